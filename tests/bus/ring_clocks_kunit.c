// SPDX-License-Identifier: GPL-2.0-only
/* Clocks on both sides of the break of a ring, and after it has healed. */
#include "ring.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"

#define TEXT	4096
#define GOAL_NS	1000	/* of every running clock from the line of the reference clock */
#define LOST_NS	2000	/* likewise, while the reference clock is lost */
#define JUMP_NS	100	/* of a clock in a cycle */
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
 * @was: difference of each clock in the last cycle, ns
 * @jump: largest change of one in a cycle, ns
 * @open: the ring is open
 * @opened: how often it was opened
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
	s64 was[SLAVES];
	s64 jump;
	bool open;
	u32 opened;
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
static s64 apart(struct clocks *k)
{
	u64 now = ktime_get_ns(), is;
	s64 most = 0, off;
	u32 i;

	ec_sim_advance(k->b->sim, now);
	is = line(k, now);
	for (i = 0; i < SLAVES; i++) {
		if (k->absent & BIT(i))
			continue;
		off = clock_of(k, i, now) - is;
		most = max_t(s64, most, abs(off));
		k->jump = max_t(s64, k->jump, abs(off - k->was[i]));
		k->was[i] = off;
	}
	return most;
}

static void clocks_look(struct cyc *c)
{
	struct clocks *k = c->ctx;
	bool open = bus_links(k->b)->ring.state == EC_RING_OPEN;

	k->most = max(k->most, apart(k));
	k->opened += open && !k->open;
	k->open = open;
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
	k->jump = 0;
	cyc_run(k->c, cycles);
	return k->most;
}

/* @back_ns: cable to the backup device; that of the main device has 50 m */
static struct bus *clocks_bus_of(struct kunit *test, u32 back_ns)
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
	scnprintf(text + len, TEXT - len, "wire d8.1 -> master.1 cable=%uns\n", back_ns);
	return bus_new(test, text);
}

static struct bus *clocks_bus(struct kunit *test)
{
	return clocks_bus_of(test, 250);
}

/* An application at the ring; @ref is the reference clock. All slaves are in OP then. */
static void clocks_activate(struct clocks *k, u32 ref)
{
	struct bus *b = k->b;

	k->ref = ref;
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
}

static struct clocks *clocks_start(struct bus *b, u32 ref, bool leads)
{
	struct clocks *k = kunit_kzalloc(b->test, sizeof(*k), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, k);
	k->b = b;
	k->leads = leads;
	bus_plug_scanned(b, SLAVES, 5000);
	clocks_activate(k, ref);
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
	ring_cable(k->b, true, p->at);
	most = clocks_run(k, 1500);
	ring_open(k->b, p->at);
	end = clocks_run(k, 500);
	expect_led(k, "with an open ring");
	ring_cable(k->b, false, p->at);
	healed = clocks_run(k, 2000);
	expect_led(k, "when it has healed");
	ring_closed(k->b, SLAVES);
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

	ring_cable(k->b, true, 4);
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
	ring_state(k->b, EC_RING_OPEN, 3, SLAVES - 1);
	expect_delays(k, delay, 4, "a slave has no power");
	bus_command(k->b, "on d4");
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	ring_closed(k->b, SLAVES);
	/* the delays of the one that is back were measured meanwhile */
	KUNIT_EXPECT_EQ(test, k->opened, 1u);
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

/* The line of the reference clock, as of two seconds before now. */
static void note_line(struct clocks *k)
{
	u64 now = ktime_get_ns(), then;

	ec_sim_advance(k->b->sim, now);
	then = clock_of(k, k->ref, now);
	clocks_run(k, 2000);
	k->then_ns = ktime_get_ns();
	ec_sim_advance(k->b->sim, k->then_ns);
	k->then = clock_of(k, k->ref, k->then_ns);
	k->ppb = div64_s64((s64)(k->then - then - (k->then_ns - now)) * NSEC_PER_SEC,
			   k->then_ns - now);
}

static u32 ref_index(struct clocks *k)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		if (!(k->absent & BIT(i)) &&
		    get_unaligned_le16(bus_esc(k->b, i)->mem + EC_REG_STATION) ==
		    bus_dc_ref_station(k->b))
			return i;
	KUNIT_FAIL(k->b->test, "no reference clock");
	return 0;
}

static void slave_power(struct clocks *k, u32 i, bool on)
{
	char text[16];

	snprintf(text, sizeof(text), "%s d%u", on ? "on" : "off", i + 1);
	bus_command(k->b, text);
}

/* a reference clock that is lost while the ring is closed, or open */
struct loss {
	u32 ref;
	int at;		/* cut before this slave, -1: none */
	u32 absent;	/* then */
};

