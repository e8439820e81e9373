// SPDX-License-Identifier: GPL-2.0-only
/* The histogram of sends against their schedule: known lateness, known figures. */
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/cycle/cycle_stats.h"

#define PERIOD_US	1000
#define NOISE_NS	5000	/* time passes when it is read, too */

static const struct ec_status_cycle *status(const struct cyc *c)
{
	return bus_kernel_status(c->b);
}

/* As uapi/ethercat.h says. */
static u64 bucket_from(u32 n)
{
	return n < 8 ? n : (8ull + n % 8) << (n / 8 - 1);
}

/* Sends counted in buckets that begin at @from or above and end before @to. */
static u64 between(const struct ec_status_cycle *st, u64 from, u64 to)
{
	u64 sum = 0;
	u32 i;

	for (i = 0; i < EC_CYCLE_BUCKETS; i++)
		if (bucket_from(i) >= from && bucket_from(i + 1) <= to)
			sum += st->late[i];
	return sum;
}

/* One slave in OP, figures forgotten, schedule settled. */
static struct cyc *start(struct kunit *test, bool told)
{
	struct bus *b = bus_up(test, "slave s io in=8 out=8\n", 1);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, PERIOD_US);
	bus_set_interval_told(b, told);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	cyc_wait_op(c, 3000);
	cyc_run(c, 100);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE_RESET, NULL), 0);
	cyc_run(c, 1);
	KUNIT_ASSERT_EQ(test, status(c)->late_count, 1ull);
	return c;
}

/* late, every so many cycles */
struct lateness {
	u32 us;
	u32 every;
};

static void be_late(struct cyc *c)
{
	const struct lateness *l = c->ctx;

	if (l && c->cycles % l->every == 0)
		udelay(l->us);
}

/* Of 1000 sends 10 are 300 us late, and nothing else is. */
static void expect_ten_late(struct kunit *test, struct cyc *c)
{
	struct lateness late = { .us = 300, .every = 100 };
	const struct ec_status_cycle *st = status(c);
	u64 sum = st->late_sum;

	c->each = be_late;
	c->ctx = &late;
	c->cycles = 1;
	cyc_run(c, 1000);
	c->ctx = NULL;
	KUNIT_EXPECT_EQ(test, st->late_count, 1001ull);
	KUNIT_EXPECT_EQ(test, between(st, 0, 1ull << 32), 1001ull);
	KUNIT_EXPECT_EQ(test, between(st, 278528, 327680), 10ull);
	KUNIT_EXPECT_EQ(test, between(st, 0, 8192), 991ull);
	KUNIT_EXPECT_GT(test, st->late_max, 300000u - NOISE_NS);
	KUNIT_EXPECT_LT(test, st->late_max, 300000u + NOISE_NS);
	KUNIT_EXPECT_GT(test, st->late_sum - sum, 10 * (300000ull - NOISE_NS));
	KUNIT_EXPECT_LT(test, st->late_sum - sum, 10 * 300000ull + 1000 * NOISE_NS);
	KUNIT_EXPECT_EQ(test, st->overruns, 0ull);
}

static void late_uses_configured_interval(struct kunit *test)
{
	struct cyc *c = start(test, true);

	expect_ten_late(test, c);
}

static void late_measured(struct kunit *test)
{
	struct cyc *c = start(test, false);
	struct ec_ioc_cycle_stats info = { 0 };
	struct ec_status_cycle *st = kunit_kzalloc(test, sizeof(*st), GFP_KERNEL);

	expect_ten_late(test, c);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, info.interval_set, 0u);
	KUNIT_EXPECT_GT(test, info.interval_ns, 999000u);
	KUNIT_EXPECT_LT(test, info.interval_ns, 1001000u);
}

static const struct ec_schedule *plan(const struct cyc *c)
{
	return bus_schedule(c->b);
}

