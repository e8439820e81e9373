// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/minmax.h>
#include <linux/slab.h>
#include <linux/string.h>
#include "ethercat_map.h"
#include "../kernel/compat.h"
#include "emerg.h"
#include "mbox.h"

/**
 * ec_emerg_set() - set where the emergencies of a slave go
 * @mb: mailbox of the slave
 * @e: ring; NULL: only to the log. The previous ring is not used afterwards.
 *
 * Context: Process.
 */
void ec_emerg_set(struct ec_mbox *mb, struct ec_emerg *e)
{
	spin_lock(&mb->desk.unasked_lock);
	mb->desk.emerg = e;
	spin_unlock(&mb->desk.unasked_lock);
}

/**
 * ec_emerg_describe() - write the mapped side of a ring again
 * @mb: mailbox of a slave whose emergencies go there, or NULL
 * @e: ring
 * @data: offset of the entries in the mapped memory
 *
 * The application may have written anything there. All is known here as well, except for the
 * number of entries that it has taken. An invalid number is replaced: the ring is empty then.
 *
 * Context: Process; no ec_emerg_set() of @e meanwhile.
 */
void ec_emerg_describe(struct ec_mbox *mb, struct ec_emerg *e, u32 data)
{
	struct ec_emerg_ring *ring = e->ring;

	if (mb)
		spin_lock(&mb->desk.unasked_lock);
	ring->count = e->count;
	ring->data = data;
	ring->reserved = 0;
	WRITE_ONCE(ring->head, e->head);
	WRITE_ONCE(ring->overruns, e->overruns);
	if (e->head - READ_ONCE(ring->tail) > min(e->count, e->head))
		WRITE_ONCE(ring->tail, e->head);
	if (mb)
		spin_unlock(&mb->desk.unasked_lock);
}

static void keep_last(struct ec_mbox *mb, const u8 *message)
{
	struct ec_emergency e = {
		.time_ns = ktime_get_real_ns(), .code = get_unaligned_le16(message),
		.error_register = message[2],
	};

	memcpy(e.data, message + 3, sizeof(e.data));
	raw_spin_lock(&mb->desk.last_lock);
	mb->desk.last[mb->desk.n_last++ % EC_EMERGENCIES] = e;
	raw_spin_unlock(&mb->desk.last_lock);
}

/**
 * ec_emerg_last() - the last emergencies of a slave
 * @mb: mailbox of the slave
 * @entry: result, EC_EMERGENCIES of them, the oldest first
 * @total: result: emergencies since the slave was found
 *
 * Readers of the master call this: the lock that it takes is for copies of the list alone.
 *
 * Context: Process.
 * Return: how many are in @entry.
 */
unsigned int ec_emerg_last(struct ec_mbox *mb, struct ec_emergency *entry, u32 *total)
{
	u32 i, n;

	raw_spin_lock(&mb->desk.last_lock);
	*total = mb->desk.n_last;
	n = min_t(u32, *total, EC_EMERGENCIES);
	for (i = 0; i < n; i++)
		entry[i] = mb->desk.last[(*total - n + i) % EC_EMERGENCIES];
	raw_spin_unlock(&mb->desk.last_lock);
	return n;
}

/**
 * ec_emerg_push() - keep an emergency, also for the application
 * @mb: mailbox of a slave that sent it
 * @message: EC_EMERG_BYTES: code, error register, data (ETG.1000.6 clause 5.6.4)
 *
 * Context: Process.
 */
void ec_emerg_push(struct ec_mbox *mb, const u8 *message)
{
	struct ec_emerg *e;

	keep_last(mb, message);
	spin_lock(&mb->desk.unasked_lock);
	e = mb->desk.emerg;
	if (!e)
		goto out;
	if (e->head - READ_ONCE(e->ring->tail) >= e->count) {
		WRITE_ONCE(e->ring->overruns, ++e->overruns);
		goto out;
	}
	memcpy(e->data + e->head % e->count * EC_EMERG_BYTES, message, EC_EMERG_BYTES);
	/* the message before the head */
	smp_store_release(&e->ring->head, ++e->head);
out:
	spin_unlock(&mb->desk.unasked_lock);
}
