/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox transport of a slave: requests and their answers, messages without a request. */
#ifndef EC_MAILBOX_H
#define EC_MAILBOX_H

#include <linux/list.h>
#include <linux/semaphore.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/wait.h>
#include "ethercat.h"
#include "../base/stop.h"
#include "../wire/al.h"
#include "../wire/mbox.h"
#include "../wire/sii.h"

struct ec_emerg;
struct ec_links;

#define EC_MBOX_MAX	1486	/* one datagram */
#define EC_MBOX_READ_TRIES	4	/* of what changes nothing, after lost frames */
#define EC_MBOX_KEPT	16	/* messages kept for their reader */

enum ec_mbox_flag {
	EC_MBOX_FILE,	/* a file is transferred */
};

/** struct ec_mbox - mailbox of a slave */
struct ec_mbox {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @links: way to the slave, immutable */
	struct ec_links *links;
	/** @stop: what ends exchanges, immutable */
	const struct ec_stop *stop;
	/** @sii: mailboxes and protocols that the slave has, immutable */
	const struct ec_sii_info *sii;
	/** @al_status: below PREOP there is no mailbox; pointer immutable */
	const u16 *al_status;
	/** @position: ring position, for the log; pointer immutable */
	const u16 *position;
	/** @station: station address, immutable */
	u16 station;

	/** @strict: the slave refuses SM1 with an event; of who brings it to its state */
	bool strict;

	/** @sdo_lock: one SDO transfer at a time; see ec_mbox_lock() */
	struct semaphore sdo_lock;
	/** @lock: one exchange at a time; protects the members up to @answered */
	struct semaphore lock;
	/** @counter: of the last message sent */
	u8 counter;
	/** @seen: counter of the last message received */
	u8 seen;
	/** @counts: the slave counts its messages */
	bool counts;
	/** @can_repeat: what is lost can be repeated, both ways; set before there are users */
	bool can_repeat;
	/** @gap: a message of the slave may have been lost */
	bool gap;
	/** @asked: it has been asked to repeat it, not acknowledged so far */
	bool asked;
	/** @want: value of that repeat request */
	bool want;
	/** @unseen: the acknowledgement had that value before */
	bool unseen;
	/** @repeats: the slave has been made to repeat its last message */
	bool repeats;
	/** @ack_fails: repeat requests without acknowledgement in a row */
	u8 ack_fails;
	/** @answered: the last exchange has ended with its answer */
	bool answered;
	/** @renew: the slave has been in INIT: the next holder of @lock resets these members */
	bool renew;

	/** @flags: bits EC_MBOX_... */
	unsigned long flags;

	/** @awaits: lock that the slave's worker waits for, NULL: none */
	const struct semaphore *awaits;
	/** @turn: callers that wait until the worker has that lock */
	wait_queue_head_t turn;

	/** @unasked_lock: protects the members below and what @emerg points to */
	spinlock_t unasked_lock;
	/** @emerg: where emergencies go, NULL: only to the log */
	struct ec_emerg *emerg;
	/** @last: the last emergencies, entry n of them at n % EC_EMERGENCIES */
	struct ec_emergency last[EC_EMERGENCIES];
	/** @n_last: emergencies so far */
	u32 n_last;
	/** @kept: VoE messages, the oldest first */
	struct list_head kept;
	/** @n_kept: entries in @kept */
	unsigned int n_kept;
	/** @keep_voe: the application has VoE handlers */
	bool keep_voe;
};

/**
 * struct ec_mbox_buf - buffers of one exchange
 * @tx: message behind the mailbox header
 * @rx: answer behind the mailbox header
 * @raw: a whole mailbox as the slave has it
 */
struct ec_mbox_buf {
	u8 tx[EC_MBOX_MAX];
	u8 rx[EC_MBOX_MAX];
	u8 raw[EC_MBOX_MAX];
};

/**
 * struct ec_mbox_limit - when a transfer has to give up
 * @timeout_ms: per message, 0: the protocol's default
 * @cancel: NULL, or becomes true when another thread cancels the transfer
 */
