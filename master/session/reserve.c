// SPDX-License-Identifier: GPL-2.0-only
/* Which application has the master, and the next one that waits for it. */
#include <linux/ctype.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../base/report.h"
#include "../bus/bus_list.h"
#include "../bus/slave.h"
#include "activate.h"
#include "clear.h"
#include "reserve.h"
#include "session_attach.h"
#include "session_slave.h"
#include "../clock/dc_app.h"

/*
 * One application at a time; a candidate may prepare the takeover of a detached session, unless
 * that was left to the master.
 */
static bool is_taken(const struct ec_sessions *ss)
{
	lockdep_assert_held(&ss->lock);
	return ss->paused || ss->candidate ||
	       (ss->session && (ss->session->cycle.owner || ss->session->detached));
}

/*
 * Mailboxes have to work from now on, even if a tool has requested another state. A slave that has
 * failed before PREOP is skipped: another attempt would only delay the caller.
 */
static void to_preop(struct ec_sessions *ss)
{
	down_read(&ss->bus->topo);
	ec_for_each_slave(s, ss->bus) {
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED ||
		    (READ_ONCE(s->al.requested) == EC_AL_PREOP &&
		     (READ_ONCE(s->note.error) || READ_ONCE(s->al.status) == EC_AL_PREOP)))
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

/* The process that reserves the master. Its command may have any name, and goes to terminals. */
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
	spin_lock_init(&s->wanted.writes_lock);
	INIT_LIST_HEAD(&s->wanted.strays.writes);
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
	ec_report(ss->base, EC_EVENT_RESERVED, task_tgid_nr(current));
	if (READ_ONCE(ss->candidate) == s)
		return 0;
	ret = ec_bus_wait_slaves(ss->bus);
	if (ret != -EINTR)
		return 0;	/* a slow slave is no reason to refuse */
	ec_session_end(ss, owner);
	return ret;
}

/* Without the lock, which the scan needs. True: the wait is over by @end_ns (ktime) or a signal. */
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
 * until a signal. Then the list is held unchanged, and the result of that scan is discarded.
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

/* Use what the candidate has set; its first time determines the phase. */
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
	ec_for_each_config(c, &s->wanted)
		ec_session_detach(c);
	ec_session_attach_all(s);
}

static void end(struct ec_sessions *ss)
{
	struct ec_session *s = ss->session;

	/* also a session that was never active may have set time and interval */
	if (ec_session_deactivate(s))
		ec_sessions_forget_times(ss);
	WRITE_ONCE(ss->session, NULL);
	ec_session_free(s);
	inherit(ss);
}

/**
 * ec_session_end() - the application has exited or releases the master
 * @ss: sessions of a master
 * @owner: its open file, other sessions stay; NULL: end all sessions
 *
 * An active session whose cycle the kernel runs is detached instead, when it was
 * configured so; with @owner NULL it ends as well.
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
		ec_report(ss->base, EC_EVENT_RELEASED, s->owner_pid);
		ec_session_free(s);
	}
	s = ss->session;
	if (s && owner && s->cycle.owner != owner)
		s = NULL;
	if (s && owner && s->cycle.thread && !s->ending &&
	    s->cycle.setup.kernel.flags & EC_CYCLE_FLAG_DETACH) {
		ec_cycle_set_owner(&s->cycle, NULL, NULL);
		ec_report(ss->base, EC_EVENT_DETACHED, s->owner_pid);
	} else if (s) {
		pid_t pid = s->owner_pid;

		end(ss);
		ec_report(ss->base, EC_EVENT_RELEASED, pid);
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
 * Return: 0; -ENOENT no session; -EBUSY it is not detached.
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
