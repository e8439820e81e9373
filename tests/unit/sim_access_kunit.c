// SPDX-License-Identifier: GPL-2.0-only
/* What the master may write: register by register, and write protection. */
#include "sim_esc_kunit.h"

enum access {
	RO,	/* counts, changes nothing */
	RW,	/* the value stays */
	CLEAR,	/* any write makes it 0 */
	NONE,	/* does not answer */
};

/* registers of ETG.1000.4 clause 6; those that act by themselves have cases of their own */
static const struct {
	u16 reg;
	u8 len;
	enum access access;
	u16 mask;	/* bits to try, of each byte pair */
} regs[] = {
	{ 0x0000, 8, RO, 0xffff }, { 0x0008, 2, RO, 0xffff },
	{ 0x0012, 2, RO, 0xffff }, { 0x0021, 1, RW, 0x00 },
	{ 0x0031, 1, RW, 0x00 }, { 0x0100, 1, RW, 0x01 },
	{ 0x0102, 2, RW, 0x0107 }, { 0x0108, 2, RW, 0xffff },
	{ 0x0110, 2, RO, 0xffff }, { 0x0130, 2, RO, 0xffff },
	{ 0x0134, 2, RO, 0xffff }, { 0x0140, 2, RO, 0xffff },
	{ 0x0150, 4, RO, 0xffff }, { 0x0200, 2, RW, 0xffff },
	{ 0x0204, 4, RO, 0xffff }, { 0x0210, 2, RO, 0xffff },
	{ 0x0220, 4, RO, 0xffff }, { 0x0300, 8, CLEAR, 0xffff },
	{ 0x0308, 4, CLEAR, 0xffff }, { 0x030c, 1, CLEAR, 0xff },
	{ 0x030d, 1, CLEAR, 0xff }, { 0x030e, 2, RO, 0xffff },
	{ 0x0310, 4, CLEAR, 0xffff }, { 0x0400, 2, RW, 0xffff },
	{ 0x0410, 2, RW, 0xffff }, { 0x0420, 2, RW, 0xffff },
	{ 0x0440, 2, RO, 0xffff }, { 0x0442, 1, CLEAR, 0xff },
	{ 0x0443, 1, CLEAR, 0xff }, { 0x0500, 1, RW, 0x01 },
	{ 0x0501, 1, RO, 0xff }, { 0x0504, 4, RW, 0xffff },
	{ 0x0508, 8, RW, 0xffff }, { 0x0510, 1, RO, 0xff },
	{ 0x0512, 2, RW, 0x1f1f }, { 0x0514, 2, RW, 0xffff },
	{ 0x0516, 1, RW, 0x01 }, { 0x0518, 4, RO, 0xffff },
	{ 0x0600, 8, RW, 0x0707 }, { 0x0608, 2, RW, 0xffff },
	{ 0x060a, 2, RW, 0x0307 }, { 0x060c, 1, RW, 0x01 },
	{ 0x0670, 2, RW, 0xffff }, { 0x0680, 8, NONE, 0xffff },
	{ 0x0800, 4, RW, 0xffff }, { 0x0804, 1, RW, 0x7f },
	{ 0x0805, 1, RO, 0xff }, { 0x0806, 1, RW, 0xc2 },
	{ 0x0807, 1, RO, 0xff }, { 0x0838, 4, RW, 0xffff },
	{ 0x0840, 8, NONE, 0xffff }, { 0x0904, 8, RO, 0xffff },
	{ 0x090c, 4, RO, 0xffff }, { 0x0918, 8, RO, 0xffff },
	{ 0x0920, 8, RW, 0xffff }, { 0x0928, 4, RW, 0xffff },
	{ 0x092c, 4, RO, 0xffff }, { 0x0930, 2, RW, 0x7fff },
	{ 0x0932, 2, RO, 0xffff }, { 0x0934, 2, RW, 0x0f0f },
	{ 0x0980, 2, RW, 0x0600 }, { 0x0982, 2, RO, 0xffff },
	{ 0x0984, 1, RO, 0xff }, { 0x098e, 2, RO, 0xffff },
	{ 0x0990, 8, RW, 0xffff }, { 0x0998, 8, RO, 0xffff },
	{ 0x09a0, 8, RW, 0xffff }, { 0x09a8, 2, RW, 0x0303 },
	{ 0x09ae, 2, RO, 0xffff }, { 0x09b0, 8, RO, 0xffff },
	{ 0x09b8, 8, RO, 0xffff }, { 0x09c0, 8, RO, 0xffff },
	{ 0x09c8, 8, RO, 0xffff }, { 0x09f0, 4, RO, 0xffff },
	{ 0x09f8, 8, RO, 0xffff }, { 0x0e00, 8, RO, 0xffff },
	{ 0x0f00, 4, RW, 0xffff }, { 0x0f10, 8, RW, 0xffff },
	{ 0x0f18, 8, RO, 0xffff }, { 0x0f80, 8, RW, 0xffff },
	{ 0x0fff, 2, NONE, 0xffff }, { 0x1000, 8, RW, 0xffff },
	{ 0x2ff8, 8, RW, 0xffff }, { 0x2ff9, 8, NONE, 0xffff },
};

