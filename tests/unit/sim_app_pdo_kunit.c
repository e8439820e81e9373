// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: assignment, mapping, profiles. */
#include "sim_app_kunit.h"

struct pd {
	struct bed *b;
	struct app_mbox m;
	u16 st;
	u16 in;		/* start of the input SM */
	u8 buf[1486];	/* too large for the stack of a kernel with KASAN */
};

static struct pd *pd_new(struct kunit *test, const char *text)
{
	struct pd *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->b = app_bed(test, text);
	x->st = STATION(0);
	x->m.station = x->st;
	x->m.size = 256;
	app_mbox_sms(x->b, x->st, 256);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->st, EC_AL_PREOP, 5),
			(u32)EC_AL_PREOP);
	return x;
}

static int pd_write(struct pd *x, const u8 *out, u16 n)
{
	memcpy(x->buf, out, n);
	return bed_tx(x->b, EC_CMD_FPWR, x->st, 0x1200, x->buf, n);
}

/* to OP with outputs @out and inputs of @in bytes at 0x1200 and @at */
static u32 pd_op(struct pd *x, const u8 *out, u16 n_out, u16 at, u16 n_in)
{
	u32 st;

	x->in = at;
	if (n_out)
		bed_sm(x->b, x->st, 2, 0x1200, n_out, 0x64);
	bed_sm(x->b, x->st, 3, at, n_in, 0x20);
	st = app_al(x->b, x->st, EC_AL_SAFEOP, 5);
	if (st != EC_AL_SAFEOP)
		return st;
	if (n_out)
		pd_write(x, out, n_out);
	return app_al(x->b, x->st, EC_AL_OP, 5);
}

static void sim_app_pdo_rules(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive mapping=rewritable\n");
	struct bed *b = x->b;
	struct app_mbox *m = &x->m;

	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 1, 0x1600, 2),
			EC_ABORT_SUB0_FIRST);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 0, 2, 1),
			EC_ABORT_TOO_HIGH);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 0, 0, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 1, 0x1A00, 2),
			EC_ABORT_RANGE);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 1, 0x1650, 2),
			EC_ABORT_RANGE);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60400010, 4),
			EC_ABORT_SUB0_FIRST);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 0, 0, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60410010, 4),
			EC_ABORT_NOT_MAPPABLE);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60400020, 4),
			EC_ABORT_LENGTH);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60400010, 4), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 2, 0x60FF0020, 4), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 0, 2, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 1, 0x1600, 2), 0u);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 0, 1, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C12, 0), 1);
}

static void sim_app_pdo_fixed(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive mapping=fixed\n");

	KUNIT_EXPECT_EQ(test, app_put(x->b, &x->m, 0x1C12, 0, 0, 1),
			EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_EQ(test, app_put(x->b, &x->m, 0x1600, 0, 0, 1),
			EC_ABORT_READ_ONLY);
}

/* a rewritten mapping moves the bytes of the image */
static void sim_app_pdo_rewritten(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive mapping=rewritable\n");
	static const u8 map[] = { 2, 0, 0x20, 0, 0xFF, 0x60, 0x10, 0, 0x40, 0x60 };
	static const u8 assign[] = { 1, 0, 0x00, 0x16 };
	static const u8 bad[] = { 2, 0, 0x20, 0, 0xFF, 0x60, 0x20, 0, 0x40, 0x60 };
	u8 out[8] = { 0xE8, 3, 0, 0, 0x0F, 0 };

	/* not while it is assigned */
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x1600, 0, true, map,
					   sizeof(map)), EC_ABORT_STATE);
	KUNIT_EXPECT_EQ(test, app_put(x->b, &x->m, 0x1C12, 0, 0, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x1600, 0, true, bad,
					   sizeof(bad)), EC_ABORT_LENGTH);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x1600, 1), 0x60400010);
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x1600, 0, true, map,
					   sizeof(map)), 0u);
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x1C12, 0, true, assign,
					   sizeof(assign)), 0u);
	KUNIT_EXPECT_EQ(test, app_put(x->b, &x->m, 0x6060, 0, 9, 1), 0u);
	KUNIT_EXPECT_EQ(test, pd_op(x, out, 8, 0x1300, 8), 0x001D0012u);
	app_al(x->b, x->st, 0x12, 1);
	KUNIT_EXPECT_EQ(test, pd_op(x, out, 6, 0x1300, 8), (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x60FF, 0), 1000);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x6040, 0), 0x0F);
}

