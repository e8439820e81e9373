/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The layer "link": devices, frame slots, sending, bus access. It knows neither slaves nor the
 * callers that wait for a frame.
 */
#ifndef EC_LINKS_H
#define EC_LINKS_H

#include <linux/list.h>
#include <linux/rcupdate.h>
#include <linux/spinlock.h>
#include "ethercat.h"
#include "../base/base.h"
#include "../base/limits.h"
#include "../kernel/trace.h"
#include "access.h"
#include "device.h"
#include "link.h"
#include "ring.h"
#include "slots.h"

struct ec_capture;
struct ec_carry;
struct ec_links;

/** struct ec_links_ops - what the layer reports to higher ones; each may be NULL */
struct ec_links_ops {
	/** @device: a device was attached or detached; may sleep */
	void (*device)(struct ec_links *l, const struct ec_link *link, bool attached);
	/** @changed: the bus access or a device has changed; with the access lock held */
	void (*changed)(struct ec_links *l);
	/** @event: a reply to the cycle has one of struct ec_links.events; RT-safe */
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
	/**
	 * @backup: backup device at the other end of a ring, as the user names it, NULL: none;
	 * changed as @main
	 */
	const char *backup;
	/** @backup_name: memory of @backup */
	char backup_name[EC_UAPI_STRING];
	/**
	 * @exchanged: the device at @backup is the main one of the ring, and that at @main the
	 * backup one, since the cables are exchanged; changed as @main
	 */
	bool exchanged;
	/** @closed: gets no main device, under the device lock */
	bool closed;
	/** @held: gets its main device later, and no other master does; under the device lock */
	bool held;
	/** @link: main and backup */
	struct ec_link link[EC_MAX_LINKS];
	/** @capture: for capture programs, NULL: none; immutable while a device is attached */
	struct ec_capture *capture;
	/**
	 * @sides: mask of the links on which frames are sent; it and @only change while no device
	 * is attached, no slave known and no session open, with the access lock held
	 */
	u8 sides;
	/** @only: the link that carries all of them, NULL: several */
	struct ec_link *only;
	/** @ring: state of the ring, with a backup device */
	struct ec_ring ring;
	/** @slots: frame slots */
	struct ec_slots slots;
	/** @access: bus access */
	struct ec_access access;
	/** @carry: acyclic posts of these links, which the next layer owns; immutable */
	struct ec_carry *carry;
	/** @events: ECAT events to report when a reply has one; the report clears them; 0: none */
	u16 events;
	/** @max_datagrams: datagrams in a frame at most, immutable */
	unsigned int max_datagrams;
	/** @io_timeout_us: after this time a frame counts as lost, immutable */
	unsigned int io_timeout_us;
};

#define ec_links_for_each(l, link) \
	for ((link) = (l)->link; (link) < (l)->link + EC_MAX_LINKS; (link)++)

/* Is a link up on which frames are sent? Its physical state now; false also without device. */
static inline bool ec_links_is_up(const struct ec_links *l)
{
	const struct ec_link *link;

	ec_links_for_each(l, link)
		if (READ_ONCE(l->sides) & BIT(link->side) && ec_link_is_up(link))
			return true;
	return false;
}

/* the same, as last read by the monitor */
static inline bool ec_links_seen_up(const struct ec_links *l)
{
	const struct ec_link *link;

	ec_links_for_each(l, link)
		if (READ_ONCE(l->sides) & BIT(link->side) && READ_ONCE(link->up))
			return true;
	return false;
}

/* the link at the other end of a ring, as last read by the monitor */
static inline bool ec_links_ring_end_up(const struct ec_links *l)
{
	return READ_ONCE(l->link[EC_BACKUP].up);
}

/* one link at least, as last read by the monitor */
static inline bool ec_links_any_up(const struct ec_links *l)
{
	return ec_links_seen_up(l) || ec_links_ring_end_up(l);
}

bool ec_links_one_attached(const struct ec_links *l);

