// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "eoe_frame.h"
#include "frame.h"

#define VLAN_C		0x8100
#define VLAN_S		0x88a8
#define IPV4		0x0800
#define IPV4_PLAIN	0x45	/* its first byte: without options */
#define IPV4_UDP	17
#define IPV4_HDR	20
#define UDP_HDR		8

/* first word of the header, behind the type */
#define PORT_SHIFT	4
#define LAST_FRAGMENT	0x0100
#define TIME_APPENDED	0x0200
#define TIME_REQUEST	0x0400
/* second word */
#define UNITS_SHIFT	6
#define FRAME_SHIFT	12
#define NUMBER_MASK	0x3f
#define UNITS_MASK	0x3f

#define OVERHEAD	(EC_MBOX_HDR + EC_EOE_HDR)
#define TIME_STAMP	4	/* bytes behind the last fragment */

/**
 * ec_eoe_fragment_decode() - read a fragment
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @f: result, its data are those at @rx
 *
 * Only the last fragment can have a time stamp behind it, which is no part of
 * the data.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOMSG when it is another message of EoE, -EBADMSG when it is
 * too short or too long.
 */
int ec_eoe_fragment_decode(const u8 *rx, size_t len, struct ec_eoe_fragment *f)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	u16 first = ec_rbuf_le16(&r), second = ec_rbuf_le16(&r);
	int type = ec_eoe_type_decode(rx, len);
	size_t left = ec_rbuf_left(&r);

	if (type < 0)
		return -EBADMSG;
	if (type != EC_EOE_FRAGMENT)
		return -ENOMSG;
	f->last = first & LAST_FRAGMENT;
	if (f->last && first & TIME_APPENDED) {
		if (left < TIME_STAMP)
			return -EBADMSG;
		left -= TIME_STAMP;
	}
	if (left > 0xffff)
		return -EBADMSG;
	f->port = (u8)(first >> PORT_SHIFT & 0x0f);
	f->time_request = first & TIME_REQUEST;
	f->number = second & NUMBER_MASK;
	f->units = second >> UNITS_SHIFT & UNITS_MASK;
	f->frame = (u8)(second >> FRAME_SHIFT);
	f->data = r.p;
	f->len = (u16)left;
	return 0;
}

/**
 * ec_eoe_fragment_encode() - write a fragment
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @f: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit.
 */
int ec_eoe_fragment_encode(u8 *tx, size_t cap, const struct ec_eoe_fragment *f)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_wbuf_le16(&w, (u16)(EC_EOE_FRAGMENT | (f->port & 0x0f) << PORT_SHIFT |
			       (f->last ? LAST_FRAGMENT : 0) |
			       (f->time_request ? TIME_REQUEST : 0)));
	ec_wbuf_le16(&w, (u16)((f->number & NUMBER_MASK) | (f->units & UNITS_MASK) << UNITS_SHIFT |
			       f->frame << FRAME_SHIFT));
	ec_wbuf_bytes(&w, f->data, f->len);
	return w.bad ? -EMSGSIZE : EC_EOE_HDR + f->len;
}

/**
 * ec_eoe_fragment_room() - data bytes of a fragment that is not the last
 * @mailbox: bytes of the mailbox
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, a multiple of EC_EOE_UNIT; 0 when the mailbox is too small.
 */
unsigned int ec_eoe_fragment_room(unsigned int mailbox)
{
	return mailbox < OVERHEAD ? 0 : (mailbox - OVERHEAD) / EC_EOE_UNIT * EC_EOE_UNIT;
}

/**
 * ec_eoe_fragment_cut() - the fragment of a frame that begins at a byte
 * @f: result; port, frame number and time request remain unchanged
 * @frame: bytes of the frame
 * @frame_len: how many
 * @at: where the fragment begins
 * @number: of the fragment, from 0
 * @mailbox: bytes of the mailbox
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of the frame in the fragment; 0 when none are left, when the
 * mailbox is too small, or the frame is too long for the header.
 */
