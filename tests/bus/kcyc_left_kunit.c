// SPDX-License-Identifier: GPL-2.0-only
/* A session that its application has left to the master, and outputs that commands set. */
#include "kcyc.h"
#include "units.h"
#include "master/bus/slave.h"
#include "master/session/reserve.h"

static int detach(struct bus *b)
{
	struct ec_ioc_detach i = { 0 };

	return ec_ioc(&b->app, EC_IOC_DETACH, &i);
}

/* All in OP, then the application leaves. */
static struct kcyc *left(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });

	KUNIT_ASSERT_EQ_MSG(test, detach(a->c->b), 0, "%s", a->c->b->app.reason);
	return a;
}

/* Output @channel of a slave, 32 bits. */
static struct ec_ioc_output output(struct kcyc *a, u32 slave, u32 channel, u32 value)
{
	return (struct ec_ioc_output){
		.bit = 8 * kcyc_place(a, slave, 0, channel), .bits = 32, .value = value,
		.device = bus_slave(a->c->b, slave)->device, .lease_ms = 500,
	};
}

static int set(struct kcyc *a, struct ec_ioc_output o)
{
	return ec_ioc(&a->c->b->app, EC_IOC_OUTPUT, &o);
}

static void master_info(struct bus *b, struct ec_ioc_master *i)
{
	*i = (struct ec_ioc_master){ 0 };
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_MASTER, i), 0);
}

static bool in_op(struct bus *b)
{
	return bus_esc(b, 0)->mem[EC_REG_AL_STATUS] == EC_AL_OP &&
	       bus_esc(b, 1)->mem[EC_REG_AL_STATUS] == EC_AL_OP;
}

/* The application is gone, cycles go on, no application gets the session. */
static void left_session_continues(struct kunit *test)
{
	struct kcyc *a = left(test);
	struct bus *b = a->c->b;
	struct ec_ioc_master i;
	u64 frames = bus_frames(b);

	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 1000), -EPERM);
	bus_end(b);
	msleep(2000);
	KUNIT_EXPECT_GE(test, bus_frames(b) - frames, 1999ull);
	KUNIT_EXPECT_TRUE(test, in_op(b));
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 0ll);
	master_info(b, &i);
	KUNIT_EXPECT_EQ(test, i.session, (u32)EC_SESSION_DETACHED);
	KUNIT_EXPECT_EQ(test, i.left, 1u);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->takeovers, 0u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), -EBUSY);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "'ethercat stop'"), "%s",
				  b->app.reason);
	KUNIT_EXPECT_NULL(test, bus_candidate(b));
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	/* and it can be had again */
	a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_until_op(a);
}

/* The last outputs of the application stay, and cycles without new ones are not counted. */
static void left_with_last_outputs(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	u64 missed;

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_GT(test, kcyc_status(a)->missed, 0ull);
	KUNIT_ASSERT_EQ_MSG(test, detach(a->c->b), 0, "%s", a->c->b->app.reason);
	missed = kcyc_status(a)->missed;
	msleep(100);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, missed);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 42ll);
}

/* A lease ends to the millisecond, a value without one stays, others are not touched. */
static void left_leases_end(struct kunit *test)
{
	struct kcyc *a = left(test);
	struct bus *b = a->c->b;
	struct ec_ioc_output o = output(a, 1, KCYC_CHANNELS, 43);

	o.flags = EC_OUTPUT_FLAG_HOLD;
	o.lease_ms = 0;
	KUNIT_ASSERT_EQ_MSG(test, set(a, output(a, 0, 1, 42)), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ(test, set(a, o), 0);
	/* the process that has set it may be gone */
	bus_end(b);
	msleep(490);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 43ll);
	msleep(30);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 0ll);
	msleep(5000);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 43ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_RUNNING);
	/* with a lease instead; then the session ends in the middle of it */
	KUNIT_EXPECT_EQ(test, set(a, output(a, 1, KCYC_CHANNELS, 44)), 0);
	msleep(520);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 0ll);
	o = output(a, 0, 1, 45);
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	msleep(1000);
	KUNIT_EXPECT_EQ(test, set(a, o), -EINVAL);
}

