// SPDX-License-Identifier: GPL-2.0-only
/* A configuration gets a slave, and loses it. */
#include "../bus/pdo_coe.h"
#include "../bus/ports.h"
#include "../config/replay_run.h"
#include "../mailbox/emerg.h"
#include "detached.h"
#include "request.h"
#include "session_slave.h"
#include "session_units.h"

/**
 * ec_session_owns() - is the slave of a configuration its own?
 * @c: configuration
 *
 * A candidate session only reads from its slaves: they belong to the detached session.
 *
 * Context: Process, session lock held.
 * Return: whether it is.
 */
bool ec_session_owns(const struct ec_config *c)
{
	lockdep_assert_held(c->wanted->lock);
	return c->slave && ec_config_of(c->slave) == c;
}

/**
 * ec_session_detach() - detach a configuration from its slave, which goes to PREOP
 * @c: configuration
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_detach(struct ec_config *c)
{
	struct ec_slave *slave = c->slave;
	struct ec_setup *setup;
	unsigned int sm;

	lockdep_assert_held(c->wanted->lock);
	if (!slave)
		return;
	if (!ec_session_owns(c)) {
		c->slave = NULL;
		ec_slave_unref(slave);
		return;
	}
	c->slave = NULL;
	ec_slave_changed(slave);
	ec_ports_set_fast(slave, 0);
	setup = ec_setup_of(slave);
	ec_emerg_set(&slave->mbox, NULL);
	ec_mbox_keep_voe(&slave->mbox, false);
	WRITE_ONCE(slave->mbox.reply_ms, 0);
	ec_stop_interrupt(&slave->stop, true);
	mutex_lock(&slave->lock);
	for (sm = 0; sm < EC_MAX_SM; sm++)
		/* the slave keeps what was written */
		if (c->sm[sm].explicit ||
		    !ec_pdo_list_same(&c->sm[sm].pdos, &slave->pdos.sm[sm]))
			WRITE_ONCE(slave->pdos.known, false);
	ec_replay_forget(slave);
	WRITE_ONCE(setup->config, NULL);
	setup->active_config = NULL;
	ec_slave_clear_warning(slave);
	setup->pdo_refusal[0] = '\0';
	WRITE_ONCE(slave->work.reconfigure, true);
	ec_stop_interrupt(&slave->stop, false);
	mutex_unlock(&slave->lock);
	if (!READ_ONCE(slave->stop.gone) && !READ_ONCE(c->wanted->base->stopping))
		ec_slave_request(slave, EC_AL_PREOP);
	ec_slave_unref(slave);
}

/* Another configuration has @slave. */
static void log_taken(const struct ec_session *s, const struct ec_config *c,
		      struct ec_slave *slave)
{
	const struct ec_config *has = ec_config_of(slave);

	if (s->wanted.active)
		ec_slave_warn(slave,
			      "slave attached to %s since activation; configuration %s expects this position and has no slave: reconnect the missing slave or restart the application\n",
			      has->name, c->name);
	else
		ec_slave_warn(slave,
			      "two configurations for this slave, %s and %s; use one of them\n",
			      has->name, c->name);
}

/**
 * ec_session_give() - connect a configuration with a slave
 * @s: session
 * @c: its configuration, without slave
 * @slave: slave with a reference, which the configuration takes over
 *
 * Context: Process, session lock held. May sleep.
 * Return: false: another configuration has it.
 */
bool ec_session_give(struct ec_session *s, struct ec_config *c, struct ec_slave *slave)
{
	lockdep_assert_held(s->wanted.lock);
	/* interrupt the worker: the monitor must not wait as long as the worker does */
	ec_stop_interrupt(&slave->stop, true);
	mutex_lock(&slave->lock);
	ec_stop_interrupt(&slave->stop, false);
	if (ec_config_of(slave)) {
		log_taken(s, c, slave);
		mutex_unlock(&slave->lock);
		ec_slave_unref(slave);
		return false;
	}
	WRITE_ONCE(ec_setup_of(slave)->config, c);
	WRITE_ONCE(slave->work.reconfigure, true);
	slave->lost.seen_ns = c->lost.seen_ns;
	mutex_unlock(&slave->lock);
	c->slave = slave;
	/* before OP is requested */
	ec_detached_device(s, c);
	WRITE_ONCE(slave->mbox.reply_ms, c->reply_ms);
	ec_requests_attach(s, c);
	if (s->wanted.active && !s->ending)
		ec_slave_request(slave, ec_session_goal(s, c));
	else
		ec_slave_kick(slave);
	return true;
}

/**
 * ec_session_exchange() - connect a configuration with a slave instead of the one that it has
 * @s: session
 * @c: its configuration
 * @slave: slave with a reference, which the configuration takes over; NULL: none
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_exchange(struct ec_session *s, struct ec_config *c, struct ec_slave *slave)
{
	lockdep_assert_held(s->wanted.lock);
	if (slave == c->slave) {
		ec_slave_unref(slave);
		return;
	}
	ec_session_detach(c);
	if (slave && s == s->sessions->candidate)	/* only to read from it */
		c->slave = slave;
	else if (slave)
		ec_session_give(s, c, slave);
}
