/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read records: events, or mailbox messages. */
#ifndef EC_READER_H
#define EC_READER_H

#include <linux/fs.h>
#include <linux/list.h>
#include <linux/mutex.h>
#include <linux/poll.h>
#include "../cycle/waiters.h"

struct ec_file;
struct ec_reader;

/** struct ec_reader_kind - what is read */
struct ec_reader_kind {
	/** @size: bytes of a record */
	size_t size;
	/** @kept: records at most at once */
	size_t kept;
	/** @head: number of the next record that does not exist so far */
	u64 (*head)(const struct ec_reader *r);
	/**
	 * @copy: copy record *@at, or the oldest one after it, and set @at to the one after that;
	 * 1, 0: no new record, -EFAULT or -ERESTARTSYS
	 */
	int (*copy)(struct ec_reader *r, u64 *at, void __user *to);
	/** @free: the file is closed, and @r no longer in the list; the lock of the list is held */
	void (*free)(struct ec_reader *r);
};

/** struct ec_readers - readers of one kind */
struct ec_readers {
	/** @lock: protects @list */
	struct mutex lock;
	/** @list: of them */
	struct list_head list;
	/** @count: entries in @list; changes under @lock */
	unsigned int count;
};

/** struct ec_reader - one open file */
struct ec_reader {
	/** @kind: what it reads */
	const struct ec_reader_kind *kind;
	/** @readers: where it is in the list */
	struct ec_readers *readers;
	/** @list: in @readers */
	struct list_head list;
	/** @source: of the records; of @kind */
	const void *source;
	/** @lock: protects @at; one caller reads at a time */
	struct mutex lock;
	/** @at: number of the next record to read */
	aligned_u64 at;
	/** @waiters: callers that wait for a record */
	struct ec_waiters waiters;
};

void ec_readers_init(struct ec_readers *rs);
void ec_readers_wake(struct ec_readers *rs);
void ec_reader_init(struct ec_reader *r, const struct ec_reader_kind *kind, const void *source);
struct ec_reader *ec_reader_new(const struct ec_reader_kind *kind, const void *source);
int ec_reader_enter(struct ec_reader *r, struct ec_readers *rs, struct ec_file *f);
void ec_reader_end(struct ec_file *f);
ssize_t ec_reader_read(struct ec_file *f, char __user *to, size_t size, bool wait);
__poll_t ec_reader_poll(struct ec_reader *r, struct file *filp, poll_table *wait);

#endif
