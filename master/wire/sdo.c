// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdo.h"

/* command byte */
#define CMD_SHIFT	5
#define CMD_BIT4	0x10	/* complete access, or toggle */
#define CMD_EXPEDITED	0x02
#define CMD_SIZE	0x01
#define SEG_LAST	0x01

/* bits 7-5 of requests (service 2) and responses (service 3) */
enum {
	REQ_DOWN_SEG = 0,
	REQ_DOWN = 1,
	REQ_UP = 2,
	REQ_UP_SEG = 3,
	REQ_ABORT = 4,
	RESP_UP_SEG = 0,
	RESP_DOWN_SEG = 1,
	RESP_UP = 2,
	RESP_DOWN = 3,
};

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

static void put_service(struct ec_wbuf *w, u8 service)
{
	struct ec_coe_hdr h = { .service = service };

	ec_coe_hdr_encode(w, &h);
}

/* Any message that is no segment, up to its four bytes of size or data. */
static void put_head(struct ec_wbuf *w, u8 service, u8 cmd, u16 index, u8 sub)
{
	put_service(w, service);
	ec_wbuf_u8(w, cmd);
	ec_wbuf_le16(w, index);
	ec_wbuf_u8(w, sub);
}

static int put_simple(u8 *tx, size_t cap, u8 service, u8 cmd, u16 index, u8 sub, u32 arg)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	put_head(&w, service, cmd, index, sub);
	ec_wbuf_le32(&w, arg);
	return w.bad ? -EMSGSIZE : EC_SDO_MSG;
}

static int put_abort(u8 *tx, size_t cap, u16 index, u8 sub, u32 abort)
{
	return put_simple(tx, cap, EC_COE_SDO_REQ, REQ_ABORT << CMD_SHIFT, index, sub, abort);
}

/* A segment; @n bytes of data, padded to the minimum. */
static int put_segment(u8 *tx, size_t cap, u8 service, u8 cmd, const u8 *data, size_t n, bool last)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);
	size_t pad = n < EC_SDO_SEG_MIN ? EC_SDO_SEG_MIN - n : 0;

	put_service(&w, service);
	ec_wbuf_u8(&w, (u8)(cmd | pad << 1 | (last ? SEG_LAST : 0)));
	ec_wbuf_bytes(&w, data, n);
	ec_wbuf_zero(&w, pad);
	return w.bad ? -EMSGSIZE : (int)(EC_SDO_SEG_HDR + n + pad);
}

/*
 * Data bytes of a segment. The unused count means something only in a data
 * field of the minimum size; slaves that do not pad send it all the same.
 */
static size_t segment_len(u8 cmd, size_t field)
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
		return put_simple(tx, cap, EC_COE_SDO_REQ,
				  REQ_UP << CMD_SHIFT | (u->complete ? CMD_BIT4 : 0),
				  u->index, u->sub, 0);
	case EC_SDO_SEGMENT:
		/* no index, but the full length of a message */
		return put_simple(tx, cap, EC_COE_SDO_REQ,
				  REQ_UP_SEG << CMD_SHIFT | (u->toggle ? CMD_BIT4 : 0), 0, 0, 0);
	case EC_SDO_ABORT:
		up_set_state(u, EC_SDO_DONE);
		return put_abort(tx, cap, u->index, u->sub, u->abort);
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
	n = segment_len(a->cmd, field);
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

