/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox of a slave: transport, queue, its users, and what the protocols share. */
#ifndef EC_MBOX_H
#define EC_MBOX_H

#include <linux/bits.h>
#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include "ethercat.h"
#include "../base/stop.h"
#include "box.h"

struct ec_emerg;
struct ec_mbox;

#define EC_MBOX_READ_TRIES	4	/* of a transfer that changes nothing, if frames are lost */
#define EC_MBOX_KEPT	16	/* messages kept for their reader */
#define EC_MBOX_ALL	0xffff	/* all protocols: no other caller uses the mailbox */
#define EC_MBOX_REPLY	10	/* bytes behind the header that a mailbox for replies must hold */
#define EC_MBOX_LATE_MS	30000	/* wait for a reply after its time limit */
#define EC_MBOX_KIB_MS	4000	/* time for a KiB of a transfer: its minimum rate */

enum ec_mbox_flag {
	EC_MBOX_FILE,	/* a file is transferred */
	EC_MBOX_FILE_WRITE,	/* a file is written, firmware perhaps */
};

/**
 * enum ec_mbox_phase - of a user; desk.c and desk_enter.c alone change it
 * @EC_MBOX_USER_IDLE: out of all lists
 * @EC_MBOX_USER_QUEUED: its message waits
 * @EC_MBOX_USER_SENDING: its message is being given to the slave
 * @EC_MBOX_USER_WAITING: for a message of its type
 * @EC_MBOX_USER_DONE: it has its result; another message of its type has to wait
 *
 * =======  ===============  ========  ===========  ==========  ======  =============
 * phase    ec_desk_enter()  its turn  in SM0       its answer  error   ec_desk_
 *                                                  is here             again(),leave()
 * =======  ===============  ========  ===========  ==========  ======  =============
 * IDLE     QUEUED, WAITING
 * QUEUED                    SENDING                                    IDLE
 * SENDING                             WAITING,     DONE        DONE    IDLE
 *                                     DONE
 * WAITING                                          DONE        DONE    IDLE
 * DONE                                                                 QUEUED,
 *                                                                      WAITING, IDLE
 * =======  ===============  ========  ===========  ==========  ======  =============
 */
enum ec_mbox_phase {
	EC_MBOX_USER_IDLE,
	EC_MBOX_USER_QUEUED,
	EC_MBOX_USER_SENDING,
	EC_MBOX_USER_WAITING,
	EC_MBOX_USER_DONE,
};

/**
 * struct ec_mbox_user - user that has a message for the slave, or waits for one
 *
 * It belongs to the user, which sets the members up to @once, and may read the results while it is
 * DONE. From ec_desk_enter() until ec_desk_leave() has returned the others are of desk.c and
 * desk_enter.c, under the lock of the transport. Nothing is allocated for it.
 */
struct ec_mbox_user {
	/**
	 * @done: it is DONE. Once for each ec_desk_enter() and ec_desk_again(), with the lock of
	 * the transport held, where the frame has arrived: possibly in a hard interrupt. So it
	 * takes no sleeping lock, is bounded, and calls nothing of the mailbox but
	 * ec_desk_again(). Never after ec_desk_leave() has returned
	 */
	void (*done)(struct ec_mbox *mb, struct ec_mbox_user *u);
	/** @tx: its message behind the mailbox header */
	const u8 *tx;
	/** @rx: result: message of the slave behind the header; NULL: it only sends */
	u8 *rx;
	/** @len: bytes of @tx; 0: it waits for a message of @type */
	u16 len;
	/** @type: enum ec_mbox_type */
	u8 type;
	/** @answer: its message has an answer */
	bool answer;
	/** @first: read SM1 until it is empty before, unless it must be empty already */
	bool first;
	/** @discard: it has no message: what the slave has sent so far is discarded */
	bool discard;
	/** @once: one access to SM1, then -ENOMSG */
	bool once;

