// SPDX-License-Identifier: GPL-2.0-only
/* The transport of mailboxes: several protocols at once, beside a cycle that begins and ends. */
#include <linux/kthread.h>
#include "cyc.h"
#include "slow.h"
#include "devices/sim/app.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"

#define SLOW_MS	5

static const char text[] =
	"segment seed=51 response=5ms transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11 soe=1\n"
	"slave b drive in=8 out=8 mbox=128 serial=12\n";

/* a caller of the mailbox of slave 0 */
struct caller {
	struct bus *b;
	u32 slave;
	bool stop;	/* of those that go on and on */
	u32 done;
	u32 failed;
	u32 wrong;
	int ret;
	u64 longest_ns;
	struct completion end;
};

static int serial(struct bus *b, u32 slave, u32 *value)
{
	struct ec_mbox_limit limit = { .timeout_ms = 300 };
	size_t got;
	u32 abort;
	u8 v[4];
	int ret = ec_coe_upload(bus_mbox(b, slave), 0x1018, 4, false, v, sizeof(v), &got,
				&abort, &limit);

	*value = get_unaligned_le32(v);
	return ret;
}

static int read_sdo(void *arg)
{
	struct caller *c = arg;
	u32 value;

	c->ret = serial(c->b, 0, &value);
	c->wrong = value != 11;
	complete(&c->end);
	return 0;
}

static int read_idn(void *arg)
{
	struct caller *c = arg;
	u16 error;
	size_t got;
	u8 v[64];

	c->ret = ec_soe_read(bus_mbox(c->b, 0), 0, 91, v, sizeof(v), &got, &error, NULL);
	complete(&c->end);
	return 0;
}

static int read_on(void *arg)
{
	struct caller *c = arg;
	u32 value;

	while (!READ_ONCE(c->stop)) {
		u64 t0 = ktime_get_ns();

		if (serial(c->b, c->slave, &value))
			c->failed++;
		else if (value != 11 + c->slave)
			c->wrong++;
		else
			c->done++;
		c->longest_ns = max(c->longest_ns, ktime_get_ns() - t0);
		usleep_range(50, 51);
	}
	complete(&c->end);
	return 0;
}

static struct caller *begin(struct bus *b, int (*what)(void *), u32 slave)
{
	struct caller *c = kunit_kzalloc(b->test, sizeof(*c), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, c);
	c->b = b;
	c->slave = slave;
	init_completion(&c->end);
	KUNIT_ASSERT_FALSE(b->test, IS_ERR(kthread_run(what, c, "caller")));
	return c;
}

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);

	bus_idle(b);
	return b;
}

/* The second request is given to the slave before it has answered the first. */
static void transport_protocols_side_by_side(struct kunit *test)
{
	struct bus *b = ready(test);
	struct caller *soe, *sdo;
	u64 t0 = ktime_get_ns();

	soe = begin(b, read_idn, 0);
	sdo = begin(b, read_sdo, 0);
	usleep_range(2000, 2001);
	KUNIT_EXPECT_FALSE(test, completion_done(&soe->end));
	KUNIT_EXPECT_TRUE(test, bus_app(b, "a")->mbox.rx_waits);
	wait_for_completion(&soe->end);
	wait_for_completion(&sdo->end);
	KUNIT_EXPECT_EQ(test, soe->ret, 0);
	KUNIT_EXPECT_EQ(test, sdo->ret, 0);
	KUNIT_EXPECT_EQ(test, sdo->wrong, 0u);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, (2 * SLOW_MS + 3) * (u64)NSEC_PER_MSEC);
}

/* A transfer that is given up leaves its answer; neither it nor the other protocol is confused. */
static void transport_late_answer_beside_other_protocol(struct kunit *test)
{
	struct ec_mbox_limit limit = { .timeout_ms = 2 };
	struct bus *b = ready(test);
	struct caller *soe;
	size_t got;
	u32 abort, i, value;
	u8 v[4];

	for (i = 0; i < 20; i++) {
		soe = begin(b, read_idn, 0);
		KUNIT_EXPECT_EQ(test, ec_coe_upload(bus_mbox(b, 0), 0x1018, 1, false, v,
						    4, &got, &abort, &limit), -ETIMEDOUT);
		KUNIT_EXPECT_EQ(test, serial(b, 0, &value), 0);
		KUNIT_EXPECT_EQ(test, value, 11u);
		wait_for_completion(&soe->end);
		KUNIT_EXPECT_EQ(test, soe->ret, 0);
	}
}

/* Emergencies that come in between reach the list, and no request misses its answer. */
static void transport_emergencies_beside_requests(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_app *app = bus_app(b, "a");
	struct caller *c;
	u32 i, sent = 0;

	app->response_ns = 100 * NSEC_PER_USEC;
	c = begin(b, read_on, 0);
	for (i = 0; i < 400; i++) {
		usleep_range(1700, 1701);
		if (app->mbox.out_len)
			continue;
		ec_app_emergency(app, 0x3210, 0x04, (u8[5]){ 1, 2, 3, 4, 5 }, ktime_get_ns());
		sent++;
	}
	WRITE_ONCE(c->stop, true);
	wait_for_completion(&c->end);
	msleep(200);
	KUNIT_EXPECT_GT(test, sent, 20u);
	KUNIT_EXPECT_EQ(test, bus_mbox(b, 0)->desk.n_last, sent);
	KUNIT_EXPECT_GT(test, c->done, 40u);
	KUNIT_EXPECT_EQ(test, c->failed + c->wrong, 0u);
}

