// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"
#include "out.h"

static int run(struct tool *t, int argc, char **argv)
{
	struct dev d;
	int err;

	(void)argc, (void)argv;
	if (dev_open_single(&d, t, true))
		return 1;
	err = ect_end_detached(d.h);
	if (err)
		dev_fail(&d, err, "Master%u: cannot end the session", d.master);
	else
		out_u("master", d.master, NULL);
	dev_close(&d);
	return err ? 1 : 0;
}

const struct cmd cmd_release = {
	.name = "release",
	.run = run,
	.args = "",
	.opts = "m",
	.summary = "End a detached session",
	.help = "A detached session continues after its application has exited (EC_CYCLE_DETACH);\n"
		"'ethercat master' shows it. The slaves go to PREOP. The session of a running\n"
		"application is not ended.\n",
	.json = "master",
	.flags = CMD_ONE_MASTER,
};
