// SPDX-License-Identifier: GPL-2.0-only
/* SDO upload and download in their three sizes, errors, and how long they take. */
#include "bus.h"
#include "devices/sim/codes.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/wire/coe.h"
#include "master/wire/sdo.h"
#include "master/wire/sdoinfo.h"

#define RESPONSE_US	500
#define SCRATCH		0x2000	/* 1000 bytes */
#define TYPES		0x2001	/* a record */

static const char line[] =
	"segment seed=8 response=500us transition=200us\n"
	"slave small drive mbox=64\nslave large drive mbox=512\nslave digital EL2008\n";

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, line, 3);

	bus_idle(b);
	return b;
}

static void pattern(u8 *data, size_t n)
{
	size_t i;

	for (i = 0; i < n; i++)
		data[i] = (u8)(i * 7 + n);
}

/* down and up again; the slave holds what was sent */
static void there_and_back(struct bus *b, u32 position, const char *name, u16 index, u8 sub,
			   size_t n)
{
	struct ec_slave *s = bus_slave(b, position);
	struct ec_app *app = bus_app(b, name);
	const struct ec_app_entry *e = ec_app_od_entry(app->model, index, sub);
	u8 *out = kunit_kzalloc(b->test, 1000, GFP_KERNEL);
	u8 *in = kunit_kzalloc(b->test, 1000, GFP_KERNEL);
	size_t got = 0;
	u32 abort;

	KUNIT_ASSERT_NOT_NULL(b->test, out);
	KUNIT_ASSERT_NOT_NULL(b->test, in);
	KUNIT_ASSERT_NOT_NULL(b->test, e);
	pattern(out, n);
	KUNIT_EXPECT_EQ_MSG(b->test,
			    ec_coe_download(&s->mbox, index, sub, false, out, n, &abort, NULL), 0,
			    "%zu bytes to %s: abort 0x%08x", n, name, abort);
	KUNIT_EXPECT_MEMEQ(b->test, app->data + e->off, out, n);
	KUNIT_EXPECT_EQ(b->test,
			ec_coe_upload(&s->mbox, index, sub, false, in, 1000, &got, &abort,
				      NULL), 0);
	KUNIT_EXPECT_EQ(b->test, got, n);
	KUNIT_EXPECT_MEMEQ(b->test, in, out, n);
	KUNIT_EXPECT_EQ(b->test, abort, 0);
}

static void sdo_expedited(struct kunit *test)
{
	struct bus *b = ready(test);

	there_and_back(b, 0, "small", TYPES, 2, 1);
	there_and_back(b, 0, "small", TYPES, 7, 2);
	there_and_back(b, 1, "large", TYPES, 8, 4);
}

static void sdo_normal(struct kunit *test)
{
	struct bus *b = ready(test);

	/* 64 - 16 bytes fit behind the headers */
	there_and_back(b, 0, "small", TYPES, 9, 8);
	there_and_back(b, 0, "small", TYPES, 12, 16);
}

static void sdo_segmented(struct kunit *test)
{
	struct bus *b = ready(test);

	there_and_back(b, 0, "small", SCRATCH, 0, 1000);
	there_and_back(b, 1, "large", SCRATCH, 0, 1000);
}

static void sdo_complete_access(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 0);
	u8 buf[64];
	size_t got;
	u32 abort;

	KUNIT_ASSERT_EQ(test,
			ec_coe_upload(&s->mbox, 0x1018, 0, true, buf, sizeof(buf), &got, &abort,
				      NULL),
			0);
	KUNIT_EXPECT_EQ(test, got, 18ul);
	KUNIT_EXPECT_EQ(test, buf[0], 4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(buf + 2), s->info.vendor);
}

