// SPDX-License-Identifier: GPL-2.0-only
/*
 * Sync units in a ring: what fails is judged the same whether slaves are lost by power, by cables
 * or by themselves, and a break that leaves each slave a path is no failure.
 */
#include "ring.h"
#include "units.h"

#define RUN(state)	((state) & 0xf)
#define FAULTS(state)	((state) >> 16)
#define LEASE		10
#define EVENTS		200	/* half of them cuts */

/* How slave 2, or 2 and 3, are lost, and how they return. */
struct way {
	const char *name;
	const char *one;
	const char *both;
	const char *back;
};

static const struct way ways[] = {
	{ "dead", "dead s3", "dead s3;dead s4", "alive s3;alive s4" },
	{ "power", "off s3", "off s3;off s4", "on s3;on s4" },
	{ "cables", "cut s3.0;cut s4.0", "cut s3.0;cut s5.0", "heal s3.0;heal s4.0;heal s5.0" },
	{ "open ring", "cut s3.0;cut s4.0", "cut s3.0;cut s5.0", "heal s3.0;heal s4.0;heal s5.0" },
};

/* What a unit does when they are, in cycles after the event. */
struct act {
	u32 failed;	/* until it has failed */
	u32 zero;	/* until the outputs of slave 3 are zero */
	u32 after;	/* its state then */
	u32 end;	/* and when they are back */
	u8 al[SLAVES];	/* AL states then */
};

static void units_commands(struct bus *b, const char *list)
{
	char line[64], *rest = line, *one;

	strscpy(line, list, sizeof(line));
	while ((one = strsep(&rest, ";")))
		bus_command(b, one);
}

/* Four domains of two slaves; the second and the third are units. */
static struct cyc *two_units(struct bus *b, u32 policy)
{
	struct cyc *c = units_app(b, 4, 2);

	units_put(b, 1, units_new(b, "a", policy, 0));
	units_put(b, 2, units_new(b, "b", EC_UNIT_POLICY_ZERO, 0));
	cyc_activate(c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	return c;
}

/* Slaves of no unit, and of unit "b": these run on with what the application writes. */
static void expect_others(struct cyc *c, const char *when)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		if (i != 2 && i != 3)
			KUNIT_EXPECT_EQ_MSG(c->b->test, units_out(c->b, i),
					    (i + 1) << 24 | (u32)c->cycles, "%s: slave %u", when,
					    i);
	KUNIT_EXPECT_EQ_MSG(c->b->test, units_state(c->b, 1),
			    EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY, "%s", when);
}

static struct act lose(struct cyc *c, const struct way *w, u32 policy, bool both)
{
	struct act a = { .failed = ~0, .zero = ~0 };
	struct bus *b = c->b;
	u32 i;

	if (!strcmp(w->name, "open ring")) {
		bus_command(b, "cut s3.0");
		cyc_run(c, 300);
		KUNIT_EXPECT_EQ(b->test, FAULTS(units_state(b, 0)), 0u);
	}
	units_commands(b, both ? w->both : w->one);
	for (i = 1; i <= 300; i++) {
		cyc_run(c, 1);
		if (RUN(units_state(b, 0)) == EC_UNIT_RUN_FAILED)
			a.failed = min(a.failed, i);
		if (!units_out(b, 3))
			a.zero = min(a.zero, i);
		/* the frame of the event may be lost */
		if (i > 5 && policy != EC_UNIT_POLICY_STOP)
			expect_others(c, w->name);
	}
	a.after = units_state(b, 0);
	units_commands(b, w->back);
	cyc_run(c, 3000);
	for (i = 0; i < 3000 && units_authority(b, 0, 1) == -EINPROGRESS; i++)
		cyc_run(c, 1);
	cyc_run(c, 500);
	a.end = units_state(b, 0);
	for (i = 0; i < SLAVES; i++) {
		a.al[i] = READ_ONCE(bus_slave(b, i)->al.status);
		KUNIT_EXPECT_EQ_MSG(b->test, units_out(b, i), (i + 1) << 24 | (u32)c->cycles,
				    "%s: slave %u", w->name, i);
	}
	ring_closed(b, SLAVES);
	return a;
}

static const u32 policies[] = {
	EC_UNIT_POLICY_CONTINUE, EC_UNIT_POLICY_ZERO, EC_UNIT_POLICY_HOLD, EC_UNIT_POLICY_SAFEOP,
	EC_UNIT_POLICY_STOP,
};

static void policy_desc(const u32 *policy, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "policy %u", *policy);
}

KUNIT_ARRAY_PARAM(policy, policies, policy_desc);

