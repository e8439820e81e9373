// SPDX-License-Identifier: GPL-2.0-only
/* The end of 'ethercat run'. */
#include "dev.h"
#include "out.h"

static int stop(struct dev *d)
{
	struct ect_master m = { .struct_size = sizeof(m) };
	int err;

	if (dev_master(d, &m))
		return 1;
	if (m.session == ECT_SESSION_DETACHED && !m.left)
		return fail("Master%u has the session of an application that has exited; end it with 'ethercat release'",
			    d->master);
	if (m.session != ECT_SESSION_DETACHED && m.owner[0])
		return fail("Master%u is not run by 'ethercat run' but by %s; stop that application",
			    d->master, m.owner);
	if (m.session != ECT_SESSION_DETACHED)
		return fail("Master%u does not run", d->master);
	err = ect_end_detached(d->h);
	if (err)
		return dev_fail(d, err, "Master%u: cannot stop", d->master);
	out_u("master", d->master, "Master%u stopped: its slaves go to PREOP\n", d->master);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct dev d;
	int ret;

	(void)argc, (void)argv;
	if (dev_open_single(&d, t, true))
		return 1;
	ret = stop(&d);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_stop = {
	.name = "stop",
	.run = run,
	.args = "",
	.opts = "m",
	.summary = "End what 'ethercat run' has begun",
	.help = "Frames with process data end, and the slaves go to PREOP. Each member of the group of\n"
		"the device may do that. Sessions of applications are not ended.\n",
	.json = "master",
	.flags = CMD_ONE_MASTER,
};
