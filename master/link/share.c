// SPDX-License-Identifier: GPL-2.0-only
/*
 * What one cyclic send carries of the acyclic frames is limited, so that its execution time
 * is: frames per millisecond of cycle, clock frames among them, frames in all, and half of the
 * free wire time. Short frames of several callers leave as one.
 */
#include <linux/ktime.h>
#include <linux/minmax.h>
#include <linux/module.h>
#include "../base/once64.h"
#include "../wire/regs.h"
#include "device.h"
#include "links.h"
#include "pack.h"

unsigned int ec_share_max = 64;

static int set_max(const char *value, const struct kernel_param *kp)
{
	return param_set_uint_minmax(value, kp, 1, EC_LINK_QUEUED);
}

static const struct kernel_param_ops max_ops = {
	.set = set_max,
	.get = param_get_uint,
};

module_param_cb(max_acyclic, &max_ops, &ec_share_max, 0644);
MODULE_PARM_DESC(max_acyclic, "Most acyclic frames that one cyclic send carries, 1 to 192 (64)");

/**
 * ec_share_clock_bytes() - how long clock frames may be to leave as often as they may
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of datagrams, with their headers, of one frame.
 */
u16 ec_share_clock_bytes(const struct ec_links *l)
{
	u32 frames = max(1u, ec_access_interval_us(&l->access) * EC_SHARE_CLOCKS_PER_MS / 1000);
	u32 bytes = ec_access_slack_ns(l) / 2 / frames / 80;

	/* what ec_frame_wire_ns() adds, and the headers */
	bytes -= min(bytes, 8u + 4 + 12 + EC_ETH_HDR + EC_FRAME_HDR);
	return min_t(u32, bytes, EC_FRAME_BODY_MAX);
}

/*
 * The queue of the frame to send next, NULL: none may be sent. Clock frames and others take
 * turns, as long as there is credit for clocks.
 */
static struct ec_queue *next_frame(struct ec_links *l, struct ec_queued *next)
{
	u32 most = clamp(ec_access_interval_us(&l->access) * EC_SHARE_PER_MS / 1000, 1u,
			 READ_ONCE(ec_share_max));
	struct ec_queues *qs = &l->queues;
	bool clocks = l->share.clock_credit >= 1000;

	if (l->share.frames >= most)
		return NULL;
	if (clocks && !l->share.clock_last && ec_queue_peek(qs, &qs->clock, next))
		return &qs->clock;
	if (ec_queue_peek(qs, &qs->acyclic, next))
		return &qs->acyclic;
	return clocks && ec_queue_peek(qs, &qs->clock, next) ? &qs->clock : NULL;
}

/*
 * A single frame may take all wire time before the next cycle; more of them share half of
 * what the cycle leaves.
 */
static bool fits(struct ec_links *l, u32 used_ns, u32 frame_ns)
{
	u64 budget = ec_access_interval_us(&l->access) * 900ULL;

	if (used_ns + (u64)frame_ns > budget)
		return false;
	return !l->share.frames || 2ull * (l->share.wire_ns + frame_ns) <= ec_access_slack_ns(l);
}

/* What a frame may hold that callers share; clock frames leave alone. */
static void find_room(const struct ec_links *l, const struct ec_queue *q, u32 used_ns,
		      struct ec_pack_room *room)
{
	u32 budget = ec_access_interval_us(&l->access) * 900, half = ec_access_slack_ns(l) / 2;
	u32 ns = min(budget - min(budget, used_ns), half - min(half, l->share.wire_ns));
	/* what ec_frame_wire_ns() adds, and the header */
	u32 bytes = ns / 80 - min(ns / 80, 8u + 4 + 12 + EC_ETH_HDR);