static u64 wide(u16 mask, u32 len)
{
	u64 v = mask * 0x0001000100010001ull;

	return len < 8 ? v & ((1ull << 8 * len) - 1) : v;
}

static void sim_access_every_register_has_its_access(struct kunit *test)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(regs); i++) {
		struct bed *b = bed_new(test, 2, 1);
		struct ec_esc *esc = ec_sim_slave(b->sim, 0);
		u16 reg = regs[i].reg, len = regs[i].len;
		u64 put = wide(regs[i].mask, len), was, got;
		int want = regs[i].access == NONE ? 0 : 1;

		if (regs[i].access == CLEAR)
			memset(esc->mem + reg, 3, len);
		bed_get(b, 1001, reg, len);	/* reading clears events */
		was = bed_get(b, 1001, reg, len);
		if (regs[i].access == RO)
			put &= ~was ? ~was : 0;	/* what differs */
		KUNIT_EXPECT_EQ_MSG(test, bed_put(b, 1001, reg, put, len),
				    want, "0x%04x", reg);
		got = bed_get(b, 1001, reg, len);
		KUNIT_EXPECT_EQ_MSG(test, got, regs[i].access == RW ? put :
				    regs[i].access == CLEAR ? 0 : was,
				    "0x%04x", reg);
		ec_sim_free(b->sim);
		test->priv = NULL;
	}
}

/* command @n of a frame */
struct piece {
	u16 reg;
	u16 val;
	int wkc;
};

/* FPWRs of 2 bytes in one frame */
static void one_frame(struct kunit *test, struct bed *b, struct piece *p,
		      u32 n)
{
	struct ec_frame_buf f;
	struct ec_frame_iter it;
	struct ec_dgram d;
	size_t len;
	u32 i;

	ec_frame_begin(&f, b->frame, sizeof(b->frame));
	for (i = 0; i < n; i++)
		put_unaligned_le16(p[i].val, (u8 *)ec_frame_add(&f, EC_CMD_FPWR,
				   (u8)i, 1001, p[i].reg, 2));
	len = ec_frame_end(&f);
	KUNIT_ASSERT_GT(test, ec_sim_frame(b->sim, 0, b->frame, len, b->now), 0);
	b->now += b->gap;
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, b->frame, len), 0);
	for (i = 0; i < n; i++) {
		KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
		p[i].wkc = ec_dgram_wkc(&d);
	}
}

static void sim_access_protected_registers_open_for_one_frame(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct piece open[] = {
		{ 0x0400, 0x1111, 0 }, { 0x0020, 0x0100, 0 },
		{ 0x0410, 0x2222, 0 }, { 0x0420, 0x3333, 0 },
	};

	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x21, 0xff, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x21, 1), 1ull);
	/* counts, changes nothing; the rest of the memory is free */
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x400, 0x1234, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x400, 2), 0x9c2ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x120, 2, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x120, 2), 1ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0xf7c, ~0ull, 8), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0xf7c, 8), 0xffffffff00000000ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x1000, 0x55, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x1000, 1), 0x55ull);
	bed_put(b, 1001, 0x900, 0, 4);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x900, 4), 0ull);

	/* what stands before the enable in the frame is held back */
	one_frame(test, b, open, ARRAY_SIZE(open));
	KUNIT_EXPECT_EQ(test, open[0].wkc, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x400, 2), 0x9c2ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x410, 2), 0x2222ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x420, 2), 0x3333ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x21, 1), 1ull);
	bed_put(b, 1001, 0x410, 0x4444, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x410, 2), 0x2222ull);
	/* a 1 does not open */
	open[1].val = 1;
	open[2].val = 0x5555;
	one_frame(test, b, open, ARRAY_SIZE(open));
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x410, 2), 0x2222ull);
	/* enable and "off" in one write */
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x20, 0, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x21, 1), 0ull);
	bed_put(b, 1001, 0x410, 0x4444, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x410, 2), 0x4444ull);
}

