/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Transmit and receive ring of an Intel network controller, polled.
 *
 * The controller writes to descriptors that are done, so that the cycle reads memory and no
 * register. It knows of new ones by a write to the tail: one for all frames of a burst, and
 * one for INTEL_RX_BATCH received frames.
 */
#ifndef EC_INTEL_RING_H
#define EC_INTEL_RING_H

#include <linux/pci.h>
#include "nic.h"
#include "regs.h"

#define INTEL_TX	256	/* buffers; more than a cycle and others send at once */
#define INTEL_RX	512	/* what two polls take, see ec_ring_rx_put(), and more */
#define INTEL_BUF	2048
#define INTEL_RX_BATCH	8

/* legacy descriptor, transmit: data sheet of the 82574, 7.2.10.1; receive: 7.1.4 */
struct intel_legacy {
	__le64 addr;
	__le16 len;
	u8 tx_cso;
	u8 tx_command;
	u8 status;
	u8 rx_errors;
	__le16 special;
};

/* legacy, receive: the checksum stands where cso and command of a transmit descriptor are */
#define INTEL_L_DONE		BIT(0)
#define INTEL_L_END		BIT(1)
#define INTEL_L_COMMAND	(BIT(0) | BIT(1) | BIT(3))	/* end of packet, add FCS, report */

/* advanced descriptor: data sheet of the 82576, 7.2.2.3 (transmit), 7.1.5 (receive) */
struct intel_advanced {
	union {
		__le64 addr;
		__le32 word[2];
	};
	__le32 command_status;	/* transmit: command and length; receive: status and errors */
	__le32 olinfo;		/* transmit: status; receive: length in the low half */
};

#define INTEL_A_DONE		BIT(0)
#define INTEL_A_END		BIT(1)
#define INTEL_A_ERRORS	GENMASK(31, 24)
/* data descriptor, otherwise as INTEL_L_COMMAND */
#define INTEL_A_COMMAND	(3 << 20 | BIT(29) | BIT(24) | BIT(25) | BIT(27))
#define INTEL_A_PAYLOAD	14

union intel_desc {
	struct intel_legacy l;
	struct intel_advanced a;
};

/**
 * struct intel_ring - descriptors and their buffers, all of it memory for DMA
 */
struct intel_ring {
	/** @desc: descriptors of 16 bytes */
	union intel_desc *desc;
	/** @desc_dma: where the controller finds them */
	dma_addr_t desc_dma;
	/** @buf: buffers of INTEL_BUF bytes */
	u8 *buf;
	/** @buf_dma: where the controller finds them */
	dma_addr_t buf_dma;
	/** @next: descriptor that is next in turn */
	unsigned int next;
	/** @tail: tail that the controller knows */
	unsigned int tail;
	/** @kept: receive: oldest descriptor that was taken and not given back; @next: none */
	unsigned int kept;
};

int ec_ring_alloc(struct device *dev, struct intel_ring *tx, struct intel_ring *rx);
int ec_ring_start(struct intel_nic *nic, struct intel_ring *tx, struct intel_ring *rx);

static inline dma_addr_t ec_ring_buf_dma(const struct intel_ring *r, unsigned int i)
{
	return r->buf_dma + i * INTEL_BUF;
}

static inline bool ec_ring_tx_done(const struct intel_nic *nic, const union intel_desc *d)
{
	if (nic->class->advanced)
		return le32_to_cpu(READ_ONCE(d->a.olinfo)) & INTEL_A_DONE;
	return READ_ONCE(d->l.status) & INTEL_L_DONE;
}

static inline u8 *ec_ring_tx_buf(const struct intel_ring *tx)
{
	return tx->buf + tx->next * INTEL_BUF;
}

/**
 * ec_ring_tx_get() - the buffer that is next in turn
 * @nic: controller
 * @tx: transmit ring
 *
 * Context: One sender at a time, in an RCU read section, for which a start of the ring waits: it
 * would make the buffer another one's. RT-safe.
 * Return: buffer of INTEL_BUF bytes, or NULL while the controller owns it.
 */
static inline u8 *ec_ring_tx_get(const struct intel_nic *nic, const struct intel_ring *tx)
{
	unsigned int next = (tx->next + 1) % INTEL_TX;

	/*
	 * The one behind it, which is done later: a tail that meets the head would mean an empty
	 * ring.
	 */
	if (!ec_ring_tx_done(nic, &tx->desc[next]))
		return NULL;
	return ec_ring_tx_buf(tx);
}