/* A policy acts the same whichever way the slaves of its unit are lost. */
static void unit_way_of_loss(struct kunit *test)
{
	u32 policy = *(const u32 *)test->param_value, i, k;
	struct bus *b = units_ring(test, SLAVES);
	struct act first[2], a;

	for (i = 0; i < 2 * ARRAY_SIZE(ways); i++) {
		const struct way *w = &ways[i / 2];
		struct cyc *c = two_units(b, policy);

		a = lose(c, w, policy, i % 2);
		if (i < 2)
			first[i] = a;
		/* power and cables lose the frame as well, and the slaves a cycle earlier */
		KUNIT_EXPECT_LE_MSG(test, abs((int)(a.failed - first[i % 2].failed)), 1, "%s: %u, %u",
				    w->name, a.failed, first[i % 2].failed);
		if (!(i % 2) && policy != EC_UNIT_POLICY_CONTINUE && policy != EC_UNIT_POLICY_HOLD)
			KUNIT_EXPECT_LE_MSG(test, abs((int)(a.zero - first[0].zero)), 1,
					    "%s: %u, %u", w->name, a.zero, first[0].zero);
		KUNIT_EXPECT_EQ_MSG(test, a.after, first[i % 2].after, "%s", w->name);
		KUNIT_EXPECT_EQ_MSG(test, a.end, first[i % 2].end, "%s", w->name);
		for (k = 0; k < SLAVES; k++)
			KUNIT_EXPECT_EQ_MSG(test, a.al[k], EC_AL_OP, "%s: slave %u", w->name, k);
		cyc_release(c);
		bus_idle(b);
	}
	bus_figure("unit with policy %u in a ring: failed %u cycles after the loss of one slave, %u of both",
		   policy, first[0].failed, first[1].failed);
}

/* A slave that leaves OP by itself still counts; its AL state is read on both sides of a break. */
static void unit_leaves_op(struct kunit *test)
{
	struct bus *b = units_ring(test, SLAVES);
	struct cyc *c = two_units(b, EC_UNIT_POLICY_ZERO);
	u32 cables[] = { CUTS, 1, 5 }, k, n;

	for (k = 0; k < ARRAY_SIZE(cables); k++) {
		if (cables[k] < CUTS)
			ring_cable(b, true, cables[k]);
		cyc_run(c, 300);
		bus_command(b, "error s3 code=0x1b");
		for (n = 0; n < 100 && RUN(units_state(b, 0)) == EC_UNIT_RUN_COMPLETE; n++)
			cyc_run(c, 1);
		/* 20 ms until it is read, and three receives */
		KUNIT_EXPECT_LE_MSG(test, n, 25u, "cable %u", cables[k]);
		expect_others(c, "left OP");
		cyc_run(c, 1000);
		bus_request(b, 2, EC_AL_OP);
		cyc_run(c, 500);
		KUNIT_EXPECT_EQ(test, RUN(units_state(b, 0)), (u32)EC_UNIT_RUN_COMPLETE);
		if (cables[k] < CUTS)
			ring_cable(b, false, cables[k]);
		cyc_run(c, 300);
	}
}

/* One unit of all slaves: cut at each cable, and at random. */
static void unit_at_both_sides(struct kunit *test)
{
	struct bus *b = units_ring(test, SLAVES);
	struct cyc *c = units_app(b, 2, 4);
	struct rnd_state rnd;
	u32 at = 0, i, u;

	u = units_create(b, (struct ec_ioc_unit){ .policy = EC_UNIT_POLICY_SAFEOP, .limit = 2 },
			 "all");
	units_put(b, 0, u);
	units_put(b, 1, u);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	for (i = 0; i < 2 * CUTS; i++) {
		ring_cable(b, !(i % 2), i / 2);
		cyc_run(c, 300);
		KUNIT_EXPECT_EQ_MSG(test, units_state(b, 0),
				    EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY, "cable %u",
				    i / 2);
	}
	prandom_seed_state(&rnd, 37);
	for (i = 0; i < EVENTS; i++) {
		at = ring_next_cut(b, at, i % 2, prandom_u32_state(&rnd) % CUTS);
		ring_cable_of(b, !(i % 2), at, SLAVES,
			      NSEC_PER_MSEC + prandom_u32_state(&rnd) % (NSEC_PER_MSEC / 4));
		cyc_run(c, 2 + prandom_u32_state(&rnd) % 200);
	}
	cyc_run(c, 300);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_EQ(test, units_state(b, 0), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
	bus_figure("unit of all slaves of a ring, limit 2: %u breaks and repairs, %u faults",
		   2 * CUTS + EVENTS, FAULTS(units_state(b, 0)));
}

/* The copies of repeated frames are joined one by one. */
static void unit_repeats_in_ring(struct kunit *test)
{
	struct bus *b = units_ring(test, SLAVES);
	struct cyc *c = units_app(b, 2, 4);
	struct ec_ioc_sc_flag f = { .value = 1, .key = "FrameRepeatSupport" };
	u32 i, incomplete;

	units_put(b, 0, units_create(b, (struct ec_ioc_unit){
		.policy = EC_UNIT_POLICY_ZERO, .repeats = 3, .limit = 2 }, "a"));
	for (f.config = 0; f.config < 4; f.config++)
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &f), 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	for (i = 0; i < 2 * CUTS; i++) {
		ring_cable(b, !(i % 2), i / 2);
		cyc_run(c, 300);
		KUNIT_EXPECT_EQ_MSG(test, units_state(b, 0),
				    EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY, "cable %u",
				    i / 2);
		incomplete = c->incomplete;
		/* one of the copies is lost */
		bus_fault(b, EC_SIM_FAULT_LOSE, -1, -1, 3 + i % 4, 0);
		cyc_run(c, 20);
		bus_fault(b, EC_SIM_FAULT_LOSE, -1, -1, 0, 0);
		cyc_run(c, 5);
		KUNIT_EXPECT_EQ_MSG(test, units_state(b, 0),
				    EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY, "lost %u", i / 2);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, 12u);
		KUNIT_EXPECT_LE(test, c->incomplete, incomplete + 20ull);
	}
}

