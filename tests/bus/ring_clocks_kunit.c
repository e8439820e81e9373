// SPDX-License-Identifier: GPL-2.0-only
/* Clocks on both sides of the break of a ring, and after it has healed. */
#include "ring.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"

#define TEXT	4096
#define GOAL_NS	1000	/* of every running clock from the line of the reference clock */
#define LOST_NS	2000	/* likewise, while the reference clock is lost */
#define LATE_NS	20000	/* cycles, on average */

/**
 * struct clocks - an application with SYNC0 at a ring of clocks of up to 100 ppm
 * @b: bus
 * @c: its cycle
 * @leads: the reference clock is synchronized to its time
 * @off: how far it was ahead of that, ns, 0: not known yet
 * @ref: index of the reference clock
 * @absent: mask of slaves that no frame reaches
 * @lost: the reference clock is one of them: its line is continued
 * @then_ns: when its line was noted (ktime)
 * @then: its time then
 * @ppb: how much faster it was than ktime, 1e-9
 * @most: largest difference from that line, ns
 */
struct clocks {
	struct bus *b;
	struct cyc *c;
	bool leads;
	s64 off;
	u32 ref;
	u32 absent;
	bool lost;
	u64 then_ns;
	u64 then;
	s64 ppb;
	s64 most;
};

static u64 clock_of(const struct clocks *k, u32 i, u64 now)
{
	return ec_esc_system_time(bus_esc(k->b, i), now);
}

/* The time that the reference clock has, or would have. */
static u64 line(const struct clocks *k, u64 now)
{
	u64 since = now - k->then_ns;

	if (!k->lost)
		return clock_of(k, k->ref, now);
	return k->then + since + div_s64((s64)since * k->ppb, NSEC_PER_SEC);
}

/* How far the running clocks are from that line, the worst of them, ns. */
static s64 apart(const struct clocks *k)
{
	u64 now = ktime_get_ns(), is;
	s64 most = 0;
	u32 i;

	ec_sim_advance(k->b->sim, now);
	is = line(k, now);
	for (i = 0; i < SLAVES; i++)
		if (!(k->absent & BIT(i)))
			most = max_t(s64, most, abs((s64)(clock_of(k, i, now) - is)));
	return most;
}

static void clocks_look(struct cyc *c)
{
	struct clocks *k = c->ctx;

	k->most = max(k->most, apart(k));
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR;
	if (!k->leads)
		return;
	c->flags |= EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_REF_TIME;
	c->app_time = ktime_to_ns(c->next);
	c->sync_time = c->app_time;
}

/* Cycles; the largest difference in them, ns. */
static s64 clocks_run(struct clocks *k, u32 cycles)
{
	k->most = 0;
	cyc_run(k->c, cycles);
	return k->most;
}

static struct bus *clocks_bus(struct kunit *test)
{
	char *text = kunit_kzalloc(test, TEXT, GFP_KERNEL);
	struct rnd_state rnd;
	int len, i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	prandom_seed_state(&rnd, 5);
	len = scnprintf(text, TEXT, "segment seed=8 response=100us transition=1ms\n");
	for (i = 1; i <= SLAVES; i++)
		len += scnprintf(text + len, TEXT - len,
				 "slave d%u drive in=8 out=8 cable=50 drift=%dppb clock=%ums\n", i,
				 (int)(prandom_u32_state(&rnd) % 200001) - 100000 - 50000,
				 prandom_u32_state(&rnd));
	scnprintf(text + len, TEXT - len, "wire d8.1 -> master.1 cable=50\n");
	return bus_new(test, text);
}

/* All slaves in OP with their clocks; @ref is the reference clock. */
static struct clocks *clocks_start(struct bus *b, u32 ref, bool leads)
{
	struct clocks *k = kunit_kzalloc(b->test, sizeof(*k), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, k);
	k->b = b;
	k->ref = ref;
	k->leads = leads;
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	k->c = cyc_new(b, 1000);
	cyc_domain(k->c);
	cyc_map_all(k->c, 0, SLAVES, 0);
	cyc_sync0(k->c, SLAVES);
	if (ref) {
		struct ec_ioc_ref_clock r = { .config = ref };

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &r), 0);
	}
	k->c->ctx = k;
	k->c->each = clocks_look;
	cyc_activate(k->c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(k->c, 20000), ~0ull);
	cyc_shake(k->c, LATE_NS, 1000);
	cyc_run(k->c, 5000);
	return k;
}

/* What the application gets of the reference clock, wherever that is. */
static void expect_led(struct clocks *k, const char *when)
{
	const struct ec_status *st = bus_status(k->b);
	u64 now = ktime_get_ns();
	s64 off;

	ec_sim_advance(k->b->sim, now);
	KUNIT_EXPECT_NE_MSG(k->b->test, st->dc_monitor, ~0u, "%s", when);
	if (!k->leads)
		return;
	KUNIT_EXPECT_TRUE_MSG(k->b->test, st->dc_time64_valid, "%s", when);
	off = clock_of(k, k->ref, now) - now + LATE_NS;
	/* it gets the time when the frame reaches it */
	k->off = k->off ?: off;
	off = abs(off - k->off);
	KUNIT_EXPECT_LE_MSG(k->b->test, off, (s64)GOAL_NS, "%s", when);
}

