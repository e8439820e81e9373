// SPDX-License-Identifier: GPL-2.0-only
/* Accesses to elements of IDNs, in fragments where the mailbox is smaller than the data. */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "caller.h"
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

/* one access in progress; @end_ns: limit of the caller, or 0 */
struct soe_transfer {
	struct ec_soe_access *a;
	struct ec_mbox *mb;
	struct ec_mbox_request req;
	u64 begin_ns;
	u64 end_ns;
};

/* From the first fragment on: the longer it lasts, the more data it has to have moved. */
static void set_end(struct soe_transfer *t)
{
	u32 ms = t->req.limit.timeout_ms + EC_MBOX_LATE_MS;

	if (t->a->at)
		t->req.limit.end_ns = min_not_zero(t->end_ns,
						   ec_mbox_end_ns(t->begin_ns, ms, t->a->at));
}

static int soe_rx(void *ctx, const u8 *buf, size_t len)
{
	struct soe_transfer *t = ctx;
	int ret = ec_soe_rx(t->a, buf, len);

	set_end(t);
	return ret;
}

/* A slave may refuse a value before it has all fragments. 0: it has not. */
static int take_early(struct soe_transfer *t, struct ec_mbox_user *u)
{
	int ret;

	/* pairs with desk_finish(): the result is complete */
	if (smp_load_acquire(&u->phase) != EC_MBOX_USER_DONE)
		return 0;
	ret = u->err;
	if (!ret)
		ret = u->got_type == EC_MBOX_ERR ? ec_mbox_error_reply(t->mb, u->rx, u->got) :
						   soe_rx(t, u->rx, u->got);
	if (ret != EC_STALE)
		return ret;
	ec_desk_wait_on(t->mb, u);
	return 0;
}

/* Fragments up to the last one, which is in @b then. Return: its bytes, or -errno. */
static int send_fragments(struct soe_transfer *t, struct ec_mbox_buf *b)
{
	struct ec_caller early = { .user = { .type = EC_MBOX_SOE, .rx = b->rx } };
	bool entered = false;
	int ret, len;

	for (;;) {
		set_end(t);
		len = ec_soe_tx(t->a, b->tx, ec_mbox_tx_room(t->mb));
		if (len < 0 || ec_soe_awaits(t->a))
			break;
		ret = ec_mbox_send_part(t->mb, &t->req, b, len);
		if (!ret && !entered) {
			/* what the slave had sent before the first one is no answer */
			ec_caller_enter(t->mb, &early);
			entered = true;
		}
		ret = ret ?: take_early(t, &early.user);
		if (ret) {
			len = ret;
			break;
		}
		t->req.first = false;
	}
	if (entered)
		ec_desk_leave(t->mb, &early.user, false);
	return len;
}

static int soe_exchange(struct soe_transfer *t, struct ec_mbox_buf *b)
{
	struct ec_claim claim = { 0 };
	int ret = ec_mbox_claim_for(t->mb, &claim, EC_MBOX_SOE, &t->req.limit);

	if (ret)
		return ret;
	t->begin_ns = ktime_get_ns();
	t->end_ns = t->req.limit.end_ns;
	ret = send_fragments(t, b);
	if (ret >= 0)
		ret = ec_mbox_request(t->mb, &t->req, b, ret);
	ec_mbox_unclaim(t->mb, &claim);
	/* the slave sends fragments of an answer that is of no use without end: no second try */
	if (ret == -ETIMEDOUT && t->a->wrong)
		return t->a->wrong == -EPROTO ? -EBADMSG : t->a->wrong;
	return ret;
}

static int soe_try(struct ec_mbox *mb, struct ec_soe_access *a, const struct ec_mbox_limit *limit)
{
	struct soe_transfer t = {
		.a = a, .mb = mb,
		.req = {
			.type = EC_MBOX_SOE, .first = true, .late = true, .rx = soe_rx, .ctx = &t,
			.limit = ec_mbox_limit(limit, READ_ONCE(mb->reply_ms) ?: EC_SOE_TIMEOUT_MS),
		},
	};
	struct ec_mbox_buf *b = ec_mbox_alloc(mb, EC_SII_PROTO_SOE, EC_SOE_HDR);
	char name[12];
	int ret;

	if (IS_ERR(b))
		return PTR_ERR(b);
	ret = soe_exchange(&t, b);
	kfree(b);
	ec_mbox_dbg_result(mb, ret, "%s %s of drive %u, elements 0x%02x, error 0x%04x",
			   a->write ? "write" : "read", ec_soe_idn_text(a->idn, name), a->drive,
			   a->elements, a->error);
	return ret;
}

/* Is it known that a failed access has changed nothing in the slave? */
static bool is_harmless(const struct ec_soe_access *a)
{
	return !a->write || a->left;
}

/**
 * ec_soe_access() - read or write elements of an IDN
 * @mb: mailbox of the slave
 * @a: access, up to @size as the caller wants it
 * @limit: time limits; NULL: the defaults
 *
 * Data larger than a message are transferred in fragments. A whole transfer is repeated where a
 * lost frame cannot have changed anything.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO with @a->error set; -ENOBUFS when the data are larger than @a->cap;
 * -EPROTONOSUPPORT without SoE; -EMSGSIZE when the mailbox has no space for data, or is larger than
 * a datagram; -EAGAIN in INIT; -EINVAL for drive or elements; -EBADMSG for a wrong answer, wrong
 * fragments included; -ETIMEDOUT; -EINTR; -ECANCELED; -ENOMEM; of a write -ENOTRECOVERABLE when a
 * lost frame leaves the outcome unknown.
 */
int ec_soe_access(struct ec_mbox *mb, struct ec_soe_access *a, const struct ec_mbox_limit *limit)
{
	const struct ec_soe_access wanted = *a;
	unsigned int tries = 0;
	int ret;

	if (a->drive >= EC_SOE_DRIVES || !a->elements)
		return -EINVAL;
	do {
		*a = wanted;
		ret = soe_try(mb, a, limit);
	} while ((ret == -EPROTO || (ret == -ENOTRECOVERABLE && is_harmless(a))) &&
		 ++tries < EC_MBOX_READ_TRIES);
	if (!a->write && ret)
		a->size = 0;
	if (ret == -EPROTO)
		return -EBADMSG;
	return is_harmless(a) ? ec_mbox_read_result(ret) : ret;
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
 * Return: as ec_soe_access().
 */
int ec_soe_read(struct ec_mbox *mb, u8 drive, u16 idn, u8 *data, size_t cap, size_t *size,
		u16 *error, const struct ec_mbox_limit *limit)
{
	struct ec_soe_access a = {
		.drive = drive, .elements = EC_SOE_VALUE, .idn = idn, .data = data, .cap = cap,
	};
	int ret = ec_soe_access(mb, &a, limit);

	*error = a.error;
	*size = a.size;
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
 * Return: as ec_soe_access().
 */
int ec_soe_write(struct ec_mbox *mb, u8 drive, u16 idn, const u8 *data, size_t size,
		 u16 *error, const struct ec_mbox_limit *limit)
{
	struct ec_soe_access a = {
		.write = true, .drive = drive, .elements = EC_SOE_VALUE, .idn = idn,
		.data = (u8 *)data, .size = size,
	};
	int ret = ec_soe_access(mb, &a, limit);

	*error = a.error;
	return ret;
}
