/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox transport of a slave: requests and their answers, messages without a request. */
#ifndef EC_MAILBOX_H
#define EC_MAILBOX_H

#include <linux/bits.h>
#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include <linux/wait.h>
#include "ethercat.h"
#include "../base/stop.h"
#include "../carry/post.h"
#include "../wire/al.h"
#include "../wire/mbox.h"
#include "../wire/sii.h"

struct ec_emerg;
struct ec_links;
struct ec_mbox_user;

#define EC_MBOX_MAX	1486	/* one datagram */
#define EC_MBOX_READ_TRIES	4	/* of what changes nothing, after lost frames */
#define EC_MBOX_KEPT	16	/* messages kept for their reader */
#define EC_MBOX_BEGIN	16	/* bytes in which two messages differ */
#define EC_MBOX_ALL	0xffff	/* all protocols: no other caller uses the mailbox */
#define EC_MBOX_REPLY	10	/* bytes behind the header that a reply has at most, at least */
#define EC_MBOX_LATE_MS	30000	/* so long a reply is waited for after its time limit */
#define EC_MBOX_KIB_MS	4000	/* for a KiB of a transfer: its rate must not be lower */

enum ec_mbox_flag {
	EC_MBOX_FILE,	/* a file is transferred */
	EC_MBOX_FILE_WRITE,	/* a file is written, firmware perhaps */
};

/* datagram of the mailbox that is on its way */
enum ec_mbox_step {
	EC_MBOX_REST,		/* none */
	EC_MBOX_STATUS,		/* is SM1 full? */
	EC_MBOX_READ,		/* of SM1 */
	EC_MBOX_WRITE,		/* of SM0 */
	EC_MBOX_REPEAT_GET,	/* repeat request and acknowledgement, as they are */
	EC_MBOX_REPEAT_SET,	/* repeat request */
	EC_MBOX_REPEAT_ACK,	/* has the slave acknowledged it? */
};

/**
 * struct ec_mbox_sending - the message that is given to the slave
 * @user: whose message, NULL: the user has left
 * @on: there is one
 * @emptying: first SM1 is read until it is empty
 * @blocked: SM0 is full: first the slave's own message is read
 * @lost: a frame with it was lost, so it may be in SM0
 * @discard: no message, but what the slave has in SM1 is discarded
 * @type: enum ec_mbox_type
 * @counter: its own; the slave drops another message with it
 * @len: bytes behind the header
 * @read: messages read while @emptying
 */
struct ec_mbox_sending {
	struct ec_mbox_user *user;
	bool on;
	bool emptying;
	bool blocked;
	bool lost;
	bool discard;
	u8 type;
	u8 counter;
	u16 len;
	u16 read;
};

/** struct ec_mbox - mailbox of a slave */
struct ec_mbox {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @links: way to the slave, immutable */
	struct ec_links *links;
	/** @stop: what ends exchanges, immutable */
	struct ec_stop *stop;
	/** @sii: mailboxes and protocols that the slave has, immutable */
	const struct ec_sii_info *sii;
	/** @al_status: below PREOP there is no mailbox; pointer immutable */
	const u16 *al_status;
	/** @changes: counts callers that come; NULL: nobody wants to know; pointer immutable */
	atomic_t *changes;
	/** @position: ring position, for the log; pointer immutable */
	const u16 *position;
	/** @station: station address, immutable */
	u16 station;

	/** @reply_ms: limit of SDO and SoE replies that its configuration has, 0: the default */
	u32 reply_ms;
	/** @profile: of the device, 402: a drive; 0: not known. Written by the bus */
	u32 profile;
	/** @strict: the slave refuses SM1 with an event; of who brings it to its state */
	bool strict;

