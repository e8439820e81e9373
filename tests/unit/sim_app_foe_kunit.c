// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: FoE server. */
#include "sim_app_kunit.h"

#define ROOM	(256 - 12)	/* data of a packet */

struct files {
	struct bed *b;
	struct app_mbox m;
	u8 buf[65536 + 1];
	u32 busy;	/* BUSY answers of the last transfer */
};

static struct files *files_new(struct kunit *test, const char *text)
{
	struct files *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->b = app_bed(test, text);
	x->m.station = STATION(0);
	x->m.size = 256;
	app_mbox_sms(x->b, x->m.station, 256);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->m.station, EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	return x;
}

/* 0; the error code of the slave; ~0: nothing of sense */
static u32 transfer(struct files *x, struct ec_foe *f)
{
	struct ec_mbox_hdr h;
	int ret = EC_MORE, len;

	f->name_len = strlen(f->name);
	x->busy = 0;
	while (ret == EC_MORE) {
		u8 *data = x->m.tx + EC_MBOX_HDR;

		len = ec_foe_tx(f, data, x->m.size - EC_MBOX_HDR);
		if (len < 0)
			return ~0u;
		if (f->write && f->begun)
			memcpy(data + EC_FOE_HDR, x->buf + f->at, f->n);
		if (app_send(x->b, &x->m, EC_MBOX_FOE, (size_t)len) != 1)
			return ~0u;
		if (!f->write && f->last)
			return app_recv(x->b, &x->m, &h, 10) < 0 ? 0 : ~0u;
		len = app_recv(x->b, &x->m, &h, 100);
		if (len < 0 || h.type != EC_MBOX_FOE)
			return ~0u;
		data = x->m.rx + EC_MBOX_HDR;
		ret = ec_foe_rx(f, data, (size_t)len, ROOM);
		x->busy += f->busy;
		if (ret == EC_MORE && !f->write && !f->busy)
			memcpy(x->buf + f->at, data + EC_FOE_HDR, f->n);
	}
	return ret == -EREMOTEIO ? f->error : (u32)ret;
}

static u32 put(struct files *x, const char *name, u32 size)
{
	struct ec_foe f = { .write = true, .name = name, .size = size };

	for (u32 i = 0; i < size; i++)
		x->buf[i] = (u8)(i * 7 + size);
	return transfer(x, &f);
}

static u32 get(struct files *x, const char *name, u64 *size)
{
	struct ec_foe f = { .name = name, .password = 0x55aa };
	u32 error;

	memset(x->buf, 0, sizeof(x->buf));
	error = transfer(x, &f);
	*size = f.size;
	return error;
}

