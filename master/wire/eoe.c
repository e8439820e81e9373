// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "eoe.h"
#include "text.h"

#define TYPE_MASK	0x000f
#define LAST_FRAGMENT	0x0100

/**
 * ec_eoe_type_decode() - what kind of message this is
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: enum ec_eoe_type or another number up to 15, -EMSGSIZE when the
 * header is not complete.
 */
int ec_eoe_type_decode(const u8 *rx, size_t len)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	u16 type = ec_rbuf_le16(&r) & TYPE_MASK;

	ec_rbuf_le16(&r);
	return r.bad ? -EMSGSIZE : type;
}

/* A field that is absent has its place, or none. */
static void put_bytes(struct ec_wbuf *w, const u8 *from, size_t n, bool given, bool packed)
{
	if (given)
		ec_wbuf_bytes(w, from, n);
	else if (!packed)
		ec_wbuf_zero(w, n);
}

/* Network order is the most significant byte first, the message's the last. */
static void put_address(struct ec_wbuf *w, const u8 a[4], bool given, bool packed)
{
	u8 le[4];
	unsigned int i;

	for (i = 0; i < 4; i++)
		le[i] = a[3 - i];
	put_bytes(w, le, sizeof(le), given, packed);
}

static int ip_encode(u8 *tx, size_t cap, u8 type, const struct ec_eoe_ip *p, bool packed)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_wbuf_le16(&w, (u16)(type | LAST_FRAGMENT));
	ec_wbuf_le16(&w, 0);
	ec_wbuf_le32(&w, p->which & EC_EOE_ALL);
	put_bytes(&w, p->mac, sizeof(p->mac), p->which & EC_EOE_MAC, packed);
	put_address(&w, p->ip, p->which & EC_EOE_IP, packed);
	put_address(&w, p->mask, p->which & EC_EOE_MASK, packed);
	put_address(&w, p->gateway, p->which & EC_EOE_GATEWAY, packed);
	put_address(&w, p->dns, p->which & EC_EOE_DNS, packed);
	put_bytes(&w, p->name, sizeof(p->name), p->which & EC_EOE_HOSTNAME, packed);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/**
 * ec_eoe_ip_encode() - write IP parameters
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @type: EC_EOE_SET_IP_REQ; or EC_EOE_GET_IP_RESP, with a result of 0
 * @p: what to write
 *
 * Every field has its fixed place, those not in @p->which are 0.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit.
 */
int ec_eoe_ip_encode(u8 *tx, size_t cap, u8 type, const struct ec_eoe_ip *p)
{
	return ip_encode(tx, cap, type, p, false);
}

/**
 * ec_eoe_ip_encode_packed() - write IP parameters as some slaves read them
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @type: as that of ec_eoe_ip_encode()
 * @p: what to write
 *
 * Fields that are not in @p->which have no place.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit.
 */
int ec_eoe_ip_encode_packed(u8 *tx, size_t cap, u8 type, const struct ec_eoe_ip *p)
{
	return ip_encode(tx, cap, type, p, true);
}

/* The cursor ends behind the last field that is given, at the latest. */
static void get_bytes(struct ec_rbuf *r, u8 *to, size_t n, bool given, bool packed)
{
	const u8 *p;

	if (!given && packed)
		return;
	if (!given && ec_rbuf_left(r) < n) {
		r->p = r->end;
		return;
	}
	p = ec_rbuf_take(r, n);
	if (p && given)
		memcpy(to, p, n);
}

static void get_address(struct ec_rbuf *r, u8 a[4], bool given, bool packed)
{
	u8 le[4] = { 0 };
	unsigned int i;

	get_bytes(r, le, sizeof(le), given, packed);
	for (i = 0; i < 4; i++)
		a[i] = le[3 - i];
}

/* Return: the bytes that are left, or -EMSGSIZE. */
static int ip_decode(const u8 *rx, size_t len, struct ec_eoe_ip *p, bool packed)
{
	struct ec_rbuf r = ec_rbuf(rx, len);

	memset(p, 0, sizeof(*p));
	ec_rbuf_le32(&r);
	p->which = ec_rbuf_le32(&r) & EC_EOE_ALL;
	get_bytes(&r, p->mac, sizeof(p->mac), p->which & EC_EOE_MAC, packed);
	get_address(&r, p->ip, p->which & EC_EOE_IP, packed);
	get_address(&r, p->mask, p->which & EC_EOE_MASK, packed);
	get_address(&r, p->gateway, p->which & EC_EOE_GATEWAY, packed);
	get_address(&r, p->dns, p->which & EC_EOE_DNS, packed);
	get_bytes(&r, p->name, sizeof(p->name), p->which & EC_EOE_HOSTNAME, packed);
	return r.bad ? -EMSGSIZE : (int)ec_rbuf_left(&r);
}

/**
 * ec_eoe_ip_decode_packed() - read IP parameters as some slaves do
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @p: result; fields that are not in @p->which are 0
 *
 * Fields that are not in @p->which have no place.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short for what it says it has.
 */
int ec_eoe_ip_decode_packed(const u8 *rx, size_t len, struct ec_eoe_ip *p)
{
	int ret = ip_decode(rx, len, p, true);

	return min(ret, 0);
}

