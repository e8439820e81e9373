// SPDX-License-Identifier: GPL-2.0-only
/* The state of the bus for an active session, and log messages about its application. */
#include "../cycle/units.h"
#include "../config/why.h"
#include "../config/group.h"
#include "../cycle/counts.h"
#include "../cycle/pll.h"
#include "../cycle/cycle_sched.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/receive.h"
#include "../cycle/ring_sides.h"
#include "../cycle/wire_time.h"
#include "../base/once64.h"
#include "../base/report.h"
#include "clocks.h"
#include "request.h"
#include "session_status.h"
#include "../bus/slave.h"
#include "../bus/survey.h"
#include "../clock/dc_app.h"

/*
 * A timeout and its end are two lines, at most once in 10 s: on a busy host a cycle may time out
 * many times a second.
 */
static void log_timeouts(struct ec_session *s, u64 now)
{
	struct ec_sessions *ss = s->sessions;
	struct ec_timeout_log *l = &s->timeout_log;
	bool timed_out = !ec_access_runs(&ss->links->access);
	u32 more = atomic_read(&ss->links->access.timeouts) - l->logged;

	if (l->open && !timed_out) {
		ec_report_line(ss->base, EC_EVENT_RESUMED,
			       div_u64(now - l->since_ns, NSEC_PER_MSEC));
		l->open = false;
	} else if (!l->open && more && now >= l->next_ns) {
		l->since_ns = ec_read64(&ss->links->access.timeout_ns);
		l->logged += more;
		l->open = timed_out;
		if (more > timed_out)
			ec_warn(ss, "%u%s\n", more - timed_out, ec_timeouts_text(l));
		l->next_ns = now + EC_TIMEOUT_LOG_NS;
		if (timed_out)
			ec_report_line(ss->base, EC_EVENT_TIMEOUT,
				       div_u64(now - l->since_ns, NSEC_PER_MSEC));
	}
}

static void note_timeouts(struct ec_session *s, u64 now)
{
	struct ec_sessions *ss = s->sessions;
	struct ec_count_notes *n = &s->notes;
	u32 timeouts = atomic_read(&ss->links->access.timeouts);

	if (timeouts != n->timeouts) {
		n->since_ns = ec_read64(&ss->links->access.timeout_ns);
		ec_event(ss->base, EC_EVENT_TIMEOUT, div_u64(now - n->since_ns, NSEC_PER_MSEC),
			 timeouts - n->timeouts);
		n->timeouts = timeouts;
	}
	if (n->since_ns && ec_access_runs(&ss->links->access)) {
		ec_event(ss->base, EC_EVENT_RESUMED, div_u64(now - n->since_ns, NSEC_PER_MSEC));
		n->since_ns = 0;
	}
}

/**
 * ec_session_note_counts() - report counters that have grown as events, once a second each
 * @s: active session
 * @first: begin to count: no events for earlier counts
 * @all: also within the second
 *
 * The cycle itself only counts.
 *
 * Context: Process, session lock held.
 */
void ec_session_note_counts(struct ec_session *s, bool first, bool all)
{
	static const u32 kinds[] = { EC_EVENT_OVERRUN, EC_EVENT_FRAMES_LOST, EC_EVENT_FRAMES_LATE };
	struct ec_status *st = s->cycle.shared->status;
	struct ec_count_notes *n = &s->notes;
	u64 counts[3] = { 0 }, now = ktime_get_ns();
	const struct ec_link *link;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	ec_status_copy(st, &counts[0], &st->kernel.overruns, sizeof(counts[0]));
	ec_links_for_each(s->sessions->links, link) {
		counts[1] += atomic64_read(&link->stats.lost);
		counts[2] += atomic64_read(&link->stats.late);
	}
	for (i = 0; i < ARRAY_SIZE(counts); i++) {
		/* less: a caller has reset it, or the device has changed */
		n->more[i] += counts[i] - (counts[i] < n->count[i] ? 0 : n->count[i]);
		n->count[i] = counts[i];
		if (first)
			n->more[i] = 0;
		if (!n->more[i] || (!all && now < n->next_ns[i]))
			continue;
		ec_report(s->sessions->base, kinds[i], n->more[i]);
		n->more[i] = 0;
		n->next_ns[i] = now + NSEC_PER_SEC;
	}
	if (first)
		n->timeouts = atomic_read(&s->sessions->links->access.timeouts);
	note_timeouts(s, now);
}

