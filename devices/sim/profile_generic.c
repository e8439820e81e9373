// SPDX-License-Identifier: GPL-2.0-only
/* Generic slaves of any size: "drive" (bytes) and "io" (bits). */
#include "app_int.h"

#define MAX_BYTES	4096u	/* more than a datagram holds */
#define PDO_ENTRIES	64u	/* then the next PDO begins */

static const struct ec_app_pdo_entry drive_out[] = {
	{ 0x6040, 0, 16, EC_TYPE_UINT16, 1, "Controlword", NULL },
	{ 0x607A, 0, 32, EC_TYPE_INT32, 2, "Target position", NULL },
	{ 0x6060, 0, 8, EC_TYPE_INT8, 3, "Modes of operation", NULL },
	{ 0, 0, 8, 0, 0, NULL, NULL },
	{ 0x60FF, 0, 32, EC_TYPE_INT32, 4, "Target velocity", NULL },
	{ 0x6071, 0, 16, EC_TYPE_INT16, 5, "Target torque", NULL },
};

static const struct ec_app_pdo_entry drive_in[] = {
	{ 0x6041, 0, 16, EC_TYPE_UINT16, 1, "Statusword", NULL },
	{ 0x6064, 0, 32, EC_TYPE_INT32, 2, "Position actual value", NULL },
	{ 0x6061, 0, 8, EC_TYPE_INT8, 3, "Modes of operation display", NULL },
	{ 0, 0, 8, 0, 0, NULL, NULL },
	{ 0x606C, 0, 32, EC_TYPE_INT32, 4, "Velocity actual value", NULL },
	{ 0x60F4, 0, 32, EC_TYPE_INT32, 5, "Following error actual value", NULL },
	{ 0x6077, 0, 16, EC_TYPE_INT16, 6, "Torque actual value", NULL },
};

/* one entry of @bits for filler number @n (from 0) */
static void filler(struct ec_app_pdo_entry *e, u16 base, u32 n, u8 bits)
{
	e->index = (u16)(base + n / 255);
	e->sub = (u8)(n % 255 + 1);
	e->bits = bits;
	e->type = bits == 32 ? EC_TYPE_UINT32 : bits == 16 ? EC_TYPE_UINT16 :
		  bits == 8 ? EC_TYPE_UINT8 : EC_TYPE_BOOL;
	e->name = "Data";
	e->object = "Process data";
}

/* SyncManagers of a direction */
static u32 sms_of(const struct ec_app_model *m, enum ec_app_dir dir)
{
	return max_t(u32, m->params.quirks.sms[dir], 1);
}

/*
 * PDOs of one direction: first those of @known that fit, then fillers of
 * @width bits and less. Returns the number of PDOs, or -ENOMEM.
 */
static int make_pdos(struct ec_app_model *m, struct ec_app_pdo *pdos,
		     enum ec_app_dir dir, u32 bits, u8 width,
		     const struct ec_app_pdo_entry *known, u32 n_known)
{
	u16 index = dir == EC_APP_OUT ? 0x1600 : 0x1A00;
	u16 base = dir == EC_APP_OUT ? 0x2100 : 0x2200;
	u32 cap = n_known + bits / width + 8, n = 0, first = 0, fill = 0, per;
	u32 sms = sms_of(m, dir), first_sm = m->dev.n_sms - sms_of(m, EC_APP_IN);
	struct ec_app_pdo_entry *e;
	int n_pdos = 0;
	u8 chan = 0;

	if (dir == EC_APP_OUT)
		first_sm -= sms;
	e = ec_app_model_alloc(m, cap * sizeof(*e));
	if (!e)
		return -ENOMEM;
	for (u32 i = 0; i < n_known; i++) {
		if (known[i].bits > bits)
			continue;
		e[n++] = known[i];
		bits -= known[i].bits;
		if (known[i].chan)
			chan = known[i].chan;
	}
	while (bits) {
		u8 w = width;

		while (w > bits)
			w = w > 8 ? w / 2 : 1;
		filler(&e[n], base, fill++, w);
		if (chan < 255)
			e[n].chan = ++chan;
		bits -= w;
		n++;
	}
	per = min_t(u32, PDO_ENTRIES, DIV_ROUND_UP(n, sms));
	for (u32 i = 0; i < n; i++) {
		if (i + 1 < n && i + 1 - first < per)
			continue;
		pdos[n_pdos] = (struct ec_app_pdo){
			.index = (u16)(index + n_pdos),
			.sm = (u8)(first_sm + first / per * sms / DIV_ROUND_UP(n, per)),
			.count = (u16)(i + 1 - first),
			.entries = &e[first],
			.name = dir == EC_APP_OUT ? "Outputs" : "Inputs",
		};
		n_pdos++;
		first = i + 1;
	}
	return n_pdos;
}

