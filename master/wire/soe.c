// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "soe.h"
#include "text.h"

/**
 * ec_soe_hdr_decode() - read an SoE header
 * @r: cursor behind the mailbox header
 * @h: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is not complete.
 */
int ec_soe_hdr_decode(struct ec_rbuf *r, struct ec_soe_hdr *h)
{
	u8 b = ec_rbuf_u8(r);

	h->opcode = b & 0x07;
	h->incomplete = b & 0x08;
	h->error = b & 0x10;
	h->drive = b >> 5;
	h->elements = ec_rbuf_u8(r);
	h->idn = ec_rbuf_le16(r);
	return r->bad ? -EMSGSIZE : 0;
}

/**
 * ec_soe_hdr_encode() - write an SoE header
 * @w: cursor
 * @h: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_soe_hdr_encode(struct ec_wbuf *w, const struct ec_soe_hdr *h)
{
	ec_wbuf_u8(w, (u8)((h->opcode & 0x07) | (h->incomplete ? 0x08 : 0) |
			   (h->error ? 0x10 : 0) | h->drive << 5));
	ec_wbuf_u8(w, h->elements);
	ec_wbuf_le16(w, h->idn);
}

/**
 * ec_soe_tx() - request of an access
 * @a: access; @error is cleared
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit into one message.
 */
int ec_soe_tx(struct ec_soe_access *a, u8 *tx, size_t cap)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);
	struct ec_soe_hdr h = {
		.opcode = a->write ? EC_SOE_WRITE_REQ : EC_SOE_READ_REQ,
		.drive = a->drive, .elements = a->element, .idn = a->idn,
	};

	a->error = 0;
	ec_soe_hdr_encode(&w, &h);
	if (a->write)
		ec_wbuf_bytes(&w, a->data, a->size);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/*
 * The error code is behind the header in a write response and in the last two
 * bytes of a read response; usually there is nothing else.
 */
static int soe_refused(struct ec_soe_access *a, const struct ec_rbuf *r)
{
	if (ec_rbuf_left(r) < 2)
		return -EBADMSG;
	a->error = get_unaligned_le16(a->write ? r->p : r->end - 2);
	return -EIO;
}

/**
 * ec_soe_rx() - a message from the slave
 * @a: access whose request was sent
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; EC_STALE for the answer to something else; -EIO with @error set;
 * -ENOBUFS for a value larger than @cap; -EMSGSIZE for one in several
 * fragments; -EBADMSG for a message that is too short.
 */
int ec_soe_rx(struct ec_soe_access *a, const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_soe_hdr h;

	if (ec_soe_hdr_decode(&r, &h))
		return -EBADMSG;
	if (h.opcode != (a->write ? EC_SOE_WRITE_RESP : EC_SOE_READ_RESP) ||
	    h.drive != a->drive)
		return EC_STALE;
	if (h.incomplete)
		return -EMSGSIZE;
	if (h.idn != a->idn)
		return EC_STALE;
	if (h.error)
		return soe_refused(a, &r);
	if (a->write)
		return 0;
	if (h.elements != a->element)
		return EC_STALE;
	a->size = ec_rbuf_left(&r);
	if (a->size > a->cap)
		return -ENOBUFS;
	memcpy(a->data, r.p, a->size);
	return 0;
}

static const struct ec_text soe_errors[] = {
	{ 0x1001, "there is no such IDN" },
	{ 0x1009, "access to element 1 is not valid" },
	{ 0x2001, "the IDN has no name" },
	{ 0x2002, "the name is too short" },
	{ 0x2003, "the name is too long" },
	{ 0x2004, "the name can only be read" },
	{ 0x2005, "the name is write protected at this time" },
	{ 0x3002, "the attribute is too short" },
	{ 0x3003, "the attribute is too long" },
	{ 0x3004, "the attribute can only be read" },
	{ 0x3005, "the attribute is write protected at this time" },
	{ 0x4001, "the IDN has no unit" },
	{ 0x4002, "the unit is too short" },
	{ 0x4003, "the unit is too long" },
	{ 0x4004, "the unit can only be read" },
	{ 0x4005, "the unit is write protected at this time" },
	{ 0x5001, "the IDN has no minimum" },
	{ 0x5002, "the minimum is too short" },
	{ 0x5003, "the minimum is too long" },
	{ 0x5004, "the minimum can only be read" },
	{ 0x5005, "the minimum is write protected at this time" },
	{ 0x6001, "the IDN has no maximum" },
	{ 0x6002, "the maximum is too short" },
	{ 0x6003, "the maximum is too long" },
	{ 0x6004, "the maximum can only be read" },
	{ 0x6005, "the maximum is write protected at this time" },
	{ 0x7002, "the value is too short" },
	{ 0x7003, "the value is too long" },
	{ 0x7004, "the value can only be read" },
	{ 0x7005, "the value is write protected at this time" },
	{ 0x7006, "the value is below the minimum" },
	{ 0x7007, "the value is above the maximum" },
	{ 0x7008, "the value is not valid" },
	{ 0x7009, "the value is protected by a password" },
	{ 0x700A, "the value is configured cyclically and cannot be changed" },
	{ 0x700B, "the indirect addressing is not valid" },
	{ 0x700C, "the value is protected by other settings" },
	{ 0x7010, "the procedure command is active already" },
	{ 0x7011, "the procedure command cannot be interrupted" },
	{ 0x7012, "the procedure command cannot be executed at this time" },
	{ 0x7013, "the procedure command cannot be executed: parameters are not valid" },
	{ 0x7014, "the IDN has no data state" },
	{ 0x8001, "the IDN has no default value" },
	{ 0x8002, "the default value is too long" },
	{ 0x8004, "the default value can only be read" },
	{ 0x800A, "the drive number is not valid" },
	{ 0x800B, "general error" },
	{ 0x800C, "no element was addressed" },
};

/**
 * ec_soe_error_text() - meaning of an SoE error code
 * @code: error code
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, NULL if unknown.
 */
const char *ec_soe_error_text(u16 code)
{
	return ec_text_find(soe_errors, ARRAY_SIZE(soe_errors), code);
}
