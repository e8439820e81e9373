/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The two mailboxes of a slave: the structure of the transport that writes, polls, reads and
 * repeats (box.h), its memory, and the datagrams of its steps.
 */
#ifndef EC_BOX_POST_H
#define EC_BOX_POST_H

#include <linux/spinlock.h>
#include <linux/types.h>
#include "../carry/post.h"
#include "../wire/al.h"
#include "../wire/mbox.h"
#include "../wire/sii.h"

struct ec_box;
struct ec_links;

#define EC_MBOX_MAX	1486	/* bytes of a mailbox at most: one datagram */
#define EC_BOX_BEGIN	16	/* bytes in which two messages differ */
#define EC_BOX_DRAIN	16	/* messages at most that are read in a row to empty SM1 */

/**
 * enum ec_box_step - datagram of a mailbox that is in flight; box_set_step() alone changes it
 * @EC_BOX_REST: none
 * @EC_BOX_STATUS: is SM1 full?
 * @EC_BOX_READ: a piece of SM1
 * @EC_BOX_WRITE: a piece of SM0
 * @EC_BOX_REPEAT_GET: repeat request and acknowledgement, before they change
 * @EC_BOX_REPEAT_SET: the repeat request is toggled
 * @EC_BOX_REPEAT_ACK: has the slave acknowledged it?
 *
 * ==========  ==========  =============================  ===============  ==========
 * step        done        done, and there is more to do  lost, or WKC 0   not sent
 * ==========  ==========  =============================  ===============  ==========
 * STATUS      next        READ: SM1 is full              next             next
 * READ        next        READ: another piece            next             READ
 * WRITE       next        WRITE: another piece           next             WRITE
 * REPEAT_GET              REPEAT_SET                     next             REPEAT_GET
 * REPEAT_SET              REPEAT_ACK                     next             REPEAT_SET
 * REPEAT_ACK  next        REPEAT_ACK: not so far         next             REPEAT_ACK
 * ==========  ==========  =============================  ===============  ==========
 *
 * Next is what there is to do: STATUS, READ, WRITE, REPEAT_GET, or REST. ec_box_hurry() withdraws a
 * poll (STATUS, or the first piece of READ) that is not due: REST.
 */
enum ec_box_step {
	EC_BOX_REST,
	EC_BOX_STATUS,
	EC_BOX_READ,
	EC_BOX_WRITE,
	EC_BOX_REPEAT_GET,
	EC_BOX_REPEAT_SET,
	EC_BOX_REPEAT_ACK,
};

/**
 * enum ec_box_job - message for the slave; ec_box_set_job() alone changes it
 * @EC_BOX_NO_JOB: none
 * @EC_BOX_EMPTYING: first SM1 is read until it is empty
 * @EC_BOX_DISCARDING: no message, but what the slave has in SM1 is discarded
 * @EC_BOX_WRITING: it is written
 * @EC_BOX_BLOCKED: SM0 is full: first the slave's own message is read
 *
 * ==========  =============  ===============  =======  ======  ==============  ===========
 * job         given          SM1 empty,       message  SM0     in SM0, or      error, or
 *                            or without end   read     full    perhaps in SM0  taken back
 * ==========  =============  ===============  =======  ======  ==============  ===========
 * NO_JOB      EMPTYING,
 *             DISCARDING,
 *             WRITING
 * EMPTYING                   WRITING                                           NO_JOB
 * DISCARDING                 NO_JOB                                            NO_JOB
 * WRITING                                              BLOCKED NO_JOB          NO_JOB
 * BLOCKED                    WRITING          WRITING          NO_JOB          NO_JOB
 * ==========  =============  ===============  =======  ======  ==============  ===========
 */
enum ec_box_job {
	EC_BOX_NO_JOB,
	EC_BOX_EMPTYING,
	EC_BOX_DISCARDING,
	EC_BOX_WRITING,
	EC_BOX_BLOCKED,
};

