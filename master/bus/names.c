// SPDX-License-Identifier: GPL-2.0-only
/*
 * Names of PDOs and entries from the object dictionary (SDO information, ETG.1000.6 clause
 * 5.6.3). Asked for is only what the EEPROM has no name for, once, while no cycle runs.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../base/grow.h"
#include "../mailbox/coe.h"
#include "slave.h"
#include "../wire/sdoinfo.h"

#define LIMIT_MS	500	/* for all names of a slave; others wait for its worker */
#define ANSWER_MS	100

/* The name of an object or entry, or NULL: not asked for yet. */
static const char *names_find(const struct ec_names *l, u16 index, u16 sub)
{
	unsigned int i;

	for (i = 0; i < l->n; i++)
		if (l->v[i].index == index && l->v[i].sub == sub)
			return l->v[i].text;
	return NULL;
}

/**
 * ec_names_find() - what the object dictionary calls an object or entry
 * @s: slave
 * @index: object
 * @sub: subindex, or EC_NAME_OBJECT
 *
 * Context: After ec_show_begin(), or topo held.
 * Return: name, perhaps empty.
 */
const char *ec_names_find(const struct ec_slave *s, u16 index, u16 sub)
{
	ec_bus_assert_stays(s->bus);
	return names_find(&s->pdos.names, index, sub) ?: "";
}

struct answer {
	struct ec_sdoinfo info;
	u64 until;	/* ktime, ns */
	u8 data[EC_MBOX_MAX];
};

/* One description; 0, or -errno. */
static int ask(struct ec_slave *s, struct answer *a, struct ec_mbox_buf *b)
{
	static const struct ec_mbox_limit limit = { .timeout_ms = ANSWER_MS };

	return ec_coe_ask(&s->mbox, &a->info, a->until, &limit, b);
}

/* An entry of a simple object is called as the object. */
static int read_name(struct ec_slave *s, struct answer *a, struct ec_mbox_buf *b, u16 index,
		     u16 sub, char *text)
{
	struct ec_od_object o = { 0 };
	struct ec_od_entry e = { 0 };
	int ret;

	text[0] = '\0';
	if (sub != EC_NAME_OBJECT) {
		ec_sdoinfo_init(&a->info, EC_SDOINFO_ENTRY_REQ, index, sub, a->data,
				sizeof(a->data));
		ret = ask(s, a, b);
		if (!ret && !ec_od_entry_decode(a->data, a->info.size, &e))
			ec_sii_text(text, EC_UAPI_STRING, (const u8 *)e.name, e.name_len);
		if (ret || text[0] || sub)
			return ret;
	}
	ec_sdoinfo_init(&a->info, EC_SDOINFO_OBJECT_REQ, index, 0, a->data, sizeof(a->data));
	ret = ask(s, a, b);
	if (!ret && !ec_od_object_decode(a->data, a->info.size, &o))
		ec_sii_text(text, EC_UAPI_STRING, (const u8 *)o.name, o.name_len);
	return ret;
}

static int names_add(struct ec_names *l, u16 index, u16 sub, const char *text)
{
	struct ec_od_name *v;

	if (l->n >= EC_MAX_NAMES)
		return -ENOSPC;
	v = ec_grow(l->v, l->n, sizeof(*v));
	if (!v)
		return -ENOMEM;
	l->v = v;
	v[l->n] = (struct ec_od_name){ .index = index, .sub = sub };
	strscpy(v[l->n++].text, text, sizeof(v->text));
	return 0;
}

/* a PDO of the slave, @entry 0, or one of its entries */
struct place {
	unsigned int sm, pdo, entry;
};

/* The next one without a name, at @at or behind it; false: none. */
static bool next_unknown(const struct ec_slave *s, const struct ec_names *l, struct place *at,
			 u16 *index, u16 *sub)
{
	for (; at->sm < EC_MAX_SM; at->sm++, at->pdo = 0) {
		const struct ec_pdo_list *pdos = &s->pdos.sm[at->sm];

		for (; at->pdo < pdos->n; at->pdo++, at->entry = 0) {
			const struct ec_pdo *p = &pdos->pdos[at->pdo];

			for (; at->entry <= p->n_entries; at->entry++) {
				const struct ec_pdo_entry *e = p->entries + at->entry - 1;

				*index = at->entry ? e->index : p->index;
				*sub = at->entry ? e->sub : EC_NAME_OBJECT;
				if (*index && !(at->entry ? e->name : p->name) &&
				    !names_find(l, *index, *sub))
					return true;
			}
		}
	}
	return false;
}

