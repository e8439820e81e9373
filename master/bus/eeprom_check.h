/* SPDX-License-Identifier: GPL-2.0-only */
/* May this image be written into that EEPROM? */
#ifndef EC_EEPROM_CHECK_H
#define EC_EEPROM_CHECK_H

#include <linux/types.h>

/**
 * struct ec_eeprom_images - an EEPROM and what is to be written
 * @now: what the EEPROM has, as many bytes as @image
 * @image: the same after the write
 * @bytes: of each, at least the fixed area
 * @capacity: bytes that the chip can have
 */
struct ec_eeprom_images {
	const u8 *now;
	const u8 *image;
	size_t bytes;
	size_t capacity;
};

int ec_eeprom_check_image(const u8 *image, size_t bytes, bool unsafe, char *why, size_t size);
int ec_eeprom_check_pair(const struct ec_eeprom_images *e, bool force, bool unsafe, char *why,
			 size_t size);
bool ec_eeprom_is_valid(const u8 *image);

#endif
