/* SPDX-License-Identifier: GPL-2.0-only */
/* FoE: reading and writing files of a slave. */
#ifndef EC_FOE_H
#define EC_FOE_H

#include <linux/types.h>
#include "../wire/foe.h"

struct ec_mbox;
struct ec_mbox_limit;

#define EC_FOE_TIMEOUT_MS	10000	/* per message: the first one may erase a flash */
#define EC_FOE_BUSY_MS		60000	/* BUSY without progress */

/** struct ec_foe_file - the master's side of a file */
struct ec_foe_file {
	/** @size: write: its bytes; read: most of them */
	u64 size;
	/**
	 * @copy: write: fill @buf with @n bytes from @at on; read: take them. May sleep, no lock is
	 * held. 0 or -errno
	 */
	int (*copy)(void *ctx, u64 at, u8 *buf, size_t n);
	/** @progress: NULL, or called after each packet with the bytes that are transferred */
	void (*progress)(void *ctx, u64 done);
	/** @ctx: for these */
	void *ctx;
};

bool ec_foe_writes(const struct ec_mbox *mb);
int ec_foe_transfer(struct ec_mbox *mb, struct ec_foe *f, const struct ec_foe_file *file,
		    const struct ec_mbox_limit *limit);

#endif
