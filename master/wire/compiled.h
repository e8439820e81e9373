/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * A compiled bus file: calls of ecrt.h with their arguments, in the order in which an application
 * makes them, and the names of values. 'ethercat bus compile' writes it, the kernel executes it.
 *
 * Little-endian. Header: 8 bytes EC_COMPILED_MAGIC, u16 version, u16 0, u32 bytes of the whole,
 * u32 CRC-32 of all that follows, u32 number of records. A record: u16 operation, u16 0, u32 bytes
 * of its body, body, zeros up to a multiple of 4. A text has u16 bytes with its terminator.
 * Domains, units, groups, slaves and places are numbered from 0 in the order of their records; a
 * record names earlier ones only.
 */
#ifndef EC_WIRE_COMPILED_H
#define EC_WIRE_COMPILED_H

#include "buf.h"

#define EC_COMPILED_MAGIC	"ECATBUS"	/* and its terminator */
#define EC_COMPILED_VERSION	1
#define EC_COMPILED_HEADER	24
#define EC_COMPILED_RECORD	8	/* before the body */
#define EC_COMPILED_CRC_AT	16
#define EC_COMPILED_MAX		(32U << 20)	/* bytes of the whole */
#define EC_COMPILED_NAMES_MAX	(4U << 20)	/* of ecrt_master_set_names() */
#define EC_COMPILED_NONE	0xffffffffU
#define EC_COMPILED_REASON	96

/* operations; the numbers of arguments are those of ecrt.h */
enum ec_compiled_op {
	/* makes a domain */
	EC_COMPILED_DOMAIN = 1,
	/* makes a sync unit: text name, u32 policy, limit, lease_cycles, repeats, flags */
	EC_COMPILED_UNIT,
	/* u32 domain, unit */
	EC_COMPILED_DOMAIN_UNIT,
	/* makes a slave: u16 alias, position, u32 vendor, product */
	EC_COMPILED_SLAVE,
	/* makes a group: text name, u8 by, port, u16 value, u32 slave or NONE, flags */
	EC_COMPILED_GROUP,
	/* makes a slave: u32 group, u16 member, 0, u32 vendor, product */
	EC_COMPILED_MEMBER,
	/* u32 slave, text key, s32 value */
	EC_COMPILED_FLAG,
	/* u32 slave, u16 index, u8 subindex, complete, data */
	EC_COMPILED_SDO,
	/* u32 slave, u16 IDN, u8 drive, state, data */
	EC_COMPILED_IDN,
	/*
	 * u32 slave, u8 step, kind, u16 index, u8 subindex, complete, 1: is written or 2: is
	 * expected, 0, data
	 */
	EC_COMPILED_COMMAND,
	/* u32 slave, u8 from, to, u16 0, u32 ms */
	EC_COMPILED_TIMEOUT,
	/* u32 slave, ms: time limit of the mailbox */
	EC_COMPILED_REPLY,
	/* u32 slave, u16 assign, 0, u32 sync0, s32 shift, u32 sync1 */
	EC_COMPILED_DC,
	/*
	 * u32 slave, SyncManagers: u8 index, direction, u16 PDOs: u16 index, entries: u16 index,
	 * u8 subindex, bits; other SyncManagers get none
	 */
	EC_COMPILED_PDOS,
	/* makes a place: u32 slave, domain, u8 SM, 0, u16 PDO */
	EC_COMPILED_PLACE,
	/* u32 slave, domain: the SyncManagers without place */
	EC_COMPILED_REST,
	/* u32 slave: the reference clock */
	EC_COMPILED_CLOCK,
	/* u64 ns: interval */
	EC_COMPILED_CYCLE,
	/* text for tools, to the end of the record */
	EC_COMPILED_NAMES,
	/*
	 * text name, unit, u32 place, bit in it, object, u8 bits, type, output, 0, s64 scale,
	 * u64 divisor, s64 offset, u64 divisor; in the order of the names
	 */
	EC_COMPILED_VALUE,
	EC_COMPILED_OPS
};

