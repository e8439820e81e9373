// SPDX-License-Identifier: GPL-2.0-only
/*
 * Posts: one end each, whatever becomes of their frame. Nothing that is not as it was sent is
 * taken, and nobody gets what is another's.
 */
#include <linux/kthread.h>
#include "master/carry/direct.h"
#include "posts.h"

#define ALL	(BIT(POSTS) - 1)

static u64 refused(const struct rig *r)
{
	return bus_late(r->b) + bus_unmatched(r->b);
}

/* what rig_answer() has written */
static void expect_data(struct rig *r, u32 mask, u8 side)
{
	static const u8 first[POSTS] = { 0, 1, 3, 4 };
	u32 i, k;

	for (i = 0; i < POSTS; i++)
		for (k = 0; mask & BIT(i) && k < r->post[i].n; k++) {
			u8 v = 0x10 * (side + 1) + first[i] + k;

			KUNIT_EXPECT_EQ_MSG(r->b->test, r->data[i][k][0], v, "post %u.%u", i, k);
			KUNIT_EXPECT_EQ(r->b->test, r->data[i][k][r->dg[i][k].len - 1], v);
			KUNIT_EXPECT_EQ(r->b->test, r->data[i][k][r->dg[i][k].len], 0);
		}
}

/* in one frame */
static struct rig *sent(struct kunit *test)
{
	struct rig *r = rig_new(test);

	rig_send(r, ALL);
	KUNIT_ASSERT_EQ(test, r->frames[0], 1u);
	return r;
}

static void give(struct rig *r)
{
	rig_give(r, 0, r->frame[0] + EC_ETH_HDR, r->len[0]);
}

static void post_shares_frame(struct kunit *test)
{
	struct rig *r = sent(test);
	u64 before = refused(r);

	rig_answer(r, 0);
	rig_expect(r, ALL, 0, -EINPROGRESS);
	give(r);
	rig_expect(r, ALL, 1, 0);
	expect_data(r, ALL, 0);
	KUNIT_EXPECT_EQ(test, refused(r), before);
	/* a second copy */
	give(r);
	rig_expect(r, ALL, 1, 0);
	KUNIT_EXPECT_EQ(test, refused(r), before + 1);
	KUNIT_EXPECT_EQ(test, bus_acyclic_ns(r->b), 0);
}

/* Bits a header reserves, or a slave may set, are no reason to refuse a frame. */
static bool is_free_bit(size_t in_header, u32 bit)
{
	return in_header == 7 && bit >= 3 && bit <= 6;
}

/* Not one changed bit of a header is taken, whosever it is: no post has anything then. */
static void post_changed_frame_refused(struct kunit *test)
{
	struct rig *r = sent(test);
	u8 *copy = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL), *body = r->frame[0] + EC_ETH_HDR;
	u64 before = refused(r);
	struct ec_frame_iter it, at;
	struct ec_dgram d;
	u32 n = 0, bit;
	size_t i;

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, body, r->len[0]), 0);
	for (at = it; ec_frame_iter_next(&it, &d) == 1; at = it)
		for (i = 0; i < 8; i++)
			for (bit = 0; bit < 8; bit++) {
				if (is_free_bit(i, bit))
					continue;
				memcpy(copy, body, r->len[0]);
				copy[at.p - body + i] ^= BIT(bit);
				rig_give(r, 0, copy, r->len[0]);
				n++;
			}
	KUNIT_EXPECT_GT(test, n, 250u);
	KUNIT_EXPECT_EQ(test, refused(r) - before, (u64)n);
	rig_expect(r, ALL, 0, -EINPROGRESS);
	rig_answer(r, 0);
	give(r);
	rig_expect(r, ALL, 1, 0);
}

static void post_truncated_frame_refused(struct kunit *test)
{
	struct rig *r = sent(test);
	u64 before = refused(r);
	size_t len;

	for (len = 0; len < r->len[0]; len++) {
		/* a copy, so that the tool sees a read behind it */
		u8 *cut = kmemdup(r->frame[0] + EC_ETH_HDR, len, GFP_KERNEL);

		rig_give(r, 0, cut, len);
		kfree(cut);
	}
	KUNIT_EXPECT_EQ(test, refused(r) - before, (u64)r->len[0]);
	rig_expect(r, ALL, 0, -EINPROGRESS);
	give(r);
	rig_expect(r, ALL, 1, 0);
}

