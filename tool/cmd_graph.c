// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <strings.h>

#include "absent.h"
#include "errors.h"
#include "graph_tree.h"
#include "out.h"
#include "slave_info.h"

enum info { PLAIN, DC, CRC };

#define TYPE_EBUS	2

static void node(const struct ect_slave *s, enum info info)
{
	out_object(NULL);
	out_u("position", s->position, "\n\tslave%u [", s->position);
	out_text("shape=\"box\", label=\"%u / %u:%u", s->position, s->alias_group,
		 slave_alias_pos(s));
	out_u("alias", s->alias_group, NULL);
	out_u("relative_position", slave_alias_pos(s), NULL);
	if (s->order[0]) {
		out_text("\\n");
		out_quoted(s->order);
	}
	out_str("order_number", s->order, NULL);
	if (info == DC) {
		if (s->dc_delay_only)
			out_text("\\nDC: delay only");
		else if (s->dc_supported)
			out_text("\\nDC: %u bit", s->dc_supported == 1 ? 32u : 64u);
		if (slave_has_dc(s))
			out_u("dc_delay_ns", s->transmission_delay, "\\nDelay: %u ns",
			      s->transmission_delay);
	}
	out_text("\"]\n");
	out_end();
}

/* @e: NULL: not read */
static void label(const char *attribute, const struct ect_slave *s, unsigned int port,
		  enum info info, const struct ect_errors *e)
{
	out_text(", %s=\"%u", attribute, port);
	if (info == DC && slave_has_dc(s))
		out_text(" [%u]", s->ports[port].delay_to_next_dc);
	if (e)
		out_text(" [%u/%u]", err_rx(e, port), err_fwd(e, port));
	out_text("\"");
}

static void medium(unsigned int type)
{
	out_str("medium", port_type_text(type), " [label=\"%s\", weight=\"%u\"",
		port_type_text(type), type == TYPE_EBUS ? 5u : 1u);
}

static void edge(const struct slaves *all, const struct ect_slave *s, unsigned int port,
		 enum info info, const struct ect_errors *const *regs)
{
	const struct ect_slave *to = &all->v[s->ports[port].next_slave];
	unsigned int back;

	for (back = 0; back < ECT_PORTS && to->ports[back].next_slave != s->position; back++)
		;
	out_object(NULL);
	out_u("from", s->position, "\tslave%u", s->position);
	out_u("to", to->position, " -- slave%u", to->position);
	medium(s->ports[port].type);
	label("taillabel", s, port, info, regs[s->position]);
	out_u("from_port", port, NULL);
	if (back < ECT_PORTS) {
		label("headlabel", to, back, info, regs[to->position]);
		out_u("to_port", back, NULL);
	}
	out_text("]\n");
	out_end();
}

static void edge_to_master(const struct slaves *all, unsigned int at, unsigned int port,
			   enum info info, const struct ect_errors *const *regs)
{
	out_text("\tmaster -- slave%u [label=\"%s\", weight=\"%u\"", at,
		 port_type_text(all->v[at].ports[port].type),
		 all->v[at].ports[port].type == TYPE_EBUS ? 5u : 1u);
	label("headlabel", &all->v[at], port, info, regs[at]);
	out_text("]\n");
}

/*
 * The first open port without a slave behind it leads to the master, in a ring the last one as
 * well; it may be on any slave.
 */
static void to_master(const struct slaves *all, bool ring, enum info info,
		      const struct ect_errors *const *regs)
{
	unsigned int at[2] = { 0 }, port[2] = { 0 }, n = 0;

	for (unsigned int i = 0; i < all->n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			const struct ect_port *x = &all->v[i].ports[p];

			if (!x->signal || x->loop_closed || x->next_slave != ECT_NONE16)
				continue;
			at[!!n] = i;
			port[!!n] = p;
			n++;
		}
	edge_to_master(all, at[0], port[0], info, regs);
	if (ring && n > 1)
		edge_to_master(all, at[1], port[1], info, regs);
}

static void no_line(const struct dev *d, const char *text)
{
	(void)d, (void)text;
}

