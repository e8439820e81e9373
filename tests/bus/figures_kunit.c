// SPDX-License-Identifier: GPL-2.0-only
/* Figures in bus time, printed and held to their limits. */
#include "bus.h"

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
	bus_figure("scan to PREOP, %u slaves, %zu bytes of EEPROM, %u-byte ESCs: %llu us of bus time, %llu frames (scan %u us, %llu frames)",
		   n, bytes, eight ? 8 : 4, us, bus_frames(b), b->m->scan_us, b->m->scan_frames);
	for (i = 0; i < n; i++)
		KUNIT_ASSERT_EQ(test, bus_slave(b, i)->sii_bytes, bytes);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	return b;
}

static u64 scan_us(struct kunit *test, u32 n, size_t bytes, bool eight)
{
	struct bus *b = scan(test, n, bytes, eight);

	return div_u64(ktime_get_ns() - b->t0, 1000);
}

static void figures_scan_100(struct kunit *test)
{
	KUNIT_EXPECT_LT(test, scan_us(test, 100, 1024, true), 200000ull);
}

static void figures_scan_1000(struct kunit *test)
{
	KUNIT_EXPECT_LT(test, scan_us(test, 1000, 1024, true), 800000ull);
}

static void figures_scan_1000_4byte(struct kunit *test)
{
	KUNIT_EXPECT_LT(test, scan_us(test, 1000, 1024, false), 1300000ull);
}

static void figures_scan_frames(struct kunit *test)
{
	KUNIT_EXPECT_LE(test, bus_frames(scan(test, 100, 2048, true)), 2200ull);
}

static struct kunit_case figures_cases[] = {
	KUNIT_CASE(figures_scan_100),
	KUNIT_CASE(figures_scan_1000),
	KUNIT_CASE(figures_scan_1000_4byte),
	KUNIT_CASE(figures_scan_frames),
	{}
};

static struct kunit_suite figures_suite = {
	.name = "bus_figures",
	.exit = bus_exit,
	.test_cases = figures_cases,
};

kunit_test_suite(figures_suite);

MODULE_LICENSE("GPL");
