// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "io.h"

static int foe_write(const struct tool *t, struct foe *f)
{
	struct ect_slave s;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = foe_check_name(f->name) || dev_select_single(&d, t, &s) ||
	      foe_transfer(&d, t, &s, f);
	dev_close(&d);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct foe f = { .write = true };
	size_t size;
	int ret;

	if (foe_password(argc, argv, &f))
		return 1;
	if (!strcmp(argv[0], "-") && !t->output_file)
		return usage_error("stdin has no name; add -o NAME, the file name on the slave");
	f.name = t->output_file ? t->output_file : base_name(argv[0]);
	if (io_read_any(argv[0], &f.data, &size))
		return 1;
	f.size = (u32)size;
	ret = foe_write(t, &f);
	free(f.data);
	return ret;
}

const struct cmd cmd_foe_write = {
	.name = "foe_write",
	.run = run,
	.args = "FILE|- [PASSWORD]",
	.opts = "mapoqv",
	.summary = "Write a file to a slave (FoE)",
	.help = "FILE := file to write; '-': stdin\n"
		"PASSWORD := 32-bit number, default 0\n"
		"The file on the slave has the base name of FILE, or the name after --output-file, 1 to\n"
		"64 characters. A slave in BOOT is written through its bootstrap mailbox. What takes\n"
		"longer than a second shows its progress on a terminal. A transfer that is interrupted\n"
		"is also ended at the slave; what it has of the file then is the slave's matter.\n"
		"Firmware is written by 'ethercat firmware'.\n",
	.json = "master, position, name, size_bytes",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
