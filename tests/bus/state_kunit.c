// SPDX-License-Identifier: GPL-2.0-only
/* What an application is told about the bus from activation on, and a reset. */
#include "cyc.h"
#include "kapp.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"
#include "master/session/activate.h"

/* the last one is nobody's */
static const char line[] =
	"segment seed=9 response=100us transition=1ms\n"
	"slave k EK1100\nslave a drive in=8 out=8 soe=1\nslave b drive in=8 out=8\n"
	"slave c EL2008\n";

#define N	4
#define A	1
#define B	2
#define C	3

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
	return bus_status(b);
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
	KUNIT_ASSERT_NE(test, bus_dc_ref_station(b), 0);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, A, 1, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	ref.config = sc.index;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &ref), 0);
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
	KUNIT_EXPECT_EQ(test, bus_dc_ref_station(b), bus_slave(b, B)->station);
}

static u16 al(struct bus *b, u32 position)
{
	return bus_slave(b, position)->al.status;
}

/* A tool has taken one away, another has failed: both come back, the rest stays. */
static void state_reset(struct kunit *test)
{
	struct cyc *c = configure(test);
	struct bus *b = c->b;

	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, B, 0, EC_AL_OP, 0x001e);
	cyc_activate(c);
	cyc_run(c, 2000);
	KUNIT_ASSERT_EQ(test, al(b, A), EC_AL_OP);
	KUNIT_ASSERT_EQ(test, (u32) bus_slave(b, B)->note.error, (u32)EC_SLAVE_CONFIG_FAILED);
	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, B, 0, 0, 0);
	/* what it is to reach does not count for one that has failed, either */
	bus_slave(b, B)->al.requested = EC_AL_PREOP;
	bus_request(b, A, EC_AL_PREOP);
	bus_request(b, C, EC_AL_INIT);
	cyc_run(c, 500);
	KUNIT_ASSERT_EQ(test, al(b, A), EC_AL_PREOP);
	KUNIT_ASSERT_EQ(test, al(b, C), EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	cyc_run(c, 2000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, al(b, A), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, al(b, B), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, al(b, C), EC_AL_INIT);
	/* one in OP is not disturbed */
	c->incomplete = 0;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	/* the way down is not turned back */
	bus_lock(b);
	KUNIT_EXPECT_EQ(test, ec_session_slaves_down(bus_session(b)), 0);
	bus_unlock(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, al(b, A), EC_AL_PREOP);
	cyc_release(c);
	/* without an application nobody wants OP */
	bus_request(b, A, EC_AL_INIT);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, A, EC_AL_INIT, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	msleep(500);
	KUNIT_EXPECT_EQ(test, al(b, A), EC_AL_INIT);
}

struct reset {
	struct work_struct work;
	struct bus *b;
	struct completion done;
	int ret;
};

static void reset(struct work_struct *work)
{
	struct reset *r = container_of(work, struct reset, work);

	r->ret = ec_ioc(&r->b->app, EC_IOC_RESET, NULL);
	complete(&r->done);
}

/* The cycle resets while another caller has the lock of the sessions, and goes on. */
static void state_reset_beside_lock(struct kunit *test)
{
	struct cyc *c = configure(test);
	struct reset r = { .b = c->b, .ret = 1 };

	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_ASSERT_TRUE(test, cyc_all_op(c));
	bus_request(c->b, A, EC_AL_PREOP);
	cyc_run(c, 200);
	KUNIT_ASSERT_EQ(test, al(c->b, A), EC_AL_PREOP);
	init_completion(&r.done);
	INIT_WORK_ONSTACK(&r.work, reset);
	mutex_lock(bus_mutex(c->b));
	schedule_work(&r.work);
	KUNIT_EXPECT_NE(test, wait_for_completion_timeout(&r.done, msecs_to_jiffies(100)), 0ul);
	mutex_unlock(bus_mutex(c->b));
	flush_work(&r.work);
	destroy_work_on_stack(&r.work);
	KUNIT_EXPECT_EQ(test, r.ret, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, al(c->b, A), EC_AL_OP);
}

static void state_reset_kernel(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, A);
	kapp_op(k);
	bus_request(b, A, EC_AL_PREOP);
	kapp_run(k, 500);
	KUNIT_ASSERT_EQ(test, al(b, A), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, ecrt_master_reset(k->m), 0);
	kapp_run(k, 1000);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(state_at_once),
	KUNIT_CASE(state_at_once_kernel),
	KUNIT_CASE(state_no_reference),
	KUNIT_CASE(state_reset),
	KUNIT_CASE(state_reset_beside_lock),
	KUNIT_CASE(state_reset_kernel),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_state",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
