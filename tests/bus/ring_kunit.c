// SPDX-License-Identifier: GPL-2.0-only
/* Cable redundancy: a ring with a device at each end, which is cut, and heals. */
#include "ring.h"
#include "devices/sim/esc_int.h"
#include "master/bus/graph.h"
#include "master/bus/ring_break.h"
#include "master/cycle/ring_sides.h"
#include "master/mailbox/coe.h"

#define EVENTS		1000		/* of the long run, half of them cuts */

static const char many_text[] =
	"segment seed=9 response=100us transition=1ms\n"
	"repeat 50 slave d drive in=8 out=8 cable=50\n"
	"wire d50.1 -> master.1 cable=50\n";

/* a tool that reads an object of one slave after the other */
struct talk {
	struct bus *b;
	u32 n;
	u32 done;
	u32 failed;
	bool stop;
	struct completion end;
};

static int read_objects(void *arg)
{
	struct talk *t = arg;
	u32 abort, i;

	for (i = 0; !READ_ONCE(t->stop); i++) {
		char text[64] = { 0 };
		size_t got;
		int ret = ec_coe_upload(&bus_slave(t->b, i % t->n)->mbox, 0x1008, 0, false, text,
					sizeof(text), &got, &abort, 0);

		if (ret && t->failed < 5)
			pr_info("# SDO of slave %u: %d\n", i % t->n, ret);
		if (ret || !got)
			t->failed++;
		else
			t->done++;
	}
	complete(&t->end);
	return 0;
}

static struct talk *talk_begin(struct bus *b, u32 n)
{
	struct talk *t = kunit_kzalloc(b->test, sizeof(*t), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, t);
	t->b = b;
	t->n = n;
	init_completion(&t->end);
	KUNIT_ASSERT_FALSE(b->test, IS_ERR(kthread_run(read_objects, t, "reader")));
	return t;
}

static bool talk_end(struct talk *t)
{
	WRITE_ONCE(t->stop, true);
	return try_wait_for_completion(&t->end);
}

static void ring_is_found(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u32 i;

	bus_idle(b);
	ring_closed(b, SLAVES);
	for (i = 0; i < SLAVES; i++) {
		KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, i), 0), i ? i - 1 : EC_UAPI_NONE16);
		KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, i), 1),
				i + 1 < SLAVES ? i + 1 : EC_UAPI_NONE16);
		KUNIT_EXPECT_FALSE(test, bus_slave(b, i)->graph.inconsistent);
	}
}

/* Nothing of it reaches the application: the same cable, cut while nothing runs. */
static void ring_cut_at_rest(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u16 station[SLAVES];
	u32 i, k, at[4];

	bus_idle(b);
	for (k = 0; k < SLAVES; k++)
		station[k] = bus_slave(b, k)->station;
	for (i = 0; i < CUTS; i++) {
		ring_cable(b, true, i);
		bus_idle(b);
		ring_open(b, i);
		ec_ring_break_show(bus_table(b), &at[0], &at[1], &at[2], &at[3]);
		KUNIT_EXPECT_EQ(test, at[1], i ? i - 1 : EC_EVENT_NONE);
		KUNIT_EXPECT_EQ(test, at[2], i ? 1 : EC_EVENT_NONE);
		KUNIT_EXPECT_EQ(test, at[3], i < SLAVES ? i : EC_EVENT_NONE);
		for (k = 0; k < SLAVES; k++) {
			KUNIT_EXPECT_EQ(test, bus_slave(b, k)->station, station[k]);
			KUNIT_EXPECT_FALSE(test, bus_slave(b, k)->graph.inconsistent);
		}
		ring_cable(b, false, i);
		bus_idle(b);
		ring_closed(b, SLAVES);
	}
}

/* The inputs of slaves from @front on are taken from the copy of the backup link. */
static void ring_sides(struct ring *r, u32 front)
{
	const struct ec_cycle *c = bus_cycle(r->b);
	u64 sides = c->layout.dgrams[0].sides;
	const u8 *at = c->domains[0].image + (u16)sides;

	KUNIT_EXPECT_EQ(r->b->test, sides >> 16,
			ec_ring_sides_proof(c->moves, 3 * front, 3 * (SLAVES - front)));
	KUNIT_EXPECT_TRUE(r->b->test, at > r->in[front - 1] && at <= r->in[front]);
}

