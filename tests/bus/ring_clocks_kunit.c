// SPDX-License-Identifier: GPL-2.0-only
/* Clocks on both sides of the break of a ring, and after it has healed. */
#include "ring_clocks.h"
#include "master/cycle/ring_clock.h"
#include "master/wire/frame.h"

#define EVENTS	200	/* half of them cuts */

/* What the application gets of the reference clock, wherever that is. */
static void expect_led(struct clocks *k, const char *when)
{
	const struct ec_status *st = bus_status(k->b);
	u64 now = ktime_get_ns();
	s64 off;

	ec_sim_advance(k->b->sim, now);
	if (k->kernel) {
		KUNIT_EXPECT_EQ_MSG(k->b->test, st->kernel.lock, EC_CYCLE_LOCK_LOCKED, "%s", when);
		KUNIT_EXPECT_EQ_MSG(k->b->test, st->kernel.lock_losses, 0u, "%s", when);
		/* a reply that equals the prediction is one */
		KUNIT_EXPECT_EQ_MSG(k->b->test, k->unlocked, 0u, "%s", when);
		return;
	}
	KUNIT_EXPECT_NE_MSG(k->b->test, st->dc_monitor, ~0u, "%s", when);
	if (!k->leads)
		return;
	KUNIT_EXPECT_TRUE_MSG(k->b->test, st->dc_time64_valid, "%s", when);
	off = (s32)((u32)clock_of(k, k->ref, now) - (u32)now + LATE_NS);
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
	struct kinds kinds;
	bool kernel;
	bool still;
};

static const struct cut cuts[] = {
	{ 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 5, 0 }, { 6, 0 }, { 7, 0 }, { 8, 0 },
	{ 2, 3 }, { 3, 3 }, { 4, 3 }, { 6, 7 }, { 0, 0, true }, { 4, 0, true }, { 2, 3, true },
	{ 8, 7, true },
	/* of both widths */
	{ 0, 0, false, { 0x55 } }, { 4, 0, false, { 0xaa } }, { 2, 3, false, { 0x33 } },
	{ 2, 3, true, { 0xff } },
	/* some without a clock, beside the break and at the ends */
	{ 4, 1, false, { 0, 0x99 } }, { 3, 5, false, { 0x20, 0x98 } },
	{ 0, 0, false, { 0 }, true }, { 4, 0, false, { 0 }, true }, { 2, 3, false, { 0 }, true },
	{ 6, 7, false, { 0 }, true },
	/* replies equal the prediction for many cycles */
	{ 0, 0, false, { 0 }, true, true }, { 2, 3, false, { 0 }, true, true },
	{ 6, 7, false, { 0 }, true, true },
	/* some ignore FRMW; the first one is the reference clock, before the break */
	{ 4, 0, false, { 0, 0, 0x66 } }, { 1, 0, false, { 0x0f, 0, 0xfe } },
	{ 8, 0, false, { 0, 0, 0x88 } }, { 5, 0, true, { 0, 0, 0x24 } },
	/* behind it: they run free at the rate that they have learned */
	{ 0, 0, false, { 0, 0, 0x66 } },
};

static void cut_desc(const struct cut *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE,
		 "before %u, reference %u%s, 0x%x narrow, 0x%x none, 0x%x deaf%s%s", p->at, p->ref,
		 p->leads ? " led" : "", p->kinds.narrow, p->kinds.none,
		 p->kinds.deaf, p->kernel ? ", kernel's cycle" : "", p->still ? ", still" : "");
}

KUNIT_ARRAY_PARAM(cut, cuts, cut_desc);

static void clocks_cut(struct kunit *test)
{
	const struct cut *p = test->param_value;
	struct clocks *k = clocks_new(clocks_bus_of(test, 250, p->kinds));
	s64 before, most, end, healed;

	k->leads = p->leads;
	k->kernel = p->kernel;
	k->still = p->still;
	k->none = p->kinds.none;
	k->deaf = p->kinds.deaf;
	bus_plug_scanned(k->b, SLAVES, 5000);
	clocks_activate(k, p->ref);
	before = clocks_run(k, 1000);
	expect_led(k, "with a closed ring");
	ring_cable(k->b, true, p->at);
	most = clocks_run(k, 1500);
	ring_open(k->b, p->at);
	end = clocks_run(k, 500);
	expect_led(k, "with an open ring");
	ring_cable(k->b, false, p->at);
	healed = clocks_run(k, 1500);
	healed = max(healed, clocks_run(k, 500));
	expect_led(k, "when it has healed");
	ring_closed(k->b, SLAVES);
	bus_figure("ring cut before slave %u, reference slave %u%s: clocks apart %lld ns before, at most %lld in 1.5 s after it, then %lld, at most %lld in 2 s after it has healed",
		   p->at, p->ref, p->leads ? " synchronized to the application" : "", before, most,
		   end, healed);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	clocks_on_grid(k);
	KUNIT_EXPECT_LE(test, before, GOAL_NS);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
}

