// SPDX-License-Identifier: GPL-2.0-only
/*
 * May this image be written into that EEPROM? A slave with an image that is refused here might not
 * start its application any more, or have its mailbox where no master looks for it.
 */
#include <linux/kernel.h>
#include "../wire/sii.h"
#include "eeprom_check.h"

#define BYTES_MIN	(EC_SII_FIXED_SIZE + 2)	/* with the end marker of the categories */
#define MBOX_MIN	0x1000	/* registers are before */
#define UNSAFE		"--allow-unreachable writes it nevertheless"

/**
 * ec_eeprom_is_valid() - has an image a right checksum and an identity?
 * @image: image, the fixed area at least
 *
 * Context: Any.
 * Return: whether it has.
 */
bool ec_eeprom_is_valid(const u8 *image)
{
	struct ec_sii_info i;

	if (ec_sii_decode_info(image, EC_SII_FIXED_SIZE, &i) || !i.checksum_ok)
		return false;
	return (i.vendor || i.product) && i.vendor != U32_MAX;
}

static bool area_fits(u16 offset, u16 size)
{
	return !size || (offset >= MBOX_MIN && offset + size <= 0x10000);
}

static bool mbox_fits(const struct ec_sii_mbox *m)
{
	if (!area_fits(m->rx_offset, m->rx_size) || !area_fits(m->tx_offset, m->tx_size))
		return false;
	return !m->rx_size || !m->tx_size || m->rx_offset + m->rx_size <= m->tx_offset ||
	       m->tx_offset + m->tx_size <= m->rx_offset;
}

static int check_chain(const u8 *image, size_t bytes, char *why, size_t size)
{
	struct ec_sii_flaw f;

	switch (ec_sii_check(image, bytes, &f)) {
	case EC_SII_FLAW_BLANK:
		scnprintf(why, size, "the image is blank (only 0x%02x); %s", f.type, UNSAFE);
		return -EBADMSG;
	case EC_SII_FLAW_LARGE:
		scnprintf(why, size,
			  "category 0x%04x at word 0x%04zx of the image has %zu bytes, beyond the end of the image; %s",
			  f.type, f.offset / 2, f.bytes, UNSAFE);
		return -EBADMSG;
	case EC_SII_FLAW_NO_END:
		scnprintf(why, size,
			  "the categories of the image have no end marker (0xffff) up to word 0x%04zx; %s",
			  f.end / 2, UNSAFE);
		return -EBADMSG;
	case EC_SII_FLAW_BEYOND:
		scnprintf(why, size,
			  "the categories of the image end at byte %zu, beyond its declared size of %zu (word 0x003e); %s",
			  f.end, f.declared, UNSAFE);
		return -EBADMSG;
	default:
		return 0;
	}
}

/**
 * ec_eeprom_check_image() - check an image by itself
 * @image: image
 * @bytes: at @image
 * @unsafe: also one with which the slave may be unreachable
 * @why: result of a refusal: what is wrong, and what to do
 * @size: of @why
 *
 * Context: Any.
 * Return: 0; -EINVAL: no image; -EBADMSG: refused unless @unsafe.
 */
int ec_eeprom_check_image(const u8 *image, size_t bytes, bool unsafe, char *why, size_t size)
{
	struct ec_sii_info i;

	if (bytes < BYTES_MIN || bytes % 2 || bytes > EC_SII_MAX_SIZE) {
		scnprintf(why, size,
			  "an EEPROM image has an even number of bytes, %u to %u, not %zu",
			  BYTES_MIN, EC_SII_MAX_SIZE, bytes);
		return -EINVAL;
	}
	if (unsafe || ec_sii_decode_info(image, bytes, &i))
		return 0;
	if (!i.checksum_ok) {
		scnprintf(why, size,
			  "checksum of the image 0x%02x (word 0x0007), expected 0x%02x; --repair-checksum writes the right one",
			  i.checksum, i.checksum_calc);
		return -EBADMSG;
	}
	if (!mbox_fits(&i.std) || !mbox_fits(&i.boot)) {
		scnprintf(why, size,
			  "the mailboxes of the image overlap, or are not between 0x1000 and 0xffff; %s",
			  UNSAFE);
		return -EBADMSG;
	}
	return check_chain(image, bytes, why, size);
}

static int check_mbox(const struct ec_sii_info *now, const struct ec_sii_info *image, char *why,
		      size_t size)
{
	const struct ec_sii_mbox *a = &now->std, *b = &image->std;

	if (!memcmp(a, b, sizeof(*a)) && !memcmp(&now->boot, &image->boot, sizeof(*a)))
		return 0;
	scnprintf(why, size,
		  "the image moves the mailboxes of the slave: now 0x%04x/%u and 0x%04x/%u, then 0x%04x/%u and 0x%04x/%u (bootstrap 0x%04x/%u, then 0x%04x/%u); %s",
		  a->rx_offset, a->rx_size, a->tx_offset, a->tx_size, b->rx_offset, b->rx_size,
		  b->tx_offset, b->tx_size, now->boot.rx_offset, now->boot.rx_size,
		  image->boot.rx_offset, image->boot.rx_size, UNSAFE);
	return -EBADMSG;
}

/**
 * ec_eeprom_check_pair() - check an image against the EEPROM that is to have it
 * @e: the two
 * @force: also the image of another device
 * @unsafe: also one with which the slave may be unreachable
 * @why: result of a refusal: what is wrong, and what to do
 * @size: of @why
 *
 * An EEPROM without valid content is not compared.
 *
 * Context: Any.
 * Return: 0; -EFBIG: larger than the chip; -EBADMSG: refused unless @unsafe; -EPERM: refused
 * unless @force.
 */
int ec_eeprom_check_pair(const struct ec_eeprom_images *e, bool force, bool unsafe, char *why,
			 size_t size)
{
	struct ec_sii_info now, image;
	size_t declared;

	if (e->bytes > e->capacity) {
		scnprintf(why, size, "the image has %zu bytes, the EEPROM at most %zu", e->bytes,
			  e->capacity);
		return -EFBIG;
	}
	if (!ec_eeprom_is_valid(e->now) || ec_sii_decode_info(e->now, e->bytes, &now) ||
	    ec_sii_decode_info(e->image, e->bytes, &image))
		return 0;
	declared = (size_t)now.size_kbit * 128;
	if (!unsafe && e->bytes > declared) {
		scnprintf(why, size,
			  "the image has %zu bytes, the EEPROM %zu by its word 0x003e; %s",
			  e->bytes, declared, UNSAFE);
		return -EBADMSG;
	}
	if (!force && (now.vendor != image.vendor || now.product != image.product)) {
		scnprintf(why, size,
			  "the image is of device 0x%08x/0x%08x, the slave is 0x%08x/0x%08x; --force writes it nevertheless",
			  image.vendor, image.product, now.vendor, now.product);
		return -EPERM;
	}
	return unsafe ? 0 : check_mbox(&now, &image, why, size);
}
