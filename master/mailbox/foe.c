// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "foe.h"
#include "mailbox.h"
#include "../wire/mbox.h"

#define PAUSE_US	2000	/* before a message is sent again to a slave that is busy */
#define WHOLE_MS	900000	/* for all messages of a file, besides its bytes: an erase, say */

/* a transfer in progress */
struct transfer {
	struct ec_foe *f;
	struct ec_mbox *mb;
	u64 begin_ns;
	u64 busy_ns;	/* since when the slave is busy without progress, 0: it is not */
	u16 done;	/* highest progress since then: only a higher value is progress */
	u64 wait_ns;	/* since when it is busy before the first data, 0: it is not */
};

static int foe_rx(void *ctx, const u8 *buf, size_t len)
{
	struct transfer *t = ctx;
	/* what a message of the slave can hold decides which one is the last */
	size_t room = ec_mbox_room(ec_mbox_area(t->mb)->tx_size);
	int ret = ec_foe_rx(t->f, buf, len, room > EC_FOE_HDR ? room - EC_FOE_HDR : 0);

	/* BUSY before the first data: still the same request, so its limit is here */
	if (ret != EC_WAIT)
		return ret;
	t->wait_ns = t->wait_ns ?: ktime_get_ns();
	return ktime_get_ns() - t->wait_ns > (u64)EC_FOE_BUSY_MS * NSEC_PER_MSEC ? -ETIMEDOUT : ret;
}

/* A slave that is BUSY gets time, but a limited one. */
static int wait_busy(struct transfer *t)
{
	u64 now = ktime_get_ns();

	if (!t->f->busy) {
		t->busy_ns = 0;
		return 0;
	}
	if (!t->busy_ns || t->f->done > t->done) {
		t->busy_ns = now;
		t->done = t->f->done;
	}
	if (now - t->busy_ns > (u64)EC_FOE_BUSY_MS * NSEC_PER_MSEC)
		return -ETIMEDOUT;
	usleep_range(PAUSE_US, PAUSE_US + PAUSE_US / 4);
	return 0;
}

/* Store data of a read; -ENOBUFS: the file is too large. */
static int foe_take(const struct ec_foe *f, const struct ec_foe_file *file, struct ec_mbox_buf *b)
{
	if (f->size > file->size)
		return -ENOBUFS;
	return f->n ? file->copy(file->ctx, f->at, b->rx + EC_FOE_HDR, f->n) : 0;
}

/* One message and its answer: EC_MORE, 0 or -errno. */
static int foe_step(struct transfer *t, const struct ec_foe_file *file, struct ec_mbox_request *req,
		    struct ec_mbox_buf *b)
{
	struct ec_foe *f = t->f;
	int len = ec_foe_tx(f, b->tx, ec_mbox_room(ec_mbox_area(t->mb)->rx_size)), ret;

	if (len < 0)
		return len;
	if (f->write && f->begun && f->n) {
		ret = file->copy(file->ctx, f->at, b->tx + EC_FOE_HDR, f->n);
		if (ret)
			return ret;
	}
	/* the acknowledgement of the last data has no answer */
	if (!f->write && f->last) {
		ret = ec_mbox_send(t->mb, EC_MBOX_FOE, b, len, &req->limit);
		/* the file is complete, even if the slave did not get this */
		return ret == -ENOTRECOVERABLE ? 0 : ret;
	}
	req->limit.end_ns = ec_mbox_end_ns(t->begin_ns, WHOLE_MS, f->write ? f->at : f->size);
	ret = ec_mbox_request(t->mb, req, b, len);
	req->first = false;
	if (ret < 0)
		return ret;
	if (!f->write && !f->busy)
		ret = foe_take(f, file, b) ?: ret;
	if (file->progress && !f->busy)
		file->progress(file->ctx, f->write ? ret ? f->at : f->size : f->size);
	return ret;
}

