/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Ethernet over EtherCAT: IP parameters (ETG.1000.6 clause 5.7). */
#ifndef EC_WIRE_EOE_H
#define EC_WIRE_EOE_H

#include "mbox.h"

#define EC_EOE_HDR		4
#define EC_EOE_NAME		32
#define EC_EOE_IP_SIZE		(EC_EOE_HDR + 58)

enum ec_eoe_type {
	EC_EOE_FRAGMENT = 0,
	EC_EOE_TIME_RESP = 1,
	EC_EOE_SET_IP_REQ = 2,
	EC_EOE_SET_IP_RESP = 3,
	EC_EOE_SET_FILTER_REQ = 4,
	EC_EOE_SET_FILTER_RESP = 5,
	EC_EOE_GET_IP_REQ = 6,
	EC_EOE_GET_IP_RESP = 7,
};

#define EC_EOE_OK		0x0000
#define EC_EOE_UNSPECIFIED	0x0001
#define EC_EOE_NO_TYPE		0x0002
#define EC_EOE_NO_IP		0x0201
#define EC_EOE_NO_DHCP		0x0202
#define EC_EOE_NO_FILTER	0x0401

/* struct ec_eoe_ip.which */
#define EC_EOE_MAC		0x01
#define EC_EOE_IP		0x02
#define EC_EOE_MASK		0x04
#define EC_EOE_GATEWAY		0x08
#define EC_EOE_DNS		0x10
#define EC_EOE_HOSTNAME		0x20
#define EC_EOE_ALL		0x3f

/**
 * struct ec_eoe_ip - IP parameters, laid out as struct ec_ip_params; addresses in network order
 * @which: EC_EOE_MAC..., those of the rest that count
 * @mac: MAC address
 * @reserved: 0
 * @ip: IPv4 address
 * @mask: of the subnet
 * @gateway: default gateway
 * @dns: server
 * @name: of the host, ends with 0 when it is shorter
 */
struct ec_eoe_ip {
	u32 which;
	u8 mac[6];
	u8 reserved[2];
	u8 ip[4];
	u8 mask[4];
	u8 gateway[4];
	u8 dns[4];
	u8 name[EC_EOE_NAME];
};

int ec_eoe_type_decode(const u8 *rx, size_t len);
int ec_eoe_ip_encode(u8 *tx, size_t cap, u8 type, const struct ec_eoe_ip *p);
int ec_eoe_ip_decode(const u8 *rx, size_t len, struct ec_eoe_ip *p);
int ec_eoe_ip_encode_packed(u8 *tx, size_t cap, u8 type, const struct ec_eoe_ip *p);
int ec_eoe_ip_decode_packed(const u8 *rx, size_t len, struct ec_eoe_ip *p);
bool ec_eoe_ip_fill(struct ec_eoe_ip *p, const struct ec_eoe_ip *now, const u8 mac[6]);
bool ec_eoe_ip_same(const struct ec_eoe_ip *a, const struct ec_eoe_ip *b, u32 which);
int ec_eoe_result_encode(u8 *tx, size_t cap, u8 type, u16 result);
int ec_eoe_result_decode(const u8 *rx, size_t len, u8 type, u16 *result);
const char *ec_eoe_result_text(u16 result);

#endif
