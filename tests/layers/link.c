// SPDX-License-Identifier: GPL-2.0-only
/* The layer "link" with a device that behaves as a test says; there is no slave. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "alone.h"
#include "devices/ecdev.h"
#include "master/base/limits.h"
#include "master/base/once64.h"
#include "master/link/device.h"
#include "master/link/links.h"
#include "master/link/xfer.h"

static const u8 mac[ETH_ALEN] = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x01 };

enum behaviour {
	ANSWERS,	/* at once, as one slave would */
	HOLDS,		/* keeps the last frame for deliver() */
};

struct test_device {
	enum behaviour does;
	bool up;
	bool seen;		/* the last look has found it up */
	bool started;
	unsigned int sent;
	size_t len;
	u8 tx[EC_ETH_MAX];
	u8 held[EC_ETH_MAX];
	struct ecdev *dev;
	const struct ec_links *links;
	bool cyclic;
	int mode;		/* of the access when the device heard of it */
};

/* the held frame comes back */
static void deliver(struct test_device *d)
{
	u8 *body = d->held + EC_ETH_HDR;
	struct ec_frame_iter it;
	struct ec_dgram dg;

	ec_frame_iter_init(&it, body, d->len - EC_ETH_HDR);
	while (ec_frame_iter_next(&it, &dg) == 1) {
		memset(dg.data, 0xa5, dg.len);
		ec_dgram_set_wkc(&dg, ec_dgram_wkc(&dg) + 1);
	}
	rcu_read_lock();
	ecdev_receive(d->dev, d->held + ETH_ALEN, body, d->len - EC_ETH_HDR);
	rcu_read_unlock();
}

static int start(void *priv, struct ecdev *dev)
{
	struct test_device *d = priv;

	d->dev = dev;
	d->started = true;
	return 0;
}

static void stop(void *priv)
{
	struct test_device *d = priv;

	d->started = false;
}

static u8 *tx_get(void *priv)
{
	struct test_device *d = priv;

	return d->tx;
}

static int tx_send(void *priv, u8 *buf, size_t len)
{
	struct test_device *d = priv;

	memcpy(d->held, buf, len);
	d->len = len;
	d->sent++;
	if (d->does == ANSWERS)
		deliver(d);
	return 0;
}

static bool link_up(void *priv)
{
	const struct test_device *d = priv;

	return READ_ONCE(d->up);
}

static void cycle(void *priv, bool on)
{
	struct test_device *d = priv;

	d->cyclic = on;
	d->mode = READ_ONCE(d->links->access.mode);
}

static void look(void *priv)
{
	struct test_device *d = priv;

	WRITE_ONCE(d->seen, READ_ONCE(d->up));
}

static bool link_seen(void *priv)
{
	const struct test_device *d = priv;

	return READ_ONCE(d->seen);
}

static const struct ecdev_ops device_ops = {
	.kind = "test", .atomic = true, .start = start, .stop = stop, .tx_get = tx_get,
	.tx_send = tx_send, .cycle = cycle, .link_up = link_up,
};

/* as a network card without interrupts */
static const struct ecdev_ops looking_ops = {
	.kind = "test", .atomic = true, .start = start, .stop = stop, .tx_get = tx_get,
	.tx_send = tx_send, .cycle = cycle, .link_up = link_seen, .look = look,
};

/* links of a master that has nothing else */
struct bench {
	struct ec_base base;
	struct ec_links links;
	struct test_device d;
	struct ecdev *dev;
};

static void bench_free(struct bench *b)
{
	if (b->dev)
		ecdev_withdraw(b->dev);
	ec_links_exit(&b->links);
	kvfree(b);
}

static struct bench *bench_new(enum behaviour does)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	ec_base_init(&b->base, 0, 0);
	b->d.does = does;
	b->d.up = true;
	b->d.links = &b->links;
	if (!CHECK_EQ(ec_links_init(&b->links, &b->base, NULL, "test0", NULL), 0)) {
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

static bool queued(void *links)
{
	return ec_queue_frames(&((struct ec_links *)links)->queues) == 1;
}

/* with ops NULL: the queue reports to no application */
static void cycle_sends_what_others_queue(void)
{
	struct bench *b = bench_new(ANSWERS);
	struct caller c;

	if (!b)
		return;
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_CYCLIC), true);
	if (caller_begins(&c, b)) {
		CHECK(alone_wait(queued, &b->links, 10));
		CHECK_EQ(b->d.sent, 0);
		ec_links_enter(&b->links);
		ec_write64(&b->links.access.last_send_ns, ktime_get_ns());
		ec_share_begin(&b->links.share, ec_access_interval_us(&b->links.access));
		rcu_read_lock();
		ec_share_send_left(&b->links, 0);
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

/* The owner of the cycle is the only one that polls: the device hears of it before it may. */
static void device_hears_of_cycle_first(void)
{
	struct bench *b = bench_new(ANSWERS);

	if (!b)
		return;
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_CYCLIC), true);
	CHECK_EQ(b->d.cyclic, true);
	CHECK_EQ(b->d.mode, EC_ACCESS_DIRECT);
	/* one that comes while there is a cycle */
	ecdev_withdraw(b->dev);
	CHECK_EQ(b->d.cyclic, false);
	ec_access_change(&b->links, EC_ACCESS_CYCLIC);
	b->dev = ecdev_offer("test0", mac, &device_ops, &b->d);
	if (CHECK(!IS_ERR(b->dev)))
		CHECK_EQ(b->d.cyclic, true);
	else
		b->dev = NULL;
	CHECK_EQ(ec_access_change(&b->links, EC_ACCESS_DIRECT), true);
	CHECK_EQ(b->d.cyclic, false);
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
	TEST(device_hears_of_cycle_first),
	TEST(withdrawn_device_ends_calls),
	TEST(link_down_ends_calls_at_once),
	TEST(late_frame_makes_device_look),
	{ }
};
