// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "bus_machine.h"

static struct {
	const struct bus_wish *wish;
	struct ecb_bus *bus;
} into;

static int no_memory(void)
{
	return fail("out of memory");
}

/* values of a PDO, with the names that ecb_name_entries() makes of the texts of the EEPROM */
static int name_values(struct ecb_slave *to, char (*texts)[ECT_STRING], size_t n)
{
	struct ecb_entry_name *names = calloc(n ? n : 1, sizeof(*names));
	size_t at = 0;
	int ret = 0;

	if (!names)
		return no_memory();
	for (size_t p = 0; p < to->pdo_count; p++)
		for (size_t i = 0; i < to->pdos[p]->entry_count; i++, at++) {
			names[at].text = texts[at];
			names[at].pdo = to->pdos[p]->name;
			names[at].pdo_index = to->pdos[p]->index;
			names[at].index = ECB_INDEX(to->pdos[p]->entries[i]->object);
			names[at].subindex = ECB_SUBINDEX(to->pdos[p]->entries[i]->object);
		}
	if (ecb_name_entries(names, n))
		ret = no_memory();
	at = 0;
	for (size_t p = 0; p < to->pdo_count && !ret; p++)
		for (size_t i = 0; i < to->pdos[p]->entry_count; i++, at++)
			to->pdos[p]->entries[i]->name = ecb_bus_text(into.bus, names[at].name);
	free(names);
	return ret;
}

struct texts {
	char (*v)[ECT_STRING];
	size_t n;
};

static int read_entries(struct dev *d, const struct ect_slave *s, unsigned int sm, unsigned int pdo,
			const struct ect_pdo *p, struct ecb_pdo *to, struct texts *texts)
{
	for (unsigned int i = 0; i < p->entry_count; i++) {
		struct ect_pdo_entry e = { .struct_size = sizeof(e) };
		struct ecb_entry *entry;
		void *grown;
		int err = ect_pdo_entry_read(d->h, s->device, sm, pdo, i, &e);

		if (err)
			return dev_fail(d, err, "slave %u: cannot read PDO 0x%04x", s->position,
					p->index);
		/* neither a gap nor a value */
		if (!e.bits)
			continue;
		grown = realloc(texts->v, (texts->n + 1) * sizeof(*texts->v));
		if (!grown)
			return no_memory();
		texts->v = grown;
		memcpy(texts->v[texts->n++], e.name, sizeof(e.name));
		entry = ecb_entry_add(into.bus, to);
		if (!entry)
			return no_memory();
		entry->object = e.index ? (u32)e.index << 8 | e.subindex : 0;
		entry->bits = e.bits;
	}
	return 0;
}

static int read_pdos(struct dev *d, const struct ect_slave *s, struct ecb_slave *to)
{
	struct texts texts = { 0 };
	int err, ret = 0;

	for (unsigned int i = 0; i < s->sm_count && !ret; i++) {
		struct ect_sm sm = { .struct_size = sizeof(sm) };

		err = ect_sm_read(d->h, s->device, i, &sm);
		if (err) {
			ret = dev_fail(d, err, "slave %u: cannot read SM%u", s->position, i);
			break;
		}
		for (unsigned int k = 0; k < sm.pdo_count && !ret; k++) {
			struct ect_pdo p = { .struct_size = sizeof(p) };
			struct ecb_pdo *pdo;

			err = ect_pdo_read(d->h, s->device, i, k, &p);
			if (err) {
				ret = dev_fail(d, err, "slave %u: cannot read PDO %u of SM%u",
					       s->position, k, i);
				break;
			}
			pdo = ecb_pdo_add(into.bus, to);
			if (!pdo) {
				ret = no_memory();
				break;
			}
			pdo->index = p.index;
			pdo->sm = (uint8_t)i;
			pdo->name = ecb_bus_text(into.bus, p.name);
			ret = read_entries(d, s, i, k, &p, pdo, &texts);
		}
	}
	if (!ret)
		ret = name_values(to, texts.v, texts.n);
	free(texts.v);
	return ret;
}

static int read_slave(struct dev *d, const struct ect_slave *s, struct ecb_slave *to)
{
	to->vendor = s->vendor_id;
	to->product = s->product_code;
	to->revision = s->revision_number;
	to->alias = s->alias;
	to->identification = s->identification;
	to->serial = into.wish->serial ? s->serial_number : 0;
	to->type = ecb_bus_text(into.bus, s->order[0] ? s->order : s->name);
	return into.wish->pdos ? read_pdos(d, s, to) : 0;
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

	(void)t;
	if (!m)
		return no_memory();
	m->index = d->master;
	err = ect_slaves_read(d->h, &list);
	if (err)
		return dev_fail(d, err, "Master%u: cannot read its slaves", d->master);
	for (size_t i = 0; (s = ect_list_get(list, i)) && !ret; i++) {
		struct ecb_slave *to = ecb_slave_add(into.bus, m);

		ret = to ? read_slave(d, s, to) : no_memory();
	}
	if (!ret)
		ret = name_slaves(list, m);
	if (!ret)
		signs_once(m);
	if (!ret && ecb_bus_finish(into.bus, "machine", &e))
		ret = fail("%s", e.text);
	if (!ret)
		ret = read_ports(list, m);
	ect_list_free(list);
	return ret;
}

int bus_of_machine(const struct tool *t, const struct bus_wish *wish, struct ecb_bus **bus)
{
	int ret;

	into.wish = wish;
	into.bus = ecb_bus_new();
	if (!into.bus)
		return no_memory();
	ret = dev_each(t, false, each);
	if (ret) {
		ecb_bus_free(into.bus);
		return ret;
	}
	*bus = into.bus;
	return 0;
}
