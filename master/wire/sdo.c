// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdo_msg.h"

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
 * do not pad send it nevertheless.
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
static bool same_object(const struct answer *a, const struct ec_sdo *s)
{
	return a->index == s->index && (a->sub == s->sub || (s->complete && a->sub <= 1));
}

static void sdo_set_state(struct ec_sdo *s, enum ec_sdo_state state)
{
	s->state = state;
	s->send_abort = state == EC_SDO_ABORT;
}

/* End a transfer with @err; @goes_on: the slave does not know, it needs an abort. */
static int sdo_fail(struct ec_sdo *s, int err, u32 abort, bool goes_on)
{
	s->abort = abort;
	sdo_set_state(s, goes_on ? EC_SDO_ABORT : EC_SDO_DONE);
	return err;
}

/**
 * ec_sdo_upload_init() - prepare an upload
 * @s: transfer
 * @index: object
 * @sub: subindex; with @complete 0 (with the count) or 1
 * @complete: complete access
 * @data: where the data go
 * @cap: bytes at @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_upload_init(struct ec_sdo *s, u16 index, u8 sub, bool complete, u8 *data, size_t cap)
{
	*s = (struct ec_sdo){
		.index = index, .sub = sub, .complete = complete,
		.data = data, .cap = cap,
	};
}

/**
 * ec_sdo_download_init() - prepare a download
 * @s: transfer
 * @index: object
 * @sub: subindex; with @complete 0 (with the count) or 1
 * @complete: complete access
 * @data: value; must not change until the end
 * @size: bytes at @data
 * @mbox_size: size of the slave's receive mailbox less EC_MBOX_HDR
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_download_init(struct ec_sdo *s, u16 index, u8 sub, bool complete,
			  const u8 *data, size_t size, size_t mbox_size)
{
	*s = (struct ec_sdo){
		.down = true, .index = index, .sub = sub, .complete = complete,
		.data = (u8 *)data, .size = size, .mbox_size = mbox_size,
	};
}

static int initiate_tx(struct ec_sdo *s, u8 *tx, size_t cap)
{
	u8 complete = s->complete ? CMD_BIT4 : 0;

	if (s->down)
		return ec_sdo_put_object(tx, cap, EC_COE_SDO_REQ, REQ_DOWN << CMD_SHIFT | complete,
					 s->index, s->sub, s->data, s->size, &s->chunk);
	return ec_sdo_put(tx, cap, EC_COE_SDO_REQ, REQ_UP << CMD_SHIFT | complete, s->index,
			  s->sub, 0);
}

static int segment_tx(struct ec_sdo *s, u8 *tx, size_t cap)
{
	u8 toggle = s->toggle ? CMD_BIT4 : 0;
	size_t left = s->size - s->sent;

	/* no index, but the full length of a message */
	if (!s->down)
		return ec_sdo_put(tx, cap, EC_COE_SDO_REQ, REQ_UP_SEG << CMD_SHIFT | toggle,
				  0, 0, 0);
	s->chunk = min_t(size_t, left, cap - EC_SDO_SEG_HDR);
	return ec_sdo_put_segment(tx, cap, EC_COE_SDO_REQ, REQ_DOWN_SEG << CMD_SHIFT | toggle,
				  s->data + s->sent, s->chunk, s->chunk == left);
}

/**
 * ec_sdo_tx() - next message of a transfer
 * @s: transfer
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * Without ec_sdo_rx() in between it is the same message again; an abort is given out once.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when @cap or the slave's mailbox is too small for
 * any SDO or the value too large for the protocol, -EINVAL when the transfer is
 * over.
 */
int ec_sdo_tx(struct ec_sdo *s, u8 *tx, size_t cap)
{
	if (s->down)
		cap = min_t(size_t, cap, s->mbox_size);
	if (cap < EC_SDO_MSG || s->size > 0x7FFFFFFF)
		return -EMSGSIZE;

	switch (s->state) {
	case EC_SDO_INITIATE:
		return initiate_tx(s, tx, cap);
	case EC_SDO_SEGMENT:
		return segment_tx(s, tx, cap);
	case EC_SDO_ABORT:
		sdo_set_state(s, EC_SDO_DONE);
		return ec_sdo_put_abort(tx, cap, s->index, s->sub, s->abort);
	case EC_SDO_DONE:
		break;
	}
	return -EINVAL;
}

static int upload_take(struct ec_sdo *s, const u8 *p, size_t n, bool more)
{
	if (n > s->cap - s->size)
		return sdo_fail(s, -ENOBUFS, EC_ABORT_MEMORY, more);
	if (n)
		memcpy(s->data + s->size, p, n);
	s->size += n;
	sdo_set_state(s, more ? EC_SDO_SEGMENT : EC_SDO_DONE);
	return more ? EC_MORE : 0;
}

