// SPDX-License-Identifier: GPL-2.0-only
/* The layer "carry" with a device that behaves as a test says; there is no slave. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include "alone.h"
#include "card.h"
#include "master/carry/carry.h"
#include "master/carry/posts.h"
#include "master/carry/xfer.h"

/* links of a master that has nothing else */
struct bench {
	struct ec_base base;
	struct ec_links links;
	struct ec_carry carry;
	struct test_device d;
	struct ecdev *dev;
};

static void bench_free(struct bench *b)
{
	if (b->dev)
		ecdev_withdraw(b->dev);
	ec_carry_exit(&b->carry);
	ec_links_exit(&b->links);
	kvfree(b);
}

static const struct ec_links_ops links_ops = {
	.changed = ec_carry_changed,
};

static struct bench *bench_new(enum behaviour does)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	ec_base_init(&b->base, 0, 0);
	b->d.does = does;
	b->d.up = true;
	b->d.links = &b->links;
	if (!CHECK_EQ(ec_links_init(&b->links, &b->base, &links_ops, "test0", NULL), 0) ||
	    !CHECK_EQ(ec_carry_init(&b->carry, &b->links, NULL), 0)) {
		kvfree(b);
		return NULL;
	}
	ec_device_register(&b->links);
	b->dev = ecdev_offer("test0", mac, &device_ops, &b->d);
	if (CHECK(!IS_ERR(b->dev)) && CHECK_EQ(ec_links_any_device(&b->links), true) &&
	    CHECK_EQ(ec_links_look(&b->links), true))
		return b;
	b->dev = NULL;
	bench_free(b);
	return NULL;
}

static void replies_reach_their_callers(void)
{
	struct bench *b = bench_new(ANSWERS);
	u8 x[2][4] = { 0 };
	struct ec_dg dg[] = {
		EC_DG(EC_CMD_FPRD, 1001, 0x130, 4, x[0]),
		EC_DG(EC_CMD_BRD, 0, 0x110, 2, x[1]),
	};

	if (!b)
		return;
	CHECK_EQ(ec_xfer(&b->links, dg, ARRAY_SIZE(dg)), 0);
	CHECK_EQ(dg[0].wkc, 1);
	CHECK_EQ(dg[1].wkc, 1);
	CHECK_EQ(x[0][3], 0xa5);
	CHECK_EQ(x[1][1], 0xa5);
	CHECK_EQ(x[1][2], 0);
	CHECK_EQ(b->d.sent, 1);
	CHECK_EQ(ec_links_sent(&b->links), 1);
	bench_free(b);
}

/* a read is repeated, a write that is no repeatable one is not */
static void lost_frames_time_out(void)
{
	struct bench *b = bench_new(HOLDS);
	u8 x[4] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_FPRD, 1001, 0x130, 4, x);
	u64 t0 = ktime_get_ns();

	if (!b)
		return;
	CHECK_EQ(ec_xfer(&b->links, &dg, 1), -ETIMEDOUT);
	CHECK_OP(ktime_get_ns() - t0, >=, 4 * 20 * NSEC_PER_MSEC);
	CHECK_EQ(b->d.sent, 4);
	dg.repeat = false;
	CHECK_EQ(ec_xfer(&b->links, &dg, 1), -ETIMEDOUT);
	CHECK_EQ(b->d.sent, 5);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.lost), 5);
	bench_free(b);
}

static void late_and_unknown_frames_are_only_counted(void)
{
	struct bench *b = bench_new(HOLDS);
	u8 x[4] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_FPRD, 1001, 0x130, 4, x);

	if (!b)
		return;
	dg.repeat = false;
	CHECK_EQ(ec_xfer(&b->links, &dg, 1), -ETIMEDOUT);
	deliver(&b->d);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.late), 1);
	/* number of a frame that was never sent */
	b->d.held[ETH_ALEN + 5] ^= 0x55;
	deliver(&b->d);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.late), 1);
	CHECK_EQ(atomic64_read(&b->links.link[0].stats.unmatched), 1);
	CHECK_EQ(x[0], 0);
	b->d.does = ANSWERS;
	CHECK_EQ(ec_xfer(&b->links, &dg, 1), 0);
	CHECK_EQ(x[0], 0xa5);
	bench_free(b);
}

