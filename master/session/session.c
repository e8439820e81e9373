// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ctype.h>
#include <linux/pid_namespace.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../cycle/pll.h"
#include "../cycle/cycle_stats.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/wire_time.h"
#include "../mailbox/emerg.h"
#include "request.h"
#include "session.h"
#include "../bus/slave.h"
#include "../cycle/waiters.h"
#include "../config/why.h"

/**
 * ec_session_of() - the session an application works with
 * @ss: sessions of a master
 * @owner: its open file
 *
 * Context: Process, session lock held or after ec_show_begin().
 * Return: session, or NULL when it has not reserved the master.
 */
struct ec_session *ec_session_of(const struct ec_sessions *ss, const void *owner)
{
	lockdep_assert(lockdep_is_held(&ss->lock) || ec_show_begun(&ss->base->show));
	if (ss->session && ss->session->cycle.owner == owner)
		return ss->session;
	return ss->candidate && ss->candidate->cycle.owner == owner ? ss->candidate : NULL;
}

/* One application at a time; one more may prepare to take a detached session over. */
static bool is_taken(const struct ec_sessions *ss)
{
	lockdep_assert_held(&ss->lock);
	return ss->paused || ss->candidate || (ss->session && ss->session->cycle.owner);
}

/*
 * Mailboxes shall work from now on, whatever state a tool has requested. A slave that has failed
 * on its way to PREOP is skipped: another attempt would only delay the caller.
 */
static void to_preop(struct ec_sessions *ss)
{
	down_read(&ss->bus->topo);
	ec_for_each_slave(s, ss->bus) {
		if (READ_ONCE(s->error) == EC_SLAVE_SCAN_FAILED ||
		    (READ_ONCE(s->requested) == EC_AL_PREOP &&
		     (READ_ONCE(s->error) || READ_ONCE(s->al_status) == EC_AL_PREOP)))
			continue;
		ec_slave_request_anew(s, EC_AL_PREOP, 0);
	}
	up_read(&ss->bus->topo);
}

/* -EAGAIN: a scan has begun since the wait for it, which has returned @waited. */
static int session_begin(struct ec_sessions *ss, struct ec_session *s, int waited)
{
	int ret = 0;

	ec_sessions_lock(ss);
	if (is_taken(ss)) {
		ret = -EBUSY;
	} else if (ss->session) {
		ss->next = (struct ec_next){ };
		WRITE_ONCE(ss->candidate, s);
		s->wanted.before = &ss->session->wanted;
	} else if (!ec_bus_hold(ss->bus, waited)) {
		ret = -EAGAIN;
	} else {
		WRITE_ONCE(ss->session, s);
		to_preop(ss);
	}
	ec_sessions_unlock(ss);
	return ret;
}

/* Who reserves the master; a command may have any name, and it goes to terminals. */
static void note_process(struct ec_session *s)
{
	char *p;

	s->owner_pid = task_tgid_nr(current);
	get_task_comm(s->owner_comm, current);
	for (p = s->owner_comm; *p; p++)
		if (!isascii(*p) || !isprint(*p))
			*p = '?';
}

/**
 * ec_session_process() - the process that has reserved the master for a session
 * @s: session, or NULL
 * @buf: result, such as "process 123 (demo)"
 * @size: of @buf
 *
 * The number is that of the caller's PID namespace.
 *
 * Context: Process, session lock held or after ec_show_begin().
 * Return: length of the text; 0: there is none.
 */
size_t ec_session_process(const struct ec_session *s, char *buf, size_t size)
{
	pid_t nr;

	buf[0] = '\0';
	if (!s || !s->cycle.owner)
		return 0;
	lockdep_assert(lockdep_is_held(&s->sessions->lock) ||
		       ec_show_begun(&s->sessions->base->show));
	rcu_read_lock();
	nr = pid_vnr(find_pid_ns(s->owner_pid, &init_pid_ns));
	rcu_read_unlock();
	/* it has left its file to a child, or is in another namespace */
	if (nr)
		return scnprintf(buf, size, "process %d (%s)", nr, s->owner_comm);
	return scnprintf(buf, size, "another process (%s)", s->owner_comm);
}

