// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"
#include "out.h"

#define WAIT_S	60.0
#define POLL_MS	20

static int wait_scan(const struct tool *t, struct dev *d, u32 before)
{
	double limit = t->wait_s >= 0 ? t->wait_s : WAIT_S, end = now_s() + limit;
	struct ect_master m;

	for (;;) {
		if (dev_master(d, &m))
			return 1;
		if (m.scan_count != before && !m.scan_busy)
			return 0;
		if (now_s() >= end)
			return fail("Master%u: the bus scan has not finished after %g s", d->master,
				    limit);
		sleep_ms(POLL_MS);
	}
}

static int each(const struct tool *t, struct dev *d)
{
	struct ect_master m;
	char why[160];
	int err;

	/* without a link nothing is sent: a scan would have no effect */
	if (dev_master(d, &m) || dev_why_empty(d, &m, why, sizeof(why)))
		return 1;
	if (*why && !m.scan_busy)
		return fail("Master%u: cannot scan the bus: %s", d->master, why);
	err = ect_rescan(d->h);
	if (err)
		return dev_fail(d, err, "Master%u: cannot scan the bus", d->master);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_end();
	return t->wait ? wait_scan(t, d, m.scan_count) : 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, true, each);
	out_end();
	return ret;
}

const struct cmd cmd_rescan = {
	.name = "rescan",
	.run = run,
	.args = "",
	.opts = "mw",
	.summary = "Scan the bus again",
	.help = "Returns at once; with --wait it waits for the end of the scan (default at most 60 s).\n"
		"Fails without a device or link, and while an application has the list of slaves held.\n"
		"Slaves that are absent now are no longer shown as disconnected.\n",
	.json = "masters[]: master",
	.flags = CMD_HISTORIC,
};
