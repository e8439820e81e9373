// SPDX-License-Identifier: GPL-2.0-only
/*
 * The mailbox queue: it gives the message of the next user to the mailbox transport, and each
 * message of the slave to the user that waits for it.
 */
#include <linux/ktime.h>
#include "../wire/coe.h"
#include "../wire/eoe.h"
#include "../wire/soe.h"
#include "box_state.h"
#include "desk.h"

#define FLOOD_NS	(250 * NSEC_PER_MSEC)	/* of a slave that sends without end */

#define STRIDE		4	/* messages without answer at most between accesses to SM1 */

#define for_each_user(mb, u) list_for_each_entry(u, &(mb)->desk.users, list)

static struct ec_mbox *mbox_of(struct ec_box *box)
{
	return container_of(box, struct ec_mbox, box);
}

/* A user has its result; NULL: it has left. */
static void desk_finish(struct ec_mbox *mb, struct ec_mbox_user *u, int err)
{
	lockdep_assert_held(&mb->box.lock);
	if (!u)
		return;
	u->err = err;
	/* the result before the phase */
	smp_store_release(&u->phase, EC_MBOX_USER_DONE);
	u->done(mb, u);
}

/* An error for all users that send a message or wait for one. */
static void finish_all(struct ec_mbox *mb, int err)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	mb->desk.fetch = false;
	for_each_user(mb, u)
		if (u->phase == EC_MBOX_USER_WAITING || u->phase == EC_MBOX_USER_SENDING)
			desk_finish(mb, u, err);
}

/* An access to SM1 has ended: users that want only one, and have no message, are DONE. */
static void finish_once(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	for_each_user(mb, u)
		if (u->once && u->phase == EC_MBOX_USER_WAITING)
			desk_finish(mb, u, -ENOMSG);
}

/* A frame was lost: a user without an answer does not know what the slave has done. */
static void mark_gap(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	for_each_user(mb, u)
		if (u->answer)
			u->gap = true;
}

/* The slave has sent another message, so it is not busy with the requests that wait. */
static void mark_heard(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	for_each_user(mb, u)
		if (u->answer && u->phase == EC_MBOX_USER_WAITING)
			u->heard = true;
}

/* Does it send or read frames of the network? They have no answer, but perhaps an error reply. */
static bool is_of_frames(const struct ec_mbox_user *u)
{
	return u->type == EC_MBOX_EOE && !u->answer;
}

/* messages to the slave -----------------------------------------------------*/

/* BOOT is for files: a fragment would disturb the transfer. */
static bool is_frame_in_boot(const struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	return u->type == EC_MBOX_EOE && ec_box_area(&mb->box) != &mb->box.sii->std;
}

/* The user whose message is the next one; NULL: none. */
static struct ec_mbox_user *next_user(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	while ((u = list_first_entry_or_null(&mb->desk.queue, struct ec_mbox_user, list))) {
		list_move_tail(&u->list, &mb->desk.users);
		u->phase = EC_MBOX_USER_SENDING;
		/* not while a slave only passes INIT: its worker has claimed the mailbox */
		if (ec_box_is_off(&mb->box) || is_frame_in_boot(mb, u))
			desk_finish(mb, u, -EAGAIN);
		else if (u->len + EC_MBOX_HDR > mb->box.tx_room && !u->discard)
			desk_finish(mb, u, -EMSGSIZE);
		else
			break;
	}
	return u;
}

static void desk_next(struct ec_box *box)
{
	struct ec_mbox *mb = mbox_of(box);
	struct ec_mbox_user *u = next_user(mb);
	bool emptying;

	if (!u)
		return;
	mb->desk.sending = u;
	mb->desk.frame_sent = is_of_frames(u);
	if (u->discard) {
		ec_box_discard(box);
		return;
	}
	emptying = u->first && !mb->desk.answered;
	mb->desk.answered = false;
	ec_box_give(box, u->type, u->tx, u->len, emptying);
}

static void job_over(struct ec_mbox *mb, int err)
{
	struct ec_mbox_user *u = mb->desk.sending;

	lockdep_assert_held(&mb->box.lock);
	/* its answer may have been received before */
	if (!u || u->phase != EC_MBOX_USER_SENDING)
		return;
	u->lost |= err == -ENOTRECOVERABLE;
	/* a stream of them does not keep the slave from sending */
	if (!u->answer && mb->desk.ahead < EC_BOX_DRAIN)
		mb->desk.ahead++;
	if (u->answer && (!err || err == -ENOTRECOVERABLE)) {
		u->phase = EC_MBOX_USER_WAITING;
		ec_box_expect_reply(&mb->box);
	} else {
		desk_finish(mb, u, err);
	}
}

