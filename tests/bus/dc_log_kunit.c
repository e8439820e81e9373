// SPDX-License-Identifier: GPL-2.0-only
/*
 * What the log says of clocks and their configuration, and the interval that is learned
 * from sends, some of which are late.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_job.h"
#include "master/boundary/ioctl.h"

#define DELAY_ONLY_MS	50u	/* as clocks that do not answer they cost 600 ms */

static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

static struct cyc *configure(struct kunit *test, u32 slaves, u32 us)
{
	struct cyc *c = cyc_drives(test, slaves, us);

	c->each = each;
	return c;
}

/* An application of all @slaves, @ms after its activation the clocks are set. */
static struct cyc *synchronized(struct kunit *test, const char *text, u32 slaves, u32 *ms)
{
	struct bus *b = bus_up(test, text, slaves);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, slaves, 0);
	c->each = each;
	cyc_activate(c);
	for (*ms = 0; *ms < 3000 && bus_dc_state(b) != EC_DC_READY; ++*ms)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	return c;
}

/*
 * Slaves with receive times and nothing else of a clock are known from the scan: no
 * warning, no repeated attempt, and their times count for the delays of all.
 */
static void dc_log_delay_only(struct kunit *test)
{
	struct ec_ioc_slave *info = kunit_kzalloc(test, sizeof(*info), GFP_KERNEL);
	const struct ec_sim_step *step;
	u32 invalid = bus_log_lines("no valid reply to DC register access");
	u32 i, alone, ms, late = bus_log_lines("not synchronized");
	struct bus *b;
	struct cyc *c;

	KUNIT_ASSERT_NOT_NULL(test, info);
	synchronized(test, "segment seed=5 response=100us transition=1ms\n"
		     "slave a drive in=8 out=8 drift=20ppm clock=3s\n"
		     "slave z drive in=8 out=8 drift=-30ppm\n", 2, &alone);
	bus_exit(test);
	c = synchronized(test, "segment seed=5 response=100us transition=1ms\n"
			 "slave a drive in=8 out=8 drift=20ppm clock=3s\n"
			 "repeat 20 slave i EL1004 clock=7s cable=200\n"
			 "slave z drive in=8 out=8 drift=-30ppm\n", 22, &ms);
	b = c->b;
	bus_figure("clocks of 2 drives synchronized after %u ms, with 20 delay-only slaves after %u ms",
		   alone, ms);
	bus_row(ms - min(ms, alone), DELAY_ONLY_MS,
		"ms: cost of 20 delay-only slaves at clock start");
	KUNIT_EXPECT_LE(test, ms, alone + DELAY_ONLY_MS);
	cyc_run(c, 3000);
	step = b->sim->route[0].step;
	for (i = 0; i < 22; i++) {
		const struct ec_slave *s = bus_slave(b, i);
		bool only = i && i < 21;

		memset(info, 0, sizeof(*info));
		info->slave.position = i;
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, info), 0);
		KUNIT_EXPECT_EQ(test, (bool)info->dc_delay_only, only);
		KUNIT_EXPECT_EQ(test, (bool)info->dc_set, !only);
		KUNIT_EXPECT_FALSE(test, ec_clock_is_excluded(s));
		KUNIT_EXPECT_FALSE(test, ec_clock_of(s)->delay_unreliable);
		KUNIT_EXPECT_LE(test, abs((s32)(ec_clock_of(s)->delay -
						(step[i].pu_ns - step[0].pu_ns))),
				10);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("no valid reply to DC register access"), invalid);
	KUNIT_EXPECT_EQ(test, bus_log_lines("not synchronized"), late);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	/* none of them can be the reference clock */
	KUNIT_EXPECT_FALSE(test, ec_dc_can_be(bus_dc(b), bus_slave(b, 5)->station));
	KUNIT_EXPECT_TRUE(test, ec_dc_can_be(bus_dc(b), bus_slave(b, 21)->station));
}

/* Delayed sends do not change the interval that was learned. */
static void dc_log_interval_ignores_outliers(struct kunit *test)
{
	struct cyc *c = configure(test, 1, 1000);
	u32 i;

	bus_set_interval_told(c->b, false);
	cyc_activate(c);
	cyc_run(c, 200);
	KUNIT_EXPECT_LE(test, abs((int)bus_interval_us(c->b) - 1000), 10);
	for (i = 0; i < 10; i++) {
		/* one send is 15 ms late */
		c->next = ktime_add_ms(c->next, 15);
		cyc_run(c, 1);
		KUNIT_EXPECT_LE(test, abs((int)bus_interval_us(c->b) - 1000), 10);
		cyc_run(c, 50);
	}
	/* but it follows a cycle that has become another one */
	c->period_ns = 4 * NSEC_PER_MSEC;
	cyc_run(c, 20);
	KUNIT_EXPECT_LE(test, abs((int)bus_interval_us(c->b) - 4000), 40);
}

