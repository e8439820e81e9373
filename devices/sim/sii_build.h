/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Building the EEPROM image of a slave (ETG.2010), into a buffer of the caller. */
#ifndef EC_SIM_SII_BUILD_H
#define EC_SIM_SII_BUILD_H

#include "../../master/wire/sii.h"

/**
 * struct ec_sii_builder - an image under construction
 * @buf: image
 * @cap: bytes at @buf
 * @pos: bytes used
 * @cat: offset of the header of the open category, 0: none is open
 * @strings: strings added so far
 * @bad: something did not fit
 *
 * Calls in order: begin, strings (their indexes are needed by the others),
 * the other categories, end. Errors are sticky and reported by the end.
 */
struct ec_sii_builder {
	u8 *buf;
	size_t cap;
	size_t pos;
	size_t cat;
	u8 strings;
	bool bad;
};

void ec_sii_build_begin(struct ec_sii_builder *b, u8 *buf, size_t cap,
			const struct ec_sii_info *info);
u8 ec_sii_build_string(struct ec_sii_builder *b, const char *text);
void ec_sii_build_general(struct ec_sii_builder *b, const struct ec_sii_general *g);
void ec_sii_build_fmmus(struct ec_sii_builder *b, const u8 *use, unsigned int n);
void ec_sii_build_sms(struct ec_sii_builder *b, const struct ec_sii_sm *sm, unsigned int n);
void ec_sii_build_pdo(struct ec_sii_builder *b, u16 cat_type, const struct ec_sii_pdo *pdo,
		      const struct ec_sii_pdo_entry *entries);
void ec_sii_build_dcs(struct ec_sii_builder *b, const struct ec_sii_dc *dc, unsigned int n);
void ec_sii_build_category(struct ec_sii_builder *b, u16 type, const void *data, size_t bytes);
int ec_sii_build_end(struct ec_sii_builder *b);

#endif
