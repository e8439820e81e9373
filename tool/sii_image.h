/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SII_IMAGE_H
#define EC_TOOL_SII_IMAGE_H

#include "../master/wire/sii.h"
#include "dev.h"

/* a text of the image, fit to be shown */
void sii_text(const u8 *img, size_t size, u8 number, char *name, size_t room);
/* a PDO of either direction, assigned or not */
bool sii_pdo_find(const u8 *img, size_t size, u16 index, struct ec_sii_pdo *p);
/* name and type of an entry in any PDO; "" and 0: there is none */
void sii_entry_text(const u8 *img, size_t size, u16 index, u8 sub, char *name, size_t room,
		    u16 *type);

int sii_load(struct dev *d, const struct ect_slave *s, u8 **img, size_t *size);

#endif
