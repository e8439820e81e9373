/* SPDX-License-Identifier: GPL-2.0-only */
/* What a sender leaves to its network card: checksums and TCP segments. */
#ifndef EC_SIM_OFFLOAD_H
#define EC_SIM_OFFLOAD_H

#include <linux/virtio_net.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OFFLOAD_MAX	(65536 + 64)	/* frame of a sender that leaves segmentation to its card */

/**
 * struct offload - a frame of which the segments are taken one by one
 * @len: bytes of the frame, 0: there is none
 * @l3: where its IP header begins
 * @l4: where its TCP header begins
 * @head: where its data begin
 * @at: where the data of the next segment begin
 * @size: data of a segment, 0: the frame is no TCP segment
 * @frame: the frame
 */
struct offload {
	size_t len;
	size_t l3;
	size_t l4;
	size_t head;
	size_t at;
	size_t size;
	uint8_t frame[OFFLOAD_MAX];
};

bool offload_begin(struct offload *o, size_t len, const struct virtio_net_hdr *h);
size_t offload_next(struct offload *o, uint8_t *buf, size_t cap);

#endif
