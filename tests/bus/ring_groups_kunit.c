// SPDX-License-Identifier: GPL-2.0-only
/*
 * Hot connect groups in a ring: one that is removed opens it, and the others run on. Each slave
 * has outputs of its own, which are compared in the slave.
 */
#include "ring.h"
#include "units.h"
#include "devices/sim/esc_int.h"
#include "master/bus/ring_break.h"

#define X	(BIT(2) | BIT(3))	/* slaves of the first group */
#define Y	BIT(4)			/* of the second one, behind it */
#define ALL	GENMASK(SLAVES - 1, 0)
#define RANDOM	100		/* events */

/* s1 s2 [s3 s4] [s5] s6 s7 s8: equal slaves, the heads have an alias */
static const char in_ring[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 2 slave s io in=32 out=32 cable=50\n"
	"slave s3 io in=32 out=32 cable=50 alias=60\n"
	"slave s4 io in=32 out=32 cable=50\n"
	"slave s5 io in=32 out=32 cable=50 alias=70\n"
	"slave s6 io in=32 out=32 cable=50\n"
	"slave s7 io in=32 out=32 cable=50\n"
	"slave s8 io in=32 out=32 cable=50\n"
	"wire s8.1 -> master.1 cable=50\n";

/**
 * struct hot - an application with groups in a ring
 * @c: its cycle
 * @by: EC_GROUP_BY_*: what both groups are known by
 * @flags: of both, EC_GROUP_FLAG_*
 * @second: product of the second member of the first group, 0: that of all others
 * @y: slave of the second group
 * @hub: mask of slaves that are couplers, without process data
 * @config: configuration of each slave
 * @ran: slaves that have to be in OP and get the outputs of each cycle
 * @wrong: outputs of another slave, so far
 * @old: outputs of another cycle, so far
 * @left: cycles in which one of @ran was not in OP
 * @incomplete: cycles in which the domain was not complete
 */
struct hot {
	struct cyc *c;
	u32 by;
	u32 flags;
	u32 second;
	u32 y;
	u32 hub;
	u32 config[SLAVES];
	u32 ran;
	u32 wrong;
	u32 old;
	u32 left;
	u32 incomplete;
};

/* Process data of the SyncManager 0 that a configuration has. */
static u8 *outputs_of(struct cyc *c, u32 config)
{
	const struct ec_config *sc = bus_config(c->b, config);
	u32 i = 0;

	while (sc->fmmus[i].sm)
		i++;
	return cyc_data(c, 0) + sc->fmmus[i].offset;
}

static void hot_look(struct cyc *c)
{
	struct hot *h = c->ctx;
	struct bus *b = c->b;
	u32 i;

	ec_sim_advance(b->sim, ktime_get_ns());
	h->incomplete += cyc_state(c, 0)->wc_state != EC_STATUS_WC_COMPLETE;
	for (i = 0; i < SLAVES; i++) {
		u32 is = units_out(b, i);

		h->wrong += is && (is & 0xff) != i + 1;
		if (!(h->ran & BIT(i)))
			continue;
		h->old += !(h->hub & BIT(i)) && is >> 8 != (u32)c->cycles;
		h->left += bus_esc(b, i)->mem[EC_REG_AL_STATUS] != EC_AL_OP;
	}
	for (i = 0; i < SLAVES; i++)
		if (!(h->hub & BIT(i)))
			put_unaligned_le32((u32)(c->cycles + 1) << 8 | (i + 1),
					   outputs_of(c, h->config[i]));
}

static u32 hot_group(struct hot *h, const char *name, u16 alias, u32 at)
{
	struct ec_ioc_group g = {
		.by = h->by, .flags = h->flags, .at = EC_UAPI_NONE32,
		.value = h->by == EC_GROUP_BY_PORT ? 0 : alias,
	};

	if (h->by == EC_GROUP_BY_PORT) {
		g.at = h->config[at];
		g.port = 1;
	}
	strscpy(g.name, name, sizeof(g.name));
	KUNIT_ASSERT_EQ_MSG(h->c->b->test, ec_ioc(&h->c->b->app, EC_IOC_GROUP, &g), 0, "%s",
			    h->c->b->app.reason);
	return g.index;
}

static void hot_member(struct hot *h, u32 slave, u32 group, u16 member)
{
	const struct ec_slave *like = bus_slave(h->c->b, 0);
	struct ec_ioc_group_config m = {
		.group = group, .member = member, .vendor_id = like->info.vendor,
		.product_code = slave == 3 && h->second ? h->second : like->info.product,
	};

	KUNIT_ASSERT_EQ_MSG(h->c->b->test, ec_ioc(&h->c->b->app, EC_IOC_GROUP_CONFIG, &m), 0,
			    "%s", h->c->b->app.reason);
	h->config[slave] = m.index;
	ring_map_like(h->c, m.index, like);
}

static void hot_plain(struct hot *h, u32 slave, u32 position)
{
	const struct ec_slave *like = bus_slave(h->c->b, 0);
	bool hub = h->hub & BIT(slave);
	struct ec_ioc_slave_config sc = {
		.position = position, .vendor_id = hub ? 2 : like->info.vendor,
		.product_code = hub ? 0x044c2c52 : like->info.product,
	};

	KUNIT_ASSERT_EQ_MSG(h->c->b->test, ec_ioc(&h->c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0,
			    "%s", h->c->b->app.reason);
	h->config[slave] = sc.index;
	if (!(h->hub & BIT(slave)))
		ring_map_like(h->c, sc.index, like);
}

/* An application with the two groups, and five slaves by ring position. */
static void hot_begin(struct hot *h, struct bus *b)
{
	u32 i, x, y, n;

	h->ran = 0;
	bus_idle(b);
	h->c = cyc_new(b, 1000);
	cyc_domain(h->c);
	for (i = 0; i < 2 && h->by == EC_GROUP_BY_PORT; i++)
		hot_plain(h, i, i);
	x = hot_group(h, "x", 60, 1);
	hot_member(h, 2, x, 0);
	hot_member(h, 3, x, 1);
	y = hot_group(h, "y", 70, 3);
	hot_member(h, h->y, y, 0);
	for (i = 0, n = 0; i < SLAVES; i++) {
		if (BIT(i) & X || i == h->y)
			continue;
		if (i >= 2 || h->by != EC_GROUP_BY_PORT)
			hot_plain(h, i, n);
		n++;
	}
	h->c->ctx = h;
	h->c->each = hot_look;
	cyc_activate(h->c);
}

static struct hot *hot_make(struct kunit *test, u32 by)
{
	struct hot *h = kunit_kzalloc(test, sizeof(*h), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, h);
	h->by = by;
	h->y = 4;
	return h;
}

static struct hot *hot_new(struct bus *b, u32 by)
{
	struct hot *h = hot_make(b->test, by);

	hot_begin(h, b);
	return h;
}

/*
 * After 1.2 s those of @with are in OP and get the outputs of each cycle, the others get none. What
 * is missing counts if it is in no group, or in a mandatory one.
 */
static void hot_settled(struct hot *h, u32 with, const char *when)
{
	struct bus *b = h->c->b;
	u32 groups = h->flags & EC_GROUP_FLAG_MANDATORY ? 0 : X | BIT(h->y);
	u32 counted = with | (ALL & ~groups);
	u32 i, before[SLAVES], got = 0, wkc = 3 * hweight32(with & ~h->hub);
	u32 expected = 3 * hweight32(counted & ~h->hub);

	cyc_run(h->c, 1200);
	KUNIT_EXPECT_EQ_MSG(b->test, h->left, 0u, "%s", when);
	h->ran = with;
	h->old = h->left = h->incomplete = 0;
	for (i = 0; i < SLAVES; i++)
		before[i] = units_out(b, i);
	cyc_run(h->c, 20);
	for (i = 0; i < SLAVES; i++)
		got |= units_out(b, i) != before[i] ? BIT(i) : 0;
	KUNIT_EXPECT_EQ_MSG(b->test, got, with & ~h->hub, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, h->wrong, 0u, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, h->old, 0u, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, h->left, 0u, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, h->incomplete, wkc < expected ? 20u : 0u, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, cyc_state(h->c, 0)->expected, expected, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, cyc_state(h->c, 0)->working_counter, wkc, "%s", when);
}

static void hot_commands(struct hot *h, const char *list)
{
	char line[128], *rest = line, *one;

	strscpy(line, list, sizeof(line));
	while ((one = strsep(&rest, ";")))
		bus_command(h->c->b, one);
}

static void hot_open(struct bus *b, u32 slave, u32 port, u32 next)
{
	u32 at[4];

	ec_ring_break_show(bus_table(b), &at[0], &at[1], &at[2], &at[3]);
	KUNIT_EXPECT_EQ(b->test, at[0], (u32)EC_RING_OPEN);
	KUNIT_EXPECT_EQ(b->test, at[1], slave);
	KUNIT_EXPECT_EQ(b->test, at[2], port);
	KUNIT_EXPECT_EQ(b->test, at[3], next);
}

/* what groups are known by, and whether they are mandatory */
struct sign {
	u32 by;
	u32 flags;
};

static const struct sign signs[] = {
	{ EC_GROUP_BY_ALIAS }, { EC_GROUP_BY_PORT },
	{ EC_GROUP_BY_ALIAS, EC_GROUP_FLAG_MANDATORY },
	{ EC_GROUP_BY_PORT, EC_GROUP_FLAG_MANDATORY },
};

static void sign_desc(const struct sign *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%sby %s", p->flags ? "mandatory, " : "",
		 p->by == EC_GROUP_BY_ALIAS ? "alias" : "port");
}

KUNIT_ARRAY_PARAM(sign, signs, sign_desc);

/* All connected, in a closed ring. */
static struct hot *hot_up(struct kunit *test)
{
	const struct sign *p = test->param_value;
	struct bus *b = bus_up(test, in_ring, SLAVES);
	struct hot *h = hot_make(test, p->by);

	h->flags = p->flags;
	hot_begin(h, b);
	hot_settled(h, ALL, "all connected");
	ring_closed(b, SLAVES);
	return h;
}

/* A group that is taken out opens the ring, and closes it when it is back. */
static void hot_removed(struct kunit *test)
{
	struct hot *h = hot_up(test);
	struct bus *b = h->c->b;

	h->ran &= ~X;
	hot_commands(h, "unplug s3.0;unplug s4.1");
	hot_settled(h, ALL & ~X, "one removed");
	hot_open(b, 1, 1, 2);
	hot_commands(h, "plug s2.1 s3.0;plug s4.1 s5.0");
	hot_settled(h, ALL, "back");
	ring_closed(b, SLAVES);
	/* one end first */
	h->ran &= ~X;
	hot_commands(h, "unplug s3.0;unplug s4.1");
	hot_settled(h, ALL & ~X, "one removed");
	hot_commands(h, "plug s4.1 s5.0");
	hot_settled(h, ALL, "at its far end");
	hot_commands(h, "plug s2.1 s3.0");
	hot_settled(h, ALL, "at both ends");
	ring_closed(b, SLAVES);
}

/* A first start with an open ring. */
struct first {
	u32 by;
	u32 cut;
	u32 with;
};

static const struct first firsts[] = {
	{ EC_GROUP_BY_ALIAS, 0, ALL }, { EC_GROUP_BY_ALIAS, 1, ALL }, { EC_GROUP_BY_ALIAS, 2, ALL },
	{ EC_GROUP_BY_ALIAS, 3, BIT(0) | BIT(1) | Y }, { EC_GROUP_BY_ALIAS, 4, ALL },
	{ EC_GROUP_BY_ALIAS, 5, ALL }, { EC_GROUP_BY_ALIAS, 7, ALL }, { EC_GROUP_BY_ALIAS, 8, ALL },
	{ EC_GROUP_BY_PORT, 0, 0 }, { EC_GROUP_BY_PORT, 1, BIT(0) },
	{ EC_GROUP_BY_PORT, 2, BIT(0) | BIT(1) }, { EC_GROUP_BY_PORT, 3, BIT(0) | BIT(1) },
	{ EC_GROUP_BY_PORT, 4, GENMASK(3, 0) }, { EC_GROUP_BY_PORT, 5, ALL },
	{ EC_GROUP_BY_PORT, 8, ALL },
};

static void first_desc(const struct first *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "by %s, cut before %u",
		 p->by == EC_GROUP_BY_ALIAS ? "alias" : "port", p->cut);
}

