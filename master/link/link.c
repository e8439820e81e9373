// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bitops.h>
#include <linux/errno.h>
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/ratelimit.h>
#include <linux/rcupdate.h>
#include <linux/string.h>
#include "capture.h"
#include "device.h"
#include "links.h"

#define MUTE_NS	(1500 * NSEC_PER_MSEC)	/* without a frame; a measurement takes less */

/**
 * ec_link_init() - prepare a link, without device
 * @link: zeroed structure
 * @l: links it belongs to
 * @side: 0 main, 1 backup
 *
 * Context: Any.
 */
void ec_link_init(struct ec_link *link, struct ec_links *l, u8 side)
{
	link->links = l;
	link->side = side;
	link->places = EC_LINK_ACYCLIC;
}

/**
 * ec_link_trace() - show a frame in the kernel log, debug level 2
 * @link: link
 * @what: "sent" or "received"
 * @data: what follows the EtherType
 * @len: bytes there
 *
 * At most 50 a second: the log is slower than the wire.
 *
 * Context: Any.
 */
void ec_link_trace(const struct ec_link *link, const char *what, const u8 *data, size_t len)
{
	static DEFINE_RATELIMIT_STATE(rate, HZ, 50);

	if (__ratelimit(&rate))
		printk(KERN_DEBUG "EtherCAT %u: %s %s, %zu byte(s): %*ph\n",
		       link->links->base->index,
		       link->side ? "backup" : "main", what, len, (int)min_t(size_t, len, 48),
		       data);
}

/**
 * ec_link_show() - show a sent frame in the kernel log and to capture programs
 * @link: link
 * @dev: its device
 * @frame: the frame
 * @len: its bytes, with padding
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 */
void ec_link_show(struct ec_link *link, struct ecdev *dev, const u8 *frame, size_t len)
{
	struct ec_capture *capture = link->links->capture;

	if (READ_ONCE(link->links->base->debug) >= 2)
		ec_link_trace(link, "sent", frame + EC_ETH_HDR, len - EC_ETH_HDR);
	/* while the link is down no frame leaves */
	if (capture && ec_tap_wanted(&capture->tap) && dev->ops->link_up(dev->priv) &&
	    !ec_capture_sent(capture, frame, len))
		atomic64_inc(&link->stats.not_captured);
}

/**
 * ec_link_send_traced() - let a device send a frame, with a trace event when it has taken it
 * @link: link
 * @dev: its device
 * @buf: the frame, in a buffer of the device
 * @len: its bytes, with padding
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: as struct ecdev_ops.tx_send.
 */
int ec_link_send_traced(const struct ec_link *link, struct ecdev *dev, u8 *buf, size_t len)
{
	/* afterwards the buffer belongs to the device */
	u32 seq = get_unaligned_le32(buf + 8);
	u8 index = buf[EC_ETH_HDR + EC_FRAME_HDR + 1];
	int ret = dev->ops->tx_send(dev->priv, buf, len);

	if (!ret)
		trace_ec_frame_sent(link->links->base->index, link->side, index, seq, len);
	return ret;
}

/*
 * Those of @sides that are up and not mute; all if none is. One that the monitor has seen last as
 * down is read again: a ring that is closed there needs its frames at once.
 */
static u8 live(const struct ec_links *l, u8 sides)
{
	unsigned int i;
	u8 up = 0;

	for (i = 0; i < EC_MAX_LINKS; i++)
		if (sides & BIT(i) && !READ_ONCE(l->link[i].mute) &&
		    (READ_ONCE(l->link[i].up) || ec_link_is_up(&l->link[i])))
			up |= BIT(i);
	return up ?: sides;
}

/** struct leaving - a frame in buffers of the devices that send it */
struct leaving {
	/** @sides: mask of their links */
	u8 sides;
	/** @unsent: mask of links that have refused it */
	u8 unsent;
	/** @full: mask of links without a buffer */
	u8 full;
	/** @err: the last reason */
	int err;
};

/* a link refuses a frame */
static noinline void note_refused(struct leaving *f, unsigned int side, int err)
{
	f->unsent |= BIT(side);
	if (err == -EBUSY)
		f->full |= BIT(side);
	f->err = err;
}

/* one of its links */
static __always_inline void leave_by(struct ec_link *link, struct ecdev *dev, u8 *buf, size_t len,
				     struct leaving *f)
{
	int err = ec_link_send_buf(link, dev, buf, len);

	if (unlikely(err))
		note_refused(f, link->side, err);
}

