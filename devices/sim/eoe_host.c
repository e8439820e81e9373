// SPDX-License-Identifier: GPL-2.0-only
/* ARP, IPv4 and ICMP echo of a simulated slave; replies go where the frame came from. */
#include "eoe.h"

#define ARP_LEN		28
#define IP_HDR		20
#define ICMP_ECHO	8
#define PROTO_ICMP	1
#define PROTO_TCP	6

static const u8 broadcast[6] = { 0xff, 0xff, 0xff, 0xff, 0xff, 0xff };

/**
 * ec_app_eoe_eth() - write an Ethernet header
 * @app: slave, the source
 * @f: frame
 * @to: destination, NULL: all
 * @type: of the payload
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: place of the payload.
 */
u8 *ec_app_eoe_eth(struct ec_app *app, struct ec_app_eoe_frame *f, const u8 *to, u16 type)
{
	memcpy(f->data, to ? to : broadcast, 6);
	memcpy(f->data + 6, ec_app_eoe_mac(app), 6);
	ec_app_put_be16(f->data + 12, type);
	return f->data + EC_APP_ETH_HDR;
}

/**
 * ec_app_ip_sum() - checksum of the Internet protocols
 * @p: bytes
 * @len: how many
 * @sum: of what is not there, not folded
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the checksum, 0 when that of a message is right.
 */
u16 ec_app_ip_sum(const u8 *p, size_t len, u32 sum)
{
	size_t i;

	for (i = 0; i + 1 < len; i += 2)
		sum += ec_app_get_be16(p + i);
	if (i < len)
		sum += (u32)p[i] << 8;
	while (sum >> 16)
		sum = (sum & 0xffff) + (sum >> 16);
	return (u16)~sum;
}

/**
 * ec_app_eoe_ip() - write an IPv4 header
 * @app: slave, the source
 * @ip: place of it
 * @to: destination
 * @proto: of the payload
 * @len: bytes of the payload
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_ip(struct ec_app *app, u8 *ip, const u8 *to, u8 proto, u16 len)
{
	u8 dest[4];

	memcpy(dest, to, 4);	/* it may lie in the packet that is written */
	memset(ip, 0, IP_HDR);
	ip[0] = 0x45;
	ec_app_put_be16(ip + 2, (u16)(IP_HDR + len));
	ip[6] = 0x40;		/* do not fragment */
	ip[8] = 64;
	ip[9] = proto;
	memcpy(ip + 12, app->ip.now.ip, 4);
	memcpy(ip + 16, dest, 4);
	ec_app_put_be16(ip + 10, ec_app_ip_sum(ip, IP_HDR, 0));
}

static void put_arp(struct ec_app *app, u8 *arp, u16 op, const u8 *mac, const u8 *ip)
{
	memcpy(arp, "\0\1\x8\0\6\4", 6);
	ec_app_put_be16(arp + 6, op);
	memcpy(arp + 8, ec_app_eoe_mac(app), 6);
	memcpy(arp + 14, app->ip.now.ip, 4);
	memcpy(arp + 18, mac, 6);
	memcpy(arp + 24, ip, 4);
}

/**
 * ec_app_eoe_announce() - tell all stations the slave's addresses
 * @app: slave
 * @len: bytes of the frame, zeros behind the ARP
 * @due: when it is ready
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_announce(struct ec_app *app, u16 len, u64 due)
{
	struct ec_app_eoe_frame *f = ec_app_eoe_place(app);
	u8 *arp;

	if (!f)
		return;
	memset(f->data, 0, len);
	arp = ec_app_eoe_eth(app, f, NULL, EC_APP_ETH_ARP);
	put_arp(app, arp, 1, broadcast, app->ip.now.ip);
	ec_app_eoe_send(app, f, len, due);
}

static void arp_request(struct ec_app *app, const u8 *frame, u16 len, u64 due)
{
	const u8 *in = frame + EC_APP_ETH_HDR;
	struct ec_app_eoe_frame *f;

	if (len < EC_APP_ETH_HDR + ARP_LEN || memcmp(in, "\0\1\x8\0\6\4\0\1", 8) ||
	    memcmp(in + 24, app->ip.now.ip, 4))
		return;
	f = ec_app_eoe_place(app);
	if (!f)
		return;
	put_arp(app, ec_app_eoe_eth(app, f, in + 8, EC_APP_ETH_ARP), 2, in + 8, in + 14);
	ec_app_eoe_send(app, f, EC_APP_ETH_HDR + ARP_LEN, due);
}

/* @ip: header of @hdr bytes, and @len bytes of ICMP behind it */
static void icmp(struct ec_app *app, const u8 *frame, const u8 *ip, u16 hdr, u16 len, u64 due)
{
	const u8 *in = ip + hdr;
	struct ec_app_eoe_frame *f;
	u8 *out;

	if (len < 8 || in[0] != ICMP_ECHO || in[1] || ec_app_ip_sum(in, len, 0))
		return;
	f = ec_app_eoe_place(app);
	if (!f)
		return;
	out = ec_app_eoe_eth(app, f, frame + 6, EC_APP_ETH_IP);
	ec_app_eoe_ip(app, out, ip + 12, PROTO_ICMP, len);
	out += IP_HDR;
	memcpy(out, in, len);
	out[0] = 0;
	ec_app_put_be16(out + 2, 0);
	ec_app_put_be16(out + 2, ec_app_ip_sum(out, len, 0));
	ec_app_eoe_send(app, f, (u16)(EC_APP_ETH_HDR + IP_HDR + len), due);
}

/* Options of IP are skipped, parts of packets dropped. */
static void ip_packet(struct ec_app *app, const u8 *frame, u16 len, u64 now)
{
	const u8 *ip = frame + EC_APP_ETH_HDR;
	u16 left = (u16)(len - EC_APP_ETH_HDR), hdr, total;

	if (left < IP_HDR || ip[0] >> 4 != 4)
		return;
	hdr = (u16)((ip[0] & 0x0f) * 4);
	total = ec_app_get_be16(ip + 2);
	if (hdr < IP_HDR || total < hdr || total > left || ec_app_get_be16(ip + 6) & 0x3fff ||
	    memcmp(ip + 16, app->ip.now.ip, 4) || ec_app_ip_sum(ip, hdr, 0))
		return;
	if (ip[9] == PROTO_ICMP)
		icmp(app, frame, ip, hdr, (u16)(total - hdr), now + app->response_ns);
	else if (ip[9] == PROTO_TCP)
		ec_app_tcp(app, frame, ip, (u16)(total - hdr), now);
}

/**
 * ec_app_eoe_host() - a whole frame from the master
 * @app: slave
 * @frame: the frame, at least its header
 * @len: bytes of it
 * @now: time, ns
 *
 * Without an IP address there is no reply.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_host(struct ec_app *app, const u8 *frame, u16 len, u64 now)
{
	const u8 *mac = ec_app_eoe_mac(app);

	if (!(app->ip.now.which & EC_EOE_IP) ||
	    (memcmp(frame, mac, 6) && memcmp(frame, broadcast, 6)))
		return;
	if (ec_app_get_be16(frame + 12) == EC_APP_ETH_ARP)
		arp_request(app, frame, len, now + app->response_ns);
	else if (ec_app_get_be16(frame + 12) == EC_APP_ETH_IP && !memcmp(frame, mac, 6))
		ip_packet(app, frame, len, now);
}
