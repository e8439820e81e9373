// SPDX-License-Identifier: GPL-2.0-only
/* Set an output of a bus that runs without an application. */
#include "current.h"
#include "out.h"

#define LEASE_MS	5000

static int set(const struct tool *t, struct dev *d, const struct current *l, char **argv)
{
	const struct ect_value *v = current_find(d, l, argv[0]);
	struct ect_output o = { .struct_size = sizeof(o) };
	int err;

	if (!v)
		return 1;
	if (v->dir != ECT_DIR_OUTPUT)
		return fail("%s is an input: only outputs can be set", v->name);
	if (!v->device)
		return fail("%s: its slave is disconnected", v->name);
	if (current_parse(l, v, argv[1], &o.value))
		return 1;
	o.domain = v->domain;
	o.device = v->device;
	o.bit = v->bit;
	o.bits = v->bits;
	o.lease_ms = t->hold ? 0 : t->lease_ms ? t->lease_ms : LEASE_MS;
	err = ect_output_set(d->h, &o);
	if (err)
		return dev_fail(d, err, "Master%u: cannot set %s", d->master, v->name);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_str("name", v->name, "%s", v->name);
	out_u("bits", o.value, " is %s", argv[1]);
	if (*current_unit_text(l, v))
		out_str("unit", current_unit_text(l, v), " %s", current_unit_text(l, v));
	out_u("lease_ms", o.lease_ms, NULL);
	if (o.lease_ms)
		out_text(" for %g s, then zero\n", o.lease_ms / 1e3);
	else
		out_text(" until it is set again, or the bus is stopped\n");
	out_end();
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct current l;
	struct dev d;
	int ret;

	(void)argc;
	if (t->hold && t->lease_ms)
		return usage_error("--hold and --lease exclude each other");
	if (dev_open_single(&d, t, true))
		return 1;
	ret = current_read_as(t, &d, t->file, &l) || set(t, &d, &l, argv);
	current_free(&l);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_set = {
	.name = "set",
	.run = run,
	.args = "<NAME> <VALUE>",
	.opts = "mHli",
	.summary = "Set an output of a bus that 'ethercat run' runs",
	.help = "The value becomes zero when its lease ends: after 5 s, or the time of --lease. The\n"
		"kernel ends it, whether this command, its shell or its user are still there. Each\n"
		"'set' of the same output begins its lease again. With --hold the value stays until it\n"
		"is set again or the bus is stopped; a slave that was disconnected and returns gets it\n"
		"again. The outputs of an application are refused: only the application sets them.\n"
		"VALUE: a number of the type of the output; on and off as well. In its unit if a bus\n"
		"file scales it: that of the session, or of --file.\n",
	.json = "master, name, bits (the raw value as a number without sign), unit, lease_ms (0: it stays)",
	.flags = CMD_ONE_MASTER | CMD_NEGATIVE,
	.min_args = 2,
	.max_args = 2,
};
