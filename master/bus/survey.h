/* SPDX-License-Identifier: GPL-2.0-only */
/* All slaves, by one pass over them. */
#ifndef EC_MASTER_SURVEY_H
#define EC_MASTER_SURVEY_H

#include "bus.h"

/** struct ec_survey - what the monitor has to know of all slaves */
struct ec_survey {
	/** @replying: slaves that have to reply */
	unsigned int replying;
	/** @state: AL state that these have and shall have; 0: there is none of them */
	u8 state;
	/** @differ: not one state for all, or not all are in the state they shall have */
	bool differ;
	/** @silent: one does not reply any more */
	bool silent;
	/** @chores: one is busy, shall be tried again, or its PDOs are not read yet */
	bool chores;
	/** @exchange: a caller exchanges messages with one */
	bool exchange;
};

bool ec_survey_is_due(const struct ec_slave *s, u64 now);
void ec_survey(const struct ec_bus *bus, struct ec_survey *survey);

#endif