/**
 * ec_session_owner_text() - the process that has reserved the master
 * @ss: sessions of a master
 * @buf: result, as of ec_session_process()
 * @size: of @buf
 *
 * Context: Process. May sleep.
 * Return: length of the text; 0: no process has reserved it.
 */
size_t ec_session_owner_text(struct ec_sessions *ss, char *buf, size_t size)
{
	size_t len;

	ec_sessions_lock(ss);
	len = ec_session_process(ss->candidate ?: ss->session, buf, size);
	ec_sessions_unlock(ss);
	return len;
}

static const struct ec_cycle_ops cycle_ops = {
	.cycle = ec_requests_notice,
};

/**
 * ec_session_begin() - an application reserves the master
 * @ss: sessions of a master
 * @owner: its open file
 * @waiters: wait queue of that file; freed after an RCU grace period
 *
 * Waits for a scan that is in progress or due, at most EC_SCAN_WAIT_MS, then the list of slaves
 * is held until activation and all go to PREOP; this waits for them. While a detached session
 * runs, the new one is the candidate: it touches no slave until activation.
 *
 * Context: Process. May sleep.
 * Return: 0, -EBUSY when another application has it, -ENODEV without device,
 * -EINTR, -ENOMEM.
 */
int ec_session_begin(struct ec_sessions *ss, const void *owner, struct ec_waiters *waiters)
{
	struct ec_session *s;
	bool taken;
	int ret;

	if (!ec_links_attached(ss->links))
		return -ENODEV;
	mutex_lock(&ss->lock);
	taken = is_taken(ss);
	mutex_unlock(&ss->lock);
	if (taken)
		return -EBUSY;
	ret = ec_bus_wait_scan(ss->bus);
	if (ret == -EINTR)
		return ret;
	s = kvzalloc(sizeof(*s), GFP_KERNEL_ACCOUNT);
	if (!s)
		return -ENOMEM;
	s->sessions = ss;
	s->wanted = (struct ec_wanted){
		.base = ss->base, .links = ss->links, .bus = ss->bus, .lock = &ss->lock,
		.sends = &s->cycle.sends, .budget = { .lock = &ss->lock, .total = &ss->memory },
	};
	ec_cycle_init(&s->cycle, ss->cycles, &s->wanted);
	s->cycle.owner = owner;
	RCU_INIT_POINTER(s->cycle.waiters, waiters);
	note_process(s);
	s->ref_config = EC_UAPI_NONE32;
	while ((ret = session_begin(ss, s, ret)) == -EAGAIN) {
		ret = ec_bus_wait_scan(ss->bus);
		if (ret == -EINTR)
			break;
	}
	if (ret) {
		kvfree(s);
		return ret;
	}
	ec_event(ss->base, EC_EVENT_RESERVED, task_tgid_nr(current));
	ec_info(ss, "application reserved the master, process %d\n", task_tgid_nr(current));
	if (READ_ONCE(ss->candidate) == s)
		return 0;
	ret = ec_bus_wait_slaves(ss->bus);
	if (ret != -EINTR)
		return 0;	/* one that is slow is no reason to refuse */
	ec_session_end(ss, owner);
	return ret;
}

static void clear(struct ec_session *s)
{
	ec_ref_clock_lower(s);
	/* all at once: a worker may need a moment to leave */
	ec_for_each_config(c, &s->wanted)
		if (ec_session_owns(c))
			ec_stop_interrupt(&c->slave->stop, true);
	ec_for_each_config(c, &s->wanted) {
		ec_session_detach(c);
		ec_config_free(c);
	}
	ec_for_each_domain(d, &s->wanted)
		ec_domain_free(d);
	kvfree(s->wanted.configs);
	kvfree(s->specs);
	ec_budget_release(&s->wanted.budget, s->wanted.budget.bytes);
	if (s->handles)
		ec_session_free(s->handles);
	memset_startat(&s->wanted, 0, configs);
	memset_startat(s, 0, specs);
	s->ref_config = EC_UAPI_NONE32;
	ec_cycle_clear(&s->cycle);
}