KUNIT_ARRAY_PARAM(first, firsts, first_desc);

/* Exactly those of @with have outputs, each its own; of the others the position is not certain. */
static void hot_has(struct hot *h, u32 with, const char *when)
{
	struct bus *b = h->c->b;
	u32 i, got = 0;

	cyc_run(h->c, 2000);
	for (i = 0; i < SLAVES; i++)
		got |= units_out(b, i) >> 8 == (u32)h->c->cycles ? BIT(i) : 0;
	KUNIT_EXPECT_EQ_MSG(b->test, got, with, "%s", when);
	KUNIT_EXPECT_EQ_MSG(b->test, h->wrong, 0u, "%s", when);
}

static void hot_restart(struct hot *h)
{
	struct bus *b = h->c->b;

	cyc_release(h->c);
	hot_begin(h, b);
}

/* A cut at each cable, in a group and beside it; the application is started again meanwhile. */
static void hot_cut(struct kunit *test)
{
	struct hot *h = hot_up(test);
	struct bus *b = h->c->b;
	char when[32];
	u32 i;

	for (i = 0; i < CUTS; i++) {
		snprintf(when, sizeof(when), "cut before %u", i);
		ring_cable(b, true, i);
		hot_settled(h, ALL, when);
		ring_open(b, i);
		hot_restart(h);
		hot_settled(h, ALL, when);
		ring_cable(b, false, i);
		hot_settled(h, ALL, "healed");
		ring_closed(b, SLAVES);
	}
}

