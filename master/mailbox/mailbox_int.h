/* SPDX-License-Identifier: GPL-2.0-only */
/* Inside the transport: its machine and the callers that use it. */
#ifndef EC_MAILBOX_INT_H
#define EC_MAILBOX_INT_H

#include <linux/ktime.h>
#include "mailbox.h"

/* Messages at most that no user waits for, read in a row. */
#define EC_MBOX_DRAIN	16
#define EC_MBOX_ACK_FAILS	3	/* repeat requests without acknowledgement */
#define EC_MBOX_SLICE_MS	20	/* between looks whether a waiting caller has to leave */

/** struct ec_mbox_until - when a waiting caller has to give up */
struct ec_mbox_until {
	/** @ns: time (ktime) */
	u64 ns;
	/** @cancel: NULL, or becomes true when another thread cancels the transfer */
	const bool *cancel;
};

static inline struct ec_mbox_until ec_mbox_until(const struct ec_mbox_limit *l)
{
	u64 ns = ktime_get_ns() + (u64)l->timeout_ms * NSEC_PER_MSEC;

	return (struct ec_mbox_until){ l->end_ns ? min(ns, l->end_ns) : ns, l->cancel };
}

enum ec_mbox_phase {
	EC_MBOX_USER_IDLE,	/* out of all lists */
	EC_MBOX_USER_QUEUED,	/* its message waits */
	EC_MBOX_USER_SENDING,	/* its message is being given to the slave */
	EC_MBOX_USER_WAITING,	/* for a message of its type */
	EC_MBOX_USER_DONE,	/* @err, or the message is in @rx; another one has to wait */
};

/**
 * struct ec_mbox_user - a caller that has a message for the slave, or waits for one
 * @list: in the queue, or among the users
 * @phase: enum ec_mbox_phase
 * @type: enum ec_mbox_type
 * @answer: its message has an answer
 * @first: read SM1 until it is empty before, unless nothing can be there
 * @discard: it has no message: what the slave has sent so far is discarded
 * @once: one access to SM1, then -ENOMSG
 * @lost: a frame with its message was lost
 * @gap: a frame was lost that may have had its answer
 * @heard: the slave has sent something else meanwhile: it is not busy with the request
 * @err: result: 0 or -errno
 * @tx: message behind the header
 * @len: bytes of it
 * @rx: result: message of the slave behind the header
 * @got: bytes of it
 * @got_type: its type: @type or EC_MBOX_ERR
 * @task: woken when @phase is DONE
 */
struct ec_mbox_user {
	struct list_head list;
	u8 phase;
	u8 type;
	bool answer;
	bool first;
	bool discard;
	bool once;
	bool lost;
	bool gap;
	bool heard;
	int err;
	const u8 *tx;
	u16 len;
	u8 *rx;
	u16 got;
	u8 got_type;
	struct task_struct *task;
};

/* mailbox.c */
void ec_mbox_enter(struct ec_mbox *mb, struct ec_mbox_user *u);
void ec_mbox_leave(struct ec_mbox *mb, struct ec_mbox_user *u, bool answered);

/* late.c */
bool ec_mbox_is_late(struct ec_mbox *mb, const struct ec_mbox_user *u);
void ec_mbox_mark_late(struct ec_mbox *mb, const struct ec_mbox_user *u);
void ec_mbox_took_late(struct ec_mbox *mb, u8 type);
int ec_mbox_await_late(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b);

/* claim.c */
int ec_mbox_over(const struct ec_mbox *mb, const struct ec_mbox_until *u);
void ec_mbox_sleep(const struct ec_mbox *mb, const u8 *state, u8 end,
		   const struct ec_mbox_until *u);

/* box.c: with the lock of the mailbox held */
void ec_mbox_go(struct ec_mbox *mb);
void ec_mbox_hurry(struct ec_mbox *mb);
void ec_mbox_done(struct ec_post *post);
bool ec_mbox_off(const struct ec_mbox *mb);

/* inbox.c: with the lock of the mailbox held */
void ec_mbox_received(struct ec_mbox *mb);
void ec_mbox_finish(struct ec_mbox *mb, struct ec_mbox_user *u, int err);
void ec_mbox_fail(struct ec_mbox *mb, int err);
bool ec_mbox_awaited(const struct ec_mbox *mb);
bool ec_mbox_is_blind(const struct ec_mbox *mb);
void ec_mbox_found_empty(struct ec_mbox *mb);
void ec_mbox_finish_once(struct ec_mbox *mb);
void ec_mbox_mark_gap(struct ec_mbox *mb);
bool ec_mbox_has_reader(struct ec_mbox *mb);
void ec_mbox_retry_held(struct ec_mbox *mb);

/* unasked.c */
void ec_mbox_unasked(struct work_struct *work);
int ec_mbox_error_reply(struct ec_mbox *mb, const u8 *rx, size_t len);
void ec_mbox_flush_kept(struct ec_mbox *mb);
int ec_mbox_take_kept(struct ec_mbox *mb, u8 *rx);

#endif
