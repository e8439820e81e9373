// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include "emerg.h"
#include "mailbox.h"
#include "master.h"
#include "slave.h"
#include "wire/coe.h"
#include "wire/mbox.h"
#include "xfer.h"

/* Why an exchange has to end now; 0: go on. */
static int over(const struct ec_slave *slave, u64 until_ns)
{
	if (slave->gone || slave->master->stopping || READ_ONCE(slave->interrupt))
		return -ECANCELED;
	if (signal_pending(current))
		return -EINTR;
	return ktime_get_ns() > until_ns ? -ETIMEDOUT : 0;
}

/* Short waits first: most slaves answer within a few hundred microseconds. */
static void pause_us(unsigned int *us)
{
	usleep_range(*us, *us + *us / 4 + 1);
	*us = min(*us * 2, 1000u);
}

/* One access that must not happen twice: 0, -EIO when the slave took no part... */
static int once(struct ec_slave *slave, u8 cmd, u16 ado, void *data, u16 len)
{
	struct ec_dg dg = EC_DG(cmd, slave->station, ado, len, data);
	int ret;

	dg.repeat = false;
	ret = ec_xfer(slave->master, &dg, 1);
	return ret ? ret : dg.wkc == 1 ? 0 : -EIO;
}

/**
 * ec_mbox_send() - write one message to the slave's mailbox
 * @slave: slave with mailbox, @mbox_lock held
 * @type: enum ec_mbox_type
 * @b: message in @tx
 * @len: bytes of the message
 * @until_ns: when to give up (ktime)
 *
 * A full mailbox (working counter 0) is tried again. A lost frame is not: the
 * message may have arrived, and the answer tells.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED, or as ec_xfer().
 */
int ec_mbox_send(struct ec_slave *slave, u8 type, struct ec_mbox_buf *b, size_t len,
		 u64 until_ns)
{
	u16 size = slave->info.std.rx_size;
	struct ec_mbox_hdr h = { .len = len, .type = type };
	struct ec_wbuf w;
	unsigned int us = 50;
	int ret;

	if (size > EC_MBOX_MAX || len + EC_MBOX_HDR > size)
		return -EMSGSIZE;
	slave->mbox_counter = ec_mbox_next_counter(slave->mbox_counter);
	h.counter = slave->mbox_counter;
	w = ec_wbuf(b->raw, size);
	ec_mbox_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, b->tx, len);
	ec_wbuf_zero(&w, w.end - w.p);

	for (;;) {
		ret = once(slave, EC_CMD_FPWR, slave->info.std.rx_offset, b->raw, size);
		if (ret != -EIO)
			return ret == -ETIMEDOUT ? 0 : ret;
		ret = over(slave, until_ns);
		if (ret)
			return ret;
		pause_us(&us);
	}
}

static int full(struct ec_slave *slave)
{
	u8 status;
	int ret = ec_xfer_fprd(slave->master, slave->station, EC_REG_SM(1) + EC_SM_OFS_STATUS,
			       &status, 1);

	return ret ? ret : !!(status & EC_SM_ST_FULL);
}

/*
 * The frame that fetched a message is lost, and with it the message: let the
 * slave put it there again (ETG.1000.4 clause 6.7.3, registers 0x080E, 0x080F).
 */
static int repeat_request(struct ec_slave *slave)
{
	u16 ado = EC_REG_SM(1) + EC_SM_OFS_ACTIVATE;
	unsigned int i;
	u8 b[2];
	int ret = ec_xfer_fprd(slave->master, slave->station, ado, b, 2);

	if (ret)
		return ret;
	b[0] ^= EC_SM_ACT_REPEAT;
	ret = ec_xfer_fpwr(slave->master, slave->station, ado, b, 1);
	for (i = 0; i < 50 && !ret; i++) {
		ret = ec_xfer_fprd(slave->master, slave->station, ado, b, 2);
		if (!ret && !(b[0] & EC_SM_ACT_REPEAT) == !(b[1] & EC_SM_PDI_REPEAT_ACK))
			return 0;
		usleep_range(200, 400);
	}
	return ret ?: -ETIMEDOUT;
}

