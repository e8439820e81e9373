// SPDX-License-Identifier: GPL-2.0-only
/* Who hangs at which port, and propagation delays, also of slaves connected by other ports. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc.h"
#include "master/boundary/ioctl.h"
#include "master/bus/bus_list.h"

/* how long a frame is on its way from slave 0 to slave @i */
static s32 true_delay(struct bus *b, u32 i)
{
	const struct ec_sim_step *step = b->sim->route[0].step;

	return step[i].pu_ns - step[0].pu_ns;
}

/* Neighbours and delays as they are in truth; returns the largest error of a delay, ns. */
static u32 expect_wiring(struct bus *b, const char *text)
{
	const struct ec_sim_route *r = &b->sim->route[0];
	u32 i, p, max = 0;

	for (i = 0; i < r->steps; i++) {
		const struct ec_slave *s = bus_slave(b, i);
		const struct ec_esc *esc = r->step[i].esc;

		for (p = 0; p < EC_MAX_PORT; p++) {
			s32 peer = esc->port[p].peer;

			KUNIT_EXPECT_EQ_MSG(b->test, bus_next(s, p), peer < 0 ? EC_UAPI_NONE16 :
					    (u16)b->sim->esc[peer]->route_pos[0],
					    "slave %u port %u of\n%s", i, p, text);
			if (peer == -2)
				KUNIT_EXPECT_EQ(b->test, s->graph.upstream, p);
		}
		KUNIT_EXPECT_FALSE(b->test, s->graph.inconsistent);
		if (!(ec_slave_features(s) & EC_FEAT_DC))
			continue;
		KUNIT_EXPECT_FALSE(b->test, ec_clock_of(s)->delay_unreliable);
		max = max_t(u32, max, abs((s32)ec_clock_of(s)->delay - true_delay(b, i)));
	}
	return max;
}

/* every cycle the time of the reference goes to the slaves */
static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

static void judge_wiring(struct kunit *test, const char *text, u32 n)
{
	struct bus *b = bus_up(test, text, n);
	struct cyc *c;
	u64 now;
	u32 i;

	bus_idle(b);
	KUNIT_EXPECT_LE(test, expect_wiring(b, text), 10u);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, n, 0);
	c->each = each;
	cyc_activate(c);
	for (i = 0; i < 2000 && bus_dc_state(b) != EC_DC_READY; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	cyc_run(c, 2000);
	now = ktime_get_ns();
	ec_sim_advance(b->sim, now);
	for (i = 1; i < n; i++) {
		s64 d = ec_esc_system_time(bus_esc(b, i), now) -
			ec_esc_system_time(bus_esc(b, 0), now);

		if (bus_esc(b, i)->cfg.features & EC_FEAT_DC)
			KUNIT_EXPECT_LT(test, abs(d), 100ll);
	}
	bus_down(b);
	test->priv = NULL;
}

/* IN and OUT swapped: at the end of a line or branch, in the middle, at the master */
static void wiring_reversed(struct kunit *test)
{
	judge_wiring(test, "slave a drive in=8 out=8 drift=60ppm cable=50\n"
		     "slave b drive in=8 out=8 drift=-70ppm clock=3s\n"
		     "slave c drive in=8 out=8 drift=30ppm clock=9s\n"
		     "wire b.1 -> c.1 cable=100ns\n", 3);
	judge_wiring(test, "slave k EK1100 drift=-20ppm\n"
		     "slave a drive in=8 out=8 drift=60ppm clock=1s\n"
		     "slave b drive in=8 out=8 drift=-70ppm clock=3s\n"
		     "slave d drive in=8 out=8 drift=-70ppm clock=3s\n"
		     "wire k.1 -> a.1 cable=300ns\n"
		     "wire k.2 -> b.0 cable=900ns\n"
		     "wire b.1 -> d.0 cable=900ns\n", 4);
	judge_wiring(test, "slave a drive in=8 out=8 drift=60ppm cable=50\n"
		     "slave b drive in=8 out=8 drift=-70ppm clock=3s\n"
		     "slave c drive in=8 out=8 drift=30ppm clock=9s\n"
		     "slave d drive in=8 out=8 drift=30ppm clock=9s\n"
		     "wire a.1 -> b.1 cable=100ns\n"
		     "wire b.0 -> c.0 cable=100ns\n"
		     "wire c.1 -> d.0 cable=700ns\n", 4);
	judge_wiring(test, "slave a drive in=8 out=8 drift=60ppm\n"
		     "slave b drive in=8 out=8 drift=-70ppm clock=3s\n"
		     "slave c drive in=8 out=8 drift=30ppm clock=9s\n"
		     "wire master.0 -> a.1 cable=100ns\n"
		     "wire a.0 -> b.0 cable=100ns\n"
		     "wire b.1 -> c.1 cable=700ns\n", 3);
	/* only the last one has no clock, and is known by its single open port */
	judge_wiring(test, "slave a drive in=8 out=8 drift=60ppm\n"
		     "slave b drive in=8 out=8 drift=-70ppm clock=3s dc=none\n"
		     "wire a.1 -> b.1 cable=100ns\n", 2);
}

