// SPDX-License-Identifier: GPL-2.0-only
/* However often something happens, the kernel log gets few lines of it. */
#include "bus.h"
#include "devices/sim/app.h"
#include "master/link/device.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"

static const char text[] =
	"segment seed=9 response=200us transition=200us\n"
	"slave coupler EK1100\nslave bad drive\nslave good drive\n";

#define BAD	1
#define GOOD	2

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	u32 i;

	for (i = 0; i < 1000 && !bus_settled(b); i++)
		msleep(1);
	KUNIT_ASSERT_TRUE(test, bus_settled(b));
	/* what it had to say of the start is not looked at */
	msleep(11000);
	return b;
}

static u64 lines(const struct bus *b)
{
	return READ_ONCE(bus_base(b)->log.lines);
}

/* Equal texts: one line, and one more at the end of each window. */
static void log_equal(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 l0 = lines(b);
	u32 i;

	for (i = 0; i < 100000; i++)
		ec_slave_warn(bus_slave(b, BAD), "equal\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 1ull);
	/* another slave has its own state, so has another event */
	ec_slave_warn(bus_slave(b, GOOD), "equal\n");
	ec_slave_warn(bus_slave(b, BAD), "other\n");
	ec_warn(b->m, "equal\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 4ull);
	msleep(9000);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 4ull);
	msleep(1500);
	KUNIT_EXPECT_EQ_MSG(test, lines(b) - l0, 5ull, "what was counted is logged at last");
	msleep(20000);
	KUNIT_EXPECT_EQ_MSG(test, lines(b) - l0, 5ull, "and once");
	ec_slave_warn(bus_slave(b, BAD), "equal\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 6ull);
}

/* Different texts of one event: three; changes of state: five. */
static void log_varied(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 l0 = lines(b);
	u32 i;

	for (i = 0; i < 1000; i++)
		ec_slave_warn(bus_slave(b, BAD), "number %u\n", i);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 3ull);
	for (i = 0; i < 1000; i++)
		ec_info(b->m, "state %u\n", i & 1);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 8ull);
	msleep(10500);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 10ull);
	/* one line for each configuration */
	for (i = 0; i < 1000; i++)
		ec_warn_each(b->m, 1 + i % 100, "configuration %u\n", i % 100);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 110ull);
}

/* More slaves than there are places: the rest is one number. */
static void log_many(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 l0 = lines(b);
	u32 i, k;

	for (i = 0; i < 1000; i++)
		for (k = 0; k < 3; k++)
			ec_log_event(bus_base(b), i, 0, KERN_WARNING, "many\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, (u64)EC_LOG_OF_SLAVES);
	/* the master itself is still heard */
	ec_warn(b->m, "heard\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, EC_LOG_OF_SLAVES + 1ull);
	msleep(10500);
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 2 * EC_LOG_OF_SLAVES + 2ull);
	/* when it is over there is room again */
	msleep(10500);
	l0 = lines(b);
	ec_log_event(bus_base(b), 999, 0, KERN_WARNING, "many\n");
	KUNIT_EXPECT_EQ(test, lines(b) - l0, 1ull);
}

/* A slave answers each message with a mailbox error reply. */
static void log_mailbox_errors(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, BAD);
	struct ec_mbox_limit limit = { .timeout_ms = 100 };
	u64 l0 = lines(b);
	u8 v[8];
	size_t got;
	u16 error;
	u32 i;

	/* by its EEPROM it has SoE */
	s->info.protocols |= EC_SII_PROTO_SOE;
	for (i = 0; i < 500; i++)
		KUNIT_EXPECT_LT(test,
				ec_soe_read(&s->mbox, 0, 1, v, sizeof(v), &got, &error, &limit), 0);
	KUNIT_EXPECT_GE(test, lines(b) - l0, 1ull);
	KUNIT_EXPECT_LE(test, lines(b) - l0, 2ull);
}

/* A slave shows an error, with another code each time, as often as it can. */
static void log_al_errors(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 l0 = lines(b), end;
	u32 i;

	bus_request(b, BAD, EC_AL_SAFEOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, BAD, EC_AL_SAFEOP, 500), ~0ull);
	end = ktime_get_ns() + 30 * NSEC_PER_SEC;
	for (i = 0; ktime_get_ns() < end; i++) {
		ec_app_al_fail(bus_app(b, "bad"), EC_AL_PREOP, 0x8000 + i % 100, ktime_get_ns());
		msleep(30);
	}
	bus_figure("%u AL errors in 30 s: %llu lines", i, lines(b) - l0);
	KUNIT_EXPECT_GT(test, i, 200u);
	KUNIT_EXPECT_GE(test, lines(b) - l0, 4ull);
	KUNIT_EXPECT_LE(test, lines(b) - l0, 12ull);
}

static bool flapping(void *priv)
{
	return ktime_to_ms(ktime_get()) / 25 & 1;
}

/* A bad plug: the link goes up and down all the time. */
static void log_link_flaps(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ecdev *dev = bus_dev(b);
	const struct ecdev_ops *ops = dev->ops;
	struct ecdev_ops bad = *ops;
	u64 l0 = lines(b), n;

	bad.link_up = flapping;
	dev->ops = &bad;
	msleep(60000);
	dev->ops = ops;
	msleep(1000);
	n = lines(b) - l0;
	bus_figure("link flaps for 60 s: %llu lines", n);
	KUNIT_EXPECT_GE(test, n, 5ull);
	KUNIT_EXPECT_LE(test, n, 40ull);
}

/* A slave is cut off and comes back all the time. */
static void log_cable_flaps(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 l0 = lines(b);
	u32 i;

	for (i = 0; i < 60; i++) {
		bus_fault(b, EC_SIM_FAULT_CUT, BAD, 0, 0, 0);
		msleep(300);
		bus_fault(b, EC_SIM_FAULT_HEAL, BAD, 0, 0, 0);
		msleep(300);
	}
	bus_figure("60 cuts of a cable in 36 s: %llu lines", lines(b) - l0);
	KUNIT_EXPECT_GE(test, lines(b) - l0, 5ull);
	KUNIT_EXPECT_LE(test, lines(b) - l0, 40ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(log_equal),
	KUNIT_CASE(log_varied),
	KUNIT_CASE(log_many),
	KUNIT_CASE(log_mailbox_errors),
	KUNIT_CASE(log_al_errors),
	KUNIT_CASE(log_link_flaps),
	KUNIT_CASE(log_cable_flaps),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_log",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
