// SPDX-License-Identifier: GPL-2.0-only
/*
 * Figures of mailboxes in bus time: latency of an SDO, many slaves at once, files. A row has the
 * goal; the gate is what is reached today.
 */
#include <linux/kthread.h>
#include "cyc.h"
#include "master/link/access.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/foe.h"
#include "master/wire/frame.h"

#define RESPONSE_US	100	/* what the slave takes for a message */
#define PERIOD_US	1000
#define REQUESTS	100	/* of which the latency is the mean */
#define UPLOADS		10	/* of each slave, one after the other */
#define FILE_BYTES	(1 << 20)
#define FILE_MBOX	512
#define DGRAM		12	/* bytes of a datagram beside its data */

/* what is reached today; the goals are in the rows */
#define LATENCY_IDLE_US		460	/* 336, or 451 when one meets a frame of the monitor */
#define ALONE_IDLE_US		336	/* of those that meet none */
#define MET_IDLE		5	/* polls are 20 ms apart: 2 of 100 meet one on average */
#define LATENCY_1_MEAN		250	/* 1/100 of a cycle */
#define LATENCY_1_WORST		300
#define LATENCY_100_MEAN	250
#define LATENCY_100_WORST	300
#define UPLOADS_IDLE		130	/* % */
#define UPLOADS_CYCLE		125
#define FOE_IDLE_1		120
#define FOE_IDLE_20		112

/* who has something for mailboxes, one after the other */
struct client {
	struct bus *b;
	u32 slave;
	u32 slaves;	/* latency: one of them each time */
	int ret;
	u64 sum_ns;
	u64 worst_ns;
	u32 met;	/* that took longer than ALONE_IDLE_US */
	struct completion done;
};

static struct bus *drives(struct kunit *test, u32 n, u32 mbox)
{
	char text[160];
	struct bus *b;

	snprintf(text, sizeof(text), "segment seed=41 response=%uus transition=1ms\n"
		 "repeat %u slave d drive in=8 out=8 mbox=%u foe=%u\n", RESPONSE_US, n, mbox,
		 FILE_BYTES / 1024);
	b = bus_up(test, text, n);
	bus_idle(b);
	return b;
}

static int upload(struct ec_slave *s)
{
	size_t got;
	u32 abort;
	u8 v[4];

	return ec_coe_upload(&s->mbox, 0x1000, 0, false, v, sizeof(v), &got, &abort, NULL);
}

/* Requests at all phases of a cycle, each alone. */
static int ask_apart(void *arg)
{
	struct client *c = arg;
	u32 i;

	for (i = 0; i < REQUESTS && !c->ret; i++) {
		u64 t0, ns;

		usleep_range(3000 + 137 * i, 3001 + 137 * i);
		t0 = ktime_get_ns();
		c->ret = upload(bus_slave(c->b, i * 37 % c->slaves));
		ns = ktime_get_ns() - t0 - RESPONSE_US * NSEC_PER_USEC;
		c->sum_ns += ns;
		c->worst_ns = max(c->worst_ns, ns);
		c->met += ns > ALONE_IDLE_US * NSEC_PER_USEC;
	}
	complete(&c->done);
	return 0;
}

static int ask_often(void *arg)
{
	struct client *c = arg;
	u32 i;

	for (i = 0; i < UPLOADS && !c->ret; i++)
		c->ret = upload(bus_slave(c->b, c->slave));
	complete(&c->done);
	return 0;
}

static int fill(void *ctx, u64 at, u8 *buf, size_t n)
{
	memset(buf, (u8)(at >> 8), n);
	return 0;
}

static int write_file(void *arg)
{
	struct client *c = arg;
	struct ec_foe_file file = { .size = FILE_BYTES, .copy = fill };
	struct ec_foe f = { .write = true, .name = "f", .name_len = 1 };

	c->ret = ec_foe_transfer(&bus_slave(c->b, c->slave)->mbox, &f, &file, NULL);
	complete(&c->done);
	return 0;
}