/* An interval that is known is not measured again, although sends are late; nothing is lost. */
static void late_known_interval_needs_no_measurement(struct kunit *test)
{
	struct cyc *c = start(test, false);
	u32 gaps = plan(c)->n_gaps;

	cyc_shake(c, 50000, 500);
	cyc_run(c, 5000);
	bus_figure("of 5000 sends of a known interval %u were measured; interval %u ns, %llu sends counted",
		   plan(c)->n_gaps - gaps, plan(c)->interval_ns, status(c)->late_count);
	KUNIT_EXPECT_EQ(test, plan(c)->n_gaps, gaps);
	KUNIT_EXPECT_EQ(test, status(c)->late_count, 5001ull);
	KUNIT_EXPECT_EQ(test, status(c)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, bus_interval_us(c->b), 1000u);
}

/* How many sends of an interval are needed until it is known. */
static u32 until_known(struct cyc *c, u32 us)
{
	u32 n;

	c->period_ns = us * NSEC_PER_USEC;
	for (n = 0; n < 1000; n++) {
		cyc_run(c, 1);
		if (abs((s32)(bus_interval_us(c->b) - us)) <= 2 &&
		    abs((s32)(plan(c)->interval_ns - c->period_ns)) <= 2000)
			break;
	}
	return n + 1;
}

/* One that really changes is noticed, by much soon, and by little. */
static void late_changed_interval_is_noticed(struct kunit *test)
{
	static const struct {
		u32 us, sends;
	} steps[] = { { 2000, 80 }, { 1000, 80 }, { 1030, 256 }, { 990, 256 }, { 250, 80 },
		      { 20000, 80 }, { 1000, 80 } };
	struct cyc *c = start(test, false);
	u32 i, n;

	for (i = 0; i < ARRAY_SIZE(steps); i++) {
		n = until_known(c, steps[i].us);
		bus_figure("interval changed to %u us: known after %u sends", steps[i].us, n);
		KUNIT_EXPECT_LE(test, n, steps[i].sends);
		cyc_run(c, 100);
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CYCLE_RESET, NULL), 0);
		cyc_run(c, 300);
		KUNIT_EXPECT_EQ(test, status(c)->late_count, 300ull);
		KUNIT_EXPECT_LT(test, status(c)->late_max, 2 * NOISE_NS);
		KUNIT_EXPECT_EQ(test, status(c)->overruns, 0ull);
	}
}

/* And soon enough for the frames between two sends. */
static void late_changed_interval_limits_frames_soon(struct kunit *test)
{
	struct cyc *c = start(test, false);

	c->period_ns = 4 * NSEC_PER_MSEC;
	cyc_run(c, 12);
	KUNIT_EXPECT_EQ(test, bus_interval_us(c->b), 4000u);
	c->period_ns = 500 * NSEC_PER_USEC;
	cyc_run(c, 12);
	KUNIT_EXPECT_EQ(test, bus_interval_us(c->b), 500u);
}

/* An interval that was rounded, or another clock: the schedule follows. */
static void late_drift(struct kunit *test)
{
	struct cyc *c = start(test, true);

	c->period_ns = PERIOD_US * 1000 + 900;
	cyc_run(c, 3000);
	KUNIT_EXPECT_LT(test, status(c)->late_max, NOISE_NS);
	c->period_ns = PERIOD_US * 1000 - 900;
	cyc_run(c, 3000);
	KUNIT_EXPECT_LT(test, status(c)->late_max, NOISE_NS);
	KUNIT_EXPECT_EQ(test, status(c)->overruns, 0ull);
}

/* 3.4 ms late: three are left out; the grid stays. */
static void late_overrun(struct kunit *test)
{
	struct cyc *c = start(test, true);
	struct lateness late = { .us = 3400, .every = 1 };

	c->each = be_late;
	c->ctx = &late;
	cyc_run(c, 1);
	c->ctx = NULL;
	KUNIT_EXPECT_EQ(test, status(c)->overruns, 3ull);
	KUNIT_EXPECT_EQ(test, between(status(c), 3145728, 3670016), 1ull);
	/* this application sends what it has left out, at once */
	cyc_run(c, 3);
	KUNIT_EXPECT_EQ(test, status(c)->overruns, 3ull);
	KUNIT_EXPECT_LT(test, status(c)->late_max, 3400000u + NOISE_NS);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, status(c)->overruns, 3ull);
	KUNIT_EXPECT_GE(test, between(status(c), 0, 8192), 100ull);
}

