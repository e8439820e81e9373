// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sdoinfo.h"

/**
 * ec_sdoinfo_put_hdr() - write what every message begins with
 * @w: cursor behind the mailbox header
 * @opcode: enum ec_sdoinfo_opcode, and EC_SDOINFO_INCOMPLETE
 * @left: fragments that follow
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdoinfo_put_hdr(struct ec_wbuf *w, u8 opcode, u16 left)
{
	ec_coe_hdr_encode(w, EC_COE_SDO_INFO);
	ec_wbuf_u8(w, opcode);
	ec_wbuf_u8(w, 0);
	ec_wbuf_le16(w, left);
}

/**
 * ec_sdoinfo_init() - prepare a request
 * @s: exchange
 * @opcode: EC_SDOINFO_LIST_REQ, ..._OBJECT_REQ or ..._ENTRY_REQ
 * @index: object, or list type
 * @sub: subindex, 0 unless it is an entry
 * @data: where the answer goes, for ec_od_object_decode() or ec_od_entry_decode(); of a list
 *	only the indexes
 * @cap: bytes at @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sdoinfo_init(struct ec_sdoinfo *s, u8 opcode, u16 index, u8 sub, u8 *data, size_t cap)
{
	*s = (struct ec_sdoinfo){
		.opcode = opcode, .index = index, .sub = sub, .data = data, .cap = cap,
	};
}

/**
 * ec_sdoinfo_tx() - the request
 * @s: exchange
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when they do not fit, -EINVAL when the answer has
 * begun.
 */
int ec_sdoinfo_tx(struct ec_sdoinfo *s, u8 *tx, size_t cap)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	if (s->state != EC_SDOINFO_REQUEST)
		return -EINVAL;
	ec_sdoinfo_put_hdr(&w, s->opcode, 0);
	ec_wbuf_le16(&w, s->index);
	if (s->opcode == EC_SDOINFO_ENTRY_REQ) {
		ec_wbuf_u8(&w, s->sub);
		ec_wbuf_u8(&w, s->info);
	}
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

static int sdoinfo_fail(struct ec_sdoinfo *s, int err)
{
	s->state = EC_SDOINFO_DONE;
	return err;
}

/* Does the first fragment answer our question? 0, EC_STALE, -EMSGSIZE */
static int sdoinfo_match(const struct ec_sdoinfo *s, struct ec_rbuf r)
{
	u16 index = ec_rbuf_le16(&r);
	u8 sub = s->opcode == EC_SDOINFO_ENTRY_REQ ? ec_rbuf_u8(&r) : s->sub;

	if (r.bad)
		return -EMSGSIZE;
	return index == s->index && sub == s->sub ? 0 : EC_STALE;
}

/**
 * ec_sdoinfo_rx() - take a fragment of the answer
 * @s: exchange
 * @rx: CoE message behind the mailbox header
 * @len: bytes at @rx: the length of the mailbox header
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 when complete, EC_WAIT: the next fragment comes unasked, EC_STALE
 * for what is not our answer; -EIO: the slave refused, see @s->abort;
 * -ENOBUFS: larger than @cap, fragments still to come are stale; -EPROTO: a
 * fragment is missing or there is no end to them; -EMSGSIZE: message too
 * short; -EINVAL: the exchange is over.
 */
int ec_sdoinfo_rx(struct ec_sdoinfo *s, const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_coe_hdr h;
	u8 opcode;
	u16 left;
	size_t n;
	int ret;

	if (s->state == EC_SDOINFO_DONE)
		return -EINVAL;
	if (ec_coe_hdr_decode(&r, &h))
		return sdoinfo_fail(s, -EMSGSIZE);
	if (h.service != EC_COE_SDO_INFO)
		return EC_STALE;
	opcode = ec_rbuf_u8(&r);
	ec_rbuf_u8(&r);
	left = ec_rbuf_le16(&r);
	if (r.bad)
		return sdoinfo_fail(s, -EMSGSIZE);

	if ((opcode & EC_SDOINFO_OPCODE_MASK) == EC_SDOINFO_ERROR) {
		s->abort = ec_rbuf_le32(&r);
		return sdoinfo_fail(s, r.bad ? -EMSGSIZE : -EIO);
	}
	if ((opcode & EC_SDOINFO_OPCODE_MASK) != s->opcode + 1)
		return EC_STALE;

	if (s->state == EC_SDOINFO_REQUEST) {
		ret = sdoinfo_match(s, r);
		if (ret == EC_STALE)
			return EC_STALE;
		if (ret)
			return sdoinfo_fail(s, ret);
		if (s->opcode == EC_SDOINFO_LIST_REQ)
			ec_rbuf_le16(&r);
	} else if (s->left && left + 1 != s->left) {
		return sdoinfo_fail(s, -EPROTO);
	}
	if (++s->fragments > EC_SDOINFO_FRAGMENTS)
		return sdoinfo_fail(s, -EPROTO);

	n = ec_rbuf_left(&r);
	if (n > s->cap - s->size)
		return sdoinfo_fail(s, -ENOBUFS);
	if (n)
		memcpy(s->data + s->size, ec_rbuf_take(&r, n), n);
	s->size += n;
	s->left = left;
	/* one of the two is enough: slaves forget the other */
	if (!(opcode & EC_SDOINFO_INCOMPLETE) && !left)
		return sdoinfo_fail(s, 0);
	s->state = EC_SDOINFO_FRAGMENT;
	return EC_WAIT;
}

