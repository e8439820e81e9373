// SPDX-License-Identifier: GPL-2.0-only
/* A trial at a port that frames come to late: large branches are in front of it. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"

#define N	41u	/* connected at first */

/* each frame takes its way from slave to slave; it is lost where a loop closes in front of it */
#define TEXT(ways) \
	"segment seed=3 response=100us transition=1ms under_way=" ways "\n" \
	"slave hub EK1100\n" \
	"repeat 40 slave a drive in=8 out=8 cable=200\n" \
	"branch none\nslave x1 drive in=8 out=8\nslave x2 EK1100\n" \
	"branch x2 2\nslave x3 drive in=8 out=8\n"

/* A slave behind the port that has processed the frame changes its counter. */
static void look(struct cyc *c)
{
	u64 *wrong = c->ctx;

	*wrong += cyc_state(c, 0)->working_counter != cyc_state(c, 0)->expected;
}

/* The slaves have been let in, and no frame of the cycle has met the trials. */
static void let_in(struct kunit *test, const char *text)
{
	struct bus *b = bus_up(test, text, N);
	struct cyc *c = cyc_in_op(b, 0, N);
	u64 wrong = 0;
	u32 i, lines = bus_log_lines("contact lost");
	char line[64];

	cyc_run(c, 200);
	c->ctx = &wrong;
	c->each = look;
	/* as another master left it: over the process data of the first drive */
	snprintf(line, sizeof(line), "old x1 state=OP logical=%u", bus_esc(b, 1)->fmmu[0].logical);
	bus_command(b, line);
	cyc_run(c, 5);
	bus_command(b, "plug hub.2 x1.0");
	for (i = 0; i < 2000 && bus_n_slaves(b) < N + 3; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 3);
	cyc_run(c, 200);
	bus_expect_graph(b, "plug");
	KUNIT_EXPECT_EQ(test, wrong, 0ull);
	KUNIT_EXPECT_EQ(test, bus_log_lines("contact lost"), lines);
}

static void trial_behind_large_branch(struct kunit *test)
{
	let_in(test, TEXT("lost"));
}

static void trial_behind_large_branch_by_chance(struct kunit *test)
{
	let_in(test, TEXT("random"));
}

/* The branch before the port takes so long that no trial fits into a cycle: nothing is tried. */
static void trial_without_time(struct kunit *test)
{
	static const char text[] =
		"segment seed=3 response=100us transition=1ms under_way=lost\n"
		"slave hub EK1100\n"
		"repeat 40 slave a drive in=8 out=8 cable=5us\n"
		"branch none\nslave x1 drive in=8 out=8\n";
	struct bus *b = bus_up(test, text, N);
	struct cyc *c = cyc_in_op(b, 0, N);
	struct ec_ioc_port p = { .port = 2 };
	u32 lines = bus_log_lines("too little time on the wire");
	u64 wrong = 0;

	cyc_run(c, 200);
	c->ctx = &wrong;
	c->each = look;
	bus_command(b, "plug hub.2 x1.0");
	cyc_run(c, 10000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_PORT, &p), 0);
	KUNIT_EXPECT_EQ(test, p.kept, (u32)EC_PORT_NO_TIME);
	KUNIT_EXPECT_EQ(test, bus_log_lines("too little time on the wire") - lines, 1u);
	KUNIT_EXPECT_EQ(test, wrong, 0ull);
}

/*
 * Slaves have left the ring before the port, and the master does not know yet: nobody else gets an
 * address for that.
 */
static void trial_after_slaves_have_gone(struct kunit *test)
{
	static const char text[] =
		"segment seed=3 response=100us transition=1ms\n"
		"slave hub EK1100\n"
		"repeat 3 slave a drive in=8 out=8\n"
		"branch hub 2\nslave fork EK1122\n"
		"repeat 6 slave b drive in=8 out=8\n"
		"branch none\nslave x1 drive in=8 out=8\n";
	struct bus *b = bus_up(test, text, 11);
	struct cyc *c = cyc_in_op(b, 0, 11);
	u32 lines = bus_log_lines("contact lost"), ms;

	cyc_run(c, 200);
	for (ms = 60; ms < 120; ms += 5) {
		bus_command(b, "plug fork.3 x1.0");
		cyc_run(c, ms);
		bus_command(b, "cut a2.0");
		cyc_run(c, 1000);
		bus_command(b, "unplug fork.3");
		bus_command(b, "heal a2.0");
		/* not as a contact that is lost again and again */
		cyc_run(c, 12000);
		KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 11u);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("contact lost"), lines);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(trial_behind_large_branch),
	KUNIT_CASE(trial_behind_large_branch_by_chance),
	KUNIT_CASE(trial_without_time),
	KUNIT_CASE(trial_after_slaves_have_gone),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_trial", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