/*
 * @n clients at once, beside the cycle of @c if there is one. Returns how long they take, ns;
 * the last one is @last.
 */
static u64 together(struct bus *b, struct cyc *c, int (*what)(void *), u32 n, u32 slaves,
		    struct client *last)
{
	struct client *x = kvcalloc(n, sizeof(*x), GFP_KERNEL);
	u64 lost = bus_lost(b), t0 = ktime_get_ns(), ns;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, x);
	for (i = 0; i < n; i++) {
		x[i].b = b;
		x[i].slave = i;
		x[i].slaves = slaves;
		init_completion(&x[i].done);
		kthread_run(what, &x[i], "client%u", i);
	}
	for (i = 0; i < n; i++) {
		while (c && !completion_done(&x[i].done))
			cyc_run(c, 1);
		wait_for_completion(&x[i].done);
	}
	ns = ktime_get_ns() - t0;
	for (i = 0; i < n; i++)
		KUNIT_EXPECT_EQ_MSG(b->test, x[i].ret, 0, "client %u", i);
	KUNIT_EXPECT_EQ(b->test, bus_lost(b), lost);
	if (last)
		*last = x[n - 1];
	kvfree(x);
	return ns;
}

static u64 percent(u64 value, u64 of)
{
	return div64_u64(value * 100 + of - 1, of);
}

/* wire time of @n datagrams of @bytes, as many in a frame as it holds */
static u64 packed_ns(u64 n, u32 bytes)
{
	u32 body = bytes + DGRAM, each = min3(15u, (u32)EC_FRAME_BODY_MAX / body, (u32)n);
	u32 frame = EC_ETH_HDR + EC_FRAME_HDR + each * body;

	return div_u64(n + each - 1, each) * ec_frame_wire_ns(frame);
}

/* wire time of @n messages and their answers */
static u64 mailboxes_ns(struct bus *b, u64 n)
{
	const struct ec_sii_mbox *box = &bus_slave(b, 0)->info.std;

	return packed_ns(n, box->rx_size) + packed_ns(n, box->tx_size);
}

static void mailbox_latency_idle(struct kunit *test)
{
	struct bus *b = drives(test, 100, 128);
	struct client x;

	together(b, NULL, ask_apart, 1, 100, &x);
	bus_judge(test, div_u64(x.worst_ns, 1000), 500, LATENCY_IDLE_US,
	      "us of bus time: SDO upload idle, 100 slaves, without the slave's time, worst");
	KUNIT_EXPECT_LE_MSG(test, x.met, MET_IDLE, "longer than %u us", ALONE_IDLE_US);
}

