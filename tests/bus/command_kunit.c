// SPDX-License-Identifier: GPL-2.0-only
/*
 * Commands of the application for each transition of a slave: when they are executed, in which
 * order, what they read back, and what a failure does.
 */
#include "step_command.h"

/* The slave is brought to a state; what of the registers was written on the way. */
static u32 went(struct cyc *c, u8 state)
{
	u32 i, bits = 0;

	memset(ram(c->b), 0, 16);
	bus_request(c->b, DRIVE, state);
	for (i = 0; i < 2000 && (bus_slave(c->b, DRIVE)->al.status != state ||
				 !bus_settled(c->b)); i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(c->b->test, bus_slave(c->b, DRIVE)->al.status, state);
	for (i = 0; i < 16; i++)
		bits |= ram(c->b)[i] ? BIT(i) : 0;
	return bits;
}

/* Each step has a register of its own. */
static void command_every_step(struct kunit *test)
{
	static const u8 steps[] = {
		STEP(INIT, PREOP), STEP(PREOP, SAFEOP), STEP(SAFEOP, OP), STEP(OP, SAFEOP),
		STEP(OP, PREOP), STEP(OP, INIT), STEP(SAFEOP, PREOP), STEP(SAFEOP, INIT),
		STEP(PREOP, INIT), STEP(INIT, BOOT), STEP(BOOT, INIT),
	};
	enum { IP, PS, SO, OS, OP, OI, SP, SI, PI, IB, BI };
	struct cyc *c = replay_configure(test);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(steps); i++)
		must_add(c, (struct command){ .step = steps[i], .kind = EC_REQUEST_REG,
					      .index = RAM + i, .flags = PUT, .bytes = 1,
					      .data = 0xa0 + i });
	replay_into_op(c);
	/* from PREOP, where the scan has brought it, through INIT */
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_EQ(test, ram(c->b)[i], 0xa0 + i);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_SAFEOP), (u32)BIT(OS));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_OP), (u32)BIT(SO));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_PREOP), (u32)BIT(OP));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_SAFEOP), (u32)BIT(PS));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_PREOP), (u32)BIT(SP));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_INIT), (u32)BIT(PI));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_OP), (u32)(BIT(IP) | BIT(PS) | BIT(SO)));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_INIT), (u32)BIT(OI));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_SAFEOP), (u32)(BIT(IP) | BIT(PS)));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_INIT), (u32)BIT(SI));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_BOOT), (u32)BIT(IB));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_PREOP), (u32)(BIT(BI) | BIT(IP)));
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_OP), (u32)(BIT(PS) | BIT(SO)));
	cyc_release(c);
}

/* In the order of the calls, in any protocol; a check sees what was written before it. */
static void all_kinds(struct cyc *c)
{
	const struct command commands[] = {
		{ STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, PUT, 1, 0, 1 },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, PUT | CHECK, 4, 0, 0x12345678,
		  0x12345678, ~0u },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, CHECK, 1, 0, 0, 1, 0xff },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, PUT, 1, 0, 2 },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_SOE, 91, 1, PUT | CHECK, 4, 0, 4321, 4321,
		  ~0u },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, CHECK, 1, 0, 0, 2, 0xff },
		{ STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, PUT, 4, 0, 0x9abcdef0 },
		/* bits outside of the mask do not count */
		{ STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 4, 0, 0, 0x9abc0000,
		  0xffff0000 },
		{ STEP(SAFEOP, OP), EC_REQUEST_REG, RAM, 0, PUT | CHECK, 2, 0, 0x0403, 0x0403,
		  0xffff },
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(commands); i++)
		must_add(c, commands[i]);
}

static void expect_all_kinds(struct cyc *c)
{
	KUNIT_EXPECT_EQ(c->b->test, get_unaligned_le16(ram(c->b)), 0x0403);
	KUNIT_EXPECT_EQ(c->b->test, replay_value(c->b, TYPES, 8, 4), 0x9abcdef0ull);
}

