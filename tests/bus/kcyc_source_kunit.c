// SPDX-License-Identifier: GPL-2.0-only
/*
 * What a cycle of the kernel sends from: the application's buffer while all slaves
 * take part, the image otherwise. The application leaves rubbish in the places of
 * inputs; it must never come back as inputs.
 */
#include "kcyc.h"

#define SLAVES	3
#define RUBBISH	0xee

/* what the inputs of a slave did */
struct seen {
	u32 last;
	u32 held;	/* cycles without change */
	u32 wrong;
};

struct source {
	struct kcyc *a;
	u32 number;	/* given last, below 256: a channel has 8 bits */
	struct seen seen[SLAVES];
};

/* Three slaves in one domain, each with its outputs wired to its inputs. */
static struct source *begin_with(struct kunit *test, struct ec_ioc_cycle cfg, u32 options)
{
	struct ec_ioc_domain_options o = { .options = options };
	struct source *s = kunit_kzalloc(test, sizeof(*s), GFP_KERNEL);
	struct bus *b = bus_up(test, "segment seed=32\nrepeat 3 slave s io in=512 out=512\n"
			       "connect s1.1 -> s1.1\nconnect s2.1 -> s2.1\nconnect s3.1 -> s3.1\n",
			       SLAVES);

	KUNIT_ASSERT_NOT_NULL(test, s);
	bus_idle(b);
	s->a = kunit_kzalloc(test, sizeof(*s->a), GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, s->a);
	s->a->c = cyc_new(b, 1000);
	cyc_domain(s->a->c);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OPTIONS, &o), 0);
	cyc_map_all(s->a->c, 0, SLAVES, 0);
	cfg.period_ns = KCYC_PERIOD_NS;
	cfg.cpu = -1;
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(s->a), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ(test, bus_n_dgrams(b), options & EC_DOMAIN_OPT_SEPARATE ? 2u : 1u);
	kcyc_until_op(s->a);
	/* the buffer is sent when all have taken part for a while */
	kcyc_wait_cycles(s->a, 1000);
	return s;
}

/* In one LRW. */
static struct source *begin(struct kunit *test, struct ec_ioc_cycle cfg)
{
	return begin_with(test, cfg, 0);
}

static const u8 *direct(const struct source *s)
{
	return bus_direct(s->a->c->b);
}

static void look(struct source *s, const struct ec_exchange_buffer *in)
{
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		struct seen *e = &s->seen[i];
		u32 now = get_unaligned_le32((u8 *)(in + 1) + kcyc_place(s->a, i, 1, 1));

		e->wrong += now > s->number || now < e->last;
		e->held += now == e->last;
		e->last = now;
	}
}

/* One cycle of the application: numbers that count up, rubbish elsewhere. */
static void step(struct source *s)
{
	u8 *image = kcyc_outputs(s->a);
	u32 i;

	KUNIT_ASSERT_EQ(s->a->c->b->test, kcyc_wait(s->a, 0), 0);
	look(s, kcyc_take(s->a));
	memset(image, RUBBISH, 128 * SLAVES);
	s->number++;
	for (i = 0; i < SLAVES; i++)
		put_unaligned_le32(s->number, image + kcyc_place(s->a, i, 0, 1));
	kcyc_give(s->a);
}

static void steps(struct source *s, u32 n)
{
	memset(s->seen, 0, sizeof(s->seen));
	while (n--)
		step(s);
}

static void frame_fault(struct source *s, enum ec_sim_fault_type type, u32 frame, u64 value)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = type, .port = -1, .arg = frame,
		.arg2 = 1000000, .value = value,
	};

	KUNIT_ASSERT_EQ(s->a->c->b->test, ec_sim_add_fault(s->a->c->b->sim, &f), 0);
}

static void expect_right(struct kunit *test, const struct source *s)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_EQ_MSG(test, s->seen[i].wrong, 0u, "slave %u", i);
}

