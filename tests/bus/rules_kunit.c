// SPDX-License-Identifier: GPL-2.0-only
/* What applications written for the field's interface depend on. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"
#include "master/config/why.h"

#define TWO	"slave a drive in=8 out=8 drift=40ppm clock=3s cable=50\n" \
		"slave b drive in=8 out=8 drift=-70ppm clock=9s cable=30\n"
#define CYCLE	1000000

/* what the application's clock is ahead of the master's */
static u64 ahead;

static u64 app_now(void)
{
	return ktime_get_ns() + ahead;
}

/* time to the reference clock, from there to all, in every cycle */
static void follow_app(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES |
		   EC_SEND_FLAG_REF_TIME;
	c->app_time = app_now();
	c->sync_time = c->app_time;
}

static void tell(struct bus *b, u64 app_time)
{
	struct ec_ioc_app_time t = { .app_time = app_time };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_APP_TIME, &t), 0);
}

static struct cyc *with_sync(struct bus *b, s32 shift)
{
	struct ec_ioc_sc_dc dc = { .assign_activate = 0x0300, .cycle0 = CYCLE, .shift0 = shift };
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	for (dc.config = 0; dc.config < 2; dc.config++)
		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	c->each = follow_app;
	return c;
}

/* SYNC0 of both slaves lies on the application's grid, shifted; both keep one time. */
static void expect_grid(struct cyc *c, u64 phase, s32 shift)
{
	struct kunit *test = c->b->test;
	u64 now, t[2];
	u32 i;

	for (i = 0; i < 2; i++) {
		const u8 *mem = bus_esc(c->b, i)->mem;
		s64 d = get_unaligned_le64(mem + EC_REG_DC_START) - phase - shift;
		s32 rest;

		div_s64_rem(d, CYCLE, &rest);
		KUNIT_EXPECT_EQ(test, rest, 0);
		KUNIT_EXPECT_EQ(test, mem[EC_REG_DC_ACTIVATION], 3);
		/* the first one was in the future: it is told as pending no more */
		KUNIT_EXPECT_EQ(test, bus_slave(c->b, i)->note.error, EC_SLAVE_OK);
	}
	cyc_run(c, 5000);	/* what the reference was off is made up for */
	now = ktime_get_ns();
	ec_sim_advance(c->b->sim, now);
	for (i = 0; i < 2; i++) {
		t[i] = ec_esc_system_time(bus_esc(c->b, i), now);
		/* a few cycles, no more: the reference follows the application */
		KUNIT_EXPECT_LT(test, abs((s64)(t[i] - (now + ahead))), 5ll * CYCLE);
	}
	KUNIT_EXPECT_LT(test, abs((s64)(t[1] - t[0])), 1000ll);
}

/* a time below zero before activation, decades later in the cycle */
static void jump(struct kunit *test, u64 before, u64 in_cycle, u32 pause_ms)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = with_sync(b, 0);

	ahead = before;
	tell(b, app_now());
	tell(b, app_now() + 1);		/* the first one counts */
	ahead = in_cycle;
	cyc_activate(c);
	msleep(pause_ms);
	c->next = ktime_get();
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 8000), ~0ull);
	expect_grid(c, bus_dc_phase(b), 0);
	ahead = 0;
}

static void rules_time_below_zero(struct kunit *test)
{
	jump(test, -946684800ull * NSEC_PER_SEC, 848000000ull * NSEC_PER_SEC, 0);
}

static void rules_time_jumps_after_pause(struct kunit *test)
{
	jump(test, -946684800ull * NSEC_PER_SEC, 848000000ull * NSEC_PER_SEC, 300);
}

static void rules_time_jumps_back(struct kunit *test)
{
	jump(test, 848000000ull * NSEC_PER_SEC, 1000ull * NSEC_PER_SEC, 0);
}

static void shifted(struct kunit *test, s32 shift)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = with_sync(b, shift);
	u32 i;

	ahead = 848000000ull * NSEC_PER_SEC;
	tell(b, app_now());
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 8000), ~0ull);
	expect_grid(c, bus_dc_phase(b), shift);
	for (i = 0; i < 2; i++)		/* and in the future when it was set */
		KUNIT_EXPECT_GT(test, get_unaligned_le64(bus_esc(b, i)->mem + EC_REG_DC_START),
				bus_dc_phase(b));
	ahead = 0;
}

static void rules_shift_of_almost_one_period(struct kunit *test)
{
	shifted(test, CYCLE - 1000);
}

static void rules_shift_backwards(struct kunit *test)
{
	shifted(test, -250000);
}

