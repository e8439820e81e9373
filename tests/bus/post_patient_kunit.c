// SPDX-License-Identifier: GPL-2.0-only
/* Patient posts: what a cycle owner receives for them ends when its process data have left. */
#include "master/carry/flight.h"
#include "posts.h"

#define ALL	(BIT(POSTS) - 1)

/* Sent in one frame, all of them patient but those of @others. */
static struct rig *patient(struct kunit *test, u32 others)
{
	struct rig *r = rig_new(test);
	u32 i;

	for (i = 0; i < POSTS; i++)
		r->post[i].patient = !(others & BIT(i));
	rig_send(r, ALL);
	KUNIT_ASSERT_EQ(test, r->frames[0], 1u);
	rig_answer(r, 0);
	return r;
}

/* The cycle owner receives the reply. */
static void poll(struct rig *r)
{
	struct ec_carry *c = bus_carry(r->b);

	WRITE_ONCE(c->polled, true);
	rig_give(r, 0, r->frame[0] + EC_ETH_HDR, r->len[0]);
	WRITE_ONCE(c->polled, false);
}

static void patient_ends_in_send(struct kunit *test)
{
	struct rig *r = patient(test, 0);

	poll(r);
	rig_expect(r, ALL, 0, -EINPROGRESS);
	KUNIT_EXPECT_TRUE(test, ec_carry_has_landed(bus_carry(r->b)));
	ec_flight_land(bus_carry(r->b));
	rig_expect(r, ALL, 1, 0);
	KUNIT_EXPECT_FALSE(test, ec_carry_has_landed(bus_carry(r->b)));
	ec_flight_land(bus_carry(r->b));
	rig_expect(r, ALL, 1, 0);
	KUNIT_EXPECT_EQ(test, bus_acyclic(r->b), 0u);
}

/* A frame is not held for those that can wait, nor outside of the cycle owner's receive. */
static void patient_beside_others(struct kunit *test)
{
	struct rig *r = patient(test, BIT(2));

	poll(r);
	rig_expect(r, ALL, 1, 0);
	r->post[2].patient = true;
	rig_send(r, ALL);
	rig_answer(r, 0);
	rig_give(r, 0, r->frame[0] + EC_ETH_HDR, r->len[0]);
	rig_expect(r, ALL, 2, 0);
}

/* The cycle owner sends no more: the thread ends them. */
static void patient_without_send(struct kunit *test)
{
	struct rig *r = patient(test, 0);
	u64 lost = bus_lost(r->b);

	poll(r);
	msleep(50);
	rig_expect(r, ALL, 1, 0);
	KUNIT_EXPECT_EQ(test, bus_lost(r->b), lost);
	KUNIT_EXPECT_EQ(test, bus_posts(r->b), 0u);
}

/* Cancelled with its reply there: nothing of it is written any more. */
static void patient_cancelled(struct kunit *test)
{
	struct rig *r = patient(test, 0);

	poll(r);
	ec_post_cancel(&r->post[0]);
	memset(r->data[0], 0x77, sizeof(r->data[0]));
	ec_flight_land(bus_carry(r->b));
	rig_expect(r, ALL & ~BIT(0), 1, 0);
	KUNIT_EXPECT_EQ(test, r->ends[0], 0u);
	KUNIT_EXPECT_EQ(test, r->data[0][0][0], 0x77);
}

static void patient_device_gone(struct kunit *test)
{
	struct rig *r = patient(test, 0);

	poll(r);
	bus_dev(r->b)->ops = r->real;
	bus_no_device(r->b);
	msleep(50);
	rig_expect(r, ALL, 1, 0);
	KUNIT_EXPECT_EQ(test, bus_posts(r->b), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(patient_ends_in_send),
	KUNIT_CASE(patient_beside_others),
	KUNIT_CASE(patient_without_send),
	KUNIT_CASE(patient_cancelled),
	KUNIT_CASE(patient_device_gone),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_post_patient",
	.exit = rig_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
