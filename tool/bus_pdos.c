// SPDX-License-Identifier: GPL-2.0-only
/* PDOs of a slave with names and types: of its dictionary, else of its EEPROM. */
#include <stdlib.h>
#include <string.h>

#include "bus_int.h"
#include "data_types.h"
#include "sii_image.h"

/* an entry that is made; @text is empty if nothing names it */
struct text {
	char name[ECT_TEXT];
};

/* an entry of a PDO that the EEPROM assigns; those are the names that 'data' shows */
struct assigned {
	u16 pdo;
	u16 index;
	u8 sub;
	char pdo_name[ECT_STRING];
	char name[ECT_STRING];
};

/* PDOs of a slave while they are made */
struct making {
	struct dev *d;
	struct ecb_bus *bus;
	const struct ect_slave *s;
	struct ecb_slave *to;
	u8 *img;
	size_t size;
	struct text *texts;
	size_t n;
	struct assigned *assigned;
	size_t assigned_n;
};

static int no_memory(void)
{
	return fail("out of memory");
}

static uint8_t type_of(u16 code, unsigned int bits)
{
	static const struct {
		enum ec_type_kind kind;
		u8 bits;
		uint8_t type;
	} types[] = {
		{ EC_KIND_BOOL, 1, ECB_TYPE_BOOL }, { EC_KIND_INT, 8, ECB_TYPE_INT8 },
		{ EC_KIND_INT, 16, ECB_TYPE_INT16 }, { EC_KIND_INT, 32, ECB_TYPE_INT32 },
		{ EC_KIND_INT, 64, ECB_TYPE_INT64 }, { EC_KIND_UINT, 8, ECB_TYPE_UINT8 },
		{ EC_KIND_UINT, 16, ECB_TYPE_UINT16 }, { EC_KIND_UINT, 32, ECB_TYPE_UINT32 },
		{ EC_KIND_UINT, 64, ECB_TYPE_UINT64 }, { EC_KIND_FLOAT, 32, ECB_TYPE_REAL32 },
		{ EC_KIND_FLOAT, 64, ECB_TYPE_REAL64 },
	};
	const struct ec_type *t = code ? ec_type_by_code(code) : NULL;

	for (unsigned int i = 0; t && t->bits == bits && i < ARRAY_SIZE(types); i++)
		if (types[i].kind == t->kind && types[i].bits == bits)
			return types[i].type;
	return ECB_TYPE_NONE;
}

/* @name: of the dictionary; that of the EEPROM comes first, as for 'data' and 'watch' */
static int add_entry(struct making *m, struct ecb_pdo *pdo, u16 index, u8 sub, u8 bits, u16 type,
		     const char *name)
{
	struct text *grown;
	struct ecb_entry *e;
	u16 sii_type = 0;

	/* neither a gap nor a value */
	if (!bits)
		return 0;
	grown = realloc(m->texts, (m->n + 1) * sizeof(*grown));
	if (!grown)
		return no_memory();
	m->texts = grown;
	sii_entry_text(m->img, m->size, index, sub, grown[m->n].name, sizeof(grown->name),
		       &sii_type);
	if (!*grown[m->n].name)
		snprintf(grown[m->n].name, sizeof(grown->name), "%s", name);
	m->n++;
	e = ecb_entry_add(m->bus, pdo);
	if (!e)
		return no_memory();
	e->object = index ? (u32)index << 8 | sub : 0;
	e->bits = bits;
	if (index)
		e->type = type_of(type, bits) ?: type_of(sii_type, bits);
	return 0;
}

static int sii_entries(struct making *m, unsigned int sm, unsigned int k, const struct ect_pdo *p,
		       struct ecb_pdo *to)
{
	for (unsigned int i = 0; i < p->entry_count; i++) {
		struct ect_pdo_entry e = { .struct_size = sizeof(e) };
		int err = ect_pdo_entry_read(m->d->h, m->s->device, sm, k, i, &e);

		if (err)
			return dev_fail(m->d, err, "slave %u: cannot read PDO 0x%04x",
					m->s->position, p->index);
		if (add_entry(m, to, e.index, e.subindex, e.bits, 0, e.name))
			return 1;
	}
	return 0;
}

static int sii_pdos(struct making *m, unsigned int sm)
{
	struct ect_sm x = { .struct_size = sizeof(x) };
	int err = ect_sm_read(m->d->h, m->s->device, sm, &x);

	if (err)
		return dev_fail(m->d, err, "slave %u: cannot read SM%u", m->s->position, sm);
	for (unsigned int k = 0; k < x.pdo_count; k++) {
		struct ect_pdo p = { .struct_size = sizeof(p) };
		struct ecb_pdo *to;

		err = ect_pdo_read(m->d->h, m->s->device, sm, k, &p);
		if (err)
			return dev_fail(m->d, err, "slave %u: cannot read PDO %u of SM%u",
					m->s->position, k, sm);
		to = ecb_pdo_add(m->bus, m->to);
		if (!to)
			return no_memory();
		to->index = p.index;
		to->sm = (uint8_t)sm;
		to->name = ecb_bus_text(m->bus, p.name);
		if (sii_entries(m, sm, k, &p, to))
			return 1;
	}
	return 0;
}

static int keep_assigned(struct making *m, unsigned int sm, unsigned int k, const struct ect_pdo *p)
{
	for (unsigned int i = 0; i < p->entry_count; i++) {
		struct ect_pdo_entry e = { .struct_size = sizeof(e) };
		struct assigned *to;

		if (ect_pdo_entry_read(m->d->h, m->s->device, sm, k, i, &e))
			break;
		to = realloc(m->assigned, (m->assigned_n + 1) * sizeof(*to));
		if (!to)
			return no_memory();
		m->assigned = to;
		to += m->assigned_n++;
		*to = (struct assigned){ .pdo = p->index, .index = e.index, .sub = e.subindex };
		memcpy(to->pdo_name, p->name, sizeof(to->pdo_name));
		memcpy(to->name, e.name, sizeof(to->name));
	}
	return 0;
}

