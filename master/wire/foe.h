/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* File access over EtherCAT: messages, and the master's side of a transfer (ETG.1000.6 5.8). */
#ifndef EC_WIRE_FOE_H
#define EC_WIRE_FOE_H

#include "mbox.h"

#define EC_FOE_HDR		6
#define EC_FOE_TEXT		64	/* of an error that are kept, with the zero */

enum ec_foe_opcode {
	EC_FOE_RRQ = 1,
	EC_FOE_WRQ = 2,
	EC_FOE_DATA = 3,
	EC_FOE_ACK = 4,
	EC_FOE_ERR = 5,
	EC_FOE_BUSY = 6,
};

enum ec_foe_error {
	EC_FOE_ERR_UNDEFINED = 0x8000,
	EC_FOE_ERR_NOT_FOUND = 0x8001,
	EC_FOE_ERR_DENIED = 0x8002,
	EC_FOE_ERR_FULL = 0x8003,
	EC_FOE_ERR_ILLEGAL = 0x8004,
	EC_FOE_ERR_PACKET = 0x8005,
	EC_FOE_ERR_EXISTS = 0x8006,
	EC_FOE_ERR_NO_USER = 0x8007,
	EC_FOE_ERR_BOOT_ONLY = 0x8008,
	EC_FOE_ERR_NOT_BOOT = 0x8009,
	EC_FOE_ERR_NO_RIGHTS = 0x800a,
	EC_FOE_ERR_PROGRAM = 0x800b,
	EC_FOE_ERR_CHECKSUM = 0x800c,
};

/**
 * struct ec_foe_hdr - FoE header, decoded
 * @opcode: enum ec_foe_opcode
 * @number: password, packet number, or error code; BUSY: done in the low half, entire in
 *	the high half
 */
struct ec_foe_hdr {
	u8 opcode;
	u32 number;
};

/**
 * struct ec_foe - transfer of a file, as the master sees it
 * @write: to the slave, not from it
 * @password: of the request, 0: none
 * @name: of the file on the slave
 * @name_len: bytes of @name, more than 0
 * @size: write: bytes of the file; read: bytes received so far
 * @begun: the slave has accepted the request
 * @packet: number of the present DATA
 * @at: offset in the file of its data
 * @n: how many they are
 * @last: it is the last one
 * @busy: the last answer was BUSY, the next message is the same as before
 * @done: of @entire, how far the slave is; 0 of 0: it does not say
 * @entire: see @done
 * @error: error code of the slave, 0: none
 * @text: of that error
 */
struct ec_foe {
	bool write;
	u32 password;
	const char *name;
	size_t name_len;
	u64 size;
	bool begun;
	u32 packet;
	u64 at;
	u16 n;
	bool last;
	bool busy;
	u16 done;
	u16 entire;
	u32 error;
	char text[EC_FOE_TEXT];
};

int ec_foe_hdr_decode(struct ec_rbuf *r, struct ec_foe_hdr *h);
void ec_foe_hdr_encode(struct ec_wbuf *w, const struct ec_foe_hdr *h);
int ec_foe_tx(struct ec_foe *f, u8 *tx, size_t cap);
int ec_foe_rx(struct ec_foe *f, const u8 *rx, size_t len, size_t room);
int ec_foe_error_encode(u8 *tx, size_t cap, u32 error, const char *text);
const char *ec_foe_error_text(u32 code);
size_t ec_foe_name_len(const char *name, size_t cap);

#endif
