/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox transport of a slave: send, poll, fetch, counter, demultiplex. */
#ifndef EC_MAILBOX_H
#define EC_MAILBOX_H

#include <linux/types.h>

struct ec_slave;
struct semaphore;

#define EC_MBOX_MAX	1486	/* one datagram */
#define EC_MBOX_KEPT	16	/* messages kept for who reads them later */

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

/**
 * struct ec_mbox_limit - when a transfer has to give up
 * @timeout_ms: per message, 0: the protocol's default
 * @cancel: NULL, or set to true by somebody who wants it to end
 */
struct ec_mbox_limit {
	u32 timeout_ms;
	const bool *cancel;
};

/**
 * struct ec_mbox_ask - a question to the slave
 * @type: enum ec_mbox_type
 * @first: of a transfer: what an earlier one has left is thrown away
 * @timeout_ms: for the answer
 * @cancel: as in struct ec_mbox_limit
 * @rx: looks at each message of @type: 0 and EC_MORE end the wait, EC_STALE
 *	goes on, EC_WAIT goes on with a new time limit, or -errno
 * @ctx: for @rx
 */
struct ec_mbox_ask {
	u8 type;
	bool first;
	u32 timeout_ms;
	const bool *cancel;
	int (*rx)(void *ctx, const u8 *rx, size_t len);
	void *ctx;
};

int ec_mbox_lock(struct ec_slave *slave, struct semaphore *lock, u32 ms);
int ec_mbox_check(const struct ec_slave *slave, u16 protocol, size_t message);
int ec_mbox_ask(struct ec_slave *slave, const struct ec_mbox_ask *a, struct ec_mbox_buf *b,
		size_t len);
int ec_mbox_tell(struct ec_slave *slave, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit);
int ec_mbox_drain(struct ec_slave *slave, struct ec_mbox_buf *b);
int ec_mbox_forget(struct ec_slave *slave);

/* VoE: messages nobody has asked for */
void ec_mbox_keep_voe(struct ec_slave *slave, bool on);
int ec_mbox_wait_voe(struct ec_slave *slave, struct ec_mbox_buf *b, bool blind,
		     const struct ec_mbox_limit *limit);

/* mbox_text.c */
const char *ec_mbox_fail_text(int ret, const char *protocol, char *buf, size_t size);

#endif
