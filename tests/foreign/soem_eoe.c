// SPDX-License-Identifier: GPL-2.0-only
/*
 * A foreign master, SOEM, with Ethernet over EtherCAT: it gives simulated slaves their addresses,
 * asks for their hardware addresses by ARP, and sends them echo requests. It is linked with the
 * sources of SOEM that soem.sh downloads.
 */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "ethercat.h"

#define RECEIVE_US	500000
#define ETH_HDR		14
#define LONGEST		1514
#define ROOM		1536	/* SOEM wants whole units of 32 bytes */
#define READS_PACKED		3	/* this slave reads IP parameters as SOEM writes them */

static const uint8 own_mac[6] = { 2, 0, 0, 0, 0, 0x99 }, own_ip[4] = { 192, 168, 9, 1 };
static int passed, failed;

/* what SOEM has as globals in its other version */
static ecx_portt port;
static ec_slavet slave_list[EC_MAXSLAVE];
static int slave_count;
static ec_groupt groups[EC_MAXGROUP];
static uint8 esi_buf[EC_MAXEEPBUF];
static uint32 esi_map[EC_MAXEEPBITMAP];
static ec_eringt errors;
static ec_idxstackT stack;
static boolean error;
static int64 dc_time;
static ec_SMcommtypet sm_types[EC_MAX_MAPT];
static ec_PDOassignt assigns[EC_MAX_MAPT];
static ec_PDOdesct pdos[EC_MAX_MAPT];
static ec_eepromSMt eep_sm;
static ec_eepromFMMUt eep_fmmu;
static ecx_contextt master = {
	.port = &port, .slavelist = slave_list, .slavecount = &slave_count,
	.maxslave = EC_MAXSLAVE, .grouplist = groups, .maxgroup = EC_MAXGROUP,
	.esibuf = esi_buf, .esimap = esi_map, .elist = &errors, .idxstack = &stack,
	.ecaterror = &error, .DCtime = &dc_time, .SMcommtype = sm_types, .PDOassign = assigns,
	.PDOdesc = pdos, .eepSM = &eep_sm, .eepFMMU = &eep_fmmu,
};

static void ok(bool good, int slave, const char *what)
{
	printf("%s slave %d: %s\n", good ? "ok" : "not ok", slave, what);
	if (good)
		passed++;
	else
		failed++;
}

static void slave_ip(int slave, uint8 ip[4])
{
	memcpy(ip, own_ip, 4);
	ip[3] = (uint8)(100 + slave);
}

/* With the MAC address there is no gap: SOEM has no place for absent fields. */
static void addresses(int slave)
{
	eoe_param_t set = { .mac_set = 1, .ip_set = 1, .subnet_set = 1, .default_gateway_set = 1 };
	eoe_param_t got = { 0 };
	uint8 mac[6] = { 2, 0, 0, 0, 1, (uint8)slave };

	memcpy(set.mac.addr, mac, 6);
	EOE_IP4_ADDR_TO_U32(&set.ip, 192, 168, 9, (100 + slave));
	EOE_IP4_ADDR_TO_U32(&set.subnet, 255, 255, 255, 0);
	EOE_IP4_ADDR_TO_U32(&set.default_gateway, 192, 168, 9, 1);
	ok(ecx_EOEsetIp(&master, (uint16)slave, 0, &set, EC_TIMEOUTRXM) > 0, slave,
	   "takes addresses");
	ok(ecx_EOEgetIp(&master, (uint16)slave, 0, &got, EC_TIMEOUTRXM) > 0 &&
	   !memcmp(got.mac.addr, mac, 6) && got.ip.addr == set.ip.addr &&
	   got.subnet.addr == set.subnet.addr &&
	   got.default_gateway.addr == set.default_gateway.addr, slave, "reports them");
}

/* An address without a MAC address before it, which the slave keeps. */
static void gap(int slave)
{
	eoe_param_t set = { .ip_set = 1, .default_gateway_set = 1 }, got = { 0 };

	EOE_IP4_ADDR_TO_U32(&set.ip, 192, 168, 9, (100 + slave));
	EOE_IP4_ADDR_TO_U32(&set.default_gateway, 192, 168, 9, 77);
	ok(ecx_EOEsetIp(&master, (uint16)slave, 0, &set, EC_TIMEOUTRXM) > 0 &&
	   ecx_EOEgetIp(&master, (uint16)slave, 0, &got, EC_TIMEOUTRXM) > 0 &&
	   got.mac.addr[4] == 1 && got.mac.addr[5] == slave && got.ip.addr == set.ip.addr &&
	   got.default_gateway.addr == set.default_gateway.addr, slave,
	   "reads a request with a gap as SOEM means it");
}

