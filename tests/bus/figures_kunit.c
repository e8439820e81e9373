// SPDX-License-Identifier: GPL-2.0-only
/* Figures in bus time, printed and held to their limits. */
#include "cyc.h"
#include "slow.h"

/* a scan of @n slaves with @bytes of EEPROM each, 1 us of delay a slave */
static struct bus *scan(struct kunit *test, u32 n, size_t bytes, bool eight)
{
	struct bus *b;
	char text[160];
	u64 us;
	u32 i;

	snprintf(text, sizeof(text),
		 "segment seed=7\nrepeat %u slave d drive in=8 out=8 delay=500ns cable=0\n", n);
	b = bus_new(test, text);
	for (i = 0; i < n; i++) {
		struct ec_esc *esc = bus_esc(b, i);

		esc->cfg.eeprom_8byte = eight;
		esc->cfg.forward_ns = 500;
		KUNIT_ASSERT_EQ(test, esc->cfg.eeprom_busy_ns, 740000);
		KUNIT_ASSERT_EQ(test, esc->cfg.process_ns, 500);
		bus_fill_eeprom(b, i, bytes);
	}
	bus_plug(b);
	us = bus_wait(b, n, EC_AL_PREOP, 20000);
	KUNIT_ASSERT_NE(test, us, ~0ull);
	bus_figure("scan to PREOP, %u slaves, %zu bytes of EEPROM, %u-byte ESCs: %llu us of bus time; the scan itself %u us, %llu frames",
		   n, bytes, eight ? 8 : 4, us, bus_table(b)->scan_us, bus_scan_frames(b));
	for (i = 0; i < n; i++)
		KUNIT_ASSERT_EQ(test, bus_slave(b, i)->eeprom.bytes, bytes);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	return b;
}

static void scan_within(struct kunit *test, u32 n, size_t bytes, bool eight, u64 limit_us)
{
	struct bus *b = scan(test, n, bytes, eight);
	u64 us = div_u64(ktime_get_ns() - b->t0, 1000);

	bus_row(us, limit_us, "us of bus time: scan of %u slaves to PREOP, %u-byte ESCs", n,
		eight ? 8 : 4);
	KUNIT_EXPECT_LT(test, us, limit_us);
}

static void figures_scan_100(struct kunit *test)
{
	scan_within(test, 100, 1024, true, 200000);
}

static void figures_scan_1000(struct kunit *test)
{
	scan_within(test, 1000, 1024, true, 800000);
}

static void figures_scan_1000_4byte(struct kunit *test)
{
	scan_within(test, 1000, 1024, false, 1300000);
}

static void figures_scan_frames(struct kunit *test)
{
	struct bus *b = scan(test, 100, 2048, true);

	/* reading PDOs comes later and is another matter */
	KUNIT_EXPECT_EQ(test, bus_scans(b), 1u);
	bus_row(bus_scan_frames(b), 2200, "frames: scan of 100 slaves with 2 KiB to PREOP");
	KUNIT_EXPECT_LE(test, bus_scan_frames(b), 2200ull);
}

/* Frames for each of @n slaves until all are in PREOP, in hundredths. */
static u64 frames_to_preop(struct kunit *test, u32 n, const char *transition, u32 slowness)
{
	char text[160];
	struct bus *b;
	u64 us, frames;
	u32 whole, rest;

	snprintf(text, sizeof(text),
		 "segment seed=7 transition=%s\nrepeat %u slave d drive in=8 out=8\n", transition, n);
	b = bus_new(test, text);
	if (slowness)
		slow_plug(b, 64, slowness);
	else
		bus_plug(b);
	us = bus_wait(b, n, EC_AL_PREOP, 60000);
	KUNIT_ASSERT_NE(test, us, ~0ull);
	frames = ec_links_sent(bus_links(b));
	frames = div_u64(100 * frames, n);
	whole = (u32)div_u64_rem(frames, 100, &rest);
	bus_figure("frames to PREOP, %u slaves, transition of %s%s: %u.%02u a slave, %llu us",
		   n, transition, slowness ? ", 25 Mbit/s" : "", whole, rest, us);
	bus_exit(test);
	return frames;
}

