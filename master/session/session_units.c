// SPDX-License-Identifier: GPL-2.0-only
#include "../cycle/units.h"
#include "../bus/slave.h"
#include "../config/unit.h"
#include "session_units.h"

/**
 * ec_session_goal() - the AL state that an active session wants for a slave
 * @s: active session
 * @c: configuration of the slave
 *
 * Context: Process, session lock held.
 * Return: EC_AL_OP, or EC_AL_SAFEOP by the policy of a sync unit.
 */
u8 ec_session_goal(const struct ec_session *s, const struct ec_config *c)
{
	lockdep_assert_held(s->wanted.lock);
	return ec_units_keep_down(&s->cycle, c->index) ? EC_AL_SAFEOP : EC_AL_OP;
}

/* A slave in another state was brought there by another request, and stays. */
static void turn_slave(const struct ec_config *c, u8 goal)
{
	if (!c->slave)
		return;
	if (goal == EC_AL_SAFEOP && READ_ONCE(c->slave->al.requested) == EC_AL_OP)
		ec_slave_request(c->slave, EC_AL_SAFEOP);
	else if (goal == EC_AL_OP && READ_ONCE(c->slave->al.requested) == EC_AL_SAFEOP)
		ec_slave_request_anew(c->slave, EC_AL_OP, 0);
}

/**
 * ec_session_units() - take slaves to the states that sync units want
 * @work: of struct ec_sessions
 *
 * The cycle has replaced their outputs before.
 *
 * Context: The service queue. May sleep.
 */
void ec_session_units(struct work_struct *work)
{
	struct ec_sessions *ss = container_of(work, struct ec_sessions, units);
	struct ec_session *s;

	mutex_lock(&ss->lock);
	s = ss->session;
	if (s && s->wanted.active && s->cycle.units && !s->ending)
		ec_for_each_config(c, &s->wanted)
			if (ec_units_turns(&s->cycle, c->index))
				turn_slave(c, ec_session_goal(s, c));
	mutex_unlock(&ss->lock);
}

/**
 * ec_session_find_unit() - find a sync unit by its name
 * @s: session
 * @name: name
 *
 * Context: Process, session lock held.
 * Return: index or -ENOENT.
 */
int ec_session_find_unit(const struct ec_session *s, const char *name)
{
	lockdep_assert_held(s->wanted.lock);
	ec_for_each_unit(u, &s->wanted)
		if (!strcmp(u->what.name, name))
			return u->what.index;
	return -ENOENT;
}

/**
 * ec_session_leave_units() - a file that is closed holds no units any more
 * @ss: sessions of a master
 * @holder: the file
 *
 * Context: Process. May sleep.
 */
void ec_session_leave_units(struct ec_sessions *ss, const void *holder)
{
	mutex_lock(&ss->lock);
	if (ss->session && ss->session->wanted.active)
		ec_units_leave(&ss->session->cycle, EC_UNIT_NONE, holder);
	mutex_unlock(&ss->lock);
}