/* messages of the slave -----------------------------------------------------*/

static enum ec_box_want desk_want(struct ec_box *box)
{
	struct ec_mbox *mb = mbox_of(box);
	enum ec_box_want message = mb->desk.ahead && mb->desk.ahead >= mb->desk.stride ?
				   EC_BOX_FIRST : EC_BOX_MESSAGE;
	enum ec_box_want want = mb->desk.fetch ? message : EC_BOX_NOTHING;
	const struct ec_mbox_user *u;

	lockdep_assert_held(&box->lock);
	for_each_user(mb, u) {
		if (u->phase != EC_MBOX_USER_WAITING)
			continue;
		if (u->once)
			return EC_BOX_BLIND;
		want = message;
	}
	return want;
}

/* Is no user waiting for an answer, and is no message sent but frames? */
static bool desk_streams(struct ec_box *box)
{
	struct ec_mbox *mb = mbox_of(box);
	const struct ec_mbox_user *u;

	lockdep_assert_held(&box->lock);
	for_each_user(mb, u)
		if (!is_of_frames(u) &&
		    (u->phase == EC_MBOX_USER_WAITING || u->phase == EC_MBOX_USER_SENDING))
			return false;
	return true;
}

/* May a message be the answer to this user? Only if the slave may have its request. */
static bool may_have(const struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	return u->phase == EC_MBOX_USER_WAITING ||
	       (u == mb->desk.sending && ec_box_is_doubtful(&mb->box));
}

/* Of EoE, frames of the network go to the user that reads them, never to one with a request. */
static bool is_kind(const struct ec_mbox *mb, const struct ec_mbox_user *u, u16 len)
{
	int type;

	if (u->type != EC_MBOX_EOE)
		return true;
	type = ec_eoe_type_decode(mb->box.rx + EC_MBOX_HDR, len);
	return u->answer ? type != EC_EOE_FRAGMENT : type == EC_EOE_FRAGMENT;
}

/*
 * The user that a message of a type is for. An error reply has no type: it is for the user that
 * has sent its request first. A user that is DONE has to take its previous message first.
 */
static struct ec_mbox_user *desk_find(struct ec_mbox *mb, u8 type, u16 len)
{
	struct ec_mbox_user *u, *reader = NULL;

	lockdep_assert_held(&mb->box.lock);
	for_each_user(mb, u) {
		/* it only sends */
		if (!u->rx)
			continue;
		if (type == EC_MBOX_ERR ? is_of_frames(u) != mb->desk.frame_sent :
		    u->type != type || !is_kind(mb, u, len))
			continue;
		if (!may_have(mb, u) && !(u->phase == EC_MBOX_USER_DONE && u->answer))
			continue;
		if (u->answer)
			return u;
		reader = reader ?: u;
	}
	return reader;
}

/* The slave has answered, so it has the message of the user, even if its frame was lost. */
static void desk_arrived(struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	if (mb->desk.sending == u)
		ec_box_arrived(&mb->box);
}

static void deliver(struct ec_mbox *mb, struct ec_mbox_user *u, const struct ec_mbox_hdr *h)
{
	lockdep_assert_held(&mb->box.lock);
	u->got = h->len;
	u->got_type = h->type;
	memcpy(u->rx, mb->box.rx + EC_MBOX_HDR, h->len);
	if (u->answer)
		mb->desk.never_late = false;
	desk_arrived(mb, u);
	desk_finish(mb, u, 0);
}

/* Is it an emergency, or a notification of a drive? They are no answers. */
static bool is_unasked(const struct ec_mbox *mb, const struct ec_mbox_hdr *h)
{
	const u8 *rx = mb->box.rx + EC_MBOX_HDR;
	struct ec_coe_emergency e;

	if (h->type == EC_MBOX_SOE)
		return ec_soe_is_unasked(rx, h->len);
	return h->type == EC_MBOX_COE && !ec_coe_emergency_decode(rx, h->len, &e);
}

