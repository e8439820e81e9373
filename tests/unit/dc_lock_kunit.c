// SPDX-License-Identifier: GPL-2.0-only
/* The controller against a reference clock that drifts, jitters and jumps. */
#include "wire_kunit.h"
#include "../../master/wire/dc_lock.h"

/**
 * struct plant - a cycle and a reference clock
 * @l: controller
 * @at: local time of the next cycle, 2^-20 ns
 * @ref: reference time minus local time then, 2^-20 ns
 * @ppb: how much faster the reference runs
 * @noise: of a measurement, ns, all positive: a frame can only be late
 * @random: state
 * @lost: cycles until frames come back again
 * @step: largest correction, ns
 */
struct plant {
	struct ec_dc_lock l;
	s64 at;
	s64 ref;
	s64 ppb;
	u32 noise;
	u32 random;
	u32 lost;
	s32 step;
};

static u32 rnd(struct plant *p)
{
	p->random = p->random * 1664525 + 1013904223;
	return p->random >> 8;
}

static void begin(struct plant *p, u32 period, s64 off, s64 ppb, u32 noise)
{
	*p = (struct plant){ .ref = off * (1 << 20), .ppb = ppb, .noise = noise, .random = 4711 };
	ec_dc_lock_init(&p->l, period);
}

/* true error of the cycle that is due */
static s32 error(const struct plant *p)
{
	return ec_dc_lock_wrap((p->at + p->ref) >> 20, p->l.period);
}

static void run(struct plant *p, u32 cycles)
{
	while (cycles--) {
		s32 e = error(p) + (p->noise ? (s32)(rnd(p) % p->noise) : 0), c;
		s64 span;

		if (p->lost)
			p->lost--;
		c = p->lost ? ec_dc_lock_miss(&p->l) :
			      ec_dc_lock_step(&p->l, ec_dc_lock_wrap(e, p->l.period));
		p->step = max_t(s32, p->step, c < 0 ? -c : c);
		span = (s64)p->l.period + c;
		p->at += span * (1 << 20);
		p->ref += div_s64(span * p->ppb, 1000) * (1 << 20) / 1000000;
	}
}

/* cycles until it is locked, at most @limit */
static u32 until_locked(struct plant *p, u32 limit)
{
	u32 n = 0;

	while (p->l.state != EC_DC_LOCK_LOCKED && n++ < limit)
		run(p, 1);
	return n;
}

/* largest true error in so many cycles */
static s32 worst(struct plant *p, u32 cycles)
{
	s32 max = 0;

	while (cycles--) {
		s32 e = error(p);

		max = max_t(s32, max, e < 0 ? -e : e);
		run(p, 1);
	}
	return max;
}

static void dc_lock_wraps_to_nearest(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(0, 1000), 0);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(499, 1000), 499);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(501, 1000), -499);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(-501, 1000), 499);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(-1234567, 1000), 433);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(1LL << 62, 1000000000), 427387904);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_wrap(-0x7fffffffffffffffLL - 1, 1000), 192);
}

/* any first phase, any rate: locked, then exact; never faster than allowed */
static void dc_lock_locks_from_anywhere(struct kunit *test)
{
	static const u32 period[] = { 10000, 62500, 1000000, 4000000, 1000000000 };
	static const s64 ppb[] = { 0, 100000, -100000, 300000, -300000 };
	u32 i, k, part;

	for (i = 0; i < ARRAY_SIZE(period); i++)
		for (k = 0; k < ARRAY_SIZE(ppb); k++)
			for (part = 0; part < 8; part++) {
				struct plant p;
				u32 n;

				begin(&p, period[i], (s64)period[i] / 8 * part, ppb[k], 0);
				n = until_locked(&p, 1000);
				KUNIT_EXPECT_LT_MSG(test, n, 500u, "%u %lld", period[i],
						    (long long)ppb[k]);
				run(&p, 2000);
				KUNIT_EXPECT_LE_MSG(test, worst(&p, 2000),
						    2 + (s32)(period[i] / 500000), "%u %lld",
						    period[i], (long long)ppb[k]);
				KUNIT_EXPECT_LE(test, p.step, (s32)(period[i] / 100));
				KUNIT_EXPECT_LE(test, ec_dc_lock_ppb(&p.l) - (s32)ppb[k], 500);
				KUNIT_EXPECT_GE(test, ec_dc_lock_ppb(&p.l) - (s32)ppb[k], -500);
			}
}

