// SPDX-License-Identifier: GPL-2.0-only
/* Whole Ethernet frames: direct, tagged, in UDP, and what is none of these. */
#include "sim_esc_kunit.h"

#define TAG	"\x81\x00\x60\x05"
#define IP	"\x45\x00\x00\x2c\x00\x01\x00\x00\x40\x11\xaa\xbb" \
		"\xc0\xa8\x00\x01\xc0\xa8\x00\xff"
#define UDP	"\x88\xa4\x88\xa4\x00\x18\x12\x34"
#define FRAME_MAX	1600

/* an Ethernet frame: addresses, @n bytes of headers @h, then a BRD of 0x0000 */
static size_t frame(u8 *eth, const char *h, size_t n)
{
	struct ec_frame_buf f;

	memset(eth, 0, FRAME_MAX);
	memset(eth, 0xff, 6);
	memcpy(eth + 6, "\x00\x11\x22\x33\x44\x55", 6);
	memcpy(eth + 12, h, n);
	ec_frame_begin(&f, eth + 12 + n, FRAME_MAX - 12 - n);
	memset(ec_frame_add(&f, EC_CMD_BRD, 1, 0, 0, 2), 0, 2);
	return max_t(size_t, 12 + n + ec_frame_end(&f), EC_ETH_MIN);
}

/* the same frame as the slaves change it; @sum: of its UDP header, 0: none */
static void expected(u8 *eth, size_t at, size_t sum, u8 wkc)
{
	eth[6] |= 2;
	if (sum)
		memset(eth + sum, 0, 2);
	eth[at + 4] = wkc;		/* the position counts up */
	eth[at + 12] = 0x11;		/* type and revision of the controller */
	eth[at + 14] = wkc;
}

static const struct {
	const char *what;
	const char *head;
	size_t n;
	size_t sum;			/* place of the UDP checksum */
} kinds[] = {
	{ "direct", "\x88\xa4", 2, 0 },
	{ "tagged", TAG "\x88\xa4", 6, 0 },
	{ "UDP", "\x08\x00" IP UDP, 30, 40 },
	{ "tagged UDP", TAG "\x08\x00" IP UDP, 34, 44 },
};

static void sim_eth_ethercat_is_found_in_all_its_covers(struct kunit *test)
{
	u8 *eth = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	u8 *want = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	struct bed *b = bed_new(test, 3, 3);
	struct ec_sim_result res;

	for (u32 i = 0; i < ARRAY_SIZE(kinds); i++) {
		size_t len = frame(eth, kinds[i].head, kinds[i].n);
		s64 delay = 6 * 100 + 5 * 500 + (s64)(8 + len + 4) * 80;

		memcpy(want, eth, FRAME_MAX);
		expected(want, 12 + kinds[i].n, kinds[i].sum, 3);
		KUNIT_EXPECT_TRUE(test, ec_sim_eth_is_ethercat(eth, EC_SIM_ETH_HEAD));
		KUNIT_EXPECT_EQ_MSG(test, ec_sim_eth(b->sim, 0, eth, len, b->now, &res), delay,
				    "%s", kinds[i].what);
		KUNIT_EXPECT_EQ(test, res.copies, 1);
		KUNIT_EXPECT_MEMEQ_MSG(test, eth, want, FRAME_MAX, "%s", kinds[i].what);
		b->now += b->gap;
	}
}

/* no slave looks at a length, an address, a checksum or the content of a tag */
static void sim_eth_other_fields_make_no_difference(struct kunit *test)
{
	u8 *eth = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	struct bed *b = bed_new(test, 3, 3);
	static const u8 free_fields[] = {
		0, 5, 14, 15, 19, 20, 21, 22, 23, 24, 25, 26, 28, 29, 30, 37, 38, 39, 42, 43, 44, 45
	};
	struct ec_sim_result res;

	for (u32 i = 0; i < ARRAY_SIZE(free_fields); i++) {
		size_t len = frame(eth, kinds[3].head, kinds[3].n);

		eth[free_fields[i]] ^= 0xff;
		KUNIT_EXPECT_GT_MSG(test, ec_sim_eth(b->sim, 0, eth, len, b->now, &res), (s64)0,
				    "byte %u", free_fields[i]);
		KUNIT_EXPECT_EQ_MSG(test, eth[46 + 14], 3, "byte %u", free_fields[i]);
		b->now += b->gap;
	}
}

