// SPDX-License-Identifier: GPL-2.0-only
/* EEPROM images from device tables, and device tables from EEPROM images. */
#include "app_int.h"

#define IMAGE_CAP	32768u
#define MBOX_MIN	16u
#define MBOX_MAX	1486u
#define IMAGE_STEP	2048u	/* EEPROMs come in these sizes */

/* strings of an image, each of them once */
struct names {
	const char *s[255];
	u8 index[255];
	u32 n;
};

static u8 name_find(const struct names *n, const char *s)
{
	for (u32 i = 0; s && i < n->n; i++)
		if (!strcmp(n->s[i], s))
			return n->index[i];
	return 0;
}

static void name_add(struct names *n, struct ec_sii_builder *b, const char *s)
{
	if (!s || !*s || name_find(n, s) || n->n >= 254)
		return;
	n->s[n->n] = s;
	n->index[n->n++] = ec_sii_build_string(b, s);
}

static struct ec_sii_mbox mbox_of(const struct ec_app_mbox_area *a)
{
	return (struct ec_sii_mbox){
		.rx_offset = a->rx,
		.rx_size = a->rx_len,
		.tx_offset = a->tx,
		.tx_size = a->tx_len,
	};
}

static void build_general(struct ec_sii_builder *b, const struct names *n,
			  const struct ec_app_dev *d)
{
	struct ec_sii_general g = {
		.group = name_find(n, d->group),
		.order = name_find(n, d->name),
		.name = name_find(n, d->title),
		.group_name = name_find(n, d->group),
		.coe = d->coe,
		.foe = !!(d->protocols & EC_SII_PROTO_FOE),
		.eoe = !!(d->protocols & EC_SII_PROTO_EOE),
		.flags = d->flags,
		.current_ma = d->current_ma,
	};

	for (int p = 0; p < EC_MAX_PORT; p++) {
		u16 type = d->ports[p] == EC_PORT_TYPE_MII ? 1 :
			   d->ports[p] == EC_PORT_TYPE_EBUS ? 3 : 0;

		g.ports |= (u16)(type << (4 * p));
	}
	ec_sii_build_general(b, &g);
}

static void build_pdos(struct ec_sii_builder *b, const struct names *n,
		       const struct ec_app_dev *d, u16 cat,
		       struct ec_sii_pdo_entry *entries)
{
	for (u32 i = 0; i < d->n_pdos; i++) {
		const struct ec_app_pdo *p = &d->pdos[i];
		struct ec_sii_pdo pdo = {
			.index = p->index,
			.entries = (u8)p->count,
			.sm = p->sm,
			.name = name_find(n, p->name),
		};

		if ((p->index >= 0x1A00) != (cat == EC_SII_CAT_TXPDO))
			continue;
		for (u32 k = 0; k < p->count; k++)
			entries[k] = (struct ec_sii_pdo_entry){
				.index = p->entries[k].index,
				.sub = p->entries[k].sub,
				.name = name_find(n, p->entries[k].name),
				.type = (u8)p->entries[k].type,
				.bits = p->entries[k].bits,
			};
		ec_sii_build_pdo(b, cat, &pdo, entries);
	}
}

static void build_names(struct ec_sii_builder *b, struct names *n,
			const struct ec_app_dev *d)
{
	name_add(n, b, d->name);
	name_add(n, b, d->group);
	name_add(n, b, d->title);
	for (u32 i = 0; i < d->n_pdos; i++) {
		name_add(n, b, d->pdos[i].name);
		for (u32 k = 0; k < d->pdos[i].count; k++)
			name_add(n, b, d->pdos[i].entries[k].name);
	}
	for (u32 i = 0; i < d->n_dc; i++)
		name_add(n, b, d->dc[i].name);
}

static void build_sms(struct ec_sii_builder *b, const struct ec_app_dev *d)
{
	struct ec_sii_sm sm[EC_APP_SMS];

	for (u32 i = 0; i < d->n_sms; i++)
		sm[i] = (struct ec_sii_sm){
			.start = d->sms[i].start,
			.len = d->sms[i].len,
			.control = d->sms[i].control,
			.enable = d->sms[i].enable,
			.type = d->sms[i].type,
		};
	if (d->n_sms)
		ec_sii_build_sms(b, sm, d->n_sms);
}