/* Those of @gone have a reason, that of a group says whether it is mandatory. */
static void hot_why(struct hot *h, u32 gone, const char *when)
{
	const char *words = h->flags & EC_GROUP_FLAG_MANDATORY ? "group " : "optional group ";
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		struct ec_ioc_config_why w = { .index = h->config[i] };

		KUNIT_ASSERT_EQ(h->c->b->test, ec_ioc(&h->c->b->app, EC_IOC_CONFIG_WHY, &w), 0);
		KUNIT_EXPECT_EQ_MSG(h->c->b->test, w.cause.kind != EC_CAUSE_NONE, !!(gone & BIT(i)),
				    "%s, slave %u: %s", when, i, w.text);
		if (gone & BIT(i) & (X | Y))
			KUNIT_EXPECT_TRUE_MSG(h->c->b->test, strstarts(w.text, words),
					      "%s, slave %u: %s", when, i, w.text);
	}
}

/* Two cuts: a whole group between them, a part of it, parts of both, both. */
static const u32 pairs[][2] = { { 2, 4 }, { 2, 3 }, { 3, 4 }, { 3, 5 }, { 1, 3 }, { 2, 5 } };

/* Those between the cuts are missed, also members whose head is not; the others run on. */
static void hot_between(struct kunit *test)
{
	struct hot *h = hot_up(test);
	struct bus *b = h->c->b;
	char when[32];
	u32 i, gone;

	for (i = 0; i < ARRAY_SIZE(pairs); i++) {
		snprintf(when, sizeof(when), "cut before %u and %u", pairs[i][0], pairs[i][1]);
		gone = GENMASK(pairs[i][1] - 1, pairs[i][0]);
		ring_cable(b, true, pairs[i][0]);
		hot_settled(h, ALL, when);
		h->ran &= ~gone;
		ring_cable(b, true, pairs[i][1]);
		hot_settled(h, ALL & ~gone, when);
		hot_why(h, gone, when);
		ring_cable(b, false, pairs[i][0]);
		hot_settled(h, ALL, "healed");
		ring_cable(b, false, pairs[i][1]);
		hot_settled(h, ALL, "healed");
		ring_closed(b, SLAVES);
	}
}

