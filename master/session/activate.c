// SPDX-License-Identifier: GPL-2.0-only
/* Begin and end of the cyclic exchange of a session. */
#include <linux/delay.h>
#include <linux/slab.h>
#include "../base/report.h"
#include "../bus/ports.h"
#include "../bus/slave.h"
#include "../config/unit.h"
#include "../config/why.h"
#include "../cycle/cycle_stats.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/recorder.h"
#include "../cycle/units.h"
#include "../cycle/wire_time.h"
#include "activate.h"
#include "clear.h"
#include "clocks.h"
#include "detached.h"
#include "ref_clock.h"
#include "request.h"
#include "request_layout.h"
#include "session_attach.h"
#include "session_groups.h"
#include "session_slave.h"
#include "session_status.h"
#include "../clock/dc.h"
#include "../clock/dc_app.h"
#include "../clock/dc_armw.h"

#define DOWN_MS		2000	/* for commands before steps down, of all slaves */

static const struct ec_cycle_ops cycle_ops = {
	.cycle = ec_requests_notice,
};

/**
 * session_fits() - does the memory of an activation stay within the limit?
 * @s: session
 * @image_size: bytes of all domains
 *
 * Context: Process, session lock held.
 * Return: 0 or -EDQUOT.
 */
static int session_fits(const struct ec_session *s, size_t image_size)
{
	/* with six images for the exchange; requests have a copy of their data */
	size_t images = s->cycle.setup.kernel.period_ns ? 1 + 2 * EC_EXCHANGE_BUFFERS : 1;

	lockdep_assert_held(&s->sessions->lock);
	/* sync units: one that is sent instead, and the buffers of holders */
	if (s->wanted.n_units)
		images += 1 + EC_EXCHANGE_BUFFERS;
	return atomic_long_read(&s->sessions->memory) + images * image_size + EC_STATUS_BYTES +
	       ec_requests_bytes(s) + s->request_bytes > EC_MAX_SESSION_BYTES ? -EDQUOT : 0;
}

/* The status page as the application first reads it. */
static void activate_status(struct ec_session *s)
{
	struct ec_status *st = s->cycle.shared->status;

	st->config_count = s->wanted.n_configs;
	st->dc_monitor = ~0u;
	ec_for_each_domain(d, &s->wanted)
		st->domains[d->index].expected = d->expected;
	ec_for_each_unit(u, &s->wanted)
		st->units[u->what.index] = ec_units_state(&s->cycle.units->unit[u->what.index]);
}

static void free_cycle(struct ec_cycle *c)
{
	ec_units_end(c->units);
	ec_cycle_free(c);
}

/* Memory and layout of the cycle, and the thread that runs it. */
static int activate_prepare(struct ec_session *s, u32 image_bytes)
{
	struct ec_cycle *c = &s->cycle;
	int ret;

	ret = session_fits(s, image_bytes);
	if (ret)
		return ret;
	c->shared = ec_shared_create(&s->sessions->memory, image_bytes, ec_requests_bytes(s));
	if (!c->shared)
		return -ENOMEM;
	if (s->preset)
		memcpy(c->shared->image, s->preset, image_bytes);
	ret = ec_requests_begin(s) ?: ec_cycle_layout(c) ?:
	      ec_units_make(c, s->sessions->service, &s->sessions->units) ?:
	      ec_wire_time_check(c, ec_clocks_used(s));
	if (!ret && c->setup.kernel.period_ns)
		ret = ec_cycle_thread_create(c, image_bytes, &cycle_ops);
	if (!ret) {
		activate_status(s);
		return 0;
	}
	free_cycle(c);
	ec_requests_end(s);
	ec_shared_put(c->shared);
	c->shared = NULL;
	return ret;
}

