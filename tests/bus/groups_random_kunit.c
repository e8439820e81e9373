// SPDX-License-Identifier: GPL-2.0-only
/*
 * Hot connect events at random: tools come and go at any free port, four of them alike but for
 * their identification, two with the same one, some wired the wrong way, and strangers. Never does
 * a device get the configuration of another one.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave h0 EK1100\nslave h1 EK1100\nslave h2 EK1100\nslave f1 drive in=8 out=8\n"
	"branch none\nslave t0 drive in=8 out=8 id=11\n"
	"branch none\nslave t1 drive in=8 out=8 id=12\n"
	"branch none\nslave t2 drive in=8 out=8 id=13\n"
	"branch none\nslave t3 drive in=8 out=8 id=14\n"
	"branch none\nslave t4 drive in=8 out=8 id=20\nslave u4 drive in=8 out=8\n"
	"branch none\nslave t5 drive in=8 out=8 id=20\nslave u5 drive in=8 out=8\n"
	"branch none\nslave t6 drive in=8 out=8 id=21 vendor=77 product=6\n"
	"branch none\nslave t7 drive in=8 out=8 id=22 vendor=77 product=7\n"
	"branch none\nslave x0 drive in=8 out=8\n";

#define FIXED	4
#define TOOLS	9	/* with the stranger, which has no group */
#define GROUPS	8

/* Index of each in the segment, and what the application expects; 20 is there twice. */
static const struct tool {
	const char *name;
	u32 index;
	u16 id;
} tools[TOOLS] = {
	{ "t0", 4, 11 }, { "t1", 5, 12 }, { "t2", 6, 13 }, { "t3", 7, 14 }, { "t4", 8, 20 },
	{ "t5", 10, 20 }, { "t6", 12, 21 }, { "t7", 13, 22 }, { "x0", 14, 0 },
};

/* the eighth group is never connected */
static const u16 ids[GROUPS] = { 11, 12, 13, 14, 20, 21, 22, 23 };

static const char * const free_ports[] = { "h0.2", "h1.2", "h2.2", "f1.1" };

/**
 * struct run - a run and its counts
 * @c: application
 * @rng: random numbers
 * @at: free port + 1 where each tool is, 0: nowhere
 * @used: by which tool + 1 a free port is
 * @head: configuration of the head of each group
 * @incomplete: cycles in which the domain of the fixed drive was not complete
 * @events: so far
 * @op: the group was in OP at the last check
 * @started: times that a group came to OP
 * @wrong: configurations with a device that is not theirs, and strangers in operation
 */
struct run {
	struct cyc *c;
	struct rnd_state rng;
	u32 at[TOOLS];
	u32 used[ARRAY_SIZE(free_ports)];
	u32 head[GROUPS];
	bool op[GROUPS];
	u64 incomplete;
	u32 events;
	u32 started;
	u32 wrong;
};

static u32 below(struct run *r, u32 n)
{
	return prandom_u32_state(&r->rng) % n;
}

static struct ec_esc *esc_of(struct bus *b, const struct ec_slave *s)
{
	u32 i;

	for (i = 0; i < b->sim->count; i++)
		if (b->sim->route[0].steps && bus_esc(b, i)->route_pos[0] >= 0 &&
		    get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION) == s->station)
			return bus_esc(b, i);
	return NULL;
}

/* Each configuration with a slave has the device with the identification of its group. */
static void check(struct run *r)
{
	struct bus *b = r->c->b;
	u32 g, i;

	for (g = 0; g < GROUPS; g++) {
		const struct ec_slave *s = bus_config(b, r->head[g])->slave;
		const struct ec_esc *esc = s && !READ_ONCE(s->stop.gone) ? esc_of(b, s) : NULL;

		bool op = esc && esc->mem[EC_REG_AL_STATUS] == EC_AL_OP;

		r->started += op && !r->op[g];
		r->op[g] = op;
		/* unplugged, and not noticed so far */
		if (!esc)
			continue;
		for (i = 0; i < TOOLS && bus_esc(b, tools[i].index) != esc; i++)
			;
		if (i == TOOLS || tools[i].id != ids[g])
			r->wrong++;
	}
	r->wrong += bus_esc(b, tools[TOOLS - 1].index)->mem[EC_REG_AL_STATUS] > EC_AL_PREOP;
}

static void look(struct cyc *c)
{
	struct run *r = c->ctx;

	r->incomplete += cyc_state(c, 0)->wc_state != EC_STATUS_WC_COMPLETE;
}

