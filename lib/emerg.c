// SPDX-License-Identifier: LGPL-2.1-or-later
/* Emergencies: a ring in mapped memory, filled by the kernel, emptied here. */
#include <string.h>

#include "ecrt/ecrt_int.h"

/* NULL before activation */
static struct ec_emerg_ring *ring(const struct ec_slave_config *sc)
{
	const struct ec_request_area *area = sc->master->area;

	if (!area || sc->index >= area->ring_count)
		return NULL;
	return (struct ec_emerg_ring *)(sc->master->area_base + area->rings) +
	       sc->index;
}

int ecrt_slave_config_emerg_pop(ec_slave_config_t *sc, uint8_t *target)
{
	struct ec_emerg_ring *r;
	const __u8 *data;
	__u32 tail;

	if (!sc || !target)
		return -EINVAL;
	r = ring(sc);
	if (!r || r->tail == __atomic_load_n(&r->head, __ATOMIC_ACQUIRE))
		return -ENOENT;
	tail = r->tail;
	data = sc->master->area_base + r->data;
	memcpy(target, data + (size_t)(tail % r->count) * EC_EMERG_BYTES,
	       EC_COE_EMERGENCY_MSG_SIZE);
	__atomic_store_n(&r->tail, tail + 1, __ATOMIC_RELEASE);
	return 0;
}

/* The kernel counts on; what was cleared is subtracted here. */
int ecrt_slave_config_emerg_clear(ec_slave_config_t *sc)
{
	struct ec_emerg_ring *r;

	if (!sc)
		return -EINVAL;
	r = ring(sc);
	if (!r)
		return 0;
	sc->overruns = ec_status_read(r->overruns);
	__atomic_store_n(&r->tail, __atomic_load_n(&r->head, __ATOMIC_ACQUIRE),
			 __ATOMIC_RELEASE);
	return 0;
}

int ecrt_slave_config_emerg_overruns(const ec_slave_config_t *sc)
{
	const struct ec_emerg_ring *r;

	if (!sc)
		return -EINVAL;
	r = ring(sc);
	return r ? (int)((ec_status_read(r->overruns) - sc->overruns) &
			 INT32_MAX) : 0;
}
