// SPDX-License-Identifier: GPL-2.0-only
/*
 * Compiled bus files: refused with a place and a reason, or all that the kernel relies on holds.
 * Input: a byte, then a whole file, or, with an odd byte, records that get a right header.
 */
#include "fuzz.h"
#include "../../master/wire/compiled.h"

/* every operation, as in tests/unit/vectors_compiled_kunit.c */
const struct fuzz_seed fuzz_seeds[] = {
	SEED("\1"
	     "\1\0\0\0\0\0\0\0"
	     "\2\0\0\0\33\0\0\0\5\0axes\0\3\0\0\0\2\0\0\0d\0\0\0\1\0\0\0\5\0\0\0\0"
	     "\3\0\0\0\10\0\0\0\0\0\0\0\0\0\0\0"
	     "\4\0\0\0\14\0\0\0\5\0\0\0\2\0\0\0R0!\34"
	     "\5\0\0\0\23\0\0\0\5\0dock\0\3\2\0\0\0\0\0\0\2\0\0\0\0"
	     "\6\0\0\0\20\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0000\0\0\0"
	     "\7\0\0\0\33\0\0\0\0\0\0\0\21\0ExpectedRevision\0\0\0\22\0\0"
	     "\10\0\0\0\11\0\0\0\1\0\0\0\20\200\1\0\5\0\0\0"
	     "\11\0\0\0\12\0\0\0\1\0\0\0 \0\1\2\13\0\0\0"
	     "\12\0\0\0\20\0\0\0\1\0\0\0$\0P\360\1\0\2\0\1\2\3\4"
	     "\13\0\0\0\14\0\0\0\1\0\0\0\2\4\0\0\20'\0\0"
	     "\14\0\0\0\10\0\0\0\1\0\0\0\364\1\0\0"
	     "\15\0\0\0\24\0\0\0\1\0\0\0\0\7\0\0@B\17\0p/\374\377\5\0\0\0"
	     "\16\0\0\0\34\0\0\0\1\0\0\0\2\1\1\0\0\26\0\0\3\2\1\0\0\32\2\0\0`\21 \0\0\0\10"
	     "\17\0\0\0\14\0\0\0\1\0\0\0\0\0\0\0\3\0\1\0"
	     "\20\0\0\0\10\0\0\0\1\0\0\0\0\0\0\0"
	     "\21\0\0\0\4\0\0\0\1\0\0\0"
	     "\22\0\0\0\10\0\0\0@B\17\0\0\0\0\0"
	     "\23\0\0\0\14\0\0\0ethercat: 1\12"
	     "\24\0\0\0;\0\0\0\4\0a.x\0\3\0mm\0\0\0\0\0\20\0\0\0\21\0`\0 \4\0\0\375\377\377"
	     "\377\377\377\377\377\350\3\0\0\0\0\0\0\7\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0\0"
	     "\24\0\0\0009\0\0\0\2\0b\0\3\0mm\0\0\0\0\0\20\0\0\0\21\0`\0\1\4\0\0\375\377\377"
	     "\377\377\377\377\377\1\0\0\0\0\0\0\0\7\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0\0\0\0"),
	SEED("\1\1\0\0\0\0\0\0\0\4\0\0\0\14\0\0\0\5\0\0\0\2\0\0\0\3\0\0\0"
	     "\20\0\0\0\10\0\0\0\0\0\0\0\0\0\0\0"),
	SEED("\1\4\0\0\0\14\0\0\0\5\0\0\0\2\0\0\0\3\0\0\0"
	     "\16\0\0\0\20\0\0\0\0\0\0\0\3\2\1\0\0\32\1\0\0\140\21\40"),
	SEED("\0ECATBUS\0\1\0\0\0\30\0\0\0\0\0\0\0\0\0\0\0"),
	{ NULL, 0 }
};

/* header for records that are in @image already */
static void seal(u8 *image, size_t size)
{
	size_t at = EC_COMPILED_HEADER, n = 0;

	while (size - at >= EC_COMPILED_RECORD) {
		size_t next = EC_COMPILED_RECORD +
			((size_t)get_unaligned_le32(image + at + 4) + 3) / 4 * 4;

		n++;
		if (next > size - at)
			break;
		at += next;
	}
	memcpy(image, EC_COMPILED_MAGIC, sizeof(EC_COMPILED_MAGIC));
	put_unaligned_le16(EC_COMPILED_VERSION, image + 8);
	put_unaligned_le16(0, image + 10);
	put_unaligned_le32((u32)size, image + 12);
	put_unaligned_le32((u32)n, image + 20);
	put_unaligned_le32(ec_compiled_crc(image + 20, size - 20), image + EC_COMPILED_CRC_AT);
}

