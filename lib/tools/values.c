// SPDX-License-Identifier: LGPL-2.1-or-later
/* The process data of a session as values with names. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../include/ethercat-bus/names.h"
#include "../../master/wire/sii.h"
#include "internal.h"
#include "text.h"

_Static_assert(ECT_WORD == ECB_WORD && ECT_VALUE_NAME == ECB_VALUE, "names");

/* an entry as the slave describes it */
struct text {
	u16 pdo_index;
	u16 index;
	u8 subindex;
	char pdo[ECT_STRING];
	char name[ECT_STRING];
};

/**
 * struct entry - one of a configuration
 * @sm: SyncManager
 * @bit: in the SyncManager
 * @bits: length
 * @pdo_index: of its PDO
 * @index: object
 * @subindex: likewise
 */
struct entry {
	u8 sm;
	u8 bits;
	u8 subindex;
	u32 bit;
	u16 pdo_index;
	u16 index;
};

/**
 * struct slot - a configuration or a slave without one, which have names together
 * @place: ring position, as configured if it is
 * @config: index of the configuration, ECT_NONE32: none
 * @device: number of the slave, 0: disconnected
 * @vendor_id: identity
 * @product_code: likewise
 * @slave: a slave of this kind, NULL: there is none
 * @image: EEPROM of @slave, of a configuration
 * @size: bytes of @image
 * @entries: of a configuration
 * @names: of @entries
 * @n: of them
 */
struct slot {
	u32 place;
	u32 config;
	u64 device;
	u32 vendor_id;
	u32 product_code;
	const struct ect_slave *slave;
	u8 *image;
	size_t size;
	struct entry *entries;
	struct ecb_entry_name *names;
	size_t n;
};

struct naming {
	struct ect_list *slaves;
	struct slot *slots;
	struct ecb_slave_name *names;
	size_t n;
};

static void naming_free(struct naming *x)
{
	for (size_t i = 0; i < x->n; i++) {
		free(x->slots[i].image);
		free(x->slots[i].entries);
		free(x->slots[i].names);
	}
	free(x->slots);
	free(x->names);
	ect_list_free(x->slaves);
}

static int by_place(const void *a, const void *b)
{
	const struct slot *x = a, *y = b;

	if (x->place != y->place)
		return x->place < y->place ? -1 : 1;
	return x->config < y->config ? -1 : x->config > y->config;
}

/* While a slave is disconnected its name is that of the others of its kind. */
static const struct ect_slave *slave_of(const struct naming *x, const struct slot *t)
{
	const struct ect_slave *s, *alike = NULL;

	for (size_t i = 0; (s = ect_list_get(x->slaves, i)); i++) {
		if (t->device && s->device == t->device)
			return s;
		if (!alike && s->vendor_id == t->vendor_id && s->product_code == t->product_code)
			alike = s;
	}
	return alike;
}

static int add_configs(struct ect_handle *h, struct naming *x, unsigned int configs)
{
	for (unsigned int i = 0; i < configs; i++) {
		struct ect_config c = { .struct_size = sizeof(c) };
		int ret = ect_config_read(h, i, &c);

		if (ret)
			return ret;
		/* members of groups, and behind an alias: where the slave is */
		x->slots[x->n++] = (struct slot){
			.place = !c.alias && !c.group ? c.position : c.slave_position < 0 ?
				 ECT_NONE32 : (u32)c.slave_position,
			.config = i, .device = c.device, .vendor_id = c.vendor_id,
			.product_code = c.product_code,
		};
	}
	return 0;
}

static void add_others(struct naming *x)
{
	const struct ect_slave *s;

	for (size_t i = 0; (s = ect_list_get(x->slaves, i)); i++) {
		if (s->config)
			continue;
		x->slots[x->n++] = (struct slot){
			.place = s->position, .config = ECT_NONE32, .device = s->device,
			.vendor_id = s->vendor_id, .product_code = s->product_code,
		};
	}
}

