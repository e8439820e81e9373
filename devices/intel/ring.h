/* SPDX-License-Identifier: GPL-2.0-only */
/* Transmit and receive ring of an Intel network controller, polled. */
#ifndef EC_INTEL_RING_H
#define EC_INTEL_RING_H

#include <linux/pci.h>
#include "nic.h"

#define INTEL_TX	256	/* buffers; more than a cycle and others send at once */
#define INTEL_RX	256
#define INTEL_BUF	2048

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
};

int ec_ring_alloc(struct device *dev, struct intel_ring *tx, struct intel_ring *rx);
int ec_ring_start(struct intel_nic *nic, struct intel_ring *tx, struct intel_ring *rx);
u8 *ec_ring_tx_get(const struct intel_nic *nic, const struct intel_ring *tx);
void ec_ring_tx_put(const struct intel_nic *nic, struct intel_ring *tx, size_t len);
bool ec_ring_tx_flush(const struct intel_nic *nic, struct intel_ring *tx);
const u8 *ec_ring_rx_get(const struct intel_nic *nic, const struct intel_ring *rx, size_t *len);
void ec_ring_rx_put(const struct intel_nic *nic, struct intel_ring *rx);

#endif