#define TREES	24u
#define TREE	20u

/* a tree of slaves with two and three ports that are entered by any of them */
struct tree {
	u32 random;
	u8 ports[TREE];		/* bit per port there is */
	u8 used[TREE];		/* with a cable */
	u8 entry[TREE];
	u8 parent[TREE];
	u8 at[TREE];		/* port there */
};

static u32 dice(struct tree *t, u32 n)
{
	t->random = t->random * 1664525 + 1013904223;
	return (t->random >> 8) % n;
}

static u8 free_port(struct tree *t, u32 i)
{
	u8 free = t->ports[i] & ~t->used[i], p;

	do
		p = dice(t, EC_MAX_PORT);
	while (!(free & BIT(p)));
	t->used[i] |= BIT(p);
	return p;
}

static void grow(struct tree *t)
{
	u32 i, closed = 0;

	for (i = 0; i < TREE; i++) {
		t->ports[i] = i % 3 == 1 ? 7 : 3;
		t->used[i] = 0;
		t->entry[i] = dice(t, 2) ? 0 : free_port(t, i);
		t->used[i] |= BIT(t->entry[i]);
		if (!i)
			continue;
		do
			t->parent[i] = dice(t, i);
		while (t->used[t->parent[i]] == t->ports[t->parent[i]]);
		t->at[i] = free_port(t, t->parent[i]);
	}
	/* a frame passes one closed port 0 at most */
	for (i = 0; i < TREE; i++)
		if (!(t->used[i] & BIT(0)) && closed++)
			t->entry[i] = 0;
}

static u32 describe(struct tree *t, char *text, u32 size)
{
	u32 i, n = scnprintf(text, size, "segment seed=%u\n", t->random);

	for (i = 0; i < TREE; i++)
		n += scnprintf(text + n, size - n, "slave s%u %s drift=%dppm clock=%ums dc=%d\n",
			       i, t->ports[i] == 7 ? "EK1100" : "drive in=8 out=8",
			       (int)dice(t, 200) - 100, dice(t, 9000), dice(t, 2) ? 32 : 64);
	n += scnprintf(text + n, size - n, "wire master.0 -> s0.%u\n", t->entry[0]);
	for (i = 1; i < TREE; i++)
		n += scnprintf(text + n, size - n, "wire s%u.%u -> s%u.%u cable=%uns\n",
			       t->parent[i], t->at[i], i, t->entry[i], 20 + dice(t, 900));
	return n;
}

static void wiring_by_any_port(struct kunit *test)
{
	struct tree *t = kunit_kzalloc(test, sizeof(*t), GFP_KERNEL);
	static char text[8192];
	u32 i, max = 0;

	KUNIT_ASSERT_NOT_NULL(test, t);
	for (i = 0; i < TREES; i++) {
		struct bus *b;

		grow(t);
		describe(t, text, sizeof(text));
		b = bus_up(test, text, TREE);
		bus_idle(b);
		KUNIT_ASSERT_EQ(test, ec_dc_measure(bus_dc(b)), 0);
		max = max(max, expect_wiring(b, text));
		bus_down(b);
		test->priv = NULL;
	}
	bus_figure("%u random trees of slaves connected by any port: worst delay error %u ns",
		   TREES, max);
	KUNIT_EXPECT_LE(test, max, 10u);
}

