// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "border.h"
#include "known.h"
#include "slave.h"

#define MAX_FOUND	64	/* ports; what is behind others is kept out, but not listed */

/**
 * ec_border_set() - what the application expects at ports
 * @bus: bus
 * @signs: from kvcalloc(), @bus frees it
 * @n: how many
 * @waiting: a slave at whose port one is expected is not connected
 *
 * Context: Process.
 */
void ec_border_set(struct ec_bus *bus, struct ec_border_sign *signs, unsigned int n, bool waiting)
{
	struct ec_border *b = &bus->border;
	unsigned long flags;

	raw_spin_lock_irqsave(&b->lock, flags);
	swap(b->signs, signs);
	b->n_signs = n;
	b->waiting = waiting;
	raw_spin_unlock_irqrestore(&b->lock, flags);
	kvfree(signs);
}

static struct ec_border_found *border_find(struct ec_border *b, u64 device, unsigned int port)
{
	struct ec_border_found *f;

	lockdep_assert_held(&b->lock);
	list_for_each_entry(f, &b->found, list)
		if (f->device == device && f->port == port)
			return f;
	return NULL;
}

static bool is_named(const struct ec_border *b, u64 device, unsigned int port)
{
	unsigned int i;

	lockdep_assert_held(&b->lock);
	for (i = 0; i < b->n_signs; i++)
		if (device && b->signs[i].device == device && b->signs[i].port == port)
			return true;
	return false;
}

/* At a port that groups name only these count, at others the groups that may be anywhere. */
static bool sign_counts(const struct ec_border_sign *sign, bool named, u64 device,
			unsigned int port)
{
	return named ? sign->device == device && sign->port == port : !sign->device;
}

/**
 * ec_border_asks() - has a device behind a port to be known before it is let in?
 * @bus: bus
 * @device: number of the slave, 0: it is new itself
 * @port: its port
 *
 * Context: Any.
 * Return: EC_BORDER_*, or 0: any device is let in.
 */
unsigned int ec_border_asks(struct ec_bus *bus, u64 device, unsigned int port)
{
	struct ec_border *b = &bus->border;
	unsigned int i, asks = 0;
	unsigned long flags;
	bool named;

	if (b->mode == EC_BORDER_OPEN)
		return 0;
	raw_spin_lock_irqsave(&b->lock, flags);
	named = is_named(b, device, port);
	if (named || b->mode == EC_BORDER_CLOSED)
		asks = EC_BORDER_ASKS;
	for (i = 0; asks && i < b->n_signs; i++)
		if (sign_counts(&b->signs[i], named, device, port) &&
		    b->signs[i].by == EC_GROUP_BY_ID)
			asks |= EC_BORDER_ID;
	raw_spin_unlock_irqrestore(&b->lock, flags);
	return asks;
}

/**
 * ec_border_may_be() - may a port be one at which a group is expected?
 * @bus: bus
 * @device: number of the slave; 0: it is not known which one it is
 * @port: its port
 *
 * Context: Any.
 * Return: false: certainly not.
 */
bool ec_border_may_be(struct ec_bus *bus, u64 device, unsigned int port)
{
	struct ec_border *b = &bus->border;
	unsigned long flags;
	bool may;

	if (b->mode == EC_BORDER_OPEN)
		return false;
	raw_spin_lock_irqsave(&b->lock, flags);
	may = b->waiting || is_named(b, device, port);
	raw_spin_unlock_irqrestore(&b->lock, flags);
	return may;
}

static bool same_identity(const struct ec_behind *a, const struct ec_behind *b)
{
	return a->vendor == b->vendor && a->product == b->product &&
	       a->revision == b->revision && a->serial == b->serial;
}

/* Has a slave of the bus the same alias or identification? */
static bool has_twin(const struct ec_bus *bus, const struct ec_border_sign *sign)
{
	ec_for_each_slave(s, bus)
		if (sign->by == EC_GROUP_BY_ID ?
		    READ_ONCE(s->identification) == sign->value : s->alias == sign->value)
			return true;
	return false;
}

