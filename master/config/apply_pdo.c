// SPDX-License-Identifier: GPL-2.0-only
/* PDO assignment and mapping of a slave before SAFEOP. */
#include <linux/err.h>
#include "../mailbox/coe.h"
#include "config.h"
#include "../mailbox/mailbox.h"
#include "../link/links.h"
#include "../bus/pdo_coe.h"
#include "../bus/result.h"
#include "../wire/coe.h"
#include "apply_pdo.h"

#define REFUSED		1
#define LIST_TEXT	160	/* characters of PDOs in a line of the log */

static int sdo_u(struct ec_slave *s, u16 index, u8 sub, u32 value, u8 bytes, u32 *abort)
{
	u8 b[4];

	put_unaligned_le32(value, b);
	return ec_coe_download(&s->mbox, index, sub, false, b, bytes, abort, NULL);
}

/* Many slaves have fixed lists: what they have instead decides, see apply_pdo_check(). */
static int note_refusal(struct ec_slave *s, unsigned int sm, u16 index, const char *what, int ret,
			u32 abort)
{
	struct ec_setup *setup = ec_setup_of(s);
	char text[sizeof(setup->pdo_refusal)], why[96];

	if (!ret || ret == -ECANCELED || ret == -EINTR)
		return ret;
	if (abort)
		scnprintf(text, sizeof(text), "%s 0x%04x refused: abort 0x%08x (%s)", what, index,
			  abort, ec_coe_abort_text(abort) ?: "unknown code");
	else
		scnprintf(text, sizeof(text), "%s 0x%04x not written: %s", what, index,
			  ec_mbox_fail_text(ret, "CoE", why, sizeof(why)));
	ec_slave_warn(s, "%s\n", text);
	if (!setup->pdo_refusal[0]) {
		strscpy(setup->pdo_refusal, text, sizeof(setup->pdo_refusal));
		setup->pdo_cause = *EC_CAUSE(PDO, .sm = sm, .object = index, .code = abort);
	}
	return REFUSED;
}

/* The CiA procedure: count 0, values, count. */
static int write_list(struct ec_slave *s, unsigned int sm, u16 index, unsigned int n, u8 bytes,
		      u32 (*value)(const void *ctx, unsigned int i), const void *ctx,
		      const char *what)
{
	unsigned int i;
	u32 abort;
	int ret;

	ret = sdo_u(s, index, 0, 0, 1, &abort);
	for (i = 0; i < n && !ret; i++)
		ret = sdo_u(s, index, i + 1, value(ctx, i), bytes, &abort);
	if (!ret)
		ret = sdo_u(s, index, 0, n, 1, &abort);
	return note_refusal(s, sm, index, what, ret, abort);
}

static u32 map_value(const void *ctx, unsigned int i)
{
	const struct ec_pdo *pdo = ctx;

	return ec_pdo_entry_value(&pdo->entries[i]);
}

static u32 assign_value(const void *ctx, unsigned int i)
{
	const struct ec_pdo_list *l = ctx;

	return l->pdos[i].index;
}

/* Value @i of a list, which has @bytes; the one at 0, their number, may have more. */
static bool read_value(struct ec_slave *s, u16 index, u8 i, u8 bytes, u32 *value)
{
	u8 b[4] = { 0 };
	size_t got;
	u32 abort;

	if (ec_coe_upload(&s->mbox, index, i, false, b, sizeof(b), &got, &abort, NULL))
		return false;
	*value = get_unaligned_le32(b);
	return !i || got == bytes;
}

static bool mapped_already(struct ec_slave *s, const struct ec_pdo *p)
{
	unsigned int i;
	u32 v;

	if (!p->n_entries)
		return true;
	if (!read_value(s, p->index, 0, 1, &v) || v != p->n_entries)
		return false;
	for (i = 0; i < p->n_entries; i++)
		if (!read_value(s, p->index, i + 1, 4, &v) || v != map_value(p, i))
			return false;
	return true;
}

/* An assignment may have entries of 0, which are not in use. */
static bool assigned_already(struct ec_slave *s, u16 index, const struct ec_pdo_list *l)
{
	unsigned int i, used = 0;
	u32 n, v;

	if (!read_value(s, index, 0, 1, &n) || n > 255 || n < l->n)
		return false;
	for (i = 1; i <= n; i++) {
		if (!read_value(s, index, i, 2, &v))
			return false;
		if (v && (used == l->n || l->pdos[used++].index != v))
			return false;
	}
	return used == l->n;
}

