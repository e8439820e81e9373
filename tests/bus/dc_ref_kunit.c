// SPDX-License-Identifier: GPL-2.0-only
/*
 * The reference clock goes and comes while other clocks stay: they stay together,
 * nobody's time jumps, SYNC0 goes on. By the true time of the modelled clocks, in
 * the application's cycle, in one that leads the clocks, and in the kernel's.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/cycle/cycle_thread.h"
#include "master/clock/dc_app.h"
#include "master/boundary/ioctl.h"

#define PERIOD_NS	1000000

/* a and c hang at branches of k: one without power leaves the other there */
#define TREE(k) "segment seed=3\n" \
	"slave k EK1100 alias=10 " k "\n" \
	"slave a drive in=8 out=8 alias=11 drift=60ppm cable=30\n" \
	"branch k 2\n" \
	"slave b drive in=8 out=8 alias=12 drift=-70ppm clock=3s\n" \
	"slave c drive in=8 out=8 alias=13 drift=95ppm clock=77s cable=90\n"

/*
 * Only behind one without a clock can the first clock go and others stay. What it
 * takes from one of its branches to the other nobody can measure.
 */
#define GUESS_NS	1500

enum mode { FOLLOWERS, LEAD, KERNEL };

static const struct variant {
	enum mode mode;
	const char *name;
	u64 together;	/* clocks that stay differ by no more, ns */
	u64 change;	/* while they learn the rate of one that was in front */
} variants[] = {
	{ FOLLOWERS, "application's cycle", 200, 1000 },
	{ LEAD, "application leads the clocks", 1000, 2000 },
	{ KERNEL, "kernel's cycle follows", 200, 1000 },
};

