// SPDX-License-Identifier: GPL-2.0-only
/* What an application is told about the bus from activation on. */
#include "cyc.h"
#include "kapp.h"
#include "master/dc.h"
#include "master/ioctl.h"

/* the last one is nobody's */
static const char line[] =
	"segment seed=9 response=100us transition=1ms\n"
	"slave k EK1100\nslave a drive in=8 out=8 soe=1\nslave b drive in=8 out=8\n"
	"slave c EL2008\n";

#define N	4
#define A	1
#define B	2

#define PREOP	(EC_AL_PREOP | EC_STATUS_SC_ONLINE)

static struct cyc *configure(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, A, 2, 0);
	return c;
}

static const struct ec_status *page(const struct bus *b)
{
	return b->m->session->shared->status;
}

/* As it was told before: no time in between in which nobody is there. */
static void state_at_once(struct kunit *test)
{
	struct cyc *c = configure(test);
	const struct ec_status *st;

	cyc_activate(c);
	st = page(c->b);
	KUNIT_EXPECT_EQ(test, st->slaves_responding, (u32)N);
	KUNIT_EXPECT_EQ(test, st->al_states, (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, st->link_up, 1u);
	KUNIT_EXPECT_GE(test, st->link_count, 1u);
	KUNIT_EXPECT_EQ(test, st->links[0].slaves_responding, (u32)N);
	KUNIT_EXPECT_EQ(test, st->links[0].link_up, 1u);
	KUNIT_EXPECT_EQ(test, st->configs[0], PREOP);
	KUNIT_EXPECT_EQ(test, st->configs[1], PREOP);
	KUNIT_EXPECT_EQ(test, st->dc_ref, 1u);
}

static void state_at_once_kernel(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	ec_slave_config_state_t sc;
	ec_master_state_t ms;
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, A);
	kapp_activate(k);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_state(k->sc[A], &sc), 0);
	KUNIT_EXPECT_TRUE(test, sc.online);
	KUNIT_EXPECT_TRUE(test, sc.al_state == EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, ecrt_master_state(k->m, &ms), 0);
	KUNIT_EXPECT_EQ(test, ms.slaves_responding, (u32)N);
	KUNIT_EXPECT_TRUE(test, ms.link_up);
	ecrt_release_master(k->m);
}

static void clocks(struct cyc *c)
{
	c->app_time = ktime_to_ns(c->next);
	c->flags = EC_SEND_FLAG_APP_TIME |
		   (page(c->b)->dc_ref ? EC_SEND_FLAG_SYNC_SLAVES : 0);
}

/*
 * The chosen reference clock is not there: no cycle believes that there is one, though
 * others have clocks, until it comes.
 */
static void state_no_reference(struct kunit *test)
{
	struct cyc *c = configure(test);
	struct bus *b = c->b;
	struct ec_slave *s = bus_slave(b, B);
	struct ec_ioc_slave_config sc = {
		.position = B, .vendor_id = s->info.vendor, .product_code = s->info.product,
	};
	struct ec_ioc_ref_clock ref = { 0 };
	u32 i;

	cyc_release(c);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, B, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, B, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	KUNIT_ASSERT_NE(test, b->m->dc.ref_station, 0);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, A, 1, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc_slave_config(&b->app, &sc), 0);
	ref.config = sc.index;
	KUNIT_ASSERT_EQ(test, ec_ioc_ref_clock(&b->app, &ref), 0);
	c->each = clocks;
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, page(b)->dc_ref, 0u);
	for (i = 0; i < 500; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(test, page(b)->dc_ref, 0u);
	}
	bus_fault(b, EC_SIM_FAULT_POWER_ON, B, 0, 0, 0);
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, page(b)->dc_ref, 1u);
	KUNIT_EXPECT_EQ(test, b->m->dc.ref_station, bus_slave(b, B)->station);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(state_at_once),
	KUNIT_CASE(state_at_once_kernel),
	KUNIT_CASE(state_no_reference),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_state",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
