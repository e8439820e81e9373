// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "eoe.h"
#include "mailbox.h"
#include "../wire/mbox.h"

#define TIMEOUT_MS	5000	/* as that of an SDO */

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
			u16 *result)
{
	struct answer a = { .type = resp, .result = result };
	struct ec_mbox_request req = {
		.type = EC_MBOX_EOE, .first = true, .limit.timeout_ms = TIMEOUT_MS, .rx = eoe_rx,
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
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_EOE, EC_EOE_IP_SIZE);
	int ret;

	*result = 0;
	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_eoe_ip_encode(b->tx, sizeof(b->tx), EC_EOE_SET_IP_REQ, p);
	ret = eoe_exchange(mb, b, ret, EC_EOE_SET_IP_RESP, result);
	kfree(b);
	ret = min(ret, 0);
	ec_mbox_dbg_result(mb, ret, "set IP parameters 0x%02x, EoE result 0x%04x", p->which,
			    *result);
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
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_EOE, EC_EOE_IP_SIZE);
	int ret;

	*result = 0;
	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_eoe_result_encode(b->tx, sizeof(b->tx), EC_EOE_GET_IP_REQ, 0);
	ret = eoe_exchange(mb, b, ret, EC_EOE_GET_IP_RESP, result);
	if (ret >= 0)
		ret = ec_eoe_ip_decode(b->rx, ret, p) ? -EBADMSG : 0;
	ret = ec_mbox_read_result(ret);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "get IP parameters, EoE result 0x%04x", *result);
	return ret;
}
