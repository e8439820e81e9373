// SPDX-License-Identifier: GPL-2.0-only
/* Mailboxes that answer wrongly, endlessly or not at all. */
#include "bus.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"

static const char text[] =
	"segment seed=9 response=200us transition=200us\n"
	"slave coupler EK1100\nslave bad drive serial=5\nslave good drive serial=6\n";

#define BAD	1
#define GOOD	2

/* In PREOP, and their PDOs have been read over CoE. */
static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	u32 i;

	for (i = 0; i < 1000 && !bus_settled(b); i++)
		msleep(1);
	KUNIT_ASSERT_TRUE(test, bus_settled(b));
	return b;
}

/* Serial number of a slave; negative: error. Never longer than the default limit. */
static s64 serial(struct bus *b, u32 position)
{
	u64 t0 = ktime_get_ns();
	u8 v[4] = { 0 };
	size_t got;
	u32 abort;
	int ret;

	ret = ec_coe_upload(&bus_slave(b, position)->mbox, 0x1018, 4, false, v, sizeof(v), &got,
			    &abort,
			    &(struct ec_mbox_limit){ .timeout_ms = 100 });
	KUNIT_EXPECT_LE_MSG(b->test, ktime_get_ns() - t0, 300 * NSEC_PER_MSEC,
			    "slave %u kept its caller", position);
	if (ret)
		return ret;
	KUNIT_EXPECT_EQ(b->test, got, 4ul);
	return get_unaligned_le32(v);
}

static const struct wrong {
	const char *name;
	u32 kind;
	int want;	/* errno; 0: the answer is taken, and right */
} wrongs[] = {
	{ "length", EC_SIM_MAILBOX_LENGTH, -EBADMSG },
	{ "short", EC_SIM_MAILBOX_SHORT, -EBADMSG },
	{ "counter", EC_SIM_MAILBOX_COUNTER, 0 },
	{ "type", EC_SIM_MAILBOX_TYPE, -ETIMEDOUT },
	{ "babble", EC_SIM_MAILBOX_BABBLE, -ETIMEDOUT },
};

static void wrong_desc(const struct wrong *w, char *desc)
{
	strscpy(desc, w->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* An error within the time limit, no wrong value; the others are not touched. */
static void mbox_wrong(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct bus *b = ready(test);
	u32 i;

	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, w->kind, 0);
	for (i = 0; i < 3; i++) {
		KUNIT_EXPECT_EQ(test, serial(b, BAD), w->want ?: 5);
		KUNIT_EXPECT_EQ(test, serial(b, GOOD), 6);
	}
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_GOOD, 0);
	serial(b, BAD);		/* what still lies there is thrown away */
	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
}

static void mbox_mute(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), -ETIMEDOUT);
	/* now its mailbox is full, too */
	KUNIT_EXPECT_EQ(test, serial(b, BAD), -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, serial(b, GOOD), 6);
	bus_request(b, GOOD, EC_AL_SAFEOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, GOOD, EC_AL_SAFEOP, 500), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 0, 0);
	msleep(50);
	serial(b, BAD);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
}

/* Power fails while a transfer waits. */
static void mbox_gone(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, BAD, 0, 0, 0);
	KUNIT_EXPECT_LT(test, serial(b, BAD), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(mbox_wrong, wrong_gen_params),
	KUNIT_CASE(mbox_mute),
	KUNIT_CASE(mbox_gone),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_fault_mbox",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
