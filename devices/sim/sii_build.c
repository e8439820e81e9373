// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sii_build.h"

static struct ec_wbuf grow(struct ec_sii_builder *b, size_t n)
{
	struct ec_wbuf w;

	if (b->bad || b->cap - b->pos < n) {
		b->bad = true;
		return ec_wbuf(b->buf, 0);
	}
	w = ec_wbuf(b->buf + b->pos, n);
	b->pos += n;
	return w;
}

static void close_cat(struct ec_sii_builder *b)
{
	struct ec_wbuf w;
	size_t bytes;

	if (!b->cat)
		return;
	bytes = b->pos - b->cat - EC_SII_CAT_HDR;
	if (bytes & 1) {
		w = grow(b, 1);
		ec_wbuf_u8(&w, 0xFF);
		bytes++;
	}
	put_unaligned_le16((u16)(bytes / 2), b->buf + b->cat + 2);
	b->cat = 0;
}

static void open_cat(struct ec_sii_builder *b, u16 type)
{
	struct ec_wbuf w;
	size_t at;

	close_cat(b);
	at = b->pos;
	w = grow(b, EC_SII_CAT_HDR);
	ec_wbuf_le16(&w, type);
	ec_wbuf_le16(&w, 0);
	b->cat = b->bad ? 0 : at;
}

/* Goes on with the open category if it has the right type. */
static void want_cat(struct ec_sii_builder *b, u16 type)
{
	if (!b->cat || get_unaligned_le16(b->buf + b->cat) != type)
		open_cat(b, type);
}

static void mbox_encode(struct ec_wbuf *w, const struct ec_sii_mbox *m)
{
	ec_wbuf_le16(w, m->rx_offset);
	ec_wbuf_le16(w, m->rx_size);
	ec_wbuf_le16(w, m->tx_offset);
	ec_wbuf_le16(w, m->tx_size);
}

/**
 * ec_sii_build_begin() - start an image
 * @b: builder
 * @buf: image
 * @cap: bytes at @buf: the size of the EEPROM
 * @info: fixed area; the checksum is computed, @size_kbit 0 stands for the
 *	size of @cap and @version 0 for 1
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_begin(struct ec_sii_builder *b, u8 *buf, size_t cap,
			const struct ec_sii_info *info)
{
	u32 kbit = info->size_kbit ? info->size_kbit : (u32)(cap / 128);
	struct ec_wbuf w;

	*b = (struct ec_sii_builder){ .buf = buf, .cap = min_t(size_t, cap, EC_SII_MAX_SIZE) };
	w = grow(b, EC_SII_FIXED_SIZE);
	if (b->bad)
		return;
	ec_wbuf_le16(&w, info->pdi_control);
	ec_wbuf_le16(&w, info->pdi_config);
	ec_wbuf_le16(&w, info->sync_impulse);
	ec_wbuf_le16(&w, info->pdi_config2);
	ec_wbuf_le16(&w, info->alias);
	ec_wbuf_le16(&w, info->reserved[0]);
	ec_wbuf_le16(&w, info->reserved[1]);
	ec_wbuf_le16(&w, ec_sii_crc(buf));
	ec_wbuf_le32(&w, info->vendor);
	ec_wbuf_le32(&w, info->product);
	ec_wbuf_le32(&w, info->revision);
	ec_wbuf_le32(&w, info->serial);
	ec_wbuf_zero(&w, 2 * (EC_SII_W_BOOT_MBOX - EC_SII_W_SERIAL - 2));
	mbox_encode(&w, &info->boot);
	mbox_encode(&w, &info->std);
	ec_wbuf_le16(&w, info->protocols);
	ec_wbuf_zero(&w, 2 * (EC_SII_W_SIZE - EC_SII_W_PROTOCOLS - 1));
	ec_wbuf_le16(&w, (u16)(kbit - 1));
	ec_wbuf_le16(&w, info->version ? info->version : 1);
}

/**
 * ec_sii_build_string() - add a string
 * @b: builder
 * @text: Latin-1, at most 255 bytes; may be NULL or empty
 *
 * Add all strings before anything else: a second string category is legal but
 * not every master looks for one.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: index for other categories, 0 for no text.
 */
u8 ec_sii_build_string(struct ec_sii_builder *b, const char *text)
{
	size_t len = text ? strlen(text) : 0;
	struct ec_wbuf w;

	if (!len)
		return 0;
	if (len > 255 || b->strings == 255)
		b->bad = true;
	if (!b->cat || get_unaligned_le16(b->buf + b->cat) != EC_SII_CAT_STRINGS) {
		open_cat(b, EC_SII_CAT_STRINGS);
		w = grow(b, 1);
		ec_wbuf_u8(&w, 0);
	}
	w = grow(b, 1 + len);
	ec_wbuf_u8(&w, (u8)len);
	ec_wbuf_bytes(&w, text, len);
	if (b->bad)
		return 0;
	b->buf[b->cat + EC_SII_CAT_HDR]++;
	return ++b->strings;
}

