// SPDX-License-Identifier: GPL-2.0-only
/*
 * The delay of a cable changes while a cycle runs, without any event: the master follows it, in
 * frames of the cycle. By the true time of the modelled clocks.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/clock/dc_track.h"
#include "master/boundary/ioctl.h"

static const char text[] =
	"segment seed=5\n"
	"slave hub EK1100 drift=-20ppm\n"
	"slave x1 drive in=8 out=8 drift=60ppm cable=30 clock=1s\n"
	"slave x2 drive in=8 out=8 drift=-70ppm clock=3s\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 drift=-33ppm clock=5s cable=40\n"
	"slave b drive in=8 out=8 drift=88ppm clock=9s\n"
	"slave c drive in=8 out=8 drift=8ppm clock=4s\n";

enum { HUB, X1, X2, A, B, C, SLAVES };

#define LIMIT_NS	100ull	/* by which SYNC0 of running slaves may move */
#define ERROR_NS	10u	/* of a delay, with 10 ns of noise in receive times */

/* what is known of a run */
struct run {
	struct bus *b;
	struct cyc *c;
	u64 offset[SLAVES];
	u32 delay[SLAVES];	/* at the last look */
	u32 step;		/* largest change of a delay in a cycle, ns */
	u64 moved;		/* largest difference of a clock to the reference clock, ns */
};

static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_to_ns(c->next) + 123456789;
}

static u32 delay_of(struct bus *b, u32 i)
{
	return get_unaligned_le32(bus_esc(b, i)->mem + EC_REG_DC_DELAY);
}

static u64 offset_of(struct bus *b, u32 i)
{
	return get_unaligned_le64(bus_esc(b, i)->mem + EC_REG_DC_OFFSET);
}

static void track_look(struct run *r)
{
	u64 now = ktime_get_ns(), t;
	u32 i;

	ec_sim_advance(r->b->sim, now);
	t = ec_esc_system_time(bus_esc(r->b, HUB), now);
	for (i = X1; i < SLAVES; i++) {
		s64 d = ec_esc_system_time(bus_esc(r->b, i), now) - t;
		u32 delay = delay_of(r->b, i);

		r->moved = max_t(u64, r->moved, abs(d));
		r->step = max_t(u32, r->step, abs((s32)(delay - r->delay[i])));
		r->delay[i] = delay;
	}
}

static void track_run(struct run *r, u32 cycles)
{
	while (cycles--) {
		cyc_run(r->c, 1);
		track_look(r);
	}
}

static struct run *track_start(struct kunit *test)
{
	struct run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->b = bus_up(test, text, SLAVES);
	bus_idle(r->b);
	r->c = cyc_new(r->b, 1000);
	cyc_domain(r->c);
	cyc_map_all(r->c, 1, SLAVES - 1, 0);
	cyc_sync0(r->c, SLAVES - 1);
	r->c->each = each;
	cyc_activate(r->c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(r->c, 5000), ~0ull);
	track_run(r, 5000);
	for (i = 0; i < SLAVES; i++)
		r->offset[i] = offset_of(r->b, i);
	r->moved = 0;
	r->step = 0;
	return r;
}

/* Without an event: both ends of the cable keep their links. */
static void lengthen(struct bus *b, u32 slave, u32 port, s32 by)
{
	struct ec_esc_port *a = &bus_esc(b, slave)->port[port];
	struct ec_esc_port *z = &bus_esc(b, a->peer)->port[a->peer_port];

	a->cable_ns += by;
	z->cable_ns += by;
	b->sim->dirty = true;
}

static u32 worst_error(struct bus *b)
{
	const struct ec_sim_route *r = &b->sim->route[0];
	u32 i, max = 0;

	for (i = X1; i < SLAVES; i++) {
		s32 is = r->step[bus_esc(b, i)->route_pos[0]].pu_ns - r->step[0].pu_ns;

		max = max_t(u32, max, abs((s32)delay_of(b, i) - is));
	}
	return max;
}

static void expect_followed(struct run *r, const char *what)
{
	struct kunit *test = r->b->test;
	u32 i, error = worst_error(r->b);

	bus_figure("%s: SYNC0 moves by %llu ns, delays by %u ns a cycle, and are wrong by %u ns",
		   what, r->moved, r->step, error);
	KUNIT_EXPECT_LE(test, error, ERROR_NS);
	KUNIT_EXPECT_LT(test, r->moved, LIMIT_NS);
	KUNIT_EXPECT_LE(test, r->step, 1u);
	for (i = 0; i < SLAVES; i++) {
		KUNIT_EXPECT_EQ(test, offset_of(r->b, i), r->offset[i]);
		KUNIT_EXPECT_EQ(test, bus_esc(r->b, i)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	}
	r->moved = 0;
	r->step = 0;
}

/* A cable before all of a branch, and one at its end */
static void track_follows_cables(struct kunit *test)
{
	struct run *r = track_start(test);

	lengthen(r->b, HUB, 1, 20);
	track_run(r, 1);
	KUNIT_EXPECT_GE(test, worst_error(r->b), 35u);
	track_run(r, 80000);
	expect_followed(r, "cable of a branch longer by 20 ns");
	lengthen(r->b, B, 1, 15);
	track_run(r, 80000);
	expect_followed(r, "cable at the end longer by 15 ns");
	lengthen(r->b, B, 1, -15);
	lengthen(r->b, HUB, 1, -20);
	track_run(r, 80000);
	expect_followed(r, "both as before");
}

/*
 * Where nothing changes, delays stay within the noise. No frame is sent for it, those of one cycle
 * in 100 carry some datagrams more.
 */
static void track_costs_no_frame(struct kunit *test)
{
	struct run *r = track_start(test);
	u64 frames[2], sent;
	u32 riding[2], rode, i;

	for (i = 0; i < 2; i++) {
		WRITE_ONCE(ec_dc_track_on, !i);
		sent = bus_frames(r->b);
		rode = bus_riders(r->b)->seq;
		track_run(r, 60000);
		frames[i] = bus_frames(r->b) - sent;
		riding[i] = bus_riders(r->b)->seq - rode;
	}
	WRITE_ONCE(ec_dc_track_on, true);
	bus_figure("60 s: %llu frames, %u with riders, while delays are measured; else %llu and %u",
		   frames[0], riding[0], frames[1], riding[1]);
	/* the monitor and the watch */
	KUNIT_EXPECT_LE(test, frames[0], frames[1] + 5);
	KUNIT_EXPECT_GT(test, riding[0], riding[1] + 30);
	KUNIT_EXPECT_LT(test, riding[0], riding[1] + 600);
	expect_followed(r, "nothing changes");
}

/* It can be switched off; a scan that the user has requested measures nevertheless. */
static void track_off_measures_on_demand(struct kunit *test)
{
	struct run *r = track_start(test);
	u32 delay;

	WRITE_ONCE(ec_dc_track_on, false);
	delay = delay_of(r->b, C);
	lengthen(r->b, HUB, 1, 20);
	track_run(r, 60000);
	KUNIT_EXPECT_EQ(test, delay_of(r->b, C), delay);
	bus_rescan(r->b);
	track_run(r, 2000);
	WRITE_ONCE(ec_dc_track_on, true);
	/* written at once: the clock takes 1/64 of it with each frame */
	r->step = 1;
	expect_followed(r, "cable of a branch longer by 20 ns, scan requested");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(track_follows_cables),
	KUNIT_CASE(track_costs_no_frame),
	KUNIT_CASE(track_off_measures_on_demand),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_track", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
