// SPDX-License-Identifier: GPL-2.0-only
/*
 * The PDOs a CoE slave uses at this moment, from its object dictionary. The
 * EEPROM only has those it is delivered with.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../mailbox/coe.h"
#include "pdo_coe.h"
#include "slave.h"
#include "slave_pdo.h"

#define NO_OBJECT	0x06020000	/* abort code */
#define WHOLE_MS	300000	/* for the PDOs of a SyncManager: up to 65,000 objects */
#define AGAIN_MIN_MS	2000	/* until they are read again after an exchange that failed */
#define AGAIN_MAX_MS	60000

/* An unsigned object of at most 4 bytes; -ENOENT: the slave refuses it; -ENXIO: it has none. */
static int upload(struct ec_slave *s, u16 index, u8 sub, u32 *value, u64 end_ns)
{
	const struct ec_mbox_limit limit = { .end_ns = end_ns };
	u8 b[4] = { 0 };
	size_t got;
	u32 abort;
	int ret = ec_coe_upload(&s->mbox, index, sub, false, b, sizeof(b), &got, &abort, &limit);

	*value = get_unaligned_le32(b);
	if (ret != -EIO || !abort)
		return ret;
	return abort == NO_OBJECT ? -ENXIO : -ENOENT;
}

/* What is known of a PDO, from the EEPROM for example; 1: nothing. */
static int known_mapping(struct ec_slave *s, struct ec_pdo *pdo)
{
	const struct ec_pdo *known;
	int ret;

	down_read(&s->bus->topo);
	known = ec_slave_find_pdo(s, pdo->index);
	ret = known ? ec_pdo_copy_entries(pdo, known) : 1;
	up_read(&s->bus->topo);
	return ret;
}

/*
 * Objects 0x1600..., 0x1A00...: mapping (ETG.1000.6 clause 5.6.7.4.7). One that is assigned and
 * does not exist has no data.
 */
static int read_mapping(struct ec_slave *s, struct ec_pdo *pdo, u64 end_ns)
{
	u32 n, v;
	unsigned int i;
	int ret = upload(s, pdo->index, 0, &n, end_ns);

	if (ret == -ENOENT || ret == -ENXIO) {
		int known = known_mapping(s, pdo);

		return known <= 0 ? known : ret == -ENXIO ? 0 : ret;
	}
	if (!ret && n > 255)
		return -EBADMSG;
	for (i = 1; i <= n && !ret; i++) {
		struct ec_pdo_entry e;

		ret = upload(s, pdo->index, i, &v, end_ns);
		e = (struct ec_pdo_entry){ .index = v >> 16, .sub = v >> 8, .bits = v };
		if (!ret)
			ret = ec_pdo_add_entry(pdo, &e);
	}
	return ret;
}

/* Objects 0x1C10...: assignment (ETG.1000.6 clause 5.6.7.4.9) */
static int read_assignment(struct ec_slave *s, unsigned int sm, struct ec_pdo_list *l)
{
	u64 end_ns = ktime_get_ns() + (u64)WHOLE_MS * NSEC_PER_MSEC;
	u32 n, index;
	unsigned int i;
	int ret = upload(s, EC_PDO_ASSIGN + sm, 0, &n, end_ns);

	if (!ret && n > 255)
		return -EBADMSG;
	for (i = 1; i <= n && !ret; i++) {
		struct ec_pdo *p;

		ret = upload(s, EC_PDO_ASSIGN + sm, i, &index, end_ns);
		if (ret)
			break;
		if (!index)	/* an entry that is not in use */
			continue;
		p = ec_pdo_add(l, index, 0);
		ret = p ? read_mapping(s, p, end_ns) : -ENOMEM;
	}
	ec_slave_name_pdos(s, l);
	return ret;
}