static void status_links(struct ec_sessions *ss, struct ec_status *st)
{
	unsigned int i;

	for (i = 0; i < ec_links_n(ss->links); i++) {
		const struct ec_link *link = ec_links_at(ss->links, i);
		u32 slaves = READ_ONCE(link->slaves);

		WRITE_ONCE(st->links[i].slaves_responding, slaves);
		WRITE_ONCE(st->links[i].al_states, slaves ? READ_ONCE(ss->bus->al_states) : 0);
		WRITE_ONCE(st->links[i].link_up, READ_ONCE(link->up));
	}
	WRITE_ONCE(st->link_count, i);
}

static void status_bus(struct ec_session *s)
{
	struct ec_status *st = s->cycle.shared->status;
	struct ec_sessions *ss = s->sessions;

	WRITE_ONCE(st->slaves_responding, READ_ONCE(ss->bus->responding));
	WRITE_ONCE(st->al_states, READ_ONCE(ss->bus->al_states));
	WRITE_ONCE(st->link_up, ec_links_any_up(ss->links));
	status_links(ss, st);
}

static void status_configs(struct ec_session *s)
{
	struct ec_status *st = s->cycle.shared->status;

	lockdep_assert_held(s->wanted.lock);
	/* the count before the slaves */
	s->configs_seen = atomic_read_acquire(&s->sessions->bus->changes);
	s->configs_ns = ktime_get_ns();
	ec_for_each_config(c, &s->wanted)
		WRITE_ONCE(st->configs[c->index], ec_config_status(c));
	ec_counts_update(&s->cycle);
	ec_units_look(&s->cycle);
	if (ec_groups_wait(&s->wanted))
		WRITE_ONCE(s->sessions->bus->regroup, true);
}

/**
 * ec_session_fill_status() - write the state of the bus to the status page
 * @s: active session, or one that is about to be
 *
 * It is written before the application can read the page, so that the page never contradicts
 * what the application has read before its activation.
 *
 * Context: Process, session lock held.
 */
void ec_session_fill_status(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	status_bus(s);
	status_configs(s);
}

/**
 * ec_session_status() - update the mapped status
 * @ss: sessions of a master
 * @scanned: the slaves are those of the last scan: clocks may be set as well
 *
 * Context: The monitor thread. May sleep.
 */
void ec_session_status(struct ec_sessions *ss, bool scanned)
{
	struct ec_session *s;
	u64 now;

	/* an activation has the lock: next time */
	if (!ec_sessions_trylock(ss))
		return;
	if (scanned)
		ec_session_clocks(ss);
	s = ss->session;
	if (s && s->wanted.active) {
		now = ktime_get_ns();
		log_timeouts(s, now);
		ec_session_note_counts(s, false, false);
		ec_pll_log(&s->cycle);
		ec_cycle_thread_check_cpu(&s->cycle);
		ec_cycle_sched_log_place(&s->cycle);
		ec_dc_app_log(ss->dc);
		ec_wire_time_log(&s->cycle);
		ec_cycle_log_stale(&s->cycle);
		if (!s->cycle.thread || ec_cycle_thread_ended(&s->cycle))
			ec_requests_notice(&s->cycle);
		status_bus(s);
		if (s->configs_seen != (u32)atomic_read(&ss->bus->changes) ||
		    now - s->configs_ns >= EC_SURVEY_NS)
			status_configs(s);
		ec_ring_sides_look(&s->cycle, scanned);
	}
	mutex_unlock(&ss->lock);
}