/* Datagrams in another order, twice, one too many. */
static void post_other_order_refused(struct kunit *test)
{
	static const u8 order[][6] = {
		{ 1, 0, 2, 3, 4 }, { 0, 1, 3, 2, 4 }, { 0, 1, 2, 3, 0 }, { 4, 1, 2, 3, 0 },
		{ 0, 1, 2, 3, 3 }, { 0, 1, 2, 3, 4, 4 },
	};
	struct rig *r = sent(test);
	u8 *copy = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL);
	struct ec_dgram d[5];
	struct ec_frame_iter it;
	struct ec_frame_buf fb;
	u64 before = refused(r);
	u32 i, k;

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, r->frame[0] + EC_ETH_HDR, r->len[0]), 0);
	for (k = 0; k < 5; k++)
		KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d[k]), 1);
	for (i = 0; i < ARRAY_SIZE(order); i++) {
		ec_frame_begin(&fb, copy, EC_ETH_MAX);
		for (k = 0; k < 5 + (i == ARRAY_SIZE(order) - 1); k++) {
			const struct ec_dgram *o = &d[order[i][k]];

			ec_frame_add(&fb, o->cmd, o->idx, o->adp, o->ado, o->len);
		}
		rig_give(r, 0, copy, ec_frame_end(&fb));
	}
	KUNIT_EXPECT_EQ(test, refused(r) - before, (u64)ARRAY_SIZE(order));
	rig_expect(r, ALL, 0, -EINPROGRESS);
	give(r);
	rig_expect(r, ALL, 1, 0);
}

/* Any of them may be cancelled: the others have theirs, nobody has what is not his. */
static void post_cancelled_in_frame(struct kunit *test)
{
	struct rig *r = rig_new(test);
	u32 gone, i;

	for (gone = 1; gone < ALL; gone++) {
		memset(r->ends, 0, sizeof(r->ends));
		memset(r->data, 0, sizeof(r->data));
		r->frames[0] = 0;
		rig_send(r, ALL);
		KUNIT_ASSERT_EQ(test, r->frames[0], 1u);
		for (i = 0; i < POSTS; i++)
			if (gone & BIT(i)) {
				ec_post_cancel(&r->post[i]);
				/* it is ours again, at once */
				memset(r->data[i], 0x77, sizeof(r->data[i]));
			}
		rig_answer(r, 0);
		give(r);
		rig_expect(r, ALL & ~gone, 1, 0);
		expect_data(r, ALL & ~gone, 0);
		for (i = 0; i < POSTS; i++) {
			if (!(gone & BIT(i)))
				continue;
			KUNIT_EXPECT_EQ_MSG(test, r->ends[i], 0u, "post %u of %x", i, gone);
			KUNIT_EXPECT_EQ(test, r->data[i][0][0], 0x77);
		}
	}
	KUNIT_EXPECT_EQ(test, bus_acyclic(r->b), 0u);
}

/* Whoever frees the memory after the cancel: the tool sees each access to it. */
static void post_freed_after_cancel(struct kunit *test)
{
	struct rig *r = rig_new(test);
	struct ec_post *post;
	struct ec_dg *dg;
	u32 state;

	for (state = 0; state < 3; state++) {
		post = kzalloc(sizeof(*post), GFP_KERNEL);
		dg = kzalloc(sizeof(*dg), GFP_KERNEL);
		*dg = EC_DG(EC_CMD_FPRW, POSTS_ADP, 0x1000, 2, r->data[0][0]);
		ec_post_init(post, bus_links(r->b), r->post[0].done);
		post->dg = dg;
		post->n = 1;
		/* not sent; waits for its time; on its way */
		if (state)
			ec_post_send(post, state == 1 ? U64_MAX : 0);
		if (state == 2)
			ec_direct_push(bus_carry(r->b));
		KUNIT_EXPECT_EQ(test, post->state, state);
		ec_post_cancel(post);
		kfree(post);
		kfree(dg);
		msleep(50);
	}
	/* the reply comes, and the frame is lost */
	KUNIT_EXPECT_EQ(test, r->frames[0], 1u);
	give(r);
	msleep(200);
	KUNIT_EXPECT_EQ(test, r->frames[0], 1u);
	KUNIT_EXPECT_EQ(test, bus_posts(r->b), 0u);
}

