// SPDX-License-Identifier: GPL-2.0-only
/* SII images: all decoders, and the reader that fetches piece by piece. */
#include "fuzz.h"
#include "../../devices/sim/sii_build.h"

#define FIXED "\x05\x0E\x03\x06\x10\x27\0\0\0\0\0\0\0\0\xD7\0\x37\x13\0\0\x56\x34\x12\0\1\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x10\x80\0\x80\x10\x80\0\4\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0F\0\1\0"

const struct fuzz_seed fuzz_seeds[] = {
	SEED(FIXED "\x0A\0\5\0\3\2AB\3CDE\1F\0"
	     "\x1E\0\x10\0\1\2\3\1\0\x21\1\0\0\0\0\4\x30\xF8\1\0\x11\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
	     "\x28\0\2\0\1\2\3\0"
	     "\x29\0\x08\0\0\x10\x80\0\x26\0\1\1\x80\x10\x80\0\x22\0\1\2"
	     "\x32\0\x08\0\0\x1A\1\3\0\1\0\0\0\x60\1\1\6\x10\0\0"
	     "\x33\0\x04\0\0\x16\0\2\0\1\0\0"
	     "\x3C\0\x0C\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\3\1\0\1\2\0\0\0\0"
	     "\xFF\xFF"),
	SEED(FIXED "\xFF\xFF"),
	SEED(FIXED "\0\0\0\0\0\0\0\0\0\0\0\0"),
	SEED(FIXED "\x0A\0\2\0\1\1A\xFF\x0A\0\2\0\1\1B\xFF\xFF\xFF\0\0"),
	{ NULL, 0 }
};

static void read_pieces(const uint8_t *img, size_t len)
{
	size_t have = 0, limit = 0;
	struct ec_sii_flaw flaw;
	int need;

	MUST(ec_sii_check(img, len, &flaw) == flaw.kind && flaw.end <= len);
	while ((need = ec_sii_needed(img, have)) > 0) {
		MUST((size_t)need > have && need <= EC_SII_MAX_SIZE);
		MUST(++limit < 1000);
		if ((size_t)need > len)
			return;
		have = (size_t)need;
	}
	MUST(!need && ec_sii_used(img, have) <= have);
}

static void pdos(const uint8_t *img, size_t len, u16 type)
{
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	struct ec_sii_pdo_entry e;
	unsigned int i, n = 0;
	int ret;

	ec_sii_pdo_iter_init(&it, img, len, type);
	while ((ret = ec_sii_pdo_iter_next(&it, &pdo)) == 1) {
		MUST(++n <= EC_SII_MAX_SIZE / 8);
		for (i = 0; i < pdo.entries; i++)
			MUST(!ec_sii_pdo_entry(&pdo, i, &e));
		MUST(ec_sii_pdo_entry(&pdo, i, &e) == -ENOENT);
	}
	MUST(ec_sii_pdo_iter_next(&it, &pdo) == ret);
}

/* all PDOs of a direction, as long as they are sound */
static void build_pdos(struct ec_sii_builder *b, const uint8_t *img, size_t len, u16 type)
{
	static struct ec_sii_pdo_entry e[255];
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	unsigned int i;

	ec_sii_pdo_iter_init(&it, img, len, type);
	while (ec_sii_pdo_iter_next(&it, &pdo) == 1) {
		for (i = 0; i < pdo.entries; i++)
			ec_sii_pdo_entry(&pdo, i, &e[i]);
		ec_sii_build_pdo(b, type, &pdo, e);
	}
}

static unsigned int count_pdos(const uint8_t *img, size_t len)
{
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	unsigned int n = 0;

	ec_sii_pdo_iter_init(&it, img, len, EC_SII_CAT_TXPDO);
	while (ec_sii_pdo_iter_next(&it, &pdo) == 1)
		n += 1u + pdo.entries;
	return n;
}

/* A decoded image, built anew, decodes to the same. */
static void rebuild(const uint8_t *img, size_t len)
{
	static u8 out[EC_SII_MAX_SIZE];
	struct ec_sii_builder b;
	struct ec_sii_info info, info2;
	struct ec_sii_sm sm[16], sm2[16];
	struct ec_sii_dc dc[8], dc2[8];
	int n, m, used;

	if (ec_sii_decode_info(img, len, &info))
		return;
	n = ec_sii_decode_sms(img, len, sm, 16);
	m = ec_sii_decode_dcs(img, len, dc, 8);
	ec_sii_build_begin(&b, out, sizeof(out), &info);
	ec_sii_build_fmmus(&b, img, 3);
	ec_sii_build_sms(&b, sm, (unsigned int)n);
	ec_sii_build_dcs(&b, dc, (unsigned int)m);
	build_pdos(&b, img, len, EC_SII_CAT_TXPDO);
	used = ec_sii_build_end(&b);
	MUST(used > 0 && ec_sii_used(out, sizeof(out)) == (size_t)used);
	MUST(!ec_sii_decode_info(out, sizeof(out), &info2) && info2.checksum_ok);
	MUST(info2.vendor == info.vendor && info2.std.tx_size == info.std.tx_size);
	MUST(ec_sii_decode_sms(out, sizeof(out), sm2, 16) == n);
	MUST(!memcmp(sm, sm2, sizeof(*sm) * (size_t)n));
	MUST(ec_sii_decode_dcs(out, sizeof(out), dc2, 8) == m);
	MUST(count_pdos(out, sizeof(out)) == count_pdos(img, len));
	for (; m; m--)
		MUST(dc[m - 1].assign == dc2[m - 1].assign &&
		     dc[m - 1].factor0 == dc2[m - 1].factor0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	static unsigned int calls;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	struct ec_sii_general g;
	struct ec_sii_sm sm[3];
	struct ec_sii_dc dc[2];
	char s[16];
	int i, ret;

	ec_sii_iter_init(&it, data, len);
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1)
		MUST(cat.data >= data && cat.data + cat.bytes <= data + len);
	MUST(ec_sii_iter_next(&it, &cat) == ret);
	for (i = 0; i < 256; i += i < 8 ? 1 : 31) {
		size_t cap = 1 + (size_t)i % sizeof(s);

		memset(s, 'x', sizeof(s));
		ret = ec_sii_string(data, len, (u8)i, s, cap);
		MUST(ret < (int)cap && memchr(s, 0, cap));
		if (ret >= 0)
			MUST(strlen(s) == (size_t)ret);
	}
	ec_sii_decode_general(data, len, &g);
	MUST(ec_sii_decode_sms(data, len, sm, 3) <= 3);
	MUST(ec_sii_decode_dcs(data, len, dc, 2) <= 2);
	pdos(data, len, EC_SII_CAT_TXPDO);
	pdos(data, len, EC_SII_CAT_RXPDO);
	read_pieces(data, len);
	if (!(calls++ & 15))
		rebuild(data, len);
	return 0;
}
