// SPDX-License-Identifier: GPL-2.0-only
/* Faults that wait for a frame. */
#include "sim_flight_kunit.h"

#define ACCESSES	6	/* frames of a small sequence */

static void add(struct kunit *test, struct bed *b, const char *text)
{
	struct ec_sim_error err;
	struct ec_sim_fault f;

	KUNIT_ASSERT_EQ_MSG(test, ec_sim_command(b->sim, &bed_ops, text, strlen(text), &f, &err),
			    0, "%s: %s", text, err.text);
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
}

static void sim_wait_counts_frames(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\nslave c EL2008\n");

	b->now += SECOND;
	add(test, b, "cut b.0 frame=3");
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 1, "before it gets there");
	add(test, b, "heal b.0 frame=1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
	/* from a time on, and so much later */
	add(test, b, "at=5s off c frame=2 after=30us");
	for (u32 i = 0; i < 9; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	b->now = 5 * SECOND;
	b->gap = 40 * US;
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
}

/* both ports of the master, and frames that are lost, count */
static void sim_wait_counts_all_frames(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\nwire b.1 -> master.1\n");

	b->now += SECOND;
	add(test, b, "lose frame=2");
	add(test, b, "cut b.1 frame=4");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, count(b, 1), 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->out, 0);
}

static void sim_wait_counts_register(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\nslave c EL2008\n");
	u8 v[17] = {};

	b->now += SECOND;
	add(test, b, "cut c.0 frame=4 register=0x110");
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(0), EC_REG_DL_STATUS, v, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(1), EC_REG_DL_CONTROL, v, 16), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(1), EC_REG_DL_CONTROL, v, 17), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(1), EC_REG_DL_STATUS + 1, v, 1), 1);
	KUNIT_EXPECT_EQ(test, logical(b, EC_CMD_LRD, EC_REG_DL_STATUS << 16, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_NOP, 0, EC_REG_DL_STATUS, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, EC_REG_DL_STATUS, v, 2), 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRD, 0, EC_REG_DL_STATUS, v, 2), 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	/* and so do faults of frames */
	add(test, b, "lose frame=2 register=0x130");
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, EC_REG_AL_STATUS, v, 2), 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, EC_REG_AL_STATUS, v, 2), -1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, EC_REG_AL_STATUS, v, 2), 2);
}

static void wait_for(struct kunit *test, struct bed *b, enum ec_sim_fault_type type, int slave,
		     int port, u32 n, enum ec_sim_when when)
{
	const struct ec_sim_fault f = {
		.at_ns = b->now, .type = type, .slave = slave, .port = port, .frame = n,
		.when = when,
	};

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
}

/* one access after the other; what the n-th frame meets, and who has executed it */
static void sim_wait_breaks_under_each_frame(struct kunit *test)
{
	static const struct {
		enum ec_sim_when when;
		s32 wkc;
		u32 marks;
	} cases[] = {
		{ EC_SIM_WHEN_SENT, 4, 0x47 },
		{ EC_SIM_WHEN_OUT, -1, 0x07 },
		{ EC_SIM_WHEN_BACK, -1, 0x3f },
	};

	for (u32 k = 0; k < ARRAY_SIZE(cases); k++) {
		for (u32 n = 1; n <= ACCESSES; n++) {
			struct bed *b = line(test, 20000);
			struct air a;

			/* named by either end */
			wait_for(test, b, EC_SIM_FAULT_CUT, n & 1 ? 2 : 3, n & 1, n, cases[k].when);
			for (u32 i = 1; i <= ACCESSES; i++) {
				s32 want = i < n ? 7 : i > n ? 4 : cases[k].wkc;

				mark(b, &a, b->now + i * 100 * US, (u8)i);
				ec_sim_advance(b->sim, b->now + i * 100 * US + 99 * US);
				KUNIT_ASSERT_TRUE(test, a.fl.done);
				KUNIT_EXPECT_EQ(test, a.fl.res.copies ? wkc(&a) : -1, want);
				if (i == n)
					KUNIT_EXPECT_EQ(test, marked(b, (u8)i), cases[k].marks);
			}
			KUNIT_EXPECT_EQ(test, lost(b, 2), 0x100);
			ec_sim_free(b->sim);
			test->priv = NULL;
		}
	}
}

/* the cable at the master's port, and a slave, which is met at its port 0 */
static void sim_wait_names_cable_of_master_or_slave(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct air a;

	wait_for(test, b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 1, EC_SIM_WHEN_BACK);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	KUNIT_EXPECT_EQ(test, marked(b, 1), 0x7f);
	plan(test, b, 0, EC_SIM_FAULT_HEAL, 0, 0);
	b->now += 2 * SECOND;
	wait_for(test, b, EC_SIM_FAULT_POWER_OFF, 4, 0, 1, EC_SIM_WHEN_OUT);
	mark(b, &a, b->now, 2);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	KUNIT_EXPECT_EQ(test, marked(b, 2), 0x0f);
	b->now += 2 * SECOND;
	plan(test, b, 0, EC_SIM_FAULT_POWER_ON, 4, 0);
	wait_for(test, b, EC_SIM_FAULT_POWER_OFF, 4, 0, 1, EC_SIM_WHEN_BACK);
	mark(b, &a, b->now, 3);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	KUNIT_EXPECT_EQ(test, marked(b, 3), 0x3f);
}