/* Is it what is expected? EC_PORT_*: the more of it fits, the larger is the reason. */
static u32 border_compare(const struct ec_border_sign *sign, const struct ec_behind *is)
{
	if ((sign->vendor || sign->product) &&
	    (sign->vendor != is->vendor || sign->product != is->product))
		return EC_PORT_OTHER;
	if (sign->by == EC_GROUP_BY_ALIAS && sign->value != is->alias)
		return EC_PORT_SIGN;
	if (sign->by == EC_GROUP_BY_ID && sign->value != is->identification)
		return EC_PORT_SIGN;
	return sign->serial && sign->serial != is->serial ? EC_PORT_SERIAL : EC_PORT_NOT_KEPT;
}

/* The reason of the sign that is nearest to the device; one without reason is copied to @sign. */
static u32 nearest(struct ec_border *b, u64 device, unsigned int port,
		   const struct ec_behind *is, struct ec_border_sign *sign)
{
	bool named = is_named(b, device, port);
	u32 kept = named ? EC_PORT_OTHER : EC_PORT_UNKNOWN;
	unsigned int i;

	lockdep_assert_held(&b->lock);
	for (i = 0; i < b->n_signs; i++) {
		u32 why;

		if (!sign_counts(&b->signs[i], named, device, port))
			continue;
		why = border_compare(&b->signs[i], is);
		if (!why) {
			*sign = b->signs[i];
			return EC_PORT_NOT_KEPT;
		}
		kept = named ? max(kept, why) : kept;
	}
	return kept;
}

static bool was_let_in(struct ec_border *b, u64 device, unsigned int port, u32 kept,
		       const struct ec_behind *is)
{
	const struct ec_border_found *f;
	unsigned long flags;
	bool was;

	raw_spin_lock_irqsave(&b->lock, flags);
	f = border_find(b, device, port);
	was = f && f->let && f->let_in.kept == kept && same_identity(&f->let_in, is);
	raw_spin_unlock_irqrestore(&b->lock, flags);
	return was;
}

/**
 * ec_border_judge() - may a device be let in?
 * @bus: bus
 * @device: number of the slave behind whose port it is, 0: a new one
 * @port: that port
 * @is: device; with @kept if there is a reason already
 *
 * Context: The monitor thread, which alone changes the list of slaves.
 * Return: EC_PORT_NOT_KEPT: it may, as expected or by command; otherwise why not.
 */
u32 ec_border_judge(struct ec_bus *bus, u64 device, unsigned int port, const struct ec_behind *is)
{
	struct ec_border_sign sign = { .by = EC_GROUP_BY_PORT };
	struct ec_border *b = &bus->border;
	unsigned long flags;
	u32 kept = is->kept;

	if (!kept) {
		raw_spin_lock_irqsave(&b->lock, flags);
		kept = nearest(b, device, port, is, &sign);
		raw_spin_unlock_irqrestore(&b->lock, flags);
	}
	if (!kept && sign.by != EC_GROUP_BY_PORT && has_twin(bus, &sign))
		kept = EC_PORT_SECOND;
	return kept && was_let_in(b, device, port, kept, is) ? EC_PORT_NOT_KEPT : kept;
}

/*
 * An entry for another port: the oldest one whose slave is not connected. What a user has let in
 * stays as long as there is another one.
 */
static struct ec_border_found *border_reuse(const struct ec_bus *bus)
{
	const struct ec_border *b = &bus->border;
	struct ec_border_found *f, *let = NULL;

	lockdep_assert_held(&b->lock);
	list_for_each_entry(f, &b->found, list) {
		if (ec_known_connected(bus, f->device))
			continue;
		if (!f->let)
			return f;
		let = let ?: f;
	}
	return let;
}

