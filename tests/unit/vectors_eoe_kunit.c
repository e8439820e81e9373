// SPDX-License-Identifier: GPL-2.0-only
/* EoE messages typed from the tables of the specification. */
#include "wire_kunit.h"
#include "../../master/wire/eoe_frame.h"

/* type 2, last fragment; flags; MAC; addresses as 32-bit numbers; name */
static const u8 set[62] = {
	0x02, 0x01, 0x00, 0x00,
	0x3f, 0x00, 0x00, 0x00,
	0x02, 0x00, 0x00, 0xec, 0x01, 0x07,
	0x01, 0x00, 0xa8, 0xc0,		/* 192.168.0.1 */
	0x00, 0xff, 0xff, 0xff,		/* 255.255.255.0 */
	0xfe, 0x00, 0xa8, 0xc0,		/* 192.168.0.254 */
	0x35, 0x00, 0x00, 0x0a,		/* 10.0.0.53 */
	'm', 'i', 'x', 'e', 'r',
};

static void vectors_eoe_set_ip_request(struct kunit *test)
{
	static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x01, 0x07 };
	static const u8 ip[4] = { 192, 168, 0, 1 }, mask[4] = { 255, 255, 255, 0 };
	static const u8 gateway[4] = { 192, 168, 0, 254 }, dns[4] = { 10, 0, 0, 53 };
	struct ec_eoe_ip p;
	u8 out[62];

	KUNIT_EXPECT_EQ(test, ec_eoe_type_decode(set, sizeof(set)), 2);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(set, sizeof(set), &p), 0);
	KUNIT_EXPECT_EQ(test, p.which, 0x3fu);
	KUNIT_EXPECT_MEMEQ(test, p.mac, mac, 6);
	KUNIT_EXPECT_MEMEQ(test, p.ip, ip, 4);
	KUNIT_EXPECT_MEMEQ(test, p.mask, mask, 4);
	KUNIT_EXPECT_MEMEQ(test, p.gateway, gateway, 4);
	KUNIT_EXPECT_MEMEQ(test, p.dns, dns, 4);
	KUNIT_EXPECT_STREQ(test, (const char *)p.name, "mixer");
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode(out, sizeof(out), EC_EOE_SET_IP_REQ, &p), 62);
	KUNIT_EXPECT_MEMEQ(test, out, set, 62);
}

static void vectors_eoe_set_ip_response(struct kunit *test)
{
	static const u8 no_ip[] = { 0x03, 0x01, 0x01, 0x02 };
	static const u8 port4[] = { 0x43, 0x00, 0x00, 0x00 };
	u16 result;
	u8 out[4];

	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(no_ip, 4, EC_EOE_SET_IP_RESP, &result), 0);
	KUNIT_EXPECT_EQ(test, result, 0x0201);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(port4, 4, EC_EOE_SET_IP_RESP, &result), 0);
	KUNIT_EXPECT_EQ(test, result, 0);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_encode(out, 4, EC_EOE_SET_IP_RESP, 0x0201), 4);
	KUNIT_EXPECT_MEMEQ(test, out, no_ip, 4);
}

static void vectors_eoe_get_ip(struct kunit *test)
{
	static const u8 req[] = { 0x06, 0x01, 0x00, 0x00 };
	static const u8 resp[] = {	/* ends behind the address */
		0x07, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0x11, 0x02, 0x10, 0xac,
	};
	static const u8 ip[4] = { 172, 16, 2, 17 };
	struct ec_eoe_ip p;
	u16 result;
	u8 out[4];

	KUNIT_EXPECT_EQ(test, ec_eoe_result_encode(out, 4, EC_EOE_GET_IP_REQ, 0), 4);
	KUNIT_EXPECT_MEMEQ(test, out, req, 4);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(resp, sizeof(resp), EC_EOE_GET_IP_RESP,
						   &result), 0);
	KUNIT_EXPECT_EQ(test, result, 0);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(resp, sizeof(resp), &p), 0);
	KUNIT_EXPECT_EQ(test, p.which, (u32)EC_EOE_IP);
	KUNIT_EXPECT_MEMEQ(test, p.ip, ip, 4);
}

/*
 * Frame 5 of 70 bytes in two parts: type 0, no port; number 0, size 3 units of 32; then port 2,
 * last fragment, time stamp; number 1, offset 2 units.
 */
