// SPDX-License-Identifier: GPL-2.0-only
/* Callers beside a cycle whose datagrams leave in one frame. */
#include <linux/kthread.h>
#include "cyc.h"
#include "master/link/device.h"
#include "master/carry/flight.h"

static const char text[] =
	"segment seed=25 response=100us transition=1ms\n"
	"slave a EK1100\nslave x EL1859\nslave d drive\n";

#define N	3
#define CALLERS	8

/* somebody who reads a register */
struct caller {
	struct bus *b;
	u32 slave;
	bool repeat;
	u8 v[8];
	int ret;
	u64 ns;
	struct completion done;
};

static struct caller callers[CALLERS];

static int call(void *arg)
{
	struct caller *r = arg;
	u64 t0 = ktime_get_ns();
	struct ec_dg dg = EC_DG(EC_CMD_FPRD, bus_slave(r->b, r->slave)->station, 0, sizeof(r->v),
				r->v);

	dg.repeat = r->repeat;
	r->ret = bus_xfer(r->b, &dg, 1);
	if (!r->ret && dg.wkc != 1)
		r->ret = -EIO;
	r->ns = ktime_get_ns() - t0;
	complete(&r->done);
	return 0;
}

/* All wait in the queue of the cycle when this returns. */
static void begin(struct cyc *c, bool repeat)
{
	u32 i;

	for (i = 0; i < CALLERS; i++) {
		callers[i] = (struct caller){ .b = c->b, .slave = i % N, .repeat = repeat };
		init_completion(&callers[i].done);
		kthread_run(call, &callers[i], "caller%u", i);
	}
	for (i = 0; i < 100 && bus_queued(c->b) < CALLERS; i++)
		usleep_range(1, 2);
	KUNIT_ASSERT_GE(c->b->test, bus_queued(c->b), (unsigned int)CALLERS);
}

/* cycles until all have ended */
static u32 end(struct cyc *c)
{
	u32 n, left = CALLERS;

	for (n = 0; left && n < 2000; n++) {
		cyc_run(c, 1);
		while (left && try_wait_for_completion(&callers[left - 1].done))
			left--;
	}
	KUNIT_ASSERT_EQ(c->b->test, left, 0u);
	return n;
}

static void expect_registers(struct cyc *c)
{
	u32 i;

	for (i = 0; i < CALLERS; i++) {
		KUNIT_EXPECT_EQ_MSG(c->b->test, callers[i].ret, 0, "caller %u", i);
		KUNIT_EXPECT_MEMEQ(c->b->test, callers[i].v, bus_slave(c->b, i % N)->regs, 8);
	}
}

static struct cyc *in_op(struct kunit *test)
{
	/* all in OP: no other frames of the monitor than the urgent ones */
	struct cyc *c = cyc_in_op(bus_up(test, text, N), 0, N);

	cyc_run(c, 5);
	return c;
}

static void pack_one_frame(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u64 frames = bus_frames(c->b);

	begin(c, false);
	KUNIT_EXPECT_LE(test, end(c), 3u);
	expect_registers(c);
	frames = bus_frames(c->b) - frames;
	/* two or three cycles with a frame each, theirs, perhaps one of the monitor */
	KUNIT_EXPECT_LE(test, frames, 5ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

static const struct ecdev_ops *real_ops;
static u32 to_swallow;		/* frames that are shared */
static u32 no_buffer;		/* times that there is no transmit buffer for acyclic frames */
static struct bus *victim;

static int swallow(void *priv, u8 *buf, size_t len)
{
	const u8 *first = buf + EC_ETH_HDR + EC_FRAME_HDR;

	/* the frame of the cycle begins with another command */
	if (first[0] != EC_CMD_FPRD || !(first[7] & EC_DGRAM_MORE >> 8) || !to_swallow)
		return real_ops->tx_send(priv, buf, len);
	to_swallow--;
	return 0;
}

static u8 *refuse(void *priv)
{
	static u64 sent_ns;
	bool cyclic = sent_ns != bus_last_send_ns(victim);

	/* the first one of a send is for the frame of the cycle */
	sent_ns = bus_last_send_ns(victim);
	if (cyclic || !no_buffer)
		return real_ops->tx_get(priv);
	no_buffer--;
	return NULL;
}

static struct ecdev_ops *hook(struct bus *b, struct ecdev_ops *ops)
{
	struct ecdev *dev = bus_dev(b);

	victim = b;
	real_ops = dev->ops;
	*ops = *real_ops;
	dev->ops = ops;
	return ops;
}

static void unhook(struct bus *b)
{
	bus_dev(b)->ops = real_ops;
}

/* A lost frame ends for all as a frame of their own would, and is one frame. */
static void pack_lost(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ecdev_ops ops;
	u64 least = ~0ull, most = 0;
	u32 i;

	hook(c->b, &ops)->tx_send = swallow;
	to_swallow = 1;
	begin(c, false);
	end(c);
	KUNIT_EXPECT_EQ(test, to_swallow, 0u);
	for (i = 0; i < CALLERS; i++) {
		KUNIT_EXPECT_EQ_MSG(test, callers[i].ret, -ETIMEDOUT, "caller %u", i);
		least = min(least, callers[i].ns);
		most = max(most, callers[i].ns);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 1ull);
	/* 20 ms on the wire */
	KUNIT_EXPECT_GE(test, least, 20 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, most, 80 * NSEC_PER_MSEC);

	/* those that may be sent again are, each by itself */
	to_swallow = 100;
	begin(c, true);
	end(c);
	expect_registers(c);
	KUNIT_EXPECT_LE(test, bus_lost(c->b), 5ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 1ull + 100 - to_swallow);
	unhook(c->b);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
}

/* The link goes while the frame is on its way: all know at once. */
static void pack_link_down(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ecdev_ops ops;
	u32 i;

	hook(c->b, &ops)->tx_send = swallow;
	to_swallow = 1;
	begin(c, true);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, to_swallow, 0u);
	bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	end(c);
	for (i = 0; i < CALLERS; i++) {
		KUNIT_EXPECT_EQ_MSG(test, callers[i].ret, -ENETDOWN, "caller %u", i);
		KUNIT_EXPECT_LE(test, callers[i].ns, 50 * NSEC_PER_MSEC);
	}
	unhook(c->b);
}

/* No transmit buffer: they stay in the queue, in their order, and leave later. */
static void pack_no_buffer(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ecdev_ops ops;

	hook(c->b, &ops)->tx_get = refuse;
	no_buffer = 3;
	begin(c, false);
	end(c);
	KUNIT_EXPECT_EQ(test, no_buffer, 0u);
	unhook(c->b);
	expect_registers(c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(pack_one_frame),
	KUNIT_CASE(pack_lost),
	KUNIT_CASE(pack_link_down),
	KUNIT_CASE(pack_no_buffer),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_pack_cycle",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
