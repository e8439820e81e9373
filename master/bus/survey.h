/* SPDX-License-Identifier: GPL-2.0-only */
/* All slaves, by one pass over them. */
#ifndef EC_MASTER_SURVEY_H
#define EC_MASTER_SURVEY_H

#include "bus.h"

/* between two surveys without a counted change, as not every change is counted */
#define EC_SURVEY_NS	NSEC_PER_SEC

/** struct ec_survey - what the monitor has to know of all slaves */
struct ec_survey {
	/** @replying: slaves that have to reply */
	unsigned int replying;
	/** @state: AL state requested for the first of these; 0: there is none of them */
	u8 state;
	/** @differ: not one state requested for all, or not all are in it */
	bool differ;
	/** @silent: one does not reply any more */
	bool silent;
	/** @chores: one is busy, its next attempt is due, or its PDOs are not read yet */
	bool chores;
	/** @exchange: a caller exchanges messages with one */
	bool exchange;
	/** @polled: the mailbox of one has to be polled often */
	bool polled;
	/** @failed: one has failed or does not reply, and will be tried again */
	bool failed;
};

bool ec_survey_is_due(const struct ec_slave *s, u64 now);
bool ec_survey_is_off(const struct ec_slave *s, u16 status);
bool ec_survey_lasts(const struct ec_survey *survey);
void ec_survey(const struct ec_bus *bus, struct ec_survey *survey);

#endif
