/* SPDX-License-Identifier: GPL-2.0-only */
/* Open files that read mailbox messages. */
#ifndef EC_MAIL_READERS_H
#define EC_MAIL_READERS_H

#include <linux/workqueue.h>
#include "reader.h"

struct ec_mail_tap;
struct ec_master;

/** struct ec_mail_readers - readers of a master */
struct ec_mail_readers {
	/** @readers: the files; their lock protects @tap and @woken */
	struct ec_readers readers;
	/** @tap: messages, NULL: there is no reader */
	struct ec_mail_tap *tap;
	/** @work: wakes the readers, periodically while there is one */
	struct delayed_work work;
	/** @woken: number of the next message when they were woken last */
	u64 woken;
};

void ec_mail_readers_init(struct ec_master *m);
void ec_mail_readers_exit(struct ec_master *m);

#endif