/* The difference that controllers of which the rate changes have for a while. */
static void disturb(struct cyc *c, u32 first, u32 last)
{
	u32 i, k;

	for (k = 0; k < 100; k++) {
		for (i = first; i <= last; i++)
			bus_esc(c->b, i)->cfg.drift_ppb += k < 50 ? 2000 : -2000;
		cyc_run(c, 50);
	}
}

/* All clocks but one leave the window, for seconds: that is one line, and one when it ends. */
static void dc_log_window_has_one_line(struct kunit *test)
{
	struct cyc *c = configure(test, 22, 4000);
	u32 i, k, out = bus_log_lines("clocks outside the sync window"), in;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_log_lines("clocks outside the sync window"), out);
	in = bus_log_lines("clocks inside the sync window");
	disturb(c, 1, 21);
	KUNIT_EXPECT_EQ(test, bus_log_lines("clocks outside the sync window"), out + 1);
	KUNIT_EXPECT_EQ(test,
			bus_log_lines("21 of 21 clocks outside the sync window, worst: slave "),
			1u);
	for (k = 0; k < 60 && bus_log_lines("clocks inside the sync window") == in; k++)
		cyc_run(c, 250);
	KUNIT_EXPECT_EQ(test, bus_log_lines("clocks inside the sync window"), in + 1);
	/* it names the one that is off most, and by how much: above the limit of 1 us */
	cyc_run(c, 11000 / 4);
	i = bus_log_lines("sync window, worst: slave 7 by ");
	disturb(c, 7, 7);
	KUNIT_EXPECT_EQ(test, bus_log_lines("sync window, worst: slave 7 by "), i + 1);
	KUNIT_EXPECT_EQ(test, bus_log_lines("sync window, worst: slave 7 by 0."), 0u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("clocks outside the sync window"), out + 2);
}

/* Values of AssignActivate that enable nothing, or that the SII does not have. */
static void dc_log_warns_about_assign_activate(struct kunit *test)
{
	static const struct {
		u16 assign;
		const char *words;
		u32 lines;
	} t[] = {
		{ 0x0300, "AssignActivate 0x0300", 0 },
		{ 0x0001, "AssignActivate 0x0001 enables no SYNC signal", 1 },
		{ 0x0200, "AssignActivate 0x0200 enables no SYNC signal", 1 },
		{ 0x0330, "AssignActivate 0x0330 is no operation mode of the SII, which has 0x0300", 1 },
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(t); i++) {
		struct cyc *c = configure(test, 1, 1000);
		u32 before = bus_log_lines(t[i].words);
		struct ec_ioc_sc_dc dc = { .assign_activate = t[i].assign, .cycle0 = 1000000 };

		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_DC, &dc), 0);
		cyc_activate(c);
		cyc_run(c, 1000);
		KUNIT_EXPECT_EQ_MSG(test, bus_log_lines(t[i].words) - before, t[i].lines, "%s",
				    t[i].words);
		bus_down(c->b);
		test->priv = NULL;
	}
}

/* A SYNC0 time beside the cycle: one line names slave, both times and the call. */
static void dc_log_warns_about_sync0_beside_cycle(struct kunit *test)
{
	static const char line[] =
		"EtherCAT 0-0: SYNC0 time 300000 ns does not divide the cycle of 1000 us";
	struct cyc *c = configure(test, 1, 1000);
	u32 before = bus_log_lines(line), all = bus_log_lines("does not divide");
	struct ec_ioc_sc_dc dc = { .assign_activate = 0x0300, .cycle0 = 300000 };

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_DC, &dc), 0);
	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_log_lines(line) - before, 1u);
	bus_down(c->b);
	test->priv = NULL;
	c = configure(test, 1, 1000);
	dc.cycle0 = 500000;
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_DC, &dc), 0);
	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_log_lines("does not divide") - all, 1u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(dc_log_delay_only),
	KUNIT_CASE(dc_log_interval_ignores_outliers),
	KUNIT_CASE(dc_log_window_has_one_line),
	KUNIT_CASE(dc_log_warns_about_assign_activate),
	KUNIT_CASE(dc_log_warns_about_sync0_beside_cycle),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_dc_log", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
