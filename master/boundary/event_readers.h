/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read events. */
#ifndef EC_EVENT_READERS_H
#define EC_EVENT_READERS_H

#include <linux/fs.h>
#include <linux/list.h>
#include <linux/mutex.h>
#include <linux/poll.h>
#include <linux/workqueue.h>
#include "../cycle/waiters.h"

struct ec_events;
struct ec_file;
struct ec_master;

/**
 * struct ec_event_readers - readers of a master
 * @lock: protects @list
 * @list: open files that read events
 * @count: entries in @list
 * @work: wakes them
 * @woken: number of the next event when they were woken last; for the monitor only
 */
struct ec_event_readers {
	struct mutex lock;
	struct list_head list;
	unsigned int count;
	struct work_struct work;
	u64 woken;
};

/**
 * struct ec_event_reader - one open file
 * @list: in struct ec_event_readers
 * @events: of the master
 * @lock: protects @at; one caller reads at a time
 * @at: number of the next event to read
 * @waiters: callers that wait for an event
 */
struct ec_event_reader {
	struct list_head list;
	const struct ec_events *events;
	struct mutex lock;
	aligned_u64 at;
	struct ec_waiters waiters;
};

void ec_event_readers_init(struct ec_master *m);
void ec_event_readers_exit(struct ec_master *m);
void ec_event_readers_kick(struct ec_master *m);
void ec_event_reader_end(struct ec_file *f);
ssize_t ec_event_reader_read(struct ec_file *f, char __user *to, size_t size, bool wait);
__poll_t ec_event_reader_poll(struct ec_event_reader *r, struct file *filp, poll_table *wait);

#endif