static int upload_initiate(struct ec_sdo *s, struct answer *a)
{
	size_t n, left;
	const u8 *p;

	if (a->cmd & CMD_EXPEDITED) {
		n = a->cmd & CMD_SIZE ? 4u - (a->cmd >> 2 & 3) : 4u;
		p = ec_rbuf_take(&a->r, n);
		if (!p)
			return sdo_fail(s, -EMSGSIZE, EC_ABORT_COMMAND, false);
		/* without a size the object may well be smaller, but it is not empty */
		if (!(a->cmd & CMD_SIZE))
			n = min_t(size_t, n, s->cap ?: 1);
		s->total = n;
		return upload_take(s, p, n, false);
	}

	n = ec_rbuf_le32(&a->r);
	if (a->r.bad)
		return sdo_fail(s, -EMSGSIZE, EC_ABORT_COMMAND, false);
	left = ec_rbuf_left(&a->r);
	p = ec_rbuf_take(&a->r, left);
	if (!(a->cmd & CMD_SIZE))	/* what has data in it is complete */
		return upload_take(s, p, left, !left);
	s->total = n;
	if (n > s->cap)
		return sdo_fail(s, -ENOBUFS, EC_ABORT_MEMORY, n > left);
	/* what exceeds the size is the padding of a slave that fills its mailbox */
	return upload_take(s, p, min_t(size_t, n, left), n > left);
}

static int upload_segment(struct ec_sdo *s, struct answer *a)
{
	size_t field = ec_rbuf_left(&a->r), n = ec_sdo_segment_len(a->cmd, field);
	bool last = a->cmd & SEG_LAST;

	if (!n && !last)	/* would not end */
		return sdo_fail(s, field ? -EPROTO : -EMSGSIZE, EC_ABORT_COMMAND, true);
	s->toggle = !s->toggle;
	return upload_take(s, ec_rbuf_take(&a->r, n), n, !last);
}

static int initiate_rx(struct ec_sdo *s, struct answer *a)
{
	if (a->cmd >> CMD_SHIFT != (s->down ? RESP_DOWN : RESP_UP))
		return EC_STALE;
	if (!ec_rbuf_take(&a->r, 3))
		return sdo_fail(s, -EMSGSIZE, EC_ABORT_COMMAND, false);
	return same_object(a, s) ? 0 : EC_STALE;
}

static int segment_rx(struct ec_sdo *s, const struct answer *a)
{
	u8 cs = a->cmd >> CMD_SHIFT;

	if ((cs == RESP_UP || cs == RESP_DOWN) && !same_object(a, s))
		return EC_STALE;
	if (cs != (s->down ? RESP_DOWN_SEG : RESP_UP_SEG))
		return sdo_fail(s, -EPROTO, EC_ABORT_COMMAND, true);
	if (!(a->cmd & CMD_BIT4) != !s->toggle)
		return sdo_fail(s, -EPROTO, EC_ABORT_TOGGLE, true);
	return 0;
}

/**
 * ec_sdo_rx() - take the answer to ec_sdo_tx()
 * @s: transfer
 * @rx: CoE message behind the mailbox header; the caller handles emergencies
 *	before, here they are stale
 * @len: bytes at @rx: the length of the mailbox header
 *
 * The size announced by the slave counts for nothing but the capacity check:
 * @s->size is what really came.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 when complete, EC_MORE to send the next message, EC_STALE for what
 * is not our answer; -EIO: the slave aborted, see @s->abort; -ENOBUFS: larger
 * than @cap, @s->total is the size if known; -EPROTO: wrong toggle bit or
 * command; -EMSGSIZE: message too short; -EINVAL: the transfer is over. After
 * an error with @s->send_abort ec_sdo_tx() has one more message.
 */
int ec_sdo_rx(struct ec_sdo *s, const u8 *rx, size_t len)
{
	bool initiate = s->state == EC_SDO_INITIATE;
	struct answer a;
	int ret;

	if (s->state == EC_SDO_ABORT || s->state == EC_SDO_DONE)
		return -EINVAL;
	if (answer_decode(&a, rx, len))
		return sdo_fail(s, -EMSGSIZE, EC_ABORT_COMMAND, !initiate);
	if (is_abort(&a)) {
		if (!same_object(&a, s) && (initiate || a.index))
			return EC_STALE;
		sdo_set_state(s, EC_SDO_DONE);
		ec_rbuf_take(&a.r, 3);
		s->abort = ec_rbuf_le32(&a.r);
		return a.r.bad ? -EMSGSIZE : -EIO;
	}
	if (a.service != EC_COE_SDO_RESP)
		return EC_STALE;
	ret = initiate ? initiate_rx(s, &a) : segment_rx(s, &a);
	if (ret)
		return ret;
	if (!s->down)
		return initiate ? upload_initiate(s, &a) : upload_segment(s, &a);
	s->toggle = initiate ? 0 : !s->toggle;
	s->sent += s->chunk;
	s->chunk = 0;
	sdo_set_state(s, s->sent < s->size ? EC_SDO_SEGMENT : EC_SDO_DONE);
	return s->state == EC_SDO_SEGMENT ? EC_MORE : 0;
}

/**
 * ec_sdo_cancel() - cancel a transfer
 * @s: transfer
 *
 * A slave in the middle of segments gets an abort: @s->send_abort, and ec_sdo_tx() has one more
 * message.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_cancel(struct ec_sdo *s)
{
	if (s->state == EC_SDO_SEGMENT)
		sdo_fail(s, 0, EC_ABORT_TIMEOUT, true);
}
