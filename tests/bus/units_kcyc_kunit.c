// SPDX-License-Identifier: GPL-2.0-only
/* Sync units when the kernel runs the cycle: leases, authority, the source of outputs. */
#include "units.h"

#define LEASE	10

/* The application renews one unit and not the other. */
static void lease_of_one(struct kunit *test)
{
	struct bus *b = units_bus(test, 3);
	struct kcyc *a = units_kernel(b, 3, 1, (struct ec_ioc_cycle){ });
	u32 i;

	units_put(b, 0, units_create(b, (struct ec_ioc_unit){ .lease_cycles = LEASE }, "zero"));
	units_put(b, 1, units_create(b, (struct ec_ioc_unit){
		.lease_cycles = LEASE, .flags = EC_UNIT_FLAG_LEASE_HOLD }, "hold"));
	units_begin(a);
	/* without any outputs so far no lease runs */
	KUNIT_EXPECT_EQ(test, units_state(b, 0), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
	units_give(a, 100, 7);
	kcyc_wait_cycles(a, 2);
	for (i = 0; i < 50; i++) {
		units_give(a, 101 + i, 6);
		kcyc_wait_cycles(a, 1);
	}
	kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 150u);
	KUNIT_EXPECT_EQ(test, units_out(b, 2), 150u);
	KUNIT_EXPECT_EQ(test, units_state(b, 0), EC_UNIT_RUN_COMPLETE | EC_UNIT_SENDS_ZERO << 4 |
			EC_UNIT_HAS_AUTHORITY | EC_UNIT_LEASE_ENDED | 1 << 16);
	/* that one is renewed, the other is not: it is held */
	for (i = 0; i < 50; i++) {
		units_give(a, 201 + i, 5);
		kcyc_wait_cycles(a, 1);
	}
	kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 250u);
	KUNIT_EXPECT_LE(test, units_out(b, 1), 201u + LEASE);
	KUNIT_EXPECT_GE(test, units_out(b, 1), 201u + LEASE - 2);
	KUNIT_EXPECT_EQ(test, units_out(b, 2), 250u);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, (u32)EC_CYCLE_STATE_RUNNING);
}

/* The lease ends after so many cycles, and not one earlier. */
static void lease_length(struct kunit *test)
{
	struct bus *b = units_bus(test, 1);
	struct kcyc *a = units_kernel(b, 1, 1, (struct ec_ioc_cycle){ });
	u32 i, cycles;

	units_put(b, 0, units_create(b, (struct ec_ioc_unit){ .lease_cycles = LEASE }, "a"));
	units_begin(a);
	for (i = 0; i < 20; i++) {
		units_give(a, 7, 1);
		kcyc_wait_cycles(a, LEASE);
		KUNIT_EXPECT_EQ(test, units_out(b, 0), 7u);
	}
	KUNIT_EXPECT_EQ(test, units_state(b, 0) >> 16, 0u);
	units_give(a, 7, 1);
	for (cycles = 0; units_out(b, 0) != 0 && cycles < 50; cycles++)
		kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_GE(test, cycles, (u32)LEASE);
	KUNIT_EXPECT_LE(test, cycles, (u32)LEASE + 2);
}

/* Both domains of a unit have to be given. */
static void lease_of_two_domains(struct kunit *test)
{
	struct bus *b = units_bus(test, 2);
	struct kcyc *a = units_kernel(b, 2, 1, (struct ec_ioc_cycle){ });
	u32 u, i;

	u = units_create(b, (struct ec_ioc_unit){ .lease_cycles = LEASE }, "a");
	units_put(b, 0, u);
	units_put(b, 1, u);
	units_begin(a);
	for (i = 0; i < 50; i++) {
		units_give(a, 5, BIT(i % 2));
		kcyc_wait_cycles(a, 2);
	}
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 5u);
	for (i = 0; i < 50; i++) {
		units_give(a, 5, 1);
		kcyc_wait_cycles(a, 1);
	}
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 0u);
}

/* With authority the lease takes it: new outputs alone do not bring it back. */
static void lease_takes_authority(struct kunit *test)
{
	struct bus *b = units_bus(test, 1);
	struct kcyc *a = units_kernel(b, 1, 1, (struct ec_ioc_cycle){ });
	u32 i;

	units_put(b, 0, units_create(b, (struct ec_ioc_unit){
		.lease_cycles = LEASE, .flags = EC_UNIT_FLAG_AUTHORITY }, "a"));
	units_begin(a);
	units_give(a, 5, 1);
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_authority(b, 0, 1), 0);
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 5u);
	kcyc_wait_cycles(a, 2 * LEASE);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_authority(b, 0, 1), -EINPROGRESS);
	for (i = 0; i < 20; i++) {
		units_give(a, 6, 1);
		kcyc_wait_cycles(a, 1);
	}
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_authority(b, 0, 1), 0);
	units_give(a, 6, 1);
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 6u);
}

