// SPDX-License-Identifier: GPL-2.0-only
/* AL states on request, refusals, errors, and who notices them when. */
#include "bus.h"
#include "master/base/limits.h"
#include "master/bus/al.h"
#include "master/boundary/ioctl.h"
#include "master/wire/al.h"

#define N	4

static const char line[] =
	"segment seed=6 response=100us transition=2ms\n"
	"slave coupler EK1100\nslave ai EL3062\nslave axis EL7201 motor=AM8121\n"
	"slave out EL2008\n";

/* position of the slave with inputs only: it may be in OP without cycle */
#define AI	1
#define AXIS	2
#define OUT	3

static void al_up_and_down(struct kunit *test)
{
	static const u8 way[] = {
		EC_AL_SAFEOP, EC_AL_OP, EC_AL_SAFEOP, EC_AL_PREOP, EC_AL_OP, EC_AL_INIT,
		EC_AL_SAFEOP, EC_AL_INIT, EC_AL_PREOP,
	};
	struct bus *b = bus_up(test, line, N);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(way); i++) {
		bus_request(b, AI, way[i]);
		KUNIT_EXPECT_NE_MSG(test, bus_wait_al(b, AI, way[i], 500), ~0ull, "step %u", i);
		KUNIT_EXPECT_EQ(test, ec_app_state(bus_app(b, "ai")), way[i]);
		/* the others stay where they are */
		KUNIT_EXPECT_EQ(test, ec_app_state(bus_app(b, "axis")), EC_AL_PREOP);
	}
}

static void al_boot(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);

	bus_request(b, AXIS, EC_AL_BOOT);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AXIS, EC_AL_BOOT, 500), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AXIS)->note.error, EC_SLAVE_OK);
	bus_request(b, AXIS, EC_AL_PREOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AXIS, EC_AL_PREOP, 500), ~0ull);
}

/* It stays in BOOT, and its worker has nothing to do there, whatever state it comes from. */
static void al_boot_stays(struct kunit *test)
{
	static const u8 from[] = { EC_AL_INIT, EC_AL_PREOP, EC_AL_SAFEOP };
	struct bus *b = bus_up(test, line, N);
	struct ec_slave *s = bus_slave(b, AXIS);
	u32 i, k, reads, left = 0;

	for (i = 0; i < ARRAY_SIZE(from); i++) {
		bus_request(b, AXIS, from[i]);
		KUNIT_ASSERT_NE(test, bus_wait_al(b, AXIS, from[i], 500), ~0ull);
		bus_idle(b);
		bus_request(b, AXIS, EC_AL_BOOT);
		KUNIT_ASSERT_NE(test, bus_wait_al(b, AXIS, EC_AL_BOOT, 500), ~0ull);
		usleep_range(10000, 10001);
		reads = s->al.reads;
		for (k = 0; k < 500; k++) {
			usleep_range(1000, 1001);
			left += ec_app_state(bus_app(b, "axis")) != EC_AL_BOOT;
		}
		KUNIT_EXPECT_EQ_MSG(test, left, 0u, "from %s", ec_al_state_name(from[i]));
		KUNIT_EXPECT_EQ(test, s->al.reads, reads);
		KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
		/* a scan leaves it there, too */
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, OUT, 0, 0, 0);
		msleep(500);
		KUNIT_EXPECT_EQ(test, s->al.reads, reads);
		bus_fault(b, EC_SIM_FAULT_POWER_ON, OUT, 0, 0, 0);
		msleep(500);
		KUNIT_EXPECT_EQ(test, ec_app_state(bus_app(b, "axis")), EC_AL_BOOT);
	}
}

/* A slave without bootstrap mailbox says so. */
static void al_no_boot(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);

	bus_request(b, OUT, EC_AL_BOOT);
	msleep(300);
	KUNIT_EXPECT_EQ(test, bus_slave(b, OUT)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(bus_slave(b, OUT)->note.why, "bootstrap mailbox"),
				  "why: %s", bus_slave(b, OUT)->note.why);
	bus_request(b, OUT, EC_AL_PREOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, OUT, EC_AL_PREOP, 500), ~0ull);
}