static void sdo_errors(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 0);
	u8 buf[8] = { 0 };
	size_t got;
	u32 abort;

	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x3fff, 0, false, buf, 8, &got, &abort, NULL),
			-EIO);
	KUNIT_EXPECT_EQ(test, abort, EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, ec_coe_download(&s->mbox, 0x1018, 1, false, buf, 4, &abort, NULL),
			-EIO);
	KUNIT_EXPECT_EQ(test, abort, EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_EQ(test,
			ec_coe_upload(&s->mbox, SCRATCH, 0, false, buf, 8, &got, &abort, NULL),
			-ENOBUFS);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(bus_mbox(b, 2), 0x1000, 0, false, buf, 8, &got,
					    &abort, NULL), -EPROTONOSUPPORT);
	/* and the mailbox works on */
	there_and_back(b, 0, "small", TYPES, 8, 4);

	bus_request(b, 0, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_INIT, 500), ~0ull);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x1000, 0, false, buf, 8, &got, &abort, NULL),
			-EAGAIN);
}

/* What the slave says about its objects; a mailbox of 64 bytes needs fragments. */
static void sdo_information(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *small = bus_mbox(b, 0);
	const struct ec_app *app = bus_app(b, "small");
	struct ec_sdoinfo i;
	struct ec_od_entry e;
	u8 buf[1024];

	ec_sdoinfo_init(&i, EC_SDOINFO_LIST_REQ, 1, 0, buf, sizeof(buf));
	KUNIT_ASSERT_EQ(test, ec_coe_info(small, &i, NULL), 0);
	KUNIT_EXPECT_EQ(test, i.size, 2 * (size_t)app->model->n_objects);
	KUNIT_EXPECT_GT(test, i.size, (size_t)64 - EC_MBOX_HDR - EC_SDOINFO_HDR - 2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(buf), 0x1000);

	ec_sdoinfo_init(&i, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, buf, sizeof(buf));
	KUNIT_ASSERT_EQ(test, ec_coe_info(small, &i, NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(buf, i.size, &e), 0);
	KUNIT_EXPECT_EQ(test, e.bits, 32);
	KUNIT_EXPECT_EQ(test, e.access, EC_OD_READ);

	ec_sdoinfo_init(&i, EC_SDOINFO_OBJECT_REQ, 0x3fff, 0, buf, sizeof(buf));
	KUNIT_EXPECT_EQ(test, ec_coe_info(small, &i, NULL), -EIO);
	KUNIT_EXPECT_EQ(test, i.abort, EC_ABORT_NO_OBJECT);
	ec_sdoinfo_init(&i, EC_SDOINFO_LIST_REQ, 1, 0, buf, 7);
	KUNIT_EXPECT_EQ(test, ec_coe_info(small, &i, NULL), -ENOBUFS);
	ec_sdoinfo_init(&i, EC_SDOINFO_LIST_REQ, 1, 0, buf, sizeof(buf));
	KUNIT_EXPECT_EQ(test, ec_coe_info(bus_mbox(b, 2), &i, NULL), -EPROTONOSUPPORT);
	/* and the mailbox works on */
	there_and_back(b, 0, "small", TYPES, 8, 4);
}

/* An EEPROM names a mailbox larger than a datagram: nothing is sent there. */
static void sdo_huge_mailbox(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 0);
	const u16 tx_size = s->info.std.tx_size;
	u8 *data = kvzalloc(60000, GFP_KERNEL);
	size_t got;
	u32 abort;

	KUNIT_ASSERT_NOT_NULL(test, data);
	s->info.std.rx_size = 0xf000;
	KUNIT_EXPECT_EQ(test,
			ec_coe_download(&s->mbox, SCRATCH, 0, false, data, 60000, &abort, NULL),
			-EMSGSIZE);
	s->info.std.rx_size = 64;
	s->info.std.tx_size = 0xf000;
	KUNIT_EXPECT_EQ(test,
			ec_coe_upload(&s->mbox, SCRATCH, 0, false, data, 60000, &got, &abort, NULL),
			-EMSGSIZE);
	kvfree(data);
	s->info.std.tx_size = tx_size;
	there_and_back(b, 0, "small", TYPES, 8, 4);
}

