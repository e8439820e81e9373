// SPDX-License-Identifier: GPL-2.0-only
/* A device that sends nothing before its doorbell: one for all frames of a cycle. */
#include "cyc.h"
#include "slow.h"

#define N	100
#define FRAMES	4	/* of a cycle with N slaves */

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"repeat 100 slave d drive in=24 out=24\n";

static struct cyc *in_op(struct kunit *test, struct slow **s)
{
	struct bus *b = bus_new(test, text);
	struct cyc *c;

	*s = slow_plug(b, 32, 1);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
	c = cyc_in_op(b, 0, N);
	cyc_run(c, 10);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	return c;
}

static void doorbell_once_per_cycle(struct kunit *test)
{
	struct slow *s;
	struct cyc *c = in_op(test, &s);
	u32 rings = slow_doorbells(s), frames = slow_sent(s);

	cyc_run(c, 1000);
	rings = slow_doorbells(s) - rings;
	frames = slow_sent(s) - frames;
	KUNIT_EXPECT_GE(test, frames, 1000u * FRAMES);
	KUNIT_EXPECT_EQ(test, rings, 1000u);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* frames that have come back */
static u64 back(const struct bus *b)
{
	return bus_rx_frames(b);
}

/* the frames before the one that the device refuses must not wait for the next cycle */
static void doorbell_when_last_frame_fails(struct kunit *test)
{
	struct slow *s;
	struct cyc *c = in_op(test, &s);
	u32 rings = slow_doorbells(s);
	u64 frames = back(c->b);

	slow_refuse(s, EC_CMD_LRW, FRAMES - 1, 1);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, slow_to_refuse(s), 0u);
	KUNIT_EXPECT_EQ(test, slow_doorbells(s) - rings, 1u);
	/* they are back before the next send */
	usleep_range(900, 901);
	ec_link_poll(bus_link(c->b, 0));
	KUNIT_EXPECT_EQ(test, back(c->b) - frames, (u64)FRAMES - 1 + FRAMES);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(doorbell_once_per_cycle),
	KUNIT_CASE(doorbell_when_last_frame_fails),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_doorbell",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
