// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include "../boundary/api.h"
#include "cycle.h"
#include "../link/device.h"
#include "../master.h"
#include "../base/once64.h"
#include "../link/pack.h"
#include "../link/queue.h"
#include "../session/session.h"

#define TURN_CYCLES	100	/* an acyclic frame has its turn within that many */
#define CLOCK_CYCLES	10	/* and one that sets clocks, which has sent less before it */
#define CLOCK_US	100000	/* or within that time */
#define FLUSH_WAITS	200	/* for room in the transmit ring: 20 ms at least */
#define SLOWEST		4	/* a device that sends at 25 Mbit/s instead of 100 */

/* owner of the links -------------------------------------------------------*/

static void own_devices(struct ec_master *m, bool cycle)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++) {
		struct ecdev *dev = m->link[i].dev;

		if (dev && dev->ops->cycle)
			dev->ops->cycle(dev->priv, cycle);
	}
}

/* Nobody shall wait for a frame that was not sent. */
static void disarm(struct ec_slot *slot, u64 now)
{
	if (ec_slot_cancel(slot, now))
		atomic_set_release(&slot->state, EC_SLOT_BUILD);
}

/**
 * ec_cycle_transmit() - send a built frame
 * @m: master
 * @slot: the slot is back in BUILD on failure
 * @now: time
 *
 * Context: The owner of the links. RT-safe.
 * Return: as ec_link_send().
 */
int ec_cycle_transmit(struct ec_master *m, struct ec_slot *slot, u64 now)
{
	struct ec_link *link = &m->link[0];
	int ret;

	ec_slot_arm(&m->slots, slot, link->side, now);
	WRITE_ONCE(slot->left, slot->seq);
	ret = ec_link_send(link, slot);
	if (ret)
		disarm(slot, now);
	return ret;
}

/*
 * What was left in the queue goes out now. When a send fails the waiter runs
 * into its time limit: the slot is his, not ours.
 */
static void flush(struct ec_master *m, struct ec_queue *q)
{
	static const struct ec_pack_room none;
	struct ec_queued next;
	struct ec_pack pack;
	unsigned int waits = 0;

	lockdep_assert_held(&m->io_lock);
	while (ec_queue_peek(m, q, &next)) {
		ec_queue_gather(m, q, &next, &none, &pack);
		if (pack.n && ec_link_send_pack(&m->link[0], &pack, ktime_get_ns()) == -EBUSY &&
		    waits++ < FLUSH_WAITS) {
			usleep_range(100, 200);
			continue;
		}
		ec_queue_drop(m, q, &next, 1);
	}
}

/**
 * ec_cycle_own() - hand the links to the cyclic caller or back to everybody
 * @m: master
 * @owner: new owner
 *
 * Waits until the cyclic caller has left the links.
 *
 * Context: Process. May sleep.
 * Return: whether they had another owner before.
 */
bool ec_cycle_own(struct ec_master *m, enum ec_owner owner)
{
	bool change;

	rt_mutex_lock(&m->io_lock);
	change = m->owner != owner;
	if (change) {
		ec_write64(&m->last_send_ns, ktime_get_ns());
		WRITE_ONCE(m->owner, owner);
		smp_mb();	/* owner before cycle_busy; pairs with enter() */
		while (owner == EC_OWNER_IDLE && atomic_read(&m->cycle_busy))
			usleep_range(20, 50);
		own_devices(m, owner == EC_OWNER_CYCLE);
		ec_link_set_places(&m->link[0], owner == EC_OWNER_CYCLE);
		if (owner == EC_OWNER_IDLE) {
			flush(m, &m->xq);
			flush(m, &m->cq);
		}
	}
	rt_mutex_unlock(&m->io_lock);
	return change;
}

/**
 * ec_cycle_enter() - the cyclic caller takes the links for one call
 * @m: master
 *
 * Reclaims them after a stall.
 *
 * Context: The master's single cyclic caller. Sleeps after a stall only.
 */
void ec_cycle_enter(struct ec_master *m)
{
	for (;;) {
		atomic_set(&m->cycle_busy, 1);
		smp_mb();	/* cycle_busy before owner; pairs with ec_cycle_own() */
		if (READ_ONCE(m->owner) == EC_OWNER_CYCLE)
			return;
		atomic_set(&m->cycle_busy, 0);
		ec_cycle_own(m, EC_OWNER_CYCLE);
	}
}

/**
 * ec_cycle_try_enter() - take the links for one call, or say why not
 * @m: master
 *
 * For a caller that must not sleep. While the links are entered the active session
 * stays: deactivation waits for the caller in ec_cycle_own().
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -EBUSY somebody else is in them; -EAGAIN they were taken back after a
 * stall: somebody who may sleep has to call ec_cycle_own().
 */
int ec_cycle_try_enter(struct ec_master *m)
{
	if (atomic_cmpxchg(&m->cycle_busy, 0, 1))
		return -EBUSY;
	smp_mb();	/* cycle_busy before owner; pairs with ec_cycle_own() */
	if (READ_ONCE(m->owner) == EC_OWNER_CYCLE)
		return 0;
	ec_cycle_leave(m);
	return -EAGAIN;
}

