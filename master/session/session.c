// SPDX-License-Identifier: GPL-2.0-only
/* The owner of a session, and the places of its process data. */
#include <linux/pid_namespace.h>
#include <linux/rcupdate.h>
#include "session.h"

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
	/* the process has passed its file to a child, or is in another namespace */
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
