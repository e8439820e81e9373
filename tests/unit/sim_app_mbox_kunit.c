// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: mailbox, object dictionary, SDO information. */
#include "sim_app_kunit.h"
#include "od_list.h"

struct mb {
	struct bed *b;
	struct app_mbox m;
	u8 buf[2048];
};

/* one slave in PREOP, its mailboxes of @size bytes from 0x1000 */
static struct mb *mb_new(struct kunit *test, const char *text, u16 size)
{
	struct mb *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->b = app_bed(test, text);
	x->m.station = STATION(0);
	x->m.size = size;
	app_mbox_sms(x->b, x->m.station, size);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->m.station, EC_AL_PREOP, 5),
			(u32)EC_AL_PREOP);
	return x;
}

static void sim_app_mbox_identity(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave a EL7201 serial=77\n", 256);
	struct bed *b = x->b;
	u32 abort = 0;

	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1018, 0), 4);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1018, 1), 2);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1018, 2), 0x1C213052);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1018, 3), 0x00110000);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1018, 4), 77);
	KUNIT_EXPECT_EQ(test, app_upload(b, &x->m, 0x1008, 0, false, x->buf,
					 sizeof(x->buf), &abort), 6);
	KUNIT_EXPECT_MEMEQ(test, x->buf, "EL7201", 6);
	/* count as two bytes, then four values */
	KUNIT_EXPECT_EQ(test, app_upload(b, &x->m, 0x1018, 0, true, x->buf,
					 sizeof(x->buf), &abort), 18);
	KUNIT_EXPECT_EQ(test, x->buf[0], 4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->buf + 2), 2u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->buf + 14), 77u);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1C00, 3), 3);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1C12, 1), 0x1600);
	KUNIT_EXPECT_EQ(test, app_get(b, &x->m, 0x1600, 1), 0x70100110);
}

static u32 up_abort(struct mb *x, u16 index, u8 sub)
{
	u32 abort = 0;

	return app_upload(x->b, &x->m, index, sub, false, x->buf,
			  sizeof(x->buf), &abort) == -1 ? abort : 0;
}

static void sim_app_mbox_aborts(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	struct bed *b = x->b;
	struct app_mbox *m = &x->m;

	KUNIT_EXPECT_EQ(test, up_abort(x, 0x3000, 0), EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, up_abort(x, 0x1018, 9), EC_ABORT_NO_SUB);
	KUNIT_EXPECT_EQ(test, up_abort(x, 0x2002, 0), EC_ABORT_WRITE_ONLY);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x1018, 1, 5, 4),
			EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2003, 0, 5, 2),
			EC_ABORT_TOO_SHORT);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2003, 0, 5, 8),
			EC_ABORT_TOO_LONG);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2001, 1, 2, 1),
			EC_ABORT_TOO_HIGH);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2003, 0, 5, 4), 0u);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x2003, 0), 5);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2001, 9, 0x1122334455667788, 8),
			0u);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x2001, 9), 0x1122334455667788);
	bed_sm(b, STATION(0), 2, 0x1200, 8, 0x64);
	bed_sm(b, STATION(0), 3, 0x1218, 8, 0x20);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_SAFEOP, 1),
			(u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, app_put(b, m, 0x2003, 0, 6, 4), EC_ABORT_STATE);
	KUNIT_EXPECT_EQ(test, app_get(b, m, 0x2003, 0), 5);
}

static void sim_app_mbox_segmented(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive mbox=64 response=50us\n", 64);
	u8 *data = kunit_kmalloc(test, 1000, GFP_KERNEL);
	u32 abort;

	KUNIT_ASSERT_NOT_NULL(test, data);
	for (int i = 0; i < 1000; i++)
		data[i] = (u8)(i * 7);
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x2000, 0, false, data,
					   1000), 0u);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x2000, 0, false, x->buf,
					 sizeof(x->buf), &abort), 1000);
	KUNIT_EXPECT_MEMEQ(test, x->buf, data, 1000);
}

