// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"
#include "io.h"
#include "out.h"

static u32 level;

static int each(const struct tool *t, struct dev *d)
{
	int err = ect_debug(d->h, level);

	(void)t;
	if (err)
		return dev_fail(d, err, "Master%u: cannot set the debug level", d->master);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_u("debug_level", level, NULL);
	out_end();
	return 0;
}

static int show(const struct tool *t, struct dev *d)
{
	struct ect_master m;

	(void)t;
	if (dev_master(d, &m))
		return 1;
	out_object(NULL);
	out_u("master", d->master, "Master%u: ", d->master);
	out_u("debug_level", m.debug_level, "debug level %u\n", m.debug_level);
	out_end();
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	u64 v;
	int ret;

	if (!argc) {
		out_array("masters");
		ret = dev_each(t, false, show);
		out_end();
		return ret;
	}
	if (io_number("level", argv[0], 2, &v))
		return 1;
	level = (u32)v;
	out_array("masters");
	ret = dev_each(t, true, each);
	out_end();
	return ret;
}

const struct cmd cmd_debug = {
	.name = "debug",
	.run = run,
	.args = "[LEVEL]",
	.opts = "m",
	.summary = "Set or show how much the master writes to the kernel log",
	.help = "LEVEL := { 0: normal | 1: more events | 2: also the content of all frames }\n"
		"Without LEVEL it is shown.\n",
	.json = "masters[]: master, debug_level",
	.flags = CMD_HISTORIC,
	.max_args = 1,
};
