// SPDX-License-Identifier: GPL-2.0-only
/* A contact of a ring that opens and closes again and again. */
#include "ring.h"
#include "devices/sim/esc_int.h"

#define MS	1500	/* for so long, a cycle each */
#define SEEN	100	/* of these the master has seen it */

/* between changes; no cycle is a multiple of it */
static const u32 steps_us[] = { 23, 101, 1003, 7013, 60013 };

/*
 * A change costs the frame that is in flight on this cable, and no other one; and none does once
 * the master has seen the break.
 */
static void ring_flap_costs_frames_in_flight(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, changes, first;
	char text[80];

	bus_idle(b);
	ring_run(r, SLAVES);
	for (i = 0; i < ARRAY_SIZE(steps_us); i++) {
		r->flown = 0;
		changes = MS * 1000 / steps_us[i] / 2 * 2;
		snprintf(text, sizeof(text), "bounce d4.1 pattern=01 step=%uus times=%u",
			 steps_us[i], changes / 2);
		bus_command(b, text);
		cyc_run(r->c, SEEN);
		first = r->flown;
		KUNIT_EXPECT_LE(test, first, min(changes, (u32)SEEN / 2));
		cyc_run(r->c, MS - SEEN);
		KUNIT_EXPECT_EQ(test, r->flown, first);
		cyc_run(r->c, 500);
		ring_expect(r, "a contact that bounces");
		KUNIT_EXPECT_EQ(test, r->flown, first);
		ring_closed(b, SLAVES);
		bus_figure("ring whose contact changes every %u us: %u changes in %u cycles, %u of these incomplete, 0 after the first %u",
			   steps_us[i], changes, MS, r->flown, SEEN);
	}
}

static void expect_loops(struct bus *b, u32 cut, bool held)
{
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		u8 want = i + 1 == cut ? EC_LOOP_AUTO_CLOSE << 2 : EC_LOOP_AUTO_CLOSE;

		if (!held || cut % SLAVES == 0 || (i != cut && i + 1 != cut))
			want = 0;
		KUNIT_EXPECT_EQ_MSG(b->test, bus_esc(b, i)->mem[EC_REG_DL_LOOPS], want,
				    "cable %u, slave %u", cut, i);
	}
}

/* Both ends of a break open together when their link is sound, those at the devices at once. */
static void ring_ends_wait(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, flown, healing = 0;

	ring_run(r, SLAVES);
	for (i = 0; i < CUTS; i++) {
		ring_cable(b, true, i);
		cyc_run(r->c, 300);
		ring_open(b, i);
		expect_loops(b, i, true);
		flown = r->flown;
		ring_cable(b, false, i);
		cyc_run(r->c, 80);
		KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state,
				i % SLAVES ? EC_RING_OPEN : EC_RING_CLOSED);
		expect_loops(b, i, true);
		cyc_run(r->c, 120);
		ring_closed(b, SLAVES);
		expect_loops(b, i, false);
		ring_expect(r, "it has healed");
		healing += r->flown - flown;
	}
	KUNIT_EXPECT_EQ(test, healing, 0u);
	bus_figure("ring of %u slaves, healed at each of %u cables: %u cycles without a value",
		   SLAVES, CUTS, healing);
	/* the application ends in an open ring: nothing of it stays */
	ring_cable(b, true, 4);
	cyc_run(r->c, 300);
	expect_loops(b, 4, true);
	cyc_release(r->c);
	bus_idle(b);
	expect_loops(b, 4, false);
}