/*
 * A tree of slaves with two, three and four ports that are entered by port 0. One without a clock
 * is never a junction: the time of a frame between its branches cannot be measured.
 */
static u32 grow_junctions(struct tree *t, char *text, u32 size)
{
	static const char * const names[] = { "drive in=8 out=8", "EK1100", "EK1122" };
	static const char * const clocks[] = { "32", "64", "none" };
	static const u8 ports[] = { 3, 7, 15 };
	u32 i, n = scnprintf(text, size, "segment seed=%u\n", t->random);

	for (i = 0; i < TREE; i++) {
		u32 kind = dice(t, 3), dc = dice(t, i && !kind ? 3 : 2);

		t->ports[i] = ports[kind];
		t->used[i] = BIT(0);
		n += scnprintf(text + n, size - n, "slave s%u %s drift=%dppm clock=%ums dc=%s\n",
			       i, names[kind], (int)dice(t, 200) - 100, dice(t, 9000), clocks[dc]);
	}
	n += scnprintf(text + n, size - n, "wire master.0 -> s0.0\n");
	for (i = 1; i < TREE; i++) {
		do
			t->parent[i] = dice(t, i);
		while (t->used[t->parent[i]] == t->ports[t->parent[i]]);
		t->at[i] = free_port(t, t->parent[i]);
		n += scnprintf(text + n, size - n, "wire s%u.%u -> s%u.0 cable=%uns\n",
			       t->parent[i], t->at[i], i, 20 + dice(t, 900));
	}
	return n;
}

static u32 wiring_now(struct bus *b, const char *text)
{
	msleep(300);
	KUNIT_EXPECT_NE(b->test, bus_wait(b, b->sim->route[0].steps, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	return expect_wiring(b, text);
}

/* Branches at any port go and come back: delays are those of the path that is there. */
static void wiring_of_trees_that_change(struct kunit *test)
{
	struct tree *t = kunit_kzalloc(test, sizeof(*t), GFP_KERNEL);
	static char text[8192];
	u32 i, k, max = 0;
	char command[40];

	KUNIT_ASSERT_NOT_NULL(test, t);
	for (i = 0; i < TREES; i++) {
		struct bus *b;

		grow_junctions(t, text, sizeof(text));
		b = bus_up(test, text, TREE);
		bus_idle(b);
		max = max(max, expect_wiring(b, text));
		for (k = 0; k < 3; k++) {
			u32 s = 1 + dice(t, TREE - 1);

			scnprintf(command, sizeof(command), "unplug s%u.0", s);
			bus_command(b, command);
			max = max(max, wiring_now(b, text));
			scnprintf(command, sizeof(command), "plug s%u.%u s%u.0", t->parent[s],
				  t->at[s], s);
			bus_command(b, command);
			max = max(max, wiring_now(b, text));
		}
		bus_down(b);
		test->priv = NULL;
	}
	bus_figure("%u random trees with junctions, 6 changes each: worst delay error %u ns",
		   TREES, max);
	KUNIT_EXPECT_LE(test, max, 10u);
}

static bool shown_odd(struct bus *b, u32 position)
{
	struct ec_ioc_slave *s = kunit_kzalloc(b->test, sizeof(*s), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, s);
	s->slave.position = position;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SLAVE, s), 0);
	return s->dc_odd;
}

