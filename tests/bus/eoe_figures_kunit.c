// SPDX-License-Identifier: GPL-2.0-only
/*
 * Figures of Ethernet through slaves, in bus time: pings that fill mailboxes in both directions,
 * one ping alone.
 */
#include <linux/kthread.h>
#include <linux/mm.h>
#include "cyc.h"
#include "eoe_wire.h"
#include "master/wire/frame.h"

#define RESPONSE_US	100	/* what the slave takes for a frame */
#define PERIOD_US	1000
#define MBOX		512
#define FRAGMENT	480	/* of a frame, in a mailbox of this size: a multiple of 32 */
#define FRAGMENTS	3
#define PINGS		300	/* of each slave */
#define WINDOW		8	/* on their way at once */
#define ALONE		100
#define DGRAM		12	/* bytes of a datagram beside its data */
#define HEADERS		(ETH_HLEN + 20 + 8)

/* what is reached today; the goals are in the rows */
#define IDLE_1		125	/* % */
#define IDLE_8		125
#define CYCLE_1		250	/* 1/100 of a cycle */
#define CYCLE_8		250
#define PING_MEAN	250
#define PING_WORST	300
#define DEVICES		60
#define MEMORY_KIB	40
#define OWN_BYTES	4096

/* who pings */
struct pinger {
	struct eoe_wire *w;
	u8 mac[ETH_ALEN];
	u32 answers;
	u64 sum_ns;
	u64 worst_ns;
	struct completion done;
};

/* Full mailboxes: @PINGS pings, @WINDOW at once. */
static int stream(void *arg)
{
	struct pinger *p = arg;
	u32 begin = READ_ONCE(p->w->frames), sent = 0, us = 0;

	while (p->answers < PINGS && us < 2000000) {
		for (; sent < PINGS && sent < p->answers + WINDOW; sent++)
			eoe_send_ping(p->w, p->mac, FRAGMENTS * FRAGMENT - HEADERS);
		usleep_range(10, 11);
		us = READ_ONCE(p->w->frames) - begin == p->answers ? us + 10 : 0;
		p->answers = READ_ONCE(p->w->frames) - begin;
	}
	complete(&p->done);
	return 0;
}

/* One fragment each way, at all phases of a cycle. */
static int ask_apart(void *arg)
{
	struct pinger *p = arg;
	u32 i;

	for (i = 0; i < ALONE; i++) {
		u64 t0, ns;
		u32 before = READ_ONCE(p->w->frames);

		usleep_range(7000 + 137 * i, 7001 + 137 * i);
		t0 = ktime_get_ns();
		eoe_send_ping(p->w, p->mac, 56);
		p->answers += eoe_await_frames(p->w, before + 1);
		ns = ktime_get_ns() - t0 - RESPONSE_US * NSEC_PER_USEC;
		p->sum_ns += ns;
		p->worst_ns = max(p->worst_ns, ns);
	}
	complete(&p->done);
	return 0;
}

/* @n slaves with their devices up, slave 0 has none. */
static struct pinger *pingers(struct kunit *test, u32 n)
{
	struct pinger *p = kunit_kcalloc(test, n, sizeof(*p), GFP_KERNEL);
	char text[160], name[IFNAMSIZ];
	struct bus *b;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, p);
	snprintf(text, sizeof(text), "segment seed=41 response=%uus transition=1ms\n"
		 "slave a drive in=8 out=8\nrepeat %u slave d drive in=8 out=8 mbox=%u eoe=host\n",
		 RESPONSE_US, n, MBOX);
	p[0].w = eoe_up(test, text, n + 1, "eoe0s1");
	b = p[0].w->b;
	for (i = 1; i < n; i++) {
		snprintf(name, sizeof(name), "eoe0s%u", i + 1);
		p[i].w = eoe_wire_new(b, i + 1, name);
	}
	for (i = 0; i < n; i++)
		KUNIT_ASSERT_TRUE(test, eoe_ask_address(p[i].w, p[i].mac));
	bus_idle(b);
	return p;
}

