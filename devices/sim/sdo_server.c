// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdo_server.h"
#include "../../master/wire/sdo_msg.h"

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
}

static int srv_abort(struct ec_sdo_srv *srv, u8 *resp, size_t cap, u32 abort)
{
	srv->state = EC_SDO_SRV_IDLE;
	return ec_sdo_put_abort(resp, cap, srv->index, srv->sub, abort);
}

static u8 srv_ca(const struct ec_sdo_srv *srv)
{
	return srv->complete ? CMD_BIT4 : 0;
}

static int srv_upload(struct ec_sdo_srv *srv, u8 *resp, size_t cap)
{
	u32 abort;
	int ret;

	srv->size = 0;
	abort = srv->ops->read(srv->ctx, srv->index, srv->sub, srv->complete,
			       srv->buf, srv->cap, &srv->size);
	if (!abort && srv->size > srv->cap)
		abort = EC_ABORT_INTERNAL;
	if (abort)
		return srv_abort(srv, resp, cap, abort);

	ret = ec_sdo_put_object(resp, cap, EC_COE_SDO_RESP, RESP_UP << CMD_SHIFT | srv_ca(srv),
				srv->index, srv->sub, srv->buf, srv->size, &srv->pos);
	if (srv->pos < srv->size)
		srv->state = EC_SDO_SRV_UPLOAD;
	return ret;
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
		srv->state = EC_SDO_SRV_IDLE;
	return ec_sdo_put_segment(resp, cap, EC_COE_SDO_RESP, RESP_UP_SEG << CMD_SHIFT | toggle,
				  p, n, n == left);
}

static u32 srv_write(struct ec_sdo_srv *srv)
{
	srv->state = EC_SDO_SRV_IDLE;
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
		srv->state = EC_SDO_SRV_DOWNLOAD;
	else
		abort = srv_write(srv);
	if (abort)
		return srv_abort(srv, resp, cap, abort);
	return ec_sdo_put(resp, cap, EC_COE_SDO_RESP, RESP_DOWN << CMD_SHIFT | srv_ca(srv),
			  srv->index, srv->sub, 0);
}

static int srv_download_seg(struct ec_sdo_srv *srv, u8 cmd, struct ec_rbuf *r,
			    u8 *resp, size_t cap)
{
	size_t n = ec_sdo_segment_len(cmd, ec_rbuf_left(r));
	const u8 *p = ec_rbuf_take(r, n);
	u8 toggle = cmd & CMD_BIT4;
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
	return ec_sdo_put(resp, cap, EC_COE_SDO_RESP, RESP_DOWN_SEG << CMD_SHIFT | toggle, 0, 0, 0);
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
		srv->state = EC_SDO_SRV_IDLE;
		return 0;
	}

	/* a new transfer ends the last one */
	srv->state = EC_SDO_SRV_IDLE;
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
