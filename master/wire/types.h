/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* CoE data types and the names users give them (ETG.1020, ETG.1000.6 table 64). */
#ifndef EC_WIRE_TYPES_H
#define EC_WIRE_TYPES_H

#include "env.h"

enum ec_type_kind {
	EC_KIND_BOOL,
	EC_KIND_INT,
	EC_KIND_UINT,
	EC_KIND_FLOAT,
	EC_KIND_STRING,		/* 8-bit characters */
	EC_KIND_OCTETS,
	EC_KIND_UNICODE,	/* 16-bit characters */
	EC_KIND_SM,		/* sign and magnitude */
	EC_KIND_BITS,
	EC_KIND_RAW,		/* bytes, no value form */
};

#define EC_TYPE_BOOL		0x0001
#define EC_TYPE_INT8		0x0002
#define EC_TYPE_INT16		0x0003
#define EC_TYPE_INT32		0x0004
#define EC_TYPE_UINT8		0x0005
#define EC_TYPE_UINT16		0x0006
#define EC_TYPE_UINT32		0x0007
#define EC_TYPE_FLOAT		0x0008
#define EC_TYPE_STRING		0x0009
#define EC_TYPE_OCTET_STRING	0x000A
#define EC_TYPE_UNICODE_STRING	0x000B
#define EC_TYPE_DOUBLE		0x0011
#define EC_TYPE_INT64		0x0015
#define EC_TYPE_UINT64		0x001B
#define EC_TYPE_SM8		0xFFFB
#define EC_TYPE_SM16		0xFFFC
#define EC_TYPE_SM32		0xFFFD
#define EC_TYPE_SM64		0xFFFE
#define EC_TYPE_RAW		0xFFFF

/**
 * struct ec_type - one data type
 * @code: index in the object dictionary, or 0xFFFB and up for our own
 * @bits: size, 0: variable
 * @kind: how values look
 * @name: as the tool's -t option knows it
 */
struct ec_type {
	u16 code;
	u16 bits;
	enum ec_type_kind kind;
	const char *name;
};

extern const struct ec_type ec_types[];
extern const unsigned int ec_types_count;

const struct ec_type *ec_type_by_code(u16 code);
const struct ec_type *ec_type_by_name(const char *name);

#endif
