/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The layer "link": devices, frame slots, bus access, ec_xfer(). It knows no slave and
 * no session.
 */
#ifndef EC_LINKS_H
#define EC_LINKS_H

#include <linux/list.h>
#include <linux/rcupdate.h>
#include <linux/spinlock.h>
#include "ethercat.h"
#include "../base/base.h"
#include "../base/limits.h"
#include "access.h"
#include "device.h"
#include "link.h"
#include "post.h"
#include "queue.h"
#include "rider.h"
#include "share.h"
#include "slots.h"

struct ec_capture;
struct ec_links;
struct task_struct;

/** struct ec_links_ops - what the layer reports to higher ones; each may be NULL */
struct ec_links_ops {
	/** @device: a device was attached, or detached and its link is left; may sleep */
	void (*device)(struct ec_links *l, const struct ec_link *link, bool attached);
	/** @queued: an acyclic frame waits for the cycle; with the access lock held */
	void (*queued)(struct ec_links *l);
	/** @event: a frame of the cycle has brought an event that is watched for; RT-safe */
	void (*event)(struct ec_links *l);
};

/** struct ec_links - links of a master and all that uses them */
struct ec_links {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @ops: immutable */
	const struct ec_links_ops *ops;
	/** @list: links of all masters, under the device lock */
	struct list_head list;
	/** @main: name of the main device; changed with the device lock and @main_lock held */
	char main[EC_UAPI_STRING];
	/** @main_lock: for readers of @main and of the name of an attached device */
	raw_spinlock_t main_lock;
	/** @backup: backup device as the module parameters name it, NULL: none; immutable */
	const char *backup;
	/** @closed: gets no main device, under the device lock */
	bool closed;
	/** @link: main and backup */
	struct ec_link link[EC_MAX_LINKS];
	/** @capture: interface for capture programs, NULL: none; immutable while devices are there */
	struct ec_capture *capture;
	/** @carry: mask of the links that carry frames, immutable */
	u8 carry;
	/** @only: the link that carries all of them, NULL: several; immutable */
	struct ec_link *only;
	/** @slots: frame slots */
	struct ec_slots slots;
	/** @access: bus access */
	struct ec_access access;
	/** @queues: acyclic frames that wait for the cycle */
	struct ec_queues queues;
	/** @riders: datagrams in frames of the cycle */
	struct ec_riders riders;
	/** @posts: acyclic datagrams that no thread waits for */
	struct ec_posts posts;
	/** @share: what a cyclic send carries of @queues */
	struct ec_share share;
	/** @events: ECAT events that are reported at once, once; 0: none */
	u16 events;
	/** @monitor: thread whose frames overtake those of other callers, NULL: none */
	const struct task_struct *monitor;
	/** @max_datagrams: of a frame, immutable */
	unsigned int max_datagrams;
	/** @io_timeout_us: after that a frame counts as lost, immutable */
	unsigned int io_timeout_us;
};

/* physical state of the way to the slaves, now; false also without device */
static inline bool ec_links_is_up(const struct ec_links *l)
{
	return ec_link_is_up(&l->link[0]);
}

/* the same, as the monitor saw it last */
static inline bool ec_links_seen_up(const struct ec_links *l)
{
	return READ_ONCE(l->link[0].up);
}

/* the link at the other end of a ring, as the monitor saw it last */
static inline bool ec_links_ring_end_up(const struct ec_links *l)
{
	return READ_ONCE(l->link[1].up);
}

/* one link at least, as the monitor saw it last */
static inline bool ec_links_any_up(const struct ec_links *l)
{
	return ec_links_seen_up(l) || ec_links_ring_end_up(l);
}

/* a device that sends frames is attached */
static inline bool ec_links_attached(const struct ec_links *l)
{
	return READ_ONCE(l->link[0].dev);
}

static inline bool ec_links_any_device(const struct ec_links *l)
{
	return ec_links_attached(l) || READ_ONCE(l->link[1].dev);
}

/* links that the module parameters name; numbers of ec_links_at() are below */
static inline unsigned int ec_links_n(const struct ec_links *l)
{
	return l->backup ? 2 : 1;
}

static inline const struct ec_link *ec_links_at(const struct ec_links *l, unsigned int i)
{
	return &l->link[i];
}

/**
 * ec_links_enter() - the cycle owner takes the links for one call; ends with ec_links_leave()
 * @l: links
 *
 * Takes cyclic access again after a cycle timeout.
 *
 * Context: Cycle owner. Sleeps after a cycle timeout only.
 */
static inline void ec_links_enter(struct ec_links *l)
{
	if (unlikely(!ec_access_enters(&l->access)))
		ec_access_reenter(l);
}

static inline void ec_links_leave(struct ec_links *l)
{
	ec_access_leave(&l->access);
}

/* the events of all slaves that a frame of the cycle has brought; RT-safe */
static inline void ec_links_events(struct ec_links *l, u16 events)
{
	if (likely(!(events & READ_ONCE(l->events))))
		return;
	WRITE_ONCE(l->events, 0);
	if (l->ops->event)
		l->ops->event(l);
}

/* deliver what the devices have received; the owner of the links, RT-safe */
static inline void ec_links_poll(struct ec_links *l)
{
	ec_link_poll(&l->link[0]);
}

