// SPDX-License-Identifier: GPL-2.0-only
#include <string.h>

#include "layout.h"
#include "out.h"
#include "pdos_coe.h"

static void entry(const struct ect_pdo_entry *e)
{
	out_object(NULL);
	out_u("index", e->index, "    PDO entry 0x%04x", e->index);
	out_u("subindex", e->subindex, ":%02x", e->subindex);
	out_u("size_bits", e->bits, ", %2u bit", e->bits);
	out_str("name", e->name, ", \"%s\"\n", pdo_entry_text(e->index, e->name));
	out_end();
}

static void show_pdo(const struct layout_pdo *p, bool output, bool quiet)
{
	out_object(NULL);
	out_str("direction", output ? "rx" : "tx", "  %cxPDO", output ? 'R' : 'T');
	out_u("index", p->pdo.index, " 0x%04x", p->pdo.index);
	out_str("name", p->pdo.name, " \"%s\"\n", p->pdo.name);
	out_array("entries");
	for (unsigned int i = 0; i < p->pdo.entry_count && !quiet; i++)
		entry(&p->entries[i]);
	out_end();
	out_end();
}

static void show(const struct layout *l, bool quiet)
{
	for (unsigned int i = 0; i < l->n; i++) {
		const struct layout_sm *s = &l->sms[i];

		out_object(NULL);
		out_u("index", s->sm.sm, "SM%u", s->sm.sm);
		out_u("address", s->sm.start, ": PhysAddr 0x%04x", s->sm.start);
		out_u("default_size_bytes", s->sm.default_size, ", DefaultSize %4u",
		      s->sm.default_size);
		out_u("control", s->sm.control, ", ControlRegister 0x%02x", s->sm.control);
		out_u("enable", s->sm.enable, ", Enable %u\n", s->sm.enable);
		out_array("pdos");
		for (unsigned int k = 0; k < s->sm.pdo_count; k++)
			show_pdo(&s->pdos[k], layout_is_output(s), quiet);
		out_end();
		out_end();
	}
}

/* a port for each entry that carries data */
static void matlab_ports(const struct layout *l, bool output)
{
	unsigned int n = 0;

	for (unsigned int i = 0; i < l->n; i++) {
		const struct layout_sm *s = &l->sms[i];

		for (unsigned int k = 0; k < s->sm.pdo_count && layout_is_output(s) == output; k++)
			for (unsigned int e = 0; e < s->pdos[k].pdo.entry_count; e++) {
				const struct ect_pdo_entry *x = &s->pdos[k].entries[e];
				const char *kind = output ? "input" : "output";

				if (!x->index)
					continue;
				n++;
				out_text("rv.PortConfig.%s(%u).pdo = [%u, %u, %u, 0];\n", kind,
					 n, i, k, e);
				out_text("rv.PortConfig.%s(%u).pdo_data_type = %u;\n\n", kind,
					 n, 1000u + x->bits);
			}
	}
}

/* "..." continues a line: without it MATLAB begins a row there */
static void matlab_sm(const struct layout_sm *s)
{
	out_text("    {%u, %u, {\n", s->sm.sm, !layout_is_output(s));
	for (unsigned int k = 0; k < s->sm.pdo_count; k++) {
		const struct layout_pdo *p = &s->pdos[k];

		out_text("        {hex2dec('%04x'), [\n", p->pdo.index);
		for (unsigned int e = 0; e < p->pdo.entry_count; e++)
			out_text("            hex2dec('%04x'), hex2dec('%02x'), %3u; ...\n",
				 p->entries[e].index, p->entries[e].subindex, p->entries[e].bits);
		out_text("            ]}, ...\n");
	}
	out_text("        }}, ...\n");
}

static void matlab(const struct dev *d, const struct ect_slave *s, const struct layout *l)
{
	out_text("%%\n%% Master %u, Slave %u", d->master, s->position);
	if (*s->order)
		out_text(", \"%s\"", s->order);
	out_text("\n%%\nfunction rv = slave%u()\n\n%% Slave configuration\n\n", s->position);
	out_text("rv.SlaveConfig.vendor = %u;\n", s->vendor_id);
	out_text("rv.SlaveConfig.product = hex2dec('%08x');\n", s->product_code);
	out_text("rv.SlaveConfig.description = '");
	for (const char *c = s->order; *c; c++)
		out_text(*c == '\'' ? "''" : "%c", *c);
	out_text("';\nrv.SlaveConfig.sm = { ...\n");
	for (unsigned int i = 0; i < l->n; i++)
		matlab_sm(&l->sms[i]);
	out_text("    };\n\n%% Port configuration\n\n");
	matlab_ports(l, true);
	matlab_ports(l, false);
	out_text("end\n\n");
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ect_slave *s, bool several)
{
	bool etherlab = t->skin && !strcmp(t->skin, "etherlab") && !out_is_json();
	struct layout l;

	(void)w;
	if (layout_read(d, s, &l))
		return 1;
	out_object(NULL);
	out_u("position", s->position, NULL);
	if (l.n && !etherlab && several)
		out_text("=== Master %u, Slave %u ===\n", d->master, s->position);
	out_array("sync_managers");
	if (l.n && etherlab)
		matlab(d, s, &l);
	else
		show(&l, t->verbosity < 0);
	out_end();
	out_end();
	layout_free(&l);
	return 0;
}

static int end(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected)
{
	(void)w;
	if (!selected || taken)
		return 0;
	return fail("Master%u: no selected slave has CoE", d->master);
}

static int run(struct tool *t, int argc, char **argv)
{
	static const struct slave_walk walk = { .slave = slave };
	static const struct slave_walk coe = {
		.write = true, .takes = pdos_coe_has, .slave = pdos_coe, .end = end,
	};

	(void)argc, (void)argv;
	if (t->skin && strcmp(t->skin, "default") && strcmp(t->skin, "etherlab"))
		return usage_error("unknown skin '%s': expected default or etherlab", t->skin);
	if (t->coe && t->skin)
		return usage_error("--coe and --skin exclude each other");
	return dev_each_slave(t, t->coe ? &coe : &walk);
}

const struct cmd cmd_pdos = {
	.name = "pdos",
	.run = run,
	.args = "",
	.opts = "mapsqvO",
	.summary = "Show SyncManagers, PDOs and PDO entries",
	.help = "The master writes RxPDOs and reads TxPDOs. An entry 0x0000:00 is a gap. Names are\n"
		"those of the SII, otherwise of the object dictionary, which the master reads while\n"
		"no application is active. --quiet omits the entries. The skin etherlab prints a\n"
		"MATLAB function for each slave. --coe reads assignment (0x1c12...) and mapping (0x1600...,\n"
		"0x1a00...) from the slave at this call, names from the SII, and marks a PDO whose\n"
		"assignment or mapping is another in the SII.\n",
	.json = "masters[]: master, slaves[]: position, sync_managers[]: index, address,\n"
		"default_size_bytes, control, enable, pdos[]: direction (rx, tx), index, name,\n"
		"entries[]: index, subindex, size_bits, name. --coe: sync_managers[]: index, object,\n"
		"pdos[]: direction, index, name, sii (same, other_mapping, not_assigned, unknown;\n"
		"only: the slave has not assigned it), entries[]",
	.flags = CMD_HISTORIC,
};
