// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: states, mailbox, process data. */
#include "sim_app_kunit.h"

static void sim_app_thin_segment_reaches_op(struct kunit *test)
{
	struct bed *b = app_bed(test, ec_sim_builtin("thin"));
	struct ec_app *out = ec_sim_find(b->sim, "out");
	u8 v = 0x05;

	KUNIT_ASSERT_NOT_NULL(test, out);
	/* both emulate: the status follows at once */
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_OP, 1), (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(1), EC_AL_OP, 1), (u32)EC_AL_OP);
	bed_sm(b, STATION(1), 0, 0x0F00, 1, 0x44);
	KUNIT_EXPECT_EQ(test, bed_fmmu(b, STATION(1), 0, (struct ec_fmmu){
			.logical = 0x10000, .len = 1, .lbit_stop = 7,
			.phys = 0x0F00, .type = EC_FMMU_WRITE, .enable = true,
		}), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 0, 1, &v, 1), 1);
	KUNIT_EXPECT_EQ(test, ec_app_channel(out, EC_APP_OUT, 0), 1);
	KUNIT_EXPECT_EQ(test, ec_app_channel(out, EC_APP_OUT, 1), 0);
	KUNIT_EXPECT_EQ(test, ec_app_channel(out, EC_APP_OUT, 2), 1);
	/* off outside OP */
	app_al(b, STATION(1), EC_AL_SAFEOP, 1);
	KUNIT_EXPECT_EQ(test, ec_app_channel(out, EC_APP_OUT, 0), 0);
}

static void sim_app_digital_loop(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave o EL2008\nslave i EL1008\n"
				"connect o.2 -> i.5\nconst i.1 value=1\n");
	u8 v = 0x02;

	for (int i = 0; i < 2; i++)
		app_al(b, STATION(i), EC_AL_OP, 1);
	bed_sm(b, STATION(0), 0, 0x0F00, 1, 0x44);
	bed_sm(b, STATION(1), 0, 0x1000, 1, 0x00);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x1000, 1), 0x01);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, STATION(0), 0x0F00, &v, 1), 1);
	bed_get(b, STATION(1), 0x1000, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x1000, 1), 0x11);
}

/* EK1100, EL2008, EL7201: the axis is slave 2 */
#define AXIS	STATION(2)

static void axis_sms(struct bed *b, u16 out, u16 in)
{
	bed_sm(b, AXIS, 2, 0x1200, out, 0x64);
	bed_sm(b, AXIS, 3, 0x1300, in, 0x20);
}

static void sim_app_al_illegal(struct kunit *test)
{
	struct bed *b = app_bed(test, ec_sim_builtin("three"));

	KUNIT_EXPECT_EQ(test, app_al_status(b, AXIS), (u32)EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_OP, 1), 0x00110011u);
	/* nothing but INIT is heard until the acknowledge */
	app_mbox_sms(b, AXIS, 256);
	bed_put(b, AXIS, EC_REG_AL_CONTROL, EC_AL_PREOP, 2);
	KUNIT_EXPECT_EQ(test, app_al_status(b, AXIS), 0x00110011u);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_INIT | EC_AL_ERROR, 1),
			(u32)EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 5, 1), 0x00120011u);
	/* acknowledge and request in one */
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_PREOP | EC_AL_ERROR, 1),
			(u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_BOOT, 1), 0x00110012u);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_INIT, 1), (u32)EC_AL_INIT);
}

static void sim_app_al_mailbox(struct kunit *test)
{
	struct bed *b = app_bed(test, ec_sim_builtin("three"));

	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_PREOP, 1), 0x00160011u);
	app_mbox_sms(b, AXIS, 128);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_PREOP | EC_AL_ERROR, 1),
			0x00160011u);
	app_mbox_sms(b, AXIS, 256);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_PREOP | EC_AL_ERROR, 1),
			(u32)EC_AL_PREOP);
	/* the master takes the mailbox away */
	bed_put(b, AXIS, EC_REG_SM(1) + EC_SM_OFS_ACTIVATE, 0, 1);
	KUNIT_EXPECT_EQ(test, app_al_status(b, AXIS), 0x00160011u);
}

static void sim_app_al_boot(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EL7201\nslave w 750-354\n");

	app_mbox_sms(b, STATION(0), 256);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_BOOT, 1), 0x00150011u);
	app_mbox_sms(b, STATION(0), 512);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_BOOT | EC_AL_ERROR, 1),
			(u32)EC_AL_BOOT);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(1), EC_AL_BOOT, 1), 0x00130011u);
}

