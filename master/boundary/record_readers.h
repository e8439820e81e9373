/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read records of process data. */
#ifndef EC_RECORD_READERS_H
#define EC_RECORD_READERS_H

#include <linux/workqueue.h>
#include "reader.h"

struct ec_master;
struct ec_recorder;

/** struct ec_record_readers - readers of a master */
struct ec_record_readers {
	/** @readers: the files; their lock protects all below */
	struct ec_readers readers;
	/** @ring: of the newest session that has a reader, or NULL */
	struct ec_recorder *ring;
	/** @rings: how many there are, with those of ended sessions that have readers */
	unsigned int rings;
	/** @read_only: readers whose file is opened for reading only */
	unsigned int read_only;
	/** @next: number of the first record of the next ring */
	u64 next;
	/** @work: wakes the readers, periodically while there is one */
	struct delayed_work work;
};

void ec_record_readers_init(struct ec_master *m);
void ec_record_readers_exit(struct ec_master *m);

#endif
