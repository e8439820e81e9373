// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "frame.h"

/**
 * ec_frame_iter_next() - decode the next datagram
 * @it: iterator
 * @d: result; points into the frame
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 1 for a datagram, 0 at the end, -EBADMSG when a datagram does not
 * fit or the "more" bit and the frame length disagree.
 */
int ec_frame_iter_next(struct ec_frame_iter *it, struct ec_dgram *d)
{
	size_t left = (size_t)(it->end - it->p);
	u16 len;

	if (!it->more)
		return left ? -EBADMSG : 0;
	if (left < EC_DGRAM_OVERHEAD)
		return -EBADMSG;

	len = get_unaligned_le16(it->p + 6);
	d->cmd = it->p[0];
	d->idx = it->p[1];
	d->adp = get_unaligned_le16(it->p + 2);
	d->ado = get_unaligned_le16(it->p + 4);
	d->len = len & EC_DGRAM_LEN_MASK;
	d->circulating = len & EC_DGRAM_CIRCULATING;
	d->more = len & EC_DGRAM_MORE;
	d->irq = get_unaligned_le16(it->p + 8);
	d->hdr = it->p;
	d->data = it->p + EC_DGRAM_HDR;
	if (left < (size_t)EC_DGRAM_OVERHEAD + d->len)
		return -EBADMSG;

	it->p += EC_DGRAM_OVERHEAD + d->len;
	it->more = d->more;
	return 1;
}

/**
 * ec_frame_append() - append the datagrams of another frame
 * @f: builder
 * @dgrams: the datagrams of that frame, the last one without "more" bit
 * @len: bytes of them
 * @last: offset of the last one
 * @count: how many there are
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether they fit; nothing is appended otherwise.
 */
bool ec_frame_append(struct ec_frame_buf *f, const u8 *dgrams, size_t len, size_t last,
		     unsigned int count)
{
	u8 *p = f->buf + f->len;

	if (f->cap < f->len || f->cap - f->len < len || last + EC_DGRAM_OVERHEAD > len)
		return false;
	memcpy(p, dgrams, len);
	if (f->last)
		f->last[7] |= EC_DGRAM_MORE >> 8;
	f->last = p + last;
	f->len += len;
	f->count += count;
	return true;
}

/* commands whose data slaves do not change, and those whose data they do not take */
#define NO_READ		(BIT(EC_CMD_NOP) | BIT(EC_CMD_APWR) | BIT(EC_CMD_FPWR) | \
			 BIT(EC_CMD_BWR) | BIT(EC_CMD_LWR))
#define NO_WRITE	(BIT(EC_CMD_NOP) | BIT(EC_CMD_APRD) | BIT(EC_CMD_FPRD) | \
			 BIT(EC_CMD_BRD) | BIT(EC_CMD_LRD))

bool ec_cmd_reads(u8 cmd)
{
	return cmd <= EC_CMD_FRMW && !(NO_READ & BIT(cmd));
}

bool ec_cmd_writes(u8 cmd)
{
	return cmd <= EC_CMD_FRMW && !(NO_WRITE & BIT(cmd));
}
