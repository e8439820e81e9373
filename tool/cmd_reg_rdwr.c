// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "io.h"
#include "out.h"
#include "reg.h"

static int exchange(const struct tool *t, u16 address, const struct ec_type *type, u8 *data,
		    size_t size)
{
	struct ect_slave s;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = dev_select_single(&d, t, &s) || reg_rdwr(&d, &s, address, data, size);
	if (!ret) {
		out_u("master", d.master, NULL);
		out_u("position", s.position, NULL);
		out_u("address", address, NULL);
		ret = io_print(type, data, size);
	}
	dev_close(&d);
	return ret;
}

/* a value of a type without fixed size, as long as SIZE says */
static int pad(u8 **data, size_t *size, const struct ec_type *type, const char *text)
{
	u64 wanted;
	u8 *more;

	if (io_number("size", text, REG_SPACE, &wanted))
		return 1;
	if (wanted < *size || !wanted || (value_bytes(type) && wanted != *size))
		return usage_error("the value has %zu byte(s), not %llu", *size,
				   (unsigned long long)wanted);
	more = realloc(*data, wanted);
	if (!more)
		return fail("out of memory");
	for (size_t i = *size; i < wanted; i++)
		more[i] = 0;
	*data = more;
	*size = wanted;
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type;
	u8 *data = NULL;
	u64 address;
	size_t size;
	int ret;

	if (!t->type)
		return usage_error("missing option: --type of the value and of the result");
	if (io_number("address", argv[0], REG_SPACE - 1, &address) || io_type(t->type, &type) ||
	    io_value(type, argv[1], &data, &size))
		return 1;
	ret = argc > 2 ? pad(&data, &size, type, argv[2]) : 0;
	if (!ret && !size)
		ret = usage_error("the value has no bytes");
	if (!ret && address + size > REG_SPACE)
		ret = usage_error("registers end at 0xffff: %zu bytes at 0x%04llx are too many",
				  size, (unsigned long long)address);
	if (!ret)
		ret = exchange(t, (u16)address, type, data, size);
	free(data);
	return ret;
}

const struct cmd cmd_reg_rdwr = {
	.name = "reg_rdwr",
	.run = run,
	.args = "ADDRESS DATA [SIZE]",
	.opts = "mapt",
	.summary = "Write registers of a slave's controller and show what they contained",
	.help = "One datagram reads and writes: counters are cleared without losing an event.\n"
		"ADDRESS := { 0 to 0xffff }\n"
		"DATA := { value of --type, which is required; - for stdin }\n"
		"SIZE := { bytes; a shorter value of a type without fixed size ends in zeros }\n"
		"  ethercat reg_rdwr -p3 -t uint16 0x0300 0\n",
	.json = "master, position, address, type, size_bytes, value, data_hex",
	.flags = CMD_ONE_MASTER | CMD_NEGATIVE,
	.min_args = 2,
	.max_args = 3,
};