static void ring_cut_in_op(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, moves;

	ring_run(r, SLAVES);
	for (i = 0; i < CUTS; i++) {
		moves = bus_cycle(b)->moves;
		ring_cable(b, true, i);
		cyc_run(r->c, 300);
		ring_open(b, i);
		ring_expect(r, "a cut");
		KUNIT_EXPECT_NE(test, moves, bus_cycle(b)->moves);
		if (i && i < SLAVES)
			ring_sides(r, i);
		/* with the last cable all slaves are before the break */
		KUNIT_EXPECT_EQ(test, cyc_state(r->c, 0)->redundancy_active, i < SLAVES);
		ring_cable(b, false, i);
		cyc_run(r->c, 300);
		ring_closed(b, SLAVES);
		ring_expect(r, "it has healed");
		KUNIT_EXPECT_EQ(test, cyc_state(r->c, 0)->redundancy_active, 0);
	}
	bus_figure("ring of %u slaves, cut and healed at each of %u cables: %u cycles met an event, %u without a value",
		   SLAVES, CUTS, r->met, r->flown);
	KUNIT_EXPECT_LE(test, r->flown, 2 * CUTS);
}

/* Between two frames of an application that pauses, cables may be plugged in elsewhere. */
static void ring_cycle_pauses(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i, old = 0;

	ring_run(r, SLAVES);
	ring_cable(b, true, 4);
	cyc_run(r->c, 300);
	ring_sides(r, 4);
	r->c->period_ns = 50 * NSEC_PER_MSEC;
	cyc_run(r->c, 10);
	KUNIT_EXPECT_EQ(test, bus_cycle(b)->layout.dgrams[0].sides, 0ull);
	bus_command(b, "swap d3 d6");
	for (i = 0; i < 20; i++) {
		cyc_run(r->c, 1);
		old += cyc_state(r->c, 0)->wc_state == EC_STATUS_WC_COMPLETE &&
		       *r->in[2] != r->value[2];
	}
	KUNIT_EXPECT_EQ(test, old, 0u);
}

/* What rides in frames of an open ring has the replies of both sides. */
static void ring_rider_of_both_sides(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 rides;
	u64 frames;

	ring_run(r, SLAVES);
	ring_cable(b, true, 3);
	cyc_run(r->c, 300);
	ring_open(b, 3);
	rides = bus_riders(b)->seq;
	frames = bus_frames(b);
	cyc_run(r->c, 500);
	frames = bus_frames(b) - frames;
	rides = bus_riders(b)->seq - rides;
	bus_figure("open ring: %u riders in 500 cycles, %llu frames", rides, frames);
	KUNIT_EXPECT_GE(test, rides, 500 / 25);
	/* and the counters of line errors, perhaps */
	KUNIT_EXPECT_LE(test, frames, 505ull);
	ring_expect(r, "riders");
}

/* The slaves are found from both ends, in the order that the closed ring would have. */
static void ring_starts_open(struct kunit *test)
{
	struct bus *b = bus_new(test, ring_eight);
	struct ring *r = ring_new(test, b);

	ring_cable(b, true, 3);
	bus_plug_scanned(b, SLAVES, 5000);
	ring_open(b, 3);
	ring_run(r, SLAVES);
	cyc_run(r->c, 100);
	ring_cable(b, false, 3);
	cyc_run(r->c, 300);
	ring_closed(b, SLAVES);
	ring_expect(r, "it has healed");
}

/* Cuts and repairs at random places and instants, also while frames are on their way. */
static void ring_random(struct kunit *test)
{
	struct bus *b = bus_up(test, many_text, RING_MANY);
	struct ring *r = ring_new(test, b);
	struct rnd_state rnd;
	u32 at = 0, i;

	prandom_seed_state(&rnd, 37);
	ring_run(r, RING_MANY);
	for (i = 0; i < EVENTS; i++) {
		at = ring_next_cut(b, at, i % 2, prandom_u32_state(&rnd) % (RING_MANY + 1));
		/* known before the frame sets out that it may meet */
		ring_cable_of(b, !(i % 2), at, RING_MANY,
			 NSEC_PER_MSEC + prandom_u32_state(&rnd) % (NSEC_PER_MSEC / 4));
		cyc_run(r->c, 2 + prandom_u32_state(&rnd) % 200);
	}
	cyc_run(r->c, 300);
	ring_expect(r, "random events");
	KUNIT_EXPECT_LE(test, r->flown, (u32)EVENTS);
	ring_closed(b, RING_MANY);
	bus_figure("ring of %u slaves, %u random cuts and repairs: %llu cycles, %u wrong values, %u of cycles that met none without a value, %u of %u that met one",
		   RING_MANY, EVENTS, r->c->cycles, r->wrong, r->lost, r->flown, r->met);
}

