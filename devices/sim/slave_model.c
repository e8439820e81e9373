// SPDX-License-Identifier: GPL-2.0-only
/* From a device table to a model: object dictionary and process data. */
#include "app_int.h"

struct ec_app_block {
	struct ec_app_block *next;
	u64 align;
};

/**
 * ec_app_model_alloc() - memory that lives as long as a model
 * @model: model
 * @bytes: how much
 *
 * Context: Process. May sleep.
 * Return: zeroed memory, or NULL.
 */
void *ec_app_model_alloc(struct ec_app_model *model, size_t bytes)
{
	struct ec_app_block *b = ec_sim_alloc(model->sim, sizeof(*b) + bytes);

	if (!b)
		return NULL;
	b->next = model->blocks;
	model->blocks = b;
	return b + 1;
}

/**
 * ec_app_model_put() - drop a reference
 * @model: model, NULL is allowed
 *
 * Context: Process. May sleep.
 */
void ec_app_model_put(struct ec_app_model *model)
{
	struct ec_app_block *b, *next;
	struct ec_sim *sim;

	if (!model || --model->refs)
		return;
	sim = model->sim;
	for (b = model->blocks; b; b = next) {
		next = b->next;
		ec_sim_release(sim, b);
	}
	ec_sim_release(sim, model);
}

/* an entry under construction */
struct item {
	struct ec_app_entry e;
	u32 value;
	const char *text;	/* value of a string */
	const char *object;
};

struct list {
	struct item *item;
	u32 n;
	u32 cap;
};

static void add_text(struct list *l, u16 index, const char *name,
		     const char *text)
{
	if (l->n == l->cap)
		return;
	l->item[l->n++] = (struct item){
		.e = {
			.index = index,
			.type = EC_TYPE_STRING,
			.bits = (u16)(8 * strlen(text)),
			.access = EC_OD_READ,
			.name = name,
		},
		.text = text,
		.object = name,
	};
}

static void add(struct list *l, u16 index, u8 sub, u16 type, u16 bits,
		u16 access, u32 value, const char *name, const char *object)
{
	if (l->n == l->cap)
		return;
	l->item[l->n++] = (struct item){
		.e = {
			.index = index,
			.sub = sub,
			.type = type,
			.bits = bits,
			.access = access,
			.name = name,
		},
		.value = value,
		.object = object,
	};
}

static void add_diag(struct list *l, u8 messages)
{
	add(l, EC_DIAG_INDEX, EC_DIAG_SUB_MAX, EC_TYPE_UINT8, 8, EC_OD_READ, messages,
	    "Maximum messages", "Diagnosis history");
	add(l, EC_DIAG_INDEX, EC_DIAG_SUB_NEWEST, EC_TYPE_UINT8, 8, EC_OD_READ, 0,
	    "Newest message", NULL);
	add(l, EC_DIAG_INDEX, EC_DIAG_SUB_ACK, EC_TYPE_UINT8, 8, EC_APP_RW, 0,
	    "Newest acknowledged message", NULL);
	add(l, EC_DIAG_INDEX, 4, EC_TYPE_BOOL, 1, EC_OD_READ, 0, "New messages available", NULL);
	add(l, EC_DIAG_INDEX, EC_DIAG_SUB_FLAGS, EC_TYPE_UINT16, 16, EC_APP_RW, 0, "Flags", NULL);
	for (u8 i = 0; i < messages; i++)
		add(l, EC_DIAG_INDEX, EC_DIAG_FIRST_SUB + i, EC_TYPE_OCTET_STRING,
		    8 * EC_APP_DIAG_BYTES, EC_OD_READ, 0, "Diagnosis message", NULL);
}

static void add_modules(struct list *l, const struct ec_app_quirks *q)
{
	add(l, EC_APP_MODULAR, 1, EC_TYPE_UINT16, 16, EC_OD_READ, 0x10, "Index distance",
	    "Modular device profile");
	add(l, EC_APP_MODULAR, 2, EC_TYPE_UINT16, 16, EC_OD_READ, q->n_modules,
	    "Maximum number of modules", NULL);
	for (u8 i = 0; i < q->n_modules; i++) {
		add(l, EC_APP_MODULES_SET, i + 1, EC_TYPE_UINT32, 32,
		    EC_OD_READ | EC_OD_WRITE_PREOP, 0, NULL, "Configured module list");
		add(l, EC_APP_MODULES_FOUND, i + 1, EC_TYPE_UINT32, 32, EC_OD_READ, q->modules[i],
		    NULL, "Detected module list");
	}
}