/* Names in the configured order of the bus: they stay while a slave is disconnected. */
static int naming_read(struct ect_handle *h, struct naming *x)
{
	struct ect_master m = { .struct_size = sizeof(m) };
	int ret = ect_get_master(h, &m);

	*x = (struct naming){ 0 };
	ret = ret ? ret : ect_slaves_read(h, &x->slaves);
	if (ret)
		return ret;
	x->slots = calloc(m.config_count + ect_list_count(x->slaves) + 1, sizeof(*x->slots));
	x->names = calloc(m.config_count + ect_list_count(x->slaves) + 1, sizeof(*x->names));
	if (!x->slots || !x->names)
		return ect_no_memory(h);
	ret = add_configs(h, x, m.config_count);
	if (ret)
		return ret;
	add_others(x);
	qsort(x->slots, x->n, sizeof(*x->slots), by_place);
	for (size_t i = 0; i < x->n; i++) {
		const struct ect_slave *s = slave_of(x, &x->slots[i]);

		x->slots[i].slave = s;
		if (s)
			x->names[i] = (struct ecb_slave_name){
				.order = s->order, .text = s->name, .group = s->group,
			};
	}
	return ecb_name_slaves(x->names, x->n) ? ect_no_memory(h) : 0;
}

int ect_names_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *l = ect_list_new(sizeof(struct ect_name));
	struct naming x = { 0 };
	int ret = l ? naming_read(h, &x) : ect_no_memory(h);

	for (size_t i = 0; i < x.n && !ret; i++) {
		const struct slot *t = &x.slots[i];
		struct ect_name *to;

		if (!t->device || !t->slave || t->slave->device != t->device)
			continue;
		to = ect_list_add(l);
		if (!to) {
			ret = ect_no_memory(h);
			break;
		}
		to->position = t->slave->position;
		to->device = t->device;
		snprintf(to->name, sizeof(to->name), "%s", x.names[i].name);
	}
	naming_free(&x);
	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}

/* Entries of a SyncManager of the configuration: keeps at most @room; without room only counts. */
static int sm_entries(struct ect_handle *h, struct slot *t, unsigned int sm, size_t room)
{
	struct ect_config_sm x = { .struct_size = sizeof(x) };
	int ret = ect_config_sm(h, t->config, sm, &x);
	u32 bit = 0;

	for (unsigned int i = 0; i < x.pdo_count && !ret; i++) {
		struct ect_pdo p = { .struct_size = sizeof(p) };

		ret = ect_config_pdo(h, t->config, sm, i, &p);
		for (unsigned int k = 0; k < p.entry_count && !ret; k++) {
			struct ect_pdo_entry e = { .struct_size = sizeof(e) };

			/* more than were counted: another session has begun */
			if (room && t->n == room)
				return -EAGAIN;
			if (room)
				ret = ect_config_entry(h, t->config, sm, i, k, &e);
			if (room && !ret)
				t->entries[t->n] = (struct entry){
					.sm = (u8)sm, .bit = bit, .bits = e.bits, .index = e.index,
					.subindex = e.subindex, .pdo_index = p.index,
				};
			bit += e.bits;
			t->n++;
		}
	}
	return ret;
}

static int read_entries(struct ect_handle *h, struct slot *t)
{
	size_t n;
	int ret = 0;

	for (unsigned int sm = 0; sm < 16 && !ret; sm++)
		ret = sm_entries(h, t, sm, 0);
	n = t->n;
	t->n = 0;
	t->entries = calloc(n + 1, sizeof(*t->entries));
	t->names = calloc(n + 1, sizeof(*t->names));
	if (!t->entries || !t->names)
		return ect_no_memory(h);
	/* PDOs of an active session do not change; another one may have begun */
	for (unsigned int sm = 0; sm < 16 && !ret && n; sm++)
		ret = sm_entries(h, t, sm, n);
	if (ret == -EAGAIN || (!ret && t->n != n))
		return ect_fail(h, -EAGAIN, "another session has begun meanwhile; repeat the command");
	return ret;
}

