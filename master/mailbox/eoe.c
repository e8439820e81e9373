// SPDX-License-Identifier: GPL-2.0-only
#include <linux/log2.h>
#include <linux/slab.h>
#include "eoe.h"
#include "mailbox.h"
#include "../wire/mbox.h"

#define TIMEOUT_MS	5000	/* as that of an SDO */
#define KNOWN_MS	500	/* for a slave that may not know the request */

/* the answer that is waited for */
struct answer {
	u8 type;
	u16 *result;
	int len;
};

/* Frames of the slave's network may come in between. */
static int eoe_rx(void *ctx, const u8 *buf, size_t len)
{
	struct answer *a = ctx;
	int ret = ec_eoe_result_decode(buf, len, a->type, a->result);

	if (ret)
		return ret == -ENOMSG ? EC_STALE : -EBADMSG;
	a->len = len;
	return *a->result ? -EREMOTEIO : 0;
}

/* Send @len bytes of @b->tx, get the answer of type @resp in @b->rx; returns its length. */
static int eoe_exchange(struct ec_mbox *mb, struct ec_mbox_buf *b, size_t len, u8 resp,
			u16 *result, u32 timeout_ms)
{
	struct answer a = { .type = resp, .result = result };
	struct ec_mbox_request req = {
		.type = EC_MBOX_EOE, .first = true, .limit.timeout_ms = timeout_ms, .rx = eoe_rx,
		.ctx = &a,
	};
	struct ec_claim claim = { 0 };
	int ret = ec_mbox_claim(mb, &claim, BIT(EC_MBOX_EOE), 0);

	if (ret)
		return ret;
	ret = ec_mbox_request(mb, &req, b, len) ?: a.len;
	ec_mbox_unclaim(mb, &claim);
	return ret;
}

static int set_ip(struct ec_mbox *mb, const struct ec_eoe_ip *p, u16 *result, bool packed)
{
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_EOE, EC_EOE_IP_SIZE);
	int ret;

	*result = 0;
	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = packed ? ec_eoe_ip_encode_packed(b->tx, sizeof(b->tx), EC_EOE_SET_IP_REQ, p) :
		       ec_eoe_ip_encode(b->tx, sizeof(b->tx), EC_EOE_SET_IP_REQ, p);
	ret = eoe_exchange(mb, b, ret, EC_EOE_SET_IP_RESP, result, TIMEOUT_MS);
	kfree(b);
	ret = min(ret, 0);
	ec_mbox_dbg_result(mb, ret, "set IP parameters 0x%02x, EoE result 0x%04x", p->which,
			    *result);
	return ret;
}

/**
 * ec_eoe_set_ip() - give a slave IP parameters
 * @mb: mailbox of the slave
 * @p: parameters; those not in @which do not change
 * @result: EC_EOE_OK... of the slave
 *
 * EoE "set IP parameter" (ETG.1000.6 clause 5.7).
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EREMOTEIO when the slave refuses, with @result;
 * -EPROTONOSUPPORT without EoE; -EMSGSIZE for a mailbox that is too small;
 * -EAGAIN in INIT; -EBADMSG for a wrong answer; -ETIMEDOUT; -EINTR;
 * -ECANCELED; -ENOMEM.
 */
int ec_eoe_set_ip(struct ec_mbox *mb, const struct ec_eoe_ip *p, u16 *result)
{
	return set_ip(mb, p, result, false);
}

static int get_ip(struct ec_mbox *mb, struct ec_eoe_ip *p, u16 *result, u32 timeout_ms)
{
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_EOE, EC_EOE_IP_SIZE);
	int ret;

	*result = 0;
	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_eoe_result_encode(b->tx, sizeof(b->tx), EC_EOE_GET_IP_REQ, 0);
	ret = eoe_exchange(mb, b, ret, EC_EOE_GET_IP_RESP, result, timeout_ms);
	if (ret >= 0)
		ret = ec_eoe_ip_decode(b->rx, ret, p) ? -EBADMSG : 0;
	ret = ec_mbox_read_result(ret);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "get IP parameters, EoE result 0x%04x", *result);
	return ret;
}

/**
 * ec_eoe_get_ip() - get the IP parameters of a slave
 * @mb: mailbox of the slave
 * @p: parameters, @which: those that the slave has
 * @result: EC_EOE_OK... of the slave
 *
 * EoE "get IP parameter" (ETG.1000.6 clause 5.7).
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_eoe_set_ip().
 */
int ec_eoe_get_ip(struct ec_mbox *mb, struct ec_eoe_ip *p, u16 *result)
{
	return get_ip(mb, p, result, TIMEOUT_MS);
}

/* Does a slave have what it would, if it has read a request with fixed places as packed? */
static bool misread(const struct ec_eoe_ip *p, const struct ec_eoe_ip *now)
{
	u8 msg[EC_EOE_IP_SIZE];
	struct ec_eoe_ip wrong;

	return ec_eoe_ip_encode(msg, sizeof(msg), EC_EOE_SET_IP_REQ, p) > 0 &&
	       !ec_eoe_ip_decode_packed(msg, sizeof(msg), &wrong) &&
	       !ec_eoe_ip_same(now, p, p->which) && ec_eoe_ip_same(now, &wrong, p->which);
}

/**
 * ec_eoe_give_ip() - give a slave IP parameters, in a form that each slave understands
 * @mb: mailbox of the slave
 * @p: parameters; those not in @which do not change
 * @mac: MAC address for a slave that reports none, if its request needs one
 * @result: EC_EOE_OK... of the slave
 *
 * Between wanted parameters the request repeats what the slave has, see
 * ec_eoe_ip_fill(); a slave that does not report it has 500 ms. Where that does
 * not help, the parameters are read back, and are packed if the slave has read
 * them so.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_eoe_set_ip().
 */
int ec_eoe_give_ip(struct ec_mbox *mb, const struct ec_eoe_ip *p, const u8 mac[6], u16 *result)
{
	static const struct ec_eoe_ip nothing;
	struct ec_eoe_ip now, all = *p;
	int ret;

	*result = 0;
	/* no field between others is absent */
	if (is_power_of_2(p->which + 1))
		return ec_eoe_set_ip(mb, p, result);
	ret = get_ip(mb, &now, result, KNOWN_MS);
	if (ret == -EINTR || ret == -ECANCELED || ret == -EAGAIN || ret == -ENOMEM)
		return ret;
	if (ec_eoe_ip_fill(&all, ret ? &nothing : &now, mac) || ret)
		return ec_eoe_set_ip(mb, &all, result);
	ret = ec_eoe_set_ip(mb, p, result);
	if (ret)
		return ret;
	if (!get_ip(mb, &now, result, KNOWN_MS) && misread(p, &now))
		return set_ip(mb, p, result, true);
	*result = 0;
	return 0;
}
