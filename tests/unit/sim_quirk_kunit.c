// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that are unlike others: what registers and protocols show of them. */
#include "sim_app_kunit.h"

#define S	STATION(0)
#define MBOX	256

static struct ec_app *app_of(struct bed *b, const char *name)
{
	return ec_sim_find(b->sim, name);
}

static u16 eeprom_word(struct bed *b, u32 word)
{
	return get_unaligned_le16(ec_sim_at(b->sim, 0)->eep.data + 2 * word);
}

static struct app_mbox *mbox_new(struct kunit *test, u16 station)
{
	struct app_mbox *m = kunit_kzalloc(test, sizeof(*m), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, m);
	m->station = station;
	m->size = MBOX;
	return m;
}

static u32 to_preop(struct bed *b, u16 station)
{
	app_mbox_sms(b, station, MBOX);
	return app_al(b, station, EC_AL_PREOP, 1);
}

/* process data of a drive with 8 bytes each way */
static void drive_sms(struct bed *b, u16 station, u16 out, u16 in)
{
	const struct ec_app_sm *sm = app_of(b, "d")->model->dev.sms;

	bed_sm(b, station, 2, sm[2].start, out, out ? 0x64 : 0);
	bed_sm(b, station, 3, sm[3].start, in, in ? 0x20 : 0);
}

/* longer than 32 bits of nanoseconds */
static void sim_quirk_long_times_hold(struct kunit *test)
{
	struct bed *b = app_bed(test, "segment response=2min transition=5s\n"
				"slave d drive\nslave e drive transition=0s\n");
	struct app_mbox *m = mbox_new(test, STATION(1));
	u64 from = b->now;
	struct ec_mbox_hdr h;

	app_mbox_sms(b, S, MBOX);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 4999), (u32)EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 5001), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_GE(test, b->now - from, 5000000000ull);

	KUNIT_EXPECT_EQ(test, to_preop(b, STATION(1)), (u32)EC_AL_PREOP);
	memset(m->tx, 0, sizeof(m->tx));
	m->tx[7] = 0x20;			/* SDO request */
	m->tx[8] = 0x40;			/* upload */
	put_unaligned_le16(0x1000, m->tx + 9);
	KUNIT_EXPECT_EQ(test, app_send(b, m, EC_MBOX_COE, EC_COE_HDR + 8), 1);
	KUNIT_EXPECT_EQ_MSG(test, app_recv(b, m, &h, 119000), -1, "after 119 s");
	KUNIT_EXPECT_EQ_MSG(test, app_recv(b, m, &h, 1100), EC_COE_HDR + 8, "after 120.1 s");
}

/* one step is slow, those around it are not */
static void sim_quirk_single_step_is_slow(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive transition_safeop=6s\n");

	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 5990), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 6010), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, EC_AL_PREOP, 1), (u32)EC_AL_PREOP, "down");
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_INIT, 1), (u32)EC_AL_INIT);

	ec_sim_free(b->sim);
	b = app_bed(test, "slave d drive transition=20ms transition_boot=1ms\n");
	app_mbox_sms(b, S, MBOX);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 19), (u32)EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 2), (u32)EC_AL_INIT);
	b->now += 20000000;
	KUNIT_EXPECT_EQ(test, app_al_status(b, S), (u32)EC_AL_PREOP);
	app_al(b, S, EC_AL_INIT, 30);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_BOOT, 2), (u32)EC_AL_BOOT);
}

