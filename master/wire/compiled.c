// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "compiled.h"
#ifndef __KERNEL__
#include <stdarg.h>
#include <stdio.h>
#endif

#define SMS		16
#define DATA_MAX	0x10000		/* bytes of a startup value */
#define TEXT_MAX	256		/* of a name, its terminator included */
#define SHORT_MAX	64		/* of sync units, groups, flags */
#define BITS_MAX	(8 * 0xffff)	/* of a SyncManager */
#define TYPES		12		/* enum ecb_type */

/**
 * ec_compiled_crc() - checksum of a compiled bus
 * @data: bytes
 * @size: their number
 *
 * Context: Any.
 * Return: CRC-32 as in Ethernet and gzip.
 */
u32 ec_compiled_crc(const u8 *data, size_t size)
{
	u32 crc = 0xffffffff, table[16], i, k;

	for (i = 0; i < 16; i++) {
		table[i] = i;
		for (k = 0; k < 4; k++)
			table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320 : 0);
	}
	for (; size; size--, data++) {
		crc ^= *data;
		crc = crc >> 4 ^ table[crc & 15];
		crc = crc >> 4 ^ table[crc & 15];
	}
	return ~crc;
}

__printf(4, 5)
static int invalid(struct ec_compiled *c, int err, size_t at, const char *fmt, ...)
{
	va_list args;

	va_start(args, fmt);
	vsnprintf(c->why, sizeof(c->why), fmt, args);
	va_end(args);
	c->at = at;
	return err;
}

/* Sets b->bad without a terminator at the end, with one before, and with control characters. */
static const char *text(struct ec_rbuf *b, size_t most)
{
	u16 size = ec_rbuf_le16(b);
	const u8 *p = ec_rbuf_take(b, size), *q;

	if (!p || !size || size > most || p[size - 1])
		goto bad;
	for (q = p; q < p + size - 1; q++)
		if (*q < ' ' || *q == 0x7f)
			goto bad;
	return (const char *)p;
bad:
	b->bad = true;
	return "";
}

/* what is reserved */
static void zeros(struct ec_rbuf *b, size_t n)
{
	const u8 *p = ec_rbuf_take(b, n);

	while (p && n--)
		b->bad |= *p++ != 0;
}

static void data(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->size = (u32)ec_rbuf_left(b);
	r->data = ec_rbuf_take(b, r->size);
}

/* the record is enough */
static void dec_domain(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	(void)b;
	(void)r;
}

static void dec_unit(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->name = text(b, SHORT_MAX);
	r->policy = ec_rbuf_le32(b);
	r->limit = ec_rbuf_le32(b);
	r->lease_cycles = ec_rbuf_le32(b);
	r->repeats = ec_rbuf_le32(b);
	r->flags = ec_rbuf_le32(b);
}

static void dec_domain_unit(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->domain = ec_rbuf_le32(b);
	r->unit = ec_rbuf_le32(b);
}

static void dec_slave(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->alias = ec_rbuf_le16(b);
	r->position = ec_rbuf_le16(b);
	r->vendor = ec_rbuf_le32(b);
	r->product = ec_rbuf_le32(b);
}

static void dec_group(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->name = text(b, SHORT_MAX);
	r->kind = ec_rbuf_u8(b);
	r->to = ec_rbuf_u8(b);
	r->number = ec_rbuf_le16(b);
	r->slave = ec_rbuf_le32(b);
	r->flags = ec_rbuf_le32(b);
}

static void dec_member(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->group = ec_rbuf_le32(b);
	r->position = ec_rbuf_le16(b);
	zeros(b, 2);
	r->vendor = ec_rbuf_le32(b);
	r->product = ec_rbuf_le32(b);
}

static void dec_flag(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->name = text(b, SHORT_MAX);
	r->value = (s32)ec_rbuf_le32(b);
}

static void dec_sdo(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->index = ec_rbuf_le16(b);
	r->subindex = ec_rbuf_u8(b);
	r->complete = ec_rbuf_u8(b);
	data(b, r);
}

static void dec_idn(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->index = ec_rbuf_le16(b);
	r->subindex = ec_rbuf_u8(b);
	r->step = ec_rbuf_u8(b);
	data(b, r);
}

static void dec_command(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	u8 what;

	r->slave = ec_rbuf_le32(b);
	r->step = ec_rbuf_u8(b);
	r->kind = ec_rbuf_u8(b);
	r->index = ec_rbuf_le16(b);
	r->subindex = ec_rbuf_u8(b);
	r->complete = ec_rbuf_u8(b);
	what = ec_rbuf_u8(b);
	r->expected = what == 2;
	b->bad |= what != 1 && what != 2;
	zeros(b, 1);
	data(b, r);
}

