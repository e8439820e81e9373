// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that do not reply for a while: they are found again without any request. */
#include <linux/kmsg_dump.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/config/why.h"

static const char line[] =
	"segment seed=10 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave x EL1859\nslave ao EL4002\nslave ai EL3062\n"
	"slave last EL1859\n";

#define N	5
#define X	1
#define AO	2
#define AI	3

static struct cyc *activate(struct bus *b)
{
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	return c;
}

static struct cyc *begin(struct kunit *test)
{
	return activate(bus_up(test, line, N));
}

/* Lines of the kernel log since @it was last read that have @text in them. */
static u32 logged(struct kmsg_dump_iter *it, const char *text)
{
	static char buf[512];
	size_t len;
	u32 n = 0;

	while (kmsg_dump_get_line(it, true, buf, sizeof(buf) - 1, &len)) {
		buf[len] = 0;
		n += !!strstr(buf, text);
	}
	return n;
}

static void expect_why(struct bus *b, u32 config, const char *text)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(w.text, text), "%s", w.text);
}

/* The slave in OP falls silent for @ms and replies again: same object, OP, no rescan asked. */
static void silent_for(struct kunit *test, u32 ms)
{
	struct cyc *c = begin(test);
	struct bus *b = c->b;
	struct ec_slave *s;
	u64 us;

	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 20);
	s = bus_slave(b, AO);
	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 1, 0);
	cyc_run(c, ms);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, AO), s);
	KUNIT_EXPECT_STREQ(test, s->order, "EL4002");
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_EQ(test, cyc_config_status(b, AO), 0);
	expect_why(b, AO, "no reply");
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->al.status, EC_AL_OP);

	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 0, 0);
	us = cyc_wait_op(c, 3000);
	KUNIT_EXPECT_NE(test, us, ~0ull);
	bus_figure("a slave that was silent for %u ms is in OP after %llu us", ms, us);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, AO), s);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_EQ(test, bus_esc(b, AO)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

static void retry_silent_slave_returns_to_op(struct kunit *test)
{
	silent_for(test, 300);
}

static void retry_long_silent_slave_returns_to_op(struct kunit *test)
{
	silent_for(test, 30000);
}

/* Meanwhile the power was off: address and state are lost. */
static void retry_silent_slave_restarts(struct kunit *test)
{
	struct cyc *c = begin(test);
	struct bus *b = c->b;

	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 1, 0);
	cyc_run(c, 1000);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, AO, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, AO, 0, 0, 0);
	cyc_run(c, 100);
	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 0, 0);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, AO)->order, "EL4002");
	KUNIT_EXPECT_EQ(test, bus_slave(b, AO)->note.error, EC_SLAVE_OK);
}

/* Two neighbours: one stays silent, the other one returns. */
static void retry_one_of_two_silent(struct kunit *test)
{
	struct cyc *c = begin(test);
	struct bus *b = c->b;

	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 1, 0);
	cyc_run(c, 500);
	bus_fault(b, EC_SIM_FAULT_DEAD, AI, 0, 1, 0);
	cyc_run(c, 500);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, AI)->order, "EL3062");
	bus_fault(b, EC_SIM_FAULT_DEAD, AI, 0, 0, 0);
	cyc_run(c, 2000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->al.status, EC_AL_OP);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, AO)->reply.silent);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, AO)->order, "EL4002");
	bus_fault(b, EC_SIM_FAULT_DEAD, AO, 0, 0, 0);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
}

/* No application: the same, and PREOP. */
static void retry_silent_without_application(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u32 scans;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_DEAD, X, 0, 1, 0);
	msleep(20000);
	scans = bus_scans(b);
	KUNIT_EXPECT_EQ(test, bus_slave(b, X)->note.error, EC_SLAVE_SCAN_FAILED);
	msleep(5000);
	/* while it does not reply, nothing else is disturbed */
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	bus_fault(b, EC_SIM_FAULT_DEAD, X, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, X, EC_AL_PREOP, 2000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, X)->note.error, EC_SLAVE_OK);
}

/* What cannot be read is tried again, ever less often; the log has the cause once. */
static void unreadable(struct kunit *test, enum ec_sim_fault_type type, u32 arg)
{
	struct bus *b = bus_new(test, line);
	struct kmsg_dump_iter it;
	u32 scans;

	kmsg_dump_rewind(&it);
	logged(&it, "");
	bus_fault(b, type, AI, 0, arg, 0);
	bus_plug(b);
	msleep(1000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->note.error, EC_SLAVE_SCAN_FAILED);
	msleep(60000);
	scans = bus_scans(b);
	KUNIT_EXPECT_LE(test, scans, 12u);
	KUNIT_EXPECT_EQ(test, logged(&it, "EtherCAT 0-3: "), 1u);
	bus_fault(b, type, AI, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 70000), ~0ull);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, AI)->order, "EL3062");
	KUNIT_EXPECT_STREQ(test, bus_slave(b, AI)->note.why, "");
}

static void retry_eeprom_busy(struct kunit *test)
{
	unreadable(test, EC_SIM_FAULT_EEPROM_BUSY, 1);
}

static void retry_eeprom_without_acknowledge(struct kunit *test)
{
	unreadable(test, EC_SIM_FAULT_EEPROM_NOACK, ~0u);
}

static void retry_slave_silent_from_start(struct kunit *test)
{
	unreadable(test, EC_SIM_FAULT_DEAD, 1);
}