/* The next frame for us; broadcasts of the slave are others. */
static int receive(int slave, uint8 *buf)
{
	for (int i = 0; i < 10; i++) {
		int size = ROOM;

		if (ecx_EOErecv(&master, (uint16)slave, 0, &size, buf, RECEIVE_US) <= 0)
			return -1;
		if (size >= ETH_HDR && !memcmp(buf, own_mac, 6))
			return size;
	}
	return -1;
}

static bool transmit(int slave, uint8 *buf, int size)
{
	return ecx_EOEsend(&master, (uint16)slave, 0, size, buf, EC_TIMEOUTRXM) > 0;
}

/* its hardware address */
static bool arp(int slave, uint8 mac[6])
{
	static const uint8 request[] = { 0, 1, 8, 0, 6, 4, 0, 1 };
	uint8 f[ROOM] = { 0 }, ip[4];

	slave_ip(slave, ip);
	memset(f, 0xff, 6);
	memcpy(f + 6, own_mac, 6);
	memcpy(f + 12, "\x08\x06", 2);
	memcpy(f + ETH_HDR, request, 8);
	memcpy(f + ETH_HDR + 8, own_mac, 6);
	memcpy(f + ETH_HDR + 14, own_ip, 4);
	memcpy(f + ETH_HDR + 24, ip, 4);
	if (!transmit(slave, f, 60) || receive(slave, f) < ETH_HDR + 28)
		return false;
	memcpy(mac, f + ETH_HDR + 8, 6);
	return !memcmp(f + 12, "\x08\x06", 2) && f[ETH_HDR + 7] == 2 &&
	       !memcmp(f + ETH_HDR + 14, ip, 4);
}

static uint16 sum(const uint8 *p, int len)
{
	uint32 s = 0;

	for (int i = 0; i < len; i += 2)
		s += (uint32)(p[i] << 8) + (i + 1 < len ? p[i + 1] : 0);
	while (s >> 16)
		s = (s & 0xffff) + (s >> 16);
	return (uint16)~s;
}

static void put_sum(uint8 *at, const uint8 *p, int len)
{
	uint16 s;

	memset(at, 0, 2);
	s = sum(p, len);
	at[0] = (uint8)(s >> 8);
	at[1] = (uint8)s;
}

/* echo request of a frame of @size bytes, and its reply */
static bool echo(int slave, const uint8 mac[6], int size)
{
	uint8 f[ROOM] = { 0 }, sent[ROOM], *ip = f + ETH_HDR, *icmp = ip + 20;
	int len = size - ETH_HDR, n;

	memcpy(f, mac, 6);
	memcpy(f + 6, own_mac, 6);
	memcpy(f + 12, "\x08\x00", 2);
	ip[0] = 0x45;
	ip[2] = (uint8)(len >> 8);
	ip[3] = (uint8)len;
	ip[8] = 64;
	ip[9] = 1;
	memcpy(ip + 12, own_ip, 4);
	slave_ip(slave, ip + 16);
	put_sum(ip + 10, ip, 20);
	icmp[0] = 8;
	for (int i = 4; i < len - 20; i++)
		icmp[i] = (uint8)(i * 7 + slave);
	put_sum(icmp + 2, icmp, len - 20);
	memcpy(sent, f, sizeof(sent));
	if (!transmit(slave, f, size))
		return false;
	n = receive(slave, f);
	return n >= size && !memcmp(f + 12, "\x08\x00", 2) && icmp[0] == 0 &&
	       !sum(ip, 20) && !sum(icmp, len - 20) &&
	       !memcmp(icmp + 4, sent + ETH_HDR + 24, (size_t)(len - 24));
}

int main(int argc, char **argv)
{
	static const int sizes[] = { 60, 200, 1000, LONGEST };
	static const char *const texts[] = {
		"answers an echo request of 60 bytes", "of 200 bytes", "of 1000 bytes", "of 1514 bytes",
	};
	int slaves;

	if (argc != 2 || !ecx_init(&master, argv[1])) {
		printf("no interface\n0 passed, 1 failed\n");
		return 1;
	}
	slaves = ecx_config_init(&master, FALSE);
	ecx_statecheck(&master, 0, EC_STATE_PRE_OP, EC_TIMEOUTSTATE);
	ok(slaves == 4, 0, "four slaves are found");
	for (int s = 2; s <= slaves; s++) {
		uint8 mac[6] = { 0 };

		ok(slave_list[s].mbx_proto & ECT_MBXPROT_EOE, s, "has EoE");
		addresses(s);
		if (s == READS_PACKED)
			gap(s);
		ok(arp(s, mac) && mac[4] == 1 && mac[5] == s, s,
		   "answers ARP with the MAC address that SOEM has set");
		for (unsigned int i = 0; i < sizeof(sizes) / sizeof(sizes[0]); i++)
			ok(echo(s, mac, sizes[i]), s, texts[i]);
	}
	ecx_close(&master);
	printf("%d passed, %d failed\n", passed, failed);
	return failed != 0;
}
