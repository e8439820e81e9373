// SPDX-License-Identifier: GPL-2.0-only
/* pdos --coe: assignment and mapping as the slave has them now, beside those of its SII. */
#include "pdos_coe.h"

#include <stdlib.h>
#include <string.h>

#include "present.h"
#include "out.h"
#include "sdo.h"
#include "sii_image.h"

#define NAME		256
#define CONTROL_WRITE	0x04	/* direction bit of the SM's control byte */

/* a PDO as the slave has it */
struct coe_pdo {
	u16 index;
	u8 n;
	bool absent;	/* assigned, and the slave does not have it */
	u32 map[255];	/* object 31-16, subindex 15-8, bits 7-0 */
};

/* one slave */
struct reading {
	struct dev *d;
	const struct ect_slave *s;
	u8 *img;
	size_t size;
	bool quiet;
	bool output;	/* direction of the SyncManager */
	u8 sm;
	struct coe_pdo pdo;
	u16 assigned[255];
	unsigned int n;
};

const char *pdo_entry_text(u16 index, const char *name)
{
	return index || *name ? name : "Gap";
}

bool pdos_coe_has(const struct ect_slave *s)
{
	return present_has_coe(s);
}

/* 0, errno after printing it; @abort not NULL: an abort code is stored there, not printed */
static int upload(struct reading *r, u16 index, u8 sub, u32 *v, u32 *abort)
{
	int err = present_number(r->d->h, r->s, index, sub, v);
	u32 code = err ? ect_error_code(r->d->h) : 0;

	if (code && abort)
		*abort = code;
	else if (code)
		fail_full(-err, NULL, code, "Master%u slave %u: SDO upload 0x%04x:%02x",
			  r->d->master, r->s->position, index, sub);
	else if (err)
		dev_fail(r->d, err, "Master%u slave %u: SDO upload 0x%04x:%02x",
			 r->d->master, r->s->position, index, sub);
	return -err;
}

/* The number of entries, which is subindex 0 of both kinds of objects. */
static int count(struct reading *r, u16 index, unsigned int *n, u32 *abort)
{
	u32 v;
	int err = upload(r, index, 0, &v, abort);

	*n = err ? 0 : v;
	if (err || v <= 255)
		return err;
	fail("Master%u slave %u: 0x%04x:00 is %u, expected at most 255", r->d->master,
	     r->s->position, index, v);
	return 1;
}

/* an entry of 0 is not in use */
static int read_pdo(struct reading *r, u16 index)
{
	unsigned int n = 0;
	u32 abort = 0;
	int err = index ? count(r, index, &n, &abort) : 0;

	r->pdo.index = index;
	r->pdo.absent = err && abort == SDO_NO_OBJECT;
	if (r->pdo.absent)
		err = 0;
	if (err && abort)
		fail_full(err, NULL, abort, "Master%u slave %u: SDO upload 0x%04x:00",
			  r->d->master, r->s->position, index);
	r->pdo.n = (u8)n;
	for (unsigned int i = 0; i < n && !err; i++)
		err = upload(r, index, (u8)(i + 1), &r->pdo.map[i], NULL);
	return err;
}

static bool sii_next(struct reading *r, struct ec_sii_pdo_iter *it, struct ec_sii_pdo *p)
{
	if (!it->type)
		ec_sii_pdo_iter_init(it, r->img, r->size,
				     r->output ? EC_SII_CAT_RXPDO : EC_SII_CAT_TXPDO);
	return ec_sii_pdo_iter_next(it, p) == 1;
}

static bool same_mapping(const struct coe_pdo *l, const struct ec_sii_pdo *p)
{
	struct ec_sii_pdo_entry e;

	for (unsigned int i = 0; i < l->n; i++)
		if (ec_sii_pdo_entry(p, i, &e) ||
		    l->map[i] != ((u32)e.index << 16 | (u32)e.sub << 8 | e.bits))
			return false;
	return l->n == p->entries;
}

static void show_entry(struct reading *r, u32 v)
{
	u16 index = (u16)(v >> 16);
	u8 sub = (u8)(v >> 8), bits = (u8)v;
	char name[NAME];
	u16 type;

	sii_entry_text(r->img, r->size, index, sub, name, sizeof(name), &type);
	out_object(NULL);
	out_u("index", index, "    PDO entry 0x%04x", index);
	out_u("subindex", sub, ":%02x", sub);
	out_u("size_bits", bits, ", %2u bit", bits);
	out_str("name", name, ", \"%s\"\n", pdo_entry_text(index, name));
	out_end();
}

