// SPDX-License-Identifier: GPL-2.0-only
/*
 * While all is well a look of the monitor only finds that: the reply of the rider is as before,
 * no slave has changed and there is no event. A timer in hard interrupt sees this without a switch
 * to the monitor and sends the rider again. For all else, and for what needs a thread, it wakes
 * the monitor.
 */
#include <linux/sched.h>
#include "boundary/master.h"
#include "link/access.h"
#include "quiet.h"
#include "kernel/compat.h"
#include "wire/event_ring.h"
#include "clock/dc_app.h"

#define LOOKS	49	/* of the timer, between two of the monitor: the rates need one a second */

static u64 frames_missed(const struct ec_links *l)
{
	const struct ec_link *link;
	u64 n = 0;

	ec_links_for_each(l, link)
		n += atomic64_read(&link->stats.lost) + atomic64_read(&link->stats.late);
	return n;
}

static bool is_reply_as_before(const struct ec_quiet *q)
{
	const struct ec_rider *r = &q->m->rider;

	return ec_rider_is_back(r) && r->back == q->count && r->wkc >= q->survey->replying &&
	       get_unaligned_le16(r->data) == q->survey->state &&
	       !(r->irq & q->events);
}

static bool is_quiet(struct ec_quiet *q)
{
	struct ec_master *m = q->m;

	return ktime_get_ns() < q->until_ns && is_reply_as_before(q) &&
	       (u32)atomic_read(&m->bus.changes) == q->changes &&
	       ec_event_ring_head(&m->base->events.ring) == q->event &&
	       frames_missed(&m->links) == q->missed && !ec_dc_due(&m->dc) &&
	       !ec_dc_app_due(&m->dc) &&
	       ec_access_is_cyclic(&m->links.access) && !ec_access_timed_out(&m->links);
}

static enum hrtimer_restart timer_looks(struct hrtimer *timer)
{
	struct ec_quiet *q = container_of(timer, struct ec_quiet, timer);

	if (!q->looks || !is_quiet(q)) {
		wake_up_process(q->task);
		return HRTIMER_NORESTART;
	}
	q->looks--;
	q->m->bus.complete_ns = q->ride_ns;
	q->ride_ns = ktime_get_ns();
	ec_rider_again(&q->m->riders, &q->m->rider);
	/* not hrtimer_forward(): it may be before the end of the slack */
	hrtimer_set_expires_range_ns(timer, ktime_add_ns(ktime_get(), q->after_ns), q->slack_ns);
	return HRTIMER_RESTART;
}

/**
 * ec_quiet_init() - prepare the timer of the monitor's sleep
 * @q: zeroed structure on the stack; ec_quiet_exit() must follow
 * @m: master
 *
 * Context: The monitor.
 */
void ec_quiet_init(struct ec_quiet *q, struct ec_master *m)
{
	q->m = m;
	q->task = current;
	hrtimer_setup_on_stack(&q->timer, timer_looks, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
}

/**
 * ec_quiet_exit() - the monitor ends
 * @q: after ec_quiet_init()
 *
 * Context: The monitor.
 */
void ec_quiet_exit(struct ec_quiet *q)
{
	destroy_hrtimer_on_stack(&q->timer);
}

/**
 * ec_quiet_allow() - all is well: let the timer look instead of the monitor, some times
 * @q: of the monitor, with the values to compare
 *
 * A second link may be lost without a trace in the frames, and the messages of some mailboxes show
 * in no frame: then the monitor looks itself.
 *
 * Context: The monitor, with the rider in flight.
 */
void ec_quiet_allow(struct ec_quiet *q)
{
	q->missed = frames_missed(&q->m->links);
	if (ec_links_n(&q->m->links) == 1 && !q->survey->polled && ec_survey_lasts(q->survey))
		q->looks = LOOKS;
}

/**
 * ec_quiet_sleep() - sleep until there is something to do
 * @q: of the monitor; the timer makes no look unless ec_quiet_allow() was called
 * @after: time until the next look
 * @slack_ns: by which it may be later
 *
 * Context: The monitor, in state TASK_IDLE.
 */
void ec_quiet_sleep(struct ec_quiet *q, ktime_t after, u64 slack_ns)
{
	q->after_ns = ktime_to_ns(after);
	q->slack_ns = slack_ns;
	hrtimer_start_range_ns(&q->timer, after, slack_ns, HRTIMER_MODE_REL_HARD);
	schedule();
	hrtimer_cancel(&q->timer);
	q->looks = 0;
}
