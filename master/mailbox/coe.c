// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "coe.h"
#include "mailbox.h"
#include "../wire/mbox.h"
#include "../wire/sdo.h"

static int rx(void *ctx, const u8 *buf, size_t len)
{
	int ret = ec_sdo_rx(ctx, buf, len);

	/* the reply is too short; the mailbox is large enough */
	return ret == -EMSGSIZE ? -EBADMSG : ret;
}

static void send_abort(struct ec_mbox *mb, struct ec_sdo *s, struct ec_mbox_buf *b, size_t cap,
		       const bool *cancel)
{
	struct ec_mbox_limit limit = { .timeout_ms = 100, .cancel = cancel };
	int len = ec_sdo_tx(s, b->tx, cap);

	if (len > 0)
		ec_mbox_send(mb, EC_MBOX_COE, b, len, &limit);
}

/*
 * Other protocols may use the mailbox between the messages of a transfer, another
 * SDO transfer may not.
 */
static int run(struct ec_mbox *mb, struct ec_sdo *s, const struct ec_mbox_limit *limit)
{
	size_t cap = mb->sii->std.rx_size - EC_MBOX_HDR;
	struct ec_mbox_request req = {
		.type = EC_MBOX_COE, .first = true, .rx = rx, .ctx = s,
		.limit = ec_mbox_limit(limit, EC_SDO_TIMEOUT_MS),
	};
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_COE, EC_SDO_MSG);
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_mbox_lock(mb, &mb->sdo_lock, 0);
	if (ret)
		goto out;
	do {
		ret = ec_sdo_tx(s, b->tx, cap);
		if (ret >= 0)
			ret = ec_mbox_request(mb, &req, b, ret);
		req.first = false;
	} while (ret == EC_MORE);
	if (s->send_abort)
		send_abort(mb, s, b, cap, req.limit.cancel);
	up(&mb->sdo_lock);
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
 * @cap: room at @data
 * @size: bytes read
 * @abort: abort code of the slave, or 0
 * @limit: when to give up; NULL: as usual
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
	struct ec_sdo s;
	int ret;

	*abort = 0;
	*size = 0;
	ec_sdo_upload_init(&s, index, sub, complete, data, cap);
	ret = run(mb, &s, limit);
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
 * @limit: when to give up; NULL: as usual
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_coe_upload().
 */
int ec_coe_download(struct ec_mbox *mb, u16 index, u8 sub, bool complete, const u8 *data,
		    size_t size, u32 *abort, const struct ec_mbox_limit *limit)
{
	struct ec_sdo s;
	int ret;

	*abort = 0;
	ec_sdo_download_init(&s, index, sub, complete, data, size,
			     mb->sii->std.rx_size - EC_MBOX_HDR);
	ret = run(mb, &s, limit);
	if (ret == -EIO)
		*abort = s.abort;
	ec_mbox_dbg_result(mb, ret, "download 0x%04x:%02x, abort 0x%08x, %zu byte(s)", index,
			    sub, *abort, size);
	return ret;
}
