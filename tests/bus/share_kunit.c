// SPDX-License-Identifier: GPL-2.0-only
/* How many acyclic frames one send of the cycle carries, and how much of the wire they take. */
#include <linux/kthread.h>
#include "cyc.h"
#include "slow.h"

static const char text[] =
	"segment seed=23 response=100us transition=1ms\n"
	"slave a EK1100\nslave x EL1859\nslave d drive\n";

#define N	3
#define ASKERS	3	/* together they use all places of the queue */
#define FRAMES	64

/* somebody with many frames */
struct asker {
	struct bus *b;
	u32 n;
	u16 len;
	bool clock;
	bool first;
	struct ec_dg *dg;
	u8 *data;
	int ret;
	u64 end_ns;
	struct completion done;
};

static int ask(void *arg)
{
	struct asker *a = arg;
	u32 i;

	for (i = 0; i < a->n; i++) {
		a->dg[i] = EC_FPRD(bus_slave(a->b, 1)->station, 0, a->len, a->data + i * a->len);
		a->dg[i].repeat = false;
		a->dg[i].first = a->first;
	}
	a->ret = a->clock ? bus_xfer_clock(a->b, a->dg, a->n) : bus_xfer(a->b, a->dg, a->n);
	a->end_ns = ktime_get_ns();
	complete(&a->done);
	return 0;
}

/* @n callers, each with @frames frames of @dgrams datagrams with @len bytes */
static struct asker *askers(struct bus *b, u32 n, u32 frames, u32 dgrams, u16 len)
{
	struct asker *a = kunit_kzalloc(b->test, n * sizeof(*a), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, a);
	for (i = 0; i < n; i++) {
		a[i].b = b;
		a[i].n = frames * dgrams;
		a[i].len = len;
		a[i].dg = kunit_kzalloc(b->test, a[i].n * sizeof(*a[i].dg), GFP_KERNEL);
		KUNIT_ASSERT_NOT_NULL(b->test, a[i].dg);
		a[i].data = kunit_kzalloc(b->test, a[i].n * len, GFP_KERNEL);
		KUNIT_ASSERT_NOT_NULL(b->test, a[i].data);
	}
	return a;
}

/* acyclic frames of a send */
struct share {
	u64 frames;
	u64 bytes;
	u64 most;
	u64 most_ns;
	u64 sum;
};

static void count(struct cyc *c)
{
	u64 bytes = bus_tx_bytes(c->b);
	u64 frames = bus_frames(c->b);
	const struct ec_cyc_wire *last = bus_last_wire(c->b);
	struct share *s = c->ctx;

	/* everything since the send before was sent by it */
	if (s->frames) {
		u64 n = frames - s->frames - last->frames;
		/* preamble, FCS and gap beside the bytes of a frame */
		u64 ns = (bytes - s->bytes + 24 * (frames - s->frames)) * 80 - last->ns;

		s->most = max(s->most, n);
		s->most_ns = max(s->most_ns, ns);
		s->sum += n;
	}
	s->frames = frames;
	s->bytes = bytes;
}

static struct cyc *in_op(struct kunit *test)
{
	return cyc_in_op(bus_up(test, text, N), 1, 2);
}

static struct share run(struct cyc *c, struct asker *a, u32 n, u32 us)
{
	struct share s = { 0 };
	u32 i, left = n;

	c->period_ns = us * NSEC_PER_USEC;
	bus_set_interval(c->b, us);
	cyc_run(c, 5);
	c->each = count;
	c->ctx = &s;
	for (i = 0; i < n; i++) {
		init_completion(&a[i].done);
		kthread_run(ask, &a[i], "asker%u", i);
	}
	for (i = 0; left && i < 2000; i++) {
		cyc_run(c, 1);
		while (left && try_wait_for_completion(&a[left - 1].done))
			left--;
	}
	c->each = NULL;
	KUNIT_EXPECT_EQ(c->b->test, left, 0u);
	while (left)
		wait_for_completion(&a[--left].done);
	for (i = 0; i < n; i++)
		KUNIT_EXPECT_EQ(c->b->test, a[i].ret, 0);
	return s;
}

