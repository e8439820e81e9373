/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read events. */
#ifndef EC_EVENT_READERS_H
#define EC_EVENT_READERS_H

#include <linux/workqueue.h>
#include "reader.h"

struct ec_master;

/** struct ec_event_readers - readers of a master */
struct ec_event_readers {
	/** @readers: the files */
	struct ec_readers readers;
	/** @work: wakes them */
	struct work_struct work;
	/** @woken: number of the next event when they were woken last; for the monitor only */
	u64 woken;
};

void ec_event_readers_init(struct ec_master *m);
void ec_event_readers_exit(struct ec_master *m);
void ec_event_readers_kick(struct ec_master *m);

#endif
