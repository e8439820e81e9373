// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdo_msg.h"

const char *ec_sdo_state_name(enum ec_sdo_state state)
{
	switch (state) {
	case EC_SDO_INITIATE:
		return "INITIATE";
	case EC_SDO_SEGMENT:
		return "SEGMENT";
	case EC_SDO_ABORT:
		return "ABORT";
	case EC_SDO_DONE:
		return "DONE";
	}
	return "???";
}

/* Any message that is no segment, up to its four bytes of size or data. */
static void put_head(struct ec_wbuf *w, u8 service, u8 cmd, u16 index, u8 sub)
{
	ec_coe_hdr_encode(w, service);
	ec_wbuf_u8(w, cmd);
	ec_wbuf_le16(w, index);
	ec_wbuf_u8(w, sub);
}

/**
 * ec_sdo_put() - write a message without data
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @service: EC_COE_SDO_REQ or EC_COE_SDO_RESP
 * @cmd: command byte
 * @index: object, 0 for segments
 * @sub: subindex, 0 for segments
 * @arg: last four bytes
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit.
 */
int ec_sdo_put(u8 *tx, size_t cap, u8 service, u8 cmd, u16 index, u8 sub, u32 arg)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	put_head(&w, service, cmd, index, sub);
	ec_wbuf_le32(&w, arg);
	return w.bad ? -EMSGSIZE : EC_SDO_MSG;
}

/**
 * ec_sdo_put_abort() - write an abort; client and server send the same
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @index: object
 * @sub: subindex
 * @abort: abort code
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit.
 */
int ec_sdo_put_abort(u8 *tx, size_t cap, u16 index, u8 sub, u32 abort)
{
	return ec_sdo_put(tx, cap, EC_COE_SDO_REQ, REQ_ABORT << CMD_SHIFT, index, sub, abort);
}

/**
 * ec_sdo_put_object() - write the first message that carries an object's data
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx, at least EC_SDO_MSG
 * @service: EC_COE_SDO_REQ or EC_COE_SDO_RESP
 * @cmd: command byte: REQ_DOWN or RESP_UP, and CMD_BIT4 for complete access
 * @index: object
 * @sub: subindex
 * @data: content of the object
 * @size: bytes at @data
 * @chunk: result: bytes of @data in the message
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit.
 */
int ec_sdo_put_object(u8 *tx, size_t cap, u8 service, u8 cmd, u16 index, u8 sub,
		      const u8 *data, size_t size, size_t *chunk)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	/* complete access always in the normal form: not all slaves know the other */
	if (size && size <= 4 && !(cmd & CMD_BIT4)) {
		put_head(&w, service, (u8)(cmd | CMD_SIZE | CMD_EXPEDITED | (4 - size) << 2),
			 index, sub);
		*chunk = size;
		ec_wbuf_bytes(&w, data, size);
		ec_wbuf_zero(&w, 4 - size);
	} else {
		put_head(&w, service, cmd | CMD_SIZE, index, sub);
		ec_wbuf_le32(&w, (u32)size);
		*chunk = min_t(size_t, size, cap - EC_SDO_MSG);
		ec_wbuf_bytes(&w, data, *chunk);
	}
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/**
 * ec_sdo_put_segment() - write a segment, padded to the minimum
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @service: EC_COE_SDO_REQ or EC_COE_SDO_RESP
 * @cmd: command byte: REQ_DOWN_SEG or RESP_UP_SEG, and the toggle bit
 * @data: data of the segment
 * @n: bytes at @data
 * @last: no segment follows
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit.
 */