/* Cuts and repairs at random cables and instants, also while frames are on their way. */
static void clocks_random(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 3);
	struct rnd_state rnd;
	u32 at = 0, i;
	s64 most = 0;

	prandom_seed_state(&rnd, 41);
	for (i = 0; i < EVENTS; i++) {
		at = ring_next_cut(k->b, at, i % 2, prandom_u32_state(&rnd) % CUTS);
		ring_cable_of(k->b, !(i % 2), at, SLAVES,
			      NSEC_PER_MSEC + prandom_u32_state(&rnd) % (NSEC_PER_MSEC / 4));
		most = max(most, clocks_run(k, 2 + prandom_u32_state(&rnd) % 400));
	}
	most = max(most, clocks_run(k, 200));
	ring_closed(k->b, SLAVES);
	bus_figure("ring of clocks, %u random cuts and repairs: clocks apart at most %lld ns",
		   EVENTS, most);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
}

/* Minutes with an open ring. */
static void clocks_stay(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
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
static void clocks_power_off(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
	s64 most, back, end;
	s32 delay[SLAVES];

	note_delays(k, delay);
	k->absent = BIT(3);
	bus_command(k->b, "off d4");
	most = clocks_run(k, 2000);
	ring_state(k->b, EC_RING_OPEN, 3, SLAVES - 1);
	expect_delays(k, delay, 4, "a slave has no power");
	bus_command(k->b, "on d4");
	k->empty = 0;
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	ring_closed(k->b, SLAVES);
	/* the delays of the one that is back were measured meanwhile */
	KUNIT_EXPECT_EQ(test, k->opened, 1u);
	KUNIT_EXPECT_EQ(test, k->empty, 0u);
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
	struct clocks *k = clocks_start(clocks_bus(test), p->ref);
	s64 most, back, end;

	if (p->at >= 0) {
		ring_cable(k->b, true, p->at);
		clocks_run(k, 1000);
	}
	clocks_note_line(k);
	k->lost = true;
	k->absent = p->absent;
	clocks_power(k, p->ref, false);
	most = clocks_run(k, 2000);
	KUNIT_EXPECT_NE(test, bus_status(k->b)->dc_ref, 0u);
	/* from now on the line of the new one */
	k->lost = false;
	k->ref = clocks_ref(k);
	clocks_power(k, p->ref, true);
	if (p->at >= 0)
		ring_cable(k->b, false, p->at);
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	clocks_on_grid(k);
	ring_closed(k->b, SLAVES);
	bus_figure("ring open before slave %d loses reference clock %u: clocks %lld ns from its line at most in 2 s; back: the others apart %lld ns at most, all %lld then",
		   p->at, p->ref, most, back, end);
	KUNIT_EXPECT_LE(test, most, LOST_NS);
	KUNIT_EXPECT_LE(test, back, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

static void map_drive(struct cyc *c, u32 config)
{
	struct ec_ioc_sc_sync sm = { .config = config, .sm = 2, .dir = EC_CFG_DIR_OUTPUT };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_SYNC, &sm), 0);
	sm.sm = 3;
	sm.dir = EC_CFG_DIR_INPUT;
	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_SYNC, &sm), 0);
	cyc_remap(c, config);
	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
}

/* The third and the fourth slave are a hot connect group, known by its alias. */
static void map_group(struct clocks *k)
{
	const struct ec_slave *like = bus_slave(k->b, 0);
	struct ec_ioc_group g = {
		.by = EC_GROUP_BY_ALIAS, .value = 60, .at = EC_UAPI_NONE32, .name = "x",
	};
	struct ec_ioc_group_config m = {
		.vendor_id = like->info.vendor, .product_code = like->info.product,
	};
	u32 i;

	cyc_map_all(k->c, 0, 2, 0);
	KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_GROUP, &g), 0);
	m.group = g.index;
	for (m.member = 0; m.member < 2; m.member++) {
		KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_GROUP_CONFIG, &m), 0);
		map_drive(k->c, m.index);
	}
	for (i = 2; i < SLAVES - 2; i++) {
		struct ec_ioc_slave_config sc = {
			.position = i, .vendor_id = like->info.vendor,
			.product_code = like->info.product,
		};

		KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
		map_drive(k->c, sc.index);
	}
}