static void dec_timeout(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->step = ec_rbuf_u8(b);
	r->to = ec_rbuf_u8(b);
	zeros(b, 2);
	r->ms = ec_rbuf_le32(b);
}

static void dec_reply(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->ms = ec_rbuf_le32(b);
}

static void dec_dc(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->index = ec_rbuf_le16(b);
	zeros(b, 2);
	r->sync0 = ec_rbuf_le32(b);
	r->value = (s32)ec_rbuf_le32(b);
	r->sync1 = ec_rbuf_le32(b);
}

static void dec_pdos(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	data(b, r);
}

static void dec_place(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->domain = ec_rbuf_le32(b);
	r->subindex = ec_rbuf_u8(b);
	zeros(b, 1);
	r->index = ec_rbuf_le16(b);
}

static void dec_rest(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
	r->domain = ec_rbuf_le32(b);
}

static void dec_clock(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->slave = ec_rbuf_le32(b);
}

static void dec_cycle(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->ns = ec_rbuf_le64(b);
}

static void dec_names(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	data(b, r);
}

static void dec_value(struct ec_rbuf *b, struct ec_compiled_record *r)
{
	r->name = text(b, TEXT_MAX);
	r->unit_text = text(b, TEXT_MAX);
	r->place = ec_rbuf_le32(b);
	r->bit = ec_rbuf_le32(b);
	r->object = ec_rbuf_le32(b);
	r->bits = ec_rbuf_u8(b);
	r->type = ec_rbuf_u8(b);
	r->output = ec_rbuf_u8(b);
	zeros(b, 1);
	r->scale.num = (s64)ec_rbuf_le64(b);
	r->scale.den = ec_rbuf_le64(b);
	r->offset.num = (s64)ec_rbuf_le64(b);
	r->offset.den = ec_rbuf_le64(b);
}

/* numbers that name earlier records */
#define OF_SLAVE	0x01
#define OF_DOMAIN	0x02
#define OF_UNIT		0x04
#define OF_GROUP	0x08
#define OF_PLACE	0x10
#define OR_NONE		0x20	/* EC_COMPILED_NONE as well */

static const struct {
	void (*decode)(struct ec_rbuf *b, struct ec_compiled_record *r);
	const char *name;
	u8 of;
} ops[EC_COMPILED_OPS] = {
	[EC_COMPILED_DOMAIN] = { dec_domain, "domain", 0 },
	[EC_COMPILED_UNIT] = { dec_unit, "sync unit", 0 },
	[EC_COMPILED_DOMAIN_UNIT] = { dec_domain_unit, "domain in a unit", OF_DOMAIN | OF_UNIT },
	[EC_COMPILED_SLAVE] = { dec_slave, "slave", 0 },
	[EC_COMPILED_GROUP] = { dec_group, "group", OF_SLAVE | OR_NONE },
	[EC_COMPILED_MEMBER] = { dec_member, "member of a group", OF_GROUP },
	[EC_COMPILED_FLAG] = { dec_flag, "flag", OF_SLAVE },
	[EC_COMPILED_SDO] = { dec_sdo, "SDO", OF_SLAVE },
	[EC_COMPILED_IDN] = { dec_idn, "IDN", OF_SLAVE },
	[EC_COMPILED_COMMAND] = { dec_command, "command", OF_SLAVE },
	[EC_COMPILED_TIMEOUT] = { dec_timeout, "time limit", OF_SLAVE },
	[EC_COMPILED_REPLY] = { dec_reply, "time limit of the mailbox", OF_SLAVE },
	[EC_COMPILED_DC] = { dec_dc, "SYNC signals", OF_SLAVE },
	[EC_COMPILED_PDOS] = { dec_pdos, "PDOs", OF_SLAVE },
	[EC_COMPILED_PLACE] = { dec_place, "registration", OF_SLAVE | OF_DOMAIN },
	[EC_COMPILED_REST] = { dec_rest, "registration of the rest", OF_SLAVE | OF_DOMAIN },
	[EC_COMPILED_CLOCK] = { dec_clock, "reference clock", OF_SLAVE },
	[EC_COMPILED_CYCLE] = { dec_cycle, "cycle", 0 },
	[EC_COMPILED_NAMES] = { dec_names, "names", 0 },
	[EC_COMPILED_VALUE] = { dec_value, "value", OF_PLACE },
};

static bool is_known(u16 op)
{
	return op < EC_COMPILED_OPS && ops[op].decode;
}

/**
 * ec_compiled_op_name() - what a record is
 * @op: enum ec_compiled_op
 *
 * Context: Any.
 * Return: text for messages.
 */
const char *ec_compiled_op_name(u16 op)
{
	return is_known(op) ? ops[op].name : "unknown operation";
}