/* Each set begins the lease anew, and its last value counts. */
static void left_lease_is_renewed(struct kunit *test)
{
	struct kcyc *a = left(test);
	u32 i;

	for (i = 1; i <= 10; i++) {
		KUNIT_ASSERT_EQ(test, set(a, output(a, 0, 1, i)), 0);
		msleep(300);
		KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), (s64)i);
	}
	msleep(300);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 0ll);
}

/* Inputs, other slaves, bits beyond the outputs, values that do not fit. */
static void left_refuses_wrong_outputs(struct kunit *test)
{
	struct kcyc *a = left(test);
	struct ec_ioc_output o = output(a, 0, 1, 42);

#define REFUSED(ret, ...) do { \
	struct ec_ioc_output x = o; \
	__VA_ARGS__; \
	KUNIT_EXPECT_EQ(test, set(a, x), ret); \
} while (0)
	REFUSED(-ENOENT, x.device = bus_slave(a->c->b, 1)->device);
	REFUSED(-ENOENT, x.device = 0);
	REFUSED(-ENOENT, x.domain = 1);
	REFUSED(-ENOENT, x.bit = 8 * kcyc_place(a, 0, 1, 1));
	REFUSED(-ENOENT, x.bit = 8 * kcyc_place(a, 0, 0, KCYC_CHANNELS) + 1);
	REFUSED(-ENOENT, x.bit = ~0u);
	REFUSED(-EINVAL, x.bits = 0);
	REFUSED(-EINVAL, x.bits = 65);
	REFUSED(-EINVAL, x.bits = 5);
	REFUSED(-EINVAL, x.lease_ms = 0);
	REFUSED(-EINVAL, x.flags = EC_OUTPUT_FLAG_HOLD);
	REFUSED(-EINVAL, x.lease_ms = EC_OUTPUT_LEASE_MAX_MS + 1);
	REFUSED(-EOPNOTSUPP, x.flags = 2);
	REFUSED(0, x.value = 42);
	/* a part of what has a lease */
	REFUSED(-EBUSY, x.bits = 8);
	REFUSED(-EBUSY, x.bit += 31; x.bits = 1; x.value = 1);
	REFUSED(0, x.bit += 32; x.value = 7);
	msleep(20);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 2), 7ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 0ll);
}

/* Who may leave, and whose outputs are set. */
static void left_only_by_its_application(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .stall_cycles = 10 });
	struct bus *b = a->c->b;
	struct ec_shared *sh = kcyc_shared(a);

	KUNIT_EXPECT_EQ(test, set(a, output(a, 0, 1, 42)), -EPERM);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "those of an application"));
	KUNIT_EXPECT_EQ(test, detach(b), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "stall_cycles 0"));
	bus_end(b);
	KUNIT_EXPECT_EQ(test, detach(b), -EPERM);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
	KUNIT_EXPECT_EQ(test, detach(b), -EINVAL);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	/* memory that a process has mapped */
	sh = kcyc_shared(a);
	ec_shared_get(sh);
	KUNIT_EXPECT_EQ(test, detach(b), -EBUSY);
	ec_shared_put(sh);
	KUNIT_EXPECT_EQ(test, detach(b), 0);
	/* the handle of a session that is no longer its own */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), -EPERM);
}

