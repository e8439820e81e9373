// SPDX-License-Identifier: GPL-2.0-only
/* Frames of several callers that leave as one: each has its own back, or none has. */
#include <linux/rcupdate.h>
#include "bus.h"
#include "devices/ecdev.h"
#include "master/link/pack.h"

static const char text[] =
	"segment seed=24 response=100us transition=200us\n"
	"slave a EK1100\nslave b EL2008\nslave c drive serial=9\n";

#define N	3
#define MEMBERS	4

static const struct ec_pack_room roomy = {
	.len = EC_FRAME_HDR + EC_FRAME_BODY_MAX, .dgrams = 15,
};

/* a frame that four callers share, on its way, and a good reply to it */
struct shared {
	struct bus *b;
	u8 links;
	struct ec_slot *slot[MEMBERS];
	struct ec_xfer x[MEMBERS];
	struct ec_queued e[MEMBERS];
	struct ec_pack pack;
	u8 frame[EC_ETH_MAX];
	size_t len;	/* behind the EtherType */
	u8 *reply;
};

/* datagrams of the callers: command, address, bytes; the third has two */
static const struct { u8 member, cmd; u16 adp, ado, len; } dgrams[] = {
	{ 0, EC_CMD_FPRD, 0x1001, 0x0130, 2 },
	{ 1, EC_CMD_FPWR, 0x1002, 0x1000, 128 },
	{ 2, EC_CMD_FPRD, 0x1003, 0x0130, 6 },
	{ 2, EC_CMD_BRD, 0x0000, 0x0000, 1 },
	{ 3, EC_CMD_FPRD, 0x1001, 0x080d, 1 },
};

