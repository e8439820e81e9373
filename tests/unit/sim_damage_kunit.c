// SPDX-License-Identifier: GPL-2.0-only
/* Cables that damage frames, and the error counters of the slaves behind them. */
#include "sim_flight_kunit.h"

#define ALL	1000000

static void damage(struct kunit *test, struct bed *b, int slave, int port, u32 ppm)
{
	const struct ec_sim_fault f = {
		.type = EC_SIM_FAULT_DAMAGE, .slave = slave, .port = port, .arg = ppm,
	};

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	ec_sim_advance(b->sim, b->now);
}

static u8 invalid(struct bed *b, u32 slave, int port)
{
	return ec_sim_slave(b->sim, slave)->mem[EC_REG_ERR_RX(port)];
}

static u8 forwarded(struct bed *b, u32 slave, int port)
{
	return ec_sim_slave(b->sim, slave)->mem[EC_REG_ERR_FWD(port)];
}

/* all ports in the order in which a frame comes to them */
static const struct {
	u8 slave, port;
} arrivals[] = {
	{ 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 5, 0 }, { 4, 1 }, { 3, 1 }, { 2, 1 },
	{ 6, 0 }, { 2, 2 }, { 1, 1 }, { 0, 1 },
};

/* slaves that process the frame before it comes to arrival @at */
static u32 before(u32 at)
{
	u32 v = 0;

	for (u32 i = 0; i < at; i++)
		v |= arrivals[i].port ? 0 : BIT(arrivals[i].slave);
	return v;
}

static void sim_damage_counts_invalid_once_then_forwarded(struct kunit *test)
{
	for (u32 at = 0; at < ARRAY_SIZE(arrivals); at++) {
		struct bed *b = line(test, 100);
		struct air a;

		damage(test, b, arrivals[at].slave, arrivals[at].port, ALL);
		mark(b, &a, b->now, 1);
		ec_sim_advance(b->sim, b->now + SECOND);
		KUNIT_EXPECT_TRUE(test, a.fl.done);
		KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
		KUNIT_EXPECT_TRUE(test, a.fl.res.induced);
		KUNIT_EXPECT_EQ(test, marked(b, 1), before(at));
		for (u32 i = 0; i < ARRAY_SIZE(arrivals); i++) {
			u32 s = arrivals[i].slave, p = arrivals[i].port;

			KUNIT_EXPECT_EQ_MSG(test, invalid(b, s, p), i == at, "%u at %u", i, at);
			KUNIT_EXPECT_EQ_MSG(test, forwarded(b, s, p), i > at, "%u at %u", i, at);
		}
		damage(test, b, arrivals[at].slave, arrivals[at].port, 0);
		b->now += SECOND;
		mark(b, &a, b->now, 2);
		KUNIT_EXPECT_EQ_MSG(test, wkc(&a), 7, "the cable is whole again");
		ec_sim_free(b->sim);
		test->priv = NULL;
	}
}

/* feature bit 7 of 0x0008 */
static void sim_damage_is_invalid_frame_without_separate_counter(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct air a;

	ec_sim_slave(b->sim, 4)->cfg.features &= (u16)~EC_FEAT_FCS_SEPARATE;
	damage(test, b, 3, 0, ALL);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, invalid(b, 4, 0), 1);
	KUNIT_EXPECT_EQ(test, forwarded(b, 4, 0), 0);
	KUNIT_EXPECT_EQ(test, forwarded(b, 5, 0), 1);
}

static void sim_damage_by_chance_and_up_to_255(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct air a;
	u32 lost = 0;

	damage(test, b, 3, 0, ALL / 10);
	for (u32 i = 0; i < 1000; i++) {
		b->now += 100 * US;
		mark(b, &a, b->now, 1);
		ec_sim_advance(b->sim, b->now + 50 * US);
		KUNIT_ASSERT_TRUE(test, a.fl.done);
		lost += !a.fl.res.copies;
	}
	KUNIT_EXPECT_GT(test, lost, 70u);
	KUNIT_EXPECT_LT(test, lost, 130u);
	KUNIT_EXPECT_EQ(test, invalid(b, 3, 0), lost);
	KUNIT_EXPECT_EQ(test, forwarded(b, 0, 1), lost);
	damage(test, b, 3, 0, ALL);
	for (u32 i = 0; i < 300; i++) {
		b->now += 100 * US;
		mark(b, &a, b->now, 1);
		ec_sim_advance(b->sim, b->now + 50 * US);
	}
	KUNIT_EXPECT_EQ(test, invalid(b, 3, 0), 0xff);
	KUNIT_EXPECT_EQ(test, forwarded(b, 0, 1), 0xff);
	/* a write to one of them clears those of all ports */
	KUNIT_EXPECT_EQ(test, invalid(b, 1, 0), 0);
	ec_sim_clear_faults(b->sim);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1004, EC_REG_ERR_FWD(3), 0, 1), 1);
	KUNIT_EXPECT_EQ(test, invalid(b, 3, 0), 0);
	KUNIT_EXPECT_EQ(test, invalid(b, 0, 1), 0);
	KUNIT_EXPECT_EQ_MSG(test, forwarded(b, 0, 1), 0xff, "that of another slave");
}

static void sim_damage_words_are_checked(struct kunit *test)
{
	static const struct {
		const char *text, *error;
	} wrong[] = {
		{ "damage b.1", "missing rate: expected fault damage NAME.PORT rate=10ppm" },
		{ "damage b.1 rate=2", "'2' is not a rate: expected 25ppm or 300ppb" },
	};
	struct bed *b = app_bed_part(test, "slave a EK1100\nslave b EL2008\n", 2);
	struct ec_sim_error err;
	struct ec_sim_fault f;

	for (u32 i = 0; i < ARRAY_SIZE(wrong); i++) {
		const char *t = wrong[i].text;

		KUNIT_EXPECT_EQ(test, ec_sim_command(b->sim, &bed_ops, t, strlen(t), &f, &err),
				-EINVAL);
		KUNIT_EXPECT_STREQ(test, err.text, wrong[i].error);
	}
	command(test, b, "damage b.0 rate=1000000ppm");
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, invalid(b, 1, 0), 1);
	command(test, b, "damage b.0 rate=0ppm");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_damage_counts_invalid_once_then_forwarded),
	KUNIT_CASE(sim_damage_is_invalid_frame_without_separate_counter),
	KUNIT_CASE(sim_damage_by_chance_and_up_to_255),
	KUNIT_CASE(sim_damage_words_are_checked),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_damage",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