/* whatever the EEPROM says, the slave has its mailbox */
static void sim_quirk_eeprom_hides_mailbox(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive mbox_words=no mbox_protocols=no\n");
	struct ec_esc *esc = ec_sim_at(b->sim, 0);
	struct app_mbox *m = mbox_new(test, S);
	struct ec_sii_sm sm[4];

	for (u32 w = 0x18; w <= 0x1C; w++)
		KUNIT_EXPECT_EQ_MSG(test, eeprom_word(b, w), 0, "word 0x%x", w);
	KUNIT_EXPECT_EQ(test, esc->eep.data[14], ec_sii_crc(esc->eep.data));
	KUNIT_ASSERT_EQ(test, ec_sii_decode_sms(esc->eep.data, esc->eep.len, sm, 4), 4);
	KUNIT_EXPECT_EQ(test, sm[0].type, EC_SII_SM_MBOX_OUT);
	KUNIT_EXPECT_EQ(test, sm[0].start, 0x1000);
	KUNIT_EXPECT_EQ(test, sm[1].type, EC_SII_SM_MBOX_IN);
	KUNIT_EXPECT_EQ(test, sm[1].len, MBOX);

	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 1), 0x00160011u);
	app_mbox_sms(b, S, 128);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), 0x00160011u);
	app_mbox_sms(b, S, MBOX);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1018, 1), app_of(b, "d")->model->dev.vendor);
}

struct image {
	u8 *data;
	size_t len;
};

static int load(void *ctx, const char *name, u8 *buf, size_t cap)
{
	const struct image *img = ctx;

	if (img->len > cap)
		return -EFBIG;
	memcpy(buf, img->data, img->len);
	return (int)img->len;
}

/* the same from an image: SM0 and SM1 of category 41 are the mailbox */
static void sim_quirk_mailbox_of_category_41(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive mbox_words=no mbox_protocols=no\n");
	static const char text[] = "slave d file=x\n";
	const struct ec_app_model *drive = app_of(b, "d")->model;
	struct image img = { .len = drive->eeprom_len };
	struct ec_sim_loader loader = { .load = load, .ctx = &img };
	struct app_mbox *m = mbox_new(test, S);
	struct ec_sim_error err;

	img.data = kunit_kmalloc(test, img.len, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, img.data);
	memcpy(img.data, drive->eeprom, img.len);
	ec_sim_free(b->sim);
	b->sim = NULL;
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&b->sim, &bed_ops, text, strlen(text), &loader,
					      &err), 0);
	b->now = 1000000;
	bed_station(b, 0, S);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_PREOP, 1), 0x00160011u);
	app_mbox_sms(b, S, MBOX);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), (u32)EC_AL_PREOP);
	/* CoE, as the details of the general category say */
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C12, 0), 1);
}

/* the acknowledge changes nothing, INIT does, with and without its bit */
static void sim_quirk_only_init_clears_error(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive ack=no\nfault at=1s error d code=0x1b\n"
				"fault at=2s error d code=0x1b\n");

	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);
	b->now = 1000000000;
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x14, 1), 0x001B0014u);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), 0x001B0014u);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_INIT, 1), (u32)EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_OP, 1), 0x00110011u);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), 0x00110011u);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x11, 1), (u32)EC_AL_INIT);
}

/* 0x1C1x at power-on: nothing, index 0, PDOs that are not there */
static void sim_quirk_assignment_at_power_on(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive assign_out=none assign_in=0\n");
	struct app_mbox *m = mbox_new(test, S);

	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C12, 0), 0);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C13, 0), 1);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C13, 1), 0);
	/* no process data: a length is wrong */
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), 0x001D0012u);
	drive_sms(b, S, 0, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x14, 1), 0x001E0012u);
	drive_sms(b, S, 0, 0);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x14, 1), (u32)EC_AL_SAFEOP);
	app_al(b, S, EC_AL_PREOP, 1);
	/* the entry can be written back as it was; another slave refuses it */
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 0, 0, 1), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 1, 0, 2), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 0, 1, 1), 0);
	/* and what startup SDOs assign counts */
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 1, 0x1600, 2), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 0, 1, 1), 0);
	drive_sms(b, S, 8, 0);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);

	ec_sim_free(b->sim);
	b = app_bed(test, "slave d drive assign_in=0x1A00,0x1A7F\n");
	m->counter = 0;
	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C13, 2), 0x1A7F);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1A7F, 0), ~0ull);
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);

	ec_sim_free(b->sim);
	b = app_bed(test, "slave d drive\n");
	m->counter = 0;
	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 0, 0, 1), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 1, 0, 2), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 0, 1, 1), EC_ABORT_RANGE);
}

