// SPDX-License-Identifier: GPL-2.0-only
/* What a script makes wrong with messages from the mailbox of a simulated slave. */
#include "app.h"
#include "../../master/wire/sdo_msg.h"

#define FRAGMENT_NS	90000000	/* from one empty fragment to the next */
#define BODY		EC_MBOX_HDR
#define SDO		(EC_MBOX_HDR + EC_COE_HDR)

/* a field of a message: where it is, and how long */
struct field {
	u8 at;
	u8 len;
};

static u8 type_of(const u8 *h)
{
	return h[5] & 0x0f;
}

static void set_type(u8 *h, u8 type)
{
	h[5] = (u8)((h[5] & 0x70) | type);
}

/* Let a message to the master be SDO information without data. */
static void info_empty(u8 *h, u8 opcode)
{
	struct ec_wbuf w = ec_wbuf(h + EC_MBOX_HDR, EC_SDOINFO_HDR);

	put_unaligned_le16(EC_SDOINFO_HDR, h);
	set_type(h, EC_MBOX_COE);
	ec_sdoinfo_put_hdr(&w, opcode, 0);
}

static bool is_info(const u8 *h)
{
	return type_of(h) == EC_MBOX_COE && h[BODY + 1] >> 4 == EC_COE_SDO_INFO;
}

static bool is_abort(const u8 *h)
{
	return type_of(h) == EC_MBOX_COE && !is_info(h) && h[SDO] == 0x80;
}

/* a list of objects without one, which answers no request */
static void stale(u8 *h)
{
	info_empty(h, EC_SDOINFO_LIST_RESP);
	put_unaligned_le16(EC_SDOINFO_HDR + 2, h);
	put_unaligned_le16(1, h + BODY + EC_SDOINFO_HDR);
}

static void error_reply(u8 *h, u16 detail)
{
	put_unaligned_le16(EC_MBOX_ERR_BODY, h);
	set_type(h, EC_MBOX_ERR);
	put_unaligned_le16(1, h + BODY);
	put_unaligned_le16(detail, h + BODY + 2);
}

/* An FoE message with a number only. */
static void foe_reply(u8 *h, u8 opcode, u32 number)
{
	put_unaligned_le16(EC_FOE_HDR, h);
	h[BODY] = opcode;
	put_unaligned_le32(number, h + BODY + 2);
}

/* Its progress goes up and down. */
static void busy(u8 *h)
{
	u8 counter = h[5] >> 4;

	if (type_of(h) == EC_MBOX_FOE)
		foe_reply(h, EC_FOE_BUSY, (1u + (counter & 1)) | 100u << 16);
	else
		error_reply(h, EC_MBOX_ERR_IN_WORK);
}

static void deny(const struct ec_app *app, u8 *h, u32 code)
{
	switch (type_of(h)) {
	case EC_MBOX_FOE:
		foe_reply(h, EC_FOE_ERR, code);
		break;
	case EC_MBOX_COE:
		put_unaligned_le16(EC_SDO_MSG, h);
		if (is_info(h))
			ec_sdoinfo_error_encode(h + BODY, EC_SDO_MSG, code);
		else
			ec_sdo_put_abort(h + BODY, EC_SDO_MSG, app->mbox.srv.index,
					 app->mbox.srv.sub, code);
		break;
	case EC_MBOX_SOE:
		h[BODY] |= 0x10;	/* the error flag of its header */
		put_unaligned_le16(EC_SOE_HDR + 2, h);
		put_unaligned_le16((u16)code, h + BODY + EC_SOE_HDR);
		break;
	default:
		break;
	}
}

