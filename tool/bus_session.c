// SPDX-License-Identifier: GPL-2.0-only
/* What the running session has configured: clocks, sync units, hot connect groups. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "bus_int.h"

struct session {
	struct dev *d;
	struct ecb_bus *bus;
	struct ecb_master *m;
	const struct ect_list *list;
	struct ecb_slave **of;	/* slave of each configuration, NULL: none */
	u32 configs;
	int64_t interval;	/* ns */
};

static int no_memory(void)
{
	return fail("out of memory");
}

/* a name of a session may have '-' and '.', that of a file has neither */
static const char *name_of(struct session *x, const char *text)
{
	char word[ECB_WORD];

	snprintf(word, sizeof(word), "%s", text);
	for (char *c = word; *c; c++)
		if (*c == '-' || *c == '.')
			*c = '_';
	return ecb_bus_text(x->bus, word);
}

static struct ecb_slave *slave_of(const struct session *x, u64 device)
{
	const struct ect_slave *s;

	for (size_t i = 0; i < x->m->slave_count && (s = ect_list_get(x->list, i)); i++)
		if (s->device == device)
			return x->m->slaves[i];
	return NULL;
}

static int take_clock(struct session *x, const struct ect_config *c, struct ecb_slave *to)
{
	to->known |= ECB_KNOWN_CLOCK | ECB_KNOWN_SHIFT;
	if (!c->dc_assign_activate) {
		to->clock = NULL;
		return 0;
	}
	if (!to->clock && !ecb_clock_add(x->bus, to))
		return no_memory();
	to->clock->assign_activate = c->dc_assign_activate;
	to->clock->sync0 = c->dc_cycle[0];
	to->clock->sync0_shift = c->dc_shift[0];
	to->clock->sync1 = c->dc_cycle[1];
	return 0;
}

static struct ecb_group *group_of(struct session *x, const char *name)
{
	struct ecb_group *g;

	for (size_t i = 0; i < x->m->group_count; i++)
		if (!strcmp(x->m->groups[i]->name, name))
			return x->m->groups[i];
	g = ecb_group_add(x->bus, x->m);
	if (g)
		g->name = name;
	return g;
}

static int take_group(struct session *x, const struct ect_config *c, struct ecb_slave *to)
{
	const char *name = c->group ? name_of(x, c->group_name) : NULL;
	struct ecb_group *g = name ? group_of(x, name) : NULL;
	const struct ecb_slave *at = c->group_at < x->configs ? x->of[c->group_at] : NULL;

	to->known |= ECB_KNOWN_GROUP;
	if (!c->group)
		return 0;
	if (!g)
		return no_memory();
	to->group = g->name;
	g->mandatory = c->group_mandatory;
	if (c->group_by == ECT_GROUP_ALIAS)
		g->alias = c->group_value;
	else if (c->group_by == ECT_GROUP_ID)
		g->identification = c->group_value;
	if (at && !g->alias && !g->identification) {
		g->parent = at->name;
		g->port = c->group_port;
	}
	return 0;
}

static int take_configs(struct session *x)
{
	struct ect_config c = { .struct_size = sizeof(c) };
	int err = 0;

	for (u32 i = 0; i < x->configs && !err; i++) {
		err = ect_config_read(x->d->h, i, &c);
		x->of[i] = err || !c.device ? NULL : slave_of(x, c.device);
	}
	for (u32 i = 0; i < x->configs && !err; i++) {
		if (!x->of[i])
			continue;
		err = ect_config_read(x->d->h, i, &c);
		if (err)
			break;
		x->of[i]->state = c.al_status & 0x0f;
		if (take_clock(x, &c, x->of[i]) || take_group(x, &c, x->of[i]))
			return 1;
	}
	return err ? dev_fail(x->d, err, "Master%u: cannot read its session", x->d->master) : 0;
}

/* the slaves whose data a domain has are in its unit */
static void take_domain(struct session *x, unsigned int domain, const char *unit)
{
	struct ect_domain dom = { .struct_size = sizeof(dom) };

	if (ect_domain_read(x->d->h, domain, &dom))
		return;
	for (unsigned int i = 0; i < dom.fmmu_count; i++) {
		struct ect_fmmu f = { .struct_size = sizeof(f) };
		struct ecb_slave *s;

		if (ect_domain_fmmu(x->d->h, domain, i, &f) || !f.config || f.config > x->configs)
			continue;
		s = x->of[f.config - 1];
		if (s && !s->sync_unit)
			s->sync_unit = unit;
	}
}

static int take_unit(struct session *x, const struct ect_unit *u)
{
	struct ecb_unit *to = ecb_unit_add(x->bus, x->m);
	const char *name = to ? name_of(x, u->name) : NULL;

	if (!name)
		return no_memory();
	to->name = name;
	to->policy = u->policy <= ECB_POLICY_STOP ? u->policy : ECB_POLICY_CONTINUE;
	to->limit = u->limit ? u->limit : 1;
	to->lease = u->lease_cycles * x->interval;
	to->lease_holds = !!(u->flags & ECT_UNIT_LEASE_HOLD);
	to->repeats = u->repeats ? (uint8_t)u->repeats : 1;
	to->needs_authority = !!(u->flags & ECT_UNIT_AUTHORITY);
	to->offered = !!(u->flags & ECT_UNIT_OFFERED);
	for (unsigned int i = 0; i < 64; i++)
		if (u->domains >> i & 1)
			take_domain(x, i, name);
	return 0;
}

/* each until there is no more; an older module has none */
static int take_units(struct session *x)
{
	for (unsigned int i = 0; ; i++) {
		struct ect_unit u = { .struct_size = sizeof(u) };
		int err = ect_unit_read(x->d->h, i, &u);

		if (err == -ENOTTY)
			return 0;
		if (err == -ENOENT)
			break;
		if (err)
			return dev_fail(x->d, err, "Master%u: cannot read unit %u",
					x->d->master, i);
		if (take_unit(x, &u))
			return 1;
	}
	x->m->known |= ECB_KNOWN_UNIT;
	for (u32 i = 0; i < x->configs; i++)
		if (x->of[i])
			x->of[i]->known |= ECB_KNOWN_UNIT;
	return 0;
}

int bus_session(struct dev *d, struct ecb_bus *bus, const struct ect_list *list,
		struct ecb_master *m)
{
	struct ect_master master = { .struct_size = sizeof(master) };
	struct ect_cycle cycle = { .struct_size = sizeof(cycle) };
	struct session x = { .d = d, .bus = bus, .m = m, .list = list };
	int ret = 0;

	if (dev_master(d, &master))
		return 1;
	if (!master.active)
		return 0;
	x.configs = master.config_count;
	x.interval = 1000 * (int64_t)master.cycle_interval_us;
	if (!ect_cycle_read(d->h, &cycle) && cycle.interval_set) {
		x.interval = cycle.interval_ns;
		m->cycle = x.interval;
	}
	x.of = calloc(x.configs + 1u, sizeof(struct ecb_slave *));
	if (!x.of)
		return no_memory();
	ret = take_configs(&x) || take_units(&x);
	m->known |= ret ? 0 : ECB_KNOWN_GROUP;
	free(x.of);
	return ret;
}