/* a slave that reads its own EEPROM on the way to PREOP */
static void sim_quirk_eeprom_must_be_assigned(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive own_eeprom=yes\n");

	bed_put(b, S, EC_REG_EEP_OWNER, 0, 1);
	KUNIT_EXPECT_EQ(test, to_preop(b, S), 0x00500011u);
	bed_put(b, S, EC_REG_EEP_OWNER, 1, 1);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x12, 1), (u32)EC_AL_PREOP);
	bed_put(b, S, EC_REG_EEP_OWNER, 0, 1);
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP,
			    "asked for on the way to PREOP only");
}

/* LRW passes, LRD and LWR do not */
static void sim_quirk_lrw_is_not_processed(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive lrw=no\n");
	const struct ec_app_sm *sm = app_of(b, "d")->model->dev.sms;
	u8 data[16] = { 0 };

	KUNIT_EXPECT_TRUE(test, bed_get(b, S, EC_REG_FEATURES, 2) & EC_FEAT_NO_LRW);
	to_preop(b, S);
	drive_sms(b, S, 8, 8);
	for (u8 i = 0; i < 2; i++)
		bed_fmmu(b, S, i, (struct ec_fmmu){
			.logical = 0x1000 + 8u * i, .len = 8, .lbit_stop = 7,
			.phys = sm[2 + i].start, .type = i ? EC_FMMU_READ : EC_FMMU_WRITE,
			.enable = true,
		});
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 0x1000, 0, data, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 0x1000, 0, data, 8), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRD, 0x1008, 0, data, 8), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 0x1000, 0, data, 16), 0);
}

/* FRMW passes: neither read nor written nor counted; ARMW is processed. */
static void sim_quirk_frmw_is_not_processed(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a drive product=1\nslave d drive product=2 frmw=no\n"
				"slave e drive product=3\n");
	u8 data[2] = { 0 };

	bed_put(b, S, 0x0f80, 0x4711, 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, S, 0x0f80, data, 2), 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x0f80, 2), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(2), 0x0f80, 2), 0x4711ull);
	/* no slave reads at the address of this one: the others are written */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, STATION(1), 0x0f80, data, 2), 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_ARMW, 0, 0x0f80, data, 2), 3);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), 0x0f80, 2), 0x4711ull);
}

/* IN and OUT of the second slave are exchanged: it is processed on the way back */
static void sim_quirk_swapped_slave_comes_later(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a drive product=1\nslave d drive product=2 swap=yes\n"
				"slave c drive product=3\nslave e drive product=4\n");
	static const u32 want[] = { 1, 3, 4, 2 };

	for (u16 i = 0; i < 4; i++) {
		u8 cmd[6] = { 0x00, 0x01, EC_SII_W_PRODUCT };

		bed_tx(b, EC_CMD_APWR, (u16)-i, EC_REG_EEP_CONTROL, cmd, 6);
		b->now += 5000000;
		KUNIT_EXPECT_EQ(test, bed_get(b, STATION(i), EC_REG_EEP_DATA, 4), want[i]);
	}
	/* ports 0 and 1 have a link, the frame came in at port 1 */
	KUNIT_EXPECT_EQ(test, app_of(b, "d")->esc->port[1].peer, 0);
	KUNIT_EXPECT_EQ(test, app_of(b, "d")->esc->port[0].peer, 2);
}

/* forward and back; what the clock is compared with does not follow */
static void sim_quirk_clock_jumps(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive clock=1s\nfault at=2s jump d by=5ms\n"
				"fault at=3s jump d by=-1.5s\n");
	struct ec_esc *esc = ec_sim_at(b->sim, 0);
	u64 before, from;

	b->now = 1999000000;
	from = b->now;
	before = bed_get(b, S, EC_REG_DC_SYSTIME, 8);
	KUNIT_EXPECT_EQ(test, before / 1000000, 2999ull);
	b->now = 2001000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, S, EC_REG_DC_SYSTIME, 8) - before,
			2001000000 - from + 5000000);
	b->now = 3001000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, S, EC_REG_DC_SYSTIME, 8) - before,
			3001000000 - from + 5000000 - 1500000000);
	KUNIT_EXPECT_EQ(test, ec_esc_local_time(esc, 4000000000), 3505000000ull);
}

