// SPDX-License-Identifier: GPL-2.0-only
/* Replies to the cycle that stay in the memory of the device, and are read there. */
#include "cyc.h"
#include "slow.h"

#define N	8

/* three frames a cycle; what s1 is told it shows */
static const char text[] =
	"segment seed=5 response=100us transition=1ms\n"
	"repeat 8 slave s io in=1600 out=1600\nconnect s1.1 -> s1.1\n";

static void show_cycle(struct cyc *c)
{
	put_unaligned_le32(c->cycles, cyc_pd(c, 0, 0));
}

/* what comes back is of one of the last cycles */
static void count_up(struct cyc *c)
{
	u32 seen = get_unaligned_le32(cyc_pd(c, 0, 1));

	KUNIT_ASSERT_LT(c->b->test, seen, (u32)c->cycles);
	KUNIT_ASSERT_GE(c->b->test, seen + 4, (u32)c->cycles);
	show_cycle(c);
}

static struct cyc *in_op(struct kunit *test)
{
	struct bus *b = bus_new(test, text);
	struct cyc *c;

	slow_plug(b, 32, 1);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
	c = cyc_in_op(b, 0, N);
	KUNIT_ASSERT_GE(test, bus_n_dgrams(b), 3u);
	c->each = show_cycle;
	cyc_run(c, 5);
	c->each = count_up;
	c->incomplete = 0;
	return c;
}

/* slots whose last reply was read where the device had it */
static u32 kept(const struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < EC_SLOTS; i++) {
		const struct ec_slot *s = bus_slot(b, i);

		n += s->reply && (s->reply < s->frame || s->reply >= s->frame + EC_ETH_MAX);
	}
	return n;
}

static void kept_in_device(struct kunit *test)
{
	struct cyc *c = in_op(test);

	cyc_run(c, 1000);
	KUNIT_EXPECT_GE(test, kept(c->b), EC_SLOTS * 3u / 4);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* A poll between two calls of the cycle: what it brings has to outlive the next poll. */
static void kept_not_between_calls(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ec_link *link = bus_link(c->b, 0);
	u64 frames, between = 0;
	u32 i;

	for (i = 0; i < 200; i++) {
		cyc_run(c, 1);
		usleep_range(700, 701);
		frames = atomic64_read(&link->stats.rx_frames);
		ec_link_poll(link);
		between += atomic64_read(&link->stats.rx_frames) - frames;
	}
	KUNIT_EXPECT_GE(test, between, 200 * 3ull);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kept_in_device),
	KUNIT_CASE(kept_not_between_calls),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kept",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
