// SPDX-License-Identifier: GPL-2.0-only
/* A contact of a ring that opens and closes again and again. */
#include "ring.h"

#define MS	1500	/* for so long, a cycle each */

/* between changes; no cycle is a multiple of it */
static const u32 steps_us[] = { 23, 101, 1003, 7013, 60013 };

/* A change costs the frame that is in flight on this cable, and no other one. */
static void ring_flap_costs_frames_in_flight(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, changes;
	char text[80];

	bus_idle(b);
	ring_run(r, SLAVES);
	for (i = 0; i < ARRAY_SIZE(steps_us); i++) {
		r->flown = 0;
		changes = MS * 1000 / steps_us[i] / 2 * 2;
		snprintf(text, sizeof(text), "bounce d4.1 pattern=01 step=%uus times=%u",
			 steps_us[i], changes / 2);
		bus_command(b, text);
		cyc_run(r->c, MS + 500);
		ring_expect(r, "a contact that bounces");
		KUNIT_EXPECT_LE(test, r->flown, min(changes, (u32)MS / 2));
		ring_closed(b, SLAVES);
		bus_figure("ring whose contact changes every %u us: %u changes in %u cycles, %u of these incomplete",
			   steps_us[i], changes, MS, r->flown);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ring_flap_costs_frames_in_flight),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_ring_flap",
	.test_cases = cases,
	.exit = bus_exit,
};
kunit_test_suite(suite);