/**
 * ec_compiled_next() - decode a record
 * @c: of ec_compiled_check()
 * @at: of ec_compiled_begin(), moved to the next record
 * @rec: result
 *
 * Context: Any.
 * Return: false: there is none any more, or, while @c is checked, it is not valid.
 */
bool ec_compiled_next(const struct ec_compiled *c, struct ec_rbuf *at,
		      struct ec_compiled_record *rec)
{
	struct ec_rbuf body;
	const u8 *p;
	u32 size;

	memset(rec, 0, sizeof(*rec));
	rec->at = (size_t)(at->p - c->data);
	rec->op = ec_rbuf_le16(at);
	zeros(at, 2);
	size = ec_rbuf_le32(at);
	p = ec_rbuf_take(at, size);
	zeros(at, -size & 3);
	if (!p || !is_known(rec->op))
		return false;
	body = ec_rbuf(p, size);
	ops[rec->op].decode(&body, rec);
	at->bad |= body.bad || ec_rbuf_left(&body);
	return !at->bad;
}

/* --- check ------------------------------------------------------------------- */

static bool is_state(u8 state)
{
	return state == 1 || state == 2 || state == 3 || state == 4 || state == 8;
}

/* The parts of SyncManagers fit into the record, and their numbers are possible. */
static bool valid_pdos(const struct ec_compiled_record *r)
{
	struct ec_rbuf b = ec_rbuf(r->data, r->size);
	unsigned int after = 0;

	while (ec_rbuf_left(&b)) {
		struct ec_compiled_sm sm = ec_compiled_sm(&b);

		if (sm.index < after || sm.index >= SMS || (sm.dir != 1 && sm.dir != 2))
			return false;
		after = sm.index + 1U;
		for (; sm.n_pdos && !b.bad; sm.n_pdos--) {
			struct ec_compiled_pdo pdo = ec_compiled_pdo(&b);

			for (; pdo.n_entries && !b.bad; pdo.n_entries--)
				b.bad |= !ec_compiled_entry(&b).bits;
		}
		if (b.bad)
			return false;
	}
	return true;
}

static bool valid_size(const struct ec_compiled_record *r)
{
	return r->size && r->size <= DATA_MAX && r->complete <= 1;
}

static bool valid_value(const struct ec_compiled_record *r)
{
	return *r->name && r->bits && r->bit <= BITS_MAX && r->type < TYPES && r->output <= 1 &&
		r->scale.den && r->offset.den && r->scale.num;
}

/* numbers that do not depend on other records */
static bool valid(const struct ec_compiled_record *r)
{
	switch (r->op) {
	case EC_COMPILED_UNIT:
		return *r->name && r->policy <= 4 && r->flags <= 7;
	case EC_COMPILED_GROUP:
		return *r->name && r->kind >= 1 && r->kind <= 3 && r->to <= 3 && r->flags <= 3;
	case EC_COMPILED_FLAG:
		return *r->name;
	case EC_COMPILED_SDO:
		return valid_size(r) && !(r->complete && r->subindex);
	case EC_COMPILED_IDN:
		return valid_size(r) && r->subindex <= 7 && (r->step == 2 || r->step == 4);
	case EC_COMPILED_COMMAND:
		return valid_size(r) && r->kind <= 2 && is_state(r->step >> 4) &&
			is_state(r->step & 15);
	case EC_COMPILED_TIMEOUT:
		return is_state(r->step) && is_state(r->to);
	case EC_COMPILED_PDOS:
		return valid_pdos(r);
	case EC_COMPILED_PLACE:
		return r->subindex < SMS;
	case EC_COMPILED_CYCLE:
		return r->ns && r->ns <= 0xffffffffULL * 1000;
	case EC_COMPILED_NAMES:
		return r->size <= EC_COMPILED_NAMES_MAX;
	case EC_COMPILED_VALUE:
		return valid_value(r);
	default:
		return true;
	}
}

/* @number of a record before, of which there are @n */
static int refers(struct ec_compiled *c, const struct ec_compiled_record *r, const char *what,
		  u32 number, u32 n)
{
	if (number < n)
		return 0;
	return invalid(c, -EINVAL, r->at, "%s: there is no %s %u before, expected less than %u",
		       ops[r->op].name, what, number, n);
}

static int check_references(struct ec_compiled *c, const struct ec_compiled_record *r)
{
	u8 of = ops[r->op].of;
	int ret = 0;

	if (of & OF_SLAVE && !(of & OR_NONE && r->slave == EC_COMPILED_NONE))
		ret = refers(c, r, "slave", r->slave, c->n_slaves);
	if (!ret && of & OF_DOMAIN)
		ret = refers(c, r, "domain", r->domain, c->n_domains);
	if (!ret && of & OF_UNIT)
		ret = refers(c, r, "unit", r->unit, c->n_units);
	if (!ret && of & OF_GROUP)
		ret = refers(c, r, "group", r->group, c->n_groups);
	if (!ret && of & OF_PLACE)
		ret = refers(c, r, "registration", r->place, c->n_places);
	return ret;
}