/* Likewise, with a ring that was never seen closed: what is not certain gets no outputs. */
static void hot_first_cut(struct kunit *test)
{
	const struct first *p = test->param_value;
	struct bus *b = bus_new(test, in_ring);
	struct hot *h;

	ring_cable(b, true, p->cut);
	bus_plug_scanned(b, SLAVES, 5000);
	h = hot_new(b, p->by);
	hot_has(h, p->with, "open since the start");
	ring_cable(b, false, p->cut);
	hot_settled(h, ALL, "healed");
	ring_closed(b, SLAVES);
}

/* Behind the first group is a slave that looks like its second one. */
static const char alike_text[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 2 slave s io in=32 out=32 cable=50\n"
	"slave s3 io in=32 out=32 cable=50 alias=60\n"
	"slave s4 io in=32 out=32 cable=50\n"
	"slave s5 io in=32 out=32 cable=50\n"
	"slave s6 io in=32 out=32 cable=50\n"
	"slave s7 io in=32 out=32 cable=50\n"
	"slave s8 io in=32 out=32 cable=50 alias=70\n"
	"wire s8.1 -> master.1 cable=50\n";

/* in_ring with another device as second slave of the group: nothing else looks like it. */
static const char other_kind[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 2 slave s io in=32 out=32 cable=50\n"
	"slave s3 io in=32 out=32 cable=50 alias=60\n"
	"slave s4 io in=32 out=32 cable=50 product=0x999\n"
	"slave s5 io in=32 out=32 cable=50 alias=70\n"
	"slave s6 io in=32 out=32 cable=50\n"
	"slave s7 io in=32 out=32 cable=50\n"
	"slave s8 io in=32 out=32 cable=50\n"
	"wire s8.1 -> master.1 cable=50\n";

/* whether others look like its second member, and whether groups are mandatory */
struct kind {
	bool alike;
	u32 flags;
};

static const struct kind kinds[] = {
	{ true }, { false }, { true, EC_GROUP_FLAG_MANDATORY }, { false, EC_GROUP_FLAG_MANDATORY },
};

static void kind_desc(const struct kind *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%s%s", p->flags ? "mandatory, " : "",
		 p->alike ? "alike" : "of another kind");
}

KUNIT_ARRAY_PARAM(kind, kinds, kind_desc);

/*
 * The group is absent when the computer starts, and again when the application is started. Where
 * the slaves behind the break look like a part of it, their positions are not certain.
 */
static void hot_start_without(struct kunit *test)
{
	const struct kind *p = test->param_value;
	bool alike = p->alike;
	struct bus *b = bus_new(test, alike ? alike_text : other_kind);
	struct hot *h = hot_make(test, EC_GROUP_BY_ALIAS);
	u32 i;

	h->flags = p->flags;
	h->second = alike ? 0 : 0x999;
	h->y = alike ? 7 : 4;
	bus_command(b, "unplug s3.0");
	bus_command(b, "unplug s4.1");
	bus_plug_scanned(b, SLAVES - 2, 5000);
	hot_begin(h, b);
	for (i = 0; i < 2; i++) {
		if (alike)
			hot_has(h, BIT(0) | BIT(1) | BIT(7), "without one");
		else
			hot_settled(h, ALL & ~X, "without one");
		hot_open(b, 1, i ? 1 : EC_EVENT_NONE, 2);
		hot_commands(h, "plug s2.1 s3.0;plug s4.1 s5.0");
		hot_settled(h, ALL, "with it");
		ring_closed(b, SLAVES);
		h->ran &= ~X;
		hot_commands(h, "unplug s3.0;unplug s4.1");
		hot_settled(h, ALL & ~X, "removed");
		hot_restart(h);
	}
}

/* It is attached to another place of the open ring, at one end and then at both. */
static void hot_moved(struct kunit *test)
{
	struct bus *b = bus_up(test, in_ring, SLAVES);
	struct hot *h = hot_new(b, EC_GROUP_BY_ALIAS);

	hot_settled(h, ALL, "all connected");
	h->ran &= ~X;
	hot_commands(h, "unplug s3.0;unplug s4.1");
	hot_settled(h, ALL & ~X, "one removed");
	hot_commands(h, "plug s2.1 s5.0");
	hot_settled(h, ALL & ~X, "closed without it");
	ring_closed(b, SLAVES - 2);
	hot_commands(h, "unplug s7.0");
	hot_settled(h, ALL & ~X, "open for it");
	hot_commands(h, "plug s4.1 s7.0");
	hot_settled(h, ALL, "behind the break");
	hot_restart(h);
	hot_has(h, ALL, "started again");
	hot_commands(h, "plug s6.1 s3.0");
	hot_settled(h, ALL, "at another place");
	ring_closed(b, SLAVES);
	hot_restart(h);
	hot_settled(h, ALL, "started again");
}

struct random {
	u32 by;
	u32 seed;
};

static const struct random randoms[] = {
	{ EC_GROUP_BY_ALIAS, 37 }, { EC_GROUP_BY_PORT, 38 },
};

static void random_desc(const struct random *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "by %s, seed %u",
		 p->by == EC_GROUP_BY_ALIAS ? "alias" : "port", p->seed);
}