static void build_dcs(struct ec_sii_builder *b, const struct names *n,
		      const struct ec_app_dev *d)
{
	struct ec_sii_dc dc[EC_APP_LIST];

	for (u32 i = 0; i < d->n_dc && i < ARRAY_SIZE(dc); i++)
		dc[i] = (struct ec_sii_dc){
			.assign = d->dc[i].assign_activate,
			.factor0 = d->dc[i].assign_activate ? 1 : 0,
			.name = name_find(n, d->dc[i].name),
		};
	if (d->n_dc)
		ec_sii_build_dcs(b, dc, min_t(u32, d->n_dc, ARRAY_SIZE(dc)));
}

struct work {
	struct names names;
	struct ec_sii_pdo_entry entries[256];
	u8 image[IMAGE_CAP];
};

/**
 * ec_app_model_eeprom() - write the EEPROM image of a model
 * @m: model with its table complete
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM, or -ENOSPC when it does not fit.
 */
int ec_app_model_eeprom(struct ec_app_model *m)
{
	const struct ec_app_dev *d = &m->dev;
	struct work *w = ec_sim_alloc(m->sim, sizeof(*w));
	struct ec_sii_info info = {
		.pdi_control = d->pdi_control,
		.pdi_config = d->pdi_config,
		.sync_impulse = d->n_dc ? 100 : 0,
		.vendor = d->vendor,
		.product = d->product,
		.revision = d->revision,
		.boot = mbox_of(&d->boot),
		.std = mbox_of(&d->std),
		.protocols = d->protocols,
	};
	struct ec_sii_builder b;
	size_t len, used;
	int ret;

	if (!w)
		return -ENOMEM;
	ec_sii_build_begin(&b, w->image, sizeof(w->image), &info);
	build_names(&b, &w->names, d);
	build_general(&b, &w->names, d);
	if (d->n_fmmu_use)
		ec_sii_build_fmmus(&b, d->fmmu_use, d->n_fmmu_use);
	build_sms(&b, d);
	build_pdos(&b, &w->names, d, EC_SII_CAT_TXPDO, w->entries);
	build_pdos(&b, &w->names, d, EC_SII_CAT_RXPDO, w->entries);
	build_dcs(&b, &w->names, d);
	ret = ec_sii_build_end(&b);
	if (ret < 0)
		goto out;

	used = (size_t)ret;
	len = (used + IMAGE_STEP - 1) / IMAGE_STEP * IMAGE_STEP;
	ret = -ENOMEM;
	m->eeprom = ec_app_model_alloc(m, len);
	if (!m->eeprom)
		goto out;
	memset(m->eeprom, 0xFF, len);
	memcpy(m->eeprom, w->image, used);
	put_unaligned_le16((u16)(len / 128 - 1),
			   m->eeprom + 2 * EC_SII_W_SIZE);
	m->eeprom_len = len;
	ret = 0;
out:
	ec_sim_release(m->sim, w);
	return ret;
}

/**
 * ec_app_model_modes() - operation modes as the description lists them
 * @m: model
 *
 * Context: Process. May sleep.
 * Return: 0, or -ENOMEM.
 */
int ec_app_model_modes(struct ec_app_model *m)
{
	static const char digits[] = "0123456789ABCDEF";
	const struct ec_app_list *l = &m->params.quirks.dc_modes;
	struct ec_app_dc_mode *mode;
	char (*name)[8];

	if (!l->given)
		return 0;
	mode = ec_app_model_alloc(m, (l->n + 1u) * (sizeof(*mode) + sizeof(*name)));
	if (!mode)
		return -ENOMEM;
	name = (void *)(mode + l->n);
	for (u32 i = 0; i < l->n; i++) {
		memcpy(name[i], "DC ", 3);
		for (int k = 0; k < 4; k++)
			name[i][3 + k] = digits[l->v[i] >> (12 - 4 * k) & 15];
		mode[i].name = name[i];
		mode[i].assign_activate = l->v[i];
	}
	m->dev.dc = mode;
	m->dev.n_dc = l->n;
	return 0;
}

