// SPDX-License-Identifier: GPL-2.0-only
#include "units.h"

u32 units_create(struct bus *b, struct ec_ioc_unit u, const char *name)
{
	strscpy(u.name, name, sizeof(u.name));
	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_UNIT, &u), 0, "%s", b->app.reason);
	return u.index;
}

u32 units_new(struct bus *b, const char *name, u32 policy, u32 flags)
{
	return units_create(b, (struct ec_ioc_unit){ .policy = policy, .flags = flags }, name);
}

void units_put(struct bus *b, u32 domain, u32 unit)
{
	struct ec_ioc_domain_unit d = { .domain = domain, .unit = unit };

	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_DOMAIN_UNIT, &d), 0, "%s",
			    b->app.reason);
}

/* As the application sees it. */
u32 units_state(struct bus *b, u32 unit)
{
	return READ_ONCE(bus_status(b)->units[unit]);
}

int units_authority(struct bus *b, u32 unit, u32 give)
{
	struct ec_ioc_unit_authority a = { .unit = unit, .authority = give };

	return ec_ioc(&b->app, EC_IOC_UNIT_AUTHORITY, &a);
}

/* All outputs of a slave, as it has them. */
u32 units_out(struct bus *b, u32 slave)
{
	char name[16];
	u32 v = 0, i;

	snprintf(name, sizeof(name), "s%u", slave + 1);
	for (i = 0; i < UNITS_BITS; i++)
		v |= (u32)ec_app_channel(bus_app(b, name), EC_APP_OUT, i) << i;
	return v;
}

void units_dead(struct bus *b, u32 slave, bool dead)
{
	bus_fault(b, EC_SIM_FAULT_DEAD, slave, -1, dead, 0);
}

struct bus *units_bus(struct kunit *test, u32 slaves)
{
	char text[96];
	struct bus *b;

	snprintf(text, sizeof(text), "segment seed=34\nrepeat %u slave s io in=%u out=%u\n", slaves,
		 UNITS_BITS, UNITS_BITS);
	b = bus_up(test, text, slaves);
	bus_idle(b);
	return b;
}

/* A ring of them. */
struct bus *units_ring(struct kunit *test, u32 slaves)
{
	char text[160];
	struct bus *b;

	snprintf(text, sizeof(text),
		 "segment seed=34\nrepeat %u slave s io in=%u out=%u cable=50 cpu=yes\n"
		 "wire s%u.1 -> master.1\n", slaves, UNITS_BITS, UNITS_BITS, slaves);
	b = bus_up(test, text, slaves);
	bus_idle(b);
	return b;
}

/* Each output has the number of the cycle, and the slave in its highest bits. */
static void count(struct cyc *c)
{
	u32 i;

	for (i = 0; i < bus_wanted(c->b)->n_configs; i++)
		put_unaligned_le32((i + 1) << 24 | (u32)(c->cycles + 1), cyc_pd(c, i, 0));
}

/* Slaves 0.. in @domains domains of @each slaves, not active yet. */
struct cyc *units_app(struct bus *b, u32 domains, u32 each)
{
	struct cyc *c = cyc_new(b, 1000);
	u32 i;

	for (i = 0; i < domains; i++)
		cyc_domain(c);
	for (i = 0; i < domains; i++)
		cyc_map_all(c, each * i, each, i);
	c->each = count;
	return c;
}

/* Events of units from number *@from on. */
u32 units_events(struct bus *b, u64 *from)
{
	struct ec_event_ring *ring = bus_events(b);
	struct ec_event e;
	u32 n = 0;

	while (ec_event_ring_get(ring, from, &e))
		n += e.kind == EC_EVENT_UNIT;
	return n;
}

/* As units_app(), and the kernel runs the cycle. */
struct kcyc *units_kernel(struct bus *b, u32 domains, u32 each, struct ec_ioc_cycle cfg)
{
	struct kcyc *a = kunit_kzalloc(b->test, sizeof(*a), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, a);
	a->c = units_app(b, domains, each);
	cfg.period_ns = KCYC_PERIOD_NS;
	cfg.cpu = -1;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	return a;
}

void units_begin(struct kcyc *a)
{
	KUNIT_ASSERT_EQ_MSG(a->c->b->test, kcyc_activate(a), 0, "%s", a->c->b->app.reason);
	kcyc_until_op(a);
	kcyc_wait_cycles(a, 50);
}

/* @value for all slaves, then given for @domains. */
void units_give(struct kcyc *a, u32 value, u64 domains)
{
	u32 i;

	for (i = 0; i < bus_wanted(a->c->b)->n_configs; i++)
		put_unaligned_le32(value, kcyc_outputs(a) +
				   (cyc_pd(a->c, i, 0) - cyc_data(a->c, 0)));
	kcyc_give_domains(a, domains);
}