/**
 * struct ec_compiled - a compiled bus whose records are valid
 * @data: all bytes
 * @size: their number
 * @n_records: records
 * @n_domains: made by them
 * @n_units: likewise
 * @n_groups: likewise
 * @n_slaves: likewise
 * @n_places: likewise
 * @n_values: likewise
 * @texts: bytes of the names and units of all values, with terminators
 * @at: when it is not valid: byte where
 * @why: and why
 */
struct ec_compiled {
	const u8 *data;
	size_t size;
	u32 n_records;
	u32 n_domains;
	u32 n_units;
	u32 n_groups;
	u32 n_slaves;
	u32 n_places;
	u32 n_values;
	u32 texts;
	size_t at;
	char why[EC_COMPILED_REASON];
};

/* a rational number, as the kernel has no floating point */
struct ec_compiled_number {
	s64 num;
	u64 den;
};

/* one call; members that its operation does not have are 0 */
struct ec_compiled_record {
	u16 op;			/* enum ec_compiled_op */
	size_t at;		/* byte where the record begins */
	const char *name;	/* of unit, group, value; key of a flag */
	const char *unit_text;	/* of a value */
	const u8 *data;		/* of @size bytes: data, SyncManagers, or text */
	u32 size;
	u32 slave;
	u32 domain;
	u32 unit;
	u32 group;
	u32 place;
	u32 vendor;
	u32 product;
	u16 alias;
	u16 position;		/* of a slave; number of a member */
	u16 index;		/* object, IDN, register; AssignActivate; PDO of a place */
	u8 subindex;		/* or drive; SM of a place */
	u8 complete;
	u8 kind;		/* of a command; what a group is known by */
	u8 step;		/* of a command; state of an IDN; first state of a time limit */
	u8 to;			/* second state of a time limit; port of a group */
	u8 expected;		/* a command reads */
	u16 number;		/* of a group: alias or identification */
	u8 bits;
	u8 type;
	u8 output;
	u32 bit;		/* of a value, from its place on */
	u32 object;
	u32 policy;
	u32 limit;
	u32 lease_cycles;
	u32 repeats;
	u32 flags;
	u32 ms;
	s32 value;		/* of a flag; shift of SYNC0 */
	u32 sync0;
	u32 sync1;
	u64 ns;
	struct ec_compiled_number scale;
	struct ec_compiled_number offset;
};

/* a SyncManager of EC_COMPILED_PDOS */
struct ec_compiled_sm {
	u8 index;
	u8 dir;
	u16 n_pdos;
};

/* a PDO of it */
struct ec_compiled_pdo {
	u16 index;
	u16 n_entries;
};

/* an entry of it */
struct ec_compiled_entry {
	u16 index;
	u8 subindex;
	u8 bits;
};

const char *ec_compiled_op_name(u16 op);
u32 ec_compiled_crc(const u8 *data, size_t size);
int ec_compiled_check(struct ec_compiled *c, const void *data, size_t size);
bool ec_compiled_next(const struct ec_compiled *c, struct ec_rbuf *at,
		      struct ec_compiled_record *rec);

/* records of a valid one begin here */
static inline struct ec_rbuf ec_compiled_begin(const struct ec_compiled *c)
{
	return ec_rbuf(c->data + EC_COMPILED_HEADER, c->size - EC_COMPILED_HEADER);
}

/* the next part of the SyncManagers in EC_COMPILED_PDOS */
static inline struct ec_compiled_sm ec_compiled_sm(struct ec_rbuf *b)
{
	struct ec_compiled_sm sm;

	sm.index = ec_rbuf_u8(b);
	sm.dir = ec_rbuf_u8(b);
	sm.n_pdos = ec_rbuf_le16(b);
	return sm;
}

static inline struct ec_compiled_pdo ec_compiled_pdo(struct ec_rbuf *b)
{
	struct ec_compiled_pdo pdo;

	pdo.index = ec_rbuf_le16(b);
	pdo.n_entries = ec_rbuf_le16(b);
	return pdo;
}

static inline struct ec_compiled_entry ec_compiled_entry(struct ec_rbuf *b)
{
	struct ec_compiled_entry e;

	e.index = ec_rbuf_le16(b);
	e.subindex = ec_rbuf_u8(b);
	e.bits = ec_rbuf_u8(b);
	return e;
}

#endif
