/* SPDX-License-Identifier: GPL-2.0-only */
/* Inside the transport: the mailboxes of a slave themselves, and messages without a request. */
#ifndef EC_MAILBOX_INT_H
#define EC_MAILBOX_INT_H

#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/minmax.h>
#include "mailbox.h"

/** struct ec_mbox_until - when a waiting caller has to give up */
struct ec_mbox_until {
	/** @ns: time (ktime) */
	u64 ns;
	/** @cancel: NULL, or becomes true when another thread cancels the transfer */
	const bool *cancel;
};

static inline struct ec_mbox_until ec_mbox_until(const struct ec_mbox_limit *l)
{
	return (struct ec_mbox_until){
		ktime_get_ns() + (u64)l->timeout_ms * NSEC_PER_MSEC, l->cancel,
	};
}

/** struct ec_mbox_message - a message to the slave */
struct ec_mbox_message {
	/** @type: enum ec_mbox_type */
	u8 type;
	/** @counter: its own; the slave drops another message with it */
	u8 counter;
	/** @len: bytes behind the header, in ec_mbox_buf.tx */
	u16 len;
	/** @sent: it is in the slave's mailbox, or may be and must not be sent again */
	bool sent;
	/** @lost: a frame with it was lost, so it may be in the mailbox */
	bool lost;
};

/* Short waits first: most slaves answer within a few hundred microseconds. */
static inline void ec_mbox_pause(unsigned int *us)
{
	usleep_range(*us, *us + *us / 4 + 1);
	*us = min(*us * 2, 1000u);
}

/* box.c */
void ec_mbox_begin(struct ec_mbox *mb);
int ec_mbox_off(const struct ec_mbox *mb);
int ec_mbox_over(const struct ec_mbox *mb, const struct ec_mbox_until *u);
int ec_mbox_full(struct ec_mbox *mb);
int ec_mbox_message(struct ec_mbox *mb, struct ec_mbox_message *m, u8 type, size_t len);
int ec_mbox_put(struct ec_mbox *mb, struct ec_mbox_message *m, struct ec_mbox_buf *b);
int ec_mbox_fetch(struct ec_mbox *mb, struct ec_mbox_buf *b, struct ec_mbox_hdr *h, bool blind);
int ec_mbox_error_reply(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx);

/* unasked.c */
bool ec_mbox_unasked(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx);

/* A semaphore has no owner: what can be checked is that there is a holder. */
static inline void ec_mbox_assert_locked(const struct ec_mbox *mb)
{
	lockdep_assert(ec_mbox_in_use(mb));
}

#endif
