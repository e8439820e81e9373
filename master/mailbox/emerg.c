// SPDX-License-Identifier: GPL-2.0-only
#include <linux/minmax.h>
#include <linux/slab.h>
#include <linux/string.h>
#include "emerg.h"
#include "mailbox.h"
#include "../bus/slave.h"

/**
 * ec_emerg_set() - where the emergencies of a slave go from now on
 * @slave: slave
 * @e: ring; NULL: only to the log. Nobody uses the one before afterwards.
 *
 * Context: Process.
 */
void ec_emerg_set(struct ec_slave *slave, struct ec_emerg *e)
{
	spin_lock(&slave->emerg_lock);
	slave->emerg = e;
	spin_unlock(&slave->emerg_lock);
}

/**
 * ec_emerg_describe() - write the mapped side of a ring anew
 * @slave: slave whose emergencies go there, or NULL
 * @e: ring
 * @data: offset of the entries in the mapped memory
 *
 * Of what the application can write only the number of those it has taken is not
 * known here. It stays, unless there cannot be so many left: then none is.
 *
 * Context: Process, session_lock held.
 */
void ec_emerg_describe(struct ec_slave *slave, struct ec_emerg *e, u32 data)
{
	struct ec_emerg_ring *ring = e->ring;

	if (slave)
		spin_lock(&slave->emerg_lock);
	ring->count = e->count;
	ring->data = data;
	ring->reserved = 0;
	WRITE_ONCE(ring->head, e->head);
	WRITE_ONCE(ring->overruns, e->overruns);
	if (e->head - READ_ONCE(ring->tail) > min(e->count, e->head))
		WRITE_ONCE(ring->tail, e->head);
	if (slave)
		spin_unlock(&slave->emerg_lock);
}

/**
 * ec_emerg_push() - keep an emergency for the application
 * @slave: slave that sent it
 * @message: EC_EMERG_BYTES: code, error register, data (ETG.1000.6 5.6.4)
 *
 * Context: Process.
 */
void ec_emerg_push(struct ec_slave *slave, const u8 *message)
{
	struct ec_emerg *e;

	spin_lock(&slave->emerg_lock);
	e = slave->emerg;
	if (!e)
		goto out;
	if (e->head - READ_ONCE(e->ring->tail) >= e->count) {
		WRITE_ONCE(e->ring->overruns, ++e->overruns);
		goto out;
	}
	memcpy(e->data + e->head % e->count * EC_EMERG_BYTES, message, EC_EMERG_BYTES);
	smp_store_release(&e->ring->head, ++e->head);
out:
	spin_unlock(&slave->emerg_lock);
}

/**
 * ec_emerg_poll() - look whether the slave has sent one
 * @slave: slave
 *
 * While somebody else uses the mailbox there is nothing to do: who waits for
 * an answer takes emergencies, too.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_emerg_poll(struct ec_slave *slave)
{
	struct ec_mbox_buf *b;

	if (!ec_slave_has_mailbox(slave) || slave->gone ||
	    (READ_ONCE(slave->al_status) & EC_AL_STATE_MASK) < EC_AL_PREOP ||
	    down_trylock(&slave->mbox_lock))
		return;
	b = kmalloc(sizeof(*b), GFP_KERNEL);
	if (b)
		ec_mbox_drain(slave, b);
	kfree(b);
	up(&slave->mbox_lock);
}