/* 20 us of jitter in the send: the cycle itself jitters far less */
static void dc_lock_averages_noise(struct kunit *test)
{
	struct plant p;

	begin(&p, 1000000, 300000, 80000, 20000);
	KUNIT_EXPECT_LT(test, until_locked(&p, 2000), 1000u);
	run(&p, 3000);
	p.step = 0;
	/* 10 us is the mean of the noise */
	KUNIT_EXPECT_LT(test, worst(&p, 20000), 14000);
	KUNIT_EXPECT_LT(test, p.step, 500);
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_LOCKED);
}

/* Frames that come late one at a time change nothing at all. */
static void dc_lock_one_late_frame_is_no_error(struct kunit *test)
{
	struct plant p;
	u32 i;

	begin(&p, 1000000, 0, 50000, 0);
	until_locked(&p, 1000);
	run(&p, 3000);
	for (i = 0; i < 50; i++) {
		p.noise = 400000;
		run(&p, 1);
		p.noise = 0;
		KUNIT_EXPECT_LE(test, worst(&p, 5), 2);
	}
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_LOCKED);
}

/* One in four frames is lost; then all for long: the rate is kept. */
static void dc_lock_lost_frames_keep_rate(struct kunit *test)
{
	struct plant p;
	u32 i;

	begin(&p, 1000000, 400000, -100000, 0);
	for (i = 0; i < 1000; i++) {
		p.lost = i % 4 == 3 ? 2 : 0;
		run(&p, 1);
	}
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_LOCKED);
	run(&p, 3000);
	p.lost = 60;
	run(&p, 50);
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_LOCKED);
	KUNIT_EXPECT_LE(test, error(&p), 3);
	p.lost = 10001;
	run(&p, 10000);
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_HOLD);
	/* without it 1 ms would be gone */
	KUNIT_EXPECT_LT(test, error(&p), 2000);
	KUNIT_EXPECT_GT(test, error(&p), -2000);
	/* what is left is small: locked at once */
	KUNIT_EXPECT_EQ(test, until_locked(&p, 1000), 1u);
}

/* The reference jumps, or another one runs at another rate. */
static void dc_lock_follows_jump(struct kunit *test)
{
	struct plant p;

	begin(&p, 1000000, 0, 100000, 0);
	until_locked(&p, 1000);
	run(&p, 2000);
	p.step = 0;
	p.ref += 470000LL * (1 << 20);
	p.ppb = -100000;
	run(&p, 20);
	KUNIT_EXPECT_EQ(test, p.l.state, EC_DC_LOCK_SEEK);
	KUNIT_EXPECT_LT(test, until_locked(&p, 1000), 500u);
	run(&p, 2000);
	KUNIT_EXPECT_LE(test, worst(&p, 1000), 2);
	KUNIT_EXPECT_LE(test, p.step, 10000);
}

/* Half a period off with noise: it takes one of both ways, to its end. */
static void dc_lock_locks_from_half_period(struct kunit *test)
{
	struct plant p;

	begin(&p, 1000000, 500000, 0, 1000);
	KUNIT_EXPECT_LT(test, until_locked(&p, 1000), 300u);
}

static void dc_lock_nothing_known_is_no_correction(struct kunit *test)
{
	struct ec_dc_lock l;
	u32 i;

	ec_dc_lock_init(&l, 1000000);
	for (i = 0; i < 1000; i++)
		KUNIT_EXPECT_EQ(test, ec_dc_lock_miss(&l), 0);
	KUNIT_EXPECT_EQ(test, l.state, EC_DC_LOCK_OFF);
	KUNIT_EXPECT_EQ(test, ec_dc_lock_ppb(&l), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(dc_lock_wraps_to_nearest),
	KUNIT_CASE(dc_lock_locks_from_anywhere),
	KUNIT_CASE(dc_lock_averages_noise),
	KUNIT_CASE(dc_lock_one_late_frame_is_no_error),
	KUNIT_CASE(dc_lock_lost_frames_keep_rate),
	KUNIT_CASE(dc_lock_follows_jump),
	KUNIT_CASE(dc_lock_locks_from_half_period),
	KUNIT_CASE(dc_lock_nothing_known_is_no_correction),
	{ }
};

static struct kunit_suite suite = { .name = "dc_lock", .test_cases = cases };
kunit_test_suite(suite);