int ec_sdo_put_segment(u8 *tx, size_t cap, u8 service, u8 cmd, const u8 *data, size_t n,
		       bool last)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);
	size_t pad = n < EC_SDO_SEG_MIN ? EC_SDO_SEG_MIN - n : 0;

	ec_coe_hdr_encode(&w, service);
	ec_wbuf_u8(&w, (u8)(cmd | pad << 1 | (last ? SEG_LAST : 0)));
	ec_wbuf_bytes(&w, data, n);
	ec_wbuf_zero(&w, pad);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/**
 * ec_sdo_segment_len() - data bytes of a received segment
 * @cmd: command byte
 * @field: bytes behind it
 *
 * The unused count of @cmd means something only in a data field of the minimum size; slaves that
 * do not pad send it all the same.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, at most @field.
 */
size_t ec_sdo_segment_len(u8 cmd, size_t field)
{
	size_t n = EC_SDO_SEG_MIN - (cmd >> 1 & 7);

	return field > EC_SDO_SEG_MIN ? field : min_t(size_t, field, n);
}

/* What every answer to a client has in common. */
struct answer {
	u8 service;
	u8 cmd;
	u16 index;
	u8 sub;
	struct ec_rbuf r;	/* behind the command byte */
};

static int answer_decode(struct answer *a, const u8 *rx, size_t len)
{
	struct ec_coe_hdr h;
	struct ec_rbuf peek;

	a->r = ec_rbuf(rx, len);
	if (ec_coe_hdr_decode(&a->r, &h))
		return -EMSGSIZE;
	*a = (struct answer){ .service = h.service, .r = a->r };
	if (h.service != EC_COE_SDO_REQ && h.service != EC_COE_SDO_RESP)
		return 0;
	a->cmd = ec_rbuf_u8(&a->r);
	if (a->r.bad)
		return -EMSGSIZE;
	peek = a->r;
	a->index = ec_rbuf_le16(&peek);
	a->sub = ec_rbuf_u8(&peek);
	return 0;
}

static bool is_abort(const struct answer *a)
{
	return a->cmd >> CMD_SHIFT == REQ_ABORT &&
	       (a->service == EC_COE_SDO_REQ || a->service == EC_COE_SDO_RESP);
}

/*
 * Subindex 0 and 1 of complete access name the same transfer: some slaves
 * answer with the other one.
 */
static bool same_object(const struct answer *a, u16 index, u8 sub, bool complete)
{
	return a->index == index && (a->sub == sub || (complete && a->sub <= 1));
}

static int get_abort(struct answer *a, u32 *abort)
{
	ec_rbuf_take(&a->r, 3);
	*abort = ec_rbuf_le32(&a->r);
	return a->r.bad ? -EMSGSIZE : -EIO;
}

static void up_set_state(struct ec_sdo_up *u, enum ec_sdo_state state)
{
	u->state = state;
	u->send_abort = state == EC_SDO_ABORT;
}

/* Ends an upload with @err; the slave is told if it would go on. */
static int up_fail(struct ec_sdo_up *u, int err, u32 abort, bool tell)
{
	u->abort = abort;
	up_set_state(u, tell ? EC_SDO_ABORT : EC_SDO_DONE);
	return err;
}

/**
 * ec_sdo_up_init() - prepare an upload
 * @u: exchange
 * @index: object
 * @sub: subindex; with @complete 0 (with the count) or 1
 * @complete: complete access
 * @data: where the data go
 * @cap: bytes at @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_up_init(struct ec_sdo_up *u, u16 index, u8 sub, bool complete, u8 *data, size_t cap)
{
	*u = (struct ec_sdo_up){
		.index = index, .sub = sub, .complete = complete,
		.data = data, .cap = cap,
	};
	up_set_state(u, EC_SDO_INITIATE);
}

/**
 * ec_sdo_up_tx() - next message of an upload
 * @u: exchange
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * The same message again if called again before ec_sdo_up_rx(); an abort is
 * given out once.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit, -EINVAL when the upload is over.
 */