	/**
	 * @lock: protects the members up to @flags; box.c has the machine that they are.
	 * ec_mbox_in_use() reads some without it
	 */
	raw_spinlock_t lock;
	/** @post: carries @dg */
	struct ec_post post;
	/** @dg: its datagram */
	struct ec_dg dg;
	/** @unasked: takes what the slave has sent without a request */
	struct work_struct unasked;
	/** @step: what @post is, enum ec_mbox_step */
	u8 step;
	/** @dead: nothing is sent any more */
	bool dead;
	/** @status: data of @post, unless that is a whole mailbox */
	u8 status[2];
	/** @tx: the message that is given to the slave, as it is in SM0 */
	u8 *tx;
	/** @rx: the message of the slave, as it is in SM1 */
	u8 *rx;
	/** @tx_room: bytes of @tx */
	u16 tx_room;
	/** @rx_room: bytes of @rx that a mailbox may have */
	u16 rx_room;
	/** @size: of SM0 or SM1, as the present access began */
	u16 size;
	/** @at: bytes of them before @post */
	u16 at;
	/** @rx_size: of SM1, as @rx was read */
	u16 rx_size;
	/** @held: @rx has a message that was not taken so far */
	bool held;
	/** @handed_over: @unasked takes it */
	bool handed_over;
	/** @sending: message to the slave */
	struct ec_mbox_sending sending;
	/** @queue: users whose message waits, the oldest first */
	struct list_head queue;
	/** @users: users that wait for messages, the oldest first */
	struct list_head users;
	/** @fetch: read SM1 until it is empty, although no user waits */
	bool fetch;
	/** @fetched: messages read so */
	u16 fetched;
	/** @flood_ns: no @fetch before that time (ktime): the slave sends without end */
	u64 flood_ns;
	/** @since_ns: last progress (ktime) */
	u64 since_ns;
	/** @took_ns: how long the slave took for its last message, with direct access */
	u64 took_ns;
	/** @due_ns: no access before that time (ktime) */
	u64 due_ns;
	/** @counter: of the last message sent */
	u8 counter;
	/** @seen: counter of the last message received */
	u8 seen;
	/** @in_order: messages in a row that had the next counter, up to some */
	u8 in_order;
	/** @begin: header and first bytes of that message */
	u8 begin[EC_MBOX_BEGIN];
	/** @counts: the slave counts its messages */
	bool counts;
	/** @can_repeat: what is lost can be repeated, both ways; set before there are users */
	bool can_repeat;
	/** @gap: a message of the slave may have been lost */
	bool gap;
	/** @unread: the frame that read SM1 was lost; if it is full, SM1 was not read */
	bool unread;
	/** @failed: the last try to get a repetition has failed: first look without it */
	bool failed;
	/** @asked: it has been asked to repeat it, not acknowledged so far */
	bool asked;
	/** @want: value of that repeat request */
	bool want;
	/** @unseen: the acknowledgement had that value before */
	bool unseen;
	/** @acks: looks for the acknowledgement so far */
	u8 acks;
	/** @repeats: the slave has been made to repeat its last message */
	bool repeats;
	/** @ack_fails: repeat requests without acknowledgement in a row */
	u8 ack_fails;
	/** @logged: that it does not repeat although it should */
	bool logged;
	/** @answered: nothing of an earlier exchange can come any more */
	bool answered;
	/** @renew: the slave has been in INIT: the next message resets these members */
	bool renew;
	/** @late: BIT(enum ec_mbox_type): the slave has a request whose reply is late */
	u16 late;
	/** @late_ns: nothing waits for that reply after this time (ktime) */
	u64 late_ns;
	/** @never_late: the last late reply did not come; the next one is not waited for */
	bool never_late;
	/** @claimed: BIT(enum ec_mbox_type) of the protocols in use; see ec_mbox_claim() */
	u16 claimed;
	/** @claims: callers that wait for a protocol, the oldest first */
	struct list_head claims;

	/** @flags: bits EC_MBOX_... */
	unsigned long flags;

	/** @unasked_lock: protects the members below and what @emerg points to */
	spinlock_t unasked_lock;
	/** @emerg: where emergencies go, NULL: only to the log */
	struct ec_emerg *emerg;
	/** @kept: VoE messages, the oldest first */
	struct list_head kept;
	/** @n_kept: entries in @kept */
	unsigned int n_kept;
	/** @keep_voe: the application has VoE handlers */
	bool keep_voe;