/* Sent from the buffer of the application: what is held is what was sent, inputs are received. */
static void held_from_buffer(struct kunit *test, struct ec_ioc_cycle cfg)
{
	struct bus *b;
	struct kcyc *a;
	u32 i, held = 0;
	u8 *in;

	b = bus_up(test, "segment seed=35\nrepeat 4 slave s io in=32 out=32\n"
		   "connect s2.1 -> s2.1\nconnect s2.2 -> s2.2\nconnect s2.3 -> s2.3\n", 4);
	bus_idle(b);
	a = units_kernel(b, 2, 2, cfg);
	units_put(b, 0, units_new(b, "a", EC_UNIT_POLICY_HOLD, 0));
	units_begin(a);
	for (i = 0; i < 1200; i++) {
		units_give(a, 0x1000 + i, 3);
		kcyc_wait_cycles(a, 1);
	}
	KUNIT_EXPECT_NOT_NULL(test, bus_direct(b));
	units_dead(b, 0, true);
	for (i = 1; i <= 60; i++) {
		/* the application leaves other values in each of its buffers */
		units_give(a, 0x2000 + i, 3);
		kcyc_wait_cycles(a, 1);
		if (i == 10)
			held = units_out(b, 1);
		if (i > 10)
			KUNIT_ASSERT_EQ(test, units_out(b, 1), held);
		if (i > 2)
			KUNIT_ASSERT_GE(test, units_out(b, 3), 0x2000 + i - 2);
	}
	KUNIT_EXPECT_GT(test, held, 0x2000u);
	KUNIT_EXPECT_LE(test, held, 0x2006u);
	/* the inputs of its neighbor, wired to its outputs */
	in = kcyc_shared(a)->image + (cyc_pd(a->c, 1, 1) - cyc_data(a->c, 0));
	KUNIT_EXPECT_EQ(test, in[0] & 7, (int)held & 7);
	units_dead(b, 0, false);
	for (i = 0; i < 2000 && units_state(b, 0) >> 4 & 0xf; i++) {
		units_give(a, 0x3000, 3);
		kcyc_wait_cycles(a, 1);
	}
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0x3000u);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 0x3000u);
	KUNIT_EXPECT_EQ(test, in[0] & 7, 0x3000 & 7);
}

static void unit_from_buffer(struct kunit *test)
{
	held_from_buffer(test, (struct ec_ioc_cycle){ });
}

/* The same in a hard interrupt. */
static void unit_in_interrupt(struct kunit *test)
{
	held_from_buffer(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_INTERRUPT });
}

/* The worker that moves slaves is started from a hard interrupt. */
static void safeop_in_interrupt(struct kunit *test)
{
	struct bus *b = units_bus(test, 4);
	struct kcyc *a = units_kernel(b, 2, 2, (struct ec_ioc_cycle){
		.flags = EC_CYCLE_FLAG_INTERRUPT });
	u32 i;

	units_put(b, 0, units_new(b, "a", EC_UNIT_POLICY_SAFEOP, 0));
	units_begin(a);
	units_dead(b, 0, true);
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave_at(b, 1)->al.status), EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave_at(b, 2)->al.status), EC_AL_OP);
	units_dead(b, 0, false);
	for (i = 0; i < 3000 && units_authority(b, 0, 1); i++)
		kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave_at(b, 0)->al.status), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave_at(b, 1)->al.status), EC_AL_OP);
}

static struct kcyc *detachable(struct bus *b, struct ec_ioc_unit u, u32 domain)
{
	struct kcyc *a = units_kernel(b, 2, 1, (struct ec_ioc_cycle){
		.flags = EC_CYCLE_FLAG_DETACH });

	units_put(b, domain, units_create(b, u, "a"));
	return a;
}

/* The application dies: the lease of its unit ends. The next one has to have the same units. */
static void unit_detached(struct kunit *test)
{
	struct ec_ioc_unit u = { .lease_cycles = LEASE, .flags = EC_UNIT_FLAG_AUTHORITY };
	struct bus *b = units_bus(test, 2);
	struct kcyc *a = detachable(b, u, 0);

	units_begin(a);
	units_give(a, 9, 3);
	KUNIT_EXPECT_EQ(test, units_authority(b, 0, 1), 0);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 9u);
	bus_end(b);
	msleep(100);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 9u);
	a = detachable(b, u, 1);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), -EEXIST);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "sync unit a"));
	cyc_release(a->c);
	a = detachable(b, u, 0);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	units_give(a, 11, 3);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(b, 1), 11u);
	KUNIT_EXPECT_EQ(test, units_authority(b, 0, 1), 0);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, units_out(b, 0), 11u);
}

/* One lost frame is one bad exchange, also of a domain that is not sent in each cycle. */
static void unit_with_division(struct kunit *test)
{
	struct bus *b = units_bus(test, 2);
	struct kcyc *a = units_kernel(b, 2, 1, (struct ec_ioc_cycle){ });
	struct ec_ioc_division d = { .domain = 1, .division = 10 };
	u32 u = units_new(b, "a", EC_UNIT_POLICY_SAFEOP, 0), i;

	units_put(b, 0, u);
	units_put(b, 1, u);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DIVISION, &d), 0);
	units_begin(a);
	kcyc_wait_cycles(a, 50);
	for (i = 0; i < 40; i++) {
		bus_fault(b, EC_SIM_FAULT_LOSE, -1, -1, 1, 0);
		kcyc_wait_cycles(a, 21);
	}
	KUNIT_EXPECT_GE(test, bus_lost(b), 30ull);
	KUNIT_EXPECT_EQ(test, units_state(b, 0), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
	units_dead(b, 1, true);
	kcyc_wait_cycles(a, 60);
	KUNIT_EXPECT_EQ(test, units_state(b, 0) >> 16, 1u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(lease_of_one),
	KUNIT_CASE(lease_length),
	KUNIT_CASE(lease_of_two_domains),
	KUNIT_CASE(lease_takes_authority),
	KUNIT_CASE(unit_from_buffer),
	KUNIT_CASE(unit_in_interrupt),
	KUNIT_CASE(safeop_in_interrupt),
	KUNIT_CASE(unit_detached),
	KUNIT_CASE(unit_with_division),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_units_kcyc", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
