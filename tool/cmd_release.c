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
	err = dev_ioctl(&d, EC_IOC_END_DETACHED, NULL);
	if (err)
		dev_fail(&d, err, "Master%u: cannot end its session", d.master);
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
	.summary = "End the cycle of an application that is gone",
	.help = "For a session the kernel goes on with because its application wanted that:\n"
		"'ethercat master' shows it as detached. Its slaves go to PREOP. The session of an\n"
		"application that is there is not touched.\n",
	.json = "master",
	.flags = CMD_ONE_MASTER,
};