static void sim_eth_other_protocols_are_destroyed(struct kunit *test)
{
	u8 *eth = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	struct bed *b = bed_new(test, 3, 3);
	/* types of tag and protocol, version and header of IP, UDP, its port */
	static const u8 needed[] = { 12, 13, 16, 17, 18, 27, 40, 41 };
	struct ec_sim_result res;
	size_t len, n;

	for (u32 i = 0; i < ARRAY_SIZE(needed); i++) {
		len = frame(eth, kinds[3].head, kinds[3].n);
		eth[needed[i]] ^= 1;
		KUNIT_EXPECT_FALSE(test, ec_sim_eth_is_ethercat(eth, len));
		KUNIT_EXPECT_EQ_MSG(test, ec_sim_eth(b->sim, 0, eth, len, b->now, &res),
				    (s64)-ENOLINK, "byte %u", needed[i]);
		KUNIT_EXPECT_EQ(test, res.copies, 0);
		KUNIT_EXPECT_EQ(test, eth[46 + 14], 0);
		b->now += b->gap;
	}
	/* two tags */
	len = frame(eth, TAG TAG "\x88\xa4", 10);
	KUNIT_EXPECT_EQ(test, ec_sim_eth(b->sim, 0, eth, len, b->now, &res), (s64)-ENOLINK);
	/* cut off anywhere: never read beyond the end, never processed in part */
	for (u32 i = 0; i < ARRAY_SIZE(kinds); i++) {
		len = 12 + kinds[i].n + 2 + 14;
		for (n = 0; n < len; n++) {
			u8 *cut = kunit_kmalloc(test, n ? n : 1, GFP_KERNEL);

			frame(eth, kinds[i].head, kinds[i].n);
			memcpy(cut, eth, n);
			ec_sim_eth(b->sim, 0, cut, n, b->now, &res);
			KUNIT_EXPECT_EQ(test, n >= 14 + kinds[i].n, res.copies == 1);
			eth[6] |= n >= 14 + kinds[i].n ? 2 : 0;
			if (kinds[i].sum && n >= 14 + kinds[i].n)
				memset(eth + kinds[i].sum, 0, 2);
			KUNIT_EXPECT_MEMEQ_MSG(test, cut, eth, n, "%s, %zu bytes", kinds[i].what, n);
			b->now += b->gap;
		}
	}
}

/* the longest ones */
static void sim_eth_full_frame_fits(struct kunit *test)
{
	u8 *eth = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	struct bed *b = bed_new(test, 3, 3);
	struct ec_sim_result res;

	for (u32 i = 0; i < 2; i++) {
		size_t at = 12 + kinds[i].n;
		struct ec_frame_buf f;

		frame(eth, kinds[i].head, kinds[i].n);
		ec_frame_begin(&f, eth + at, EC_SIM_ETH_MAX - at);
		memset(ec_frame_add(&f, EC_CMD_BRD, 1, 0, 0x1000, EC_DGRAM_DATA_MAX), 0,
		       EC_DGRAM_DATA_MAX);
		KUNIT_EXPECT_EQ(test, at + ec_frame_end(&f), (size_t)EC_ETH_MAX + 4 * i);
		KUNIT_EXPECT_GT(test, ec_sim_eth(b->sim, 0, eth, EC_ETH_MAX + 4 * i, b->now, &res),
				(s64)0);
		KUNIT_EXPECT_EQ(test, eth[EC_ETH_MAX + 4 * i - 2], 3);
		b->now += 10 * b->gap;
	}
}

/* back through a whole ring no processing unit is on the way */
static void sim_eth_forwarded_frame_is_unchanged(struct kunit *test)
{
	u8 *eth = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	u8 *was = kunit_kzalloc(test, FRAME_MAX, GFP_KERNEL);
	struct bed *b = bed_new(test, 3, 3);
	struct ec_sim_result res;
	size_t len;

	KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, EC_SIM_MASTER1, 0, 2, 1, 100), 0);
	len = frame(eth, kinds[2].head, kinds[2].n);
	memcpy(was, eth, FRAME_MAX);
	KUNIT_EXPECT_GT(test, ec_sim_eth(b->sim, 1, eth, len, b->now, &res), (s64)0);
	KUNIT_EXPECT_EQ(test, res.out_port, 0);
	KUNIT_EXPECT_MEMEQ(test, eth, was, FRAME_MAX);
	b->now += b->gap;
	KUNIT_EXPECT_GT(test, ec_sim_eth(b->sim, 0, eth, len, b->now, &res), (s64)0);
	KUNIT_EXPECT_EQ(test, res.out_port, 1);
	expected(was, 42, 40, 3);
	KUNIT_EXPECT_MEMEQ(test, eth, was, FRAME_MAX);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_eth_ethercat_is_found_in_all_its_covers),
	KUNIT_CASE(sim_eth_other_fields_make_no_difference),
	KUNIT_CASE(sim_eth_other_protocols_are_destroyed),
	KUNIT_CASE(sim_eth_full_frame_fits),
	KUNIT_CASE(sim_eth_forwarded_frame_is_unchanged),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_eth",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
