// SPDX-License-Identifier: GPL-2.0-only
/* Domains that are not sent in each cycle; copies from slave to slave. */
#include "kcyc.h"

#define CHANNELS	64	/* of one bit, each way */

/* Four slaves; the first 32 outputs of three are inputs, @next or their own. */
static struct bus *plant_wired(struct kunit *test, bool next)
{
	static char text[4096];
	u32 slave, chan, n = scnprintf(text, sizeof(text), "segment seed=33\n"
				       "repeat 4 slave s io in=64 out=64\n");
	struct bus *b;

	for (slave = 1; slave <= 3; slave++)
		for (chan = 1; chan <= 32; chan++)
			n += scnprintf(text + n, sizeof(text) - n, "connect s%u.%u -> s%u.%u\n",
				       slave, chan, next ? slave % 3 + 1 : slave, chan);
	b = bus_up(test, text, 4);
	bus_idle(b);
	return b;
}

static struct bus *plant(struct kunit *test)
{
	return plant_wired(test, false);
}

/* All outputs of a slave. */
static u64 plant_out(struct kcyc *a, const char *slave)
{
	struct ec_app *p = bus_app(a->c->b, slave);
	u64 v = 0;
	u32 i;

	for (i = 0; i < CHANNELS; i++)
		v |= (u64)ec_app_channel(p, EC_APP_OUT, i) << i;
	return v;
}

/* An application with @n domains, slave i in domain i % n. */
static struct kcyc *app(struct bus *b, u32 n)
{
	struct kcyc *a = kunit_kzalloc(b->test, sizeof(*a), GFP_KERNEL);
	struct ec_ioc_cycle cfg = { .period_ns = KCYC_PERIOD_NS, .cpu = -1 };
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, a);
	a->c = cyc_new(b, 1000);
	for (i = 0; i < n; i++)
		cyc_domain(a->c);
	for (i = 0; i < 4; i++)
		cyc_map_all(a->c, i, 1, i % n);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	return a;
}

static int divide(struct kcyc *a, u32 domain, u32 division, u32 phase)
{
	struct ec_ioc_division d = { .domain = domain, .division = division, .phase = phase };

	return ec_ioc(&a->c->b->app, EC_IOC_DIVISION, &d);
}

static void begin(struct kcyc *a)
{
	KUNIT_ASSERT_EQ_MSG(a->c->b->test, kcyc_activate(a), 0, "%s", a->c->b->app.reason);
	kcyc_until_op(a);
}

static u8 *out(struct kcyc *a, u32 slave)
{
	return kcyc_outputs(a) + (cyc_pd(a->c, slave, 0) - cyc_data(a->c, 0));
}

/*
 * A counter goes to two slaves, to the second one in every fifth cycle only: it
 * sees every fifth number, and each for five cycles.
 */
static void division_exchanges_every_nth_cycle(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	u32 i, changes = 0, wrong = 0, state = 0, frames;
	u64 number, last = 0;

	KUNIT_ASSERT_EQ(test, divide(a, 1, 5, 2), 0);
	begin(a);
	kcyc_wait_cycles(a, 20);
	frames = bus_frames(b);
	for (i = 0; i < 500; i++) {
		struct ec_exchange_buffer *x;

		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		x = kcyc_take(a);
		KUNIT_ASSERT_NOT_NULL(test, x);
		state += x->domains[0].wc_state != 2 || x->domains[1].wc_state != 2;
		put_unaligned_le32(1000 + i, out(a, 0));
		put_unaligned_le32(1000 + i, out(a, 1));
		kcyc_give(a);
		number = (u32)plant_out(a, "s2");
		changes += number != last;
		/* a multiple of five apart */
		wrong += i > 20 && number != last && number - last != 5;
		wrong += i > 20 && (u32)plant_out(a, "s1") != 1000 + i - 1;
		last = number;
	}
	KUNIT_EXPECT_EQ(test, state, 0u);
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_GE(test, changes, 99u);
	KUNIT_EXPECT_LE(test, changes, 102u);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	bus_figure("500 cycles, one domain in 5: %llu frames", bus_frames(b) - frames);
}