/**
 * enum ec_box_gap - has a message of the slave been lost? ec_box_set_gap() alone changes it
 * @EC_BOX_WHOLE: none, as far as the master knows
 * @EC_BOX_UNREAD: the frame that read SM1 was lost, and the slave cannot repeat: if SM1 is full,
 *	it was not read
 * @EC_BOX_GAP: one may have been lost: the slave is made to repeat it before SM1 is read
 * @EC_BOX_GAP_LOOK: the last try to get a repetition has failed: first one access without it
 *
 * ========  ===========  ===================  ==========  ==========  ================
 * state     frame of     result of            repetition  try failed  the slave
 *           READ lost    STATUS or READ                               does not repeat
 * ========  ===========  ===================  ==========  ==========  ================
 * WHOLE     UNREAD, GAP                                               WHOLE
 * UNREAD    UNREAD       WHOLE
 * GAP       GAP                               WHOLE       GAP_LOOK    WHOLE
 * GAP_LOOK  GAP          GAP
 * ========  ===========  ===================  ==========  ==========  ================
 *
 * INIT leads to WHOLE.
 */
enum ec_box_gap {
	EC_BOX_WHOLE,
	EC_BOX_UNREAD,
	EC_BOX_GAP,
	EC_BOX_GAP_LOOK,
};

/** enum ec_box_want - what is wanted of SM1 */
enum ec_box_want {
	/** @EC_BOX_NOTHING: no user waits for a message of the slave */
	EC_BOX_NOTHING,
	/** @EC_BOX_MESSAGE: the next message */
	EC_BOX_MESSAGE,
	/** @EC_BOX_FIRST: the next message, before another one is written */
	EC_BOX_FIRST,
	/** @EC_BOX_BLIND: one access without a poll of its status */
	EC_BOX_BLIND,
};

/** enum ec_box_event - what the transport reports */
enum ec_box_event {
	/** @EC_BOX_ON_RECEIVED: a message is in @rx; it stays there until ec_box_drop() */
	EC_BOX_ON_RECEIVED,
	/** @EC_BOX_ON_REPEATED: the last message has come again, and is dropped */
	EC_BOX_ON_REPEATED,
	/** @EC_BOX_ON_MALFORMED: a message whose header is wrong, dropped */
	EC_BOX_ON_MALFORMED,
	/** @EC_BOX_ON_NOTHING: an access to SM1 has ended, no other message follows from it */
	EC_BOX_ON_NOTHING,
	/** @EC_BOX_ON_EMPTY: SM1 is empty, and no repetition is necessary */
	EC_BOX_ON_EMPTY,
	/** @EC_BOX_ON_GAP: a frame was lost that may have had a message of the slave */
	EC_BOX_ON_GAP,
	/** @EC_BOX_ON_EMPTIED: all messages are read that the slave had before the job */
	EC_BOX_ON_EMPTIED,
	/**
	 * @EC_BOX_ON_JOB: the job has ended: 0: the message is in SM0, or all is discarded;
	 * -ENOTRECOVERABLE: its frame was lost, it may be in SM0; -EMSGSIZE: too large;
	 * -EBUSY: the slave sends without end
	 */
	EC_BOX_ON_JOB,
	/** @EC_BOX_ON_FAILED: the slave cannot be reached, -errno; the job has ended */
	EC_BOX_ON_FAILED,
	/** @EC_BOX_ON_RENEWED: the slave has been in INIT */
	EC_BOX_ON_RENEWED,
	/** @EC_BOX_ON_UNABLE: the slave does not repeat, although it should */
	EC_BOX_ON_UNABLE,
};

/**
 * struct ec_box_ops - calls of the transport, with its lock held
 *
 * RT-safe: bounded, no sleep, no allocation. A call may use the functions of box.h that are
 * marked so.
 */
struct ec_box_ops {
	/** @next: there is no job: it may begin one by ec_box_give() or ec_box_discard() */
	void (*next)(struct ec_box *box);
	/** @want: what is wanted of SM1 */
	enum ec_box_want (*want)(struct ec_box *box);
	/** @streams: only frames of EoE are exchanged: each can wait until the cycle has sent */
	bool (*streams)(struct ec_box *box);
	/** @event: something has happened; @err is 0 where not described otherwise */
	void (*event)(struct ec_box *box, enum ec_box_event event, int err);
};

/**
 * struct ec_box - mailbox transport of a slave
 *
 * Members that are not described otherwise are under @lock. The files box*.c alone change them.
 */
struct ec_box {
	/** @ops: calls, immutable */
	const struct ec_box_ops *ops;
	/** @links: way to the slave, immutable; set by the owner of the slave */
	struct ec_links *links;
	/** @sii: mailboxes of the slave, immutable; set by the owner of the slave */
	const struct ec_sii_info *sii;
	/** @al_status: below PREOP there is no mailbox; pointer immutable */
	const u16 *al_status;
	/** @station: station address, immutable; set by the owner of the slave */
	u16 station;