/* Sync units that send other outputs than those that are set; outputs that the cycle writes. */
static void left_refuses_outputs_not_sent(struct kunit *test)
{
	static const struct ec_ioc_unit units[] = {
		{ .policy = EC_UNIT_POLICY_ZERO }, { .policy = EC_UNIT_POLICY_HOLD },
		{ .flags = EC_UNIT_FLAG_AUTHORITY }, { .policy = EC_UNIT_POLICY_CONTINUE },
	};
	struct bus *b = kcyc_bus(test);
	struct ec_ioc_output o;
	struct kcyc *a;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(units); i++) {
		struct ec_ioc_unit u = units[i];
		struct ec_ioc_copy c;

		strscpy(u.name, "unit", sizeof(u.name));
		a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
		KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_UNIT, &u), 0, "%s",
				    b->app.reason);
		units_put(b, 0, u.index);
		c = (struct ec_ioc_copy){
			.from_bit = 8 * bus_config(b, 0)->fmmus[1].offset, .bits = 32,
			.to_bit = 8 * bus_config(b, 0)->fmmus[0].offset + 32,
		};
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_COPY, &c), 0);
		KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
		if (i == ARRAY_SIZE(units) - 1)
			break;
		KUNIT_EXPECT_EQ(test, detach(b), -EINVAL);
		KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "only units without these"),
					  "%s", b->app.reason);
		bus_end(b);
	}
	kcyc_until_op(a);
	KUNIT_ASSERT_EQ_MSG(test, detach(b), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, set(a, output(a, 0, 2, 1)), -EEXIST);
	o = output(a, 0, 1, 1);
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	o = output(a, 0, 2, 1);
	o.bit += 31;
	o.bits = 2;
	KUNIT_EXPECT_EQ(test, set(a, o), -EEXIST);
	o.bit++;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
}

/* What was detached when its application exited is the session of others. */
static void left_is_not_detached_by_exit(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });
	struct ec_ioc_master i;

	bus_end(a->c->b);
	master_info(a->c->b, &i);
	KUNIT_EXPECT_EQ(test, i.session, (u32)EC_SESSION_DETACHED);
	KUNIT_EXPECT_EQ(test, i.left, 0u);
	KUNIT_EXPECT_EQ(test, set(a, output(a, 0, 1, 42)), -EPERM);
}

/* A slave is away for a while; then both are in OP, and have got outputs. */
static void comes_back(struct bus *b, const char *gone, const char *back)
{
	bus_command(b, gone);
	msleep(3000);
	bus_command(b, back);
	KUNIT_EXPECT_NE(b->test, bus_wait(b, 2, EC_AL_OP, 10000), ~0ull);
	msleep(100);
}

/* Without a serial number a slave that has lost its power may be any: it gets zeros. */
static void left_values_while_slave_is_gone(struct kunit *test)
{
	struct kcyc *a = left(test);
	struct bus *b = a->c->b;
	struct ec_ioc_output o = output(a, 1, 1, 43);

	KUNIT_EXPECT_EQ(test, set(a, output(a, 1, 2, 44)), 0);
	o.flags = EC_OUTPUT_FLAG_HOLD;
	o.lease_ms = 0;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	bus_command(b, "off s2");
	msleep(3000);
	KUNIT_EXPECT_EQ(test, set(a, o), -ENOENT);
	bus_command(b, "on s2");
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_OP, 10000), ~0ull);
	msleep(100);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 2), 0ll);
	/* it can be set again, by its new number */
	o.device = bus_slave(b, 1)->device;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
}

