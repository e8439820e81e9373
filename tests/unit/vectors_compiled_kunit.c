// SPDX-License-Identifier: GPL-2.0-only
/* Compiled bus files: every operation, and what is refused, with the byte and the reason. */
#include "wire_kunit.h"
#include "compiled_file.h"

static struct ec_compiled c;

static void add_value(const char *name, u32 place, u64 scale_den, u8 bits)
{
	begin(EC_COMPILED_VALUE);
	text(name);
	text("mm");
	U32(place, 16, 0x600011);
	ec_wbuf_u8(&f.w, bits);
	bytes("\4\0\0", 3);
	ec_wbuf_le64(&f.w, (u64)-3);
	ec_wbuf_le64(&f.w, scale_den);
	ec_wbuf_le64(&f.w, 7);
	ec_wbuf_le64(&f.w, 2);
	end();
}

static void add_setup(void)
{
	begin(EC_COMPILED_FLAG);
	U32(0);
	text("ExpectedRevision");
	U32(0x120000);
	end();
	begin(EC_COMPILED_SDO);
	U32(1);
	bytes("\x10\x80\x01\x00\x05", 5);
	end();
	begin(EC_COMPILED_IDN);
	U32(1);
	bytes("\x20\x00\x01\x02\x0b\x00", 6);
	end();
	begin(EC_COMPILED_COMMAND);
	U32(1);
	bytes("\x24\x00\x50\xf0\x01\x00\x02\x00\x01\x02\x03\x04", 12);
	end();
	begin(EC_COMPILED_TIMEOUT);
	U32(1);
	bytes("\x02\x04\0\0", 4);
	U32(10000);
	end();
	begin(EC_COMPILED_REPLY);
	U32(1, 500);
	end();
	begin(EC_COMPILED_DC);
	U32(1);
	bytes("\x00\x07\0\0", 4);
	U32(1000000, (u32)-250000, 5);
	end();
}

/* every operation once, two values */
static size_t whole(void)
{
	start();
	begin(EC_COMPILED_DOMAIN);
	end();
	begin(EC_COMPILED_UNIT);
	text("axes");
	U32(3, 2, 100, 1, 5);
	end();
	begin(EC_COMPILED_DOMAIN_UNIT);
	U32(0, 0);
	end();
	begin(EC_COMPILED_SLAVE);
	bytes("\5\0\0\0", 4);
	U32(2, 0x1c213052);
	end();
	begin(EC_COMPILED_GROUP);
	text("dock");
	bytes("\3\2\0\0", 4);
	U32(0, 2);
	end();
	begin(EC_COMPILED_MEMBER);
	U32(0);
	bytes("\1\0\0\0", 4);
	U32(2, 0x30);
	end();
	add_setup();
	begin(EC_COMPILED_PDOS);
	U32(1);
	bytes("\2\1\1\0\x00\x16\0\0" "\3\2\1\0\x00\x1a\2\0\x00\x60\x11\x20\0\0\0\x08", 24);
	end();
	begin(EC_COMPILED_PLACE);
	U32(1, 0);
	bytes("\3\0\1\0", 4);
	end();
	begin(EC_COMPILED_REST);
	U32(1, 0);
	end();
	begin(EC_COMPILED_CLOCK);
	U32(1);
	end();
	begin(EC_COMPILED_CYCLE);
	ec_wbuf_le64(&f.w, 1000000);
	end();
	begin(EC_COMPILED_NAMES);
	bytes("ethercat: 1\n", 12);
	end();
	add_value("a.x", 0, 1000, 32);
	add_value("b", 0, 1, 1);
	return finish();
}

/* the next record of @op */
static struct ec_compiled_record find(u16 op)
{
	struct ec_rbuf at = ec_compiled_begin(&c);
	struct ec_compiled_record r;

	while (ec_compiled_next(&c, &at, &r) && r.op != op)
		;
	return r;
}

static void vectors_compiled_crc(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_compiled_crc((const u8 *)"123456789", 9), 0xcbf43926u);
	KUNIT_EXPECT_EQ(test, ec_compiled_crc((const u8 *)"", 0), 0u);
}