/* Take one message out of the slave's mailbox: bytes behind the header, or 0: empty. */
static int fetch(struct ec_slave *slave, struct ec_mbox_buf *b, struct ec_mbox_hdr *h)
{
	u16 size = slave->info.std.tx_size;
	struct ec_rbuf r;
	int ret;

	if (size > EC_MBOX_MAX)
		return -EMSGSIZE;
	ret = full(slave);
	if (ret <= 0)
		return ret;
	ret = once(slave, EC_CMD_FPRD, slave->info.std.tx_offset, b->raw, size);
	if (ret == -ETIMEDOUT && !full(slave))
		repeat_request(slave);
	if (ret)
		return ret == -EIO || ret == -ETIMEDOUT ? 0 : ret;
	r = ec_rbuf(b->raw, size);
	ret = ec_mbox_hdr_decode(&r, h);
	if (ret)
		return ret;
	memcpy(b->rx, r.p, h->len);
	return h->len;
}

static bool emergency(struct ec_slave *slave, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_coe_emergency e;

	if (h->type != EC_MBOX_COE || ec_coe_emergency_decode(rx, h->len, &e))
		return false;
	if (printk_ratelimit())
		ec_slave_warn(slave, "emergency 0x%04x, error register 0x%02x\n",
			      e.code, e.reg);
	ec_emerg_push(slave, rx + EC_COE_HDR);
	return true;
}

/**
 * ec_mbox_drain() - empty the mailbox of what nobody waits for
 * @slave: slave with mailbox, @mbox_lock held
 * @b: buffers
 *
 * Emergencies are kept, what an earlier exchange has left is thrown away.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or as ec_xfer().
 */
int ec_mbox_drain(struct ec_slave *slave, struct ec_mbox_buf *b)
{
	struct ec_mbox_hdr h;
	unsigned int i;
	int ret = 1;

	for (i = 0; i < 16 && ret; i++) {
		ret = fetch(slave, b, &h);
		if (ret < 0 && ret != -EBADMSG && ret != -EMSGSIZE)
			return ret;
		if (ret > 0)
			emergency(slave, &h, b->rx);
	}
	return 0;
}

/**
 * ec_mbox_recv() - wait for a message of one protocol
 * @slave: slave with mailbox, @mbox_lock held
 * @type: enum ec_mbox_type
 * @b: the message is in @rx
 * @until_ns: when to give up (ktime)
 *
 * Emergencies are logged and skipped, messages of other protocols dropped.
 *
 * Context: Process. Waits for bus traffic.
 * Return: bytes behind the mailbox header; -ETIMEDOUT; -EBADMSG for a message
 * whose header is wrong; -EINTR; -ECANCELED; the errno of a mailbox error
 * reply; or as ec_xfer().
 */
int ec_mbox_recv(struct ec_slave *slave, u8 type, struct ec_mbox_buf *b, u64 until_ns)
{
	struct ec_mbox_hdr h;
	unsigned int us = 20;
	u16 detail;
	int ret;

	for (;;) {
		ret = fetch(slave, b, &h);
		if (ret < 0 && ret != -ETIMEDOUT)
			return ret;
		if (ret > 0) {
			if (h.type == EC_MBOX_ERR) {
				struct ec_rbuf r = ec_rbuf(b->rx, h.len);

				if (ec_mbox_error_decode(&r, &detail))
					return -EBADMSG;
				ec_slave_warn(slave, "mailbox error 0x%04x: %s\n", detail,
					      ec_mbox_error_text(detail));
				return ec_mbox_error_errno(detail);
			}
			if (h.type == type && !emergency(slave, &h, b->rx))
				return ret;
			us = 20;
		}
		/* also a slave that talks without end has to answer in time */
		ret = over(slave, until_ns);
		if (ret)
			return ret;
		pause_us(&us);
	}
}