	/** @exchange: it counts as one in struct ec_desk */
	bool exchange;
	/** @phase: enum ec_mbox_phase; may be read without the lock */
	u8 phase;
	/** @got_type: result: @type or EC_MBOX_ERR */
	u8 got_type;
	/** @got: result: bytes of @rx */
	u16 got;
	/** @err: result: 0 or -errno */
	int err;
	/** @list: in the queue, or among the users */
	struct list_head list;
	/** @lost: a frame with its message was lost */
	bool lost;
	/** @gap: a frame was lost that may have had its answer */
	bool gap;
	/** @heard: the slave has sent something else meanwhile: it is not busy with the request */
	bool heard;
};

/**
 * struct ec_desk - mailbox queue: requests that wait, and messages that are kept
 *
 * Under the lock of the transport, except for the last two groups.
 */
struct ec_desk {
	/* of desk.c and desk_enter.c */
	/** @queue: users whose message waits, the oldest first */
	struct list_head queue;
	/** @users: users that wait for messages, the oldest first */
	struct list_head users;
	/** @sending: user whose message the transport has; NULL: none, or it has left */
	struct ec_mbox_user *sending;
	/** @flood_ns: no @fetch before that time (ktime): the slave sends without end */
	u64 flood_ns;
	/** @fetched: messages read because of @fetch */
	u8 fetched;
	/** @fetch: SM1 is read until it is empty, although no user waits */
	bool fetch;
	/** @handed_over: @unasked takes the message that the transport holds */
	bool handed_over;
	/** @answered: no message of an earlier exchange can follow any more */
	bool answered;
	/**
	 * @frame_sent: the last message to the slave is a fragment of EoE: an error reply, which
	 * names no message, is for the user that reads frames, not for a request that waits
	 */
	bool frame_sent;
	/** @ahead: messages without answer written since SM1 was accessed last */
	u8 ahead;
	/** @stride: of them, so many between two accesses to SM1; a power of 2 */
	u8 stride;
	/** @exchanges: users that await an answer; ec_mbox_in_use() reads it without the lock */
	u16 exchanges;

	/* of late.c; a user that gets its answer clears @never_late, INIT clears all */
	/** @never_late: the last late reply was not received: no wait for the next one */
	bool never_late;

	/* of unasked.c, with more below */
	/** @unable: the slave does not repeat, which is to be logged; of desk.c until then */
	bool unable;
	/** @keep_voe: the application has VoE handlers; under @unasked_lock */
	bool keep_voe;
	/** @n_kept: entries in @kept; under @unasked_lock */
	u8 n_kept;

	/* of late.c */
	/** @late_ns: nothing waits for that reply after this time (ktime) */
	u64 late_ns;
	/** @late: BIT(enum ec_mbox_type): the slave has a request whose reply is late */
	u16 late;

	/** @unasked_lock: of unasked.c, protects @kept, and @emerg with what it points to */
	spinlock_t unasked_lock;

	/* of claim.c */
	/** @claimed: BIT(enum ec_mbox_type) of the protocols in use; see ec_mbox_claim() */
	u16 claimed;
	/** @claims: struct ec_claim that wait for a protocol, in the order of their turn */
	struct list_head claims;
	/** @holders: struct ec_claim that have one */
	struct list_head holders;

	/* of unasked.c */
	/** @unasked: takes what the slave has sent without a request */
	struct work_struct unasked;
	/** @kept: VoE messages, the oldest first; under @unasked_lock */
	struct list_head kept;

	/* of emerg.c */
	/** @emerg: where emergencies go, NULL: only to the log; under @unasked_lock */
	struct ec_emerg *emerg;
	/** @last_lock: protects the members below, for one copy of them */
	raw_spinlock_t last_lock;
	/** @n_last: emergencies so far */
	u32 n_last;
	/** @last: the last emergencies, entry n of them at n % EC_EMERGENCIES */
	struct ec_emergency last[EC_EMERGENCIES];
};

/** struct ec_mbox - mailbox of a slave */
struct ec_mbox {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @stop: what ends exchanges, immutable */
	struct ec_stop *stop;
	/** @changes: counts users that enter; NULL: they are not counted; pointer immutable */
	atomic_t *changes;
	/** @position: ring position, for the log; pointer immutable */
	const u16 *position;

