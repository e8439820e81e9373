// SPDX-License-Identifier: GPL-2.0-only
/* Large EEPROMs are read in parts; neither the other slaves nor the monitor wait for them. */
#include "bus.h"

#define N	6

static const char line[] =
	"segment seed=5 response=100us transition=200us\n"
	"slave a EK1100\nslave b EL2008\nslave c EL3062\n"
	"slave d EL4002\nslave e EL1008\nslave f EL2004\n";

/* Plug in; all but slave 5 are in PREOP within @limit_ms. */
static void others_fine(struct bus *b, u32 limit_ms)
{
	u32 i;

	bus_plug_scanned(b, N, limit_ms);
	for (i = 0; i < 5; i++)
		KUNIT_EXPECT_EQ_MSG(b->test, bus_slave(b, i)->al.status, EC_AL_PREOP,
				    "slave %u: %s",
				    i, bus_slave(b, i)->note.why);
}

/*
 * Slave 5 has an EEPROM of @len bytes, used up to its end, where the words differ; 8 bytes
 * an access. A category has less than 128 KiB.
 */
static void enlarge(struct bus *b, size_t len)
{
	struct ec_esc *esc = bus_esc(b, 5);
	u8 *data = ec_sim_alloc(b->sim, len + 1);
	size_t i, k, body;

	KUNIT_ASSERT_NOT_NULL(b->test, data);
	memset(data, 0xff, len);
	memcpy(data, esc->eep.data, esc->eep.len);
	ec_sim_release(b->sim, esc->eep.data);
	esc->eep.data = data;
	esc->eep.len = len;
	put_unaligned_le16(len / 128 - 1, data + 2 * EC_SII_W_SIZE);
	for (i = ec_sii_used(data, len) - 2; i + 2 < len; i += 4 + body) {
		body = min_t(size_t, len - i - 6, 2 * 0xf000);
		if (len - i - 6 - body == 2)
			body -= 2;
		put_unaligned_le16(0x0900, data + i);
		put_unaligned_le16(body / 2, data + i + 2);
		for (k = 0; k < body; k += 2)
			put_unaligned_le16((i + k) / 2 * 7, data + i + 4 + k);
	}
	KUNIT_ASSERT_EQ(b->test, ec_sii_used(data, len), len);
}

/* Until slave 5 is in PREOP; the longest time without a look of the monitor, ns. */
static u64 until_read(struct bus *b, u32 limit_ms)
{
	u64 end = ktime_get_ns() + (u64)limit_ms * NSEC_PER_MSEC, gap = 0;

	while (ktime_get_ns() < end && bus_slave(b, 5)->al.status != EC_AL_PREOP) {
		usleep_range(1000, 1001);
		if (bus_table(b)->complete_ns)
			gap = max(gap, ktime_get_ns() - bus_table(b)->complete_ns);
	}
	return gap;
}

static void is_read(struct bus *b, size_t len)
{
	struct ec_slave *s = bus_slave(b, 5);

	KUNIT_EXPECT_EQ(b->test, s->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_STREQ(b->test, s->note.why, "");
	KUNIT_EXPECT_STREQ(b->test, s->note.sii_flaw, "");
	KUNIT_ASSERT_EQ(b->test, s->eeprom.bytes, len);
	KUNIT_EXPECT_MEMEQ(b->test, s->eeprom.data, bus_esc(b, 5)->eep.data, len);
	KUNIT_EXPECT_GE(b->test, atomic_long_read(&bus_table(b)->sii_bytes), (long)len);
	KUNIT_EXPECT_LE(b->test, atomic_long_read(&bus_table(b)->sii_bytes), 4 * (long)len);
}

static void large(struct kunit *test, size_t len)
{
	struct bus *b = bus_new(test, line);
	u32 limit = 4 * len / 8 + 20 * N;
	u64 us;

	bus_esc(b, 5)->cfg.eeprom_busy_ns = 10000;
	enlarge(b, len);
	others_fine(b, 60000);
	until_read(b, 60000);
	us = div_u64(ktime_get_ns() - b->t0, NSEC_PER_USEC);
	bus_figure("an EEPROM of %zu KiB: PREOP after %llu us of bus time, %llu frames", len / 1024,
		   us, bus_frames(b));
	is_read(b, len);
	/* each word is read once: a request and its answer for 8 bytes, and some polls */
	KUNIT_EXPECT_LE(test, bus_frames(b), limit + div_u64(us, 1000));
}

/* One that takes a minute holds up neither the others nor the monitor. */
static void scan_largest_eeprom_delays_no_other_slave(struct kunit *test)
{
	struct bus *b = bus_new(test, line);
	u64 gap;

	enlarge(b, EC_MAX_SII_BYTES);
	others_fine(b, 5000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 5)->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(bus_slave(b, 5)->note.why, "the rest follows"), "%s",
				  bus_slave(b, 5)->note.why);
	gap = until_read(b, 150000);
	bus_figure("an EEPROM of 512 KiB: PREOP after %llu us of bus time; the monitor was busy for %llu us at most",
		   div_u64(ktime_get_ns() - b->t0, NSEC_PER_USEC), div_u64(gap, NSEC_PER_USEC));
	KUNIT_EXPECT_LT(test, gap, 3 * NSEC_PER_SEC);
	is_read(b, EC_MAX_SII_BYTES);
}

/* Another slave in its place meanwhile: it gets nothing of what was read. */
static void scan_large_replaced(struct kunit *test)
{
	struct bus *b = bus_new(test, line);

	enlarge(b, EC_MAX_SII_BYTES);
	others_fine(b, 5000);
	msleep(5000);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 5, 0, 0, 0);
	msleep(1000);
	put_unaligned_le16(EC_SII_CAT_END, bus_esc(b, 5)->eep.data + EC_SII_FIXED_SIZE);
	put_unaligned_le16(0x4711, bus_esc(b, 5)->eep.data + 2 * EC_SII_W_SERIAL);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 5, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 30000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 5)->info.serial & 0xffff, 0x4711u);
	KUNIT_EXPECT_LE(test, bus_slave(b, 5)->eeprom.bytes, 4096ul);
}

/* Word 0x3E counts KiBit: 160 KiB, with words that need more than 16 bits, is legal. */
static void scan_large(struct kunit *test)
{
	large(test, 160 * 1024);
}

/* the largest there is, ETG.1000.6 */
static void scan_largest(struct kunit *test)
{
	large(test, EC_MAX_SII_BYTES);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(scan_large),
	KUNIT_CASE(scan_largest),
	KUNIT_CASE(scan_largest_eeprom_delays_no_other_slave),
	KUNIT_CASE(scan_large_replaced),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_scan_large", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