static void add_standard(struct list *l, const struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;
	static const char sync[] = "SM synchronization";

	add(l, 0x1000, 0, EC_TYPE_UINT32, 32, EC_OD_READ, d->device_type,
	    "Device type", NULL);
	add(l, 0x1001, 0, EC_TYPE_UINT8, 8, EC_OD_READ, 0, "Error register",
	    NULL);
	add_text(l, 0x1008, "Device name", d->name);
	add_text(l, 0x1009, "Hardware version", "sim");
	add_text(l, 0x100A, "Software version", "1.0");
	add(l, 0x1018, 1, EC_TYPE_UINT32, 32, EC_OD_READ, d->vendor,
	    "Vendor ID", "Identity");
	add(l, 0x1018, 2, EC_TYPE_UINT32, 32, EC_OD_READ, d->product,
	    "Product code", NULL);
	add(l, 0x1018, 3, EC_TYPE_UINT32, 32, EC_OD_READ, d->revision,
	    "Revision", NULL);
	add(l, 0x1018, 4, EC_TYPE_UINT32, 32, EC_OD_READ, 0, "Serial number",
	    NULL);
	add(l, 0x10F1, 1, EC_TYPE_UINT32, 32, EC_APP_RW, 1,
	    "Local error reaction", "Error settings");
	add(l, 0x10F1, 2, EC_TYPE_UINT16, 16, EC_APP_RW, 4,
	    "Sync error counter limit", NULL);
	if (m->params.diag)
		add_diag(l, m->params.diag);
	if (m->params.quirks.n_modules)
		add_modules(l, &m->params.quirks);
	for (u8 i = 0; i < d->n_sms; i++)
		add(l, 0x1C00, (u8)(i + 1), EC_TYPE_UINT8, 8, EC_OD_READ,
		    d->sms[i].type, NULL, "SyncManager type");
	for (u16 sm = 0; sm < d->n_sms; sm++) {
		u16 index = 0x1C30 + sm;

		if (ec_app_area(m, EC_APP_OUT, sm) < 0 && ec_app_area(m, EC_APP_IN, sm) < 0)
			continue;
		add(l, index, 1, EC_TYPE_UINT16, 16, EC_APP_RW, 1,
		    "Synchronization type", sync);
		add(l, index, 2, EC_TYPE_UINT32, 32, EC_APP_RW, 1000000,
		    "Cycle time", NULL);
		add(l, index, 3, EC_TYPE_UINT32, 32, EC_APP_RW, 0, "Shift time",
		    NULL);
		add(l, index, 4, EC_TYPE_UINT16, 16, EC_OD_READ,
		    d->n_dc ? 0x0007 : 0x0003, "Synchronization types supported",
		    NULL);
		add(l, index, 5, EC_TYPE_UINT32, 32, EC_OD_READ, 62500,
		    "Minimum cycle time", NULL);
		add(l, index, 6, EC_TYPE_UINT32, 32, EC_OD_READ, 10000,
		    "Calc and copy time", NULL);
		add(l, index, 9, EC_TYPE_UINT32, 32, EC_OD_READ, 0, "Delay time",
		    NULL);
		add(l, index, 0x0B, EC_TYPE_UINT16, 16, EC_OD_READ, 0,
		    "SM event missed counter", NULL);
		add(l, index, 0x0C, EC_TYPE_UINT16, 16, EC_OD_READ, 0,
		    "Cycle time too small counter", NULL);
		add(l, index, 0x20, EC_TYPE_BOOL, 1, EC_OD_READ, 0,
		    "Sync error", NULL);
	}
}

static enum ec_app_dir pdo_dir(const struct ec_app_pdo *p)
{
	return p->index < 0x1800 ? EC_APP_OUT : EC_APP_IN;
}

static u32 pdo_bits(const struct ec_app_pdo *p)
{
	u32 bits = 0;

	for (u32 i = 0; i < p->count; i++)
		bits += p->entries[i].bits;
	return bits;
}

/* entries a mapping object has room for */
static u32 pdo_cap(const struct ec_app_model *m, const struct ec_app_pdo *p)
{
	return m->dev.mapping >= EC_APP_MAP_FULL ?
		max_t(u32, p->count, EC_APP_MAP_CAP) : p->count;
}

