// SPDX-License-Identifier: GPL-2.0-only
/* Records of process data: what they contain, and that nothing is kept without a reader. */
#include "units.h"
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
	return rcu_access_pointer(bus_cycles(b)->recorder);
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

/* Cycles with a number more in each. */
static void count_up(struct kcyc *a, u32 *number, u32 cycles)
{
	while (cycles--) {
		KUNIT_ASSERT_EQ(a->c->b->test, kcyc_wait(a, 0), 0);
		kcyc_write(a, ++*number);
		kcyc_give(a);
	}
}

/* A number is sent in a cycle, and received in the next one. */
static void expect_pairs(struct kcyc *a, u32 steady)
{
	struct kunit *test = a->c->b->test;
	u32 out = kcyc_place(a, 0, 0, 1), in = kcyc_place(a, 0, 1, 1), number = 1000, n = 0;
	struct rec *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	u32 first = min(out, in), size = max(out, in) + 4 - first;
	u32 sent = 0, received = 0, wrong = 0;
	struct ec_ioc_recorder arg;
	struct ec_file *f;
	u64 time_ns = 0;

	KUNIT_ASSERT_NOT_NULL(test, r);
	count_up(a, &number, steady);
	f = reader_new(a->c->b, first, size, &arg);
	count_up(a, &number, 100);
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
			KUNIT_EXPECT_EQ(test, now_in, received + 1);
			/* time passes only when it is read */
			wrong += r->head.time_ns - time_ns - KCYC_PERIOD_NS + 10000 > 20000;
		}
		sent = now_out;
		received = now_in;
		time_ns = r->head.time_ns;
	}
	KUNIT_EXPECT_GE(test, n, 98u);
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_LT(test, received, sent);
	KUNIT_EXPECT_GE(test, received, sent - 3);
	ec_reader_end(f);
}

static void recorder_outputs_of_image_before_inputs(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });

	expect_pairs(a, 10);
	KUNIT_EXPECT_NULL(test, bus_cycles(a->c->b)->active->direct);
}

/* The buffer of the application is sent then. */
static void recorder_outputs_of_buffer_before_inputs(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });

	expect_pairs(a, 1100);
	KUNIT_EXPECT_NOT_NULL(test, bus_cycles(a->c->b)->active->direct);
}

static u32 rest_of(struct kunit *test, struct ec_file *f)
{
	struct rec *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	u32 n = 0;

	KUNIT_ASSERT_NOT_NULL(test, r);
	while (next_rec(f, 0, 4, r))
		n++;
	return n;
}

static u64 kept_of(struct ec_file *f)
{
	return f->reader->kind->kept;
}

/* A reader that has nothing left gets this at the end of the session. */
static bool has_ended(struct ec_file *f)
{
	u64 at = f->reader->at;

	return f->reader->kind->head(f->reader) == ~0ull &&
	       f->reader->kind->copy(f->reader, &at, NULL) == -ENODATA;
}

static void deactivate(struct bus *b)
{
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
}

/* The ring is full: the oldest records are lost, and each reader gets their exact number. */
static void recorder_slow_reader_gets_exact_number(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct rec *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	struct ec_ioc_recorder slow, quick;
	struct ec_file *f, *g;
	u32 n, got = 0;

	KUNIT_ASSERT_NOT_NULL(test, r);
	f = reader_new(a->c->b, 0, 4, &slow);
	/* both within the memory of one ring */
	KUNIT_EXPECT_GT(test, slow.kept, 2000u);
	KUNIT_EXPECT_LE(test, slow.kept * (6400u + sizeof(struct ec_status_domain)),
			(size_t)EC_RECORD_RING);
	kcyc_wait_cycles(a, slow.kept - 10);
	g = reader_new(a->c->b, 0, 4, &quick);
	KUNIT_EXPECT_EQ(test, quick.kept, slow.kept);
	for (n = 0; n < 100; n++) {
		kcyc_wait_cycles(a, 1);
		got += rest_of(test, g);
	}
	KUNIT_EXPECT_EQ(test, got, (u32)(g->reader->at - quick.next));
	KUNIT_ASSERT_TRUE(test, next_rec(f, 0, 4, r));
	KUNIT_EXPECT_EQ(test, r->head.missed, g->reader->at - slow.next - kept_of(f));
	KUNIT_EXPECT_EQ(test, r->head.number, slow.next + r->head.missed);
	KUNIT_EXPECT_GE(test, r->head.missed, 80ull);
	KUNIT_ASSERT_TRUE(test, next_rec(f, 0, 4, r));
	KUNIT_EXPECT_EQ(test, r->head.missed, 0ull);
	KUNIT_EXPECT_EQ(test, rest_of(test, f), (u32)kept_of(f) - 2);
	ec_reader_end(f);
	KUNIT_EXPECT_NOT_NULL(test, ring_of(a->c->b));
	ec_reader_end(g);
	KUNIT_EXPECT_NULL(test, ring_of(a->c->b));
}