static void sim_app_mbox_complete_access(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	/* sub 0 twice, bit, 8, 16, 32, 64, 8, 16, 32, 64, 32, 64, string */
	size_t len = 2 + 1 + 1 + 2 + 4 + 8 + 1 + 2 + 4 + 8 + 4 + 8 + 16;
	u8 rec[61];
	u32 abort;

	KUNIT_ASSERT_EQ(test, len, sizeof(rec));
	memset(rec, 0x5A, sizeof(rec));
	rec[0] = 12;
	rec[1] = 0;
	rec[2] = 1;
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x2001, 0, true, rec,
					   len), 0u);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x2001, 1), 1);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, 0x2001, 4), 0x5A5A5A5A);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x2001, 0, true, x->buf,
					 sizeof(x->buf), &abort), (int)len);
	KUNIT_EXPECT_MEMEQ(test, x->buf, rec, len);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x2001, 1, true, x->buf,
					 sizeof(x->buf), &abort), (int)len - 2);
	rec[2] = 1;
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, 0x1018, 0, true, rec,
					   18), EC_ABORT_READ_ONLY);
}

static int info(struct mb *x, struct ec_sdoinfo *s)
{
	struct ec_mbox_hdr h;
	int ret, len;

	len = ec_sdoinfo_tx(s, x->m.tx + EC_MBOX_HDR, 100);
	if (len < 0 || app_send(x->b, &x->m, EC_MBOX_COE, (size_t)len) != 1)
		return -1;
	do {
		len = app_recv(x->b, &x->m, &h, 100);
		if (len < 0)
			return -2;
		ret = ec_sdoinfo_rx(s, x->m.rx + EC_MBOX_HDR, (size_t)len);
	} while (ret == EC_WAIT || ret == EC_STALE);
	return ret;
}

static void sim_app_mbox_information(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive mbox=64 mapping=rewritable\n", 64);
	struct ec_app *app = ec_sim_find(x->b->sim, "d");
	struct ec_od_object o;
	struct ec_od_entry e;
	struct ec_sdoinfo s;
	size_t n;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	n = od_list_count(&s);
	KUNIT_EXPECT_EQ(test, n, app->model->n_objects);
	KUNIT_EXPECT_EQ(test, od_list_get(&s, 0), 0x1000);
	KUNIT_EXPECT_GT(test, s.fragments, 1);

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_COUNTS, 0, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(x->buf), n);

	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_object_decode(x->buf, s.size, &o), 0);
	KUNIT_EXPECT_EQ(test, o.max_sub, 4);
	KUNIT_EXPECT_EQ(test, o.code, EC_OD_RECORD);
	KUNIT_EXPECT_EQ(test, o.name_len, 8);
	KUNIT_EXPECT_MEMEQ(test, o.name, "Identity", 8);

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x607A, 0, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(x->buf, s.size, &e), 0);
	KUNIT_EXPECT_EQ(test, e.type, EC_TYPE_INT32);
	KUNIT_EXPECT_EQ(test, e.bits, 32);
	KUNIT_EXPECT_EQ(test, e.access, 0x007F);
	KUNIT_EXPECT_MEMEQ(test, e.name, "Target position", 15);

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1600, 1, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(x->buf, s.size, &e), 0);
	KUNIT_EXPECT_MEMEQ(test, e.name, "SubIndex 001", 12);
	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1600, 12, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(x->buf, s.size, &e), 0);
	KUNIT_EXPECT_MEMEQ(test, e.name, "SubIndex 012", 12);

	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x3000, 0, x->buf, sizeof(x->buf));
	KUNIT_EXPECT_LT(test, info(x, &s), 0);
	KUNIT_EXPECT_EQ(test, s.abort, EC_ABORT_NO_OBJECT);
}

/* A slave sends of the optional fields what it has and the master asks for. */
static void sim_app_mbox_describes_values(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive mbox=64 mapping=rewritable\n", 64);
	struct ec_od_values v;
	struct ec_sdoinfo s;
	size_t plain;

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x60FF, 0, x->buf, sizeof(x->buf));
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	plain = s.size;
	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x60FF, 0, x->buf, sizeof(x->buf));
	s.info = EC_OD_INFO_VALUES;
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_values_decode(x->buf, s.size, plain, &v), 0);
	KUNIT_EXPECT_EQ(test, v.info, EC_OD_INFO_VALUES);
	KUNIT_EXPECT_EQ(test, v.unit, 0xB503u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v.def), 0u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v.min), (u32)-2000000);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v.max), 2000000u);

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x60FF, 0, x->buf, sizeof(x->buf));
	s.info = EC_OD_INFO_MAX;
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_EXPECT_EQ(test, s.size, plain + 4);
	/* an entry without any of them */
	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, x->buf, sizeof(x->buf));
	s.info = EC_OD_INFO_VALUES;
	KUNIT_ASSERT_EQ(test, info(x, &s), 0);
	KUNIT_ASSERT_EQ(test, ec_od_values_decode(x->buf, s.size, s.size, &v), 0);
	KUNIT_EXPECT_EQ(test, v.info, 0);
}

