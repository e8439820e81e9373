// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bitops.h>
#include <linux/errno.h>
#include <linux/math64.h>
#include <linux/ratelimit.h>
#include <linux/rcupdate.h>
#include <linux/string.h>
#include "capture.h"
#include "device.h"
#include "links.h"
#include "pack.h"

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
	ec_gate_init(&link->acyclic, EC_LINK_ACYCLIC);
	ec_gate_init(&link->ring_full, 1);
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
 * ec_link_show() - show a frame that leaves to those who watch
 * @link: link
 * @dev: its device
 * @frame: the frame
 * @len: its bytes, with padding
 *
 * Context: The owner of the link, in an RCU read section. RT-safe.
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

/* Send the frame of an armed slot. */
static int send(struct ec_link *link, struct ec_slot *slot)
{
	struct ecdev *dev;
	u8 *buf = ec_link_tx_get(link, &dev);

	if (!buf)
		return dev ? -EBUSY : -ENODEV;
	memcpy(buf, slot->frame, ec_slot_padded(slot));
	buf[7] |= link->side;
	return ec_link_send_buf(link, dev, buf, ec_slot_padded(slot));
}

/**
 * ec_links_send() - send the frame of an armed slot on its links
 * @l: links
 * @slot: slot in state SENT, which holds the frame
 *
 * ec_links_flush() must follow.
 *
 * Context: The owner of the links, in an RCU read section. RT-safe.
 * Return: 0, -ENODEV without device, -EBUSY without transmit buffer (then no error
 * is counted: whether the frame may wait, the caller knows), -ENETDOWN when the link
 * is down. The first link that fails ends it.
 */
int ec_links_send(struct ec_links *l, struct ec_slot *slot)
{
	unsigned long left = slot->links;
	int ret = 0;

	for (; left && !ret; left &= left - 1)
		ret = send(&l->link[__ffs(left)], slot);
	return ret;
}

/**
 * ec_links_send_pack() - send the frame that callers share
 * @l: links
 * @p: the frame; its slots are let go before it leaves
 * @sent_ns: when it leaves (ktime)
 *
 * ec_links_flush() must follow.
 *
 * Context: The owner of the links, in an RCU read section. RT-safe.
 * Return: as ec_links_send(). The frames stay in the queue when it is -EBUSY.
 */
int ec_links_send_pack(struct ec_links *l, struct ec_pack *p, u64 sent_ns)
{
	struct {
		struct ecdev *dev;
		u8 *buf;
	} tx[EC_MAX_LINKS];
	unsigned long left, links = p->e[0].slot->links;
	size_t len = 0;
	int ret = 0;

	ec_pack_place(&l->slots, p, sent_ns);
	for (left = links; left && !ret; left &= left - 1) {
		unsigned int i = __ffs(left);

		tx[i].buf = ec_link_tx_get(&l->link[i], &tx[i].dev);
		if (!tx[i].buf) {
			ret = tx[i].dev ? -EBUSY : -ENODEV;
			break;
		}
		len = ec_pack_write(p, tx[i].buf);
		if (p->e[0].slot->clock)
			ec_share_stamp(l, tx[i].buf + EC_ETH_HDR, len - EC_ETH_HDR, sent_ns);
		tx[i].buf[7] |= i;
	}
	ec_pack_release(p, ret == -EBUSY ? EC_SLOT_QUEUED : EC_SLOT_SENT);
	if (ret)
		return ret;
	for (left = links; left && !ret; left &= left - 1)
		ret = ec_link_send_buf(&l->link[__ffs(left)], tx[__ffs(left)].dev,
				       tx[__ffs(left)].buf, len);
	if (ret == -EBUSY)
		ec_pack_move(p, EC_SLOT_SENT, EC_SLOT_QUEUED);
	return ret;
}

/**
 * ec_link_set_places() - set how many acyclic frames may be on their way
 * @link: link
 * @cycle: a cyclic caller sends them from a queue, and as many as fit
 *
 * Without a cycle buffers of the device are left for the monitor.
 *
 * Context: Process, with the access lock held.
 */
void ec_link_set_places(struct ec_link *link, bool cycle)
{
	const struct ecdev *dev = link->dev;
	unsigned int n = dev && dev->ops->burst ? dev->ops->burst : EC_LINK_ACYCLIC;

	lockdep_assert_held(&link->links->access.lock);
	ec_gate_set_limit(&link->acyclic, cycle ? EC_LINK_QUEUED :
			  min_t(unsigned int, n, EC_LINK_ACYCLIC));
}

/**
 * ec_link_poll() - deliver what the device has received
 * @link: link
 *
 * Context: The owner of the link. RT-safe.
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
 * ec_links_poll_cycle() - the same for the cycle
 * @l: links
 *
 * Replies to the cycle may stay in the memory of the device: they have to be taken before the
 * links are left and before the RCU read section of the caller ends.
 *
 * Context: The cycle owner, in an RCU read section. RT-safe.
 */
void ec_links_poll_cycle(struct ec_links *l)
{
	struct ec_link *link = &l->link[0];
	struct ecdev *dev = READ_ONCE(link->dev);	/* may be withdrawn now */

	if (!dev || !dev->ops->poll)
		return;
	WRITE_ONCE(link->keep, dev->ops->keeps);
	dev->ops->poll(dev->priv);
	WRITE_ONCE(link->keep, false);
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
 * ec_link_look() - let the device read its link state
 * @link: link
 *
 * Context: Process. May sleep.
 * Return: as ec_link_is_up().
 */
bool ec_link_look(struct ec_link *link)
{
	struct rt_mutex *lock = &link->links->access.lock;

	/* with it the device stays */
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
 * The averages follow with the next ec_link_rates_update().
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
	/* before the counters are read: if they are cleared after that, there is a next time */
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