/* What was recorded before the end is still read; the next session has a ring of its own. */
static void recorder_session_ends_while_reading(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_ioc_recorder arg, next;
	struct bus *b = a->c->b;
	struct ec_file *f, *g;

	f = reader_new(b, 0, 4, &arg);
	kcyc_wait_cycles(a, 20);
	KUNIT_EXPECT_NE(test, f->reader->kind->head(f->reader), ~0ull);
	deactivate(b);
	KUNIT_EXPECT_NULL(test, ring_of(b));
	KUNIT_EXPECT_GE(test, rest_of(test, f), 20u);
	KUNIT_EXPECT_TRUE(test, has_ended(f));
	g = file_new(b, false);
	KUNIT_EXPECT_EQ(test, want(g, 0, 4, &next), -ENOENT);
	KUNIT_EXPECT_NULL(test, g->reader);
	cyc_release(a->c);

	bus_idle(b);
	a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_until_op(a);
	KUNIT_ASSERT_EQ(test, want(g, 0, 4, &next), 0);
	/* numbers are not reused */
	KUNIT_EXPECT_GE(test, next.next, f->reader->at);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_GE(test, rest_of(test, g), 5u);
	KUNIT_EXPECT_EQ(test, rest_of(test, f), 0u);
	KUNIT_EXPECT_TRUE(test, has_ended(f));
	ec_reader_end(f);
	KUNIT_EXPECT_NOT_NULL(test, ring_of(b));
	/* the process is killed in the middle */
	kcyc_wait_cycles(a, 5);
	ec_reader_end(g);
	KUNIT_EXPECT_NULL(test, ring_of(b));
	kcyc_wait_cycles(a, 5);
}

/* Files that are opened for reading only have half of the places. */
static void recorder_readers_are_limited(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_file *f[EC_RECORDERS], *more;
	struct ec_ioc_recorder arg;
	struct bus *b = a->c->b;
	u32 i;

	for (i = 0; i < EC_RECORDERS_READ_ONLY; i++)
		f[i] = reader_new(b, 0, 4, &arg);
	more = file_new(b, false);
	KUNIT_EXPECT_EQ(test, want(more, 0, 4, &arg), -EUSERS);
	for (; i < EC_RECORDERS; i++) {
		f[i] = file_new(b, true);
		KUNIT_ASSERT_EQ(test, want(f[i], 0, 4, &arg), 0);
	}
	more = file_new(b, true);
	KUNIT_EXPECT_EQ(test, want(more, 0, 4, &arg), -EUSERS);
	/* one ring for all */
	KUNIT_EXPECT_EQ(test, bus_record_readers(b)->rings, 1u);
	ec_reader_end(f[0]);
	KUNIT_EXPECT_EQ(test, want(more, 0, 4, &arg), 0);
	ec_reader_end(more);
	for (i = 1; i < EC_RECORDERS; i++)
		ec_reader_end(f[i]);
	KUNIT_EXPECT_NULL(test, ring_of(b));
	KUNIT_EXPECT_EQ(test, bus_record_readers(b)->read_only, 0u);
	KUNIT_EXPECT_EQ(test, bus_record_readers(b)->rings, 0u);
}

/* Readers of sessions that have ended keep no more than RINGS_MAX rings: the oldest one goes. */
static void recorder_rings_of_ended_sessions_are_limited(struct kunit *test)
{
	struct bus *b = kcyc_bus(test);
	struct ec_ioc_recorder arg;
	struct ec_file *f[5];
	u64 at = 0;
	u32 i;

	for (i = 0; i < 5; i++) {
		struct kcyc *a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });

		KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
		f[i] = file_new(b, true);
		KUNIT_EXPECT_EQ(test, want(f[i], 0, 4, &arg), 0);
		KUNIT_EXPECT_EQ(test, bus_record_readers(b)->rings, min(i + 1, 3u));
		kcyc_wait_cycles(a, 5);
		cyc_release(a->c);
		bus_idle(b);
		/* the second one has read all */
		if (i == 1)
			KUNIT_EXPECT_GE(test, rest_of(test, f[i]), 5u);
	}
	KUNIT_EXPECT_EQ(test, f[0]->reader->kind->head(f[0]->reader), ~0ull);
	KUNIT_EXPECT_EQ(test, f[0]->reader->kind->copy(f[0]->reader, &at, NULL), -ENOBUFS);
	KUNIT_EXPECT_TRUE(test, has_ended(f[1]));
	KUNIT_EXPECT_GE(test, rest_of(test, f[2]), 5u);
	KUNIT_EXPECT_GE(test, rest_of(test, f[4]), 5u);
	for (i = 0; i < 5; i++)
		ec_reader_end(f[i]);
	KUNIT_EXPECT_EQ(test, bus_record_readers(b)->rings, 0u);
}

