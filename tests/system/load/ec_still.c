// SPDX-License-Identifier: GPL-2.0-only
/* Its load lets the machine stand still: no CPU runs a thread or an interrupt for @ms. */
#include <linux/delay.h>
#include <linux/module.h>
#include <linux/stop_machine.h>

static unsigned int ms = 172;
module_param(ms, uint, 0444);
MODULE_PARM_DESC(ms, "how long, milliseconds");

static int spin(void *unused)
{
	mdelay(ms);
	return 0;
}

static int __init still_init(void)
{
	return stop_machine(spin, NULL, NULL);
}

static void __exit still_exit(void)
{
}

module_init(still_init);
module_exit(still_exit);

MODULE_DESCRIPTION("Test: a machine that stands still");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
