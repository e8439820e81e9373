// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "coe.h"
#include "mailbox.h"
#include "../wire/mbox.h"
#include "../wire/sdo.h"

/* the two exchanges behind one loop */
struct exchange {
	bool down;
	union {
		struct ec_sdo_up up;
		struct ec_sdo_down dn;
	};
};

static int tx(struct exchange *x, u8 *buf, size_t cap)
{
	return x->down ? ec_sdo_down_tx(&x->dn, buf, cap) : ec_sdo_up_tx(&x->up, buf, cap);
}

static int rx(void *ctx, const u8 *buf, size_t len)
{
	struct exchange *x = ctx;
	int ret = x->down ? ec_sdo_down_rx(&x->dn, buf, len) : ec_sdo_up_rx(&x->up, buf, len);

	/* the reply is too short; the mailbox is large enough */
	return ret == -EMSGSIZE ? -EBADMSG : ret;
}

static bool send_abort(const struct exchange *x)
{
	return x->down ? x->dn.send_abort : x->up.send_abort;
}

static void tell_abort(struct ec_mbox *mb, struct exchange *x, struct ec_mbox_buf *b,
		       size_t cap, const bool *cancel)
{
	struct ec_mbox_limit limit = { .timeout_ms = 100, .cancel = cancel };
	int len = tx(x, b->tx, cap);

	if (len > 0)
		ec_mbox_tell(mb, EC_MBOX_COE, b, len, &limit);
}

/*
 * Other protocols may use the mailbox between the messages of a transfer, another
 * SDO transfer may not.
 */
static int run(struct ec_mbox *mb, struct exchange *x, const struct ec_mbox_limit *limit)
{
	size_t cap = mb->sii->std.rx_size - EC_MBOX_HDR;
	struct ec_mbox_ask ask = {
		.type = EC_MBOX_COE, .first = true, .rx = rx, .ctx = x,
		.timeout_ms = limit && limit->timeout_ms ? limit->timeout_ms : EC_SDO_TIMEOUT_MS,
		.cancel = limit ? limit->cancel : NULL,
	};
	struct ec_mbox_buf *b;
	int ret;

	b = kmalloc(sizeof(*b), GFP_KERNEL);
	if (!b)
		return -ENOMEM;
	ret = ec_mbox_lock(mb, &mb->sdo_lock, 0);
	if (ret)
		goto out;
	do {
		ret = tx(x, b->tx, cap);
		if (ret >= 0)
			ret = ec_mbox_ask(mb, &ask, b, ret);
		ask.first = false;
	} while (ret == EC_MORE);
	if (send_abort(x))
		tell_abort(mb, x, b, cap, ask.cancel);
	up(&mb->sdo_lock);
out:
	kfree(b);
	return ret;
}

static int check(const struct ec_mbox *mb)
{
	return ec_mbox_check(mb, EC_SII_PROTO_COE, EC_SDO_MSG);
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
	struct exchange x = { .down = false };
	int ret = check(mb);

	*abort = 0;
	*size = 0;
	if (ret)
		return ret;
	ec_sdo_up_init(&x.up, index, sub, complete, data, cap);
	ret = run(mb, &x, limit);
	if (ret == -EIO)
		*abort = x.up.abort;
	if (!ret)
		*size = x.up.size;
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
	struct exchange x = { .down = true };
	int ret = check(mb);

	*abort = 0;
	if (ret)
		return ret;
	ec_sdo_down_init(&x.dn, index, sub, complete, data, size,
			 mb->sii->std.rx_size - EC_MBOX_HDR);
	ret = run(mb, &x, limit);
	if (ret == -EIO)
		*abort = x.dn.abort;
	ec_mbox_dbg_result(mb, ret, "download 0x%04x:%02x, abort 0x%08x, %zu byte(s)", index,
			    sub, *abort, size);
	return ret;
}
