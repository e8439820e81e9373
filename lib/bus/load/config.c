// SPDX-License-Identifier: LGPL-2.1-or-later
/* The configuration of a slave: PDOs, startup commands, time limits, clock. */
#include <errno.h>
#include <stdlib.h>

#include "load.h"

static const ec_step_t steps[] = {
	[ECB_AT_PREOP] = EC_STEP_IP, [ECB_AT_SAFEOP] = EC_STEP_PS, [ECB_AT_OP] = EC_STEP_SO,
};

uint32_t load_ms(int64_t ns)
{
	return (uint32_t)((ns + 999999) / 1000000);
}

static ec_direction_t direction_of_pdo(uint16_t index)
{
	return index >= 0x1600 && index < 0x1800 ? EC_DIR_OUTPUT :
		index >= 0x1a00 && index < 0x1c00 ? EC_DIR_INPUT : EC_DIR_INVALID;
}

/* by its PDOs, else as the slave has it */
ec_direction_t load_direction(const struct load *l, const struct plan *p, unsigned int sm)
{
	ec_direction_t dir = EC_DIR_INVALID;
	ec_slave_info_t info;
	ec_sync_info_t s;
	bool mixed = false;

	for (size_t i = 0; i < p->n_pdos; i++) {
		ec_direction_t d = direction_of_pdo(p->pdos[i]->index);

		if (p->pdos[i]->sm != sm)
			continue;
		mixed |= d == EC_DIR_INVALID || (dir != EC_DIR_INVALID && d != dir);
		dir = d;
	}
	if (!mixed)
		return dir;
	if (!p->there || l->offline || ecrt_master_get_slave(l->m, (uint16_t)p->position, &info) ||
	    sm >= info.sync_count ||
	    ecrt_master_get_sync_manager(l->m, (uint16_t)p->position, (uint8_t)sm, &s))
		return EC_DIR_INVALID;
	return s.dir;
}

/* PDOs and entries of all SyncManagers, in memory that is freed behind */
struct layout {
	ec_sync_info_t syncs[EC_MAX_SYNC_MANAGERS];
	unsigned int n_syncs;
	ec_pdo_info_t *pdos;
	ec_pdo_entry_info_t *entries;
};

static int layout_init(struct layout *x, const struct ecb_slave *s)
{
	size_t entries = 0;

	for (size_t i = 0; i < s->pdo_count; i++)
		entries += s->pdos[i]->entry_count;
	x->n_syncs = 0;
	x->pdos = calloc(s->pdo_count + 1, sizeof(*x->pdos));
	x->entries = calloc(entries + 1, sizeof(*x->entries));
	return x->pdos && x->entries ? 0 : -ENOMEM;
}

static void layout_sm(struct layout *x, const struct load *l, const struct plan *p,
		      unsigned int sm, ec_pdo_info_t **pdo, ec_pdo_entry_info_t **entry)
{
	ec_sync_info_t *sync = &x->syncs[x->n_syncs];

	*sync = (ec_sync_info_t){
		.index = (uint8_t)sm, .dir = load_direction(l, p, sm), .pdos = *pdo,
	};
	for (size_t i = 0; i < p->s->pdo_count; i++) {
		const struct ecb_pdo *from = p->s->pdos[i];

		if (from->sm != sm)
			continue;
		*(*pdo)++ = (ec_pdo_info_t){
			.index = from->index, .n_entries = (unsigned int)from->entry_count,
			.entries = *entry,
		};
		sync->n_pdos++;
		for (size_t k = 0; k < from->entry_count; k++)
			*(*entry)++ = (ec_pdo_entry_info_t){
				.index = ECB_INDEX(from->entries[k]->object),
				.subindex = ECB_SUBINDEX(from->entries[k]->object),
				.bit_length = from->entries[k]->bits,
			};
	}
	x->n_syncs += sync->n_pdos > 0;
}

/* The PDOs of the file are all that the slave has: other SyncManagers get none. */
static int empty_others(struct layout *x, const struct load *l, const struct plan *p)
{
	unsigned int listed = 0;
	ec_slave_info_t info;
	int ret;

	for (unsigned int i = 0; i < x->n_syncs; i++)
		listed |= 1U << x->syncs[i].index;
	/* offline the calls do that */
	if (!p->there || l->offline)
		return 0;
	ret = ecrt_master_get_slave(l->m, (uint16_t)p->position, &info);
	for (unsigned int sm = 0; sm < info.sync_count && !ret; sm++) {
		ec_sync_info_t *s = &x->syncs[x->n_syncs];

		if (listed >> sm & 1 || sm >= EC_MAX_SYNC_MANAGERS)
			continue;
		ret = ecrt_master_get_sync_manager(l->m, (uint16_t)p->position, (uint8_t)sm, s);
		if (ret || !s->n_pdos)
			continue;
		s->n_pdos = 0;
		s->watchdog_mode = EC_WD_DEFAULT;
		x->n_syncs++;
	}
	return ret;
}

static int configure_pdos(struct load *l, struct plan *p)
{
	struct layout x;
	ec_pdo_entry_info_t *entry;
	ec_pdo_info_t *pdo;
	int ret;

	if (!p->s->pdo_count)
		return 0;
	ret = layout_init(&x, p->s);
	entry = x.entries;
	pdo = x.pdos;
	for (unsigned int sm = 0; sm < EC_MAX_SYNC_MANAGERS && !ret; sm++)
		layout_sm(&x, l, p, sm, &pdo, &entry);
	if (!ret)
		ret = empty_others(&x, l, p);
	if (!ret)
		ret = l->calls->pdos(p->sc, x.n_syncs, x.syncs);
	free(x.pdos);
	free(x.entries);
	return ret ? load_failed(l, p->s->line, ret, "slave '%s': cannot configure its PDOs",
				 p->s->name) : 0;
}