/* Report to a slave in the middle of a file that the transfer ends. */
static void end_at_slave(struct transfer *t, struct ec_mbox_buf *b)
{
	int len = ec_foe_error_encode(b->tx, ec_mbox_room(ec_mbox_area(t->mb)->rx_size),
				      EC_FOE_ERR_UNDEFINED, "ended by the master");

	if (len > 0)
		ec_mbox_send_last(t->mb, EC_MBOX_FOE, b, len);
}

/**
 * ec_foe_writes() - is a file written to the slave?
 * @mb: mailbox of the slave
 *
 * It may be firmware, and without the rest of it the slave has none.
 *
 * Context: Any.
 * Return: true while it is.
 */
bool ec_foe_writes(const struct ec_mbox *mb)
{
	return test_bit(EC_MBOX_FILE_WRITE, &mb->flags);
}

/* To the log, since the caller may have been killed by a shutdown, and reports nothing. */
static void report_end(const struct ec_mbox *mb, const struct ec_foe *f, int ret)
{
	if (f->write && (ret == -EINTR || ret == -ECANCELED))
		ec_mbox_warn(mb, "FoE write of '%*pE' ended early (%pe) after %llu of %llu bytes; write the file again, since firmware may be incomplete\n",
			     (int)f->name_len, f->name, ERR_PTR(ret), f->at, f->size);
}

/**
 * ec_foe_transfer() - read or write a file of a slave
 * @mb: mailbox of the slave
 * @f: transfer: direction, name, password; result: progress and error
 * @file: where the data are
 * @limit: time limits; NULL: the defaults
 *
 * Other protocols may use the mailbox between the messages. In BOOT the bootstrap mailbox is
 * used. A transfer that ends early is ended at the slave as well.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EREMOTEIO when the slave refuses, with @f->error; -EINPROGRESS while another file
 * of this slave is transferred; -ENOBUFS for a file larger than @file->size; -EPROTONOSUPPORT
 * without FoE; -EMSGSIZE for a mailbox that is too small; -EAGAIN in INIT; -EBADMSG for a wrong
 * answer; -ETIMEDOUT; -ENOTRECOVERABLE when a lost frame ends a write; -EINTR; -ECANCELED;
 * -ENOMEM; what @file->copy returned.
 */
int ec_foe_transfer(struct ec_mbox *mb, struct ec_foe *f, const struct ec_foe_file *file,
		    const struct ec_mbox_limit *limit)
{
	struct transfer t = { .f = f, .mb = mb };
	struct ec_mbox_request req = {
		.type = EC_MBOX_FOE, .first = true, .rx = foe_rx, .ctx = &t,
		.limit = ec_mbox_limit(limit, EC_FOE_TIMEOUT_MS),
	};
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_FOE, EC_FOE_HDR + 1);
	struct ec_claim claim = { 0 };
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	if (test_and_set_bit(EC_MBOX_FILE, &mb->flags)) {
		kfree(b);
		return -EINPROGRESS;
	}
	if (f->write)
		f->size = file->size;
	ret = ec_mbox_claim_for(mb, &claim, EC_MBOX_FOE, &req.limit);
	if (ret)
		goto out;
	t.begin_ns = ktime_get_ns();
	if (f->write)
		set_bit(EC_MBOX_FILE_WRITE, &mb->flags);
	do {
		ret = wait_busy(&t) ?: foe_step(&t, file, &req, b);
	} while (ret == EC_MORE);
	if (!f->write)
		ret = ec_mbox_read_result(ret);
	if (ret && ret != -EREMOTEIO && !req.first) {
		end_at_slave(&t, b);
		report_end(mb, f, ret);
	}
	clear_bit(EC_MBOX_FILE_WRITE, &mb->flags);
	ec_mbox_unclaim(mb, &claim);
out:
	clear_bit_unlock(EC_MBOX_FILE, &mb->flags);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "FoE %s '%*pE', error 0x%08x, %llu byte(s)",
			   f->write ? "write" : "read", (int)f->name_len, f->name, f->error,
			   f->size);
	return ret;
}