/* newest message of the diagnosis history: 0 or what ec_diag_msg_decode() says */
static int newest(struct mb *x, struct ec_diag_msg *m)
{
	u8 at = (u8)app_get(x->b, &x->m, EC_DIAG_INDEX, EC_DIAG_SUB_NEWEST);
	u32 abort;
	int len = app_upload(x->b, &x->m, EC_DIAG_INDEX, at, false, x->buf, sizeof(x->buf), &abort);

	return len < 0 ? len : ec_diag_msg_decode(x->buf, (size_t)len, m);
}

static void sim_app_mbox_keeps_newest_diagnosis_messages(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive mbox=128 diag=3\n", 128);
	struct ec_app *app = ec_sim_find(x->b->sim, "d");
	struct ec_diag_param p;
	struct ec_diag_msg m;
	static const u8 none[5];
	u8 value = 5;

	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, EC_DIAG_INDEX, EC_DIAG_SUB_MAX), 3);
	KUNIT_ASSERT_EQ(test, newest(x, &m), 0);
	KUNIT_EXPECT_EQ(test, m.flags & 0xF, EC_DIAG_INFO);
	KUNIT_EXPECT_EQ(test, m.params, 0);
	for (u16 i = 1; i <= 4; i++) {
		ec_app_diag_emergency(app, 0x8130 + i, 0x11, i);
		KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, EC_DIAG_INDEX, EC_DIAG_SUB_NEWEST),
				6u + i % 3);
	}
	KUNIT_ASSERT_EQ(test, newest(x, &m), 0);
	KUNIT_EXPECT_EQ(test, m.code, 0x8134E800u);
	KUNIT_EXPECT_EQ(test, m.flags & 0xF, EC_DIAG_WARNING);
	KUNIT_EXPECT_EQ(test, m.time_ns, 4);
	KUNIT_ASSERT_EQ(test, ec_diag_param_decode(&m, &p), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(p.data), 0x8134);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, EC_DIAG_INDEX, 4), 1);

	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, EC_DIAG_INDEX, 3, false, &value, 1),
			EC_ABORT_TOO_LOW);
	value = 9;
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, EC_DIAG_INDEX, 3, false, &value, 1),
			EC_ABORT_TOO_HIGH);
	value = 7;
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, EC_DIAG_INDEX, 3, false, &value, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, EC_DIAG_INDEX, 4), 0);
	KUNIT_EXPECT_EQ(test, app_download(x->b, &x->m, EC_DIAG_INDEX, 3, false, none, 1), 0u);
	KUNIT_EXPECT_EQ(test, app_get(x->b, &x->m, EC_DIAG_INDEX, EC_DIAG_SUB_NEWEST), 0);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, EC_DIAG_INDEX, 6, false, x->buf,
					 sizeof(x->buf), (u32[1]){ 0 }), EC_APP_DIAG_BYTES);
	KUNIT_EXPECT_EQ(test, ec_diag_msg_decode(x->buf, EC_APP_DIAG_BYTES, &m), -ENOMSG);
	/* a fault adds the next one */
	ec_app_al_fail(app, EC_AL_PREOP, 0x001D, 77);
	KUNIT_ASSERT_EQ(test, newest(x, &m), 0);
	KUNIT_EXPECT_EQ(test, m.flags & 0xF, EC_DIAG_ERROR);
}

static void sim_app_mbox_keeps_no_diagnosis_without_coe(struct kunit *test)
{
	struct ec_app *app = ec_sim_find(app_bed(test, "slave d io cpu=yes diag=3\n")->sim, "d");

	ec_app_diag_emergency(app, 1, 1, 1);
	KUNIT_EXPECT_NULL(test, ec_app_od_object(app->model, EC_DIAG_INDEX));
}

