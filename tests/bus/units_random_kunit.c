// SPDX-License-Identifier: GPL-2.0-only
/*
 * Random faults of slaves in eight sync units: in no cycle does a slave of another unit leave OP or
 * get another value than that of its application.
 */
#include <linux/prandom.h>
#include "units.h"
#include "devices/sim/esc_int.h"

#define UNITS	8
#define EACH	6	/* slaves in a unit */
#define SLAVES	(UNITS * EACH + 2)	/* two are in none */
#define NOWHERE	UNITS
#define STEADY	400	/* cycles without a failure after a fault */

#define FAULTS	100	/* in a run: KUnit allows 300 s for a case */

static unsigned int runs = 2;
module_param(runs, uint, 0444);
MODULE_PARM_DESC(runs, "runs of 100 faults");

/* The seed of a run is its number. */
static const void *next_run(const void *prev, char *desc)
{
	static unsigned int run;

	run = prev ? run + 1 : 0;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "seed %u", run);
	return run < runs ? &run : NULL;
}

/* a run and its counts */
struct run {
	struct cyc *c;
	struct rnd_state rng;
	struct ec_app *app[SLAVES];
	u32 dead;		/* slave with a fault, SLAVES: none */
	u64 checks;
	u32 left_op;		/* slaves of other units that were not in OP */
	u32 value;		/* or had another value */
	u32 policy;		/* slaves of the unit with other outputs than its state says */
	u32 stuck;		/* units that were not complete again in time */
	u32 failed;		/* units that have failed */
};

static u32 draw(struct run *r, u32 n)
{
	return prandom_u32_state(&r->rng) % n;
}

/* The low byte of its outputs. */
static u8 low_byte(struct run *r, u32 slave)
{
	u8 v = 0;
	u32 i;

	for (i = 0; i < 8; i++)
		v |= (u8)ec_app_channel(r->app[slave], EC_APP_OUT, i) << i;
	return v;
}

static void check_unit(struct run *r, u32 unit, u32 slave, u8 value)
{
	u32 sends = units_state(r->c->b, unit) >> 4 & 0xf;
	u8 has = low_byte(r, slave);

	if (slave == r->dead)
		return;
	r->policy += sends == EC_UNIT_SENDS_ZERO && has;
	r->policy += sends == EC_UNIT_SENDS_VALUES && has != value;
}

/* A cycle; @unit: the one that has a fault. */
static void one_cycle(struct run *r, u32 unit)
{
	u32 i;

	cyc_run(r->c, 1);
	for (i = 0; i < SLAVES; i++) {
		u8 value = r->c->cycles;

		r->checks++;
		if (i / EACH == unit) {
			check_unit(r, unit, i, value);
			continue;
		}
		r->left_op += bus_esc(r->c->b, i)->mem[EC_REG_AL_STATUS] != EC_AL_OP;
		r->value += low_byte(r, i) != value;
	}
}

static void run_cycles(struct run *r, u32 unit, u32 n)
{
	while (n--)
		one_cycle(r, unit);
}

static bool is_whole(struct run *r, u32 unit)
{
	u32 state = units_state(r->c->b, unit), i;

	for (i = unit * EACH; i < (unit + 1) * EACH; i++)
		if (bus_esc(r->c->b, i)->mem[EC_REG_AL_STATUS] != EC_AL_OP)
			return false;
	return (state & 0xff) == EC_UNIT_RUN_COMPLETE && state & EC_UNIT_HAS_AUTHORITY;
}

static void one_fault(struct run *r)
{
	u32 unit = draw(r, UNITS), slave = unit * EACH + draw(r, EACH), i, n;
	u32 before = units_state(r->c->b, unit) >> 16;

	r->dead = slave;
	switch (draw(r, 4)) {
	case 0:		/* it leaves OP by itself */
		bus_fault(r->c->b, EC_SIM_FAULT_AL_ERROR, slave, -1, 0x1b, 0);
		run_cycles(r, unit, 60);
		break;
	case 1:		/* a loose contact inside of it */
		n = 2 + draw(r, 10);
		for (i = 0; i < n; i++) {
			units_dead(r->c->b, slave, i % 2 == 0);
			run_cycles(r, unit, 1 + draw(r, 6));
		}
		units_dead(r->c->b, slave, false);
		break;
	default:
		units_dead(r->c->b, slave, true);
		run_cycles(r, unit, 1 + draw(r, 60));
		units_dead(r->c->b, slave, false);
	}
	/* a scan may find its fault later */
	for (i = 0, n = 0; i < 5000 && n < STEADY; i++) {
		if (i % 10 == 9 && !is_whole(r, unit))
			units_authority(r->c->b, unit, 1);
		one_cycle(r, unit);
		n = is_whole(r, unit) ? n + 1 : 0;
	}
	r->dead = SLAVES;
	r->stuck += !is_whole(r, unit);
	r->failed += units_state(r->c->b, unit) >> 16 != before;
	run_cycles(r, NOWHERE, 5);
}

static void units_fail_alone(struct kunit *test)
{
	static const struct ec_ioc_unit kinds[UNITS] = {
		{ .policy = EC_UNIT_POLICY_ZERO }, { .policy = EC_UNIT_POLICY_HOLD, .limit = 1 },
		{ .policy = EC_UNIT_POLICY_SAFEOP }, { .policy = EC_UNIT_POLICY_CONTINUE },
		{ .policy = EC_UNIT_POLICY_ZERO, .flags = EC_UNIT_FLAG_AUTHORITY, .limit = 1 },
		{ .policy = EC_UNIT_POLICY_HOLD, .flags = EC_UNIT_FLAG_AUTHORITY },
		{ .policy = EC_UNIT_POLICY_SAFEOP, .limit = 10 },
		{ .policy = EC_UNIT_POLICY_ZERO, .limit = 20 },
	};
	struct run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	char name[8];
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	prandom_seed_state(&r->rng, *(const unsigned int *)test->param_value);
	r->c = units_app(units_bus(test, SLAVES), UNITS, EACH);
	cyc_map_all(r->c, UNITS * EACH, 2, cyc_domain(r->c));
	for (i = 0; i < UNITS; i++) {
		snprintf(name, sizeof(name), "u%u", i);
		units_put(r->c->b, i, units_create(r->c->b, kinds[i], name));
	}
	for (i = 0; i < SLAVES; i++) {
		snprintf(name, sizeof(name), "s%u", i + 1);
		r->app[i] = bus_app(r->c->b, name);
	}
	r->dead = SLAVES;
	cyc_activate(r->c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(r->c, 10000), ~0ull);
	cyc_run(r->c, 50);
	for (i = 0; i < UNITS; i++)
		KUNIT_ASSERT_EQ(test, units_authority(r->c->b, i, 1), 0);
	cyc_run(r->c, 2);
	for (i = 0; i < FAULTS; i++)
		one_fault(r);
	KUNIT_EXPECT_EQ(test, r->left_op, 0u);
	KUNIT_EXPECT_EQ(test, r->value, 0u);
	KUNIT_EXPECT_EQ(test, r->policy, 0u);
	KUNIT_EXPECT_EQ(test, r->stuck, 0u);
	KUNIT_EXPECT_GT(test, r->failed, FAULTS / 3u);
	bus_figure("%u faults in 8 units of 50 slaves: %u failures of units, %llu checks, others: %u not in OP, %u with another value; %u units not complete again",
		   FAULTS, r->failed, r->checks, r->left_op, r->value, r->stuck);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(units_fail_alone, next_run),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_units_random", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