/* What ec_xfer() does with the datagrams of caller @k. */
static void arm(struct shared *s, u32 k)
{
	struct ec_slots *slots = bus_slots(s->b);
	struct ec_frame_buf fb;
	u32 i;

	ec_frame_begin(&fb, ec_slot_body(s->slot[k]), EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	for (i = 0; i < ARRAY_SIZE(dgrams); i++)
		if (dgrams[i].member == k)
			memset(ec_frame_add(&fb, dgrams[i].cmd, s->slot[k]->index, dgrams[i].adp,
					    dgrams[i].ado, dgrams[i].len), 0x10 + i, dgrams[i].len);
	s->slot[k]->dgrams = fb.count;
	s->slot[k]->last = fb.last - (fb.buf + EC_FRAME_HDR);
	s->slot[k]->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	init_completion(&s->x[k].done);
	atomic_set(&s->x[k].pending, 1);
	s->slot[k]->xfer = &s->x[k];
	ec_slot_queue(slots, s->slot[k], s->links, ktime_get_ns());
	s->e[k] = (struct ec_queued){ .slot = s->slot[k], .seq = s->slot[k]->seq };
}

/* The frame leaves: as what is in @s->frame. */
static void leave(struct shared *s)
{
	u32 k;

	ec_pack_begin(&s->pack);
	for (k = 0; k < MEMBERS; k++)
		KUNIT_ASSERT_TRUE(s->b->test, ec_pack_add(&s->pack, &s->e[k], &roomy));
	KUNIT_ASSERT_EQ(s->b->test, s->pack.n, MEMBERS);
	ec_pack_place(bus_slots(s->b), &s->pack, ktime_get_ns());
	ec_pack_write(&s->pack, s->frame);
	ec_pack_release(&s->pack, EC_SLOT_SENT);
	s->len = s->pack.len;
	s->reply = s->frame + EC_ETH_HDR;
	/* every slave does so */
	s->frame[6] |= 2;
}

static struct shared *shared(struct kunit *test)
{
	struct shared *s = kunit_kzalloc(test, sizeof(*s), GFP_KERNEL);
	u32 k;

	KUNIT_ASSERT_NOT_NULL(test, s);
	s->b = bus_up(test, text, N);
	s->links = BIT(0);
	bus_idle(s->b);
	for (k = 0; k < MEMBERS; k++) {
		s->slot[k] = ec_slot_get(bus_slots(s->b), false, ktime_get_ns());
		KUNIT_ASSERT_NOT_NULL(test, s->slot[k]);
		arm(s, k);
	}
	leave(s);
	return s;
}

static void give(struct shared *s, const u8 *data, size_t len)
{
	rcu_read_lock();
	ecdev_receive(bus_dev(s->b), s->frame + 6, data, len);
	rcu_read_unlock();
}

static u64 refused(const struct shared *s)
{
	const struct ec_link_stats *st = bus_stats(s->b);

	return atomic64_read(&st->unmatched) + atomic64_read(&st->late);
}

/* The slots in @done have their reply, the others (but those in @gone) still wait. */
static void expect(struct shared *s, u32 done, u32 gone)
{
	struct kunit *test = s->b->test;
	u32 k;

	for (k = 0; k < MEMBERS; k++) {
		if (gone & BIT(k))
			continue;
		KUNIT_ASSERT_EQ_MSG(test, atomic_read(&s->slot[k]->state),
				    done & BIT(k) ? EC_SLOT_DONE : EC_SLOT_SENT, "caller %u", k);
		KUNIT_ASSERT_EQ_MSG(test, completion_done(&s->x[k].done), !!(done & BIT(k)),
				    "caller %u", k);
	}
}

/* Each caller has its part of the reply, data and working counter. */
static void expect_data(struct shared *s, u32 done)
{
	u32 seen[MEMBERS] = { 0 }, i;

	for (i = 0; i < ARRAY_SIZE(dgrams); i++) {
		u32 k = dgrams[i].member, n;
		struct ec_frame_iter it;
		struct ec_dgram d;

		if (!(done & BIT(k)))
			continue;
		KUNIT_ASSERT_EQ(s->b->test, ec_frame_iter_init(&it, ec_slot_body(s->slot[k]),
							       s->slot[k]->eth_len - EC_ETH_HDR), 0);
		for (n = 0; n <= seen[k]; n++)
			KUNIT_ASSERT_EQ(s->b->test, ec_frame_iter_next(&it, &d), 1);
		seen[k]++;
		KUNIT_EXPECT_EQ(s->b->test, d.len, dgrams[i].len);
		KUNIT_EXPECT_EQ(s->b->test, d.data[d.len - 1], 0xa0 + i);
		KUNIT_EXPECT_EQ(s->b->test, ec_dgram_wkc(&d), i + 1);
	}
}

/* What slaves do: data and working counters change. */
static void answer(struct shared *s)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	u32 i = 0;

	KUNIT_ASSERT_EQ(s->b->test, ec_frame_iter_init(&it, s->reply, s->len), 0);
	while (ec_frame_iter_next(&it, &d) == 1) {
		memset(d.data, 0xa0 + i, d.len);
		ec_dgram_set_wkc(&d, ++i);
	}
	KUNIT_ASSERT_EQ(s->b->test, i, (u32)ARRAY_SIZE(dgrams));
}

static void put(struct shared *s, u32 done)
{
	u32 k;

	for (k = 0; k < MEMBERS; k++)
		if (done & BIT(k))
			ec_slot_put(s->slot[k]);
}

static void pack_dealt_out(struct kunit *test)
{
	struct shared *s = shared(test);
	u64 before = refused(s);

	answer(s);
	expect(s, 0, 0);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	expect_data(s, 15);
	KUNIT_EXPECT_EQ(test, refused(s), before);
	/* a second copy */
	give(s, s->reply, s->len);
	KUNIT_EXPECT_EQ(test, refused(s), before + 1);
	put(s, 15);
	give(s, s->reply, s->len);
	KUNIT_EXPECT_EQ(test, refused(s), before + 2);
}

/* Bits a header reserves, or a slave may set, are no reason to refuse a frame. */
static bool free_bit(const struct shared *s, size_t byte, u32 bit)
{
	struct ec_frame_iter it, at;
	struct ec_dgram d;

	if (byte == 1)
		return bit == 3;
	ec_frame_iter_init(&it, s->reply, s->len);
	for (at = it; ec_frame_iter_next(&it, &d) == 1; at = it)
		if (byte == (size_t)(at.p - s->reply) + 7)
			return bit >= 3 && bit <= 6;
	return false;
}

static bool is_header(const struct shared *s, size_t byte)
{
	struct ec_frame_iter it, at;
	struct ec_dgram d;

	ec_frame_iter_init(&it, s->reply, s->len);
	for (at = it; ec_frame_iter_next(&it, &d) == 1; at = it)
		if (byte >= (size_t)(at.p - s->reply) && byte < (size_t)(at.p - s->reply) + 8)
			/* of a broadcast each slave counts the position */
			return d.cmd != EC_CMD_BRD || (byte - (at.p - s->reply)) / 2 != 1;
	return byte < EC_FRAME_HDR;
}

