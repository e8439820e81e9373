// SPDX-License-Identifier: GPL-2.0-only
/* SyncManagers and FMMUs of a slave: what it takes to exchange process data. */
#include "config.h"
#include "domain.h"
#include "../link/links.h"
#include "../bus/result.h"
#include "../wire/fmmu.h"
#include "../carry/xfer.h"
#include "apply_pdo.h"
#include "apply_regs.h"

#define MAX_FMMU	16

/**
 * struct batch - writes that leave in as few frames as they fit in
 * @dg: datagrams: one for each SyncManager and FMMU, so that they fit beside a full cycle
 * @n: entries in @dg
 * @sm: pages of SyncManagers
 * @fmmu: pages of FMMUs
 */
struct batch {
	struct ec_dg dg[EC_MAX_SM + MAX_FMMU];
	unsigned int n;
	u8 sm[EC_MAX_SM][EC_SM_PAGE];
	u8 fmmu[MAX_FMMU][EC_FMMU_PAGE];
};

static void apply_regs_add(struct batch *b, const struct ec_slave *s, u16 ado, void *data, u16 len)
{
	b->dg[b->n++] = EC_FPWR(s->station, ado, len, data);
}

static unsigned int count_fmmus(const struct ec_slave *s)
{
	return min_t(u8, s->regs[EC_REG_FMMUS], MAX_FMMU);
}

static unsigned int first_sm(const struct ec_slave *s)
{
	return ec_mbox_present(&s->mbox) ? 2 : 0;
}

/* SM page for process data; NULL configuration: the EEPROM's defaults */
static void sm_page(const struct ec_slave *s, const struct ec_config *c, unsigned int sm, u8 *page)
{
	struct ec_sm v = {
		.start = s->sms[sm].start, .len = ec_pdo_list_bytes(ec_apply_pdos_of(s, c, sm)),
		.control = s->sms[sm].control,
	};

	if (c && c->sm[sm].dir)
		v.control = (v.control & ~EC_SM_DIR_MASK) |
			    (c->sm[sm].dir == EC_CFG_DIR_OUTPUT ? EC_SM_DIR_WRITE : 0);
	if (c && c->sm[sm].watchdog == EC_CFG_WD_ENABLE)
		v.control |= EC_SM_WATCHDOG;
	if (c && c->sm[sm].watchdog == EC_CFG_WD_DISABLE)
		v.control &= ~EC_SM_WATCHDOG;
	if (v.len && !(s->sms[sm].enable & EC_SII_SM_OP_ONLY))
		v.activate = EC_SM_ACT_ENABLE;
	ec_sm_encode(&v, page);
}

static struct ec_result add_sms(struct batch *b, struct ec_slave *s, const struct ec_config *c)
{
	unsigned int sm;
	u32 bytes;

	for (sm = first_sm(s); sm < s->n_sms; sm++) {
		if (s->sms[sm].enable & EC_SII_SM_VIRTUAL)
			continue;
		bytes = ec_pdo_list_bytes(ec_apply_pdos_of(s, c, sm));
		if (bytes > EC_MAX_SM_BYTES)
			return ec_result_fail(s, -EOVERFLOW, EC_CAUSE(LAYOUT),
					      "SM%u needs %u bytes, limit %u; map fewer entries",
					      sm, bytes, EC_MAX_SM_BYTES);
		sm_page(s, c, sm, b->sm[sm]);
		apply_regs_add(b, s, EC_REG_SM(sm), b->sm[sm], EC_SM_PAGE);
	}
	return EC_RESULT(0);
}

/*
 * An FMMU that leads anywhere else than to process data would write registers, or the
 * mailbox, with each frame.
 */
static bool holds_pdos(const struct ec_slave *s, unsigned int sm)
{
	return sm < s->n_sms && s->sms[sm].start >= EC_REG_DIGITAL_OUT &&
	       !(sm < 2 && ec_mbox_present(&s->mbox));
}

/* Can the slave serve the layout of the session? */
static struct ec_result check_fmmus(struct ec_slave *s, const struct ec_config *c)
{
	unsigned int i;

	if (c->n_fmmus > count_fmmus(s))
		return ec_result_fail(s, -ENOSPC, EC_CAUSE(LAYOUT),
				      "%u FMMUs needed, slave has %u; put the SyncManagers into fewer domains",
				      c->n_fmmus, s->regs[EC_REG_FMMUS]);
	if (c->lrw && ec_slave_no_lrw(s))
		return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(LAYOUT),
				      "slave without LRW support attached to a layout with LRW; restart the application");
	if (c->in_ring && s->position != c->ring_position)
		return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(LAYOUT),
				      "ring position %u, was %u at activation, and the layout overlaps with other slaves; restart the application, or overlap within the slave only",
				      s->position, c->ring_position);
	for (i = 0; i < c->n_fmmus; i++)
		if (!holds_pdos(s, c->fmmus[i].sm))
			return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(LAYOUT),
					      "SM%u is not a process data SyncManager in the SII; map its PDOs elsewhere",
					      c->fmmus[i].sm);
	return EC_RESULT(0);
}

/* All FMMUs: this clears what an earlier configuration has left in the unused ones. */
static struct ec_result add_fmmus(struct batch *b, struct ec_slave *s, const struct ec_config *c)
{
	struct ec_result r = check_fmmus(s, c);
	unsigned int i;

