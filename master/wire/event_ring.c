// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "event_ring.h"

/**
 * ec_event_ring_put() - add an event
 * @r: ring, no other writer meanwhile
 * @e: event; its number is set
 *
 * Context: Any. RT-safe: one copy of 64 bytes.
 */
void ec_event_ring_put(struct ec_event_ring *r, struct ec_event *e)
{
	u64 head = ec_event_head_read(&r->head);
	union ec_event_place *place = &r->place[head % EC_EVENT_PLACES];
	union ec_event_place from;
	unsigned int i;

	e->number = head;
	from.event = *e;
	/* @head, of the last event, before the data: see ec_event_ring_get() */
	ec_event_wmb();
	for (i = 0; i < ARRAY_SIZE(from.word); i++)
		ec_event_store(&place->word[i], from.word[i]);
	/* the data before @head */
	ec_event_wmb();
	ec_event_head_set(&r->head, head + 1);
}

/**
 * ec_event_ring_head() - number of the next event
 * @r: ring
 *
 * Context: Any. RT-safe.
 * Return: the number, which is the count of events so far.
 */
u64 ec_event_ring_head(const struct ec_event_ring *r)
{
	return ec_event_head_read(&r->head);
}

/**
 * ec_event_ring_oldest() - number of the oldest event that is kept
 * @r: ring
 *
 * Context: Any. RT-safe.
 * Return: the number.
 */
u64 ec_event_ring_oldest(const struct ec_event_ring *r)
{
	u64 head = ec_event_ring_head(r);

	return head > EC_EVENTS_KEPT ? head - EC_EVENTS_KEPT : 0;
}

/* The events from @at to @to are lost for this reader. */
static bool missed(u64 *at, u64 to, struct ec_event *e)
{
	u64 lost = to - *at;

	e->number = *at;
	e->kind = EC_EVENT_MISSED;
	e->slave = EC_EVENT_NO_SLAVE;
	e->reserved = 0;
	memset(e->arg, 0, sizeof(e->arg));
	e->arg[0] = (u32)lost;
	e->arg[1] = (u32)(lost >> 32);
	*at = to;
	return true;
}

/**
 * ec_event_ring_get() - the next event of a reader
 * @r: ring
 * @at: number of the event to read; then that of the next one
 * @e: result, also EC_EVENT_MISSED, whose times are those that the caller has set
 *
 * Context: Any. RT-safe: it never waits for a writer.
 * Return: false: there is no event yet.
 */
bool ec_event_ring_get(const struct ec_event_ring *r, u64 *at, struct ec_event *e)
{
	const union ec_event_place *place = &r->place[*at % EC_EVENT_PLACES];
	u64 oldest = ec_event_ring_oldest(r);
	union ec_event_place to;
	unsigned int i;

	if (*at >= ec_event_ring_head(r))
		return false;
	if (*at < oldest)
		return missed(at, oldest, e);
	/* @head before the data */
	ec_event_rmb();
	for (i = 0; i < ARRAY_SIZE(to.word); i++)
		to.word[i] = ec_event_load(&place->word[i]);
	/* the data before @head: a writer here has set it to *at + EC_EVENT_PLACES before */
	ec_event_rmb();
	oldest = ec_event_ring_oldest(r);
	if (*at < oldest)
		return missed(at, oldest, e);
	*e = to.event;
	++*at;
	return true;
}