/* the frame never is on that cable: it happens when the frame is back, or is lost */
static void sim_wait_happens_at_end_of_frame(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_LOSE, .port = -1, .arg = 1 };
	struct air a;

	wait_for(test, b, EC_SIM_FAULT_PLUG, 5, 1, 1, EC_SIM_WHEN_OUT);
	wait_for(test, b, EC_SIM_FAULT_POWER_OFF, 5, 2, 1, EC_SIM_WHEN_BACK);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, wkc(&a), 7);
	KUNIT_EXPECT_FALSE(test, ec_sim_slave(b->sim, 5)->powered);
	b->now += 2 * SECOND;
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	wait_for(test, b, EC_SIM_FAULT_POWER_ON, 5, 0, 1, EC_SIM_WHEN_BACK);
	mark(b, &a, b->now, 2);
	KUNIT_EXPECT_TRUE_MSG(test, a.fl.done, "lost at once");
	ec_sim_advance(b->sim, b->now);
	KUNIT_EXPECT_TRUE(test, ec_sim_slave(b->sim, 5)->powered);
}

/* several that wait for one frame happen in the order in which they were added */
static void sim_wait_keeps_order(struct kunit *test)
{
	struct bed *b = line(test, 100);

	for (u32 i = 0; i < 5; i++)
		wait_for(test, b, i & 1 ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_CUT, 3, 0, 2,
			 EC_SIM_WHEN_SENT);
	b->now += SECOND;
	KUNIT_EXPECT_EQ(test, count(b, 0), 7);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0x300);
	/* forgotten ones do not happen, wherever they were */
	wait_for(test, b, EC_SIM_FAULT_POWER_OFF, 0, 0, 2, EC_SIM_WHEN_SENT);
	wait_for(test, b, EC_SIM_FAULT_POWER_OFF, 1, 0, 1, EC_SIM_WHEN_BACK);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	ec_sim_clear_faults(b->sim);
	for (u32 i = 0; i < 3; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 1);
}

static void sim_wait_forgotten_in_flight(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct air a;

	wait_for(test, b, EC_SIM_FAULT_CUT, 3, 0, 1, EC_SIM_WHEN_BACK);
	mark(b, &a, b->now, 1);
	KUNIT_EXPECT_FALSE(test, a.fl.done);
	ec_sim_clear_faults(b->sim);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, wkc(&a), 7);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

/* a contact that bounces from the n-th frame on */
static void sim_wait_bounce_continues(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n");

	b->now += SECOND;
	b->gap = 0;
	add(test, b, "bounce a.1 pattern=01 step=1ms times=2 frame=2");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	for (u32 i = 0; i < 5; i++) {
		KUNIT_EXPECT_EQ_MSG(test, count(b, 0), i & 1 || i > 3 ? 2 : 1, "digit %u", i);
		b->now += 1000000;
	}
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x200);
}

/* lose: with when=out no slave has processed it */
static void sim_wait_lose_out_or_back(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n");
	u8 v[1] = { 5 };

	add(test, b, "lose frame=1 when=out");
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, MARK, v, 1), -1);
	KUNIT_EXPECT_EQ(test, marked(b, 5), 0);
	add(test, b, "lose frame=1 when=back");
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, MARK, v, 1), -1);
	KUNIT_EXPECT_EQ(test, marked(b, 5), 3);
	v[0] = 6;
	add(test, b, "lose frame=1");
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, MARK, v, 1), -1);
	KUNIT_EXPECT_EQ(test, marked(b, 6), 3);
}

static void sim_wait_errors_are_reported(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n");
	static const struct {
		const char *text, *want;
	} bad[] = {
		{ "cut a.1 frame=0", "out of range" },
		{ "cut a.1 frame=1 when=in", "invalid when 'in': expected out or back" },
		{ "cut a.1 frame=1 register=0x10000", "out of range" },
		{ "cut a.1 when=out", "when=out" },
		{ "cut a.1 register=1", "register=1" },
		{ "lose frame=1 when=there", "invalid when 'there'" },
		{ "lose frame=1 after=1us", "after=1us" },
		{ "delay frame=1 when=out", "when=out" },
	};
	struct ec_sim_error err;
	struct ec_sim_fault f;

	for (u32 i = 0; i < ARRAY_SIZE(bad); i++) {
		KUNIT_EXPECT_EQ_MSG(test, ec_sim_command(b->sim, &bed_ops, bad[i].text,
							 strlen(bad[i].text), &f, &err),
				    -EINVAL, "%s", bad[i].text);
		KUNIT_EXPECT_TRUE_MSG(test, strstr(err.text, bad[i].want), "\"%s\" says \"%s\"",
				      bad[i].text, err.text);
	}
	f = (struct ec_sim_fault){ .type = EC_SIM_FAULT_LOSE, .arg = 1, .frame = 1 };
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	f = (struct ec_sim_fault){ .type = EC_SIM_FAULT_CUT, .frame = 1, .when = 3 };
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_wait_counts_frames),
	KUNIT_CASE(sim_wait_counts_all_frames),
	KUNIT_CASE(sim_wait_counts_register),
	KUNIT_CASE(sim_wait_breaks_under_each_frame),
	KUNIT_CASE(sim_wait_names_cable_of_master_or_slave),
	KUNIT_CASE(sim_wait_happens_at_end_of_frame),
	KUNIT_CASE(sim_wait_keeps_order),
	KUNIT_CASE(sim_wait_forgotten_in_flight),
	KUNIT_CASE(sim_wait_bounce_continues),
	KUNIT_CASE(sim_wait_lose_out_or_back),
	KUNIT_CASE(sim_wait_errors_are_reported),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_wait",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
