// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../master/wire/al.h"
#include "al_request.h"
#include "dev.h"
#include "out.h"

static u8 wanted;	/* 0: show */

static u8 parse_state(const char *text)
{
	static const u8 all[] = { EC_AL_INIT, EC_AL_PREOP, EC_AL_BOOT, EC_AL_SAFEOP, EC_AL_OP };

	for (size_t i = 0; i < ARRAY_SIZE(all); i++)
		if (!strcasecmp(text, ec_al_state_name(all[i])))
			return all[i];
	return 0;
}

/* columns as wide as their widest cell */
static void measure(const struct slaves *s, int *w)
{
	char state[16];

	for (size_t i = 0; i < s->n; i++) {
		al_state_text(s->v[i].al_status, state, sizeof(state));
		w[0] = max(w[0], snprintf(NULL, 0, "%u", s->v[i].position));
		w[1] = max(w[1], snprintf(NULL, 0, "%u", s->v[i].alias_group));
		w[2] = max(w[2], snprintf(NULL, 0, "%u", slave_alias_pos(&s->v[i])));
		w[3] = max(w[3], (int)strlen(state));
	}
}

static void show_slave(const struct ect_slave *s, const char *indent, const int *w)
{
	char state[16], why[400];

	al_state_text(s->al_status, state, sizeof(state));
	al_reason(s, why, sizeof(why));
	out_object(NULL);
	out_u("position", s->position, "%s%*u  ", indent, w[0], s->position);
	out_u("alias", s->alias_group, "%*u:", w[1], s->alias_group);
	out_u("relative_position", slave_alias_pos(s), "%-*u  ", w[2], slave_alias_pos(s));
	out_str("state", ec_al_state_name((u8)s->al_status), "%-*s", *why ? w[3] : 0, state);
	out_bool("al_error", s->al_status & EC_AL_ERROR, NULL);
	out_u("al_status_code", s->al_code, NULL);
	out_str("al_status_text", ec_al_code_text(s->al_code), NULL);
	out_bool("flag_error", s->error, NULL);
	out_str("cause", s->why, NULL);
	out_text("%s%s\n", *why ? "  " : "", why);
	out_end();
}

static int each(const struct tool *t, struct dev *d)
{
	double end = now_s() + (t->wait_s >= 0 ? t->wait_s : AL_WAIT_S + t->timeout_ms / 1e3);
	struct slaves sel;
	int w[4] = { 0 };
	int ret = 0;

	if (dev_select(d, t, &sel, NULL))
		return 1;
	if (wanted && !sel.n && list_all(&t->aliases) && list_all(&t->positions)) {
		slaves_free(&sel);
		return dev_none_present(d);
	}
	out_object(NULL);
	out_u("master", d->master, NULL);
	if (!wanted && d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("slaves");
	for (size_t i = 0; i < sel.n && wanted; i++)
		ret |= al_request(d, &sel.v[i], wanted, t->timeout_ms);
	for (size_t i = 0; i < sel.n && wanted && t->wait; i++)
		ret |= al_wait(d, &sel.v[i], wanted, end);
	measure(&sel, w);
	for (size_t i = 0; i < sel.n; i++)
		if (!wanted || (t->wait && out_is_json() &&
				!dev_slave(d, &sel.v[i])))
			show_slave(&sel.v[i], d->selected > 1 ? "  " : "", w);
	out_end();
	out_end();
	slaves_free(&sel);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	wanted = 0;
	if (argc) {
		wanted = parse_state(argv[0]);
		if (!wanted)
			return usage_error("invalid state '%s': expected INIT, PREOP, BOOT, SAFEOP or OP",
					   argv[0]);
	}
	out_array("masters");
	ret = dev_each(t, wanted, each);
	out_end();
	return ret;
}

const struct cmd cmd_states = {
	.name = "states",
	.run = run,
	.args = "[STATE]",
	.opts = "mapwI",
	.summary = "Request an AL state for slaves, or show the states",
	.help = "STATE := { INIT | PREOP | BOOT | SAFEOP | OP }, in any case.\n"
		"Without --wait the command returns when the master has accepted the request. With\n"
		"--wait it fails and shows the AL status code when a slave refuses the state or does\n"
		"not reach it in time (default 10 s, with --timeout as much more). The slave keeps this\n"
		"state until it reconnects or an application reserves, activates, resets or deactivates\n"
		"the master.\n"
		"--timeout is the time limit of each transition on the way to STATE, instead of that of the\n"
		"application, of the module parameter state_timeout_ms, and of 0.2 to 10 s by transition.\n"
		"A slave that is late has failed, but its state is taken when it comes.\n"
		"Without STATE: position, alias:relative position, state, and the cause of an error.\n",
	.json = "masters[]: master, slaves[] (position, alias, relative_position, state, al_error,\n"
		"al_status_code, al_status_text, flag_error, cause); empty after a request without --wait",
	.flags = CMD_HISTORIC,
	.max_args = 1,
};