static void add_pdo(struct list *l, const struct ec_app_model *m,
		    const struct ec_app_pdo *p)
{
	bool out = pdo_dir(p) == EC_APP_OUT;
	u16 access = EC_OD_READ;
	u32 cap = pdo_cap(m, p);

	if (m->dev.mapping >= EC_APP_MAP_FULL &&
	    !ec_app_listed(&m->params.quirks.fixed, p->index))
		access |= EC_OD_WRITE_PREOP;
	add(l, p->index, 0, EC_TYPE_UINT8, 8, access, p->count, NULL, p->name);
	for (u32 i = 0; i < cap; i++) {
		const struct ec_app_pdo_entry *e = &p->entries[i];
		u32 v = i < p->count ? (u32)e->index << 16 |
				       (u32)e->sub << 8 | e->bits : 0;

		add(l, p->index, (u8)(i + 1), EC_TYPE_UINT32, 32, access, v,
		    NULL, NULL);
		if (v >> 16)
			add(l, e->index, e->sub, e->type, e->bits,
			    out ? EC_APP_RW | EC_OD_RXPDO :
				  EC_OD_READ | EC_OD_TXPDO,
			    0, e->name, e->object);
	}
}

/* of the @k-th SyncManager; only the first has the @list of the description */
static void add_assign(struct list *l, const struct ec_app_model *m,
		       enum ec_app_dir dir, int k)
{
	static const struct ec_app_list none;
	const struct ec_app_list *list = k ? &none : &m->params.quirks.assign[dir];
	u16 index = (u16)(0x1C10 + m->area[dir][k]), access = EC_OD_READ;
	u8 n = 0, cap = 0;

	if (m->dev.mapping >= EC_APP_MAP_ASSIGN &&
	    !ec_app_listed(&m->params.quirks.fixed, index))
		access |= EC_OD_WRITE_PREOP;
	for (u32 i = 0; i < m->dev.n_pdos; i++) {
		const struct ec_app_pdo *p = &m->dev.pdos[i];

		if (pdo_dir(p) != dir)
			continue;
		cap++;
		if (!list->given && p->sm == m->area[dir][k])
			add(l, index, ++n, EC_TYPE_UINT16, 16, access, p->index,
			    NULL, NULL);
	}
	for (; n < list->n; n++)
		add(l, index, (u8)(n + 1), EC_TYPE_UINT16, 16, access, list->v[n], NULL, NULL);
	add(l, index, 0, EC_TYPE_UINT8, 8, access, n, NULL,
	    dir == EC_APP_OUT ? "RxPDO assign" : "TxPDO assign");
	while (n < cap)
		add(l, index, ++n, EC_TYPE_UINT16, 16, access, 0, NULL, NULL);
}

/* by index and subindex; equal ones stay in the order they were added */
static bool before(const struct item *a, const struct item *b)
{
	return a->e.index != b->e.index ? a->e.index < b->e.index :
					  a->e.sub < b->e.sub;
}

/* merge sort, bottom up, between @a and @tmp; the result is in @a */
static void sort(struct item *a, struct item *tmp, u32 n)
{
	for (u32 w = 1; w < n; w *= 2) {
		for (u32 lo = 0; lo < n; lo += 2 * w) {
			u32 mid = min(lo + w, n), hi = min(lo + 2 * w, n);
			u32 i = lo, k = mid, o = lo;

			while (i < mid || k < hi)
				tmp[o++] = k == hi ||
					(i < mid && !before(&a[k], &a[i])) ?
					a[i++] : a[k++];
		}
		memcpy(a, tmp, n * sizeof(*a));
	}
}

static void drop_doubles(struct list *l)
{
	u32 n = 0;

	for (u32 i = 0; i < l->n; i++) {
		struct item *it = &l->item[i];

		if (n && !before(&l->item[n - 1], it)) {
			l->item[n - 1].e.access |= it->e.access &
						   (EC_OD_RXPDO | EC_OD_TXPDO);
			continue;
		}
		l->item[n++] = *it;
	}
	l->n = n;
}

