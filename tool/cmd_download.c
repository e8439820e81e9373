// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "sdo.h"

static int download(const struct tool *t, struct dev *d, const struct sdo_addr *a,
		    const struct ec_type *type, const char *text)
{
	struct ect_slave s;
	u32 abort = 0;
	size_t size;
	u8 *data;
	int ret;

	if (dev_select_single(d, t, &s))
		return 1;
	if (!type)
		type = sdo_described_type(d, &s, a, t->timeout_ms, &abort);
	if (!type && (abort == SDO_NO_OBJECT || abort == SDO_NO_SUBINDEX))
		return usage_error("%s is absent in the dictionary of slave %u; if the slave has it nevertheless, give --type",
				   a->text, s.position);
	if (!type)
		return usage_error("the data type of %s is not known; give it with --type",
				   a->text);
	if (io_value(type, text, &data, &size))
		return 1;
	ret = sdo_download(d, &s, a, t->timeout_ms, data, size);
	free(data);
	if (ret)
		return ret;
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	sdo_addr_out(a);
	out_u("size_bytes", size, NULL);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const char *sub = argc > 2 ? argv[1] : NULL, *text = argv[argc - 1];
	const struct ec_type *type = NULL;
	struct sdo_addr a;
	struct dev d;
	int ret;

	if (sdo_addr_parse(&a, argv[0], sub) ||
	    (t->type && io_type(t->type, &type)) || sdo_timeout_check(t))
		return 1;
	/* a number behind a forgotten subindex is not written as text */
	if (!type && a.complete && strcmp(text, "-"))
		return usage_error("without a subindex all of %s is written: give the subindex, or --type of VALUE",
				   a.text);
	if (!type && a.complete)
		type = ec_type_by_code(EC_TYPE_OCTET_STRING);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = download(t, &d, &a, type, text);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_download = {
	.name = "download",
	.run = run,
	.args = "INDEX [SUBINDEX] VALUE",
	.opts = "maptI",
	.summary = "Write an SDO to a slave",
	.help = "INDEX := { 0 to 0xffff | INDEX:HH }     HH: subindex, two hex digits\n"
		"SUBINDEX := { 0 to 0xff }\n"
		"VALUE := { a value of the type of the object | - for stdin }\n"
		"Without a subindex the whole object is written (complete access); VALUE needs --type\n"
		"then, stdin is written unchanged. With a subindex and without --type the type is that\n"
		"of the slave's dictionary, which costs one more transfer; a slave that describes no\n"
		"objects needs --type. --timeout is the time limit of each reply, at most 60 s, by\n"
		"default 5 s or that of the application. After that the slave may still write the\n"
		"value: the next SDO waits for its reply, at most 30 s. Negative\n"
		"numbers need no '--' before them.\n",
	.json = "master, position, index, subindex, complete_access, size_bytes",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 2,
	.max_args = 3,
};