/* PDOs that are not assigned any more can be assigned again: keep them. */
static void keep_unassigned(struct ec_slave *s, struct ec_pdo_list *old)
{
	unsigned int i;

	lockdep_assert_held_write(&s->bus->topo);
	for (i = 0; i < old->n; i++) {
		struct ec_pdo *p;

		if (ec_slave_find_pdo(s, old->pdos[i].index))
			continue;
		p = ec_pdo_add(&s->pdos.free, old->pdos[i].index, old->pdos[i].name);
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

	down_write(&s->bus->topo);
	ec_show_change_begin(&s->bus->base->show);
	old = s->pdos.sm[sm];
	s->pdos.sm[sm] = *l;
	keep_unassigned(s, &old);
	ec_slave_note_profile(s);
	ec_show_change_end(&s->bus->base->show);
	up_write(&s->bus->topo);
	ec_pdo_list_clear(&old);
}

/**
 * ec_slave_read_sm_pdos() - read the PDOs of a SyncManager
 * @s: slave in PREOP or higher with CoE, @lock held
 * @sm: SyncManager
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ENOENT when the slave refuses; -EBADMSG; -ENOMEM; or as ec_coe_upload().
 */
int ec_slave_read_sm_pdos(struct ec_slave *s, unsigned int sm)
{
	struct ec_pdo_list l = { 0 };
	int ret;

	lockdep_assert_held(&s->lock);
	ret = read_assignment(s, sm, &l);
	if (ret == -ENXIO)
		ret = -ENOENT;
	if (!ret)
		replace(s, sm, &l);
	else
		ec_pdo_list_clear(&l);
	return ret;
}

/**
 * ec_slave_set_sm_pdos() - note the PDOs that were written to a slave
 * @s: slave, @lock held
 * @sm: SyncManager
 * @l: its PDOs now, copied
 *
 * Context: Process. May sleep.
 */
void ec_slave_set_sm_pdos(struct ec_slave *s, unsigned int sm, const struct ec_pdo_list *l)
{
	struct ec_pdo_list copy = { 0 };

	lockdep_assert_held(&s->lock);
	if (l == &s->pdos.sm[sm])
		return;
	if (ec_pdo_list_copy(&copy, l)) {
		ec_pdo_list_clear(&copy);
		return;
	}
	ec_slave_name_pdos(s, &copy);
	replace(s, sm, &copy);
}

/**
 * ec_slave_clear_warning() - forget what was not certain of a configuration
 * @s: slave, @lock held
 *
 * That its PDOs could not be read stays visible until they can.
 *
 * Context: Process.
 */
void ec_slave_clear_warning(struct ec_slave *s)
{
	lockdep_assert_held(&s->lock);
	ec_slave_set_warning(s, "%s", s->pdos.unread ?
			     "PDOs could not be read over CoE; those of the EEPROM are used" : "");
}

/*
 * Says once that it failed; what a slave answers wrongly it would answer again. One that only makes
 * the master wait has its worker for a tenth of the time.
 */
static void note_unread(struct ec_slave *s, int ret, u64 took_ns)
{
	bool before = s->pdos.unread;
	u64 again = 0;
	char why[96];

	s->pdos.unread = ret && ret != -ENOENT;
	ec_slave_clear_warning(s);
	if (s->pdos.unread && ret != -EBADMSG) {
		s->pdos.again_ms = clamp_t(u32, before ? 2 * s->pdos.again_ms : 0, AGAIN_MIN_MS,
					   AGAIN_MAX_MS);
		again = ktime_get_ns() +
			max(s->pdos.again_ms * (u64)NSEC_PER_MSEC, 9 * took_ns);
	}
	ec_write64(&s->pdos.again_ns, again);
	if (s->pdos.unread && !before)
		ec_slave_warn(s, "%s (%s)\n", s->note.warning,
			      ec_mbox_fail_text(ret, "CoE", why, sizeof(why)));
	else if (before && !s->pdos.unread)
		ec_slave_info(s, "PDOs read over CoE\n");
}

/**
 * ec_slave_read_coe_pdos() - read which PDOs the slave uses
 * @s: slave in PREOP or higher with CoE, @lock held
 *
 * SyncManagers whose objects the slave does not have keep the PDOs of the
 * EEPROM. When its mailbox fails, they are read again later.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_slave_read_coe_pdos(struct ec_slave *s)
{
	u64 began = ktime_get_ns();
	unsigned int sm;
	int ret = 0;

	lockdep_assert_held(&s->lock);
	for (sm = 2; sm < s->n_sms && !READ_ONCE(s->stop.gone); sm++) {
		ret = ec_slave_read_sm_pdos(s, sm);
		if (ret && ret != -ENOENT)
			break;
	}
	/* then the monitor lets it begin again */
	if (ret == -ECANCELED || ret == -EINTR || ret == -ENOMEM)
		return;
	note_unread(s, ret, ktime_get_ns() - began);
	if (!s->pdos.unread || !s->pdos.known)
		WRITE_ONCE(s->pdos.names_done, false);
	WRITE_ONCE(s->pdos.known, true);
}
