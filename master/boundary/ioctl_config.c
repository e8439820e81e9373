// SPDX-License-Identifier: GPL-2.0-only
/* Commands that show what the application has configured. */
#include "../cycle/units_hold.h"
#include "../config/config.h"
#include "../cycle/cycle_thread.h"
#include "../config/domain.h"
#include "../config/group.h"
#include "ioctl.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../config/why.h"

#define WALK	64	/* list entries, */
#define PIECE	4096	/* and bytes to copy, at once */

/* 0: not configured */
static u16 reg(const struct ec_config *c, u16 index)
{
	const struct ec_startup *u = ec_startup_find(c, EC_STARTUP_REG, index);

	return u ? get_unaligned_le16(u->data) : 0;
}

int ec_ioc_config(struct ec_call *call)
{
	struct ec_ioc_config *i = call->arg;
	struct ec_config *c = call->config;

	i->alias = c->alias;
	i->position = c->position;
	i->vendor_id = c->vendor;
	i->product_code = c->product;
	i->slave_position = c->slave ? c->slave->position : -1;
	i->device = c->slave ? c->slave->device : 0;
	i->al_status = c->slave ? READ_ONCE(c->slave->al.status) : 0;
	i->watchdog_divider = reg(c, EC_REG_WD_DIVIDER);
	i->watchdog_intervals = reg(c, EC_REG_WD_SM);
	i->dc_assign_activate = c->sync.assign;
	memcpy(i->dc_cycle, c->sync.period, sizeof(i->dc_cycle));
	memcpy(i->dc_shift, c->sync.shift, sizeof(i->dc_shift));
	i->sdo_count = c->n_startup[EC_STARTUP_SDO];
	i->state = ec_config_status(c);
	i->flag_count = c->n_flags;
	i->group = c->group ? c->group->index + 1 : 0;
	return 0;
}

int ec_ioc_config_sm(struct ec_call *call)
{
	struct ec_ioc_config_sm *i = call->arg;
	struct ec_config *c = call->config;

	if (i->sm >= EC_MAX_SM)
		return ec_refuse(call, -ENOENT, "SyncManagers are 0 to %u", EC_MAX_SM - 1);
	i->dir = c->sm[i->sm].dir;
	i->watchdog = c->sm[i->sm].watchdog;
	i->pdo_count = c->sm[i->sm].pdos.n;
	return 0;
}

static int find_pdo(struct ec_call *call, u8 sm, u32 pos, const struct ec_pdo **p)
{
	const struct ec_config *c = call->config;

	if (sm >= EC_MAX_SM || pos >= c->sm[sm].pdos.n)
		return ec_refuse(call, -ENOENT, "no PDO %u at SM%u", pos, sm);
	*p = &c->sm[sm].pdos.pdos[pos];
	return 0;
}

int ec_ioc_config_pdo(struct ec_call *call)
{
	struct ec_ioc_config_pdo *i = call->arg;
	const struct ec_pdo *p;
	int ret = find_pdo(call, i->sm, i->pdo_pos, &p);

	if (ret)
		return ret;
	i->pdo_index = p->index;
	i->entry_count = p->n_entries;
	return 0;
}

int ec_ioc_config_entry(struct ec_call *call)
{
	struct ec_ioc_config_entry *i = call->arg;
	const struct ec_pdo *p;
	int ret = find_pdo(call, i->sm, i->pdo_pos, &p);

	if (ret)
		return ret;
	if (i->entry_pos >= p->n_entries)
		return ec_refuse(call, -ENOENT, "PDO 0x%04x has %u entries", p->index,
				 p->n_entries);
	i->entry_index = p->entries[i->entry_pos].index;
	i->subindex = p->entries[i->entry_pos].sub;
	i->bits = p->entries[i->entry_pos].bits;
	return 0;
}

/**
 * ec_ioc_copy_out() - copy to the buffer of a command in pieces, up to its size, with pauses
 * @call: command, in a show section
 * @from: of what is shown
 * @size: bytes
 *
 * Context: Process. May sleep.
 * Return: 0 within the same show section, or as ec_ioc_pause().
 */
int ec_ioc_copy_out(struct ec_call *call, const void *from, u32 size)
{
	u32 pos;
	int ret;

	size = min(size, call->size);
	for (pos = 0; pos < size; pos += PIECE) {
		ret = pos ? ec_ioc_pause(call) : 0;
		if (ret)
			return ret;
		memcpy(call->data + pos, from + pos, min(size - pos, PIECE));
	}
	return 0;
}

/* Return: 0 within the same show section; -ENOENT; or as ec_ioc_pause(). */
static int find_startup(struct ec_call *call, u8 type, u32 n, const struct ec_startup **found)
{
	const struct ec_startup *u;
	u32 k = 0, walked = 0;
	int ret;

	list_for_each_entry(u, &call->config->startup, list) {
		if (u->type == type && k++ == n) {
			*found = u;
			return 0;
		}
		ret = ++walked % WALK ? 0 : ec_ioc_pause(call);
		if (ret)
			return ret;
	}
	return ec_refuse(call, -ENOENT, "configuration %u has %u %ss", call->config->index,
			 call->config->n_startup[type],
			 type == EC_STARTUP_SDO ? "startup SDO" :
			 type == EC_STARTUP_IDN ? "startup IDN" : "command");
}

int ec_ioc_config_sdo(struct ec_call *call)
{
	struct ec_ioc_config_sdo *i = call->arg;
	const struct ec_startup *u = NULL;
	int ret = find_startup(call, EC_STARTUP_SDO, i->sdo_pos, &u);

	if (ret)
		return ret;
	i->flags = u->complete ? EC_SDO_FLAG_COMPLETE : 0;
	i->sdo_index = u->index;
	i->subindex = u->sub;
	i->size = u->size;
	return ec_ioc_copy_out(call, u->data, u->size);
}

