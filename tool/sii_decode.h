/* SPDX-License-Identifier: GPL-2.0-only */
/* What an EEPROM image says. */
#ifndef EC_TOOL_SII_DECODE_H
#define EC_TOOL_SII_DECODE_H

#include <stddef.h>

#include "../master/wire/env.h"

void sii_decode(const u8 *img, size_t size);

#endif
