// SPDX-License-Identifier: GPL-2.0-only
/*
 * What happens before the first and after the last suite.
 *
 * Before: timers turn high-resolution at the first tick; without a wait the
 * first suite would see wake-ups up to 10 ms late.
 *
 * After, debug variant: once all tests are done, lets virtual time pass so that
 * kmemleak's own thread scans (60 s after boot, then each 600 s; an object
 * must be seen twice).  run.sh looks for its report in the log.
 */
#include <linux/delay.h>
#include <linux/init.h>
#include <linux/notifier.h>
#include <linux/reboot.h>

static int __init settle_init(void)
{
	msleep(100);
	return 0;
}
late_initcall_sync(settle_init);

#ifdef CONFIG_DEBUG_KMEMLEAK
static int leakscan(struct notifier_block *nb, unsigned long action,
		    void *data)
{
	/* a suite has restarts of its own */
	if (action != SYS_HALT)
		return NOTIFY_DONE;
	pr_info("leakscan: waiting for kmemleak\n");
	ssleep(1300);
	pr_info("leakscan: done\n");
	return NOTIFY_DONE;
}

static struct notifier_block leakscan_nb = {
	.notifier_call = leakscan,
	.priority = INT_MAX,
};

static int __init leakscan_init(void)
{
	return register_reboot_notifier(&leakscan_nb);
}
late_initcall(leakscan_init);
#endif
