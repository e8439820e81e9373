// SPDX-License-Identifier: GPL-2.0-only
/*
 * Slaves that ignore FRMW get the time of the reference clock by ARMW, which addresses its ring
 * position. Judged by the true time of the modelled clocks.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"

/* frames pass the branch of port 1 before that of port 2, in which the reference clock is */
static const char text[] =
	"segment seed=3\n"
	"slave hub EK1100 drift=-20ppm\n"
	"slave x1 drive in=8 out=8 drift=60ppm cable=30 clock=1s\n"
	"slave x2 drive in=8 out=8 drift=-70ppm clock=3s\n"
	"slave x3 drive in=8 out=8 drift=95ppm clock=77s cable=90\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 drift=-33ppm clock=5s cable=40\n"
	"slave b drive in=8 out=8 drift=88ppm clock=9s frmw=no\n"
	"branch none\nslave n drive in=8 out=8 drift=-8ppm clock=2s\n";

/* in the segment */
enum { HUB, X1, X2, X3, A, B, N };

#define CONNECTED	6u
#define HELD_NS		1000ull	/* clocks that get the time */
#define DRIFTS_NS	50000ull	/* 121 ppm in a second is more */

static void armw_each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_to_ns(c->next) + 123456789;
}

/* How far the clock of @i is from that of @ref, in true time. */
static u64 apart(struct bus *b, u32 i, u32 ref)
{
	u64 now = ktime_get_ns();
	s64 d;

	ec_sim_advance(b->sim, now);
	d = ec_esc_system_time(bus_esc(b, i), now) - ec_esc_system_time(bus_esc(b, ref), now);
	return abs(d);
}

/* The largest distance of the clocks of b and a in some cycles */
static u64 armw_run(struct cyc *c, u32 cycles)
{
	u64 most = 0;

	while (cycles--) {
		cyc_run(c, 1);
		most = max(most, apart(c->b, B, A));
	}
	return most;
}

/* An application with reference clock @ref (configuration), and b marked or not. */
static struct cyc *armw_start(struct kunit *test, const char *segment, u32 ref, bool marked)
{
	struct bus *b = bus_up(test, segment, CONNECTED);
	struct ec_ioc_sc_flag f = { .config = B - 1, .key = EC_FLAG_NO_FRMW, .value = marked };
	struct ec_ioc_ref_clock r = { .config = ref };
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, CONNECTED - 1, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &f), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &r), 0);
	c->each = armw_each;
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	armw_run(c, 3000);
	return c;
}

/* Without the mark the clock of the slave drifts, with it the clock holds. */
static void dc_armw_holds_clock(struct kunit *test)
{
	struct cyc *c = armw_start(test, text, A - 1, false);
	u64 drifts = armw_run(c, 1000), held;

	cyc_release(c);
	bus_exit(test);
	c = armw_start(test, text, A - 1, true);
	held = armw_run(c, 1000);
	bus_figure("clock of a slave that ignores FRMW: %llu ns by FRMW, %llu ns by ARMW", drifts,
		   held);
	KUNIT_EXPECT_GT(test, drifts, DRIFTS_NS);
	KUNIT_EXPECT_LT(test, held, HELD_NS);
	KUNIT_EXPECT_LT(test, apart(c->b, X1, A), 10 * HELD_NS);
	cyc_release(c);
}

/* Until the ring is as the segment has it, and the clocks are set. */
static u64 settle(struct cyc *c, u32 slaves)
{
	u64 most = armw_run(c, 300);
	u32 i;

	for (i = 0; i < 5000 && (bus_n_slaves(c->b) != slaves || !bus_settled(c->b) ||
				 bus_dc_state(c->b) != EC_DC_READY); i++)
		most = max(most, armw_run(c, 1));
	KUNIT_EXPECT_EQ(c->b->test, bus_n_slaves(c->b), slaves);
	return max(most, armw_run(c, 1500));
}

/* ARMW that have read another slave than a */
static u32 wrong_reads(struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i <= N; i++)
		n += i == A ? 0 : bus_esc(b, i)->armw_reads;
	return n;
}

/*
 * Slaves leave and join the ring before the reference clock, among them one whose clock was never
 * set: no frame reads the time of another slave for all.
 */
