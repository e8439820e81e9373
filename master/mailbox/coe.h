/* SPDX-License-Identifier: GPL-2.0-only */
/* CoE: SDO upload and download, and SDO information over the mailbox. */
#ifndef EC_COE_H
#define EC_COE_H

#include <linux/types.h>

struct ec_mbox_buf;
struct ec_mbox_limit;
struct ec_mbox;
struct ec_sdoinfo;

#define EC_SDO_TIMEOUT_MS	5000	/* some drives store parameters that long */
#define EC_SDOINFO_TIMEOUT_MS	1000	/* nothing is stored */

int ec_coe_upload(struct ec_mbox *mb, u16 index, u8 sub, bool complete, u8 *data, size_t cap,
		  size_t *size, u32 *abort, const struct ec_mbox_limit *limit);
int ec_coe_download(struct ec_mbox *mb, u16 index, u8 sub, bool complete, const u8 *data,
		    size_t size, u32 *abort, const struct ec_mbox_limit *limit);
int ec_coe_ask(struct ec_mbox *mb, struct ec_sdoinfo *info, u64 until_ns,
	       const struct ec_mbox_limit *limit, struct ec_mbox_buf *b);
int ec_coe_info(struct ec_mbox *mb, struct ec_sdoinfo *info, const struct ec_mbox_limit *limit);

#endif
