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
 * ec_soe_tx() - next message of an access
 * @a: access; its results are reset before the first message
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * A value that is larger than a message is written in fragments. They count down how many follow;
 * only the last one has the IDN.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit into messages of @cap bytes.
 */
int ec_soe_tx(struct ec_soe_access *a, u8 *tx, size_t cap)
{
	size_t room = cap > EC_SOE_HDR ? cap - EC_SOE_HDR : 0, n = a->write ? a->size - a->at : 0;
	struct ec_wbuf w = ec_wbuf(tx, cap);
	struct ec_soe_hdr h = {
		.opcode = a->write ? EC_SOE_WRITE_REQ : EC_SOE_READ_REQ,
		.drive = a->drive, .elements = a->elements, .idn = a->idn,
	};

	if (!a->begun) {
		a->error = 0;
		a->wrong = 0;
	}
	if (n > room) {
		if (!room || (n - 1) / room > 0xffff)
			return -EMSGSIZE;
		a->left = (u16)((n - 1) / room);
		h.incomplete = true;
		h.idn = a->left;
		n = room;
	} else {
		a->left = 0;
	}
	ec_soe_hdr_encode(&w, &h);
	if (n)
		ec_wbuf_bytes(&w, a->data + a->at, n);
	if (w.bad)
		return -EMSGSIZE;
	a->at += n;
	a->begun = a->left;
	return (int)(w.p - tx);
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

/*
 * Take the data of one message of a read. The rest of a wrong answer is waited for: a fragment of
 * it must not be taken for an answer to the next request. That does not restart the time limit.
 */
static int soe_take(struct ec_soe_access *a, const struct ec_soe_hdr *h, const struct ec_rbuf *r)
{
	size_t n = ec_rbuf_left(r);
	u16 left = h->incomplete ? h->idn : 0;

	/* frames with fragments were lost, or the slave miscounts */
	if (a->begun && left + 1u != a->left)
		a->wrong = a->wrong ? a->wrong : -EPROTO;
	/* a fragment has data, and another one behind it */
	if (h->incomplete && (!n || !left))
		a->wrong = a->wrong ? a->wrong : -EBADMSG;
	a->begun = h->incomplete;
	a->left = left;
	if (!a->wrong && n > a->cap - a->at)
		a->wrong = -ENOBUFS;
	if (a->wrong)
		return h->incomplete ? EC_STALE : a->wrong;
	if (n)
		memcpy(a->data + a->at, r->p, n);
	a->at += n;
	a->size = a->at;
	return h->incomplete ? EC_WAIT : 0;
}

/* The end of an answer to something else: the fragments so far were of that. */
static int soe_other(struct ec_soe_access *a)
{
	if (!a->write) {
		a->at = 0;
		a->left = 0;
		a->wrong = 0;
		a->begun = false;
	}
	return EC_STALE;
}

/**
 * ec_soe_rx() - a message from the slave
 * @a: access whose request was sent, of a write at least the first fragment
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; EC_WAIT for a fragment that others follow; EC_STALE for the answer to something else,
 * or for a fragment of an answer that is of no use; -EIO with @error set; -ENOBUFS for data larger
 * than @cap; -EPROTO for fragments that do not count down by one; -EBADMSG for a message that is
 * too short or wrong.
 */
int ec_soe_rx(struct ec_soe_access *a, const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_soe_hdr h;
	bool part;

	if (ec_soe_hdr_decode(&r, &h))
		return -EBADMSG;
	if (h.opcode != (a->write ? EC_SOE_WRITE_RESP : EC_SOE_READ_RESP) ||
	    h.drive != a->drive)
		return EC_STALE;
	part = h.incomplete || (a->write && a->left);
	/* before the last fragment the slave does not know the IDN that it refuses */
	if (h.error && (part || h.idn == a->idn))
		return soe_refused(a, &r);
	if (!part && (h.idn != a->idn || (!a->write && h.elements != a->elements)))
		return soe_other(a);
	if (a->write)
		return part ? EC_STALE : 0;
	return h.elements == a->elements ? soe_take(a, &h, &r) : EC_STALE;
}

/**
 * ec_soe_is_unasked() - is a message a notification or an emergency?
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: it is no answer.
 */
bool ec_soe_is_unasked(const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_soe_hdr h;

	return !ec_soe_hdr_decode(&r, &h) &&
	       (h.opcode == EC_SOE_NOTIFICATION || h.opcode == EC_SOE_EMERGENCY);
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

/**
 * ec_soe_command_text() - what a procedure command does
 * @state: its data state
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text.
 */
const char *ec_soe_command_text(u16 state)
{
	if (state & EC_SOE_COMMAND_ERROR)
		return "error";
	if (!(state & EC_SOE_COMMAND_SET))
		return "not set";
	if (!(state & EC_SOE_COMMAND_ENABLE))
		return "interrupted";
	return state & EC_SOE_COMMAND_BUSY ? "in process" : "executed";
}