/* What is left is a name; zeros at its end do not belong to it. */
static size_t get_name(struct ec_rbuf *r, const char **name)
{
	size_t n = ec_rbuf_left(r);
	const u8 *p = ec_rbuf_take(r, n);

	*name = (const char *)p;
	while (n && p && !p[n - 1])
		n--;
	return p ? n : 0;
}

/**
 * ec_od_object_decode() - read an object description
 * @data: body of the answer
 * @len: bytes at @data
 * @o: result; the name points into @data
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short.
 */
int ec_od_object_decode(const u8 *data, size_t len, struct ec_od_object *o)
{
	struct ec_rbuf r = ec_rbuf(data, len);

	o->index = ec_rbuf_le16(&r);
	o->type = ec_rbuf_le16(&r);
	o->max_sub = ec_rbuf_u8(&r);
	o->code = ec_rbuf_u8(&r);
	o->name_len = get_name(&r, &o->name);
	return r.bad ? -EMSGSIZE : 0;
}

/**
 * ec_od_entry_decode() - read an entry description
 * @data: body of the answer
 * @len: bytes at @data
 * @e: result; the name points into @data
 *
 * Optional fields (unit, default, minimum, maximum) are skipped; if they do
 * not fit, the entry has no name.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short.
 */
int ec_od_entry_decode(const u8 *data, size_t len, struct ec_od_entry *e)
{
	struct ec_rbuf r = ec_rbuf(data, len);
	size_t skip = 0, value;

	e->index = ec_rbuf_le16(&r);
	e->sub = ec_rbuf_u8(&r);
	e->info = ec_rbuf_u8(&r);
	e->type = ec_rbuf_le16(&r);
	e->bits = ec_rbuf_le16(&r);
	e->access = ec_rbuf_le16(&r);
	if (r.bad)
		return -EMSGSIZE;

	value = DIV_ROUND_UP((size_t)e->bits, 8);
	skip += e->info & EC_OD_INFO_UNIT ? 2 : 0;
	skip += e->info & EC_OD_INFO_DEFAULT ? value : 0;
	skip += e->info & EC_OD_INFO_MIN ? value : 0;
	skip += e->info & EC_OD_INFO_MAX ? value : 0;
	ec_rbuf_take(&r, min_t(size_t, skip, ec_rbuf_left(&r)));
	e->name_len = get_name(&r, &e->name);
	return 0;
}

/**
 * ec_od_values_decode() - read the optional fields of an entry description
 * @data: body of the answer with them
 * @len: bytes at @data
 * @plain: bytes of the same description without any optional field
 * @v: result; the values point into @data
 *
 * The unit type has 2 bytes or 4, and a name of any length follows. The length of the
 * description alone does not show where the name begins: @plain is needed.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short, -EBADMSG when it is not longer than
 * @plain by the sizes of its optional fields.
 */
int ec_od_values_decode(const u8 *data, size_t len, size_t plain, struct ec_od_values *v)
{
	struct ec_rbuf r = ec_rbuf(data, len);
	struct ec_od_entry e;
	size_t values, unit;

	*v = (struct ec_od_values){ 0 };
	if (ec_od_entry_decode(data, len, &e))
		return -EMSGSIZE;
	ec_rbuf_take(&r, EC_OD_ENTRY_HDR);
	values = DIV_ROUND_UP((size_t)e.bits, 8) *
		 (!!(e.info & EC_OD_INFO_DEFAULT) + !!(e.info & EC_OD_INFO_MIN) +
		  !!(e.info & EC_OD_INFO_MAX));
	if (plain < EC_OD_ENTRY_HDR || plain > len || len - plain < values)
		return -EBADMSG;
	unit = len - plain - values;
	if (e.info & EC_OD_INFO_UNIT ? unit != 2 && unit != 4 : unit)
		return -EBADMSG;

	v->info = e.info & EC_OD_INFO_VALUES;
	v->unit_size = (u8)unit;
	v->size = DIV_ROUND_UP((size_t)e.bits, 8);
	if (unit)
		v->unit = unit == 2 ? ec_rbuf_le16(&r) : ec_rbuf_le32(&r);
	v->def = v->info & EC_OD_INFO_DEFAULT ? ec_rbuf_take(&r, v->size) : NULL;
	v->min = v->info & EC_OD_INFO_MIN ? ec_rbuf_take(&r, v->size) : NULL;
	v->max = v->info & EC_OD_INFO_MAX ? ec_rbuf_take(&r, v->size) : NULL;
	return r.bad ? -EBADMSG : 0;
}