/* cancels a post while its end is told */
struct cancelling {
	struct rig *r;
	struct completion began, over;
};

static struct cancelling cancelling;

static int cancel(void *arg)
{
	struct cancelling *c = arg;

	complete(&c->began);
	ec_post_cancel(&c->r->post[0]);
	complete(&c->over);
	return 0;
}

static void slow_end(struct ec_post *post)
{
	cancelling.r->ends[0]++;
	KUNIT_ASSERT_FALSE(cancelling.r->b->test,
			   IS_ERR(kthread_run(cancel, &cancelling, "cancel")));
	wait_for_completion(&cancelling.began);
	usleep_range(3000, 3001);
	KUNIT_EXPECT_FALSE(cancelling.r->b->test, completion_done(&cancelling.over));
}

static void post_cancel_waits_for_end(struct kunit *test)
{
	struct rig *r = rig_new(test);

	cancelling.r = r;
	init_completion(&cancelling.began);
	init_completion(&cancelling.over);
	r->post[0].done = slow_end;
	rig_send(r, BIT(0));
	/* not in rig_give(): the end sleeps here, as a long one would run */
	ec_slot_hold(bus_slot(r->b, r->post[0].slot), EC_SLOT_SENT,
		     bus_slot(r->b, r->post[0].slot)->seq);
	ec_slot_take(bus_slot(r->b, r->post[0].slot), 0,
		     r->frame[0] + EC_ETH_HDR, false, false);
	ec_flight_landed(bus_slot(r->b, r->post[0].slot));
	wait_for_completion(&cancelling.over);
	rig_expect(r, BIT(0), 1, 0);
}

/* What may be repeated is, alone and three times; the rest ends at once. */
static void post_lost(struct kunit *test)
{
	struct rig *r = rig_new(test);
	u64 lost = bus_lost(r->b);

	r->dg[1][0].repeat = true;
	rig_send(r, ALL);
	usleep_range(30000, 30001);
	rig_expect(r, ALL & ~BIT(1), 1, -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, r->ends[1], 0u);
	KUNIT_EXPECT_EQ(test, r->dg[1][0].err, -EINPROGRESS);
	KUNIT_EXPECT_EQ(test, r->dg[1][1].err, -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, r->frames[0], 2u);
	/* its other datagram is not in it */
	KUNIT_EXPECT_EQ(test, r->len[0], (size_t)EC_FRAME_HDR + EC_DGRAM_OVERHEAD + 3);
	msleep(200);
	KUNIT_EXPECT_EQ(test, r->frames[0], 4u);
	rig_expect(r, ALL, 1, -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, bus_lost(r->b) - lost, 4ull);
	/* the last one after all */
	give(r);
	rig_expect(r, ALL, 1, -ETIMEDOUT);
}

static void post_end_sends_it_again(struct kunit *test)
{
	struct rig *r = rig_new(test);
	u32 i;

	r->again = ALL;
	rig_send(r, ALL);
	give(r);
	/* the thread sends what the end has sent */
	for (i = 0; i < 100 && r->frames[0] < 2; i++)
		usleep_range(100, 101);
	KUNIT_ASSERT_EQ(test, r->frames[0], 2u);
	rig_expect(r, ALL, 1, -EINPROGRESS);
	rig_answer(r, 0);
	give(r);
	rig_expect(r, ALL, 2, 0);
	expect_data(r, ALL, 0);
}

/* Its end runs in the interrupt that has received the frame. */
static void post_ends_in_interrupt(struct kunit *test)
{
	struct rig *r = sent(test);
	unsigned long flags;

	local_irq_save(flags);
	give(r);
	local_irq_restore(flags);
	rig_expect(r, ALL, 1, 0);
}

