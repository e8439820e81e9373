// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "sdo.h"

static int download(const struct tool *t, struct dev *d, const struct sdo_addr *a, u8 *data,
		    size_t size)
{
	struct ec_ioc_slave s;

	if (dev_select_single(d, t, &s) || sdo_download(d, s.position, a, data, size))
		return 1;
	out_u("master", d->master, NULL);
	out_u("slave", s.position, NULL);
	sdo_addr_out(a);
	out_u("size_bytes", size, NULL);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const char *sub = argc > 2 ? argv[1] : NULL, *text = argv[argc - 1];
	const struct ec_type *type;
	struct sdo_addr a;
	struct dev d;
	size_t size;
	u8 *data;
	int ret;

	if (sdo_addr_parse(&a, argv[0], sub))
		return 1;
	if (!t->type && !a.complete)
		return usage_error("the data type of %s is not known; give it with --type", a.text);
	if (io_type(t->type ? t->type : "octet_string", &type) ||
	    io_value(type, text, &data, &size))
		return 1;
	ret = dev_open_single(&d, t, true);
	if (!ret) {
		ret = download(t, &d, &a, data, size);
		dev_close(&d);
	}
	free(data);
	return ret;
}

const struct cmd cmd_download = {
	.name = "download",
	.run = run,
	.args = "INDEX [SUBINDEX] VALUE",
	.opts = "mapt",
	.summary = "Write an SDO to a slave",
	.help = "INDEX := { 0 to 0xffff | INDEX:HH }     HH: subindex, two hex digits\n"
		"SUBINDEX := { 0 to 0xff }\n"
		"VALUE := { a value of the type given by --type | - for stdin }\n"
		"Without a subindex the whole object is written (complete access), by default as\n"
		"octet_string. Negative numbers need no '--' before them.\n",
	.json = "master, slave, index, subindex, complete_access, size_bytes",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 2,
	.max_args = 3,
};
