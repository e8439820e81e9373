// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include "links.h"
#include "submit.h"

#define TURN_CYCLES	100	/* an acyclic frame has its turn within that many */
#define CLOCK_CYCLES	10	/* and one that sets clocks, which has sent less before it */
#define CLOCK_US	100000	/* or within that time */
#define SLOWEST		4	/* a device that sends at 25 Mbit/s instead of 100 */

/**
 * ec_submit() - send an acyclic frame, now or with the next cycle
 * @l: links
 * @slot: built frame
 * @urgent: before what others have left
 *
 * Context: Process. May sleep on the link's lock.
 * Return: 0, -ENODEV, -ENETDOWN, -EBUSY; the slot is in BUILD on failure.
 */
int ec_submit(struct ec_links *l, struct ec_slot *slot, bool urgent)
{
	u64 now = ktime_get_ns();
	int ret;

	rt_mutex_lock(&l->access.lock);
	if (READ_ONCE(l->access.mode) == EC_ACCESS_DIRECT) {
		rcu_read_lock();
		ret = ec_links_transmit(l, slot, slot->frame, now);
		ec_links_flush(l);
		rcu_read_unlock();
	} else if (!ec_link_is_up(&l->link[0])) {
		ret = -ENETDOWN;
	} else {
		/* the waiter may give up from now on */
		ec_slot_queue(&l->slots, slot, l->carry, now);
		ret = ec_queue_push(&l->queues, slot, urgent);
		if (ret && !ec_slot_disarm(slot))
			ret = 0;
		if (!ret && l->ops && l->ops->queued)
			l->ops->queued(l);
	}
	rt_mutex_unlock(&l->access.lock);
	return ret;
}

/**
 * ec_submit_wait_begin() - how long ec_xfer() waits for its frames
 * @l: links
 * @w: result: all but @polls and @clock
 *
 * With cyclic access frames first wait in the queue, see ec_submit_wait_turn().
 *
 * Context: Any.
 */
void ec_submit_wait_begin(const struct ec_links *l, struct ec_submit_wait *w)
{
	u32 interval_us = ec_access_interval_us(&l->access);
	u32 late_per_s = READ_ONCE(l->share.late_per_s);	/* a takeover may change it */
	u32 turns;

	w->mode = READ_ONCE(l->access.mode);
	w->began_ns = ktime_get_ns();
	w->turn_ns = w->began_ns;
	w->timeout_us = l->io_timeout_us;
	/* half of the limit is for the frames, the rest for what is on its way before them */
	if (w->mode != EC_ACCESS_CYCLIC) {
		w->timeout_us = max_t(u32, w->timeout_us, w->timeout_us / 2 + SLOWEST *
				      atomic_read(&l->link[0].acyclic_ns) / NSEC_PER_USEC);
		return;
	}
	w->turns = TURN_CYCLES;
	if (w->clock)
		w->turns = clamp_t(u32, CLOCK_US / max(interval_us, 1000u), CLOCK_CYCLES,
				   TURN_CYCLES);
	w->timeout_us += w->turns * max(interval_us, 1000u);
	/* the worst: each send carries one of those that wait, every second one is urgent */
	turns = min(2 * (ec_queue_frames(&l->queues) + 1), 2u * EC_SLOTS);
	w->turn_ns += (u64)turns * interval_us * NSEC_PER_USEC;
	/* worse: and only when it may be late */
	if (late_per_s)
		w->turn_ns += (u64)turns * (NSEC_PER_SEC / late_per_s);
}

/**
 * ec_submit_wait_turn() - may frames that are in the queue still be sent?
 * @l: links
 * @w: the wait
 *
 * The timeout of @w starts when they leave the queue. A fatal signal and the loss of the
 * link end the queue wait.
 *
 * Context: Process.
 * Return: whether to wait for that.
 */
bool ec_submit_wait_turn(struct ec_links *l, const struct ec_submit_wait *w)
{
	return ktime_get_ns() < w->turn_ns && READ_ONCE(l->access.mode) == w->mode &&
	       !ec_access_timed_out(l) && !fatal_signal_pending(current) &&
	       ec_link_is_up(&l->link[0]);
}

/**
 * ec_submit_wait_more() - is a wait without reply to be repeated?
 * @l: links
 * @w: the wait
 *
 * It is when the machine stood still meanwhile (a paused VM), when the bus access
 * changed, or when the cycle has polled too rarely. A cycle timeout is noticed here as
 * well: the caller may be the monitor.
 *
 * Context: Process. May sleep.
 * Return: true: the frames have had no fair chance yet.
 */
bool ec_submit_wait_more(struct ec_links *l, const struct ec_submit_wait *w)
{
	if (ktime_get_ns() - w->began_ns > 2ULL * NSEC_PER_USEC * w->timeout_us ||
	    READ_ONCE(l->access.mode) != w->mode)
		return true;
	if (w->mode == EC_ACCESS_DIRECT || READ_ONCE(l->access.polls) - w->polls >= w->turns)
		return false;
	if (ec_access_timed_out(l))
		ec_access_timeout(l);
	return true;
}
