// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io.h"
#include "out.h"
#include "reg.h"

static int position(const struct tool *t, struct dev *d, struct ect_slave *s)
{
	unsigned int v;

	if (t->emergency) {
		if (!list_single(&t->positions, &v) || v > 0xffff || t->aliases.given)
			return usage_error("--emergency needs one ring position with -p and no -a");
		*s = (struct ect_slave){ .position = (u16)v };
		return 0;
	}
	return dev_select_single(d, t, s);
}

static int put(const struct tool *t, u16 address, const u8 *data, size_t size)
{
	struct ect_slave s;
	struct dev d;
	int ret;

	if (address + size > REG_SPACE)
		return usage_error("registers end at 0xffff: %zu bytes at 0x%04x are too many",
				   size, address);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = position(t, &d, &s) || reg_write(&d, &s, address, data, size, t->emergency);
	if (!ret) {
		out_u("master", d.master, NULL);
		out_u("position", s.position, NULL);
		out_u("address", address, NULL);
		out_u("size_bytes", size, NULL);
		if (t->verbosity > 0)
			note("%zu byte(s) written to 0x%04x of slave %u", size, address,
			     s.position);
	}
	dev_close(&d);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type;
	u64 address;
	size_t size;
	u8 *data;
	int ret;

	(void)argc;
	if (io_number("address", argv[0], REG_SPACE - 1, &address) ||
	    (t->type && io_type(t->type, &type)))
		return 1;
	if (!t->type && strcmp(argv[1], "-") && access(argv[1], F_OK))
		return fail("cannot open %s: %s; DATA without --type is a file, for a value give --type",
			    argv[1], strerror(errno));
	if (t->type ? io_value(type, argv[1], &data, &size) : io_read(argv[1], &data, &size))
		return 1;
	ret = put(t, (u16)address, data, size);
	free(data);
	return ret;
}

const struct cmd cmd_reg_write = {
	.name = "reg_write",
	.run = run,
	.args = "ADDRESS DATA",
	.opts = "maptev",
	.summary = "Write registers of a slave's controller",
	.help = "ADDRESS := { 0 to 0xffff }\n"
		"DATA := { with --type a value, else the name of a file with the bytes; - for stdin }\n"
		"With --emergency, -p is the ring position of the slave, even if the bus has not been\n"
		"scanned.\n",
	.json = "master, position, address, size_bytes",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 2,
	.max_args = 2,
};