static void start_sync(struct bed *b, u8 act)
{
	bed_put(b, S, EC_REG_DC_ACTIVATION, 0, 1);
	bed_put(b, S, EC_REG_DC_CYCLE0, 1000000, 4);
	bed_put(b, S, EC_REG_DC_CYCLE1, 0, 4);
	bed_put(b, S, EC_REG_DC_START, bed_get(b, S, EC_REG_DC_SYSTIME, 8) + 1000000, 8);
	bed_put(b, S, EC_REG_DC_ACTIVATION, act, 1);
}

/* SYNC1 alone, and only what the modes say */
static void sim_quirk_operation_modes(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive dc_modes=0x0500,0x0700\n");
	const struct ec_esc *esc = ec_sim_at(b->sim, 0);
	struct ec_sii_dc dc[4];
	char name[16];
	u8 out[8] = { 0 };

	KUNIT_ASSERT_EQ(test, ec_sii_decode_dcs(esc->eep.data, esc->eep.len, dc, 4), 2);
	KUNIT_EXPECT_EQ(test, dc[0].assign, 0x0500);
	KUNIT_EXPECT_EQ(test, dc[1].assign, 0x0700);
	ec_sii_string(esc->eep.data, esc->eep.len, dc[0].name, name, sizeof(name));
	KUNIT_EXPECT_STREQ(test, name, "DC 0500");

	to_preop(b, S);
	drive_sms(b, S, 8, 8);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, EC_AL_SAFEOP, 1), 0x00300012u, "no SYNC");
	start_sync(b, 3);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, 0x14, 1), 0x00300012u, "SYNC0 alone");
	start_sync(b, 7);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, 0x14, 1), (u32)EC_AL_SAFEOP, "both");
	app_al(b, S, EC_AL_PREOP, 1);
	start_sync(b, 5);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP, "SYNC1");
	bed_tx(b, EC_CMD_FPWR, S, app_of(b, "d")->model->dev.sms[2].start, out, 8);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_OP, 1), (u32)EC_AL_SAFEOP);
	b->now += 3000000;
	bed_tx(b, EC_CMD_FPWR, S, app_of(b, "d")->model->dev.sms[2].start, out, 8);
	KUNIT_EXPECT_EQ_MSG(test, app_al_status(b, S), (u32)EC_AL_OP, "SYNC1 has begun");

	ec_sim_free(b->sim);
	b = app_bed(test, "slave d drive\n");
	to_preop(b, S);
	drive_sms(b, S, 8, 8);
	start_sync(b, 5);
	KUNIT_EXPECT_EQ_MSG(test, app_al(b, S, EC_AL_SAFEOP, 1), 0x00300012u, "as others do");
}

/* one mapping and one assignment are read-only, the others are not */
static void sim_quirk_single_objects_are_fixed(struct kunit *test)
{
	struct bed *b = app_bed(test,
				"slave d drive mapping=lenient fixed=0x1A00,0x1C12\n");
	struct app_mbox *m = mbox_new(test, S);

	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1A00, 0, 0, 1), EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1600, 0, 0, 1), 0);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C12, 0, 0, 1), EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1C13, 0, 0, 1), 0);
}

