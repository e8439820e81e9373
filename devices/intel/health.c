// SPDX-License-Identifier: GPL-2.0-only
#include <linux/time64.h>
#include "health.h"
#include "regs.h"

#define STUCK_NS	(500 * NSEC_PER_MSEC)
#define STUCK_LOOKS	10

/**
 * ec_health_second() - is a look due that is made once a second?
 * @h: health of a controller
 * @now: ktime
 *
 * Context: One caller at a time.
 * Return: whether it is; then the next one is due a second later.
 */
bool ec_health_second(struct intel_health *h, u64 now)
{
	if (now - h->second_ns < NSEC_PER_SEC)
		return false;
	h->second_ns = now;
	return true;
}

/**
 * ec_health_stuck() - does the controller send nothing although it has a link?
 * @h: health of the controller
 * @nic: controller
 * @tx: its transmit ring, which runs
 * @now: ktime
 *
 * Observes one descriptor at a time. Each look that finds it sent ends that; in between the ring
 * may wrap, but not so often that the same one is on its way each time.
 *
 * Context: One caller at a time, beside senders.
 * Return: whether a frame has not left for 500 ms; then the observation begins anew.
 */
bool ec_health_stuck(struct intel_health *h, const struct intel_nic *nic,
		     const struct intel_ring *tx, u64 now)
{
	unsigned int last = (READ_ONCE(tx->tail) - 1) % INTEL_TX;

	if (!nic->up || (h->looks && ec_ring_tx_done(nic, &tx->desc[h->index])))
		h->looks = 0;
	if (!h->looks) {
		if (!nic->up || ec_ring_tx_done(nic, &tx->desc[last]))
			return false;
		h->index = last;
		h->since_ns = now;
	}
	if (++h->looks < STUCK_LOOKS || now - h->since_ns < STUCK_NS)
		return false;
	h->looks = 0;
	return true;
}

/* one that is gone counts nothing */
static u32 counter(const struct intel_nic *nic, u32 reg)
{
	u32 v = ec_nic_read(nic, reg);

	return v == ~0u ? 0 : v;
}

/**
 * ec_health_count() - add the counters of faults, which begin at 0 again
 * @h: health of the controller
 * @nic: controller
 *
 * Context: Process, one caller at a time.
 * Return: whether there were any since @h->damaged and @h->missed were cleared.
 */
bool ec_health_count(struct intel_health *h, const struct intel_nic *nic)
{
	h->damaged += counter(nic, R_CRCERRS) + counter(nic, R_RXERRC);
	h->missed += counter(nic, R_MPC);
	return h->damaged || h->missed;
}

/**
 * ec_health_clear() - forget what was counted so far
 * @h: health of the controller
 * @nic: controller
 *
 * Context: Process, one caller at a time.
 */
void ec_health_clear(struct intel_health *h, const struct intel_nic *nic)
{
	ec_health_count(h, nic);
	h->damaged = 0;
	h->missed = 0;
}
