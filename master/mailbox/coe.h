/* SPDX-License-Identifier: GPL-2.0-only */
/* CoE: SDO upload and download over the mailbox. */
#ifndef EC_COE_H
#define EC_COE_H

#include <linux/types.h>

struct ec_mbox_limit;
struct ec_mbox;

#define EC_SDO_TIMEOUT_MS	1000

int ec_coe_upload(struct ec_mbox *mb, u16 index, u8 sub, bool complete, u8 *data, size_t cap,
		  size_t *size, u32 *abort, const struct ec_mbox_limit *limit);
int ec_coe_download(struct ec_mbox *mb, u16 index, u8 sub, bool complete, const u8 *data,
		    size_t size, u32 *abort, const struct ec_mbox_limit *limit);

#endif