/* What was configured is shown as it is, in the order of the calls. */
static void command_shown(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	u32 v[3] = { 0 };
	struct ec_ioc_config_command i = {
		.command_pos = 1, .size = sizeof(v), .data = (uintptr_t)v,
	};

	all_kinds(c);
	replay_into_op(c);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CONFIG_COMMAND, &i), 0);
	KUNIT_EXPECT_EQ(test, i.flags, (u32)(PUT | CHECK));
	KUNIT_EXPECT_EQ(test, i.kind, EC_WRITE_KIND_SDO);
	KUNIT_EXPECT_EQ(test, i.object, TYPES);
	KUNIT_EXPECT_EQ(test, i.subindex, 8);
	KUNIT_EXPECT_EQ(test, EC_TRANSITION(i.from, i.to), EC_TRANSITION_PS);
	KUNIT_EXPECT_EQ(test, i.size, 12u);
	KUNIT_EXPECT_EQ(test, v[0], 0x12345678u);
	KUNIT_EXPECT_EQ(test, v[2], ~0u);
	i = (struct ec_ioc_config_command){ .command_pos = 8 };
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CONFIG_COMMAND, &i), 0);
	KUNIT_EXPECT_EQ(test, i.kind, EC_WRITE_KIND_REG);
	KUNIT_EXPECT_EQ(test, i.size, 6u);
	i = (struct ec_ioc_config_command){ .command_pos = 9 };
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CONFIG_COMMAND, &i), -ENOENT);
	HAS(test, c->b->app.reason, "9 commands");
	cyc_release(c);
}

/* A slave that was without power gets them again. */
static void command_order_and_return(struct kunit *test)
{
	struct cyc *c = replay_configure(test);

	all_kinds(c);
	replay_into_op(c);
	expect_all_kinds(c);
	replay_power_off(c);
	memset(ram(c->b), 0, 2);
	replay_power_on(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	expect_all_kinds(c);
	cyc_release(c);
}

/* A command on the way up that fails: the slave stays below, and the text names the command. */
static void command_fails(struct kunit *test)
{
	static const struct {
		struct command command;
		u8 state;
		const char *text;
	} rows[] = {
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SDO, 0x5fff, 3, PUT, 4 }, EC_AL_PREOP,
		  "PREOP to SAFEOP command SDO 0x5fff:03 (4 byte(s)) failed: abort 0x06020000" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 4, 20, 0, 5, ~0u },
		  EC_AL_PREOP,
		  "PREOP to SAFEOP command SDO 0x2001:08 (4 byte(s)) failed: it reads 00 00 00 00, not as expected within 20 ms" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 2, 0, 0, 0, ~0u },
		  EC_AL_PREOP, "it has another length than expected" },
		{ { STEP(SAFEOP, OP), EC_REQUEST_SOE, 92, 0, PUT, 4 }, EC_AL_SAFEOP,
		  "SAFEOP to OP command IDN S-0-0092 of drive 0 (4 byte(s)) failed: SoE error 0x1001" },
		{ { STEP(SAFEOP, OP), EC_REQUEST_REG, RAM, 0, CHECK, 2, 10, 0, 1, 0xffff },
		  EC_AL_SAFEOP,
		  "SAFEOP to OP command register 0x0f80 failed: it reads 00 00, not as expected within 10 ms" },
		{ { STEP(INIT, PREOP), EC_REQUEST_REG, RAM, 0, CHECK, 1, 0, 0, 1, 0xff },
		  EC_AL_INIT, "INIT to PREOP command register 0x0f80 failed" },
	};
	struct cyc *c = replay_configure(test);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(rows); i++) {
		struct ec_slave *s;

		must_add(c, rows[i].command);
		cyc_activate(c);
		cyc_run(c, 1000);
		s = bus_slave(c->b, DRIVE);
		KUNIT_EXPECT_EQ_MSG(test, s->al.status, rows[i].state, "row %u", i);
		HAS(test, s->note.why, rows[i].text);
		cyc_release(c);
		KUNIT_ASSERT_NE(test, bus_wait(c->b, 2, EC_AL_PREOP, 10000), ~0ull);
		bus_idle(c->b);
		c = cyc_new(c->b, 1000);
		cyc_domain(c);
		cyc_map_all(c, DRIVE, 1, 0);
	}
	replay_into_op(c);
	cyc_release(c);
}