/**
 * ec_eoe_ip_decode() - read IP parameters
 * @rx: message behind the mailbox header: a request to set them, or the answer
 *	to a request to get them
 * @len: bytes at @rx
 * @p: result; fields that are not in @p->which are 0
 *
 * A message may end behind its last member in use. One that is too short for
 * fixed places and just has the members in use is packed.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short for what it says it has.
 */
int ec_eoe_ip_decode(const u8 *rx, size_t len, struct ec_eoe_ip *p)
{
	int ret = ip_decode(rx, len, p, false);

	if (ret < 0 && !ip_decode(rx, len, p, true))
		return 0;
	return min(ret, 0);
}

/**
 * ec_eoe_ip_fill() - make a request that slaves of both readings understand
 * @p: parameters to set; fields that are not wanted are added
 * @now: those that the slave has; @which 0: not known
 * @mac: address for a slave whose address is not known
 *
 * Some slaves look for each member at its fixed place, others behind the one
 * before, others ignore what follows the first absent one. The three agree
 * when no member before the last one is absent. An address that the slave may
 * have from DHCP is not made a static one: without EC_EOE_IP, and without a
 * mask, the request does not change.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether all slaves understand it.
 */
bool ec_eoe_ip_fill(struct ec_eoe_ip *p, const struct ec_eoe_ip *now, const u8 mac[6])
{
	u32 all = p->which | p->which >> 1, gaps, known;

	all |= all >> 2;
	all |= all >> 4;
	gaps = all & ~p->which;
	known = gaps & now->which;
	if (gaps & EC_EOE_IP || gaps & ~known & EC_EOE_MASK)
		return false;
	if (gaps & EC_EOE_MAC)
		memcpy(p->mac, known & EC_EOE_MAC ? now->mac : mac, sizeof(p->mac));
	if (gaps & EC_EOE_MASK)
		memcpy(p->mask, now->mask, sizeof(p->mask));
	/* 0.0.0.0: there is none */
	if (gaps & EC_EOE_GATEWAY)
		memcpy(p->gateway, now->gateway, sizeof(p->gateway));
	if (gaps & EC_EOE_DNS)
		memcpy(p->dns, now->dns, sizeof(p->dns));
	p->which |= gaps;
	return true;
}

/**
 * ec_eoe_ip_same() - are parameters the same
 * @a: parameters
 * @b: others; those that they do not have are 0
 * @which: EC_EOE_MAC..., those that are compared
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether they are.
 */
bool ec_eoe_ip_same(const struct ec_eoe_ip *a, const struct ec_eoe_ip *b, u32 which)
{
	return (!(which & EC_EOE_MAC) || !memcmp(a->mac, b->mac, sizeof(a->mac))) &&
	       (!(which & EC_EOE_IP) || !memcmp(a->ip, b->ip, sizeof(a->ip))) &&
	       (!(which & EC_EOE_MASK) || !memcmp(a->mask, b->mask, sizeof(a->mask))) &&
	       (!(which & EC_EOE_GATEWAY) || !memcmp(a->gateway, b->gateway, sizeof(a->gateway))) &&
	       (!(which & EC_EOE_DNS) || !memcmp(a->dns, b->dns, sizeof(a->dns))) &&
	       (!(which & EC_EOE_HOSTNAME) || !memcmp(a->name, b->name, sizeof(a->name)));
}

/**
 * ec_eoe_result_encode() - write a message that is a header only
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @type: enum ec_eoe_type, an answer; or EC_EOE_GET_IP_REQ
 * @result: EC_EOE_OK...; 0 in a request
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit.
 */
int ec_eoe_result_encode(u8 *tx, size_t cap, u8 type, u16 result)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_wbuf_le16(&w, (u16)(type | LAST_FRAGMENT));
	ec_wbuf_le16(&w, result);
	return w.bad ? -EMSGSIZE : EC_EOE_HDR;
}

/**
 * ec_eoe_result_decode() - read the result of an answer
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @type: the answer that is expected
 * @result: EC_EOE_OK...
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOMSG when it is another message, -EMSGSIZE when it is too
 * short.
 */
int ec_eoe_result_decode(const u8 *rx, size_t len, u8 type, u16 *result)
{
	int ret = ec_eoe_type_decode(rx, len);

	if (ret < 0)
		return ret;
	if (ret != type)
		return -ENOMSG;
	*result = get_unaligned_le16(rx + 2);
	return 0;
}

static const struct ec_text results[] = {
	{ EC_EOE_OK, "success" },
	{ EC_EOE_UNSPECIFIED, "unspecified error" },
	{ EC_EOE_NO_TYPE, "the slave does not support this kind of EoE message" },
	{ EC_EOE_NO_IP, "the slave does not support IP" },
	{ EC_EOE_NO_DHCP, "the slave does not support DHCP" },
	{ EC_EOE_NO_FILTER, "the slave does not support MAC filters" },
};

/**
 * ec_eoe_result_text() - meaning of a result
 * @result: EC_EOE_OK...
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: text, never NULL.
 */
const char *ec_eoe_result_text(u16 result)
{
	const char *text = ec_text_find(results, ARRAY_SIZE(results), result);

	return text ? text : "unknown result";
}