int ec_ioc_config_idn(struct ec_call *call)
{
	struct ec_ioc_config_idn *i = call->arg;
	const struct ec_startup *u = NULL;
	int ret = find_startup(call, EC_STARTUP_IDN, i->idn_pos, &u);

	if (ret)
		return ret;
	i->idn = u->index;
	i->drive = u->sub;
	i->state = EC_TRANSITION_FROM(u->transition);
	i->size = u->size;
	return ec_ioc_copy_out(call, u->data, u->size);
}

int ec_ioc_config_command(struct ec_call *call)
{
	static const u8 kinds[EC_STARTUP_TYPES] = {
		[EC_STARTUP_SDO] = EC_WRITE_KIND_SDO, [EC_STARTUP_IDN] = EC_WRITE_KIND_IDN,
		[EC_STARTUP_REG] = EC_WRITE_KIND_REG,
	};
	struct ec_ioc_config_command *i = call->arg;
	const struct ec_startup *u = NULL;
	int ret = find_startup(call, EC_STARTUP_COMMAND, i->command_pos, &u);

	if (ret)
		return ret;
	i->flags = (u->how & EC_STARTUP_WRITES ? EC_COMMAND_FLAG_WRITE : 0) |
		   (u->how & EC_STARTUP_CHECKS ? EC_COMMAND_FLAG_CHECK : 0) |
		   (u->complete ? EC_COMMAND_FLAG_COMPLETE : 0);
	i->object = u->index;
	i->subindex = u->sub;
	i->kind = kinds[u->kind];
	i->from = EC_TRANSITION_FROM(u->transition);
	i->to = EC_TRANSITION_TO(u->transition);
	i->timeout_ms = u->timeout_ms;
	i->size = u->size;
	return ec_ioc_copy_out(call, u->data, u->size);
}

int ec_ioc_config_flag(struct ec_call *call)
{
	struct ec_ioc_config_flag *i = call->arg;
	struct ec_config_flag *flag;
	u32 k = 0;

	list_for_each_entry(flag, &call->config->flags, list) {
		if (k++ != i->flag_pos)
			continue;
		i->value = flag->value;
		memcpy(i->key, flag->key, sizeof(i->key));
		return 0;
	}
	return ec_refuse(call, -ENOENT, "there are %u flags, not %u", call->config->n_flags,
			 i->flag_pos + 1);
}

int ec_ioc_domain(struct ec_call *call)
{
	struct ec_ioc_domain *i = call->arg;
	struct ec_domain *d = call->domain;

	i->size = d->size;
	i->logical = d->offset;
	i->expected = READ_ONCE(d->expected);
	i->fmmu_count = d->n_fmmus;
	i->options = d->options;
	i->max_age = d->max_age;
	if (ec_domain_session(d)->wanted.active) {
		const struct ec_cycle *c = &ec_domain_session(d)->cycle;
		const struct ec_status *st = c->shared->status;

		i->datagram_count = d->n_dgrams;
		i->datagram_bytes = d->dgram_bytes;
		i->working_counter = READ_ONCE(st->domains[d->index].working_counter);
		i->age = READ_ONCE(st->domains[d->index].age);
		i->wc_state = READ_ONCE(st->domains[d->index].wc_state);
		if (!(ec_read64(&c->sent_once) & BIT_ULL(d->index)))
			i->unsent = READ_ONCE(c->send);
	}
	return 0;
}

int ec_ioc_domain_fmmu(struct ec_call *call)
{
	struct ec_ioc_domain_fmmu *i = call->arg;
	struct ec_domain *d = call->domain;
	const struct ec_config_fmmu *fm;

	if (i->fmmu >= d->n_fmmus)
		return ec_refuse(call, -ENOENT, "domain %u has %u FMMUs", i->index, d->n_fmmus);
	fm = d->fmmus[i->fmmu].fmmu;
	i->alias = d->fmmus[i->fmmu].config->alias;
	i->position = d->fmmus[i->fmmu].config->position;
	i->config = d->fmmus[i->fmmu].config->index + 1;
	i->sm = fm->sm;
	i->dir = fm->dir;
	i->offset = fm->offset;
	i->size = fm->size;
	i->logical = d->offset + fm->logical;
	return 0;
}

int ec_ioc_domain_data(struct ec_call *call)
{
	struct ec_ioc_domain_data *i = call->arg;
	struct ec_domain *d = call->domain;
	u32 pos;
	int ret;

	if (!ec_domain_session(d)->wanted.active)
		return ec_refuse(call, -ENOENT, "the application has not activated the master");
	i->size = min_t(u32, call->size, d->size);
	for (pos = 0; pos < i->size; pos += PIECE) {
		u32 n = min(i->size - pos, PIECE);

		ret = pos ? ec_ioc_pause(call) : 0;
		if (ret)
			return ret;
		memcpy(call->data + pos, ec_session_domain_data(d) + pos, n);
		ec_cycle_thread_outputs(&ec_domain_session(d)->cycle, call->data + pos,
					d->offset + pos, n);
		ec_units_show(&ec_domain_session(d)->cycle, d, call->data + pos, pos, n);
	}
	return 0;
}

int ec_ioc_config_why(struct ec_call *call)
{
	struct ec_ioc_config_why *i = call->arg;

	i->len = ec_config_why(call->config, i->text, sizeof(i->text), &i->cause);
	return 0;
}
