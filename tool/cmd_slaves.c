// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../lib/tools/text.h"
#include "absent.h"
#include "config_info.h"
#include "dev.h"
#include "out.h"
#include "slave_info.h"

#define WAIT_S	60.0
#define FIRST_S	2.0		/* for the first scan, on a terminal */
#define MISSING_LINES	16

static int digits(unsigned int v)
{
	return snprintf(NULL, 0, "%u", v);
}

static void row(const struct ect_slave *s, const char *indent, const int *w)
{
	char state[16], name[ECT_STRING];

	slave_state_text(s, state, sizeof(state));
	slave_name(s, name, sizeof(name));
	out_text("%s%*u  %*u:%-*u  %-*s  %c  %s\n", indent, w[0], s->position, w[1], s->alias_group,
		 w[2], slave_alias_pos(s), w[3], state, slave_flag(s), name);
}

/* ring order, each slave once; the link to the next one may be cut */
static void table(const struct ect_slave *s, size_t n, const char *indent)
{
	int w[4] = { 0 };
	char state[16];

	for (size_t i = 0; i < n; i++) {
		slave_state_text(&s[i], state, sizeof(state));
		w[0] = max(w[0], digits(s[i].position));
		w[1] = max(w[1], digits(s[i].alias_group));
		w[2] = max(w[2], digits(slave_alias_pos(&s[i])));
		w[3] = max(w[3], (int)strlen(state));
	}
	for (size_t i = 0; i < n; i++) {
		if (i && s[i].device_index != s[i - 1].device_index)
			out_text("xxx LINK FAILURE xxx\n");
		row(&s[i], indent, w);
	}
}

static int by_position(const void *a, const void *b)
{
	const struct ect_slave *x = a, *y = b;

	return (x->position > y->position) - (x->position < y->position);
}

static size_t sort_once(struct slaves *s)
{
	size_t n = 0;

	qsort(s->v, s->n, sizeof(*s->v), by_position);
	for (size_t i = 0; i < s->n; i++)
		if (!n || s->v[n - 1].position != s->v[i].position)
			s->v[n++] = s->v[i];
	return n;
}

/* on stderr: why the list may differ from the bus */
static void remark(struct dev *d, const struct ect_master *m)
{
	char why[160] = "";

	if (m->held && m->slaves_responding != m->slave_count)
		snprintf(why, sizeof(why), "; slaves responding: %u, in the list: %u",
			 m->slaves_responding, m->slave_count);
	if (m->held)
		note("Master%u: the list of slaves is held until %s activates or releases the master%s",
		     d->master, *m->owner ? m->owner : "the application", why);

	if (dev_why_empty(d, m, why, sizeof(why)))
		return;
	if (m->scan_busy)
		note("Master%u: a bus scan is running, the list may be incomplete (see --wait)",
		     d->master);
	else if (!m->slave_count && *why)
		note("Master%u: %s", d->master, why);
}

/* on stderr: configured slaves that have no line, or one of another slave */
static void missing(struct dev *d, unsigned int configs)
{
	unsigned int n = 0;

	for (unsigned int i = 0; i < configs; i++) {
		struct ect_config c = { .struct_size = sizeof(c) };
		char why[ECT_TEXT], name[CONFIG_NAME];

		if (ect_config_read(d->h, i, &c))
			break;	/* the application has exited meanwhile */
		/* the whole group is connected, or none of its slaves is used */
		if (c.slave_position >= 0 || (c.group && c.position) || n++ >= MISSING_LINES)
			continue;
		dev_config_why(d, i, why, sizeof(why));
		note("Master%u: configuration %s: %s", d->master,
		     config_name(&c, name, sizeof(name)), why);
	}
	if (n > MISSING_LINES)
		note("Master%u: %u more configurations without slave, see 'ethercat config'",
		     d->master, n - MISSING_LINES);
}

/* on stderr, as the lines of slaves are for programs */
static void beside(const struct dev *d, const char *text)
{
	note("Master%u: %s", d->master, text);
}

/* Just after the load of the modules a user wants to see slaves, not that there are none yet. */
static int wait_first(struct dev *d)
{
	double end = now_s() + FIRST_S;
	struct ect_master m;
	char why[160];

	if (out_is_json() || !isatty(STDOUT_FILENO))
		return 0;
	for (;;) {
		if (dev_master(d, &m) || dev_why_empty(d, &m, why, sizeof(why)))
			return 1;
		if (m.scan_count || (*why && !m.scan_busy) || now_s() >= end)
			return 0;
		sleep_ms(20);
	}
}

/* A scan that a user asks for tries ports again that have lost their link too often. */
static int retry(struct dev *d)
{
	int err = ect_rescan(d->h);

	return err ? dev_fail(d, err, "Master%u: cannot scan the bus", d->master) : 0;
}

