// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "idn.h"
#include "sdo.h"

/* A text becomes a list: its length, the same as the largest one, the characters. */
static int as_list(u8 **data, size_t *size)
{
	u8 *list;

	if (*size > 0xffff - 4)
		return fail("invalid text: %zu bytes, limit 65531", *size);
	list = malloc(*size + 4);
	if (!list)
		return fail("out of memory");
	put_unaligned_le16((u16)*size, list);
	put_unaligned_le16((u16)*size, list + 2);
	memcpy(list + 4, *data, *size);
	free(*data);
	*data = list;
	*size += 4;
	return 0;
}

static int soe_write(const struct tool *t, struct dev *d, const struct soe_addr *a, u8 *data,
		     size_t size)
{
	struct ect_slave s;
	int err;

	if (dev_select_single(d, t, &s))
		return 1;
	err = soe_put(t, d, &s, a, data, size);
	if (err)
		return soe_failed(d, err, &s, a, "write");
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	soe_addr_out(a);
	out_u("size_bytes", size, NULL);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type;
	struct soe_addr a;
	struct dev d;
	size_t size;
	u8 *data;
	int ret;

	if (sdo_timeout_check(t) || soe_addr_parse(&a, argc > 2 ? argv[0] : NULL, argv[argc - 2]) ||
	    soe_element_parse(&a, t->element))
		return 1;
	if (!t->type)
		return usage_error("the data type of %s is not known; give it with --type", a.text);
	if (io_type(t->type, &type) || io_value(type, argv[argc - 1], &data, &size))
		return 1;
	ret = (value_is_text(type) && as_list(&data, &size)) || dev_open_single(&d, t, true);
	if (!ret) {
		ret = soe_write(t, &d, &a, data, size);
		dev_close(&d);
	}
	free(data);
	return ret;
}

const struct cmd cmd_soe_write = {
	.name = "soe_write",
	.run = run,
	.args = "[DRIVE] IDN VALUE",
	.opts = "maptMI",
	.summary = "Write an IDN of a servo drive (SoE)",
	.help = "DRIVE := { 0 to 7 }, default 0\n"
		"IDN := { S-SET-NUMBER | P-SET-NUMBER | 0 to 0xffff }     S-0-15, P-0-150, 0x8096\n"
		"VALUE := { a value of the type given by --type | - for stdin }\n"
		"--type is required. A text is sent as a list with its length; write other lists as\n"
		"raw bytes. Negative numbers need no '--' before them. Without --element the value is\n"
		"written.\n",
	.json = "master, position, drive, idn, name, element (not for the value), size_bytes",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 2,
	.max_args = 3,
};