/* outputs in SM2 and SM3, inputs in SM4 to SM6 */
static void sim_quirk_several_sync_managers(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave d drive out=16 in=24 sm_out=2 sm_in=3\n");
	struct ec_app *app = app_of(b, "d");
	const struct ec_app_sm *sm = app->model->dev.sms;
	struct app_mbox *m = mbox_new(test, S);
	struct ec_sii_sm sii[16];
	u8 data[32] = { 0 };
	u16 sum[2] = { 0, 0 };

	KUNIT_ASSERT_EQ(test, ec_sii_decode_sms(app->esc->eep.data, app->esc->eep.len, sii, 16), 7);
	KUNIT_EXPECT_EQ(test, to_preop(b, S), (u32)EC_AL_PREOP);
	for (int i = 2; i < 7; i++) {
		KUNIT_EXPECT_EQ(test, sii[i].type, i < 4 ? EC_SII_SM_OUTPUTS : EC_SII_SM_INPUTS);
		KUNIT_EXPECT_EQ(test, app_get(b, m, 0x1C00, (u8)(i + 1)), sii[i].type);
		KUNIT_EXPECT_EQ_MSG(test, app_get(b, m, (u16)(0x1C10 + i), 0), 1, "SM%d", i);
		KUNIT_EXPECT_EQ(test, app_get(b, m, (u16)(0x1C10 + i), 1),
				(u64)(i < 4 ? 0x15FE + i : 0x19FC + i));
		KUNIT_EXPECT_GT(test, sii[i].len, 0);
		sum[i >= 4] += sii[i].len;
	}
	KUNIT_EXPECT_EQ(test, sum[0], 16);
	KUNIT_EXPECT_EQ(test, sum[1], 24);

	for (int i = 2; i < 7; i++)
		bed_sm(b, S, i, sm[i].start, sm[i].len, i < 4 ? 0x64 : 0x20);
	bed_sm(b, S, 3, sm[3].start, (u16)(sm[3].len - 1), 0x64);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_SAFEOP, 1), 0x001D0012u);
	bed_sm(b, S, 3, sm[3].start, sm[3].len, 0x64);
	bed_sm(b, S, 6, sm[6].start, (u16)(sm[6].len + 1), 0x20);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x14, 1), 0x001E0012u);
	bed_sm(b, S, 6, sm[6].start, sm[6].len, 0x20);
	KUNIT_EXPECT_EQ(test, app_al(b, S, 0x14, 1), (u32)EC_AL_SAFEOP);

	/* OP needs the outputs of both */
	memset(data, 0x5A, sizeof(data));
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, S, sm[2].start, data, sm[2].len), 1);
	KUNIT_EXPECT_EQ(test, app_al(b, S, EC_AL_OP, 1), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, S, sm[3].start, data, sm[3].len), 1);
	KUNIT_EXPECT_EQ(test, app_al_status(b, S), (u32)EC_AL_OP);
	for (u16 c = 0; c < app->model->n_chan[EC_APP_OUT]; c++)
		KUNIT_EXPECT_EQ_MSG(test, ec_app_channel(app, EC_APP_OUT, c) & 0xFF, 0x5A,
				    "channel %u", c);
	/* one of them alone changes its own */
	memset(data, 0x11, sizeof(data));
	bed_tx(b, EC_CMD_FPWR, S, sm[3].start, data, sm[3].len);
	KUNIT_EXPECT_EQ(test, ec_app_channel(app, EC_APP_OUT, 0) & 0xFF, 0x5A);
	KUNIT_EXPECT_EQ(test, ec_app_channel(app, EC_APP_OUT,
					     app->model->n_chan[EC_APP_OUT] - 1) & 0xFF, 0x11);
	/* inputs of all three come from the slave */
	for (int i = 4; i < 7; i++)
		KUNIT_EXPECT_EQ(test, bed_rd(b, S, sm[i].start, data, sm[i].len), 1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_quirk_long_times_hold),
	KUNIT_CASE(sim_quirk_single_step_is_slow),
	KUNIT_CASE(sim_quirk_eeprom_hides_mailbox),
	KUNIT_CASE(sim_quirk_mailbox_of_category_41),
	KUNIT_CASE(sim_quirk_only_init_clears_error),
	KUNIT_CASE(sim_quirk_assignment_at_power_on),
	KUNIT_CASE(sim_quirk_eeprom_must_be_assigned),
	KUNIT_CASE(sim_quirk_lrw_is_not_processed),
	KUNIT_CASE(sim_quirk_frmw_is_not_processed),
	KUNIT_CASE(sim_quirk_swapped_slave_comes_later),
	KUNIT_CASE(sim_quirk_clock_jumps),
	KUNIT_CASE(sim_quirk_operation_modes),
	KUNIT_CASE(sim_quirk_single_objects_are_fixed),
	KUNIT_CASE(sim_quirk_several_sync_managers),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_quirk",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
MODULE_LICENSE("GPL");
