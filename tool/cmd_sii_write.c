// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdlib.h>

#include "../master/wire/sii.h"
#include "dev.h"
#include "io.h"
#include "out.h"
#include "progress_thread.h"

static u32 write_flags(const struct tool *t)
{
	return (t->force ? ECT_SII_FORCE : 0) | (t->unsafe ? ECT_SII_UNSAFE : 0) |
	       (t->dry_run ? ECT_SII_DRY_RUN : 0);
}

static void show_result(const struct tool *t, const struct dev *d, const struct ect_slave *s,
			const struct ect_sii_written *w)
{
	out_u("master", d->master, NULL);
	out_u("position", s->position, NULL);
	out_u("words_different", w->differ, NULL);
	out_u("words_written", w->written, NULL);
	out_bool("renewed", w->renewed, NULL);
	if (t->dry_run)
		note("slave %u: %u word(s) differ, none was written", s->position, w->differ);
	else if (t->verbosity > 0)
		note("slave %u: %u word(s) written and read back", s->position, w->written);
	if (!t->dry_run && !w->renewed && w->written && t->verbosity >= 0)
		note("slave %u: the master uses the new content after the slave has left SAFEOP and OP and a rescan",
		     s->position);
}

static int put(const struct tool *t, const u8 *data, size_t size)
{
	struct ect_sii_written w = { .struct_size = sizeof(w) };
	struct progress_thread p = { .all = size / 2, .unit = "words" };
	struct ect_slave s;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = dev_select_single(&d, t, &s);
	if (!ret) {
		progress_thread_begin(&p, t);
		ret = ect_sii_write(d.h, s.device, data, size, write_flags(t), &w, &p.done);
		progress_thread_end(&p);
		if (ret)
			ret = dev_fail(&d, ret, "Master%u slave %u: cannot write the EEPROM",
				       d.master, s.position);
		else
			show_result(t, &d, &s, &w);
	}
	dev_close(&d);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	size_t size;
	u8 *data;
	int ret;

	(void)argc;
	if (io_read(argv[0], &data, &size))
		return 1;
	if (t->verbosity > 0)
		note("%zu byte(s) read", size);
	if (t->repair && size >= 2 * (EC_SII_W_CHECKSUM + 1))
		put_unaligned_le16(ec_sii_crc(data), data + 2 * EC_SII_W_CHECKSUM);
	ret = put(t, data, size);
	free(data);
	return ret;
}

const struct cmd cmd_sii_write = {
	.name = "sii_write",
	.run = run,
	.args = "FILE|-",
	.opts = "mapfqvUKD",
	.summary = "Write the EEPROM image of a slave",
	.help = "FILE := image as sii_read writes it; '-': stdin\n"
		"Only words that differ are written, words 0 to 7 after all others, and all are read back.\n"
		"When the command is interrupted, the same command continues. Then the master reads the\n"
		"slave again.\n"
		"The image is checked first. --force is for a slave in SAFEOP or OP, one that an\n"
		"application has configured, one that keeps its EEPROM for itself, and for the image of\n"
		"another device. With --allow-unreachable also an image is written after which the slave\n"
		"may be unreachable: with a wrong checksum, other mailboxes, no end marker, or larger than\n"
		"the EEPROM says. --repair-checksum writes the right checksum instead of that of FILE.\n"
		"--dry-run checks and compares only.\n",
	.json = "master, position, words_different, words_written, renewed",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 1,
};