void ec_cycle_leave(struct ec_master *m)
{
	atomic_set_release(&m->cycle_busy, 0);
}

/**
 * ec_cycle_stalled() - has the cyclic caller stopped sending?
 * @m: master in cycle mode
 *
 * Context: Process.
 * Return: true after max(10 periods, 20 ms) without a send.
 */
bool ec_cycle_stalled(struct ec_master *m)
{
	s64 limit = max_t(s64, 10LL * m->interval_us * NSEC_PER_USEC, 20 * NSEC_PER_MSEC);

	/* it may send between the two readings of the clock */
	return (s64)(ktime_get_ns() - ec_read64(&m->last_send_ns)) > limit;
}

/**
 * ec_cycle_wait_begin() - how long ec_xfer() waits for its frames
 * @m: master
 * @w: all but @polls and @clock is set
 *
 * In cycle mode frames first wait for their turn, see ec_cycle_wait_turn().
 *
 * Context: Any.
 */
void ec_cycle_wait_begin(const struct ec_master *m, struct ec_cycle_wait *w)
{
	u32 late_per_s = READ_ONCE(m->late_per_s);	/* a takeover may change it */
	u32 turns;

	w->owner = READ_ONCE(m->owner);
	w->began_ns = ktime_get_ns();
	w->turn_ns = w->began_ns;
	w->timeout_us = m->io_timeout_us;
	/* half of the limit is for the frames, the rest for what is on its way before them */
	if (w->owner != EC_OWNER_CYCLE) {
		w->timeout_us = max_t(u32, w->timeout_us, w->timeout_us / 2 + SLOWEST *
				      atomic_read(&m->link[0].acyclic_ns) / NSEC_PER_USEC);
		return;
	}
	w->turns = TURN_CYCLES;
	if (w->clock)
		w->turns = clamp_t(u32, CLOCK_US / max(m->interval_us, 1000u), CLOCK_CYCLES,
				   TURN_CYCLES);
	w->timeout_us += w->turns * max(m->interval_us, 1000u);
	/* the worst: each send carries one of those that wait, every second one is urgent */
	turns = min(2 * (ec_queue_frames(m) + 1), 2u * EC_SLOTS);
	w->turn_ns += (u64)turns * m->interval_us * NSEC_PER_USEC;
	/* worse: and only when it may be late */
	if (late_per_s)
		w->turn_ns += (u64)turns * (NSEC_PER_SEC / late_per_s);
}

/**
 * ec_cycle_wait_turn() - may frames that are still in the queue have their turn yet?
 * @m: master
 * @w: the wait
 *
 * They have all the time limit of @w when they have left. A fatal signal and the loss
 * of the link end the queue wait.
 *
 * Context: Process.
 * Return: whether it is worth waiting for.
 */
bool ec_cycle_wait_turn(struct ec_master *m, const struct ec_cycle_wait *w)
{
	return ktime_get_ns() < w->turn_ns && READ_ONCE(m->owner) == w->owner &&
	       !ec_cycle_stalled(m) && !fatal_signal_pending(current) &&
	       ec_link_is_up(&m->link[0]);
}

/**
 * ec_cycle_wait_more() - does a wait that ended in vain count?
 * @m: master
 * @w: the wait
 *
 * It does not when the machine stood still meanwhile (a paused VM), when the
 * links changed hands, or when the cycle has hardly looked for frames. Links
 * whose cyclic caller has stalled are taken back: the monitor may be waiting,
 * too.
 *
 * Context: Process. May sleep.
 * Return: true: the frames have had no fair chance yet.
 */
bool ec_cycle_wait_more(struct ec_master *m, const struct ec_cycle_wait *w)
{
	if (ktime_get_ns() - w->began_ns > 2ULL * NSEC_PER_USEC * w->timeout_us ||
	    READ_ONCE(m->owner) != w->owner)
		return true;
	if (w->owner == EC_OWNER_IDLE || READ_ONCE(m->polls) - w->polls >= w->turns)
		return false;
	if (ec_cycle_stalled(m))
		ec_session_stalled(m);
	return true;
}

/**
 * ec_cycle_look() - have overdue frames arrived unnoticed?
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_cycle_look(struct ec_master *m)
{
	rt_mutex_lock(&m->io_lock);
	/* a cyclic caller looks himself */
	if (READ_ONCE(m->owner) == EC_OWNER_IDLE)
		ec_link_poll(&m->link[0]);
	rt_mutex_unlock(&m->io_lock);
	/* without a poll function an interrupt thread delivers */
	usleep_range(200, 500);
}

/**
 * ec_cycle_submit() - send an acyclic frame, now or with the next cycle
 * @m: master
 * @slot: built frame
 * @urgent: before what others have left
 *
 * Context: Process. May sleep on the link's lock.
 * Return: 0, -ENODEV, -ENETDOWN, -EBUSY; the slot is in BUILD on failure.
 */