/* Find the user that a message is for. The transport holds it until it is taken. */
static void desk_dispatch(struct ec_mbox *mb, const struct ec_mbox_hdr *h)
{
	bool unasked = is_unasked(mb, h);
	struct ec_mbox_user *u = unasked ? NULL : desk_find(mb, h->type, h->len);

	lockdep_assert_held(&mb->box.lock);
	if (!u && !unasked && h->type != EC_MBOX_VOE && h->type != EC_MBOX_EOE)
		mark_heard(mb);
	if (u && u->phase == EC_MBOX_USER_DONE)
		return;
	if (!u && mb->box.job != EC_BOX_DISCARDING) {
		mb->desk.handed_over = true;
		queue_work(system_highpri_wq, &mb->desk.unasked);
		return;
	}
	ec_box_drop(&mb->box);
	if (u)
		deliver(mb, u, h);
}

/* The user that reads frames; NULL: none, or it has to take its previous message first. */
static struct ec_mbox_user *find_reader(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->box.lock);
	for_each_user(mb, u)
		if (u->rx && is_of_frames(u) && may_have(mb, u))
			return u;
	return NULL;
}

/* Of no known type: that of a request is its answer, else it is counted as a frame. */
static void refuse_malformed(struct ec_mbox *mb)
{
	struct ec_mbox_user *u = desk_find(mb, EC_MBOX_ERR, 0) ?: find_reader(mb);

	if (!u || u->phase == EC_MBOX_USER_DONE)
		return;
	desk_arrived(mb, u);
	desk_finish(mb, u, -EBADMSG);
}

static void count_fetched(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->box.lock);
	if (!mb->desk.fetch || ++mb->desk.fetched < EC_BOX_DRAIN)
		return;
	mb->desk.fetch = false;
	mb->desk.fetched = 0;
	mb->desk.flood_ns = ktime_get_ns() + FLOOD_NS;
}

static void on_received(struct ec_mbox *mb)
{
	struct ec_mbox_hdr h;

	if (ec_box_message(&mb->box, &h))
		ec_box_drop(&mb->box);
	else
		desk_dispatch(mb, &h);
}

static void on_renewed(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->box.lock);
	mb->desk.answered = false;
	mb->desk.late = 0;
	mb->desk.never_late = false;
}

static void desk_event(struct ec_box *box, enum ec_box_event event, int err)
{
	struct ec_mbox *mb = mbox_of(box);

	lockdep_assert_held(&box->lock);
	switch (event) {
	case EC_BOX_ON_RECEIVED:
		mb->desk.stride = 1;
		on_received(mb);
		count_fetched(mb);
		break;
	case EC_BOX_ON_REPEATED:
		mark_heard(mb);
		count_fetched(mb);
		break;
	case EC_BOX_ON_MALFORMED:
		refuse_malformed(mb);
		count_fetched(mb);
		break;
	case EC_BOX_ON_NOTHING:
		mb->desk.ahead = 0;
		finish_once(mb);
		break;
	case EC_BOX_ON_EMPTY:
		/* a slave that has nothing to say costs less of a stream */
		mb->desk.stride = clamp(2 * mb->desk.stride, 1, STRIDE);
		mb->desk.fetch = false;
		mb->desk.fetched = 0;
		break;
	case EC_BOX_ON_GAP:
		mark_gap(mb);
		break;
	case EC_BOX_ON_EMPTIED:
		mb->desk.answered = true;
		break;
	case EC_BOX_ON_JOB:
		job_over(mb, err);
		break;
	case EC_BOX_ON_FAILED:
		finish_all(mb, err);
		break;
	case EC_BOX_ON_RENEWED:
		on_renewed(mb);
		break;
	case EC_BOX_ON_UNABLE:
		mb->desk.unable = true;
		queue_work(system_highpri_wq, &mb->desk.unasked);
		break;
	}
}

const struct ec_box_ops ec_desk_ops = {
	.next = desk_next,
	.want = desk_want,
	.streams = desk_streams,
	.event = desk_event,
};

/**
 * ec_desk_retry() - the users have changed: find the one for the message that the transport holds
 * @mb: mailbox of the slave, the lock of its transport held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_desk_retry(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->box.lock);
	if (mb->box.held && !mb->desk.handed_over)
		on_received(mb);
}

/**
 * ec_desk_has_reader() - give a VoE message that had no user to one that has entered since
 * @mb: mailbox of the slave, the lock of its transport held, @handed_over
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: a user has it.
 */
bool ec_desk_has_reader(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;
	struct ec_mbox_hdr h;

	lockdep_assert_held(&mb->box.lock);
	if (ec_box_message(&mb->box, &h) || h.type != EC_MBOX_VOE)
		return false;
	u = desk_find(mb, EC_MBOX_VOE, h.len);
	if (!u)
		return false;
	deliver(mb, u, &h);
	return true;
}