/* An application that hangs on the way to PREOP and goes on. */
static void retry_mute(struct kunit *test)
{
	struct bus *b = bus_new(test, line);

	bus_fault(b, EC_SIM_FAULT_MUTE, AI, 0, 1, 0);
	bus_plug(b);
	msleep(20000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->note.error, EC_SLAVE_CONFIG_FAILED);
	bus_fault(b, EC_SIM_FAULT_MUTE, AI, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 70000), ~0ull);
	/* the monitor may have seen the state before the worker */
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->note.error, EC_SLAVE_OK);
}

/* The next try is cut short by a caller who leaves the slave to the monitor again. */
static void retry_interrupted(struct kunit *test)
{
	struct bus *b = bus_new(test, line);
	struct ec_slave *s;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_MUTE, AI, 0, 1, 0);
	bus_plug(b);
	msleep(20000);
	s = bus_slave(b, AI);
	KUNIT_ASSERT_EQ(test, s->note.error, EC_SLAVE_CONFIG_FAILED);
	for (i = 0; i < 70000 && (!ec_slave_busy(s) || !READ_ONCE(s->stop.worker)); i++)
		usleep_range(1000, 1001);
	KUNIT_ASSERT_LT(test, i, 70000u);
	ec_stop_interrupt(&s->stop, true);
	for (i = 0; i < 1000 && ec_slave_busy(s); i++)
		usleep_range(1000, 1001);
	KUNIT_ASSERT_LT(test, i, 1000u);
	ec_stop_interrupt(&s->stop, false);
	bus_fault(b, EC_SIM_FAULT_MUTE, AI, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 70000), ~0ull);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
}

static u32 count_failed(struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < bus_n_slaves(b); i++)
		n += bus_slave_at(b, i)->note.error == EC_SLAVE_CONFIG_FAILED;
	return n;
}

/*
 * Many frames are lost on the way to OP. Which ones is chance: where no slave has failed of
 * it, another start follows.
 */
static void retry_frames_lost_during_start(struct kunit *test)
{
	struct cyc *c = begin(test);
	struct bus *b = c->b;
	u32 i, k, failed = 0;

	for (i = 0; i < 20 && !failed; i++) {
		if (i) {
			ec_sim_clear_faults(b->sim);
			KUNIT_ASSERT_NE(test, cyc_wait_op(c, 70000), ~0ull);
			cyc_release(c);
			c = activate(b);
		}
		bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 400000 + i % 4 * 50000);
		for (k = 0; k < 15 && !failed; k++) {
			cyc_run(c, 100);
			failed = count_failed(b);
		}
	}
	KUNIT_EXPECT_TRUE(test, failed);
	ec_sim_clear_faults(b->sim);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	/* one may be in OP, with its answer lost: the next try finds that out */
	for (k = 0; k < 50 && count_failed(b); k++)
		cyc_run(c, 100);
	cyc_run(c, 100);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_STREQ(test, bus_slave(b, i)->note.why, "");
}

/* A refusal stays one: only frames and time are worth another try. */
static void retry_not_after_refusal(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct cyc *c;
	u32 tries;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, AI, 0, EC_AL_SAFEOP, 0x001e);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	cyc_run(c, 1000);
	tries = bus_slave(b, AI)->al.reads;
	cyc_run(c, 5000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_EQ(test, bus_slave(b, AI)->al.reads, tries);
}

/* An error in SAFEOP that only INIT clears: INIT, then OP; the text names the acknowledge. */
static void retry_error_without_acknowledge_goes_through_init(struct kunit *test)
{
	static const char ignored[] =
		"AL state SAFEOP with error, AL status code 0x001b (SyncManager watchdog expired: no outputs came in time): 3 acknowledges without effect; INIT follows";
	struct bus *b = bus_up(test, "segment seed=17\nslave a io in=8 out=8 cpu=yes ack=no\n", 1);
	u32 lines = bus_log_lines(ignored);
	struct cyc *c;
	u64 us;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	ec_app_al_fail(bus_app(b, "a"), EC_AL_SAFEOP, EC_AL_CODE_SM_WATCHDOG, ktime_get_ns());
	cyc_run(c, 3300);
	us = cyc_wait_op(c, 10000);
	bus_figure("an error that only INIT clears: OP after %llu us", us + 3300000);
	KUNIT_EXPECT_NE_MSG(test, us, ~0ull, "%s", bus_slave(b, 0)->note.why);
	KUNIT_EXPECT_EQ(test, bus_log_lines(ignored), lines + 1);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

static struct kunit_case retry_cases[] = {
	KUNIT_CASE(retry_silent_slave_returns_to_op),
	KUNIT_CASE(retry_long_silent_slave_returns_to_op),
	KUNIT_CASE(retry_silent_slave_restarts),
	KUNIT_CASE(retry_one_of_two_silent),
	KUNIT_CASE(retry_silent_without_application),
	KUNIT_CASE(retry_eeprom_busy),
	KUNIT_CASE(retry_eeprom_without_acknowledge),
	KUNIT_CASE(retry_slave_silent_from_start),
	KUNIT_CASE(retry_mute),
	KUNIT_CASE(retry_interrupted),
	KUNIT_CASE(retry_frames_lost_during_start),
	KUNIT_CASE(retry_not_after_refusal),
	KUNIT_CASE(retry_error_without_acknowledge_goes_through_init),
	{}
};

static struct kunit_suite retry_suite = {
	.name = "bus_retry",
	.exit = bus_exit,
	.test_cases = retry_cases,
};

kunit_test_suite(retry_suite);

MODULE_LICENSE("GPL");
