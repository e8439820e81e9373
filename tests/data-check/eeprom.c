// SPDX-License-Identifier: GPL-2.0-only
/*
 * EEPROM images: compared with values found by an independent decoder, taken
 * apart and built again byte by byte.
 */
#include "check.h"
#include "../../devices/sim/sii_build.h"
#include <stdlib.h>

static const struct image {
	const char *name;
	u32 vendor;
	u32 product;
	u32 revision;
	u32 serial;
	u8 checksum;
	struct ec_sii_mbox mbox;
	u16 protocols;
	const char *cats;	/* type:words */
	const char *order;
} images[] = {
	{ "ek1100", 0x2, 0x044c2c52, 0x00120000, 0, 0x46, { 0, 0, 0, 0 }, 0,
	  "10:34 30:16", "EK1100" },
	{ "el2004", 0x2, 0x07d43052, 0x00100000, 0, 0xd8, { 0, 0, 0, 0 }, 0,
	  "10:65 30:16 40:1 41:4 43:1 51:32", "EL2004" },
	{ "el2828", 0x2, 0x0b0c3052, 0x00110000, 0, 0xe2, { 0, 0, 0, 0 }, 0,
	  "3:36 10:84 30:16 40:1 41:4 43:1 51:64", "EL2828" },
	{ "akd", 0x6a, 0x00414b44, 0x2, 0x99830093, 0x10, { 0x1800, 1024, 0x1c00, 1024 }, 0x000e,
	  "2048:10 2049:6 10:239 30:16 40:2 41:16 43:1 50:260 51:184 60:24", "AKD" },
	{ "ni9144", 0x1f9, 0x000023b8, 0x1, 0, 0x0a, { 0x1f00, 256, 0x1c00, 768 }, 0x000d,
	  "10:47 30:16 40:1 41:16 42:4 50:20 60:24", "NI 9144" },
	{ "soes_demo", 0x1337, 0x12783456, 0x1, 0, 0xd7, { 0x1000, 128, 0x1080, 128 }, 0x0004,
	  "10:42 30:16 40:1 41:16", NULL },
};

static int faults;
static const char *file;

