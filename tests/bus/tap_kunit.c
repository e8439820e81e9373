// SPDX-License-Identifier: GPL-2.0-only
/*
 * A capture program gets its frames through a ring which the cycle fills. When nothing
 * empties it, frames are dropped and counted, and the cycle does not notice.
 */
#include <linux/net.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include "cyc.h"
#include "master/link/capture.h"
#include "master/boundary/ioctl.h"

static const char text[] = "segment seed=4\nrepeat 3 slave d drive in=8 out=8\n";

/**
 * struct program - a capture program at the interface of the master
 * @pt: its entry in the list of the protocol stack
 * @sent: frames of the master it got
 * @received: frames that came back
 * @bad: these had no EtherCAT header or no time
 */
struct program {
	struct packet_type pt;
	u32 sent;
	u32 received;
	u32 bad;
};

static int get(struct sk_buff *skb, struct net_device *nd, struct packet_type *pt,
	       struct net_device *orig)
{
	struct program *p = container_of(pt, struct program, pt);

	if (skb->pkt_type == PACKET_OUTGOING)
		p->sent++;
	else
		p->received++;
	p->bad += skb->protocol != htons(0x88a4) || !skb->tstamp;
	consume_skb(skb);
	return NET_RX_SUCCESS;
}

static struct cyc *captured(struct kunit *test, struct program *p)
{
	struct bus *b = bus_new(test, text);
	struct cyc *c;
	int ret;

	ec_capture = true;
	ret = ec_capture_create(bus_links(b));
	ec_capture = false;
	KUNIT_ASSERT_EQ(test, ret, 0);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 3, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	rtnl_lock();
	ret = dev_open(bus_capture_dev(b), NULL);
	rtnl_unlock();
	KUNIT_ASSERT_EQ(test, ret, 0);
	*p = (struct program){ .pt = {
		.type = htons(ETH_P_ALL), .dev = bus_capture_dev(b), .func = get,
	} };
	dev_add_pack(&p->pt);
	return c;
}

/* A work that counts as queued is not queued again: so the worker does not run. */
static void hold_worker(struct ec_tap *t)
{
	flush_delayed_work(&t->work);
	cancel_delayed_work_sync(&t->work);
	set_bit(WORK_STRUCT_PENDING_BIT, work_data_bits(&t->work.work));
}

static void release_worker(struct ec_tap *t)
{
	clear_bit(WORK_STRUCT_PENDING_BIT, work_data_bits(&t->work.work));
	queue_delayed_work(system_unbound_wq, &t->work, 0);
	flush_delayed_work(&t->work);
}

static u32 not_captured(struct bus *b)
{
	struct ec_ioc_master i = { 0 };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_MASTER, &i), 0);
	return i.not_captured;
}

static u64 tx_errors(struct bus *b)
{
	return bus_tx_errors(b);
}

/* With a worker that runs, the program gets every frame, sent and received. */
static void tap_worker_runs_all_captured(struct kunit *test)
{
	struct program p;
	struct cyc *c = captured(test, &p);
	u64 frames = bus_frames(c->b);

	cyc_run(c, 1000);
	flush_delayed_work(&bus_tap(c->b)->work);
	frames = bus_frames(c->b) - frames;
	dev_remove_pack(&p.pt);
	KUNIT_EXPECT_EQ(test, p.bad, 0u);
	KUNIT_EXPECT_GE(test, p.sent, 1000u);
	KUNIT_EXPECT_LE(test, abs((s32)(p.sent - frames)), 2);
	/* some are on their way at the beginning and at the end */
	bus_figure("capture: %u of %llu frames sent and %u received", p.sent, frames, p.received);
	KUNIT_EXPECT_LE(test, abs((s32)(p.received - p.sent)), 5);
	KUNIT_EXPECT_EQ(test, not_captured(c->b), 0u);
	cyc_release(c);
}

