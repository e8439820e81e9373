// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "bus_int.h"
#include "present_all.h"

static struct {
	struct bus_wish *wish;
	struct ecb_bus *bus;
} into;

static int no_memory(void)
{
	return fail("out of memory");
}

static void read_slave(const struct ect_slave *s, struct ecb_slave *to)
{
	to->vendor = s->vendor_id;
	to->product = s->product_code;
	to->revision = s->revision_number;
	to->alias = s->alias;
	to->identification = s->identification;
	if (into.wish->whole || into.wish->file || into.wish->serials)
		to->serial = s->serial_number;
	to->type = ecb_bus_text(into.bus, s->order[0] ? s->order : s->name);
}

/* what slaves say themselves; @v: one for each */
static int read_present(const struct tool *t, struct dev *d, const struct ect_list *list,
		     struct ecb_master *m, struct present *v)
{
	size_t n = m->slave_count;
	unsigned int wish = 0;
	int ret = 0;

	for (size_t i = 0; i < n && !ret; i++) {
		ret = bus_present_wish(into.wish, d->master, ect_list_get(list, i), &v[i]);
		wish |= v[i].wish;
	}
	if (!ret && wish)
		ret = present_read_all(t, d, v, n);
	for (size_t i = 0; i < n && !ret; i++) {
		if (v[i].wish & ~v[i].known & ~PRESENT_NAMES) {
			note("Master%u slave %zu: %s was not read: %s", d->master, i,
			     v[i].wish & PRESENT_VALUES ? "an object" : "its dictionary", v[i].why);
			into.wish->unread++;
		}
		ret = bus_present_take(into.bus, &v[i], m->slaves[i]);
		if (!ret && v[i].wish & PRESENT_PDOS)
			ret = bus_pdos(d, into.bus, &v[i], m->slaves[i]);
	}
	return ret;
}

/* needs the names */
static int read_more(const struct tool *t, struct dev *d, const struct ect_list *list,
		     struct ecb_master *m)
{
	struct present *v = calloc(m->slave_count + 1, sizeof(*v));
	int ret = v ? read_present(t, d, list, m, v) : no_memory();

	for (size_t i = 0; v && i < m->slave_count; i++)
		present_free(&v[i]);
	free(v);
	return ret ? ret : bus_session(d, into.bus, list, m);
}

/* An alias is of one slave in a file: the first one that has it. */
static void signs_once(struct ecb_master *m)
{
	u8 alias[65536 / 8] = { 0 }, id[65536 / 8] = { 0 };

	for (size_t i = 0; i < m->slave_count; i++) {
		struct ecb_slave *s = m->slaves[i];

		if (s->alias && alias[s->alias / 8] >> s->alias % 8 & 1) {
			note("slave %zu has alias %u, as another slave before it; the bus file omits it",
			     i, s->alias);
			s->alias = 0;
		}
		if (id[s->identification / 8] >> s->identification % 8 & 1)
			s->identification = 0;
		alias[s->alias / 8] |= (u8)(1 << s->alias % 8);
		id[s->identification / 8] |= (u8)(1 << s->identification % 8);
	}
}

/* the names that data, watch and set use */
static int name_slaves(const struct ect_list *list, struct ecb_master *m)
{
	struct ecb_slave_name *names = calloc(m->slave_count + 1, sizeof(*names));
	const struct ect_slave *s;
	int ret;

	if (!names)
		return no_memory();
	for (size_t i = 0; i < m->slave_count && (s = ect_list_get(list, i)); i++)
		names[i] = (struct ecb_slave_name){
			.order = s->order, .text = s->name, .group = s->group,
		};
	ret = ecb_name_slaves(names, m->slave_count) ? no_memory() : 0;
	for (size_t i = 0; i < m->slave_count && !ret; i++) {
		m->slaves[i]->name = ecb_bus_text(into.bus, names[i].name);
		if (!m->slaves[i]->name)
			ret = no_memory();
	}
	free(names);
	return ret;
}

/* needs the names */
static int read_ports(const struct ect_list *list, struct ecb_master *m)
{
	struct ect_list *nodes;
	const struct ect_node *n;

	if (ect_topology(list, &nodes, NULL))
		return no_memory();
	for (size_t i = 0; (n = ect_list_get(nodes, i)); i++) {
		if (n->slave >= m->slave_count || n->parent >= m->slave_count)
			continue;
		m->slaves[n->slave]->parent = m->slaves[n->parent]->name;
		m->slaves[n->slave]->port = (uint8_t)n->parent_port;
	}
	ect_list_free(nodes);
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	struct ecb_master *m = ecb_master_add(into.bus);
	struct ect_list *list;
	const struct ect_slave *s;
	struct ecb_error e;
	int err, ret = 0;

	if (!m)
		return no_memory();
	m->index = d->master;
	err = ect_slaves_read(d->h, &list);
	if (err)
		return dev_fail(d, err, "Master%u: cannot read its slaves", d->master);
	for (size_t i = 0; (s = ect_list_get(list, i)) && !ret; i++) {
		struct ecb_slave *to = ecb_slave_add(into.bus, m);

		if (to)
			read_slave(s, to);
		ret = to ? 0 : no_memory();
	}
	if (!ret)
		ret = name_slaves(list, m);
	if (!ret && (into.wish->whole || into.wish->file))
		ret = read_more(t, d, list, m);
	if (!ret)
		signs_once(m);
	if (!ret && ecb_bus_finish(into.bus, "machine", &e))
		ret = fail("%s", e.text);
	if (!ret)
		ret = read_ports(list, m);
	ect_list_free(list);
	return ret;
}

/* whether a slave is asked for more than the master knows: that is bus traffic */
static bool asks_slaves(const struct bus_wish *wish)
{
	const struct ecb_bus *f = wish->file;

	for (size_t i = 0; f && i < f->master_count; i++)
		for (size_t k = 0; k < f->masters[i]->slave_count; k++) {
			const struct ecb_slave *s = f->masters[i]->slaves[k];

			if (s->pdo_count || s->module_count || s->clock || s->startup_count)
				return true;
		}
	return wish->whole || wish->pdos;
}

static int make(const struct tool *t, struct dev *d, struct bus_wish *wish, struct ecb_bus **bus)
{
	int ret;

	into.wish = wish;
	into.bus = ecb_bus_new();
	if (!into.bus)
		return no_memory();
	ret = d ? each(t, d) : dev_each(t, asks_slaves(wish), each);
	if (ret)
		ecb_bus_free(into.bus);
	else
		*bus = into.bus;
	return ret;
}

int bus_of_master(const struct tool *t, struct dev *d, struct bus_wish *wish,
		  struct ecb_bus **bus)
{
	return make(t, d, wish, bus);
}

int bus_of_machine(const struct tool *t, struct bus_wish *wish, struct ecb_bus **bus)
{
	return make(t, NULL, wish, bus);
}
