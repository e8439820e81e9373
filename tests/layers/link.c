// SPDX-License-Identifier: GPL-2.0-only
/* The layer "link" with devices that behave as a test says; there is no slave. */
#include "alone.h"
#include "card.h"

/* links of a master that has nothing else */
struct bench {
	struct ec_base base;
	struct ec_links links;
	struct test_device d[EC_MAX_LINKS];
	struct ecdev *dev[EC_MAX_LINKS];
	struct ec_slot *done;	/* the last one */
};

static void bench_free(struct bench *b)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++)
		if (b->dev[i])
			ecdev_withdraw(b->dev[i]);
	ec_links_exit(&b->links);
	kvfree(b);
}

static bool plug(struct bench *b, unsigned int side, enum behaviour does)
{
	u8 address[ETH_ALEN];
	struct ecdev *dev;

	ether_addr_copy(address, mac);
	address[5] += side;
	b->d[side].does = does;
	b->d[side].up = true;
	b->d[side].links = &b->links;
	dev = ecdev_offer(side ? "test1" : "test0", address, &device_ops, &b->d[side]);
	if (!CHECK(!IS_ERR(dev)))
		return false;
	b->dev[side] = dev;
	return CHECK(b->links.link[side].dev == dev);
}

static struct bench *bench_new(bool two, enum behaviour does)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);
	bool ok;

	if (!CHECK(b))
		return NULL;
	ec_base_init(&b->base, 0, 0);
	if (!CHECK_EQ(ec_links_init(&b->links, &b->base, NULL, "test0", two ? "test1" : NULL), 0)) {
		kvfree(b);
		return NULL;
	}
	if (two) {
		b->links.sides = BIT(EC_MAIN) | BIT(EC_BACKUP);
		b->links.only = NULL;
	}
	ec_device_register(&b->links);
	ok = plug(b, EC_MAIN, does) && (!two || plug(b, EC_BACKUP, does)) &&
	     CHECK_EQ(ec_links_look(&b->links), true);
	if (ok)
		return b;
	bench_free(b);
	return NULL;
}

static void slot_done(struct ec_slot *slot)
{
	struct bench *b = slot->user;

	b->done = slot;
}

/* a frame with one datagram */
static int send(struct bench *b, struct ec_slot **slot)
{
	struct ec_slot *s = ec_slot_get(&b->links.slots, false, ktime_get_ns());
	const struct ec_tx tx = { .sides = b->links.sides };
	struct ec_frame_buf fb;
	int ret;

	ec_frame_begin(&fb, ec_slot_body(s), EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	memset(ec_frame_add(&fb, EC_CMD_FPRD, s->index, 1001, 0x130, 4), 0, 4);
	s->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	s->done = slot_done;
	s->user = b;
	b->done = NULL;
	rcu_read_lock();
	ret = ec_links_transmit(&b->links, s, s->frame, &tx, ktime_get_ns());
	ec_links_flush(&b->links);
	rcu_read_unlock();
	*slot = s;
	return ret;
}

static u8 data_of(const struct ec_slot *slot, unsigned int side)
{
	return slot->got[side][EC_FRAME_HDR + EC_DGRAM_HDR];
}

static void reply_ends_the_slot(void)
{
	struct bench *b = bench_new(false, ANSWERS);
	struct ec_slot *slot;

	if (!b)
		return;
	CHECK_EQ(send(b, &slot), 0);
	CHECK(b->done == slot);
	CHECK_EQ(atomic_read(&slot->state), EC_SLOT_DONE);
	CHECK_EQ(data_of(slot, EC_MAIN), 0xa5);
	CHECK_EQ(ec_links_sent(&b->links), 1);
	ec_slot_put(slot);
	CHECK_EQ(atomic_read(&slot->state), EC_SLOT_FREE);
	bench_free(b);
}

static void cancelled_frame_is_late(void)
{
	struct bench *b = bench_new(false, HOLDS);
	struct ec_slot *slot;

	if (!b)
		return;
	CHECK_EQ(send(b, &slot), 0);
	CHECK_EQ(ec_slot_settle(slot), false);
	CHECK_EQ(ec_slot_cancel(slot, ktime_get_ns()), true);
	deliver(&b->d[0]);
	CHECK(!b->done);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.late), 1);
	/* number of a frame that was never sent */
	b->d[0].held[ETH_ALEN + 5] ^= 0x55;
	deliver(&b->d[0]);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.late), 1);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.unmatched), 1);
	bench_free(b);
}