/* Not one changed bit of a header is taken, whosever it is: no caller has anything then. */
static void pack_changed(struct kunit *test)
{
	struct shared *s = shared(test);
	u8 *copy = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
	u64 before = refused(s);
	u32 n = 0;
	size_t i;
	u8 bit;

	for (i = 0; i < s->len; i++) {
		for (bit = 0; bit < 8 && is_header(s, i); bit++) {
			if (free_bit(s, i, bit))
				continue;
			memcpy(copy, s->reply, s->len);
			copy[i] ^= 1 << bit;
			give(s, copy, s->len);
			n++;
			expect(s, 0, 0);
		}
	}
	KUNIT_EXPECT_GT(test, n, 250u);
	KUNIT_EXPECT_EQ(test, refused(s) - before, (u64)n);
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	put(s, 15);
}

static void pack_truncated(struct kunit *test)
{
	struct shared *s = shared(test);
	u64 before = refused(s);
	size_t len;

	for (len = 0; len < s->len; len++) {
		/* a copy, so that the tool sees a read behind it */
		u8 *cut = kmemdup(s->reply, len, GFP_KERNEL);

		give(s, cut, len);
		kfree(cut);
		expect(s, 0, 0);
	}
	KUNIT_EXPECT_EQ(test, refused(s) - before, (u64)s->len);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	put(s, 15);
}

/* Datagrams in another order, twice, one too many, in a frame that is not marked. */
static void pack_other_order(struct kunit *test)
{
	struct shared *s = shared(test);
	u8 *copy = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
	static const u8 order[][5] = {
		{ 1, 0, 2, 3, 4 }, { 0, 1, 3, 2, 4 }, { 0, 1, 4, 2, 3 }, { 0, 1, 2, 3, 0 },
		{ 4, 1, 2, 3, 0 }, { 0, 1, 2, 3, 3 }, { 2, 3, 0, 1, 4 },
	};
	struct ec_frame_buf fb;
	u32 i, k;

	for (i = 0; i <= ARRAY_SIZE(order); i++) {
		ec_frame_begin(&fb, copy, EC_ETH_MAX);
		for (k = 0; k < ARRAY_SIZE(dgrams) + (i == ARRAY_SIZE(order)); k++) {
			u32 j = i < ARRAY_SIZE(order) ? order[i][k] : k % ARRAY_SIZE(dgrams);

			ec_frame_add(&fb, dgrams[j].cmd, s->slot[dgrams[j].member]->index,
				     dgrams[j].adp, dgrams[j].ado, dgrams[j].len);
		}
		give(s, copy, ec_frame_end(&fb));
		expect(s, 0, 0);
	}
	/* the frame of one caller, as it would be without the others */
	memcpy(copy, s->frame + 6, 6);
	for (k = 0; k < MEMBERS; k++) {
		size_t len = s->slot[k]->eth_len - EC_ETH_HDR;

		give(s, ec_slot_body(s->slot[k]), len);
		expect(s, 0, 0);
	}
	s->frame[7] &= ~EC_PACKED;
	give(s, s->reply, s->len);
	expect(s, 0, 0);
	s->frame[7] |= EC_PACKED;
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	put(s, 15);
}

/* Any caller may give up: the others have theirs, nobody has what is not his. */
static void pack_given_up(struct kunit *test)
{
	struct shared *s = shared(test);
	u32 gone, k;

	answer(s);
	for (gone = 1; gone < 15; gone++) {
		if (gone > 1)
			for (k = 0; k < MEMBERS; k++)
				arm(s, k);
		if (gone > 1) {
			leave(s);
			answer(s);
		}
		for (k = 0; k < MEMBERS; k++)
			if (gone & BIT(k))
				KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[k], ktime_get_ns()));
		give(s, s->reply, s->len);
		expect(s, 15 & ~gone, gone);
		expect_data(s, 15 & ~gone);
		for (k = 0; k < MEMBERS; k++) {
			if (gone & BIT(k))
				KUNIT_ASSERT_EQ(test, atomic_read(&s->slot[k]->state),
						EC_SLOT_QUARANTINE);
			/* as somebody takes it who needs it next */
			atomic_set(&s->slot[k]->state, EC_SLOT_BUILD);
		}
	}
	put(s, 15);
}