/* the catalogue's drives take a mapping while it is assigned */
static void sim_app_pdo_lenient(struct kunit *test)
{
	static const char * const texts[] = { "slave d drive\n", "slave d drive mapping=lenient\n" };
	u8 out[8] = { 0xE8, 3, 0, 0, 0x0F, 0 };

	for (u32 i = 0; i < ARRAY_SIZE(texts); i++) {
		struct pd *x = pd_new(test, texts[i]);
		struct bed *b = x->b;
		struct app_mbox *m = &x->m;

		KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C12, 0), 1);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60FF0020, 4),
				EC_ABORT_SUB0_FIRST);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 0, 0, 1), 0u);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 1, 0x60FF0020, 4), 0u);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 2, 0x60400010, 4), 0u);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 0, 2, 1), 0u);
		KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C12, 0), 1);
		KUNIT_EXPECT_EQ(test, app_put(b, m, 0x6060, 0, 9, 1), 0u);
		KUNIT_EXPECT_EQ(test, pd_op(x, out, 6, 0x1300, 8), (u32)EC_AL_OP);
		KUNIT_EXPECT_EQ(test, app_get(b, m, 0x60FF, 0), 1000);
		KUNIT_EXPECT_EQ(test, app_get(b, m, 0x6040, 0), 0x0F);
		if (!i)
			ec_sim_free(b->sim);	/* bed_exit() frees the other */
	}
}

static void sim_app_pdo_outputs_act_in_op_only(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive\n");
	u8 out[8] = { 6, 0, 0, 0, 0, 0, 8, 0 };

	bed_sm(x->b, x->st, 2, 0x1200, 8, 0x64);
	bed_sm(x->b, x->st, 3, 0x1218, 8, 0x20);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->st, EC_AL_SAFEOP, 5),
			(u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, pd_write(x, out, 8), 1);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x6040, 0), 0);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->st, EC_AL_OP, 5), (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x6040, 0), 6);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->st, EC_AL_SAFEOP, 5),
			(u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x6040, 0), 0);
}

static u16 status(struct pd *x)
{
	return (u16)bed_get(x->b, x->st, x->in, 8);
}

/* switches on and follows a target, as CSP does */
static void sim_app_pdo_position(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive\n");
	u8 out[8] = { 0, 0, 0, 0, 0, 0, 8, 0 }, in[8];
	static const u8 steps[] = { 0x06, 0x07, 0x0F };
	static const u16 want[] = { 0x1231, 0x1233, 0x1237 };

	KUNIT_ASSERT_EQ(test, pd_op(x, out, 8, 0x1218, 8), (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ(test, status(x) & 0x6F, 0x40);
	for (u32 i = 0; i < ARRAY_SIZE(steps); i++) {
		out[0] = steps[i];
		KUNIT_EXPECT_EQ(test, pd_write(x, out, 8), 1);
		KUNIT_EXPECT_EQ(test, status(x) & 0x6F, want[i] & 0x6F);
	}
	/* without voltage it is off, with a quick stop as soon as it stands still */
	out[0] = 0x0D;
	pd_write(x, out, 8);
	KUNIT_EXPECT_EQ(test, status(x) & 0x6F, 0x40);
	for (u32 i = 0; i < ARRAY_SIZE(steps); i++) {
		out[0] = steps[i];
		pd_write(x, out, 8);
	}
	out[0] = 0x0B;
	pd_write(x, out, 8);
	KUNIT_EXPECT_EQ(test, status(x) & 0x6F, 0x07);
	pd_write(x, out, 8);
	KUNIT_EXPECT_EQ(test, status(x) & 0x6F, 0x40);
	out[0] = 0x0D;
	pd_write(x, out, 8);
	for (u32 i = 0; i < ARRAY_SIZE(steps); i++) {
		out[0] = steps[i];
		pd_write(x, out, 8);
	}
	put_unaligned_le32(100000, out + 2);
	for (int i = 0; i < 400; i++) {
		u64 at = x->b->now + 1000000;

		pd_write(x, out, 8);
		bed_rd(x->b, x->st, x->in, in, 8);
		x->b->now = at;
		if (i == 20) {
			s32 pos = (s32)get_unaligned_le32(in + 2);

			KUNIT_EXPECT_GT(test, pos, 20000);
			KUNIT_EXPECT_LT(test, pos, 99000);
		}
	}
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(in + 2), 100000u);
	/* the watchdog clears the outputs, the axis is switched off */
	x->b->now += 200000000;
	KUNIT_EXPECT_EQ(test, app_al_status(x->b, x->st), 0x001B0014u);
	bed_rd(x->b, x->st, x->in, in, 8);
	bed_rd(x->b, x->st, x->in, in, 8);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(in) & 0x6F, 0x40);
}