int ec_sdo_up_tx(struct ec_sdo_up *u, u8 *tx, size_t cap)
{
	switch (u->state) {
	case EC_SDO_INITIATE:
		return ec_sdo_put(tx, cap, EC_COE_SDO_REQ,
				  REQ_UP << CMD_SHIFT | (u->complete ? CMD_BIT4 : 0),
				  u->index, u->sub, 0);
	case EC_SDO_SEGMENT:
		/* no index, but the full length of a message */
		return ec_sdo_put(tx, cap, EC_COE_SDO_REQ,
				  REQ_UP_SEG << CMD_SHIFT | (u->toggle ? CMD_BIT4 : 0), 0, 0, 0);
	case EC_SDO_ABORT:
		up_set_state(u, EC_SDO_DONE);
		return ec_sdo_put_abort(tx, cap, u->index, u->sub, u->abort);
	case EC_SDO_DONE:
		break;
	}
	return -EINVAL;
}

static int up_take(struct ec_sdo_up *u, const u8 *p, size_t n, bool more)
{
	if (n > u->cap - u->size)
		return up_fail(u, -ENOBUFS, EC_ABORT_MEMORY, more);
	if (n)
		memcpy(u->data + u->size, p, n);
	u->size += n;
	up_set_state(u, more ? EC_SDO_SEGMENT : EC_SDO_DONE);
	return more ? EC_MORE : 0;
}

static int up_initiate(struct ec_sdo_up *u, struct answer *a)
{
	size_t n, left;
	const u8 *p;

	if (a->cmd >> CMD_SHIFT != RESP_UP)
		return EC_STALE;
	ec_rbuf_take(&a->r, 3);
	if (a->r.bad)
		return up_fail(u, -EMSGSIZE, EC_ABORT_COMMAND, false);
	if (!same_object(a, u->index, u->sub, u->complete))
		return EC_STALE;

	if (a->cmd & CMD_EXPEDITED) {
		n = a->cmd & CMD_SIZE ? 4u - (a->cmd >> 2 & 3) : 4u;
		p = ec_rbuf_take(&a->r, n);
		if (!p)
			return up_fail(u, -EMSGSIZE, EC_ABORT_COMMAND, false);
		/* without a size the object may well be smaller, but it is not empty */
		if (!(a->cmd & CMD_SIZE))
			n = min_t(size_t, n, u->cap ?: 1);
		u->total = n;
		return up_take(u, p, n, false);
	}

	n = ec_rbuf_le32(&a->r);
	if (a->r.bad)
		return up_fail(u, -EMSGSIZE, EC_ABORT_COMMAND, false);
	left = ec_rbuf_left(&a->r);
	p = ec_rbuf_take(&a->r, left);
	if (!(a->cmd & CMD_SIZE))	/* what has data in it is complete */
		return up_take(u, p, left, !left);
	u->total = n;
	if (n > u->cap)
		return up_fail(u, -ENOBUFS, EC_ABORT_MEMORY, n > left);
	/* what exceeds the size is the padding of a slave that fills its mailbox */
	return up_take(u, p, min_t(size_t, n, left), n > left);
}

static int up_segment(struct ec_sdo_up *u, struct answer *a)
{
	u8 cs = a->cmd >> CMD_SHIFT;
	size_t field, n;
	bool last = a->cmd & SEG_LAST;

	if ((cs == RESP_UP || cs == RESP_DOWN) &&
	    !same_object(a, u->index, u->sub, u->complete))
		return EC_STALE;
	if (cs != RESP_UP_SEG)
		return up_fail(u, -EPROTO, EC_ABORT_COMMAND, true);
	if (!(a->cmd & CMD_BIT4) != !u->toggle)
		return up_fail(u, -EPROTO, EC_ABORT_TOGGLE, true);

	field = ec_rbuf_left(&a->r);
	n = ec_sdo_segment_len(a->cmd, field);
	if (!n && !last)	/* would go on for ever */
		return up_fail(u, field ? -EPROTO : -EMSGSIZE, EC_ABORT_COMMAND, true);
	u->toggle = !u->toggle;
	return up_take(u, ec_rbuf_take(&a->r, n), n, !last);
}