static void vectors_eoe_fragments(struct kunit *test)
{
	static const u8 first[4 + 64] = { 0x00, 0x00, 0xc0, 0x50, 0x11 };
	static const u8 second[] = {
		0x20, 0x03, 0x81, 0x50, 0xa0, 0xa1, 0xa2, 0xa3, 0xa4, 0xa5,
		0x78, 0x56, 0x34, 0x12,		/* time */
	};
	struct ec_eoe_part p = { 0 };
	struct ec_eoe_fragment f;
	u8 frame[96], out[68];

	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode(first, sizeof(first), &f), 0);
	KUNIT_EXPECT_EQ(test, f.units, 3);
	KUNIT_EXPECT_EQ(test, f.frame, 5);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_encode(out, sizeof(out), &f), 68);
	KUNIT_EXPECT_MEMEQ(test, out, first, sizeof(first));
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, frame, sizeof(frame), &f), 0);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode(second, sizeof(second), &f), 0);
	KUNIT_EXPECT_EQ(test, f.number, 1);
	KUNIT_EXPECT_EQ(test, f.units, 2);
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, frame, sizeof(frame), &f), 70);
	KUNIT_EXPECT_EQ(test, p.port, 2);
	KUNIT_EXPECT_EQ(test, frame[0], 0x11);
	/* a mailbox of 74 bytes has just the space of the first one */
	f = (struct ec_eoe_fragment){ .frame = 5 };
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 70, 0, 0, 74), 64u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_encode(out, sizeof(out), &f), 68);
	KUNIT_EXPECT_MEMEQ(test, out, first, sizeof(first));
	f.port = 2;
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 70, 64, 1, 74), 6u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_encode(out, sizeof(out), &f), 10);
	KUNIT_EXPECT_MEMEQ(test, out, "\x20\x01\x81\x50\xa0\xa1\xa2\xa3\xa4\xa5", 10);
	KUNIT_EXPECT_MEMEQ(test, frame + 64, second + 4, 6);
}

/* The address alone without places for what is absent, then with what the slave has before it. */
static void vectors_eoe_packed_ip(struct kunit *test)
{
	static const u8 packed[] = {
		0x07, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x11, 0x02, 0x10, 0xac,
	};
	static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x01, 0x07 };
	static const u8 filled[] = {
		0x02, 0x01, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00,
		0x02, 0x00, 0x00, 0xec, 0x01, 0x07, 0x11, 0x02, 0x10, 0xac,
	};
	static const u8 ip[4] = { 172, 16, 2, 17 };
	struct ec_eoe_ip p, now = { 0 };
	u8 out[EC_EOE_IP_SIZE];

	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode_packed(packed, sizeof(packed), &p), 0);
	KUNIT_EXPECT_EQ(test, p.which, (u32)EC_EOE_IP);
	KUNIT_EXPECT_MEMEQ(test, p.ip, ip, 4);
	KUNIT_EXPECT_TRUE(test, ec_eoe_ip_fill(&p, &now, mac));
	KUNIT_EXPECT_GE(test, ec_eoe_ip_encode(out, sizeof(out), EC_EOE_SET_IP_REQ, &p),
			(int)sizeof(filled));
	KUNIT_EXPECT_MEMEQ(test, out, filled, sizeof(filled));
}

/* EtherType 0x88a4; UDP to port 0x88a4 with datagrams, behind a VLAN tag; ARP. */
static void vectors_eoe_ethercat(struct kunit *test)
{
	static const u8 plain[60] = {
		0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0, 0, 0, 0, 1, 0x88, 0xa4, 0x0d, 0x10,
	};
	static const u8 udp[64] = {
		0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0, 0, 0, 0, 1, 0x81, 0x00, 0x00, 0x05,
		0x08, 0x00, 0x45, 0x00, 0x00, 0x2b, 0, 0, 0, 0, 0x40, 0x11, 0, 0, 10, 1, 0, 2,
		0xff, 0xff, 0xff, 0xff, 0x12, 0x34, 0x88, 0xa4, 0x00, 0x17, 0, 0, 0x0d, 0x10,
	};
	static const u8 arp[60] = {
		0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0, 0, 0, 0, 1, 0x08, 0x06, 0, 1,
	};

	KUNIT_EXPECT_TRUE(test, ec_eoe_is_ethercat(plain, sizeof(plain)));
	KUNIT_EXPECT_TRUE(test, ec_eoe_is_ethercat(udp, sizeof(udp)));
	KUNIT_EXPECT_FALSE(test, ec_eoe_is_ethercat(arp, sizeof(arp)));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_eoe_set_ip_request),
	KUNIT_CASE(vectors_eoe_set_ip_response),
	KUNIT_CASE(vectors_eoe_get_ip),
	KUNIT_CASE(vectors_eoe_fragments),
	KUNIT_CASE(vectors_eoe_packed_ip),
	KUNIT_CASE(vectors_eoe_ethercat),
	{ }
};

static struct kunit_suite suite = { .name = "vectors_eoe", .test_cases = cases };
kunit_test_suite(suite);
