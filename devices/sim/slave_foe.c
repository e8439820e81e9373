// SPDX-License-Identifier: GPL-2.0-only
/*
 * FoE server of a simulated slave. Its flash keeps one file, also without power. A write erases it
 * first: only a file that has come whole can be read.
 */
#include "app.h"

#define PAGE	4096	/* of the flash, bytes */

/**
 * ec_app_foe_bytes() - memory a slave needs for its file
 * @m: model
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, 0 without FoE.
 */
u32 ec_app_foe_bytes(const struct ec_app_model *m)
{
	if (!(m->dev.protocols & EC_SII_PROTO_FOE))
		return 0;
	return 1024u * (m->params.foe ? m->params.foe : EC_APP_FOE_KIB);
}

/**
 * ec_app_foe_reset() - the mailbox starts afresh, and with it the transfer
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_foe_reset(struct ec_app *app)
{
	app->foe.opcode = 0;
}

static u32 begin(struct ec_app_foe *f, const struct ec_foe_hdr *h, const struct ec_rbuf *r)
{
	size_t len = ec_rbuf_left(r);

	f->opcode = 0;
	f->packet = 0;
	f->at = 0;
	f->n = 0;
	f->left = 0;
	f->ready = 0;
	f->password = h->number;
	if (!len || len > sizeof(f->name))
		return EC_FOE_ERR_ILLEGAL;
	if (h->opcode == EC_FOE_RRQ) {
		if (!f->valid || len != f->name_len || memcmp(f->name, r->p, len))
			return EC_FOE_ERR_NOT_FOUND;
	} else {
		f->valid = false;
		f->name_len = (u8)len;
		memcpy(f->name, r->p, len);
	}
	f->opcode = h->opcode;
	return 0;
}

/* Does a file begin as it must? Its first packet is @r. */
static bool is_firmware(const struct ec_app_foe *f, const struct ec_rbuf *r)
{
	return f->at || (ec_rbuf_left(r) >= f->header_len &&
			 !memcmp(r->p, f->header, f->header_len));
}

/* A packet of @room bytes is not the last one. */
static u32 store(struct ec_app_foe *f, const struct ec_rbuf *r, size_t room, u64 now)
{
	size_t len = ec_rbuf_left(r);

	if (f->header_len && !is_firmware(f, r))
		return EC_FOE_ERR_PROGRAM;
	if (len > f->cap - f->at)
		return EC_FOE_ERR_FULL;
	memcpy(f->flash + f->at, r->p, len);
	if ((f->at + len) / PAGE != f->at / PAGE) {
		f->left = f->busy;
		f->ready = now + f->page_ns;
	}
	f->at += (u32)len;
	f->packet++;
	if (len < room) {
		f->size = f->at;
		f->valid = true;
		f->writes++;
		f->opcode = 0;
	}
	return 0;
}

/* The next data of a read, or none behind the last ones. */
static void send(struct ec_app_foe *f, struct ec_wbuf *w, size_t room)
{
	struct ec_foe_hdr h = { .opcode = EC_FOE_DATA };

	f->at += f->n;
	f->n = (u16)min(room, (size_t)(f->size - f->at));
	h.number = ++f->packet;
	ec_foe_hdr_encode(w, &h);
	ec_wbuf_bytes(w, f->flash + f->at, f->n);
}

/* How far the flash is with a page, as BUSY says it; false: it is done. */
static bool is_busy(struct ec_app_foe *f, u64 now, u32 *progress)
{
	if (f->left) {
		*progress = (u32)(f->busy - f->left) | (u32)f->busy << 16;
		f->left--;
		return true;
	}
	if (now >= f->ready)
		return false;
	*progress = (u32)(100 - div64_u64((f->ready - now) * 100, f->page_ns)) | 100u << 16;
	return true;
}

/* The answer to DATA of a write. */
static u32 receive(struct ec_app_foe *f, const struct ec_foe_hdr *h, const struct ec_rbuf *r,
		   size_t room, struct ec_wbuf *w, u64 now)
{
	struct ec_foe_hdr ack = { .opcode = EC_FOE_ACK, .number = h->number };
	u32 error, progress;

	if (h->number != f->packet + 1)
		return EC_FOE_ERR_PACKET;
	if (is_busy(f, now, &progress)) {
		ack.opcode = EC_FOE_BUSY;
		ack.number = progress;
		ec_foe_hdr_encode(w, &ack);
		return 0;
	}
	error = store(f, r, room, now);
	if (!error)
		ec_foe_hdr_encode(w, &ack);
	return error;
}

/* An error code, 0: the answer is at @w, if there is one. */
static u32 execute(struct ec_app *app, const struct ec_foe_hdr *h, const struct ec_rbuf *r,
		   struct ec_wbuf *w)
{
	size_t in = min(app->mbox.cap, app->esc->sm[0].page.len) - EC_MBOX_HDR - EC_FOE_HDR;
	size_t out = (size_t)(w->end - w->p) - EC_FOE_HDR;
	struct ec_foe_hdr ack = { .opcode = EC_FOE_ACK };
	struct ec_app_foe *f = &app->foe;
	u32 error;

	switch (h->opcode) {
	case EC_FOE_RRQ:
	case EC_FOE_WRQ:
		if (h->opcode == EC_FOE_WRQ && f->boot && app->state != EC_AL_BOOT)
			return EC_FOE_ERR_BOOT_ONLY;
		error = begin(f, h, r);
		if (error)
			return error;
		if (h->opcode == EC_FOE_RRQ)
			send(f, w, out);
		else
			ec_foe_hdr_encode(w, &ack);
		return 0;
	case EC_FOE_DATA:
		return f->opcode == EC_FOE_WRQ ?
			receive(f, h, r, in, w, app->mbox.now) : EC_FOE_ERR_ILLEGAL;
	case EC_FOE_ACK:
		if (f->opcode != EC_FOE_RRQ)
			return EC_FOE_ERR_ILLEGAL;
		if (h->number != f->packet)
			return EC_FOE_ERR_PACKET;
		if (f->n < out)
			f->opcode = 0;
		else
			send(f, w, out);
		return 0;
	case EC_FOE_ERR:
		f->opcode = 0;
		return 0;
	default:
		return EC_FOE_ERR_ILLEGAL;
	}
}

/**
 * ec_app_foe() - answer an FoE message
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @tx: room for the answer
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded by a message, no sleep, no allocation.
 * Return: bytes at @tx, 0: there is no answer; -EMSGSIZE: the message is too short, or the mailbox
 * too small.
 */
int ec_app_foe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_wbuf w = ec_wbuf(tx, cap);
	struct ec_foe_hdr h;
	u32 error;

	if (ec_foe_hdr_decode(&r, &h) || cap <= EC_FOE_HDR)
		return -EMSGSIZE;
	error = execute(app, &h, &r, &w);
	if (error) {
		const char *text = error == EC_FOE_ERR_PROGRAM ?
			"not firmware of this device" : ec_foe_error_text(error);

		app->foe.opcode = 0;
		return ec_foe_error_encode(tx, cap, error, text ? text : "");
	}
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}
