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
	u32 number;	/* given last */
	struct seen seen[SLAVES];
};

/* Three slaves in one LRW, each with its outputs wired to its inputs. */
static struct source *begin(struct kunit *test, struct ec_ioc_cycle cfg)
{
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
	cyc_map_all(s->a->c, 0, SLAVES, 0);
	cfg.period_ns = KCYC_PERIOD_NS;
	cfg.cpu = -1;
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc_cycle(&b->app, &cfg), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(s->a), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ(test, b->m->session->cycle.n_dgrams, 1u);
	kcyc_until_op(s->a);
	return s;
}

static const u8 *direct(const struct source *s)
{
	return s->a->c->b->m->session->cycle.direct;
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
	steps(s, 20);
	KUNIT_EXPECT_NOT_NULL(test, direct(s));
	expect_right(test, s);
	KUNIT_EXPECT_LE(test, s->seen[1].held, 3u);
}

/* From now and then to always: frames that come with the next cycle, or with none. */
static void source_frames_late(struct kunit *test)
{
	struct source *s = begin(test, (struct ec_ioc_cycle){ 0 });
	u32 i;

	steps(s, 10);
	for (i = 0; i < 20; i++) {
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
	ec_session_end(b->m, &b->app);
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
	KUNIT_CASE(source_frames_late),
	KUNIT_CASE(source_zero_stays),
	KUNIT_CASE(source_held),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_source", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