static const struct loss losses[] = {
	{ 0, -1, 0x01 }, { 3, -1, 0x08 }, { 0, 4, 0x0f }, { 3, 5, 0x18 }, { 3, 2, 0x0c },
	{ 5, 2, 0x3c },
};

static void loss_desc(const struct loss *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "slave %u, ring open before slave %d", p->ref, p->at);
}

KUNIT_ARRAY_PARAM(loss, losses, loss_desc);

/* The reference clock loses its power: the next one continues its line. */
static void clocks_lose_ref(struct kunit *test)
{
	const struct loss *p = test->param_value;
	struct clocks *k = clocks_start(clocks_bus(test), p->ref, false);
	s64 most, back, end;

	if (p->at >= 0) {
		ring_cable(k->b, true, p->at);
		clocks_run(k, 1000);
	}
	note_line(k);
	k->lost = true;
	k->absent = p->absent;
	slave_power(k, p->ref, false);
	most = clocks_run(k, 2000);
	KUNIT_EXPECT_NE(test, bus_status(k->b)->dc_ref, 0u);
	/* from now on the line of the new one */
	k->lost = false;
	k->ref = ref_index(k);
	slave_power(k, p->ref, true);
	if (p->at >= 0)
		ring_cable(k->b, false, p->at);
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	ring_closed(k->b, SLAVES);
	bus_figure("ring open before slave %d loses reference clock %u: clocks %lld ns from its line at most in 2 s; back: the others apart %lld ns at most, all %lld then",
		   p->at, p->ref, most, back, end);
	KUNIT_EXPECT_LE(test, most, LOST_NS);
	KUNIT_EXPECT_LE(test, back, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* a start with an open ring */
struct start {
	u32 at;
	u32 ref;
	u32 back_ns;	/* cable to the backup device */
};

static const struct start starts[] = {
	{ 0, 0, 250 }, { 1, 0, 250 }, { 3, 0, 250 }, { 7, 0, 250 }, { 8, 0, 250 }, { 2, 3, 250 },
	{ 5, 3, 250 }, { 3, 0, 2250 },
};

static void start_desc(const struct start *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "open before slave %u, reference slave %u, %u ns",
		 p->at, p->ref, p->back_ns);
}

KUNIT_ARRAY_PARAM(start, starts, start_desc);

/* The ring is open from the start, closes, and opens again. */
static void clocks_start_open(struct kunit *test)
{
	const struct start *p = test->param_value;
	struct bus *b = clocks_bus_of(test, p->back_ns);
	s64 limit = GOAL_NS + abs((int)p->back_ns - 250), most, healed, end, again;
	struct clocks *k;

	ring_cable(b, true, p->at);
	k = clocks_start(b, p->ref, false);
	ring_open(b, p->at);
	most = clocks_run(k, 2000);
	ring_cable(b, false, p->at);
	healed = clocks_run(k, 3000);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_LE(test, k->jump, JUMP_NS);
	end = clocks_run(k, 1000);
	ring_cable(b, true, p->at);
	again = clocks_run(k, 2000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	bus_figure("ring open before slave %u at the start, reference slave %u, cable to the backup device of %u ns: clocks apart at most %lld ns, %lld in 3 s after it has closed, then %lld; %lld when it opens again",
		   p->at, p->ref, p->back_ns, most, healed, end, again);
	KUNIT_EXPECT_LE(test, most, limit);
	KUNIT_EXPECT_LE(test, healed, limit);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, again, GOAL_NS);
}

/* The application ends and begins again while the ring is open; then it closes. */
static void clocks_restart(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most, healed, end;

	ring_cable(k->b, true, 3);
	clocks_run(k, 1000);
	cyc_release(k->c);
	msleep(3000);
	clocks_activate(k, 0);
	ring_open(k->b, 3);
	most = clocks_run(k, 2000);
	ring_cable(k->b, false, 3);
	healed = clocks_run(k, 3000);
	end = clocks_run(k, 1000);
	bus_figure("application restarted while the ring is open: clocks apart at most %lld ns, %lld in 3 s after it has closed, then %lld",
		   most, healed, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* A slave that lost its power comes back behind the break. */
static void clocks_join(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most, end, healed;

	k->absent = BIT(3);
	slave_power(k, 3, false);
	ring_cable(k->b, true, 3);
	clocks_run(k, 2000);
	slave_power(k, 3, true);
	most = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	most = max(most, k->most);
	ring_open(k->b, 3);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	ring_cable(k->b, false, 3);
	healed = clocks_run(k, 3000);
	bus_figure("a slave joins those behind the break: the others apart at most %lld ns, all %lld then, %lld when it closes",
		   most, end, healed);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
}

static void expect_near(struct kunit *test, s32 is, s32 goal, s32 noise)
{
	s32 off = abs(is - goal);

	KUNIT_EXPECT_LE_MSG(test, off, noise, "%d, expected %d", is, goal);
}

/* At rest: the delays stay behind a break, and are measured again when it has healed. */
static void clocks_at_rest(struct kunit *test)
{
	struct bus *b = clocks_bus(test);
	u32 delay[SLAVES], i, k;

	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	for (k = 0; k < SLAVES; k++)
		delay[k] = ec_clock_of(bus_slave(b, k))->delay;
	expect_near(test, delay[SLAVES - 1], 3850, 50);
	for (i = 0; i <= SLAVES; i++) {
		ring_cable(b, true, i);
		bus_idle(b);
		ring_open(b, i);
		for (k = 0; k < SLAVES; k++)
			expect_near(test, ec_clock_of(bus_slave(b, k))->delay, delay[k], 20);
		ring_cable(b, false, i);
		bus_idle(b);
		for (k = 0; k < SLAVES; k++)
			expect_near(test, ec_clock_of(bus_slave(b, k))->delay, delay[k], 20);
	}
}

/* Nothing is measured while the exit of a closed ring is not known. */
static void clocks_no_exit(struct kunit *test)
{
	struct bus *b = clocks_bus(test);
	u32 k;

	bus_fault(b, EC_SIM_FAULT_DEAD, SLAVES - 1, 0, 1, 0);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_closed(b, SLAVES);
	KUNIT_ASSERT_EQ(test, bus_slave(b, SLAVES - 1)->note.error, EC_SLAVE_SCAN_FAILED);
	for (k = 0; k < SLAVES; k++)
		KUNIT_EXPECT_EQ(test, ec_clock_of(bus_slave(b, k))->measured, 0u);
	bus_fault(b, EC_SIM_FAULT_DEAD, SLAVES - 1, 0, 0, 0);
	for (k = 0; k < 100 && bus_slave(b, SLAVES - 1)->note.error; k++)
		msleep(100);
	bus_idle(b);
	expect_near(test, ec_clock_of(bus_slave(b, SLAVES - 1))->delay, 3850, 50);
}

/* The exit opens itself after a second: receive times of a later latch do not count. */
static void clocks_slow_cycle(struct kunit *test)
{
	struct clocks *k = kunit_kzalloc(test, sizeof(*k), GFP_KERNEL);
	struct bus *b = clocks_bus(test);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, k);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	k->b = b;
	k->c = cyc_new(b, 800000);
	cyc_domain(k->c);
	cyc_map_all(k->c, 0, SLAVES, 0);
	cyc_sync0(k->c, SLAVES);
	k->c->ctx = k;
	k->c->each = clocks_look;
	for (i = 0; i < SLAVES; i++)
		ec_clock_of(bus_slave(b, i))->measured = 0;
	cyc_activate(k->c);
	for (i = 0; i < 200 && !ec_clock_of(bus_slave(b, SLAVES - 1))->measured; i++)
		cyc_run(k->c, 1);
	for (i = 0; i < SLAVES; i++)
		expect_near(test, ec_clock_of(bus_slave(b, i))->delay, 550 * i, 50);
}

/* What is between two cuts stops; the clocks of the others go on. */
static void clocks_second_cut(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0, false);
	s64 most, second, back, end;
	s32 delay[SLAVES];

	note_delays(k, delay);
	ring_cable(k->b, true, 2);
	most = clocks_run(k, 1000);
	k->absent = BIT(2) | BIT(3) | BIT(4);
	ring_cable(k->b, true, 5);
	second = clocks_run(k, 2000);
	ring_state(k->b, EC_RING_OPEN, 2, SLAVES - 3);
	expect_delays(k, delay, 5, "a second cut");
	ring_cable(k->b, false, 2);
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	ring_open(k->b, 5);
	k->absent = 0;
	clocks_run(k, 3000);
	expect_delays(k, delay, 5, "the first one has healed");
	ring_cable(k->b, false, 5);
	end = clocks_run(k, 2000);
	ring_closed(k->b, SLAVES);
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
	KUNIT_CASE_PARAM(clocks_lose_ref, loss_gen_params),
	KUNIT_CASE_PARAM(clocks_start_open, start_gen_params),
	KUNIT_CASE(clocks_restart),
	KUNIT_CASE(clocks_join),
	KUNIT_CASE(clocks_at_rest),
	KUNIT_CASE(clocks_no_exit),
	KUNIT_CASE(clocks_slow_cycle),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_clocks", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
