/* SPDX-License-Identifier: GPL-2.0-only */
/* A station that talks to a simulated slave by Ethernet over EoE. */
#ifndef SIM_APP_EOE_HOST_H
#define SIM_APP_EOE_HOST_H

#include "sim_app_kunit.h"
#include "../../devices/sim/eoe.h"

static const u8 host_mac[6] = { 0x02, 0, 0, 0, 0, 1 };
static const u8 host_ip[4] = { 192, 168, 0, 1 };
static const u8 slave_ip[4] = { 192, 168, 0, 17 };

/**
 * struct host - the station, at the master's side of a mailbox
 * @b: segment, of one slave
 * @app: the slave
 * @m: its mailbox
 * @parts: frames of the slave on their way, by their number
 * @data: their bytes
 * @number: of the next frame to the slave
 * @bad: fragments that were refused
 * @stamped: fragments with a time stamp
 * @fragments: fragments received
 */
struct host {
	struct bed *b;
	struct ec_app *app;
	struct app_mbox m;
	struct ec_eoe_part parts[16];
	u8 data[16][EC_EOE_FRAME_MAX];
	u8 number;
	u32 bad;
	u32 stamped;
	u32 fragments;
};

/* a slave in PREOP, with an address */
static inline struct host *host_new(struct kunit *test, const char *text, u16 size)
{
	static const u8 set_ip[] = {
		0x02, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0x11, 0x00, 0xa8, 0xc0,
	};
	struct host *h = kunit_kzalloc(test, sizeof(*h), GFP_KERNEL);
	struct ec_mbox_hdr hdr;

	KUNIT_ASSERT_NOT_NULL(test, h);
	h->b = app_bed(test, text);
	h->app = ec_app_of(ec_sim_at(h->b->sim, 0));
	h->m.station = STATION(0);
	h->m.size = size;
	app_mbox_sms(h->b, STATION(0), size);
	KUNIT_ASSERT_EQ(test, app_al(h->b, STATION(0), EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	memcpy(h->m.tx + EC_MBOX_HDR, set_ip, sizeof(set_ip));
	KUNIT_ASSERT_EQ(test, app_send(h->b, &h->m, EC_MBOX_EOE, sizeof(set_ip)), 1);
	KUNIT_ASSERT_EQ(test, app_recv(h->b, &h->m, &hdr, 10), 4);
	return h;
}

/* false: the mailbox was full */
static inline bool host_send(struct host *h, const u8 *frame, u16 len)
{
	struct ec_eoe_fragment f = { .frame = h->number++ & 15 };
	u16 at = 0;
	u8 number = 0;

	while (at < len) {
		int n;

		at = (u16)(at + ec_eoe_fragment_cut(&f, frame, len, at, number++, h->m.size));
		n = ec_eoe_fragment_encode(h->m.tx + EC_MBOX_HDR, h->m.size - 6u, &f);
		if (n < 0 || app_send(h->b, &h->m, EC_MBOX_EOE, (size_t)n) != 1)
			return false;
	}
	return true;
}

/* one message of the slave: bytes of a frame that is whole, 0: none; -1: no message */
static inline int host_message(struct host *h, const u8 **frame, u32 ms)
{
	struct ec_eoe_fragment f;
	struct ec_mbox_hdr hdr;
	int len = app_recv(h->b, &h->m, &hdr, ms), ret;

	if (len < 0)
		return -1;
	if (hdr.type != EC_MBOX_EOE || ec_eoe_fragment_decode(h->m.rx + 6, (size_t)len, &f)) {
		h->bad++;
		return 0;
	}
	h->fragments++;
	h->stamped += f.last && h->m.rx[7] & 2;
	ret = ec_eoe_part_add(&h->parts[f.frame], h->data[f.frame], EC_EOE_FRAME_MAX, &f);
	if (ret < 0)
		h->bad++;
	*frame = h->data[f.frame];
	return max(ret, 0);
}

/* bytes of the next whole frame, 0: none in this time */
static inline int host_recv(struct host *h, const u8 **frame, u32 ms)
{
	u64 end = h->b->now + ms * 1000000ull;

	while (h->b->now < end) {
		int ret = host_message(h, frame, ms);

		if (ret)
			return max(ret, 0);
	}
	return 0;
}

/* an ARP request for @ip; its bytes */
static inline u16 host_arp(u8 *p, const u8 *ip)
{
	memset(p, 0, 60);
	memset(p, 0xff, 6);
	memcpy(p + 6, host_mac, 6);
	memcpy(p + 12, "\x8\6\0\1\x8\0\6\4\0\1", 10);
	memcpy(p + 22, host_mac, 6);
	memcpy(p + 28, host_ip, 4);
	memcpy(p + 38, ip, 4);
	return 60;
}

/* Ethernet and IP header in front of @len bytes at @p + 34; bytes of the frame */
static inline u16 host_ip_frame(const struct host *h, u8 *p, u8 proto, u16 len)
{
	memcpy(p, ec_app_eoe_mac(h->app), 6);
	memcpy(p + 6, host_mac, 6);
	memcpy(p + 12, "\x8\0\x45\0", 4);
	ec_app_put_be16(p + 16, (u16)(20 + len));
	memcpy(p + 18, "\1\2\0\0\x40", 5);
	p[23] = proto;
	ec_app_put_be16(p + 24, 0);
	memcpy(p + 26, host_ip, 4);
	memcpy(p + 30, slave_ip, 4);
	ec_app_put_be16(p + 24, ec_app_ip_sum(p + 14, 20, 0));
	return (u16)(34 + len);
}

/* an echo request with @len bytes; its bytes */
static inline u16 host_ping(const struct host *h, u8 *p, u16 len)
{
	u8 *icmp = p + 34;

	memcpy(icmp, "\x8\0\0\0\x12\x34\0\1", 8);
	for (u16 i = 0; i < len; i++)
		icmp[8 + i] = (u8)(i * 3);
	ec_app_put_be16(icmp + 2, ec_app_ip_sum(icmp, (size_t)len + 8, 0));
	return host_ip_frame(h, p, 1, (u16)(len + 8));
}

static inline bool host_is_pong(const u8 *p, int len, u16 data)
{
	return len == max(42 + data, 60) && !memcmp(p, host_mac, 6) && p[23] == 1 && !p[34] &&
	       !memcmp(p + 26, slave_ip, 4) && !memcmp(p + 30, host_ip, 4) &&
	       !ec_app_ip_sum(p + 14, 20, 0) && !ec_app_ip_sum(p + 34, (size_t)data + 8, 0);
}

/* sends an echo request and waits for the answer to it */
static inline bool host_pings(struct host *h, u16 data, u32 ms)
{
	u64 end = h->b->now + ms * 1000000ull;
	const u8 *frame = NULL;
	u8 p[EC_EOE_FRAME_MAX];

	if (!host_send(h, p, host_ping(h, p, data)))
		return false;
	while (h->b->now < end) {
		int len = host_recv(h, &frame, 1);

		if (len && host_is_pong(frame, len, data))
			return true;
	}
	return false;
}

#endif
