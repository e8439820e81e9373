// SPDX-License-Identifier: GPL-2.0-only
/*
 * Random events at all ports of a random tree, during the scan, the configuration, the set-up of
 * clocks and in OP, beside objects and files: who is not cut off does not notice, and afterwards
 * list and neighbors are those of the model.
 */
#include "random.h"

#define EVENTS	250	/* of a run: a case has 300 s, also of virtual time */

/* The list is that of the model, and has all that have a path. */
static void expect_graph(struct bus *b, const char *after)
{
	u8 mark[RANDOM_SLAVES];

	KUNIT_EXPECT_EQ_MSG(b->test, port_events_reached(b->sim, ktime_get_ns(), -1, mark),
			    b->sim->route[0].steps, "after %s: let in", after);
	bus_expect_graph(b, after);
}

static void let_pass(struct random_run *r, u32 ms)
{
	if (r->c)
		cyc_run(r->c, ms);
	else
		msleep(ms);
}

static void begin_events(struct random_run *r, bool hosts)
{
	u64 events = r->e.events, bursts = r->e.bursts;

	port_events_init(&r->e, r->b->sim, r->seed + (r->c ? 0 : 1000000), ktime_get_ns());
	r->e.events = events;
	r->e.bursts = bursts;
	r->e.no_hosts = !hosts;
}

/* Events while the bus is scanned, without an application: everything is found then. */
static void events_in_scan(struct random_run *r)
{
	u64 until = ktime_get_ns() + 4 * NSEC_PER_SEC;

	begin_events(r, false);
	while (ktime_get_ns() < until) {
		port_events_plan(&r->e, ktime_get_ns());
		usleep_range(2000, 2001);
	}
	port_events_stop(&r->e);
	let_pass(r, 1000);
	bus_idle(r->b);
	expect_graph(r->b, "events in the scan");
	port_events_restore(&r->e, ktime_get_ns());
	let_pass(r, 1000);
	bus_idle(r->b);
	expect_graph(r->b, "the scan");
	/* what failed is tried again after 250 ms, 500 ms ... */
	KUNIT_ASSERT_NE(r->b->test, bus_wait(r->b, r->n, EC_AL_PREOP, 10000), ~0ull);
}

/* Events for a while; then the list is the bus, and again once all is as in the beginning. */
static void events_in_operation(struct random_run *r)
{
	u64 until = ktime_get_ns() + 80 * NSEC_PER_SEC;

	begin_events(r, r->hosts);
	random_users_begin(r);
	while (r->e.events < EVENTS && ktime_get_ns() < until)
		cyc_run(r->c, 100);
	port_events_stop(&r->e);
	cyc_run(r->c, 1000);
	r->rescan_ns = ~0ull;
	random_users_end(r);
	/* a contact that was lost often is tried after a minute of link */
	cyc_run(r->c, 70000);
	expect_graph(r->b, "events");
	port_events_restore(&r->e, ktime_get_ns());
	cyc_run(r->c, 75000);
	expect_graph(r->b, "the end");
	KUNIT_EXPECT_TRUE_MSG(r->b->test, cyc_all_op(r->c), "not all in OP at the end");
}

static void start(struct random_run *r, struct kunit *test)
{
	r->b = bus_new(test, random_tree(r, test));
	if (r->early == RANDOM_FROM_SCAN) {
		bus_plug(r->b);
		events_in_scan(r);
	} else {
		bus_plug_scanned(r->b, r->n, 60000);
	}
	bus_idle(r->b);
	random_application(r);
	if (r->early == RANDOM_IN_OP) {
		KUNIT_ASSERT_NE(test, cyc_wait_op(r->c, 20000), ~0ull);
		cyc_run(r->c, 200);
	}
}

static void random_events(struct kunit *test, u64 seed)
{
	struct random_run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	static const char * const from[] = {
		[RANDOM_IN_OP] = "OP", [RANDOM_FROM_START] = "start", [RANDOM_FROM_SCAN] = "scan",
	};
	const struct random_user *u;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->seed = seed;
	start(r, test);
	events_in_operation(r);
	u = r->user;
	KUNIT_EXPECT_EQ(test, r->broken, 0ull);
	KUNIT_EXPECT_EQ(test, r->wrong, 0ull);
	KUNIT_EXPECT_EQ(test, u[0].bad + u[1].bad, 0u);
	bus_figure("seed %llu, %u slaves%s%s, from %s: %llu random events, %llu bursts among them; of %llu checks of slaves that were not cut off %llu failed, %llu values and counters wrong, %llu by events that met a frame (%llu cycles), %llu with the address of a trial (at most %u cycles); objects %u good, %u cut off, %u failed, files %u, %u, %u",
		   seed, r->n, r->clocks ? ", clocks" : "", r->hosts ? ", hosts" : "",
		   from[r->early], r->e.events, r->e.bursts, r->checked, r->broken, r->wrong,
		   r->in_flight, r->met, r->readdressed, r->longest, u[0].good, u[0].cut, u[0].bad,
		   u[1].good, u[1].cut, u[1].bad);
	for (i = 0; i < RANDOM_SLAVES; i++)
		if (r->s[i].slave)
			ec_slave_unref(r->s[i].slave);
}

/* in "make check" one run, in "make check-long" EC_UML_ARGS=random_kunit.runs=80 */
static uint runs = 1;
module_param(runs, uint, 0444);
MODULE_PARM_DESC(runs, "Runs of 250 events, each with a seed of its own, at most 400");

static uint first;
module_param(first, uint, 0444);
MODULE_PARM_DESC(first, "Seed of the first run");

static const char seeds[400];	/* their addresses count */

static const void *seed_gen_params(const void *prev, char *desc)
{
	const char *next = prev ? (const char *)prev + 1 : seeds;

	if (next >= seeds + min_t(uint, runs, ARRAY_SIZE(seeds)))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "seed %u", first + (uint)(next - seeds));
	return next;
}

static void random_events_at_all_ports(struct kunit *test)
{
	random_events(test, first + (u64)((const char *)test->param_value - seeds));
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(random_events_at_all_ports, seed_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_random", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