/* One caller or two have given up, and their datagrams come back with other lengths. */
static void pack_gone_changed(struct kunit *test)
{
	static const struct { u32 gone; u16 len[ARRAY_SIZE(dgrams)]; } t[] = {
		/* as long as before, but the second caller's part is at another place */
		{ 5, { 3, 128, 5, 1, 1 } },
		{ 8, { 2, 128, 6, 1, 5 } },
	};
	struct shared *s = shared(test);
	u8 *copy = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
	struct ec_frame_buf fb;
	u32 i, k;

	for (i = 0; i < ARRAY_SIZE(t); i++) {
		answer(s);
		for (k = 0; k < MEMBERS; k++)
			if (t[i].gone & BIT(k))
				KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[k], ktime_get_ns()));
		ec_frame_begin(&fb, copy, EC_ETH_MAX);
		for (k = 0; k < ARRAY_SIZE(dgrams); k++)
			ec_frame_add(&fb, dgrams[k].cmd, s->slot[dgrams[k].member]->index,
				     dgrams[k].adp, dgrams[k].ado, t[i].len[k]);
		give(s, copy, ec_frame_end(&fb));
		expect(s, 0, t[i].gone);
		give(s, s->reply, s->len);
		expect(s, 15 & ~t[i].gone, t[i].gone);
		expect_data(s, 15 & ~t[i].gone);
		for (k = 0; k < MEMBERS; k++) {
			atomic_set(&s->slot[k]->state, EC_SLOT_BUILD);
			arm(s, k);
		}
		leave(s);
	}
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	put(s, 15);
}

/* A frame that left on two links: each caller waits for both copies, and has both. */
static void pack_on_two_links_done_with_both_copies(struct kunit *test)
{
	struct shared *s = shared(test);
	u64 before = refused(s);
	u32 k;

	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	s->links = BIT(0) | BIT(1);
	for (k = 0; k < MEMBERS; k++) {
		s->slot[k]->backup = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
		arm(s, k);
	}
	leave(s);
	s->frame[7] |= 1;
	give(s, s->reply, s->len);
	expect(s, 0, 0);
	KUNIT_EXPECT_EQ(test, refused(s), before);
	/* the same copy again, and one of a link that there is not */
	give(s, s->reply, s->len);
	s->frame[7] ^= 3;
	give(s, s->reply, s->len);
	expect(s, 0, 0);
	KUNIT_EXPECT_EQ(test, refused(s), before + 2);
	s->frame[7] ^= 2;
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	expect_data(s, 15);
	/* the other one is as it came: before the answer */
	KUNIT_EXPECT_EQ(test, s->slot[1]->backup[EC_FRAME_HDR + EC_DGRAM_HDR], 0x11);
	for (k = 0; k < MEMBERS; k++)
		s->slot[k]->backup = NULL;
	put(s, 15);
}

/* The same when the copy of the main link is the first: it is what the other is compared with. */
static void pack_on_two_links_main_copy_first(struct kunit *test)
{
	struct shared *s = shared(test);
	u32 k;

	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	s->links = BIT(0) | BIT(1);
	for (k = 0; k < MEMBERS; k++) {
		s->slot[k]->backup = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
		arm(s, k);
	}
	leave(s);
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 0, 0);
	s->frame[7] |= 1;
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	expect_data(s, 15);
	for (k = 0; k < MEMBERS; k++)
		s->slot[k]->backup = NULL;
	put(s, 15);
}

/* A slot that is in use by another: not with the reply to the one before. */
static void pack_reused(struct kunit *test)
{
	struct shared *s = shared(test);
	u8 *old = kunit_kzalloc(test, sizeof(s->frame), GFP_KERNEL);
	u64 before;

	/* alone */
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[1], ktime_get_ns()));
	atomic_set(&s->slot[1]->state, EC_SLOT_BUILD);
	arm(s, 1);
	atomic_set(&s->slot[1]->state, EC_SLOT_SENT);
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 13, 0);
	/* then all of them, in a frame they share as before */
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[1], ktime_get_ns()));
	memcpy(old, s->frame, sizeof(s->frame));
	arm(s, 0);
	arm(s, 1);
	arm(s, 2);
	arm(s, 3);
	leave(s);
	before = refused(s);
	rcu_read_lock();
	ecdev_receive(bus_dev(s->b), old + 6, old + EC_ETH_HDR, s->len);
	rcu_read_unlock();
	expect(s, 0, 0);
	KUNIT_EXPECT_EQ(test, refused(s), before + 1);
	answer(s);
	give(s, s->reply, s->len);
	expect(s, 15, 0);
	expect_data(s, 15);
	put(s, 15);
}