/**
 * ec_names_pending() - are names of the slave unknown, and can they be read now?
 * @s: slave whose PDOs are known, @lock held
 *
 * Never beside a cycle: nothing there depends on names.
 *
 * Context: Process.
 * Return: whether ec_names_read() has something to do.
 */
bool ec_names_pending(const struct ec_slave *s)
{
	struct place at = { 0 };
	u16 index, sub;

	lockdep_assert_held(&s->lock);
	return s->pdos.known && !s->pdos.names_done && !READ_ONCE(s->note.error) &&
	       s->has_general && s->general.coe & EC_SII_COE_SDO_INFO &&
	       !ec_access_is_cyclic(&s->bus->links->access) &&
	       !ec_mbox_check(&s->mbox, EC_SII_PROTO_COE, EC_SDOINFO_MIN) &&
	       next_unknown(s, &s->pdos.names, &at, &index, &sub);
}

/* @l takes the place of the slave's names. */
static void names_publish(struct ec_slave *s, struct ec_names *l)
{
	struct ec_names old;

	down_write(&s->bus->topo);
	ec_show_change_begin(&s->bus->base->show);
	old = s->pdos.names;
	s->pdos.names = *l;
	ec_show_change_end(&s->bus->base->show);
	up_write(&s->bus->topo);
	kvfree(old.v);
}

static int names_copy(struct ec_names *to, const struct ec_names *from)
{
	unsigned int i;
	int ret = 0;

	for (i = 0; i < from->n && !ret; i++)
		ret = names_add(to, from->v[i].index, from->v[i].sub, from->v[i].text);
	return ret;
}

/* Ask for one after the other, until all are known or the time is over. */
static int names_read_all(struct ec_slave *s, struct ec_names *l, struct answer *a,
			  struct ec_mbox_buf *b)
{
	char text[EC_UAPI_STRING];
	struct place at = { 0 };
	u16 index, sub;
	int ret = 0;

	a->until = ktime_get_ns() + LIMIT_MS * (u64)NSEC_PER_MSEC;
	while (!ret && next_unknown(s, l, &at, &index, &sub)) {
		if (READ_ONCE(s->bus->links->access.mode) != EC_ACCESS_DIRECT)
			return -EAGAIN;
		if (ktime_get_ns() > a->until)
			return 0;
		ret = read_name(s, a, b, index, sub, text);
		/* refused: it has no name */
		if (!ret || ret == -EIO)
			ret = names_add(l, index, sub, text);
	}
	return ret;
}

/**
 * ec_names_read() - ask the slave for the names its EEPROM does not have
 * @s: slave that ec_names_pending() is true for, @lock held
 *
 * A slave that does not answer is not asked again.
 *
 * Context: The slave's worker. Waits for bus traffic.
 */
void ec_names_read(struct ec_slave *s)
{
	struct ec_mbox_buf *b = kmalloc(sizeof(*b), GFP_KERNEL);
	struct answer *a = kmalloc(sizeof(*a), GFP_KERNEL);
	struct ec_names l = { 0 };
	struct ec_claim claim = { 0 };
	int ret = -ENOMEM;

	lockdep_assert_held(&s->lock);
	if (a && b && !names_copy(&l, &s->pdos.names))
		ret = ec_mbox_claim(&s->mbox, &claim, BIT(EC_MBOX_COE), LIMIT_MS);
	if (!ret) {
		ret = names_read_all(s, &l, a, b);
		ec_mbox_unclaim(&s->mbox, &claim);
		names_publish(s, &l);
		s->pdos.names_done = ret != -ECANCELED && ret != -EAGAIN && ret != -ENOMEM;
	} else {
		kvfree(l.v);
	}
	kfree(a);
	kfree(b);
}

/**
 * ec_names_free() - free the names of a slave that is being freed
 * @s: slave
 *
 * Context: Process.
 */
void ec_names_free(struct ec_slave *s)
{
	kvfree(s->pdos.names.v);
	s->pdos.names = (struct ec_names){ 0 };
}