static void variant_name(const struct variant *v, char *desc)
{
	strscpy(desc, v->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(variant, variants, variant_name);

/**
 * struct run - one session
 * @b: bus
 * @c: its application
 * @v: who runs the cycle
 * @first: simulated slaves that stay
 * @last: the last of them
 * @apart: largest true difference of their clocks, ns
 * @jump: largest deviation of a step of one of their clocks in one cycle, ns
 * @then: time of the last look (ktime)
 * @was: system time of @first at the last look
 */
struct run {
	struct bus *b;
	struct cyc *c;
	const struct variant *v;
	u32 first;
	u32 last;
	u64 apart;
	u64 jump;
	u64 then;
	u64 was;
};

static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	if (c->ctx)
		c->flags |= EC_SEND_FLAG_SYNC_REF;
	c->app_time = ktime_to_ns(c->next) + 123456789;
	c->sync_time = c->app_time;
}

static void look(struct run *r)
{
	u64 now = ktime_get_ns(), t;
	u32 i;

	ec_sim_advance(r->b->sim, now);
	t = ec_esc_system_time(bus_esc(r->b, r->first), now);
	for (i = r->first + 1; i <= r->last; i++) {
		s64 d = ec_esc_system_time(bus_esc(r->b, i), now) - t;

		r->apart = max_t(u64, r->apart, abs(d));
	}
	if (r->then)
		r->jump = max_t(u64, r->jump, abs((s64)(t - r->was - (now - r->then))));
	r->then = now;
	r->was = t;
}

static void run(struct run *r, u32 cycles)
{
	while (cycles--) {
		if (r->v->mode == KERNEL)
			usleep_range(1000, 1001);
		else
			cyc_run(r->c, 1);
		look(r);
	}
}

static void forget(struct run *r, u32 first, u32 last)
{
	r->first = first;
	r->last = last;
	r->apart = 0;
	r->jump = 0;
	r->then = 0;
}

static void sync0(struct run *r)
{
	u32 i;

	for (i = 0; i < bus_wanted(r->b)->n_configs; i++) {
		struct ec_ioc_sc_dc dc = {
			.config = i, .assign_activate = 0x0300, .cycle0 = PERIOD_NS,
			.shift0 = 100000 * i,
		};

		if (!(ec_slave_features(bus_config(r->b, i)->slave) & EC_FEAT_DC))
			continue;
		KUNIT_ASSERT_EQ(r->b->test, ec_ioc(&r->b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

static void until_op(struct run *r)
{
	u32 i;

	for (i = 0; i < 5000; i++) {
		if (cyc_all_op(r->c) && bus_dc_state(r->b) == EC_DC_READY && bus_settled(r->b))
			return;
		run(r, 1);
	}
	KUNIT_FAIL(r->b->test, "not all in OP");
}

/* By alias: a position would be another slave's when one in front is missing. */
static void map(struct run *r, u32 n)
{
	u32 i, sm;

	for (i = 0; i < n; i++) {
		struct ec_slave *s = bus_slave(r->b, i);
		struct ec_ioc_slave_config sc = {
			.alias = 10 + i, .vendor_id = s->info.vendor,
			.product_code = s->info.product,
		};

		KUNIT_ASSERT_EQ(r->b->test, ec_ioc(&r->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
		for (sm = 0; sm < s->n_sms; sm++)
			if (ec_pdo_list_bytes(&s->pdos.sm[sm]))
				cyc_map(r->c, sc.index, sm, 0);
	}
}

/* In OP, with SYNC0, @choice (a configuration) as reference clock. */
static struct run *start(struct kunit *test, const char *text, u32 n, int choice)
{
	struct run *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	struct ec_ioc_ref_clock ref = { .config = choice };
	struct ec_ioc_cycle cfg = {
		.period_ns = PERIOD_NS, .phase_ns = 300000, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_CYCLE_DC_FOLLOW,
	};

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->v = test->param_value;
	r->b = bus_up(test, text, n);
	bus_idle(r->b);
	r->c = cyc_new(r->b, PERIOD_NS / 1000);
	cyc_domain(r->c);
	map(r, n);
	r->c->each = each;
	r->c->ctx = r->v->mode == LEAD ? r : NULL;
	sync0(r);
	if (choice >= 0)
		KUNIT_ASSERT_EQ(test, ec_ioc(&r->b->app, EC_IOC_REF_CLOCK, &ref), 0);
	if (r->v->mode == KERNEL)
		KUNIT_ASSERT_EQ(test, ec_ioc(&r->b->app, EC_IOC_CYCLE, &cfg), 0);
	cyc_activate(r->c);
	forget(r, 1, 1);
	until_op(r);
	run(r, 4000);
	return r;
}

/* until the bus has so many slaves and their clocks are set again */
static void until(struct run *r, u32 slaves)
{
	u32 i;

	for (i = 0; i < 100 && bus_n_slaves(r->b) != slaves; i++)
		run(r, 20);
	KUNIT_ASSERT_EQ(r->b->test, bus_n_slaves(r->b), slaves);
	run(r, 20);
	for (i = 0; i < 200 && ec_dc_busy(bus_dc(r->b)); i++)
		run(r, 20);
	KUNIT_ASSERT_FALSE(r->b->test, ec_dc_busy(bus_dc(r->b)));
}

/* what "ethercat master" shows */
static int shown_ref(struct run *r)
{
	struct ec_ioc_master i = { 0 };

	KUNIT_EXPECT_EQ(r->b->test, ec_ioc(&r->b->app, EC_IOC_MASTER, &i), 0);
	return i.ref_clock;
}

static void expect_within(struct run *r, const char *what, u64 limit)
{
	struct kunit *test = r->b->test;

	bus_figure("%s, %s: clocks that stay differ by %llu ns, a cycle by %llu ns", what,
		   r->v->name, r->apart, r->jump);
	KUNIT_EXPECT_LT(test, r->apart, limit);
	/* 200 ppm and what virtual time passes between reading clock and looking */
	KUNIT_EXPECT_LT(test, r->jump, 1000ull);
}

static void expect_quiet(struct run *r, const char *what)
{
	expect_within(r, what, r->v->together);
}

/* SYNC0 was not started anew at the slaves that stay, and they stay in OP */
static void expect_sync(struct run *r, const u64 *starts)
{
	u32 i;

	for (i = r->first; i <= r->last; i++) {
		KUNIT_EXPECT_EQ(r->b->test, bus_esc(r->b, i)->dc.start, starts[i]);
		KUNIT_EXPECT_TRUE(r->b->test, bus_esc(r->b, i)->dc.running);
		KUNIT_EXPECT_EQ(r->b->test, bus_esc(r->b, i)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	}
}

static void note_starts(struct run *r, u64 *starts)
{
	u32 i;

	for (i = 0; i < ec_sim_count(r->b->sim); i++)
		starts[i] = bus_esc(r->b, i)->dc.start;
}

static void expect_locked(struct run *r)
{
	struct ec_status_cycle *st = bus_kernel_status(r->b);

	if (r->v->mode != KERNEL)
		return;
	KUNIT_EXPECT_EQ(r->b->test, st->lock, EC_CYCLE_LOCK_LOCKED);
	KUNIT_EXPECT_EQ(r->b->test, st->lock_losses, 0u);
}

/* The reference that nobody has chosen loses power: the next one takes over. */
static void ref_power_off(struct kunit *test)
{
	struct run *r = start(test, TREE("dc=none"), 4, -1);
	struct bus *b = r->b;
	u64 starts[4];

	KUNIT_EXPECT_EQ(test, shown_ref(r), 1);
	note_starts(r, starts);
	forget(r, 2, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	until(r, 3);
	/* at ring position 1 is b now */
	KUNIT_EXPECT_EQ(test, shown_ref(r), 1);
	KUNIT_EXPECT_EQ(test, bus_status(b)->dc_ref, 1u);
	KUNIT_EXPECT_PTR_EQ(test, bus_dc_ref(b), bus_slave(b, 1));
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(b, 2)->mem + EC_REG_STATION),
			bus_dc_ref_station(b));
	run(r, 3000);
	expect_quiet(r, "reference without power");
	expect_sync(r, starts);
	expect_locked(r);

	forget(r, 2, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	until(r, 4);
	until_op(r);
	run(r, 3000);
	/* the one that has come back follows the new one */
	KUNIT_EXPECT_EQ(test, shown_ref(r), 2);
	expect_quiet(r, "and back");
	expect_sync(r, starts);
	expect_locked(r);
	forget(r, 1, 3);
	run(r, 1000);
	bus_figure("the one that is back, in front of the reference: %llu ns", r->apart);
	KUNIT_EXPECT_LT(test, r->apart, (u64)GUESS_NS);
	KUNIT_EXPECT_TRUE(test, bus_esc(b, 1)->dc.running);
}

/* All behind the reference are cut off, and come back to its time. */
static void ref_remains_alone(struct kunit *test)
{
	struct run *r = start(test, "segment seed=5\n"
			      "slave a drive in=8 out=8 alias=10 drift=60ppm cable=30\n"
			      "slave b drive in=8 out=8 alias=11 drift=-70ppm clock=3s\n"
			      "slave c drive in=8 out=8 alias=12 drift=95ppm clock=77s\n", 3, -1);
	struct bus *b = r->b;
	u64 starts[3];

	note_starts(r, starts);
	forget(r, 0, 0);
	bus_fault(b, EC_SIM_FAULT_CUT, 0, 1, 0, 0);
	until(r, 1);
	/* they drift away meanwhile, more than any loop takes back soon */
	bus_esc(b, 2)->cfg.drift_ppb += 1000000;
	run(r, 3000);
	bus_esc(b, 2)->cfg.drift_ppb -= 1000000;
	KUNIT_EXPECT_EQ(test, shown_ref(r), 0);
	bus_fault(b, EC_SIM_FAULT_HEAL, 0, 1, 0, 0);
	until(r, 3);
	KUNIT_EXPECT_EQ(test, shown_ref(r), 0);
	until_op(r);
	run(r, 1000);
	expect_quiet(r, "reference alone for 3 s");
	expect_sync(r, starts);
	expect_locked(r);
	forget(r, 0, 2);
	run(r, 1000);
	expect_quiet(r, "and with the others again");
	KUNIT_EXPECT_TRUE(test, bus_esc(b, 1)->dc.running);
	KUNIT_EXPECT_TRUE(test, bus_esc(b, 2)->dc.running);
}

/* Another stands in for a chosen one, which takes over its time when it is back. */
static void ref_chosen_power_off(struct kunit *test)
{
	struct run *r = start(test, TREE("drift=-20ppm"), 4, 1);
	struct bus *b = r->b;
	u64 starts[4];

	note_starts(r, starts);
	forget(r, 2, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	until(r, 3);
	KUNIT_EXPECT_EQ(test, shown_ref(r), 0);
	run(r, 3000);
	expect_within(r, "chosen reference without power", r->v->change);
	expect_sync(r, starts);
	expect_locked(r);

	forget(r, 2, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	until(r, 4);
	until_op(r);
	KUNIT_EXPECT_EQ(test, shown_ref(r), 1);
	run(r, 2000);
	expect_quiet(r, "and back as it was");
	expect_sync(r, starts);
	forget(r, 1, 3);
	run(r, 1000);
	expect_quiet(r, "chosen one back");
	expect_locked(r);
}

/* The only clock goes: nobody has the time, and the tool says so. */
static void ref_lost_without_substitute(struct kunit *test)
{
	struct run *r = start(test, "segment seed=5\n"
			      "slave k EK1100 alias=10 dc=none\n"
			      "slave a drive in=8 out=8 alias=11 drift=60ppm\n", 2, -1);
	struct bus *b = r->b;

	KUNIT_EXPECT_EQ(test, shown_ref(r), 1);
	forget(r, 0, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	until(r, 1);
	KUNIT_EXPECT_EQ(test, shown_ref(r), -1);
	KUNIT_EXPECT_EQ(test, bus_status(b)->dc_ref, 0u);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	until(r, 2);
	until_op(r);
	run(r, 1000);
	KUNIT_EXPECT_EQ(test, shown_ref(r), 1);
	KUNIT_EXPECT_TRUE(test, bus_esc(b, 1)->dc.running);
	/* it has the time the others would have: the application's */
	KUNIT_EXPECT_LT(test, abs((s64)(ec_esc_system_time(bus_esc(b, 1), ktime_get_ns()) -
					ec_dc_now(bus_dc(b)))), 5000000ll);
}

/* Four of ten frames are lost while the clocks are being set: it is tried again. */
static void ref_lost_frames(struct kunit *test)
{
	struct run *r = start(test, TREE("drift=-20ppm"), 4, -1);
	struct bus *b = r->b;
	u32 i;

	forget(r, 0, 2);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 3, 0, 0, 0);
	until(r, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
	for (i = 0; i < 2000 && !ec_dc_busy(bus_dc(b)); i++)
		run(r, 1);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 400000);
	for (i = 0; i < 500 && ec_dc_busy(bus_dc(b)); i++)
		run(r, 1);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	until(r, 4);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	until_op(r);
	run(r, 1000);
	forget(r, 0, 3);
	run(r, 500);
	expect_quiet(r, "frames lost meanwhile");
}

/*
 * One clock cannot be set for a while: the others are corrected meanwhile and do not
 * wait for it for long, and it is set when it can be.
 */
static void ref_set_again(struct kunit *test)
{
	struct run *r = start(test, TREE("drift=-20ppm"), 4, -1);
	struct bus *b = r->b;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 3, 0, 0, 0);
	until(r, 3);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
	for (i = 0; i < 2000 && !ec_dc_busy(bus_dc(b)); i++)
		run(r, 1);
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 1, 0);
	forget(r, 0, 2);
	run(r, 800);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	KUNIT_EXPECT_FALSE(test, ec_clock_is_set(bus_slave(b, 3)));
	expect_within(r, "setting fails for 0.8 s", r->v->together / 2);
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 0, 0);
	for (i = 0; i < 5000 && !ec_clock_is_set(bus_slave(b, 3)); i++)
		run(r, 1);
	until(r, 4);
	KUNIT_EXPECT_TRUE(test, ec_clock_is_set(bus_slave(b, 3)));
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
}

/* Sends in which the application is told a time of the reference clock. */
static u32 heard(struct run *r, u32 cycles)
{
	u32 n = 0;

	while (cycles--) {
		run(r, 1);
		n += READ_ONCE(bus_status(r->b)->dc_time_valid);
	}
	return n;
}

/*
 * A reference clock without power: what the others have made of the datagram is no answer
 * of it, neither to the application nor to the prediction.
 */
static void ref_silent(struct kunit *test)
{
	struct run *r = start(test, TREE("drift=-20ppm"), 4, 1);
	struct bus *b = r->b;
	struct ec_cycle *c = bus_cycle(b);
	u64 last;

	run(r, 1000);
	KUNIT_EXPECT_EQ(test, heard(r, 100), 100u);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	run(r, 3);
	last = c->clock.time_ns;
	KUNIT_EXPECT_EQ(test, heard(r, 20), 0u);
	KUNIT_EXPECT_EQ(test, c->clock.time_ns, last);
	/* another stands in */
	until(r, 3);
	run(r, 1000);
	KUNIT_EXPECT_EQ(test, heard(r, 100), 100u);
}

/*
 * One that follows goes: the reference answers as before, with fewer that count. Two frames are
 * lost at its switches, and an answer that is by chance exactly what was sent proves nothing: the
 * next ones are sent with 1, 2 and 3 ns more.
 */
static void ref_answer_valid_with_lower_wkc(struct kunit *test)
{
	struct run *r = start(test, TREE("drift=0ppm"), 4, -1);

	run(r, 1000);
	KUNIT_EXPECT_EQ(test, heard(r, 100), 100u);
	bus_fault(r->b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	KUNIT_EXPECT_GE(test, heard(r, 20), 20u - 2 - 4);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(ref_silent, variant_gen_params),
	KUNIT_CASE_PARAM(ref_answer_valid_with_lower_wkc, variant_gen_params),
	KUNIT_CASE_PARAM(ref_power_off, variant_gen_params),
	KUNIT_CASE_PARAM(ref_remains_alone, variant_gen_params),
	KUNIT_CASE_PARAM(ref_chosen_power_off, variant_gen_params),
	KUNIT_CASE_PARAM(ref_lost_without_substitute, variant_gen_params),
	KUNIT_CASE_PARAM(ref_lost_frames, variant_gen_params),
	KUNIT_CASE_PARAM(ref_set_again, variant_gen_params),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_ref", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
