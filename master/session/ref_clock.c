// SPDX-License-Identifier: GPL-2.0-only
/*
 * The reference clock need not be among the slaves an application has
 * configured: often it is a coupler. It goes to OP with them, as applications
 * wait until the AL states of the whole bus are OP.
 */
#include "../bus/slave.h"
#include "ref_clock.h"
#include "session.h"

#define SM_KIND		0x0f	/* mode and direction, register 0x0804 */
#define SM_OUTPUTS	0x04	/* buffered, written by the master */

/* Without new outputs its watchdog would expire. */
static bool has_outputs(const struct ec_slave *s)
{
	unsigned int i;

	for (i = 0; i < s->n_sms; i++)
		if ((s->sms[i].control & SM_KIND) == SM_OUTPUTS)
			return true;
	return false;
}

/**
 * ec_ref_clock_raise() - take the reference clock to OP as well
 * @s: active session
 *
 * After activation and when slaves were connected or disconnected. Not a slave that
 * is configured or has outputs.
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_ref_clock_raise(struct ec_session *s)
{
	struct ec_sessions *ss = s->sessions;
	struct ec_slave *ref;

	lockdep_assert_held(s->wanted.lock);
	down_read(&ss->bus->topo);
	ref = ss->dc->ref;
	if (ref)
		ec_slave_ref(ref);
	up_read(&ss->bus->topo);
	if (!ref || ref == s->raised || ec_config_of(ref) || READ_ONCE(ref->stop.gone) ||
	    has_outputs(ref)) {
		ec_slave_unref(ref);
		return;
	}
	ec_ref_clock_lower(s);
	s->raised = ref;
	ec_slave_request(ref, EC_AL_OP);
}

/**
 * ec_ref_clock_lower() - request PREOP for the reference clock
 * @s: session
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_ref_clock_lower(struct ec_session *s)
{
	struct ec_slave *ref = s->raised;

	lockdep_assert_held(s->wanted.lock);
	if (!ref)
		return;
	s->raised = NULL;
	if (!READ_ONCE(ref->stop.gone) && !ec_config_of(ref) &&
	    !READ_ONCE(s->sessions->base->stopping))
		ec_slave_request(ref, EC_AL_PREOP);
	ec_slave_unref(ref);
}
