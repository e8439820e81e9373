// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "sii.h"

#define BLANK_MAX	8	/* empty NOP categories in a row: nothing but zeros follows */
#define GENERAL_MIN	18
#define KEEP_MIN	8192	/* a wrong size word never limits an image below this */

/**
 * ec_sii_crc() - checksum of the configuration area
 * @words0_6: first 14 bytes of the image
 *
 * CRC-8, polynomial 0x07, start value 0xFF.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: low byte of word 7.
 */
u8 ec_sii_crc(const u8 *words0_6)
{
	u8 crc = 0xFF;
	int i, bit;

	for (i = 0; i < 14; i++) {
		crc ^= words0_6[i];
		for (bit = 0; bit < 8; bit++)
			crc = (u8)(crc & 0x80 ? crc << 1 ^ 0x07 : crc << 1);
	}
	return crc;
}

static void mbox_decode(struct ec_rbuf *r, struct ec_sii_mbox *m)
{
	m->rx_offset = ec_rbuf_le16(r);
	m->rx_size = ec_rbuf_le16(r);
	m->tx_offset = ec_rbuf_le16(r);
	m->tx_size = ec_rbuf_le16(r);
}

/**
 * ec_sii_decode_info() - read the fixed area
 * @img: image
 * @len: bytes at @img
 * @info: result
 *
 * A wrong checksum is not an error here: the rest is readable nevertheless.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE for less than EC_SII_FIXED_SIZE bytes.
 */
int ec_sii_decode_info(const u8 *img, size_t len, struct ec_sii_info *info)
{
	struct ec_rbuf r = ec_rbuf(img, len);

	if (len < EC_SII_FIXED_SIZE)
		return -EMSGSIZE;

	info->pdi_control = ec_rbuf_le16(&r);
	info->pdi_config = ec_rbuf_le16(&r);
	info->sync_impulse = ec_rbuf_le16(&r);
	info->pdi_config2 = ec_rbuf_le16(&r);
	info->alias = ec_rbuf_le16(&r);
	info->reserved[0] = ec_rbuf_le16(&r);
	info->reserved[1] = ec_rbuf_le16(&r);
	info->checksum = (u8)ec_rbuf_le16(&r);
	info->checksum_calc = ec_sii_crc(img);
	info->checksum_ok = info->checksum == info->checksum_calc;
	info->vendor = ec_rbuf_le32(&r);
	info->product = ec_rbuf_le32(&r);
	info->revision = ec_rbuf_le32(&r);
	info->serial = ec_rbuf_le32(&r);
	r = ec_rbuf(img + 2 * EC_SII_W_BOOT_MBOX, 18);
	mbox_decode(&r, &info->boot);
	mbox_decode(&r, &info->std);
	info->protocols = ec_rbuf_le16(&r);
	info->size_kbit = (u32)get_unaligned_le16(img + 2 * EC_SII_W_SIZE) + 1;
	info->version = get_unaligned_le16(img + 2 * EC_SII_W_VERSION);
	return 0;
}

/**
 * ec_sii_iter_init() - start walking the categories of an image
 * @it: iterator
 * @img: image
 * @len: bytes at @img
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_iter_init(struct ec_sii_iter *it, const u8 *img, size_t len)
{
	it->img = img;
	it->len = min_t(size_t, len, EC_SII_MAX_SIZE);
	it->pos = EC_SII_FIXED_SIZE;
	it->count = 0;
	it->blank = 0;
	it->end = 1;
}

/**
 * ec_sii_iter_next() - next category
 * @it: iterator
 * @cat: result; points into the image
 *
 * Categories returned before an error are good. After anything but 1 every
 * further call returns the same, and @it->pos is the offset of the end marker
 * or of the header that could not be used.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 1 for a category, 0 at the end marker, -ENODATA when the image ends
 * without one or is blank, -EBADMSG when a category is larger than the rest
 * of the image, -E2BIG for more than EC_SII_MAX_CATS categories.
 */