	/** @step: what @post is, enum ec_box_step; ec_mbox_in_use() reads it without the lock */
	u8 step;
	/** @job: enum ec_box_job */
	u8 job;
	/** @gap: enum ec_box_gap */
	u8 gap;
	/** @dead: nothing is sent any more */
	bool dead;
	/** @closed: no new step begins, since all protocols are claimed; of claim.c */
	bool closed;
	/** @renew: the slave has been in INIT; any thread sets it */
	bool renew;
	/** @lock: protects the transport, and the mailbox queue: see struct ec_desk */
	raw_spinlock_t lock;
	/** @post: carries @dg */
	struct ec_post post;
	/** @dg: its datagram */
	struct ec_dg dg;
	/** @tx: message to the slave, with the bytes behind it up to the size of SM0 */
	u8 *tx;
	/** @rx: message of the slave, with the bytes behind it up to the size of SM1 */
	u8 *rx;
	/** @tx_room: bytes of @tx */
	u16 tx_room;
	/** @rx_room: bytes of @rx that a mailbox may have */
	u16 rx_room;
	/** @size: of SM0 or SM1, when the present access began */
	u16 size;
	/** @at: bytes of them before @post */
	u16 at;
	/** @rx_size: of SM1, when @rx was read */
	u16 rx_size;
	/** @tx_len: bytes of the message in @tx, with header */
	u16 tx_len;
	/** @status: data of @post, unless that is a piece of a mailbox */
	u8 status[2];
	/** @drained: messages read since the job is EMPTYING or DISCARDING */
	u8 drained;
	/** @counter: of the last message to the slave */
	u8 counter;
	/** @seen: of the last message of the slave */
	u8 seen;
	/** @in_order: messages of the slave in a row with the next counter, up to some */
	u8 in_order;
	/** @acks: polls for the acknowledgement of a repeat request so far */
	u8 acks;
	/** @ack_fails: repeat requests without acknowledgement in a row */
	u8 ack_fails;
	/** @begin: header and first bytes of the last message of the slave */
	u8 begin[EC_BOX_BEGIN];
	/** @held: @rx has a message that was not dropped so far */
	bool held;
	/** @doubtful: a frame with the message of the job was lost, so it may be in SM0 */
	bool doubtful;
	/** @orphan: the job was taken back while its message was in flight */
	bool orphan;
	/** @counts: the slave counts its messages */
	bool counts;
	/** @since_ns: last progress (ktime) */
	u64 since_ns;
	/** @took_ns: how long the slave took for its last message */
	u64 took_ns;
	/** @away_ns: since when the slave does not reply at its address (ktime); 0: it does */
	u64 away_ns;
	/** @due_ns: no access before that time (ktime) */
	u64 due_ns;

	/** @can_repeat: the slave repeats, both ways; set by the scan, cleared if it does not */
	bool can_repeat;
	/** @asked: it has got a repeat request, and has not acknowledged that so far */
	bool asked;
	/** @asked_bit: value of that repeat request */
	bool asked_bit;
	/** @unseen: the acknowledgement had that value before the request */
	bool unseen;
	/** @repeats: the slave was made to repeat, so its next message may be the last one */
	bool repeats;
};

/* The mailbox in use: BOOT has one of its own. */
static inline const struct ec_sii_mbox *ec_box_area(const struct ec_box *box)
{
	bool boot = (READ_ONCE(*box->al_status) & EC_AL_STATE_MASK) == EC_AL_BOOT;

	return boot ? &box->sii->boot : &box->sii->std;
}

/* Is the slave in a state without mailbox, INIT? */
static inline bool ec_box_is_off(const struct ec_box *box)
{
	return (READ_ONCE(*box->al_status) & EC_AL_STATE_MASK) < EC_AL_PREOP;
}

int ec_box_get_memory(struct ec_box *box);
void ec_box_stop(struct ec_box *box);
void ec_box_free(struct ec_box *box);

/* with the lock held */
void ec_box_post(struct ec_box *box, enum ec_box_step step);
void ec_box_progress(struct ec_box *box);
void ec_box_pause(struct ec_box *box);
void ec_box_expect_reply(struct ec_box *box);
void ec_box_expect_more(struct ec_box *box);
bool ec_box_reads_at_once(const struct ec_box *box);

#endif
