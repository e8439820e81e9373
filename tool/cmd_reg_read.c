// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "io.h"
#include "out.h"
#include "reg.h"

static int show(const struct tool *t, struct dev *d, u16 address, size_t size,
		const struct ec_type *type)
{
	struct ect_slave s;
	u8 *data;
	int ret;

	if (dev_select_single(d, t, &s))
		return 1;
	data = calloc(1, size);
	if (!data)
		return fail("out of memory");
	ret = reg_read(d, &s, address, data, size);
	if (!ret) {
		out_u("master", d->master, NULL);
		out_u("position", s.position, NULL);
		out_u("address", address, NULL);
		ret = io_print(type, data, size);
	}
	free(data);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type;
	u64 address, size;
	struct dev d;
	int ret;

	if (io_number("address", argv[0], REG_SPACE - 1, &address) ||
	    io_type(t->type ? t->type : "raw", &type))
		return 1;
	size = value_bytes(type);
	if (argc < 2 && !size)
		return usage_error("missing argument: SIZE in bytes, or a --type that fixes it");
	if (argc > 1) {
		u64 fixed = size;

		if (io_number("size", argv[1], REG_SPACE, &size))
			return 1;
		if (!size)
			return usage_error("invalid size '%s': expected at least 1", argv[1]);
		if (fixed && fixed != size)
			return usage_error("type %s has %llu byte(s), not %llu", type->name,
					   (unsigned long long)fixed, (unsigned long long)size);
	}
	if (address + size > REG_SPACE)
		return usage_error("registers end at 0xffff: %llu bytes at 0x%04llx are too many",
				   (unsigned long long)size, (unsigned long long)address);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = show(t, &d, (u16)address, size, type);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_reg_read = {
	.name = "reg_read",
	.run = run,
	.args = "ADDRESS [SIZE]",
	.opts = "mapt",
	.summary = "Read registers of a slave's controller",
	.help = "ADDRESS := { 0 to 0xffff }\n"
		"SIZE := { bytes; not needed with a --type of fixed size }\n"
		"Without --type the value is shown as hex bytes.\n",
	.json = "master, position, address, type, size_bytes, value, data_hex",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
