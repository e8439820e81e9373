// SPDX-License-Identifier: GPL-2.0-only
/*
 * An application on a computer: its cycles wake up late by 0 to 100 us, one of 500 by half a
 * cycle, it gives the time at which it wanted to wake up, and the computer's clock is 100 ppm
 * faster than those of the drives. If the reference clock is to follow that time
 * (ecrt_master_sync_reference_clock() in each cycle), drives are in OP as soon as without.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"

#define JITTER_NS	50000
#define LATE_EVERY	500
#define HOST_PPB	100000
#define WATCH_S		40	/* after OP, in two halves */
#define MOST_PERCENT	120	/* of the time without */
#define APART_NS	10000	/* while the reference clock learns its rate */
#define APART_THEN_NS	2000
#define OP_LIMIT_MS	30000

struct start {
	u32 drives;
	u32 us;
};

/* what was seen of a start */
struct seen {
	bool leads;
	u64 op_us;	/* from activation to OP */
	u64 since_ns;	/* when that was */
	u64 apart_ns[2];	/* largest difference of a clock to the reference */
	u64 off_ns[2];	/* and of the reference to the application time */
};

static void look(struct cyc *c, struct seen *s)
{
	u64 now = ktime_get_ns(), apart = 0, ref, off;
	u32 i, half = now - s->since_ns > WATCH_S / 2 * (u64)NSEC_PER_SEC;

	ec_sim_advance(c->b->sim, now);
	ref = ec_esc_system_time(bus_esc(c->b, 0), now);
	for (i = 1; i < bus_n_slaves(c->b); i++) {
		s64 d = ec_esc_system_time(bus_esc(c->b, i), now) - ref;

		apart = max_t(u64, apart, abs(d));
	}
	/* the application means the middle of its wake-ups */
	off = abs((s64)(ref - (now - JITTER_NS)));
	s->apart_ns[half] = max(s->apart_ns[half], apart);
	s->off_ns[half] = max(s->off_ns[half], off);
}

static void each(struct cyc *c)
{
	struct seen *s = c->ctx;

	if (s->since_ns)
		look(c, s);
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	if (s->leads)
		c->flags |= EC_SEND_FLAG_SYNC_REF;
	c->app_time = ktime_to_ns(c->next);
	c->sync_time = c->app_time;
}

static void start(struct kunit *test, const struct start *p, struct seen *s)
{
	struct cyc *c = cyc_drives_of(test, p->drives, p->us, HOST_PPB);
	u32 i;

	c->each = each;
	c->ctx = s;
	cyc_shake(c, JITTER_NS, LATE_EVERY);
	cyc_activate(c);
	s->op_us = cyc_wait_op(c, OP_LIMIT_MS);
	s->since_ns = ktime_get_ns();
	cyc_run(c, WATCH_S * USEC_PER_SEC / p->us);
	for (i = 0; i < p->drives; i++)
		KUNIT_EXPECT_TRUE(test, bus_esc(c->b, i)->dc.running);
	bus_down(c->b);
	test->priv = NULL;
}

static const struct start starts[] = {
	{ 1, 1000 }, { 10, 1000 }, { 100, 1000 },
	{ 1, 4000 }, { 10, 4000 }, { 100, 4000 },
	{ 1, 20000 }, { 10, 20000 }, { 100, 20000 },
};

static void describe(const struct start *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%u drive(s), cycle of %u us", p->drives, p->us);
}

KUNIT_ARRAY_PARAM(start, starts, describe);

static void dc_lead_start_takes_as_long_as_without(struct kunit *test)
{
	const struct start *p = test->param_value;
	struct seen without = { 0 }, with = { .leads = true };

	start(test, p, &without);
	start(test, p, &with);
	bus_figure("%u drive(s) with SYNC0, cycle of %u us, jitter: OP %llu us after activation, %llu us with the reference clock synchronized to the application; clocks then within %llu and %llu ns for 20 s, within %llu and %llu ns for 20 s more; reference clock %llu ns off then",
		   p->drives, p->us, without.op_us, with.op_us, without.apart_ns[0],
		   with.apart_ns[0], without.apart_ns[1], with.apart_ns[1], with.off_ns[1]);
	bus_row(with.op_us, without.op_us * MOST_PERCENT / 100,
		"us from activation to OP: %u drive(s), cycle of %u us, reference clock synchronized to the application",
		p->drives, p->us);
	KUNIT_ASSERT_NE(test, without.op_us, ~0ull);
	KUNIT_EXPECT_LE(test, with.op_us * 100, without.op_us * MOST_PERCENT);
	KUNIT_EXPECT_LT(test, with.apart_ns[0], (u64)APART_NS);
	KUNIT_EXPECT_LT(test, with.apart_ns[1], (u64)APART_THEN_NS);
	KUNIT_EXPECT_LT(test, with.off_ns[1], (u64)JITTER_NS);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(dc_lead_start_takes_as_long_as_without, start_gen_params),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_lead", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
