// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "mailbox.h"
#include "soe.h"
#include "../wire/soe.h"

/**
 * ec_soe_idn_text() - an IDN as drive manuals write it
 * @idn: number
 * @buf: for the text
 *
 * Context: Any.
 * Return: @buf, such as "P-0-0150".
 */
const char *ec_soe_idn_text(u16 idn, char buf[12])
{
	scnprintf(buf, 12, "%c-%u-%04u", idn & BIT(15) ? 'P' : 'S', idn >> 12 & 7, idn & 0x0fff);
	return buf;
}

static int soe_rx(void *ctx, const u8 *buf, size_t len)
{
	return ec_soe_rx(ctx, buf, len);
}

static int soe_transfer(struct ec_mbox *mb, struct ec_soe_access *a,
			const struct ec_mbox_limit *limit)
{
	struct ec_mbox_request req = {
		.type = EC_MBOX_SOE, .first = true, .late = true, .rx = soe_rx, .ctx = a,
		.limit = ec_mbox_limit(limit, READ_ONCE(mb->reply_ms) ?: EC_SOE_TIMEOUT_MS),
	};
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_SOE, EC_SOE_HDR);
	struct ec_claim claim = { 0 };
	char name[12];
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = ec_soe_tx(a, b->tx, ec_mbox_tx_room(mb));
	if (ret >= 0) {
		size_t len = ret;

		ret = ec_mbox_claim_for(mb, &claim, EC_MBOX_SOE, &req.limit);
		if (!ret) {
			ret = ec_mbox_request(mb, &req, b, len);
			ec_mbox_unclaim(mb, &claim);
		}
	}
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "%s %s of drive %u, error 0x%04x",
			    a->write ? "write" : "read", ec_soe_idn_text(a->idn, name), a->drive,
			    a->error);
	return ret;
}

/**
 * ec_soe_read() - read the value of an IDN
 * @mb: mailbox of the slave
 * @drive: 0 to 7
 * @idn: number
 * @data: result
 * @cap: size of @data
 * @size: bytes read
 * @error: SoE error code of the slave, or 0
 * @limit: time limits; NULL: the defaults
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO with @error set; -ENOBUFS when the value is larger than @cap;
 * -EPROTONOSUPPORT without SoE; -EMSGSIZE when the value does not fit into one
 * message, or the mailbox into a datagram; -EAGAIN in INIT; -EINVAL for the
 * drive; -EBADMSG for a wrong answer; -ETIMEDOUT; -EINTR; -ECANCELED; -ENOMEM.
 */
int ec_soe_read(struct ec_mbox *mb, u8 drive, u16 idn, u8 *data, size_t cap, size_t *size,
		u16 *error, const struct ec_mbox_limit *limit)
{
	struct ec_soe_access a;
	unsigned int tries = 0;
	int ret;

	do {
		a = (struct ec_soe_access){
			.drive = drive, .element = EC_SOE_VALUE, .idn = idn, .data = data,
			.cap = cap,
		};
		ret = drive < EC_SOE_DRIVES ? soe_transfer(mb, &a, limit) : -EINVAL;
	} while (ret == -ENOTRECOVERABLE && ++tries < EC_MBOX_READ_TRIES);
	ret = ec_mbox_read_result(ret);
	*error = a.error;
	*size = ret ? 0 : a.size;
	return ret;
}

/**
 * ec_soe_write() - write the value of an IDN
 * @mb: mailbox of the slave
 * @drive: 0 to 7
 * @idn: number
 * @data: value
 * @size: bytes
 * @error: SoE error code of the slave, or 0
 * @limit: time limits; NULL: the defaults
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_soe_read(); -ENOTRECOVERABLE when a lost frame leaves the outcome unknown.
 */
int ec_soe_write(struct ec_mbox *mb, u8 drive, u16 idn, const u8 *data, size_t size,
		 u16 *error, const struct ec_mbox_limit *limit)
{
	struct ec_soe_access a = {
		.write = true, .drive = drive, .element = EC_SOE_VALUE, .idn = idn,
		.data = (u8 *)data, .size = size,
	};
	int ret = drive < EC_SOE_DRIVES ? soe_transfer(mb, &a, limit) : -EINVAL;

	*error = a.error;
	return ret;
}
