/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Messages of the diagnosis history, object 0x10F3 (ETG.1020): bytes to structures. */
#ifndef EC_WIRE_DIAG_H
#define EC_WIRE_DIAG_H

#include "buf.h"

#define EC_DIAG_INDEX		0x10F3
#define EC_DIAG_FIRST_SUB	6	/* of the messages */
#define EC_DIAG_HDR		16	/* bytes before the parameters */

/* subindexes before the messages */
#define EC_DIAG_SUB_MAX		1	/* number of messages the slave keeps */
#define EC_DIAG_SUB_NEWEST	2	/* subindex of the newest message */
#define EC_DIAG_SUB_ACK		3	/* the newest that is acknowledged; 0 clears all */
#define EC_DIAG_SUB_FLAGS	5

enum ec_diag_severity {
	EC_DIAG_INFO,
	EC_DIAG_WARNING,
	EC_DIAG_ERROR,
};

/* what a parameter is: bits 12 to 15 of its flags */
enum ec_diag_kind {
	EC_DIAG_VALUE,		/* of the data type in bits 0 to 11 */
	EC_DIAG_BYTES,		/* so many bytes as bits 0 to 11 say; so the next two */
	EC_DIAG_ASCII,
	EC_DIAG_UNICODE,
	EC_DIAG_TEXT_ID,	/* of a text in the device description, 2 bytes */
};

/**
 * struct ec_diag_msg - diagnosis message
 * @code: diagnosis code
 * @flags: bits 0 to 3 enum ec_diag_severity, 8 to 15 number of parameters
 * @text_id: of the text in the device description, 0: none
 * @time_ns: DC time or the slave's own
 * @params: parameters that the message announces
 * @rest: those that have not been read
 */
struct ec_diag_msg {
	u32 code;
	u16 flags;
	u16 text_id;
	u64 time_ns;
	u8 params;
	struct ec_rbuf rest;
};

/**
 * struct ec_diag_param - parameter of a diagnosis message
 * @kind: enum ec_diag_kind
 * @type: data type of EC_DIAG_VALUE
 * @data: value, little-endian
 * @size: bytes at @data
 */
struct ec_diag_param {
	u8 kind;
	u16 type;
	const u8 *data;
	size_t size;
};

int ec_diag_msg_decode(const u8 *data, size_t len, struct ec_diag_msg *m);
int ec_diag_param_decode(struct ec_diag_msg *m, struct ec_diag_param *p);

#endif
