// SPDX-License-Identifier: GPL-2.0-only
/* Mailbox services on a bus that loses frames: none is lost, none is done twice. */
#include "bus.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"

#define SCRATCH	0x2000	/* LONG bytes */
#define LONG	1000
#define TYPES	0x2001	/* a record */
#define ONE_PERCENT	10000	/* ppm */
#define TRANSFERS	25000	/* per seed; a case has 300 s */
#define EACH		150	/* 20 transfers have more frames */

/* "mbox=64": what is longer than 48 bytes comes in segments */
#define TEXT(seed) \
	"segment seed=" seed " response=100us transition=200us\n" \
	"slave sure drive mbox=64 soe=1\nslave unsure drive mbox=64 soe=1 repeat=no\n"

static const char * const texts[] = { TEXT("21"), TEXT("22"), TEXT("23"), TEXT("24") };

static void text_desc(const char * const *t, char *desc)
{
	scnprintf(desc, KUNIT_PARAM_DESC_SIZE, "seed %td", t - texts);
}

KUNIT_ARRAY_PARAM(text, texts, text_desc);

enum { SURE, UNSURE };

static const struct ec_mbox_limit limit = { .timeout_ms = 200 };

static struct bus *ready(struct kunit *test)
{
	const char * const *text = test->param_value ?: &texts[0];
	struct bus *b = bus_up(test, *text, 2);

	bus_idle(b);
	return b;
}

static void lose(struct bus *b, u32 frame, bool back, u32 ppm)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = back ? 0 : -1,
		.arg = frame, .arg2 = ppm, .value = back,
	};

	/* of two that go by chance with the same port the later one replaces the other */

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/* what became of many transfers */
struct sum {
	u32 done, unknown, late, wrong, twice;
	int err;	/* the last other error */
	u32 writes;	/* executed, after the last download */
};

/* One download; what the slave has done must fit what the master says. */
static void write(struct bus *b, u32 slave, struct sum *sum, u16 index, u8 sub, const u8 *data,
		  size_t n)
{
	struct ec_app *app = bus_app(b, slave == SURE ? "sure" : "unsure");
	const struct ec_app_entry *e = ec_app_od_entry(app->model, index, sub);
	u32 abort, writes = sum->writes ?: app->mbox.writes;
	int ret = ec_coe_download(bus_mbox(b, slave), index, sub, false, data, n, &abort,
				  &limit);

	/* a late one may still come */
	if (ret)
		msleep(20);
	sum->writes = app->mbox.writes;
	writes = sum->writes - writes;
	sum->twice += writes > 1;
	if (!ret && (writes != 1 || memcmp(app->data + e->off, data, n)))
		sum->wrong++;
	else if (!ret)
		sum->done++;
	else if (ret == -ENOTRECOVERABLE)
		sum->unknown++;
	else
		sum->late++, sum->err = ret;
}

/* One upload: the value there is, or an error. */
static void read(struct bus *b, u32 slave, struct sum *sum, u16 index, u8 sub, size_t n)
{
	struct ec_app *app = bus_app(b, slave == SURE ? "sure" : "unsure");
	const struct ec_app_entry *e = ec_app_od_entry(app->model, index, sub);
	static u8 in[LONG];
	size_t got;
	u32 abort;
	int ret = ec_coe_upload(bus_mbox(b, slave), index, sub, false, in, sizeof(in),
				&got, &abort, &limit);

	if (!ret && (got != n || memcmp(app->data + e->off, in, n)))
		sum->wrong++;
	else if (!ret)
		sum->done++;
	else
		sum->late++, sum->err = ret;
}

/* Half up, half down; one in ten has segments. */
static void transfers(struct bus *b, u32 slave, u32 n, struct sum *down, struct sum *up)
{
	static u8 data[LONG];
	u32 i;

	for (i = 0; i < n / 2; i++) {
		bool has_segments = i % 10 == 9;
		size_t size = has_segments ? LONG : 4;
		u16 index = has_segments ? SCRATCH : TYPES;
		u8 sub = has_segments ? 0 : 8;

		memset(data, i * 7, size);
		put_unaligned_le32(i * 2654435761u, data);
		write(b, slave, down, index, sub, data, size);
		read(b, slave, up, index, sub, size);
	}
}

static void print(const char *what, const struct sum *s)
{
	bus_figure("%s at 1 %% frame loss: %u done, %u outcome unknown, %u other errors (the last: %d), %u wrong, %u executed twice",
		   what, s->done, s->unknown, s->late, s->err, s->wrong, s->twice);
}

static void lossy(struct bus *b, bool on)
{
	lose(b, 0, false, on ? ONE_PERCENT / 2 : 0);
	lose(b, 0, true, on ? ONE_PERCENT / 2 : 0);
}

/* A slave that repeats: each service is done, once. */
static void lossy_repeat(struct kunit *test)
{
	struct bus *b = ready(test);
	struct sum up = { 0 }, down = { 0 };
	u64 lost = bus_lost(b);

	lossy(b, true);
	transfers(b, SURE, TRANSFERS, &down, &up);
	print("downloads, slave repeats", &down);
	print("uploads, slave repeats", &up);
	KUNIT_EXPECT_EQ(test, down.done + up.done, (u32)TRANSFERS);
	KUNIT_EXPECT_EQ(test, down.twice, 0u);
	KUNIT_EXPECT_GT(test, bus_lost(b) - lost, TRANSFERS / 50ull);
}