/* Without device: also those whose frame is on its way, or is not due. */
static void post_device_gone(struct kunit *test)
{
	struct rig *r = sent(test);
	struct bus *b = r->b;

	bus_dev(b)->ops = r->real;
	bus_no_device(b);
	msleep(50);
	rig_expect(r, ALL, 1, -ENODEV);
	rig_send(r, ALL);
	msleep(50);
	rig_expect(r, ALL, 2, -ENODEV);
	KUNIT_EXPECT_EQ(test, bus_posts(b), 0u);
}

/* On two links: ends with both copies, whichever is the first, and each can be read. */
static void post_on_two_links(struct kunit *test)
{
	struct rig *r = rig_new(test);
	u32 first;

	rig_two_links(r);
	for (first = 0; first < EC_MAX_LINKS; first++) {
		memset(r->ends, 0, sizeof(r->ends));
		memset(r->data, 0, sizeof(r->data));
		rig_send(r, ALL);
		KUNIT_ASSERT_EQ(test, r->frames[0], first + 1);
		KUNIT_ASSERT_EQ(test, r->frames[1], first + 1);
		rig_answer(r, first);
		rig_give(r, first, r->frame[first] + EC_ETH_HDR, r->len[first]);
		rig_expect(r, ALL, 0, -EINPROGRESS);
		/* no slave has been reached from the other end */
		rig_give(r, !first, r->frame[!first] + EC_ETH_HDR, r->len[!first]);
		rig_expect(r, ALL, 1, 0);
		expect_data(r, ALL, first);
		KUNIT_EXPECT_EQ(test, r->dg[1][1].wkc, 1);
		KUNIT_EXPECT_EQ(test, r->dg[1][1].side_wkc[first], 1);
		KUNIT_EXPECT_EQ(test, r->dg[1][1].side_wkc[!first], 0);
	}
	KUNIT_EXPECT_EQ(test, atomic_read(&bus_link(r->b, EC_BACKUP)->acyclic), 0);
}

/* One copy does not come: the other one is the result, and the lost one its link's. */
static void post_one_copy_of_two(struct kunit *test)
{
	struct rig *r = rig_new(test);
	u32 came;

	rig_two_links(r);
	for (came = 0; came < EC_MAX_LINKS; came++) {
		struct ec_link_stats *missing = &bus_link(r->b, !came)->stats;

		memset(r->ends, 0, sizeof(r->ends));
		memset(r->data, 0, sizeof(r->data));
		rig_send(r, ALL);
		rig_answer(r, came);
		rig_give(r, came, r->frame[came] + EC_ETH_HDR, r->len[came]);
		msleep(60);
		rig_expect(r, ALL, 1, 0);
		expect_data(r, ALL, came);
		KUNIT_EXPECT_EQ(test, r->dg[1][1].side_wkc[came], 1);
		KUNIT_EXPECT_EQ(test, r->dg[1][1].side_wkc[!came], EC_DG_NO_COPY);
		KUNIT_EXPECT_EQ(test, (u64)atomic64_read(&missing->lost), 1ull);
		/* late */
		rig_give(r, !came, r->frame[!came] + EC_ETH_HDR, r->len[!came]);
		rig_expect(r, ALL, 1, 0);
	}
}

/* Slaves of one side only may have got what was written to all. */
static void post_for_all_on_one_of_two(struct kunit *test)
{
	struct rig *r = rig_new(test);

	rig_two_links(r);
	r->dg[0][0].cmd = EC_CMD_BWR;
	rig_send(r, BIT(0));
	rig_answer(r, 0);
	rig_give(r, 0, r->frame[0] + EC_ETH_HDR, r->len[0]);
	msleep(60);
	rig_expect(r, BIT(0), 1, -ETIMEDOUT);
}