/**
 * ec_app_model_hide() - take out of an EEPROM what it does not say about the mailbox
 * @m: model with its EEPROM
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_model_hide(struct ec_app_model *m)
{
	if (m->params.quirks.no_mbox_words)
		memset(m->eeprom + 2 * EC_SII_W_STD_MBOX, 0, 8);
	if (m->params.quirks.no_protocols)
		memset(m->eeprom + 2 * EC_SII_W_PROTOCOLS, 0, 2);
}

static const char *take_string(struct ec_app_model *m, u8 index)
{
	char buf[256], *s;
	int len;

	if (!index)
		return NULL;
	len = ec_sii_string(m->eeprom, m->eeprom_len, index, buf, sizeof(buf));
	if (len < 0)
		return NULL;
	s = ec_app_model_alloc(m, strlen(buf) + 1);
	if (s)
		memcpy(s, buf, strlen(buf) + 1);
	return s;
}

static int take_pdo(struct ec_app_model *m, struct ec_app_pdo *p,
		    const struct ec_sii_pdo *pdo, u8 *chan)
{
	struct ec_app_pdo_entry *e;

	e = ec_app_model_alloc(m, (pdo->entries + 1u) * sizeof(*e));
	if (!e)
		return -ENOMEM;
	for (u32 i = 0; i < pdo->entries; i++) {
		struct ec_sii_pdo_entry s;

		if (ec_sii_pdo_entry(pdo, i, &s))
			return -EINVAL;
		e[i].index = s.index;
		e[i].sub = s.sub;
		e[i].bits = s.bits;
		e[i].type = s.type;
		e[i].name = take_string(m, s.name);
		if (s.index && *chan < 255)
			e[i].chan = ++*chan;
	}
	p->index = pdo->index;
	p->sm = pdo->sm;
	p->count = pdo->entries;
	p->entries = e;
	p->name = take_string(m, pdo->name);
	return 0;
}

static int take_pdos(struct ec_app_model *m)
{
	static const u16 cats[] = { EC_SII_CAT_RXPDO, EC_SII_CAT_TXPDO };
	struct ec_app_pdo *pdos = NULL;
	u16 n = 0;

	for (int pass = 0; pass < 2; pass++) {
		n = 0;
		for (u32 c = 0; c < ARRAY_SIZE(cats); c++) {
			struct ec_sii_pdo_iter it;
			struct ec_sii_pdo pdo;
			u8 chan = 0;

			ec_sii_pdo_iter_init(&it, m->eeprom, m->eeprom_len,
					     cats[c]);
			while (ec_sii_pdo_iter_next(&it, &pdo) > 0 && n < 512) {
				int ret = pass ? take_pdo(m, &pdos[n], &pdo,
							  &chan) : 0;

				if (ret)
					return ret;
				n++;
			}
		}
		if (pass)
			break;
		pdos = ec_app_model_alloc(m, (n + 1u) * sizeof(*pdos));
		if (!pdos)
			return -ENOMEM;
	}
	m->dev.pdos = pdos;
	m->dev.n_pdos = n;
	return 0;
}

/* old images have 0 as the type of an SM: its control byte decides */
static u8 sm_type(const struct ec_sii_sm *sm)
{
	bool out = (sm->control & EC_SM_DIR_MASK) == EC_SM_DIR_WRITE;

	if (sm->type)
		return sm->type;
	if (!sm->start)
		return EC_SII_SM_UNUSED;
	if ((sm->control & EC_SM_MODE_MASK) == EC_SM_MODE_MAILBOX)
		return out ? EC_SII_SM_MBOX_OUT : EC_SII_SM_MBOX_IN;
	return out ? EC_SII_SM_OUTPUTS : EC_SII_SM_INPUTS;
}

static void take_sms(struct ec_app_dev *d, const u8 *img, size_t len)
{
	struct ec_sii_sm sm[ARRAY_SIZE(d->sms)];
	int n = ec_sii_decode_sms(img, len, sm, ARRAY_SIZE(sm));

	n = min_t(int, n, ARRAY_SIZE(sm));
	for (int i = 0; i < n; i++) {
		d->sms[i].start = sm[i].start;
		d->sms[i].len = sm[i].len;
		d->sms[i].control = sm[i].control;
		d->sms[i].enable = sm[i].enable;
		d->sms[i].type = sm_type(&sm[i]);
		d->n_sms = (u8)(i + 1);
	}
}

/* SM0 and SM1 as the mailbox, where the header of the image has none */
static void take_mbox(struct ec_app_dev *d)
{
	const struct ec_app_sm *out = &d->sms[0], *in = &d->sms[1];

	if (d->std.rx_len || d->std.tx_len || d->n_sms < 2 ||
	    out->type != EC_SII_SM_MBOX_OUT || in->type != EC_SII_SM_MBOX_IN ||
	    out->len < MBOX_MIN || out->len > MBOX_MAX || in->len < MBOX_MIN || in->len > MBOX_MAX)
		return;
	d->std = (struct ec_app_mbox_area){ out->start, out->len, in->start, in->len };
}

/* a mailbox without a word on its protocols: as the general category says */
static void take_protocols(struct ec_app_dev *d, const struct ec_sii_general *g)
{
	if (d->protocols || !d->std.rx_len)
		return;
	d->protocols = (g->coe ? EC_SII_PROTO_COE : 0) | (g->foe ? EC_SII_PROTO_FOE : 0) |
		       (g->eoe ? EC_SII_PROTO_EOE : 0);
}