/* Application time and interval are those of one application. */
static void forget_times(struct ec_sessions *ss)
{
	ec_dc_end(ss->dc);
	WRITE_ONCE(ss->links->access.interval_us, EC_INTERVAL_US);
	ss->links->access.interval_set = false;
}

/**
 * ec_session_deactivate() - stop process data, free what was configured
 * @s: session
 *
 * The caller ends the session, or holds the list of slaves.
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0, or -EINVAL when it was not active.
 */
int ec_session_deactivate(struct ec_session *s)
{
	struct ec_sessions *ss = s->sessions;

	lockdep_assert_held(s->wanted.lock);
	if (!s->wanted.active)
		return -EINVAL;
	ec_cycle_set_active(ss->cycles, NULL);
	ec_cycle_thread_stop(&s->cycle);
	ec_session_note_counts(s, false, true);
	ec_access_change(ss->links, EC_ACCESS_DIRECT);
	ec_cycle_stats_end(&s->cycle);
	s->wanted.active = false;
	s->timeout_log.open = false;
	ec_requests_end(s);
	clear(s);
	ec_cycle_free(&s->cycle);
	ec_shared_put(s->cycle.shared);
	s->cycle.shared = NULL;
	forget_times(ss);
	if ((u32)atomic_read(&ss->links->access.timeouts) != s->timeout_log.logged)
		ec_warn(ss, "%u%s\n",
			atomic_read(&ss->links->access.timeouts) - s->timeout_log.logged,
			ec_timeouts_text(&s->timeout_log));
	ec_info(ss, "session deactivated\n");
	ec_event(ss->base, EC_EVENT_DEACTIVATED, s->owner_pid);
	return 0;
}

/* Without the lock, which the scan needs. True: no longer, @end_ns (ktime) or a signal has come. */
static bool wait_scan(struct ec_sessions *ss, u64 end_ns)
{
	u64 now = ktime_get_ns(), left = end_ns > now ? end_ns - now : 0;
	int ret;

	ec_sessions_unlock(ss);
	ret = ec_bus_wait_due(ss->bus, div_u64(left, NSEC_PER_MSEC));
	ec_sessions_lock(ss);
	return ret || !left;
}

/* The session may have ended or be active again. False: a scan runs first. */
static bool hold_list(struct ec_sessions *ss, const void *owner, bool always)
{
	const struct ec_session *s = ec_session_of(ss, owner);

	return !s || s != ss->session || s->wanted.active || ec_bus_hold(ss->bus, always);
}

/**
 * ec_session_stop() - the application deactivates its session and keeps the master
 * @ss: sessions of a master
 * @owner: its open file
 *
 * The list of slaves is held from now on, until the next activation or the end of the session. A
 * scan that is in progress or due runs first; this waits for it, at most EC_SCAN_WAIT_MS or
 * until a signal. Then the list is held unchanged, and the result of that scan is thrown away.
 *
 * Context: Process. May sleep.
 * Return: 0, -EINVAL when it was not active, -EPERM without session.
 */
int ec_session_stop(struct ec_sessions *ss, const void *owner)
{
	u64 end = ktime_get_ns() + EC_SCAN_WAIT_MS * (u64)NSEC_PER_MSEC;
	struct ec_session *s;
	bool always = false;
	int ret;

	ec_sessions_lock(ss);
	s = ec_session_of(ss, owner);
	ret = s ? ec_session_deactivate(s) : -EPERM;
	while (!ret && !hold_list(ss, owner, always))
		always = wait_scan(ss, end);
	ec_sessions_unlock(ss);
	return ret;
}

/**
 * ec_session_free() - a session that is not active goes away
 * @s: session that has left struct ec_sessions
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_free(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	clear(s);
	kvfree(s);
}

/**
 * ec_session_interval() - the application sets the interval of its cycle
 * @ss: sessions of a master
 * @interval_us: us; more than EC_MAX_INTERVAL_US: not set
 *
 * That of a candidate is valid once the detached session has ended.
 *
 * Context: Process, session lock held.
 */
