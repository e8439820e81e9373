// SPDX-License-Identifier: GPL-2.0-only
/*
 * SoE server of a simulated slave: the same IDNs for each of its drives, with
 * all their elements. One message is one access: no fragments.
 */
#include "app.h"

#define LIST_HDR	4	/* length and largest length of a list, bytes */
#define LISTS		EC_SOE_ATTR_LIST1	/* from this length on */

/*
 * One IDN. @room: bytes of the list; @text: what is in it at power-on; without
 * @max there are no limits
 */
static const struct idn {
	u16 idn;
	u32 attribute;
	const char *name;
	const char *unit;
	u64 value;
	u64 min;
	u64 max;
	u16 room;
	const char *text;
} idns[] = {
	{ 15, EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_RO_SAFEOP | EC_SOE_ATTR_RO_OP,
	  "Telegram type", NULL, 7, 0, 7, 0, NULL },
	{ 17, EC_SOE_ATTR_LIST2 | EC_SOE_ATTR_RO,
	  "IDN list of all operation data", NULL, 0, 0, 0, 0, NULL },
	{ 30, EC_SOE_ATTR_LIST1 | EC_SOE_ATTR_RO,
	  "Manufacturer version", NULL, 0, 0, 0, 16, "SIM 1.0" },
	{ 47, EC_SOE_ATTR_LEN4, "Position command value", "inc", 0, 0, 0, 0, NULL },
	{ 91, EC_SOE_ATTR_LEN4, "Bipolar velocity limit value", "rpm",
	  3000, 10, 6000, 0, NULL },
	{ 95, EC_SOE_ATTR_LIST1 | EC_SOE_ATTR_RO,
	  "Diagnostic message", NULL, 0, 0, 0, 32, "no error" },
	{ 0x8096, EC_SOE_ATTR_LEN2, "Test word", NULL, 0x1234, 0, 0, 0, NULL },
	{ 0x80A0, EC_SOE_ATTR_LIST1, "Test text", NULL, 0, 0, 0, 200, "hello" },
	{ 0x80A1, EC_SOE_ATTR_LEN8, "Test quad word", NULL,
	  0x1122334455667788, 0, 0, 0, NULL },
	{ 0x80AA, EC_SOE_ATTR_LEN2 | EC_SOE_ATTR_RO_PREOP,
	  "Not writable in PREOP", NULL, 5, 0, 0, 0, NULL },
};

/* bytes of a value that is no list */
static u16 fixed(const struct idn *i)
{
	return (u16)(1u << (i->attribute >> 16 & 3));
}

static bool is_list(const struct idn *i)
{
	return (i->attribute & EC_SOE_ATTR_LEN_MASK) >= LISTS;
}

static u16 room(const struct idn *i)
{
	return is_list(i) ? (u16)(LIST_HDR + i->room) : fixed(i);
}

/**
 * ec_app_soe_bytes() - memory one drive needs for its values
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes.
 */
size_t ec_app_soe_bytes(void)
{
	size_t n = 0;

	for (u32 i = 0; i < ARRAY_SIZE(idns); i++)
		n += room(&idns[i]);
	return n;
}

static u8 *value_of(const struct ec_app *app, u8 drive, const struct idn *which)
{
	u8 *p = app->soe.values + drive * ec_app_soe_bytes();

	for (const struct idn *i = idns; i < which; i++)
		p += room(i);
	return p;
}

static void put_list(struct ec_wbuf *w, const void *data, u16 len, u16 most)
{
	ec_wbuf_le16(w, len);
	ec_wbuf_le16(w, most);
	ec_wbuf_bytes(w, data, len);
}

static void put_text(struct ec_wbuf *w, const char *text)
{
	put_list(w, text, (u16)strlen(text), (u16)strlen(text));
}

static void put_number(struct ec_wbuf *w, const struct idn *i, u64 v)
{
	u8 b[8];

	put_unaligned_le64(v, b);
	ec_wbuf_bytes(w, b, fixed(i));
}

/**
 * ec_app_soe_reset() - values as at power-on
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_soe_reset(struct ec_app *app)
{
	for (u8 d = 0; d < app->soe.drives; d++) {
		for (u32 i = 0; i < ARRAY_SIZE(idns); i++) {
			struct ec_wbuf w = ec_wbuf(value_of(app, d, &idns[i]), room(&idns[i]));
			const char *text = idns[i].text ? idns[i].text : "";

			if (is_list(&idns[i]))
				put_list(&w, text, (u16)strlen(text), idns[i].room);
			else
				put_number(&w, &idns[i], idns[i].value);
		}
	}
	app->soe.writes = 0;
}

static void put_value(struct ec_wbuf *w, const struct ec_app *app, u8 drive, const struct idn *i)
{
	const u8 *p = value_of(app, drive, i);

	if (i->idn == 17) {
		u16 len = 2 * ARRAY_SIZE(idns);

		ec_wbuf_le16(w, len);
		ec_wbuf_le16(w, len);
		for (u32 k = 0; k < ARRAY_SIZE(idns); k++)
			ec_wbuf_le16(w, idns[k].idn);
	} else if (is_list(i)) {
		ec_wbuf_bytes(w, p, (size_t)LIST_HDR + get_unaligned_le16(p));
	} else {
		ec_wbuf_bytes(w, p, fixed(i));
	}
}

/* the elements asked for, in ascending order; an error code, 0: none */
static u16 read_elements(const struct ec_app *app, const struct ec_soe_hdr *h, const struct idn *i,
			 struct ec_wbuf *w)
{
	if (h->elements & EC_SOE_STATE)
		return EC_SOE_ERR_NO_STATE;
	if (h->elements & EC_SOE_NAME)
		put_text(w, i->name);
	if (h->elements & EC_SOE_ATTRIBUTE)
		ec_wbuf_le32(w, i->attribute);
	if (h->elements & EC_SOE_UNIT)
		put_text(w, i->unit ? i->unit : "");
	if (h->elements & EC_SOE_MIN && !i->max)
		return EC_SOE_ERR_NO_MIN;
	if (h->elements & EC_SOE_MIN)
		put_number(w, i, i->min);
	if (h->elements & EC_SOE_MAX && !i->max)
		return EC_SOE_ERR_NO_MAX;
	if (h->elements & EC_SOE_MAX)
		put_number(w, i, i->max);
	if (h->elements & EC_SOE_VALUE)
		put_value(w, app, h->drive, i);
	if (h->elements & EC_SOE_DEFAULT)
		return EC_SOE_ERR_NO_DEFAULT;
	return 0;
}