/**
 * ec_ring_tx_put() - give a buffer to the controller with the next ec_ring_tx_flush()
 * @nic: controller
 * @tx: transmit ring
 * @len: bytes of the frame without FCS, in the buffer of ec_ring_tx_get()
 *
 * Context: One sender at a time, in the RCU read section of ec_ring_tx_get(). RT-safe.
 */
static inline void ec_ring_tx_put(const struct intel_nic *nic, struct intel_ring *tx, size_t len)
{
	union intel_desc *d = &tx->desc[tx->next];

	d->a.addr = cpu_to_le64(ec_ring_buf_dma(tx, tx->next));
	if (nic->class->advanced) {
		d->a.command_status = cpu_to_le32(INTEL_A_COMMAND | len);
		WRITE_ONCE(d->a.olinfo, cpu_to_le32(len << INTEL_A_PAYLOAD));
	} else {
		d->l.len = cpu_to_le16(len);
		d->l.tx_cso = 0;
		d->l.tx_command = INTEL_L_COMMAND;
		WRITE_ONCE(d->l.status, 0);
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
static inline bool ec_ring_tx_flush(const struct intel_nic *nic, struct intel_ring *tx)
{
	if (tx->tail == tx->next)
		return false;
	WRITE_ONCE(tx->tail, tx->next);
	/* writel() orders the descriptors before it */
	ec_nic_write(nic, nic->class->tx + Q_TAIL, tx->tail);
	return true;
}

static inline void ec_ring_free_rx(struct intel_ring *rx, unsigned int i)
{
	union intel_desc *d = &rx->desc[i];

	d->a.addr = cpu_to_le64(ec_ring_buf_dma(rx, i));
	/* advanced: the second word is an address, too, when it is given to the controller */
	d->a.command_status = 0;
	d->a.olinfo = 0;
}

/**
 * ec_ring_rx_get() - take the frame that is next in turn
 * @nic: controller
 * @rx: receive ring
 * @len: result: its bytes without FCS; 0: a frame with errors
 *
 * Context: One receiver at a time. RT-safe.
 * Return: the frame, which stays until ec_ring_rx_put(); NULL: none has come, or there are no
 * more buffers, whatever the controller says.
 */
static inline const u8 *ec_ring_rx_get(const struct intel_nic *nic, struct intel_ring *rx,
				       size_t *len)
{
	const union intel_desc *d = &rx->desc[rx->next];
	unsigned int next = (rx->next + 1) % INTEL_RX;
	const u8 *frame;
	bool good;

	if (next == rx->kept)
		return NULL;
	if (nic->class->advanced) {
		u32 status = le32_to_cpu(READ_ONCE(d->a.command_status));

		if (!(status & INTEL_A_DONE))
			return NULL;
		dma_rmb();
		good = status & INTEL_A_END && !(status & INTEL_A_ERRORS);
		*len = le32_to_cpu(READ_ONCE(d->a.olinfo)) & 0xffff;
	} else {
		u8 status = READ_ONCE(d->l.status);

		if (!(status & INTEL_L_DONE))
			return NULL;
		dma_rmb();
		good = status & INTEL_L_END && !d->l.rx_errors;
		*len = le16_to_cpu(READ_ONCE(d->l.len));
	}
	if (!good || *len > INTEL_BUF)
		*len = 0;
	frame = rx->buf + rx->next * INTEL_BUF;
	rx->next = next;
	return frame;
}

/**
 * ec_ring_rx_put() - give back the buffers of all frames that were taken, before the next poll
 * @nic: controller
 * @rx: receive ring
 *
 * Context: One receiver at a time. RT-safe.
 */
static inline void ec_ring_rx_put(const struct intel_nic *nic, struct intel_ring *rx)
{
	unsigned int i = rx->kept;

	if (i == rx->next)
		return;
	for (; i != rx->next; i = (i + 1) % INTEL_RX)
		ec_ring_free_rx(rx, i);
	rx->kept = i;
	if ((i - 1 - rx->tail) % INTEL_RX < INTEL_RX_BATCH)
		return;
	rx->tail = (i - 1) % INTEL_RX;
	ec_nic_write(nic, nic->class->rx + Q_TAIL, rx->tail);
}

#endif