static const struct refusal {
	u8 from;
	u8 to;
	u16 code;
} refusals[] = {
	{ EC_AL_INIT, EC_AL_PREOP, 0x0016 },
	{ EC_AL_PREOP, EC_AL_SAFEOP, 0x001e },
	{ EC_AL_SAFEOP, EC_AL_OP, 0x001f },
};

/* The first of these that is set counts: of the request, of the module, of the transition. */
static const struct limit {
	u32 request_ms;
	u32 module_ms;
	u32 ms;
} limits[] = {
	{ 0, 0, 3000 }, { 0, 700, 700 }, { 900, 700, 900 }, { 900, 0, 900 }, { 0, 8000, 8000 },
};

static void limit_desc(const struct limit *l, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "request %u ms, module %u ms", l->request_ms,
		 l->module_ms);
}
KUNIT_ARRAY_PARAM(al_limit, limits, limit_desc);

static u32 failed_after(struct bus *b, u32 position)
{
	u64 t0 = ktime_get_ns();
	u32 i;

	for (i = 0; i < 20000 && bus_slave(b, position)->note.error == EC_SLAVE_OK; i++)
		usleep_range(1000, 1001);
	return div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
}

static void al_time_limit_without_application(struct kunit *test)
{
	const struct limit *l = test->param_value;
	struct ec_ioc_state req = {
		.slave.position = AI, .state = EC_AL_PREOP, .timeout_ms = l->request_ms,
	};
	struct bus *b = bus_up(test, line, N);
	u32 ms;

	bus_request(b, AI, EC_AL_INIT);
	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_MUTE, AI, 0, 1, 0);
	WRITE_ONCE(ec_al_timeout, l->module_ms);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_STATE, &req), 0);
	ms = failed_after(b, AI);
	WRITE_ONCE(ec_al_timeout, 0);
	KUNIT_EXPECT_GE(test, ms, l->ms);
	KUNIT_EXPECT_LE(test, ms, l->ms + 50);
	/* of that request only */
	if (l->request_ms && !l->module_ms) {
		bus_request(b, AI, EC_AL_PREOP);
		KUNIT_EXPECT_GE(test, failed_after(b, AI), 3000u);
	}
	req.timeout_ms = EC_MAX_AL_MS + 1;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_STATE, &req), -EINVAL);
}

/*
 * A slave that takes 4 s for each transition: up, and down as a user asks, each of them without
 * a way back. What it reached late is what a later request goes on from.
 */
static void al_late_states_taken(struct kunit *test)
{
	static const char slow[] = "segment seed=6\nslave a io in=8 out=8 cpu=yes transition=4s\n";
	struct bus *b = bus_new(test, slow);
	u32 lines = bus_log_lines("left without request");
	static const u8 way[] = { EC_AL_INIT, EC_AL_PREOP, EC_AL_INIT };
	u32 i, k;

	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 4100), ~0ull);
	msleep(100);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_OK);
	for (i = 0; i < ARRAY_SIZE(way); i++) {
		struct ec_ioc_state req = { .state = way[i], .timeout_ms = 500 };

		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_STATE, &req), 0);
		msleep(1500);
		KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
		for (k = 0; k < 40000 && bus_slave(b, 0)->note.error; k++)
			usleep_range(1000, 1001);
		KUNIT_EXPECT_LT_MSG(test, k, 20000u, "step %u", i);
		KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, way[i]);
		KUNIT_EXPECT_EQ(test, ec_app_state(bus_app(b, "a")), way[i]);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("left without request"), lines);
}

static void refusal_desc(const struct refusal *r, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%s to %s", ec_al_state_name(r->from),
		 ec_al_state_name(r->to));
}
KUNIT_ARRAY_PARAM(al, refusals, refusal_desc);

