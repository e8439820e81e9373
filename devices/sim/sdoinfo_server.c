// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdoinfo_server.h"

/**
 * ec_sdoinfo_req_decode() - read a request
 * @rx: CoE message behind the mailbox header
 * @len: bytes at @rx
 * @req: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOMSG when it is no SDO information, -EOPNOTSUPP for an unknown
 * opcode, -EMSGSIZE when it is too short.
 */
int ec_sdoinfo_req_decode(const u8 *rx, size_t len, struct ec_sdoinfo_req *req)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_coe_hdr h;

	if (ec_coe_hdr_decode(&r, &h))
		return -EMSGSIZE;
	if (h.service != EC_COE_SDO_INFO)
		return -ENOMSG;
	req->opcode = ec_rbuf_u8(&r) & EC_SDOINFO_OPCODE_MASK;
	ec_rbuf_take(&r, 3);
	if (!r.bad && req->opcode != EC_SDOINFO_LIST_REQ &&
	    req->opcode != EC_SDOINFO_OBJECT_REQ && req->opcode != EC_SDOINFO_ENTRY_REQ)
		return -EOPNOTSUPP;
	req->index = ec_rbuf_le16(&r);
	req->sub = 0;
	req->info = 0;
	if (req->opcode == EC_SDOINFO_ENTRY_REQ) {
		req->sub = ec_rbuf_u8(&r);
		req->info = ec_rbuf_u8(&r);
	}
	return r.bad ? -EMSGSIZE : 0;
}

/**
 * ec_od_object_encode() - write an object description
 * @buf: body of the answer
 * @cap: bytes at @buf
 * @o: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -ENOBUFS when they do not fit.
 */
int ec_od_object_encode(u8 *buf, size_t cap, const struct ec_od_object *o)
{
	struct ec_wbuf w = ec_wbuf(buf, cap);

	ec_wbuf_le16(&w, o->index);
	ec_wbuf_le16(&w, o->type);
	ec_wbuf_u8(&w, o->max_sub);
	ec_wbuf_u8(&w, o->code);
	ec_wbuf_bytes(&w, o->name, o->name_len);
	return w.bad ? -ENOBUFS : (int)(w.p - buf);
}

/**
 * ec_od_entry_encode() - write an entry description
 * @buf: body of the answer
 * @cap: bytes at @buf
 * @e: what to write, but none of the optional fields of @e->info
 * @v: optional fields; NULL: none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -ENOBUFS when they do not fit.
 */
int ec_od_entry_encode(u8 *buf, size_t cap, const struct ec_od_entry *e,
		       const struct ec_od_values *v)
{
	struct ec_wbuf w = ec_wbuf(buf, cap);
	u8 info = v ? v->info : 0;

	ec_wbuf_le16(&w, e->index);
	ec_wbuf_u8(&w, e->sub);
	ec_wbuf_u8(&w, (e->info & 0x07) | info);
	ec_wbuf_le16(&w, e->type);
	ec_wbuf_le16(&w, e->bits);
	ec_wbuf_le16(&w, e->access);
	if (info & EC_OD_INFO_UNIT && v->unit_size == 2)
		ec_wbuf_le16(&w, (u16)v->unit);
	else if (info & EC_OD_INFO_UNIT)
		ec_wbuf_le32(&w, v->unit);
	if (info & EC_OD_INFO_DEFAULT)
		ec_wbuf_bytes(&w, v->def, v->size);
	if (info & EC_OD_INFO_MIN)
		ec_wbuf_bytes(&w, v->min, v->size);
	if (info & EC_OD_INFO_MAX)
		ec_wbuf_bytes(&w, v->max, v->size);
	ec_wbuf_bytes(&w, e->name, e->name_len);
	return w.bad ? -ENOBUFS : (int)(w.p - buf);
}

/**
 * ec_sdoinfo_resp_init() - prepare an answer
 * @r: answer
 * @opcode: EC_SDOINFO_LIST_RESP...
 * @data: body from ec_od_..._encode(); must stay until the last fragment
 * @size: bytes at @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdoinfo_resp_init(struct ec_sdoinfo_resp *r, u8 opcode, const u8 *data, size_t size)
{
	*r = (struct ec_sdoinfo_resp){ .opcode = opcode, .data = data, .size = size };
}

/**
 * ec_sdoinfo_resp_next() - next fragment of an answer
 * @r: answer
 * @tx: message behind the mailbox header
 * @cap: size of the slave's send mailbox less EC_MBOX_HDR
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, 0 when all are out, -EMSGSIZE when @cap is too small.
 */
int ec_sdoinfo_resp_next(struct ec_sdoinfo_resp *r, u8 *tx, size_t cap)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);
	size_t left = r->size - r->pos;
	size_t room, n, more;

	if (r->done)
		return 0;
	if (cap < EC_SDOINFO_MIN)
		return -EMSGSIZE;
	room = (cap - EC_SDOINFO_HDR) & ~(size_t)1;	/* an index stays in one piece */
	n = min_t(size_t, left, room);
	more = DIV_ROUND_UP(left - n, room);
	if (more > 0xFFFF)
		return -EMSGSIZE;
	ec_sdoinfo_put_hdr(&w, (u8)(r->opcode | (more ? EC_SDOINFO_INCOMPLETE : 0)), (u16)more);
	ec_wbuf_bytes(&w, r->data + r->pos, n);
	r->pos += n;
	r->done = !more;
	return (int)(w.p - tx);
}

/**
 * ec_sdoinfo_error_encode() - write a refusal
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @abort: abort code
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit.
 */
int ec_sdoinfo_error_encode(u8 *tx, size_t cap, u32 abort)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_sdoinfo_put_hdr(&w, EC_SDOINFO_ERROR, 0);
	ec_wbuf_le32(&w, abort);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}
