/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* EtherCAT frame and datagram headers (ETG.1000.4 clause 5). */
#ifndef EC_WIRE_FRAME_H
#define EC_WIRE_FRAME_H

#include "env.h"

#define EC_ETHERTYPE		0x88A4
#define EC_ETH_HDR		14
#define EC_ETH_MIN		60	/* without FCS */
#define EC_ETH_MAX		1514
#define EC_FRAME_HDR		2
#define EC_FRAME_TYPE_DGRAM	1
#define EC_FRAME_BODY_MAX	1498	/* sum of all datagrams */
#define EC_DGRAM_HDR		10
#define EC_DGRAM_WKC		2
#define EC_DGRAM_OVERHEAD	(EC_DGRAM_HDR + EC_DGRAM_WKC)
#define EC_DGRAM_DATA_MAX	(EC_FRAME_BODY_MAX - EC_DGRAM_OVERHEAD)

/* the word with the length of a datagram; the frame's length has the same bits */
#define EC_DGRAM_LEN_MASK	0x07FF
#define EC_DGRAM_CIRCULATING	0x4000
#define EC_DGRAM_MORE		0x8000

enum ec_cmd {
	EC_CMD_NOP = 0,
	EC_CMD_APRD = 1,
	EC_CMD_APWR = 2,
	EC_CMD_APRW = 3,
	EC_CMD_FPRD = 4,
	EC_CMD_FPWR = 5,
	EC_CMD_FPRW = 6,
	EC_CMD_BRD = 7,
	EC_CMD_BWR = 8,
	EC_CMD_BRW = 9,
	EC_CMD_LRD = 10,
	EC_CMD_LWR = 11,
	EC_CMD_LRW = 12,
	EC_CMD_ARMW = 13,
	EC_CMD_FRMW = 14,
};

/**
 * struct ec_dgram - one datagram of a frame, decoded
 * @cmd: enum ec_cmd
 * @idx: index, never changed by slaves
 * @circulating: passed a slave whose port 0 is closed
 * @more: another datagram follows
 * @adp: low 16 bits of the address (position or station)
 * @ado: high 16 bits of the address (memory offset)
 * @len: data bytes
 * @irq: OR of the enabled ECAT events of all slaves passed
 * @hdr: where the datagram starts in the frame
 * @data: its data, in the frame; the working counter stands behind it
 */
struct ec_dgram {
	u8 cmd;
	u8 idx;
	bool circulating;
	bool more;
	u16 adp;
	u16 ado;
	u16 len;
	u16 irq;
	u8 *hdr;
	u8 *data;
};

static inline u32 ec_dgram_logical(const struct ec_dgram *d)
{
	return d->adp | (u32)d->ado << 16;
}

static inline u16 ec_dgram_wkc(const struct ec_dgram *d)
{
	return get_unaligned_le16(d->data + d->len);
}

static inline void ec_dgram_set_wkc(struct ec_dgram *d, u16 wkc)
{
	put_unaligned_le16(wkc, d->data + d->len);
}

/**
 * struct ec_frame_iter - walk over the datagrams of a received frame
 * @p: next datagram
 * @end: end of the datagram area as the EtherCAT header says
 * @more: the last datagram announced another one
 */
struct ec_frame_iter {
	u8 *p;
	u8 *end;
	bool more;
};

/**
 * struct ec_frame_buf - a frame under construction
 * @buf: EtherCAT header and datagrams (what follows the EtherType)
 * @cap: bytes in @buf
 * @len: bytes used
 * @last: last datagram header, whose "more" bit is set when one is added
 * @count: datagrams so far
 */
struct ec_frame_buf {
	u8 *buf;
	size_t cap;
	size_t len;
	u8 *last;
	unsigned int count;
};

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
static inline int ec_frame_iter_init(struct ec_frame_iter *it, u8 *frame, size_t len)
{
	u16 hdr;
	size_t body;

	if (len < EC_FRAME_HDR + EC_DGRAM_OVERHEAD)
		return -EBADMSG;
	hdr = get_unaligned_le16(frame);
	if (hdr >> 12 != EC_FRAME_TYPE_DGRAM)
		return -EPROTONOSUPPORT;
	body = hdr & EC_DGRAM_LEN_MASK;
	if (body > len - EC_FRAME_HDR || body < EC_DGRAM_OVERHEAD)
		return -EBADMSG;

	it->p = frame + EC_FRAME_HDR;
	it->end = it->p + body;
	it->more = true;
	return 0;
}

int ec_frame_iter_next(struct ec_frame_iter *it, struct ec_dgram *d);

/**
 * ec_frame_begin() - start building a frame
 * @f: builder
 * @buf: where the EtherCAT header goes (behind the EtherType)
 * @cap: bytes available at @buf
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
static inline void ec_frame_begin(struct ec_frame_buf *f, u8 *buf, size_t cap)
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
static inline u8 *ec_frame_add(struct ec_frame_buf *f, u8 cmd, u8 idx, u16 adp, u16 ado, u16 len)
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
		f->last[7] |= EC_DGRAM_MORE >> 8;
	f->last = p;
	f->len += EC_DGRAM_OVERHEAD + len;
	f->count++;
	return p + EC_DGRAM_HDR;
}

bool ec_frame_append(struct ec_frame_buf *f, const u8 *dgrams, size_t len, size_t last,
		     unsigned int count);

/**
 * ec_frame_ends_at() - no datagram follows this one: clear its "more" bit
 * @dgram: datagram header
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
static inline void ec_frame_ends_at(u8 *dgram)
{
	dgram[7] &= 0x7f;
}

/**
 * ec_frame_end() - write the EtherCAT header
 * @f: builder
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of header and datagrams; the caller pads the Ethernet frame
 * to EC_ETH_MIN.
 */
static inline size_t ec_frame_end(struct ec_frame_buf *f)
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
static inline u32 ec_frame_wire_ns(size_t eth_len)
{
	return (u32)(8 + max_t(size_t, eth_len, EC_ETH_MIN) + 4 + 12) * 80;
}

bool ec_cmd_reads(u8 cmd);
bool ec_cmd_writes(u8 cmd);

#endif
