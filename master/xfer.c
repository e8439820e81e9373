// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "cycle.h"
#include "master.h"
#include "xfer.h"

#define TRIES	4	/* of a repeatable datagram */

/* one frame of a batch: the slot and the datagrams it carries */
struct batch_frame {
	struct ec_slot *slot;
	unsigned int first;
	unsigned int count;
	int err;
};

/**
 * ec_xfer_done() - one frame of a waiting caller is accounted for
 * @x: the caller's
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_xfer_done(struct ec_xfer *x)
{
	if (atomic_dec_and_test(&x->pending))
		complete(&x->done);
}

/* pack datagrams from @first on; datagrams already answered are left out */
static void build(struct ec_master *m, struct batch_frame *bf, struct ec_dg *dg,
		  unsigned int first, unsigned int n)
{
	struct ec_slot *slot = bf->slot;
	struct ec_frame_buf fb;
	unsigned int i;

	ec_frame_begin(&fb, ec_slot_body(slot), EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	for (i = first; i < n && fb.count < m->max_datagrams; i++) {
		u8 *p;

		if (dg[i].err != -EINPROGRESS)
			continue;
		p = ec_frame_add(&fb, dg[i].cmd, slot->index, dg[i].adp, dg[i].ado, dg[i].len);
		if (!p)
			break;
		if (ec_cmd_writes(dg[i].cmd) || dg[i].cmd == EC_CMD_NOP)
			memcpy(p, dg[i].data, dg[i].len);
		else
			memset(p, 0, dg[i].len);
	}
	bf->first = first;
	bf->count = i - first;
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
}

static void collect(struct batch_frame *bf, struct ec_dg *dg)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	unsigned int i;

	if (bf->err) {
		for (i = bf->first; i < bf->first + bf->count; i++)
			if (dg[i].err == -EINPROGRESS)
				dg[i].err = bf->err;
		return;
	}
	/* checked against what was sent when it was matched */
	ec_frame_iter_init(&it, ec_slot_body(bf->slot), bf->slot->eth_len - EC_ETH_HDR);
	for (i = bf->first; i < bf->first + bf->count; i++) {
		if (dg[i].err != -EINPROGRESS)
			continue;
		if (ec_frame_iter_next(&it, &d) != 1) {
			dg[i].err = -EIO;
			continue;
		}
		dg[i].wkc = ec_dgram_wkc(&d);
		dg[i].back = d.adp;
		if (ec_cmd_reads(d.cmd))
			memcpy(dg[i].data, d.data, d.len);
		dg[i].err = 0;
	}
}

/* Waits for a free slot when all are in use by others; bounded. */
static struct ec_slot *get_slot(struct ec_master *m, bool wait)
{
	u64 until = ktime_get_ns() + EC_QUARANTINE_NS * 2;
	struct ec_slot *slot;

	for (;;) {
		slot = ec_slot_get(&m->slots, false, ktime_get_ns());
		if (slot || !wait || ktime_get_ns() > until)
			return slot;
		usleep_range(100, 200);
	}
}