static void show_pdo(struct reading *r, u16 index, const char *name, const char *sii,
		     const char *remark)
{
	out_object(NULL);
	out_str("direction", r->output ? "rx" : "tx", "  %cxPDO", r->output ? 'R' : 'T');
	out_u("index", index, " 0x%04x", index);
	out_str("name", name, " \"%s\"%s\n", name, remark);
	out_str("sii", sii, NULL);
}

/* PDO @k of the list, with what the SII says about it */
static int present_pdo(struct reading *r, unsigned int k)
{
	char name[NAME] = "";
	struct ec_sii_pdo p;
	int err = read_pdo(r, r->assigned[k]);

	if (err)
		return err;
	if (!r->assigned[k] || r->pdo.absent) {
		show_pdo(r, r->assigned[k], name, "unknown",
			 r->pdo.absent ? ", the slave does not have it" : ", entry not in use");
	} else if (!sii_pdo_find(r->img, r->size, r->assigned[k], &p)) {
		show_pdo(r, r->assigned[k], name, "unknown", ", not in the SII");
	} else {
		sii_text(r->img, r->size, p.name, name, sizeof(name));
		if (!same_mapping(&r->pdo, &p))
			show_pdo(r, p.index, name, "other_mapping", ", other mapping in the SII");
		else if (p.sm != r->sm)
			show_pdo(r, p.index, name, "not_assigned", ", not assigned in the SII");
		else
			show_pdo(r, p.index, name, "same", "");
	}
	out_array("entries");
	for (unsigned int i = 0; i < r->pdo.n && !r->quiet; i++)
		show_entry(r, r->pdo.map[i]);
	out_end();
	out_end();
	return 0;
}

/* what only the SII assigns */
static void sii_only(struct reading *r)
{
	struct ec_sii_pdo_iter it = { 0 };
	struct ec_sii_pdo p;

	while (sii_next(r, &it, &p)) {
		bool live = p.sm != r->sm;
		char name[NAME];

		for (unsigned int k = 0; k < r->n; k++)
			live |= r->assigned[k] == p.index;
		if (live)
			continue;
		sii_text(r->img, r->size, p.name, name, sizeof(name));
		show_pdo(r, p.index, name, "only", ", assigned in the SII only");
		out_end();
	}
}

static int sync_manager(struct reading *r)
{
	u16 object = (u16)(PRESENT_SM_ASSIGN + r->sm);
	u32 abort = 0, v;
	int err = count(r, object, &r->n, &abort);

	if (err && abort == SDO_NO_OBJECT)
		return 0;
	if (err && abort)
		return fail_full(err, NULL, abort, "Master%u slave %u: SDO upload 0x%04x:00",
				 r->d->master, r->s->position, object);
	for (unsigned int k = 0; k < r->n && !err; k++) {
		err = upload(r, object, (u8)(k + 1), &v, NULL);
		r->assigned[k] = (u16)v;
	}
	if (err)
		return err;
	out_object(NULL);
	out_u("index", r->sm, "SM%u", r->sm);
	out_u("object", object, ": 0x%04x\n", object);
	out_array("pdos");
	for (unsigned int k = 0; k < r->n && !err; k++)
		err = present_pdo(r, k);
	if (!err)
		sii_only(r);
	out_end();
	out_end();
	return err;
}

static int sync_managers(struct reading *r, const struct ect_slave *s)
{
	int err = 0;

	for (unsigned int i = PRESENT_FIRST_SM; i < s->sm_count && !err; i++) {
		struct ect_sm sm = { .struct_size = sizeof(sm) };

		err = ect_sm_read(r->d->h, s->device, i, &sm);
		if (err)
			return dev_fail(r->d, err, "Master%u slave %u: cannot read SM%u",
					r->d->master, s->position, i);
		r->sm = (u8)i;
		r->output = sm.control & CONTROL_WRITE;
		err = sync_manager(r);
	}
	return err;
}

/**
 * pdos_coe() - show the PDOs that a slave has now
 * @w: walk
 * @t: command line
 * @d: master, open for writing
 * @s: slave
 * @several: others may follow
 *
 * Return: 0, or 1 after printing what failed.
 */
int pdos_coe(const struct slave_walk *w, const struct tool *t, struct dev *d,
	     const struct ect_slave *s, bool several)
{
	struct reading *r = calloc(1, sizeof(*r));
	int ret;

	(void)w;
	if (!r)
		return fail("out of memory");
	r->d = d;
	r->s = s;
	r->quiet = t->verbosity < 0;
	ret = sii_load(d, s, &r->img, &r->size);
	if (!ret) {
		out_object(NULL);
		out_u("position", s->position, NULL);
		if (several)
			out_text("=== Master %u, Slave %u ===\n", d->master, s->position);
		out_array("sync_managers");
		ret = sync_managers(r, s);
		out_end();
		out_end();
	}
	free(r->img);
	free(r);
	return ret ? 1 : 0;
}
