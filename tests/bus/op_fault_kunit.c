// SPDX-License-Identifier: GPL-2.0-only
/* What happens in OP: cables, power, errors of slaves, the end of the session. */
#include <linux/kmsg_dump.h>
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"

/* outputs are wired to inputs in the same and in another slave */
static const char line[] =
	"segment seed=10 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave x EL1859\nslave ao EL4002\nslave ai EL3062\n"
	"slave last EL1859\n"
	"connect x.1 -> x.1\nconnect ao.1 -> ai.1\nconst last.1 value=1\n";

#define N	5
#define X	1
#define AI	3
#define LAST	4

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = cyc_two_domains(bus_up(test, line, N), N);

	cyc_run(c, 20);
	KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_ASSERT_EQ(test, cyc_state(c, 1)->wc_state, 2);
	return c;
}

/* cycles until everything works again, or ~0 */
static u64 recover(struct cyc *c, u32 limit_ms)
{
	u64 t0 = ktime_get_ns();

	while (!cyc_all_op(c) || cyc_state(c, 0)->wc_state != 2 ||
	       cyc_state(c, 1)->wc_state != 2) {
		if (ktime_get_ns() - t0 > (u64)limit_ms * NSEC_PER_MSEC)
			return ~0ull;
		cyc_run(c, 1);
	}
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

/* the others work: an output of theirs comes back */
static void works(struct cyc *c)
{
	*cyc_pd(c, X, 0) ^= 1;
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(c->b->test, *cyc_pd(c, X, 1) & 1, *cyc_pd(c, X, 0) & 1);
}

static void op_power_loss(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u8 before = *cyc_pd(c, LAST, 1);
	u64 us;

	KUNIT_ASSERT_EQ(test, before & 1, 1);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, LAST, 0, 0, 0);
	cyc_run(c, 300);
	/* noticed, its inputs hold, the other domain is complete */
	KUNIT_EXPECT_EQ(test, bus_responding(b), N - 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 1)->working_counter, 0);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 1)->wc_state, 0);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, LAST, 1), before);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	works(c);

	bus_fault(b, EC_SIM_FAULT_POWER_ON, LAST, 0, 0, 0);
	us = recover(c, 5000);
	KUNIT_EXPECT_NE(test, us, ~0ull);
	bus_figure("a slave whose power returns is in OP after %llu us", us);
	works(c);
}

/* The missing slave shares its datagram with others. */
static void op_missing_in_domain(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u8 ai[4];

	put_unaligned_le16(4711, cyc_pd(c, 2, 2));
	cyc_run(c, 20);
	memcpy(ai, cyc_pd(c, AI, 3), 4);
	KUNIT_EXPECT_TRUE(test, memchr_inv(ai, 0, 4));
	bus_fault(c->b, EC_SIM_FAULT_CUT, AI - 1, 1, 0, 0);
	cyc_run(c, 200);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 1);
	KUNIT_EXPECT_GT(test, cyc_state(c, 0)->working_counter, 0);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 1)->wc_state, 0);
	KUNIT_EXPECT_MEMEQ(test, cyc_pd(c, AI, 3), ai, 4);
	works(c);
	bus_fault(c->b, EC_SIM_FAULT_HEAL, AI - 1, 1, 0, 0);
	KUNIT_EXPECT_NE(test, recover(c, 5000), ~0ull);
	works(c);
}

/* Nothing comes back at all: inputs hold; then everybody returns. */
static void op_cable_pulled(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u8 before = *cyc_pd(c, LAST, 1);
	u32 i;

	bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	for (i = 0; i < 100 && bus_responding(c->b); i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, i, 100);
	cyc_run(c, 400);
	KUNIT_EXPECT_FALSE(test, bus_link_up(c->b));
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 0);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, LAST, 1), before);
	bus_fault(c->b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_NE(test, recover(c, 5000), ~0ull);
	works(c);
}

/* An error of a slave in OP is acknowledged, the slave brought back. */
static void op_slave_error(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u32 i;

	ec_app_al_fail(bus_app(c->b, "ai"), EC_AL_SAFEOP, 0x001b, ktime_get_ns());
	for (i = 0; i < 100 && bus_slave(c->b, AI)->al.status == EC_AL_OP; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, i, 100);
	KUNIT_EXPECT_NE(test, recover(c, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(c->b, AI)->note.error, EC_SLAVE_OK);
}

/* The AL event in a frame of the cycle wakes the monitor: at any phase of its looks. */
static void op_slave_error_shows_at_once(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u32 i, k, most = 0;

	for (k = 0; k < 10; k++) {
		ec_app_al_fail(bus_app(c->b, "ai"), EC_AL_SAFEOP, 0x001b, ktime_get_ns());
		for (i = 0; i < 100 && bus_slave(c->b, AI)->al.status == EC_AL_OP; i++)
			cyc_run(c, 1);
		most = max(most, i);
		KUNIT_ASSERT_NE(test, recover(c, 1000), ~0ull);
		cyc_run(c, 101 + k);
	}
	bus_figure("AL state of a slave lost in OP: seen after at most %u cycles", most);
	KUNIT_EXPECT_LE(test, most, 8);
}

static void event_stays(struct cyc *c)
{
	ec_esc_event(c->ctx, EC_ECAT_EVENT_AL, 0);
}

static void op_event_that_stays_costs_nothing(struct kunit *test)
{
	struct cyc *c = in_op(test);
	unsigned long before, quiet;

	cyc_run(c, 100);
	before = bus_monitor_slept(c->b);
	cyc_run(c, 1000);
	quiet = bus_monitor_slept(c->b) - before;
	c->ctx = bus_esc(c->b, AI);
	c->each = event_stays;
	before = bus_monitor_slept(c->b);
	cyc_run(c, 1000);
	KUNIT_EXPECT_LE(test, bus_monitor_slept(c->b) - before, quiet + 30);
	works(c);
}

/* A refused state does not keep the others from OP; the cause is kept. */
static void op_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct cyc *c;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, AI, 0, EC_AL_SAFEOP, 0x001e);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(bus_slave(b, AI)->note.why, "0x001e"), "why: %s",
				  bus_slave(b, AI)->note.why);
	KUNIT_EXPECT_EQ(test, bus_slave(b, X)->al.status, EC_AL_OP);
	works(c);
}

