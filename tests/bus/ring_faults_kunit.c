// SPDX-License-Identifier: GPL-2.0-only
/* A ring that is connected in another way than it should be, or that is not whole at the start. */
#include "ring.h"
#include "master/bus/ring_break.h"
#include "master/bus/ring_ends.h"

#define IO_BITS		8

/* equal slaves */
static const char equal_text[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 8 slave s io in=8 out=8 cable=50\n"
	"wire s8.1 -> master.1 cable=50\n";

/* The outputs that a slave has. */
static u32 outputs(struct bus *b, u32 slave)
{
	char name[16];
	u32 v = 0, i;

	snprintf(name, sizeof(name), "s%u", slave + 1);
	for (i = 0; i < IO_BITS; i++)
		v |= (u32)ec_app_channel(bus_app(b, name), EC_APP_OUT, i) << i;
	return v;
}

/* Slave @i of the closed ring is the one that is connected there, and has no outputs of others. */
static void equal_look(struct cyc *c)
{
	u32 *wrong = c->ctx, i;

	for (i = 0; i < SLAVES; i++) {
		u32 is = outputs(c->b, i);

		*wrong += is && is != i + 1;
		*cyc_pd(c, i, 0) = i + 1;
	}
}

/* An application for all of them, active, for 2 s; @got: mask of those that have their outputs. */
static struct cyc *equal_run(struct bus *b, u32 *got)
{
	struct cyc *c;
	u32 wrong = 0, i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, SLAVES, 0);
	c->each = equal_look;
	c->ctx = &wrong;
	cyc_activate(c);
	cyc_run(c, 2000);
	KUNIT_EXPECT_EQ(b->test, wrong, 0u);
	for (*got = 0, i = 0; i < SLAVES; i++)
		*got |= outputs(b, i) == i + 1 ? BIT(i) : 0;
	c->each = NULL;
	return c;
}

static void expect_order(struct bus *b, const u16 *station)
{
	u32 k;

	for (k = 0; k < SLAVES; k++)
		KUNIT_EXPECT_EQ(b->test, bus_slave(b, k)->station, station[k]);
}

static u32 faults_events(struct bus *b, u32 kind)
{
	struct ec_event e;
	u64 from = 0;
	u32 n = 0;

	while (ec_event_ring_get(bus_events(b), &from, &e))
		n += e.kind == kind;
	return n;
}

/* The names are exchanged: the ring works all the same, cut at any place. */
static void ring_names_exchanged(struct kunit *test)
{
	struct bus *b = bus_new_exchanged(test, ring_eight);
	struct ring *r = ring_new(test, b);
	u16 station[SLAVES];
	u32 i;

	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	for (i = 0; i < SLAVES; i++) {
		station[i] = get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION);
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->station, station[i]);
	}
	ring_run(r, SLAVES);
	for (i = 0; i <= SLAVES; i++) {
		ring_cable(b, true, i);
		cyc_run(r->c, 300);
		ring_open(b, i);
		ring_expect(r, "a cut");
		expect_order(b, station);
		ring_cable(b, false, i);
		cyc_run(r->c, 300);
		ring_closed(b, SLAVES);
	}
	ring_expect(r, "all have healed");
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
}

/* Likewise, never seen closed, and with one end only. */
static void ring_names_exchanged_open(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value, i;
	struct bus *b = bus_new_exchanged(test, ring_eight);
	struct ring *r = ring_new(test, b);

	ring_cable(b, true, at);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_open(b, at);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->station,
				get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION));
	ring_run(r, SLAVES);
	ring_cable(b, false, at);
	cyc_run(r->c, 300);
	ring_closed(b, SLAVES);
	ring_expect(r, "it has healed");
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
}

static const u32 places[] = { 0, 1, 4, 7, 8 };

static void place_desc(const u32 *at, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "before slave %u", *at);
}

KUNIT_ARRAY_PARAM(place, places, place_desc);

/* A slave that is the wrong way round, where @at is its number. */
static void ring_slave_turned(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value % SLAVES, cut, got;
	struct ec_ioc_activate a = { 0 };
	struct bus *b = bus_new(test, equal_text);
	char text[48];
	struct cyc *c;

	snprintf(text, sizeof(text), "swap s%u.0 s%u.1", at + 1, at + 1);
	bus_command(b, text);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_CLOSED);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	/* the same at each place where the ring may be open */
	for (cut = 0; cut <= SLAVES; cut++) {
		if (cut && cut < SLAVES)
			continue;
		bus_fault(b, EC_SIM_FAULT_CUT, min_t(u32, cut, SLAVES - 1),
			  (cut == SLAVES) ^ (at == min_t(u32, cut, SLAVES - 1)), 0, 0);
		bus_idle(b);
		KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_OPEN);
		c = cyc_new(b, 1000);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
		cyc_release(c);
		bus_fault(b, EC_SIM_FAULT_HEAL, min_t(u32, cut, SLAVES - 1),
			  (cut == SLAVES) ^ (at == min_t(u32, cut, SLAVES - 1)), 0, 0);
		bus_idle(b);
	}
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	bus_command(b, text);
	bus_idle(b);
	ring_closed(b, SLAVES);
	equal_run(b, &got);
	KUNIT_EXPECT_EQ(test, got, 0xffu);
}

/* Likewise, in a ring that was never seen closed. */
static void ring_slave_turned_open(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value, cut;
	struct ec_ioc_activate a = { 0 };
	struct bus *b = bus_new(test, equal_text);
	char text[48];

	at = min_t(u32, at, SLAVES - 1);
	cut = at < 4 ? 5 : 3;
	snprintf(text, sizeof(text), "swap s%u.0 s%u.1", at + 1, at + 1);
	bus_command(b, text);
	ring_cable(b, true, cut);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_OPEN);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	KUNIT_EXPECT_FALSE(test, bus_links(b)->exchanged);
	cyc_new(b, 1000);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ring_names_exchanged),
	KUNIT_CASE_PARAM(ring_names_exchanged_open, place_gen_params),
	KUNIT_CASE_PARAM(ring_slave_turned, place_gen_params),
	KUNIT_CASE_PARAM(ring_slave_turned_open, place_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_faults", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
