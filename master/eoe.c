// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/slab.h>
#include "config.h"
#include "eoe.h"
#include "mailbox.h"
#include "master.h"
#include "slave.h"
#include "wire/mbox.h"

#define TIMEOUT_MS	1000

/* Frames of the slave's network may come in between. */
static int answer(struct ec_slave *slave, struct ec_mbox_buf *b, u8 type, u16 *result, u64 until)
{
	int len, ret;

	do {
		len = ec_mbox_recv(slave, EC_MBOX_EOE, b, until);
		if (len < 0)
			return len;
		ret = ec_eoe_result_decode(b->rx, len, type, result);
	} while (ret == -ENOMSG && ktime_get_ns() <= until);
	if (ret)
		return ret == -ENOMSG ? -ETIMEDOUT : -EBADMSG;
	return *result ? -EREMOTEIO : len;
}

/* @len bytes of @b->tx go out, the answer of type @resp comes to @b->rx. */
static int exchange(struct ec_slave *slave, struct ec_mbox_buf *b, size_t len, u8 resp,
		    u16 *result)
{
	u64 until;
	int ret = mutex_lock_interruptible(&slave->mbox_lock);

	if (ret)
		return ret;
	until = ktime_get_ns() + TIMEOUT_MS * NSEC_PER_MSEC;
	ret = ec_mbox_drain(slave, b) ?: ec_mbox_send(slave, EC_MBOX_EOE, b, len, until) ?:
	      answer(slave, b, resp, result, until);
	mutex_unlock(&slave->mbox_lock);
	return ret;
}

static int check(const struct ec_slave *slave)
{
	if (!ec_slave_has_mailbox(slave) || !(slave->info.protocols & EC_SII_PROTO_EOE))
		return -EPROTONOSUPPORT;
	if (slave->info.std.rx_size < EC_MBOX_HDR + EC_EOE_IP_SIZE ||
	    slave->info.std.rx_size > EC_MBOX_MAX || slave->info.std.tx_size > EC_MBOX_MAX)
		return -EMSGSIZE;
	if ((slave->al_status & EC_AL_STATE_MASK) < EC_AL_PREOP)
		return -EAGAIN;
	return 0;
}

/**
 * ec_eoe_set_ip() - give a slave IP parameters
 * @slave: slave
 * @p: parameters; those not in @which stay as they are
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
int ec_eoe_set_ip(struct ec_slave *slave, const struct ec_eoe_ip *p, u16 *result)
{
	struct ec_mbox_buf *b;
	int ret = check(slave);

	*result = 0;
	if (ret)
		return ret;
	b = kmalloc(sizeof(*b), GFP_KERNEL);
	if (!b)
		return -ENOMEM;
	ret = ec_eoe_ip_encode(b->tx, sizeof(b->tx), EC_EOE_SET_IP_REQ, p);
	ret = exchange(slave, b, ret, EC_EOE_SET_IP_RESP, result);
	kfree(b);
	ec_slave_dbg(slave, 1, "set IP parameters 0x%02x: result %d, 0x%04x\n", p->which, ret,
		     *result);
	return min(ret, 0);
}

/**
 * ec_eoe_get_ip() - ask a slave for its IP parameters
 * @slave: slave
 * @p: parameters, @which says what the slave told
 * @result: EC_EOE_OK... of the slave
 *
 * EoE "get IP parameter" (ETG.1000.6 clause 5.7).
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_eoe_set_ip().
 */
int ec_eoe_get_ip(struct ec_slave *slave, struct ec_eoe_ip *p, u16 *result)
{
	struct ec_mbox_buf *b;
	int ret = check(slave);

	*result = 0;
	if (ret)
		return ret;
	b = kmalloc(sizeof(*b), GFP_KERNEL);
	if (!b)
		return -ENOMEM;
	ret = ec_eoe_result_encode(b->tx, sizeof(b->tx), EC_EOE_GET_IP_REQ, 0);
	ret = exchange(slave, b, ret, EC_EOE_GET_IP_RESP, result);
	if (ret >= 0)
		ret = ec_eoe_ip_decode(b->rx, ret, p) ? -EBADMSG : 0;
	kfree(b);
	ec_slave_dbg(slave, 1, "get IP parameters: result %d, 0x%04x\n", ret, *result);
	return ret;
}

/**
 * ec_eoe_apply() - write the configured IP parameters
 * @slave: slave in PREOP
 * @c: its configuration
 *
 * Context: Worker. Waits for bus traffic.
 * Return: 0, also when there are none; or as ec_eoe_set_ip(), told already.
 */
int ec_eoe_apply(struct ec_slave *slave, const struct ec_config *c)
{
	u16 result;
	int ret;

	if (!c->ip.which)
		return 0;
	ret = ec_eoe_set_ip(slave, &c->ip, &result);
	if (!ret || ret == -ECANCELED || ret == -EINTR)
		return ret;
	if (ret == -EREMOTEIO)
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED,
			      "refused its IP parameters: EoE result 0x%04x: %s", result,
			      ec_eoe_result_text(result));
	else if (ret == -EPROTONOSUPPORT)
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED,
			      "shall get IP parameters but has no EoE; leave ecrt_slave_config_eoe_...() out");
	else
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED, "IP parameters: error %d", ret);
	return ret;
}