static int read_assigned(struct making *m)
{
	for (unsigned int sm = 0; sm < m->s->sm_count; sm++) {
		struct ect_sm x = { .struct_size = sizeof(x) };

		if (ect_sm_read(m->d->h, m->s->device, sm, &x))
			continue;
		for (unsigned int k = 0; k < x.pdo_count; k++) {
			struct ect_pdo p = { .struct_size = sizeof(p) };

			if (ect_pdo_read(m->d->h, m->s->device, sm, k, &p))
				break;
			if (keep_assigned(m, sm, k, &p))
				return 1;
		}
	}
	return 0;
}

/* the name that the EEPROM has of it, wherever it is assigned there */
static void pdo_name(const struct making *m, const struct present_pdo *p, char *name, size_t size)
{
	struct ec_sii_pdo x;

	*name = 0;
	if (sii_pdo_find(m->img, m->size, p->index, &x))
		sii_text(m->img, m->size, x.name, name, size);
	for (size_t i = 0; !*name && i < m->assigned_n; i++)
		if (m->assigned[i].pdo == p->index)
			snprintf(name, size, "%s", m->assigned[i].pdo_name);
	if (!*name)
		snprintf(name, size, "%s", p->name);
}

/* that of the same PDO, else of another one; without any @name stays */
static void entry_name(const struct making *m, const struct present_pdo *p, u32 map, char *name,
		       size_t size)
{
	for (size_t i = 0; i < m->assigned_n; i++) {
		const struct assigned *a = &m->assigned[i];

		if (a->index != map >> 16 || a->sub != (u8)(map >> 8) || !*a->name)
			continue;
		snprintf(name, size, "%s", a->name);
		if (a->pdo == p->index)
			break;
	}
}

static int present_entries(struct making *m, const struct present_pdo *p, struct ecb_pdo *to)
{
	for (unsigned int i = 0; i < p->n; i++) {
		const struct present_entry *e = &p->entries[i];
		char name[ECT_TEXT];

		snprintf(name, sizeof(name), "%s", e->name);
		if (e->map >> 16)
			entry_name(m, p, e->map, name, sizeof(name));
		if (add_entry(m, to, (u16)(e->map >> 16), (u8)(e->map >> 8), (u8)e->map, e->type,
			      name))
			return 1;
	}
	return 0;
}

static int present_pdos(struct making *m, const struct present *l, u8 sm)
{
	for (size_t i = 0; i < l->n; i++) {
		const struct present_pdo *p = &l->pdos[i];
		char name[ECT_TEXT];
		struct ecb_pdo *to;
		size_t k = 0;

		if (p->sm != sm)
			continue;
		while (k < m->to->pdo_count && m->to->pdos[k]->index != p->index)
			k++;
		/* a slave may assign a PDO twice, a file says it once */
		if (k < m->to->pdo_count)
			continue;
		to = ecb_pdo_add(m->bus, m->to);
		if (!to)
			return no_memory();
		pdo_name(m, p, name, sizeof(name));
		to->index = p->index;
		to->sm = sm;
		to->name = ecb_bus_text(m->bus, name);
		if (present_entries(m, p, to))
			return 1;
	}
	return 0;
}

/* values of all PDOs, with the names that ecb_name_entries() makes of their texts */
static int name_values(struct making *m)
{
	struct ecb_entry_name *names = calloc(m->n + 1, sizeof(*names));
	size_t at = 0;
	int ret = 0;

	if (!names)
		return no_memory();
	for (size_t p = 0; p < m->to->pdo_count; p++)
		for (size_t i = 0; i < m->to->pdos[p]->entry_count; i++, at++)
			names[at] = (struct ecb_entry_name){
				.text = m->texts[at].name, .pdo = m->to->pdos[p]->name,
				.pdo_index = m->to->pdos[p]->index,
				.index = ECB_INDEX(m->to->pdos[p]->entries[i]->object),
				.subindex = ECB_SUBINDEX(m->to->pdos[p]->entries[i]->object),
			};
	if (ecb_name_entries(names, m->n))
		ret = no_memory();
	at = 0;
	for (size_t p = 0; p < m->to->pdo_count && !ret; p++)
		for (size_t i = 0; i < m->to->pdos[p]->entry_count; i++, at++)
			m->to->pdos[p]->entries[i]->name = ecb_bus_text(m->bus, names[at].name);
	free(names);
	return ret;
}

int bus_pdos(struct dev *d, struct ecb_bus *bus, const struct present *l, struct ecb_slave *to)
{
	struct making m = { .d = d, .bus = bus, .s = l->s, .to = to };
	bool known = l->known & PRESENT_PDOS;
	int ret = sii_load(d, l->s, &m.img, &m.size);

	if (!ret && known && l->sms)
		ret = read_assigned(&m);
	for (u8 sm = 0; sm < l->s->sm_count && !ret; sm++)
		ret = known && sm < 32 && l->sms >> sm & 1 ? present_pdos(&m, l, sm) :
			sii_pdos(&m, sm);
	if (!ret)
		ret = name_values(&m);
	if (!ret && known)
		to->known |= ECB_KNOWN_PDOS;
	free(m.assigned);
	free(m.texts);
	free(m.img);
	return ret;
}
