// SPDX-License-Identifier: GPL-2.0-only
/* A write of loop control is executed, but its reply is lost: the master cannot know it. */
#include "ring.h"
#include "devices/sim/esc_int.h"

#define CLOSES	3	/* writes of the master that close the exit of a ring, and that open it */

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave a drive in=8 out=8\nslave b drive in=8 out=8\nslave c drive in=8 out=8\n";

#define N	3

static u8 loops(struct bus *b, u32 index)
{
	return bus_esc(b, index)->mem[EC_REG_DL_LOOPS];
}

static void lose(struct bus *b, const char *which)
{
	char command[64];

	snprintf(command, sizeof(command), "lose %s", which);
	bus_command(b, command);
}

/* No write is confirmed until the application has ended: then all ports are open. */
static void ports_unsure_lost_replies_open_at_end(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	lose(b, "rate=1000000ppm register=0x101 when=back");
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 300);
	for (i = 0; i < N; i++) {
		/* closed at once, or by itself with the next loss of its link */
		KUNIT_EXPECT_NE(test, loops(b, i), 0);
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->ports.loops, 0);
		KUNIT_EXPECT_TRUE(test, bus_slave(b, i)->ports.unsure);
	}
	bus_end(b);
	lose(b, "rate=0ppm register=0x101 when=back");
	msleep(300);
	for (i = 0; i < N; i++) {
		KUNIT_EXPECT_EQ(test, loops(b, i), 0);
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->ports.loops, 0);
		KUNIT_EXPECT_FALSE(test, bus_slave(b, i)->ports.unsure);
	}
}

/*
 * The backup device leaves, but its card keeps the link, so the master closes the last port. It
 * takes the attempt for a failure, and the writes that open the port again do not arrive.
 */
static void ports_unsure_exit_of_ring_opens(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	char which[48];
	u32 i;

	bus_idle(b);
	ring_closed(b, SLAVES);
	ring_run(r, SLAVES);
	r->absent = ~0ull;
	for (i = 1; i <= 2 * CLOSES; i++) {
		snprintf(which, sizeof(which), "frame=%u register=0x101%s", i,
			 i > CLOSES ? " when=out" : "");
		lose(b, which);
	}
	/* that which shows whether frames return */
	lose(b, "frame=1 register=0");
	ec_sim_link_second_withdraw(b->link);
	ec_sim_wire_card(ec_sim_link_wire(b->link), 1, true);
	for (i = 0; i < 300 && !loops(b, SLAVES - 1); i++)
		cyc_run(r->c, 1);
	KUNIT_EXPECT_NE(test, loops(b, SLAVES - 1), 0);
	cyc_run(r->c, 20);
	KUNIT_EXPECT_EQ(test, bus_table(b)->exit.device, 0ull);
	cyc_run(r->c, 3000);
	bus_plug_second(b);
	cyc_run(r->c, 1000);
	KUNIT_EXPECT_EQ(test, loops(b, SLAVES - 1), 0);
	ring_closed(b, SLAVES);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ports_unsure_lost_replies_open_at_end),
	KUNIT_CASE(ports_unsure_exit_of_ring_opens),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_ports_unsure",
	.test_cases = cases,
	.exit = bus_exit,
};
kunit_test_suite(suite);
