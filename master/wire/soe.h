/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * Servo drive profile over EtherCAT: header, read and write of elements of an IDN in one message or
 * in fragments (ETG.1000.6 clause 5.7), state of procedure commands.
 */
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

#define EC_SOE_LIST_HDR		4	/* of lists and texts: length, largest length, bytes */

/* IDNs of a drive in error */
#define EC_SOE_IDN_ERROR	11	/* class 1 diagnostic: one bit for each kind, 0: no error */
#define EC_SOE_IDN_ERROR_TEXT	95	/* diagnostic message */
#define EC_SOE_IDN_ERROR_NUMBER	390	/* diagnostic number, which not each drive has */

/* attribute of an IDN */
#define EC_SOE_ATTR_LEN		0x00070000u	/* 1: 2 bytes, 2: 4, 3: 8, from 4 on: lists */
#define EC_SOE_ATTR_LIST	0x00040000u
#define EC_SOE_ATTR_COMMAND	0x00080000u	/* the IDN is a procedure command */
#define EC_SOE_ATTR_PREOP	0x10000000u	/* write protected in PREOP */
#define EC_SOE_ATTR_SAFEOP	0x20000000u
#define EC_SOE_ATTR_OP		0x40000000u

/* value of a procedure command, and the same bits in its data state */
#define EC_SOE_COMMAND_SET	0x01
#define EC_SOE_COMMAND_ENABLE	0x02
/* more bits of its data state */
#define EC_SOE_COMMAND_BUSY	0x04
#define EC_SOE_COMMAND_ERROR	0x08

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
 * struct ec_soe_access - reading or writing elements of an IDN
 * @write: write, not read
 * @drive: drive number
 * @elements: EC_SOE_STATE...
 * @idn: number
 * @data: read: result; write: what to write
 * @cap: read: bytes at @data
 * @size: write: bytes to write; read: result, bytes read
 * @error: result: error code of the slave, 0: none
 * @at: write: bytes sent; read: bytes received, of a wrong answer also those that were dropped
 * @left: fragments that follow the present one
 * @begun: the present one is not the first
 * @wrong: read: -errno of an answer whose remaining fragments are dropped; 0: right so far
 */
struct ec_soe_access {
	bool write;
	u8 drive;
	u8 elements;
	u16 idn;
	u8 *data;
	size_t cap;
	size_t size;
	u16 error;
	size_t at;
	u16 left;
	bool begun;
	int wrong;
};

/* Does the message of ec_soe_tx() have an answer? One that fragments follow has none. */
static inline bool ec_soe_awaits(const struct ec_soe_access *a)
{
	return !a->write || !a->left;
}

int ec_soe_hdr_decode(struct ec_rbuf *r, struct ec_soe_hdr *h);
void ec_soe_hdr_encode(struct ec_wbuf *w, const struct ec_soe_hdr *h);
int ec_soe_tx(struct ec_soe_access *a, u8 *tx, size_t cap);
int ec_soe_rx(struct ec_soe_access *a, const u8 *rx, size_t len);
bool ec_soe_is_unasked(const u8 *rx, size_t len);
const char *ec_soe_error_text(u16 code);
const char *ec_soe_command_text(u16 state);

#endif