static u16 error_of(struct mb *x)
{
	struct ec_mbox_hdr h;
	int len = app_recv(x->b, &x->m, &h, 10);
	struct ec_rbuf r;
	u16 detail = 0;

	if (len < 0 || h.type != EC_MBOX_ERR)
		return 0xFFFF;
	r = ec_rbuf(x->m.rx + EC_MBOX_HDR, (size_t)len);
	return ec_mbox_error_decode(&r, &detail) ? 0xFFFE : detail;
}

static void sim_app_mbox_errors_are_reported(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	struct ec_mbox_hdr h;

	memset(x->m.tx, 0, sizeof(x->m.tx));
	app_send(x->b, &x->m, EC_MBOX_SOE, 10);
	KUNIT_EXPECT_EQ(test, error_of(x), EC_MBOX_ERR_PROTOCOL);
	app_send(x->b, &x->m, EC_MBOX_COE, 1);
	KUNIT_EXPECT_EQ(test, error_of(x), EC_MBOX_ERR_TOO_SHORT);
	put_unaligned_le16(0x4000, x->m.tx + EC_MBOX_HDR);
	app_send(x->b, &x->m, EC_MBOX_COE, 10);
	KUNIT_EXPECT_EQ(test, error_of(x), EC_MBOX_ERR_SERVICE);
	/* longer than the mailbox */
	put_unaligned_le16(300, x->m.tx);
	x->m.tx[5] = EC_MBOX_COE;
	bed_tx(x->b, EC_CMD_FPWR, x->m.station, 0x1000, x->m.tx, 256);
	KUNIT_EXPECT_EQ(test, error_of(x), EC_MBOX_ERR_SIZE);
	/* channel */
	put_unaligned_le16(10, x->m.tx);
	x->m.tx[4] = 1;
	bed_tx(x->b, EC_CMD_FPWR, x->m.station, 0x1000, x->m.tx, 256);
	KUNIT_EXPECT_EQ(test, error_of(x), EC_MBOX_ERR_CHANNEL);
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 2), -1);
}

static size_t upload_request(struct app_mbox *m, u16 index, u8 sub)
{
	struct ec_sdo u;
	u8 buf[4];

	ec_sdo_upload_init(&u, index, sub, false, buf, sizeof(buf));
	return (size_t)ec_sdo_tx(&u, m->tx + EC_MBOX_HDR, 100);
}

static void sim_app_mbox_counter_and_repeat(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	struct app_mbox *m = &x->m;
	struct bed *b = x->b;
	struct ec_mbox_hdr h;
	u8 first[16];

	KUNIT_EXPECT_EQ(test, app_send(b, m, EC_MBOX_COE,
				       upload_request(m, 0x1018, 2)), 1);
	/* the same again: dropped, there is one answer only */
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, m->station, 0x1000, m->tx,
				     256), 1);
	KUNIT_EXPECT_EQ(test, app_recv(b, m, &h, 10), 10);
	memcpy(first, m->rx, sizeof(first));
	KUNIT_EXPECT_EQ(test, app_recv(b, m, &h, 2), -1);
	/* the answer was lost: ask for it again */
	KUNIT_EXPECT_EQ(test, bed_put(b, m->station,
				      EC_REG_SM(1) + EC_SM_OFS_ACTIVATE,
				      EC_SM_ACT_ENABLE | EC_SM_ACT_REPEAT, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, m->station,
				      EC_REG_SM(1) + EC_SM_OFS_PDI, 1),
			EC_SM_PDI_REPEAT_ACK);
	KUNIT_EXPECT_EQ(test, app_recv(b, m, &h, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, m->rx, first, sizeof(first));
	/* and once more while the next answer lies there unread */
	KUNIT_EXPECT_EQ(test, app_send(b, m, EC_MBOX_COE,
				       upload_request(m, 0x1018, 3)), 1);
	b->now += 1000000;
	bed_put(b, m->station, EC_REG_SM(1) + EC_SM_OFS_ACTIVATE,
		EC_SM_ACT_ENABLE, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, m->station,
				      EC_REG_SM(1) + EC_SM_OFS_PDI, 1), 0);
	KUNIT_EXPECT_EQ(test, app_recv(b, m, &h, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, m->rx, first, sizeof(first));
	KUNIT_EXPECT_EQ(test, app_recv(b, m, &h, 10), 10);
	KUNIT_EXPECT_EQ(test, m->rx[EC_MBOX_HDR + 5], 3);
}

