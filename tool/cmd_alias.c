// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"
#include "io.h"
#include "out.h"

static int write_alias(const struct tool *t, struct dev *d, const struct ect_slave *s, u16 alias)
{
	struct ect_sii_written w = { .struct_size = sizeof(w) };
	u32 flags = (t->force ? ECT_SII_FORCE : 0) | (t->repair ? ECT_SII_REPAIR : 0);
	int ret = ect_alias_write(d->h, s->device, alias, flags, &w);

	if (ret)
		return dev_fail(d, ret, "Master%u slave %u: cannot write the alias", d->master,
				s->position);
	out_object(NULL);
	out_u("position", s->position, NULL);
	out_u("alias", alias, NULL);
	out_bool("in_register", w.register_alias == alias, NULL);
	out_bool("renewed", w.renewed, NULL);
	out_end();
	if (w.register_alias != alias && t->verbosity >= 0)
		note("slave %u: this master uses the alias %s; register 0x0012 has %u until the slave is switched off and on",
		     s->position, w.renewed ? "now" : "after the slave has left SAFEOP and OP and a rescan",
		     w.register_alias);
	return 0;
}

static int all(const struct tool *t, struct dev *d, u16 alias)
{
	struct slaves sel;
	int ret = 0;

	if (dev_select(d, t, &sel, NULL))
		return 1;
	if (!sel.n)
		ret = list_all(&t->aliases) && list_all(&t->positions) ? dev_none_present(d) :
									  dev_nothing_selected();
	else if (sel.n > 1 && !t->force)
		ret = fail("%zu slaves are selected and would get the same alias; select one with --position, or --force",
			   sel.n);
	out_u("master", d->master, NULL);
	out_array("slaves");
	for (size_t i = 0; i < sel.n && !ret; i++)
		ret = write_alias(t, d, &sel.v[i], alias);
	out_end();
	slaves_free(&sel);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct dev d;
	u64 alias;
	int ret;

	(void)argc;
	if (io_number("alias", argv[0], 0xffff, &alias))
		return 1;
	if (dev_open_single(&d, t, true))
		return 1;
	ret = all(t, &d, (u16)alias);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_alias = {
	.name = "alias",
	.run = run,
	.args = "ALIAS",
	.opts = "mapfqK",
	.summary = "Write the alias of a slave into its EEPROM",
	.help = "ALIAS := { 0 to 65535; 0: none }\n"
		"Words 4 and 7 of the EEPROM are written and read back; the master then uses the alias at\n"
		"once. Many slaves set register 0x0012 at power-on only: a note reports it. Several slaves get\n"
		"the same alias only with --force, and so does a slave in SAFEOP or OP, or one that an\n"
		"application has configured.\n"
		"If the checksum of the EEPROM is wrong, a write was interrupted: give it the whole image\n"
		"with sii_write, or --repair-checksum where only an alias was being written.\n",
	.json = "master, slaves[] (position, alias, in_register, renewed)",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 1,
};
