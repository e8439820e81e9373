// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/slab.h>
#include "coe.h"
#include "mailbox.h"
#include "../wire/mbox.h"
#include "../wire/sdo.h"
#include "../wire/sdoinfo.h"

#define INFO_MS	30000	/* for all fragments of one answer */
#define WHOLE_MS	60000	/* for all messages of an SDO transfer, besides its bytes */

/* The reply is too short; the mailbox is large enough. */
static int rx_result(int ret)
{
	return ret == -EMSGSIZE ? -EBADMSG : ret;
}

static int coe_rx(void *ctx, const u8 *buf, size_t len)
{
	return rx_result(ec_sdo_rx(ctx, buf, len));
}

static void send_abort(struct ec_mbox *mb, struct ec_sdo *s, struct ec_mbox_buf *b, size_t cap)
{
	int len = ec_sdo_tx(s, b->tx, cap);

	if (len > 0)
		ec_mbox_send_last(mb, EC_MBOX_COE, b, len);
}

static size_t moved(const struct ec_sdo *s)
{
	return s->down ? s->sent : s->size;
}

/*
 * Other protocols may use the mailbox between the messages of a transfer, another
 * SDO transfer may not.
 */
static int coe_run(struct ec_mbox *mb, struct ec_sdo *s, const struct ec_mbox_limit *limit)
{
	size_t cap = ec_mbox_tx_room(mb);
	struct ec_mbox_request req = {
		.type = EC_MBOX_COE, .first = true, .late = true, .rx = coe_rx, .ctx = s,
		.limit = ec_mbox_limit(limit, READ_ONCE(mb->reply_ms) ?: EC_SDO_TIMEOUT_MS),
	};
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_COE, EC_SDO_MSG);
	u64 begin, end = req.limit.end_ns ?: U64_MAX;
	struct ec_claim claim = { 0 };
	u32 whole = WHOLE_MS + req.limit.timeout_ms;
	u32 abort;
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_mbox_claim_for(mb, &claim, EC_MBOX_COE, &req.limit);
	if (ret)
		goto out;
	begin = ktime_get_ns();
	do {
		req.limit.end_ns = min(end, ec_mbox_end_ns(begin, whole, moved(s)));
		ret = ec_sdo_tx(s, b->tx, cap);
		if (ret >= 0)
			ret = ec_mbox_request(mb, &req, b, ret);
		req.first = false;
	} while (ret == EC_MORE);
	/* the code of an abort by the master is not reported as one of the slave */
	abort = s->abort;
	if (ret)
		ec_sdo_cancel(s);
	if (s->send_abort) {
		send_abort(mb, s, b, cap);
		ec_mbox_forget_late(mb, BIT(EC_MBOX_COE));
	}
	s->abort = abort;
	ec_mbox_unclaim(mb, &claim);
out:
	kfree(b);
	return ret;
}

/**
 * ec_coe_upload() - read an object
 * @mb: mailbox of the slave
 * @index: object
 * @sub: subindex
 * @complete: complete access
 * @data: result
 * @cap: size of @data
 * @size: bytes read
 * @abort: abort code of the slave, or 0
 * @limit: time limits; NULL: the defaults
 *
 * Repeated when a lost frame leaves it without an answer.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO with @abort set; -ENOBUFS when the object is larger than
 * @cap; -EPROTONOSUPPORT without CoE; -EMSGSIZE for a mailbox that is too small
 * or larger than a datagram; -EAGAIN in INIT; -EPROTO, -EBADMSG for a wrong
 * answer; -ETIMEDOUT; -EINTR; -ECANCELED; -ENOMEM.
 */
int ec_coe_upload(struct ec_mbox *mb, u16 index, u8 sub, bool complete, u8 *data, size_t cap,
		  size_t *size, u32 *abort, const struct ec_mbox_limit *limit)
{
	unsigned int tries = 0;
	struct ec_sdo s;
	int ret;

	*abort = 0;
	*size = 0;
	do {
		ec_sdo_upload_init(&s, index, sub, complete, data, cap);
		ret = coe_run(mb, &s, limit);
	} while (ret == -ENOTRECOVERABLE && ++tries < EC_MBOX_READ_TRIES);
	ret = ec_mbox_read_result(ret);
	if (ret == -EIO)
		*abort = s.abort;
	if (!ret)
		*size = s.size;
	ec_mbox_dbg_result(mb, ret, "upload 0x%04x:%02x, abort 0x%08x, %zu byte(s)", index,
			    sub, *abort, *size);
	return ret;
}