static void add_counts(struct list *l)
{
	u32 n = l->n;

	for (u32 i = 0; i < n; i++) {
		const struct ec_app_entry *e = &l->item[i].e;
		u32 last = i;

		while (last + 1 < n && l->item[last + 1].e.index == e->index)
			last++;
		if (e->sub)
			add(l, e->index, 0, EC_TYPE_UINT8, 8, EC_OD_READ,
			    l->item[last].e.sub, NULL, NULL);
		i = last;
	}
}

static void object_init(struct ec_app_object *o, const struct item *it,
			u16 count)
{
	o->index = it->e.index;
	o->count = count;
	o->max_sub = it[count - 1].e.sub;
	o->name = "Object";
	for (u32 i = count; i--; )
		if (it[i].object)
			o->name = it[i].object;
	if (count == 1 && !it->e.sub && !ec_app_pdo_is_config(o->index)) {
		o->code = EC_OD_VAR;
		o->type = it->e.type;
		if (it->e.name)
			o->name = it->e.name;
	} else if (o->index >= 0x1C00 && o->index < 0x1C30) {
		o->code = EC_OD_ARRAY;
		o->type = o->index == 0x1C00 ? EC_TYPE_UINT8 : EC_TYPE_UINT16;
	} else {
		o->code = EC_OD_RECORD;
		o->type = o->index == 0x1018 ? 0x0023 :
			  o->index >= 0x1C30 && o->index < 0x1C40 ? 0x0029 :
			  o->index >= 0x1600 && o->index < 0x1C00 ? 0x0021 : 0;
	}
}

/* sorted items become entries, objects and default data */
static int take(struct ec_app_model *m, const struct list *l)
{
	u32 off = 0, objects = 0;

	for (u32 i = 0; i < l->n; i++) {
		off += (l->item[i].e.bits + 7u) / 8;
		if (!i || l->item[i].e.index != l->item[i - 1].e.index)
			objects++;
	}
	m->entries = ec_app_model_alloc(m, l->n * sizeof(*m->entries));
	m->objects = ec_app_model_alloc(m, objects * sizeof(*m->objects));
	m->defaults = ec_app_model_alloc(m, off + 8);
	if (!m->entries || !m->objects || !m->defaults)
		return -ENOMEM;
	m->data_len = off;

	off = 0;
	for (u32 i = 0, n; i < l->n; i += n) {
		struct ec_app_object *o = &m->objects[m->n_objects++];

		for (n = 1; i + n < l->n &&
		     l->item[i + n].e.index == l->item[i].e.index; n++)
			;
		o->first = i;
		object_init(o, &l->item[i], (u16)n);
	}
	for (u32 i = 0; i < l->n; i++) {
		const struct item *it = &l->item[i];
		u32 bytes = (it->e.bits + 7u) / 8;

		m->entries[i] = it->e;
		m->entries[i].off = off;
		if (it->text)
			memcpy(m->defaults + off, it->text, bytes);
		for (u32 k = 0; !it->text && k < bytes && k < 4; k++)
			m->defaults[off + k] = (u8)(it->value >> (8 * k));
		off += bytes;
	}
	m->n_entries = l->n;
	return 0;
}

static int build_od(struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;
	struct list l = { .cap = 72u + 4u * EC_APP_LIST + 2u * d->n_vars + d->n_pdos +
			    (m->params.diag ? (u32)EC_DIAG_FIRST_SUB + m->params.diag : 0u) };
	u32 areas = (u32)m->n_areas[EC_APP_OUT] + m->n_areas[EC_APP_IN];
	int ret = -ENOMEM;
	struct item *tmp;

	if (areas > EC_APP_DIRS)
		l.cap += (areas - EC_APP_DIRS) * (16u + d->n_pdos);
	for (u32 i = 0; i < d->n_pdos; i++)
		l.cap += 2 + pdo_cap(m, &d->pdos[i]) + 2u * d->pdos[i].count;
	l.item = ec_sim_alloc(m->sim, l.cap * sizeof(*l.item));
	tmp = ec_sim_alloc(m->sim, l.cap * sizeof(*tmp));
	if (!l.item || !tmp)
		goto out;

	if (d->protocols & EC_SII_PROTO_COE)
		add_standard(&l, m);
	for (u32 i = 0; i < d->n_vars; i++) {
		const struct ec_app_var *v = &d->vars[i];

		add(&l, v->index, v->sub, v->type, v->bits, v->access, v->value,
		    v->name, v->object);
	}
	for (u32 i = 0; i < d->n_pdos; i++)
		add_pdo(&l, m, &d->pdos[i]);
	for (int dir = 0; dir < EC_APP_DIRS; dir++)
		for (int k = 0; k < m->n_areas[dir]; k++)
			add_assign(&l, m, dir, k);
	sort(l.item, tmp, l.n);
	drop_doubles(&l);
	add_counts(&l);
	sort(l.item, tmp, l.n);
	ret = l.n < l.cap ? take(m, &l) : -ENOSPC;
out:
	ec_sim_release(m->sim, tmp);
	ec_sim_release(m->sim, l.item);
	return ret;
}