	/** @last_lock: protects the members below, for one copy of them */
	raw_spinlock_t last_lock;
	/** @last: the last emergencies, entry n of them at n % EC_EMERGENCIES */
	struct ec_emergency last[EC_EMERGENCIES];
	/** @n_last: emergencies so far */
	u32 n_last;
};

/**
 * struct ec_mbox_buf - buffers of one exchange
 * @tx: message behind the mailbox header
 * @rx: answer behind the mailbox header
 */
struct ec_mbox_buf {
	u8 tx[EC_MBOX_MAX];
	u8 rx[EC_MBOX_MAX];
};

/**
 * struct ec_mbox_limit - when a transfer has to give up
 * @timeout_ms: per message, 0: the protocol's default
 * @begin_ns: time (ktime) until which it waits for its protocol, 0: as long as it takes
 * @end_ns: time (ktime) until which all of its messages have to be exchanged, 0: unlimited
 * @patient: a reply that is late is waited for as well, %EC_MBOX_LATE_MS more
 * @cancel: NULL, or becomes true when another thread cancels the transfer
 */
struct ec_mbox_limit {
	u32 timeout_ms;
	bool patient;
	u64 begin_ns;
	u64 end_ns;
	const bool *cancel;
};

/**
 * struct ec_mbox_request - a message to the slave that has an answer
 * @type: enum ec_mbox_type
 * @first: of a transfer: replies to earlier ones are discarded
 * @late: the next transfer begins when the reply to this message has come, however late
 * @limit: for the answer; @timeout_ms is not 0
 * @rx: takes each message of @type: 0 and EC_MORE end the wait, EC_STALE
 *	goes on, EC_WAIT goes on with a new time limit, or -errno
 * @ctx: for @rx
 */
struct ec_mbox_request {
	u8 type;
	bool first;
	bool late;
	struct ec_mbox_limit limit;
	int (*rx)(void *ctx, const u8 *rx, size_t len);
	void *ctx;
};

#define ec_mbox_warn(mb, fmt, ...) \
	ec_log_event((mb)->base, *(mb)->position, 0, KERN_WARNING, fmt, ##__VA_ARGS__)
#define ec_mbox_dbg_result(mb, ret, fmt, ...) \
	ec_dbg_slave_result((mb)->base, *(mb)->position, ret, fmt, ##__VA_ARGS__)

/* Does the slave have a mailbox? ec_sii_settle_mbox() has decided it, once for all states. */
static inline bool ec_mbox_present(const struct ec_mbox *mb)
{
	return mb->sii->std.rx_size && mb->sii->std.tx_size;
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

/*
 * The end of a transfer that has moved @bytes since @begin_ns: a slave that replies within the
 * time limit of each message, with next to nothing in it, would go on for hours.
 */
static inline u64 ec_mbox_end_ns(u64 begin_ns, u32 ms, u64 bytes)
{
	return begin_ns + (ms + (bytes * EC_MBOX_KIB_MS >> 10)) * NSEC_PER_MSEC;
}

void ec_mbox_init(struct ec_mbox *mb);
unsigned int ec_mbox_sms(const struct ec_mbox *mb, bool boot, u8 *page);
void ec_mbox_reset(struct ec_mbox *mb);
void ec_mbox_exit(struct ec_mbox *mb);
bool ec_mbox_in_use(const struct ec_mbox *mb);
int ec_mbox_check(const struct ec_mbox *mb, u16 protocol, size_t message);
struct ec_mbox_buf *ec_mbox_alloc(const struct ec_mbox *mb, u16 protocol, size_t message);
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len);
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit);
void ec_mbox_send_last(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len);
int ec_mbox_forget(struct ec_mbox *mb);
bool ec_mbox_fetch(struct ec_mbox *mb);

/* late.c */
void ec_mbox_forget_late(struct ec_mbox *mb, u16 types);

/* claim.c */
int ec_mbox_claim(struct ec_mbox *mb, u16 types, u32 ms);
int ec_mbox_claim_for(struct ec_mbox *mb, u8 type, const struct ec_mbox_limit *limit);
void ec_mbox_unclaim(struct ec_mbox *mb, u16 types);
bool ec_mbox_is_claimed(struct ec_mbox *mb, u16 types);

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
