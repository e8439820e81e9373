/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read mailbox messages. */
#ifndef EC_MAIL_READERS_H
#define EC_MAIL_READERS_H

#include <linux/fs.h>
#include <linux/list.h>
#include <linux/mutex.h>
#include <linux/poll.h>
#include <linux/workqueue.h>
#include "../cycle/waiters.h"

struct ec_file;
struct ec_mail_tap;
struct ec_master;

/**
 * struct ec_mail_readers - readers of a master
 * @lock: protects the other members
 * @list: open files that read messages
 * @tap: messages, NULL: @list is empty
 * @work: wakes the readers, periodically while there is one
 * @woken: number of the next message when they were woken last
 */
struct ec_mail_readers {
	struct mutex lock;
	struct list_head list;
	struct ec_mail_tap *tap;
	struct delayed_work work;
	u64 woken;
};

/**
 * struct ec_mail_reader - one open file
 * @list: in struct ec_mail_readers
 * @master: of the file
 * @tap: messages; stays while the file is in the list
 * @lock: protects @at; one caller reads at a time
 * @at: number of the next message to read
 * @waiters: callers that wait for a message
 */
struct ec_mail_reader {
	struct list_head list;
	struct ec_master *master;
	const struct ec_mail_tap *tap;
	struct mutex lock;
	aligned_u64 at;
	struct ec_waiters waiters;
};

void ec_mail_readers_init(struct ec_master *m);
void ec_mail_readers_exit(struct ec_master *m);
void ec_mail_reader_end(struct ec_file *f);
ssize_t ec_mail_reader_read(struct ec_mail_reader *r, char __user *to, size_t size, bool wait);
__poll_t ec_mail_reader_poll(struct ec_mail_reader *r, struct file *filp, poll_table *wait);

#endif