static void sim_app_al_process_data(struct kunit *test)
{
	struct bed *b = app_bed(test, ec_sim_builtin("three"));

	app_mbox_sms(b, AXIS, 256);
	app_al(b, AXIS, EC_AL_PREOP, 1);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_SAFEOP, 1), 0x001D0012u);
	axis_sms(b, 5, 6);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 0x14, 1), 0x001D0012u);
	axis_sms(b, 6, 7);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 0x14, 1), 0x001E0012u);
	axis_sms(b, 6, 6);
	bed_sm(b, AXIS, 2, 0x1200, 6, 0x60);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 0x14, 1), 0x00170012u);
	bed_sm(b, AXIS, 2, 0x1210, 6, 0x64);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 0x14, 1), 0x001D0012u);
	axis_sms(b, 6, 6);
	bed_put(b, AXIS, EC_REG_WD_DIVIDER, 2, 2);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, 0x14, 1), (u32)EC_AL_SAFEOP);
	app_al(b, AXIS, EC_AL_PREOP, 1);
	bed_put(b, AXIS, EC_REG_WD_SM, 1, 2);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_SAFEOP, 1), 0x001F0012u);
}

static void sim_app_al_outputs(struct kunit *test)
{
	struct bed *b = app_bed(test, "segment op_timeout=100ms\nslave coupler EK1100\n"
				"slave out EL2008\nslave axis EL7201 motor=AM8121\n");
	u8 v[6] = { 0 };

	app_mbox_sms(b, AXIS, 256);
	app_al(b, AXIS, EC_AL_PREOP, 1);
	axis_sms(b, 6, 6);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_SAFEOP, 1),
			(u32)EC_AL_SAFEOP);
	/* the slave waits for outputs for a while */
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_OP, 50), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_OP, 200), 0x00190014u);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, AXIS, 0x1200, v, 6), 1);
	KUNIT_EXPECT_EQ(test, app_al(b, AXIS, EC_AL_OP | EC_AL_ERROR, 1),
			(u32)EC_AL_OP);
	/* the watchdog takes it out of OP after 100 ms */
	b->now += 90000000;
	KUNIT_EXPECT_EQ(test, app_al_status(b, AXIS), (u32)EC_AL_OP);
	b->now += 20000000;
	KUNIT_EXPECT_EQ(test, app_al_status(b, AXIS), 0x001B0014u);
	KUNIT_EXPECT_EQ(test, bed_get(b, AXIS, EC_REG_WD_SM_COUNT, 1), 1);
}

/* the time limit from SAFEOP to OP: the common one, that of a slave, of a segment */
static void sim_app_al_op_timeout(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a drive\nslave b drive op_timeout=2s\n"
				"segment op_timeout=30ms\nslave c drive\n");
	static const u32 ms[] = { 9000, 2000, 30 };

	for (int i = 0; i < 3; i++) {
		app_mbox_sms(b, STATION(i), 256);
		app_al(b, STATION(i), EC_AL_PREOP, 1);
		bed_sm(b, STATION(i), 2, 0x1200, 8, 0x64);
		bed_sm(b, STATION(i), 3, 0x1300, 8, 0x20);
		KUNIT_ASSERT_EQ(test, app_al(b, STATION(i), EC_AL_SAFEOP, 1),
				(u32)EC_AL_SAFEOP);
		KUNIT_EXPECT_EQ(test, app_al(b, STATION(i), EC_AL_OP, ms[i] - 5),
				(u32)EC_AL_SAFEOP);
		b->now += 10000000;
		KUNIT_EXPECT_EQ(test, app_al_status(b, STATION(i)), 0x00190014u);
	}
}

/* The identification is shown some time after its request; another request does not begin anew. */
static void sim_app_al_identification_delay(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a drive id=6\nslave b drive id=7 id_delay=60ms\n");
	const u16 request = EC_AL_INIT | EC_AL_ID;

	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), request, 1), 0x00060021u);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(1), request, 1), (u32)EC_AL_INIT);
	b->now += 50000000;
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(1), request, 1), (u32)EC_AL_INIT);
	b->now += 10000000;
	KUNIT_EXPECT_EQ(test, app_al_status(b, STATION(1)), 0x00070021u);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(1), EC_AL_INIT, 1), (u32)EC_AL_INIT);
	/* ended before it was shown */
	app_al(b, STATION(1), request, 1);
	app_al(b, STATION(1), EC_AL_INIT, 1);
	b->now += 100000000;
	KUNIT_EXPECT_EQ(test, app_al_status(b, STATION(1)), (u32)EC_AL_INIT);
}