/* Another device at the place of one with values gets none of them, and they do not come back. */
static void left_values_are_of_one_device(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=31\nslave s1 io in=6400 out=6400 serial=1\n"
			       "slave s2 io in=6400 out=6400 serial=2\n"
			       "branch none\nslave x io in=6400 out=6400 serial=3\n", 2);
	struct ec_ioc_output o;
	struct kcyc *a;

	bus_idle(b);
	a = kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	kcyc_until_op(a);
	KUNIT_ASSERT_EQ_MSG(test, detach(b), 0, "%s", b->app.reason);
	o = output(a, 1, 1, 43);
	o.flags = EC_OUTPUT_FLAG_HOLD;
	o.lease_ms = 0;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	o.device = bus_slave(b, 0)->device;
	o.bit = 8 * kcyc_place(a, 0, 0, 1);
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	o = output(a, 1, 2, 44);
	o.lease_ms = 60000;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	/* the same device gets its values again */
	comes_back(b, "off s2", "on s2");
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 43ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 2), 44ll);
	comes_back(b, "unplug s1.1", "plug s1.1 x.0");
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "x", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "x", 2), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 43ll);
	/* the lease has gone with the values: a part of its bits can be set */
	o = output(a, 1, 2, 7);
	o.bits = 8;
	KUNIT_EXPECT_EQ(test, set(a, o), 0);
	comes_back(b, "unplug s1.1", "plug s1.1 s2.0");
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 2), 0ll);
}

static int names(struct bus *b, unsigned int cmd, void *data, u32 *size)
{
	struct ec_ioc_names i = { .size = *size, .data = (uintptr_t)data };
	int ret = ec_ioc(&b->app, cmd, &i);

	*size = i.size;
	return ret;
}

/* Names stay with the session, also when its application has gone, and end with it. */
static void left_names_stay(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;
	char text[8] = "axes", more[8] = "x", read[8] = "";
	u32 size = 0;

	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), 0);
	KUNIT_EXPECT_EQ(test, size, 0u);
	size = 1;
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_SET_NAMES, more, &size), 0);
	size = 4;
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_SET_NAMES, text, &size), 0);
	size = EC_UAPI_NAMES_MAX + 1;
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_SET_NAMES, text, &size), -E2BIG);
	KUNIT_ASSERT_EQ(test, detach(b), 0);
	bus_end(b);
	/* the size says what did not fit */
	size = 2;
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), 0);
	KUNIT_EXPECT_EQ(test, size, 4u);
	KUNIT_EXPECT_STREQ(test, read, "ax");
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), 0);
	KUNIT_EXPECT_STREQ(test, read, "axes");
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_SET_NAMES, text, &size), -EPERM);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), -ENOENT);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	kcyc_configure(b, (struct ec_ioc_cycle){ 0 });
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), 0);
	KUNIT_EXPECT_EQ(test, size, 0u);
	size = 0;
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_SET_NAMES, NULL, &size), 0);
}

/* An application that takes a session over says what its values are called from then on. */
static void left_names_of_new_application(struct kunit *test)
{
	const struct ec_ioc_cycle all = { .flags = EC_CYCLE_FLAG_ALL };
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = kcyc_configure(b, all);
	char old[8] = "before", new[8] = "new", read[8] = "";
	u32 size = 6;

	KUNIT_ASSERT_EQ(test, names(b, EC_IOC_SET_NAMES, old, &size), 0);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_wait_cycles(a, 20);
	bus_end(b);
	a = kcyc_configure(b, all);
	size = 3;
	KUNIT_ASSERT_EQ(test, names(b, EC_IOC_SET_NAMES, new, &size), 0);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
	size = sizeof(read);
	KUNIT_EXPECT_EQ(test, names(b, EC_IOC_NAMES, read, &size), 0);
	KUNIT_EXPECT_EQ(test, size, 3u);
	KUNIT_EXPECT_STREQ(test, read, "new");
	bus_end(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(left_session_continues),
	KUNIT_CASE(left_names_stay),
	KUNIT_CASE(left_names_of_new_application),
	KUNIT_CASE(left_with_last_outputs),
	KUNIT_CASE(left_leases_end),
	KUNIT_CASE(left_lease_is_renewed),
	KUNIT_CASE(left_refuses_wrong_outputs),
	KUNIT_CASE(left_only_by_its_application),
	KUNIT_CASE(left_refuses_outputs_not_sent),
	KUNIT_CASE(left_is_not_detached_by_exit),
	KUNIT_CASE(left_values_while_slave_is_gone),
	KUNIT_CASE(left_values_are_of_one_device),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_left", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