static int find_channels(struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;

	for (int pass = 0; pass < 2; pass++) {
		for (u32 i = 0; i < d->n_pdos; i++) {
			const struct ec_app_pdo *p = &d->pdos[i];
			enum ec_app_dir dir = pdo_dir(p);

			for (u32 k = 0; k < p->count; k++) {
				const struct ec_app_pdo_entry *e = &p->entries[k];

				if (!e->chan)
					continue;
				if (!pass)
					m->n_chan[dir] = max_t(u16, e->chan,
							       m->n_chan[dir]);
				else
					m->chan[dir][e->chan - 1] =
						ec_app_od_entry(m, e->index,
								e->sub);
			}
		}
		for (int dir = 0; !pass && dir < EC_APP_DIRS; dir++) {
			m->chan[dir] = ec_app_model_alloc(m,
				(m->n_chan[dir] + 1u) * sizeof(*m->chan[dir]));
			if (!m->chan[dir])
				return -ENOMEM;
		}
	}
	return 0;
}

/* Everything that follows from @m->dev. */
static int finish(struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;
	u32 bits[EC_APP_DIRS] = { 0, 0 };
	int ret;

	m->emulation = d->pdi_control & 0x0100;
	for (u8 i = 0; i < d->n_sms; i++) {
		if (d->sms[i].type == EC_SII_SM_OUTPUTS)
			m->area[EC_APP_OUT][m->n_areas[EC_APP_OUT]++] = i;
		if (d->sms[i].type == EC_SII_SM_INPUTS)
			m->area[EC_APP_IN][m->n_areas[EC_APP_IN]++] = i;
	}
	for (u32 i = 0; i < d->n_pdos; i++) {
		enum ec_app_dir dir = pdo_dir(&d->pdos[i]);

		m->map_cap[dir] += pdo_cap(m, &d->pdos[i]);
		bits[dir] += pdo_bits(&d->pdos[i]);
	}
	for (int dir = 0; dir < EC_APP_DIRS && d->profile; dir++)
		m->map_cap[dir] += d->profile->map_cap;
	for (int dir = 0; dir < EC_APP_DIRS; dir++)
		m->max_bytes[dir] = d->max_bytes[dir] ? d->max_bytes[dir] :
					(u16)((bits[dir] + 7) / 8);
	ret = build_od(m);
	if (!ret)
		ret = find_channels(m);
	if (!ret && !m->eeprom)
		ret = ec_app_model_eeprom(m);
	if (!ret)
		ec_app_model_hide(m);
	return ret;
}

/*
 * Masters take slaves of one identity for equal (SOEM copies what it read of the
 * first one), so each layout is a revision of its own: bits or bytes of outputs
 * and inputs, and a mark of everything else that shows in the EEPROM.
 */
static u32 generic_revision(const struct ec_app_model *m)
{
	const struct ec_app_params *p = &m->params;
	u64 other = p->voe | (u64)p->soe << 16 | (u64)p->cpu << 24 |
		    (u64)!!p->id << 25 | (u64)!!p->foe << 30 |
		    (u64)!!p->diag << 31 | (u64)p->quirks.no_mbox_words << 48 |
		    (u64)p->quirks.no_protocols << 49 |
		    (u64)p->eoe << 58 | (u64)p->quirks.sms[EC_APP_OUT] << 50 |
		    (u64)p->quirks.sms[EC_APP_IN] << 54;

	for (u32 i = 0; i < p->quirks.dc_modes.n; i++)
		other = (other << 7 | other >> 57) ^ (p->quirks.dc_modes.v[i] + 1u);

	for (u32 i = 0; i < p->quirks.n_modules; i++)
		other = (other << 5 | other >> 59) ^ (p->quirks.modules[i] + 1u);

	if (m->dev.mapping != m->table->mapping)
		other |= (u64)m->dev.mapping << 26;
	if (m->dev.std.rx_len && m->dev.std.rx_len != EC_APP_GENERIC_MBOX)
		other |= (u64)m->dev.std.rx_len << 32;
	other *= 0x9e3779b97f4a7c15ULL;
	return (p->out << 16 | p->in) ^ (u32)(other >> 32);
}