/*
 * A PDO must not be assigned while its mapping is written (ETG.1000.6 clause 5.6.7.4). A slave
 * that refuses a change of the assignment may accept one of the mapping.
 */
static int write_sm_pdos(struct ec_slave *s, unsigned int sm, const struct ec_pdo_list *l)
{
	u16 assign = EC_PDO_ASSIGN + sm;
	unsigned int i, first;
	bool refused = false;
	u32 abort;
	int ret;

	for (first = 0; first < l->n && mapped_already(s, &l->pdos[first]); first++)
		;
	if (first < l->n) {
		ret = sdo_u(s, assign, 0, 0, 1, &abort);
		if (ret == -ECANCELED || ret == -EINTR)
			return ret;
	}
	for (i = first; i < l->n; i++) {
		const struct ec_pdo *p = &l->pdos[i];

		if (mapped_already(s, p))
			continue;
		ret = write_list(s, sm, p->index, p->n_entries, 4, map_value, p, "PDO mapping");
		if (ret < 0)
			return ret;
		refused |= ret == REFUSED;
	}
	if (assigned_already(s, assign, l))
		return refused ? REFUSED : 0;
	ret = write_list(s, sm, assign, l->n, 2, assign_value, l, "PDO assignment");
	return ret ?: refused ? REFUSED : 0;
}

static void log_list(const struct ec_slave *s, unsigned int sm, const char *what,
		     const struct ec_pdo_list *l)
{
	char text[LIST_TEXT] = "";
	unsigned int i, k, n = 0;

	for (i = 0; i < l->n; i++) {
		const struct ec_pdo *p = &l->pdos[i];

		n += scnprintf(text + n, sizeof(text) - n, " 0x%04x:", p->index);
		for (k = 0; k < p->n_entries; k++)
			n += scnprintf(text + n, sizeof(text) - n, " %04x:%02x/%u",
				       p->entries[k].index, p->entries[k].sub, p->entries[k].bits);
	}
	ec_slave_warn(s, "SM%u %s:%s%s\n", sm, what, n ? text : " nothing",
		      n >= sizeof(text) - 1 ? "..." : "");
}

/* The first registered entry that the slave does not have in its place, or NULL. */
static const struct ec_pdo_entry *first_wrong(const struct ec_pdo_list *want,
					      const struct ec_pdo_list *have, u32 *bit)
{
	unsigned int i, k;

	*bit = 0;
	for (i = 0; i < want->n; i++)
		for (k = 0; k < want->pdos[i].n_entries; k++) {
			const struct ec_pdo_entry *e = &want->pdos[i].entries[k];
			const struct ec_pdo_entry *h = ec_pdo_list_at(have, *bit);

			if (e->registered && e->index &&
			    (!h || h->index != e->index || h->sub != e->sub || h->bits != e->bits))
				return e;
			*bit += e->bits;
		}
	return NULL;
}

/*
 * @have is what the slave has, and it will not change it. Process data of other objects
 * than the registered ones would be exchanged with a full working counter.
 */
static struct ec_result apply_pdo_compare(struct ec_slave *s, const struct ec_config *c,
					  unsigned int sm, const char *cause)
{
	const struct ec_pdo_list *want = ec_apply_pdos_of(s, c, sm), *have = &s->pdos.sm[sm];
	const struct ec_pdo_entry *e, *h;
	const struct ec_setup *setup = ec_setup_of(s);
	bool refused = cause == setup->pdo_refusal;
	char has[32] = "nothing";
	struct ec_result r;
	u32 bit;

	lockdep_assert_held(&s->lock);
	e = first_wrong(want, have, &bit);
	if (!e)
		return EC_RESULT(0);
	h = ec_pdo_list_at(have, bit);
	if (h)
		snprintf(has, sizeof(has), "0x%04x:%02x, %u bit", h->index, h->sub, h->bits);
	log_list(s, sm, "configured", want);
	log_list(s, sm, "in the slave", have);
	ec_slave_set_warning(s, "SM%u bit %u: registered 0x%04x:%02x, %u bit; slave has %s; %.110s",
			     sm, bit, e->index, e->sub, e->bits, has, cause);
	if (ec_config_flag(c, EC_FLAG_ANY_PDOS)) {
		ec_slave_warn(s, "%s; flag %s set, continuing\n", s->note.warning,
			      EC_FLAG_ANY_PDOS);
		return EC_RESULT(0);
	}
	r = ec_result_fail(s, -EOPNOTSUPP,
			   EC_CAUSE(PDO, .sm = sm, .object = refused ? setup->pdo_cause.object : 0,
				    .code = refused ? setup->pdo_cause.code : 0), "%s",
			   s->note.warning);
	ec_slave_set_warning(s, "%s", "");
	return r;
}

