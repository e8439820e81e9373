// SPDX-License-Identifier: GPL-2.0-only
/* Rows of ETG.1500 class A that no other suite proves: tests/class-a/rows.txt. */
#include <linux/etherdevice.h>
#include <linux/if_arp.h>
#include <linux/netdevice.h>
#include <linux/notifier.h>
#include <linux/reboot.h>
#include <linux/rtnetlink.h>
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/mailbox/eoe.h"

/* frames ---------------------------------------------------------------------*/

#define N	5
#define OUT	1	/* device emulation */
#define CPU	2	/* has software for its AL states */
#define RISING	3	/* device emulation, behind a port that closes */

static const char segment[] =
	"segment seed=6 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave out EL2008\nslave cpu drive in=8 out=8\n"
	"slave rising EL2008\nslave last EL2008\n";

/* a device that reads the frames it sends: acknowledges by slave, requests to all, other types */
static struct {
	struct bus *b;
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	u32 frames, others, to_all, acks[N];
} watched;

static u16 station_of(u32 slave)
{
	return get_unaligned_le16(&bus_esc(watched.b, slave)->mem[EC_REG_STATION]);
}

/* Does the datagram address this slave? */
static bool addresses(const struct ec_dgram *d, u32 slave)
{
	switch (d->cmd) {
	case EC_CMD_BWR:
	case EC_CMD_BRW:
		return true;
	case EC_CMD_FPWR:
	case EC_CMD_FPRW:
		return d->adp == station_of(slave);
	case EC_CMD_APWR:
	case EC_CMD_APRW:
		return (u16)-d->adp == slave;
	}
	return false;
}

static void read_datagram(const struct ec_dgram *d)
{
	u32 i;

	if (d->ado > EC_REG_AL_CONTROL || d->ado + d->len <= EC_REG_AL_CONTROL)
		return;
	watched.to_all += d->cmd == EC_CMD_BWR;
	for (i = 0; i < N && d->data[EC_REG_AL_CONTROL - d->ado] & EC_AL_ERROR; i++)
		watched.acks[i] += addresses(d, i);
}

static int read_frame(void *priv, u8 *buf, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;

	watched.frames++;
	watched.others += get_unaligned_be16(buf + 2 * ETH_ALEN) != 0x88a4 ||
			  buf[EC_ETH_HDR + 1] >> 4 != 1;
	if (!ec_frame_iter_init(&it, buf + EC_ETH_HDR, len - EC_ETH_HDR))
		while (ec_frame_iter_next(&it, &d) == 1)
			read_datagram(&d);
	return watched.real->tx_send(priv, buf, len);
}

static void watch(struct bus *b)
{
	struct ecdev *dev = bus_dev(b);

	memset(&watched, 0, sizeof(watched));
	watched.b = b;
	watched.real = dev->ops;
	watched.ops = *dev->ops;
	watched.ops.tx_send = read_frame;
	dev->ops = &watched.ops;
}

static void watch_ends(struct bus *b)
{
	bus_dev(b)->ops = watched.real;
}

/* Each frame, from the first one on, has the EtherType 0x88A4: no VLAN tag, no UDP. */
static void etg1500_frame_has_ethertype(struct kunit *test)
{
	struct bus *b = bus_new(test, segment);

	bus_plug(b);
	watch(b);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
	cyc_run(cyc_in_op(b, 0, N), 100);
	KUNIT_EXPECT_GT(test, watched.frames, 200u);
	KUNIT_EXPECT_EQ(test, watched.others, 0u);
	watch_ends(b);
}

/* device emulation -----------------------------------------------------------*/

/* As another master leaves it: the slave copies AL control with the acknowledge. */
static void left_error(struct bus *b, u32 slave)
{
	u8 *mem = bus_esc(b, slave)->mem;

	mem[EC_REG_AL_CONTROL] |= EC_AL_ERROR;
	mem[EC_REG_AL_STATUS] = mem[EC_REG_AL_CONTROL];
}

