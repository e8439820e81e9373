// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/if_arp.h>
#include <linux/rtnetlink.h>
#include "eoe_wire.h"
#include "master/mailbox/eoe.h"

const u8 eoe_slave_ip[4] = { 10, 1, 0, 2 }, eoe_host_ip[4] = { 10, 1, 0, 1 };
const u8 eoe_all[ETH_ALEN] = { 255, 255, 255, 255, 255, 255 };

static int take(struct sk_buff *skb, struct net_device *nd, struct packet_type *type,
		struct net_device *orig)
{
	struct eoe_wire *w = container_of(type, struct eoe_wire, type);

	/* those that are sent come as well */
	if (nd == w->nd && skb->pkt_type != PACKET_OUTGOING) {
		w->ethercat += skb->protocol == htons(EC_ETHERTYPE);
		skb_push(skb, ETH_HLEN);
		if (!ether_addr_equal(skb->data, nd->dev_addr)) {
			w->others++;
			goto free;
		}
		w->len = min_t(u32, skb->len, sizeof(w->last));
		skb_copy_bits(skb, 0, w->last, w->len);
		WRITE_ONCE(w->frames, w->frames + 1);
	}
free:
	kfree_skb(skb);
	return 0;
}

struct net_device *eoe_find(const char *name)
{
	struct net_device *nd = dev_get_by_name(&init_net, name);

	if (nd)
		dev_put(nd);
	return nd;
}

struct net_device *eoe_await(struct kunit *test, const char *name, bool there)
{
	u32 ms;

	for (ms = 0; !eoe_find(name) == there && ms < 5000; ms += 10)
		msleep(10);
	KUNIT_EXPECT_EQ_MSG(test, !!eoe_find(name), there, "%s", name);
	return eoe_find(name);
}

void eoe_set_up(struct net_device *nd, bool up)
{
	rtnl_lock();
	if (up)
		dev_open(nd, NULL);
	else
		dev_close(nd);
	rtnl_unlock();
}

bool eoe_await_carrier(struct net_device *nd, bool on)
{
	u32 ms;

	for (ms = 0; netif_carrier_ok(nd) != on && ms < 3000; ms += 5)
		msleep(5);
	return netif_carrier_ok(nd) == on;
}

/* those of the case, and those that a failed one has left */
static struct eoe_wire wires[8];
static u32 n_wires;

/* The device of a slave is up, and the slave has its address. */
struct eoe_wire *eoe_wire_new(struct bus *b, u32 position, const char *name)
{
	struct ec_eoe_ip ip = { .which = EC_EOE_IP | EC_EOE_MASK, .mask = { 255, 255, 255, 0 } };
	struct kunit *test = b->test;
	struct eoe_wire *w;
	u16 result;

	memcpy(ip.ip, eoe_slave_ip, 4);
	KUNIT_ASSERT_EQ(test, ec_eoe_set_ip(&bus_slave(b, position)->mbox, &ip, &result), 0);
	KUNIT_ASSERT_LT(test, n_wires, ARRAY_SIZE(wires));
	w = &wires[n_wires];
	*w = (struct eoe_wire){
		.b = b,
		.type = { .type = htons(ETH_P_ALL), .func = take },
		.nd = eoe_await(test, name, true),
	};
	KUNIT_ASSERT_NOT_NULL(test, w->nd);
	KUNIT_EXPECT_FALSE(test, netif_carrier_ok(w->nd));
	dev_add_pack(&w->type);
	n_wires++;
	eoe_set_up(w->nd, true);
	KUNIT_ASSERT_TRUE(test, eoe_await_carrier(w->nd, true));
	return w;
}

static void remove_wires(void)
{
	while (n_wires)
		dev_remove_pack(&wires[--n_wires].type);
}

/* A bus whose slave 1 has a device of this name. */
struct eoe_wire *eoe_up(struct kunit *test, const char *text, u32 slaves, const char *name)
{
	struct bus *b = bus_up(test, text, slaves);

	remove_wires();
	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	return eoe_wire_new(b, 1, name);
}

/* The end of all devices. */
void eoe_down(struct eoe_wire *w)
{
	remove_wires();
	ec_eoe_stop(bus_eoe(w->b));
}

void eoe_send(struct eoe_wire *w, const u8 *frame, u32 len)
{
	struct sk_buff *skb = alloc_skb(LL_MAX_HEADER + len, GFP_KERNEL);

	skb_reserve(skb, LL_MAX_HEADER);
	skb_put_data(skb, frame, len);
	skb->dev = w->nd;
	skb_reset_mac_header(skb);
	skb_set_network_header(skb, ETH_HLEN);
	skb->protocol = eth_hdr(skb)->h_proto;
	dev_queue_xmit(skb);
}