/* Begin to count for the log and the events. */
static void activate_counts(struct ec_session *s)
{
	s->timeout_log.logged = atomic_read(&s->sessions->links->access.timeouts);
	WRITE_ONCE(s->sessions->links->access.stopped, false);
	s->notes = (struct ec_count_notes){ };
	ec_session_note_counts(s, true, false);
	s->cycle.watch.lock_logged = EC_CYCLE_LOCK_OFF;
	s->cycle.slaves_down = false;
}

/* The cycle may run from now on; a kernel cycle starts. */
static void activate_cycle(struct ec_session *s)
{
	struct ec_sessions *ss = s->sessions;
	struct ec_cycle *c = &s->cycle;

	/* a cycle that waits for outputs begins cyclic access with its first frame */
	if (!c->thread || !(c->setup.kernel.flags & EC_CYCLE_FLAG_WAIT))
		ec_access_change(ss->links, EC_ACCESS_CYCLIC);
	ec_cycle_set_active(ss->cycles, c);
	/* the thread's own time is the grid of the SYNC signals: its cycle keeps a phase to it */
	if (c->thread)
		ec_dc_app_forget(ss->dc);
	ec_dc_armw_want(ss->dc, ec_clocks_need_armw(s));
	if (ec_clocks_begin_now(s))
		ec_dc_begin(ss->dc, ec_clocks_choice(s));
	c->shared->status->dc_ref = READ_ONCE(ss->dc->ref_station) != 0;
	ec_session_fill_status(s);
	ec_cycle_thread_start(c);
}

/* Request OP for the slaves of the session. */
static void activate_slaves(struct ec_session *s)
{
	ec_bus_need_workers(s->sessions->bus, s->wanted.n_configs);
	ec_for_each_config(c, &s->wanted)
		if (c->slave)
			ec_slave_request(c->slave, EC_AL_OP);
	ec_ref_clock_raise(s);
}

/**
 * ec_session_activate() - lay out process data, begin cyclic bus access
 * @s: session
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0; -EBUSY when active already; -EOPNOTSUPP a domain has a division and
 * the application runs the cycle; -EOVERFLOW when the image or a cycle
 * is too large; -EDQUOT more memory than EC_MAX_SESSION_BYTES; -ENOSPC as
 * ec_wire_time_check(); -ENODEV when the CPU of the cycle is offline; -ENOMEM.
 */
int ec_session_activate(struct ec_session *s)
{
	struct ec_sessions *ss = s->sessions;
	u32 bytes;
	int ret;

	lockdep_assert_held(s->wanted.lock);
	if (s->wanted.active)
		return -EBUSY;
	ec_for_each_domain(d, &s->wanted)
		if (d->division > 1 && !s->cycle.setup.kernel.period_ns)
			return -EOPNOTSUPP;
	ec_session_settle_places(s);
	bytes = ec_session_place(s);
	if (bytes > EC_MAX_IMAGE)
		return -EOVERFLOW;
	ret = ec_session_set_borders(s) ?: activate_prepare(s, bytes);
	if (ret)
		return ret;
	/* from now on workers use the configurations, which do not change */
	smp_store_release(&s->wanted.active, true);
	activate_counts(s);
	ec_bus_unhold(ss->bus);
	ec_ports_guard(ss->bus, true);
	activate_cycle(s);
	activate_slaves(s);
	ec_requests_kick(s);
	ec_config_log_differences(&s->wanted);
	ec_session_report_groups(s);
	ec_session_begin_active(s);
	ec_report(ss->base, EC_EVENT_ACTIVATED, s->owner_pid, s->wanted.n_domains, bytes,
		  s->cycle.layout.n_dgrams);
	return 0;
}

/**
 * ec_session_slaves_down() - take the slaves to PREOP, the cycle continues
 * @s: session
 *
 * The state changes while process data and SYNC signals still run, so that no
 * slave sees a fault; the SYNC signals are switched off in PREOP.
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0, or -EINVAL when it is not active.
 */
