// SPDX-License-Identifier: GPL-2.0-only
/* The topology as a tree of text: a line of slaves stays in one column, branches are indented. */
#include "graph_tree.h"

#include <stdlib.h>
#include <string.h>

#include "../lib/tools/text.h"
#include "absent.h"
#include "out.h"
#include "slave_info.h"
#include "topology.h"

#define MAX_DEPTH	16	/* deeper branches are not indented further */
#define INDENT		3	/* columns of a level */

static int digits(size_t v)
{
	return snprintf(NULL, 0, "%zu", v);
}

/* characters of a name, which may also be Latin-1 */
static int columns(const char *s)
{
	size_t size = strlen(s);
	int n = 0;

	for (size_t i = 0; i < size; n++)
		i += (size_t)max(utf8_len((const unsigned char *)s + i, size - i), 1);
	return n;
}

static int levels(const struct ect_node *n)
{
	return (int)min(n->depth, (u32)MAX_DEPTH) + 1;
}

/* of tree with names, and of states */
struct widths {
	int name;
	int state;
};

static struct widths measure(const struct topo *t, const struct slaves *all)
{
	char name[ECT_STRING], state[16];
	struct widths w = { 0 };

	for (size_t i = 0; i < all->n; i++) {
		slave_name(&all->v[i], name, sizeof(name));
		al_state_text(all->v[i].al_status, state, sizeof(state));
		w.name = max(w.name, levels(t->node[i]) * INDENT + columns(name));
		w.state = max(w.state, (int)strlen(state));
	}
	return w;
}

/* "0 1 - -": a number is an open port, x one that is closed despite its link */
static void ports(const struct ect_slave *s)
{
	out_text("  ports");
	for (unsigned int i = 0; i < ECT_PORTS; i++) {
		const struct ect_port *p = &s->ports[i];
		char c = !p->loop_closed && p->signal ? (char)('0' + i) :
			 !p->loop_closed ? '?' : p->link_up ? 'x' : '-';

		out_text(" %c", c);
	}
}

static void counter(const char *name, unsigned int v, const char **sep)
{
	if (!v)
		return;
	out_text("%s%s %u", *sep, name, v);
	*sep = ", ";
}

static void errors_text(const struct ect_errors *e)
{
	for (unsigned int i = 0; i < ECT_PORTS; i++) {
		const char *sep = " ";

		if (!err_rx(e, i) && !err_phy(e, i) && !err_fwd(e, i) &&
		    !err_lost(e, i))
			continue;
		out_text("  port %u:", i);
		counter("CRC", err_rx(e, i), &sep);
		counter("PHY", err_phy(e, i), &sep);
		counter("FWD", err_fwd(e, i), &sep);
		counter("lost links", err_lost(e, i), &sep);
	}
}

static void ports_json(const struct ect_slave *s, const struct ect_errors *e)
{
	out_array("ports");
	for (unsigned int i = 0; i < ECT_PORTS; i++) {
		const struct ect_port *p = &s->ports[i];

		out_object(NULL);
		out_str("type", port_type_text(p->type), NULL);
		out_bool("link_up", p->link_up, NULL);
		out_bool("loop_closed", p->loop_closed, NULL);
		out_bool("signal", p->signal, NULL);
		if (e) {
			out_u("crc_errors", err_rx(e, i), NULL);
			out_u("phy_errors", err_phy(e, i), NULL);
			out_u("forwarded_errors", err_fwd(e, i), NULL);
			out_u("lost_links", err_lost(e, i), NULL);
		}
		out_end();
	}
	out_end();
}

static void upstream(const struct ect_node *n)
{
	if (n->parent == ECT_NONE32) {
		out_null("upstream", NULL);
		out_null("upstream_port", NULL);
		out_text("  %u  ", n->port);
	} else {
		out_u("upstream", n->parent, NULL);
		out_u("upstream_port", n->parent_port, "  %u>", n->parent_port);
		out_text("%u", n->port);
	}
	out_u("port", n->port, NULL);
}

static void row(const struct topo *t, const struct ect_slave *s, struct widths w,
		const struct ect_errors *e)
{
	const struct ect_node *n = t->node[s->position];
	const char *medium = port_type_text(s->ports[n->port].type);
	char name[ECT_STRING], state[16];

	slave_name(s, name, sizeof(name));
	al_state_text(s->al_status, state, sizeof(state));
	out_object(NULL);
	for (int i = 1; i < levels(n); i++)
		out_text("\u2502  ");
	out_text("%s ", n->last ? "\u2514\u2500" : "\u251c\u2500");
	out_u("position", s->position, "%*u  ", digits(t->n - 1), s->position);
	out_str("name", name, "%s", name);
	out_text("%*s", w.name - levels(n) * INDENT - columns(name), "");
	upstream(n);
	out_str("medium", medium, "  %-4s", medium);
	out_str("state", state, "  %-*s", w.state, state);
	ports(s);
	ports_json(s, e);
	if (slave_has_dc(s))
		out_u("dc_delay_ns", s->transmission_delay, "  %u ns", s->transmission_delay);
	else
		out_null("dc_delay_ns", "  no DC");
	if (e)
		errors_text(e);
	out_text("\n");
	out_end();
}

static void heading(struct dev *d, const struct ect_list *devices, unsigned int backup)
{
	const struct ect_device *dev = ect_list_get(devices, backup);

	out_text("Master%u: %s device %s, link %s\n", d->master, backup ? "backup" : "main",
		 dev ? dev->name : "", dev && dev->link_up ? "up" : "down");
}

static void tree_line(const struct dev *d, const char *text)
{
	(void)d;
	out_text("%s\n", text);
}

/**
 * graph_tree() - print the tree of a master
 * @d: open file of the master
 * @all: its slaves
 * @errors: counters of each, or NULL: without error counters
 *
 * Return: 0, or 1 after printing an error.
 */
int graph_tree(struct dev *d, const struct slaves *all, const struct ect_errors *const *errors)
{
	struct ect_list *devices;
	struct widths w;
	struct topo t;
	int ret = 0;

	if (dev_devices(d, &devices))
		return 1;
	if (topo_build(&t, all)) {
		ret = 1;
		goto out;
	}
	w = measure(&t, all);
	if (!all->n)
		heading(d, devices, 0);
	out_array("slaves");
	for (size_t i = 0; i < all->n; i++) {
		const struct ect_node *n = ect_list_get(t.order, i);

		if (n->parent == ECT_NONE32)
			heading(d, devices, n->device);
		row(&t, &all->v[n->slave], w, errors[n->slave]);
	}
	out_end();
	ret = absent_show(d, all, tree_line);
out:
	ect_list_free(devices);
	topo_free(&t);
	return ret;
}
