/* SPDX-License-Identifier: GPL-2.0-only */
/* Faults of an Intel network controller that no interrupt reports. */
#ifndef EC_INTEL_HEALTH_H
#define EC_INTEL_HEALTH_H

#include "nic.h"
#include "ring.h"

/**
 * struct intel_health - what the looks have found so far
 */
struct intel_health {
	/** @second_ns: when the last look was that is made once a second (ktime) */
	u64 second_ns;
	/** @since_ns: since then descriptor @index was not sent (ktime) */
	u64 since_ns;
	/** @index: of the transmit ring */
	unsigned int index;
	/** @looks: that have found it not sent; 0: none is observed */
	unsigned int looks;
	/** @damaged: frames with errors */
	u32 damaged;
	/** @missed: frames without a free buffer */
	u32 missed;
};

bool ec_health_second(struct intel_health *h, u64 now);
bool ec_health_stuck(struct intel_health *h, const struct intel_nic *nic,
		     const struct intel_ring *tx, u64 now);
bool ec_health_count(struct intel_health *h, const struct intel_nic *nic);
void ec_health_clear(struct intel_health *h, const struct intel_nic *nic);

#endif