/* from 1 to 7 and again, 0 is never sent */
static void sim_app_mbox_replies_are_counted(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	struct ec_mbox_hdr h;

	for (int i = 0; i < 9; i++) {
		app_send(x->b, &x->m, EC_MBOX_COE,
			 upload_request(&x->m, 0x1018, 1));
		KUNIT_ASSERT_EQ(test, app_recv(x->b, &x->m, &h, 10), 10);
		KUNIT_EXPECT_EQ(test, h.counter, 1 + i % 7);
	}
}

static void sim_app_mbox_delay_of_replies(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive response=3ms\n", 256);
	struct ec_mbox_hdr h;
	u64 from = x->b->now;

	app_send(x->b, &x->m, EC_MBOX_COE, upload_request(&x->m, 0x1018, 1));
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 2), -1);
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 4), 10);
	KUNIT_EXPECT_GE(test, x->b->now - from, 3000000ull);
}

/* the script chooses the code of aborts, and no other answer changes */
static void sim_app_mbox_abort_code(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n"
		"fault at=10ms mailbox d abort code=0x08000099\n"
		"fault at=20ms mailbox d good\n", 256);
	u32 abort = 0;
	u8 v[4];

	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x5fff, 1, false, v, 4, &abort), -1);
	KUNIT_EXPECT_EQ(test, abort, EC_ABORT_NO_OBJECT);
	x->b->now = max(x->b->now, 11000000ull);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x5fff, 1, false, v, 4, &abort), -1);
	KUNIT_EXPECT_EQ(test, abort, 0x08000099u);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x1018, 1, false, v, 4, &abort), 4);
	x->b->now = max(x->b->now, 21000000ull);
	KUNIT_EXPECT_EQ(test, app_upload(x->b, &x->m, 0x5fff, 1, false, v, 4, &abort), -1);
	KUNIT_EXPECT_EQ(test, abort, EC_ABORT_NO_OBJECT);
}

static void sim_app_mbox_emergencies(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n"
		"fault at=10ms emergency d code=0x8130 register=0x11\n"
		"fault at=10ms emergency d code=0\n", 256);
	struct ec_coe_emergency e;
	struct ec_mbox_hdr h;

	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 5), -1);
	KUNIT_ASSERT_EQ(test, app_recv(x->b, &x->m, &h, 10), 10);
	KUNIT_ASSERT_EQ(test, ec_coe_emergency_decode(x->m.rx + EC_MBOX_HDR, 10,
						      &e), 0);
	KUNIT_EXPECT_EQ(test, e.code, 0x8130);
	KUNIT_EXPECT_EQ(test, e.reg, 0x11);
	KUNIT_ASSERT_EQ(test, app_recv(x->b, &x->m, &h, 10), 10);
	KUNIT_ASSERT_EQ(test, ec_coe_emergency_decode(x->m.rx + EC_MBOX_HDR, 10,
						      &e), 0);
	KUNIT_EXPECT_EQ(test, e.code, 0);
}

static void sim_app_mbox_muted_slave_does_not_reply(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\nfault at=20ms mute d\n"
			      "fault at=60ms unmute d\n", 256);
	struct ec_mbox_hdr h;

	x->b->now = 21000000;
	app_send(x->b, &x->m, EC_MBOX_COE, upload_request(&x->m, 0x1018, 1));
	bed_put(x->b, x->m.station, EC_REG_AL_CONTROL, EC_AL_PREOP, 2);
	/* AL control is not taken: a second write is refused */
	KUNIT_EXPECT_EQ(test, bed_put(x->b, x->m.station, EC_REG_AL_CONTROL,
				      EC_AL_PREOP, 2), 0);
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 30), -1);
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 30), 10);
	KUNIT_EXPECT_EQ(test, app_al_status(x->b, x->m.station),
			(u32)EC_AL_PREOP);
}