/* What is between two cuts stops; the others run on, and it comes back when one heals. */
static void ring_second_cut(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i;

	ring_run(r, SLAVES);
	ring_cable(b, true, 2);
	cyc_run(r->c, 100);
	r->absent = BIT(2) | BIT(3) | BIT(4);
	ring_cable(b, true, 5);
	cyc_run(r->c, 500);
	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_EQ_MSG(test, bus_esc(b, i)->mem[EC_REG_AL_STATUS] == EC_AL_OP,
				    i < 2 || i >= 5, "slave %u", i);
	KUNIT_EXPECT_EQ(test, r->wrong, 0u);
	ring_state(b, EC_RING_OPEN, 2, SLAVES - 3);
	ring_cable(b, false, 2);
	KUNIT_EXPECT_NE(test, cyc_wait_op(r->c, 5000), ~0ull);
	cyc_run(r->c, 200);
	r->absent = 0;
	ring_open(b, 5);
	ring_cable(b, false, 5);
	cyc_run(r->c, 200);
	ring_is_whole(r, "both have healed");
}

/* One without power is a break on both of its sides. */
static void ring_power(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 i;

	ring_run(r, SLAVES);
	r->absent = BIT(3);
	bus_command(b, "off d4");
	cyc_run(r->c, 500);
	for (i = 0; i < SLAVES; i++)
		if (i != 3)
			KUNIT_EXPECT_EQ(test, bus_esc(b, i)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	KUNIT_EXPECT_EQ(test, r->wrong, 0u);
	ring_state(b, EC_RING_OPEN, 3, SLAVES - 1);
	bus_command(b, "on d4");
	KUNIT_EXPECT_NE(test, cyc_wait_op(r->c, 5000), ~0ull);
	r->absent = 0;
	cyc_run(r->c, 200);
	ring_is_whole(r, "it has power again");
}

/* No link at all, then one, then both. */
static void ring_both_ends(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);

	ring_run(r, SLAVES);
	ring_cable(b, true, 0);
	cyc_run(r->c, 50);
	r->absent = ~0ull;
	ring_cable(b, true, SLAVES);
	cyc_run(r->c, 300);
	ring_cable(b, false, SLAVES);
	KUNIT_EXPECT_NE(test, cyc_wait_op(r->c, 5000), ~0ull);
	r->absent = 0;
	cyc_run(r->c, 200);
	ring_open(b, 0);
	ring_cable(b, false, 0);
	cyc_run(r->c, 200);
	ring_is_whole(r, "both links are back");
}

/* A device that goes is as a link that goes; it may come back. */
static void ring_device(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);

	ring_run(r, SLAVES);
	ec_sim_link_second_withdraw(b->link);
	cyc_run(r->c, 300);
	ring_open(b, SLAVES);
	/* with a frame that it had received */
	KUNIT_EXPECT_LE(test, r->lost, 1u);
	r->lost = 0;
	ring_expect(r, "the backup device is gone");
	bus_plug_second(b);
	cyc_run(r->c, 300);
	ring_closed(b, SLAVES);
	ring_expect(r, "it is back");
}

/* SDOs of slaves of both sides while cables are cut and mended: none fails. */
static void ring_sdo(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	struct talk *t;
	u32 i;

	ring_run(r, SLAVES);
	t = talk_begin(b, SLAVES);
	for (i = 0; i < 4 * CUTS; i++) {
		ring_cable(b, !(i % 2), i / 2 % CUTS);
		cyc_run(r->c, i % 2 ? 250 : 50);
	}
	while (!talk_end(t))
		cyc_run(r->c, 1);
	bus_figure("ring of %u slaves: %u SDO uploads beside %u cuts and repairs, %u failed",
		   SLAVES, t->done, 4 * CUTS, t->failed);
	KUNIT_EXPECT_GE(test, t->done, 100u);
	KUNIT_EXPECT_EQ(test, t->failed, 0u);
	ring_expect(r, "SDOs");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ring_is_found),
	KUNIT_CASE(ring_cut_at_rest),
	KUNIT_CASE(ring_cut_in_op),
	KUNIT_CASE(ring_cycle_pauses),
	KUNIT_CASE(ring_rider_of_both_sides),
	KUNIT_CASE(ring_starts_open),
	KUNIT_CASE(ring_random),
	KUNIT_CASE(ring_second_cut),
	KUNIT_CASE(ring_power),
	KUNIT_CASE(ring_both_ends),
	KUNIT_CASE(ring_device),
	KUNIT_CASE(ring_sdo),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