KUNIT_ARRAY_PARAM(random, randoms, random_desc);

/* What is wrong with the ring, while the application is started again and again. */
static void hot_random(struct kunit *test)
{
	static const char * const events[] = {
		"off s1", "on s1", "off s2", "on s2", "off s3", "on s3", "off s4", "on s4",
		"off s5", "on s5", "off s6", "on s6", "off s8", "on s8",
		"cut s1.0", "heal s1.0", "cut s3.0", "heal s3.0", "cut s4.0", "heal s4.0",
		"cut s5.0", "heal s5.0", "cut s6.0", "heal s6.0", "cut s8.1", "heal s8.1",
	};
	const struct random *p = test->param_value;
	struct bus *b = bus_up(test, in_ring, SLAVES);
	struct hot *h = hot_new(b, p->by);
	u32 i, k, starts = 0;
	struct rnd_state rnd;

	prandom_seed_state(&rnd, p->seed);
	for (i = 0; i < RANDOM; i++) {
		k = prandom_u32_state(&rnd) % ARRAY_SIZE(events);
		bus_command(b, events[k]);
		/* each second event heals a cut */
		k = prandom_u32_state(&rnd) % (ARRAY_SIZE(events) / 2) * 2 + 1;
		if (prandom_u32_state(&rnd) % 4)
			bus_command(b, events[k]);
		cyc_run(h->c, 20 + prandom_u32_state(&rnd) % 600);
		KUNIT_ASSERT_EQ_MSG(test, h->wrong, 0u, "event %u: %s", i, events[k]);
		if (prandom_u32_state(&rnd) % 4 || !bus_n_slaves(b))
			continue;
		hot_restart(h);
		starts++;
	}
	for (k = 1; k < ARRAY_SIZE(events); k += 2)
		bus_command(b, events[k]);
	cyc_run(h->c, 2000);
	hot_settled(h, ALL, "all well");
	ring_closed(b, SLAVES);
	bus_figure("ring with two groups: %u random events, %u starts of the application, %u wrong outputs",
		   RANDOM, starts, h->wrong);
}