static void not_certain(struct ec_slave *s, unsigned int sm, const char *why)
{
	ec_slave_set_warning(s, "process data of SM%u may belong to other objects: %.130s", sm,
			     why);
	ec_slave_warn(s, "%s\n", s->note.warning);
}

/* The slave refused: what does it have instead? */
static struct ec_result apply_pdo_check(struct ec_slave *s, const struct ec_config *c,
					unsigned int sm)
{
	const char *refusal = ec_setup_of(s)->pdo_refusal;
	char text[160], why[96];
	int ret = ec_slave_read_sm_pdos(s, sm);

	if (ret == -ECANCELED || ret == -EINTR)
		return EC_RESULT(ret);
	if (!ret)
		return apply_pdo_compare(s, c, sm, refusal);
	snprintf(text, sizeof(text), "%.80s; its PDOs cannot be read (%s)", refusal,
		 ec_mbox_fail_text(ret, "CoE", why, sizeof(why)));
	not_certain(s, sm, text);
	return EC_RESULT(0);
}

/* Do the PDOs that startup SDOs have made still fit the layout? The last one is @u. */
static struct ec_result check_made(struct ec_slave *s, const struct ec_config *c, unsigned int sm,
				   const struct ec_startup *u)
{
	u32 bytes = ec_pdo_list_bytes(&s->pdos.sm[sm]);
	struct ec_result r;
	char sdo[80];
	unsigned int i;

	snprintf(sdo, sizeof(sdo), "startup SDO 0x%04x:%02x changes it; register entries after all startup SDOs",
		 u->index, u->sub);
	r = apply_pdo_compare(s, c, sm, sdo);
	for (i = 0; i < c->n_fmmus && !r.err; i++)
		if (c->fmmus[i].sm == sm && c->fmmus[i].size != bytes)
			r = ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(LAYOUT, .sm = sm),
					   "SM%u registered with %u byte(s), slave has %u; %s",
					   sm, c->fmmus[i].size, bytes, sdo);
	return r;
}

/* The application lets startup SDOs make the PDOs of a SyncManager: what are they now? */
static struct ec_result take_made(struct ec_slave *s, const struct ec_config *c, unsigned int sm,
				  const struct ec_startup *u)
{
	char text[160], why[96];
	struct ec_result r;
	int ret = ec_slave_read_sm_pdos(s, sm);

	if (ret == -ECANCELED || ret == -EINTR)
		return EC_RESULT(ret);
	if (!ret) {
		r = check_made(s, c, sm, u);
		if (!r.err)
			ec_setup_of(s)->made |= BIT(sm);
		return r;
	}
	snprintf(text, sizeof(text), "startup SDO 0x%04x:%02x changes it; its PDOs cannot be read (%s)",
		 u->index, u->sub, ec_mbox_fail_text(ret, "CoE", why, sizeof(why)));
	not_certain(s, sm, text);
	return EC_RESULT(0);
}

static bool has_entry(const struct ec_pdo_list *l, const struct ec_pdo_entry *e)
{
	unsigned int i, k;

	for (i = 0; i < l->n; i++)
		for (k = 0; k < l->pdos[i].n_entries; k++)
			if (l->pdos[i].entries[k].index == e->index &&
			    l->pdos[i].entries[k].sub == e->sub)
				return true;
	return false;
}

/*
 * Are the registered entries in the places of entries of the same length, which are only called
 * otherwise? One that the slave has in another place is not.
 */
static bool names_differ(const struct ec_pdo_list *want, const struct ec_pdo_list *have)
{
	unsigned int i, k;
	u32 bit = 0;

	if (ec_pdo_list_bytes(want) != ec_pdo_list_bytes(have))
		return false;
	for (i = 0; i < want->n; i++)
		for (k = 0; k < want->pdos[i].n_entries; k++) {
			const struct ec_pdo_entry *e = &want->pdos[i].entries[k];
			const struct ec_pdo_entry *h = ec_pdo_list_at(have, bit);

			bit += e->bits;
			if (!e->registered || !e->index)
				continue;
			if (!h || !h->index || h->bits != e->bits)
				return false;
			if ((h->index != e->index || h->sub != e->sub) && has_entry(have, e))
				return false;
		}
	return true;
}

static bool same_direction(const struct ec_slave *s, const struct ec_config *c, unsigned int sm)
{
	u8 dir = s->sms[sm].control & EC_SM_DIR_WRITE ? EC_CFG_DIR_OUTPUT : EC_CFG_DIR_INPUT;

	return c->sm[sm].dir == dir;
}

