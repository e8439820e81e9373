/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox transport of a slave: send, poll, fetch, counter, demultiplex. */
#ifndef EC_MAILBOX_H
#define EC_MAILBOX_H

#include <linux/types.h>

struct ec_slave;

#define EC_MBOX_MAX	1486	/* one datagram */

/**
 * struct ec_mbox_buf - buffers of one exchange
 * @tx: message behind the mailbox header
 * @rx: answer behind the mailbox header
 */
struct ec_mbox_buf {
	u8 tx[EC_MBOX_MAX];
	u8 rx[EC_MBOX_MAX];
	u8 raw[EC_MBOX_MAX];
};

int ec_mbox_send(struct ec_slave *slave, u8 type, struct ec_mbox_buf *b, size_t len,
		 u64 until_ns);
int ec_mbox_recv(struct ec_slave *slave, u8 type, struct ec_mbox_buf *b, u64 until_ns);
int ec_mbox_drain(struct ec_slave *slave, struct ec_mbox_buf *b);

#endif
