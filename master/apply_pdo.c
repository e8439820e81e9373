// SPDX-License-Identifier: GPL-2.0-only
/* PDO assignment and mapping of a slave on its way to SAFEOP. */
#include "coe.h"
#include "config.h"
#include "master.h"
#include "slave.h"
#include "wire/coe.h"

static int sdo_u(struct ec_slave *s, u16 index, u8 sub, u32 value, u8 bytes, u32 *abort)
{
	u8 b[4];

	put_unaligned_le32(value, b);
	return ec_coe_download(s, index, sub, false, b, bytes, abort, NULL);
}

/* Does the object hold @n values of @bytes bytes, as @value says? */
static bool already(struct ec_slave *s, u16 index, unsigned int n, u8 bytes,
		    u32 (*value)(const void *ctx, unsigned int i), const void *ctx)
{
	unsigned int i;
	u32 abort;
	size_t got;
	u8 b[4] = { 0 };

	if (ec_coe_upload(s, index, 0, false, b, sizeof(b), &got, &abort, NULL) || b[0] != n)
		return false;
	for (i = 0; i < n; i++) {
		memset(b, 0, sizeof(b));
		if (ec_coe_upload(s, index, i + 1, false, b, sizeof(b), &got, &abort, NULL) ||
		    got != bytes || get_unaligned_le32(b) != value(ctx, i))
			return false;
	}
	return true;
}

/* Many slaves have fixed lists; the SyncManager's size decides then. */
static int tell_list(struct ec_slave *s, u16 index, const char *what, int ret, u32 abort)
{
	if (ret == -ECANCELED || ret == -EINTR)
		return ret;
	if (ret)
		ec_slave_warn(s, "%s 0x%04x could not be written: error %d, abort 0x%08x: %s\n",
			      what, index, ret, abort, ec_coe_abort_text(abort) ?: "none");
	return 0;
}

/* The CiA procedure: count 0, values, count. */
static int write_list(struct ec_slave *s, u16 index, unsigned int n, u8 bytes,
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
	return tell_list(s, index, what, ret, abort);
}

static u32 map_value(const void *ctx, unsigned int i)
{
	const struct ec_pdo *pdo = ctx;

	return (u32)pdo->entries[i].index << 16 | pdo->entries[i].sub << 8 | pdo->entries[i].bits;
}

static u32 assign_value(const void *ctx, unsigned int i)
{
	const struct ec_pdo_list *l = ctx;

	return l->pdos[i].index;
}

static bool mapped_already(struct ec_slave *s, const struct ec_pdo *p)
{
	return !p->n_entries || already(s, p->index, p->n_entries, 4, map_value, p);
}

/*
 * mailbox.md, PDO write procedure: a PDO must not be assigned while it is mapped. A
 * slave that does not let the assignment be changed may let the mapping.
 */
static int write_sm_pdos(struct ec_slave *s, u16 assign, const struct ec_pdo_list *l)
{
	unsigned int i, first;
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
		ret = write_list(s, p->index, p->n_entries, 4, map_value, p, "PDO mapping");
		if (ret)
			return ret;
	}
	if (already(s, assign, l->n, 2, assign_value, l))
		return 0;
	return write_list(s, assign, l->n, 2, assign_value, l, "PDO assignment");
}

/**
 * ec_apply_pdos_of() - what a SyncManager shall have
 * @s: slave
 * @c: its configuration, or NULL
 * @sm: SyncManager
 *
 * Context: The slave's worker.
 * Return: PDOs as configured, or as the slave has them.
 */
const struct ec_pdo_list *ec_apply_pdos_of(const struct ec_slave *s, const struct ec_config *c,
					   unsigned int sm)
{
	return c && (c->sm[sm].explicit || c->sm[sm].pdos.n) ? &c->sm[sm].pdos : &s->sm_pdos[sm];
}

/**
 * ec_apply_pdos() - give a slave the PDO assignment and mapping it shall have
 * @s: slave in PREOP whose PDOs have been read
 * @c: its configuration
 *
 * Those that were there when the application began may be others by now: they are
 * written too then. A slave that refuses is warned about only, the size of its
 * SyncManagers decides.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0, -ECANCELED, -EINTR.
 */
int ec_apply_pdos(struct ec_slave *s, const struct ec_config *c)
{
	unsigned int sm;
	int ret = 0;

	if (!ec_slave_has_mailbox(s) || !(s->info.protocols & EC_SII_PROTO_COE))
		return 0;
	for (sm = 2; sm < EC_MAX_SM && !ret; sm++) {
		const struct ec_pdo_list *l = ec_apply_pdos_of(s, c, sm);

		if (c->sm[sm].explicit || !ec_pdo_list_same(l, &s->sm_pdos[sm]))
			ret = write_sm_pdos(s, 0x1c10 + sm, l);
	}
	return ret;
}