static void vectors_compiled_counts_and_calls(struct kunit *test)
{
	struct ec_compiled_record r;

	KUNIT_ASSERT_EQ(test, ec_compiled_check(&c, f.data, whole()), 0);
	KUNIT_EXPECT_EQ(test, c.n_records, EC_COMPILED_OPS + 0u);
	KUNIT_EXPECT_EQ(test, c.n_domains, 1u);
	KUNIT_EXPECT_EQ(test, c.n_units, 1u);
	KUNIT_EXPECT_EQ(test, c.n_groups, 1u);
	KUNIT_EXPECT_EQ(test, c.n_slaves, 2u);
	KUNIT_EXPECT_EQ(test, c.n_places, 1u);
	KUNIT_EXPECT_EQ(test, c.n_values, 2u);
	KUNIT_EXPECT_EQ(test, c.texts, 4u + 3 + 2 + 3);
	r = find(EC_COMPILED_UNIT);
	KUNIT_EXPECT_STREQ(test, r.name, "axes");
	KUNIT_EXPECT_EQ(test, r.policy, 3u);
	KUNIT_EXPECT_EQ(test, r.lease_cycles, 100u);
	KUNIT_EXPECT_EQ(test, r.flags, 5u);
	r = find(EC_COMPILED_SLAVE);
	KUNIT_EXPECT_EQ(test, r.alias, 5);
	KUNIT_EXPECT_EQ(test, r.product, 0x1c213052u);
	r = find(EC_COMPILED_GROUP);
	KUNIT_EXPECT_EQ(test, r.kind, 3);
	KUNIT_EXPECT_EQ(test, r.to, 2);
	KUNIT_EXPECT_EQ(test, r.slave, 0u);
	r = find(EC_COMPILED_MEMBER);
	KUNIT_EXPECT_EQ(test, r.position, 1);
	KUNIT_EXPECT_EQ(test, r.vendor, 2u);
}

static void vectors_compiled_slaves(struct kunit *test)
{
	struct ec_compiled_record r;

	KUNIT_ASSERT_EQ(test, ec_compiled_check(&c, f.data, whole()), 0);
	r = find(EC_COMPILED_SDO);
	KUNIT_EXPECT_EQ(test, r.index, 0x8010);
	KUNIT_EXPECT_EQ(test, r.size, 1u);
	KUNIT_EXPECT_EQ(test, r.data[0], 5);
	r = find(EC_COMPILED_IDN);
	KUNIT_EXPECT_EQ(test, r.subindex, 1);
	KUNIT_EXPECT_EQ(test, r.size, 2u);
	r = find(EC_COMPILED_COMMAND);
	KUNIT_EXPECT_EQ(test, r.step, 0x24);
	KUNIT_EXPECT_TRUE(test, r.expected);
	KUNIT_EXPECT_EQ(test, r.size, 4u);
	r = find(EC_COMPILED_DC);
	KUNIT_EXPECT_EQ(test, r.index, 0x0700);
	KUNIT_EXPECT_EQ(test, r.value, -250000);
	KUNIT_EXPECT_EQ(test, r.sync1, 5u);
	r = find(EC_COMPILED_PLACE);
	KUNIT_EXPECT_EQ(test, r.subindex, 3);
	KUNIT_EXPECT_EQ(test, r.index, 1);
	r = find(EC_COMPILED_VALUE);
	KUNIT_EXPECT_STREQ(test, r.name, "a.x");
	KUNIT_EXPECT_STREQ(test, r.unit_text, "mm");
	KUNIT_EXPECT_EQ(test, r.bit, 16u);
	KUNIT_EXPECT_EQ(test, r.bits, 32);
	KUNIT_EXPECT_EQ(test, r.type, 4);
	KUNIT_EXPECT_EQ(test, r.scale.num, -3);
	KUNIT_EXPECT_EQ(test, r.scale.den, 1000u);
	KUNIT_EXPECT_EQ(test, r.offset.den, 2u);
}

static void vectors_compiled_pdos(struct kunit *test)
{
	struct ec_compiled_record r;
	struct ec_compiled_entry e;
	struct ec_compiled_pdo pdo;
	struct ec_compiled_sm sm;
	struct ec_rbuf at;

	KUNIT_ASSERT_EQ(test, ec_compiled_check(&c, f.data, whole()), 0);
	r = find(EC_COMPILED_PDOS);
	at = ec_rbuf(r.data, r.size);
	sm = ec_compiled_sm(&at);
	KUNIT_EXPECT_EQ(test, sm.index, 2);
	KUNIT_EXPECT_EQ(test, sm.dir, 1);
	pdo = ec_compiled_pdo(&at);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1600);
	KUNIT_EXPECT_EQ(test, pdo.n_entries, 0);
	sm = ec_compiled_sm(&at);
	KUNIT_EXPECT_EQ(test, sm.n_pdos, 1);
	pdo = ec_compiled_pdo(&at);
	KUNIT_EXPECT_EQ(test, pdo.n_entries, 2);
	e = ec_compiled_entry(&at);
	KUNIT_EXPECT_EQ(test, e.index, 0x6000);
	KUNIT_EXPECT_EQ(test, e.subindex, 0x11);
	KUNIT_EXPECT_EQ(test, e.bits, 32);
	ec_compiled_entry(&at);
	KUNIT_EXPECT_EQ(test, ec_rbuf_left(&at), 0u);
}

