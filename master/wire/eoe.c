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

/* Network order is the most significant byte first, the message's the last. */
static void put_address(struct ec_wbuf *w, const struct ec_eoe_ip *p, u32 which, const u8 a[4])
{
	ec_wbuf_le32(w, p->which & which ? (u32)a[0] << 24 | a[1] << 16 | a[2] << 8 | a[3] : 0);
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
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_wbuf_le16(&w, (u16)(type | LAST_FRAGMENT));
	ec_wbuf_le16(&w, 0);
	ec_wbuf_le32(&w, p->which & EC_EOE_ALL);
	if (p->which & EC_EOE_MAC)
		ec_wbuf_bytes(&w, p->mac, sizeof(p->mac));
	else
		ec_wbuf_zero(&w, sizeof(p->mac));
	put_address(&w, p, EC_EOE_IP, p->ip);
	put_address(&w, p, EC_EOE_MASK, p->mask);
	put_address(&w, p, EC_EOE_GATEWAY, p->gateway);
	put_address(&w, p, EC_EOE_DNS, p->dns);
	if (p->which & EC_EOE_HOSTNAME)
		ec_wbuf_bytes(&w, p->name, sizeof(p->name));
	else
		ec_wbuf_zero(&w, sizeof(p->name));
	return w.bad ? -EMSGSIZE : EC_EOE_IP_SIZE;
}

/* The cursor ends behind the last field that is needed, at the latest. */
static void get_bytes(struct ec_rbuf *r, u8 *to, size_t n, bool needed)
{
	const u8 *p;

	if (!needed && ec_rbuf_left(r) < n) {
		r->p = r->end;
		return;
	}
	p = ec_rbuf_take(r, n);
	if (p && needed)
		memcpy(to, p, n);
}

static void get_address(struct ec_rbuf *r, u8 a[4], bool needed)
{
	u8 le[4] = { 0 };
	unsigned int i;

	get_bytes(r, le, sizeof(le), needed);
	for (i = 0; i < 4; i++)
		a[i] = le[3 - i];
}

/**
 * ec_eoe_ip_decode() - read IP parameters
 * @rx: message behind the mailbox header: a request to set them, or the answer
 *	to a request to get them
 * @len: bytes at @rx
 * @p: result; fields that are not in @p->which are 0
 *
 * A message may end behind its last field in use.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is too short for what it says it has.
 */
int ec_eoe_ip_decode(const u8 *rx, size_t len, struct ec_eoe_ip *p)
{
	struct ec_rbuf r = ec_rbuf(rx, len);

	memset(p, 0, sizeof(*p));
	ec_rbuf_le32(&r);
	p->which = ec_rbuf_le32(&r) & EC_EOE_ALL;
	get_bytes(&r, p->mac, sizeof(p->mac), p->which & EC_EOE_MAC);
	get_address(&r, p->ip, p->which & EC_EOE_IP);
	get_address(&r, p->mask, p->which & EC_EOE_MASK);
	get_address(&r, p->gateway, p->which & EC_EOE_GATEWAY);
	get_address(&r, p->dns, p->which & EC_EOE_DNS);
	get_bytes(&r, p->name, sizeof(p->name), p->which & EC_EOE_HOSTNAME);
	return r.bad ? -EMSGSIZE : 0;
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
