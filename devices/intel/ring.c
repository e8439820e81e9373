// SPDX-License-Identifier: GPL-2.0-only
/* The rings: their memory, and their start. */
#include <linux/dma-mapping.h>
#include <linux/errno.h>
#include <linux/iopoll.h>
#include "regs.h"
#include "ring.h"

#define QUEUE_US	10000

static int alloc(struct device *dev, struct intel_ring *r, unsigned int n)
{
	r->desc = dmam_alloc_coherent(dev, n * sizeof(*r->desc), &r->desc_dma, GFP_KERNEL);
	r->buf = dmam_alloc_coherent(dev, n * INTEL_BUF, &r->buf_dma, GFP_KERNEL);
	return r->desc && r->buf ? 0 : -ENOMEM;
}

/**
 * ec_ring_alloc() - allocate both rings; freed with the device
 * @dev: device
 * @tx: result
 * @rx: result
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_ring_alloc(struct device *dev, struct intel_ring *tx, struct intel_ring *rx)
{
	return alloc(dev, tx, INTEL_TX) ?: alloc(dev, rx, INTEL_RX);
}

static int enable(const struct intel_nic *nic, u32 queue)
{
	u32 v;

	if (!nic->class->queue_enable)
		return 0;
	ec_nic_write(nic, queue + Q_DCTL, ec_nic_read(nic, queue + Q_DCTL) | DCTL_ENABLE);
	return readl_poll_timeout(nic->regs + queue + Q_DCTL, v, v & DCTL_ENABLE, 100, QUEUE_US);
}

static int set_queue(const struct intel_nic *nic, u32 queue, struct intel_ring *r, unsigned int n)
{
	r->next = 0;
	/* a reset enables transmit queue 0 of some chips, which has no ring yet */
	if (nic->class->queue_enable)
		ec_nic_write(nic, queue + Q_DCTL,
			     ec_nic_read(nic, queue + Q_DCTL) & ~DCTL_ENABLE);
	ec_nic_write(nic, queue + Q_BAL, lower_32_bits(r->desc_dma));
	ec_nic_write(nic, queue + Q_BAH, upper_32_bits(r->desc_dma));
	ec_nic_write(nic, queue + Q_LEN, n * sizeof(*r->desc));
	ec_nic_write(nic, queue + Q_HEAD, 0);
	ec_nic_write(nic, queue + Q_TAIL, 0);
	if (!nic->class->advanced) {
		ec_nic_write(nic, queue + Q_DELAY, 0);
		ec_nic_write(nic, queue + Q_DELAY_ABS, 0);
	}
	return enable(nic, queue);
}

/**
 * ec_ring_start() - empty rings for a controller that was reset
 * @nic: controller
 * @tx: transmit ring
 * @rx: receive ring
 *
 * Context: Process. May sleep.
 * Return: 0, -ETIMEDOUT when the controller does not enable a queue.
 */
int ec_ring_start(struct intel_nic *nic, struct intel_ring *tx, struct intel_ring *rx)
{
	unsigned int i;
	int ret;

	for (i = 0; i < INTEL_TX; i++) {
		memset(&tx->desc[i], 0, sizeof(tx->desc[i]));
		if (nic->class->advanced)
			tx->desc[i].a.olinfo = cpu_to_le32(INTEL_A_DONE);
		else
			tx->desc[i].l.status = INTEL_L_DONE;
	}
	for (i = 0; i < INTEL_RX; i++)
		ec_ring_free_rx(rx, i);
	if (nic->class->advanced)
		ec_nic_write(nic, nic->class->rx + Q_SRRCTL, SRRCTL_ADVANCED | SRRCTL_2K);
	ret = set_queue(nic, nic->class->tx, tx, INTEL_TX) ?:
	      set_queue(nic, nic->class->rx, rx, INTEL_RX);
	tx->tail = 0;
	rx->tail = INTEL_RX - 1;
	rx->kept = 0;
	/* one stays with the driver: head and tail alike would mean that there is none */
	ec_nic_write(nic, nic->class->rx + Q_TAIL, rx->tail);
	return ret;
}
