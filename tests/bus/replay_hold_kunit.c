// SPDX-License-Identifier: GPL-2.0-only
/* An application that holds a returned slave in PREOP until it has written its own. */
#include "master/boundary/ioctl.h"
#include "replay.h"

static struct cyc *held(struct kunit *test)
{
	struct ec_ioc_sc_flag f = { .key = EC_FLAG_HOLD, .value = 1 };
	struct cyc *c = replay_configure(test);

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_FLAG, &f), 0);
	replay_put(c, TYPES, 3, 7, 2);
	replay_put(c, TYPES, 4, 5, 4);
	replay_into_op(c);
	return c;
}

static int hold(struct cyc *c, u32 flags, u32 *number)
{
	struct ec_ioc_hold h = { .flags = flags, .hold = *number };
	int ret = ec_ioc(&c->b->app, EC_IOC_HOLD, &h);

	*number = h.hold;
	return ret;
}

static u32 wait_held(struct cyc *c)
{
	u32 i, number = 0;

	for (i = 0; i < 5000 && !number; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(c->b->test, hold(c, 0, &number), 0);
	}
	return number;
}

static void replay_held_slave_waits_in_preop(struct kunit *test)
{
	struct cyc *c = held(test);
	struct bus *b = c->b;
	u32 n = 0;
	char text[EC_UAPI_REASON];

	KUNIT_EXPECT_EQ(test, hold(c, 0, &n), 0);
	KUNIT_EXPECT_EQ(test, n, 0u);
	replay_power_off(c);
	replay_power_on(c);
	n = wait_held(c);
	KUNIT_ASSERT_EQ(test, n, 1u);
	cyc_run(c, 40000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, (u32)bus_slave(b, DRIVE)->note.error, (u32)EC_SLAVE_OK);
	replay_why_text(c, text);
	HAS(test, text, "waiting for the application, which holds it in PREOP (ReinitHold)");
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &b->app, TYPES, 4, 6, 4), 0);
	KUNIT_EXPECT_EQ(test, replay_not(c, TYPES, 4), (u32)EC_REPLAY_WHY_OWN);
	n = 2;
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &n), -ESTALE);
	n = 1;
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &n), 0);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &n), -ESTALE);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 3, 2), 7ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 6ull);
	/* after that nothing is recorded */
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &b->app, TYPES, 8, 6, 4), 0);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 2u);
}

/* Its last value is replayed when the application does not write it itself. */
static void replay_held_slave_lost_again(struct kunit *test)
{
	struct cyc *c = held(test);
	struct bus *b = c->b;
	u32 n, old;

	replay_power_off(c);
	replay_power_on(c);
	old = wait_held(c);
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &b->app, TYPES, 4, 6, 4), 0);
	replay_power_off(c);
	n = 0;
	KUNIT_EXPECT_EQ(test, hold(c, 0, &n), 0);
	KUNIT_EXPECT_EQ(test, n, 0u);
	n = old;
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &n), -ESTALE);
	replay_power_on(c);
	n = wait_held(c);
	KUNIT_EXPECT_EQ(test, n, old + 1);
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &old), -ESTALE);
	KUNIT_EXPECT_NE(test, replay_value(b, TYPES, 4, 4), 6ull);
	KUNIT_EXPECT_EQ(test, hold(c, EC_HOLD_FLAG_RESUME, &n), 0);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 6ull);
}

static void replay_held_slave_is_released(struct kunit *test)
{
	struct cyc *c = held(test);
	struct bus *b = c->b;

	replay_power_off(c);
	replay_power_on(c);
	KUNIT_ASSERT_EQ(test, wait_held(c), 1u);
	cyc_release(c);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_memory(b), 0l);
	KUNIT_EXPECT_NULL(test, ec_setup_of(bus_slave(b, DRIVE))->waits_for);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, DRIVE, 1, 0);
	replay_into_op(c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(replay_held_slave_waits_in_preop),
	KUNIT_CASE(replay_held_slave_lost_again),
	KUNIT_CASE(replay_held_slave_is_released),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_replay_hold", .test_cases = cases, .exit = bus_exit,
};
kunit_test_suite(suite);