/* A slave does not take part: its inputs keep their last value, the others go on. */
static void source_slave_silent(struct kunit *test)
{
	struct source *s = begin(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = s->a->c->b;

	steps(s, 20);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	expect_right(test, s);
	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	/* one cycle is held, to find out; and the first of the count */
	step(s);
	steps(s, 5);
	KUNIT_EXPECT_NULL(test, direct(s));
	expect_right(test, s);
	KUNIT_EXPECT_LE(test, s->seen[0].held, 2u);
	KUNIT_EXPECT_LE(test, s->seen[2].held, 2u);
	KUNIT_EXPECT_GE(test, s->seen[1].held, 4u);
	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 0, 0);
	kcyc_wait_cycles(s->a, 3);
	kcyc_until_op(s->a);
	kcyc_wait_cycles(s->a, 1000);
	steps(s, 20);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	expect_right(test, s);
	KUNIT_EXPECT_LE(test, s->seen[1].held, 3u);
}

/*
 * One that takes part now and then costs the others one cycle, not one each time.
 * Only in an overlapped LRW its place may have had outputs of others.
 */
static void source_slave_flaky(struct kunit *test)
{
	u32 options = *(const u32 *)test->param_value, i;
	u32 limit = options == EC_DOMAIN_OPT_OVERLAP ? 30 : options ? 0 : 1;
	struct source *s = begin_with(test, (struct ec_ioc_cycle){ 0 }, options);

	steps(s, 10);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	memset(s->seen, 0, sizeof(s->seen));
	for (i = 0; i < 90; i++) {
		bus_fault(s->a->c->b, EC_SIM_FAULT_DEAD, 1, 0, i % 3 == 0, 0);
		step(s);
	}
	expect_right(test, s);
	KUNIT_EXPECT_LE(test, s->seen[0].held, limit);
	KUNIT_EXPECT_LE(test, s->seen[2].held, limit);
	KUNIT_EXPECT_GE(test, s->seen[1].held, 28u);
}

/* The tool sees the outputs that are sent, also those in the application's buffer. */
static void source_tool_sees(struct kunit *test)
{
	struct source *s = begin_with(test, (struct ec_ioc_cycle){ 0 },
				      *(const u32 *)test->param_value);
	struct bus *b = s->a->c->b;
	u8 *data = kunit_kzalloc(test, 128 * SLAVES, GFP_KERNEL);
	u32 i, place;

	KUNIT_ASSERT_NOT_NULL(test, data);
	steps(s, 20);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	for (i = 0; i < SLAVES; i++) {
		place = kcyc_place(s->a, i, 0, 1);
		memcpy(data, cyc_data(s->a->c, 0) + place, 64);
		mutex_lock(bus_mutex(b));
		ec_cycle_thread_outputs(bus_cycle(b), data, place, 64);
		mutex_unlock(bus_mutex(b));
		/* the last one given waits for its cycle */
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(data), s->number - 1);
	}
}

static const u32 domain_options[] = { 0, EC_DOMAIN_OPT_OVERLAP, EC_DOMAIN_OPT_SEPARATE };