static void sim_access_protected_controller_keeps_its_memory(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	struct piece regs_only[] = { { 0x20, 0, 0 }, { 0x400, 1, 0 } };
	struct piece both[] = { { 0x30, 0x0100, 0 }, { 0x1000, 0x7777, 0 } };
	u8 v[2] = { 0x66, 0x66 }, w[2];

	bed_sm(b, 1001, 2, 0x1100, 2, 0x24);
	bed_fmmu(b, 1001, 0, (struct ec_fmmu){ 0x10000, 2, 0, 7, 0x1200, 0, 2, 1 });
	bed_put(b, 1001, 0x31, 1, 1);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x1000, 0x55, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x1000, 1), 0ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0xf80, 0x55, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0xf80, 1), 0ull);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2), 1);
	KUNIT_EXPECT_FALSE(test, ec_esc_sm_readable(esc, 2));
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 0, 1, v, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x1200, 2), 0ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x2fff, 1, 2), 0);
	one_frame(test, b, regs_only, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x400, 2), 0x9c2ull);
	/* the PDI is not held back */
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_write(esc, 0x1300, v, 2, b->now), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1300, w, 2), 1);
	KUNIT_EXPECT_EQ(test, w[0], 0x66);

	one_frame(test, b, both, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x1000, 2), 0x7777ull);
	bed_put(b, 1001, 0x1000, 0, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x1000, 2), 0x7777ull);
	/* both: each wants its own */
	bed_put(b, 1001, 0x30, 0, 2);
	bed_put(b, 1001, 0x21, 1, 1);
	bed_put(b, 1001, 0x30, 0x0100, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x31, 1), 0ull);
	bed_put(b, 1001, 0x20, 0, 2);
	bed_put(b, 1001, 0x30, 0x0100, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x31, 1), 1ull);
}

static void sim_access_unused_registers_may_be_out_of_bounds(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);
	u8 v[16];

	b->cfg.features |= EC_FEAT_NO_UNUSED;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x130, v, 6), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x600, v, 16), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x000, v, 10), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x000, v, 11), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x00a, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x680, v, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x050, 0, 1), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1000, v, 16), 1);
}

static void sim_access_fixed_pages_keep_their_use(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);

	b->cfg.features |= EC_FEAT_FIXED_FMMU_SM;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x80c, 1), 0x02ull);
	bed_sm(b, 1001, 0, 0x1000, 16, 0x22);
	bed_sm(b, 1001, 3, 0x1100, 4, 0x64);
	bed_fmmu(b, 1001, 1, (struct ec_fmmu){ 0, 2, 0, 7, 0x1100, 0, 2, 1 });
	bed_fmmu(b, 1001, 3, (struct ec_fmmu){ 0, 2, 0, 7, 0x1100, 0, 2, 1 });
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x804, 1), 0x26ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x81c, 1), 0x60ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x61b, 1), 1ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x63b, 1), 2ull);
}

static void sim_access_phy_commands_need_their_enable(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	u8 pdi = 1;

	bed_put(b, 1001, 0x512, 0x0200, 2);	/* port 0, register 2 */
	bed_put(b, 1001, 0x510, 0x0100, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x514, 2), 0x22ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 4ull);
	bed_put(b, 1001, 0x510, 0x0200, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 0x4004ull);
	bed_put(b, 1001, 0x510, 0x0201, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 4ull);
	bed_put(b, 1001, 0x512, 0x0207, 2);	/* nobody there */
	bed_put(b, 1001, 0x510, 0x0100, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 0x2004ull);
	/* the PDI may take it, and be sent off */
	ec_esc_pdi_write(ec_sim_slave(b->sim, 0), 0x517, &pdi, 1, b->now);
	bed_put(b, 1001, 0x510, 0x0000, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 0x2004ull);
	bed_put(b, 1001, 0x517, 2, 1);
	bed_put(b, 1001, 0x510, 0x0000, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x510, 2), 4ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_access_every_register_has_its_access),
	KUNIT_CASE(sim_access_protected_registers_open_for_one_frame),
	KUNIT_CASE(sim_access_protected_controller_keeps_its_memory),
	KUNIT_CASE(sim_access_unused_registers_may_be_out_of_bounds),
	KUNIT_CASE(sim_access_fixed_pages_keep_their_use),
	KUNIT_CASE(sim_access_phy_commands_need_their_enable),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_access",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