/* A response to an SoE request, wrong in one way. */
static void soe(u8 *h, u32 how)
{
	u16 len = get_unaligned_le16(h), left = get_unaligned_le16(h + BODY + 2);

	if (type_of(h) != EC_MBOX_SOE || len < EC_SOE_HDR || (h[BODY] & 7) > EC_SOE_WRITE_RESP)
		return;
	switch (how) {
	case EC_SIM_SOE_ENDLESS:
	case EC_SIM_SOE_COUNTDOWN:
		left = how == EC_SIM_SOE_COUNTDOWN && h[BODY] & 8 ? left - 1 : 0xffff;
		h[BODY] |= 8;
		put_unaligned_le16(left, h + BODY + 2);
		break;
	case EC_SIM_SOE_SKIP:
		if (h[BODY] & 8)
			put_unaligned_le16(2 * left, h + BODY + 2);
		break;
	case EC_SIM_SOE_DRIVE:
		h[BODY] ^= 0x20;
		break;
	case EC_SIM_SOE_IDN:
		if (!(h[BODY] & 8))
			h[BODY + 2] ^= 1;
		break;
	case EC_SIM_SOE_ELEMENTS:
		h[BODY + 1] ^= 1;
		break;
	case EC_SIM_SOE_ERROR:
		put_unaligned_le16(EC_SOE_HDR + 2, h);
		h[BODY] |= 0x10;
		put_unaligned_le16(0x700B, h + BODY + EC_SOE_HDR);
		break;
	case EC_SIM_SOE_LIST:
		h[BODY + EC_SOE_HDR + 1] = 0xff;
		break;
	case EC_SIM_SOE_EMPTY:
		if (h[BODY] & 8)
			put_unaligned_le16(EC_SOE_HDR, h);
		break;
	}
}

static void garbage(struct ec_sim *sim, u8 *h, u16 len)
{
	u16 at = 0;

	if (ec_sim_random(sim) & 1) {
		put_unaligned_le16((u16)(ec_sim_random(sim) % (len - EC_MBOX_HDR + 1u)), h);
		at = EC_MBOX_HDR;
	}
	for (; at < len; at++)
		h[at] = (u8)ec_sim_random(sim);
}

/* members of a message behind its mailbox header */
static const struct field *body_fields(const u8 *h, u32 *n)
{
	static const struct field sdo[] = {
		{ BODY + 1, 1 }, { SDO, 1 }, { SDO + 1, 2 }, { SDO + 3, 1 }, { SDO + 4, 4 },
	};
	static const struct field info[] = {
		{ BODY + 1, 1 }, { SDO, 1 }, { SDO + 2, 2 }, { SDO + 4, 2 }, { SDO + 6, 1 },
	};
	static const struct field foe[] = { { BODY, 1 }, { BODY + 2, 4 } };
	static const struct field soe[] = { { BODY, 1 }, { BODY + 1, 1 }, { BODY + 2, 2 } };
	static const struct field other[] = { { BODY, 4 }, { BODY + 4, 2 } };

	switch (type_of(h)) {
	case EC_MBOX_COE:
		*n = ARRAY_SIZE(sdo);
		return is_info(h) ? info : sdo;
	case EC_MBOX_FOE:
		*n = ARRAY_SIZE(foe);
		return foe;
	case EC_MBOX_SOE:
		*n = ARRAY_SIZE(soe);
		return soe;
	default:
		*n = ARRAY_SIZE(other);
		return other;
	}
}

/* Another value than before, often one near by or at an end of the range. */
static void mutate(struct ec_sim *sim, u8 *p, u8 len)
{
	u32 r = ec_sim_random(sim), bits = 8u * len;
	u64 all = (1ull << bits) - 1, was = 0, v;
	u8 i;

	for (i = 0; i < len; i++)
		was |= (u64)p[i] << 8 * i;
	switch (r & 7) {
	case 0:
		v = was + 1;
		break;
	case 1:
		v = was - 1;
		break;
	case 2:
		v = 0;
		break;
	case 3:
		v = all;
		break;
	case 4:
		v = ec_sim_random(sim);
		break;
	default:
		v = was ^ 1ull << (r >> 8) % bits;
		break;
	}
	if ((v & all) == was)
		v = ~was;
	for (i = 0; i < len; i++)
		p[i] = (u8)(v >> 8 * i);
}

static void almost(struct ec_sim *sim, u8 *h)
{
	/* length; type and counter */
	static const struct field header[] = { { 0, 2 }, { 5, 1 } };
	const struct field *f;
	u32 n, i;

	if (ec_sim_random(sim) & 1)
		return;
	f = body_fields(h, &n);
	i = ec_sim_random(sim) % (n + (u32)ARRAY_SIZE(header));
	f = i < n ? &f[i] : &header[i - n];
	mutate(sim, h + f->at, f->len);
}