/* What the slave calls its entries, as struct text */
static int read_texts(struct ect_handle *h, const struct ect_slave *s, struct ect_list *texts)
{
	int ret = 0;

	for (unsigned int sm = 0; sm < s->sm_count && !ret; sm++) {
		struct ect_sm x = { .struct_size = sizeof(x) };

		ret = ect_sm_read(h, s->device, sm, &x);
		for (unsigned int i = 0; i < x.pdo_count && !ret; i++) {
			struct ect_pdo p = { .struct_size = sizeof(p) };

			ret = ect_pdo_read(h, s->device, sm, i, &p);
			for (unsigned int k = 0; k < p.entry_count && !ret; k++) {
				struct ect_pdo_entry e = { .struct_size = sizeof(e) };
				struct text *t;

				ret = ect_pdo_entry_read(h, s->device, sm, i, k, &e);
				t = ret ? NULL : ect_list_add(texts);
				if (!t)
					return ret ? ret : ect_no_memory(h);
				*t = (struct text){
					.pdo_index = p.index, .index = e.index,
					.subindex = e.subindex,
				};
				memcpy(t->pdo, p.name, sizeof(t->pdo));
				memcpy(t->name, e.name, sizeof(t->name));
			}
		}
	}
	return ret;
}

typedef int (*image_fn)(void *ctx, const struct slot *t, const struct ec_sii_pdo *pdo,
			const struct ec_sii_pdo_entry *e);

/* Entries of all PDOs that the EEPROM has, until @fn does not return 0 */
static int image_entries(const struct slot *t, image_fn fn, void *ctx)
{
	static const u16 categories[] = { EC_SII_CAT_TXPDO, EC_SII_CAT_RXPDO };

	for (unsigned int c = 0; c < 2; c++) {
		struct ec_sii_pdo_iter it;
		struct ec_sii_pdo pdo;

		ec_sii_pdo_iter_init(&it, t->image, t->size, categories[c]);
		while (ec_sii_pdo_iter_next(&it, &pdo) > 0)
			for (unsigned int i = 0; i < pdo.entries; i++) {
				struct ec_sii_pdo_entry e;
				int ret = ec_sii_pdo_entry(&pdo, i, &e) ? 0 : fn(ctx, t, &pdo, &e);

				if (ret)
					return ret;
			}
	}
	return 0;
}

static int add_text(void *ctx, const struct slot *t, const struct ec_sii_pdo *pdo,
		    const struct ec_sii_pdo_entry *e)
{
	struct text *x = e->index ? ect_list_add(ctx) : NULL;

	if (!x)
		return e->index ? -ENOMEM : 0;
	*x = (struct text){ .pdo_index = pdo->index, .index = e->index, .subindex = e->sub };
	ec_sii_string(t->image, t->size, pdo->name, x->pdo, sizeof(x->pdo));
	ec_sii_string(t->image, t->size, e->name, x->name, sizeof(x->name));
	string_clean(x->pdo, sizeof(x->pdo));
	string_clean(x->name, sizeof(x->name));
	return 0;
}

/* PDOs that the EEPROM has and does not assign; those that it assigns come first */
static int image_texts(struct ect_handle *h, const struct slot *t, struct ect_list *texts)
{
	return image_entries(t, add_text, texts) ? ect_no_memory(h) : 0;
}

static int name_entries(struct ect_handle *h, struct slot *t, const struct ect_list *texts)
{
	for (size_t i = 0; i < t->n; i++) {
		const struct entry *e = &t->entries[i];
		const struct text *x;

		t->names[i] = (struct ecb_entry_name){
			.pdo_index = e->pdo_index, .index = e->index, .subindex = e->subindex,
		};
		for (size_t k = 0; (x = ect_list_get(texts, k)); k++) {
			if (x->index != e->index || x->subindex != e->subindex || !e->index)
				continue;
			t->names[i].text = x->name;
			t->names[i].pdo = x->pdo;
			if (x->pdo_index == e->pdo_index)
				break;
		}
	}
	return ecb_name_entries(t->names, t->n) ? ect_no_memory(h) : 0;
}