u32 eoe_header(struct eoe_wire *w, u8 *f, const u8 *to, u16 type)
{
	memcpy(f, to, ETH_ALEN);
	memcpy(f + ETH_ALEN, w->nd->dev_addr, ETH_ALEN);
	put_unaligned_be16(type, f + 2 * ETH_ALEN);
	return ETH_HLEN;
}

/* Ask for the address of the slave; false: no answer within a second. */
bool eoe_ask_address(struct eoe_wire *w, u8 *mac)
{
	u8 f[ETH_HLEN + 28] = { 0 }, *p = f + eoe_header(w, f, eoe_all, ETH_P_ARP);
	u32 ms, before = READ_ONCE(w->frames);

	put_unaligned_be16(ARPHRD_ETHER, p);
	put_unaligned_be16(ETH_P_IP, p + 2);
	p[4] = ETH_ALEN;
	p[5] = 4;
	put_unaligned_be16(ARPOP_REQUEST, p + 6);
	memcpy(p + 8, w->nd->dev_addr, ETH_ALEN);
	memcpy(p + 14, eoe_host_ip, 4);
	memcpy(p + 24, eoe_slave_ip, 4);
	eoe_send(w, f, sizeof(f));
	for (ms = 0; READ_ONCE(w->frames) == before && ms < 1000; ms++)
		msleep(1);
	if (w->frames == before || get_unaligned_be16(w->last + 12) != ETH_P_ARP ||
	    memcmp(w->last + ETH_HLEN + 14, eoe_slave_ip, 4))
		return false;
	memcpy(mac, w->last + ETH_ALEN, ETH_ALEN);
	return true;
}

static u16 checksum(const u8 *p, u32 len)
{
	u32 i, sum = 0;

	for (i = 0; i < len; i += 2)
		sum += p[i] << 8 | (i + 1 < len ? p[i + 1] : 0);
	sum = (sum & 0xffff) + (sum >> 16);
	return ~((sum & 0xffff) + (sum >> 16));
}

/* An ICMP echo request with @len bytes of data. */
void eoe_send_ping(struct eoe_wire *w, const u8 *mac, u32 len)
{
	u8 *f = kzalloc(EC_EOE_FRAME_MAX, GFP_KERNEL), *ip = f + eoe_header(w, f, mac, ETH_P_IP);
	u8 *icmp = ip + 20;
	u32 i;

	ip[0] = 0x45;
	put_unaligned_be16(28 + len, ip + 2);
	ip[8] = 64;
	ip[9] = 1;
	memcpy(ip + 12, eoe_host_ip, 4);
	memcpy(ip + 16, eoe_slave_ip, 4);
	put_unaligned_be16(checksum(ip, 20), ip + 10);
	icmp[0] = 8;
	for (i = 0; i < len; i++)
		icmp[8 + i] = i * 7 + len;
	put_unaligned_be16(checksum(icmp, 8 + len), icmp + 2);
	eoe_send(w, f, ETH_HLEN + 28 + len);
	kfree(f);
}

bool eoe_await_frames(struct eoe_wire *w, u32 n)
{
	u32 us;

	for (us = 0; READ_ONCE(w->frames) < n && us < 1000000; us += 50)
		usleep_range(50, 50);
	return w->frames >= n;
}

/* us until the whole answer, 0: none. */
u64 eoe_ping(struct eoe_wire *w, const u8 *mac, u32 len)
{
	u32 i, before = READ_ONCE(w->frames);
	u64 t0 = ktime_get_ns();

	eoe_send_ping(w, mac, len);
	if (!eoe_await_frames(w, before + 1))
		return 0;
	t0 = ktime_get_ns() - t0;
	KUNIT_EXPECT_EQ(w->b->test, w->len, max_t(u32, ETH_ZLEN, ETH_HLEN + 28 + len));
	KUNIT_EXPECT_EQ(w->b->test, w->last[ETH_HLEN + 20], 0);	/* echo reply */
	for (i = 0; i < len; i++)
		if (w->last[ETH_HLEN + 28 + i] != (u8)(i * 7 + len))
			break;
	KUNIT_EXPECT_EQ(w->b->test, i, len);
	return div_u64(t0, NSEC_PER_USEC);
}

