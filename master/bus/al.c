// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/moduleparam.h>
#include "../base/limits.h"
#include "slave.h"
#include "../carry/xfer.h"

unsigned int ec_al_timeout;

static int set_timeout(const char *value, const struct kernel_param *kp)
{
	return param_set_uint_minmax(value, kp, 0, EC_MAX_AL_MS);
}

static const struct kernel_param_ops timeout_ops = {
	.set = set_timeout,
	.get = param_get_uint,
};

module_param_cb(state_timeout_ms, &timeout_ops, &ec_al_timeout, 0644);
MODULE_PARM_DESC(state_timeout_ms,
		 "Time limit of each AL state transition, up to 600000 ms; 0: 200 ms to 10 s by transition (0)");

/**
 * ec_al_read() - read AL status and code, registers 0x0130-0x0135
 * @slave: slave
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not answer, or as ec_xfer().
 */
int ec_al_read(struct ec_slave *slave)
{
	u8 b[6];
	int ret = ec_xfer_fprd(slave->bus->links, slave->station, EC_REG_AL_STATUS, b, sizeof(b));

	if (!ret) {
		ec_slave_set_al(slave, get_unaligned_le16(b), get_unaligned_le16(b + 4), true);
		WRITE_ONCE(slave->al_reads, slave->al_reads + 1);
	}
	return ret;
}

/* Register 0x0120: a slave that has not read the last request takes none. */
static int request(struct ec_slave *slave, u16 control, u64 until_ns)
{
	u8 b[2];
	int ret;

	put_unaligned_le16(control, b);
	for (;;) {
		ret = ec_xfer_fpwr(slave->bus->links, slave->station, EC_REG_AL_CONTROL, b,
				   sizeof(b));
		if (ret != -EIO || READ_ONCE(slave->stop.gone))
			return ret;
		if (ktime_get_ns() > until_ns)
			return -ETIME;
		if (ec_stop_worker(&slave->stop))
			return -ECANCELED;
		usleep_range(500, 1000);
	}
}

/* Poll (no slave reports by itself) until @mask of the status has @value or an error appears. */
static int poll(struct ec_slave *slave, u16 mask, u16 value, bool errors, u64 until_ns)
{
	unsigned int wait_us = 50;
	int ret;

	for (;;) {
		ret = ec_al_read(slave);
		if (ret && ret != -ETIMEDOUT)
			return ret;
		if (!ret) {
			if ((READ_ONCE(slave->al_status) & mask) == value)
				return 0;
			if (errors && READ_ONCE(slave->al_status) & EC_AL_ERROR)
				return -EPROTO;
		}
		if (ec_stop_worker(&slave->stop))
			return -ECANCELED;
		if (ktime_get_ns() > until_ns)
			return -ETIME;
		usleep_range(wait_us, wait_us + wait_us / 4);
		wait_us = min(wait_us * 2, 2000u);
	}
}

/**
 * ec_al_ack() - acknowledge the error indication
 * @slave: slave whose AL status was just read
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -ETIME when the slave keeps it, or as ec_al_set().
 */
int ec_al_ack(struct ec_slave *slave)
{
	u64 until = ktime_get_ns() + 1000 * NSEC_PER_MSEC;
	u16 state = READ_ONCE(slave->al_status) & EC_AL_STATE_MASK;
	int ret;

	/* device emulation copies AL control, so the acknowledge would show as an error */
	ret = request(slave, slave->emulation ? state : state | EC_AL_ERROR, until);
	return ret ? ret : poll(slave, EC_AL_ERROR, 0, false, until);
}

/* The request of a tool comes first, then what the application allows. */
static u32 limit_ms(const struct ec_slave *s, u8 from, u8 to, u32 configured_ms)
{
	return READ_ONCE(s->limit_ms) ?: configured_ms ?: READ_ONCE(ec_al_timeout) ?:
	       ec_al_timeout_ms(from, to);
}

/**
 * ec_al_set() - bring a slave to a neighbouring AL state and wait for it
 * @slave: slave
 * @state: wanted state; @awaited until it is reached or refused, or another one is asked for
 * @timeout_ms: limit that the application has configured, 0: none
 *
 * ETG.1000.6 clause 6.4.1.
 *
 * Context: Process. Waits for bus traffic, until the time limit.
 * Return: 0; -EPROTO when the slave refused (al_code says why; the error is
 * acknowledged already); -ETIME; -EIO when it does not answer; -ECANCELED.
 */
int ec_al_set(struct ec_slave *slave, u8 state, u32 timeout_ms)
{
	u8 from = READ_ONCE(slave->al_status) & EC_AL_STATE_MASK;
	u16 code;
	u64 until;
	int ret;

	/* in the new state it may have another dictionary */
	if (from < EC_AL_PREOP || from == EC_AL_BOOT || state < EC_AL_PREOP || state == EC_AL_BOOT)
		ec_dict_forget(&slave->dict);
	timeout_ms = limit_ms(slave, from, state, timeout_ms);
	slave->awaited_ms = timeout_ms;
	WRITE_ONCE(slave->awaited, state);
	until = ktime_get_ns() + (u64)timeout_ms * NSEC_PER_MSEC;
	ec_slave_dbg(slave, 1, "%s requested, is in %s, %u ms\n", ec_al_state_name(state),
		     ec_al_state_name(from), timeout_ms);
	ret = request(slave, state, until);
	if (!ret)
		ret = poll(slave, EC_AL_STATE_MASK | EC_AL_ERROR, state, true, until);
	ec_slave_dbg_result(slave, ret, "AL status 0x%04x, code 0x%04x",
			    READ_ONCE(slave->al_status), READ_ONCE(slave->al_code));
	if (!ret || ret == -EPROTO)
		WRITE_ONCE(slave->awaited, 0);
	if (ret == -EPROTO) {
		code = READ_ONCE(slave->al_code);
		ec_al_ack(slave);
		WRITE_ONCE(slave->al_code, code);
	}
	return ret;
}
