// SPDX-License-Identifier: GPL-2.0-only
/* An address is written by position while slaves before that position leave the ring. */
#include "cyc.h"
#include "devices/sim/esc_int.h"

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

#define FRAMES	12	/* of a scan up to the addresses */

static struct bus *hooked;

/* The scan asks right after it has read the addresses: has the failed hub a configuration? */
static bool cut_now(const struct ec_slave *s)
{
	struct ec_sim_fault cut = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_CUT, .slave = A1,
	};

	if (hooked)
		ec_sim_add_fault(hooked->sim, &cut);
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

static struct kunit_case cases[] = {
	KUNIT_CASE(address_after_slaves_left),
	KUNIT_CASE(address_while_slaves_leave),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_address", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
