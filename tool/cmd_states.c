// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../master/wire/al.h"
#include "dev.h"
#include "out.h"

#define WAIT_S		10.0
#define POLL_MS		10

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

/* why a slave is not where it should be: ": text" parts, "" when all is well */
static void reason(const struct ec_ioc_slave *s, char *buf, size_t size)
{
	char code[8];
	int n = 0;

	*buf = 0;
	snprintf(code, sizeof(code), "0x%04x", s->al_code);
	if (s->al_code && (!s->error || !strstr(s->why, code)))
		n = snprintf(buf, size, "AL status code %s: %s", code, ec_al_code_text(s->al_code));
	if (s->error && s->why[0] && (size_t)n < size)
		snprintf(buf + n, size - (size_t)n, "%s%s", n ? ": " : "", s->why);
}

static void show_slave(const struct ec_ioc_slave *s, const char *indent, const int *w)
{
	char state[16], why[400];

	al_state_text(s->al_status, state, sizeof(state));
	reason(s, why, sizeof(why));
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

static int failed(const struct dev *d, const struct ec_ioc_slave *s, const char *what)
{
	char state[16], why[400];

	al_state_text(s->al_status, state, sizeof(state));
	reason(s, why, sizeof(why));
	return fail("Master%u slave %u: %s %s, it is in %s%s%s", d->master, s->position, what,
		    ec_al_state_name(wanted), state, *why ? ": " : "", why);
}

/*
 * The master clears its error flag when it takes the request. The slave's own
 * error bit counts once it is new or its code differs from before.
 */
static int wait_slave(struct dev *d, const struct ec_ioc_slave *before, double end)
{
	struct ec_ioc_slave s;
	double start = now_s();

	for (;;) {
		if (dev_slave(d, before->position, &s))
			return 1;
		if ((s.al_status & (EC_AL_STATE_MASK | EC_AL_ERROR)) == wanted)
			return 0;
		if (s.error == EC_SLAVE_CONFIG_FAILED)
			return failed(d, &s, "cannot reach");
		if (s.al_status & EC_AL_ERROR &&
		    (!(before->al_status & EC_AL_ERROR) || s.al_code != before->al_code ||
		     now_s() - start > 1))
			return failed(d, &s, "refused");
		if (now_s() >= end)
			return failed(d, &s, "has not reached");
		sleep_ms(POLL_MS);
	}
}

static int each(const struct tool *t, struct dev *d)
{
	double end = now_s() + (t->wait_s >= 0 ? t->wait_s : WAIT_S);
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
	for (size_t i = 0; i < sel.n && wanted; i++) {
		struct ec_ioc_state req = { .position = sel.v[i].position, .state = wanted };
		int err = dev_ioctl(d, EC_IOC_STATE, &req);

		if (err)
			ret = dev_fail(d, err, "Master%u slave %u: cannot request %s", d->master,
				       req.position, ec_al_state_name(wanted));
	}
	for (size_t i = 0; i < sel.n && wanted && t->wait; i++)
		ret |= wait_slave(d, &sel.v[i], end);
	measure(&sel, w);
	for (size_t i = 0; i < sel.n; i++)
		if (!wanted || (t->wait && out_is_json() &&
				!dev_slave(d, sel.v[i].position, &sel.v[i])))
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
	.opts = "mapw",
	.summary = "Request an AL state for slaves, or show the states",
	.help = "STATE := { INIT | PREOP | BOOT | SAFEOP | OP }, in any case.\n"
		"Without --wait the command returns when the master has accepted the request. With\n"
		"--wait it fails and shows the AL status code when a slave refuses the state or does\n"
		"not reach it in time (default 10 s). The slave keeps this state until it reconnects or an application\n"
		"reserves, activates, resets or deactivates the master.\n"
		"Without STATE: position, alias:relative position, state, and the cause of an error.\n",
	.json = "masters[]: master, slaves[] (position, alias, relative_position, state, al_error,\n"
		"al_status_code, al_status_text, flag_error, cause); empty after a request without --wait",
	.flags = CMD_HISTORIC,
	.max_args = 1,
};
