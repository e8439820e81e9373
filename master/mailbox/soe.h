/* SPDX-License-Identifier: GPL-2.0-only */
/* SoE: reading and writing elements of IDNs over the mailbox. */
#ifndef EC_SOE_H
#define EC_SOE_H

#include <linux/types.h>

struct ec_mbox_limit;
struct ec_mbox;
struct ec_soe_access;

#define EC_SOE_TIMEOUT_MS	5000	/* as that of an SDO */

int ec_soe_access(struct ec_mbox *mb, struct ec_soe_access *a, const struct ec_mbox_limit *limit);
int ec_soe_read(struct ec_mbox *mb, u8 drive, u16 idn, u8 *data, size_t cap, size_t *size,
		u16 *error, const struct ec_mbox_limit *limit);
int ec_soe_write(struct ec_mbox *mb, u8 drive, u16 idn, const u8 *data, size_t size,
		 u16 *error, const struct ec_mbox_limit *limit);
const char *ec_soe_idn_text(u16 idn, char buf[12]);

#endif
