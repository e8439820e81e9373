// SPDX-License-Identifier: GPL-2.0-only
/*
 * Ethernet frames with EtherCAT in them: direct, behind a VLAN tag, in UDP. A
 * slave controller goes by what it needs to find its datagrams and by nothing
 * else: it reads no tag, no address, no checksum, no length of IP or UDP.
 */
#include "esc_int.h"

#define VLAN_TYPE	0x8100
#define VLAN_TAG	4
#define IP_TYPE		0x0800
#define IP_HDR		20
#define IP_FIRST	0x45	/* version 4, a header of five words */
#define IP_PROTOCOL	9
#define IP_UDP		17
#define UDP_HDR		8
#define UDP_DEST	2
#define UDP_CHECKSUM	6

static u16 be16(const u8 *p)
{
	return (u16)(p[0] << 8 | p[1]);
}

/* where the EtherCAT header is; @ip: gets the place of the IP header, 0: none */
static size_t find(const u8 *eth, size_t len, size_t *ip)
{
	size_t at = EC_ETH_HDR;
	const u8 *p;

	*ip = 0;
	if (len >= at + VLAN_TAG && be16(eth + at - 2) == VLAN_TYPE)
		at += VLAN_TAG;
	if (len < at + EC_FRAME_HDR)
		return 0;
	if (be16(eth + at - 2) == EC_ETHERTYPE)
		return at;
	p = eth + at;
	if (be16(p - 2) != IP_TYPE || len < at + IP_HDR + UDP_HDR + EC_FRAME_HDR ||
	    p[0] != IP_FIRST || p[IP_PROTOCOL] != IP_UDP ||
	    be16(p + IP_HDR + UDP_DEST) != EC_ETHERTYPE)
		return 0;
	*ip = at;
	return at + IP_HDR + UDP_HDR;
}

/**
 * ec_sim_eth_is_ethercat() - does a slave controller process this frame
 * @eth: Ethernet frame, its first EC_SIM_ETH_HEAD bytes are enough
 * @len: bytes at @eth
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it does.
 */
bool ec_sim_eth_is_ethercat(const u8 *eth, size_t len)
{
	size_t ip;

	return find(eth, len, &ip);
}

/* what a slave that processed the frame changed outside of its EtherCAT part */
void ec_sim_eth_mark(const struct ec_sim *sim, struct ec_sim_flight *fl)
{
	if (!fl->res.processed)
		return;
	fl->eth[6] |= 2;
	if (fl->ip && sim->bug != EC_SIM_BUG_UDP_CHECKSUM)
		memset(fl->eth + fl->ip + IP_HDR + UDP_CHECKSUM, 0, 2);
}

/**
 * ec_sim_send() - send one Ethernet frame into the segment
 * @sim: segment
 * @fl: state of the frame; belongs to the model until @fl->done
 * @port: master port at which it is sent, 0 or 1
 * @eth: Ethernet frame, stays the model's as long as @fl; see ec_sim_eth()
 * @len: bytes at @eth, padding included, without FCS
 * @now_ns: when the first bit is sent
 *
 * Mostly the fate of a frame is known at once. It is on its way while a port may change
 * before it is back: then ec_sim_advance() takes it on, step by step at the times of
 * ec_sim_next_step(), together with all that happens in between.
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 */
void ec_sim_send(struct ec_sim *sim, struct ec_sim_flight *fl, int port, u8 *eth, size_t len,
		 u64 now_ns)
{
	size_t ip, at = find(eth, len, &ip);

	ec_sim_flight_init(fl, eth, eth + at, len - at, len);
	fl->ip = ip;
	fl->mport = port;
	if (at)
		ec_sim_start(sim, fl, port, now_ns);
	else
		ec_sim_lose(sim, fl);
}

/**
 * ec_sim_eth() - pass one Ethernet frame through the segment and back
 * @sim: segment
 * @port: master port at which it is sent, 0 or 1
 * @eth: Ethernet frame, modified in place: a slave that processes it marks the
 *	source address and clears the UDP checksum
 * @len: bytes at @eth, padding included, without FCS
 * @now_ns: when the first bit is sent
 * @res: what became of it
 *
 * A frame without EtherCAT does not come back: the slaves destroy it.
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_eth(struct ec_sim *sim, int port, u8 *eth, size_t len, u64 now_ns,
	       struct ec_sim_result *res)
{
	struct ec_sim_flight fl;

	ec_sim_send(sim, &fl, port, eth, len, now_ns);
	ec_sim_finish(sim, &fl);
	*res = fl.res;
	return res->delay_ns;
}
