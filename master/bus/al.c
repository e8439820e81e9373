// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/moduleparam.h>
#include "../base/limits.h"
#include "al.h"
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

static void note_status(struct ec_slave *slave, const u8 *al)
{
	ec_slave_set_al(slave, get_unaligned_le16(al), get_unaligned_le16(al + 4),
			EC_AL_BY_WORKER);
	WRITE_ONCE(slave->al.reads, slave->al.reads + 1);
}

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

	if (!ret)
		note_status(slave, b);
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

/* What the reply @dg means: -EINPROGRESS: poll again. */
static int al_take(struct ec_al_poll *p, const struct ec_dg *dg, const struct ec_al_goal *goal)
{
	u16 status;

	/* also without memory for the frames of many slaves */
	if (dg->err == -ETIMEDOUT || dg->err == -EAGAIN)
		return -EINPROGRESS;
	if (dg->err || dg->wkc != 1)
		return dg->err ?: -EIO;
	note_status(p->slave, p->al);
	status = READ_ONCE(p->slave->al.status);
	if ((status & goal->mask) == goal->value)
		return 0;
	return goal->mask & EC_AL_STATE_MASK && status & EC_AL_ERROR ? -EPROTO : -EINPROGRESS;
}

/* One poll. Return: slaves that have no result after it. */
static unsigned int al_look(struct ec_al_poll *polls, unsigned int n, struct ec_dg *dg,
			    const struct ec_al_goal *goal)
{
	struct ec_links *links = polls[0].slave->bus->links;
	unsigned int i, k = 0, left = 0;

	for (i = 0; i < n; i++)
		if (polls[i].ret == -EINPROGRESS)
			dg[k++] = EC_FPRD(polls[i].slave->station, EC_REG_AL_STATUS,
					  sizeof(polls[i].al), polls[i].al);
	ec_xfer(links, dg, k);
	for (i = 0, k = 0; i < n; i++) {
		if (polls[i].ret != -EINPROGRESS)
			continue;
		polls[i].ret = al_take(&polls[i], &dg[k++], goal);
		left += polls[i].ret == -EINPROGRESS;
	}
	return left;
}

/* Those that must not be polled any more. Return: slaves that have no result after it. */
static unsigned int al_end(struct ec_al_poll *polls, unsigned int n, u64 until_ns)
{
	bool over = ktime_get_ns() > until_ns;
	unsigned int i, left = 0;

	for (i = 0; i < n; i++) {
		if (polls[i].ret != -EINPROGRESS)
			continue;
		if (ec_stop_worker(&polls[i].slave->stop))
			polls[i].ret = -ECANCELED;
		else if (over)
			polls[i].ret = -ETIME;
		else
			left++;
	}
	return left;
}

/**
 * ec_al_poll() - poll slaves together until they show an AL status, or an error instead
 * @polls: slaves, of one bus
 * @n: entries in @polls, 1 at least
 * @dg: memory for as many datagrams
 * @goal: what they are polled for, and how long
 *
 * No slave reports by itself. A lost frame is no result.
 *
 * Context: Process. Waits for bus traffic, until the time limit. Results are in @polls: 0;
 * -EPROTO when a slave shows an error instead of the state; -ETIME; -EIO when it did not answer;
 * -ECANCELED; or as in struct ec_dg.
 */
void ec_al_poll(struct ec_al_poll *polls, unsigned int n, struct ec_dg *dg,
		const struct ec_al_goal *goal)
{
	unsigned int i, us = goal->first_us;

	for (i = 0; i < n; i++)
		polls[i].ret = -EINPROGRESS;
	do {
		if (us)
			usleep_range(us, us + us / 4);
		us = us ? min(us * 2, 2000u) : 50;
	} while (al_look(polls, n, dg, goal) && al_end(polls, n, goal->until_ns));
}

static int poll_one(struct ec_slave *slave, u16 mask, u16 value, u64 until_ns)
{
	const struct ec_al_goal goal = { .mask = mask, .value = value, .until_ns = until_ns };
	struct ec_al_poll p = { .slave = slave };
	struct ec_dg dg;

	ec_al_poll(&p, 1, &dg, &goal);
	return p.ret;
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
	u16 state = READ_ONCE(slave->al.status) & EC_AL_STATE_MASK;
	int ret;

	/*
	 * Device emulation copies AL control, so the acknowledge would show as an error. Another
	 * master may have left one there: the state without it ends it.
	 */
	ret = request(slave, slave->emulation ? state : state | EC_AL_ERROR, until);
	return ret ? ret : poll_one(slave, EC_AL_ERROR, 0, until);
}

/* The request of a tool comes first, then what the application allows. */
static u32 limit_ms(const struct ec_slave *s, u8 from, u8 to, u32 configured_ms)
{
	return READ_ONCE(s->al.limit_ms) ?: configured_ms ?: READ_ONCE(ec_al_timeout) ?:
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
	u8 from = READ_ONCE(slave->al.status) & EC_AL_STATE_MASK;
	u16 code;
	u64 until;
	int ret;

	/* in the new state it may have another dictionary */
	if (from < EC_AL_PREOP || from == EC_AL_BOOT || state < EC_AL_PREOP || state == EC_AL_BOOT)
		ec_dict_forget(&slave->dict);
	timeout_ms = limit_ms(slave, from, state, timeout_ms);
	slave->al.awaited_ms = timeout_ms;
	WRITE_ONCE(slave->al.awaited, state);
	until = ktime_get_ns() + (u64)timeout_ms * NSEC_PER_MSEC;
	ec_slave_dbg(slave, 1, "%s requested, is in %s, %u ms\n", ec_al_state_name(state),
		     ec_al_state_name(from), timeout_ms);
	ret = request(slave, state, until);
	if (!ret)
		ret = poll_one(slave, EC_AL_STATE_MASK | EC_AL_ERROR, state, until);
	ec_slave_dbg_result(slave, ret, "AL status 0x%04x, code 0x%04x",
			    READ_ONCE(slave->al.status), READ_ONCE(slave->al.code));
	if (!ret || ret == -EPROTO)
		WRITE_ONCE(slave->al.awaited, 0);
	if (ret == -EPROTO) {
		code = READ_ONCE(slave->al.code);
		ec_al_ack(slave);
		WRITE_ONCE(slave->al.code, code);
	}
	return ret;
}