static int startup(const struct load *l, struct plan *p, const struct ecb_command *c)
{
	uint8_t number[8];
	const struct ecb_bytes bytes = ecb_command_data(c, number);
	const uint8_t *data = bytes.data;
	size_t size = bytes.size;
	ec_command_t command = { .size = size, .data = data };

	/* SDOs of the step to SAFEOP are written before the PDOs, which they may change */
	if (c->at == ECB_AT_SAFEOP && c->sdo != ECB_NONE32)
		return c->complete ?
			l->calls->complete_sdo(p->sc, ECB_INDEX(c->sdo), data, size) :
			l->calls->sdo(p->sc, ECB_INDEX(c->sdo), ECB_SUBINDEX(c->sdo), data,
					      size);
	if (c->at == ECB_AT_SAFEOP && c->idn != ECB_NONE32)
		return l->calls->idn(p->sc, c->drive, (uint16_t)c->idn, EC_AL_STATE_PREOP,
					     data, size);
	if (c->sdo != ECB_NONE32) {
		command.kind = EC_COMMAND_SDO;
		command.index = ECB_INDEX(c->sdo);
		command.subindex = ECB_SUBINDEX(c->sdo);
		command.complete = c->complete;
	} else if (c->idn != ECB_NONE32) {
		command.kind = EC_COMMAND_IDN;
		command.index = (uint16_t)c->idn;
		command.subindex = c->drive;
	} else {
		command.kind = EC_COMMAND_REG;
		command.index = (uint16_t)c->reg;
	}
	return l->calls->command(p->sc, steps[c->at], &command);
}

static uint32_t ident_of(const struct ecb_slave *s, unsigned int slot)
{
	for (size_t i = 0; i < s->module_count; i++)
		if (s->modules[i]->slot == slot)
			return s->modules[i]->ident;
	return 0;
}

static unsigned int last_slot(const struct ecb_slave *s)
{
	unsigned int last = 0;

	for (size_t i = 0; i < s->module_count; i++)
		if (s->modules[i]->slot > last)
			last = s->modules[i]->slot;
	return last;
}

/* The configured modules, written before all else, each time that the slave is configured. */
static int write_modules(const struct load *l, struct plan *p)
{
	int ret = 0;

	for (unsigned int slot = 1; slot <= last_slot(p->s) && !ret; slot++)
		ret = l->calls->sdo32(p->sc, 0xf030, (uint8_t)slot,
					      ident_of(p->s, slot));
	return ret;
}

/* With another module in a slot the slave stays in PREOP, and the reason names it. */
static int expect_modules(const struct load *l, struct plan *p)
{
	uint8_t ident[4];
	ec_command_t c = {
		.kind = EC_COMMAND_SDO, .index = 0xf050, .size = sizeof(ident), .expect = ident,
	};
	int ret = 0;

	for (unsigned int slot = 1; slot <= last_slot(p->s) && !ret; slot++) {
		EC_WRITE_U32(ident, ident_of(p->s, slot));
		c.subindex = (uint8_t)slot;
		ret = l->calls->command(p->sc, EC_STEP_PS, &c);
	}
	return ret;
}

static int limits(const struct load *l, struct plan *p, const struct ecb_timeouts *t)
{
	int ret = 0;

	if (t->init_preop)
		ret = l->calls->state_timeout(p->sc, EC_AL_STATE_INIT, EC_AL_STATE_PREOP,
						      load_ms(t->init_preop));
	if (t->preop_safeop && !ret)
		ret = l->calls->state_timeout(p->sc, EC_AL_STATE_PREOP, EC_AL_STATE_SAFEOP,
						      load_ms(t->preop_safeop));
	if (t->safeop_op && !ret)
		ret = l->calls->state_timeout(p->sc, EC_AL_STATE_SAFEOP, EC_AL_STATE_OP,
						      load_ms(t->safeop_op));
	return t->mailbox && !ret ? l->calls->sdo_timeout(p->sc, load_ms(t->mailbox)) :
		ret;
}

int load_configure(struct load *l, struct plan *p)
{
	const struct ecb_slave *s = p->s;
	const struct ecb_clock *k = s->clock;
	int ret = 0;

	if (s->revision && s->revision_rule == ECB_REVISION_EQUAL)
		ret = l->calls->flag(p->sc, "ExpectedRevision", (int32_t)s->revision);
	if (s->serial && p->group >= 0 && !ret)
		ret = l->calls->flag(p->sc, "ExpectedSerial", (int32_t)s->serial);
	if (ret)
		return load_failed(l, s->line, ret, "slave '%s': cannot configure it", s->name);
	if (s->write_modules)
		ret = write_modules(l, p);
	if (!ret)
		ret = expect_modules(l, p);
	if (ret)
		return load_failed(l, s->line, ret, "slave '%s': cannot configure its modules",
				   s->name);
	for (size_t i = 0; i < s->startup_count; i++) {
		ret = startup(l, p, s->startup[i]);
		if (ret)
			return load_failed(l, s->startup[i]->line, ret,
					   "slave '%s': cannot add a startup command", s->name);
	}
	if (s->timeouts)
		ret = limits(l, p, s->timeouts);
	if (ret)
		return load_failed(l, s->timeouts->line, ret, "slave '%s': cannot set its time limits",
				   s->name);
	if (k)
		ret = l->calls->dc(p->sc, k->assign_activate, (uint32_t)k->sync0,
					   (int32_t)k->sync0_shift, (uint32_t)k->sync1, 0);
	if (ret)
		return load_failed(l, k->line, ret, "slave '%s': cannot configure its clock",
				   s->name);
	return configure_pdos(l, p);
}