/**
 * ec_sdo_up_rx() - take the answer to ec_sdo_up_tx()
 * @u: exchange
 * @rx: CoE message behind the mailbox header; emergencies are better handled
 *	before, here they are stale
 * @len: bytes at @rx: the length of the mailbox header
 *
 * The size announced by the slave counts for nothing but the capacity check:
 * @u->size is what really came.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 when complete, EC_MORE to send the next message, EC_STALE for what
 * is not our answer; -EIO: the slave aborted, see @u->abort; -ENOBUFS: larger
 * than @cap, @u->total is the size if known; -EPROTO: wrong toggle bit or
 * command; -EMSGSIZE: message too short; -EINVAL: nothing was asked. After
 * an error with @u->send_abort ec_sdo_up_tx() has one more message.
 */
int ec_sdo_up_rx(struct ec_sdo_up *u, const u8 *rx, size_t len)
{
	struct answer a;

	if (u->state == EC_SDO_ABORT || u->state == EC_SDO_DONE)
		return -EINVAL;
	if (answer_decode(&a, rx, len))
		return up_fail(u, -EMSGSIZE, EC_ABORT_COMMAND, u->state == EC_SDO_SEGMENT);
	if (is_abort(&a)) {
		if (!same_object(&a, u->index, u->sub, u->complete) &&
		    (u->state == EC_SDO_INITIATE || a.index))
			return EC_STALE;
		up_set_state(u, EC_SDO_DONE);
		return get_abort(&a, &u->abort);
	}
	if (a.service != EC_COE_SDO_RESP)
		return EC_STALE;
	return u->state == EC_SDO_INITIATE ? up_initiate(u, &a) : up_segment(u, &a);
}

/**
 * ec_sdo_up_cancel() - give an upload up
 * @u: exchange
 * @abort: code for the slave
 *
 * For a time limit that has passed or an interrupted caller. If @u->send_abort
 * is set afterwards, send ec_sdo_up_tx() once and expect no answer.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_up_cancel(struct ec_sdo_up *u, u32 abort)
{
	if (u->state == EC_SDO_INITIATE || u->state == EC_SDO_SEGMENT)
		up_fail(u, 0, abort, true);
}

static void down_set_state(struct ec_sdo_down *d, enum ec_sdo_state state)
{
	d->state = state;
	d->send_abort = state == EC_SDO_ABORT;
}

static int down_fail(struct ec_sdo_down *d, int err, u32 abort, bool tell)
{
	d->abort = abort;
	down_set_state(d, tell ? EC_SDO_ABORT : EC_SDO_DONE);
	return err;
}

/**
 * ec_sdo_down_init() - prepare a download
 * @d: exchange
 * @index: object
 * @sub: subindex; with @complete 0 (with the count) or 1
 * @complete: complete access
 * @data: what to write; must stay as it is until the end
 * @size: bytes at @data
 * @mbox_size: size of the slave's receive mailbox less EC_MBOX_HDR
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_down_init(struct ec_sdo_down *d, u16 index, u8 sub, bool complete,
		      const u8 *data, size_t size, size_t mbox_size)
{
	*d = (struct ec_sdo_down){
		.index = index, .sub = sub, .complete = complete,
		.data = data, .size = size, .mbox_size = mbox_size,
	};
	down_set_state(d, EC_SDO_INITIATE);
}

/**
 * ec_sdo_down_tx() - next message of a download
 * @d: exchange
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * The same message again if called again before ec_sdo_down_rx(); an abort is
 * given out once.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when @cap or the slave's mailbox is too small for
 * any SDO or the data too large for the protocol, -EINVAL when the download is
 * over.
 */
