// SPDX-License-Identifier: GPL-2.0-only
/* The record of an application's writes: replay_run.c writes them again. */
#include <linux/err.h>
#include "config.h"
#include "replay.h"

/**
 * ec_replay_name() - replay an object in any case
 * @c: configuration
 * @type: EC_STARTUP_SDO or EC_STARTUP_IDN
 * @index: object or IDN
 * @sub: subindex, 0 for complete access; or drive
 *
 * Context: Process, lock of the session held.
 * Return: 0, also if it is named already; -ENOSPC.
 */
int ec_replay_name(struct ec_config *c, u8 type, u16 index, u8 sub)
{
	struct ec_replay *r = &c->replay;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; i < r->n_named; i++)
		if (r->named[i].type == type && r->named[i].index == index &&
		    r->named[i].sub == sub)
			return 0;
	if (i == ARRAY_SIZE(r->named))
		return -ENOSPC;
	r->named[i] = (struct ec_replay_name){ .type = type, .sub = sub, .index = index };
	r->n_named++;
	return 0;
}

/* The configuration in @w that a slave has, or means; in a session that waits it only means it. */
static struct ec_config *replay_config(const struct ec_wanted *w, const struct ec_slave *s)
{
	struct ec_config *has = ec_config_of(s);

	ec_wanted_assert_stays(w);
	if (has && has->wanted == w)
		return has;
	if (w->active)
		return NULL;
	ec_for_each_config(c, w)
		if (c->slave == s)
			return c;
	return NULL;
}

static bool replay_is_open(const struct ec_replay *r)
{
	return !READ_ONCE(r->was_op) || READ_ONCE(r->hold) == EC_HOLD_HELD;
}

/**
 * ec_replay_is_open() - are writes to a slave recorded now?
 * @w: what the application configures
 * @s: slave
 *
 * Context: Process, lock of the session held, or after ec_show_begin().
 * Return: false: its configuration had it in OP already, or it has none in an active session.
 */
bool ec_replay_is_open(const struct ec_wanted *w, struct ec_slave *s)
{
	const struct ec_config *c = replay_config(w, s);

	ec_wanted_assert_stays(w);
	return c ? replay_is_open(&c->replay) : !w->active;
}

static bool replay_same_object(const struct ec_startup *a, const struct ec_startup *b)
{
	return a->type == b->type && a->index == b->index && a->sub == b->sub &&
	       a->complete == b->complete &&
	       (a->type != EC_STARTUP_REG || a->size == b->size);
}

static struct ec_startup *find(const struct ec_replay *r, const struct ec_startup *what)
{
	struct ec_startup *u;

	list_for_each_entry_reverse(u, &r->writes, list)
		if (replay_same_object(u, what) && u->device == what->device)
			return u;
	return NULL;
}

static bool has_value(const struct ec_startup *u)
{
	return u && !(u->write & EC_WRITE_DROPPED);
}

static void release(struct ec_wanted *w, struct ec_startup *u)
{
	lockdep_assert_held(w->lock);
	if (!u)
		return;
	ec_budget_release(&w->budget, struct_size(u, data, has_value(u) ? u->size : 0));
	kvfree(u);
}

/* Exchange an entry for the next one, which is the last write then; both may be NULL. */
static bool replay_replace(struct ec_wanted *w, struct ec_replay *r, struct ec_startup *old,
			   struct ec_startup *next, bool last)
{
	struct list_head *at = old && !last ? old->list.prev : NULL;
	bool open;

	lockdep_assert_held(w->lock);
	spin_lock(&w->writes_lock);
	open = replay_is_open(r);
	if (open && old)
		list_del(&old->list);
	if (open && next)
		list_add(&next->list, at ?: r->writes.prev);
	spin_unlock(&w->writes_lock);
	if (!open)
		return false;
	r->n += !!next - !!old;
	r->n_values += has_value(next) - has_value(old);
	r->bytes += (has_value(next) ? next->size : 0) - (has_value(old) ? old->size : 0);
	return true;
}