/* Each time is in the bucket the header names; none is lost at the ends. */
static void late_buckets(struct kunit *test)
{
	struct cyc *c = start(test, true);
	struct ec_cycle *cycle = bus_cycle(c->b);
	const struct ec_status_cycle *st = status(c);
	u32 i;

	for (i = 0; i < EC_CYCLE_BUCKETS; i++) {
		u64 was = st->late[i];

		ec_late_count(&cycle->late, bucket_from(i));
		ec_late_count(&cycle->late, bucket_from(i + 1) - 1);
		KUNIT_EXPECT_EQ(test, st->late[i], was + 2);
	}
	KUNIT_EXPECT_EQ(test, bucket_from(EC_CYCLE_BUCKETS), 1ull << 32);
	ec_late_count(&cycle->late, -5);
	KUNIT_EXPECT_EQ(test, st->late_min, 0u);
	ec_late_count(&cycle->late, 1ll << 40);
	KUNIT_EXPECT_EQ(test, st->late_max, U32_MAX);
}

/* The figures outlive the session, until they are reset or the next one begins. */
static void late_kept(struct kunit *test)
{
	struct cyc *c = start(test, true);
	struct ec_ioc_cycle_stats info = { 0 };
	struct ec_status_cycle *st = kunit_kzalloc(test, sizeof(*st), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, st);
	cyc_run(c, 9);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, info.active, 1u);
	KUNIT_EXPECT_EQ(test, info.kind, (u32)EC_CYCLE_BY_APP);
	KUNIT_EXPECT_EQ(test, info.interval_set, 1u);
	KUNIT_EXPECT_EQ(test, info.interval_ns, PERIOD_US * 1000u);
	KUNIT_EXPECT_EQ(test, st->late_count, 10ull);
	cyc_release(c);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, info.active, 0u);
	KUNIT_EXPECT_EQ(test, info.kind, (u32)EC_CYCLE_BY_APP);
	KUNIT_EXPECT_EQ(test, st->late_count, 10ull);
	KUNIT_EXPECT_EQ(test, between(st, 0, 1ull << 32), 10ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CYCLE_RESET, NULL), 0);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, st->late_count, 0ull);
	KUNIT_EXPECT_EQ(test, between(st, 0, 1ull << 32), 0ull);
}

/* A reset is seen at once, though the cyclic caller does it with its next send. */
static void late_reset_pending(struct kunit *test)
{
	struct cyc *c = start(test, true);
	struct ec_ioc_cycle_stats info = { 0 };
	struct ec_status_cycle *st = kunit_kzalloc(test, sizeof(*st), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, st);
	cyc_run(c, 9);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CYCLE_RESET, NULL), 0);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, st->late_count, 0ull);
	KUNIT_EXPECT_EQ(test, st->late_max, 0u);
	cyc_run(c, 5);
	ec_cycle_stats_get(bus_cycles(c->b), &info, st);
	KUNIT_EXPECT_EQ(test, st->late_count, 5ull);
	KUNIT_EXPECT_EQ(test, between(st, 0, 1ull << 32), 5ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(late_uses_configured_interval),
	KUNIT_CASE(late_measured),
	KUNIT_CASE(late_known_interval_needs_no_measurement),
	KUNIT_CASE(late_changed_interval_is_noticed),
	KUNIT_CASE(late_changed_interval_limits_frames_soon),
	KUNIT_CASE(late_drift),
	KUNIT_CASE(late_overrun),
	KUNIT_CASE(late_buckets),
	KUNIT_CASE(late_kept),
	KUNIT_CASE(late_reset_pending),
	{ }
};

static struct kunit_suite suite = { .name = "bus_late", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