#define EXPECT(cond)							\
	do {								\
		if (!(cond)) {						\
			printf("%s: not so: %s\n", file, #cond);	\
			faults++;					\
		}							\
	} while (0)

static const struct image *find(const char *path)
{
	const char *base = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
	size_t i, n;

	for (i = 0; i < ARRAY_SIZE(images); i++) {
		n = strlen(images[i].name);
		if (!strncmp(base, images[i].name, n) && !strcmp(base + n, ".bin"))
			return &images[i];
	}
	return NULL;
}

static void compare(const struct image *want, const u8 *img, size_t len,
		    const struct ec_sii_info *info, const char *cats)
{
	struct ec_sii_general g;
	char order[64];

	EXPECT(info->vendor == want->vendor);
	EXPECT(info->product == want->product);
	EXPECT(info->revision == want->revision);
	EXPECT(info->serial == want->serial);
	EXPECT(info->checksum == want->checksum);
	EXPECT(!memcmp(&info->std, &want->mbox, sizeof(want->mbox)));
	EXPECT(info->protocols == want->protocols);
	EXPECT(!strcmp(cats, want->cats));
	EXPECT(!ec_sii_decode_general(img, len, &g));
	if (want->order) {
		EXPECT(ec_sii_string(img, len, g.order, order, sizeof(order)) > 0);
		EXPECT(!strcmp(order, want->order));
	}
	if (!strcmp(want->name, "ek1100"))	/* feeds the E-bus */
		EXPECT(g.current_ma == -2000 && (g.ports >> 4 & 0xF) == 3);
	if (!strcmp(want->name, "akd")) {
		struct ec_sii_dc dc[4];

		EXPECT(ec_sii_decode_dcs(img, len, dc, 4) == 2);
		EXPECT(dc[0].assign == 0x0300 && dc[0].factor0 == 1 && dc[1].assign == 0);
	}
}

/* The categories with a structure, decoded and encoded, are what they were. */
static void rebuild_cats(const u8 *img, size_t len)
{
	static u8 out[EC_SII_MAX_SIZE];
	static const u16 types[] = { 41, 50, 51, 60 };
	struct ec_sii_iter it;
	struct ec_sii_cat cat, again;
	struct ec_sii_info info;
	size_t i;

	ec_sii_decode_info(img, len, &info);
	for (i = 0; i < ARRAY_SIZE(types); i++) {
		struct ec_sii_builder b;
		struct ec_sii_pdo_iter pit;
		struct ec_sii_pdo pdo;
		struct ec_sii_sm sm[16];
		struct ec_sii_dc dc[16];

		ec_sii_iter_init(&it, img, len);
		while (ec_sii_iter_next(&it, &cat) == 1 && cat.type != types[i])
			;
		if (it.end != 1)
			continue;
		ec_sii_build_begin(&b, out, sizeof(out), &info);
		ec_sii_build_sms(&b, sm, types[i] == 41 ?
				 (unsigned int)ec_sii_decode_sms(img, len, sm, 16) : 0);
		ec_sii_build_dcs(&b, dc, types[i] == 60 ?
				 (unsigned int)ec_sii_decode_dcs(img, len, dc, 16) : 0);
		ec_sii_pdo_iter_init(&pit, img, len, types[i]);
		while (types[i] / 10 == 5 && ec_sii_pdo_iter_next(&pit, &pdo) == 1) {
			struct ec_sii_pdo_entry e[255];
			unsigned int k;

			for (k = 0; k < pdo.entries; k++)
				ec_sii_pdo_entry(&pdo, k, &e[k]);
			ec_sii_build_pdo(&b, types[i], &pdo, e);
		}
		EXPECT(ec_sii_build_end(&b) > 0);
		ec_sii_iter_init(&it, out, sizeof(out));
		EXPECT(ec_sii_iter_next(&it, &again) == 1);
		if (again.type != cat.type || again.bytes != cat.bytes ||
		    memcmp(again.data, cat.data, cat.bytes)) {
			printf("%s: category %u is not the same after decoding and encoding\n",
			       file, cat.type);
			faults++;
		}
	}
}

static void rebuild_all(const u8 *img, size_t len, size_t used)
{
	static u8 out[EC_SII_MAX_SIZE];
	struct ec_sii_builder b;
	struct ec_sii_info info;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t i;

	ec_sii_decode_info(img, len, &info);
	ec_sii_build_begin(&b, out, sizeof(out), &info);
	ec_sii_iter_init(&it, img, len);
	while (ec_sii_iter_next(&it, &cat) == 1)
		ec_sii_build_category(&b, cat.type, cat.data, cat.bytes);
	EXPECT(ec_sii_build_end(&b) == (int)used);
	for (i = 0; i < used; i++) {
		/* reserved words hold data of the vendor's tools */
		if ((i >= 0x20 && i < 0x28) || (i >= 0x3A && i < 0x7C))
			continue;
		if (out[i] != img[i]) {
			printf("%s: byte 0x%zx is 0x%02x after decoding and encoding, was 0x%02x\n",
			       file, i, out[i], img[i]);
			faults++;
			return;
		}
	}
}

/* Everything a decoder may be asked, of an image without a byte behind it. */
static void decode_all(const u8 *img, size_t len)
{
	static const u16 dirs[] = { EC_SII_CAT_TXPDO, EC_SII_CAT_RXPDO };
	struct ec_sii_general g;
	struct ec_sii_info info;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	struct ec_sii_sm sm[16];
	struct ec_sii_dc dc[16];
	char text[256];
	unsigned int i, k;

	ec_sii_decode_info(img, len, &info);
	ec_sii_decode_general(img, len, &g);
	ec_sii_decode_sms(img, len, sm, 16);
	ec_sii_decode_dcs(img, len, dc, 16);
	for (i = 0; i < 256; i++)
		ec_sii_string(img, len, (u8)i, text, sizeof(text));
	ec_sii_iter_init(&it, img, len);
	while (ec_sii_iter_next(&it, &cat) == 1)
		EXPECT(cat.data >= img && cat.data + cat.bytes <= img + len);
	for (i = 0; i < ARRAY_SIZE(dirs); i++) {
		struct ec_sii_pdo_iter pit;
		struct ec_sii_pdo_entry e;
		struct ec_sii_pdo pdo;

		ec_sii_pdo_iter_init(&pit, img, len, dirs[i]);
		while (ec_sii_pdo_iter_next(&pit, &pdo) == 1)
			for (k = 0; k < pdo.entries; k++)
				ec_sii_pdo_entry(&pdo, k, &e);
	}
	ec_sii_used(img, len);
	ec_sii_needed(img, len);
}

/* ... of each of its beginnings, too. */
static void decode_cut(const u8 *img, size_t len)
{
	size_t n;

	for (n = 0; n <= len; n++) {
		u8 *cut = malloc(n);

		memcpy(cut, img, n);
		decode_all(cut, n);
		free(cut);
	}
}

/*
 * Reads an image as a scan does, 8 bytes at a time, from a chip of @size bytes. Returns the
 * number of bytes read when no more are needed, 0 if the chip ends before.
 */
static size_t fetch(const u8 *chip, size_t size)
{
	size_t have = 0;
	int need;

	for (;;) {
		u8 *copy = malloc(have);

		memcpy(copy, chip, have);
		need = ec_sii_needed(copy, have);
		free(copy);
		if (need <= 0)
			return need ? 0 : have;
		have = ((size_t)need + 7) & ~(size_t)7;
		if (have > size)
			return 0;
	}
}

/* A scan ends where the image ends. A chip is empty behind a shorter file. */
static void scan(const u8 *data, size_t len, size_t used)
{
	size_t have, size = (len + 7) & ~(size_t)7;
	u8 *chip = malloc(size);

	memset(chip, 0xff, size);
	memcpy(chip, data, len);
	have = fetch(chip, size);
	EXPECT(have >= used && have < used + 8);
	EXPECT(ec_sii_used(chip, have) == used);
	free(chip);
}

/* A damaged image: no decoder reads beyond it, whatever it says. */
int check_damaged(const char *path, const u8 *data, size_t len, char *note, size_t cap)
{
	struct ec_sii_info info = { 0 };
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	unsigned int cats = 0;
	int ret;

	file = path;
	faults = 0;
	decode_cut(data, len);
	fetch(data, len);
	EXPECT(!ec_sii_decode_info(data, len, &info));
	ec_sii_iter_init(&it, data, len);
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1)
		cats++;
	EXPECT(ret < 0);
	snprintf(note, cap, "%zu bytes, vendor 0x%x product 0x%08x, refused after %u categories",
		 len, info.vendor, info.product, cats);
	return faults;
}

