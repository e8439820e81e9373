// SPDX-License-Identifier: GPL-2.0-only
/* Switches the transmitter of an Intel network card off, behind the back of its driver. */
#include <linux/io.h>
#include <linux/module.h>
#include <linux/pci.h>

#define TCTL	0x0400
#define ENABLE	BIT(1)

static char *function = "";
module_param(function, charp, 0444);
MODULE_PARM_DESC(function, "PCI address: DDDD:BB:SS.F");

static int __init hang_init(void)
{
	struct device *dev = bus_find_device_by_name(&pci_bus_type, NULL, function);
	void __iomem *regs;

	if (!dev)
		return -ENODEV;
	regs = ioremap(pci_resource_start(to_pci_dev(dev), 0), PAGE_SIZE);
	put_device(dev);
	if (!regs)
		return -ENOMEM;
	writel(readl(regs + TCTL) & ~ENABLE, regs + TCTL);
	iounmap(regs);
	return 0;
}

static void __exit hang_exit(void)
{
}

module_init(hang_init);
module_exit(hang_exit);
MODULE_DESCRIPTION("Test: a network card that sends nothing any more");
MODULE_LICENSE("GPL");