/* Without it there are no types. */
static int read_image(struct ect_handle *h, struct slot *t)
{
	long got;

	t->image = calloc(1, 2u * t->slave->sii_words + 1);
	if (!t->image)
		return ect_no_memory(h);
	got = t->slave->sii_words ? ect_sii_read(h, t->slave->device, 0, t->image,
						 2u * t->slave->sii_words) : 0;
	t->size = got > 0 ? (size_t)got : 0;
	return 0;
}

static int find_type(void *ctx, const struct slot *t, const struct ec_sii_pdo *pdo,
		     const struct ec_sii_pdo_entry *x)
{
	const struct entry *e = ctx;

	(void)t;
	(void)pdo;
	return x->index == e->index && x->sub == e->subindex && x->bits == e->bits ? x->type : 0;
}

/* The type of an entry, 0: the EEPROM has none */
static u16 type_of(const struct slot *t, struct entry *e)
{
	return (u16)image_entries(t, find_type, e);
}

static int add_values(struct ect_handle *h, const struct slot *t, const char *slave,
		      const struct ect_fmmu *f, unsigned int domain, struct ect_list *l)
{
	bool attached = t->device && t->slave && t->slave->device == t->device;

	for (size_t i = 0; i < t->n; i++) {
		struct entry *e = &t->entries[i];
		struct ect_value *v;

		if (e->sm != f->sm || !e->index || !e->bits)
			continue;
		v = ect_list_add(l);
		if (!v)
			return ect_no_memory(h);
		v->config = t->config;
		v->device = attached ? t->device : 0;
		v->position = attached ? t->slave->position : -1;
		v->domain = domain;
		v->bit = 8 * f->offset + e->bit;
		v->bits = e->bits;
		v->index = e->index;
		v->subindex = e->subindex;
		v->dir = f->dir;
		v->type = t->size ? type_of(t, e) : 0;
		ecb_name_value(v->name, slave, t->names[i].name);
	}
	return 0;
}

static int read_fmmus(struct ect_handle *h, const struct naming *x, struct ect_list *l,
		      unsigned int domains)
{
	for (unsigned int d = 0; d < domains; d++) {
		struct ect_domain dom = { .struct_size = sizeof(dom) };
		int ret = ect_domain_read(h, d, &dom);

		for (unsigned int i = 0; i < dom.fmmu_count && !ret; i++) {
			struct ect_fmmu f = { .struct_size = sizeof(f) };

			ret = ect_domain_fmmu(h, d, i, &f);
			for (size_t k = 0; k < x->n && !ret; k++)
				if (f.config && x->slots[k].config == f.config - 1)
					ret = add_values(h, &x->slots[k], x->names[k].name, &f, d,
							 l);
		}
		if (ret)
			return ret;
	}
	return 0;
}

static int describe(struct ect_handle *h, struct naming *x)
{
	int ret = 0;

	for (size_t i = 0; i < x->n && !ret; i++) {
		struct slot *t = &x->slots[i];
		struct ect_list *texts;

		if (t->config == ECT_NONE32)
			continue;
		texts = ect_list_new(sizeof(struct text));
		ret = texts ? read_entries(h, t) : ect_no_memory(h);
		if (!ret && t->slave)
			ret = read_texts(h, t->slave, texts);
		if (!ret && t->slave)
			ret = read_image(h, t);
		if (!ret && t->size)
			ret = image_texts(h, t, texts);
		ret = ret ? ret : name_entries(h, t, texts);
		ect_list_free(texts);
	}
	return ret;
}

int ect_values_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *l = ect_list_new(sizeof(struct ect_value));
	struct ect_master m = { .struct_size = sizeof(m) };
	struct naming x = { 0 };
	int ret = l ? ect_get_master(h, &m) : ect_no_memory(h);

	if (!ret && !m.active)
		ret = ect_fail(h, -ENOENT,
			       "no application and no 'ethercat run' exchanges process data");
	ret = ret ? ret : naming_read(h, &x);
	ret = ret ? ret : describe(h, &x);
	ret = ret ? ret : read_fmmus(h, &x, l, m.domain_count);
	naming_free(&x);
	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}