/* Latency of SDOs in operation, in 1/100 of a cycle. */
static void latency_in_cycle(struct kunit *test, u32 n, u64 mean_limit, u64 worst_limit)
{
	struct bus *b = drives(test, n, 128);
	struct cyc *c = cyc_in_op(b, 0, n);
	struct client x;
	char text[120];

	together(b, c, ask_apart, 1, n, &x);
	snprintf(text, sizeof(text),
		 "1/100 cycle of 1 ms: SDO upload, %u slave(s), without the slave's time, mean", n);
	bus_judge(test, div_u64(x.sum_ns, REQUESTS * PERIOD_US * 10), 250, mean_limit, text);
	snprintf(text, sizeof(text), "1/100 cycle of 1 ms: the same, %u slave(s), worst", n);
	bus_judge(test, div_u64(x.worst_ns, PERIOD_US * 10), 300, worst_limit, text);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

static void mailbox_latency_cycle_1(struct kunit *test)
{
	latency_in_cycle(test, 1, LATENCY_1_MEAN, LATENCY_1_WORST);
}

static void mailbox_latency_cycle_100(struct kunit *test)
{
	latency_in_cycle(test, 100, LATENCY_100_MEAN, LATENCY_100_WORST);
}

static void mailbox_uploads_idle(struct kunit *test)
{
	struct bus *b = drives(test, 100, 128);
	u64 ns = together(b, NULL, ask_often, 100, 0, NULL);
	u64 wire = mailboxes_ns(b, 100 * UPLOADS);

	bus_figure("100 slaves with %u uploads each, idle: %llu us, wire time of the mailboxes %llu us",
		   UPLOADS, div_u64(ns, 1000), div_u64(wire, 1000));
	bus_judge(test, percent(ns, wire), 130, UPLOADS_IDLE,
	      "% of the wire time of their mailboxes: 100 slaves upload at once, idle");
}

/* Acyclic frames share half of what the cycle leaves. */
static void mailbox_uploads_cycle(struct kunit *test)
{
	struct bus *b = drives(test, 100, 128);
	struct cyc *c = cyc_in_op(b, 0, 100);
	u64 ns = together(b, c, ask_often, 100, 0, NULL), wire = mailboxes_ns(b, 100 * UPLOADS);
	u64 allowed = div64_u64(wire * PERIOD_US * 1000, bus_slack_ns(b) / 2);

	bus_figure("100 slaves with %u uploads each, cycle of 1 ms: %llu us, wire time of the mailboxes %llu us, in their share %llu us",
		   UPLOADS, div_u64(ns, 1000), div_u64(wire, 1000), div_u64(allowed, 1000));
	bus_judge(test, percent(ns, allowed), 130, UPLOADS_CYCLE,
	      "% of what the share of the wire allows: 100 slaves upload at once, 1 ms cycle");
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/*
 * The shortest time for files of @n slaves: a packet of a slave is a frame with DATA, its own
 * time, and a frame with ACK; all packets together are what the wire has to carry.
 */
static u64 files_ns(struct bus *b, u32 n)
{
	u32 packets = FILE_BYTES / (FILE_MBOX - EC_MBOX_HDR - EC_FOE_HDR) + 2;
	u64 alone = 2 * packed_ns(1, FILE_MBOX) + RESPONSE_US * NSEC_PER_USEC;

	return max(packets * alone, mailboxes_ns(b, (u64)packets * n));
}

static void files(struct kunit *test, u32 n, bool cycle, u64 limit)
{
	struct bus *b = drives(test, n, FILE_MBOX);
	struct cyc *c = cycle ? cyc_in_op(b, 0, n) : NULL;
	u64 ns = together(b, c, write_file, n, 0, NULL), best = files_ns(b, n);
	char text[100];

	bus_figure("FoE, 1 MiB to %u slave(s) at once, mailboxes of %u bytes, %s: %llu ms, at best %llu ms idle: %llu %% of the bandwidth",
		   n, FILE_MBOX, cycle ? "cycle of 1 ms" : "idle", div_u64(ns, NSEC_PER_MSEC),
		   div_u64(best, NSEC_PER_MSEC), div64_u64(best * 100, ns));
	if (cycle) {
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
		return;
	}
	snprintf(text, sizeof(text), "%% of the shortest time: FoE, 1 MiB to %u slave(s), idle", n);
	bus_judge(test, percent(ns, best), 125, limit, text);
}

static void mailbox_foe_idle_1(struct kunit *test)
{
	files(test, 1, false, FOE_IDLE_1);
}

static void mailbox_foe_idle_20(struct kunit *test)
{
	files(test, 20, false, FOE_IDLE_20);
}

static void mailbox_foe_cycle_1(struct kunit *test)
{
	files(test, 1, true, 0);
}

static void mailbox_foe_cycle_20(struct kunit *test)
{
	files(test, 20, true, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(mailbox_latency_idle),
	KUNIT_CASE(mailbox_latency_cycle_1),
	KUNIT_CASE(mailbox_latency_cycle_100),
	KUNIT_CASE(mailbox_uploads_idle),
	KUNIT_CASE(mailbox_uploads_cycle),
	KUNIT_CASE(mailbox_foe_idle_1),
	KUNIT_CASE(mailbox_foe_idle_20),
	KUNIT_CASE(mailbox_foe_cycle_1),
	KUNIT_CASE(mailbox_foe_cycle_20),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_mailbox_figures",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