static u8 al_status(struct bus *b, u32 slave)
{
	return bus_esc(b, slave)->mem[EC_REG_AL_STATUS];
}

static void expect_no_acks(struct kunit *test, const char *when)
{
	u32 i;

	for (i = 0; i < N; i++)
		if (i != CPU)
			KUNIT_EXPECT_EQ_MSG(test, watched.acks[i], 0u, "slave %u %s", i, when);
}

static void emulation_without_session(struct kunit *test, struct bus *b)
{
	u32 i;

	left_error(b, OUT);
	ec_app_al_fail(bus_app(b, "cpu"), EC_AL_INIT, 0x001b, ktime_get_ns());
	for (i = 0; i < 1000 && (al_status(b, OUT) != EC_AL_PREOP ||
				 al_status(b, CPU) != EC_AL_PREOP); i++)
		msleep(1);
	KUNIT_EXPECT_EQ(test, al_status(b, OUT), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, al_status(b, CPU), EC_AL_PREOP);
	/* the other one needs it */
	KUNIT_EXPECT_GT(test, watched.acks[CPU], 0u);
	expect_no_acks(test, "in PREOP");
}

/* As soon as it has power. */
static void error_at_power_on(struct cyc *c)
{
	if (al_status(c->b, RISING) != EC_AL_INIT)
		return;
	left_error(c->b, RISING);
	c->each = NULL;
}

static void emulation_in_op(struct kunit *test, struct cyc *c)
{
	left_error(c->b, OUT);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, al_status(c->b, OUT), EC_AL_OP);
	expect_no_acks(test, "in OP");
	/* one that connects while process data run has such an error, too */
	bus_fault(c->b, EC_SIM_FAULT_POWER_OFF, RISING, 0, 0, 0);
	cyc_run(c, 500);
	bus_fault(c->b, EC_SIM_FAULT_POWER_ON, RISING, 0, 0, 0);
	c->each = error_at_power_on;
	cyc_run(c, 50);
	KUNIT_EXPECT_NULL(test, c->each);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, al_status(c->b, RISING), EC_AL_OP);
	expect_no_acks(test, "after power-on");
}

/* A slave that is too slow for PREOP makes the reboot request INIT from all. */
static void emulation_at_reboot(struct kunit *test, struct bus *b)
{
	u32 i, before = watched.to_all;

	bus_app(b, "cpu")->transition_ns = 4000 * (u32)NSEC_PER_MSEC;
	blocking_notifier_call_chain(&reboot_notifier_list, SYS_RESTART, NULL);
	KUNIT_EXPECT_GT(test, watched.to_all, before);
	for (i = 0; i < N; i++)
		if (i != CPU)
			KUNIT_EXPECT_FALSE_MSG(test, al_status(b, i) &
					       (EC_AL_BEYOND_PREOP | EC_AL_ERROR), "slave %u", i);
	expect_no_acks(test, "at the reboot");
}

/*
 * A slave with device emulation copies AL control to AL status, so that it would show the
 * acknowledge as an error. No frame has one for it: not for an error that another master has left
 * there, not in a broadcast, not when it connects beside process data, not at a reboot.
 */
static void etg1500_emulation_gets_no_acknowledge(struct kunit *test)
{
	struct bus *b = bus_up(test, segment, N);
	struct cyc *c;

	watch(b);
	bus_idle(b);
	emulation_without_session(test, b);
	c = cyc_in_op(b, 0, N);
	emulation_in_op(test, c);
	emulation_at_reboot(test, b);
	watch_ends(b);
}

/* virtual switch -------------------------------------------------------------*/

/* as a bridge does it: each frame of a port goes to the other one, as it is */
static rx_handler_result_t forward(struct sk_buff **pskb)
{
	struct sk_buff *skb = *pskb;

	skb->dev = rcu_dereference(skb->dev->rx_handler_data);
	skb_push(skb, ETH_HLEN);
	dev_queue_xmit(skb);
	return RX_HANDLER_CONSUMED;
}

static struct net_device *port(struct kunit *test, const char *name)
{
	struct net_device *nd = NULL;
	u32 i;