	if (r.err)
		return r;
	for (i = 0; i < c->n_fmmus; i++) {
		const struct ec_config_fmmu *f = &c->fmmus[i];
		struct ec_fmmu v = {
			.logical = f->domain->offset + f->logical, .len = f->size,
			.lbit_stop = 7, .phys = s->sms[f->sm].start,
			.type = f->dir == EC_CFG_DIR_OUTPUT ? EC_FMMU_WRITE : EC_FMMU_READ,
			.enable = f->size,
		};

		ec_fmmu_encode(&v, b->fmmu[i]);
	}
	ec_setup_of(s)->mapped = c->n_fmmus;
	WRITE_ONCE(s->work.mapped, c->n_fmmus && c->fmmus[0].size ?
		   c->fmmus[0].domain->offset + c->fmmus[0].logical + 1 : 0);
	for (i = 0; i < count_fmmus(s); i++)
		apply_regs_add(b, s, EC_REG_FMMU(i), b->fmmu[i], EC_FMMU_PAGE);
	return r;
}

/**
 * ec_apply_regs() - write SyncManagers and FMMUs of process data
 * @s: slave in PREOP
 * @c: its configuration; NULL: SyncManagers as the EEPROM has them
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -EOVERFLOW, -ENOSPC, -EOPNOTSUPP when it cannot serve the configuration, reported;
 * -ENOMEM; -EIO when it did not execute the writes; or as ec_xfer().
 */
struct ec_result ec_apply_regs(struct ec_slave *s, const struct ec_config *c)
{
	struct batch *b = kzalloc(sizeof(*b), GFP_KERNEL);
	struct ec_result r;

	lockdep_assert_held(&s->lock);
	if (!b)
		return EC_RESULT(-ENOMEM);
	r = add_sms(b, s, c);
	if (!r.err && c)
		r = add_fmmus(b, s, c);
	if (!r.err)
		r = EC_RESULT(ec_xfer_all(s->bus->links, b->dg, b->n));
	kfree(b);
	return r;
}

static const u8 zero[MAX_FMMU * EC_FMMU_PAGE];

/**
 * ec_apply_clear_fmmus() - reset the FMMUs of a slave
 * @s: slave
 *
 * Without process data no FMMU may be left: even in PREOP the slave would respond at
 * logical addresses that the next application gives to another slave.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0, -EIO, or as ec_xfer().
 */
int ec_apply_clear_fmmus(struct ec_slave *s)
{
	unsigned int n = count_fmmus(s);
	int ret = n ? ec_xfer_fpwr(s->bus->links, s->station, EC_REG_FMMU(0), zero,
				   n * EC_FMMU_PAGE) : 0;

	lockdep_assert_held(&s->lock);
	ec_setup_of(s)->mapped = ret;
	if (!ret)
		WRITE_ONCE(s->work.mapped, 0);
	return ret;
}

/**
 * ec_apply_clear_pdos() - reset FMMUs and SyncManagers of process data
 * @s: slave in PREOP
 *
 * While a SyncManager is on its other registers cannot be written.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0, -EIO, or as ec_xfer().
 */
int ec_apply_clear_pdos(struct ec_slave *s)
{
	unsigned int sm = first_sm(s), n = min_t(u8, s->regs[EC_REG_SMS], EC_MAX_SM);
	struct ec_dg dg[EC_MAX_SM];
	unsigned int used = 0;

	lockdep_assert_held(&s->lock);
	for (; sm < n; sm++)
		dg[used++] = EC_FPWR(s->station, EC_REG_SM(sm), EC_SM_PAGE, zero);
	return (used ? ec_xfer_all(s->bus->links, dg, used) : 0) ?: ec_apply_clear_fmmus(s);
}

/**
 * ec_apply_clear() - reset all SyncManagers and FMMUs
 * @s: slave in INIT
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0, -EIO, or as ec_xfer().
 */
int ec_apply_clear(struct ec_slave *s)
{
	unsigned int n = min_t(u8, s->regs[EC_REG_SMS], EC_MAX_SM);
	int ret = ec_apply_clear_fmmus(s);

	lockdep_assert_held(&s->lock);
	if (n)
		ret = ec_xfer_fpwr(s->bus->links, s->station, EC_REG_SM(0), zero,
				   EC_SM_PAGE * n) ?: ret;
	return ret;
}

static int activate_sm(struct ec_slave *s, unsigned int sm, u8 active)
{
	return ec_xfer_fpwr(s->bus->links, s->station, EC_REG_SM(sm) + EC_SM_OFS_ACTIVATE,
			    &active, 1);
}

/**
 * ec_apply_op_only_on() - enable the SyncManagers that the SII enables in OP only
 * @s: slave in SAFEOP or OP
 *
 * Before OP is requested, as some slaves need outputs first.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: how many were off, -EIO, or as ec_xfer().
 */
int ec_apply_op_only_on(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	unsigned int sm, n = 0;
	int ret;

	lockdep_assert_held(&s->lock);
	for (sm = 0; sm < s->n_sms; sm++) {
		if (!(s->sms[sm].enable & EC_SII_SM_OP_ONLY) || setup->op_only & BIT(sm) ||
		    !ec_pdo_list_bytes(ec_apply_pdos_of(s, setup->active_config, sm)))
			continue;
		ret = activate_sm(s, sm, EC_SM_ACT_ENABLE);
		if (ret)
			return ret;
		setup->op_only |= BIT(sm);
		n++;
	}
	return n;
}

/**
 * ec_apply_op_only_off() - disable them
 * @s: slave that leaves OP
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0, -EIO, or as ec_xfer().
 */
int ec_apply_op_only_off(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	unsigned int sm;
	int ret;

	lockdep_assert_held(&s->lock);
	for (sm = 0; setup->op_only; sm++) {
		ret = setup->op_only & BIT(sm) ? activate_sm(s, sm, 0) : 0;
		if (ret)
			return ret;
		setup->op_only &= ~BIT(sm);
	}
	return 0;
}
