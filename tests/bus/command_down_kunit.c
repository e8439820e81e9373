// SPDX-License-Identifier: GPL-2.0-only
/* Commands for steps down when the session of the application ends. */
#include <linux/kthread.h>
#include "step_command.h"
#include "master/cycle/recorder.h"

/* What of the registers of the slave is written when the application ends its session. */
static u32 ended(struct cyc *c, bool release)
{
	struct bus *b = c->b;
	u32 i, bits = 0;

	memset(ram(b), 0, 16);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, release ? EC_IOC_RELEASE : EC_IOC_DEACTIVATE,
					NULL), 0);
	for (i = 0; i < 16; i++)
		bits |= ram(b)[i] ? BIT(i) : 0;
	KUNIT_ASSERT_NE(b->test, bus_wait(b, 2, EC_AL_PREOP, 10000), ~0ull);
	if (!release)
		KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);
	bus_idle(b);
	return bits;
}

/* They are executed when the call returns; OP stands for OS and SP if it has commands. */
static void command_down_session_ends(struct kunit *test)
{
	static const struct {
		u8 steps[6];
		bool release;
		u32 bits;
	} rows[] = {
		{ { STEP(OP, SAFEOP), STEP(SAFEOP, PREOP) }, false, BIT(0) | BIT(1) },
		{ { STEP(OP, SAFEOP), STEP(SAFEOP, PREOP) }, true, BIT(0) | BIT(1) },
		{ { STEP(OP, SAFEOP) }, true, BIT(0) },
		{ { STEP(SAFEOP, PREOP) }, true, BIT(0) },
		{ { STEP(OP, PREOP), STEP(OP, SAFEOP), STEP(SAFEOP, PREOP) }, true, BIT(0) },
		/* it does not go to INIT */
		{ { STEP(OP, SAFEOP), STEP(OP, INIT), STEP(SAFEOP, INIT), STEP(PREOP, INIT) }, true,
		  BIT(0) },
		{ { STEP(OP, INIT), STEP(PREOP, INIT) }, true, 0 },
	};
	struct cyc *c = replay_configure(test);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(rows); i++) {
		in_op_with(c, rows[i].steps);
		KUNIT_EXPECT_EQ_MSG(test, ended(c, rows[i].release), rows[i].bits, "row %u", i);
		c = cyc_new(c->b, 1000);
		cyc_domain(c);
		cyc_map_all(c, DRIVE, 1, 0);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("commands for steps down not finished"), 0u);
	cyc_release(c);
}

/* One that fails does not keep the others from being executed. */
static void command_down_fails(struct kunit *test)
{
	static const u8 steps[] = { STEP(OP, SAFEOP), STEP(SAFEOP, PREOP), 0 };
	struct cyc *c = replay_configure(test);

	must_add(c, (struct command){ STEP(OP, SAFEOP), EC_REQUEST_SDO, 0x5fff, 3, PUT, 4 });
	in_op_with(c, steps);
	KUNIT_EXPECT_EQ(test, ended(c, true), (u32)BIT(1));
	KUNIT_EXPECT_GE(test, bus_log_lines("OP to SAFEOP command SDO 0x5fff:03"), 1u);
}

/*
 * A check that never succeeds, a slave without power, a mailbox that does not answer, a cut cable:
 * the end of the session is limited.
 */
static void ends_within(struct kunit *test, enum ec_sim_fault_type fault, int slave, u32 arg,
			bool limit)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	u32 lines = bus_log_lines("commands for steps down not finished");
	u64 t0, ms;

	must_add(c, (struct command){ STEP(OP, PREOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 4, 60000,
				      0, 7, ~0u });
	replay_into_op(c);
	if (slave)
		bus_fault(b, fault, slave, 0, arg, 0);
	t0 = ktime_get_ns();
	cyc_release(c);
	ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	KUNIT_EXPECT_GE(test, ms, limit ? 2000u : 0u);
	KUNIT_EXPECT_LT(test, ms, limit ? 2500u : 500u);
	if (!slave)
		KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_EXPECT_GT(test, bus_log_lines("commands for steps down not finished"), lines);
}

static void command_down_check(struct kunit *test)
{
	ends_within(test, 0, 0, 0, true);
}

static void command_down_power(struct kunit *test)
{
	ends_within(test, EC_SIM_FAULT_POWER_OFF, DRIVE, 0, false);
}

static void command_down_mailbox(struct kunit *test)
{
	ends_within(test, EC_SIM_FAULT_MAILBOX, DRIVE, EC_SIM_MAILBOX_LOST, true);
}

static void command_down_cable(struct kunit *test)
{
	ends_within(test, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, false);
}

/* A reader of records that begins while a session waits for such a command. */
static struct ec_file reader;
static struct completion began;

static int begin_reader(void *arg)
{
	static u8 mask[2];
	struct ec_ioc_recorder i = { .data = (uintptr_t)mask, .size = sizeof(mask) };
	struct bus *b = arg;

	mask[0] = 1;
	ec_file_init(&reader, b->m, false);
	msleep(500);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&reader, EC_IOC_RECORDER, &i), 0);
	complete(&began);
	return 0;
}

/* It ends with that session: the next one does not record in the form of that before. */
static void command_down_recorder_ends(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	u64 at;

	must_add(c, (struct command){ STEP(OP, PREOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 4, 60000,
				      0, 7, ~0u });
	replay_into_op(c);
	init_completion(&began);
	kthread_run(begin_reader, b, "reader");
	cyc_release(c);
	wait_for_completion(&began);
	KUNIT_EXPECT_NULL(test, rcu_access_pointer(bus_cycles(b)->recorder));
	KUNIT_ASSERT_NOT_NULL(test, reader.reader);
	at = reader.reader->at;
	KUNIT_EXPECT_EQ(test, reader.reader->kind->copy(reader.reader, &at, NULL), -ENODATA);
	ec_reader_end(&reader);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(command_down_session_ends),
	KUNIT_CASE(command_down_fails),
	KUNIT_CASE(command_down_check),
	KUNIT_CASE(command_down_power),
	KUNIT_CASE(command_down_mailbox),
	KUNIT_CASE(command_down_cable),
	KUNIT_CASE(command_down_recorder_ends),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_command_down",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
