// SPDX-License-Identifier: GPL-2.0-only
/* When the clocks of a session are set, and by which reference clock. */
#include "../bus/slave.h"
#include "clocks.h"
#include "ref_clock.h"
#include "../clock/dc.h"
#include "../clock/dc_job.h"

/**
 * ec_clocks_choice() - station address of the chosen reference clock
 * @s: session
 *
 * Context: Process, session lock held.
 * Return: address, or %EC_DC_ANY or %EC_DC_NOBODY as for ec_dc_begin().
 */
u16 ec_clocks_choice(const struct ec_session *s)
{
	const struct ec_config *c;

	lockdep_assert_held(s->wanted.lock);
	if (s->ref_config >= s->wanted.n_configs)
		return EC_DC_ANY;
	c = s->wanted.configs[s->ref_config];
	return c->slave ? c->slave->station : EC_DC_NOBODY;
}

/**
 * ec_clocks_used() - does the session need clocks for sure?
 * @s: session
 *
 * It does with SYNC signals and with a cycle of the kernel that has clocks.
 *
 * Context: Process, session lock held.
 * Return: whether it does.
 */
bool ec_clocks_used(const struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	if (s->cycle.setup.kernel.dc)
		return true;
	ec_for_each_config(c, &s->wanted)
		if (c->sync.assign)
			return true;
	return false;
}

/**
 * ec_clocks_need_armw() - has the session a slave that ignores FRMW?
 * @s: session
 *
 * Context: Process, session lock held.
 * Return: whether it has, on the bus or not.
 */
bool ec_clocks_need_armw(const struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_for_each_config(c, &s->wanted)
		if (ec_config_flag(c, EC_FLAG_NO_FRMW))
			return true;
	return false;
}

/**
 * ec_clocks_begin_now() - do the clocks begin with the activation?
 * @s: session
 *
 * A chosen reference clock that is absent is reported at once: the clock calls of the application
 * fail, so no later event would start the search for it.
 *
 * Context: Process, session lock held.
 * Return: whether they do; else with the first clock datagram.
 */
bool ec_clocks_begin_now(const struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	return ec_clocks_used(s) ||
	       (s->ref_config < s->wanted.n_configs &&
		!ec_dc_can_be(s->sessions->dc, ec_clocks_choice(s)));
}

/**
 * ec_session_clocks() - set clocks that the application needs and that are not set
 * @ss: sessions of a master
 *
 * The clocks of an application begin with its activation when a slave has SYNC
 * signals, else with the first clock datagram it sends. They begin again when slaves
 * were connected or disconnected, and when a slave replies that did not before.
 *
 * Context: The monitor thread, session lock held. May sleep.
 */
void ec_session_clocks(struct ec_sessions *ss)
{
	struct ec_session *s = ss->session;
	struct ec_dc *dc = ss->dc;

	lockdep_assert_held(&ss->lock);
	if (s && s->wanted.active && ec_dc_due(dc))
		ec_dc_begin(dc, ec_clocks_choice(s));
	if (dc->changed) {
		WRITE_ONCE(dc->changed, false);
		wake_up_all(&dc->wq);
	}
	if (s && s->wanted.active && !s->ending)
		ec_ref_clock_raise(s);
}