/**
 * ec_coe_download() - write an object
 * @mb: mailbox of the slave
 * @index: object
 * @sub: subindex
 * @complete: complete access
 * @data: value
 * @size: bytes
 * @abort: abort code of the slave, or 0
 * @limit: time limits; NULL: the defaults
 *
 * Never repeated: the slave may have written the value.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_coe_upload(); -ENOTRECOVERABLE when a lost frame leaves the outcome unknown.
 */
int ec_coe_download(struct ec_mbox *mb, u16 index, u8 sub, bool complete, const u8 *data,
		    size_t size, u32 *abort, const struct ec_mbox_limit *limit)
{
	struct ec_sdo s;
	int ret;

	*abort = 0;
	ec_sdo_download_init(&s, index, sub, complete, data, size,
			     ec_mbox_tx_room(mb));
	ret = coe_run(mb, &s, limit);
	if (ret == -EIO)
		*abort = s.abort;
	ec_mbox_dbg_result(mb, ret, "download 0x%04x:%02x, abort 0x%08x, %zu byte(s)", index,
			    sub, *abort, size);
	return ret;
}

/* a request for SDO information */
struct ask {
	struct ec_sdoinfo *info;
	u64 until_ns;
};

static int info_rx(void *ctx, const u8 *buf, size_t len)
{
	struct ask *a = ctx;

	/* fragments may come without end */
	if (ktime_get_ns() > a->until_ns)
		return -ETIMEDOUT;
	return rx_result(ec_sdoinfo_rx(a->info, buf, len));
}

/**
 * ec_coe_ask() - one request for SDO information
 * @mb: mailbox of the slave, CoE claimed
 * @info: request, and its answer
 * @until_ns: limit for the last fragment (ktime)
 * @limit: for each fragment
 * @b: buffers
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_coe_info().
 */
int ec_coe_ask(struct ec_mbox *mb, struct ec_sdoinfo *info, u64 until_ns,
	       const struct ec_mbox_limit *limit, struct ec_mbox_buf *b)
{
	struct ask a = { .info = info, .until_ns = until_ns };
	struct ec_mbox_request req = {
		.type = EC_MBOX_COE, .first = true, .limit = *limit, .rx = info_rx, .ctx = &a,
	};
	unsigned int tries = 0;
	const struct ec_sdoinfo again = *info;
	int len, ret;

	do {
		*info = again;
		len = ec_sdoinfo_tx(info, b->tx, ec_mbox_tx_room(mb));
		ret = len < 0 ? len : ec_mbox_request(mb, &req, b, len);
	} while (ret == -ENOTRECOVERABLE && ++tries < EC_MBOX_READ_TRIES &&
		 ktime_get_ns() < until_ns);
	return ec_mbox_read_result(ret);
}

/**
 * ec_coe_info() - read from the object dictionary of a slave
 * @mb: mailbox of the slave
 * @info: request, of ec_sdoinfo_init(), and its answer
 * @limit: time limits; NULL: the defaults
 *
 * SDO information (ETG.1000.6 clause 5.6.3). SDO transfers wait meanwhile.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO with @info->abort set; -ENOBUFS for an answer larger than its buffer;
 * otherwise as ec_coe_upload().
 */
int ec_coe_info(struct ec_mbox *mb, struct ec_sdoinfo *info, const struct ec_mbox_limit *limit)
{
	struct ec_mbox_limit l = ec_mbox_limit(limit, EC_SDOINFO_TIMEOUT_MS);
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_COE, EC_SDOINFO_MIN);
	struct ec_claim claim = { 0 };
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_mbox_claim_for(mb, &claim, EC_MBOX_COE, &l);
	if (!ret) {
		ret = ec_coe_ask(mb, info, ktime_get_ns() + INFO_MS * (u64)NSEC_PER_MSEC, &l, b);
		ec_mbox_unclaim(mb, &claim);
	}
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "SDO information %u of 0x%04x:%02x, error 0x%08x, %zu byte(s)",
			    info->opcode, info->index, info->sub, info->abort, info->size);
	return ret;
}