	room->len = min_t(u32, bytes, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	room->dgrams = q == &l->queues.clock ? 0 : l->max_datagrams;
}

static void count(struct ec_links *l, const struct ec_queue *q, u32 frame_ns)
{
	l->share.frames++;
	l->share.wire_ns += frame_ns;
	l->share.clock_last = q == &l->queues.clock;
	if (l->share.clock_last)
		l->share.clock_credit -= 1000;
}

/*
 * May a frame that does not fit go nevertheless, and make the next cycle late?
 * So many times a second, evenly: then also a full wire carries acyclic frames.
 */
static bool may_be_late(struct ec_links *l)
{
	u32 per_s = READ_ONCE(l->share.late_per_s);
	u64 now = ktime_get_ns();

	if (!per_s || now < l->share.late_next_ns)
		return false;
	l->share.late_next_ns = now + NSEC_PER_SEC / per_s;
	WRITE_ONCE(l->share.late_cycles, l->share.late_cycles + 1);
	return true;
}

/*
 * Send the frame @next, and with it what else fits. Returns its wire time; 0: no more can
 * be sent, it stays the first.
 */
static u32 send_next(struct ec_links *l, struct ec_queue *q, const struct ec_queued *next,
		     u32 wire_ns)
{
	struct ec_pack_room room;
	struct ec_pack pack;
	u32 frame_ns;

	find_room(l, q, wire_ns, &room);
	ec_queue_gather(&l->queues, q, next, &room, &pack);
	if (!pack.n)
		return 0;	/* given up meanwhile: the next send goes on */
	frame_ns = ec_frame_wire_ns(EC_ETH_HDR + pack.len);
	/* behind what this cycle has sent before */
	if (ec_links_send_pack(l, &pack, ec_read64(&l->access.last_send_ns) + wire_ns) == -EBUSY)
		return 0;
	count(l, q, frame_ns);
	return frame_ns;
}

/**
 * ec_share_send_left() - send what others have left, as far as it fits before
 *	the next cycle; see ecrt_master_set_late_cycles() for what does not
 * @l: links; ec_links_flush() must follow
 * @wire_ns: wire time this cycle has used
 *
 * Context: The master's single cyclic caller, in an RCU read section. RT-safe.
 */
void ec_share_send_left(struct ec_links *l, u32 wire_ns)
{
	const struct ecdev *dev = READ_ONCE(l->link[0].dev);
	struct ec_queued next;
	struct ec_queue *q;
	unsigned int n, burst;
	u32 frame_ns;

	if (READ_ONCE(l->posts.n_ready))
		ec_posts_fill(l);
	/* one that comes at this moment has time until the next cycle */
	if (!ec_queue_frames(&l->queues))
		return;
	/* ecdev_withdraw() may run now; it waits for the cycle owner before the device goes */
	if (!dev)
		return;
	burst = dev->ops->burst ?: EC_SLOTS;
	/* the next cycle needs transmit buffers, too */
	for (n = 0; n < burst && (q = next_frame(l, &next)); n++) {
		if (!fits(l, wire_ns, ec_frame_wire_ns(next.slot->eth_len)) &&
		    (l->share.frames || !may_be_late(l)))
			break;
		frame_ns = send_next(l, q, &next, wire_ns);
		if (!frame_ns)
			break;
		wire_ns += frame_ns;
	}
}

/**
 * ec_share_send_between() - send what others have left, between two cycles
 * @l: links, entered
 *
 * Nothing is sent when the next cycle is so near that even one frame might be in
 * its way; what is left goes with it.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_share_send_between(struct ec_links *l)
{
	u64 since = ktime_get_ns() - ec_read64(&l->access.last_send_ns);

	if (since + ec_frame_wire_ns(EC_ETH_MAX) < ec_access_interval_us(&l->access) * 900ULL) {
		rcu_read_lock();
		ec_share_send_left(l, since);
		ec_links_flush(l);
		rcu_read_unlock();
	}
}

/**
 * ec_share_stamp() - write the time of the reference clock into a clock frame that leaves
 * @l: links
 * @frame: EtherCAT header and datagrams
 * @len: bytes
 * @sent_ns: when it leaves (ktime)
 *
 * If the reference clock does not reply, the other clocks take the time that was sent with a
 * drift compensation datagram: one that has waited in the queue would slow them down.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_share_stamp(const struct ec_links *l, u8 *frame, size_t len, u64 sent_ns)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	u8 time[8];

	if (!l->share.ref_minus_ktime || ec_frame_iter_init(&it, frame, len))
		return;
	put_unaligned_le64(atomic64_read(l->share.ref_minus_ktime) + sent_ns, time);
	while (ec_frame_iter_next(&it, &d) == 1)
		if (d.cmd == EC_CMD_FRMW && d.ado == EC_REG_DC_SYSTIME && d.len <= sizeof(time))
			memcpy(d.data, time, d.len);
}
