/* SPDX-License-Identifier: GPL-2.0-only */
/* Files of slaves; functions print errors. */
#ifndef EC_TOOL_FILES_H
#define EC_TOOL_FILES_H

#include "dev.h"

/**
 * struct foe - one transfer
 * @write: to the slave
 * @name: of the file on the slave
 * @password: 0: none
 * @data: its content, or the buffer for it
 * @size: bytes of @data
 */
struct foe {
	bool write;
	const char *name;
	u32 password;
	u8 *data;
	u32 size;
};

#define FOE_MAX		(256u << 20)	/* bytes of a file */

const char *base_name(const char *path);
int foe_password(int argc, char **argv, struct foe *f);
/* Check that the kernel accepts the name. */
int foe_check_name(const char *name);
int foe_transfer(struct dev *d, const struct tool *t, const struct ect_slave *s, struct foe *f);

#endif