int ec_sii_iter_next(struct ec_sii_iter *it, struct ec_sii_cat *cat)
{
	const u8 *p;
	size_t left;

	if (it->end != 1)
		return it->end;
	left = it->len > it->pos ? it->len - it->pos : 0;
	p = it->img + it->pos;
	if (left < 2)
		return it->end = -ENODATA;
	cat->type = get_unaligned_le16(p);
	if (cat->type == EC_SII_CAT_END)
		return it->end = 0;
	if (left < EC_SII_CAT_HDR)
		return it->end = -ENODATA;
	if (it->count >= EC_SII_MAX_CATS)
		return it->end = -E2BIG;

	cat->words = get_unaligned_le16(p + 2);
	cat->bytes = (size_t)cat->words * 2;
	cat->offset = it->pos;
	cat->data = p + EC_SII_CAT_HDR;
	if (cat->type == EC_SII_CAT_NOP && !cat->words)
		it->blank++;
	else
		it->blank = 0;
	if (it->blank > BLANK_MAX)
		return it->end = -ENODATA;
	if (cat->bytes > left - EC_SII_CAT_HDR)
		return it->end = -EBADMSG;

	it->pos += EC_SII_CAT_HDR + cat->bytes;
	it->count++;
	return 1;
}

/*
 * The size word is too often wrong to be believed; it only keeps a garbage
 * category from costing 512 KiB of slow EEPROM reads.
 */
static size_t size_limit(const u8 *img)
{
	size_t bytes = ((size_t)get_unaligned_le16(img + 2 * EC_SII_W_SIZE) + 1) * 128;

	return min_t(size_t, max_t(size_t, 4 * bytes, KEEP_MIN), EC_SII_MAX_SIZE);
}

/**
 * ec_sii_needed() - how far an image must be read
 * @img: first bytes of the image
 * @have: how many
 *
 * Lets a master that fetches an EEPROM piece by piece stop at its end.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: total bytes that must be had, more than @have, or 0 when nothing
 * worth reading follows: @img has the end marker, or the rest is blank or
 * garbage. ec_sii_used() then returns how much to keep.
 */
int ec_sii_needed(const u8 *img, size_t have)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t need;
	int ret;

	if (have < EC_SII_FIXED_SIZE)
		return EC_SII_FIXED_SIZE;

	ec_sii_iter_init(&it, img, have);
	do {
		ret = ec_sii_iter_next(&it, &cat);
	} while (ret == 1);

	if (ret == -EBADMSG)	/* its data and the type of the next one */
		need = it.pos + EC_SII_CAT_HDR + cat.bytes + 2;
	else if (ret == -ENODATA && it.blank <= BLANK_MAX)
		need = it.pos + (have < it.pos + 2 ? 2 : EC_SII_CAT_HDR);
	else
		return 0;
	return need <= size_limit(img) && need > have ? (int)need : 0;
}

/**
 * ec_sii_used() - bytes of an image that are in use
 * @img: image
 * @have: bytes at @img
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes up to and with the end marker; without one, bytes up to the
 * first unusable header, at most @have.
 */
size_t ec_sii_used(const u8 *img, size_t have)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	int ret;

	ec_sii_iter_init(&it, img, have);
	do {
		ret = ec_sii_iter_next(&it, &cat);
	} while (ret == 1);
	return ret ? min_t(size_t, it.pos, have) : it.pos + 2;
}

/* Next category of one type: 1, or what ec_sii_iter_next() said. */
static int next_of(struct ec_sii_iter *it, u16 type, struct ec_sii_cat *cat)
{
	int ret;

	do {
		ret = ec_sii_iter_next(it, cat);
	} while (ret == 1 && cat->type != type);
	return ret;
}

/**
 * ec_sii_text() - make a text of a slave printable
 * @buf: result, UTF-8, always terminated; cut if it does not fit
 * @cap: bytes at @buf, at least 1
 * @s: Latin-1 at best, not terminated
 * @len: bytes at @s
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: length of the text.
 */
int ec_sii_text(char *buf, size_t cap, const u8 *s, size_t len)
{
	size_t out = 0;

	while (len && !s[len - 1])
		len--;
	for (; len; len--, s++) {
		bool wide = *s >= 0xA0;
		u8 c = *s < 0x20 || (*s >= 0x7F && !wide) ? '?' : *s;

		if (cap - out < (wide ? 3u : 2u))
			break;
		if (wide) {
			buf[out++] = (char)(0xC0 | c >> 6);
			c = 0x80 | (c & 0x3F);
		}
		buf[out++] = (char)c;
	}
	buf[out] = 0;
	return (int)out;
}