/**
 * ec_app_mbox_late() - how much later than usual the next message is sent
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns.
 */
u64 ec_app_mbox_late(const struct ec_app *app)
{
	const struct ec_esc_fault *f = &app->esc->fault;

	return f->mailbox == EC_SIM_MAILBOX_DELAY && !f->mailbox_after ? f->mailbox_code : 0;
}

/**
 * ec_app_mbox_spoil() - what is wrong with the message that goes to SM1 now
 * @app: slave
 * @len: bytes of the mailbox, at least as many as the message has
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: it is not sent.
 */
bool ec_app_mbox_spoil(struct ec_app *app, u16 len)
{
	struct ec_esc_fault *f = &app->esc->fault;
	u8 *h = app->mbox.out;

	app->mbox.out_wrong = !f->mailbox_after;
	if (f->mailbox_after) {
		f->mailbox_after--;
		return true;
	}
	/* what rewrites a body needs the space of an SDO */
	if (f->mailbox >= EC_SIM_MAILBOX_STALE && f->mailbox != EC_SIM_MAILBOX_LOST &&
	    len < EC_MBOX_HDR + 10)
		return true;
	switch (f->mailbox) {
	case EC_SIM_MAILBOX_LENGTH:
		put_unaligned_le16(0xffff, h);
		break;
	case EC_SIM_MAILBOX_SHORT:
		put_unaligned_le16(1, h);
		break;
	case EC_SIM_MAILBOX_COUNTER:
		h[5] = (u8)((h[5] & 0x0f) | 1 << 4);
		break;
	case EC_SIM_MAILBOX_TYPE:
	case EC_SIM_MAILBOX_BABBLE:
		set_type(h, EC_MBOX_FOE);
		break;
	case EC_SIM_MAILBOX_STALE:
		stale(h);
		break;
	case EC_SIM_MAILBOX_FRAGMENTS:
		if (is_info(h))
			h[SDO] |= EC_SDOINFO_INCOMPLETE;
		break;
	case EC_SIM_MAILBOX_ERROR:
		error_reply(h, (u16)f->mailbox_code);
		break;
	case EC_SIM_MAILBOX_ABORT:
		if (is_abort(h))
			put_unaligned_le32(f->mailbox_code, h + SDO + 4);
		break;
	case EC_SIM_MAILBOX_BUSY:
		busy(h);
		break;
	case EC_SIM_MAILBOX_DENY:
		deny(app, h, f->mailbox_code);
		break;
	case EC_SIM_MAILBOX_GARBAGE:
		garbage(app->esc->sim, h, len);
		break;
	case EC_SIM_MAILBOX_ALMOST:
		almost(app->esc->sim, h);
		break;
	case EC_SIM_MAILBOX_SOE:
		soe(h, f->mailbox_code);
		break;
	case EC_SIM_MAILBOX_LOST:
		return false;
	default:
		break;
	}
	return true;
}

/**
 * ec_app_mbox_sent() - the master has read the message: does it come again?
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_mbox_sent(struct ec_app *app)
{
	struct ec_app_mbox *m = &app->mbox;
	u8 kind = m->out_wrong ? app->esc->fault.mailbox : (u8)EC_SIM_MAILBOX_GOOD;

	if (kind == EC_SIM_MAILBOX_FRAGMENTS && is_info(m->out)) {
		info_empty(m->out, m->out[SDO]);
		m->out_len = EC_MBOX_HDR + EC_SDOINFO_HDR;
		m->out_due += FRAGMENT_NS;
		return;
	}
	if (kind == EC_SIM_MAILBOX_BABBLE)
		return;
	if (kind == EC_SIM_MAILBOX_SOE && type_of(m->out) == EC_MBOX_SOE &&
	    app->esc->fault.mailbox_code <= EC_SIM_SOE_COUNTDOWN) {
		m->tx_counter = ec_mbox_next_counter(m->tx_counter);
		m->out[5] = (u8)((m->out[5] & 0x0f) | m->tx_counter << 4);
		return;
	}
	m->out_again = kind == EC_SIM_MAILBOX_DUPLICATE && !m->out_again;
	if (!m->out_again)
		m->out_len = 0;
}