unsigned int ec_eoe_fragment_cut(struct ec_eoe_fragment *f, const u8 *frame, u16 frame_len,
				 u16 at, u8 number, unsigned int mailbox)
{
	unsigned int room = ec_eoe_fragment_room(mailbox), left;

	if (!room || at >= frame_len || frame_len > UNITS_MASK * EC_EOE_UNIT ||
	    number > NUMBER_MASK)
		return 0;
	left = frame_len - at;
	f->last = left <= mailbox - OVERHEAD;
	f->len = (u16)(f->last ? left : room);
	f->number = number;
	f->units = (u16)(number ? at / EC_EOE_UNIT : DIV_ROUND_UP(frame_len, EC_EOE_UNIT));
	f->data = frame + at;
	return f->len;
}

static bool fragment_follows(const struct ec_eoe_part *p, const struct ec_eoe_fragment *f)
{
	return p->open && f->frame == p->frame && f->number == p->next &&
	       f->units * EC_EOE_UNIT == p->len;
}

/**
 * ec_eoe_part_add() - add a fragment to a frame
 * @p: the frame; zeros: none yet
 * @data: its bytes
 * @cap: room at @data
 * @f: fragment; number 0 begins a frame, and drops one that is not complete
 *
 * Context: Any. RT-safe: bounded by a fragment, no sleep, no allocation.
 * Return: bytes of the frame when it is complete, 0 when more are to come;
 * -EBADMSG when the fragment does not follow the one before (gap, offset, frame
 * number), has no or no whole units and is not the last one, or does not fit
 * into the size that was announced or into @cap: the frame is dropped.
 */
int ec_eoe_part_add(struct ec_eoe_part *p, u8 *data, size_t cap, const struct ec_eoe_fragment *f)
{
	if (!f->number)
		*p = (struct ec_eoe_part){
			.frame = f->frame,
			.open = true,
			.room = (u16)min_t(size_t, cap, f->units * EC_EOE_UNIT),
		};
	else if (!fragment_follows(p, f))
		goto drop;
	if (f->len > p->room - p->len || (!f->last && (!f->len || f->len % EC_EOE_UNIT)))
		goto drop;
	memcpy(data + p->len, f->data, f->len);
	p->len = (u16)(p->len + f->len);
	p->next = (u8)(f->number + 1);
	p->port = f->port;
	if (!f->last)
		return 0;
	p->open = false;
	if (p->len)
		return p->len;
drop:
	p->open = false;
	return -EBADMSG;
}

static u16 get_be16(const u8 *p)
{
	return (u16)(p[0] << 8 | p[1]);
}

/* From the IP header on: do slaves take it for EtherCAT? Other types are no datagrams. */
static bool is_ethercat_udp(struct ec_rbuf *r)
{
	const u8 *ip = ec_rbuf_take(r, IPV4_HDR), *udp = ec_rbuf_take(r, UDP_HDR);
	u16 header = ec_rbuf_le16(r);

	return !r->bad && ip[0] == IPV4_PLAIN && ip[9] == IPV4_UDP &&
	       get_be16(udp + 2) == EC_ETHERTYPE && header >> 12 == EC_FRAME_TYPE_DGRAM;
}

/**
 * ec_eoe_is_ethercat() - may slaves process an Ethernet frame?
 * @frame: from the destination address on
 * @len: bytes at @frame
 *
 * Context: Any. RT-safe: bounded by @len, no sleep, no allocation.
 * Return: true: it is EtherCAT by its EtherType, or datagrams in UDP; perhaps behind VLAN tags.
 */
bool ec_eoe_is_ethercat(const u8 *frame, size_t len)
{
	struct ec_rbuf r = ec_rbuf(frame, len);
	const u8 *type;

	ec_rbuf_take(&r, 12);
	while ((type = ec_rbuf_take(&r, 2))) {
		switch (get_be16(type)) {
		case VLAN_C:
		case VLAN_S:
			ec_rbuf_take(&r, 2);
			break;
		case EC_ETHERTYPE:
			return true;
		case IPV4:
			return is_ethercat_udp(&r);
		default:
			return false;
		}
	}
	return false;
}