void ec_session_interval(struct ec_sessions *ss, u32 interval_us)
{
	struct ec_access *a = &ss->links->access;

	lockdep_assert_held(&ss->lock);
	if (ss->candidate) {
		ss->next.interval_us = interval_us;
		return;
	}
	WRITE_ONCE(a->interval_us, min_t(u32, interval_us, EC_MAX_INTERVAL_US));
	a->interval_set = interval_us <= EC_MAX_INTERVAL_US;
}

/**
 * ec_session_app_time() - the application sets its time before activation
 * @ss: sessions of a master
 * @app_time: ns
 *
 * That of a candidate is valid once the detached session has ended, whose cycle has its own.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_session_app_time(struct ec_sessions *ss, u64 app_time)
{
	u64 now = ktime_get_ns();

	if (!READ_ONCE(ss->candidate)) {
		ec_dc_app_time(ss->dc, app_time, now);
		return;
	}
	if (!ec_read64(&ss->next.phase))
		ec_write64(&ss->next.phase, app_time);
	ec_write64(&ss->next.time, app_time);
	ec_write64(&ss->next.at_ns, now);
}

/* What the candidate has set; its first time decides the phase. */
static void use_next(struct ec_sessions *ss)
{
	u64 at_ns = ec_read64(&ss->next.at_ns);

	if (ss->next.interval_us)
		ec_session_interval(ss, ss->next.interval_us);
	if (!at_ns)
		return;
	ec_dc_app_time(ss->dc, ec_read64(&ss->next.phase), at_ns);
	ec_dc_app_time(ss->dc, ec_read64(&ss->next.time), at_ns);
}

/* The session has ended: its slaves are the candidate's now. */
static void inherit(struct ec_sessions *ss)
{
	struct ec_session *s = ss->candidate;

	WRITE_ONCE(ss->candidate, NULL);
	WRITE_ONCE(ss->session, s);
	if (!s) {
		ec_bus_unhold(ss->bus);
		return;
	}
	ec_bus_hold(ss->bus, true);
	s->wanted.before = NULL;
	use_next(ss);
	to_preop(ss);
	ec_for_each_config(c, &s->wanted) {
		ec_session_detach(c);
		ec_session_attach_one(s, c);
	}
}

static void end(struct ec_sessions *ss)
{
	struct ec_session *s = ss->session;

	/* a session that was never active may have set time and interval, too */
	if (ec_session_deactivate(s))
		forget_times(ss);
	WRITE_ONCE(ss->session, NULL);
	ec_session_free(s);
	inherit(ss);
}

static void released(struct ec_sessions *ss, pid_t pid)
{
	ec_event(ss->base, EC_EVENT_RELEASED, pid);
	ec_info(ss, "application exited or released the master, process %d\n", pid);
}

/**
 * ec_session_end() - the application has exited or releases the master
 * @ss: sessions of a master
 * @owner: its open file, other sessions stay; NULL: end all sessions
 *
 * An active session whose cycle the kernel runs is detached instead, when it was
 * configured so; with @owner NULL it ends, too.
 *
 * Context: Process. May sleep.
 */
void ec_session_end(struct ec_sessions *ss, const void *owner)
{
	struct ec_session *s;

	ec_sessions_lock(ss);
	s = ss->candidate;
	if (s && (!owner || s->cycle.owner == owner)) {
		WRITE_ONCE(ss->candidate, NULL);
		released(ss, s->owner_pid);
		ec_session_free(s);
	}
	s = ss->session;
	if (s && owner && s->cycle.owner != owner)
		s = NULL;
	if (s && owner && s->cycle.thread && !s->ending &&
	    s->cycle.setup.kernel.flags & EC_CYCLE_FLAG_DETACH) {
		ec_cycle_set_owner(&s->cycle, NULL, NULL);
		ec_event(ss->base, EC_EVENT_DETACHED, s->owner_pid);
		ec_info(ss,
			"application exited or released the master; session detached, kernel cycle continues\n");
	} else if (s) {
		pid_t pid = s->owner_pid;

		end(ss);
		released(ss, pid);
	}
	ec_sessions_unlock(ss);
}