/* A link that is down does not stop the other one. */
static void post_beside_link_that_is_down(struct kunit *test)
{
	struct rig *r = rig_new(test);

	rig_two_links(r);
	r->down = true;
	rig_send(r, ALL);
	KUNIT_EXPECT_EQ(test, r->frames[0], 1u);
	KUNIT_EXPECT_EQ(test, r->frames[1], 0u);
	rig_answer(r, 0);
	give(r);
	rig_expect(r, ALL, 1, 0);
	/* one that is for it alone */
	r->post[0].sides = BIT(EC_BACKUP);
	rig_send(r, BIT(0));
	msleep(50);
	rig_expect(r, BIT(0), 2, -ENETDOWN);
	/* and one for it alone that arrives */
	r->down = false;
	rig_send(r, BIT(0));
	KUNIT_EXPECT_EQ(test, r->frames[0], 1u);
	KUNIT_ASSERT_EQ(test, r->frames[1], 1u);
	rig_give(r, 1, r->frame[1] + EC_ETH_HDR, r->len[1]);
	rig_expect(r, BIT(0), 3, 0);
}

/* Datagrams that keep their data may have the same: none writes to what another one sends. */
static void post_keeps_data(struct kunit *test)
{
	struct rig *r = rig_new(test);
	const u8 sent[] = { 0xaa, 0xbb };

	memcpy(r->data[0][0], sent, sizeof(sent));
	r->dg[0][0].keep = true;
	rig_send(r, BIT(0));
	rig_answer(r, 0);
	give(r);
	rig_expect(r, BIT(0), 1, 0);
	KUNIT_EXPECT_EQ(test, r->dg[0][0].wkc, 1);
	KUNIT_EXPECT_MEMEQ(test, r->data[0][0], sent, sizeof(sent));
}

/* A caller that sleeps and comes after the end of the posts gets -ENODEV: no thread is left. */
static void post_after_end(struct kunit *test)
{
	struct rig *r = rig_new(test);
	struct ec_post_wait wait = { .pending = 1 };
	struct ec_dg dg[6];
	u32 i;

	for (i = 0; i < ARRAY_SIZE(dg); i++)
		dg[i] = EC_DG(EC_CMD_FPRW, POSTS_ADP, 0x1000, 2, r->data[0][0]);
	init_completion(&wait.done);
	r->post[0].wait = &wait;
	r->post[0].done = NULL;
	bus_post_close(r->b, true);
	ec_post_send(&r->post[0], 0);
	KUNIT_EXPECT_EQ(test, r->dg[0][0].err, -ENODEV);
	KUNIT_EXPECT_EQ(test, wait.pending, 0u);
	/* it would sleep for ever */
	if (completion_done(&wait.done)) {
		KUNIT_EXPECT_EQ(test, bus_xfer(r->b, dg, 1), -ENODEV);
		/* those that have memory of their own, in two halves */
		KUNIT_EXPECT_EQ(test, bus_xfer(r->b, dg, ARRAY_SIZE(dg)), -ENODEV);
		for (i = 0; i < ARRAY_SIZE(dg); i++)
			KUNIT_EXPECT_EQ(test, dg[i].err, -ENODEV);
	} else {
		KUNIT_FAIL(test, "the caller sleeps for ever");
	}
	bus_post_close(r->b, false);
	KUNIT_EXPECT_EQ(test, r->frames[0], 0u);
	KUNIT_EXPECT_EQ(test, bus_posts(r->b), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(post_shares_frame),
	KUNIT_CASE(post_changed_frame_refused),
	KUNIT_CASE(post_truncated_frame_refused),
	KUNIT_CASE(post_other_order_refused),
	KUNIT_CASE(post_cancelled_in_frame),
	KUNIT_CASE(post_freed_after_cancel),
	KUNIT_CASE(post_cancel_waits_for_end),
	KUNIT_CASE(post_lost),
	KUNIT_CASE(post_end_sends_it_again),
	KUNIT_CASE(post_ends_in_interrupt),
	KUNIT_CASE(post_device_gone),
	KUNIT_CASE(post_on_two_links),
	KUNIT_CASE(post_one_copy_of_two),
	KUNIT_CASE(post_for_all_on_one_of_two),
	KUNIT_CASE(post_beside_link_that_is_down),
	KUNIT_CASE(post_keeps_data),
	KUNIT_CASE(post_after_end),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_post",
	.exit = rig_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