static void sim_app_pdo_velocity(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave a EL7201\n");
	u8 out[6] = { 0 }, in[6];

	KUNIT_ASSERT_EQ(test, pd_op(x, out, 6, 0x1300, 6), (u32)EC_AL_OP);
	for (int i = 0; i < 1100; i++) {
		u64 at = x->b->now + 1000000;

		out[0] = i < 3 ? "\x06\x07\x0f"[i] : 0x0F;
		put_unaligned_le32(10000, out + 2);
		pd_write(x, out, 6);
		bed_rd(x->b, x->st, x->in, in, 6);
		x->b->now = at;
	}
	/* about a second at 10000 counts/s */
	KUNIT_EXPECT_GT(test, get_unaligned_le32(in), 10500u);
	KUNIT_EXPECT_LT(test, get_unaligned_le32(in), 11000u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(in + 4) & 0x6F, 0x27);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x6010, 7) / 100, 99);
}

static void sim_app_pdo_fillers(struct kunit *test)
{
	struct pd *x = pd_new(test, "slave d drive in=1486 out=1486\n");
	u8 *out = kunit_kzalloc(test, 1486, GFP_KERNEL);
	u8 *in = kunit_kzalloc(test, 1486, GFP_KERNEL);
	u16 at = 0x1200 + 3 * 1486 + 2;

	KUNIT_ASSERT_TRUE(test, out && in);
	for (int i = 18; i < 1486; i++)
		out[i] = (u8)(i * 3);
	KUNIT_ASSERT_EQ(test, pd_op(x, out, 1486, at, 1486), (u32)EC_AL_OP);
	bed_rd(x->b, x->st, at, in, 1486);
	/* behind the objects of the profile: 16 bytes there, 20 here */
	KUNIT_EXPECT_MEMEQ(test, in + 20, out + 16, 1400);
}

static void sim_app_pdo_analog(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave ai EL3062\nslave ao EL4002\n"
		"sine ai.1 amplitude=10000 period=4ms offset=5\n"
		"connect ao.2 -> ai.2\n");
	u16 ai = STATION(0), ao = STATION(1);
	u8 v[8], out[4] = { 0, 0, 0x9C, 0xFF };
	s32 lo = 0, hi = 0;

	for (int i = 0; i < 2; i++) {
		app_mbox_sms(b, STATION(i), 128);
		KUNIT_ASSERT_EQ(test, app_al(b, STATION(i), EC_AL_PREOP, 1),
				(u32)EC_AL_PREOP);
	}
	bed_sm(b, ai, 3, 0x1180, 8, 0x20);
	bed_sm(b, ao, 2, 0x1100, 4, 0x24);
	for (int i = 0; i < 2; i++)
		KUNIT_ASSERT_EQ(test, app_al(b, STATION(i), EC_AL_SAFEOP, 1),
				(u32)EC_AL_SAFEOP);
	bed_tx(b, EC_CMD_FPWR, ao, 0x1100, out, 4);
	for (int i = 0; i < 2; i++)
		KUNIT_ASSERT_EQ(test, app_al(b, STATION(i), EC_AL_OP, 1),
				(u32)EC_AL_OP);
	for (int i = 0; i < 400; i++) {
		bed_rd(b, ai, 0x1180, v, 8);
		lo = min(lo, (s32)(s16)get_unaligned_le16(v + 2));
		hi = max(hi, (s32)(s16)get_unaligned_le16(v + 2));
	}
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v + 6), 0xFF9C);
	KUNIT_EXPECT_GE(test, hi, 9990);
	KUNIT_EXPECT_LE(test, hi, 10005);
	KUNIT_EXPECT_LE(test, lo, -9980);
	KUNIT_EXPECT_GE(test, lo, -9995);
}

static void sim_app_pdo_io_bits(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave x io in=12 out=20\n"
				"connect x.20 -> x.12\n");
	u8 out[3] = { 0, 0, 0x08 }, in[2];

	app_al(b, STATION(0), EC_AL_OP, 1);
	bed_sm(b, STATION(0), 0, 0x1000, 3, 0x64);
	bed_sm(b, STATION(0), 1, 0x100C, 2, 0x20);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, STATION(0), 0x1000, out, 3), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(0), 0x100C, in, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(in), 0x0800);
	/* the watchdog switches them off */
	b->now += 200000000;
	KUNIT_EXPECT_EQ(test, bed_rd(b, STATION(0), 0x100C, in, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(in), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_pdo_rules),
	KUNIT_CASE(sim_app_pdo_fixed),
	KUNIT_CASE(sim_app_pdo_rewritten),
	KUNIT_CASE(sim_app_pdo_lenient),
	KUNIT_CASE(sim_app_pdo_outputs_act_in_op_only),
	KUNIT_CASE(sim_app_pdo_position),
	KUNIT_CASE(sim_app_pdo_velocity),
	KUNIT_CASE(sim_app_pdo_fillers),
	KUNIT_CASE(sim_app_pdo_analog),
	KUNIT_CASE(sim_app_pdo_io_bits),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_app_pdo",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
MODULE_LICENSE("GPL");
