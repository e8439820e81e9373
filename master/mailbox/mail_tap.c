// SPDX-License-Identifier: GPL-2.0-only
/*
 * The ring of messages, as that of events (master/wire/event_ring.h): writers take a raw spinlock
 * for one copy, allocate nothing and wake no reader. Readers copy a record without a lock and see
 * by @head whether its place may have been written meanwhile.
 */
#include <linux/ktime.h>
#include <linux/vmalloc.h>
#include "mail_tap.h"

/**
 * ec_mail_tap_new() - allocate a ring for the messages of a master
 * @next: number of the first message
 *
 * Context: Process. May sleep.
 * Return: the ring, to be freed with kvfree_rcu(); NULL: no memory.
 */
struct ec_mail_tap *ec_mail_tap_new(u64 next)
{
	struct ec_mail_tap *t = __vmalloc(sizeof(*t), GFP_KERNEL_ACCOUNT | __GFP_ZERO);

	if (!t)
		return NULL;
	raw_spin_lock_init(&t->lock);
	atomic64_set(&t->head, next);
	return t;
}

static void mail_tap_store(struct ec_mail_tap *t, union ec_mail_place *from)
{
	union ec_mail_place *place;
	unsigned long irq;
	unsigned int i;
	u64 head;

	raw_spin_lock_irqsave(&t->lock, irq);
	head = ec_mail_tap_head(t);
	place = &t->place[head % EC_MAIL_PLACES];
	from->mail.number = head;
	/* with the lock, so that times are in the order of numbers */
	from->mail.time_ns = ktime_get_ns();
	from->mail.wall_ns = ktime_get_real_ns();
	/* @head, of the last message, before the data */
	smp_wmb();
	for (i = 0; i < ARRAY_SIZE(from->word); i++)
		WRITE_ONCE(place->word[i], from->word[i]);
	/* the data before @head */
	smp_wmb();
	atomic64_set(&t->head, head + 1);
	raw_spin_unlock_irqrestore(&t->lock, irq);
}

/**
 * ec_mail_tap_put() - a message has passed
 * @base: of the master
 * @station: station address of the slave
 * @flags: EC_MAIL_*
 * @bytes: the message from its mailbox header
 * @size: bytes there
 *
 * Call it only if ec_mail_tap_wanted().
 *
 * Context: Any but NMI. RT-safe: one copy of 192 bytes, no sleep, no allocation.
 */
void ec_mail_tap_put(const struct ec_base *base, u16 station, u32 flags, const u8 *bytes,
		     u16 size)
{
	union ec_mail_place from = { .mail = {
		.flags = flags, .station = station, .size = size,
		.kept = min_t(u16, size, EC_MAIL_DATA),
	} };
	struct ec_mail_tap *t;

	memcpy(from.mail.data, bytes, from.mail.kept);
	rcu_read_lock();
	t = rcu_dereference(base->mail_tap);
	if (t)
		mail_tap_store(t, &from);
	rcu_read_unlock();
}

static u64 mail_tap_oldest(const struct ec_mail_tap *t)
{
	u64 head = ec_mail_tap_head(t);

	return head > EC_MAILS_KEPT ? head - EC_MAILS_KEPT : 0;
}

/* Copy message @at; false: its place may be that of a newer one. */
static bool mail_tap_load(const struct ec_mail_tap *t, u64 at, union ec_mail_place *to)
{
	const union ec_mail_place *place = &t->place[at % EC_MAIL_PLACES];
	unsigned int i;

	/* @head before the data */
	smp_rmb();
	for (i = 0; i < ARRAY_SIZE(to->word); i++)
		to->word[i] = READ_ONCE(place->word[i]);
	/* the data before @head */
	smp_rmb();
	return at >= mail_tap_oldest(t);
}

/**
 * ec_mail_tap_get() - the next message of a reader
 * @t: ring
 * @at: number of the message to read; then that of the next one
 * @m: result, without @position
 *
 * Context: Any. It never waits for a writer.
 * Return: false: there is no message yet.
 */
bool ec_mail_tap_get(const struct ec_mail_tap *t, u64 *at, struct ec_mail *m)
{
	u64 oldest, missed = 0;
	union ec_mail_place to;

	if (*at >= ec_mail_tap_head(t))
		return false;
	do {
		oldest = mail_tap_oldest(t);
		if (*at < oldest) {
			missed += oldest - *at;
			*at = oldest;
		}
	} while (!mail_tap_load(t, *at, &to));
	*m = to.mail;
	m->missed = missed;
	++*at;
	return true;
}