static void recorder_wrong_arguments_are_refused(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_ioc_events events = { .size = sizeof(struct ec_event) };
	struct ec_ioc_recorder arg, flag = { .flags = 1 };
	struct bus *b = a->c->b;
	struct ec_file *f = file_new(b, false), *g;

	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_RECORDER, &flag), -EOPNOTSUPP);
	/* the image has 3200 bytes */
	KUNIT_EXPECT_EQ(test, want(f, 3199, 2, &arg), -ERANGE);
	KUNIT_EXPECT_NULL(test, ring_of(b));
	KUNIT_EXPECT_EQ(test, want(f, 3199, 1, &arg), 0);
	KUNIT_EXPECT_EQ(test, arg.record_size, (u32)ALIGN(sizeof(struct ec_record) + 2, 8));
	KUNIT_EXPECT_EQ(test, want(f, 0, 4, &arg), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &events), -EBUSY);
	g = file_new(b, false);
	KUNIT_EXPECT_EQ(test, ec_ioc(g, EC_IOC_EVENTS, &events), 0);
	KUNIT_EXPECT_EQ(test, want(g, 0, 4, &arg), -EBUSY);
	ec_reader_end(g);
	KUNIT_EXPECT_NOT_NULL(test, ring_of(b));
	ec_reader_end(f);
	KUNIT_EXPECT_NULL(test, ring_of(b));
}

/* The outputs of the application while they are sent, and zeros while these replace them. */
static void recorder_outputs_of_units_as_sent(struct kunit *test)
{
	struct bus *b = units_bus(test, 2);
	struct cyc *c = cyc_new(b, 1000);
	struct rec *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	u32 unit = units_new(b, "one", EC_UNIT_POLICY_ZERO, 0), out, zeros = 0, values = 0, i;
	struct ec_ioc_recorder arg;
	struct ec_file *f;

	KUNIT_ASSERT_NOT_NULL(test, r);
	cyc_domain(c);
	units_put(b, 0, unit);
	cyc_map_all(c, 0, 2, 0);
	cyc_activate(c);
	cyc_wait_op(c, 5000);
	out = cyc_pd(c, 0, 0) - cyc_data(c, 0);
	put_unaligned_le32(0x12345678, cyc_data(c, 0) + out);
	cyc_run(c, 20);
	f = reader_new(b, out, 4, &arg);
	cyc_run(c, 10);
	while (next_rec(f, out, 4, r)) {
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(r->data + 4), 0x12345678u);
		KUNIT_EXPECT_EQ(test, r->head.complete, 1ull);
		values++;
	}
	KUNIT_EXPECT_GE(test, values, 10u);
	units_dead(b, 1, true);
	cyc_run(c, 50);
	for (i = 0; next_rec(f, out, 4, r); i++)
		if (i >= 25) {
			zeros += !get_unaligned_le32(r->data + 4);
			KUNIT_EXPECT_EQ(test, r->head.complete, 0ull);
		}
	KUNIT_EXPECT_GE(test, zeros, 25u);
	/* the application has not changed them */
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_data(c, 0) + out), 0x12345678u);
	ec_reader_end(f);
	cyc_release(c);
}

static struct kunit_case recorder_cases[] = {
	KUNIT_CASE(recorder_without_reader_is_absent),
	KUNIT_CASE(recorder_outputs_of_image_before_inputs),
	KUNIT_CASE(recorder_outputs_of_buffer_before_inputs),
	KUNIT_CASE(recorder_slow_reader_gets_exact_number),
	KUNIT_CASE(recorder_session_ends_while_reading),
	KUNIT_CASE(recorder_readers_are_limited),
	KUNIT_CASE(recorder_rings_of_ended_sessions_are_limited),
	KUNIT_CASE(recorder_wrong_arguments_are_refused),
	KUNIT_CASE(recorder_outputs_of_units_as_sent),
	{}
};

static struct kunit_suite recorder_suite = {
	.name = "bus_recorder",
	.exit = bus_exit,
	.test_cases = recorder_cases,
};

kunit_test_suites(&recorder_suite);
