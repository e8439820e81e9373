// SPDX-License-Identifier: GPL-2.0-only
/*
 * Acyclic frames that are there but were not looked for: a machine that stood
 * still, a cycle that is slower than it said. None of them is lost.
 */
#include <linux/kthread.h>
#include "cyc.h"
#include "master/device.h"
#include "master/ioctl.h"

static const char text[] =
	"segment seed=22 response=100us transition=1ms\n"
	"slave a EK1100\nslave x EL1859\nslave d drive\n";

#define N	3
#define READERS	3	/* together they use all slots that are not for the cycle */
#define READS	64
#define BYTES	1400

/* somebody with much to read */
struct reader {
	struct bus *b;
	struct ec_dg dg[READS];
	u8 data[READS][BYTES];
	int ret;
	struct completion done;
};

static int read_much(void *arg)
{
	struct reader *r = arg;
	u32 i;

	for (i = 0; i < READS; i++) {
		r->dg[i] = (struct ec_dg)EC_DG(EC_CMD_FPRD, bus_slave(r->b, 1)->station, 0, BYTES,
					       r->data[i]);
		r->dg[i].repeat = false;
	}
	r->ret = ec_xfer(r->b->m, r->dg, READS);
	complete(&r->done);
	return 0;
}

static struct cyc *in_op(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	return c;
}

/* A cycle of 1 ms that comes every 15 ms: the frames' turn is late. */
static void turn_slow_cycle(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct reader *r = kvcalloc(READERS, sizeof(*r), GFP_KERNEL);
	u32 i, left = READERS;

	KUNIT_ASSERT_NOT_NULL(test, r);
	for (i = 0; i < READERS; i++) {
		r[i].b = c->b;
		init_completion(&r[i].done);
		kthread_run(read_much, &r[i], "reader%u", i);
	}
	c->period_ns = 15 * NSEC_PER_MSEC;
	for (i = 0; left && i < 400; i++) {
		cyc_run(c, 1);
		/* counts each reader when its turn in the row has come */
		while (left && try_wait_for_completion(&r[left - 1].done))
			left--;
	}
	bus_figure("%u reads of %u bytes beside a cycle of 1 ms that comes every 15 ms: %u ms",
		   READERS * READS, BYTES, i * 15);
	KUNIT_EXPECT_EQ(test, left, 0u);
	while (left)
		wait_for_completion(&r[--left].done);
	for (i = 0; i < READERS; i++)
		KUNIT_EXPECT_EQ(test, r[i].ret, 0);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, c->b->m->owner, EC_OWNER_CYCLE);
	kvfree(r);
}

/* The cycle stops while a frame waits for its turn: it goes out without it. */
static void turn_stalled_cycle(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u64 t0 = ktime_get_ns();
	u8 v[4];

	KUNIT_ASSERT_EQ(test, c->b->m->owner, EC_OWNER_CYCLE);
	KUNIT_EXPECT_EQ(test, ec_xfer_fprd(c->b->m, bus_slave(c->b, 1)->station, 0, v, 4), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 400 * NSEC_PER_MSEC);
	KUNIT_EXPECT_MEMEQ(test, v, bus_slave(c->b, 1)->regs, 4);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, c->b->m->slaves_responding, N);
}

/* Nobody delivers what has arrived, as when an interrupt is held up. */
static void turn_overdue(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ecdev *dev = b->m->link[0].dev;
	u32 i;
	u8 v[4];

	bus_idle(b);
	dev->ops->cycle(dev->priv, true);
	for (i = 0; i < 20; i++) {
		memset(v, 0, sizeof(v));
		KUNIT_EXPECT_EQ(test, ec_xfer_fprd(b->m, bus_slave(b, 1)->station, 0, v, 4), 0);
		KUNIT_EXPECT_MEMEQ(test, v, bus_slave(b, 1)->regs, 4);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, b->m->slaves_responding, N);
	dev->ops->cycle(dev->priv, false);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(turn_slow_cycle),
	KUNIT_CASE(turn_stalled_cycle),
	KUNIT_CASE(turn_overdue),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_turn",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