static int down_initiate_tx(struct ec_sdo_down *d, u8 *tx, size_t cap)
{
	u8 cmd = REQ_DOWN << CMD_SHIFT | CMD_SIZE | (d->complete ? CMD_BIT4 : 0);
	struct ec_wbuf w = ec_wbuf(tx, cap);

	/* complete access always in the normal form: not all slaves know the other */
	if (d->size && d->size <= 4 && !d->complete) {
		cmd |= (u8)(CMD_EXPEDITED | (4 - d->size) << 2);
		put_head(&w, EC_COE_SDO_REQ, cmd, d->index, d->sub);
		d->chunk = d->size;
		ec_wbuf_bytes(&w, d->data, d->chunk);
		ec_wbuf_zero(&w, 4 - d->chunk);
		return w.bad ? -EMSGSIZE : EC_SDO_MSG;
	}

	put_head(&w, EC_COE_SDO_REQ, cmd, d->index, d->sub);
	ec_wbuf_le32(&w, (u32)d->size);
	d->chunk = min_t(size_t, d->size, cap - EC_SDO_MSG);
	ec_wbuf_bytes(&w, d->data, d->chunk);
	return w.bad ? -EMSGSIZE : (int)(EC_SDO_MSG + d->chunk);
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
		return down_initiate_tx(d, tx, cap);
	case EC_SDO_SEGMENT:
		d->chunk = min_t(size_t, left, cap - EC_SDO_SEG_HDR);
		return put_segment(tx, cap, EC_COE_SDO_REQ,
				   REQ_DOWN_SEG << CMD_SHIFT | (d->toggle ? CMD_BIT4 : 0),
				   d->data + d->sent, d->chunk, d->chunk == left);
	case EC_SDO_ABORT:
		down_set_state(d, EC_SDO_DONE);
		return put_abort(tx, cap, d->index, d->sub, d->abort);
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

static void srv_set_state(struct ec_sdo_srv *srv, enum ec_sdo_srv_state state)
{
	srv->state = state;
}

/**
 * ec_sdo_srv_init() - prepare an SDO server
 * @srv: server
 * @ops: object dictionary
 * @ctx: its argument
 * @buf: transfer buffer
 * @cap: bytes at @buf: the largest object
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdo_srv_init(struct ec_sdo_srv *srv, const struct ec_sdo_srv_ops *ops, void *ctx,
		     u8 *buf, size_t cap)
{
	*srv = (struct ec_sdo_srv){ .ops = ops, .ctx = ctx, .buf = buf, .cap = cap };
	srv_set_state(srv, EC_SDO_SRV_IDLE);
}

static int srv_abort(struct ec_sdo_srv *srv, u8 *resp, size_t cap, u32 abort)
{
	srv_set_state(srv, EC_SDO_SRV_IDLE);
	return put_abort(resp, cap, srv->index, srv->sub, abort);
}

static u8 srv_ca(const struct ec_sdo_srv *srv)
{
	return srv->complete ? CMD_BIT4 : 0;
}

static int srv_upload(struct ec_sdo_srv *srv, u8 *resp, size_t cap)
{
	struct ec_wbuf w = ec_wbuf(resp, cap);
	u8 cmd = RESP_UP << CMD_SHIFT | CMD_SIZE | srv_ca(srv);
	u32 abort;

	srv->size = 0;
	abort = srv->ops->read(srv->ctx, srv->index, srv->sub, srv->complete,
			       srv->buf, srv->cap, &srv->size);
	if (!abort && srv->size > srv->cap)
		abort = EC_ABORT_INTERNAL;
	if (abort)
		return srv_abort(srv, resp, cap, abort);

	if (srv->size && srv->size <= 4 && !srv->complete) {
		cmd |= (u8)(CMD_EXPEDITED | (4 - srv->size) << 2);
		put_head(&w, EC_COE_SDO_RESP, cmd, srv->index, srv->sub);
		ec_wbuf_bytes(&w, srv->buf, srv->size);
		ec_wbuf_zero(&w, 4 - srv->size);
		return EC_SDO_MSG;
	}
	put_head(&w, EC_COE_SDO_RESP, cmd, srv->index, srv->sub);
	ec_wbuf_le32(&w, (u32)srv->size);
	srv->pos = min_t(size_t, srv->size, cap - EC_SDO_MSG);
	ec_wbuf_bytes(&w, srv->buf, srv->pos);
	if (srv->pos < srv->size)
		srv_set_state(srv, EC_SDO_SRV_UPLOAD);
	return (int)(EC_SDO_MSG + srv->pos);
}

static int srv_upload_seg(struct ec_sdo_srv *srv, u8 cmd, u8 *resp, size_t cap)
{
	size_t left = srv->size - srv->pos, n;
	const u8 *p = srv->buf + srv->pos;
	u8 toggle = cmd & CMD_BIT4;

	if (srv->state != EC_SDO_SRV_UPLOAD)
		return srv_abort(srv, resp, cap, EC_ABORT_COMMAND);
	if (toggle != srv->toggle)
		return srv_abort(srv, resp, cap, EC_ABORT_TOGGLE);
	n = min_t(size_t, left, cap - EC_SDO_SEG_HDR);
	srv->pos += n;
	srv->toggle ^= CMD_BIT4;
	if (n == left)
		srv_set_state(srv, EC_SDO_SRV_IDLE);
	return put_segment(resp, cap, EC_COE_SDO_RESP, RESP_UP_SEG << CMD_SHIFT | toggle,
			   p, n, n == left);
}

static u32 srv_write(struct ec_sdo_srv *srv)
{
	srv_set_state(srv, EC_SDO_SRV_IDLE);
	return srv->ops->write(srv->ctx, srv->index, srv->sub, srv->complete, srv->buf, srv->size);
}

static int srv_download(struct ec_sdo_srv *srv, u8 cmd, struct ec_rbuf *r, u8 *resp, size_t cap)
{
	const u8 *p;
	size_t n;
	u32 abort = 0;

	if (cmd & CMD_EXPEDITED) {
		srv->size = cmd & CMD_SIZE ? 4u - (cmd >> 2 & 3) : 4u;
		n = srv->size;
	} else {
		srv->size = ec_rbuf_le32(r);
		n = min_t(size_t, srv->size, ec_rbuf_left(r));
	}
	if (srv->size > srv->cap)
		return srv_abort(srv, resp, cap, EC_ABORT_MEMORY);
	p = ec_rbuf_take(r, n);
	if (n && p)
		memcpy(srv->buf, p, n);
	srv->pos = n;
	if (n < srv->size)
		srv_set_state(srv, EC_SDO_SRV_DOWNLOAD);
	else
		abort = srv_write(srv);
	if (abort)
		return srv_abort(srv, resp, cap, abort);
	return put_simple(resp, cap, EC_COE_SDO_RESP, RESP_DOWN << CMD_SHIFT | srv_ca(srv),
			  srv->index, srv->sub, 0);
}

static int srv_download_seg(struct ec_sdo_srv *srv, u8 cmd, struct ec_rbuf *r,
			    u8 *resp, size_t cap)
{
	size_t n = segment_len(cmd, ec_rbuf_left(r));
	const u8 *p = ec_rbuf_take(r, n);
	u8 toggle = cmd & CMD_BIT4;
	struct ec_wbuf w = ec_wbuf(resp, cap);
	u32 abort;

	if (srv->state != EC_SDO_SRV_DOWNLOAD)
		return srv_abort(srv, resp, cap, EC_ABORT_COMMAND);
	if (toggle != srv->toggle)
		return srv_abort(srv, resp, cap, EC_ABORT_TOGGLE);
	if (n > srv->size - srv->pos)
		return srv_abort(srv, resp, cap, EC_ABORT_TOO_LONG);
	if (n)
		memcpy(srv->buf + srv->pos, p, n);
	srv->pos += n;
	srv->toggle ^= CMD_BIT4;
	if (cmd & SEG_LAST) {
		abort = srv->pos < srv->size ? EC_ABORT_TOO_SHORT : srv_write(srv);
		if (abort)
			return srv_abort(srv, resp, cap, abort);
	}
	put_service(&w, EC_COE_SDO_RESP);
	ec_wbuf_u8(&w, RESP_DOWN_SEG << CMD_SHIFT | toggle);
	ec_wbuf_zero(&w, EC_SDO_SEG_MIN);
	return EC_SDO_MSG;
}

/**
 * ec_sdo_srv_handle() - answer an SDO request
 * @srv: server
 * @req: CoE message behind the mailbox header
 * @len: bytes at @req: the length of the mailbox header
 * @resp: answer, without mailbox header
 * @cap: size of the slave's send mailbox less EC_MBOX_HDR, at least EC_SDO_MSG
 *
 * Context: Any. RT-safe: bounded apart from @srv->ops, no sleep, no allocation.
 * Return: bytes of the answer, 0 when none is due (an abort came),
 * -EMSGSIZE for a request that is too short, -ENOMSG for a message that is no
 * SDO request; both call for an error reply of the mailbox. -EINVAL: @cap is
 * too small.
 */
int ec_sdo_srv_handle(struct ec_sdo_srv *srv, const u8 *req, size_t len, u8 *resp, size_t cap)
{
	struct ec_rbuf r = ec_rbuf(req, len);
	struct ec_coe_hdr h;
	u8 cmd, cs;

	if (cap < EC_SDO_MSG)
		return -EINVAL;
	if (ec_coe_hdr_decode(&r, &h))
		return -EMSGSIZE;
	if (h.service != EC_COE_SDO_REQ)
		return -ENOMSG;
	cmd = ec_rbuf_u8(&r);
	if (r.bad)
		return -EMSGSIZE;

	cs = cmd >> CMD_SHIFT;
	switch (cs) {
	case REQ_UP_SEG:
		return srv_upload_seg(srv, cmd, resp, cap);
	case REQ_DOWN_SEG:
		return srv_download_seg(srv, cmd, &r, resp, cap);
	case REQ_ABORT:
		srv_set_state(srv, EC_SDO_SRV_IDLE);
		return 0;
	}

	/* a new transfer ends the last one */
	srv_set_state(srv, EC_SDO_SRV_IDLE);
	srv->index = ec_rbuf_le16(&r);
	srv->sub = ec_rbuf_u8(&r);
	srv->complete = cmd & CMD_BIT4;
	srv->toggle = 0;
	srv->pos = 0;
	if (ec_rbuf_left(&r) < 4)
		return -EMSGSIZE;
	if (cs != REQ_UP && cs != REQ_DOWN)
		return srv_abort(srv, resp, cap, EC_ABORT_COMMAND);
	if (srv->complete && srv->sub > 1)
		return srv_abort(srv, resp, cap, EC_ABORT_NO_SUB);
	if (cs == REQ_UP)
		return srv_upload(srv, resp, cap);
	return srv_download(srv, cmd, &r, resp, cap);
}