/* The slave stays where it was, acknowledged, and the reason can be read. */
static void al_refused(struct kunit *test)
{
	const struct refusal *r = test->param_value;
	struct bus *b = bus_up(test, line, N);
	struct ec_slave *s = bus_slave(b, AI);
	char code[16];

	bus_request(b, AI, r->from);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, AI, r->from, 500), ~0ull);
	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, AI, 0, r->to, r->code);
	bus_request(b, AI, r->to);
	msleep(200);
	KUNIT_EXPECT_EQ(test, s->al.status, r->from);
	KUNIT_EXPECT_FALSE(test, bus_app(b, "ai")->error);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_CONFIG_FAILED);
	snprintf(code, sizeof(code), "0x%04x", r->code);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(s->note.why, code), "why: %s", s->note.why);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(s->note.why, ec_al_state_name(r->to)), "why: %s",
				  s->note.why);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(s->note.why, ec_al_code_text(r->code)), "why: %s",
				  s->note.why);

	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, AI, 0, 0, 0);
	bus_request(b, AI, r->to);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AI, r->to, 500), ~0ull);
	msleep(20);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_STREQ(test, s->note.why, "");
}

/* An error of the slave's own: seen, acknowledged, brought back. */
static void al_falls_back(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u64 us;

	bus_request(b, AI, EC_AL_OP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, AI, EC_AL_OP, 500), ~0ull);
	msleep(50);
	ec_app_al_fail(bus_app(b, "ai"), EC_AL_SAFEOP, 0x001b, ktime_get_ns());
	us = bus_wait_al(b, AI, EC_AL_SAFEOP | EC_AL_ERROR, 1000);
	KUNIT_EXPECT_LT(test, us, 100000ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->al.code, 0x001b);
	bus_figure("a slave that falls back is noticed after %llu us", us);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AI, EC_AL_OP, 500), ~0ull);
}

/* Who only lets the worker look again leaves alone what is requested meanwhile. */
static void al_kicked(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct ec_slave *s = bus_slave(b, AI);

	bus_idle(b);
	ec_slave_kick(s);
	bus_request(b, AI, EC_AL_SAFEOP);
	ec_slave_kick(s);
	KUNIT_EXPECT_EQ(test, s->al.requested, EC_AL_SAFEOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AI, EC_AL_SAFEOP, 500), ~0ull);
	WRITE_ONCE(s->al.requested, EC_AL_PREOP);
	ec_slave_kick(s);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, AI, EC_AL_PREOP, 500), ~0ull);
}

/* virtual time until the master sees @n slaves; ~0 after a second */
static u64 wait_count(struct bus *b, u32 n)
{
	u64 t0 = ktime_get_ns();

	while (bus_responding(b) != n) {
		if (ktime_get_ns() - t0 > NSEC_PER_SEC)
			return ~0ull;
		usleep_range(100, 101);
	}
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

static void al_disappears_and_returns(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u64 gone, back;

	msleep(55);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, N - 1, 0, 0, 0);
	gone = wait_count(b, N - 1);
	KUNIT_EXPECT_LT(test, gone, 100000ull);
	msleep(333);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N - 1);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, N - 1, 0, 0, 0);
	back = wait_count(b, N);
	KUNIT_EXPECT_LT(test, back, 100000ull);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
	bus_figure("a slave that disappears is noticed after %llu us, one that appears after %llu us",
		   gone, back);
}

/* The cable to the first slave: everybody is gone, then everybody is back. */
static void al_cable_pulled(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);

	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_LT(test, wait_count(b, 0), 100000ull);
	msleep(500);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 0);
	KUNIT_EXPECT_FALSE(test, bus_link_up(b));
	bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_LT(test, wait_count(b, N), 100000ull);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
}

static struct kunit_case al_cases[] = {
	KUNIT_CASE(al_up_and_down),
	KUNIT_CASE(al_boot),
	KUNIT_CASE(al_boot_stays),
	KUNIT_CASE(al_no_boot),
	KUNIT_CASE_PARAM(al_refused, al_gen_params),
	KUNIT_CASE_PARAM(al_time_limit_without_application, al_limit_gen_params),
	KUNIT_CASE(al_late_states_taken),
	KUNIT_CASE(al_falls_back),
	KUNIT_CASE(al_kicked),
	KUNIT_CASE(al_disappears_and_returns),
	KUNIT_CASE(al_cable_pulled),
	{}
};

static struct kunit_suite al_suite = {
	.name = "bus_al",
	.exit = bus_exit,
	.test_cases = al_cases,
};

kunit_test_suite(al_suite);

MODULE_LICENSE("GPL");
