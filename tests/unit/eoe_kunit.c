// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/eoe.h"

static const struct ec_eoe_ip all = {
	.which = EC_EOE_ALL,
	.mac = { 2, 0, 0, 0xec, 1, 7 },
	.ip = { 192, 168, 0, 17 },
	.mask = { 255, 255, 255, 0 },
	.gateway = { 192, 168, 0, 1 },
	.dns = { 8, 8, 4, 4 },
	.name = "axis-17",
};

static void eoe_parameters_survive_both_ways(struct kunit *test)
{
	struct ec_eoe_ip out;
	u8 msg[EC_EOE_IP_SIZE];

	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode(msg, sizeof(msg), EC_EOE_SET_IP_REQ, &all),
			EC_EOE_IP_SIZE);
	KUNIT_EXPECT_EQ(test, ec_eoe_type_decode(msg, sizeof(msg)), EC_EOE_SET_IP_REQ);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(msg, sizeof(msg), &out), 0);
	KUNIT_EXPECT_EQ(test, out.which, (u32)EC_EOE_ALL);
	KUNIT_EXPECT_MEMEQ(test, &out, &all, sizeof(all));
}

static void eoe_unset_fields_are_zero(struct kunit *test)
{
	struct ec_eoe_ip in = all, out;
	u8 msg[EC_EOE_IP_SIZE];
	unsigned int i;

	in.which = EC_EOE_MASK;
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode(msg, sizeof(msg), EC_EOE_SET_IP_REQ, &in),
			EC_EOE_IP_SIZE);
	for (i = EC_EOE_HDR + 4; i < sizeof(msg); i++)
		KUNIT_EXPECT_EQ(test, msg[i], i >= 19 && i < 22 ? 255 : 0);
	memset(msg + 22, 0x55, sizeof(msg) - 22);	/* whatever the others hold */
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(msg, sizeof(msg), &out), 0);
	KUNIT_EXPECT_MEMEQ(test, out.mask, all.mask, 4);
	KUNIT_EXPECT_EQ(test, out.dns[0] | out.gateway[0] | out.name[0] | out.mac[0], 0);
}

/* a message may end behind its last field, but not before */
static void eoe_short_messages(struct kunit *test)
{
	struct ec_eoe_ip in = all, out;
	u8 msg[EC_EOE_IP_SIZE];
	size_t len;

	in.which = EC_EOE_IP | EC_EOE_GATEWAY;
	ec_eoe_ip_encode(msg, sizeof(msg), EC_EOE_SET_IP_REQ, &in);
	for (len = 0; len < sizeof(msg); len++)
		/* two addresses, packed, have 16 */
		KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(msg, len, &out),
				len < 26 && len != 16 ? -EMSGSIZE : 0);
	KUNIT_EXPECT_MEMEQ(test, out.gateway, all.gateway, 4);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode(msg, sizeof(msg) - 1, EC_EOE_SET_IP_REQ, &all),
			-EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_eoe_type_decode(msg, 3), -EMSGSIZE);
}

/* absent fields have no place: what is left of a message with fixed places is another one */
static void eoe_packed(struct kunit *test)
{
	struct ec_eoe_ip in = all, out;
	u8 msg[EC_EOE_IP_SIZE];

	in.which = EC_EOE_IP | EC_EOE_GATEWAY;
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode_packed(msg, sizeof(msg), EC_EOE_SET_IP_REQ, &in),
			16);
	KUNIT_EXPECT_MEMEQ(test, msg + 8, "\x11\0\xa8\xc0\x01\0\xa8\xc0", 8);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode_packed(msg, 15, &out), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode_packed(msg, 16, &out), 0);
	KUNIT_EXPECT_MEMEQ(test, out.gateway, all.gateway, 4);
	/* too short for fixed places */
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(msg, 16, &out), 0);
	KUNIT_EXPECT_MEMEQ(test, out.ip, all.ip, 4);
	KUNIT_EXPECT_MEMEQ(test, out.gateway, all.gateway, 4);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_decode(msg, 17, &out), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_eoe_ip_encode_packed(msg, sizeof(msg), EC_EOE_SET_IP_REQ, &all),
			EC_EOE_IP_SIZE);
}

