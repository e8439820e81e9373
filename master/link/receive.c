// SPDX-License-Identifier: GPL-2.0-only
#include "capture.h"
#include "links.h"
#include "receive.h"
#include "xfer.h"

/**
 * ec_receive() - a frame has arrived on a link
 * @link: link
 * @src: source MAC address
 * @data: what follows the EtherType
 * @len: bytes there
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_receive(struct ec_link *link, const u8 *src, const u8 *data, size_t len)
{
	struct ec_links *l = link->links;
	struct ec_matched got;

	atomic64_inc(&link->stats.rx_frames);
	atomic64_add(len + EC_ETH_HDR, &link->stats.rx_bytes);
	if (unlikely(READ_ONCE(l->base->debug) >= 2))
		ec_link_trace(link, "received", data, len);
	if (unlikely(!ec_capture_received(l->capture, src, data, len)))
		atomic64_inc(&link->stats.not_captured);
	switch (ec_slots_match(&l->slots, src, data, len, &got)) {
	case EC_MATCH_DONE:
		while (got.n)
			ec_xfer_done(got.xfer[--got.n]);
		break;
	case EC_MATCH_LATE:
		atomic64_inc(&link->stats.late);
		break;
	case EC_MATCH_UNMATCHED:
		atomic64_inc(&link->stats.unmatched);
		break;
	}
}
