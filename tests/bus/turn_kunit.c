// SPDX-License-Identifier: GPL-2.0-only
/*
 * Acyclic frames that are there but were not looked for: a machine that stood
 * still, a cycle that is slower than it said. None of them is lost.
 */
#include <linux/kthread.h>
#include <linux/sched/signal.h>
#include "cyc.h"
#include "master/link/device.h"
#include "master/boundary/ioctl.h"

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
		r->dg[i] = EC_FPRD(bus_slave(r->b, 1)->station, 0, BYTES, r->data[i]);
		r->dg[i].repeat = false;
	}
	r->ret = bus_xfer(r->b, r->dg, READS);
	complete(&r->done);
	return 0;
}

/* The last slave but @behind is in OP, the others in PREOP. */
static struct cyc *in_op_of(struct bus *b, u32 behind)
{
	return cyc_in_op(b, bus_n_slaves(b) - 1 - behind, 1);
}

static struct cyc *in_op(struct kunit *test)
{
	return in_op_of(bus_up(test, text, N), 1);
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
	KUNIT_EXPECT_EQ(test, bus_access_mode(c->b), EC_ACCESS_CYCLIC);
	kvfree(r);
}

/* The cycle stops while a frame waits for its turn: it goes out without it. */
static void turn_stalled_cycle(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u64 t0 = ktime_get_ns();
	u8 v[4];

	KUNIT_ASSERT_EQ(test, bus_access_mode(c->b), EC_ACCESS_CYCLIC);
	KUNIT_EXPECT_EQ(test, bus_fprd(c->b, bus_slave(c->b, 1)->station, 0, v, 4), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 400 * NSEC_PER_MSEC);
	KUNIT_EXPECT_MEMEQ(test, v, bus_slave(c->b, 1)->regs, 4);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_responding(c->b), N);
}

/* Nobody delivers what has arrived, as when an interrupt is held up. */
static void turn_overdue(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ecdev *dev = bus_dev(b);
	u32 i;
	u8 v[4];

	bus_idle(b);
	dev->ops->cycle(dev->priv, true);
	for (i = 0; i < 20; i++) {
		memset(v, 0, sizeof(v));
		KUNIT_EXPECT_EQ(test, bus_fprd(b, bus_slave(b, 1)->station, 0, v, 4), 0);
		KUNIT_EXPECT_MEMEQ(test, v, bus_slave(b, 1)->regs, 4);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_responding(b), N);
	dev->ops->cycle(dev->priv, false);
}

/* The wire is full: not even the shortest frame fits, so many cycles a second are late. */
static struct cyc *full(struct cyc *c, u32 late_per_s)
{
	struct kunit *test = c->b->test;

	bus_set_late_per_s(c->b, late_per_s);
	bus_set_interval(c->b, 5);
	cyc_run(c, 10);
	KUNIT_ASSERT_EQ(test, bus_access_mode(c->b), EC_ACCESS_CYCLIC);
	KUNIT_ASSERT_LT(test, bus_slack_ns(c->b), ec_layout_need_ns());
	return c;
}

/* somebody who reads registers, one frame after the other */
struct few {
	struct bus *b;
	u16 station;
	u32 count;
	int ret;
	struct completion done;
};

static int read_few(void *arg)
{
	struct few *f = arg;
	u8 v[4];
	u32 i;

	allow_signal(SIGKILL);
	for (i = 0; i < f->count && !f->ret; i++) {
		struct ec_dg dg = EC_DG(EC_CMD_FPRD, f->station, 0, sizeof(v), v);

		dg.repeat = false;
		f->ret = bus_xfer(f->b, &dg, 1);
	}
	complete(&f->done);
	return 0;
}

/* ms until it is done; at most @limit_ms cycles are run before that counts as too long */
static u32 run_few(struct cyc *c, struct few *f, u32 count, u32 kill_after_ms, u32 limit_ms)
{
	struct task_struct *t;
	u32 ms;

	*f = (struct few){ .b = c->b, .station = bus_slave(c->b, 0)->station, .count = count };
	init_completion(&f->done);
	t = kthread_run(read_few, f, "few");
	KUNIT_ASSERT_FALSE(c->b->test, IS_ERR(t));
	for (ms = 0; ms < limit_ms && !try_wait_for_completion(&f->done); ms++) {
		if (kill_after_ms && ms == kill_after_ms)
			send_sig(SIGKILL, t, 1);
		cyc_run(c, 1);
	}
	if (ms < limit_ms)
		return ms;
	KUNIT_FAIL(c->b->test, "not done in %u ms", ms);
	while (!try_wait_for_completion(&f->done))
		cyc_run(c, 1);
	return ms;
}

