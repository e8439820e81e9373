// SPDX-License-Identifier: GPL-2.0-only
/*
 * The PDOs a CoE slave uses at this moment, from its object dictionary. The
 * EEPROM only has those it is delivered with.
 */
#include <linux/slab.h>
#include "coe.h"
#include "master.h"
#include "slave.h"

/* An unsigned object of at most 4 bytes; -ENOENT: the slave refuses it. */
static int upload(struct ec_slave *s, u16 index, u8 sub, u32 *value)
{
	u8 b[4] = { 0 };
	size_t got;
	u32 abort;
	int ret = ec_coe_upload(s, index, sub, false, b, sizeof(b), &got, &abort, NULL);

	*value = get_unaligned_le32(b);
	return ret == -EIO && abort ? -ENOENT : ret;
}

/* String index of the same entry in the EEPROM, for its name. */
static u8 entry_name(const struct ec_pdo *known, u16 index, u8 sub)
{
	unsigned int i;

	for (i = 0; known && i < known->n_entries; i++)
		if (known->entries[i].index == index && known->entries[i].sub == sub)
			return known->entries[i].name;
	return 0;
}

/* Objects 0x1600..., 0x1A00...: mapping (ETG.1000.6 clause 5.6.7.4.7) */
static int read_mapping(struct ec_slave *s, struct ec_pdo *pdo, const struct ec_pdo *known)
{
	u32 n, v;
	unsigned int i;
	int ret = upload(s, pdo->index, 0, &n);

	if (!ret && n > 255)
		return -EBADMSG;
	for (i = 1; i <= n && !ret; i++) {
		struct ec_pdo_entry e;

		ret = upload(s, pdo->index, i, &v);
		e = (struct ec_pdo_entry){ .index = v >> 16, .sub = v >> 8, .bits = v };
		e.name = entry_name(known, e.index, e.sub);
		if (!ret)
			ret = ec_pdo_add_entry(pdo, &e);
	}
	return ret;
}

/* Objects 0x1C10...: assignment (ETG.1000.6 clause 5.6.7.4.9) */
static int read_assignment(struct ec_slave *s, unsigned int sm, struct ec_pdo_list *l)
{
	u32 n, index;
	unsigned int i;
	int ret = upload(s, 0x1c10 + sm, 0, &n);

	if (!ret && n > 255)
		return -EBADMSG;
	for (i = 1; i <= n && !ret; i++) {
		const struct ec_pdo *known;
		struct ec_pdo *p;

		ret = upload(s, 0x1c10 + sm, i, &index);
		if (ret)
			break;
		known = ec_slave_find_pdo(s, index);
		p = ec_pdo_add(l, index, known ? known->name : 0);
		ret = p ? read_mapping(s, p, known) : -ENOMEM;
	}
	return ret;
}

/* PDOs that are not assigned any more can be assigned again: keep them. */
static void keep_unassigned(struct ec_slave *s, struct ec_pdo_list *old)
{
	unsigned int i;

	for (i = 0; i < old->n; i++) {
		struct ec_pdo *p;

		if (ec_slave_find_pdo(s, old->pdos[i].index))
			continue;
		p = ec_pdo_add(&s->free_pdos, old->pdos[i].index, old->pdos[i].name);
		if (!p)
			break;
		p->entries = old->pdos[i].entries;
		p->n_entries = old->pdos[i].n_entries;
		old->pdos[i].entries = NULL;
	}
}

static void replace(struct ec_slave *s, unsigned int sm, struct ec_pdo_list *l)
{
	struct ec_pdo_list old;

	down_write(&s->master->topo);
	ec_change_begin(s->master);
	old = s->sm_pdos[sm];
	s->sm_pdos[sm] = *l;
	keep_unassigned(s, &old);
	ec_change_end(s->master);
	up_write(&s->master->topo);
	ec_pdo_list_clear(&old);
}

/**
 * ec_slave_pdos_pending() - shall the PDOs be read over CoE?
 * @s: slave
 *
 * Context: Any.
 * Return: false also when that was done or is not possible now.
 */
bool ec_slave_pdos_pending(const struct ec_slave *s)
{
	u16 al = READ_ONCE(s->al_status);

	return !READ_ONCE(s->pdos_known) && s->error == EC_SLAVE_OK && s->sii &&
	       ec_slave_has_mailbox(s) && s->info.protocols & EC_SII_PROTO_COE &&
	       (al == EC_AL_PREOP || al == EC_AL_SAFEOP || al == EC_AL_OP);
}

/**
 * ec_slave_read_coe_pdos() - read which PDOs the slave uses, once
 * @s: slave in PREOP or higher with CoE, @lock held
 *
 * SyncManagers whose objects the slave does not have keep the PDOs of the
 * EEPROM.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_slave_read_coe_pdos(struct ec_slave *s)
{
	unsigned int sm;
	int ret = 0;

	for (sm = 2; sm < s->n_sms && !s->gone; sm++) {
		struct ec_pdo_list l = { 0 };

		ret = read_assignment(s, sm, &l);
		if (!ret)
			replace(s, sm, &l);
		else
			ec_pdo_list_clear(&l);
		if (ret && ret != -ENOENT)
			break;
	}
	if (ret == -ECANCELED || ret == -EINTR)
		return;
	if (ret && ret != -ENOENT)
		ec_slave_warn(s, "PDOs could not be read over CoE (%pe); those of the EEPROM are used\n",
			      ERR_PTR(ret));
	WRITE_ONCE(s->pdos_known, true);
}
