// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "frame.h"

#define LEN_MASK	0x07FF
#define LEN_CIRCULATING	0x4000
#define LEN_MORE	0x8000

/**
 * ec_frame_iter_init() - start walking a received frame
 * @it: iterator
 * @frame: EtherCAT header and what follows (behind the EtherType)
 * @len: bytes at @frame, padding included
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EPROTONOSUPPORT for a type other than 1 (datagrams), -EBADMSG
 * when the header's length does not fit into @len or holds no datagram.
 */
int ec_frame_iter_init(struct ec_frame_iter *it, u8 *frame, size_t len)
{
	u16 hdr;
	size_t body;

	if (len < EC_FRAME_HDR + EC_DGRAM_OVERHEAD)
		return -EBADMSG;
	hdr = get_unaligned_le16(frame);
	if (hdr >> 12 != EC_FRAME_TYPE_DGRAM)
		return -EPROTONOSUPPORT;
	body = hdr & LEN_MASK;
	if (body > len - EC_FRAME_HDR || body < EC_DGRAM_OVERHEAD)
		return -EBADMSG;

	it->p = frame + EC_FRAME_HDR;
	it->end = it->p + body;
	it->more = true;
	return 0;
}

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
	d->len = len & LEN_MASK;
	d->circulating = len & LEN_CIRCULATING;
	d->more = len & LEN_MORE;
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
 * ec_frame_begin() - start building a frame
 * @f: builder
 * @buf: where the EtherCAT header goes (behind the EtherType)
 * @cap: bytes available at @buf
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_frame_begin(struct ec_frame_buf *f, u8 *buf, size_t cap)
{
	f->buf = buf;
	f->cap = min_t(size_t, cap, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	f->len = EC_FRAME_HDR;
	f->last = NULL;
	f->count = 0;
}

/**
 * ec_frame_add() - append a datagram
 * @f: builder
 * @cmd: enum ec_cmd
 * @idx: datagram index
 * @adp: low half of the address
 * @ado: high half of the address
 * @len: data bytes
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: where the data go (not cleared; the working counter behind them
 * is), or NULL when the datagram does not fit.
 */
u8 *ec_frame_add(struct ec_frame_buf *f, u8 cmd, u8 idx, u16 adp, u16 ado, u16 len)
{
	u8 *p = f->buf + f->len;

	if (len > EC_DGRAM_DATA_MAX || f->cap < f->len ||
	    f->cap - f->len < (size_t)EC_DGRAM_OVERHEAD + len)
		return NULL;

	p[0] = cmd;
	p[1] = idx;
	put_unaligned_le16(adp, p + 2);
	put_unaligned_le16(ado, p + 4);
	put_unaligned_le16(len, p + 6);
	put_unaligned_le16(0, p + 8);
	put_unaligned_le16(0, p + EC_DGRAM_HDR + len);
	if (f->last)
		f->last[7] |= LEN_MORE >> 8;
	f->last = p;
	f->len += EC_DGRAM_OVERHEAD + len;
	f->count++;
	return p + EC_DGRAM_HDR;
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
		f->last[7] |= LEN_MORE >> 8;
	f->last = p + last;
	f->len += len;
	f->count += count;
	return true;
}

/**
 * ec_frame_end() - write the EtherCAT header
 * @f: builder
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of header and datagrams; the caller pads the Ethernet frame
 * to EC_ETH_MIN.
 */
size_t ec_frame_end(struct ec_frame_buf *f)
{
	put_unaligned_le16((u16)(EC_FRAME_TYPE_DGRAM << 12 | (f->len - EC_FRAME_HDR)), f->buf);
	return f->len;
}

/**
 * ec_frame_wire_ns() - time a frame occupies a 100 Mbit/s wire
 * @eth_len: bytes from destination address to the last datagram, without FCS
 *
 * Preamble, padding, FCS and inter-frame gap included.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: nanoseconds.
 */
u32 ec_frame_wire_ns(size_t eth_len)
{
	return (u32)(8 + max_t(size_t, eth_len, EC_ETH_MIN) + 4 + 12) * 80;
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