/**
 * ec_session_end_detached() - end the cycle of an application that has exited
 * @ss: sessions of a master
 *
 * Slaves go to PREOP. An application that waits for a takeover gets the master, with the list of
 * slaves held: a scan that is in progress or due runs first, while the cycle continues. This waits
 * for it as ec_session_stop().
 *
 * Context: Process. May sleep.
 * Return: 0; -ENOENT nothing is active; -EBUSY its application is there.
 */
int ec_session_end_detached(struct ec_sessions *ss)
{
	u64 until = ktime_get_ns() + EC_SCAN_WAIT_MS * (u64)NSEC_PER_MSEC;
	bool always = false;
	int ret;

	ec_sessions_lock(ss);
	for (;;) {
		ret = !ss->session ? -ENOENT : ss->session->cycle.owner ? -EBUSY : 0;
		if (ret || !ss->candidate || ec_bus_hold(ss->bus, always))
			break;
		always = wait_scan(ss, until);
	}
	if (!ret)
		end(ss);
	ec_sessions_unlock(ss);
	return ret;
}

/* Station address of the chosen reference clock, as for ec_dc_begin(). */
static u16 ref_choice(const struct ec_session *s)
{
	const struct ec_config *c;

	if (s->ref_config >= s->wanted.n_configs)
		return EC_DC_ANY;
	c = s->wanted.configs[s->ref_config];
	return c->slave ? c->slave->station : EC_DC_NOBODY;
}

/* Does the session need clocks for sure: SYNC signals, or a cycle of the kernel with clocks? */
static bool uses_clocks(const struct ec_session *s)
{
	if (s->cycle.setup.kernel.dc)
		return true;
	ec_for_each_config(c, &s->wanted)
		if (c->sync.assign)
			return true;
	return false;
}

/*
 * A chosen reference clock that is absent is reported at once: the clock calls of the application
 * fail, so no later event would start the search for it.
 */
static bool begins_clocks(const struct ec_session *s)
{
	return uses_clocks(s) ||
	       (s->ref_config < s->wanted.n_configs &&
		!ec_dc_can_be(s->sessions->dc, ref_choice(s)));
}

/**
 * ec_session_clocks() - set clocks that the application needs and that are not set
 * @ss: sessions of a master
 *
 * The clocks of an application begin with its activation when a slave has SYNC
 * signals, else with the first clock datagram it sends. They begin anew when slaves
 * have come or gone, and when one that did not answer does.
 *
 * Context: The monitor thread, session lock held. May sleep.
 */
void ec_session_clocks(struct ec_sessions *ss)
{
	struct ec_session *s = ss->session;
	struct ec_dc *dc = ss->dc;

	lockdep_assert_held(&ss->lock);
	if (s && s->wanted.active && ec_dc_due(dc))
		ec_dc_begin(dc, ref_choice(s));
	if (dc->changed) {
		WRITE_ONCE(dc->changed, false);
		wake_up_all(&dc->wq);
	}
	if (s && s->wanted.active && !s->ending)
		ec_ref_clock_raise(s);
}

/**
 * ec_session_place() - give the domains their places in the image
 * @s: session, not active
 *
 * Context: Process, session lock held.
 * Return: bytes of all domains.
 */
u32 ec_session_place(struct ec_session *s)
{
	u32 offset = 0;

	lockdep_assert_held(s->wanted.lock);
	ec_for_each_domain(d, &s->wanted) {
		d->offset = offset;
		offset += ALIGN(d->size, 8);
	}
	return offset;
}

