/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies of frames for capture programs, off the cycle's path. */
#ifndef EC_TAP_H
#define EC_TAP_H

#include <linux/netdevice.h>
#include <linux/rculist.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include <net/net_namespace.h>

#define EC_TAP_RING	512	/* frames; power of 2 */
#define EC_TAP_MS	8	/* between two runs of the worker; the timer adds a tick */

struct ec_tap_frame;

/** struct ec_tap - copies of frames for the capture programs of an interface */
struct ec_tap {
	/** @nd: the interface */
	struct net_device *nd;
	/** @lock: protects @head, @awake and @dropped */
	raw_spinlock_t lock;
	/** @head: next to be filled, by the sender or receiver of the frame */
	unsigned int head;
	/** @tail: next to be shown, by the worker */
	unsigned int tail;
	/** @shown: frames shown */
	aligned_u64 shown;
	/** @bytes: of these */
	aligned_u64 bytes;
	/** @dropped: frames that found the ring full, or no memory */
	aligned_u64 dropped;
	/** @awake: @work runs or is scheduled */
	bool awake;
	/** @work: shows the content of the ring, periodically while a program captures */
	struct delayed_work work;
	/** @ring: frames */
	struct ec_tap_frame *ring;
};

/**
 * ec_tap_wanted() - may a program capture at the interface?
 * @t: tap
 *
 * dev_nit_active() is true for a packet socket in any network namespace, and every user can open
 * one in a new namespace, which gets no frame from here. So it is called only with a handler at
 * this interface, or a packet socket in the namespace of the interface.
 *
 * Context: Any, in an RCU read section. RT-safe.
 * Return: false when no program does.
 */
static __always_inline bool ec_tap_wanted(const struct ec_tap *t)
{
	struct net_device *nd = t->nd;

	RCU_LOCKDEP_WARN(!rcu_read_lock_held(), "the namespace may go away");
	if (likely(list_empty(&nd->ptype_all) && hlist_empty(&dev_net(nd)->packet.sklist)))
		return false;
	return netif_running(nd) && dev_nit_active(nd);
}

int ec_tap_init(struct ec_tap *t, struct net_device *nd);
void ec_tap_exit(struct ec_tap *t);
bool ec_tap_sent(struct ec_tap *t, const u8 *frame, size_t len);
bool ec_tap_received(struct ec_tap *t, const u8 *src, const u8 *data, size_t len);

#endif
