// SPDX-License-Identifier: GPL-2.0-only
/*
 * Random events at all ports of a tree while process data run: who is not cut off does not notice,
 * and afterwards the list is the bus.
 */
#include "cyc.h"
#include "tests/unit/port_events.h"

#define SLAVES	32	/* slaves of the segment */

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"slave a1 drive in=8 out=8\nslave a2 drive in=8 out=8\nslave a3 drive in=8 out=8\n"
	"branch hub 2\nslave mid EK1100\n"
	"slave b1 drive in=8 out=8\nslave b2 drive in=8 out=8\nslave b3 drive in=8 out=8\n"
	"branch mid 2\nslave low EK1100\n"
	"slave c1 drive in=8 out=8\nslave c2 drive in=8 out=8\n"
	"branch low 2\nslave d1 drive in=8 out=8\nslave d2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8\nslave x2 drive in=8 out=8\n";

#define N	13	/* connected at first */

/**
 * struct run - what the run has to keep
 * @e: events
 * @last_ns: time of the last check
 * @entitled: was in OP, and its path was whole since
 * @slave: its object then
 * @broken: slaves that were entitled, and were not in OP, or not in the list
 * @checked: slaves and cycles
 */
struct run {
	struct port_events e;
	u64 last_ns;
	bool entitled[SLAVES];
	struct ec_slave *slave[SLAVES];
	u32 broken;
	u64 checked;
};

static struct ec_slave *by_station(struct bus *b, u16 station)
{
	u32 i;

	for (i = 0; i < bus_n_slaves(b); i++)
		if (bus_slave(b, i)->station == station)
			return bus_slave(b, i);
	return NULL;
}

static bool is_well(const struct ec_esc *esc, const struct ec_slave *s)
{
	return esc->mem[EC_REG_AL_STATUS] == EC_AL_OP && !READ_ONCE(s->stop.gone) &&
	       !READ_ONCE(s->silent) && !READ_ONCE(s->reconfigure) &&
	       READ_ONCE(s->al_status) == EC_AL_OP;
}

/* A port that has closed itself at a loss of link stays closed when the link is back. */
static bool is_passed(struct bus *b, const struct ec_esc *esc)
{
	const struct ec_sim_route *r = &b->sim->route[0];
	u32 at = (u32)esc->route_pos[0];

	return at < r->steps && r->step[at].esc == esc;
}

static void check(struct bus *b, struct run *r, u32 i, bool whole)
{
	struct ec_esc *esc = bus_esc(b, i);
	struct ec_slave *s;

	if (!whole) {
		r->entitled[i] = false;
		return;
	}
	if (r->entitled[i]) {
		r->checked++;
		if (is_well(esc, r->slave[i]))
			return;
		s = r->slave[i];
		pr_info("# broken: slave %u of the segment, AL 0x%02x, gone %d silent %d, reconfigure %d, AL of the list 0x%02x, %llu ns\n",
			i, esc->mem[EC_REG_AL_STATUS], s->stop.gone, s->silent, s->reconfigure,
			s->al_status, ktime_get_ns());
		r->broken++;
		r->entitled[i] = false;
		return;
	}
	s = by_station(b, get_unaligned_le16(esc->mem + EC_REG_STATION));
	if (!s || !is_well(esc, s))
		return;
	if (r->slave[i])
		ec_slave_unref(r->slave[i]);
	r->slave[i] = ec_slave_ref(s);
	r->entitled[i] = true;
}

static void look(struct cyc *c)
{
	struct run *r = c->ctx;
	u64 now = ktime_get_ns();
	u8 mark[SLAVES];
	u32 i;

	port_events_plan(&r->e, now);
	port_events_reached(c->b->sim, r->last_ns, -1, mark);
	for (i = 0; i < c->b->sim->count; i++)
		check(c->b, r, i, mark[i] && is_passed(c->b, bus_esc(c->b, i)));
	r->last_ns = now;
}

/* The list is that of the model, and has all that have a path. */
static void expect_graph(struct bus *b, const char *after)
{
	u8 mark[SLAVES];

	KUNIT_EXPECT_EQ_MSG(b->test, port_events_reached(b->sim, ktime_get_ns(), -1, mark),
			    b->sim->route[0].steps, "after %s: let in", after);
	bus_expect_graph(b, after);
}

/* Events for a while; then the list is the bus, and again once all is as in the beginning. */
static void run_events(struct cyc *c, struct run *r, u64 seed, u32 events)
{
	struct bus *b = c->b;
	u64 until = ktime_get_ns() + 80 * NSEC_PER_SEC;

	port_events_init(&r->e, b->sim, seed, ktime_get_ns());
	/* a host at a port that has just lost its branch opens it, and takes all frames */
	r->e.no_hosts = true;
	r->last_ns = ktime_get_ns();
	c->ctx = r;
	c->each = look;
	while (r->e.events < events && ktime_get_ns() < until)
		cyc_run(c, 100);
	port_events_stop(&r->e);
	cyc_run(c, 1000);
	/* a contact that was lost often is tried after a minute of link */
	cyc_run(c, 70000);
	expect_graph(b, "events");
	c->each = NULL;
	port_events_restore(&r->e, ktime_get_ns());
	cyc_run(c, 75000);
	expect_graph(b, "the end");
}

static void random_events(struct kunit *test, u64 seed, u32 events)
{
	struct bus *b = bus_up(test, text, N);
	struct run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	struct cyc *c;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 3, 0);
	cyc_map_all(c, 5, 3, 0);
	cyc_map_all(c, 9, 2, 0);
	cyc_map_all(c, 11, 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 200);
	run_events(c, r, seed, events);
	KUNIT_EXPECT_EQ(test, r->broken, 0u);
	bus_figure("%llu random events, %llu bursts among them, seed %llu: of %llu checks of slaves that were not cut off %u failed",
		   r->e.events, r->e.bursts, seed, r->checked, r->broken);
	for (i = 0; i < SLAVES; i++)
		if (r->slave[i])
			ec_slave_unref(r->slave[i]);
}

/* in "make check" one run, in "make check-long" EC_UML_ARGS=random_kunit.runs=80 */
static uint runs = 1;
module_param(runs, uint, 0444);
MODULE_PARM_DESC(runs, "Runs of 250 events, each with a seed of its own, at most 400");

static const char seeds[400];	/* their addresses count */

static const void *seed_gen_params(const void *prev, char *desc)
{
	const char *next = prev ? (const char *)prev + 1 : seeds;

	if (next >= seeds + min_t(uint, runs, ARRAY_SIZE(seeds)))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "seed %d", (int)(next - seeds));
	return next;
}

static void random_events_at_all_ports(struct kunit *test)
{
	random_events(test, (const char *)test->param_value - seeds, 250);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(random_events_at_all_ports, seed_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_random", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