/* Return: 0: at least one link has sent it; or -errno, the slot is in BUILD again. */
static __always_inline int has_left(struct ec_links *l, struct ec_slot *slot,
				    const struct leaving *f)
{
	/* a frame whose reply was received counts as sent */
	if (unlikely(f->unsent) && ec_slot_disarm(slot, f->unsent))
		return f->err;
	if (unlikely(f->full))
		ec_links_count(l, f->full, tx_errors);
	return 0;
}

/**
 * ec_links_send() - send a frame on several links
 * @l: links
 * @slot: slot in state BUILD, which holds the frame; in BUILD again on failure
 * @sides: mask of the links
 * @now: time
 *
 * A link that is down is skipped while another one is up. One that fails does not stop the others:
 * the slot awaits only the copies of links that have sent the frame. One without transmit buffer
 * counts an error then, since the frame does not wait for it. ec_links_flush() must follow.
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: 0: at least one link has sent it; -ENODEV: no device; -EBUSY: no transmit buffer, not
 * counted as an error, since the frame may wait; -ENETDOWN: the link is down.
 */
int ec_links_send(struct ec_links *l, struct ec_slot *slot, u8 sides, u64 now)
{
	struct leaving f = { .sides = live(l, sides), .err = -ENODEV };
	struct ecdev *dev[EC_MAX_LINKS];
	u8 *buf[EC_MAX_LINKS];
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++) {
		if (!(f.sides & BIT(i)))
			continue;
		buf[i] = ec_link_tx_get(&l->link[i], &dev[i]);
		if (likely(buf[i]))
			continue;
		f.sides &= ~BIT(i);
		if (!dev[i])
			continue;
		f.full |= BIT(i);
		f.err = -EBUSY;
	}
	if (!f.sides)
		return f.err;
	slot->sent = slot->frame;
	ec_slot_arm(&l->slots, slot, slot->frame, f.sides, now);
	for (i = 0; i < EC_MAX_LINKS; i++) {
		if (!(f.sides & BIT(i)))
			continue;
		memcpy(buf[i], slot->frame, ec_slot_padded(slot));
		buf[i][7] |= i;
		leave_by(&l->link[i], dev[i], buf[i], ec_slot_padded(slot), &f);
	}
	return has_left(l, slot, &f);
}

/**
 * ec_links_keep_sent() - may frames of the cycle be built in buffers of the main device in a ring?
 * @l: two links
 *
 * They may if it keeps them, so that the copies can be compared with them: that saves a copy of
 * each frame. By its number a frame is known again. Both links have to work.
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: whether they may, by ec_links_tx_get_both().
 */
bool ec_links_keep_sent(const struct ec_links *l)
{
	const struct ecdev *main = READ_ONCE(l->link[EC_MAIN].dev);	/* may be withdrawn now */

	if (!main || !main->ops->stays || !l->slots.numbered)
		return false;
	return likely(READ_ONCE(l->link[EC_MAIN].up) && READ_ONCE(l->link[EC_BACKUP].up) &&
		      !READ_ONCE(l->link[EC_MAIN].mute) && !READ_ONCE(l->link[EC_BACKUP].mute)) ||
	       live(l, l->sides) == l->sides;
}

/**
 * ec_links_transmit_both() - send a frame on both links of a ring
 * @l: links
 * @slot: the slot is back in BUILD on failure
 * @frame: where it was built: in a buffer of ec_links_tx_get_both()
 * @tx: result of that
 * @now: time
 *
 * Context: The owner of the bus access, in the RCU read section of ec_links_tx_get_both(). RT-safe.
 * Return: as ec_links_send().
 */
int ec_links_transmit_both(struct ec_links *l, struct ec_slot *slot, u8 *frame,
			   const struct ec_tx *tx, u64 now)
{
	size_t len = ec_slot_padded(slot);
	struct leaving f = { 0 };

	slot->sent = frame;
	ec_slot_arm(&l->slots, slot, frame, tx->sides, now);
	memcpy(tx->copy, frame, len);
	tx->copy[7] |= EC_BACKUP;
	leave_by(&l->link[EC_MAIN], tx->dev, frame, len, &f);
	leave_by(&l->link[EC_BACKUP], tx->backup, tx->copy, len, &f);
	return has_left(l, slot, &f);
}

/**
 * ec_link_poll() - deliver what the device has received
 * @link: link
 *
 * Context: The owner of the bus access. RT-safe.
 */
void ec_link_poll(struct ec_link *link)
{
	struct ecdev *dev;

	rcu_read_lock();
	dev = READ_ONCE(link->dev);	/* may be withdrawn now */
	if (dev && dev->ops->poll)
		dev->ops->poll(dev->priv);
	rcu_read_unlock();
}