int ec_sdo_down_tx(struct ec_sdo_down *d, u8 *tx, size_t cap)
{
	size_t left = d->size - d->sent;

	cap = min_t(size_t, cap, d->mbox_size);
	if (cap < EC_SDO_MSG || d->size > 0x7FFFFFFF)
		return -EMSGSIZE;

	switch (d->state) {
	case EC_SDO_INITIATE:
		return ec_sdo_put_object(tx, cap, EC_COE_SDO_REQ,
					 REQ_DOWN << CMD_SHIFT | (d->complete ? CMD_BIT4 : 0),
					 d->index, d->sub, d->data, d->size, &d->chunk);
	case EC_SDO_SEGMENT:
		d->chunk = min_t(size_t, left, cap - EC_SDO_SEG_HDR);
		return ec_sdo_put_segment(tx, cap, EC_COE_SDO_REQ,
				   REQ_DOWN_SEG << CMD_SHIFT | (d->toggle ? CMD_BIT4 : 0),
				   d->data + d->sent, d->chunk, d->chunk == left);
	case EC_SDO_ABORT:
		down_set_state(d, EC_SDO_DONE);
		return ec_sdo_put_abort(tx, cap, d->index, d->sub, d->abort);
	case EC_SDO_DONE:
		break;
	}
	return -EINVAL;
}

/**
 * ec_sdo_down_rx() - take the answer to ec_sdo_down_tx()
 * @d: exchange
 * @rx: CoE message behind the mailbox header
 * @len: bytes at @rx: the length of the mailbox header
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 when the slave has taken all, EC_MORE to send the next message,
 * EC_STALE for what is not our answer; -EIO: the slave aborted, see @d->abort;
 * -EPROTO: wrong toggle bit or command; -EMSGSIZE: message too short;
 * -EINVAL: nothing was asked. After an error with @d->send_abort
 * ec_sdo_down_tx() has one more message.
 */
int ec_sdo_down_rx(struct ec_sdo_down *d, const u8 *rx, size_t len)
{
	struct answer a;
	u8 cs;

	if (d->state == EC_SDO_ABORT || d->state == EC_SDO_DONE)
		return -EINVAL;
	if (answer_decode(&a, rx, len))
		return down_fail(d, -EMSGSIZE, EC_ABORT_COMMAND, d->state == EC_SDO_SEGMENT);
	cs = a.cmd >> CMD_SHIFT;
	if (is_abort(&a)) {
		if (!same_object(&a, d->index, d->sub, d->complete) &&
		    (d->state == EC_SDO_INITIATE || a.index))
			return EC_STALE;
		down_set_state(d, EC_SDO_DONE);
		return get_abort(&a, &d->abort);
	}
	if (a.service != EC_COE_SDO_RESP)
		return EC_STALE;

	if (d->state == EC_SDO_INITIATE) {
		if (cs != RESP_DOWN)
			return EC_STALE;
		if (ec_rbuf_left(&a.r) < 3)
			return down_fail(d, -EMSGSIZE, EC_ABORT_COMMAND, false);
		if (!same_object(&a, d->index, d->sub, d->complete))
			return EC_STALE;
	} else {
		if ((cs == RESP_UP || cs == RESP_DOWN) &&
		    !same_object(&a, d->index, d->sub, d->complete))
			return EC_STALE;
		if (cs != RESP_DOWN_SEG)
			return down_fail(d, -EPROTO, EC_ABORT_COMMAND, true);
		if (!(a.cmd & CMD_BIT4) != !d->toggle)
			return down_fail(d, -EPROTO, EC_ABORT_TOGGLE, true);
		d->toggle = !d->toggle;
	}

	d->sent += d->chunk;
	d->chunk = 0;
	down_set_state(d, d->sent < d->size ? EC_SDO_SEGMENT : EC_SDO_DONE);
	return d->state == EC_SDO_SEGMENT ? EC_MORE : 0;
}

/**
 * ec_sdo_down_cancel() - give a download up
 * @d: exchange
 * @abort: code for the slave
 *
 * See ec_sdo_up_cancel().
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_down_cancel(struct ec_sdo_down *d, u32 abort)
{
	if (d->state == EC_SDO_INITIATE || d->state == EC_SDO_SEGMENT)
		down_fail(d, 0, abort, true);
}
