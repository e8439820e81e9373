// SPDX-License-Identifier: GPL-2.0-only
/* Records of process data: what they contain, and that nothing is kept without a reader. */
#include "kcyc.h"
#include "master/cycle/recorder.h"

#define RECORD_MAX	2048

/**
 * struct rec - a record as a case reads it
 * @head: as read() returns it
 * @data: wanted bytes
 */
struct rec {
	struct ec_record head;
	u8 data[RECORD_MAX];
};

static struct ec_recorder *ring_of(struct bus *b)
{
	return rcu_access_pointer(b->m->cycles.recorder);
}

static struct ec_file *file_new(struct bus *b, bool writable)
{
	struct ec_file *f = kunit_kzalloc(b->test, sizeof(*f), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, f);
	ec_file_init(f, b->m, writable);
	return f;
}

/* A reader of @size bytes from @at on: as received, and as sent. Return: as the command. */
static int want(struct ec_file *f, u32 at, u32 size, struct ec_ioc_recorder *arg)
{
	static u8 mask[2][512];
	u32 i;

	memset(mask, 0, sizeof(mask));

	for (i = at; i < at + size; i++) {
		mask[0][i / 8] |= 1 << i % 8;
		mask[1][i / 8] |= 1 << i % 8;
	}
	*arg = (struct ec_ioc_recorder){ .data = (uintptr_t)mask, .size = sizeof(mask) };
	return ec_ioc(f, EC_IOC_RECORDER, arg);
}

static struct ec_file *reader_new(struct bus *b, u32 at, u32 size, struct ec_ioc_recorder *arg)
{
	struct ec_file *f = file_new(b, false);

	KUNIT_ASSERT_EQ_MSG(b->test, want(f, at, size, arg), 0, "%s", f->reason);
	KUNIT_ASSERT_NOT_NULL(b->test, f->reader);
	KUNIT_ASSERT_LE(b->test, (size_t)arg->record_size, sizeof(struct rec));
	return f;
}

/* the bytes @at of the image, in runs of both images */
static bool next_rec(struct ec_file *f, u32 at, u32 size, struct rec *r)
{
	const struct ec_recorder_run runs[] = {
		{ .offset = at, .len = size }, { .offset = at, .len = size, .output = 1 },
	};
	u64 number = f->reader->at;
	bool got = ec_recorder_get(f->reader->source, &number, runs, 2, &r->head);

	f->reader->at = number;
	return got;
}

static void recorder_without_reader_is_absent(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_ioc_recorder arg;
	struct ec_file *f;

	kcyc_wait_cycles(a, 10);
	KUNIT_EXPECT_NULL(test, ring_of(a->c->b));
	f = reader_new(a->c->b, 0, 4, &arg);
	KUNIT_EXPECT_NOT_NULL(test, ring_of(a->c->b));
	ec_reader_end(f);
	KUNIT_EXPECT_NULL(test, ring_of(a->c->b));
	kcyc_wait_cycles(a, 10);
}

/* Inputs are those of two cycles before: given in cycle n, they are sent in n and received in n + 1. */
static void expect_pairs(struct kcyc *a, u32 steady)
{
	struct kunit *test = a->c->b->test;
	u32 out = kcyc_place(a, 0, 0, 1), in = kcyc_place(a, 0, 1, 1), i, n = 0;
	struct rec *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	u32 first = min(out, in), size = max(out, in) + 4 - first;
	u32 sent = 0, received = 0, wrong = 0;
	struct ec_ioc_recorder arg;
	struct ec_file *f;
	u64 time_ns = 0;

	KUNIT_ASSERT_NOT_NULL(test, r);
	for (i = 0; i < steady; i++) {
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		kcyc_write(a, 1000 + i);
		kcyc_give(a);
	}
	f = reader_new(a->c->b, first, size, &arg);
	for (i = 0; i < 100; i++) {
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		kcyc_write(a, 5000 + i);
		kcyc_give(a);
	}
	while (next_rec(f, first, size, r)) {
		u32 now_in = get_unaligned_le32(r->data + in - first);
		u32 now_out = get_unaligned_le32(r->data + size + out - first);

		KUNIT_EXPECT_EQ(test, r->head.number, arg.next + n);
		KUNIT_EXPECT_EQ(test, r->head.missed, 0ull);
		KUNIT_EXPECT_EQ(test, r->head.complete, 1ull);
		KUNIT_EXPECT_EQ(test, r->head.zero, 0ull);
		KUNIT_EXPECT_EQ(test, r->head.sent, 1ull);
		if (n++) {
			KUNIT_EXPECT_EQ(test, now_out, sent + 1);
			/* time passes only when it is read */
			KUNIT_EXPECT_LT(test, r->head.time_ns - time_ns - KCYC_PERIOD_NS + 10000,
					20000ull);
			wrong += now_in < received || now_in >= now_out;
		}
		sent = now_out;
		received = now_in;
		time_ns = r->head.time_ns;
	}
	KUNIT_EXPECT_GE(test, n, 98u);
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_GE(test, received, sent - 4);
	ec_reader_end(f);
}

static void recorder_pairs_of_the_image(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });

	expect_pairs(a, 1);
	KUNIT_EXPECT_NULL(test, a->c->b->m->cycles.active->direct);
}

/* The buffer of the application is sent then. */
static void recorder_pairs_of_the_buffer(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });

	expect_pairs(a, 1100);
	KUNIT_EXPECT_NOT_NULL(test, a->c->b->m->cycles.active->direct);
}

static struct kunit_case recorder_cases[] = {
	KUNIT_CASE(recorder_without_reader_is_absent),
	KUNIT_CASE(recorder_pairs_of_the_image),
	KUNIT_CASE(recorder_pairs_of_the_buffer),
	{}
};

static struct kunit_suite recorder_suite = {
	.name = "bus_recorder",
	.exit = bus_exit,
	.test_cases = recorder_cases,
};

kunit_test_suites(&recorder_suite);