static bool is_protected(const struct ec_app *app, const struct idn *i)
{
	u32 bit = app->state == EC_AL_OP ? EC_SOE_ATTR_RO_OP :
		  app->state == EC_AL_SAFEOP ? EC_SOE_ATTR_RO_SAFEOP : EC_SOE_ATTR_RO_PREOP;

	return i->attribute & bit;
}

/* the length in a list must be what is there */
static u16 check_list(const struct idn *i, const u8 *data, size_t len)
{
	if (len < LIST_HDR || get_unaligned_le16(data) > len - LIST_HDR)
		return EC_SOE_ERR_SHORT;
	if (get_unaligned_le16(data) < len - LIST_HDR || len > room(i))
		return EC_SOE_ERR_LONG;
	return 0;
}

static u16 check_number(const struct idn *i, const u8 *data, size_t len)
{
	u8 b[8] = { 0 };

	if (len != fixed(i))
		return len < fixed(i) ? EC_SOE_ERR_SHORT : EC_SOE_ERR_LONG;
	memcpy(b, data, len);
	if (!i->max)
		return 0;
	return get_unaligned_le64(b) < i->min ? EC_SOE_ERR_BELOW :
	       get_unaligned_le64(b) > i->max ? EC_SOE_ERR_ABOVE : 0;
}

static u16 write_value(struct ec_app *app, const struct ec_soe_hdr *h, const struct idn *i,
		       const u8 *data, size_t len)
{
	u8 *p = value_of(app, h->drive, i);
	u16 error;

	switch (h->elements) {
	case EC_SOE_VALUE:
		break;
	case EC_SOE_NAME:
		return EC_SOE_ERR_NAME_RO;
	case EC_SOE_ATTRIBUTE:
		return EC_SOE_ERR_ATTRIBUTE_RO;
	case EC_SOE_UNIT:
		return EC_SOE_ERR_UNIT_RO;
	case EC_SOE_MIN:
		return EC_SOE_ERR_MIN_RO;
	case EC_SOE_MAX:
		return EC_SOE_ERR_MAX_RO;
	default:
		return EC_SOE_ERR_GENERAL;
	}
	if ((i->attribute & EC_SOE_ATTR_RO) == EC_SOE_ATTR_RO)
		return EC_SOE_ERR_READ_ONLY;
	if (is_protected(app, i))
		return EC_SOE_ERR_PROTECTED;
	error = is_list(i) ? check_list(i, data, len) : check_number(i, data, len);
	if (error)
		return error;
	memcpy(p, data, len);
	if (is_list(i))
		put_unaligned_le16(i->room, p + 2);
	app->soe.writes++;
	return 0;
}

static u16 execute(struct ec_app *app, const struct ec_soe_hdr *h, struct ec_rbuf *r,
		   struct ec_wbuf *w)
{
	const struct idn *i = NULL;

	for (u32 k = 0; k < ARRAY_SIZE(idns); k++)
		if (idns[k].idn == h->idn)
			i = &idns[k];
	if (h->incomplete)
		return EC_SOE_ERR_GENERAL;
	if (h->drive >= app->soe.drives)
		return EC_SOE_ERR_DRIVE;
	if (!i)
		return EC_SOE_ERR_NO_IDN;
	if (!h->elements)
		return EC_SOE_ERR_NO_ELEMENT;
	return h->opcode == EC_SOE_READ_REQ ? read_elements(app, h, i, w) :
		write_value(app, h, i, r->p, ec_rbuf_left(r));
}

/**
 * ec_app_soe() - answer an SoE message
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @tx: room for the answer
 * @cap: bytes at @tx
 *
 * An answer that needs fragments is a general error.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx; -EMSGSIZE: the message is too short, or no room for an
 * answer; -EINVAL: it is no request.
 */
int ec_app_soe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_wbuf w = ec_wbuf(tx, cap), head = w;
	struct ec_soe_hdr h;
	u16 error;

	if (ec_soe_hdr_decode(&r, &h) || !ec_wbuf_take(&w, EC_SOE_HDR))
		return -EMSGSIZE;
	if (h.opcode != EC_SOE_READ_REQ && h.opcode != EC_SOE_WRITE_REQ)
		return -EINVAL;
	error = execute(app, &h, &r, &w);
	if (!error && w.bad)
		error = EC_SOE_ERR_GENERAL;
	if (error) {
		w = ec_wbuf(tx + EC_SOE_HDR, cap - EC_SOE_HDR);
		ec_wbuf_le16(&w, error);
	}
	h.opcode++;
	h.incomplete = false;
	h.error = error;
	ec_soe_hdr_encode(&head, &h);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}