/* SYNC0 that starts so many ns from now; SAFEOP and outputs, then OP is requested */
static u32 al_with_sync(struct bed *b, s64 start)
{
	u8 v[8] = { 0 };

	app_al(b, STATION(0), EC_AL_PREOP | EC_AL_ERROR, 1);
	bed_put(b, STATION(0), EC_REG_DC_CUC, 0, 2);
	bed_put(b, STATION(0), EC_REG_DC_CYCLE0, 1000000, 4);
	start += bed_get(b, STATION(0), EC_REG_DC_SYSTIME, 8);
	bed_put(b, STATION(0), EC_REG_DC_START, start, 8);
	bed_put(b, STATION(0), EC_REG_DC_CUC, 0x0300, 2);
	app_al(b, STATION(0), EC_AL_SAFEOP, 1);
	bed_tx(b, EC_CMD_FPWR, STATION(0), 0x1200, v, 8);
	return app_al(b, STATION(0), EC_AL_OP, 200);
}

static void sim_app_al_sync(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive in=8 out=8 op_timeout=100ms\n");

	app_mbox_sms(b, STATION(0), 256);
	app_al(b, STATION(0), EC_AL_PREOP, 1);
	bed_sm(b, STATION(0), 2, 0x1200, 8, 0x24);
	bed_sm(b, STATION(0), 3, 0x1218, 8, 0x20);
	KUNIT_EXPECT_EQ(test, al_with_sync(b, -1000), 0x002D0014u);
	/* it waits for a start that is near */
	KUNIT_EXPECT_EQ(test, al_with_sync(b, 50000000), (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ(test, al_with_sync(b, 500000000), 0x002D0014u);
}

/* the cycle time in the dictionary follows SYNC0 */
static void sim_app_al_sync_cycle(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive in=8 out=8\n");
	struct app_mbox *m = kunit_kzalloc(test, sizeof(*m), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, m);
	m->station = STATION(0);
	m->size = 256;
	app_mbox_sms(b, STATION(0), 256);
	app_al(b, STATION(0), EC_AL_PREOP, 1);
	bed_sm(b, STATION(0), 2, 0x1200, 8, 0x24);
	bed_sm(b, STATION(0), 3, 0x1300, 8, 0x20);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C32, 2), 1000000);
	bed_put(b, STATION(0), EC_REG_DC_CYCLE0, 250000, 4);
	bed_put(b, STATION(0), EC_REG_DC_START,
		bed_get(b, STATION(0), EC_REG_DC_SYSTIME, 8) + 50000000, 8);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C32, 2), 1000000);
	bed_put(b, STATION(0), EC_REG_DC_CUC, 0x0300, 2);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C32, 2), 250000);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C33, 2), 250000);
}

static void sim_app_al_refuse(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive\n"
				"fault refuse d SAFEOP code=0x1d\n"
				"fault at=1s allow d\n");
	u16 d = STATION(0);

	app_mbox_sms(b, d, 256);
	KUNIT_EXPECT_EQ(test, app_al(b, d, EC_AL_PREOP, 1), (u32)EC_AL_PREOP);
	bed_sm(b, d, 2, 0x1200, 8, 0x64);
	bed_sm(b, d, 3, 0x1218, 8, 0x20);
	KUNIT_EXPECT_EQ(test, app_al(b, d, EC_AL_SAFEOP, 1), 0x001D0012u);
	b->now = 1000000000;
	KUNIT_EXPECT_EQ(test, app_al(b, d, EC_AL_SAFEOP | EC_AL_ERROR, 1),
			(u32)EC_AL_SAFEOP);
}

static void sim_app_al_time_and_id(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive transition=5ms id=0x1234\n");
	u16 d = STATION(0);
	u64 from = b->now;

	KUNIT_EXPECT_EQ(test, bed_put(b, d, EC_REG_AL_CONTROL, 0x21, 2), 1);
	KUNIT_EXPECT_EQ(test, app_al_status(b, d), 0x12340021u);
	app_mbox_sms(b, d, 256);
	KUNIT_EXPECT_EQ(test, app_al(b, d, EC_AL_PREOP, 20), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_GE(test, b->now - from, 5000000ull);
}

static void sim_app_several_datagrams_share_frame(struct kunit *test)
{
	static const struct {
		u8 cmd;
		u16 adp, ado, len, wkc, back;
	} d[] = {
		{ EC_CMD_BRD, 0, EC_REG_AL_STATUS, 2, 3, 3 },
		{ EC_CMD_APRD, 0xffff, EC_REG_STATION, 2, 1, 2 },
		{ EC_CMD_FPRD, STATION(2), EC_REG_TYPE, 12, 1, STATION(2) },
		{ EC_CMD_NOP, 7, 8, 1, 0, 7 },
		{ EC_CMD_LRW, 0, 0x10, 30, 0, 0 },
		{ EC_CMD_ARMW, 0, EC_REG_DC_SYSTIME, 8, 3, 3 },
		{ EC_CMD_BWR, 0, EC_REG_ERR_RX(0), 8, 3, 3 },
	};
	struct bed *b = app_bed(test, ec_sim_builtin("three"));
	struct ec_frame_buf f;
	struct ec_frame_iter it;
	struct ec_dgram g;
	size_t len;
	u32 i;

	ec_frame_begin(&f, b->frame, sizeof(b->frame));
	for (i = 0; i < ARRAY_SIZE(d); i++) {
		u8 *p = ec_frame_add(&f, d[i].cmd, (u8)(0x40 + i), d[i].adp,
				     d[i].ado, d[i].len);

		KUNIT_ASSERT_NOT_NULL(test, p);
		memset(p, 0, d[i].len);
	}
	len = ec_frame_end(&f);
	KUNIT_ASSERT_GT(test, ec_sim_frame2(b->sim, 0, b->frame, len, b->now,
					    &b->out), (s64)0);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, b->frame, len), 0);
	for (i = 0; i < ARRAY_SIZE(d); i++) {
		KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &g), 1);
		KUNIT_EXPECT_EQ(test, g.idx, 0x40 + i);
		KUNIT_EXPECT_EQ(test, g.adp, d[i].back);
		KUNIT_EXPECT_EQ(test, ec_dgram_wkc(&g), d[i].wkc);
	}
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &g), 0);
}