/* each copy, and what was sent, can be read */
static void two_links_bring_two_copies(void)
{
	struct bench *b = bench_new(true, HOLDS);
	struct ec_slot *slot;

	if (!b)
		return;
	CHECK_EQ(send(b, &slot), 0);
	CHECK_EQ(b->d[0].sent, 1);
	CHECK_EQ(b->d[1].sent, 1);
	deliver(&b->d[1]);
	CHECK(!b->done);
	/* twice the same one */
	deliver(&b->d[1]);
	CHECK(!b->done);
	CHECK_EQ(atomic64_read(&b->links.link[1].stats.unmatched), 1);
	deliver(&b->d[0]);
	CHECK(b->done == slot);
	CHECK_EQ(slot->back, 3);
	CHECK_EQ(data_of(slot, EC_MAIN), 0xa5);
	CHECK_EQ(data_of(slot, EC_BACKUP), 0xa5);
	CHECK_EQ(ec_slot_body(slot)[EC_FRAME_HDR + EC_DGRAM_HDR], 0);
	ec_slot_put(slot);
	bench_free(b);
}

/* the copy that came is kept when the other one does not */
static void one_copy_of_two_settles(void)
{
	struct bench *b = bench_new(true, HOLDS);
	struct ec_slot *slot;
	unsigned int side;

	if (!b)
		return;
	for (side = 0; side < EC_MAX_LINKS; side++) {
		CHECK_EQ(send(b, &slot), 0);
		deliver(&b->d[side]);
		CHECK_EQ(ec_slot_settle(slot), true);
		CHECK(!b->done);
		CHECK_EQ(atomic_read(&slot->state), EC_SLOT_DONE);
		CHECK_EQ(slot->back, BIT(side));
		CHECK_EQ(data_of(slot, side), 0xa5);
		/* the other one may still come: it finds nobody */
		ec_slot_put(slot);
		CHECK_EQ(atomic_read(&slot->state), EC_SLOT_QUARANTINE);
		deliver(&b->d[!side]);
		CHECK_EQ(atomic64_read(&b->links.link[!side].stats.late), 1);
	}
	bench_free(b);
}

/* a link that refuses a frame, is full, or has no device, does not stop the other */
static void failing_link_does_not_stop_the_other(void)
{
	struct bench *b = bench_new(true, ANSWERS);
	struct ec_slot *slot;
	unsigned int side;

	if (!b)
		return;
	for (side = 0; side < EC_MAX_LINKS; side++) {
		b->d[side].refuses = -ENETDOWN;
		CHECK_EQ(send(b, &slot), 0);
		CHECK(b->done == slot);
		CHECK_EQ(slot->sides, BIT(!side));
		ec_slot_put(slot);
		CHECK_EQ(atomic_read(&slot->state), EC_SLOT_FREE);
		b->d[side].refuses = 0;
	}
	b->d[0].refuses = b->d[1].refuses = -ENETDOWN;
	CHECK_EQ(send(b, &slot), -ENETDOWN);
	CHECK_EQ(atomic_read(&slot->state), EC_SLOT_BUILD);
	ec_slot_put(slot);
	bench_free(b);
}

/* The owner of the cycle is the only one that polls: the device hears of it before it may. */
static void device_hears_of_cycle_first(void)
{
	struct bench *b = bench_new(false, ANSWERS);

	if (!b)
		return;
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_CYCLIC), true);
	CHECK_EQ(b->d[0].cyclic, true);
	CHECK_EQ(b->d[0].mode, EC_ACCESS_DIRECT);
	/* one that comes while there is a cycle */
	ecdev_withdraw(b->dev[0]);
	b->dev[0] = NULL;
	CHECK_EQ(b->d[0].cyclic, false);
	ec_access_change(&b->links, EC_ACCESS_CYCLIC);
	if (plug(b, EC_MAIN, ANSWERS))
		CHECK_EQ(b->d[0].cyclic, true);
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_DIRECT), true);
	CHECK_EQ(b->d[0].cyclic, false);
	bench_free(b);
}

/* the cycle goes on with the device that is left */
static void one_device_of_two_leaves_the_cycle(void)
{
	struct bench *b = bench_new(true, ANSWERS);
	struct ec_slot *slot;

	if (!b)
		return;
	ec_access_change(&b->links, EC_ACCESS_CYCLIC);
	ecdev_withdraw(b->dev[EC_MAIN]);
	b->dev[EC_MAIN] = NULL;
	CHECK_EQ(ec_access_is_cyclic(&b->links.access), true);
	CHECK_EQ(b->d[EC_MAIN].cyclic, false);
	CHECK_EQ(b->d[EC_BACKUP].cyclic, true);
	CHECK_EQ(ec_access_try_enter(&b->links), 0);
	CHECK_EQ(send(b, &slot), 0);
	CHECK(b->done == slot);
	ec_slot_put(slot);
	ec_access_leave(&b->links.access);
	ecdev_withdraw(b->dev[EC_BACKUP]);
	b->dev[EC_BACKUP] = NULL;
	CHECK_EQ(ec_access_is_cyclic(&b->links.access), false);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(reply_ends_the_slot),
	TEST(cancelled_frame_is_late),
	TEST(two_links_bring_two_copies),
	TEST(one_copy_of_two_settles),
	TEST(failing_link_does_not_stop_the_other),
	TEST(device_hears_of_cycle_first),
	TEST(one_device_of_two_leaves_the_cycle),
	{ }
};
