/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Servo drive profile over EtherCAT: header, read and write of an IDN (ETG.1000.6 clause 5.7). */
#ifndef EC_WIRE_SOE_H
#define EC_WIRE_SOE_H

#include "mbox.h"

#define EC_SOE_HDR	4
#define EC_SOE_DRIVES	8	/* the drive number has three bits */

enum ec_soe_opcode {
	EC_SOE_READ_REQ = 1,
	EC_SOE_READ_RESP = 2,
	EC_SOE_WRITE_REQ = 3,
	EC_SOE_WRITE_RESP = 4,
	EC_SOE_NOTIFICATION = 5,
	EC_SOE_EMERGENCY = 6,
};

/* bits of struct ec_soe_hdr.elements; data follow in this order */
#define EC_SOE_STATE		0x01	/* data state */
#define EC_SOE_NAME		0x02
#define EC_SOE_ATTRIBUTE	0x04
#define EC_SOE_UNIT		0x08
#define EC_SOE_MIN		0x10
#define EC_SOE_MAX		0x20
#define EC_SOE_VALUE		0x40
#define EC_SOE_DEFAULT		0x80

#define EC_SOE_ERR_NO_IDN	0x1001
#define EC_SOE_ERR_ELEMENT1	0x1009
#define EC_SOE_ERR_NAME_RO	0x2004
#define EC_SOE_ERR_ATTRIBUTE_RO	0x3004
#define EC_SOE_ERR_UNIT_RO	0x4004
#define EC_SOE_ERR_NO_MIN	0x5001
#define EC_SOE_ERR_MIN_RO	0x5004
#define EC_SOE_ERR_NO_MAX	0x6001
#define EC_SOE_ERR_MAX_RO	0x6004
#define EC_SOE_ERR_SHORT	0x7002
#define EC_SOE_ERR_LONG		0x7003
#define EC_SOE_ERR_READ_ONLY	0x7004
#define EC_SOE_ERR_PROTECTED	0x7005
#define EC_SOE_ERR_BELOW	0x7006
#define EC_SOE_ERR_ABOVE	0x7007
#define EC_SOE_ERR_NO_STATE	0x7014
#define EC_SOE_ERR_NO_DEFAULT	0x8001
#define EC_SOE_ERR_DEFAULT_RO	0x8004
#define EC_SOE_ERR_DRIVE	0x800A
#define EC_SOE_ERR_GENERAL	0x800B
#define EC_SOE_ERR_NO_ELEMENT	0x800C

/* attribute: bits 16-18 length, bits 28-30 write protection by AL state */
#define EC_SOE_ATTR_LEN2	0x00010000u
#define EC_SOE_ATTR_LEN4	0x00020000u
#define EC_SOE_ATTR_LEN8	0x00030000u
#define EC_SOE_ATTR_LIST1	0x00040000u
#define EC_SOE_ATTR_LIST2	0x00050000u
#define EC_SOE_ATTR_LIST4	0x00060000u
#define EC_SOE_ATTR_LIST8	0x00070000u
#define EC_SOE_ATTR_LEN_MASK	0x00070000u
#define EC_SOE_ATTR_RO_PREOP	0x10000000u
#define EC_SOE_ATTR_RO_SAFEOP	0x20000000u
#define EC_SOE_ATTR_RO_OP	0x40000000u
#define EC_SOE_ATTR_RO		0x70000000u

/**
 * struct ec_soe_hdr - SoE header, decoded
 * @opcode: enum ec_soe_opcode
 * @incomplete: more fragments follow; @idn is how many
 * @error: an error code is with the data
 * @drive: 0 to 7
 * @elements: EC_SOE_STATE...
 * @idn: bit 15: P, else S; bits 12-14 parameter set; bits 0-11 number
 */
struct ec_soe_hdr {
	u8 opcode;
	bool incomplete;
	bool error;
	u8 drive;
	u8 elements;
	u16 idn;
};

/**
 * struct ec_soe_access - reading or writing one element of an IDN
 * @write: write, not read
 * @drive: drive number
 * @element: one of EC_SOE_STATE...
 * @idn: number
 * @data: read: result; write: value
 * @cap: read: bytes at @data
 * @size: write: bytes to write; read: result, bytes read
 * @error: result: error code of the slave, 0: none
 */
struct ec_soe_access {
	bool write;
	u8 drive;
	u8 element;
	u16 idn;
	u8 *data;
	size_t cap;
	size_t size;
	u16 error;
};

int ec_soe_hdr_decode(struct ec_rbuf *r, struct ec_soe_hdr *h);
void ec_soe_hdr_encode(struct ec_wbuf *w, const struct ec_soe_hdr *h);
int ec_soe_tx(struct ec_soe_access *a, u8 *tx, size_t cap);
int ec_soe_rx(struct ec_soe_access *a, const u8 *rx, size_t len);
const char *ec_soe_error_text(u16 code);

#endif
