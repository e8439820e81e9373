// SPDX-License-Identifier: GPL-2.0-only
/* A slave that returns: what the application has written, again, and PREOP until it has itself. */
#include "config.h"
#include "../bus/result.h"
#include "apply_state.h"
#include "replay_run.h"

#define WAITS	"the application, which holds it in PREOP (" EC_FLAG_HOLD ")"

static bool replay_named(const struct ec_config *c, const struct ec_startup *u)
{
	const struct ec_replay *r = &c->replay;
	unsigned int i;

	for (i = 0; i < r->n_named; i++)
		if (r->named[i].type == u->type && r->named[i].index == u->index &&
		    r->named[i].sub == u->sub)
			return true;
	return false;
}

static bool maps(const struct ec_pdo *p, const struct ec_startup *u)
{
	unsigned int i;

	for (i = 0; i < p->n_entries; i++)
		if (p->entries[i].index == u->index &&
		    (u->type == EC_STARTUP_IDN || u->complete || p->entries[i].sub == u->sub))
			return true;
	return false;
}

/* The process data write it in each cycle. */
static bool is_output(const struct ec_config *c, const struct ec_startup *u)
{
	unsigned int sm, i;

	for (sm = 0; sm < EC_MAX_SM; sm++)
		for (i = 0; c->sm[sm].dir == EC_CFG_DIR_OUTPUT && i < c->sm[sm].pdos.n; i++)
			if (maps(&c->sm[sm].pdos.pdos[i], u))
				return true;
	return false;
}

/* The first configuration had them in this order. */
static bool startup_is_later(const struct ec_config *c, const struct ec_startup *u)
{
	const struct ec_startup *x;

	if (!(u->write & EC_WRITE_EARLY))
		return false;
	list_for_each_entry(x, &c->startup, list)
		if (x->type == u->type && x->index == u->index && x->sub == u->sub)
			return true;
	return false;
}

/**
 * ec_replay_why() - why a recorded write is not replayed
 * @c: configuration
 * @u: write
 *
 * Context: A section of a reader (ec_show_begin()), or the slave's worker.
 * Return: EC_REPLAY_WHY_NONE: it is.
 */
enum ec_replay_why ec_replay_why(const struct ec_config *c, const struct ec_startup *u)
{
	u8 mode = c->replay.mode;
	bool named = replay_named(c, u);
	enum ec_replay_why why;

	if (mode == EC_REPLAY_MODE_NONE && !named)
		return EC_REPLAY_WHY_OFF;
	if (u->write & EC_WRITE_DROPPED)
		return EC_REPLAY_WHY_LIMIT;
	if (READ_ONCE(u->write) & EC_WRITE_OWN)
		return EC_REPLAY_WHY_OWN;
	if (startup_is_later(c, u))
		return EC_REPLAY_WHY_STARTUP;
	if (u->type == EC_STARTUP_REG)
		return ec_replay_register_why(u->index, u->size);
	if (named || mode == EC_REPLAY_MODE_ALL)
		return EC_REPLAY_WHY_NONE;
	why = u->type == EC_STARTUP_SDO ? ec_replay_sdo_why(u->index) :
					  ec_replay_idn_why(u->index);
	return why ?: is_output(c, u) ? EC_REPLAY_WHY_OUTPUT : EC_REPLAY_WHY_NONE;
}

/* Has the slave returned since it had what the application has written? */
static bool has_returned(const struct ec_slave *s, const struct ec_config *c)
{
	return c && READ_ONCE(c->replay.was_op) && !ec_setup_of(s)->replayed;
}

/* Not what the application itself wants so, or has written meanwhile. */
static bool is_worth_a_word(enum ec_replay_why why)
{
	return why != EC_REPLAY_WHY_NONE && why != EC_REPLAY_WHY_OFF &&
	       why != EC_REPLAY_WHY_STARTUP && why != EC_REPLAY_WHY_OWN;
}

static size_t object_text(const struct ec_startup *u, char *buf, size_t size)
{
	if (u->type == EC_STARTUP_SDO)
		return scnprintf(buf, size, "0x%04x:%02x", u->index, u->sub);
	if (u->type == EC_STARTUP_IDN)
		return scnprintf(buf, size, "IDN 0x%04x", u->index);
	return scnprintf(buf, size, "register 0x%04x", u->index);
}

/* What was not replayed, as many as there is a place for. */
static void note_rest(struct ec_slave *s, const struct ec_config *c, u32 n)
{
	char text[EC_UAPI_WARNING - 72] = "";
	const struct ec_startup *u;
	u32 shown = 0;
	size_t len = 0;

	lockdep_assert_held(&s->lock);
	list_for_each_entry(u, &c->replay.writes, list) {
		enum ec_replay_why why = ec_replay_why(c, u);

		if (!is_worth_a_word(why))
			continue;
		if (len + 60 > sizeof(text))
			break;
		len += scnprintf(text + len, sizeof(text) - len, "%s", shown++ ? ", " : "");
		len += object_text(u, text + len, sizeof(text) - len);
		len += scnprintf(text + len, sizeof(text) - len, " (%s)", ec_replay_why_text(why));
	}
	ec_slave_set_warning(s, "returned, %u write(s) of the application not replayed: %s%s", n,
			     text, shown < n ? "; see config -v" : "");
	ec_slave_info(s, "%s\n", s->note.warning);
}