int ec_session_slaves_down(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	if (!s->wanted.active)
		return -EINVAL;
	s->ending = true;
	WRITE_ONCE(s->cycle.slaves_down, true);
	ec_ref_clock_lower(s);
	ec_for_each_config(c, &s->wanted)
		if (c->slave)
			ec_slave_request(c->slave, EC_AL_PREOP);
	return 0;
}

/* Is a slave to go down, with commands of the application for that? */
static bool leads_down(const struct ec_config *c)
{
	return ec_session_owns(c) && READ_ONCE(c->slave->al.status) & EC_AL_BEYOND_PREOP &&
	       !READ_ONCE(c->slave->stop.gone) && !READ_ONCE(c->slave->reply.silent) &&
	       (ec_startup_leaves(NULL, c, EC_AL_OP, EC_AL_PREOP) ||
		ec_startup_leaves(NULL, c, EC_AL_SAFEOP, EC_AL_PREOP));
}

/* How many are; @busy: those whose worker is on the way. */
static unsigned int n_down(const struct ec_session *s, bool busy)
{
	unsigned int n = 0;

	ec_for_each_config(c, &s->wanted)
		n += leads_down(c) && (!busy || atomic_read(&c->slave->work.runs));
	return n;
}

/*
 * The commands of the application for steps down are executed before the slaves lose their
 * configurations. Nothing is awaited for applications without such commands.
 */
static void run_commands_down(struct ec_session *s)
{
	struct ec_base *base = s->sessions->base;
	u64 end = ktime_get_ns() + DOWN_MS * (u64)NSEC_PER_MSEC;

	lockdep_assert_held(s->wanted.lock);
	if (!n_down(s, false) || READ_ONCE(base->stopping))
		return;
	ec_session_slaves_down(s);
	/* what is shown does not change while the session waits */
	ec_show_change_end(&base->show);
	while (n_down(s, true) && ktime_get_ns() < end && !READ_ONCE(base->stopping) &&
	       ec_links_is_up(s->sessions->links))
		usleep_range(500, 1000);
	ec_show_change_begin(&base->show);
	ec_for_each_config(c, &s->wanted)
		if (leads_down(c))
			ec_slave_warn(c->slave,
				      "commands for steps down not finished before the end of the session, limit %u ms\n",
				      DOWN_MS);
}

/**
 * ec_session_deactivate() - stop process data, free what was configured
 * @s: session
 *
 * The caller ends the session, or holds the list of slaves. Slaves with commands for steps down
 * go to PREOP first, for which all of them have DOWN_MS.
 *
 * Context: Process, ec_sessions_lock() held. May sleep.
 * Return: 0, or -EINVAL when it was not active.
 */
int ec_session_deactivate(struct ec_session *s)
{
	struct ec_sessions *ss = s->sessions;

	lockdep_assert_held(s->wanted.lock);
	if (!s->wanted.active)
		return -EINVAL;
	ec_detached_end(s);
	ec_cycle_set_active(ss->cycles, NULL);
	ec_cycle_thread_stop(&s->cycle);
	ec_session_note_counts(s, false, true);
	ec_access_change(ss->links, EC_ACCESS_DIRECT);
	ec_cycle_stats_end(&s->cycle);
	ec_requests_end(s);
	run_commands_down(s);
	s->wanted.active = false;
	/* a reader may have begun while commands for steps down ran, but none does from now on */
	ec_recorder_end(&s->cycle);
	ec_ports_guard(ss->bus, false);
	s->timeout_log.open = false;
	ec_session_clear(s);
	free_cycle(&s->cycle);
	ec_shared_put(s->cycle.shared);
	s->cycle.shared = NULL;
	ec_sessions_forget_times(ss);
	if ((u32)atomic_read(&ss->links->access.timeouts) != s->timeout_log.logged)
		ec_warn(ss, "%u%s\n",
			atomic_read(&ss->links->access.timeouts) - s->timeout_log.logged,
			ec_timeouts_text(&s->timeout_log));
	ec_report(ss->base, EC_EVENT_DEACTIVATED, s->owner_pid);
	return 0;
}