/* An entry without value says that there was a write. */
static void drop_value(struct ec_wanted *w, struct ec_replay *r, struct ec_startup *u)
{
	struct ec_startup *next = ec_config_alloc(w, sizeof(*u));

	if (IS_ERR(next)) {
		next = NULL;
	} else {
		*next = *u;
		next->write |= EC_WRITE_DROPPED;
	}
	if (!replay_replace(w, r, u, next, false)) {
		release(w, next);
		return;
	}
	r->forgotten += !next;
	release(w, u);
}

static void keep_limits(struct ec_wanted *w, struct ec_replay *r)
{
	struct ec_startup *u, *after;

	list_for_each_entry_safe(u, after, &r->writes, list) {
		if (r->n_values <= EC_MAX_SC_WRITES && r->bytes <= EC_MAX_SC_WRITE_BYTES)
			break;
		if (has_value(u))
			drop_value(w, r, u);
	}
	u = list_first_entry(&r->writes, typeof(*u), list);
	if (r->n > EC_MAX_SC_LISTED && replay_replace(w, r, u, NULL, false)) {
		r->forgotten++;
		release(w, u);
	}
}

/**
 * ec_replay_record() - record a write that was successful
 * @w: what the application configures
 * @s: slave
 * @what: type, index, sub, complete, and size of @data
 * @data: value
 *
 * A write to a slave that has no configuration is kept until it gets one. The write itself does
 * not fail if there is no memory for its record: then the record has no value of the object.
 *
 * Context: Process, lock of the session held. May sleep.
 */
void ec_replay_record(struct ec_wanted *w, struct ec_slave *s, const struct ec_startup *what,
		      const void *data)
{
	struct ec_config *c = replay_config(w, s);
	struct ec_replay *r = c ? &c->replay : &w->strays;
	struct ec_startup key = *what, *old, *u;

	lockdep_assert_held(w->lock);
	if (!ec_replay_is_open(w, s))
		return;
	key.device = c ? 0 : s->device;
	key.write = EC_WRITE_RECORDED;
	if (!w->active)
		key.write |= EC_WRITE_EARLY;
	if (r->was_op)
		key.write |= EC_WRITE_OWN;
	old = find(r, &key);
	u = ec_config_alloc(w, struct_size(u, data, key.size));
	if (IS_ERR(u)) {
		if (has_value(old))
			drop_value(w, r, old);
		else if (!old)
			r->forgotten++;
		return;
	}
	*u = key;
	memcpy(u->data, data, key.size);
	if (replay_replace(w, r, old, u, true)) {
		release(w, old);
		keep_limits(w, r);
	} else {
		release(w, u);
	}
}

/**
 * ec_replay_adopt() - give a new configuration what was written to its slave before
 * @c: configuration
 *
 * Context: Process, lock of the session held.
 */
void ec_replay_adopt(struct ec_config *c)
{
	struct ec_replay *from = &c->wanted->strays;
	struct ec_startup *u, *after;

	lockdep_assert_held(c->wanted->lock);
	list_for_each_entry_safe(u, after, &from->writes, list) {
		if (!c->slave || u->device != c->slave->device)
			continue;
		replay_replace(c->wanted, from, u, NULL, false);
		u->device = 0;
		replay_replace(c->wanted, &c->replay, NULL, u, true);
	}
}

/**
 * ec_replay_free() - free the record
 * @r: record; its memory is not charged to the session any more
 *
 * Context: Process.
 */
void ec_replay_free(struct ec_replay *r)
{
	struct ec_startup *u, *after;

	list_for_each_entry_safe(u, after, &r->writes, list)
		kvfree(u);
	INIT_LIST_HEAD(&r->writes);
	r->n = 0;
	r->n_values = 0;
	r->bytes = 0;
	r->forgotten = 0;
}