/* The device that is listed behind a closed port of the selected slave */
static int let_in(const struct tool *t, struct dev *d, const struct slaves *sel)
{
	struct ect_behind b = { .struct_size = sizeof(b) };
	char device[160];
	int err;

	if (sel->n != 1)
		return fail("Master%u: --let-in is for a port of one slave, not of %zu: select it with --position or --alias",
			    d->master, sel->n);
	err = ect_behind_read(d->h, sel->v->device, t->let_in, &b);
	if (!err)
		err = ect_let_in(d->h, sel->v->device, t->let_in, &b);
	if (err)
		return dev_fail(d, err, "Master%u: cannot let in what is behind port %u of slave %u",
				d->master, t->let_in, sel->v->position);
	note("Master%u: the device behind port %u of slave %u is let in%s", d->master, t->let_in,
	     sel->v->position, text_behind(&b, device, sizeof(device)));
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	struct ect_master m;
	struct slaves sel;
	int ret;

	if (t->retry && retry(d))
		return 1;
	if (!t->wait && wait_first(d))
		return 1;
	if (t->wait && dev_wait_scan(d, t->wait_s >= 0 ? t->wait_s : WAIT_S))
		return 1;
	if (dev_master(d, &m) || dev_select(d, t, &sel, NULL))
		return 1;
	if (t->let_in && let_in(t, d, &sel)) {
		slaves_free(&sel);
		return 1;
	}
	remark(d, &m);
	missing(d, m.config_count);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_bool("scan_busy", m.scan_busy, NULL);
	out_bool("list_held", m.held, NULL);
	out_u("slaves_responding", m.slaves_responding, NULL);
	out_array("slaves");
	if (t->verbosity <= 0)
		sel.n = sort_once(&sel);
	if (t->verbosity <= 0 && !out_is_json()) {
		if (d->selected > 1)
			out_text("Master%u\n", d->master);
		table(sel.v, sel.n, d->selected > 1 ? "  " : "");
	} else {
		for (size_t i = 0; i < sel.n; i++)
			slave_info(d, &sel.v[i]);
	}
	out_end();
	ret = absent_show(d, &sel, beside);
	out_end();
	slaves_free(&sel);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, t->retry || t->let_in, each);
	out_end();
	return ret;
}

const struct cmd cmd_slaves = {
	.name = "slaves",
	.run = run,
	.args = "",
	.opts = "mapvwRN",
	.summary = "Show the slaves on the bus",
	.help = "One line for each slave: ring position, alias:relative position, state, flag, name.\n"
		"'+ERROR' after the state: the slave reports an error; state LOST: it does not reply.\n"
		"Flag 'E': scan or configuration of the slave failed; '!': another slave than configured\n"
		"by the application. Configured slaves that are absent are listed on stderr, and so are\n"
		"ports behind which slaves were disconnected, until they return or 'ethercat rescan' forgets\n"
		"them, and ports that stay closed although they have a link.\n"
		"--retry tries ports at once that wait because they have lost their link too often, and\n"
		"failed ones, as 'ethercat rescan' does.\n"
		"While an application runs, a port at which it expects a hot connect group stays closed if\n"
		"another device is behind it, which stderr lists. --let-in PORT opens the port for the device\n"
		"behind it, at the slave that --position or --alias selects. It holds for this device at this\n"
		"port until the application has ended; the right device needs no command.\n"
		"'xxx LINK FAILURE xxx' marks the break of a redundant ring.\n"
		"From its reservation of the master to activation, and after deactivation, an application\n"
		"has the list of slaves held: no scan changes it, and stderr shows which process that is.\n"
		"--verbose shows all data of the slaves. --wait waits until no bus scan is running\n"
		"(default at most 60 s); without it, on a terminal, at most 2 s for the first scan.\n",
	.json = "masters[]: master, scan_busy, list_held, slaves_responding,\n"
		"slaves[] (position, device_number, alias, relative_position, device,\n"
		"state, al_error, flag_error, cause, warning, differs,\n"
		"not_in_op (or null), name, vendor_id, product_code, revision_number,\n"
		"serial_number, station_address, own_alias, identification, al_status, al_status_code,\n"
		"al_status_text, requested_state, dl_status, fmmu_bit_operation, dc, dc_delay_ns,\n"
		"dc_state (not_set, in_step, off, delay_uncertain), dc_offset_ns,\n"
		"dc_difference_ns (when set), ports[] (type, link_up, loop_closed, signal,\n"
		"next_slave, receive_time_ns, receive_time_diff_ns, delay_to_next_dc_ns),\n"
		"mailboxes (bootstrap_rx_offset, bootstrap_rx_size, bootstrap_tx_offset,\n"
		"bootstrap_tx_size, standard_..., protocols[]),\n"
		"general (group, image, order_number, device_name, coe_details, flags, current_ma),\n"
		"sync_managers, fmmus, sii_words),\n"
		"absent[] (upstream and port (null: the main device), slaves, since_ns, first, last (ring\n"
		"positions they had), first_name), closed_ports[] (slave, port, reason (no_reply,\n"
		"no_loop_control, losses, other_device, other_sign, other_serial, second, reversed, boot,\n"
		"unreadable, unexpected), wait_s, behind (null: no device that can be let in; vendor_id,\n"
		"product_code, revision_number, serial_number, alias, identification, slaves, name))",
	.flags = CMD_HISTORIC,
};