static void vectors_compiled_header(struct kunit *test)
{
	size_t size = whole(), n;

	for (n = 0; n < size; n++)
		KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, f.data, n), -EBADMSG);
	f.data[size - 1] ^= 1;
	KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, f.data, size), -EBADMSG);
	KUNIT_EXPECT_EQ(test, c.at, 16u);
	KUNIT_EXPECT_EQ(test, memcmp(c.why, "CRC 0x", 6), 0);
	f.data[8] = 2;
	KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, f.data, size), -EPROTONOSUPPORT);
	KUNIT_EXPECT_STREQ(test, c.why, "version 2, expected 1; compile the bus file again");
	f.data[0] = 'e';
	KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, f.data, size), -EBADMSG);
	KUNIT_EXPECT_EQ(test, c.at, 0u);
}

/* With a right checksum: valid, or refused with a reason; never behind its end (ASan, KASAN). */
static void vectors_compiled_each_byte_wrong(struct kunit *test)
{
	static u8 copy[sizeof(f.data)];
	size_t size = whole(), i;
	unsigned int k;
	int ret;

	for (i = EC_COMPILED_HEADER; i < size; i++)
		for (k = 0; k < 10; k++) {
			memcpy(copy, f.data, size);
			copy[i] = k < 8 ? copy[i] ^ (1 << k) : k == 8 ? 0xff : 0;
			seal(copy, size, f.n);
			ret = ec_compiled_check(&c, copy, size);
			KUNIT_EXPECT_TRUE(test, !ret || (ret == -EINVAL && c.why[0] &&
							 c.at <= size));
		}
	for (i = EC_COMPILED_HEADER; i < size; i++) {
		memcpy(copy, f.data, i);
		seal(copy, i, f.n);
		KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, copy, i), -EINVAL);
	}
}

/* the place in the file where the body of the first record of @op begins */
static u8 *body_of(u16 op)
{
	ec_compiled_check(&c, f.data, whole());
	return f.data + find(op).at + EC_COMPILED_RECORD;
}

static void refused(struct kunit *test, const char *why)
{
	size_t size = (size_t)(f.w.p - f.data);

	seal(f.data, size, f.n);
	KUNIT_EXPECT_EQ(test, ec_compiled_check(&c, f.data, size), -EINVAL);
	KUNIT_EXPECT_STREQ(test, c.why, why);
}

static void vectors_compiled_counts_overflow(struct kunit *test)
{
	static const u32 sizes[] = { 1, 3, 9, 0x7fffffff, 0xfffffff8, 0xfffffffc, 0xffffffff };
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		put_unaligned_le32(sizes[i], body_of(EC_COMPILED_DOMAIN_UNIT) - 4);
		refused(test, "record 2 of 21 (domain in a unit): its length or a text is wrong");
	}
	whole();
	f.n = 0xffffffff;
	refused(test, "record 21 of 4294967295 (unknown operation): this version does not know it");
	whole();
	f.n = 20;
	refused(test, "68 bytes behind 20 records");
	put_unaligned_le16(99, body_of(EC_COMPILED_UNIT) - 8);
	refused(test, "record 1 of 21 (unknown operation): this version does not know it");
	put_unaligned_le16(0xffff, body_of(EC_COMPILED_PDOS) + 6);
	refused(test, "record 13 of 21 (PDOs): a number is wrong");
	put_unaligned_le16(0xffff, body_of(EC_COMPILED_PDOS) + 10);
	refused(test, "record 13 of 21 (PDOs): a number is wrong");
}