static void count_record(struct ec_compiled *c, const struct ec_compiled_record *r)
{
	c->n_domains += r->op == EC_COMPILED_DOMAIN;
	c->n_units += r->op == EC_COMPILED_UNIT;
	c->n_groups += r->op == EC_COMPILED_GROUP;
	c->n_slaves += r->op == EC_COMPILED_SLAVE || r->op == EC_COMPILED_MEMBER;
	c->n_places += r->op == EC_COMPILED_PLACE;
	if (r->op != EC_COMPILED_VALUE)
		return;
	c->n_values++;
	c->texts += (u32)(strlen(r->name) + strlen(r->unit_text) + 2);
}

static int check_records(struct ec_compiled *c)
{
	struct ec_rbuf b = ec_compiled_begin(c);
	struct ec_compiled_record r;
	const char *last = "";
	u32 i;
	int ret;

	for (i = 0; i < c->n_records; i++) {
		if (!ec_compiled_next(c, &b, &r))
			return invalid(c, -EINVAL, r.at, "record %u of %u (%s): %s", i,
				       c->n_records, ec_compiled_op_name(r.op), is_known(r.op) ?
				       "its length or a text is wrong" :
				       "this version does not know it");
		if (!valid(&r))
			return invalid(c, -EINVAL, r.at, "record %u of %u (%s): a number is wrong",
				       i, c->n_records, ops[r.op].name);
		ret = check_references(c, &r);
		if (ret)
			return ret;
		if (r.op == EC_COMPILED_VALUE) {
			if (strcmp(last, r.name) >= 0)
				return invalid(c, -EINVAL, r.at,
					       "value '%.32s' does not follow '%.32s' in the order of names",
					       r.name, last);
			last = r.name;
		}
		count_record(c, &r);
	}
	if (ec_rbuf_left(&b))
		return invalid(c, -EINVAL, (size_t)(b.p - c->data), "%zu bytes behind %u records",
			       ec_rbuf_left(&b), c->n_records);
	return 0;
}

/**
 * ec_compiled_check() - is it a compiled bus, with each record valid?
 * @c: result; with @data when it is, else @at and @why
 * @data: bytes, which must not change as long as @c is used
 * @size: their number
 *
 * Context: Any. Time in proportion to @size.
 * Return: 0; -EBADMSG another file, cut off, or changed; -EPROTONOSUPPORT another version; -EFBIG
 * larger than EC_COMPILED_MAX; -EINVAL a record is not valid.
 */
int ec_compiled_check(struct ec_compiled *c, const void *data, size_t size)
{
	struct ec_rbuf b = ec_rbuf(data, size);
	const u8 *magic = ec_rbuf_take(&b, sizeof(EC_COMPILED_MAGIC));
	u16 version = ec_rbuf_le16(&b), reserved = ec_rbuf_le16(&b);
	u32 length = ec_rbuf_le32(&b), crc = ec_rbuf_le32(&b), found;

	memset(c, 0, sizeof(*c));
	if (!magic || memcmp(magic, EC_COMPILED_MAGIC, sizeof(EC_COMPILED_MAGIC)))
		return invalid(c, -EBADMSG, 0, "no compiled bus file; 'ethercat bus compile' writes one");
	if (b.bad)
		return invalid(c, -EBADMSG, size, "%zu bytes, header cut off", size);
	if (version != EC_COMPILED_VERSION || reserved)
		return invalid(c, -EPROTONOSUPPORT, sizeof(EC_COMPILED_MAGIC),
			       "version %u, expected %u; compile the bus file again", version,
			       EC_COMPILED_VERSION);
	if (size > EC_COMPILED_MAX)
		return invalid(c, -EFBIG, EC_COMPILED_MAX, "%zu bytes, limit %u", size,
			       EC_COMPILED_MAX);
	if (length != size || size < EC_COMPILED_HEADER)
		return invalid(c, -EBADMSG, min_t(size_t, length, size),
			       "%zu bytes, expected %u by the header", size, length);
	found = ec_compiled_crc(b.p, ec_rbuf_left(&b));
	if (found != crc)
		return invalid(c, -EBADMSG, EC_COMPILED_CRC_AT, "CRC 0x%08x, expected 0x%08x",
			       found, crc);
	c->data = data;
	c->size = size;
	c->n_records = ec_rbuf_le32(&b);
	return check_records(c);
}
