// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "foe.h"
#include "text.h"

/**
 * ec_foe_hdr_decode() - read an FoE header
 * @r: cursor behind the mailbox header; then it stands on name, data or text
 * @h: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is not complete.
 */
int ec_foe_hdr_decode(struct ec_rbuf *r, struct ec_foe_hdr *h)
{
	h->opcode = ec_rbuf_u8(r);
	ec_rbuf_u8(r);
	h->number = ec_rbuf_le32(r);
	return r->bad ? -EMSGSIZE : 0;
}

/**
 * ec_foe_hdr_encode() - write an FoE header
 * @w: cursor
 * @h: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_foe_hdr_encode(struct ec_wbuf *w, const struct ec_foe_hdr *h)
{
	u8 *p = ec_wbuf_take(w, EC_FOE_HDR);

	if (!p)
		return;
	p[0] = h->opcode;
	p[1] = 0;
	put_unaligned_le32(h->number, p + 2);
}

/**
 * ec_foe_error_encode() - message that ends a transfer
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @error: enum ec_foe_error
 * @text: as much of it as fits is sent
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when not even the header fits.
 */
int ec_foe_error_encode(u8 *tx, size_t cap, u32 error, const char *text)
{
	struct ec_foe_hdr h = { .opcode = EC_FOE_ERR, .number = error };
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_foe_hdr_encode(&w, &h);
	if (w.bad)
		return -EMSGSIZE;
	ec_wbuf_bytes(&w, text, min(strlen(text), (size_t)(w.end - w.p)));
	return (int)(w.p - tx);
}

/**
 * ec_foe_tx() - next message of a transfer
 * @f: transfer; the first message is the request
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx; a mailbox of the same size as before
 *
 * Data of the file are the caller's to copy: @f->n bytes from @f->at on behind the
 * header, EC_FOE_HDR. They are as many as fit; fewer, also none, end the file.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes with those data; -EMSGSIZE when the request, or one byte of data, does not fit.
 */
int ec_foe_tx(struct ec_foe *f, u8 *tx, size_t cap)
{
	struct ec_foe_hdr h = { .opcode = f->write ? EC_FOE_WRQ : EC_FOE_RRQ,
				.number = f->password };
	struct ec_wbuf w = ec_wbuf(tx, cap);
	size_t room;

	if (f->begun) {
		h.opcode = f->write ? EC_FOE_DATA : EC_FOE_ACK;
		h.number = f->packet;
	}
	ec_foe_hdr_encode(&w, &h);
	if (w.bad || w.p == w.end)
		return -EMSGSIZE;
	if (!f->begun) {
		ec_wbuf_bytes(&w, f->name, f->name_len);
	} else if (f->write) {
		room = (size_t)(w.end - w.p);
		f->last = f->size - f->at < room;
		f->n = (u16)(f->last ? f->size - f->at : room);
		ec_wbuf_take(&w, f->n);
	}
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/* Only what can be printed: it comes from the slave. */
static int foe_refused(struct ec_foe *f, const struct ec_foe_hdr *h, const struct ec_rbuf *r)
{
	size_t n = min(ec_rbuf_left(r), sizeof(f->text) - 1), i;

	f->error = h->number;
	for (i = 0; i < n && r->p[i]; i++)
		f->text[i] = r->p[i] < ' ' || r->p[i] > '~' ? '?' : (char)r->p[i];
	f->text[i] = '\0';
	return -EREMOTEIO;
}

/* The slave has all until packet @number. */
static int acknowledged(struct ec_foe *f, u32 number)
{
	if (!f->begun) {
		if (number)
			return EC_STALE;
		f->begun = true;
		f->packet = 1;
		return EC_MORE;
	}
	if (number != f->packet)
		return EC_STALE;
	if (f->last)
		return 0;
	f->at += f->n;
	f->packet++;
	return EC_MORE;
}

static int received(struct ec_foe *f, u32 number, size_t len, size_t room)
{
	if (number != f->packet + 1)
		return EC_STALE;
	/* with messages that have no data bytes the transfer would not end */
	if (len > room || !room)
		return -EBADMSG;
	f->begun = true;
	f->packet = number;
	f->at = f->size;
	f->n = (u16)len;
	f->size += len;
	f->last = len < room;
	return EC_MORE;
}

/**
 * ec_foe_rx() - a message from the slave
 * @f: transfer whose message was sent
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @room: read: data bytes of a message that fills the slave's mailbox
 *
 * After a read has got data they are the caller's to take: @f->n bytes behind the header, for
 * @f->at in the file. The acknowledgement of the last ones has no answer. Packets that are not
 * the present one are late.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0: written; EC_MORE: send the next message, after some time when @f->busy;
 * EC_WAIT: the slave is busy with the request; EC_STALE; -EREMOTEIO with @f->error and
 * @f->text; -EBADMSG for a message that is too short.
 */
int ec_foe_rx(struct ec_foe *f, const u8 *rx, size_t len, size_t room)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_foe_hdr h;

	if (ec_foe_hdr_decode(&r, &h))
		return -EBADMSG;
	f->busy = h.opcode == EC_FOE_BUSY;
	if (h.opcode == EC_FOE_ERR)
		return foe_refused(f, &h, &r);
	if (f->busy) {
		f->done = (u16)h.number;
		f->entire = (u16)(h.number >> 16);
		return f->begun ? EC_MORE : EC_WAIT;
	}
	if (f->write && h.opcode == EC_FOE_ACK)
		return acknowledged(f, h.number);
	if (!f->write && h.opcode == EC_FOE_DATA)
		return received(f, h.number, ec_rbuf_left(&r), room);
	return EC_STALE;
}

/**
 * ec_foe_error_text() - meaning of an error code
 * @code: of the slave, with or without 0x8000
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, NULL: the code is not known.
 */
const char *ec_foe_error_text(u32 code)
{
	static const struct ec_text texts[] = {
		{ EC_FOE_ERR_UNDEFINED, "error without further details" },
		{ EC_FOE_ERR_NOT_FOUND, "file not found" },
		{ EC_FOE_ERR_DENIED, "access denied" },
		{ EC_FOE_ERR_FULL, "disk full" },
		{ EC_FOE_ERR_ILLEGAL, "illegal request" },
		{ EC_FOE_ERR_PACKET, "wrong packet number" },
		{ EC_FOE_ERR_EXISTS, "file exists" },
		{ EC_FOE_ERR_NO_USER, "no user" },
		{ EC_FOE_ERR_BOOT_ONLY, "only possible in BOOT" },
		/* ETG.1000.6 "not bootstrap" can be read both ways, and is */
		{ EC_FOE_ERR_NOT_BOOT,
		  "not possible in BOOT; some slaves mean: only possible in BOOT" },
		{ EC_FOE_ERR_NO_RIGHTS, "no access rights" },
		{ EC_FOE_ERR_PROGRAM, "program error" },
		{ EC_FOE_ERR_CHECKSUM, "wrong checksum" },
	};

	return ec_text_find(texts, ARRAY_SIZE(texts), code < 0x8000 ? code | 0x8000 : code);
}

/**
 * ec_foe_name_len() - check the name of a file on a slave
 * @name: all bytes, or up to a zero
 * @cap: bytes at @name
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its length; 0 when it is empty or has a character that is not printable.
 */
size_t ec_foe_name_len(const char *name, size_t cap)
{
	size_t n;

	for (n = 0; n < cap && name[n]; n++)
		if (name[n] < ' ' || name[n] > '~')
			return 0;
	return n;
}