/* Receive times no cable makes, and ports that lead nowhere, are told. */
static void wiring_that_does_not_fit(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave b drive in=8 out=8\n"
			       "slave c drive in=8 out=8\n", 3);
	u32 i, scans;

	bus_idle(b);
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_FALSE(test, shown_odd(b, i));
	bus_esc(b, 1)->cfg.drift_ppb = 2000000000;
	KUNIT_ASSERT_EQ(test, ec_dc_measure(bus_dc(b)), 0);
	KUNIT_EXPECT_FALSE(test, shown_odd(b, 0));
	KUNIT_EXPECT_TRUE(test, shown_odd(b, 1));
	KUNIT_EXPECT_TRUE(test, shown_odd(b, 2));
	bus_esc(b, 1)->cfg.drift_ppb = 0;
	KUNIT_ASSERT_EQ(test, ec_dc_measure(bus_dc(b)), 0);
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_FALSE(test, shown_odd(b, i));
	bus_down(b);

	/* b is reversed, and has no clock to tell: it seems to come behind c */
	b = bus_up(test, "slave a drive in=8 out=8\nslave b drive in=8 out=8 dc=none\n"
		   "slave c drive in=8 out=8\n"
		   "wire a.1 -> b.1\nwire b.0 -> c.0\n", 3);
	bus_idle(b);
	KUNIT_EXPECT_FALSE(test, bus_slave(b, 0)->graph.inconsistent);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 2)->graph.inconsistent);
	/* it is looked at again a few times */
	scans = bus_table(b)->scan_count;
	msleep(60000);
	KUNIT_EXPECT_EQ(test, bus_table(b)->scan_count - scans, 4u);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 2)->graph.inconsistent);
	/* an EEPROM that cannot be read changes nothing of that */
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 0, 0, ~0u, 0);
	bus_rescan(b);
	KUNIT_ASSERT_EQ(test, ec_bus_wait_scan(bus_table(b)), 0);
	KUNIT_ASSERT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 2)->graph.inconsistent);
}

/*
 * While the EEPROM of a new slave between the others is read, their clocks are set: by the
 * topology and the positions of the table that is valid.
 */
static void wiring_slave_inserted(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave k EK1100\nslave x drive in=8 out=8\n"
				"slave l drive in=8 out=8\nslave m drive in=8 out=8\n"
				"slave n drive in=8 out=8\n"
				"wire k.1 -> x.0 cable=100ns\nwire k.2 -> l.0 cable=100ns\n"
				"wire l.1 -> m.0 cable=100ns\nwire m.1 -> n.0 cable=100ns\n");
	struct cyc *c;
	s32 before[4];
	u64 frames;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 4, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 3, 0);
	cyc_sync0(c, 3);
	for (i = 0; i < 4; i++)
		before[i] = ec_clock_of(bus_slave(b, i))->delay;
	/* as after a scan beside the application before: the delays are measured again */
	bus_table(b)->scan_count++;
	bus_esc(b, 1)->cfg.eeprom_busy_ns = 15 * NSEC_PER_MSEC;
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	msleep(500);
	/* the next look of the monitor starts the scan; the clocks wait for the application time */
	for (frames = bus_frames(b); bus_frames(b) == frames;)
		usleep_range(100, 101);
	usleep_range(19000, 19001);
	cyc_activate(c);
	cyc_run(c, 15);
	c->each = each;
	for (i = 0; i < 2000 && (bus_dc_state(b) != EC_DC_READY || !bus_scan_busy(b)); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_TRUE(test, bus_scan_busy(b));
	KUNIT_ASSERT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 4u);
	for (i = 1; i < 4; i++) {
		s32 delay = ec_clock_of(bus_slave(b, i))->delay;

		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->position, i);
		/* the way through x counts half as long as it is not known; it is slave 1 then */
		KUNIT_EXPECT_GE(test, delay, before[i]);
		KUNIT_EXPECT_LE(test, delay, true_delay(b, i + 1) + 10);
		bus_figure("slave %u: delay %d ns, %d ns before, %d ns with the new slave", i,
			   delay, before[i], true_delay(b, i + 1));
	}
	cyc_run(c, 5000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 5u);
	KUNIT_EXPECT_LE(test, expect_wiring(b, "x between k and l"), 10u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(wiring_reversed),
	KUNIT_CASE(wiring_by_any_port),
	KUNIT_CASE(wiring_of_trees_that_change),
	KUNIT_CASE(wiring_that_does_not_fit),
	KUNIT_CASE(wiring_slave_inserted),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_dc_wiring", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