static bool outputs_off(struct bus *b)
{
	return !ec_app_channel(bus_app(b, "x"), EC_APP_OUT, 0) &&
	       !ec_app_channel(bus_app(b, "ao"), EC_APP_OUT, 0);
}

/* The session ends, also when its owner just dies: back to PREOP, outputs off. */
static void op_session_ends(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;

	*cyc_pd(c, X, 0) = 1;
	put_unaligned_le16(1000, cyc_pd(c, 2, 2));
	cyc_run(c, 10);
	KUNIT_ASSERT_FALSE(test, outputs_off(b));
	/* what closing the file does */
	bus_end(b);
	KUNIT_EXPECT_PTR_EQ(test, bus_session(b), NULL);
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), EC_ACCESS_DIRECT);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 3000), ~0ull);
	KUNIT_EXPECT_TRUE(test, outputs_off(b));
	KUNIT_EXPECT_FALSE(test, bus_table(b)->held);
	/* and the next one may begin */
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_release(c);
}

/* An application that stops sending: the links are free again, then reclaimed. */
static void op_application_stalls(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	struct ec_ioc_slave s = { .slave.position = X };

	msleep(300);
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), EC_ACCESS_DIRECT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &s), 0);
	KUNIT_EXPECT_EQ(test, bus_responding(b), N);
	/* the watchdog of the slave has switched its outputs off */
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "ao"), EC_APP_OUT, 0), 0ll);
	c->next = ktime_get();
	cyc_run(c, 20);
	KUNIT_EXPECT_NE(test, recover(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), EC_ACCESS_CYCLIC);
	works(c);
}

/* Lines of the kernel log since @it was last read that have @text in them. */
static u32 logged(struct kmsg_dump_iter *it, const char *text)
{
	static char line[512];
	size_t len;
	u32 n = 0;

	while (kmsg_dump_get_line(it, true, line, sizeof(line) - 1, &len)) {
		line[len] = 0;
		n += !!strstr(line, text);
	}
	return n;
}

/* One stall; the monitor may first wait 100 ms for a frame that nobody sends. */
static void stall_once(struct cyc *c)
{
	msleep(250);
	/* which says nothing about the slaves */
	KUNIT_EXPECT_EQ(c->b->test, bus_responding(c->b), N);
	c->next = ktime_get();
	cyc_run(c, 60);
}

/* Four stalls a second: the log has two lines, and a count 10 s later. */
static void op_stalls_logged(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct kmsg_dump_iter first, it;
	u32 i, before = bus_timeouts(c->b);
	u32 scans = bus_scans(c->b);

	kmsg_dump_rewind(&it);
	logged(&it, "");
	for (i = 0; i < 20; i++)
		stall_once(c);
	KUNIT_EXPECT_EQ(test, bus_timeouts(c->b), before + 20);
	KUNIT_EXPECT_EQ(test, bus_scans(c->b), scans);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle timeout"), 1);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle resumed"), 1);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle timeout: no cyclic frame for "), 1);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle resumed after 2"), 1);
	it = first;

	/* told when the 10 s are over although it does not stall any more */
	cyc_run(c, 9000);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "19 more cycle timeout(s) since the last message"), 1);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle timeout"), 1);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "cycle resumed"), 0);
	/* what the log does not know at the end is told then */
	it = first;
	stall_once(c);
	KUNIT_EXPECT_EQ(test, logged(&it, "cycle timeout"), 0);
	cyc_release(c);
	KUNIT_EXPECT_EQ(test, logged(&it, "1 more cycle timeout(s) since the last message"), 1);
}

static struct kunit_case op_fault_cases[] = {
	KUNIT_CASE(op_power_loss),
	KUNIT_CASE(op_missing_in_domain),
	KUNIT_CASE(op_cable_pulled),
	KUNIT_CASE(op_slave_error),
	KUNIT_CASE(op_slave_error_shows_at_once),
	KUNIT_CASE(op_event_that_stays_costs_nothing),
	KUNIT_CASE(op_refused),
	KUNIT_CASE(op_session_ends),
	KUNIT_CASE(op_application_stalls),
	KUNIT_CASE(op_stalls_logged),
	{}
};

static struct kunit_suite op_fault_suite = {
	.name = "bus_op_fault",
	.exit = bus_exit,
	.test_cases = op_fault_cases,
};

kunit_test_suite(op_fault_suite);

MODULE_LICENSE("GPL");