/* The worker does not run: the ring fills, the rest is counted, process data are complete. */
static void tap_ring_full_drops_and_counts(struct kunit *test)
{
	struct program p;
	struct cyc *c = captured(test, &p);
	struct ec_tap *t = bus_tap(c->b);
	struct rtnl_link_stats64 stats;
	u64 frames, incomplete, errors;
	u32 dropped, had;

	cyc_run(c, 10);
	hold_worker(t);
	had = p.sent + p.received;
	frames = bus_frames(c->b);
	incomplete = c->incomplete;
	errors = tx_errors(c->b);
	cyc_run(c, 2000);
	frames = bus_frames(c->b) - frames;
	dropped = not_captured(c->b);
	bus_figure("capture with a worker that is held: %u of %llu copies dropped", dropped,
		   2 * frames);
	/* a frame has two copies: as it is sent and as it comes back */
	KUNIT_EXPECT_GE(test, frames, 2000ull);
	KUNIT_EXPECT_LE(test, abs((s32)(dropped - (2 * frames - EC_TAP_RING))), 4);
	KUNIT_EXPECT_EQ(test, p.sent + p.received, had);
	/* the cycle has not noticed */
	KUNIT_EXPECT_EQ(test, c->incomplete, incomplete);
	KUNIT_EXPECT_EQ(test, tx_errors(c->b), errors);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	/* what the interface counts is the same */
	dev_get_stats(bus_capture_dev(c->b), &stats);
	KUNIT_EXPECT_EQ(test, stats.rx_dropped, (u64)dropped);
	/* the ring is whole: all it has is shown, and then no frame is dropped any more */
	release_worker(t);
	KUNIT_EXPECT_EQ(test, p.sent + p.received - had, (u32)EC_TAP_RING);
	cyc_run(c, 510);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_EQ(test, not_captured(c->b), dropped);
	KUNIT_EXPECT_GE(test, p.sent + p.received - had, EC_TAP_RING + 1000u);
	KUNIT_EXPECT_EQ(test, p.bad, 0u);
	dev_remove_pack(&p.pt);
	cyc_release(c);
}

/* Without a program nothing is copied, so nothing is dropped either. */
static void tap_without_program_not_used(struct kunit *test)
{
	struct program p;
	struct cyc *c = captured(test, &p);
	struct ec_tap *t = bus_tap(c->b);
	u32 head;

	dev_remove_pack(&p.pt);
	hold_worker(t);
	head = t->head;
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, t->head, head);
	KUNIT_EXPECT_EQ(test, not_captured(c->b), 0u);
	release_worker(t);
	cyc_release(c);
}

/*
 * A socket of another namespace is a handler for all devices, and so is this one: nothing is copied
 * for it until there is a packet socket in the namespace of the interface.
 */
static void tap_other_namespace_not_used(struct kunit *test)
{
	struct program p, other = { .pt = { .type = htons(ETH_P_ALL), .func = get } };
	struct cyc *c = captured(test, &p);
	struct ec_tap *t = bus_tap(c->b);
	struct socket *own;
	u32 head;

	dev_remove_pack(&p.pt);
	dev_add_pack(&other.pt);
	hold_worker(t);
	head = t->head;
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, t->head, head);
	release_worker(t);
	KUNIT_ASSERT_EQ(test, sock_create_kern(&init_net, AF_PACKET, SOCK_RAW, htons(ETH_P_ALL),
					       &own), 0);
	cyc_run(c, 100);
	KUNIT_EXPECT_GE(test, t->head, head + 200);
	sock_release(own);
	dev_remove_pack(&other.pt);
	cyc_release(c);
}

/* The worker looks as long as a program captures, and no longer. */
static void tap_worker_ends_with_program(struct kunit *test)
{
	struct program p;
	struct cyc *c = captured(test, &p);
	struct ec_tap *t = bus_tap(c->b);

	cyc_run(c, 100);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_TRUE(test, t->awake);
	KUNIT_EXPECT_TRUE(test, delayed_work_pending(&t->work));
	dev_remove_pack(&p.pt);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_FALSE(test, t->awake);
	KUNIT_EXPECT_FALSE(test, delayed_work_pending(&t->work));
	KUNIT_EXPECT_EQ(test, t->head, READ_ONCE(t->tail));
	/* the next one wakes it */
	dev_add_pack(&p.pt);
	cyc_run(c, 100);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_GE(test, p.sent, 200u);
	dev_remove_pack(&p.pt);
	cyc_release(c);
}

/* What cannot leave is not shown as sent. */
static void tap_without_link_shows_nothing(struct kunit *test)
{
	struct program p;
	struct cyc *c = captured(test, &p);
	struct ec_tap *t = bus_tap(c->b);
	u32 sent;

	cyc_run(c, 10);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_GE(test, p.sent, 10u);
	bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	flush_delayed_work(&t->work);
	sent = p.sent;
	cyc_run(c, 100);
	flush_delayed_work(&t->work);
	KUNIT_EXPECT_EQ(test, p.sent, sent);
	dev_remove_pack(&p.pt);
	cyc_release(c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(tap_worker_runs_all_captured),
	KUNIT_CASE(tap_ring_full_drops_and_counts),
	KUNIT_CASE(tap_without_program_not_used),
	KUNIT_CASE(tap_other_namespace_not_used),
	KUNIT_CASE(tap_worker_ends_with_program),
	KUNIT_CASE(tap_without_link_shows_nothing),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_tap",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