/* A slave of the slow domain goes: its state is judged with its exchanges only. */
static void division_judged(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	u32 i, zero = 0, incomplete = 0, fast = 0;

	KUNIT_ASSERT_EQ(test, divide(a, 1, 10, 0), 0);
	begin(a);
	kcyc_wait_cycles(a, 30);
	bus_request(b, 3, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 3, EC_AL_INIT, 2000), ~0ull);
	a->seen = kcyc_status(a)->cycle;
	kcyc_wait_cycles(a, 11);
	for (i = 0; i < 50; i++) {
		struct ec_exchange_buffer *x;

		kcyc_wait_cycles(a, 1);
		x = kcyc_take(a);
		KUNIT_ASSERT_NOT_NULL(test, x);
		zero += !x->domains[1].working_counter;
		incomplete += x->domains[1].wc_state == 1;
		fast += x->domains[0].wc_state == 2;
	}
	KUNIT_EXPECT_EQ(test, zero, 0u);
	KUNIT_EXPECT_EQ(test, incomplete, 50u);
	KUNIT_EXPECT_EQ(test, fast, 50u);
}

/* Each domain in its own cycle: three domains, never two in one. */
static void division_phases(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 3);
	u32 i, k, together = 0, turns[3] = { 0 };
	u32 sends[3];

	for (i = 0; i < 3; i++)
		KUNIT_ASSERT_EQ(test, divide(a, i, 3, i), 0);
	begin(a);
	kcyc_wait_cycles(a, 10);
	for (i = 0; i < 3; i++)
		sends[i] = bus_domain_send(b, i);
	for (i = 0; i < 300; i++) {
		u32 now = 0;

		kcyc_wait_cycles(a, 1);
		for (k = 0; k < 3; k++) {
			u32 send = bus_domain_send(b, k);

			now += send != sends[k];
			turns[k] += send != sends[k];
			sends[k] = send;
		}
		together += now != 1;
	}
	KUNIT_EXPECT_EQ(test, together, 0u);
	for (k = 0; k < 3; k++)
		KUNIT_EXPECT_EQ(test, turns[k], 100u);
	/* three cycles are left out: whose turn it was goes next, then as before */
	udelay(4500);
	kcyc_wait_cycles(a, 20);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 3ull);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
}

static void division_refused(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	struct ec_ioc_cycle none = { .cpu = -1 };

	KUNIT_EXPECT_EQ(test, divide(a, 0, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, divide(a, 0, 4, 4), -EINVAL);
	KUNIT_EXPECT_EQ(test, divide(a, 0, 1001, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, divide(a, 2, 2, 0), -ENOENT);
	KUNIT_EXPECT_EQ(test, divide(a, 1, 2, 0), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &none), 0);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), -EOPNOTSUPP);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "ecrt_master_set_cycle"));
	KUNIT_EXPECT_EQ(test, divide(a, 1, 1, 0), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &(struct ec_ioc_cycle){
		.period_ns = KCYC_PERIOD_NS, .cpu = -1 }), 0);
	begin(a);
	KUNIT_EXPECT_EQ(test, divide(a, 1, 2, 0), -EBUSY);
	cyc_release(a->c);
	KUNIT_EXPECT_EQ(test, divide(a, 1, 2, 0), -EPERM);
}

/* copies -------------------------------------------------------------------*/

/* @bits from bit @from of the inputs of a slave to bit @to of another's outputs. */
static int copy(struct kcyc *a, u32 from_slave, u32 from, u32 to_slave, u32 to, u32 bits)
{
	const struct ec_config *f = bus_config(a->c->b, from_slave);
	const struct ec_config *t = bus_config(a->c->b, to_slave);
	struct ec_ioc_copy c = {
		.from_domain = f->fmmus[1].domain->index, .from_bit = 8 * f->fmmus[1].offset + from,
		.to_domain = t->fmmus[0].domain->index, .to_bit = 8 * t->fmmus[0].offset + to,
		.bits = bits,
	};

	return ec_ioc(&a->c->b->app, EC_IOC_COPY, &c);
}

/* What s1 is told comes back as its input, and goes to s4 without us. */
static void copies_reach_outputs_in_same_cycle(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	u32 i, last = 0, late = 0;

	KUNIT_ASSERT_EQ(test, copy(a, 0, 0, 3, 0, 32), 0);	/* other domain, bytes */
	KUNIT_ASSERT_EQ(test, copy(a, 0, 3, 3, 37, 13), 0);	/* bits */
	KUNIT_ASSERT_EQ(test, copy(a, 0, 31, 3, 50, 1), 0);
	begin(a);
	for (i = 0; i < 100; i++) {
		u32 v = 0x9e3779b9u * (i + 1);

		put_unaligned_le32(v, out(a, 0));
		memset(out(a, 3), 0xff, 8);	/* bits of nobody's copy stay */
		kcyc_give(a);
		kcyc_wait_cycles(a, 1);
		/* the cycle that has received it sends it */
		late += i > 3 && (u32)plant_out(a, "s4") != 0x9e3779b9u * (i - 1);
		last = v;
	}
	KUNIT_EXPECT_EQ(test, late, 0u);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, plant_out(a, "s4"),
			last | ((u64)(last >> 3 & 0x1fff) << 37) | (u64)(last >> 31) << 50 |
			0x1full << 32 | ~0ull << 51);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* A source that is not complete: the last value stays. */
