// SPDX-License-Identifier: GPL-2.0-only
/* The end of what an application has configured. */
#include <linux/slab.h>
#include "../bus/slave.h"
#include "clear.h"
#include "../config/replay.h"
#include "../config/unit.h"
#include "ref_clock.h"
#include "session_groups.h"
#include "session_slave.h"

/**
 * ec_session_clear() - free what an application has configured, and detach its slaves
 * @s: session that is not active
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_clear(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_ref_clock_lower(s);
	/* interrupt all of them first: each worker may need a moment to end */
	ec_for_each_config(c, &s->wanted)
		if (ec_session_owns(c))
			ec_stop_interrupt(&c->slave->stop, true);
	ec_session_drop_groups(s);
	ec_for_each_config(c, &s->wanted) {
		ec_session_detach(c);
		ec_config_free(c);
	}
	ec_for_each_domain(d, &s->wanted)
		ec_domain_free(d);
	ec_units_free(&s->wanted);
	ec_replay_free(&s->wanted.strays);
	kvfree(s->wanted.configs);
	kvfree(s->specs);
	kvfree(s->names);
	ec_budget_release(&s->wanted.budget, s->wanted.budget.bytes);
	if (s->handles)
		ec_session_free(s->handles);
	memset_startat(&s->wanted, 0, configs);
	memset_startat(s, 0, specs);
	s->ref_config = EC_UAPI_NONE32;
	ec_cycle_clear(&s->cycle);
}

/**
 * ec_session_free() - free a session that is not active
 * @s: session that has left struct ec_sessions
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_free(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_session_clear(s);
	kvfree(s);
}