/* The first group is a branch of a coupler, by whose port 2 the ring goes on. */
static const char branch_text[] =
	"segment seed=8 response=100us transition=1ms\n"
	"slave s1 io in=32 out=32 cable=50\n"
	"slave s2 EK1100 cable=50\n"
	"slave s3 io in=32 out=32 alias=60\n"
	"slave s4 io in=32 out=32\n"
	"branch s2 2\n"
	"slave s5 io in=32 out=32 cable=50 alias=70\n"
	"slave s6 io in=32 out=32 cable=50\n"
	"slave s7 io in=32 out=32 cable=50\n"
	"slave s8 io in=32 out=32 cable=50\n"
	"wire s8.1 -> master.1 cable=50\n";

/* Cables of the ring before and behind the coupler; "" none. */
static const char * const beside[] = { "", "s1.0", "s2.0", "s5.0", "s6.0", "s8.1" };

static void beside_desc(const char * const *cable, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "open at %s", **cable ? *cable : "no cable");
}

KUNIT_ARRAY_PARAM(beside, beside, beside_desc);

static void hot_cable(struct hot *h, const char *what, const char *cable)
{
	char text[16];

	snprintf(text, sizeof(text), "%s %s", what, cable);
	if (*cable)
		bus_command(h->c->b, text);
}