/* Objects that no service can reach are labels. The first one is reported. */
static void note_names(struct ec_slave *s, unsigned int sm, const struct ec_pdo_list *want,
		       const struct ec_pdo_list *have)
{
	const struct ec_pdo_entry *e, *h;
	u32 bit;

	lockdep_assert_held(&s->lock);
	e = first_wrong(want, have, &bit);
	h = e ? ec_pdo_list_at(have, bit) : NULL;
	if (!h || s->note.warning[0])
		return;
	ec_slave_set_warning(s, "SM%u bit %u: registered as 0x%04x:%02x, named 0x%04x:%02x in the EEPROM; same layout, and without CoE only the name differs",
			     sm, bit, e->index, e->sub, h->index, h->sub);
	ec_slave_warn(s, "%s\n", s->note.warning);
}

/* Without CoE the PDOs cannot be changed, and the EEPROM has what they are. */
static struct ec_result check_fixed(struct ec_slave *s, const struct ec_config *c)
{
	static const struct ec_pdo_list nothing;
	struct ec_result r = { 0 };
	unsigned int sm;
	u32 bit;

	for (sm = 0; sm < s->n_sms && !r.err; sm++) {
		if (!c->sm[sm].explicit || !first_wrong(&c->sm[sm].pdos, &nothing, &bit))
			continue;
		if (s->pdos.sm[sm].n && same_direction(s, c, sm) &&
		    names_differ(&c->sm[sm].pdos, &s->pdos.sm[sm]))
			note_names(s, sm, &c->sm[sm].pdos, &s->pdos.sm[sm]);
		else if (s->pdos.sm[sm].n)
			r = apply_pdo_compare(s, c, sm, "without CoE its PDOs cannot be changed");
		else
			not_certain(s, sm, "the slave has no CoE, and its EEPROM lists no PDOs");
	}
	return r;
}

/**
 * ec_apply_pdos_of() - PDOs that a SyncManager must have
 * @s: slave
 * @c: its configuration, or NULL
 * @sm: SyncManager
 *
 * Context: The slave's worker.
 * Return: PDOs as configured, or as the slave has them: if the application named none, and if
 * startup SDOs have made them.
 */
const struct ec_pdo_list *ec_apply_pdos_of(const struct ec_slave *s, const struct ec_config *c,
					   unsigned int sm)
{
	lockdep_assert_held(&s->lock);
	if (!c || ec_setup_of(s)->made & BIT(sm))
		return &s->pdos.sm[sm];
	return c->sm[sm].explicit || c->sm[sm].pdos.n ? &c->sm[sm].pdos : &s->pdos.sm[sm];
}

/**
 * ec_apply_pdos() - write the configured PDO assignment and mapping
 * @s: slave in PREOP whose PDOs have been read
 * @c: its configuration
 *
 * The slave may have other PDOs by now than when the application started: they are written
 * in that case as well, but not where startup SDOs have changed them: there the slave's are read
 * again. When a slave refuses, or has no CoE, the registered entries must
 * still be in their place. In a SoE drive the IDNs decide.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -ECANCELED, -EINTR; -EOPNOTSUPP when the slave has other process data, reported.
 */
struct ec_result ec_apply_pdos(struct ec_slave *s, const struct ec_config *c)
{
	struct ec_result r = { 0 };
	unsigned int sm;
	int ret;

	lockdep_assert_held(&s->lock);
	if (!ec_mbox_present(&s->mbox) || !(s->info.protocols & EC_SII_PROTO_COE))
		return s->info.protocols & EC_SII_PROTO_SOE ? r : check_fixed(s, c);
	ec_setup_of(s)->made = 0;
	for (sm = 2; sm < EC_MAX_SM && !r.err; sm++) {
		const struct ec_pdo_list *l = ec_apply_pdos_of(s, c, sm);
		const struct ec_startup *u =
			c->sm[sm].explicit || sm >= s->n_sms ? NULL : ec_startup_changes(c, s, sm);

		if (u) {
			r = take_made(s, c, sm, u);
			continue;
		}
		if (!c->sm[sm].explicit && ec_pdo_list_same(l, &s->pdos.sm[sm]))
			continue;
		ret = write_sm_pdos(s, sm, l);
		if (!ret)
			ec_slave_set_sm_pdos(s, sm, l);
		else if (ret == REFUSED)
			r = apply_pdo_check(s, c, sm);
		else
			r = EC_RESULT(ret);
	}
	return r;
}