/* a device that sends frames is attached */
static inline bool ec_links_attached(const struct ec_links *l)
{
	const struct ec_link *only = READ_ONCE(l->only);

	return likely(only) ? !!READ_ONCE(only->dev) :
			      READ_ONCE(l->link[EC_MAIN].dev) || ec_links_one_attached(l);
}

static inline bool ec_links_any_device(const struct ec_links *l)
{
	return ec_links_attached(l) || READ_ONCE(l->link[EC_BACKUP].dev);
}

/* number of links that have a name of a device, limit for ec_links_at() */
static inline unsigned int ec_links_n(const struct ec_links *l)
{
	return READ_ONCE(l->backup) ? 2 : 1;
}

/* the link that has the device at one of the two names of the user, 0: that at the main one */
static inline unsigned int ec_links_named(const struct ec_links *l, unsigned int name)
{
	return name ^ READ_ONCE(l->exchanged);
}

static inline const struct ec_link *ec_links_at(const struct ec_links *l, unsigned int i)
{
	return &l->link[i];
}

/**
 * ec_links_enter() - the cycle owner enters the links for one call
 * @l: links
 *
 * After a cycle timeout it makes the access cyclic again. ec_links_leave() must follow.
 *
 * Context: Cycle owner. Sleeps after a cycle timeout only.
 * Return: 0; -ENODEV as ec_access_reenter(): then it must not follow.
 */
static inline int ec_links_enter(struct ec_links *l)
{
	return likely(ec_access_enters(&l->access)) ? 0 : ec_access_reenter(l);
}

static inline void ec_links_leave(struct ec_links *l)
{
	ec_access_leave(&l->access);
}

/* a frame of the cycle that both ends of a ring have sent was received: as expected? RT-safe */
static inline void ec_links_note_ring(struct ec_links *l, const struct ec_slot *slot)
{
	if (unlikely(ec_ring_note(&l->ring, slot)) && l->ops->event)
		l->ops->event(l);
}

/* report ECAT events of the slaves in a reply to the cycle; RT-safe */
static inline void ec_links_events(struct ec_links *l, u16 events)
{
	if (likely(!(events & READ_ONCE(l->events))))
		return;
	WRITE_ONCE(l->events, 0);
	if (l->ops->event)
		l->ops->event(l);
}

/* deliver what the devices have received; for the owner of the bus access, RT-safe */
static inline void ec_links_poll(struct ec_links *l)
{
	struct ec_link *link;

	ec_links_for_each(l, link)
		if (l->sides & BIT(link->side))
			ec_link_poll(link);
}

/* deliver what the device of a link has received, for the cycle; as ec_links_poll_cycle() */
static inline void ec_link_poll_cycle(struct ec_link *link)
{
	struct ecdev *dev = READ_ONCE(link->dev);	/* may be withdrawn now */

	if (!dev || !dev->ops->poll)
		return;
	WRITE_ONCE(link->keep, dev->ops->keeps);
	dev->ops->poll(dev->priv);
	WRITE_ONCE(link->keep, false);
}

/**
 * ec_links_poll_cycle() - deliver what the devices have received, for the cycle
 * @l: links
 *
 * Replies to the cycle may stay in the memory of the device: they have to be taken before the
 * links are left and before the RCU read section of the caller ends.
 *
 * Context: The cycle owner, in an RCU read section. RT-safe.
 */
static inline void ec_links_poll_cycle(struct ec_links *l)
{
	if (likely(l->only))
		ec_link_poll_cycle(l->only);
	else
		ec_links_poll_each(l);
}

/* the device and its next transmit buffer or NULL; for the owner of the bus access, RT-safe */
static inline u8 *ec_link_tx_get(const struct ec_link *link, struct ecdev **dev)
{
	RCU_LOCKDEP_WARN(!rcu_read_lock_held(), "frame built outside of an RCU read section");
	*dev = READ_ONCE(link->dev);	/* may be withdrawn now */
	return *dev ? (*dev)->ops->tx_get((*dev)->priv) : NULL;
}