/* room for the process data ends where the next SM begins */
static void take_max(struct ec_app_dev *d)
{
	for (u32 i = 0; i < d->n_sms; i++) {
		bool out = d->sms[i].type == EC_SII_SM_OUTPUTS;
		u32 room = 0;
		u16 *max;

		if (!out && d->sms[i].type != EC_SII_SM_INPUTS)
			continue;
		for (u32 k = 0; k < d->n_sms; k++) {
			u32 gap = (u32)(d->sms[k].start - d->sms[i].start) / 3;

			if (d->sms[k].start > d->sms[i].start &&
			    (!room || gap < room))
				room = gap;
		}
		room = min_t(u32, room ? room : 512, MBOX_MAX);
		max = &d->max_bytes[out ? EC_APP_OUT : EC_APP_IN];
		*max = max_t(u16, *max, (u16)room);
	}
}

/**
 * ec_app_model_parse() - fill the table of a model from an EEPROM image
 * @m: model
 * @eeprom: image
 * @len: bytes in it
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM, or -EINVAL: not an image.
 */
int ec_app_model_parse(struct ec_app_model *m, const u8 *eeprom, size_t len)
{
	struct ec_app_dev *d = &m->dev;
	struct ec_sii_general g;
	struct ec_sii_info info;
	struct ec_sii_dc dc[4];

	if (ec_sii_decode_info(eeprom, len, &info))
		return -EINVAL;
	m->eeprom_len = (len + 1) & ~(size_t)1;
	m->eeprom = ec_app_model_alloc(m, m->eeprom_len);
	if (!m->eeprom)
		return -ENOMEM;
	memcpy(m->eeprom, eeprom, len);

	memset(&g, 0, sizeof(g));
	if (ec_sii_decode_general(eeprom, len, &g))
		memset(&g, 0, sizeof(g));
	d->vendor = info.vendor;
	d->product = info.product;
	d->revision = info.revision;
	d->pdi_control = info.pdi_control;
	d->pdi_config = info.pdi_config;
	d->protocols = info.protocols;
	d->std = (struct ec_app_mbox_area){
		info.std.rx_offset, info.std.rx_size,
		info.std.tx_offset, info.std.tx_size,
	};
	d->boot = (struct ec_app_mbox_area){
		info.boot.rx_offset, info.boot.rx_size,
		info.boot.tx_offset, info.boot.tx_size,
	};
	/* an EEPROM with wrong contents makes a slave without mailbox */
	if (d->std.rx_len > MBOX_MAX || d->std.tx_len > MBOX_MAX ||
	    d->boot.rx_len > MBOX_MAX || d->boot.tx_len > MBOX_MAX) {
		memset(&d->std, 0, sizeof(d->std));
		memset(&d->boot, 0, sizeof(d->boot));
		d->protocols = 0;
	}
	d->coe = g.coe;
	d->flags = g.flags;
	d->current_ma = g.current_ma;
	d->name = take_string(m, g.order);
	d->title = take_string(m, g.name);
	if (!d->name)
		d->name = "file";
	d->mapping = m->params.mapping != EC_APP_MAP_DEFAULT ?
		m->params.mapping :
		d->coe & EC_SII_COE_PDO_CONFIG ? EC_APP_MAP_FULL :
		d->coe & EC_SII_COE_PDO_ASSIGN ? EC_APP_MAP_ASSIGN :
						 EC_APP_MAP_FIXED;
	for (int p = 0; p < EC_MAX_PORT; p++) {
		u8 type = g.ports >> (4 * p) & 15;

		d->ports[p] = type == 1 || type == 4 ? EC_PORT_TYPE_MII :
			      type == 3 ? EC_PORT_TYPE_EBUS : EC_PORT_TYPE_NONE;
	}
	if (!g.ports) {
		d->ports[0] = EC_PORT_TYPE_MII;
		d->ports[1] = EC_PORT_TYPE_MII;
	}
	d->esc_type = EC_APP_ESC_ET1100;
	d->features = EC_FEAT_DC | EC_FEAT_DC64 | EC_FEAT_DC_ENHANCED;
	d->fmmus = 8;
	d->n_dc = (u8)ec_sii_decode_dcs(eeprom, len, dc, ARRAY_SIZE(dc));
	take_sms(d, eeprom, len);
	take_mbox(d);
	take_protocols(d, &g);
	take_max(d);
	return take_pdos(m);
}
