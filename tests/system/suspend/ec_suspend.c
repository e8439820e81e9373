// SPDX-License-Identifier: GPL-2.0-only
/*
 * Suspends one PCI function as the kernel does with all of them, and resumes it when the module
 * is removed. A guest cannot be suspended: the 9p device with its file systems has no resume. With
 * whole=1 the function sleeps during a suspend of the guest that goes as far as the freezer of
 * processes (/sys/power/pm_test): after all notifiers of the suspend, and up to the first
 * of the resume. shut=1 shuts it down, as a reboot does.
 */
#include <linux/device.h>
#include <linux/module.h>
#include <linux/pci.h>
#include <linux/pm.h>
#include <linux/suspend.h>

static char *function = "";
module_param(function, charp, 0444);
MODULE_PARM_DESC(function, "PCI address: DDDD:BB:SS.F");

static bool whole;
module_param(whole, bool, 0444);
MODULE_PARM_DESC(whole, "with each suspend of the computer");

static bool shut;
module_param(shut, bool, 0444);
MODULE_PARM_DESC(shut, "shut the function down");

static struct device *dev;

typedef int (*step)(struct device *dev);

static int run(const step *steps, size_t n)
{
	int ret = 0;
	size_t i;

	for (i = 0; i < n && !ret; i++)
		if (steps[i])
			ret = steps[i](dev);
	return ret;
}

static int suspend(void)
{
	const struct dev_pm_ops *pm = dev->bus->pm;
	int ret;

	device_lock(dev);
	ret = run((const step[]){ pm->prepare, pm->suspend, pm->suspend_late,
				  pm->suspend_noirq }, 4);
	/* 1 of prepare(): leave it as it is, which would test nothing */
	if (!ret && to_pci_dev(dev)->current_state == PCI_D0)
		ret = -EBUSY;
	device_unlock(dev);
	dev_info(dev, "suspended (%d), in D%d\n", ret, to_pci_dev(dev)->current_state);
	return ret > 0 ? -EIO : ret;
}

static void resume(void)
{
	const struct dev_pm_ops *pm = dev->bus->pm;
	int ret;

	device_lock(dev);
	ret = run((const step[]){ pm->resume_noirq, pm->resume_early, pm->resume }, 3);
	if (pm->complete)
		pm->complete(dev);
	device_unlock(dev);
	dev_info(dev, "resumed (%d), in D%d\n", ret, to_pci_dev(dev)->current_state);
}

static int last(struct notifier_block *nb, unsigned long event, void *unused)
{
	return event == PM_SUSPEND_PREPARE ? notifier_from_errno(suspend()) : NOTIFY_DONE;
}

static int first(struct notifier_block *nb, unsigned long event, void *unused)
{
	if (event == PM_POST_SUSPEND)
		resume();
	return NOTIFY_DONE;
}

static struct notifier_block last_nb = { .notifier_call = last, .priority = -1 };
static struct notifier_block first_nb = { .notifier_call = first, .priority = 1 };

static int begin(void)
{
	if (shut) {
		device_lock(dev);
		if (dev->bus->shutdown)
			dev->bus->shutdown(dev);
		device_unlock(dev);
		return 0;
	}
	if (!whole)
		return suspend();
	return register_pm_notifier(&last_nb) ?: register_pm_notifier(&first_nb);
}

static int __init suspend_init(void)
{
	int ret;

	dev = bus_find_device_by_name(&pci_bus_type, NULL, function);
	if (!dev)
		return -ENODEV;
	if (!dev->bus->pm) {
		pr_err("ec_suspend: this kernel has no CONFIG_PM_SLEEP\n");
		put_device(dev);
		return -EOPNOTSUPP;
	}
	ret = begin();
	if (ret)
		put_device(dev);
	return ret;
}

static void __exit suspend_exit(void)
{
	if (whole) {
		unregister_pm_notifier(&first_nb);
		unregister_pm_notifier(&last_nb);
	} else if (!shut) {
		resume();
	}
	put_device(dev);
}

module_init(suspend_init);
module_exit(suspend_exit);
MODULE_DESCRIPTION("Test: suspend of one PCI function");
MODULE_LICENSE("GPL");