static void vectors_compiled_references(struct kunit *test)
{
	put_unaligned_le32(1, body_of(EC_COMPILED_DOMAIN_UNIT));
	refused(test, "domain in a unit: there is no domain 1 before, expected less than 1");
	put_unaligned_le32(1, body_of(EC_COMPILED_DOMAIN_UNIT) + 4);
	refused(test, "domain in a unit: there is no unit 1 before, expected less than 1");
	put_unaligned_le32(0x80000000, body_of(EC_COMPILED_MEMBER));
	refused(test, "member of a group: there is no group 2147483648 before, expected less than 1");
	/* one that comes later */
	put_unaligned_le32(1, body_of(EC_COMPILED_GROUP) + 11);
	refused(test, "group: there is no slave 1 before, expected less than 1");
	put_unaligned_le32(2, body_of(EC_COMPILED_CLOCK));
	refused(test, "reference clock: there is no slave 2 before, expected less than 2");
	put_unaligned_le32(EC_COMPILED_NONE, body_of(EC_COMPILED_SDO));
	refused(test, "SDO: there is no slave 4294967295 before, expected less than 2");
	start();
	add_value("x", 0, 1, 1);
	refused(test, "value: there is no registration 0 before, expected less than 0");
}

static void vectors_compiled_numbers(struct kunit *test)
{
	static const struct {
		u16 op;
		unsigned int at;
		u8 value;
	} wrong[] = {
		{ EC_COMPILED_UNIT, 7, 5 }, { EC_COMPILED_UNIT, 23, 8 },
		{ EC_COMPILED_GROUP, 7, 0 }, { EC_COMPILED_GROUP, 8, 4 },
		{ EC_COMPILED_SDO, 7, 2 }, { EC_COMPILED_IDN, 6, 8 }, { EC_COMPILED_IDN, 7, 8 },
		{ EC_COMPILED_COMMAND, 4, 0x25 }, { EC_COMPILED_COMMAND, 5, 3 },
		{ EC_COMPILED_TIMEOUT, 4, 5 }, { EC_COMPILED_PDOS, 4, 16 },
		{ EC_COMPILED_PDOS, 5, 0 }, { EC_COMPILED_PDOS, 12, 2 },
		{ EC_COMPILED_PLACE, 8, 16 }, { EC_COMPILED_CYCLE, 7, 1 },
		{ EC_COMPILED_VALUE, 23, 0 }, { EC_COMPILED_VALUE, 24, 12 },
	};
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(wrong); i++) {
		body_of(wrong[i].op)[wrong[i].at] = wrong[i].value;
		seal(f.data, (size_t)(f.w.p - f.data), f.n);
		KUNIT_EXPECT_EQ_MSG(test, ec_compiled_check(&c, f.data, (size_t)(f.w.p - f.data)),
				    -EINVAL, "%u", i);
		KUNIT_EXPECT_NOT_NULL(test, strstr(c.why, "a number is wrong"));
	}
}

static void vectors_compiled_texts(struct kunit *test)
{
	static const char *const why =
		"record 1 of 21 (sync unit): its length or a text is wrong";

	body_of(EC_COMPILED_UNIT)[6] = 'x';	/* no terminator */
	refused(test, why);
	body_of(EC_COMPILED_UNIT)[3] = 0;	/* one before the end */
	refused(test, why);
	body_of(EC_COMPILED_UNIT)[3] = '\n';
	refused(test, why);
	body_of(EC_COMPILED_UNIT)[0] = 0;
	refused(test, why);
	body_of(EC_COMPILED_UNIT)[1] = 0xff;
	refused(test, why);
	whole();
	add_value("b", 0, 1, 1);
	refused(test, "value 'b' does not follow 'b' in the order of names");
	whole();
	add_value("a.y", 0, 1, 1);
	refused(test, "value 'a.y' does not follow 'b' in the order of names");
	whole();
	add_value("c", 0, 0, 1);
	refused(test, "record 21 of 22 (value): a number is wrong");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_compiled_crc),
	KUNIT_CASE(vectors_compiled_counts_and_calls),
	KUNIT_CASE(vectors_compiled_slaves),
	KUNIT_CASE(vectors_compiled_pdos),
	KUNIT_CASE(vectors_compiled_header),
	KUNIT_CASE(vectors_compiled_each_byte_wrong),
	KUNIT_CASE(vectors_compiled_counts_overflow),
	KUNIT_CASE(vectors_compiled_references),
	KUNIT_CASE(vectors_compiled_numbers),
	KUNIT_CASE(vectors_compiled_texts),
	{}
};

static struct kunit_suite suite = { .name = "vectors_compiled", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