	for (i = 0; !nd && i < 500; i++) {
		nd = dev_get_by_name(&init_net, name);
		msleep(10);
	}
	KUNIT_ASSERT_NOT_NULL_MSG(test, nd, "%s", name);
	dev_put(nd);
	rtnl_lock();
	dev_open(nd, NULL);
	dev_set_promiscuity(nd, 1);
	rtnl_unlock();
	for (i = 0; !netif_carrier_ok(nd) && i < 300; i++)
		msleep(10);
	KUNIT_EXPECT_TRUE(test, netif_carrier_ok(nd));
	return nd;
}

/* A computer at the Ethernet port of one slave asks for the address of the other one. */
static void arp_of_computer(u8 *f)
{
	static const u8 mac[] = { 0x02, 0xaa, 0, 0, 0, 1 };
	u8 *p = f + ETH_HLEN;

	eth_broadcast_addr(f);
	memcpy(f + ETH_ALEN, mac, ETH_ALEN);
	put_unaligned_be16(ETH_P_ARP, f + 2 * ETH_ALEN);
	put_unaligned_be16(ARPHRD_ETHER, p);
	put_unaligned_be16(ETH_P_IP, p + 2);
	p[4] = ETH_ALEN;
	p[5] = 4;
	put_unaligned_be16(ARPOP_REQUEST, p + 6);
	memcpy(p + 8, mac, ETH_ALEN);
	memcpy(p + 14, (u8[]){ 10, 1, 0, 7 }, 4);
	memcpy(p + 24, (u8[]){ 10, 1, 0, 2 }, 4);
}

/*
 * Network devices of slaves are ports of a switch: a frame of a computer behind one slave reaches
 * the other slave, and the reply, which is for none of the devices, the computer.
 */
static void etg1500_switch_joins_slaves(struct kunit *test)
{
	struct ec_eoe_ip ip = {
		.which = EC_EOE_IP | EC_EOE_MASK, .ip = { 10, 1, 0, 2 }, .mask = { 255, 255, 255 },
	};
	struct bus *b = bus_up(test, "segment seed=5\nslave sw EL6614 alias=5 eoe=switch\n"
			       "slave web EL6614 alias=6 eoe=host\n", 2);
	u8 f[60] = { 0 }, *reply = kunit_kzalloc(test, EC_EOE_FRAME_MAX, GFP_KERNEL);
	struct net_device *nd[2];
	u32 i, len = 0;
	u16 result;

	KUNIT_ASSERT_EQ(test, ec_eoe_set_ip(&bus_slave(b, 1)->mbox, &ip, &result), 0);
	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	nd[0] = port(test, "eoe0a5");
	nd[1] = port(test, "eoe0a6");
	rtnl_lock();
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_EQ(test, netdev_rx_handler_register(nd[i], forward, nd[!i]), 0);
	rtnl_unlock();
	arp_of_computer(f);
	ec_app_eoe_enter(bus_app(b, "sw"), f, sizeof(f), ktime_get_ns());
	for (i = 0; !len && i < 1000; i++) {
		msleep(1);
		len = ec_app_eoe_leave(bus_app(b, "sw"), reply);
	}
	KUNIT_EXPECT_EQ(test, len, 60u);
	KUNIT_EXPECT_MEMEQ(test, reply, f + ETH_ALEN, ETH_ALEN);
	KUNIT_EXPECT_EQ(test, get_unaligned_be16(reply + ETH_HLEN + 6), ARPOP_REPLY);
	KUNIT_EXPECT_MEMEQ(test, reply + ETH_HLEN + 14, ip.ip, 4);
	rtnl_lock();
	for (i = 0; i < 2; i++)
		netdev_rx_handler_unregister(nd[i]);
	rtnl_unlock();
	ec_eoe_stop(bus_eoe(b));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(etg1500_frame_has_ethertype),
	KUNIT_CASE(etg1500_emulation_gets_no_acknowledge),
	KUNIT_CASE(etg1500_switch_joins_slaves),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_etg1500",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