/**
 * ec_sii_build_general() - add the general category
 * @b: builder
 * @g: content
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_general(struct ec_sii_builder *b, const struct ec_sii_general *g)
{
	struct ec_wbuf w;

	open_cat(b, EC_SII_CAT_GENERAL);
	w = grow(b, EC_SII_GENERAL_BYTES);
	ec_wbuf_u8(&w, g->group);
	ec_wbuf_u8(&w, g->image);
	ec_wbuf_u8(&w, g->order);
	ec_wbuf_u8(&w, g->name);
	ec_wbuf_u8(&w, 0);
	ec_wbuf_u8(&w, g->coe);
	ec_wbuf_u8(&w, g->foe);
	ec_wbuf_u8(&w, g->eoe);
	ec_wbuf_u8(&w, g->soe_channels);
	ec_wbuf_u8(&w, g->ds402_channels);
	ec_wbuf_u8(&w, g->sysman_class);
	ec_wbuf_u8(&w, g->flags);
	ec_wbuf_le16(&w, (u16)g->current_ma);
	ec_wbuf_u8(&w, g->group_name);
	ec_wbuf_u8(&w, 0);
	ec_wbuf_le16(&w, g->ports);
	ec_wbuf_le16(&w, g->id_address);
	ec_wbuf_zero(&w, 12);
	close_cat(b);
}

/**
 * ec_sii_build_fmmus() - add the FMMU usage
 * @b: builder
 * @use: EC_SII_FMMU_* of FMMU 0, 1, ...
 * @n: how many; nothing is written for 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_fmmus(struct ec_sii_builder *b, const u8 *use, unsigned int n)
{
	if (n)
		ec_sii_build_category(b, EC_SII_CAT_FMMU, use, n);
}

/**
 * ec_sii_build_sms() - add the SyncManagers
 * @b: builder
 * @sm: SM0 first
 * @n: how many; nothing is written for 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_sms(struct ec_sii_builder *b, const struct ec_sii_sm *sm, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++) {
		struct ec_wbuf w;

		want_cat(b, EC_SII_CAT_SM);
		w = grow(b, EC_SII_SM_BYTES);
		ec_wbuf_le16(&w, sm[i].start);
		ec_wbuf_le16(&w, sm[i].len);
		ec_wbuf_u8(&w, sm[i].control);
		ec_wbuf_u8(&w, sm[i].status);
		ec_wbuf_u8(&w, sm[i].enable);
		ec_wbuf_u8(&w, sm[i].type);
	}
}

/**
 * ec_sii_build_pdo() - add a PDO
 * @b: builder
 * @cat_type: EC_SII_CAT_TXPDO or EC_SII_CAT_RXPDO; PDOs of one direction in
 *	a row share a category
 * @pdo: header
 * @entries: @pdo->entries of them; may be NULL for none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_pdo(struct ec_sii_builder *b, u16 cat_type, const struct ec_sii_pdo *pdo,
		      const struct ec_sii_pdo_entry *entries)
{
	struct ec_wbuf w;
	unsigned int i;

	want_cat(b, cat_type);
	w = grow(b, (size_t)EC_SII_PDO_BYTES * (1u + pdo->entries));
	ec_wbuf_le16(&w, pdo->index);
	ec_wbuf_u8(&w, pdo->entries);
	ec_wbuf_u8(&w, pdo->sm);
	ec_wbuf_u8(&w, pdo->sync);
	ec_wbuf_u8(&w, pdo->name);
	ec_wbuf_le16(&w, pdo->flags);
	for (i = 0; i < pdo->entries; i++) {
		ec_wbuf_le16(&w, entries[i].index);
		ec_wbuf_u8(&w, entries[i].sub);
		ec_wbuf_u8(&w, entries[i].name);
		ec_wbuf_u8(&w, entries[i].type);
		ec_wbuf_u8(&w, entries[i].bits);
		ec_wbuf_le16(&w, entries[i].flags);
	}
}

/**
 * ec_sii_build_dcs() - add the distributed clocks operation modes
 * @b: builder
 * @dc: modes
 * @n: how many; nothing is written for 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_dcs(struct ec_sii_builder *b, const struct ec_sii_dc *dc, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++) {
		struct ec_wbuf w;

		want_cat(b, EC_SII_CAT_DC);
		w = grow(b, EC_SII_DC_BYTES);
		ec_wbuf_le32(&w, dc[i].cycle0_ns);
		ec_wbuf_le32(&w, dc[i].shift0_ns);
		ec_wbuf_le32(&w, dc[i].shift1_ns);
		ec_wbuf_le16(&w, (u16)dc[i].factor1);
		ec_wbuf_le16(&w, dc[i].assign);
		ec_wbuf_le16(&w, (u16)dc[i].factor0);
		ec_wbuf_u8(&w, dc[i].name);
		ec_wbuf_u8(&w, dc[i].desc);
		ec_wbuf_le32(&w, 0);
	}
}

/**
 * ec_sii_build_category() - add any category
 * @b: builder
 * @type: category type
 * @data: content
 * @bytes: bytes at @data; an odd number is padded with 0xFF
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_build_category(struct ec_sii_builder *b, u16 type, const void *data, size_t bytes)
{
	struct ec_wbuf w;

	open_cat(b, type);
	w = grow(b, bytes);
	ec_wbuf_bytes(&w, data, bytes);
	close_cat(b);
}

/**
 * ec_sii_build_end() - finish an image
 * @b: builder
 *
 * The rest of the buffer becomes 0xFF, as in a blank EEPROM.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes used, end marker included, or -ENOSPC when something did not
 * fit.
 */
int ec_sii_build_end(struct ec_sii_builder *b)
{
	struct ec_wbuf w;

	close_cat(b);
	w = grow(b, 2);
	ec_wbuf_le16(&w, EC_SII_CAT_END);
	if (b->bad)
		return -ENOSPC;
	memset(b->buf + b->pos, 0xFF, b->cap - b->pos);
	return (int)b->pos;
}
