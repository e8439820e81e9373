// SPDX-License-Identifier: GPL-2.0-only
/* An address is written by position while slaves before that position leave the ring. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/bus/ports.h"

static const char text[] =
	"segment seed=3 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"repeat 2 slave a drive in=8 out=8\n"
	"branch hub 2\nslave fork EK1122\n"
	"repeat 2 slave b drive in=8 out=8\n"
	"branch fork 3\n"
	"repeat 2 slave x drive in=8 out=8\n";

/* in the segment, and in the ring */
enum { N = 8, A1 = 1, B1 = 4, B1_AT = 6 };

/* of a shorter bus, in the segment; in the ring X1 precedes B1 */
enum { M_B1 = 3, M_B2, M = 6 };

#define FRAMES	12	/* of a scan up to the addresses */

static struct bus *hooked;
static bool hook_loses;	/* the frame that writes addresses does not return */
static bool hook_forgets;	/* B2 has lost its address as well */

/* The scan asks right after it has read the addresses: has the failed hub a configuration? */
static bool cut_now(const struct ec_slave *s)
{
	struct ec_sim_fault cut = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_CUT, .slave = A1,
	};

	if (!hooked)
		return true;
	ec_sim_add_fault(hooked->sim, &cut);
	if (hook_loses)
		bus_command(hooked, "lose frame=1 register=0x10 when=back");
	if (hook_forgets)
		put_unaligned_le16(0x5555, bus_esc(hooked, M_B2)->mem + EC_REG_STATION);
	hooked = NULL;
	return true;
}

static void cut_after_read(struct bus *b)
{
	static struct ec_bus_ops ops;

	ops = *bus_table(b)->ops;
	ops.attached = cut_now;
	bus_table(b)->ops = &ops;
	WRITE_ONCE(bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
	hooked = b;
}

static bool has_address(struct bus *b, const struct ec_slave *s, u32 index)
{
	return get_unaligned_le16(bus_esc(b, index)->mem + EC_REG_STATION) == s->station;
}

/* Slaves X1 and X2 leave, and return without their addresses. */
static void forget_addresses(struct bus *b)
{
	bus_command(b, "off x1");
	bus_command(b, "off x2");
	KUNIT_EXPECT_NE(b->test, bus_wait(b, N - 2, EC_AL_PREOP, 20000), ~0ull);
	bus_command(b, "on x1");
	bus_command(b, "on x2");
}

/* Slaves B1 and B2 keep what they are, and have another address for a millisecond at most. */
static void expect_kept(struct bus *b, struct ec_slave *const *s, const char *what)
{
	u32 ms, i, wrong = 0;

	for (ms = 0; ms < 400; ms++) {
		bool all = true;

		usleep_range(1000, 1001);
		ec_sim_advance(b->sim, ktime_get_ns());
		for (i = 0; i < 2; i++)
			all &= has_address(b, s[i], B1 + i);
		wrong += !all;
	}
	KUNIT_EXPECT_LE_MSG(b->test, wrong, 1u, "%s", what);
	bus_command(b, "heal a1.0");
	KUNIT_EXPECT_NE_MSG(b->test, bus_wait(b, N, EC_AL_PREOP, 20000), ~0ull, "%s", what);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_PTR_EQ_MSG(b->test, bus_slave(b, B1_AT + i), s[i], "%s", what);
}

/* What was meant for X1 and X2 goes to B1 and B2. */
static void address_after_slaves_left(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s[2] = { bus_slave(b, B1_AT), bus_slave(b, B1_AT + 1) };
	u32 lines = bus_log_lines("those of 2 others restored");

	bus_idle(b);
	forget_addresses(b);
	cut_after_read(b);
	expect_kept(b, s, "cut");
	KUNIT_EXPECT_NULL(test, hooked);
	KUNIT_EXPECT_EQ(test, bus_log_lines("those of 2 others restored"), lines + 1);
}

/* The contact breaks while each of the frames is under way, which is lost. */
static void address_while_slaves_leave(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s[2] = { bus_slave(b, B1_AT), bus_slave(b, B1_AT + 1) };
	char words[64];
	u32 n;

	bus_idle(b);
	for (n = 1; n <= 2 * FRAMES; n++) {
		forget_addresses(b);
		snprintf(words, sizeof(words), "cut a1.0 frame=%u when=%s", (n + 1) / 2,
			 n % 2 ? "out" : "back");
		bus_command(b, words);
		expect_kept(b, s, words);
	}
}

/* A session with B2, and with B1; slaves are let in without a trial, as with loops=auto. */
static struct cyc *run_b(struct kunit *test, const char *b1, bool maps)
{
	struct bus *b;
	struct cyc *c;
	char line[256];

	snprintf(line, sizeof(line),
		 "segment seed=3 response=100us transition=1ms\n"
		 "slave hub EK1100\nslave a1 drive in=8 out=8\n"
		 "branch hub 2\nslave fork EK1122\n"
		 "slave b1 %s\nslave b2 drive in=8 out=8\n"
		 "branch fork 3\nslave x1 drive in=8 out=8\n", b1);
	b = bus_up(test, line, M);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	if (!maps)
		cyc_config(c, M - 2);
	cyc_map_all(c, maps ? M - 2 : M - 1, maps ? 2 : 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	ec_ports_guard(bus_table(b), false);
	cyc_run(c, 200);
	return c;
}

/*
 * A1 leaves after the addresses were read: B1 gets the one of X1, which has returned, and the reply
 * is lost. It has its own back in the same scan.
 */
static void expect_given_back(struct cyc *c, bool forgets)
{
	struct bus *b = c->b;
	struct ec_slave *s = ec_slave_ref(bus_slave(b, M - 2));
	u32 ms, wrong = 0, other = 0;

	bus_command(b, "off x1");
	for (ms = 0; ms < 2000 && bus_n_slaves(b) != M - 1; ms++)
		cyc_run(c, 1);
	cyc_run(c, 200);
	hook_loses = true;
	hook_forgets = forgets;
	cut_after_read(b);
	bus_command(b, "on x1");
	for (ms = 0; ms < 1000; ms++) {
		cyc_run(c, 1);
		wrong += !has_address(b, s, M_B1);
		other += READ_ONCE(s->stop.gone) || READ_ONCE(s->al.status) != EC_AL_OP;
	}
	hook_loses = hook_forgets = false;
	KUNIT_EXPECT_NULL(b->test, hooked);
	KUNIT_EXPECT_GT_MSG(b->test, wrong, 0u, "not hit");
	KUNIT_EXPECT_LE(b->test, wrong, 40u);
	KUNIT_EXPECT_EQ(b->test, other, 0u);
	ec_slave_unref(s);
}

/* Counting says nothing, as B2 has lost its address at the same time. */
static void address_reply_lost_given_back_by_fmmu(struct kunit *test)
{
	struct cyc *c = run_b(test, "drive in=8 out=8", true);

	expect_given_back(c, true);
}

static void address_reply_lost_given_back_without_process_data(struct kunit *test)
{
	struct cyc *c = run_b(test, "EK1100", false);

	expect_given_back(c, false);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(address_after_slaves_left),
	KUNIT_CASE(address_while_slaves_leave),
	KUNIT_CASE(address_reply_lost_given_back_by_fmmu),
	KUNIT_CASE(address_reply_lost_given_back_without_process_data),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_address", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