static void set_late(struct cyc *c)
{
	if (c->cycles > 300)
		ram(c->b)[0] = 7;
}

/* The value becomes what is expected within the time limit. */
static void command_waits(struct kunit *test)
{
	struct cyc *c = replay_configure(test);

	must_add(c, (struct command){ STEP(SAFEOP, OP), EC_REQUEST_REG, RAM, 0, CHECK, 1, 5000, 0,
				      7, 0xff });
	c->each = set_late;
	cyc_activate(c);
	cyc_run(c, 250);
	KUNIT_EXPECT_EQ(test, bus_slave(c->b, DRIVE)->al.status, EC_AL_SAFEOP);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 1000), ~0ull);
	cyc_release(c);
}

/* The application releases the master while a check waits, after a fault or without one. */
static void interrupted(struct kunit *test, enum ec_sim_fault_type fault, int slave)
{
	struct cyc *c = replay_configure(test);
	u64 t0;

	must_add(c, (struct command){ STEP(PREOP, SAFEOP), EC_REQUEST_SDO, TYPES, 8, CHECK, 4,
				      60000, 0, 7, ~0u });
	cyc_activate(c);
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, bus_slave(c->b, DRIVE)->al.status, EC_AL_PREOP);
	if (slave) {
		bus_fault(c->b, fault, slave, 0, 0, 0);
		cyc_run(c, 50);
	}
	t0 = ktime_get_ns();
	cyc_release(c);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 2 * NSEC_PER_SEC);
}

static void command_released(struct kunit *test)
{
	interrupted(test, 0, 0);
}

static void command_without_slave(struct kunit *test)
{
	interrupted(test, EC_SIM_FAULT_POWER_OFF, DRIVE);
}

static void command_without_link(struct kunit *test)
{
	interrupted(test, EC_SIM_FAULT_CUT, EC_SIM_MASTER0);
}

/* On the way down a failure is logged, and the slave goes down. */
static void command_fails_down(struct kunit *test)
{
	struct cyc *c = replay_configure(test);

	must_add(c, (struct command){ STEP(OP, PREOP), EC_REQUEST_SDO, 0x5fff, 3, PUT, 4 });
	must_add(c, (struct command){ STEP(OP, INIT), EC_REQUEST_SDO, 0x5fff, 3, PUT, 4 });
	replay_into_op(c);
	went(c, EC_AL_PREOP);
	KUNIT_EXPECT_GE(test, bus_log_lines("OP to PREOP command SDO 0x5fff:03"), 1u);
	went(c, EC_AL_OP);
	went(c, EC_AL_INIT);
	KUNIT_EXPECT_GE(test, bus_log_lines("OP to INIT command SDO 0x5fff:03"), 1u);
	went(c, EC_AL_OP);
	cyc_release(c);
}

/* Steps between neighbors on the way to INIT and BOOT. */
static void command_by_neighbors(struct kunit *test)
{
	static const u8 steps[] = {
		STEP(OP, SAFEOP), STEP(SAFEOP, PREOP), STEP(PREOP, INIT), STEP(INIT, BOOT), 0,
	};
	struct cyc *c = in_op_with(replay_configure(test), steps);

	KUNIT_EXPECT_EQ(test, went(c, EC_AL_INIT), 7u);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_OP), 0u);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_PREOP), 3u);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_SAFEOP), 0u);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_BOOT), 14u);
	KUNIT_EXPECT_EQ(test, went(c, EC_AL_OP), 0u);
	cyc_release(c);
}