static void copies_hold(struct kunit *test)
{
	struct bus *b = plant_wired(test, true);
	struct kcyc *a = app(b, 4);
	u32 i;

	/* input of s2, which is output of s1 */
	KUNIT_ASSERT_EQ(test, copy(a, 1, 0, 3, 0, 32), 0);
	begin(a);
	put_unaligned_le32(77, out(a, 0));
	kcyc_give(a);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 77u);
	bus_request(b, 1, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 1, EC_AL_INIT, 2000), ~0ull);
	for (i = 0; i < 50; i++) {
		put_unaligned_le32(100 + i, out(a, 0));
		memset(out(a, 3), i, 8);
		kcyc_give(a);
		kcyc_wait_cycles(a, 1);
		KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 77u);
	}
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s1"), 149u);
	bus_request(b, 1, EC_AL_OP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 1, EC_AL_OP, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 149u);
}

/* The application has died: the copies go on, whatever the policy does. */
static void copies_detached(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 1);
	struct ec_ioc_cycle cfg = {
		.period_ns = KCYC_PERIOD_NS, .cpu = -1, .flags = EC_CYCLE_FLAG_DETACH,
		.stall = EC_STALL_ZERO, .stall_cycles = 200,
	};

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	/* s4 has no wire of its own: what it gets from s3 shows that copies run */
	KUNIT_ASSERT_EQ(test, copy(a, 2, 0, 3, 0, 32), 0);
	begin(a);
	put_unaligned_le32(5, out(a, 2));
	put_unaligned_le32(6, out(a, 1));
	kcyc_give(a);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 5u);
	bus_end(b);
	msleep(10);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s2"), 6u);
	msleep(300);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s2"), 0u);
	/* zeroed as an output of s3, so its input is zero, so is the copy */
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 0u);
	/* the next one must want the same copies */
	a = app(b, 1);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), -EEXIST);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "it has 1 copies, not 0"));
}

/* The cycle of an application does them, too. */
static void copies_of_application(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	struct ec_ioc_cycle none = { .cpu = -1 };

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &none), 0);
	KUNIT_ASSERT_EQ(test, copy(a, 0, 0, 3, 0, 32), 0);
	cyc_activate(a->c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(a->c, 5000), ~0ull);
	put_unaligned_le32(99, cyc_pd(a->c, 0, 0));
	cyc_run(a->c, 3);
	KUNIT_EXPECT_EQ(test, (u32)plant_out(a, "s4"), 99u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(a->c, 3, 0)), 99u);
}

static void copies_refused(struct kunit *test)
{
	struct bus *b = plant(test);
	struct kcyc *a = app(b, 2);
	struct ec_ioc_copy c = { .from_domain = 2, .bits = 1 };
	u32 i;

	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 0, 65), -EINVAL);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 60, 3, 0, 5), -EINVAL);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 60, 5), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "not outputs of one slave"));
	KUNIT_EXPECT_EQ(test, copy(a, 0, ~0u, 3, 0, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 0, ~0u), -EINVAL);
	/* outputs are no source, inputs no target */
	KUNIT_EXPECT_EQ(test, copy(a, 0, -64u, 3, 0, 8), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "not inputs of one slave"));
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 64, 8), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_COPY, &c), -ENOENT);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 3, 8, 16), 0);
	KUNIT_EXPECT_EQ(test, copy(a, 1, 0, 3, 23, 1), -EEXIST);
	KUNIT_EXPECT_EQ(test, copy(a, 1, 0, 3, 0, 9), -EEXIST);
	KUNIT_EXPECT_EQ(test, copy(a, 1, 0, 3, 24, 1), 0);
	KUNIT_EXPECT_EQ(test, copy(a, 1, 0, 3, 7, 1), 0);
	for (i = 0; i < 7; i++)
		KUNIT_EXPECT_EQ(test, copy(a, 1, i, 3, i, 1), 0);
	begin(a);
	KUNIT_EXPECT_EQ(test, copy(a, 0, 0, 2, 0, 1), -EBUSY);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(division_exchanges_every_nth_cycle),
	KUNIT_CASE(division_judged),
	KUNIT_CASE(division_phases),
	KUNIT_CASE(division_refused),
	KUNIT_CASE(copies_reach_outputs_in_same_cycle),
	KUNIT_CASE(copies_hold),
	KUNIT_CASE(copies_detached),
	KUNIT_CASE(copies_of_application),
	KUNIT_CASE(copies_refused),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_domains", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