static void dc_armw_position_changes(struct kunit *test)
{
	struct cyc *c = armw_start(test, text, A - 1, true);
	u64 most = 0;
	u32 i;

	for (i = 0; i < 4; i++) {
		armw_run(c, 11000 * !!i + 137 * i);
		bus_command(c->b, "unplug x1.1");
		bus_command(c->b, "plug x1.1 n.0");
		bus_command(c->b, "plug n.1 x2.0");
		most = max(most, settle(c, CONNECTED + 1));
		bus_command(c->b, "unplug n.0");
		bus_command(c->b, "plug x1.1 x2.0");
		most = max(most, settle(c, CONNECTED));
		bus_command(c->b, "unplug x1.0");
		most = max(most, settle(c, CONNECTED - 3));
		KUNIT_EXPECT_EQ(test, bus_slave(c->b, 1)->station, bus_dc(c->b)->ref_station);
		most = max(most, armw_run(c, 1000));
		bus_command(c->b, "plug hub.1 x1.0");
		most = max(most, settle(c, CONNECTED));
	}
	bus_figure("%u changes before the reference clock: a clock is at most %llu ns apart, %u of %u ARMW read another slave",
		   4 * i, most, wrong_reads(c->b), bus_esc(c->b, A)->armw_reads);
	KUNIT_EXPECT_GT(test, bus_esc(c->b, A)->armw_reads, 50000u);
	KUNIT_EXPECT_EQ(test, wrong_reads(c->b), 0u);
	KUNIT_EXPECT_LT(test, most, 20 * HELD_NS);
	KUNIT_EXPECT_LT(test, armw_run(c, 1000), HELD_NS);
	cyc_release(c);
}

/*
 * The hub does not keep its ports closed: slaves may join before the reference clock, so no ARMW is
 * sent. With the hub as reference clock nothing is before it.
 */
static void dc_armw_open_port(struct kunit *test)
{
	char open[sizeof(text) + 16];
	const char *at = strstr(text, "EK1100") + 6;
	struct cyc *c;
	u32 lines = bus_log_lines("no ARMW is sent");

	scnprintf(open, sizeof(open), "%.*s loops=fixed%s", (int)(at - text), text, at);
	c = armw_start(test, open, A - 1, true);
	armw_run(c, 2000);
	KUNIT_EXPECT_EQ(test, bus_dc(c->b)->armw.at, 0ull);
	KUNIT_EXPECT_GT(test, apart(c->b, B, A), DRIFTS_NS);
	KUNIT_EXPECT_GT(test, bus_log_lines("no ARMW is sent"), lines);
	cyc_release(c);
	bus_exit(test);
	c = armw_start(test, open, EC_UAPI_NONE32, true);
	KUNIT_EXPECT_EQ(test, bus_slave(c->b, 0)->station, bus_dc(c->b)->ref_station);
	armw_run(c, 1000);
	KUNIT_EXPECT_LT(test, apart(c->b, B, HUB), HELD_NS);
	cyc_release(c);
}

/* Frames are lost; the time is only read until the reference clock has replied again. */
static void dc_armw_frames_lost(struct kunit *test)
{
	struct cyc *c = armw_start(test, text, A - 1, true);
	u32 i;

	for (i = 0; i < 50; i++) {
		bus_fault(c->b, EC_SIM_FAULT_LOSE, EC_SIM_MASTER0, 0, 1 + i % 3, 0);
		KUNIT_EXPECT_LT(test, armw_run(c, 20), HELD_NS);
	}
	cyc_release(c);
}

/* The position counts for one clock, and until the next change of a port. */
static void dc_armw_command(struct kunit *test)
{
	u32 changes[2] = { 5, ~0u };
	struct ec_armw a = { .changes = { &changes[0], &changes[1] } };
	u16 adp = 1001;

	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FRMW);
	a.wanted = true;
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FPRD);
	a.at = ec_armw_at(1001, 3, 4);
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_ARMW);
	KUNIT_EXPECT_EQ(test, adp, 0xfffd);
	adp = 1002;
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FPRD);
	KUNIT_EXPECT_EQ(test, adp, 1002);
	adp = 1001;
	changes[0]++;
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FPRD);
	changes[0]--;
	changes[1]++;
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FPRD);
	/* no reference clock */
	a.at = 0;
	changes[0] = 0;
	adp = 0;
	KUNIT_EXPECT_EQ(test, ec_armw_command(&a, &adp), EC_CMD_FPRD);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(dc_armw_command),
	KUNIT_CASE(dc_armw_holds_clock),
	KUNIT_CASE(dc_armw_position_changes),
	KUNIT_CASE(dc_armw_open_port),
	KUNIT_CASE(dc_armw_frames_lost),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_armw", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