/* Header of the answer to an upload while the mailbox is wrong in way @kind. */
static void spoiled_header(struct kunit *test, struct mb *x, u32 kind, u8 raw[6])
{
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_MAILBOX, .arg = kind };

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(x->b->sim, &f), 0);
	app_send(x->b, &x->m, EC_MBOX_COE, upload_request(&x->m, 0x1018, 1));
	x->b->now += 5000000;
	KUNIT_ASSERT_EQ(test, bed_rd(x->b, x->m.station, 0x1000 + 256, x->buf, 256), 1);
	memcpy(raw, x->buf, 6);
	/* the buffer is empty now, but for one that sends without end */
	x->b->now += 5000000;
	KUNIT_EXPECT_EQ(test, !!(bed_get(x->b, x->m.station, EC_REG_SM(1) + EC_SM_OFS_STATUS, 1) &
				 EC_SM_ST_FULL),
			kind == EC_SIM_MAILBOX_BABBLE || kind == EC_SIM_MAILBOX_STALE);
}

static void sim_app_mbox_faulty_messages_are_sent(struct kunit *test)
{
	struct mb *x = mb_new(test, "slave d drive\n", 256);
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_MAILBOX, .arg = EC_SIM_MAILBOX_FAULTS };
	u8 h[6];

	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(x->b->sim, &f), -EINVAL);
	spoiled_header(test, x, EC_SIM_MAILBOX_GOOD, h);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(h), 10);
	KUNIT_EXPECT_EQ(test, h[5], 1 << 4 | EC_MBOX_COE);
	spoiled_header(test, x, EC_SIM_MAILBOX_LENGTH, h);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(h), 0xffff);
	spoiled_header(test, x, EC_SIM_MAILBOX_SHORT, h);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(h), 1);
	spoiled_header(test, x, EC_SIM_MAILBOX_COUNTER, h);
	KUNIT_EXPECT_EQ(test, h[5], 1 << 4 | EC_MBOX_COE);
	spoiled_header(test, x, EC_SIM_MAILBOX_TYPE, h);
	KUNIT_EXPECT_EQ(test, h[5], 5 << 4 | EC_MBOX_FOE);
	spoiled_header(test, x, EC_SIM_MAILBOX_BABBLE, h);
	KUNIT_EXPECT_EQ(test, h[5], 6 << 4 | EC_MBOX_FOE);
	/* the last of it */
	f.arg = EC_SIM_MAILBOX_GOOD;
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(x->b->sim, &f), 0);
	KUNIT_ASSERT_EQ(test, bed_rd(x->b, x->m.station, 0x1000 + 256, x->buf, 256), 1);
	spoiled_header(test, x, EC_SIM_MAILBOX_STALE, h);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(h), EC_SDOINFO_HDR + 2);
	KUNIT_EXPECT_EQ(test, h[5] & 0x0f, EC_MBOX_COE);
	KUNIT_EXPECT_EQ(test, x->buf[7] >> 4, EC_COE_SDO_INFO);
	KUNIT_EXPECT_EQ(test, x->buf[8], EC_SDOINFO_LIST_RESP);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_mbox_identity),
	KUNIT_CASE(sim_app_mbox_aborts),
	KUNIT_CASE(sim_app_mbox_segmented),
	KUNIT_CASE(sim_app_mbox_complete_access),
	KUNIT_CASE(sim_app_mbox_information),
	KUNIT_CASE(sim_app_mbox_describes_values),
	KUNIT_CASE(sim_app_mbox_keeps_newest_diagnosis_messages),
	KUNIT_CASE(sim_app_mbox_keeps_no_diagnosis_without_coe),
	KUNIT_CASE(sim_app_mbox_errors_are_reported),
	KUNIT_CASE(sim_app_mbox_counter_and_repeat),
	KUNIT_CASE(sim_app_mbox_replies_are_counted),
	KUNIT_CASE(sim_app_mbox_delay_of_replies),
	KUNIT_CASE(sim_app_mbox_emergencies),
	KUNIT_CASE(sim_app_mbox_abort_code),
	KUNIT_CASE(sim_app_mbox_muted_slave_does_not_reply),
	KUNIT_CASE(sim_app_mbox_faulty_messages_are_sent),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_app_mbox",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
MODULE_LICENSE("GPL");
