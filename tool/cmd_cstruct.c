// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "layout.h"
#include "out.h"

#define CONTROL_WATCHDOG	0x40

/* text inside a comment: it can neither end it nor begin another */
static void comment_text(const char *s)
{
	for (; *s; s++) {
		bool mark = (s[0] == '*' && s[1] == '/') || (s[0] == '/' && s[1] == '*');

		out_text(mark ? "%c " : "%c", *s);
	}
}

static void comment(const char *name)
{
	if (*name) {
		out_text(" /* ");
		comment_text(name);
		out_text(" */");
	}
	out_text("\n");
}

static unsigned int entries(unsigned int pos, const struct layout *l)
{
	unsigned int n = 0;

	for (unsigned int i = 0; i < l->n; i++)
		for (unsigned int k = 0; k < l->sms[i].sm.pdo_count; k++) {
			const struct layout_pdo *p = &l->sms[i].pdos[k];

			for (unsigned int e = 0; e < p->pdo.entry_count; e++) {
				if (!n++)
					out_text("ec_pdo_entry_info_t slave_%u_pdo_entries[] = {\n", pos);
				out_text("    {0x%04x, 0x%02x, %u},", p->entries[e].index,
					 p->entries[e].subindex, p->entries[e].bits);
				comment(p->entries[e].name);
			}
		}
	if (n)
		out_text("};\n\n");
	return n;
}

static unsigned int pdos(unsigned int pos, const struct layout *l)
{
	unsigned int n = 0, offset = 0;

	for (unsigned int i = 0; i < l->n; i++)
		for (unsigned int k = 0; k < l->sms[i].sm.pdo_count; k++) {
			const struct ect_pdo *p = &l->sms[i].pdos[k].pdo;

			if (!n++)
				out_text("ec_pdo_info_t slave_%u_pdos[] = {\n", pos);
			if (p->entry_count)
				out_text("    {0x%04x, %u, slave_%u_pdo_entries + %u},", p->index,
					 p->entry_count, pos, offset);
			else
				out_text("    {0x%04x, 0, NULL},", p->index);
			comment(p->name);
			offset += p->entry_count;
		}
	if (n)
		out_text("};\n\n");
	return n;
}

static void syncs(unsigned int pos, const struct layout *l)
{
	unsigned int offset = 0;

	out_text("ec_sync_info_t slave_%u_syncs[] = {\n", pos);
	for (unsigned int i = 0; i < l->n; i++) {
		const struct ect_sm *s = &l->sms[i].sm;

		out_text("    {%u, %s, %u, ", s->sm,
			 layout_is_output(&l->sms[i]) ? "EC_DIR_OUTPUT" : "EC_DIR_INPUT",
			 s->pdo_count);
		if (s->pdo_count)
			out_text("slave_%u_pdos + %u, ", pos, offset);
		else
			out_text("NULL, ");
		out_text("%s},\n",
			 s->control & CONTROL_WATCHDOG ? "EC_WD_ENABLE" : "EC_WD_DISABLE");
		offset += s->pdo_count;
	}
	out_text("    {0xff}\n};\n\n");
}

static void json(const struct ect_slave *s, const struct layout *l)
{
	out_u("position", s->position, NULL);
	out_str("order_number", s->order, NULL);
	out_u("vendor_id", s->vendor_id, NULL);
	out_u("product_code", s->product_code, NULL);
	out_u("revision_number", s->revision_number, NULL);
	out_array("sync_managers");
	for (unsigned int i = 0; i < l->n; i++) {
		const struct layout_sm *sm = &l->sms[i];

		out_object(NULL);
		out_u("index", sm->sm.sm, NULL);
		out_str("direction", layout_is_output(sm) ? "output" : "input", NULL);
		out_bool("watchdog", sm->sm.control & CONTROL_WATCHDOG, NULL);
		out_array("pdos");
		for (unsigned int k = 0; k < sm->sm.pdo_count; k++) {
			out_object(NULL);
			out_u("index", sm->pdos[k].pdo.index, NULL);
			out_str("name", sm->pdos[k].pdo.name, NULL);
			out_array("entries");
			for (unsigned int e = 0; e < sm->pdos[k].pdo.entry_count; e++) {
				const struct ect_pdo_entry *x = &sm->pdos[k].entries[e];

				out_object(NULL);
				out_u("index", x->index, NULL);
				out_u("subindex", x->subindex, NULL);
				out_u("size_bits", x->bits, NULL);
				out_str("name", x->name, NULL);
				out_end();
			}
			out_end();
			out_end();
		}
		out_end();
		out_end();
	}
	out_end();
}

static void text(const struct dev *d, const struct ect_slave *s, const struct layout *l)
{
	out_text("/* Master %u, Slave %u", d->master, s->position);
	if (s->order[0]) {
		out_text(", \"");
		comment_text(s->order);
		out_text("\"");
	}
	out_text("\n * Vendor ID:       0x%08x\n", s->vendor_id);
	out_text(" * Product code:    0x%08x\n", s->product_code);
	out_text(" * Revision number: 0x%08x\n */\n\n", s->revision_number);
	entries(s->position, l);
	pdos(s->position, l);
	syncs(s->position, l);
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ect_slave *s, bool several)
{
	struct layout l;

	(void)w, (void)t, (void)several;
	if (layout_read(d, s, &l))
		return 1;
	if (l.n) {
		out_object(NULL);
		json(s, &l);
		text(d, s, &l);
		out_end();
	}
	layout_free(&l);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	static const struct slave_walk walk = { .slave = slave };

	(void)argc, (void)argv;
	return dev_each_slave(t, &walk);
}

const struct cmd cmd_cstruct = {
	.name = "cstruct",
	.run = run,
	.args = "",
	.opts = "map",
	.summary = "Print the PDO layout as C arrays for ecrt.h",
	.help = "Use the arrays as arguments of ecrt_slave_config_pdos(): ethercat cstruct -p2 > pdos.h\n"
		"Slaves without SyncManagers are omitted. Names are unique within one master: select\n"
		"the master with -m.\n",
	.json = "masters[]: master, slaves[]: position, order_number, vendor_id, product_code,\n"
		"revision_number, sync_managers[]: index, direction (output, input), watchdog, pdos[]: index,\n"
		"name, entries[]: index, subindex, size_bits, name",
	.flags = CMD_HISTORIC,
};