/* All at once, beside the cycle of @c if there is one; how long they take, ns. */
static u64 together(struct kunit *test, struct pinger *p, u32 n, int (*what)(void *),
		    struct cyc *c, u32 answers)
{
	u64 lost = bus_lost(p->w->b), t0 = ktime_get_ns(), ns;
	u32 i;

	for (i = 0; i < n; i++) {
		init_completion(&p[i].done);
		kthread_run(what, &p[i], "pinger%u", i);
	}
	for (i = 0; i < n; i++) {
		while (c && !completion_done(&p[i].done))
			cyc_run(c, 1);
		wait_for_completion(&p[i].done);
	}
	ns = ktime_get_ns() - t0;
	for (i = 0; i < n; i++)
		KUNIT_EXPECT_EQ_MSG(test, p[i].answers, answers, "slave %u", i + 1);
	KUNIT_EXPECT_EQ(test, bus_lost(p->w->b), lost);
	if (c)
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	return ns;
}

/*
 * The shortest time: the wire carries all mailboxes, those for the slaves and those of the slaves,
 * as many in a frame as it holds; what a slave takes for a frame passes meanwhile.
 */
static u64 shortest_ns(u32 slaves)
{
	u32 each = min(2u, slaves);

	return div_u64(2ull * PINGS * FRAGMENTS * slaves, each) *
	       ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + each * (MBOX + DGRAM));
}

static void idle(struct kunit *test, u32 n, u64 limit)
{
	struct pinger *p = pingers(test, n);
	u64 ns = together(test, p, n, stream, NULL, PINGS), best = shortest_ns(n);
	char text[100];

	bus_figure("EoE, %u pings of %u bytes through each of %u slave(s), mailboxes of %u bytes, idle: %llu ms, at best %llu ms: %llu Mbit/s each way",
		   PINGS, FRAGMENTS * FRAGMENT, n, MBOX, div_u64(ns, NSEC_PER_MSEC),
		   div_u64(best, NSEC_PER_MSEC),
		   div64_u64(8000ull * n * PINGS * FRAGMENTS * FRAGMENT, ns));
	snprintf(text, sizeof(text),
		 "%% of the shortest time: EoE both ways through %u slave(s), idle", n);
	bus_judge(test, div64_u64(ns * 100 + best - 1, best), 125, limit, text);
	eoe_down(p->w);
}

static void eoe_idle_1(struct kunit *test)
{
	idle(test, 1, IDLE_1);
}

static void eoe_idle_8(struct kunit *test)
{
	idle(test, 8, IDLE_8);
}

/* between receive and send: do replies of mailboxes wait until the process data have left? */
static void count_waiting(struct cyc *c)
{
	u64 *cycles = c->ctx;

	*cycles += ec_carry_has_landed(bus_carry(c->b));
}

static void beside_cycle(struct kunit *test, u32 n, u64 limit)
{
	struct pinger *p = pingers(test, n);
	struct cyc *c = cyc_in_op(p->w->b, 0, n + 1);
	u64 ns, waiting = 0;
	char text[100];

	c->ctx = &waiting;
	c->each = count_waiting;
	ns = together(test, p, n, stream, c, PINGS);
	KUNIT_EXPECT_GT(test, waiting, 2ull * PINGS);
	snprintf(text, sizeof(text),
		 "1/100 cycle of 1 ms: a full mailbox of EoE each way, %u slave(s)", n);
	bus_judge(test, div_u64(ns, PINGS * FRAGMENTS * PERIOD_US * 10), 250, limit, text);
	eoe_down(p->w);
}

static void eoe_cycle_1(struct kunit *test)
{
	beside_cycle(test, 1, CYCLE_1);
}

static void eoe_cycle_8(struct kunit *test)
{
	beside_cycle(test, 8, CYCLE_8);
}