/* Nobody answers: the time limit holds, the others are not concerned. */
static void sdo_mute(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 t0 = ktime_get_ns(), ms;
	u8 buf[8];
	size_t got;
	u32 abort;

	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test,
			ec_coe_upload(bus_mbox(b, 0), 0x1000, 0, false, buf, 8, &got,
				      &abort,
					    &(struct ec_mbox_limit){ .timeout_ms = 200 }), -ETIMEDOUT);
	ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	KUNIT_EXPECT_GE(test, ms, 200ull);
	KUNIT_EXPECT_LE(test, ms, 210ull);
	there_and_back(b, 1, "large", TYPES, 8, 4);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	msleep(10);
	/* the late answer is not taken for the one of the next request */
	there_and_back(b, 0, "small", TYPES, 8, 4);
}

/* An emergency in between is logged, not taken for an answer. */
static void sdo_emergency(struct kunit *test)
{
	static const u8 data[5] = { 1, 2, 3, 4, 5 };
	struct bus *b = ready(test);
	u32 i;

	for (i = 0; i < 3; i++)
		ec_app_emergency(bus_app(b, "small"), 0x8110, 0x11, data, ktime_get_ns());
	there_and_back(b, 0, "small", TYPES, 8, 4);
}

/* The mailboxes of an EEPROM hold no reply: no transfer begins. */
static void sdo_mailbox_without_room_refused(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 0);
	const u16 tx_size = s->info.std.tx_size;
	u8 v[4];
	size_t got;
	u32 abort;

	s->info.std.tx_size = EC_MBOX_HDR + EC_SDO_MSG - 1;
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, TYPES, 8, false, v, 4, &got, &abort, NULL),
			-EMSGSIZE);
	s->info.std.tx_size = tx_size;
	there_and_back(b, 0, "small", TYPES, 8, 4);
}

/* Each segment comes just in time, and there are many of them. */
static void sdo_slow_segments_end_transfer(struct kunit *test)
{
	const struct ec_mbox_limit limit = { .timeout_ms = 5000 };
	struct bus *b = ready(test);
	struct ec_mbox *small = bus_mbox(b, 0);
	u8 *v = kunit_kzalloc(test, 1000, GFP_KERNEL);
	u64 t0 = ktime_get_ns(), up, down;
	size_t got;
	u32 abort;

	KUNIT_ASSERT_NOT_NULL(test, v);
	bus_app(b, "small")->response_ns = 4u * NSEC_PER_SEC;
	KUNIT_EXPECT_EQ(test, ec_coe_upload(small, SCRATCH, 0, false, v, 1000, &got, &abort,
					    &limit), -ETIMEDOUT);
	up = ktime_get_ns() - t0;
	t0 += up;
	KUNIT_EXPECT_EQ(test, ec_coe_download(small, SCRATCH, 0, false, v, 1000, &abort, &limit),
			-ETIMEDOUT);
	down = ktime_get_ns() - t0;
	bus_figure("1000 bytes at 4 s a segment: upload ends after %llu ms, download after %llu ms",
		   div_u64(up, NSEC_PER_MSEC), div_u64(down, NSEC_PER_MSEC));
	KUNIT_EXPECT_GE(test, up, 60 * NSEC_PER_SEC);
	KUNIT_EXPECT_LE(test, max(up, down), 70 * NSEC_PER_SEC);
	bus_app(b, "small")->response_ns = 0;
	msleep(10000);
	there_and_back(b, 0, "small", SCRATCH, 0, 1000);
}

/*
 * The tick of this kernel is 10 ms: were anything bound to it, an upload would
 * take at least that long.
 */
/*
 * One frame of an exchange is lost, every one in turn. On the way back the
 * slave has done its part, so the exchange succeeds; lost before, only the
 * request may be missed. The next exchange never sees remains of this one.
 */
