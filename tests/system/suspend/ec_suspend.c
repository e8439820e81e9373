// SPDX-License-Identifier: GPL-2.0-only
/*
 * Suspends one PCI function as the kernel does with all of them, and resumes it when the module
 * is removed. A guest cannot be suspended: the 9p device with its file systems has no resume.
 */
#include <linux/device.h>
#include <linux/module.h>
#include <linux/pci.h>
#include <linux/pm.h>

static char *function = "";
module_param(function, charp, 0444);
MODULE_PARM_DESC(function, "PCI address: DDDD:BB:SS.F");

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

static int __init suspend_init(void)
{
	const struct dev_pm_ops *pm;
	int ret;

	dev = bus_find_device_by_name(&pci_bus_type, NULL, function);
	if (!dev)
		return -ENODEV;
	pm = dev->bus->pm;
	if (!pm) {
		pr_err("ec_suspend: this kernel has no CONFIG_PM_SLEEP\n");
		put_device(dev);
		return -EOPNOTSUPP;
	}
	device_lock(dev);
	ret = run((const step[]){ pm->prepare, pm->suspend, pm->suspend_late,
				  pm->suspend_noirq }, 4);
	/* 1 of prepare(): leave it as it is, which would test nothing */
	if (!ret && to_pci_dev(dev)->current_state == PCI_D0)
		ret = -EBUSY;
	device_unlock(dev);
	dev_info(dev, "suspended (%d), in D%d\n", ret, to_pci_dev(dev)->current_state);
	if (ret)
		put_device(dev);
	return ret > 0 ? -EIO : ret;
}

static void __exit suspend_exit(void)
{
	const struct dev_pm_ops *pm = dev->bus->pm;
	int ret;

	device_lock(dev);
	ret = run((const step[]){ pm->resume_noirq, pm->resume_early, pm->resume }, 3);
	if (pm->complete)
		pm->complete(dev);
	device_unlock(dev);
	dev_info(dev, "resumed (%d), in D%d\n", ret, to_pci_dev(dev)->current_state);
	put_device(dev);
}

module_init(suspend_init);
module_exit(suspend_exit);
MODULE_DESCRIPTION("Test: suspend of one PCI function");
MODULE_LICENSE("GPL");
