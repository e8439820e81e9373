// SPDX-License-Identifier: GPL-2.0-only
/*
 * A sync unit whose outputs another application gives. It exchanges them through three buffers, as
 * the application of the session does with a cycle of the kernel: the holder has one, the cycle has
 * one, and a word has the number of the third. So neither waits for the other.
 */
#include <linux/bitops.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../config/domain.h"
#include "cycle.h"
#include "units_hold.h"

static u8 *buffer(const struct ec_cyc_unit *u, unsigned int n)
{
	return u->buffers + (size_t)n * u->bytes;
}

/* Pass the buffer of the holder to the cycle. */
static void pass(struct ec_cyc_unit *u)
{
	u->back = xchg(&u->word, u->back | EC_EXCHANGE_NEW) & ~EC_EXCHANGE_NEW;
}

/**
 * ec_units_buffers() - make the buffers of a unit that is offered
 * @u: unit
 * @w: its domains
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_units_buffers(struct ec_cyc_unit *u, const struct ec_wanted *w)
{
	lockdep_assert_held(w->lock);
	ec_for_each_domain(d, w)
		if (u->domains >> d->index & 1)
			u->bytes += d->size;
	if (!(u->what.flags & EC_UNIT_FLAG_OFFERED))
		return 0;
	u->buffers = kvcalloc(EC_EXCHANGE_BUFFERS, u->bytes ?: 1, GFP_KERNEL_ACCOUNT);
	u->back = 1;
	u->word = 2;
	return u->buffers ? 0 : -ENOMEM;
}

/**
 * ec_units_clear() - a unit gets a holder: it begins with zeros
 * @u: unit with buffers
 *
 * Context: Process. One caller at a time for @u.
 */
void ec_units_clear(struct ec_cyc_unit *u)
{
	memset(buffer(u, u->back), 0, u->bytes);
	pass(u);
}

/**
 * ec_units_write() - outputs of the holder of a unit
 * @c: active cycle with units
 * @unit: index of one with a holder
 * @data: as many bytes as its domains have, one behind the other
 *
 * Context: Process, lock of the configuration held.
 */
void ec_units_write(struct ec_cycle *c, u32 unit, const void *data)
{
	struct ec_cyc_unit *u = &c->units->unit[unit];

	lockdep_assert_held(c->wanted->lock);
	memcpy(buffer(u, u->back), data, u->bytes);
	pass(u);
}

/* The outputs of the buffer that the cycle has. */
static void copy_outputs(struct ec_cycle *c, const struct ec_cyc_unit *u)
{
	const u8 *from = buffer(u, u->front);
	u64 left;

	for (left = u->domains; left; left &= left - 1) {
		const struct ec_domain *d = c->wanted->domains[__ffs64(left)];
		const struct ec_unit_place *p = &c->units->places[d->index];
		unsigned int i;

		for (i = 0; i < p->outputs; i++)
			memcpy(c->units->image + p->areas[i].offset,
			       from + (p->areas[i].offset - d->offset), p->areas[i].len);
		from += d->size;
	}
}

/**
 * ec_units_take_held() - take the newest outputs of holders
 * @c: active cycle with units that have a holder
 *
 * Context: The cycle owner, in send. RT-safe: bounded by the outputs.
 */
void ec_units_take_held(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->units->n; i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];

		if (!u->held)
			continue;
		if (READ_ONCE(u->word) & EC_EXCHANGE_NEW) {
			u->front = xchg(&u->word, u->front) & ~EC_EXCHANGE_NEW;
			u->unfed = 0;
			u->leased = true;
		}
		if (u->sends == EC_UNIT_SENDS_VALUES)
			copy_outputs(c, u);
	}
}

/* The outputs of a domain that are sent instead, within @size bytes from @from on. */
static void copy_replaced(const struct ec_cyc_units *us, unsigned int domain, u8 *to, u32 from,
			  u32 size)
{
	const struct ec_unit_place *p = &us->places[domain];
	unsigned int i;

	for (i = 0; i < p->outputs; i++) {
		u32 a = max(from, p->areas[i].offset);
		u32 b = min(from + size, p->areas[i].offset + p->areas[i].len);

		if (a < b)
			memcpy(to + (a - from), us->image + a, b - a);
	}
}

/**
 * ec_units_overlay() - put the outputs that are sent instead into an image
 * @c: active cycle with units
 * @image: of all domains
 *
 * Context: The cycle owner. RT-safe: bounded by the outputs.
 */
void ec_units_overlay(const struct ec_cycle *c, u8 *image)
{
	u64 left;

	for (left = c->units->replaced; left; left &= left - 1)
		copy_replaced(c->units, __ffs64(left), image, 0, EC_MAX_IMAGE);
}

/**
 * ec_units_show() - the outputs of a domain that are sent
 * @c: active cycle
 * @d: its domain
 * @to: copy of a part of its data
 * @from: where in the domain that part begins, bytes
 * @size: its bytes
 *
 * Context: Process, lock of the configuration held or after ec_show_begin().
 */
void ec_units_show(const struct ec_cycle *c, const struct ec_domain *d, u8 *to, u32 from, u32 size)
{
	ec_wanted_assert_stays(c->wanted);
	if (c->units && ec_read64(&c->units->replaced) >> d->index & 1)
		copy_replaced(c->units, d->index, to, d->offset + from, size);
}