/** struct ec_tx - where a frame is built and leaves */
struct ec_tx {
	/** @link: its link, NULL: several */
	struct ec_link *link;
	/** @dev: device of @link; it stays in the RCU read section */
	struct ecdev *dev;
	/** @sides: mask of the links */
	u8 sides;
	/** @backup: device of the backup link, for a frame of both that is built for @dev */
	struct ecdev *backup;
	/** @copy: and its buffer */
	u8 *copy;
};

/**
 * ec_links_tx_get() - a transmit buffer in which a frame may be built
 * @l: links
 * @sides: mask of those on which it is to be sent
 * @tx: result, for ec_links_transmit()
 *
 * The next frame that is sent has to be the one built here.
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: EC_ETH_MAX bytes. NULL: the frame has to be built in its slot, since it leaves on
 * several links, or the device is full or absent, which ec_links_transmit() will return.
 */
static __always_inline u8 *ec_links_tx_get(struct ec_links *l, u8 sides, struct ec_tx *tx)
{
	tx->sides = sides;
	tx->link = l->only;
	if (unlikely(!tx->link || sides != l->sides))
		tx->link = is_power_of_2(sides) ? &l->link[__ffs(sides)] : NULL;
	return tx->link ? ec_link_tx_get(tx->link, &tx->dev) : NULL;
}

bool ec_links_keep_sent(const struct ec_links *l);

/**
 * ec_links_tx_get_both() - a transmit buffer in which a frame may be built for both ends of a ring
 * @l: two links, for which ec_links_keep_sent() has returned true
 * @tx: result, for ec_links_transmit_both()
 *
 * The next frame that is sent has to be the one built here.
 *
 * Context: The owner of the bus access, in the RCU read section of ec_links_keep_sent(). RT-safe.
 * Return: EC_ETH_MAX bytes in the main device. NULL: the frame has to be built in its slot, and
 * ec_links_transmit() sends it, on the links that can.
 */
static inline u8 *ec_links_tx_get_both(struct ec_links *l, struct ec_tx *tx)
{
	u8 *frame = ec_link_tx_get(&l->link[EC_MAIN], &tx->dev);

	tx->copy = ec_link_tx_get(&l->link[EC_BACKUP], &tx->backup);
	return tx->copy ? frame : NULL;
}

int ec_links_transmit_both(struct ec_links *l, struct ec_slot *slot, u8 *frame,
			   const struct ec_tx *tx, u64 now);

/**
 * ec_ring_way() - on which link does an acyclic datagram reach its slave?
 * @l: links
 * @cmd: enum ec_cmd
 * @adp: low half of its address: for a command by position that of the closed ring
 *
 * Behind a break the slave next to it has the position 0, so a datagram by position has only one
 * way, as has one that gives the time of the reference clock to others. Others go both ways.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the links, and what its address on these differs by.
 */
static inline struct ec_ring_way ec_ring_way(const struct ec_links *l, u8 cmd, u16 adp)
{
	return likely(READ_ONCE(l->only)) ? (struct ec_ring_way){ .sides = BIT(EC_MAIN) } :
					    ec_ring_find_way(&l->ring, cmd, adp);
}

void ec_links_lost(struct ec_links *l, const struct ec_slot *slot, unsigned long sides);

/* count a frame on the links of a mask: late, or tx_errors */
#define ec_links_count(l, sides, what) \
	ec_links_count_at(l, sides, offsetof(struct ec_link_stats, what))
void ec_links_count_at(struct ec_links *l, unsigned long sides, size_t counter);

/* frames sent since the devices were attached */
static inline u64 ec_links_sent(const struct ec_links *l)
{
	const struct ec_link *link;
	u64 n = 0;

	ec_links_for_each(l, link)
		n += atomic64_read(&link->stats.tx_frames);
	return n;
}