/* It comes and goes while the ring is open before the coupler, or behind it. */
static void hot_branch(struct kunit *test)
{
	const char *cable = *(const char * const *)test->param_value;
	struct bus *b = bus_up(test, branch_text, SLAVES);
	struct hot *h = hot_make(test, EC_GROUP_BY_ALIAS);

	h->hub = BIT(1);
	hot_begin(h, b);
	hot_settled(h, ALL, "all connected");
	hot_cable(h, "cut", cable);
	hot_settled(h, ALL, "cut");
	hot_restart(h);
	hot_settled(h, ALL, "started again");
	h->ran &= ~X;
	bus_command(b, "unplug s3.0");
	hot_settled(h, ALL & ~X, "removed");
	hot_restart(h);
	hot_settled(h, ALL & ~X, "started without it");
	bus_command(b, "plug s2.1 s3.0");
	hot_settled(h, ALL, "back");
	hot_cable(h, "heal", cable);
	hot_settled(h, ALL, "healed");
	ring_closed(b, SLAVES);
}

/* The part between two breaks, with the coupler and the group, stops alone. */
static void hot_branch_between(struct kunit *test)
{
	struct bus *b = bus_up(test, branch_text, SLAVES);
	struct hot *h = hot_make(test, EC_GROUP_BY_ALIAS);
	u32 rest = ALL & ~(X | BIT(1));

	h->hub = BIT(1);
	hot_begin(h, b);
	hot_settled(h, ALL, "all connected");
	bus_command(b, "cut s2.0");
	hot_settled(h, ALL, "cut");
	h->ran = rest;
	bus_command(b, "cut s5.0");
	hot_settled(h, rest, "cut twice");
	hot_restart(h);
	hot_has(h, rest, "started again");
	bus_command(b, "heal s2.0");
	hot_settled(h, ALL, "one healed");
	bus_command(b, "heal s5.0");
	hot_settled(h, ALL, "healed");
	ring_closed(b, SLAVES);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(hot_branch, beside_gen_params),
	KUNIT_CASE(hot_branch_between),
	KUNIT_CASE_PARAM(hot_start_without, kind_gen_params),
	KUNIT_CASE(hot_moved),
	KUNIT_CASE_PARAM(hot_random, random_gen_params),
	KUNIT_CASE_PARAM(hot_cut, sign_gen_params),
	KUNIT_CASE_PARAM(hot_between, sign_gen_params),
	KUNIT_CASE_PARAM(hot_first_cut, first_gen_params),
	KUNIT_CASE_PARAM(hot_removed, sign_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_groups", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
