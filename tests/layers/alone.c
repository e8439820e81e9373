// SPDX-License-Identifier: GPL-2.0-only
/* Runs the tests of a layer when its module is loaded. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/module.h>
#include "alone.h"

static unsigned int failures;

/**
 * alone_failed() - a condition does not hold
 * @file: where
 * @line: where
 * @what: condition
 * @a: left value
 * @b: right value
 */
void alone_failed(const char *file, int line, const char *what, s64 a, s64 b)
{
	const char *name = strrchr(file, '/');

	pr_info("alone: # %s:%d: not %s: %lld and %lld\n", name ? name + 1 : file, line, what, a,
		b);
	failures++;
}

/**
 * alone_wait() - wait for a condition
 * @there: condition
 * @ctx: its argument
 * @ms: waits no longer
 *
 * Return: whether it holds.
 */
bool alone_wait(bool (*there)(void *ctx), void *ctx, unsigned int ms)
{
	u64 end = ktime_get_ns() + ms * (u64)NSEC_PER_MSEC;

	while (!there(ctx)) {
		if (ktime_get_ns() > end)
			return false;
		usleep_range(100, 200);
	}
	return true;
}

static int __init alone_init(void)
{
	const char *layer = THIS_MODULE->name + strlen("ec_alone_");
	const struct alone_test *t;

	for (t = alone_tests; t->name; t++) {
		failures = 0;
		t->run();
		pr_info("alone: %s %s: %s\n", failures ? "not ok" : "ok", layer, t->name);
	}
	pr_info("alone: end %s\n", layer);
	return 0;
}

static void __exit alone_exit(void)
{
}

module_init(alone_init);
module_exit(alone_exit);

MODULE_DESCRIPTION("tests of a layer of the EtherCAT master");
MODULE_LICENSE("GPL");