static void sdo_lost_frames(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 0);
	u32 n, back, failed = 0, abort;
	size_t got;
	u8 in[8];

	for (back = 0; back < 2; back++) {
		for (n = 1; n <= 9; n++) {
			struct ec_sim_fault f = {
				.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1,
				.arg = n, .value = back,
			};
			int ret;

			KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
			ret = ec_coe_upload(&s->mbox, 0x1018, 2, false, in, sizeof(in), &got,
					    &abort, NULL);
			if (back || ret != -ETIMEDOUT)
				KUNIT_EXPECT_EQ_MSG(test, ret, 0, "frame %u, back %u", n, back);
			failed += !!ret;
			usleep_range(50000, 50001);
			KUNIT_EXPECT_EQ(test,
					ec_coe_upload(&s->mbox, 0x1018, 1, false, in, sizeof(in),
							    &got, &abort, NULL), 0);
			KUNIT_EXPECT_EQ(test, get_unaligned_le32(in), s->info.vendor);
		}
	}
	KUNIT_EXPECT_LE(test, failed, 1u);
	KUNIT_EXPECT_GE(test, bus_lost(b), 16ull);
}

static void sdo_latency(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_slave *s = bus_slave(b, 1);
	u64 sum = 0, worst = 0;
	u8 buf[4];
	size_t got;
	u32 abort, i;

	for (i = 0; i < 100; i++) {
		u64 t0, us;

		usleep_range(3000 + 137 * i, 3001 + 137 * i);
		t0 = ktime_get_ns();
		KUNIT_ASSERT_EQ(test,
				ec_coe_upload(&s->mbox, 0x1000, 0, false, buf, 4, &got, &abort,
					      NULL),
				0);
		us = div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
		sum += us;
		worst = max(worst, us);
	}
	bus_figure("SDO upload, expedited, idle bus, slave takes %u us, HZ=%u: mean %llu us, worst %llu us",
		   RESPONSE_US, HZ, div_u64(sum, 100), worst);
	bus_row(worst - RESPONSE_US, 2000, "us of bus time: SDO upload, without the slave's own");
	KUNIT_EXPECT_LT(test, worst, 2000ull + RESPONSE_US);
	KUNIT_EXPECT_LT(test, worst, 10000ull);
	KUNIT_EXPECT_EQ(test, HZ, 100);
}

/* A slave that takes long is asked ever less often, and its reply is seen in time. */
static void sdo_slow_reply(struct kunit *test)
{
	static const struct { u32 ms, frames; } t[] = { { 5, 20 }, { 50, 60 }, { 900, 300 } };
	struct bus *b = ready(test);
	size_t got;
	u32 i, abort;
	u8 v[4];

	for (i = 0; i < ARRAY_SIZE(t); i++) {
		u64 frames = bus_frames(b), t0 = ktime_get_ns(), us;

		bus_app(b, "large")->response_ns = t[i].ms * NSEC_PER_MSEC;
		KUNIT_EXPECT_EQ(test,
				ec_coe_upload(bus_mbox(b, 1), TYPES, 8, false, v, 4, &got,
						    &abort, NULL), 0);
		us = div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
		/* those of the monitor are among them */
		frames = bus_frames(b) - frames;
		bus_figure("reply after %u ms: seen after %llu us, %llu frames", t[i].ms, us,
			   frames);
		KUNIT_EXPECT_LE(test, us, t[i].ms * 1125ull + 1000);
		KUNIT_EXPECT_LE(test, frames, (u64)t[i].frames);
	}
}

static struct kunit_case sdo_cases[] = {
	KUNIT_CASE(sdo_expedited),
	KUNIT_CASE(sdo_normal),
	KUNIT_CASE(sdo_segmented),
	KUNIT_CASE(sdo_complete_access),
	KUNIT_CASE(sdo_errors),
	KUNIT_CASE(sdo_information),
	KUNIT_CASE(sdo_huge_mailbox),
	KUNIT_CASE(sdo_mailbox_without_room_refused),
	KUNIT_CASE(sdo_slow_segments_end_transfer),
	KUNIT_CASE(sdo_mute),
	KUNIT_CASE(sdo_emergency),
	KUNIT_CASE(sdo_lost_frames),
	KUNIT_CASE(sdo_latency),
	KUNIT_CASE(sdo_slow_reply),
	{}
};

static struct kunit_suite sdo_suite = {
	.name = "bus_sdo",
	.exit = bus_exit,
	.test_cases = sdo_cases,
};

kunit_test_suite(sdo_suite);

MODULE_LICENSE("GPL");
