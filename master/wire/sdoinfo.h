/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * SDO information (ETG.1000.6 clause 5.6.3): reading the object dictionary.
 * Client exchanges without I/O, see sdo.h; an answer may come in several
 * fragments, for which ec_sdoinfo_rx() returns EC_WAIT.
 */
#ifndef EC_WIRE_SDOINFO_H
#define EC_WIRE_SDOINFO_H

#include "coe.h"

#define EC_SDOINFO_HDR		6	/* CoE header, opcode, reserved, fragments left */
#define EC_OD_ENTRY_HDR		10	/* of an entry, before optional fields and name */
#define EC_SDOINFO_MIN		10	/* smallest mailbox content a CoE slave has */
#define EC_SDOINFO_FRAGMENTS	4096	/* no answer has more */
#define EC_SDOINFO_OPCODE_MASK	0x7F
#define EC_SDOINFO_INCOMPLETE	0x80

enum ec_sdoinfo_opcode {
	EC_SDOINFO_LIST_REQ = 1,
	EC_SDOINFO_LIST_RESP = 2,
	EC_SDOINFO_OBJECT_REQ = 3,
	EC_SDOINFO_OBJECT_RESP = 4,
	EC_SDOINFO_ENTRY_REQ = 5,
	EC_SDOINFO_ENTRY_RESP = 6,
	EC_SDOINFO_ERROR = 7,
};

/* value info: optional fields of an entry description */
#define EC_OD_INFO_UNIT		BIT(3)
#define EC_OD_INFO_DEFAULT	BIT(4)
#define EC_OD_INFO_MIN		BIT(5)
#define EC_OD_INFO_MAX		BIT(6)
#define EC_OD_INFO_VALUES	(EC_OD_INFO_UNIT | EC_OD_INFO_DEFAULT | EC_OD_INFO_MIN | \
				 EC_OD_INFO_MAX)

/**
 * struct ec_od_object - object description
 * @index: object
 * @type: data type
 * @max_sub: highest subindex
 * @code: enum ec_od_code
 * @name: not terminated, of the slave's own character set
 * @name_len: bytes at @name
 */
struct ec_od_object {
	u16 index;
	u16 type;
	u8 max_sub;
	u8 code;
	const char *name;
	size_t name_len;
};

/**
 * struct ec_od_entry - entry description
 * @index: object
 * @sub: subindex
 * @info: which optional fields were sent
 * @type: data type
 * @bits: length
 * @access: EC_OD_READ_PREOP...
 * @name: not terminated, of the slave's own character set
 * @name_len: bytes at @name
 */
struct ec_od_entry {
	u16 index;
	u8 sub;
	u8 info;
	u16 type;
	u16 bits;
	u16 access;
	const char *name;
	size_t name_len;
};

/**
 * struct ec_od_values - optional fields of an entry description
 * @info: which of them there are: bits of EC_OD_INFO_VALUES
 * @unit_size: bytes of the unit type: slaves send 2 or 4
 * @unit: unit type
 * @size: bytes of each value
 * @def: default, little-endian
 * @min: minimum
 * @max: maximum
 */
struct ec_od_values {
	u8 info;
	u8 unit_size;
	u32 unit;
	size_t size;
	const u8 *def;
	const u8 *min;
	const u8 *max;
};

enum ec_sdoinfo_state {
	EC_SDOINFO_REQUEST,
	EC_SDOINFO_FRAGMENT,
	EC_SDOINFO_DONE,
};

/**
 * struct ec_sdoinfo - one request and its answer
 * @state: where it is
 * @opcode: EC_SDOINFO_LIST_REQ, ..._OBJECT_REQ or ..._ENTRY_REQ
 * @index: object, or list type
 * @sub: subindex
 * @info: optional fields asked for: bits of EC_OD_INFO_VALUES, 0 after ec_sdoinfo_init()
 * @data: where the answer goes; of a list only the indexes (or counts)
 * @cap: bytes at @data
 * @size: bytes received so far
 * @left: fragments to come, as the slave says
 * @fragments: fragments received
 * @abort: abort code received
 */
struct ec_sdoinfo {
	enum ec_sdoinfo_state state;
	u8 opcode;
	u16 index;
	u8 sub;
	u8 info;
	u8 *data;
	size_t cap;
	size_t size;
	u16 left;
	u16 fragments;
	u32 abort;
};

void ec_sdoinfo_put_hdr(struct ec_wbuf *w, u8 opcode, u16 left);
void ec_sdoinfo_init(struct ec_sdoinfo *s, u8 opcode, u16 index, u8 sub, u8 *data, size_t cap);
int ec_sdoinfo_tx(struct ec_sdoinfo *s, u8 *tx, size_t cap);
int ec_sdoinfo_rx(struct ec_sdoinfo *s, const u8 *rx, size_t len);

int ec_od_object_decode(const u8 *data, size_t len, struct ec_od_object *o);
int ec_od_entry_decode(const u8 *data, size_t len, struct ec_od_entry *e);
int ec_od_values_decode(const u8 *data, size_t len, size_t plain, struct ec_od_values *v);

#endif