/* A tool is unplugged, or plugged in at a free port, one of ten by its port 1. */
static void event(struct run *r)
{
	u32 t = below(r, TOOLS), p = below(r, ARRAY_SIZE(free_ports));
	char line[48];

	if (r->at[t]) {
		p = r->at[t] - 1;
		r->at[t] = 0;
		r->used[p] = 0;
		snprintf(line, sizeof(line), "unplug %s", free_ports[p]);
	} else if (!r->used[p]) {
		/* those of two members have a free port at the second one only */
		u32 port = tools[t].id != 20 && !below(r, 10);

		r->at[t] = p + 1;
		r->used[p] = t + 1;
		snprintf(line, sizeof(line), "plug %s %s.%u", free_ports[p], tools[t].name, port);
	} else {
		return;
	}
	bus_command(r->c->b, line);
	r->events++;
}

static u32 add_member(struct run *r, u32 group, u16 member, u32 vendor, u32 product)
{
	struct ec_ioc_group_config m = {
		.group = group, .member = member, .vendor_id = vendor, .product_code = product,
	};
	struct ec_ioc_sc_sync sm = { .sm = 2, .dir = EC_CFG_DIR_OUTPUT };
	struct bus *b = r->c->b;

	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), 0, "%s",
			    b->app.reason);
	sm.config = m.index;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sm), 0);
	sm.sm = 3;
	sm.dir = EC_CFG_DIR_INPUT;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sm), 0);
	cyc_remap(r->c, m.index);
	cyc_map(r->c, m.index, 2, 1);
	cyc_map(r->c, m.index, 3, 1);
	return m.index;
}

static void add_groups(struct run *r)
{
	const struct ec_sii_info drive = bus_slave(r->c->b, FIXED - 1)->info;
	struct bus *b = r->c->b;
	u32 g;

	for (g = 0; g < GROUPS; g++) {
		struct ec_ioc_group i = {
			.by = EC_GROUP_BY_ID, .value = ids[g], .at = EC_UAPI_NONE32,
		};
		bool other = ids[g] > 20;

		snprintf(i.name, sizeof(i.name), "tool%u", ids[g]);
		KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_GROUP, &i), 0, "%s",
				    b->app.reason);
		r->head[g] = add_member(r, i.index, 0, other ? 77 : drive.vendor,
					other ? ids[g] - 15 : drive.product);
		if (ids[g] == 20)
			add_member(r, i.index, 1, drive.vendor, drive.product);
	}
}

#define EVENTS	100	/* of a run: a case has 300 s, also of virtual time */

/* in "make check" one run, in "make check-long" groups_random_kunit.runs=100 */
static uint runs = 1;
module_param(runs, uint, 0444);
MODULE_PARM_DESC(runs, "Runs of 100 events, each with a seed of its own, at most 400");

static const char seeds[400];	/* their addresses count */

static const void *seed_gen_params(const void *prev, char *desc)
{
	const char *next = prev ? (const char *)prev + 1 : seeds;

	if (next >= seeds + min_t(uint, runs, ARRAY_SIZE(seeds)))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "seed %d", (int)(next - seeds));
	return next;
}

static void groups_random_events(struct kunit *test)
{
	struct run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	struct bus *b = bus_up(test, text, FIXED);
	u64 seed = (const char *)test->param_value - seeds;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	prandom_seed_state(&r->rng, seed);
	bus_idle(b);
	r->c = cyc_new(b, 1000);
	cyc_domain(r->c);
	cyc_domain(r->c);
	add_groups(r);
	cyc_map_all(r->c, 0, FIXED, 0);
	cyc_activate(r->c);
	cyc_run(r->c, 1000);
	KUNIT_EXPECT_EQ(test, cyc_state(r->c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
	r->c->ctx = r;
	r->c->each = look;
	while (r->events < EVENTS) {
		event(r);
		for (i = below(r, 30); i < 30; i++) {
			cyc_run(r->c, 1 + below(r, 100));
			check(r);
		}
	}
	bus_figure("%u hot connect events with %u groups, seed %llu: %u times a group came to OP, %u wrong devices, %llu of %llu cycles of the fixed drive incomplete",
		   r->events, GROUPS, seed, r->started, r->wrong, r->incomplete, r->c->cycles);
	KUNIT_EXPECT_EQ(test, r->wrong, 0u);
	/* of two events one connects a tool, of which some are wired the wrong way, or twins */
	KUNIT_EXPECT_GT(test, r->started, r->events / 8);
	/* between cycles: no frame is in flight, see bus_random for those */
	KUNIT_EXPECT_EQ(test, r->incomplete, 0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(groups_random_events, seed_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_groups_random", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