static int draw(struct dev *d, const struct slaves *all, enum info info,
		const struct ect_errors *const *regs)
{
	struct ect_list *devices;
	int ret;

	if (dev_devices(d, &devices))
		return 1;
	out_text("/* ethercat graph | dot -Tsvg > bus.svg */\n\n");
	out_text("strict graph bus {\n\trankdir=\"LR\"\n\tranksep=0.8\n\tnodesep=0.8\n"
		 "\tnode [fontname=\"Helvetica\"]\n"
		 "\tedge [fontname=\"Helvetica\", fontsize=\"10\"]\n\n"
		 "\tmaster [label=\"EtherCAT\\nMaster\"]\n");
	out_array("slaves");
	for (size_t i = 0; i < all->n; i++)
		node(&all->v[i], info);
	out_end();
	out_text("\n");
	if (all->n)
		to_master(all, ect_list_get(devices, 1), info, regs);
	ect_list_free(devices);
	out_array("links");
	for (size_t i = 0; i < all->n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			unsigned int next = all->v[i].ports[p].next_slave;

			if (next > i && next < all->n)
				edge(all, &all->v[i], p, info, regs);
		}
	out_end();
	ret = absent_show(d, all, no_line);
	if (!ret && !out_is_json())
		ret = absent_draw(d, all);
	out_text("}\n");
	return ret;
}

/* One that does not reply is drawn without counters. */
static int show(struct dev *d, enum info info, bool tree)
{
	struct ect_errors *regs;
	const struct ect_errors **counters;
	struct slaves all;
	int ret = 0;

	if (dev_slaves(d, &all))
		return 1;
	regs = calloc(all.n + 1, sizeof(*regs));
	counters = calloc(all.n + 1, sizeof(*counters));
	if (!regs || !counters) {
		ret = fail("out of memory");
		goto out;
	}
	for (size_t i = 0; i < all.n && info == CRC; i++) {
		if (errors_read(d, &all.v[i], &regs[i]))
			ret = 1;
		else
			counters[i] = &regs[i];
	}
	out_u("master", d->master, NULL);
	if (tree)
		ret |= graph_tree(d, &all, counters);
	else
		ret |= draw(d, &all, info, counters);
out:
	free(counters);
	free(regs);
	slaves_free(&all);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	enum info info = PLAIN;
	struct dev d;
	int ret;

	if (argc && !strcasecmp(argv[0], "dc"))
		info = DC;
	else if (argc && !strcasecmp(argv[0], "crc"))
		info = CRC;
	else if (argc)
		return usage_error("invalid argument '%s': expected DC, CRC or nothing", argv[0]);
	if (dev_open_single(&d, t, info == CRC))
		return 1;
	ret = show(&d, info, t->tree);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_graph = {
	.name = "graph",
	.run = run,
	.args = "[DC | CRC]",
	.opts = "mE",
	.summary = "Print the topology of the bus for Graphviz or as a tree",
	.help = "Draw it with: ethercat graph | dot -Tsvg > bus.svg\n"
		"DC adds clocks and delays in ns. CRC adds the error counters of each port [invalid\n"
		"frames/forwarded errors].\n"
		"--tree prints a tree of text instead. A line of slaves stays in one column, branches\n"
		"are indented. Columns: position and name; port of the slave upstream > own port;\n"
		"medium; AL state; open ports (-: no link, x: closed despite a link, ?: open without\n"
		"communication); delay from the reference clock. CRC adds the counters that are not 0.\n"
		"Ports behind which slaves were disconnected are drawn with a dashed line; the tree has a\n"
		"line for each of them, and for each port that stays closed although it has a link.\n",
	.json = "master, slaves[] (position, alias, relative_position, order_number, dc_delay_ns),\n"
		"links[] (from, to, medium, from_port, to_port); --tree: master, slaves[]: position,\n"
		"name, upstream and upstream_port (null: the master), port, medium, state, ports[]\n"
		"(type, link_up, loop_closed, signal; CRC: crc_errors, phy_errors, forwarded_errors,\n"
		"lost_links), dc_delay_ns (or null); absent[], closed_ports[] as of 'ethercat slaves'",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.max_args = 1,
};