/* Each has its turn, though the monitor looks often and its frames go first. */
static void turn_beside_monitor(struct kunit *test)
{
	/* all in OP: no other frames of the monitor than the urgent ones */
	struct cyc *c = full(in_op_of(bus_up(test, "slave x EL1859\n", 1), 0), 10);
	struct few f;

	/* one of them before each */
	KUNIT_EXPECT_LT(test, run_few(c, &f, 10, 0, 20000), 2500u);
	KUNIT_EXPECT_EQ(test, f.ret, 0);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_responding(c->b), 1u);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
}

/* Many wait for their turn, for longer than the time limit of a frame that has left. */
static void turn_of_many(struct kunit *test)
{
	struct cyc *c = full(in_op(test), 50);
	struct reader *r = kvcalloc(1, sizeof(*r), GFP_KERNEL);
	u32 ms;

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->b = c->b;
	init_completion(&r->done);
	kthread_run(read_much, r, "reader");
	for (ms = 0; ms < 10000 && !try_wait_for_completion(&r->done); ms++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, ms, 3000u);
	KUNIT_EXPECT_EQ(test, r->ret, 0);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	kvfree(r);
}

/* A frame that is lost is waited for from when it has left, not from all others' turns. */
static void turn_lost(struct kunit *test)
{
	struct cyc *c = full(in_op(test), 1);
	struct few f;
	u32 ms;

	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	ms = run_few(c, &f, 1, 0, 10000);
	KUNIT_EXPECT_LT(test, ms, 3500u);
	KUNIT_EXPECT_EQ(test, f.ret, -ETIMEDOUT);
}

/* Who is killed does not wait for his turn. */
static void queue_wait_ends_on_fatal_signal(struct kunit *test)
{
	struct cyc *c = full(in_op(test), 1);
	struct few f;
	u32 ms;

	/* the one late cycle of this second is over */
	while (!bus_late_cycles(c->b))
		cyc_run(c, 1);
	ms = run_few(c, &f, 5, 200, 10000);
	KUNIT_EXPECT_LT(test, ms, 600u);
	KUNIT_EXPECT_EQ(test, f.ret, -EINTR);
}

/* Tools have all places of the link, and none of them gets on. */
static u32 take_places(struct bus *b)
{
	u32 n = bus_link(b, 0)->places;

	atomic_add(n, &bus_link(b, 0)->acyclic);
	return n;
}

static void give_places(struct bus *b, u32 n)
{
	atomic_sub(n, &bus_link(b, 0)->acyclic);
}

/* A slave that falls silent, and one that shows an error: the monitor does not wait for tools. */
static void turn_monitor_passes_tools(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u64 frames;
	u32 places;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	msleep(1000);
	KUNIT_ASSERT_TRUE(test, bus_slave(b, 1)->reply.silent);
	places = take_places(b);
	frames = bus_frames(b);
	msleep(5000);
	KUNIT_EXPECT_GT(test, bus_frames(b) - frames, 200ull);
	bus_fault(b, EC_SIM_FAULT_AL_ERROR, 2, 0, 0x1b, 0);
	msleep(1000);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 2)->al.status & EC_AL_ERROR);
	/* it is even scanned again */
	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 0, 0);
	msleep(3000);
	KUNIT_EXPECT_FALSE(test, bus_slave(b, 1)->reply.silent);
	give_places(b, places);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 3000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_acyclic(b), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(turn_slow_cycle),
	KUNIT_CASE(turn_stalled_cycle),
	KUNIT_CASE(turn_overdue),
	KUNIT_CASE(turn_monitor_passes_tools),
	KUNIT_CASE(turn_beside_monitor),
	KUNIT_CASE(turn_of_many),
	KUNIT_CASE(turn_lost),
	KUNIT_CASE(queue_wait_ends_on_fatal_signal),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_turn",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