struct caller {
	struct ec_links *links;
	struct completion done;
	int ret;
};

static int call(void *arg)
{
	struct caller *c = arg;
	u8 x[4];

	c->ret = ec_xfer_one(c->links, EC_CMD_FPRD, 1001, 0x130, x, 4);
	complete(&c->done);
	return 0;
}

static bool caller_begins(struct caller *c, struct bench *b)
{
	c->links = &b->links;
	init_completion(&c->done);
	return CHECK(!IS_ERR(kthread_run(call, c, "ec_alone")));
}

static bool queued(void *carry)
{
	return ec_carry_has_left(carry);
}

/* with ops NULL: no application hears of it */
static void cycle_sends_what_others_queue(void)
{
	struct bench *b = bench_new(ANSWERS);
	struct caller c;

	if (!b)
		return;
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_CYCLIC), true);
	if (caller_begins(&c, b)) {
		CHECK(alone_wait(queued, &b->carry, 10));
		CHECK_EQ(b->d.sent, 0);
		CHECK_EQ(ec_links_enter(&b->links), 0);
		ec_write64(&b->links.access.last_send_ns, ktime_get_ns());
		ec_share_begin(&b->carry.share, ec_access_interval_us(&b->links.access));
		rcu_read_lock();
		ec_share_send_left(&b->carry, 0);
		ec_links_flush(&b->links);
		rcu_read_unlock();
		ec_links_leave(&b->links);
		wait_for_completion(&c.done);
		CHECK_EQ(c.ret, 1);
		CHECK_EQ(b->d.sent, 1);
	}
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_DIRECT), true);
	bench_free(b);
}

/* with ops NULL: no one hears of it but the caller */
static void withdrawn_device_ends_calls(void)
{
	struct bench *b = bench_new(HOLDS);
	struct caller c;
	u8 x[4];

	if (!b)
		return;
	if (caller_begins(&c, b)) {
		usleep_range(2000, 3000);
		ecdev_withdraw(b->dev);
		b->dev = NULL;
		wait_for_completion(&c.done);
		CHECK_OP(c.ret, <, 0);
		CHECK_EQ(b->d.started, false);
		CHECK_EQ(ec_links_any_device(&b->links), false);
		CHECK_EQ(ec_xfer_one(&b->links, EC_CMD_BRD, 0, 0, x, 1), -ENODEV);
	}
	bench_free(b);
}

static void link_down_ends_calls_at_once(void)
{
	struct bench *b = bench_new(HOLDS);
	struct caller c;
	u64 t0;

	if (!b)
		return;
	if (caller_begins(&c, b)) {
		usleep_range(2000, 3000);
		t0 = ktime_get_ns();
		WRITE_ONCE(b->d.up, false);
		wait_for_completion(&c.done);
		CHECK_EQ(c.ret, -ENETDOWN);
		CHECK_OP(ktime_get_ns() - t0, <, 10 * NSEC_PER_MSEC);
		CHECK_EQ(ec_links_look(&b->links), false);
	}
	bench_free(b);
}

/* the monitor, which looks, waits for the frame itself */
static void late_frame_makes_device_look(void)
{
	struct bench *b = bench_new(HOLDS);
	u8 x[4];

	if (!b)
		return;
	ecdev_withdraw(b->dev);
	b->dev = ecdev_offer("test0", mac, &looking_ops, &b->d);
	if (CHECK(!IS_ERR(b->dev)) && CHECK_EQ(ec_links_look(&b->links), true)) {
		WRITE_ONCE(b->d.up, false);
		CHECK_EQ(ec_xfer_one(&b->links, EC_CMD_BRD, 0, 0, x, 1), -ENETDOWN);
		CHECK_EQ(b->d.seen, false);
	} else if (IS_ERR(b->dev)) {
		b->dev = NULL;
	}
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(replies_reach_their_callers),
	TEST(lost_frames_time_out),
	TEST(late_and_unknown_frames_are_only_counted),
	TEST(cycle_sends_what_others_queue),
	TEST(withdrawn_device_ends_calls),
	TEST(link_down_ends_calls_at_once),
	TEST(late_frame_makes_device_look),
	{ }
};