int ec_cycle_submit(struct ec_master *m, struct ec_slot *slot, bool urgent)
{
	u64 now = ktime_get_ns();
	int ret;

	rt_mutex_lock(&m->io_lock);
	if (READ_ONCE(m->owner) == EC_OWNER_IDLE) {
		ret = ec_cycle_transmit(m, slot, now);
	} else if (!ec_link_is_up(&m->link[0])) {
		ret = -ENETDOWN;
	} else {
		/* the waiter may give up from now on */
		ec_slot_arm(&m->slots, slot, 0, now);
		ret = ec_queue_push(m, slot, urgent);
		if (ret)
			disarm(slot, now);
		else
			ec_api_left(m);
	}
	rt_mutex_unlock(&m->io_lock);
	return ret;
}

/**
 * ec_cycle_slack_ns() - wire time that a cycle leaves for acyclic frames
 * @m: master
 *
 * A tenth of the interval is kept free: the next send may be early.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns; ~0 while nobody runs a cycle.
 */
u32 ec_cycle_slack_ns(const struct ec_master *m)
{
	u64 budget = READ_ONCE(m->interval_us) * 900ULL;
	u32 used = READ_ONCE(m->cycle_wire_ns);

	if (READ_ONCE(m->owner) != EC_OWNER_CYCLE)
		return ~0u;
	return budget > used ? min_t(u64, budget - used, ~0u) : 0;
}

/**
 * ec_cycle_room() - data of one acyclic datagram that fits before the next
 *	cyclic send
 * @m: master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, at least what a minimum Ethernet frame holds.
 */
u16 ec_cycle_room(const struct ec_master *m)
{
	u32 bytes = ec_cycle_slack_ns(m) / 80;

	/* what ec_frame_wire_ns() adds, and the headers */
	bytes -= min(bytes, 8u + 4 + 12 + EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD);
	return clamp_t(u32, bytes, EC_ROOM_MIN, EC_DGRAM_DATA_MAX);
}

/*
 * May a frame that does not fit go nevertheless, and make the next cycle late?
 * So many times a second, evenly: then also a full wire carries acyclic frames.
 */
static bool may_be_late(struct ec_master *m)
{
	u32 per_s = READ_ONCE(m->late_per_s);
	u64 now = ktime_get_ns();

	if (!per_s || now < m->late_next_ns)
		return false;
	m->late_next_ns = now + NSEC_PER_SEC / per_s;
	WRITE_ONCE(m->late_cycles, m->late_cycles + 1);
	return true;
}

/*
 * Send the frame @next, and with it what else fits. Returns its wire time; 0: no more can
 * be sent, it stays the first.
 */
static u32 send_next(struct ec_master *m, struct ec_queue *q, const struct ec_queued *next,
		     u32 wire_ns)
{
	struct ec_pack_room room;
	struct ec_pack pack;
	u32 frame_ns;

	ec_share_room(m, q, wire_ns, &room);
	ec_queue_gather(m, q, next, &room, &pack);
	if (!pack.n)
		return 0;	/* given up meanwhile: the next send goes on */
	frame_ns = ec_frame_wire_ns(EC_ETH_HDR + pack.len);
	/* behind what this cycle has sent before */
	if (ec_link_send_pack(&m->link[0], &pack, m->last_send_ns + wire_ns) == -EBUSY)
		return 0;
	ec_queue_drop(m, q, pack.e, pack.n);
	ec_share_sent(m, q, frame_ns);
	return frame_ns;
}

/**
 * ec_cycle_send_left() - send what others have left, as far as it fits before
 *	the next cycle; see ecrt_master_set_late_cycles() for what does not
 * @m: master
 * @wire_ns: wire time this cycle has used
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_cycle_send_left(struct ec_master *m, u32 wire_ns)
{
	const struct ecdev *dev = READ_ONCE(m->link[0].dev);
	struct ec_queued next;
	struct ec_queue *q;
	unsigned int n, burst;
	u32 frame_ns;

	/* one that comes at this moment has time until the next cycle */
	if (!ec_queue_frames(m))
		return;
	/* it may be withdrawn now; who does that waits for us before it goes */
	if (!dev)
		return;
	burst = dev->ops->burst ?: EC_SLOTS;
	/* the next cycle needs transmit buffers, too */
	for (n = 0; n < burst && (q = ec_share_next(m, &next)); n++) {
		if (!ec_share_fits(m, wire_ns, ec_frame_wire_ns(next.slot->eth_len)) &&
		    (m->share.frames || !may_be_late(m)))
			break;
		frame_ns = send_next(m, q, &next, wire_ns);
		if (!frame_ns)
			break;
		wire_ns += frame_ns;
	}
}

/**
 * ec_cycle_send_between() - send what others have left, between two cycles
 * @m: master whose links are entered
 *
 * Nothing is sent when the next cycle is so near that even one frame might be in
 * its way; what is left goes with it.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_cycle_send_between(struct ec_master *m)
{
	u64 since = ktime_get_ns() - ec_read64(&m->last_send_ns);

	if (since + ec_frame_wire_ns(EC_ETH_MAX) < m->interval_us * 900ULL)
		ec_cycle_send_left(m, since);
}