/* Bus access changes while datagrams of the mailboxes are ready, in the queue, and on their way. */
static void transport_cycles_begin_and_end(struct kunit *test)
{
	struct bus *b = ready(test);
	struct caller *c[2];
	u32 i;

	bus_app(b, "a")->response_ns = 300 * NSEC_PER_USEC;
	bus_app(b, "b")->response_ns = 300 * NSEC_PER_USEC;
	c[0] = begin(b, read_on, 0);
	c[1] = begin(b, read_on, 1);
	for (i = 0; i < 25; i++) {
		struct cyc *cyc = cyc_new(b, 1000);

		cyc_domain(cyc);
		cyc_map_all(cyc, 0, 2, 0);
		cyc_activate(cyc);
		cyc_run(cyc, 40 + i);
		bus_end(b);
		usleep_range(5000 + 137 * i, 5001 + 137 * i);
	}
	for (i = 0; i < 2; i++) {
		WRITE_ONCE(c[i]->stop, true);
		wait_for_completion(&c[i]->end);
		bus_figure("SDO uploads while cycles begin and end: %u done, longest %llu us",
			   c[i]->done, div_u64(c[i]->longest_ns, NSEC_PER_USEC));
		KUNIT_EXPECT_GT(test, c[i]->done, 50u);
		KUNIT_EXPECT_EQ(test, c[i]->wrong, 0u);
		KUNIT_EXPECT_EQ(test, c[i]->failed, 0u);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* The slave goes while a datagram of its mailbox is on its way, and comes back. */
static void transport_slave_lost_in_transfer(struct kunit *test)
{
	struct bus *b = ready(test);
	struct caller *c = begin(b, read_on, 0);
	u32 i;

	for (i = 0; i < 10; i++) {
		usleep_range(3000 + 731 * i, 3001 + 731 * i);
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
		msleep(150);
		bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 3000), ~0ull);
		bus_idle(b);
	}
	WRITE_ONCE(c->stop, true);
	wait_for_completion(&c->end);
	KUNIT_EXPECT_GT(test, c->done, 100u);
	KUNIT_EXPECT_EQ(test, c->wrong, 0u);
	KUNIT_EXPECT_LE(test, c->longest_ns, 500ull * NSEC_PER_MSEC);
}

/* While no caller uses a mailbox, nothing is sent but the polls of the monitor. */
static void transport_rests(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 before;
	u32 value;

	KUNIT_EXPECT_EQ(test, serial(b, 0, &value), 0);
	KUNIT_EXPECT_FALSE(test, ec_mbox_in_use(bus_mbox(b, 0)));
	KUNIT_EXPECT_EQ(test, bus_posts(b), 0u);
	before = bus_frames(b);
	msleep(1000);
	/* 50 looks at the AL status, one at all mailboxes, one at error counters */
	KUNIT_EXPECT_LE(test, bus_frames(b) - before, 57ull);
}

/* A slave goes while its datagram waits for a cycle that stands still: it is freed nevertheless. */
static void transport_slave_lost_beside_stalled_cycle(struct kunit *test)
{
	struct bus *b = ready(test);
	struct cyc *cyc = cyc_in_op(b, 0, 2);
	struct caller *c = begin(b, read_on, 0);

	cyc_run(cyc, 20);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	WRITE_ONCE(c->stop, true);
	msleep(600);
	KUNIT_EXPECT_TRUE(test, completion_done(&c->end));
	KUNIT_EXPECT_GE(test, bus_timeouts(b), 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 1u);
	KUNIT_EXPECT_EQ(test, bus_posts(b), 0u);
}

/* The device sends nothing for a while: what has waited in the queue leaves afterwards. */
static void transport_full_ring_is_waited_for(struct kunit *test)
{
	struct bus *b = bus_new(test, text);
	struct caller *c;

	b->slow = slow_plug(b, 8, 1);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	slow_stop(b->slow, true);
	c = begin(b, read_sdo, 0);
	msleep(15);
	slow_stop(b->slow, false);
	wait_for_completion(&c->end);
	KUNIT_EXPECT_EQ(test, c->ret, 0);
	KUNIT_EXPECT_EQ(test, c->wrong, 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(transport_protocols_side_by_side),
	KUNIT_CASE(transport_late_answer_beside_other_protocol),
	KUNIT_CASE(transport_emergencies_beside_requests),
	KUNIT_CASE(transport_cycles_begin_and_end),
	KUNIT_CASE(transport_slave_lost_in_transfer),
	KUNIT_CASE(transport_slave_lost_beside_stalled_cycle),
	KUNIT_CASE(transport_full_ring_is_waited_for),
	KUNIT_CASE(transport_rests),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_transport",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