/* the device and its next transmit buffer; NULL without one; the owner of the link, RT-safe */
static inline u8 *ec_link_tx_get(const struct ec_link *link, struct ecdev **dev)
{
	RCU_LOCKDEP_WARN(!rcu_read_lock_held(), "frame built outside of an RCU read section");
	*dev = READ_ONCE(link->dev);	/* may be withdrawn now */
	return *dev ? (*dev)->ops->tx_get((*dev)->priv) : NULL;
}

/**
 * ec_links_tx_get() - a transmit buffer in which a frame may be built
 * @l: links
 *
 * The next frame that is sent has to be this one.
 *
 * Context: The owner of the links, in an RCU read section. RT-safe.
 * Return: EC_ETH_MAX bytes; NULL when frames leave on several links, or the device is full or
 * absent: the frame is built in its slot, and ec_links_transmit() finds out.
 */
static inline u8 *ec_links_tx_get(const struct ec_links *l)
{
	struct ecdev *dev;

	return l->only ? ec_link_tx_get(l->only, &dev) : NULL;
}

/* count a frame of the cycle: lost, late, or tx_errors */
#define ec_links_count(l, what)	atomic64_inc(&(l)->link[0].stats.what)

/* frames sent since the device was attached */
static inline u64 ec_links_sent(const struct ec_links *l)
{
	return atomic64_read(&l->link[0].stats.tx_frames);
}

/* acyclic frames in the queue and on their way, and the wire time of them */
static inline unsigned int ec_links_acyclic_frames(const struct ec_links *l)
{
	return READ_ONCE(l->link[0].acyclic.used);
}

static inline u32 ec_links_acyclic_ns(const struct ec_links *l)
{
	return atomic_read(&l->link[0].acyclic_ns);
}

/**
 * ec_link_send_buf() - send a frame that was written to a buffer of the device
 * @link: link
 * @dev: its device
 * @buf: the buffer
 * @len: bytes of the frame, with padding
 *
 * Context: The owner of the link, in an RCU read section. RT-safe.
 * Return: as ec_links_send().
 */
static __always_inline int ec_link_send_buf(struct ec_link *link, struct ecdev *dev, u8 *buf,
					    size_t len)
{
	const struct ec_links *l = link->links;
	int ret;

	if (unlikely(READ_ONCE(l->base->debug) >= 2 || l->capture))
		ec_link_show(link, dev, buf, len);
	ret = dev->ops->tx_send(dev->priv, buf, len);
	if (likely(!ret)) {
		atomic64_inc(&link->stats.tx_frames);
		atomic64_add(len, &link->stats.tx_bytes);
	} else if (ret != -EBUSY) {
		atomic64_inc(&link->stats.tx_errors);
	}
	return ret;
}

/**
 * ec_links_transmit() - send a built frame
 * @l: links
 * @slot: the slot is back in BUILD on failure
 * @frame: where it was built: in the slot, or in a buffer of ec_links_tx_get()
 * @now: time
 *
 * ec_links_flush() must follow.
 *
 * Context: The owner of the links, in an RCU read section. RT-safe.
 * Return: as ec_links_send().
 */
static inline int ec_links_transmit(struct ec_links *l, struct ec_slot *slot, u8 *frame, u64 now)
{
	int ret;

	ec_slot_arm(&l->slots, slot, frame, l->carry, now);
	if (frame == slot->frame) {
		ret = ec_links_send(l, slot);
	} else {
		struct ecdev *dev = READ_ONCE(l->only->dev);	/* withdrawn at the most */

		frame[7] |= l->only->side;
		ret = dev ? ec_link_send_buf(l->only, dev, frame, ec_slot_padded(slot)) : -ENODEV;
	}
	/* a reply that came nevertheless makes it a frame as if it was sent */
	return ret && ec_slot_disarm(slot) ? ret : 0;
}

/**
 * ec_links_flush() - a batch of frames has ended: let the devices send them
 * @l: links
 *
 * One doorbell for all frames of a cycle. Must follow each batch, also when its last frame
 * failed.
 *
 * Context: The owner of the links, in an RCU read section that has begun before the first frame.
 * RT-safe.
 */
static inline void ec_links_flush(struct ec_links *l)
{
	unsigned int i;

	RCU_LOCKDEP_WARN(!rcu_read_lock_held(), "frames flushed outside of an RCU read section");
	for (i = 0; i < EC_MAX_LINKS; i++) {
		struct ecdev *dev = READ_ONCE(l->link[i].dev);	/* may be withdrawn now */

		if (dev && dev->ops->tx_flush)
			dev->ops->tx_flush(dev->priv);
	}
}

/* has anybody left acyclic frames for the next send? */
static inline bool ec_links_have_left(const struct ec_links *l)
{
	return READ_ONCE(l->posts.n_ready) || ec_queue_frames(&l->queues);
}

int ec_links_init(struct ec_links *l, struct ec_base *base, const struct ec_links_ops *ops,
		  const char *main, const char *backup);
void ec_links_exit(struct ec_links *l);
const char *ec_links_name(struct ec_links *l, unsigned int i, char *buf, size_t size);
bool ec_links_need_thread(const struct ec_links *l);
bool ec_links_look(struct ec_links *l);
void ec_links_update_rates(struct ec_links *l);
void ec_links_saw(struct ec_links *l, u32 slaves, u32 al_states);

#endif
