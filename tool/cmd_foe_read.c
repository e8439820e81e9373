// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <sys/mman.h>

#include "files.h"
#include "out.h"
#include "save.h"

static int save(const char *path, const u8 *data, size_t size)
{
	struct save s;

	if (save_begin(&s, path))
		return 1;
	fwrite(data, 1, size, s.f);
	if (save_end(&s))
		return 1;
	out_str("output_file", path, NULL);
	return 0;
}

static int foe_read(const struct tool *t, struct foe *f)
{
	struct ect_slave s;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = foe_check_name(f->name) || dev_select_single(&d, t, &s) ||
	      foe_transfer(&d, t, &s, f);
	dev_close(&d);
	if (ret)
		return ret;
	if (t->output_file)
		return save(t->output_file, f->data, f->size);
	out_binary("data_hex", f->data, f->size);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct foe f = { .name = argv[0], .size = FOE_MAX };
	void *room;
	int ret;

	if (foe_password(argc, argv, &f))
		return 1;
	if (!t->output_file &&
	    out_binary_allowed("use -o FILE, --json, or a file: ethercat foe_read -p0 NAME > FILE"))
		return 1;
	/* only what is used of it takes memory */
	room = mmap(NULL, FOE_MAX, PROT_READ | PROT_WRITE,
		    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
	if (room == MAP_FAILED)
		return fail("out of memory");
	f.data = room;
	ret = foe_read(t, &f);
	munmap(room, FOE_MAX);
	return ret;
}

const struct cmd cmd_foe_read = {
	.name = "foe_read",
	.run = run,
	.args = "NAME [PASSWORD]",
	.opts = "mapoqv",
	.summary = "Read a file of a slave (FoE)",
	.help = "NAME := file on the slave, 1 to 64 characters\n"
		"PASSWORD := 32-bit number, default 0\n"
		"The content goes to stdout, not to a terminal; with --output-file to that file.\n"
		"A slave in BOOT is read through its bootstrap mailbox.\n",
	.json = "master, position, name, size_bytes, data_hex; with --output-file instead of\n"
		"data_hex: output_file",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