	/** @reply_ms: limit of SDO and SoE replies, 0: the default; of the configuration */
	u32 reply_ms;
	/** @profile: of the device, 402: a drive; 0: not known; of the bus */
	u32 profile;
	/** @flags: bits enum ec_mbox_flag, atomic; of foe.c */
	unsigned long flags;
	/** @strict: the slave refuses SM1 with an event, as its way to PREOP has shown */
	bool strict;

	/** @box: transport that writes, polls, reads and repeats */
	struct ec_box box;
	/** @desk: queue of requests, messages that are kept */
	struct ec_desk desk;
};

/** struct ec_mbox_buf - buffers of one exchange */
struct ec_mbox_buf {
	/** @tx: message behind the mailbox header */
	u8 tx[EC_MBOX_MAX];
	/** @rx: answer behind the mailbox header */
	u8 rx[EC_MBOX_MAX];
};

/** struct ec_mbox_limit - time limits of a transfer */
struct ec_mbox_limit {
	/** @timeout_ms: per message, 0: the protocol's default */
	u32 timeout_ms;
	/** @patient: a reply that is late is waited for as well, %EC_MBOX_LATE_MS more */
	bool patient;
	/** @begin_ns: time (ktime) until which it waits for its protocol, 0: as long as it takes */
	u64 begin_ns;
	/**
	 * @end_ns: time (ktime) until which all of its messages have to be exchanged, 0: unlimited
	 */
	u64 end_ns;
	/** @cancel: NULL, or becomes true when another thread cancels the transfer */
	const bool *cancel;
};

/** struct ec_mbox_request - a message to the slave that has an answer */
struct ec_mbox_request {
	/** @type: enum ec_mbox_type */
	u8 type;
	/** @first: of a transfer: replies to earlier ones are discarded */
	bool first;
	/** @late: the next transfer begins when the reply to this message has come, however late */
	bool late;
	/** @limit: for the answer; @timeout_ms is not 0 */
	struct ec_mbox_limit limit;
	/**
	 * @rx: takes each message of @type: 0, EC_MORE and -errno end the wait, EC_STALE continues
	 * it, EC_WAIT continues it with a new time limit
	 */
	int (*rx)(void *ctx, const u8 *rx, size_t len);
	/** @ctx: for @rx */
	void *ctx;
};

#define ec_mbox_warn(mb, fmt, ...) \
	ec_log_event((mb)->base, *(mb)->position, 0, KERN_WARNING, fmt, ##__VA_ARGS__)
#define ec_mbox_dbg_result(mb, ret, fmt, ...) \
	ec_dbg_slave_result((mb)->base, *(mb)->position, ret, fmt, ##__VA_ARGS__)

/* Does the slave have a mailbox? ec_sii_settle_mbox() has decided it, once for all states. */
static inline bool ec_mbox_present(const struct ec_mbox *mb)
{
	return mb->box.sii->std.rx_size && mb->box.sii->std.tx_size;
}

/* The mailbox in use: BOOT has one of its own. */
static inline const struct ec_sii_mbox *ec_mbox_area(const struct ec_mbox *mb)
{
	return ec_box_area(&mb->box);
}

/* Bytes that a message to the slave has behind the mailbox header, not in BOOT. */
static inline size_t ec_mbox_tx_room(const struct ec_mbox *mb)
{
	return mb->box.sii->std.rx_size - EC_MBOX_HDR;
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

/*
 * The limit of a transfer that has moved @bytes since @begin_ns. Without it a transfer would take
 * hours, if the slave replies in time but with hardly any data in each message.
 */
static inline u64 ec_mbox_end_ns(u64 begin_ns, u32 ms, u64 bytes)
{
	return begin_ns + (ms + (bytes * EC_MBOX_KIB_MS >> 10)) * NSEC_PER_MSEC;
}

/* The result of a read, whose outcome is known after a lost frame: it has changed nothing. */
static inline int ec_mbox_read_result(int ret)
{
	return ret == -ENOTRECOVERABLE ? -ETIMEDOUT : ret;
}

#endif
