/* SPDX-License-Identifier: GPL-2.0-only */
/* All slaves, by one pass over them. */
#ifndef EC_MASTER_SURVEY_H
#define EC_MASTER_SURVEY_H

#include "bus.h"

/* slaves that have not changed are looked at so often: there may be a change that does not count */
#define EC_SURVEY_NS	NSEC_PER_SEC

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
	/** @polled: the mailbox of one has to be looked at often */
	bool polled;
	/** @failed: one has failed or does not reply, and will be tried again */
	bool failed;
};

bool ec_survey_is_due(const struct ec_slave *s, u64 now);
bool ec_survey_lasts(const struct ec_survey *survey);
void ec_survey(const struct ec_bus *bus, struct ec_survey *survey);

#endif
