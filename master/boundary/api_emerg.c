// SPDX-License-Identifier: GPL-2.0-only
/* Emergencies, for applications in the kernel: the ring a process would map. */
#include "api.h"
#include "../mailbox/emerg.h"
#include "../session/request.h"

/* NULL before activation */
static struct ec_emerg *ring(const ec_slave_config_t *sc)
{
	struct ec_session *s = ec_api_session(ec_api_master(sc)->api);

	return s ? ec_requests_emerg(s, ec_api_config(sc)->index) : NULL;
}

int ecrt_slave_config_emerg_pop(ec_slave_config_t *sc, uint8_t *target)
{
	struct ec_emerg *e;
	u32 tail;

	if (!sc || !target)
		return -EINVAL;
	e = ring(sc);
	tail = e ? e->ring->tail : 0;
	/* the head before the message, which ec_emerg_take() writes */
	if (!e || tail == smp_load_acquire(&e->ring->head))
		return -ENOENT;
	memcpy(target, e->data + (size_t)(tail % e->count) * EC_EMERG_BYTES, EC_EMERG_BYTES);
	/* the place is free once the message is copied */
	smp_store_release(&e->ring->tail, tail + 1);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_pop);

/* The ring counts on; what was cleared is subtracted. */
int ecrt_slave_config_emerg_clear(ec_slave_config_t *sc)
{
	struct ec_emerg *e;

	if (!sc)
		return -EINVAL;
	e = ring(sc);
	if (!e)
		return 0;
	ec_api_config(sc)->emerg_cleared = READ_ONCE(e->ring->overruns);
	/* all places are free: the head is read, then the tail written */
	smp_store_release(&e->ring->tail, smp_load_acquire(&e->ring->head));
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_clear);

int ecrt_slave_config_emerg_overruns(const ec_slave_config_t *sc)
{
	struct ec_emerg *e;

	if (!sc)
		return -EINVAL;
	e = ring(sc);
	return e ? (READ_ONCE(e->ring->overruns) - ec_api_config(sc)->emerg_cleared) & INT_MAX : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_overruns);