/* Deactivating what was never activated frees nothing; afterwards all is new. */
static void rules_deactivate(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct ec_ioc_domain_offset at = { 0 };
	u32 round;

	bus_idle(b);
	for (round = 0; round < 3; round++) {
		struct cyc *c = cyc_new(b, 1000);

		cyc_domain(c);
		if (round == 1)
			cyc_domain(c);
		cyc_map_all(c, 0, 2, round == 1);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), -EINVAL);
		KUNIT_EXPECT_EQ(test, bus_wanted(b)->n_configs, 2u);
		cyc_activate(c);
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
		KUNIT_EXPECT_EQ(test, bus_wanted(b)->n_configs, 0u);
		KUNIT_EXPECT_EQ(test, bus_wanted(b)->n_domains, 0u);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OFFSET, &at), -ENOENT);
		KUNIT_EXPECT_FALSE(test, bus_dc_has_phase(b));
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), -EINVAL);
		bus_idle(b);
		KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
		cyc_release(c);
	}
}

/* The same slave twice is one configuration; as another device it is none. */
static void rules_configured_twice(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_slave_config sc = { .position = 0, .vendor_id = 1, .product_code = 2 };
	u32 first = cyc_config(c, 0);

	KUNIT_EXPECT_EQ(test, cyc_config(c, 0), first);
	KUNIT_EXPECT_EQ(test, bus_wanted(b)->n_configs, 1u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), -ENOENT);
	/* nobody is there: no error, the handle is good */
	sc.position = 17;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_EXPECT_EQ(test, cyc_config_status(b, sc.index), 0);
}

static int pdo(struct bus *b, u8 op, u8 sm, u16 index, u32 entry)
{
	struct ec_ioc_sc_pdo p = {
		.op = op, .sm = sm, .pdo = index, .entry_index = entry >> 16,
		.subindex = entry >> 8, .bits = entry,
	};

	return ec_ioc(&b->app, EC_IOC_SC_PDO, &p);
}

/* PDOs of a slave that is not there, with gaps; what is not assigned. */
static void rules_explicit_mapping(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_slave_config sc = { .position = 9, .vendor_id = 1, .product_code = 2 };
	struct ec_ioc_sc_sync sync = { .sm = 3, .dir = 2 };
	struct ec_ioc_reg_entry e = { .entry_index = 0x6000, .subindex = 2 };
	struct ec_ioc_domain d = { 0 };

	cyc_domain(c);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_MAP_CLEAR, 0, 0x1a00, 0), 0);
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_MAP_ADD, 0, 0x1a00, 0x60000108), -ENOENT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &e), -ENOENT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sync), 0);
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_ASSIGN_ADD, 3, 0x1a00, 0), 0);
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_MAP_ADD, 0, 0x1a00, 0x60000103), 0);
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_MAP_ADD, 0, 0x1a00, 0x0000000e), 0);	/* gap */
	KUNIT_EXPECT_EQ(test, pdo(b, EC_SC_PDO_MAP_ADD, 0, 0x1a00, 0x60000201), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &e), 0);
	KUNIT_EXPECT_EQ(test, e.offset, 2u);
	KUNIT_EXPECT_EQ(test, e.bit, 1u);
	e.offset = 99;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &e), 0);	/* again */
	KUNIT_EXPECT_EQ(test, e.offset, 2u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN, &d), 0);
	KUNIT_EXPECT_EQ(test, d.size, 3u);	/* known before activation */
}

/* The one flag with a number that changes something. */
static void rules_wait_before_safeop(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_sc_flag flag = { .config = 1, .key = "WaitBeforeSAFEOPms", .value = 700 };
	u64 us;

	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &flag), 0);
	cyc_activate(c);
	us = cyc_wait_op(c, 5000);
	KUNIT_ASSERT_NE(test, us, ~0ull);
	KUNIT_EXPECT_GE(test, us, 700000ull);
	KUNIT_EXPECT_LT(test, us, 1200000ull);
}

/* The end of a session does not wait for that time. */
static void rules_wait_ends_on_release(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_sc_flag flag = { .config = 1, .key = "WaitBeforeSAFEOPms", .value = 50000 };
	u64 t0;

	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &flag), 0);
	cyc_activate(c);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_NOT_NULL(test, ec_setup_of(bus_slave(b, 1))->waits_for);
	t0 = ktime_get_ns();
	cyc_release(c);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 100ull * NSEC_PER_MSEC);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(rules_time_below_zero),
	KUNIT_CASE(rules_time_jumps_after_pause),
	KUNIT_CASE(rules_time_jumps_back),
	KUNIT_CASE(rules_shift_of_almost_one_period),
	KUNIT_CASE(rules_shift_backwards),
	KUNIT_CASE(rules_deactivate),
	KUNIT_CASE(rules_configured_twice),
	KUNIT_CASE(rules_explicit_mapping),
	KUNIT_CASE(rules_wait_before_safeop),
	KUNIT_CASE(rules_wait_ends_on_release),
	{ }
};

static struct kunit_suite suite = { .name = "bus_rules", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
