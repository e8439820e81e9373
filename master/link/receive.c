// SPDX-License-Identifier: GPL-2.0-only
#include <linux/export.h>
#include <linux/rcupdate.h>
#include "capture.h"
#include "device.h"
#include "links.h"
#include "pack.h"
#include "xfer.h"

/* Apart, for its large result. */
static noinline enum ec_match receive_pack(struct ec_links *l, const u8 *src, const u8 *data,
					   size_t len)
{
	struct ec_pack_matched got;
	enum ec_match what = ec_pack_match(&l->slots, src, data, len, &got);

	while (got.n)
		ec_xfer_done(got.xfer[--got.n]);
	return what;
}

static __always_inline void receive(struct ec_link *link, const u8 *src, const u8 *data,
				    size_t len)
{
	struct ec_links *l = link->links;
	struct ec_matched got = { };

	atomic64_inc(&link->stats.rx_frames);
	atomic64_add(len + EC_ETH_HDR, &link->stats.rx_bytes);
	if (unlikely(READ_ONCE(l->base->debug) >= 2))
		ec_link_trace(link, "received", data, len);
	if (unlikely(l->capture) && !ec_capture_received(l->capture, src, data, len))
		atomic64_inc(&link->stats.not_captured);
	if (unlikely(src[1] & EC_PACKED))
		got.what = receive_pack(l, src, data, len);
	else
		got = ec_slots_match(&l->slots, src, data, len, READ_ONCE(link->keep));
	if (got.xfer)
		ec_xfer_done(got.xfer);
	if (unlikely(got.what == EC_MATCH_LATE))
		atomic64_inc(&link->stats.late);
	else if (unlikely(got.what == EC_MATCH_UNMATCHED))
		atomic64_inc(&link->stats.unmatched);
}

/**
 * ecdev_receive() - deliver a received EtherCAT frame
 * @dev: device
 * @src: source MAC address
 * @data: what follows the EtherType; not changed
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_receive(struct ecdev *dev, const u8 *src, const u8 *data, size_t len)
{
	struct ec_link *link = rcu_dereference(dev->link);

	if (link)
		receive(link, src, data, len);
}
EXPORT_SYMBOL_GPL(ecdev_receive);

/**
 * ecdev_awaits() - are replies to frames awaited that do not belong to the cycle?
 * @dev: device
 *
 * A device without interrupts polls for them while no cycle runs. A frame counts from
 * before it is sent until its sender has the reply or has given it up.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether they are.
 */
bool ecdev_awaits(struct ecdev *dev)
{
	const struct ec_link *link;
	bool ret;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	ret = link && ec_links_acyclic_ns(link->links);
	rcu_read_unlock();
	return ret;
}
EXPORT_SYMBOL_GPL(ecdev_awaits);