/* Three callers have 192 frames for the cycle: what a send carries depends on its length. */
static void share_of_send(struct kunit *test)
{
	static const struct { u32 us, most; } t[] = {
		{ 250, 2 }, { 1000, 8 }, { 4000, 32 }, { 16000, 64 },
	};
	struct cyc *c = in_op(test);
	/* no room for others in a frame of 15 datagrams */
	struct asker *a = askers(c->b, ASKERS, FRAMES, 15, 1);
	u32 k;

	for (k = 0; k < ARRAY_SIZE(t); k++) {
		struct share s = run(c, a, ASKERS, t[k].us);

		KUNIT_EXPECT_EQ_MSG(test, s.most, (u64)t[k].most, "cycle of %u us", t[k].us);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

static void share_limit_of_module(struct kunit *test)
{
	static const struct { u32 max, us, most; } t[] = {
		{ 1, 4000, 1 }, { 5, 1000, 5 }, { 20, 1000, 8 }, { 100, 16000, 100 },
	};
	struct cyc *c = in_op(test);
	struct asker *a = askers(c->b, ASKERS, FRAMES, 15, 1);
	u32 k, before = ec_share_max;

	KUNIT_EXPECT_EQ(test, before, 64u);
	/* the last one has its turn when 191 have left, however long that takes */
	bus_set_late_per_s(c->b, 0);
	for (k = 0; k < ARRAY_SIZE(t); k++) {
		struct share s;

		ec_share_max = t[k].max;
		s = run(c, a, ASKERS, t[k].us);
		KUNIT_EXPECT_EQ_MSG(test, s.most, (u64)t[k].most, "max_acyclic=%u", t[k].max);
	}
	ec_share_max = before;
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* Long frames take half of the wire time that is free, one of them whatever it needs. */
static void share_of_wire(struct kunit *test)
{
	static const struct { u32 us, most; } t[] = {
		{ 160, 1 }, { 500, 1 }, { 1000, 3 }, { 2000, 7 },
	};
	struct cyc *c = in_op(test);
	struct asker *a = askers(c->b, 1, FRAMES, 1, 1400);
	u32 k;

	for (k = 0; k < ARRAY_SIZE(t); k++) {
		struct share s = run(c, a, 1, t[k].us);
		u32 slack_ns = bus_slack_ns(c->b);

		KUNIT_EXPECT_EQ_MSG(test, s.most, (u64)t[k].most, "cycle of %u us", t[k].us);
		if (s.most > 1)
			KUNIT_EXPECT_LE(test, s.most_ns, (u64)slack_ns / 2);
		KUNIT_EXPECT_LE(test, s.most_ns, (u64)slack_ns);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* A frame that several callers share takes no more of the wire, either. */
static void share_of_wire_packed(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct asker *a = askers(c->b, 40, 20, 1, 300);
	struct share s = run(c, a, 40, 1000);
	u32 slack_ns = bus_slack_ns(c->b);

	KUNIT_EXPECT_GE(test, s.most, 3ull);
	KUNIT_EXPECT_LE(test, s.most, 4ull);
	KUNIT_EXPECT_LE(test, s.most_ns, (u64)slack_ns / 2);
	/* 800 frames of callers; four datagrams fit into one */
	KUNIT_EXPECT_LE(test, s.sum, 300ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* Others do not wait behind frames of clocks. */
static void share_beside_clocks(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct asker *a = askers(c->b, 2, FRAMES, 15, 1);
	u32 before = ec_share_max;
	struct share s;
	u64 t0;

	a[0].clock = true;
	a[1].n = 1;
	s = run(c, a, 2, 1000);
	KUNIT_EXPECT_LE(test, s.most, 8ull);
	/* where a send has one place only, they take turns */
	ec_share_max = 1;
	t0 = ktime_get_ns();
	s = run(c, a, 2, 1000);
	ec_share_max = before;
	KUNIT_EXPECT_EQ(test, s.most, 1ull);
	KUNIT_EXPECT_LE(test, a[1].end_ns - t0, 10 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LT(test, a[1].end_ns, a[0].end_ns);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* One that is to be the first clock frame of its send waits for the next one. */
static void share_first_clock_frame_waits(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct asker *a = askers(c->b, 1, FRAMES, 1, 1000);

	a[0].clock = true;
	KUNIT_EXPECT_EQ(test, run(c, a, 1, 1000).most, 2ull);
	a[0].first = true;
	KUNIT_EXPECT_EQ(test, run(c, a, 1, 1000).most, 1ull);
}

/* 100 drives on their way to OP: their mailboxes are at work, the monitor, the rest. */
static void share_limited_during_start(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=12 response=100us transition=1ms\n"
			       "repeat 100 slave d drive in=22 out=22 mapping=rewritable\n", 100);
	struct share s = { 0 };
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	for (i = 0; i < 100; i++) {
		u32 config = cyc_config(c, i);

		cyc_remap(c, config);
		cyc_map(c, config, 2, 0);
		cyc_map(c, config, 3, 0);
	}
	cyc_activate(c);
	c->each = count;
	c->ctx = &s;
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_figure("100 drives to OP beside a cycle of 1 ms: at most %llu acyclic frames and %llu us of wire time a send, %llu frames in all",
		   s.most, div_u64(s.most_ns, 1000), s.sum);
	KUNIT_EXPECT_LE(test, s.most, 8ull);
	KUNIT_EXPECT_LE(test, s.most_ns, (u64)bus_slack_ns(b) / 2);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* A device that has a buffer, but refuses the frame: the next send of the cycle sends it. */
static void share_refused_frame_stays_queued(struct kunit *test)
{
	struct bus *b = bus_new(test, text);
	struct slow *s = slow_plug(b, 16, 1);
	struct asker *a;
	struct cyc *c;

	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
	c = cyc_in_op(b, 1, 2);
	a = askers(b, 1, FRAMES, 15, 1);
	slow_refuse(s, EC_CMD_FPRD, 0, 20);
	run(c, a, 1, 1000);
	KUNIT_EXPECT_EQ(test, slow_to_refuse(s), 0u);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(share_of_send),
	KUNIT_CASE(share_limit_of_module),
	KUNIT_CASE(share_of_wire),
	KUNIT_CASE(share_of_wire_packed),
	KUNIT_CASE(share_beside_clocks),
	KUNIT_CASE(share_first_clock_frame_waits),
	KUNIT_CASE(share_limited_during_start),
	KUNIT_CASE(share_refused_frame_stays_queued),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_share",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