/* One that does not: an error that says so, nothing is written a second time by itself. */
static void lossy_no_repeat(struct kunit *test)
{
	struct bus *b = ready(test);
	struct sum up = { 0 }, down = { 0 };

	lossy(b, true);
	transfers(b, UNSURE, TRANSFERS, &down, &up);
	print("downloads, slave does not repeat", &down);
	print("uploads, slave does not repeat", &up);
	KUNIT_EXPECT_EQ(test, up.wrong + down.wrong + down.twice, 0u);
	KUNIT_EXPECT_EQ(test, down.late, 0u);
	KUNIT_EXPECT_LE(test, up.late, TRANSFERS / 2000u);
	KUNIT_EXPECT_GT(test, down.unknown, TRANSFERS / 400u);
	KUNIT_EXPECT_GT(test, down.done, TRANSFERS * 9 / 20u);
}

/* Every frame of the exchanges is lost once, on the way out and back. */
static void lossy_each_frame(struct kunit *test)
{
	struct bus *b = ready(test);
	struct sum up = { 0 }, down = { 0 };
	u32 n, back, frames = 0;

	for (back = 0; back < 2; back++) {
		for (n = 1; n <= EACH; n++) {
			u64 lost = bus_lost(b);

			lose(b, n, back, 0);
			transfers(b, SURE, 20, &down, &up);
			frames += bus_lost(b) - lost;
		}
	}
	bus_figure("each of %u frames of 20 transfers lost once: %u downloads and %u uploads done",
		   frames, down.done, up.done);
	KUNIT_EXPECT_EQ(test, frames, 2u * EACH);
	KUNIT_EXPECT_EQ(test, down.done, 2u * EACH * 10);
	KUNIT_EXPECT_EQ(test, up.done, 2u * EACH * 10);
	KUNIT_EXPECT_EQ(test, down.twice, 0u);
}

/* The slave forgets the repeat requests in INIT, its register with the last one does not. */
static void lossy_after_init(struct kunit *test)
{
	struct bus *b = ready(test);
	struct sum up = { 0 }, down = { 0 };
	u32 n;

	for (n = 1; n <= 12; n++) {
		lose(b, n, true, 0);
		transfers(b, SURE, 10, &down, &up);
		bus_request(b, SURE, EC_AL_INIT);
		KUNIT_ASSERT_NE(test, bus_wait_al(b, SURE, EC_AL_INIT, 500), ~0ull);
		bus_request(b, SURE, EC_AL_PREOP);
		KUNIT_ASSERT_NE(test, bus_wait_al(b, SURE, EC_AL_PREOP, 500), ~0ull);
		bus_idle(b);
	}
	KUNIT_EXPECT_TRUE(test, bus_mbox(b, SURE)->box.can_repeat);
	KUNIT_EXPECT_EQ(test, down.done, 12u * 5);
	KUNIT_EXPECT_EQ(test, up.done, 12u * 5);
	KUNIT_EXPECT_EQ(test, down.twice, 0u);
}

/* Its EEPROM promises what it does not do: found out, then treated as the other kind. */
static void lossy_false_promise(struct kunit *test)
{
	struct bus *b = ready(test);
	struct sum up = { 0 }, down = { 0 };

	ec_sim_set_bug(b->sim, EC_SIM_BUG_MBOX_REPEAT);
	lossy(b, true);
	transfers(b, SURE, 2000, &down, &up);
	lossy(b, false);
	KUNIT_EXPECT_FALSE(test, bus_mbox(b, SURE)->box.can_repeat);
	KUNIT_EXPECT_EQ(test, up.wrong + down.wrong + down.twice + down.late, 0u);
	KUNIT_EXPECT_GT(test, down.unknown, 0u);
	KUNIT_EXPECT_GT(test, down.done, 900u);
}

/* SoE has no counter of its own: the same rules. */
static void lossy_soe(struct kunit *test)
{
	struct bus *b = ready(test);
	u32 i, unknown[2] = { 0 }, slave;
	u8 v[2], in[2];
	size_t got;
	u16 error;
	int ret;

	lossy(b, true);
	for (slave = SURE; slave <= UNSURE; slave++) {
		for (i = 0; i < 2000; i++) {
			put_unaligned_le16(i, v);
			ret = ec_soe_write(bus_mbox(b, slave), 0, 0x8096, v, 2, &error,
					   &limit);
			unknown[slave] += ret == -ENOTRECOVERABLE;
			KUNIT_ASSERT_TRUE(test, !ret || ret == -ENOTRECOVERABLE);
			KUNIT_ASSERT_EQ(test,
					ec_soe_read(bus_mbox(b, slave), 0, 0x8096, in, 2,
						    &got, &error, &limit), 0);
			KUNIT_EXPECT_TRUE(test, ret || !memcmp(v, in, 2));
		}
	}
	KUNIT_EXPECT_EQ(test, unknown[SURE], 0u);
	KUNIT_EXPECT_GT(test, unknown[UNSURE], 1u);
}

static struct kunit_case lossy_cases[] = {
	KUNIT_CASE_PARAM(lossy_repeat, text_gen_params),
	KUNIT_CASE_PARAM(lossy_no_repeat, text_gen_params),
	KUNIT_CASE(lossy_each_frame),
	KUNIT_CASE(lossy_after_init),
	KUNIT_CASE(lossy_false_promise),
	KUNIT_CASE(lossy_soe),
	{}
};

static struct kunit_suite lossy_suite = {
	.name = "bus_lossy",
	.exit = bus_exit,
	.test_cases = lossy_cases,
};

kunit_test_suites(&lossy_suite);