int check_eeprom(const char *path, const u8 *data, size_t len, char *note, size_t cap)
{
	const struct image *want = find(path);
	struct ec_sii_info info;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	char cats[256] = "";
	size_t n, used;
	unsigned int i, pdos = 0;
	int ret;

	file = path;
	faults = 0;
	EXPECT(!ec_sii_decode_info(data, len, &info));
	if (faults)
		return faults;
	EXPECT(info.checksum_ok);

	ec_sii_iter_init(&it, data, len);
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1) {
		size_t at = strlen(cats);

		snprintf(cats + at, sizeof(cats) - at, "%s%u:%u", at ? " " : "",
			 cat.type, cat.words);
	}
	EXPECT(ret == 0);
	if (want)
		compare(want, data, len, &info, cats);
	else
		printf("%s: not in the table, decoded only\n", path);

	used = ec_sii_used(data, len);
	/* files of all sizes */
	for (n = used; n < used + 8 && n < len; n++)
		scan(data, n, used);
	scan(data, len, used);
	rebuild_cats(data, len);
	rebuild_all(data, len, used);
	decode_cut(data, len);
	for (i = EC_SII_CAT_TXPDO; i <= EC_SII_CAT_RXPDO; i++) {
		struct ec_sii_pdo_iter pit;
		struct ec_sii_pdo pdo;

		ec_sii_pdo_iter_init(&pit, data, len, (u16)i);
		while ((ret = ec_sii_pdo_iter_next(&pit, &pdo)) == 1)
			pdos++;
		EXPECT(ret == 0);
	}
	snprintf(note, cap, "vendor 0x%x product 0x%08x, %zu bytes used, %u PDOs, categories %s",
		 info.vendor, info.product, used, pdos, cats);
	return faults;
}