struct ec_mbox_limit {
	u32 timeout_ms;
	const bool *cancel;
};

/**
 * struct ec_mbox_request - a message to the slave that has an answer
 * @type: enum ec_mbox_type
 * @first: of a transfer: replies to earlier ones are discarded
 * @limit: for the answer; @timeout_ms is not 0
 * @rx: takes each message of @type: 0 and EC_MORE end the wait, EC_STALE
 *	goes on, EC_WAIT goes on with a new time limit, or -errno
 * @ctx: for @rx
 */
struct ec_mbox_request {
	u8 type;
	bool first;
	struct ec_mbox_limit limit;
	int (*rx)(void *ctx, const u8 *rx, size_t len);
	void *ctx;
};

#define ec_mbox_warn(mb, fmt, ...) \
	ec_log_event((mb)->base, *(mb)->position, 0, KERN_WARNING, fmt, ##__VA_ARGS__)
#define ec_mbox_dbg_result(mb, ret, fmt, ...) \
	ec_dbg_slave_result((mb)->base, *(mb)->position, ret, fmt, ##__VA_ARGS__)

/* Does the slave have a mailbox? */
static inline bool ec_mbox_present(const struct ec_mbox *mb)
{
	return mb->sii->protocols && mb->sii->std.rx_size && mb->sii->std.tx_size;
}

/* Does a caller exchange messages with the slave now? */
static inline bool ec_mbox_in_use(const struct ec_mbox *mb)
{
	return !READ_ONCE(mb->lock.count);
}

/* The mailbox in use: BOOT has one of its own. */
static inline const struct ec_sii_mbox *ec_mbox_area(const struct ec_mbox *mb)
{
	bool boot = (READ_ONCE(*mb->al_status) & EC_AL_STATE_MASK) == EC_AL_BOOT;

	return boot ? &mb->sii->boot : &mb->sii->std;
}

/* Bytes that a mailbox holds behind its header. */
static inline size_t ec_mbox_room(u16 size)
{
	return clamp_t(size_t, size, EC_MBOX_HDR, EC_MBOX_MAX) - EC_MBOX_HDR;
}

/* the limit that a caller has set, if any, with the protocol's timeout as default */
static inline struct ec_mbox_limit ec_mbox_limit(const struct ec_mbox_limit *set, u32 timeout_ms)
{
	struct ec_mbox_limit limit = set ? *set : (struct ec_mbox_limit){ 0 };

	limit.timeout_ms = limit.timeout_ms ?: timeout_ms;
	return limit;
}

void ec_mbox_init(struct ec_mbox *mb);
unsigned int ec_mbox_sms(const struct ec_mbox *mb, bool boot, u8 *page);
void ec_mbox_reset(struct ec_mbox *mb);
int ec_mbox_lock(struct ec_mbox *mb, struct semaphore *lock, u32 ms);
int ec_mbox_check(const struct ec_mbox *mb, u16 protocol, size_t message);
struct ec_mbox_buf *ec_mbox_alloc(const struct ec_mbox *mb, u16 protocol, size_t message);
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len);
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit);
void ec_mbox_send_last(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len);
int ec_mbox_drain(struct ec_mbox *mb, struct ec_mbox_buf *b);
int ec_mbox_forget(struct ec_mbox *mb);
bool ec_mbox_poll(struct ec_mbox *mb);

/* VoE: messages without a request */
void ec_mbox_keep_voe(struct ec_mbox *mb, bool on);
int ec_mbox_wait_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind,
		     const struct ec_mbox_limit *limit);

/* Nothing was to be changed, so a lost frame has left nothing unknown. */
static inline int ec_mbox_read_result(int ret)
{
	return ret == -ENOTRECOVERABLE ? -ETIMEDOUT : ret;
}

/* mbox_text.c */
const char *ec_mbox_fail_text(int ret, const char *protocol, char *buf, size_t size);

#endif
