// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Emergencies: a ring in shared memory. The master fills it, the application empties it. */
#include "ecrt_int.h"

int ecrt_slave_config_emerg_pop(ec_slave_config_t *sc, uint8_t *target)
{
	struct ec_emerg e;
	__u32 tail;

	if (!sc || !target)
		return -EINVAL;
	if (!ec_emerg_get(sc, &e) || !e.count)
		return -ENOENT;
	tail = ec_status_read(e.ring->tail);
	/* the head is read before the message */
	if (tail == ec_load_acquire(&e.ring->head))
		return -ENOENT;
	memcpy(target, e.data + (size_t)(tail % e.count) * EC_EMERG_BYTES,
	       EC_COE_EMERGENCY_MSG_SIZE);
	/* the place is free once the message is copied */
	ec_store_release(&e.ring->tail, tail + 1);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_pop);

/* The master never resets its count of lost emergencies: subtract what was cleared. */
int ecrt_slave_config_emerg_clear(ec_slave_config_t *sc)
{
	struct ec_emerg e;

	if (!sc)
		return -EINVAL;
	if (!ec_emerg_get(sc, &e))
		return 0;
	*ec_emerg_cleared(sc) = ec_status_read(e.ring->overruns);
	/* all places are free: the head is read, then the tail written */
	ec_store_release(&e.ring->tail, ec_load_acquire(&e.ring->head));
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_clear);

int ecrt_slave_config_emerg_overruns(const ec_slave_config_t *sc)
{
	struct ec_emerg e;

	if (!sc)
		return -EINVAL;
	if (!ec_emerg_get(sc, &e))
		return 0;
	return (ec_status_read(e.ring->overruns) - *ec_emerg_cleared(sc)) & INT_MAX;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_overruns);