static void sim_app_foe_file_is_kept_as_written(struct kunit *test)
{
	static const u32 sizes[] = { 0, 1, ROOM - 1, ROOM, ROOM + 1, 5000, 65536 };
	struct files *x = files_new(test, "slave d drive foe=64 mbox=256\n");
	u32 i, k;
	u64 size;

	KUNIT_EXPECT_EQ(test, get(x, "a", &size), (u32)EC_FOE_ERR_NOT_FOUND);
	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		KUNIT_ASSERT_EQ(test, put(x, "a.bin", sizes[i]), 0u);
		KUNIT_EXPECT_EQ(test, get(x, "a", &size), (u32)EC_FOE_ERR_NOT_FOUND);
		KUNIT_ASSERT_EQ(test, get(x, "a.bin", &size), 0u);
		KUNIT_ASSERT_EQ(test, size, (u64)sizes[i]);
		for (k = 0; k < sizes[i]; k++)
			KUNIT_ASSERT_EQ(test, x->buf[k], (u8)(k * 7 + sizes[i]));
	}
	KUNIT_EXPECT_EQ(test, ec_sim_find(x->b->sim, "d")->foe.password, 0x55aau);
	/* a file that does not fit leaves none */
	KUNIT_EXPECT_EQ(test, put(x, "b", 65537), (u32)EC_FOE_ERR_FULL);
	KUNIT_EXPECT_EQ(test, get(x, "b", &size), (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_EQ(test, get(x, "a.bin", &size), (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_EQ(test, put(x, "a name of more than thirty-two bytes", 1),
			(u32)EC_FOE_ERR_ILLEGAL);
}

static void sim_app_foe_is_busy_after_each_page(struct kunit *test)
{
	struct files *x = files_new(test, "slave d drive foe=64 foe_busy=3 mbox=256\n");
	u64 size;

	KUNIT_EXPECT_EQ(test, put(x, "a", 4000), 0u);
	KUNIT_EXPECT_EQ(test, x->busy, 0u);
	KUNIT_EXPECT_EQ(test, put(x, "a", 10000), 0u);
	KUNIT_EXPECT_EQ(test, x->busy, 6u);
	KUNIT_EXPECT_EQ(test, get(x, "a", &size), 0u);
	KUNIT_EXPECT_EQ(test, size, 10000ull);
	KUNIT_EXPECT_EQ(test, x->buf[9999], (u8)(9999 * 7 + 10000));
}

static void sim_app_foe_page_takes_its_time(struct kunit *test)
{
	struct files *x = files_new(test, "slave d drive foe=64 foe_page=20ms mbox=256\n");
	u64 t0 = x->b->now;

	KUNIT_EXPECT_EQ(test, put(x, "a", 4000), 0u);
	KUNIT_EXPECT_EQ(test, x->busy, 0u);
	KUNIT_EXPECT_LT(test, x->b->now - t0, 20000000ull);
	t0 = x->b->now;
	KUNIT_EXPECT_EQ(test, put(x, "a", 10000), 0u);
	KUNIT_EXPECT_GT(test, x->busy, 2u);
	KUNIT_EXPECT_GT(test, x->b->now - t0, 40000000ull);
}

static void sim_app_foe_other_header_or_state_is_refused(struct kunit *test)
{
	struct files *x = files_new(test, "slave d drive foe=64 foe_header=EC1 mbox=256\n"
				    "slave e EL7201 foe_boot=yes\n");
	struct ec_app *app = ec_sim_find(x->b->sim, "d");
	u64 size;

	KUNIT_EXPECT_EQ(test, put(x, "fw", 2), (u32)EC_FOE_ERR_PROGRAM);
	KUNIT_EXPECT_EQ(test, put(x, "fw", 5000), (u32)EC_FOE_ERR_PROGRAM);
	KUNIT_EXPECT_EQ(test, get(x, "fw", &size), (u32)EC_FOE_ERR_NOT_FOUND);
	app->foe.header[0] = (char)(u8)(5000);	/* as put() writes them */
	app->foe.header[1] = (char)(u8)(5007);
	app->foe.header[2] = (char)(u8)(5014);
	KUNIT_EXPECT_EQ(test, put(x, "fw", 5000), 0u);
	app->foe.boot = true;
	KUNIT_EXPECT_EQ(test, put(x, "fw", 5000), (u32)EC_FOE_ERR_BOOT_ONLY);
	KUNIT_EXPECT_EQ(test, get(x, "fw", &size), 0u);
	KUNIT_EXPECT_TRUE(test, ec_sim_find(x->b->sim, "e")->foe.boot);
}

/* sends one message, returns the error code in the answer; 0: none */
static u32 raw(struct files *x, u8 opcode, u32 number, size_t n)
{
	u8 *msg = x->m.tx + EC_MBOX_HDR;
	struct ec_mbox_hdr h;

	memset(msg, 'x', EC_FOE_HDR + n);
	msg[0] = opcode;
	put_unaligned_le32(number, msg + 2);
	app_send(x->b, &x->m, EC_MBOX_FOE, EC_FOE_HDR + n);
	if (app_recv(x->b, &x->m, &h, 10) < EC_FOE_HDR || x->m.rx[EC_MBOX_HDR] != EC_FOE_ERR)
		return 0;
	return get_unaligned_le32(x->m.rx + EC_MBOX_HDR + 2);
}

static void sim_app_foe_wrong_order_is_refused(struct kunit *test)
{
	struct files *x = files_new(test, "slave d drive foe=64 mbox=256\n");
	u64 size;

	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_DATA, 1, 4), (u32)EC_FOE_ERR_ILLEGAL);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_ACK, 0, 0), (u32)EC_FOE_ERR_ILLEGAL);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_WRQ, 0, 0), (u32)EC_FOE_ERR_ILLEGAL);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_WRQ, 0, 2), 0u);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_DATA, 2, 4), (u32)EC_FOE_ERR_PACKET);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_DATA, 1, 4), (u32)EC_FOE_ERR_ILLEGAL);
	/* a write that the master ends leaves no file */
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_WRQ, 0, 2), 0u);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_DATA, 1, ROOM), 0u);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_ERR, 0, 3), 0u);
	KUNIT_EXPECT_EQ(test, raw(x, EC_FOE_DATA, 2, 4), (u32)EC_FOE_ERR_ILLEGAL);
	KUNIT_EXPECT_EQ(test, get(x, "xx", &size), (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_EQ(test, raw(x, 9, 0, 0), (u32)EC_FOE_ERR_ILLEGAL);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_foe_file_is_kept_as_written),
	KUNIT_CASE(sim_app_foe_is_busy_after_each_page),
	KUNIT_CASE(sim_app_foe_page_takes_its_time),
	KUNIT_CASE(sim_app_foe_other_header_or_state_is_refused),
	KUNIT_CASE(sim_app_foe_wrong_order_is_refused),
	{}
};

static struct kunit_suite suite = { .name = "sim_app_foe", .exit = bed_exit, .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