/**
 * ec_border_note() - a device is behind a port that stays closed
 * @bus: bus
 * @device: number of the slave
 * @port: its port
 * @is: what is behind it
 *
 * Context: The monitor thread. May sleep.
 * Return: whether it is another one than before, or there for another reason.
 */
bool ec_border_note(struct ec_bus *bus, u64 device, unsigned int port, const struct ec_behind *is)
{
	struct ec_border *b = &bus->border;
	struct ec_border_found *f, *more = kzalloc(sizeof(*more), GFP_KERNEL);
	unsigned long flags;
	bool differs = false;

	raw_spin_lock_irqsave(&b->lock, flags);
	f = border_find(b, device, port);
	if (!f && more) {
		struct ec_border_found *old = b->n_found < MAX_FOUND ? NULL : border_reuse(bus);

		if (old) {
			list_del(&old->list);
			b->n_found--;
		}
		if (b->n_found < MAX_FOUND) {
			swap(f, more);
			f->device = device;
			f->port = port;
			list_add_tail(&f->list, &b->found);
			b->n_found++;
		}
		more = more ?: old;
	}
	if (f) {
		differs = f->is.kept != is->kept || !same_identity(&f->is, is);
		f->is = *is;
	}
	raw_spin_unlock_irqrestore(&b->lock, flags);
	kfree(more);
	return differs;
}

/**
 * ec_border_forget() - no device is kept behind a port any more
 * @bus: bus
 * @device: number of the slave
 * @port: its port; what a user has let in there may come again
 *
 * Context: The monitor thread.
 */
void ec_border_forget(struct ec_bus *bus, u64 device, unsigned int port)
{
	struct ec_border *b = &bus->border;
	struct ec_border_found *f;
	unsigned long flags;

	raw_spin_lock_irqsave(&b->lock, flags);
	f = border_find(b, device, port);
	if (f && f->let) {
		f->is = (struct ec_behind){ 0 };
		f = NULL;
	} else if (f) {
		list_del(&f->list);
		b->n_found--;
	}
	raw_spin_unlock_irqrestore(&b->lock, flags);
	kfree(f);
}

/**
 * ec_border_get() - the device behind a port that stays closed
 * @bus: bus
 * @device: number of the slave
 * @port: its port
 * @is: result
 *
 * Context: Any.
 * Return: whether there is one that has been seen.
 */
bool ec_border_get(struct ec_bus *bus, u64 device, unsigned int port, struct ec_behind *is)
{
	struct ec_border *b = &bus->border;
	const struct ec_border_found *f;
	unsigned long flags;

	raw_spin_lock_irqsave(&b->lock, flags);
	f = border_find(b, device, port);
	if (f && f->is.kept)
		*is = f->is;
	else
		f = NULL;
	raw_spin_unlock_irqrestore(&b->lock, flags);
	return f;
}

/**
 * ec_border_let_in() - a user lets the device behind a port in
 * @bus: bus
 * @device: number of the slave
 * @port: its port
 * @what: identity of the device that the user has seen there
 *
 * It holds for this device at this port, until the session ends.
 *
 * Context: Any.
 * Return: 0; -ENOENT: no device is kept behind the port; -ESTALE: it is another one.
 */
int ec_border_let_in(struct ec_bus *bus, u64 device, unsigned int port,
		     const struct ec_behind *what)
{
	struct ec_border *b = &bus->border;
	struct ec_border_found *f;
	unsigned long flags;
	int ret = -ENOENT;

	raw_spin_lock_irqsave(&b->lock, flags);
	f = border_find(b, device, port);
	if (f && f->is.kept) {
		ret = same_identity(&f->is, what) ? 0 : -ESTALE;
		if (!ret) {
			f->let = true;
			f->let_in = f->is;
		}
	}
	raw_spin_unlock_irqrestore(&b->lock, flags);
	return ret;
}