/**
 * ec_links_poll_each() - ec_links_poll_cycle() with several links
 * @l: links
 *
 * Context: As there.
 */
void ec_links_poll_each(struct ec_links *l)
{
	struct ec_link *link;

	ec_links_for_each(l, link)
		if (l->sides & BIT(link->side))
			ec_link_poll_cycle(link);
}

/**
 * ec_link_is_up() - physical link state
 * @link: link
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false also without device.
 */
bool ec_link_is_up(const struct ec_link *link)
{
	struct ecdev *dev;
	bool up;

	/* the device is freed only after a grace period */
	rcu_read_lock();
	dev = READ_ONCE(link->dev);
	up = dev && dev->ops->link_up(dev->priv);
	rcu_read_unlock();
	return up;
}

/**
 * ec_link_hears() - a link is not mute
 * @link: link
 *
 * Context: The monitor.
 */
void ec_link_hears(struct ec_link *link)
{
	link->missed_ns = 0;
	WRITE_ONCE(link->mute, false);
}

/**
 * ec_link_missed() - a copy of a link has not returned although the link is up
 * @link: link of a ring whose other link works
 *
 * After MUTE_NS without any frame the link is mute.
 *
 * Context: The monitor.
 * Return: whether it is mute from now on.
 */
bool ec_link_missed(struct ec_link *link)
{
	u64 rx = atomic64_read(&link->stats.rx_frames);

	if (!link->missed_ns || rx != link->missed_rx) {
		link->missed_ns = ktime_get_ns();
		link->missed_rx = rx;
	}
	if (READ_ONCE(link->mute) || ktime_get_ns() - link->missed_ns < MUTE_NS)
		return false;
	WRITE_ONCE(link->mute, true);
	return true;
}

/**
 * ec_link_look() - let the device read its link state
 * @link: link
 *
 * Context: Process. May sleep.
 * Return: as ec_link_is_up().
 */
bool ec_link_look(struct ec_link *link)
{
	struct rt_mutex *lock = &link->links->access.lock;

	/* the device stays while the lock is held */
	rt_mutex_lock(lock);
	if (link->dev && link->dev->ops->look)
		link->dev->ops->look(link->dev->priv);
	rt_mutex_unlock(lock);
	return ec_link_is_up(link);
}

/**
 * ec_link_clear_counters() - count from 0 again
 * @link: link; its counters do not change meanwhile
 *
 * The next ec_link_rates_update() resets the averages.
 *
 * Context: Any.
 */
void ec_link_clear_counters(struct ec_link *link)
{
	atomic64_t *counter = (atomic64_t *)&link->stats;
	unsigned int i;

	/* others may read them at this moment */
	for (i = 0; i < sizeof(link->stats) / sizeof(*counter); i++)
		atomic64_set(&counter[i], 0);
	/* the counters before it; pairs with ec_link_rates_update() */
	smp_store_release(&link->rates.restart, true);
}

static void restart_rates(struct ec_link_rates *r)
{
	unsigned int i, j;

	WRITE_ONCE(r->restart, false);
	/* before the counters are read: a clear after that sets @restart again */
	smp_mb();
	memset(r->last, 0, sizeof(r->last));
	for (i = 0; i < ARRAY_SIZE(r->rate); i++)
		for (j = 0; j < EC_UAPI_RATES; j++)
			WRITE_ONCE(r->rate[i][j], 0);
}

/**
 * ec_link_rates_update() - update the averages; called once a second
 * @link: link
 *
 * Context: Process. May sleep.
 */
void ec_link_rates_update(struct ec_link *link)
{
	static const s32 span[EC_UAPI_RATES] = { 1, 10, 60 };
	const struct ec_link_stats *stats = &link->stats;
	struct ec_link_rates *r = &link->rates;
	const atomic64_t *counter[5] = {
		&stats->tx_frames, &stats->rx_frames, &stats->tx_bytes, &stats->rx_bytes,
		&stats->lost,
	};
	unsigned int i, j;

	/* pairs with ec_link_clear_counters() */
	if (smp_load_acquire(&r->restart))
		restart_rates(r);

	for (i = 0; i < ARRAY_SIZE(counter); i++) {
		u64 now = atomic64_read(counter[i]);
		u32 d = (u32)(now - r->last[i]);

		for (j = 0; j < EC_UAPI_RATES; j++) {
			s64 diff = (s64)d - r->rate[i][j];

			/* step of at least 1, else a slow average never arrives */
			diff = div_s64(diff, span[j]) ?: diff > 0 ? 1 : diff < 0 ? -1 : 0;
			WRITE_ONCE(r->rate[i][j], r->rate[i][j] + diff);
		}
		r->last[i] = now;
	}
}
