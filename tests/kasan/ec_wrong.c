// SPDX-License-Identifier: GPL-2.0-only
/*
 * Deliberate errors, one for each detector of the flavour 6.1-kasan, to show that it reports them.
 * It is no part of the product: tests/system/run.sh loads it before the other tests.
 */

#include <linux/delay.h>
#include <linux/dma-mapping.h>
#include <linux/err.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/platform_device.h>
#include <linux/slab.h>
#include <linux/spinlock.h>
#include <linux/timer.h>

static char *what = "none";
module_param(what, charp, 0);
MODULE_PARM_DESC(what, "error: none, freed, bounds, nesting, order, sleep, timer, dma");

static DEFINE_RAW_SPINLOCK(ec_wrong_raw);
static DEFINE_SPINLOCK(ec_wrong_spin);
static DEFINE_MUTEX(ec_wrong_a);
static DEFINE_MUTEX(ec_wrong_b);

static noinline int ec_wrong_freed(void)
{
	u8 *p = kzalloc(64, GFP_KERNEL);
	u8 value;

	if (!p)
		return -ENOMEM;
	OPTIMIZER_HIDE_VAR(p);
	kfree(p);
	value = READ_ONCE(p[3]);
	pr_info("ec_wrong: %u\n", value);
	return 0;
}

static noinline int ec_wrong_bounds(void)
{
	u8 *p = kzalloc(60, GFP_KERNEL);
	u8 value;

	if (!p)
		return -ENOMEM;
	OPTIMIZER_HIDE_VAR(p);
	value = READ_ONCE(p[60]);
	kfree(p);
	pr_info("ec_wrong: %u\n", value);
	return 0;
}

/* On PREEMPT_RT the inner lock sleeps. */
static int ec_wrong_nesting(void)
{
	raw_spin_lock(&ec_wrong_raw);
	spin_lock(&ec_wrong_spin);
	spin_unlock(&ec_wrong_spin);
	raw_spin_unlock(&ec_wrong_raw);
	return 0;
}

static int ec_wrong_order(void)
{
	mutex_lock(&ec_wrong_a);
	mutex_lock(&ec_wrong_b);
	mutex_unlock(&ec_wrong_b);
	mutex_unlock(&ec_wrong_a);
	mutex_lock(&ec_wrong_b);
	mutex_lock(&ec_wrong_a);
	mutex_unlock(&ec_wrong_a);
	mutex_unlock(&ec_wrong_b);
	return 0;
}

static int ec_wrong_sleep(void)
{
	spin_lock(&ec_wrong_spin);
	might_sleep();
	spin_unlock(&ec_wrong_spin);
	return 0;
}

static void ec_wrong_expired(struct timer_list *unused)
{
}

/* Freed while it runs. */
static int ec_wrong_timer(void)
{
	struct timer_list *timer = kzalloc(sizeof(*timer), GFP_KERNEL);

	if (!timer)
		return -ENOMEM;
	timer_setup(timer, ec_wrong_expired, 0);
	mod_timer(timer, jiffies + 1000 * HZ);
	kfree(timer);
	return 0;
}

/* Returned with another size. */
static int ec_wrong_dma(void)
{
	struct platform_device *pdev = platform_device_register_simple("ec_wrong", -1, NULL, 0);
	void *p = kzalloc(64, GFP_KERNEL);
	dma_addr_t at;
	int err = 0;

	if (IS_ERR(pdev) || !p) {
		err = -ENOMEM;
		goto out;
	}
	at = dma_map_single(&pdev->dev, p, 64, DMA_TO_DEVICE);
	if (dma_mapping_error(&pdev->dev, at))
		err = -EIO;
	else
		dma_unmap_single(&pdev->dev, at, 32, DMA_TO_DEVICE);
out:
	kfree(p);
	if (!IS_ERR(pdev))
		platform_device_unregister(pdev);
	return err;
}

static const struct {
	const char *name;
	int (*run)(void);
} ec_wrong[] = {
	{ "freed", ec_wrong_freed },
	{ "bounds", ec_wrong_bounds },
	{ "nesting", ec_wrong_nesting },
	{ "order", ec_wrong_order },
	{ "sleep", ec_wrong_sleep },
	{ "timer", ec_wrong_timer },
	{ "dma", ec_wrong_dma },
};

static int __init ec_wrong_init(void)
{
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(ec_wrong); i++)
		if (!strcmp(what, ec_wrong[i].name))
			return ec_wrong[i].run();
	return strcmp(what, "none") ? -EINVAL : 0;
}

static void __exit ec_wrong_exit(void)
{
}

module_init(ec_wrong_init);
module_exit(ec_wrong_exit);
MODULE_DESCRIPTION("deliberate errors for the test of the detectors");
MODULE_LICENSE("GPL");
