/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_REG_H
#define EC_TOOL_REG_H

#include "dev.h"

#define REG_SPACE	0x10000u

int reg_rdwr(struct dev *d, const struct ect_slave *s, u16 address, u8 *data, size_t size);
int reg_read(struct dev *d, const struct ect_slave *s, u16 address, u8 *data, size_t size);
int reg_write(struct dev *d, const struct ect_slave *s, u16 address, const u8 *data, size_t size,
	      bool emergency);

#endif