/* SyncManagers: mailboxes, then three buffers of outputs, then inputs; false: no room */
static bool place(struct ec_app_model *m, u16 mbox)
{
	struct ec_app_dev *d = &m->dev;
	u32 at = EC_REG_RAM;
	u8 n = 0;

	if (mbox) {
		d->std = (struct ec_app_mbox_area){
			(u16)at, mbox, (u16)(at + mbox), mbox,
		};
		d->boot = d->std;
		d->sms[n++] = (struct ec_app_sm){
			(u16)at, mbox, 0x26, 1, EC_SII_SM_MBOX_OUT,
		};
		d->sms[n++] = (struct ec_app_sm){
			(u16)(at + mbox), mbox, 0x22, 1, EC_SII_SM_MBOX_IN,
		};
		at += 2u * mbox;
	}
	for (int dir = 0; dir < EC_APP_DIRS; dir++) {
		for (u32 k = 0; k < sms_of(m, dir); k++) {
			d->sms[n++] = (struct ec_app_sm){
				(u16)at, 0, dir == EC_APP_OUT ? 0x64 : 0x20, 0,
				dir == EC_APP_OUT ? EC_SII_SM_OUTPUTS : EC_SII_SM_INPUTS,
			};
			at += 3 * d->max_bytes[dir];
			at = (at + 3) & ~3u;
		}
	}
	d->n_sms = n;
	return at <= 0x10000;
}

/* lengths of the SyncManagers, as the PDOs at power-on give them */
static void set_lengths(struct ec_app_dev *d)
{
	for (u32 n = 0; n < d->n_sms; n++) {
		u32 bits = 0;

		if (d->sms[n].type != EC_SII_SM_OUTPUTS && d->sms[n].type != EC_SII_SM_INPUTS)
			continue;
		for (u32 i = 0; i < d->n_pdos; i++)
			for (u32 k = 0; d->pdos[i].sm == n && k < d->pdos[i].count; k++)
				bits += d->pdos[i].entries[k].bits;
		d->sms[n].len = (u16)((bits + 7) / 8);
		d->sms[n].enable = !!bits;
	}
}

/**
 * ec_app_dev_generic() - lay out a "drive" or an "io" as its parameters say
 * @m: model with the table of the catalogue and the parameters
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM, or -ERANGE: too large.
 */
int ec_app_dev_generic(struct ec_app_model *m)
{
	struct ec_app_params *p = &m->params;
	struct ec_app_dev *d = &m->dev;
	bool drive = d->profile;
	u32 bits[EC_APP_DIRS], bytes[EC_APP_DIRS];
	struct ec_app_pdo *pdos;
	u16 mbox = 0;
	int n = 0;

	bits[EC_APP_OUT] = drive ? p->out * 8 : p->out;
	bits[EC_APP_IN] = drive ? p->in * 8 : p->in;
	for (int dir = 0; dir < EC_APP_DIRS; dir++) {
		if (p->out > 8 * MAX_BYTES || p->in > 8 * MAX_BYTES ||
		    bits[dir] > 8 * MAX_BYTES)
			return -ERANGE;
		bytes[dir] = (bits[dir] + 7) / 8;
		d->max_bytes[dir] = (u16)bytes[dir];
		if (d->mapping >= EC_APP_MAP_FULL)
			d->max_bytes[dir] = (u16)max_t(u32, bytes[dir], 64);
	}
	if (drive) {
		mbox = p->mbox ? p->mbox : EC_APP_GENERIC_MBOX;
		if (mbox < 32 || mbox > MAX_BYTES)
			return -ERANGE;
	} else if (p->cpu) {
		d->pdi_control = 0x0005;
	}
	if (!place(m, mbox))
		return -ERANGE;

	pdos = ec_app_model_alloc(m, 2 * (8 * MAX_BYTES / 32 / PDO_ENTRIES + 8) *
				     sizeof(*pdos));
	if (!pdos)
		return -ENOMEM;
	for (int dir = 0; dir < EC_APP_DIRS; dir++) {
		bool out = dir == EC_APP_OUT;
		u8 width = drive || bits[dir] > 1024 ? 32 :
			   bits[dir] > 64 ? 8 : 1;
		int ret = make_pdos(m, pdos + n, dir, bits[dir], width,
				    out ? drive_out : drive_in, !drive ? 0 :
				    out ? ARRAY_SIZE(drive_out) :
					  ARRAY_SIZE(drive_in));

		if (ret < 0)
			return ret;
		n += ret;
	}
	d->pdos = pdos;
	d->n_pdos = (u16)n;
	set_lengths(d);
	return 0;
}