/**
 * ec_sii_string() - a string by its index
 * @img: image
 * @len: bytes at @img
 * @index: 1 is the first, 0 means no string
 * @buf: result, UTF-8, always terminated; cut if it does not fit
 * @cap: bytes at @buf
 *
 * Several string categories count as one. Bytes that are no Latin-1
 * characters become '?'.
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: length of the text, 0 for @index 0, -ENOENT when there is no such
 * string, -EBADMSG when its category is damaged, -EINVAL for @cap 0.
 */
int ec_sii_string(const u8 *img, size_t len, u8 index, char *buf, size_t cap)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	unsigned int n = index;

	if (!cap)
		return -EINVAL;
	buf[0] = 0;
	if (!index)
		return 0;

	ec_sii_iter_init(&it, img, len);
	while (next_of(&it, EC_SII_CAT_STRINGS, &cat) == 1) {
		struct ec_rbuf r = ec_rbuf(cat.data, cat.bytes);
		unsigned int count = ec_rbuf_u8(&r);
		const u8 *s = NULL;
		size_t l = 0;

		if (n > count) {
			n -= count;
			continue;
		}
		for (; n; n--) {
			l = ec_rbuf_u8(&r);
			s = ec_rbuf_take(&r, l);
		}
		return r.bad ? -EBADMSG : ec_sii_text(buf, cap, s, l);
	}
	return -ENOENT;
}

/**
 * ec_sii_decode_general() - read the general category
 * @img: image
 * @len: bytes at @img
 * @g: result, zeros if there is none
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: 0, -ENOENT when the image has none, -EBADMSG when it is too short,
 * or the error that ended the walk, see ec_sii_iter_next().
 */
int ec_sii_decode_general(const u8 *img, size_t len, struct ec_sii_general *g)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	struct ec_rbuf r;
	int ret;

	memset(g, 0, sizeof(*g));
	ec_sii_iter_init(&it, img, len);
	ret = next_of(&it, EC_SII_CAT_GENERAL, &cat);
	if (ret != 1)
		return ret ? ret : -ENOENT;
	if (cat.bytes < GENERAL_MIN)
		return -EBADMSG;

	r = ec_rbuf(cat.data, cat.bytes);
	g->group = ec_rbuf_u8(&r);
	g->image = ec_rbuf_u8(&r);
	g->order = ec_rbuf_u8(&r);
	g->name = ec_rbuf_u8(&r);
	ec_rbuf_u8(&r);
	g->coe = ec_rbuf_u8(&r);
	g->foe = ec_rbuf_u8(&r);
	g->eoe = ec_rbuf_u8(&r);
	g->soe_channels = ec_rbuf_u8(&r);
	g->ds402_channels = ec_rbuf_u8(&r);
	g->sysman_class = ec_rbuf_u8(&r);
	g->flags = ec_rbuf_u8(&r);
	g->current_ma = (s16)ec_rbuf_le16(&r);
	g->group_name = ec_rbuf_u8(&r);
	ec_rbuf_u8(&r);
	g->ports = ec_rbuf_le16(&r);
	g->id_address = ec_rbuf_le16(&r);
	return 0;
}

/**
 * ec_sii_decode_sms() - read the SyncManagers
 * @img: image
 * @len: bytes at @img
 * @sm: result, SM0 first
 * @max: how many fit at @sm
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: how many were stored; 0 also for a damaged image.
 */
int ec_sii_decode_sms(const u8 *img, size_t len, struct ec_sii_sm *sm, unsigned int max)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	unsigned int n = 0;

	ec_sii_iter_init(&it, img, len);
	while (next_of(&it, EC_SII_CAT_SM, &cat) == 1) {
		struct ec_rbuf r = ec_rbuf(cat.data, cat.bytes);

		for (; n < max && ec_rbuf_left(&r) >= EC_SII_SM_BYTES; n++) {
			sm[n].start = ec_rbuf_le16(&r);
			sm[n].len = ec_rbuf_le16(&r);
			sm[n].control = ec_rbuf_u8(&r);
			sm[n].status = ec_rbuf_u8(&r);
			sm[n].enable = ec_rbuf_u8(&r);
			sm[n].type = ec_rbuf_u8(&r);
		}
	}
	return (int)n;
}