static void options_desc(const u32 *options, char *desc)
{
	strscpy(desc, *options == EC_DOMAIN_OPT_OVERLAP ? "overlap" :
		*options ? "separate" : "plain", KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(options, domain_options, options_desc);

/* where the inputs of an incomplete datagram are taken */
static const u32 apart_options[] = { 0, EC_DOMAIN_OPT_SEPARATE };

KUNIT_ARRAY_PARAM(late_options, apart_options, options_desc);

/* From now and then to always: frames that come with the next cycle, or with none. */
static void source_frames_late(struct kunit *test)
{
	struct source *s = begin(test, (struct ec_ioc_cycle){ 0 });
	u32 i;

	steps(s, 10);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	for (i = 0; i < 20; i++) {
		/* each begins with the buffer */
		if (i % 4 == 0)
			kcyc_wait_cycles(s->a, 1000);
		frame_fault(s, i % 3 ? EC_SIM_FAULT_DELAY : EC_SIM_FAULT_LOSE, 1 + i % 2,
			    (1200 + 700 * (i % 4)) * NSEC_PER_USEC);
		steps(s, 1 + i % 5);
		expect_right(test, s);
	}
	frame_fault(s, EC_SIM_FAULT_DELAY, 0, 1200 * NSEC_PER_USEC);
	steps(s, 50);
	expect_right(test, s);
	KUNIT_EXPECT_GE(test, s->seen[0].last + 5, s->number);
	ec_sim_clear_faults(s->a->c->b->sim);
	kcyc_wait_cycles(s->a, 5);
	KUNIT_EXPECT_EQ(test, kcyc_output(s->a, "s1", 1), (s64)s->number);
}

/* The same with a slave missing: its inputs hold, and do not alternate between two values. */
static void source_slave_silent_while_late(struct kunit *test)
{
	struct source *s = begin_with(test, (struct ec_ioc_cycle){ 0 },
				      *(const u32 *)test->param_value);
	u32 i;

	frame_fault(s, EC_SIM_FAULT_DELAY, 0, 1200 * NSEC_PER_USEC);
	steps(s, 50);
	bus_fault(s->a->c->b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	steps(s, 20);
	steps(s, 50);
	expect_right(test, s);
	/* the first of the count is a change */
	KUNIT_EXPECT_EQ(test, s->seen[1].held, 49u);
	KUNIT_EXPECT_GT(test, s->seen[1].last, 40u);
	for (i = 0; i < SLAVES; i += 2) {
		KUNIT_EXPECT_LE(test, s->seen[i].held, 26u);
		KUNIT_EXPECT_GE(test, s->seen[i].last + 6, s->number);
	}
}

/* What is on its way must not bring back the outputs of before. */
static void source_zero_stays(struct kunit *test)
{
	struct source *s = begin(test, (struct ec_ioc_cycle){
		.stall = EC_STALL_ZERO, .stall_cycles = 3 });
	u32 i;

	steps(s, 10);
	kcyc_wait_cycles(s->a, 1);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	frame_fault(s, EC_SIM_FAULT_DELAY, 0, 2200 * NSEC_PER_USEC);
	kcyc_wait_cycles(s->a, 4);
	KUNIT_EXPECT_EQ(test, kcyc_status(s->a)->state, EC_CYCLE_STATE_STALLED);
	KUNIT_EXPECT_NULL(test, direct(s));
	kcyc_wait_cycles(s->a, 3);
	for (i = 0; i < 10; i++) {
		KUNIT_EXPECT_EQ(test, kcyc_output(s->a, "s1", 1), 0ll);
		KUNIT_EXPECT_EQ(test, kcyc_output(s->a, "s3", 1), 0ll);
		kcyc_wait_cycles(s->a, 1);
	}
}

/* Stalled and holding, or without an application: still sent from the buffer. */
static void source_held(struct kunit *test)
{
	struct source *s = begin(test, (struct ec_ioc_cycle){
		.flags = EC_CYCLE_FLAG_DETACH, .stall_cycles = 3 });
	struct bus *b = s->a->c->b;

	steps(s, 10);
	bus_end(b);
	msleep(20);
	KUNIT_EXPECT_EQ(test, kcyc_output(s->a, "s2", 1), (s64)s->number);
	bus_fault(b, EC_SIM_FAULT_DEAD, 0, 0, 1, 0);
	msleep(5);
	bus_fault(b, EC_SIM_FAULT_DEAD, 0, 0, 0, 0);
	msleep(5);
	KUNIT_EXPECT_EQ(test, kcyc_output(s->a, "s2", 1), (s64)s->number);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(source_slave_silent),
	KUNIT_CASE_PARAM(source_slave_flaky, options_gen_params),
	KUNIT_CASE_PARAM(source_tool_sees, options_gen_params),
	KUNIT_CASE(source_frames_late),
	KUNIT_CASE_PARAM(source_slave_silent_while_late, late_options_gen_params),
	KUNIT_CASE(source_zero_stays),
	KUNIT_CASE(source_held),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_source", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