/* What is gathered from the queue: in order, as much as fits, nobody who has given up. */
static void pack_gathered(struct kunit *test)
{
	struct shared *s = shared(test);
	struct ec_pack_room room = roomy;
	struct ec_pack p;
	struct ec_queued e;
	u32 k;

	for (k = 0; k < MEMBERS; k++) {
		KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[k], ktime_get_ns()));
		arm(s, k);
		KUNIT_ASSERT_EQ(test, ec_queue_push(bus_queues(s->b), s->slot[k], k == 3), 0);
	}
	/* the urgent one is the first */
	KUNIT_ASSERT_TRUE(test, ec_queue_peek(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e));
	KUNIT_EXPECT_PTR_EQ(test, e.slot, s->slot[3]);
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_ASSERT_EQ(test, p.n, 4u);
	KUNIT_EXPECT_EQ(test, p.dgrams, 5u);
	KUNIT_EXPECT_PTR_EQ(test, p.e[1].slot, s->slot[0]);
	KUNIT_EXPECT_PTR_EQ(test, p.e[3].slot, s->slot[2]);
	/* who wants to give up now has to wait for a moment */
	KUNIT_EXPECT_FALSE(test, ec_slot_cancel(s->slot[0], ktime_get_ns()));
	ec_pack_release(&p, EC_SLOT_QUEUED);
	/* the second of them does not fit, and so nor do those behind it */
	room.len = EC_FRAME_HDR + 13 + 14 + 139;
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_EXPECT_EQ(test, p.n, 2u);
	ec_pack_release(&p, EC_SLOT_QUEUED);
	room.len++;
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_EXPECT_EQ(test, p.n, 3u);
	ec_pack_release(&p, EC_SLOT_QUEUED);
	/* datagrams are counted, too */
	room = roomy;
	room.dgrams = 4;
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_EXPECT_EQ(test, p.n, 3u);
	ec_pack_release(&p, EC_SLOT_QUEUED);
	/* one gives up, one that leaves, the first one that gives up */
	room = roomy;
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[0], ktime_get_ns()));
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_ASSERT_EQ(test, p.n, 3u);
	KUNIT_EXPECT_PTR_EQ(test, p.e[1].slot, s->slot[1]);
	ec_pack_release(&p, EC_SLOT_QUEUED);
	p.n = 2;
	ec_pack_move(&p, EC_SLOT_QUEUED, EC_SLOT_SENT);
	KUNIT_EXPECT_EQ(test, atomic_read(&s->slot[3]->state), EC_SLOT_SENT);
	KUNIT_EXPECT_EQ(test, atomic_read(&s->slot[2]->state), EC_SLOT_QUEUED);
	KUNIT_ASSERT_TRUE(test, ec_queue_peek(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e));
	KUNIT_EXPECT_PTR_EQ(test, e.slot, s->slot[2]);
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(s->slot[2], ktime_get_ns()));
	ec_queue_gather(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e, &room, &p);
	KUNIT_EXPECT_EQ(test, p.n, 0u);
	KUNIT_EXPECT_FALSE(test, ec_queue_peek(bus_queues(s->b), &bus_queues(s->b)->acyclic, &e));
	KUNIT_EXPECT_EQ(test, bus_queued(s->b), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(pack_dealt_out),
	KUNIT_CASE(pack_changed),
	KUNIT_CASE(pack_truncated),
	KUNIT_CASE(pack_other_order),
	KUNIT_CASE(pack_given_up),
	KUNIT_CASE(pack_gone_changed),
	KUNIT_CASE(pack_on_two_links_done_with_both_copies),
	KUNIT_CASE(pack_on_two_links_main_copy_first),
	KUNIT_CASE(pack_reused),
	KUNIT_CASE(pack_gathered),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_pack",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
