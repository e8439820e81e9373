// SPDX-License-Identifier: GPL-2.0-only
/*
 * Branches of a ring: at a port that frames pass before that of the ring they are as any other. At
 * a later one, or with both ends at the same slave, frames of the main device do not pass the ring.
 */
#include "ring.h"
#include "units.h"
#include "devices/sim/esc_int.h"

#define N	6	/* slaves */
#define HUB	1	/* the one with the branch */

/* The last two slaves are the branch; the ring passes the junction by port 1. */
#define TEXT(port) \
	"segment seed=8 response=100us transition=1ms\n" \
	"slave s1 io in=32 out=32 cable=50\n" \
	"slave s2 EK1122 cable=50\n" \
	"slave s3 io in=32 out=32 cable=50\n" \
	"slave s4 io in=32 out=32 cable=50\n" \
	"branch s2 " #port "\n" \
	"slave s5 io in=32 out=32 cable=50\n" \
	"slave s6 io in=32 out=32 cable=50\n" \
	"wire s4.1 -> master.1 cable=50\n"

static u32 turned_events(struct bus *b)
{
	struct ec_event e;
	u64 from = 0;
	u32 n = 0;

	while (ec_event_ring_get(bus_events(b), &from, &e))
		n += e.kind == EC_EVENT_RING_TURNED;
	return n;
}

/* Each slave gets a value of its own, by its place in the segment. */
struct loop {
	struct cyc *c;
	u32 config[N];
	u32 wrong;
	u32 none;	/* slaves without a new value, summed up over cycles */
};

static u8 *value_of(struct loop *l, u32 i)
{
	const struct ec_config *sc = bus_config(l->c->b, l->config[i]);
	u32 k = 0;

	while (sc->fmmus[k].sm)
		k++;
	return cyc_data(l->c, 0) + sc->fmmus[k].offset;
}

static void loop_look(struct cyc *c)
{
	struct loop *l = c->ctx;
	u32 i;

	ec_sim_advance(c->b->sim, ktime_get_ns());
	for (i = 0; i < N; i++) {
		u32 is = units_out(c->b, i);

		if (i == HUB)
			continue;
		l->wrong += is && (is & 0xff) != i + 1;
		l->none += is >> 8 != (u32)c->cycles;
		put_unaligned_le32((u32)(c->cycles + 1) << 8 | (i + 1), value_of(l, i));
	}
}

/* In the closed ring: s1 s2 s5 s6 s3 s4. */
static struct loop *loop_run(struct bus *b)
{
	static const u32 order[N] = { 0, 1, 4, 5, 2, 3 };
	struct loop *l = kunit_kzalloc(b->test, sizeof(*l), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, l);
	bus_idle(b);
	l->c = cyc_new(b, 1000);
	cyc_domain(l->c);
	for (i = 0; i < N; i++) {
		cyc_map_all(l->c, i, 1, 0);
		l->config[order[i]] = i;
	}
	l->c->ctx = l;
	l->c->each = loop_look;
	cyc_activate(l->c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(l->c, 5000), ~0ull);
	cyc_run(l->c, 50);
	l->none = 0;
	cyc_run(l->c, 50);
	KUNIT_EXPECT_EQ(b->test, l->none, 0u);
	KUNIT_EXPECT_EQ(b->test, l->wrong, 0u);
	return l;
}

static void refused(struct bus *b, const char *words)
{
	struct ec_ioc_activate a = { 0 };
	struct cyc *c = cyc_new(b, 1000);

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
	KUNIT_EXPECT_TRUE_MSG(b->test, strstr(b->app.reason, words), "%s", b->app.reason);
	cyc_release(c);
}

/* At port 3 it is passed before the ring, also while that is open beside it. */
static void branch_before_ring(struct kunit *test)
{
	static const char * const cables[] = { "s2.0", "s3.0", "s1.0", "s4.1" };
	struct bus *b = bus_up(test, TEXT(3), N);
	struct loop *l = loop_run(b);
	char text[16];
	u32 i;

	ring_closed(b, N);
	for (i = 0; i < ARRAY_SIZE(cables); i++) {
		snprintf(text, sizeof(text), "cut %s", cables[i]);
		bus_command(b, text);
		cyc_run(l->c, 300);
		l->none = 0;
		cyc_run(l->c, 50);
		KUNIT_EXPECT_EQ_MSG(test, l->none, 0u, "%s", text);
		snprintf(text, sizeof(text), "heal %s", cables[i]);
		bus_command(b, text);
		cyc_run(l->c, 300);
		ring_closed(b, N);
	}
	KUNIT_EXPECT_EQ(test, l->wrong, 0u);
	KUNIT_EXPECT_EQ(test, turned_events(b), 0u);
}

/* At port 2 it is passed by frames of the backup device only. */
static void branch_behind_ring(struct kunit *test)
{
	struct bus *b = bus_up(test, TEXT(2), N);

	bus_idle(b);
	KUNIT_EXPECT_EQ(test, turned_events(b), 1u);
	refused(b, "because of a branch at slave 1, port 2");
	bus_command(b, "unplug s2.2");
	bus_command(b, "plug s2.3 s5.0");
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	loop_run(b);
}

/* A ring inside of the ring. */
static void branch_is_ring(struct kunit *test)
{
	struct bus *b = bus_new(test, TEXT(3) "wire s6.1 -> s2.2\n");

	bus_plug_scanned(b, N, 5000);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, turned_events(b), 1u);
	refused(b, "because of a branch at slave 1, port 1");
	bus_command(b, "unplug s6.1");
	msleep(1000);
	bus_idle(b);
	ring_closed(b, N);
	loop_run(b);
}

/* Likewise, while an application runs: no slave gets another one's outputs, and none is lost. */
static void branch_becomes_ring(struct kunit *test)
{
	struct bus *b = bus_up(test, TEXT(3), N);
	struct loop *l = loop_run(b);
	u32 i;

	for (i = 0; i < 3; i++) {
		bus_command(b, "plug s6.1 s2.2");
		cyc_run(l->c, 1000);
		KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_OPEN);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N);
		l->none = 0;
		cyc_run(l->c, 50);
		KUNIT_EXPECT_EQ(test, l->none, 0u);
		bus_command(b, "unplug s6.1");
		cyc_run(l->c, 1000);
		ring_closed(b, N);
		l->none = 0;
		cyc_run(l->c, 50);
		KUNIT_EXPECT_EQ(test, l->none, 0u);
	}
	KUNIT_EXPECT_EQ(test, l->wrong, 0u);
	bus_command(b, "plug s6.1 s2.2");
	cyc_run(l->c, 1000);
	cyc_release(l->c);
	refused(b, "because of a branch");
}

/* On a bus with one end the slaves behind the port of the other end are not reached. */
static void branch_is_ring_of_line(struct kunit *test)
{
	u32 lines = bus_log_lines("open ports inconsistent with ring order"), i;
	struct bus *b = bus_up(test, TEXT(3), N);

	bus_command(b, "unplug s4.1");
	for (i = 0; i < 3; i++) {
		bus_command(b, "plug s6.1 s2.2");
		msleep(2000);
		bus_idle(b);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N - 2);
		KUNIT_EXPECT_GT(test, bus_log_lines("open ports inconsistent with ring order"),
				lines);
		bus_command(b, "unplug s6.1");
		msleep(2000);
		bus_idle(b);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(branch_before_ring),
	KUNIT_CASE(branch_behind_ring),
	KUNIT_CASE(branch_is_ring),
	KUNIT_CASE(branch_becomes_ring),
	KUNIT_CASE(branch_is_ring_of_line),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_branch", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