static void eoe_ping_cycle(struct kunit *test)
{
	struct pinger *p = pingers(test, 1);
	struct cyc *c = cyc_in_op(p->w->b, 0, 2);

	together(test, p, 1, ask_apart, c, ALONE);
	bus_judge(test, div_u64(p->sum_ns, ALONE * PERIOD_US * 10), 250, PING_MEAN,
	      "1/100 cycle of 1 ms: ping by EoE, without the slave's time, mean");
	bus_judge(test, div_u64(p->worst_ns, PERIOD_US * 10), 300, PING_WORST,
	      "1/100 cycle of 1 ms: the same, worst");
	eoe_down(p->w);
}

static u64 used_bytes(void)
{
	struct sysinfo si;

	/* what waits for its end, and pages that a CPU keeps for itself, are free */
	rcu_barrier();
	drain_all_pages(NULL);
	si_meminfo(&si);
	return (u64)(si.totalram - si.freeram) << PAGE_SHIFT;
}

static netdev_tx_t plain_xmit(struct sk_buff *skb, struct net_device *nd)
{
	dev_kfree_skb(skb);
	return NETDEV_TX_OK;
}

static const struct net_device_ops plain_ops = { .ndo_start_xmit = plain_xmit };

/* What Linux needs for a network device that has nothing of its own, bytes. */
static u64 plain_memory(struct kunit *test)
{
	struct net_device *nd[DEVICES];
	u64 before = used_bytes(), bytes;
	u32 i;

	for (i = 0; i < DEVICES; i++) {
		nd[i] = alloc_netdev(0, "plain%d", NET_NAME_ENUM, ether_setup);
		KUNIT_ASSERT_NOT_NULL(test, nd[i]);
		nd[i]->netdev_ops = &plain_ops;
		KUNIT_ASSERT_EQ(test, register_netdev(nd[i]), 0);
	}
	msleep(500);
	bytes = used_bytes() - before;
	for (i = 0; i < DEVICES; i++) {
		unregister_netdev(nd[i]);
		free_netdev(nd[i]);
	}
	return div_u64(bytes, DEVICES);
}

/* Memory of the devices of slaves without traffic: those are down. */
static void eoe_memory(struct kunit *test)
{
	char text[120], name[IFNAMSIZ];
	u64 before, bytes, plain;
	struct bus *b;

	snprintf(text, sizeof(text), "segment seed=41\nrepeat %u slave d EL6614\n", DEVICES);
	b = bus_up(test, text, DEVICES);
	bus_idle(b);
	before = used_bytes();
	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	snprintf(name, sizeof(name), "eoe0s%u", DEVICES - 1);
	eoe_await(test, name, true);
	msleep(500);
	bytes = div_u64(used_bytes() - before, DEVICES);
	/* beside them: nothing that was freed is used again */
	plain = plain_memory(test);
	bus_figure("network device of EoE, down: %llu bytes, %zu of them the master's own; one that does nothing: %llu bytes",
		   bytes, sizeof(struct ec_eoe_netdev), plain);
	/* KASAN makes each allocation larger, and keeps back what was freed */
	bus_judge(test, div_u64(bytes, 1024), 4,
		  IS_ENABLED(CONFIG_KASAN) ? 4 * MEMORY_KIB : MEMORY_KIB,
		  "KiB of memory for the network device of a slave with EoE, without traffic");
	bus_judge(test, bytes - min(bytes, plain), 4096,
		  IS_ENABLED(CONFIG_KASAN) ? 4 * OWN_BYTES : OWN_BYTES,
		  "bytes of these, beyond those of a network device that does nothing");
	ec_eoe_stop(bus_eoe(b));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eoe_idle_1),
	KUNIT_CASE(eoe_idle_8),
	KUNIT_CASE(eoe_cycle_1),
	KUNIT_CASE(eoe_cycle_8),
	KUNIT_CASE(eoe_ping_cycle),
	KUNIT_CASE(eoe_memory),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_eoe_figures",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
