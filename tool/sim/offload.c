// SPDX-License-Identifier: GPL-2.0-only
/*
 * A veth pair has no card: the frames of its other end arrive without checksum, and a TCP segment
 * of up to 64 KiB as one frame. Here is what the card would do.
 */
#include <linux/if_ether.h>
#include <netinet/in.h>
#include <string.h>

#include "offload.h"

#define IP6_HDR	40

static uint16_t get16(const uint8_t *p)
{
	return (uint16_t)(p[0] << 8 | p[1]);
}

static void put16(uint8_t *p, uint16_t v)
{
	p[0] = (uint8_t)(v >> 8);
	p[1] = (uint8_t)v;
}

static uint32_t add(const uint8_t *p, size_t n, uint32_t sum)
{
	for (; n > 1; n -= 2, p += 2)
		sum += get16(p);
	return n ? sum + (uint32_t)(p[0] << 8) : sum;
}

static uint16_t fold(uint32_t sum)
{
	while (sum >> 16)
		sum = (sum & 0xffff) + (sum >> 16);
	return (uint16_t)~sum;
}

/* Is the frame TCP in IP of a version that is known? */
static bool find_headers(struct offload *o, size_t csum_start)
{
	size_t type = ETH_HLEN - 2;

	while (type + 6 < o->len && (get16(o->frame + type) == ETH_P_8021Q ||
				     get16(o->frame + type) == ETH_P_8021AD))
		type += 4;
	o->l3 = type + 2;
	o->l4 = csum_start;
	if (o->l4 + 20 > o->len || o->l4 < o->l3 + 20)
		return false;
	o->head = o->l4 + (size_t)(o->frame[o->l4 + 12] >> 4) * 4;
	if (o->head < o->l4 + 20 || o->head >= o->len)
		return false;
	o->at = o->head;
	return get16(o->frame + type) == ETH_P_IP ||
	       (get16(o->frame + type) == ETH_P_IPV6 && o->l4 >= o->l3 + IP6_HDR);
}

/**
 * offload_begin() - a frame that was received
 * @o: its bytes are in @frame
 * @len: how many
 * @h: what the sender has left to its card
 *
 * Return: whether offload_next() has segments of it.
 */
bool offload_begin(struct offload *o, size_t len, const struct virtio_net_hdr *h)
{
	uint8_t kind = h->gso_type & (uint8_t)~VIRTIO_NET_HDR_GSO_ECN;
	size_t sum = (size_t)h->csum_start + h->csum_offset;

	o->len = 0;
	o->size = 0;
	if (len > sizeof(o->frame))
		return false;
	o->len = len;
	if (kind == VIRTIO_NET_HDR_GSO_TCPV4 || kind == VIRTIO_NET_HDR_GSO_TCPV6) {
		o->size = h->gso_size;
		if (!o->size || !find_headers(o, h->csum_start))
			o->len = 0;
	} else if (kind != VIRTIO_NET_HDR_GSO_NONE) {
		o->len = 0;
	} else if (h->flags & VIRTIO_NET_HDR_F_NEEDS_CSUM && sum + 2 <= len) {
		/* the sum of the pseudo header is present */
		put16(o->frame + sum, fold(add(o->frame + h->csum_start, len - h->csum_start, 0)));
	}
	return o->len;
}

/* The headers of a segment, whose data begin @done bytes behind those of the frame. */
static void fix_headers(const struct offload *o, uint8_t *f, size_t len, size_t done, bool last)
{
	uint8_t *ip = f + o->l3, *tcp = f + o->l4;
	uint32_t seq = (uint32_t)get16(tcp + 4) << 16 | get16(tcp + 6), sum;
	size_t n = len - o->l4;

	if (ip[0] >> 4 == 4) {
		put16(ip + 2, (uint16_t)(len - o->l3));
		put16(ip + 4, (uint16_t)(get16(ip + 4) + done / o->size));
		put16(ip + 10, 0);
		put16(ip + 10, fold(add(ip, o->l4 - o->l3, 0)));
		sum = add(ip + 12, 8, 0);
	} else {
		put16(ip + 4, (uint16_t)(len - o->l3 - IP6_HDR));
		sum = add(ip + 8, 32, 0);
	}
	seq += (uint32_t)done;
	put16(tcp + 4, (uint16_t)(seq >> 16));
	put16(tcp + 6, (uint16_t)seq);
	if (!last)
		tcp[13] &= (uint8_t)~0x09;	/* FIN, PSH */
	if (done)
		tcp[13] &= (uint8_t)~0x80;	/* CWR */
	put16(tcp + 16, 0);
	put16(tcp + 16, fold(add(tcp, n, sum + IPPROTO_TCP + (uint32_t)n)));
}

/**
 * offload_next() - the next segment of the frame, as it would be on the wire
 * @o: frame
 * @buf: gets it
 * @cap: bytes at @buf
 *
 * Return: its bytes, more than @cap: too long, and not at @buf; 0: there is no other one.
 */
size_t offload_next(struct offload *o, uint8_t *buf, size_t cap)
{
	size_t len = o->len, n, left;

	if (!len)
		return 0;
	if (!o->size) {
		o->len = 0;
		if (len <= cap)
			memcpy(buf, o->frame, len);
		return len;
	}
	left = o->len - o->at;
	n = left < o->size ? left : o->size;
	len = o->head + n;
	if (len <= cap) {
		memcpy(buf, o->frame, o->head);
		memcpy(buf + o->head, o->frame + o->at, n);
		fix_headers(o, buf, len, o->at - o->head, n == left);
	}
	o->at += n;
	if (n == left)
		o->len = 0;
	return len;
}