/* A slave at the end whose controller does not keep the value: all is as without it. */
static void ring_end_is_fixed(struct kunit *test)
{
	struct bus *b = bus_up(test,
			       "segment seed=8 response=100us transition=1ms\n"
			       "repeat 4 slave d drive in=8 out=8 cable=50\n"
			       "slave e drive in=8 out=8 cable=50 loops=fixed\n"
			       "repeat 3 slave f drive in=8 out=8 cable=50\n"
			       "wire f3.1 -> master.1 cable=50\n", SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, lines = bus_log_lines("a loose contact here costs a frame");

	ring_run(r, SLAVES);
	for (i = 4; i < 6; i++) {
		ring_cable(b, true, i);
		cyc_run(r->c, 300);
		expect_loops(b, i, false);
		ring_cable(b, false, i);
		cyc_run(r->c, 60);
		ring_closed(b, SLAVES);
		ring_expect(r, "it has healed");
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("a loose contact here costs a frame") - lines, 1u);
}

/* Slaves that open by themselves, show no event or count no losses; counters that are full. */
static void ring_ends_with_bugs(struct kunit *test)
{
	static const enum ec_sim_bug bugs[] = {
		EC_SIM_BUG_NONE, EC_SIM_BUG_AUTO_CLOSE, EC_SIM_BUG_DL_SILENT,
		EC_SIM_BUG_LOST_UNCOUNTED,
	};
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, k;

	ring_run(r, SLAVES);
	for (i = 0; i < ARRAY_SIZE(bugs); i++) {
		ec_sim_set_bug(b->sim, bugs[i]);
		for (k = 3; k < 5; k++)
			bus_esc(b, k)->mem[EC_REG_ERR_LOST(!(k - 3))] = 0xff;
		ring_cable(b, true, 4);
		cyc_run(r->c, 1500);
		ring_open(b, 4);
		ring_cable(b, false, 4);
		cyc_run(r->c, bugs[i] == EC_SIM_BUG_DL_SILENT ? 1500 : 200);
		ring_closed(b, SLAVES);
		expect_loops(b, 0, false);
		KUNIT_EXPECT_EQ(test, r->wrong, 0u);
		KUNIT_EXPECT_EQ(test, r->left, 0u);
	}
	ec_sim_set_bug(b->sim, EC_SIM_BUG_NONE);
}

/* A master has crashed while the ring was open in two places, which have healed since. */
static void ring_ends_of_another_master(struct kunit *test)
{
	struct bus *b = bus_new(test, ring_eight);
	static const u32 cuts[] = { 2, 5 };
	u32 i;

	for (i = 0; i < ARRAY_SIZE(cuts); i++) {
		bus_esc(b, cuts[i] - 1)->mem[EC_REG_DL_LOOPS] |= EC_LOOP_AUTO_CLOSE << 2;
		bus_esc(b, cuts[i])->mem[EC_REG_DL_LOOPS] |= EC_LOOP_AUTO_CLOSE;
		ring_cable(b, true, cuts[i]);
	}
	ec_sim_advance(b->sim, ktime_get_ns());
	for (i = 0; i < ARRAY_SIZE(cuts); i++)
		ring_cable(b, false, cuts[i]);
	ec_sim_advance(b->sim, ktime_get_ns());
	for (i = 0; i < ARRAY_SIZE(cuts); i++) {
		KUNIT_EXPECT_FALSE(test, bus_esc(b, cuts[i] - 1)->port[1].open);
		KUNIT_EXPECT_FALSE(test, bus_esc(b, cuts[i])->port[0].open);
	}
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_closed(b, SLAVES);
	expect_loops(b, 0, false);
}

/* The ring was never closed: by which port it goes on shows as well. */
static void ring_ends_at_start(struct kunit *test)
{
	struct bus *b = bus_new(test, ring_eight);
	struct ring *r = ring_new(test, b);

	ring_cable(b, true, 4);
	bus_plug_scanned(b, SLAVES, 5000);
	ring_run(r, SLAVES);
	cyc_run(r->c, 300);
	ring_open(b, 4);
	expect_loops(b, 4, true);
	bus_command(b, "bounce d4.1 pattern=01 step=1003us times=500");
	cyc_run(r->c, 1500);
	ring_closed(b, SLAVES);
	expect_loops(b, 4, false);
	ring_expect(r, "it has healed");
	KUNIT_EXPECT_EQ(test, r->flown, 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ring_flap_costs_frames_in_flight),
	KUNIT_CASE(ring_ends_wait),
	KUNIT_CASE(ring_end_is_fixed),
	KUNIT_CASE(ring_ends_with_bugs),
	KUNIT_CASE(ring_ends_of_another_master),
	KUNIT_CASE(ring_ends_at_start),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_ring_flap",
	.test_cases = cases,
	.exit = bus_exit,
};
kunit_test_suite(suite);