/* wire time of the acyclic frames in flight, on the link with the largest */
static inline u32 ec_links_acyclic_ns(const struct ec_links *l)
{
	const struct ec_link *link;
	u32 ns = 0;

	ec_links_for_each(l, link)
		ns = max_t(u32, ns, atomic_read(&link->acyclic_ns));
	return ns;
}

/* acyclic frames in flight, on the link with the most */
static inline unsigned int ec_links_acyclic(const struct ec_links *l)
{
	const struct ec_link *link;
	unsigned int n = 0;

	ec_links_for_each(l, link)
		n = max_t(unsigned int, n, atomic_read(&link->acyclic));
	return n;
}

/* frames that may be sent in a row beside a cycle */
static inline unsigned int ec_links_burst(const struct ec_links *l)
{
	unsigned int n = EC_SLOTS;
	const struct ec_link *link;

	ec_links_for_each(l, link) {
		/* ecdev_withdraw() may run now; it waits until the cycle owner leaves */
		const struct ecdev *dev = READ_ONCE(link->dev);

		if (dev && dev->ops->burst)
			n = min(n, dev->ops->burst);
	}
	return n;
}

/**
 * ec_link_send_buf() - send a frame that was written to a buffer of the device
 * @link: link
 * @dev: its device
 * @buf: the buffer
 * @len: bytes of the frame, with padding
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: as ec_links_send().
 */
static __always_inline int ec_link_send_buf(struct ec_link *link, struct ecdev *dev, u8 *buf,
					    size_t len)
{
	const struct ec_links *l = link->links;
	int ret;

	if (unlikely(READ_ONCE(l->base->debug) >= 2 || l->capture))
		ec_link_show(link, dev, buf, len);
	ret = trace_ec_frame_sent_enabled() ? ec_link_send_traced(link, dev, buf, len) :
					      dev->ops->tx_send(dev->priv, buf, len);
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
 * @tx: result of that
 * @now: time
 *
 * ec_links_flush() must follow.
 *
 * Context: The owner of the bus access, in the RCU read section of ec_links_tx_get(). RT-safe.
 * Return: as ec_links_send().
 */
static __always_inline int ec_links_transmit(struct ec_links *l, struct ec_slot *slot, u8 *frame,
					     const struct ec_tx *tx, u64 now)
{
	int ret;

	if (unlikely(frame == slot->frame))
		return ec_links_send(l, slot, tx->sides, now);
	ec_slot_arm(&l->slots, slot, frame, tx->sides, now);
	frame[7] |= tx->link->side;
	ret = ec_link_send_buf(tx->link, tx->dev, frame, ec_slot_padded(slot));
	/* a frame whose reply was received counts as sent */
	return unlikely(ret) && ec_slot_disarm(slot, tx->sides) ? ret : 0;
}

/**
 * ec_links_flush() - let the devices send a batch of frames
 * @l: links
 *
 * One doorbell for all frames of a cycle. Must follow each batch, also when its last frame
 * failed.
 *
 * Context: The owner of the bus access, in an RCU read section that has begun before the first
 * frame. RT-safe.
 */
static inline void ec_links_flush(struct ec_links *l)
{
	const struct ec_link *link;

	RCU_LOCKDEP_WARN(!rcu_read_lock_held(), "frames flushed outside of an RCU read section");
	ec_links_for_each(l, link) {
		struct ecdev *dev = READ_ONCE(link->dev);	/* may be withdrawn now */

		if (dev && dev->ops->tx_flush)
			dev->ops->tx_flush(dev->priv);
	}
}

int ec_links_init(struct ec_links *l, struct ec_base *base, const struct ec_links_ops *ops,
		  const char *main, const char *backup);
void ec_links_exit(struct ec_links *l);
void ec_links_set_backup(struct ec_links *l, const char *name);
const char *ec_links_name(struct ec_links *l, unsigned int i, char *buf, size_t size);
bool ec_links_need_thread(const struct ec_links *l);
bool ec_links_look(struct ec_links *l);
void ec_links_update_rates(struct ec_links *l);
void ec_links_saw(struct ec_links *l, u32 slaves, u32 al_states);

#endif