static bool changes_pdos(const struct ec_startup *u)
{
	return u->type == EC_STARTUP_SDO &&
	       (u->index == EC_PDO_MODULES || ec_pdo_is_mapping(u->index) ||
		ec_pdo_is_assign(u->index));
}

/**
 * ec_replay_run() - write what the application has written, if the slave has returned
 * @s: slave in PREOP
 * @c: its configuration
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: as ec_startup_run().
 */
struct ec_result ec_replay_run(struct ec_slave *s, const struct ec_config *c)
{
	struct ec_result r = { 0 };
	const struct ec_startup *u;
	u32 rest = 0;

	lockdep_assert_held(&s->lock);
	if (!has_returned(s, c))
		return r;
	list_for_each_entry(u, &c->replay.writes, list) {
		enum ec_replay_why why = ec_replay_why(c, u);

		rest += is_worth_a_word(why);
		if (why != EC_REPLAY_WHY_NONE)
			continue;
		r = ec_startup_write(s, u);
		if (r.err)
			return r;
		if (changes_pdos(u))
			WRITE_ONCE(s->pdos.known, false);
	}
	ec_setup_of(s)->replayed = true;
	if (rest)
		note_rest(s, c, rest);
	return r;
}

/**
 * ec_replay_forget() - a slave may have lost what was written to it
 * @s: slave that is brought from INIT to another state, or loses its configuration
 *
 * Context: The slave's worker, or process with the lock of the session held.
 */
void ec_replay_forget(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	struct ec_config *c = setup->config;

	lockdep_assert_held(&s->lock);
	setup->replayed = false;
	if (!c || !c->replay.hold)
		return;
	spin_lock(&c->wanted->writes_lock);
	WRITE_ONCE(c->replay.hold, EC_HOLD_NONE);
	spin_unlock(&c->wanted->writes_lock);
	ec_apply_waits_for(s, NULL);
}

/**
 * ec_replay_reached_op() - a slave with an active configuration is in OP
 * @s: slave
 *
 * Context: The slave's worker.
 */
void ec_replay_reached_op(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	struct ec_config *c = setup->config;

	lockdep_assert_held(&s->lock);
	setup->replayed = true;
	if (c->replay.was_op)
		return;
	spin_lock(&c->wanted->writes_lock);
	WRITE_ONCE(c->replay.was_op, true);
	spin_unlock(&c->wanted->writes_lock);
}

/**
 * ec_replay_hold() - hold a slave that has returned, if the application wants that
 * @s: slave in PREOP
 *
 * Context: The slave's worker.
 * Return: 0: it is not held; -EAGAIN: it waits in PREOP, ec_replay_resume() starts the worker
 * again.
 */
int ec_replay_hold(struct ec_slave *s)
{
	struct ec_config *c = ec_setup_of(s)->config;
	struct ec_startup *u;
	bool held;

	lockdep_assert_held(&s->lock);
	if (!has_returned(s, c) || !ec_config_flag(c, EC_FLAG_HOLD))
		return 0;
	if (c->replay.hold == EC_HOLD_NONE) {
		/* of the return before */
		list_for_each_entry(u, &c->replay.writes, list)
			WRITE_ONCE(u->write, u->write & ~EC_WRITE_OWN);
		spin_lock(&c->wanted->writes_lock);
		/* not negative, and not 0 */
		WRITE_ONCE(c->replay.holds, c->replay.holds % S32_MAX + 1);
		WRITE_ONCE(c->replay.hold, EC_HOLD_HELD);
		spin_unlock(&c->wanted->writes_lock);
		ec_slave_info(s, "returned; waits in PREOP for the application (%s)\n",
			      EC_FLAG_HOLD);
	}
	/* what the application wrote meanwhile */
	held = smp_load_acquire(&c->replay.hold) == EC_HOLD_HELD;
	ec_apply_waits_for(s, held ? WAITS : NULL);
	return held ? -EAGAIN : 0;
}

/**
 * ec_replay_held() - is a slave held in PREOP for its application?
 * @c: its configuration
 *
 * Context: Process, lock of the session held.
 * Return: 0: no; else a number for ec_replay_resume(), another one after each return.
 */
int ec_replay_held(const struct ec_config *c)
{
	lockdep_assert_held(c->wanted->lock);
	if (!c->slave || READ_ONCE(c->slave->reply.silent) || READ_ONCE(c->slave->stop.gone))
		return 0;
	return READ_ONCE(c->replay.hold) == EC_HOLD_HELD ? c->replay.holds : 0;
}

/**
 * ec_replay_resume() - the application has written to the slave that is held
 * @c: its configuration
 * @hold: from ec_replay_held()
 *
 * Context: Process, lock of the session held.
 * Return: 0; -ESTALE the slave is not held, or was lost and has returned again since then.
 */
int ec_replay_resume(struct ec_config *c, u32 hold)
{
	bool held;

	lockdep_assert_held(c->wanted->lock);
	spin_lock(&c->wanted->writes_lock);
	held = hold && ec_replay_held(c) == hold;
	if (held)
		/* what was written before */
		smp_store_release(&c->replay.hold, EC_HOLD_RESUMED);
	spin_unlock(&c->wanted->writes_lock);
	if (!held)
		return -ESTALE;
	ec_slave_kick(c->slave);
	return 0;
}
