// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "mailbox.h"
#include "voe.h"
#include "../wire/voe.h"

/**
 * ec_voe_write() - send a message; there is no answer
 * @mb: mailbox of the slave
 * @h: header
 * @data: of the vendor
 * @size: bytes
 * @limit: time limits; NULL: the defaults
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EPROTONOSUPPORT without VoE; -EMSGSIZE when it does not fit into
 * the mailbox; -EAGAIN in INIT; -ETIMEDOUT; -EINTR; -ECANCELED; -ENOMEM.
 */
int ec_voe_write(struct ec_mbox *mb, const struct ec_voe_hdr *h, const u8 *data, size_t size,
		 const struct ec_mbox_limit *limit)
{
	struct ec_mbox_limit l = ec_mbox_limit(limit, EC_VOE_TIMEOUT_MS);
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_VOE, EC_VOE_HDR);
	struct ec_wbuf w;
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	w = ec_wbuf(b->tx, ec_mbox_tx_room(mb));
	ec_voe_hdr_encode(&w, h);
	ec_wbuf_bytes(&w, data, size);
	ret = w.bad ? -EMSGSIZE : ec_mbox_send(mb, EC_MBOX_VOE, b, w.p - b->tx, &l);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "VoE write, vendor 0x%08x, type 0x%04x, %zu byte(s)",
			    h->vendor, h->type, size);
	return ret;
}

static int voe_take(const u8 *rx, size_t len, struct ec_voe_hdr *h, u8 *data, size_t cap,
		    size_t *size)
{
	struct ec_rbuf r = ec_rbuf(rx, len);

	if (ec_voe_hdr_decode(&r, h))
		return -EBADMSG;
	if (ec_rbuf_left(&r) > cap)
		return -ENOBUFS;
	*size = ec_rbuf_left(&r);
	memcpy(data, r.p, *size);
	return 0;
}

/**
 * ec_voe_read() - receive a message
 * @mb: mailbox of the slave
 * @blind: read the mailbox once without a poll of its status
 * @h: its header
 * @data: of the vendor
 * @cap: size of @data
 * @size: bytes
 * @limit: time limits; NULL: the defaults
 *
 * The message may have come before, while others used the mailbox; see
 * ec_mbox_keep_voe().
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ENOBUFS when there is more than @cap, then the message is lost;
 * -ENOMSG when @blind and there is none; -ETIMEDOUT; -EBADMSG;
 * -EPROTONOSUPPORT without VoE; -EMSGSIZE; -EAGAIN in INIT; -EINTR; -ECANCELED;
 * -ENOMEM; the errno of a mailbox error reply.
 */
int ec_voe_read(struct ec_mbox *mb, bool blind, struct ec_voe_hdr *h, u8 *data, size_t cap,
		size_t *size, const struct ec_mbox_limit *limit)
{
	struct ec_mbox_limit l = ec_mbox_limit(limit, EC_VOE_TIMEOUT_MS);
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_VOE, EC_VOE_HDR);
	int ret;

	*size = 0;
	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_mbox_wait_voe(mb, b, blind, &l);
	if (ret >= 0)
		ret = voe_take(b->rx, ret, h, data, cap, size);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "VoE read, %zu byte(s)", *size);
	return ret;
}
