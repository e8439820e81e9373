// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/* What is wrong with an EEPROM image: for a warning, never a reason not to read it. */
#include "sii.h"

#define GENERAL_MIN	18

static bool is_filled(const u8 *p, size_t len, u8 with)
{
	size_t i;

	for (i = 0; i < len; i++)
		if (p[i] != with)
			return false;
	return true;
}

static bool strings_fit(const struct ec_sii_cat *cat)
{
	struct ec_rbuf r = ec_rbuf(cat->data, cat->bytes);
	unsigned int n = ec_rbuf_u8(&r);

	for (; n && !r.bad; n--)
		ec_rbuf_take(&r, ec_rbuf_u8(&r));
	return !r.bad;
}

static bool pdos_fit(const struct ec_sii_cat *cat)
{
	struct ec_rbuf r = ec_rbuf(cat->data, cat->bytes);

	while (!r.bad && ec_rbuf_left(&r) >= EC_SII_PDO_BYTES) {
		unsigned int entries;

		ec_rbuf_le16(&r);
		entries = ec_rbuf_u8(&r);
		ec_rbuf_take(&r, EC_SII_PDO_BYTES - 3 + (size_t)entries * EC_SII_PDO_BYTES);
	}
	return !r.bad;
}

static bool entries_fit(const struct ec_sii_cat *cat)
{
	switch (cat->type) {
	case EC_SII_CAT_STRINGS:
		return strings_fit(cat);
	case EC_SII_CAT_TXPDO:
	case EC_SII_CAT_RXPDO:
		return pdos_fit(cat);
	case EC_SII_CAT_GENERAL:
		return cat->bytes >= GENERAL_MIN;
	case EC_SII_CAT_SM:
		return cat->bytes % EC_SII_SM_BYTES == 0;
	default:
		return true;
	}
}

/**
 * ec_sii_check() - find what is wrong with an image
 * @img: image
 * @len: bytes of it that were read
 * @f: the first flaw, that of the whole image before that of an entry
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: @f->kind.
 */
enum ec_sii_flaw_kind ec_sii_check(const u8 *img, size_t len, struct ec_sii_flaw *f)
{
	struct ec_sii_cat cat = { .type = 0 };
	struct ec_sii_iter it;
	bool misfit = false;
	int ret;

	memset(f, 0, sizeof(*f));
	if (len < EC_SII_FIXED_SIZE)
		return f->kind = EC_SII_FLAW_NO_END;
	f->declared = ((size_t)get_unaligned_le16(img + 2 * EC_SII_W_SIZE) + 1) * 128;
	f->declared = min_t(size_t, f->declared, EC_SII_MAX_SIZE);
	if (is_filled(img, EC_SII_FIXED_SIZE, img[0]) && (!img[0] || img[0] == 0xFF)) {
		f->type = img[0];
		return f->kind = EC_SII_FLAW_BLANK;
	}
	ec_sii_iter_init(&it, img, len);
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1) {
		if (misfit || entries_fit(&cat))
			continue;
		misfit = true;
		f->type = cat.type;
		f->offset = cat.offset;
	}
	f->end = min_t(size_t, it.pos, len);
	if (ret == -EBADMSG) {
		f->type = cat.type;
		f->offset = cat.offset;
		f->bytes = cat.bytes;
		return f->kind = EC_SII_FLAW_LARGE;
	}
	if (ret)
		return f->kind = EC_SII_FLAW_NO_END;
	if (f->end > f->declared)
		return f->kind = EC_SII_FLAW_BEYOND;
	return f->kind = misfit ? EC_SII_FLAW_ENTRY : EC_SII_FLAW_NONE;
}