/* one cut: where, and the reference clock */
struct cut {
	u32 at;
	u32 ref;
	bool leads;
};

static const struct cut cuts[] = {
	{ 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 5, 0 }, { 6, 0 }, { 7, 0 }, { 8, 0 },
	{ 2, 3 }, { 3, 3 }, { 4, 3 }, { 6, 7 }, { 0, 0, true }, { 4, 0, true }, { 2, 3, true },
	{ 8, 7, true },
};

static void cut_desc(const struct cut *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "before slave %u, reference slave %u%s", p->at,
		 p->ref, p->leads ? ", synchronized to the application" : "");
}

KUNIT_ARRAY_PARAM(cut, cuts, cut_desc);

static void clocks_cut(struct kunit *test)
{
	const struct cut *p = test->param_value;
	struct clocks *k = clocks_start(clocks_bus(test), p->ref, p->leads);
	s64 before = clocks_run(k, 1000), most, end, healed;

	expect_led(k, "with a closed ring");
	cable(k->b, true, p->at);
	most = clocks_run(k, 1500);
	expect_open(k->b, p->at);
	end = clocks_run(k, 500);
	expect_led(k, "with an open ring");
	cable(k->b, false, p->at);
	healed = clocks_run(k, 2000);
	expect_led(k, "when it has healed");
	expect_closed(k->b, SLAVES);
	bus_figure("ring cut before slave %u, reference slave %u%s: clocks apart %lld ns before, at most %lld in 1.5 s after it, then %lld, at most %lld in 2 s after it has healed",
		   p->at, p->ref, p->leads ? " synchronized to the application" : "", before, most,
		   end, healed);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	KUNIT_EXPECT_LE(test, before, GOAL_NS);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
}

/* Minutes with an open ring. */
static void clocks_stay(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most;

	cable(k->b, true, 4);
	most = clocks_run(k, 60000);
	bus_figure("ring open for a minute: clocks apart %lld ns at most", most);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
}

static void note_delays(struct clocks *k, s32 *delay)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		delay[i] = get_unaligned_le32(bus_esc(k->b, i)->mem + EC_REG_DC_DELAY);
}

/* The delays in the clocks @from on are about those that were measured in the closed ring. */
static void expect_delays(struct clocks *k, const s32 *delay, u32 from, const char *when)
{
	s32 now[SLAVES];
	u32 i;

	note_delays(k, now);
	for (i = from; i < SLAVES; i++) {
		u32 off = abs(now[i] - now[from] - (delay[i] - delay[from]));

		if (!(k->absent & BIT(i)))
			KUNIT_EXPECT_LE_MSG(k->b->test, off, 50u, "%s: slave %u", when, i);
	}
}

/* A slave with a clock loses its power, and has it again. */
static void clocks_power(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most, back, end;
	s32 delay[SLAVES];

	note_delays(k, delay);
	k->absent = BIT(3);
	bus_command(k->b, "off d4");
	most = clocks_run(k, 2000);
	expect_ring(k->b, EC_RING_OPEN, 3, SLAVES - 1);
	expect_delays(k, delay, 4, "a slave has no power");
	bus_command(k->b, "on d4");
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	expect_closed(k->b, SLAVES);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	expect_delays(k, delay, 0, "it has power again");
	bus_figure("a slave of a ring loses power: the other clocks apart at most %lld ns, %lld when it is back, all %lld then",
		   most, back, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, back, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* What is between two cuts stops; the clocks of the others go on. */
static void clocks_second_cut(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most, second, back, end;
	s32 delay[SLAVES];

	note_delays(k, delay);
	cable(k->b, true, 2);
	most = clocks_run(k, 1000);
	k->absent = BIT(2) | BIT(3) | BIT(4);
	cable(k->b, true, 5);
	second = clocks_run(k, 2000);
	expect_ring(k->b, EC_RING_OPEN, 2, SLAVES - 3);
	expect_delays(k, delay, 5, "a second cut");
	cable(k->b, false, 2);
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	expect_open(k->b, 5);
	k->absent = 0;
	clocks_run(k, 3000);
	expect_delays(k, delay, 5, "the first one has healed");
	cable(k->b, false, 5);
	end = clocks_run(k, 2000);
	expect_closed(k->b, SLAVES);
	bus_figure("ring cut twice: clocks apart at most %lld ns after the first cut, %lld after the second, %lld after the repair of one, %lld of both",
		   most, second, back, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, second, GOAL_NS);
	KUNIT_EXPECT_LE(test, back, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(clocks_cut, cut_gen_params),
	KUNIT_CASE(clocks_stay),
	KUNIT_CASE(clocks_power),
	KUNIT_CASE(clocks_second_cut),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_clocks", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
