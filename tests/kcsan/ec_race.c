// SPDX-License-Identifier: GPL-2.0-only
/*
 * A deliberate data race between two threads, to show that a kernel with KCSAN reports one.
 * It is no part of the product: tests/system/run.sh loads it before the other tests.
 */

#include <linux/compiler.h>
#include <linux/delay.h>
#include <linux/err.h>
#include <linux/kthread.h>
#include <linux/module.h>

static bool marked;
module_param(marked, bool, 0);
MODULE_PARM_DESC(marked, "READ_ONCE() and WRITE_ONCE(): the same accesses without a race");

static u32 shared, seen;
static struct task_struct *writer, *reader;

static int ec_race_write(void *unused)
{
	u32 n = 0;

	while (!kthread_should_stop()) {
		if (marked)
			WRITE_ONCE(shared, ++n);
		else
			shared = ++n;
		cond_resched();
	}
	return 0;
}

static int ec_race_read(void *unused)
{
	u32 sum = 0;

	while (!kthread_should_stop()) {
		sum += marked ? READ_ONCE(shared) : shared;
		cond_resched();
	}
	seen = sum;
	return 0;
}

static int __init ec_race_init(void)
{
	writer = kthread_run(ec_race_write, NULL, "ec_race_write");
	if (IS_ERR(writer))
		return PTR_ERR(writer);
	reader = kthread_run(ec_race_read, NULL, "ec_race_read");
	if (IS_ERR(reader)) {
		kthread_stop(writer);
		return PTR_ERR(reader);
	}
	return 0;
}

static void __exit ec_race_exit(void)
{
	kthread_stop(reader);
	kthread_stop(writer);
	pr_info("ec_race: read %u in all\n", seen);
}

module_init(ec_race_init);
module_exit(ec_race_exit);
MODULE_DESCRIPTION("deliberate data race for the test of KCSAN");
MODULE_LICENSE("GPL");
