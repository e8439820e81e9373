// SPDX-License-Identifier: GPL-2.0-only
/* Sync units of the application; take the authority of one. */
#include <errno.h>
#include <string.h>

#include "out.h"
#include "unit.h"

static void domains_of(const struct ect_unit *u)
{
	const char *sep = "";

	out_text(", domains ");
	out_array("domains");
	for (unsigned int i = 0; i < 64; i++) {
		if (!(u->domains >> i & 1))
			continue;
		out_u("", i, "%s%u", sep, i);
		sep = ",";
	}
	out_end();
	out_text("%s\n", u->domains ? "" : "none");
}

static void show_state(const struct ect_unit *u, const char *in)
{
	out_bool("active", u->active, NULL);
	if (!u->active)
		return;
	out_str("run", unit_run(u), "%s  %s", in, unit_run(u));
	out_str("outputs", unit_outputs(u), ", outputs %s", unit_outputs(u));
	out_bool("authority", u->authority, "%s", u->authority ? "" : ", no authority");
	out_bool("lease_ended", u->lease_ended, "%s", u->lease_ended ? ", lease ended" : "");
	out_bool("slaves_down", u->down, "%s", u->down ? ", slaves in SAFEOP" : "");
	out_bool("held", u->held, "%s", u->held ? ", held by another application" : "");
	out_u("faults", u->faults, NULL);
	if (u->faults)
		out_text(", %u%s fault(s) since activation", u->faults,
			 u->faults == 0xffff ? " or more" : "");
	out_text("\n");
}

static void show(const struct ect_unit *u, const char *in)
{
	out_object(NULL);
	out_u("index", u->index, "%sUnit%u", in, u->index);
	out_str("name", u->name, " %s", u->name);
	domains_of(u);
	out_str("policy", unit_policy(u), "%s  policy: %s", in, unit_policy(u));
	out_u("limit_receives", u->limit, " after %u receive(s)", u->limit);
	out_u("lease_cycles", u->lease_cycles, NULL);
	out_bool("lease_holds", u->flags & ECT_UNIT_LEASE_HOLD, NULL);
	if (u->lease_cycles)
		out_text(", lease %u cycle(s), then %s", u->lease_cycles,
			 u->flags & ECT_UNIT_LEASE_HOLD ? "hold" : "zero");
	out_u("repeats", u->repeats, NULL);
	if (u->repeats > 1)
		out_text(", each frame %u times", u->repeats);
	out_bool("needs_authority", u->flags & ECT_UNIT_AUTHORITY, "%s",
		 u->flags & ECT_UNIT_AUTHORITY ? ", needs authority" : "");
	out_bool("offered", u->flags & ECT_UNIT_OFFERED, "%s\n",
		 u->flags & ECT_UNIT_OFFERED ? ", offered to other applications" : "");
	show_state(u, in);
	out_end();
}

/* Each unit until there is no more; @name: NULL, or take that one's authority. */
static int units(struct dev *d, const char *name, bool *found)
{
	const char *in = d->selected > 1 ? "  " : "";
	int err;

	for (unsigned int i = 0; ; i++) {
		struct ect_unit u = { .struct_size = sizeof(u) };

		err = ect_unit_read(d->h, i, &u);
		if (err == -ENOENT)
			return 0;
		if (err)
			return dev_fail(d, err, "Master%u: cannot read unit %u", d->master, i);
		if (!name) {
			show(&u, in);
		} else if (!strcmp(name, u.name)) {
			*found = true;
			err = ect_unit_take(d->h, i);
			return err ? dev_fail(d, err, "Master%u: cannot stop unit %s", d->master,
					      name) : 0;
		}
	}
}

static int each(const struct tool *t, struct dev *d)
{
	int ret;

	(void)t;
	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("units");
	ret = units(d, NULL, NULL);
	out_end();
	out_end();
	return ret;
}

static int take(struct tool *t, const char *name)
{
	bool found = false;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = units(&d, name, &found);
	if (!ret && !found)
		ret = fail("Master%u has no unit %s; 'ethercat units' shows them", d.master, name);
	if (!ret)
		out_u("master", d.master, NULL);
	dev_close(&d);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	if (argc == 2 && !strcmp(argv[0], "take"))
		return take(t, argv[1]);
	if (argc)
		return usage_error("'%s': use no argument, or take and a name", argv[0]);
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_units = {
	.name = "units",
	.run = run,
	.args = "[take <NAME>]",
	.opts = "m",
	.summary = "Show the sync units of the application, or stop one",
	.help = "A sync unit is a domain or several that are judged together: when a slave of the\n"
		"unit is missing or leaves OP, its policy is carried out, and on this unit alone (but\n"
		"for the policy 'stop'). Outputs: what is sent for its slaves. A unit without\n"
		"authority sends zeros, or holds the last values, until its application gives\n"
		"authority again.\n"
		"\n"
		"'take' takes the authority of a unit: its outputs are zero from the next cycle on.\n"
		"Only its application can give it again.\n",
	.json = "masters[]: master, units[]: index, name, domains[], policy (continue, zero, hold,\n"
		"SAFEOP, stop), limit_receives, lease_cycles (0: none), lease_holds, repeats,\n"
		"needs_authority, offered, active, and while active run (starting, complete,\n"
		"failed), outputs (of the application, of another application, zero, held),\n"
		"authority, lease_ended, slaves_down, held, faults; with 'take': master",
	.max_args = 2,
};
