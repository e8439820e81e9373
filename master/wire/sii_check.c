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

/**
 * ec_sii_mbox_of_sms() - the mailbox that category 41 describes
 * @sm: SyncManagers of category 41
 * @n: how many
 * @m: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it describes one: SM0 to the slave, SM1 from it.
 */
bool ec_sii_mbox_of_sms(const struct ec_sii_sm *sm, unsigned int n, struct ec_sii_mbox *m)
{
	if (n < 2 || sm[0].type != EC_SII_SM_MBOX_OUT || sm[1].type != EC_SII_SM_MBOX_IN ||
	    !sm[0].len || !sm[1].len)
		return false;
	*m = (struct ec_sii_mbox){
		.rx_offset = sm[0].start, .rx_size = sm[0].len,
		.tx_offset = sm[1].start, .tx_size = sm[1].len,
	};
	return true;
}

/**
 * ec_sii_settle_mbox() - decide whether a slave has a mailbox, and which one
 * @info: fixed area; its @std becomes what is used in PREOP and above, sizes 0: no mailbox
 * @sm: SyncManagers of category 41
 * @n: how many
 *
 * Words 0x18 to 0x1B say it, category 41 where these do not. The protocols of word 0x1C only say
 * what a mailbox is good for, except that a slave without software has none without them.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: in what the image contradicts itself.
 */
enum ec_sii_mbox_doubt ec_sii_settle_mbox(struct ec_sii_info *info, const struct ec_sii_sm *sm,
					  unsigned int n)
{
	bool emulation = info->pdi_control & EC_SII_PDI_EMULATION;
	struct ec_sii_mbox *std = &info->std, m;
	bool in_sms = ec_sii_mbox_of_sms(sm, n, &m);
	bool in_words = std->rx_size && std->tx_size;

	if (!in_words && in_sms)
		*std = m;
	if (!(in_words || in_sms) || (emulation && !info->protocols)) {
		memset(std, 0, sizeof(*std));
		return info->protocols ? EC_SII_MBOX_NONE : EC_SII_MBOX_SURE;
	}
	if (!info->protocols)
		return EC_SII_MBOX_NO_PROTOCOL;
	if (!in_words)
		return EC_SII_MBOX_NO_WORDS;
	return in_sms && memcmp(std, &m, sizeof(m)) ? EC_SII_MBOX_DIFFERS : EC_SII_MBOX_SURE;
}