/* send a window of frames and wait for all of them */
static unsigned int window(struct ec_master *m, struct ec_dg *dg, unsigned int first,
			   unsigned int n, struct batch_frame *bf)
{
	struct ec_xfer x;
	unsigned int i, frames = 0;

	init_completion(&x.done);
	atomic_set(&x.pending, 1);
	while (first < n && frames < EC_XFER_WINDOW) {
		struct batch_frame *f = &bf[frames];

		f->slot = get_slot(m, !frames);
		if (!f->slot)
			break;
		f->err = 0;
		build(m, f, dg, first, n);
		first += f->count;
		f->slot->xfer = &x;
		atomic_inc(&x.pending);
		frames++;
		if (f->slot->eth_len == EC_ETH_HDR + EC_FRAME_HDR)
			f->err = -ENODATA;	/* only answered ones were left */
		else
			f->err = ec_cycle_submit(m, f->slot);
		if (f->err)
			ec_xfer_done(&x);
	}
	ec_xfer_done(&x);
	if (!frames) {
		for (i = first; i < n; i++)
			if (dg[i].err == -EINPROGRESS)
				dg[i].err = -EBUSY;
		return n;
	}

	if (!wait_for_completion_timeout(&x.done, usecs_to_jiffies(ec_cycle_timeout_us(m)) + 1)) {
		for (i = 0; i < frames; i++) {
			if (bf[i].err || !ec_slot_cancel(bf[i].slot, ktime_get_ns()))
				continue;
			atomic64_inc(&m->link[0].stats.lost);
			bf[i].err = -ETIMEDOUT;
			ec_xfer_done(&x);
		}
		/* the rest is being copied at this moment */
		wait_for_completion(&x.done);
	}
	for (i = 0; i < frames; i++) {
		collect(&bf[i], dg);
		ec_slot_put(&m->slots, bf[i].slot, false);
	}
	return first;
}

/**
 * ec_xfer() - exchange a batch of datagrams
 * @m: master
 * @dg: datagrams; results are in them
 * @n: how many; they are packed into as few frames as fit
 *
 * Repeatable datagrams are sent again when their frame is lost, others never.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 when every datagram came back (whatever its working counter), or
 * the error of the first that did not; -EMSGSIZE when one fits no frame, then
 * nothing was sent.
 */
int ec_xfer(struct ec_master *m, struct ec_dg *dg, unsigned int n)
{
	struct batch_frame *bf;
	unsigned int i, try, again;
	int ret = 0;

	for (i = 0; i < n; i++) {
		if (dg[i].len > EC_DGRAM_DATA_MAX)
			return -EMSGSIZE;
		dg[i].err = -EINPROGRESS;
	}
	bf = kmalloc_array(EC_XFER_WINDOW, sizeof(*bf), GFP_KERNEL);
	if (!bf)
		return -ENOMEM;
	for (try = 0; try < TRIES; try++) {
		for (i = 0; i < n;)
			i = window(m, dg, i, n, bf);
		for (i = 0, again = 0; i < n; i++) {
			if (dg[i].err == -ETIMEDOUT && dg[i].repeat && try < TRIES - 1) {
				dg[i].err = -EINPROGRESS;
				again++;
			}
		}
		if (!again)
			break;
	}
	kfree(bf);
	for (i = 0; i < n && !ret; i++)
		ret = dg[i].err;
	return ret;
}

/**
 * ec_xfer_one() - exchange one repeatable datagram
 * @m: master
 * @cmd: enum ec_cmd
 * @adp: low half of the address
 * @ado: high half of the address
 * @data: data, sent or filled by @cmd
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: working counter, or -errno as in struct ec_dg.
 */
int ec_xfer_one(struct ec_master *m, u8 cmd, u16 adp, u16 ado, void *data, u16 len)
{
	struct ec_dg dg = EC_DG(cmd, adp, ado, len, data);
	int ret = ec_xfer(m, &dg, 1);

	return ret ? ret : dg.wkc;
}

/**
 * ec_xfer_fprd() - read registers of one slave
 * @m: master
 * @station: station address
 * @ado: register
 * @data: result
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not take part, or as ec_xfer().
 */
int ec_xfer_fprd(struct ec_master *m, u16 station, u16 ado, void *data, u16 len)
{
	int ret = ec_xfer_one(m, EC_CMD_FPRD, station, ado, data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}

/**
 * ec_xfer_fpwr() - write registers of one slave; may be executed twice
 * @m: master
 * @station: station address
 * @ado: register
 * @data: value
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not take part, or as ec_xfer().
 */
int ec_xfer_fpwr(struct ec_master *m, u16 station, u16 ado, const void *data, u16 len)
{
	int ret = ec_xfer_one(m, EC_CMD_FPWR, station, ado, (void *)data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}
