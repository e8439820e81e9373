// SPDX-License-Identifier: GPL-2.0-only
/*
 * The path of a frame to clocks that stay changes: their delays are measured again, and their SYNC
 * signals go on. By the true time of the modelled clocks.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"

/* frames pass the branch of port 1 before that of port 2, in which slaves stay */
static const char text[] =
	"segment seed=3\n"
	"slave hub EK1100 drift=-20ppm\n"
	"slave x1 drive in=8 out=8 drift=60ppm cable=30 clock=1s\n"
	"slave x2 drive in=8 out=8 drift=-70ppm clock=3s\n"
	"slave x3 drive in=8 out=8 drift=95ppm clock=77s cable=90\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 drift=-33ppm clock=5s cable=40\n"
	"slave b drive in=8 out=8 drift=88ppm clock=9s\n"
	"branch none\nslave n drive in=8 out=8 drift=-8ppm clock=2s\n"
	"slave m drive in=8 out=8 dc=none\n";

/* in the segment */
enum { HUB, X1, X2, X3, A, B, N, M };

#define CONNECTED	6u
#define LIMIT_NS	100ull	/* by which SYNC0 of running slaves may move */

static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_to_ns(c->next) + 123456789;
}

/**
 * struct way - an application, and what is known of the clocks that stay
 * @b: bus
 * @c: application
 * @offset: register 0x0920 of each
 * @start: of SYNC0 of each
 * @moved: largest difference of one to the reference clock, ns
 */
struct way {
	struct bus *b;
	struct cyc *c;
	u64 offset[CONNECTED];
	u64 start[CONNECTED];
	u64 moved;
};

static u64 offset_of(struct bus *b, u32 i)
{
	return get_unaligned_le64(bus_esc(b, i)->mem + EC_REG_DC_OFFSET);
}

static void path_look(struct way *p)
{
	u64 now = ktime_get_ns(), t;
	u32 i;

	ec_sim_advance(p->b->sim, now);
	t = ec_esc_system_time(bus_esc(p->b, HUB), now);
	for (i = A; i <= B; i++) {
		s64 d = ec_esc_system_time(bus_esc(p->b, i), now) - t;

		p->moved = max_t(u64, p->moved, abs(d));
	}
}

static void path_run(struct way *p, u32 cycles)
{
	while (cycles--) {
		cyc_run(p->c, 1);
		path_look(p);
	}
}

static void path_settle(struct way *p, u32 slaves)
{
	u32 i;

	path_run(p, 300);
	for (i = 0; i < 5000 && (bus_n_slaves(p->b) != slaves || !bus_settled(p->b) ||
				 bus_dc_state(p->b) != EC_DC_READY); i++)
		path_run(p, 1);
	KUNIT_ASSERT_EQ(p->b->test, bus_n_slaves(p->b), slaves);
	KUNIT_EXPECT_EQ(p->b->test, bus_dc_state(p->b), (int)EC_DC_READY);
	path_run(p, 1500);
}

static struct way *path_start(struct kunit *test)
{
	struct way *p = kunit_kzalloc(test, sizeof(*p), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, p);
	p->b = bus_up(test, text, CONNECTED);
	bus_idle(p->b);
	p->c = cyc_new(p->b, 1000);
	cyc_domain(p->c);
	cyc_map_all(p->c, 1, CONNECTED - 1, 0);
	cyc_sync0(p->c, CONNECTED - 1);
	p->c->each = each;
	cyc_activate(p->c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(p->c, 5000), ~0ull);
	path_run(p, 3000);
	for (i = 0; i < CONNECTED; i++) {
		p->offset[i] = offset_of(p->b, i);
		p->start[i] = bus_esc(p->b, i)->dc.start;
	}
	p->moved = 0;
	return p;
}

/* how long a frame is on its way from the reference clock to a slave */
static s32 path_true_delay(struct bus *b, u32 i)
{
	const struct ec_sim_route *r = &b->sim->route[0];

	return r->step[bus_esc(b, i)->route_pos[0]].pu_ns -
	       r->step[bus_esc(b, HUB)->route_pos[0]].pu_ns;
}

/* Delays are those of the path, and the clocks that stay were neither set nor moved. */
static void expect_steady(struct way *p, const char *what)
{
	struct kunit *test = p->b->test;
	u32 i, worst = 0;

	for (i = A; i <= B; i++) {
		struct ec_esc *esc = bus_esc(p->b, i);
		s32 delay = get_unaligned_le32(esc->mem + EC_REG_DC_DELAY);

		worst = max_t(u32, worst, abs(delay - path_true_delay(p->b, i)));
		KUNIT_EXPECT_EQ(test, offset_of(p->b, i), p->offset[i]);
		KUNIT_EXPECT_EQ(test, esc->dc.start, p->start[i]);
		KUNIT_EXPECT_TRUE(test, esc->dc.running);
		KUNIT_EXPECT_EQ(test, esc->mem[EC_REG_AL_STATUS], EC_AL_OP);
	}
	bus_figure("%s: SYNC0 of slaves that stay moves by %llu ns, error of their delays %u ns",
		   what, p->moved, worst);
	KUNIT_EXPECT_LT(test, p->moved, LIMIT_NS);
	KUNIT_EXPECT_LE(test, worst, 10u);
	p->moved = 0;
}

static void path_branch_unplugged(struct kunit *test)
{
	struct way *p = path_start(test);
	u32 i;

	for (i = 0; i < 3; i++) {
		bus_command(p->b, "unplug x1.0");
		path_settle(p, CONNECTED - 3);
		expect_steady(p, "branch unplugged");
		bus_command(p->b, "plug hub.1 x1.0");
		path_settle(p, CONNECTED);
		expect_steady(p, "branch plugged");
	}
}

static void path_slave_inserted(struct kunit *test)
{
	struct way *p = path_start(test);
	u32 i;

	/* what a wrong frame does depends on the moment; ports that flap are opened later */
	for (i = 0; i < 8; i++) {
		path_run(p, 11000 * !!i + 137 * i);
		bus_command(p->b, "unplug x1.1");
		bus_command(p->b, "plug x1.1 n.0");
		bus_command(p->b, "plug n.1 x2.0");
		path_settle(p, CONNECTED + 1);
		expect_steady(p, "slave inserted upstream");
		bus_command(p->b, "unplug n.0");
		bus_command(p->b, "plug x1.1 x2.0");
		path_settle(p, CONNECTED);
		expect_steady(p, "slave removed upstream");
	}
}

/* One without a clock changes the delay of others all the same. */
static void path_slave_without_clock(struct kunit *test)
{
	struct way *p = path_start(test);

	bus_command(p->b, "plug x3.1 m.0");
	path_settle(p, CONNECTED + 1);
	expect_steady(p, "slave without clock added upstream");
	bus_command(p->b, "unplug m.0");
	path_settle(p, CONNECTED);
	expect_steady(p, "slave without clock removed upstream");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(path_branch_unplugged),
	KUNIT_CASE(path_slave_inserted),
	KUNIT_CASE(path_slave_without_clock),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_path", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
