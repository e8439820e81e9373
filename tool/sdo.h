/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SDO_H
#define EC_TOOL_SDO_H

#include "dev.h"
#include "io.h"

/* abort codes of ETG.1000.6 */
#define SDO_NO_OBJECT		0x06020000u
#define SDO_NO_SUBINDEX		0x06090011u

struct sdo_addr {
	u16 index;
	u8 sub;
	bool complete;
	char meant[8];		/* "0x1018" if 1018 was typed, else "" */
	char text[16];		/* "0x1018:01" or "0x1018" */
};

int sdo_addr_parse(struct sdo_addr *a, const char *index, const char *sub);
void sdo_addr_out(const struct sdo_addr *a);
/* the largest --timeout that the kernel takes; 1 after an error message */
int sdo_timeout_check(const struct tool *t);
/* @timeout_ms: of each reply, 0: default */
const struct ec_type *sdo_described_type(struct dev *d, const struct ect_slave *s,
					 const struct sdo_addr *a, u32 timeout_ms, u32 *abort);
int sdo_upload(struct dev *d, const struct ect_slave *s, const struct sdo_addr *a, u32 timeout_ms,
	       u8 **data, size_t *size);
int sdo_download(struct dev *d, const struct ect_slave *s, const struct sdo_addr *a,
		 u32 timeout_ms, const u8 *data, size_t size);

#endif