/* More slaves need no more frames each, however long a transition and a frame take. */
static void figures_frames_each(struct kunit *test)
{
	static const struct {
		const char *transition;
		u32 slowness;
	} segments[] = { { "1ms", 0 }, { "15ms", 0 }, { "1ms", 4 }, { "15ms", 4 } };
	u32 i;

	for (i = 0; i < ARRAY_SIZE(segments); i++) {
		const char *t = segments[i].transition;
		u32 slowness = segments[i].slowness;
		u64 some, many;

		frames_to_preop(test, 100, t, slowness);
		some = frames_to_preop(test, 500, t, slowness);
		many = frames_to_preop(test, 1000, t, slowness);
		bus_row(div64_u64(100 * many, some), 110,
			"%% of the frames each of 500 slaves needs to PREOP: each of 1000, transition of %s%s",
			t, slowness ? ", 25 Mbit/s" : "");
		KUNIT_EXPECT_LE(test, 100 * many, 110 * some);
	}
}

#define RESPONSE_US	100
#define TRANSITION_US	1000

/*
 * Drives to OP, mapping and assignment of each written over CoE. What the
 * slaves take themselves: two transitions and one response for every SDO of
 * one of them; they work side by side. Returns the time without that.
 */
static u64 activate(struct kunit *test, u32 drives, u32 period_us)
{
	static const u32 sdos = 2 * (2 + ARRAY_SIZE(cyc_new_in)) + 2 * 4;
	u64 us, own = 2 * TRANSITION_US + sdos * RESPONSE_US, frames;
	struct cyc *c;
	struct bus *b;
	char text[160];
	u32 i;

	snprintf(text, sizeof(text), "segment seed=11 response=100us transition=1ms\n"
		 "repeat %u slave d drive in=22 out=22 mapping=rewritable\n", drives);
	b = bus_up(test, text, drives);
	bus_idle(b);
	c = cyc_new(b, period_us);
	cyc_domain(c);
	for (i = 0; i < drives; i++) {
		u32 config = cyc_config(c, i);

		cyc_remap(c, config);
		cyc_map(c, config, 2, 0);
		cyc_map(c, config, 3, 0);
	}
	frames = bus_frames(b);
	cyc_activate(c);
	us = cyc_wait_op(c, 60000);
	KUNIT_ASSERT_NE(test, us, ~0ull);
	bus_figure("activate to OP, %u drives, PDO mapping rewritten over CoE, cycle of %u us: %llu us of bus time, of which the slaves take some %llu us; %llu frames",
		   drives, period_us, us, own, bus_frames(b) - frames);
	for (i = 0; i < drives; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->note.error, EC_SLAVE_OK);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	return us - own;
}

static void figures_activate_100(struct kunit *test)
{
	u64 us = activate(test, 100, 1000);

	bus_row(us, USEC_PER_SEC, "us of bus time: 100 drives to OP, mapping rewritten");
	KUNIT_EXPECT_LT(test, us, (u64)USEC_PER_SEC);
}

static void figures_activate_1000(struct kunit *test)
{
	KUNIT_EXPECT_LT(test, activate(test, 1000, 4000), 10ull * USEC_PER_SEC);
}

static struct kunit_case figures_cases[] = {
	KUNIT_CASE(figures_scan_100),
	KUNIT_CASE(figures_scan_1000),
	KUNIT_CASE(figures_scan_1000_4byte),
	KUNIT_CASE(figures_scan_frames),
	KUNIT_CASE(figures_frames_each),
	KUNIT_CASE(figures_activate_100),
	KUNIT_CASE(figures_activate_1000),
	{}
};

static struct kunit_suite figures_suite = {
	.name = "bus_figures",
	.exit = bus_exit,
	.test_cases = figures_cases,
};

kunit_test_suite(figures_suite);

MODULE_LICENSE("GPL");
