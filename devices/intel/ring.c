// SPDX-License-Identifier: GPL-2.0-only
/*
 * The controller writes to descriptors that are done, so that the cycle reads memory and no
 * register. It knows of new ones by a write to the tail: one for all frames of a burst, and
 * one for each RX_BATCH received frames.
 */
#include <linux/dma-mapping.h>
#include <linux/errno.h>
#include <linux/iopoll.h>
#include "regs.h"
#include "ring.h"

#define RX_BATCH	8
#define QUEUE_US	10000

/* legacy descriptor, transmit: data sheet of the 82574, 7.2.10.1; receive: 7.1.4 */
struct legacy {
	__le64 addr;
	__le16 len;
	u8 tx_cso;
	u8 tx_command;
	u8 status;
	u8 rx_errors;
	__le16 special;
};

/* legacy, receive: the checksum stands where cso and command of a transmit descriptor are */
#define L_DONE		BIT(0)
#define L_END		BIT(1)
#define L_COMMAND	(BIT(0) | BIT(1) | BIT(3))	/* end of packet, add FCS, report */

/* advanced descriptor: data sheet of the 82576, 7.2.2.3 (transmit), 7.1.5 (receive) */
struct advanced {
	union {
		__le64 addr;
		__le32 word[2];
	};
	__le32 command_status;	/* transmit: command and length; receive: status and errors */
	__le32 olinfo;		/* transmit: status; receive: length in the low half */
};

#define A_DONE		BIT(0)
#define A_END		BIT(1)
#define A_ERRORS	GENMASK(31, 24)
/* data descriptor, otherwise as L_COMMAND */
#define A_COMMAND	(3 << 20 | BIT(29) | BIT(24) | BIT(25) | BIT(27))
#define A_PAYLOAD	14

union intel_desc {
	struct legacy l;
	struct advanced a;
};

static dma_addr_t buf_dma(const struct intel_ring *r, unsigned int i)
{
	return r->buf_dma + i * INTEL_BUF;
}

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

static void free_rx(const struct intel_nic *nic, struct intel_ring *rx, unsigned int i)
{
	union intel_desc *d = &rx->desc[i];

	d->a.addr = cpu_to_le64(buf_dma(rx, i));
	/* advanced: the second word is an address, too, when it is given to the controller */
	d->a.command_status = 0;
	d->a.olinfo = 0;
}

static bool tx_done(const struct intel_nic *nic, const union intel_desc *d)
{
	if (nic->class->advanced)
		return le32_to_cpu(READ_ONCE(d->a.olinfo)) & A_DONE;
	return READ_ONCE(d->l.status) & L_DONE;
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
			tx->desc[i].a.olinfo = cpu_to_le32(A_DONE);
		else
			tx->desc[i].l.status = L_DONE;
	}
	for (i = 0; i < INTEL_RX; i++)
		free_rx(nic, rx, i);
	if (nic->class->advanced)
		ec_nic_write(nic, nic->class->rx + Q_SRRCTL, SRRCTL_ADVANCED | SRRCTL_2K);
	ret = set_queue(nic, nic->class->tx, tx, INTEL_TX) ?:
	      set_queue(nic, nic->class->rx, rx, INTEL_RX);
	tx->tail = 0;
	rx->tail = INTEL_RX - 1;
	/* one stays with the driver: head and tail alike would mean that there is none */
	ec_nic_write(nic, nic->class->rx + Q_TAIL, rx->tail);
	return ret;
}

/**
 * ec_ring_tx_get() - the buffer that is next in turn
 * @nic: controller
 * @tx: transmit ring
 *
 * Context: One sender at a time. RT-safe.
 * Return: buffer of INTEL_BUF bytes, or NULL while the controller owns it.
 */
u8 *ec_ring_tx_get(const struct intel_nic *nic, const struct intel_ring *tx)
{
	unsigned int next = (tx->next + 1) % INTEL_TX;

	/* the one behind it, too: a tail that meets the head would mean an empty ring */
	if (!tx_done(nic, &tx->desc[tx->next]) || !tx_done(nic, &tx->desc[next]))
		return NULL;
	return tx->buf + tx->next * INTEL_BUF;
}

/**
 * ec_ring_tx_put() - give the buffer to the controller with the next ec_ring_tx_flush()
 * @nic: controller
 * @tx: transmit ring
 * @len: bytes of the frame without FCS
 *
 * Context: One sender at a time. RT-safe.
 */
void ec_ring_tx_put(const struct intel_nic *nic, struct intel_ring *tx, size_t len)
{
	union intel_desc *d = &tx->desc[tx->next];

	d->a.addr = cpu_to_le64(buf_dma(tx, tx->next));
	if (nic->class->advanced) {
		d->a.command_status = cpu_to_le32(A_COMMAND | len);
		d->a.olinfo = cpu_to_le32(len << A_PAYLOAD);
	} else {
		d->l.len = cpu_to_le16(len);
		d->l.tx_cso = 0;
		d->l.tx_command = L_COMMAND;
		d->l.status = 0;
	}
	tx->next = (tx->next + 1) % INTEL_TX;
}

/**
 * ec_ring_tx_flush() - let the controller send what it was given
 * @nic: controller
 * @tx: transmit ring
 *
 * Context: One sender at a time. RT-safe.
 * Return: false: there was nothing to send.
 */
bool ec_ring_tx_flush(const struct intel_nic *nic, struct intel_ring *tx)
{
	if (tx->tail == tx->next)
		return false;
	tx->tail = tx->next;
	/* writel() orders the descriptors before it */
	ec_nic_write(nic, nic->class->tx + Q_TAIL, tx->tail);
	return true;
}

/**
 * ec_ring_rx_get() - the frame that is next in turn
 * @nic: controller
 * @rx: receive ring
 * @len: result: its bytes without FCS; 0: a frame with errors
 *
 * Context: One receiver at a time. RT-safe.
 * Return: the frame, to give back with ec_ring_rx_put(); NULL: none has come.
 */
const u8 *ec_ring_rx_get(const struct intel_nic *nic, const struct intel_ring *rx, size_t *len)
{
	const union intel_desc *d = &rx->desc[rx->next];
	bool good;

	if (nic->class->advanced) {
		u32 status = le32_to_cpu(READ_ONCE(d->a.command_status));

		if (!(status & A_DONE))
			return NULL;
		dma_rmb();
		good = status & A_END && !(status & A_ERRORS);
		*len = le32_to_cpu(d->a.olinfo) & 0xffff;
	} else {
		u8 status = READ_ONCE(d->l.status);

		if (!(status & L_DONE))
			return NULL;
		dma_rmb();
		good = status & L_END && !d->l.rx_errors;
		*len = le16_to_cpu(d->l.len);
	}
	if (!good || *len > INTEL_BUF)
		*len = 0;
	return rx->buf + rx->next * INTEL_BUF;
}

/**
 * ec_ring_rx_put() - give the frame's buffer back
 * @nic: controller
 * @rx: receive ring
 *
 * Context: One receiver at a time. RT-safe.
 */
void ec_ring_rx_put(const struct intel_nic *nic, struct intel_ring *rx)
{
	unsigned int i = rx->next;

	free_rx(nic, rx, i);
	rx->next = (i + 1) % INTEL_RX;
	if (rx->next % RX_BATCH)
		return;
	rx->tail = i;
	ec_nic_write(nic, nic->class->rx + Q_TAIL, i);
}
