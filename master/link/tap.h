/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies of frames for capture programs, off the cycle's path. */
#ifndef EC_TAP_H
#define EC_TAP_H

#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/workqueue.h>

#define EC_TAP_RING	512	/* frames; power of 2 */

struct ec_tap_frame;
struct net_device;

/**
 * struct ec_tap - frames on their way to the capture programs of an interface
 * @nd: the interface
 * @lock: protects @head and @dropped
 * @head: next to be filled, by the sender or receiver of the frame
 * @tail: next to be shown, by the worker
 * @shown: frames shown
 * @bytes: of these
 * @dropped: frames that found the ring full, or no memory
 * @work: shows the content of the ring
 * @ring: frames
 */
struct ec_tap {
	struct net_device *nd;
	raw_spinlock_t lock;
	unsigned int head;
	unsigned int tail;
	aligned_u64 shown;
	aligned_u64 bytes;
	aligned_u64 dropped;
	struct work_struct work;
	struct ec_tap_frame *ring;
};

int ec_tap_init(struct ec_tap *t, struct net_device *nd);
void ec_tap_exit(struct ec_tap *t);
bool ec_tap_sent(struct ec_tap *t, const u8 *frame, size_t len);
bool ec_tap_received(struct ec_tap *t, const u8 *src, const u8 *data, size_t len);

#endif
