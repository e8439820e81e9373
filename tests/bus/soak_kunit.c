// SPDX-License-Identifier: GPL-2.0-only
/*
 * A long run of the bench at 1 kHz: no frame is lost, every working counter is
 * complete. soak_kunit.cycles=N on the command line of the kernel says how
 * long (EC_UML_ARGS of tests/uml/run.sh); an hour is 3600000.
 *
 * KUnit's limit for a case (300 s) counts virtual time, so the run goes on
 * from one parameter of the case to the next.
 */
#include "cyc.h"

#define BENCH	22
#define STEP	250000u

static unsigned int cycles = 60000;
module_param(cycles, uint, 0444);

static struct {
	struct bus *b;
	struct cyc c;
	u64 t0;
} soak;

static void prepare(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", BENCH);
	struct cyc *c;

	/* it lives longer than this case */
	soak.b = b;
	test->priv = NULL;
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, BENCH, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 100);
	soak.c = *c;
	soak.c.cycles = 0;
	soak.c.incomplete = 0;
	soak.t0 = ktime_get_ns();
}

static const void *next_step(const void *prev, char *desc)
{
	static u32 end;

	if (prev && end >= cycles)
		return NULL;
	end = prev ? min(end + STEP, cycles) : min(STEP, cycles);
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "up to %u cycles", end);
	return &end;
}

static void soak_cycles(struct kunit *test)
{
	u32 end = *(const u32 *)test->param_value;
	u64 ns;

	if (!soak.b)
		prepare(test);
	soak.b->test = test;
	cyc_run(&soak.c, end - soak.c.cycles);
	KUNIT_EXPECT_EQ(test, soak.c.incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(soak.b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_unmatched(soak.b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_late(soak.b), 0ull);
	if (end < cycles)
		return;
	/* wake-ups are some ns apart from the tick */
	ns = ktime_get_ns() - soak.t0 + NSEC_PER_MSEC / 2;
	KUNIT_EXPECT_EQ(test, div_u64(ns, NSEC_PER_MSEC), (u64)cycles);
	bus_row(bus_lost(soak.b) + soak.c.incomplete, 0,
		"lost frames or wrong working counters: %u cycles in virtual time", cycles);
	bus_figure("%u cycles at 1 kHz, %u slaves in OP: %llu lost frames, %llu cycles with a working counter incomplete, in %llu ms of bus time",
		   cycles, BENCH, bus_lost(soak.b), soak.c.incomplete,
		   div_u64(ns, NSEC_PER_MSEC));
}

static void soak_exit(struct kunit_suite *suite)
{
	bus_down(soak.b);
	memset(&soak, 0, sizeof(soak));
}

static struct kunit_case soak_cases[] = {
	KUNIT_CASE_PARAM(soak_cycles, next_step),
	{}
};

static struct kunit_suite soak_suite = {
	.name = "bus_soak",
	.exit = bus_exit,
	.suite_exit = soak_exit,
	.test_cases = soak_cases,
};

kunit_test_suite(soak_suite);

MODULE_LICENSE("GPL");