static void command_invalid(struct kunit *test)
{
	static const struct {
		struct command command;
		const char *text;
	} rows[] = {
		{ { STEP(PREOP, OP), EC_REQUEST_REG, RAM, 0, PUT, 1 }, "no step" },
		{ { 0xff, EC_REQUEST_REG, RAM, 0, PUT, 1 }, "no step" },
		{ { STEP(PREOP, PREOP), EC_REQUEST_REG, RAM, 0, PUT, 1 }, "no step" },
		{ { STEP(INIT, PREOP), EC_REQUEST_SDO, TYPES, 8, PUT, 4 }, "no mailbox" },
		{ { STEP(BOOT, INIT), EC_REQUEST_SOE, 91, 0, PUT, 4 }, "no mailbox" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_VOE, 1, 0, PUT, 4 }, "no kind" },
		{ { STEP(PREOP, SAFEOP), 200, 1, 0, PUT, 4 }, "no kind" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, PUT, 0 }, "bytes of data" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, 0, 4 }, "bytes of data" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, 0xffff, 0, PUT, 2 }, "below 0x10000" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, 0x0120, 0, PUT, 2 }, "AL control" },
		{ { STEP(INIT, PREOP), EC_REQUEST_REG, 0x0800, 0, PUT, 8 }, "SyncManager" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SDO, 0x1c12, 0, PUT, 1 }, "changes PDOs" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SDO, 0x1a00, 0, PUT, 1 }, "changes PDOs" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_SOE, 91, 8, PUT, 4 }, "0 to 7" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0, CHECK, 1, 60001 }, "60000 ms" },
		{ { STEP(PREOP, SAFEOP), EC_REQUEST_REG, RAM, 0,
		    PUT | EC_COMMAND_FLAG_COMPLETE, 1 }, "whole object" },
	};
	struct cyc *c = replay_configure(test);
	struct ec_ioc_sc_command odd = {
		.flags = CHECK, .from = 2, .to = 4, .kind = EC_REQUEST_REG, .index = RAM,
		.size = 3, .data = (uintptr_t)test,
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(rows); i++) {
		KUNIT_EXPECT_EQ_MSG(test, add_command(c, rows[i].command), -EINVAL, "row %u", i);
		HAS(test, c->b->app.reason, rows[i].text);
	}
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_COMMAND, &odd), -EINVAL);
	odd.size = ~0u;
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_COMMAND, &odd), -EINVAL);
	/* what the master writes may be read */
	must_add(c, (struct command){ STEP(SAFEOP, OP), EC_REQUEST_REG, EC_REG_AL_STATUS, 0, CHECK,
				      1, 0, 0, EC_AL_SAFEOP, 0xf });
	for (i = 1; i < EC_MAX_SC_COMMANDS; i++)
		must_add(c, (struct command){ STEP(OP, INIT), EC_REQUEST_REG, RAM, 0, PUT, 1 });
	KUNIT_EXPECT_EQ(test, add_command(c, (struct command){ STEP(OP, INIT), EC_REQUEST_REG,
					       RAM, 0, PUT, 1 }), -ENOSPC);
	replay_into_op(c);
	KUNIT_EXPECT_EQ(test, add_command(c, (struct command){ STEP(OP, INIT), EC_REQUEST_REG,
					       RAM, 0, PUT, 1 }), -EBUSY);
	cyc_release(c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(command_every_step),
	KUNIT_CASE(command_shown),
	KUNIT_CASE(command_order_and_return),
	KUNIT_CASE(command_fails),
	KUNIT_CASE(command_waits),
	KUNIT_CASE(command_released),
	KUNIT_CASE(command_without_slave),
	KUNIT_CASE(command_without_link),
	KUNIT_CASE(command_fails_down),
	KUNIT_CASE(command_by_neighbors),
	KUNIT_CASE(command_invalid),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_command",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