static void walk_pdos(const struct ec_compiled_record *r)
{
	struct ec_rbuf at = ec_rbuf(r->data, r->size);

	while (ec_rbuf_left(&at)) {
		struct ec_compiled_sm sm = ec_compiled_sm(&at);

		MUST(sm.index < 16 && (sm.dir == 1 || sm.dir == 2));
		for (; sm.n_pdos; sm.n_pdos--) {
			struct ec_compiled_pdo pdo = ec_compiled_pdo(&at);

			for (; pdo.n_entries; pdo.n_entries--)
				MUST(ec_compiled_entry(&at).bits);
		}
		MUST(!at.bad);
	}
}

/* the kernel uses these numbers as indexes, and divides by some */
static void check_record(const struct ec_compiled *so_far, const struct ec_compiled_record *r)
{
	MUST(r->slave < so_far->n_slaves || !r->slave || r->op == EC_COMPILED_GROUP);
	/* a text ends where its record says */
	MUST(!r->name || get_unaligned_le16(r->name - 2) == strlen(r->name) + 1);
	switch (r->op) {
	case EC_COMPILED_GROUP:
		MUST(r->slave == EC_COMPILED_NONE || r->slave < so_far->n_slaves);
		break;
	case EC_COMPILED_MEMBER:
		MUST(r->group < so_far->n_groups);
		break;
	case EC_COMPILED_DOMAIN_UNIT:
		MUST(r->unit < so_far->n_units && r->domain < so_far->n_domains);
		break;
	case EC_COMPILED_PLACE:
	case EC_COMPILED_REST:
		MUST(r->slave < so_far->n_slaves && r->domain < so_far->n_domains &&
		     r->subindex < 16);
		break;
	case EC_COMPILED_PDOS:
		walk_pdos(r);
		break;
	case EC_COMPILED_SDO:
	case EC_COMPILED_IDN:
	case EC_COMPILED_COMMAND:
		MUST(r->size && r->data);
		break;
	case EC_COMPILED_VALUE:
		MUST(r->place < so_far->n_places && r->bits && r->scale.den && r->offset.den);
		MUST(get_unaligned_le16(r->unit_text - 2) == strlen(r->unit_text) + 1);
		break;
	}
}

static void walk(const struct ec_compiled *c)
{
	struct ec_rbuf at = ec_compiled_begin(c);
	struct ec_compiled n = { 0 };
	struct ec_compiled_record r;

	while (ec_compiled_next(c, &at, &r)) {
		check_record(&n, &r);
		n.n_records++;
		n.n_domains += r.op == EC_COMPILED_DOMAIN;
		n.n_units += r.op == EC_COMPILED_UNIT;
		n.n_groups += r.op == EC_COMPILED_GROUP;
		n.n_slaves += r.op == EC_COMPILED_SLAVE || r.op == EC_COMPILED_MEMBER;
		n.n_places += r.op == EC_COMPILED_PLACE;
		if (r.op != EC_COMPILED_VALUE)
			continue;
		n.n_values++;
		n.texts += (u32)(strlen(r.name) + strlen(r.unit_text) + 2);
	}
	MUST(n.n_records == c->n_records && n.n_domains == c->n_domains &&
	     n.n_units == c->n_units && n.n_groups == c->n_groups && n.n_slaves == c->n_slaves &&
	     n.n_places == c->n_places && n.n_values == c->n_values && n.texts == c->texts);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	size_t size = len ? len - 1 : 0, head = 0;
	struct ec_compiled c;
	u8 *image;
	int ret;

	if (!len)
		return 0;
	if (*data & 1)
		head = EC_COMPILED_HEADER;
	size += head;
	/* exactly as large as needed: one byte too far is an ASan report */
	image = malloc(size ? size : 1);
	MUST(image);
	memcpy(image + head, data + 1, len - 1);
	if (head)
		seal(image, size);
	ret = ec_compiled_check(&c, image, size);
	MUST(!ret || (c.why[0] && c.at <= size));
	MUST(!head || !ret || ret == -EINVAL);
	if (!ret)
		walk(&c);
	free(image);
	return 0;
}
