/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SII_IMAGE_H
#define EC_TOOL_SII_IMAGE_H

#include "dev.h"

int sii_load(struct dev *d, const struct ect_slave *s, u8 **img, size_t *size);

#endif