/**
 * session_fits() - is there memory for an activation within the limit?
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
	return atomic_long_read(&s->sessions->memory) + images * image_size + EC_STATUS_BYTES +
	       ec_requests_bytes(s) + s->request_bytes > EC_MAX_SESSION_BYTES ? -EDQUOT : 0;
}

/**
 * ec_session_activate() - lay out process data, hand the links to the cycle
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
	struct ec_status *st;
	u32 offset;
	int ret;

	lockdep_assert_held(s->wanted.lock);
	if (s->wanted.active)
		return -EBUSY;
	ec_for_each_domain(d, &s->wanted)
		if (d->division > 1 && !s->cycle.setup.kernel.period_ns)
			return -EOPNOTSUPP;
	offset = ec_session_place(s);
	if (offset > EC_MAX_IMAGE)
		return -EOVERFLOW;
	ret = session_fits(s, offset);
	if (ret)
		return ret;
	s->cycle.shared = ec_shared_create(&ss->memory, offset, ec_requests_bytes(s));
	if (!s->cycle.shared)
		return -ENOMEM;
	if (s->preset)
		memcpy(s->cycle.shared->image, s->preset, offset);
	ret = ec_requests_begin(s) ?: ec_cycle_layout(&s->cycle) ?:
	      ec_wire_time_check(&s->cycle, uses_clocks(s));
	if (!ret && s->cycle.setup.kernel.period_ns)
		ret = ec_cycle_thread_create(&s->cycle, offset, &cycle_ops);
	if (ret) {
		ec_cycle_free(&s->cycle);
		ec_requests_end(s);
		ec_shared_put(s->cycle.shared);
		s->cycle.shared = NULL;
		return ret;
	}
	st = s->cycle.shared->status;
	st->config_count = s->wanted.n_configs;
	st->dc_monitor = ~0u;
	ec_for_each_domain(d, &s->wanted)
		st->domains[d->index].expected = d->expected;
	/* from now on workers go by the configurations, which stay as they are */
	smp_store_release(&s->wanted.active, true);
	s->timeout_log.logged = atomic_read(&ss->links->access.timeouts);
	WRITE_ONCE(ss->links->access.stopped, false);
	s->notes = (struct ec_count_notes){ };
	ec_session_note_counts(s, true, false);
	s->cycle.watch.lock_logged = EC_CYCLE_LOCK_OFF;
	s->cycle.slaves_down = false;
	ec_bus_unhold(ss->bus);
	/* one that waits for outputs takes the links with its first frame */
	if (!s->cycle.thread || !(s->cycle.setup.kernel.flags & EC_CYCLE_FLAG_WAIT))
		ec_access_change(ss->links, EC_ACCESS_CYCLIC);
	ec_cycle_set_active(ss->cycles, &s->cycle);
	/* the grid of SYNC is that of the thread's own time, which it keeps its phase to */
	if (s->cycle.thread)
		ec_dc_app_forget(ss->dc);
	if (begins_clocks(s))
		ec_dc_begin(ss->dc, ref_choice(s));
	st->dc_ref = READ_ONCE(ss->dc->ref_station) != 0;
	ec_session_fill_status(s);
	ec_cycle_thread_start(&s->cycle);
	ec_bus_need_workers(ss->bus, s->wanted.n_configs);
	ec_for_each_config(c, &s->wanted)
		if (c->slave)
			ec_slave_request(c->slave, EC_AL_OP);
	ec_ref_clock_raise(s);
	ec_requests_kick(s);
	ec_config_log_differences(&s->wanted);
	ec_session_begin_active(s);
	ec_info(ss, "session activated: %u domain(s), %u bytes, %u datagram(s) per cycle\n",
		s->wanted.n_domains, offset, s->cycle.layout.n_dgrams);
	ec_event(ss->base, EC_EVENT_ACTIVATED, s->owner_pid, s->wanted.n_domains, offset,
		 s->cycle.layout.n_dgrams);
	return 0;
}

/**
 * ec_session_slaves_down() - take the slaves to PREOP, the cycle goes on
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

/**
 * ec_session_domain_data() - where the process data of a domain lie
 * @d: domain of an active session
 *
 * Context: Any, while the session is active.
 * Return: its first byte.
 */
u8 *ec_session_domain_data(const struct ec_domain *d)
{
	return ec_domain_session(d)->cycle.domains[d->index].image + d->offset;
}
