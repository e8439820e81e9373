/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read events. */
#ifndef EC_EVENT_READERS_H
#define EC_EVENT_READERS_H

#include <linux/workqueue.h>
#include "reader.h"

struct ec_master;

/**
 * struct ec_event_readers - readers of a master
 * @readers: the files
 * @work: wakes them
 * @woken: number of the next event when they were woken last; for the monitor only
 */
struct ec_event_readers {
	struct ec_readers readers;
	struct work_struct work;
	u64 woken;
};

void ec_event_readers_init(struct ec_master *m);
void ec_event_readers_exit(struct ec_master *m);
void ec_event_readers_kick(struct ec_master *m);

#endif
