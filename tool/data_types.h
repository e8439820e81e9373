/* SPDX-License-Identifier: GPL-2.0-only */
/* CoE data types and the names users give them (ETG.1020, ETG.1000.6 table 64). */
#ifndef EC_TOOL_DATA_TYPES_H
#define EC_TOOL_DATA_TYPES_H

#include "../devices/sim/codes.h"

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
