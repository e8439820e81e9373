// SPDX-License-Identifier: GPL-2.0-only
/*
 * Native device: an Intel network controller that the master has for itself, without interrupts.
 * The driver binds to devices whose driver_override names it, and to no other: a network card
 * in use by the system is never taken.
 */
#include <linux/module.h>
#include <linux/pci.h>
#include "card.h"

#define NAME		"ec_intel"

static int check(struct pci_dev *pdev, const struct intel_chip *chip)
{
	if (pdev->vendor != PCI_VENDOR_ID_INTEL || !chip)
		pci_err(pdev, "%04x:%04x is not in the list of chips; use the generic device\n",
			pdev->vendor, pdev->device);
	else if (!chip->class)
		pci_err(pdev, "%s is not supported: %s; use the generic device\n", chip->name,
			chip->why_not);
	else
		return 0;
	return -ENODEV;
}

/*
 * Leaving a power saving state takes longer than a frame. The kernel leaves the link to firmware
 * that wants it so; the device comes before the port above it (PCIe, 5.4.1).
 */
static void keep_awake(struct pci_dev *pdev)
{
	struct pci_dev *port = pci_upstream_bridge(pdev);
	u16 control = 0;

	pci_disable_link_state(pdev, PCIE_LINK_STATE_L0S | PCIE_LINK_STATE_L1);
	pcie_capability_read_word(pdev, PCI_EXP_LNKCTL, &control);
	if (!(control & PCI_EXP_LNKCTL_ASPMC))
		return;
	pci_info(pdev, "power saving of its PCIe link is off\n");
	pcie_capability_clear_word(pdev, PCI_EXP_LNKCTL, PCI_EXP_LNKCTL_ASPMC);
	if (port)
		pcie_capability_clear_word(port, PCI_EXP_LNKCTL, PCI_EXP_LNKCTL_ASPMC);
}

static int map(struct intel *n)
{
	struct pci_dev *pdev = n->pdev;
	int ret = pcim_enable_device(pdev);

	if (ret)
		return ret;
	/* the largest offset that any chip of the list uses */
	if (pci_resource_len(pdev, 0) < 0x10000) {
		pci_err(pdev, "BAR 0 has %llu byte(s), 65536 needed\n",
			(unsigned long long)pci_resource_len(pdev, 0));
		return -ENXIO;
	}
	ret = pcim_iomap_regions(pdev, BIT(0), NAME);
	if (ret)
		return ret;
	n->nic.regs = pcim_iomap_table(pdev)[0];
	n->nic.class = n->chip->class;
	/* some chips on a 32-bit bus fail with addresses of 64 bits */
	ret = n->chip->class->pcie ? dma_set_mask_and_coherent(&pdev->dev, DMA_BIT_MASK(64)) : -EIO;
	if (ret)
		ret = dma_set_mask_and_coherent(&pdev->dev, DMA_BIT_MASK(32));
	keep_awake(pdev);
	pci_intx(pdev, 0);
	return ret ?: ec_ring_alloc(&pdev->dev, &n->tx, &n->rx);
}

static int probe(struct pci_dev *pdev, const struct pci_device_id *id)
{
	const struct intel_chip *chip = ec_chip_find(pdev->device);
	struct ecdev *dev;
	struct intel *n;
	int ret = check(pdev, chip);

	if (ret)
		return ret;
	n = devm_kzalloc(&pdev->dev, sizeof(*n), GFP_KERNEL);
	if (!n)
		return -ENOMEM;
	n->pdev = pdev;
	n->chip = chip;
	ec_card_init(n);
	ret = map(n);
	if (ret)
		return ret;
	/* the address is known after it, and the controller is quiet until a master wants it */
	ret = ec_nic_reset(&n->nic);
	if (ret) {
		pci_err(pdev, "%s (%pe)\n", ret == -EMEDIUMTYPE ?
			"is set up for fibre or SGMII; use the generic device" :
			"cannot reset the controller", ERR_PTR(ret));
		return ret;
	}
	pci_set_drvdata(pdev, n);
	pci_save_state(pdev);
	pci_info(pdev, "%s (%s), %s, %pM\n", chip->name, chip->class->name,
		 chip->tested ? "run in QEMU only" : "never tested", n->nic.mac);
	dev = ecdev_offer(pci_name(pdev), n->nic.mac, &ec_card_ops, n);
	if (IS_ERR(dev))
		return PTR_ERR(dev);
	n->dev = dev;
	return 0;
}

static void remove(struct pci_dev *pdev)
{
	struct intel *n = pci_get_drvdata(pdev);

	ecdev_withdraw(n->dev);
}

static void shutdown(struct pci_dev *pdev)
{
	ec_card_shut(pci_get_drvdata(pdev));
}

static void reset_prepare(struct pci_dev *pdev)
{
	ec_card_quiesce(pci_get_drvdata(pdev));
}

static void reset_done(struct pci_dev *pdev)
{
	struct intel *n = pci_get_drvdata(pdev);
	int ret = ec_card_run_again(n);

	if (ret)
		pci_err(pdev, "does not start after a reset (%pe)\n", ERR_PTR(ret));
}

/*
 * A card without these functions keeps the kernel from ending the errors of other functions behind
 * the same port. Also after an error that needs no reset the descriptors may be wrong.
 */
static pci_ers_result_t error_detected(struct pci_dev *pdev, pci_channel_state_t state)
{
	ec_card_quiesce(pci_get_drvdata(pdev));
	switch (state) {
	case pci_channel_io_normal:
		return PCI_ERS_RESULT_CAN_RECOVER;
	case pci_channel_io_frozen:
		return PCI_ERS_RESULT_NEED_RESET;
	default:
		return PCI_ERS_RESULT_DISCONNECT;
	}
}

/* It was never disabled: its registers answer again with the state. */
static pci_ers_result_t slot_reset(struct pci_dev *pdev)
{
	pci_restore_state(pdev);
	return PCI_ERS_RESULT_RECOVERED;
}

static int suspend(struct device *dev)
{
	ec_card_quiesce(dev_get_drvdata(dev));
	return 0;
}

static int resume(struct device *dev)
{
	return ec_card_run_again(dev_get_drvdata(dev));
}

static DEFINE_SIMPLE_DEV_PM_OPS(pm_ops, suspend, resume);

static const struct pci_error_handlers errors = {
	.reset_prepare = reset_prepare,
	.reset_done = reset_done,
	.error_detected = error_detected,
	.slot_reset = slot_reset,
	.resume = reset_done,
};

/* none: only driver_override chooses a device, see pci_match_device() */
static const struct pci_device_id ids[] = { {} };

static struct pci_driver intel_driver = {
	.name = NAME,
	.id_table = ids,
	.probe = probe,
	.remove = remove,
	.shutdown = shutdown,
	.err_handler = &errors,
	.driver.pm = pm_sleep_ptr(&pm_ops),
};
module_pci_driver(intel_driver);

MODULE_DESCRIPTION("EtherCAT master: native device for Intel network controllers");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