/**
 * ec_app_model_new() - build a model from a device table
 * @sim: segment whose memory it takes
 * @dev: table
 * @params: what it differs in
 * @err: -ENOMEM without memory, -ERANGE: sizes too large, -ENOSPC: too much
 *       for its EEPROM
 *
 * Context: Process. May sleep.
 * Return: the model with one reference, or NULL.
 */
struct ec_app_model *ec_app_model_new(struct ec_sim *sim,
				      const struct ec_app_dev *dev,
				      const struct ec_app_params *params,
				      int *err)
{
	struct ec_app_model *m = ec_sim_alloc(sim, sizeof(*m));

	*err = -ENOMEM;
	if (!m)
		return NULL;
	m->sim = sim;
	m->refs = 1;
	m->dev = *dev;
	m->table = dev;
	m->params = *params;
	if (params->vendor)
		m->dev.vendor = params->vendor;
	if (params->product)
		m->dev.product = params->product;
	if (params->revision)
		m->dev.revision = params->revision;
	if (params->mapping != EC_APP_MAP_DEFAULT)
		m->dev.mapping = params->mapping;
	if (params->id)
		m->dev.flags |= EC_SII_FLAG_ID_AL;
	if (params->no_repeat)
		m->dev.flags &= ~EC_SII_FLAG_MBOX_DLL;
	if (dev->profile && dev->profile->map && !params->soe)
		m->params.soe = 2;	/* axes */
	if (m->params.soe)
		m->dev.protocols |= EC_SII_PROTO_SOE;
	if (params->voe)
		m->dev.protocols |= EC_SII_PROTO_VOE;
	if (params->foe)
		m->dev.protocols |= EC_SII_PROTO_FOE;
	if (params->eoe)
		m->dev.protocols |= EC_SII_PROTO_EOE;
	*err = ec_app_dev_is_generic(dev) ? ec_app_dev_generic(m) : 0;
	if (ec_app_dev_is_generic(dev) && !params->revision)
		m->dev.revision = generic_revision(m);
	if (!*err && m->dev.protocols & EC_SII_PROTO_COE) {
		m->dev.coe &= (u8)~(EC_SII_COE_PDO_ASSIGN |
				    EC_SII_COE_PDO_CONFIG);
		if (m->dev.mapping >= EC_APP_MAP_ASSIGN)
			m->dev.coe |= EC_SII_COE_PDO_ASSIGN;
		if (m->dev.mapping >= EC_APP_MAP_FULL)
			m->dev.coe |= EC_SII_COE_PDO_CONFIG;
	}
	if (!*err)
		*err = ec_app_model_modes(m);
	if (!*err)
		*err = finish(m);
	if (!*err)
		return m;
	ec_app_model_put(m);
	return NULL;
}

/**
 * ec_app_model_file() - build a model from an EEPROM image
 * @sim: segment whose memory it takes
 * @eeprom: image
 * @len: bytes in it
 * @params: of these only @mapping and @id count, and @soe, @voe, @foe and @eoe
 *          where the image has the protocol
 * @err: -ENOMEM without memory, -EINVAL: not an image
 *
 * The dictionary is made from the PDOs of the image.
 *
 * Context: Process. May sleep.
 * Return: the model with one reference, or NULL.
 */
struct ec_app_model *ec_app_model_file(struct ec_sim *sim, const u8 *eeprom,
				       size_t len,
				       const struct ec_app_params *params,
				       int *err)
{
	struct ec_app_model *m = ec_sim_alloc(sim, sizeof(*m));

	*err = -ENOMEM;
	if (!m)
		return NULL;
	m->sim = sim;
	m->refs = 1;
	m->params = *params;
	*err = ec_app_model_parse(m, eeprom, len);
	if (!*err)
		*err = ec_app_model_modes(m);
	if (!*err)
		*err = finish(m);
	if (!*err)
		return m;
	ec_app_model_put(m);
	return NULL;
}