/* The reference clock is in a group that is removed: the next one continues its line. */
static void clocks_lose_group(struct kunit *test)
{
	struct clocks *k = clocks_new(clocks_bus(test));
	s64 most, back, end;

	k->map = map_group;
	bus_command(k->b, "eeprom d3 word=4 value=60");
	bus_plug_scanned(k->b, SLAVES, 5000);
	clocks_activate(k, 2);
	clocks_note_line(k);
	k->lost = true;
	k->absent = BIT(2) | BIT(3);
	bus_command(k->b, "unplug d3.0");
	bus_command(k->b, "unplug d4.1");
	most = clocks_run(k, 2000);
	KUNIT_EXPECT_NE(test, bus_status(k->b)->dc_ref, 0u);
	ring_state(k->b, EC_RING_OPEN, 2, SLAVES - 2);
	KUNIT_EXPECT_EQ(test, cyc_state(k->c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
	k->lost = false;
	k->ref = clocks_ref(k);
	bus_command(k->b, "plug d2.1 d3.0");
	bus_command(k->b, "plug d4.1 d5.0");
	back = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	back = max(back, k->most);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	ring_closed(k->b, SLAVES);
	bus_figure("ring loses a group with the reference clock: clocks %lld ns from its line at most in 2 s; back: the others apart %lld ns at most, all %lld then",
		   most, back, end);
	KUNIT_EXPECT_LE(test, most, LOST_NS);
	KUNIT_EXPECT_LE(test, back, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* What is between two cuts stops; the clocks of the others go on. */
static void clocks_second_cut(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
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

/* All replies equal the prediction, from the first one on; then the clock is lost. */
static void clocks_reply_equals(struct kunit *test)
{
	struct ec_dc *dc = kunit_kzalloc(test, sizeof(*dc), GFP_KERNEL);
	struct ec_ring_clock r = { .break_seen = 2, .samples = 64, .shift = -300 };
	struct ec_ring_clock_flight f;
	u8 frame[64], reply[64];
	u32 i, time, valid = 0;

	KUNIT_ASSERT_NOT_NULL(test, dc);
	dc->behind.ref = true;
	for (i = 0; i < 10; i++) {
		struct ec_frame_buf fb;
		const u8 *data = reply;
		bool lost = i >= 5;
		u8 *sent;

		ec_frame_begin(&fb, frame, sizeof(frame));
		ec_ring_clock_fill(&r, dc, &fb, 0, 1000 * i, false, &f);
		sent = fb.last + EC_DGRAM_HDR;
		put_unaligned_le32(lost ? get_unaligned_le32(sent) : 1000 * i - 300, reply);
		put_unaligned_le16(lost ? 7 : 8, reply + 4);
		valid += ec_ring_clock_take(&r, dc, &f, &data, &time);
	}
	KUNIT_EXPECT_EQ(test, valid, 5u);
}

#define SENDS	1000

/* What is predicted on average so long after the last reply, less that time; 1e-3 ns. */
static s64 predicted_after(struct ec_dc_datagrams *k, u32 since_ns)
{
	struct ec_frame_buf fb;
	u8 frame[64];
	s64 sum = 0;
	u32 i;

	for (i = 1; i <= SENDS; i++) {
		k->time_ns = i * 1000003ull;
		ec_frame_begin(&fb, frame, sizeof(frame));
		ec_dc_datagrams_fill(k, &fb, 0, EC_SEND_FLAG_SYNC_SLAVES, k->time_ns + since_ns);
		sum += k->sent - k->time - since_ns;
	}
	return sum;
}

/* Clocks that take the predicted time take no rate from late sends: parts of a ns count. */
static void clocks_predicted(struct kunit *test)
{
	struct ec_dc *dc = kunit_kzalloc(test, sizeof(*dc), GFP_KERNEL);
	static const s32 rates[] = { 13400, -13400, 600, -50 };
	u32 i, us;

	KUNIT_ASSERT_NOT_NULL(test, dc);
	for (i = 0; i < ARRAY_SIZE(rates); i++)
		for (us = 960; us <= 1040; us += 10) {
			struct ec_dc_datagrams k = {
				.dc = dc, .ppb = rates[i], .time = 1ull << 60, .wkc = 1,
			};
			s64 off = predicted_after(&k, us * 1000) - rates[i] * (s64)us / 1000;

			KUNIT_EXPECT_LE_MSG(test, abs(off), 60, "%d ppb, %u us", rates[i], us);
		}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(clocks_predicted),
	KUNIT_CASE(clocks_reply_equals),
	KUNIT_CASE_PARAM(clocks_cut, cut_gen_params),
	KUNIT_CASE(clocks_random),
	KUNIT_CASE(clocks_stay),
	KUNIT_CASE(clocks_power_off),
	KUNIT_CASE(clocks_second_cut),
	KUNIT_CASE_PARAM(clocks_lose_ref, loss_gen_params),
	KUNIT_CASE(clocks_lose_group),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_clocks", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