/* the whole image through the CPU, as it would come from a chip */
static void sim_app_emulated_eeprom(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EL3062\n"
				"slave b EL3062 eeprom=emulated\n");
	const struct ec_esc_eeprom *e = &ec_sim_slave(b->sim, 1)->eep;
	u64 v, chip;
	u32 w;

	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), 0x502, 2) & 0x20, 0ull);
	for (w = 0; w < e->len / 2; w += 4) {
		bed_put(b, STATION(0), 0x502, EC_EEP_CMD_READ | w << 16, 6);
		bed_put(b, STATION(1), 0x502, EC_EEP_CMD_READ | w << 16, 6);
		b->now += 700000 - b->gap;
		KUNIT_ASSERT_TRUE(test, bed_get(b, STATION(1), 0x502, 2) &
				  EC_EEP_BUSY);
		b->now += 100000;
		KUNIT_ASSERT_EQ(test, bed_get(b, STATION(1), 0x502, 2) & 0xff20,
				0x20ull);
		chip = bed_get(b, STATION(0), 0x508, 8);
		KUNIT_ASSERT_EQ_MSG(test, bed_get(b, STATION(1), 0x508, 8),
				    chip, "word 0x%x", w);
	}
	/* a word written stays, and comes back */
	bed_put(b, STATION(1), 0x508, 0xbeef, 2);
	bed_put(b, STATION(1), 0x502, EC_EEP_CMD_WRITE | 1 | 0x28 << 16, 6);
	b->now += 6000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x502, 2) & 0xff20, 0x20ull);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(e->data + 0x50), 0xbeef);
	/* behind the end, and a CPU that hangs */
	bed_put(b, STATION(1), 0x502, EC_EEP_CMD_WRITE | 1 | 0xfff0ull << 16, 6);
	b->now += 6000000;
	v = bed_get(b, STATION(1), 0x502, 2);
	KUNIT_EXPECT_EQ(test, v & 0xff20, 0x2020ull);
	ec_sim_slave(b->sim, 1)->fault.app_mute = true;
	bed_put(b, STATION(1), 0x502, EC_EEP_CMD_READ, 6);
	b->now += 100000000;
	KUNIT_EXPECT_TRUE(test, bed_get(b, STATION(1), 0x502, 2) & EC_EEP_BUSY);
	ec_sim_slave(b->sim, 1)->fault.app_mute = false;
	b->now += 2000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x502, 2) & 0xff20, 0x20ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_emulated_eeprom),
	KUNIT_CASE(sim_app_thin_segment_reaches_op),
	KUNIT_CASE(sim_app_digital_loop),
	KUNIT_CASE(sim_app_several_datagrams_share_frame),
	KUNIT_CASE(sim_app_al_illegal),
	KUNIT_CASE(sim_app_al_mailbox),
	KUNIT_CASE(sim_app_al_boot),
	KUNIT_CASE(sim_app_al_process_data),
	KUNIT_CASE(sim_app_al_outputs),
	KUNIT_CASE(sim_app_al_op_timeout),
	KUNIT_CASE(sim_app_al_identification_delay),
	KUNIT_CASE(sim_app_al_sync),
	KUNIT_CASE(sim_app_al_sync_cycle),
	KUNIT_CASE(sim_app_al_refuse),
	KUNIT_CASE(sim_app_al_time_and_id),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_app",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
MODULE_LICENSE("GPL");
