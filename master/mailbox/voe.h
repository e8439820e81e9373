/* SPDX-License-Identifier: GPL-2.0-only */
/* VoE: sending and receiving vendor specific messages over the mailbox. */
#ifndef EC_VOE_H
#define EC_VOE_H

#include <linux/types.h>

struct ec_mbox_limit;
struct ec_mbox;
struct ec_voe_hdr;

#define EC_VOE_TIMEOUT_MS	500	/* of a whole operation */

int ec_voe_write(struct ec_mbox *mb, const struct ec_voe_hdr *h, const u8 *data, size_t size,
		 const struct ec_mbox_limit *limit);
int ec_voe_read(struct ec_mbox *mb, bool blind, struct ec_voe_hdr *h, u8 *data, size_t cap,
		size_t *size, const struct ec_mbox_limit *limit);

#endif