/* Cycles until the lease of unit 0 has ended and slave @slave has no outputs. */
static u32 ends_after(struct kcyc *a, u32 slave)
{
	u32 n = 0;

	while (units_out(a->c->b, slave) && n < 50) {
		kcyc_wait_cycles(a, 1);
		units_give(a, 9, BIT(1));
		n++;
	}
	return n;
}

/* It ends when the application does not give outputs, and by nothing else. */
static void unit_lease_in_ring(struct kunit *test)
{
	struct bus *b = units_ring(test, SLAVES);
	struct kcyc *a = units_kernel(b, 2, 4, (struct ec_ioc_cycle){ });
	u32 i, k, closed, open, gone;

	units_put(b, 0, units_create(b, (struct ec_ioc_unit){ .lease_cycles = LEASE }, "a"));
	units_put(b, 1, units_create(b, (struct ec_ioc_unit){ .lease_cycles = LEASE }, "b"));
	units_begin(a);
	units_give(a, 7, 3);
	kcyc_wait_cycles(a, 2);
	for (i = 0; i < 2 * CUTS; i++) {
		ring_cable(b, !(i % 2), i / 2);
		for (k = 0; k < 40; k++) {
			units_give(a, 100 + k, 3);
			kcyc_wait_cycles(a, LEASE - 1);
			KUNIT_EXPECT_EQ_MSG(test, units_state(b, 0), EC_UNIT_RUN_COMPLETE |
					    EC_UNIT_HAS_AUTHORITY, "cable %u", i / 2);
			KUNIT_EXPECT_EQ_MSG(test, units_state(b, 1), EC_UNIT_RUN_COMPLETE |
					    EC_UNIT_HAS_AUTHORITY, "cable %u", i / 2);
		}
	}
	ring_closed(b, SLAVES);
	units_give(a, 8, 3);
	kcyc_wait_cycles(a, 2);
	closed = ends_after(a, 0);
	/* slaves 0 and 1 before the break, 2 and 3 behind it */
	ring_cable(b, true, 2);
	units_give(a, 8, 3);
	kcyc_wait_cycles(a, 200);
	units_give(a, 8, 3);
	kcyc_wait_cycles(a, 2);
	open = ends_after(a, 3);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_NE(test, units_out(b, 4), 0u);
	/* those behind it are lost: the lease of the others is as long */
	units_give(a, 8, 3);
	kcyc_wait_cycles(a, 2);
	ring_cable(b, true, 4);
	units_give(a, 8, 3);
	kcyc_wait_cycles(a, 2);
	gone = ends_after(a, 0);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 0u);
	bus_figure("lease of %u cycles in a ring: ends after %u, open %u, with slaves lost %u",
		   LEASE, closed, open, gone);
	KUNIT_EXPECT_EQ(test, open, closed);
	KUNIT_EXPECT_LE(test, gone, closed);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(unit_way_of_loss, policy_gen_params),
	KUNIT_CASE(unit_leaves_op),
	KUNIT_CASE(unit_at_both_sides),
	KUNIT_CASE(unit_repeats_in_ring),
	KUNIT_CASE(unit_lease_in_ring),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_units", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
