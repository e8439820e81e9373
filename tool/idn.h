/* SPDX-License-Identifier: GPL-2.0-only */
/* IDNs of servo drives on the command line. */
#ifndef EC_TOOL_IDN_H
#define EC_TOOL_IDN_H

#include "dev.h"
#include "io.h"

struct soe_addr {
	u8 drive;
	u16 idn;
	char text[16];		/* "P-0-0150" */
};

int soe_addr_parse(struct soe_addr *a, const char *drive, const char *idn);
void soe_addr_out(const struct soe_addr *a);
int soe_failed(struct dev *d, int err, const struct ect_slave *s, const struct soe_addr *a,
	       const char *verb);

#endif