static const struct {
	u32 wanted;
	u32 known;
	u32 sent;	/* 0: no form is understood by all */
} fills[] = {
	{ EC_EOE_MAC, 0, EC_EOE_MAC },
	{ EC_EOE_IP, 0, EC_EOE_MAC | EC_EOE_IP },
	{ EC_EOE_IP | EC_EOE_MASK, EC_EOE_MAC, EC_EOE_MAC | EC_EOE_IP | EC_EOE_MASK },
	{ EC_EOE_IP | EC_EOE_MASK | EC_EOE_HOSTNAME, EC_EOE_MAC, EC_EOE_ALL },
	{ EC_EOE_IP | EC_EOE_DNS, EC_EOE_ALL, EC_EOE_ALL & ~EC_EOE_HOSTNAME },
	{ EC_EOE_IP | EC_EOE_DNS, EC_EOE_MAC | EC_EOE_IP, 0 },
	{ EC_EOE_HOSTNAME, EC_EOE_ALL, 0 },
	{ EC_EOE_MAC | EC_EOE_GATEWAY, EC_EOE_ALL, 0 },
	{ EC_EOE_ALL, 0, EC_EOE_ALL },
};

static void eoe_gaps_are_filled(struct kunit *test)
{
	static const u8 mac[6] = { 2, 1, 1, 1, 1, 1 };
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(fills); i++) {
		struct ec_eoe_ip want = { .which = fills[i].wanted }, p;
		struct ec_eoe_ip now = all;

		now.which = fills[i].known;
		p = want;
		KUNIT_EXPECT_EQ_MSG(test, ec_eoe_ip_fill(&p, &now, mac), !!fills[i].sent, "%u", i);
		if (!fills[i].sent) {
			KUNIT_EXPECT_MEMEQ(test, &p, &want, sizeof(p));
			continue;
		}
		KUNIT_EXPECT_EQ_MSG(test, p.which, fills[i].sent, "%u", i);
		if (!(want.which & EC_EOE_MAC))
			KUNIT_EXPECT_MEMEQ(test, p.mac, now.which & EC_EOE_MAC ? all.mac : mac, 6);
		/* what is wanted is not replaced: it is 0 here */
		KUNIT_EXPECT_EQ(test, p.ip[0], 0);
		if (p.which & ~want.which & EC_EOE_MASK)
			KUNIT_EXPECT_MEMEQ(test, p.mask, all.mask, 4);
	}
}

static void eoe_results(struct kunit *test)
{
	u16 result = 9;
	u8 msg[4];

	KUNIT_EXPECT_EQ(test, ec_eoe_result_encode(msg, 3, EC_EOE_SET_IP_RESP, 0), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_encode(msg, 4, EC_EOE_SET_IP_RESP, EC_EOE_NO_IP), 4);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(msg, 4, EC_EOE_GET_IP_RESP, &result), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(msg, 3, EC_EOE_SET_IP_RESP, &result),
			-EMSGSIZE);
	KUNIT_EXPECT_EQ(test, result, 9);
	KUNIT_EXPECT_EQ(test, ec_eoe_result_decode(msg, 4, EC_EOE_SET_IP_RESP, &result), 0);
	KUNIT_EXPECT_EQ(test, result, EC_EOE_NO_IP);
	KUNIT_EXPECT_STREQ(test, ec_eoe_result_text(EC_EOE_NO_IP), "the slave does not support IP");
	KUNIT_EXPECT_STREQ(test, ec_eoe_result_text(0x0203), "unknown result");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eoe_parameters_survive_both_ways),
	KUNIT_CASE(eoe_unset_fields_are_zero),
	KUNIT_CASE(eoe_short_messages),
	KUNIT_CASE(eoe_packed),
	KUNIT_CASE(eoe_gaps_are_filled),
	KUNIT_CASE(eoe_results),
	{ }
};

static struct kunit_suite suite = { .name = "eoe", .test_cases = cases };
kunit_test_suite(suite);