/**
 * ec_sii_decode_dcs() - read the distributed clocks operation modes
 * @img: image
 * @len: bytes at @img
 * @dc: result
 * @max: how many fit at @dc
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: how many were stored; 0 also for a damaged image.
 */
int ec_sii_decode_dcs(const u8 *img, size_t len, struct ec_sii_dc *dc, unsigned int max)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	unsigned int n = 0;

	ec_sii_iter_init(&it, img, len);
	while (next_of(&it, EC_SII_CAT_DC, &cat) == 1) {
		struct ec_rbuf r = ec_rbuf(cat.data, cat.bytes);

		for (; n < max && ec_rbuf_left(&r) >= EC_SII_DC_BYTES; n++) {
			dc[n].cycle0_ns = ec_rbuf_le32(&r);
			dc[n].shift0_ns = ec_rbuf_le32(&r);
			dc[n].shift1_ns = ec_rbuf_le32(&r);
			dc[n].factor1 = (s16)ec_rbuf_le16(&r);
			dc[n].assign = ec_rbuf_le16(&r);
			dc[n].factor0 = (s16)ec_rbuf_le16(&r);
			dc[n].name = ec_rbuf_u8(&r);
			dc[n].desc = ec_rbuf_u8(&r);
			ec_rbuf_le32(&r);
		}
	}
	return (int)n;
}

/**
 * ec_sii_pdo_iter_init() - start walking the PDOs of one direction
 * @it: iterator
 * @img: image
 * @len: bytes at @img
 * @cat_type: EC_SII_CAT_TXPDO or EC_SII_CAT_RXPDO
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sii_pdo_iter_init(struct ec_sii_pdo_iter *it, const u8 *img, size_t len, u16 cat_type)
{
	ec_sii_iter_init(&it->cats, img, len);
	it->type = cat_type;
	it->r = ec_rbuf(img, 0);
	it->bad = 0;
}

/**
 * ec_sii_pdo_iter_next() - next PDO
 * @it: iterator
 * @pdo: result; points into the image, see ec_sii_pdo_entry()
 *
 * Context: Any. RT-safe: time grows with the image, no sleep, no allocation.
 * Return: 1 for a PDO, 0 at the end, -EBADMSG when the entries of a PDO do not
 * fit into its category, or the error of ec_sii_iter_next(). What was
 * returned before an error is good.
 */
int ec_sii_pdo_iter_next(struct ec_sii_pdo_iter *it, struct ec_sii_pdo *pdo)
{
	struct ec_sii_cat cat;
	int ret;

	if (it->bad)
		return it->bad;
	do {
		while (ec_rbuf_left(&it->r) < EC_SII_PDO_BYTES) {
			ret = next_of(&it->cats, it->type, &cat);
			if (ret != 1)
				return ret;
			it->r = ec_rbuf(cat.data, cat.bytes);
		}
		pdo->index = ec_rbuf_le16(&it->r);
		pdo->entries = ec_rbuf_u8(&it->r);
		pdo->sm = ec_rbuf_u8(&it->r);
		pdo->sync = ec_rbuf_u8(&it->r);
		pdo->name = ec_rbuf_u8(&it->r);
		pdo->flags = ec_rbuf_le16(&it->r);
		pdo->entry_data = ec_rbuf_take(&it->r, (size_t)pdo->entries * EC_SII_PDO_BYTES);
		if (it->r.bad)
			return it->bad = -EBADMSG;
	} while (!pdo->index && !pdo->entries);	/* zeros at the end of a category */
	return 1;
}

/**
 * ec_sii_pdo_entry() - one entry of a PDO
 * @pdo: from ec_sii_pdo_iter_next()
 * @i: 0 to @pdo->entries - 1
 * @e: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -ENOENT when there is no such entry.
 */
int ec_sii_pdo_entry(const struct ec_sii_pdo *pdo, unsigned int i, struct ec_sii_pdo_entry *e)
{
	const u8 *p;

	if (i >= pdo->entries)
		return -ENOENT;
	p = pdo->entry_data + (size_t)i * EC_SII_PDO_BYTES;
	e->index = get_unaligned_le16(p);
	e->sub = p[2];
	e->name = p[3];
	e->type = p[4];
	e->bits = p[5];
	e->flags = get_unaligned_le16(p + 6);
	return 0;
}
