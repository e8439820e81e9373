// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "domain.h"
#include "out.h"

static int show(const struct tool *t, struct dev *d, const struct ect_domain *dom)
{
	size_t size;
	u8 *data;

	(void)t;
	if (domain_data(d, dom, &data, &size))
		return 1;
	out_object(NULL);
	out_u("index", dom->index, NULL);
	out_u("size_bytes", size, NULL);
	out_binary("data_hex", data, size);
	out_end();
	free(data);
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	int ret;

	out_object(NULL);
	out_u("master", d->master, NULL);
	out_array("domains");
	ret = domain_each(d, t, show);
	out_end();
	out_end();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	if (out_binary_allowed("use --json, or a pipe: ethercat data | hexdump -C"))
		return 1;
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_data = {
	.name = "data",
	.run = run,
	.args = "",
	.opts = "md",
	.summary = "Write the process data of domains to stdout",
	.help = "Binary, all domains in a row; refused if stdout is a terminal:\n"
		"ethercat data -d0 | hexdump -C\n",
	.json = "masters[]: master, domains[]: index, size_bytes, data_hex",
	.flags = CMD_HISTORIC,
};
