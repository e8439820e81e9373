// SPDX-License-Identifier: GPL-2.0-only
/* Sync units: what fails is judged alone, and nothing is done to others. */
#include "units.h"
#include "master/session/session_units.h"

#define RUN(state)	((state) & 0xf)
#define SENDS(state)	((state) >> 4 & 0xf)
#define FAULTS(state)	((state) >> 16)

static void begin(struct cyc *c)
{
	cyc_activate(c);
	KUNIT_ASSERT_NE(c->b->test, cyc_wait_op(c, 5000), ~0ull);
	/* the master looks at the states of slaves a few times in a second */
	cyc_run(c, 50);
}

/* The value of the last cycle has reached a slave. */
static void expect_value(struct cyc *c, u32 slave)
{
	KUNIT_EXPECT_EQ_MSG(c->b->test, units_out(c->b, slave), (slave + 1) << 24 | (u32)c->cycles,
			    "slave %u", slave);
}

/* Slaves 0 and 1 in unit "a", 2 and 3 in unit "b", 4 and 5 in none. */
static struct cyc *two_units(struct kunit *test, u32 a, u32 b)
{
	struct cyc *c = units_app(units_bus(test, 6), 3, 2);

	units_put(c->b, 0, units_new(c->b, "a", a, 0));
	units_put(c->b, 1, units_new(c->b, "b", b, 0));
	return c;
}

/* Slave 0 fails: the outputs of its neighbor, and of no other slave, are zero after 3 receives. */
static void unit_zero(struct kunit *test)
{
	struct cyc *c = two_units(test, EC_UNIT_POLICY_ZERO, EC_UNIT_POLICY_ZERO);
	u32 i;

	begin(c);
	KUNIT_EXPECT_EQ(test, units_state(c->b, 0), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
	units_dead(c->b, 0, true);
	/* the frame of the first cycle is sent before the fault is seen, three receives judge it */
	for (i = 0; i < 3; i++) {
		cyc_run(c, 1);
		expect_value(c, 1);
	}
	cyc_run(c, 1);
	for (i = 0; i < 10; i++) {
		KUNIT_EXPECT_EQ(test, units_out(c->b, 1), 0u);
		expect_value(c, 2);
		expect_value(c, 3);
		expect_value(c, 4);
		cyc_run(c, 1);
	}
	KUNIT_EXPECT_EQ(test, RUN(units_state(c->b, 0)), (u32)EC_UNIT_RUN_FAILED);
	KUNIT_EXPECT_EQ(test, SENDS(units_state(c->b, 0)), (u32)EC_UNIT_SENDS_ZERO);
	KUNIT_EXPECT_EQ(test, FAULTS(units_state(c->b, 0)), 1u);
	KUNIT_EXPECT_EQ(test, units_state(c->b, 1), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
	/* its inputs are received */
	KUNIT_EXPECT_EQ(test, bus_domain_status(c->b, 0)->working_counter, 3u);
	units_dead(c->b, 0, false);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	expect_value(c, 0);
	expect_value(c, 1);
	KUNIT_EXPECT_EQ(test, SENDS(units_state(c->b, 0)), (u32)EC_UNIT_SENDS_VALUES);
}

/* The values that were sent last stay, those of the application do not arrive. */
static void unit_hold(struct kunit *test)
{
	struct cyc *c = two_units(test, EC_UNIT_POLICY_HOLD, EC_UNIT_POLICY_CONTINUE);
	u32 held, i;

	begin(c);
	units_dead(c->b, 0, true);
	cyc_run(c, 4);
	held = units_out(c->b, 1);
	KUNIT_EXPECT_EQ(test, held, 2u << 24 | ((u32)c->cycles - 1));
	for (i = 0; i < 10; i++) {
		cyc_run(c, 1);
		KUNIT_EXPECT_EQ(test, units_out(c->b, 1), held);
		expect_value(c, 2);
	}
	/* the other one continues: a slave fails, its neighbor has values */
	units_dead(c->b, 2, true);
	cyc_run(c, 10);
	expect_value(c, 3);
	KUNIT_EXPECT_EQ(test, units_state(c->b, 1),
			EC_UNIT_RUN_FAILED | EC_UNIT_HAS_AUTHORITY | 1 << 16);
	units_dead(c->b, 0, false);
	units_dead(c->b, 2, false);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	expect_value(c, 1);
}

/* One receive is not enough: the count begins again. */
static void unit_limit(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 2), 1, 2);
	u32 i;

	units_put(c->b, 0, units_create(c->b, (struct ec_ioc_unit){
		.policy = EC_UNIT_POLICY_ZERO, .limit = 2 }, "a"));
	begin(c);
	for (i = 0; i < 20; i++) {
		bus_fault(c->b, EC_SIM_FAULT_LOSE, -1, -1, 1, 0);
		cyc_run(c, 2);
		KUNIT_EXPECT_NE(test, units_out(c->b, 1), 0u);
	}
	KUNIT_EXPECT_GE(test, c->incomplete, 20ull);
	KUNIT_EXPECT_EQ(test, FAULTS(units_state(c->b, 0)), 0u);
}

static u8 al(struct bus *b, u32 slave)
{
	return READ_ONCE(bus_slave_at(b, slave)->al.status) & EC_AL_STATE_MASK;
}

/* Its slaves go to SAFEOP and stay there until the application gives authority again. */
static void unit_safeop(struct kunit *test)
{
	struct cyc *c = two_units(test, EC_UNIT_POLICY_SAFEOP, EC_UNIT_POLICY_SAFEOP);
	u32 i;

	begin(c);
	units_dead(c->b, 0, true);
	cyc_run(c, 4);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 1), 0u);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, al(c->b, 1), EC_AL_SAFEOP);
	units_dead(c->b, 0, false);
	cyc_run(c, 1500);
	KUNIT_EXPECT_EQ(test, al(c->b, 0), EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, al(c->b, 1), EC_AL_SAFEOP);
	for (i = 2; i < 6; i++) {
		KUNIT_EXPECT_EQ(test, al(c->b, i), EC_AL_OP);
		expect_value(c, i);
	}
	KUNIT_EXPECT_EQ(test, units_state(c->b, 0) & 0xffff,
			EC_UNIT_RUN_FAILED | EC_UNIT_SENDS_ZERO << 4 | EC_UNIT_DOWN);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), -EINPROGRESS);
	for (i = 0; i < 1000 && units_authority(c->b, 0, 1) == -EINPROGRESS; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(test, units_out(c->b, 0), 0u);
	}
	cyc_run(c, 2);
	for (i = 0; i < 6; i++) {
		KUNIT_EXPECT_EQ(test, al(c->b, i), EC_AL_OP);
		expect_value(c, i);
	}
	KUNIT_EXPECT_EQ(test, units_state(c->b, 1), EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY);
}

/* Everything stops, domains without unit too, until authority is given. */
static void unit_stop(struct kunit *test)
{
	struct cyc *c = two_units(test, EC_UNIT_POLICY_STOP, EC_UNIT_POLICY_SAFEOP);
	u32 i, k;

	begin(c);
	units_dead(c->b, 0, true);
	cyc_run(c, 4);
	for (i = 1; i < 6; i++)
		KUNIT_EXPECT_EQ_MSG(test, units_out(c->b, i), 0u, "slave %u", i);
	cyc_run(c, 100);
	for (i = 1; i < 6; i++)
		KUNIT_EXPECT_EQ_MSG(test, al(c->b, i), EC_AL_SAFEOP, "slave %u", i);
	units_dead(c->b, 0, false);
	cyc_run(c, 1500);
	KUNIT_EXPECT_EQ(test, al(c->b, 0), EC_AL_SAFEOP);
	/* another unit cannot end it */
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 1, 1), -EINPROGRESS);
	cyc_run(c, 200);
	KUNIT_EXPECT_EQ(test, al(c->b, 2), EC_AL_SAFEOP);
	for (k = 0; k < 1000 && units_authority(c->b, 0, 1) == -EINPROGRESS; k++) {
		cyc_run(c, 1);
		for (i = 0; i < 6; i++)
			KUNIT_ASSERT_EQ(test, units_out(c->b, i), 0u);
	}
	cyc_run(c, 5);
	for (i = 0; i < 6; i++) {
		KUNIT_EXPECT_EQ(test, al(c->b, i), EC_AL_OP);
		expect_value(c, i);
	}
}

/* Zeros until the application gives authority; taken by it, by a tool, by a failure. */
static void unit_authority(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 4), 2, 2);
	struct ec_ioc_unit_authority take = { .unit = 0 }, give = { .unit = 0, .authority = 1 };
	struct ec_file *tool = kunit_kzalloc(test, sizeof(*tool), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, tool);
	ec_file_init(tool, c->b->m, true);
	units_put(c->b, 0, units_new(c->b, "a", EC_UNIT_POLICY_HOLD, EC_UNIT_FLAG_AUTHORITY));
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), -EINVAL);
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), -EINPROGRESS);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	expect_value(c, 2);
	KUNIT_EXPECT_EQ(test, ec_ioc(tool, EC_IOC_UNIT_AUTHORITY, &give), -EPERM);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), 0);
	cyc_run(c, 2);
	expect_value(c, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(tool, EC_IOC_UNIT_AUTHORITY, &take), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 1), 0u);
	expect_value(c, 2);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), 0);
	cyc_run(c, 2);
	/* after a failure the values are held, and not those of the application when it is over */
	units_dead(c->b, 0, true);
	cyc_run(c, 10);
	units_dead(c->b, 0, false);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, units_state(c->b, 0) & 0xffff,
			EC_UNIT_RUN_COMPLETE | EC_UNIT_SENDS_HELD << 4);
	KUNIT_EXPECT_NE(test, units_out(c->b, 1), 0u);
	KUNIT_EXPECT_NE(test, units_out(c->b, 1), 2u << 24 | (u32)c->cycles);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), 0);
	cyc_run(c, 2);
	expect_value(c, 1);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 1, 1), -ENOENT);
}

/* The same frame three times: two of them may be lost. */
static void unit_repeats(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 4), 2, 2);
	struct ec_ioc_sc_flag f = { .value = 1, .key = "FrameRepeatSupport" };
	struct ec_ioc_activate act = { 0 };
	u32 i;

	units_put(c->b, 0, units_create(c->b, (struct ec_ioc_unit){
		.policy = EC_UNIT_POLICY_ZERO, .repeats = 3 }, "a"));
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_ACTIVATE, &act), -EXDEV);
	KUNIT_EXPECT_NOT_NULL(test, strstr(c->b->app.reason, "FrameRepeatSupport"));
	for (f.config = 0; f.config < 2; f.config++)
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_FLAG, &f), 0);
	begin(c);
	KUNIT_EXPECT_EQ(test, bus_plain_wire(c->b)->frames, 4u);
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->frames, 4u);
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->ns, bus_plain_wire(c->b)->ns);
	c->incomplete = 0;
	for (i = 0; i < 100; i++) {
		/* two of the first, third and fourth frame of this cycle: the second is another */
		bus_fault(c->b, EC_SIM_FAULT_LOSE, -1, -1, 1 + 2 * (i % 2), 0);
		bus_fault(c->b, EC_SIM_FAULT_LOSE, -1, 0, 3 + i % 2, 0);
		cyc_run(c, 2);
		KUNIT_EXPECT_EQ(test, bus_domain_status(c->b, 0)->wc_state, 2u);
		KUNIT_EXPECT_EQ(test, bus_domain_status(c->b, 0)->working_counter, 6u);
		expect_value(c, 0);
		expect_value(c, 2);
	}
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, FAULTS(units_state(c->b, 0)), 0u);
	/* a slave that fails is not hidden by the copies */
	units_dead(c->b, 0, true);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, bus_domain_status(c->b, 0)->working_counter, 3u);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 1), 0u);
	expect_value(c, 2);
}

/* another application */
static struct ec_file *other(struct bus *b)
{
	struct ec_file *f = kunit_kzalloc(b->test, sizeof(*f), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, f);
	ec_file_init(f, b->m, true);
	return f;
}

static int hold(struct ec_file *f, u32 flags, const char *name)
{
	struct ec_ioc_unit_hold h = { .flags = flags };
	int ret;

	strscpy(h.name, name, sizeof(h.name));
	ret = ec_ioc(f, EC_IOC_UNIT_HOLD, &h);
	return ret ?: (int)h.size;
}

static int holder_writes(struct ec_file *f, u32 unit, u32 value)
{
	u32 data[4] = { value, 0, value, 0 };
	struct ec_ioc_unit_data d = {
		.unit = unit, .size = sizeof(data), .data = (uintptr_t)data,
	};

	return ec_ioc(f, EC_IOC_UNIT_WRITE, &d);
}

/* One application has the cycle and unit 1, a second one unit 0; a third one none. */
static void unit_held(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 4), 2, 2);
	struct ec_file *f = other(c->b), *third = other(c->b);
	struct ec_ioc_unit_authority give = { .unit = 0, .authority = 1 }, take = { .unit = 0 };
	struct ec_ioc_unit_data d = { .unit = 0, .size = 16 };
	u32 data[4], i;

	units_put(c->b, 0, units_new(c->b, "a", EC_UNIT_POLICY_ZERO,
				     EC_UNIT_FLAG_AUTHORITY | EC_UNIT_FLAG_OFFERED));
	units_put(c->b, 1, units_new(c->b, "b", EC_UNIT_POLICY_ZERO, EC_UNIT_FLAG_AUTHORITY));
	KUNIT_EXPECT_EQ(test, hold(f, 0, "a"), -EINVAL);
	begin(c);
	KUNIT_EXPECT_EQ(test, hold(f, 0, "c"), -ENOENT);
	KUNIT_EXPECT_EQ(test, hold(f, 0, "b"), -EACCES);
	KUNIT_EXPECT_EQ(test, hold(&c->b->app, 0, "a"), -EPERM);
	KUNIT_EXPECT_EQ(test, holder_writes(f, 0, 1), -EPERM);
	KUNIT_EXPECT_EQ(test, hold(f, 0, "a"), 16);
	KUNIT_EXPECT_EQ(test, hold(f, 0, "a"), 16);
	KUNIT_EXPECT_EQ(test, hold(third, 0, "a"), -EBUSY);
	/* the cycle does not have it so far */
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_AUTHORITY, &give), -EINPROGRESS);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(third, EC_IOC_UNIT_AUTHORITY, &give), -EBUSY);
	KUNIT_EXPECT_EQ(test, holder_writes(third, 0, 1), -EPERM);
	KUNIT_EXPECT_EQ(test, holder_writes(f, 1, 1), -EPERM);
	KUNIT_EXPECT_EQ(test, holder_writes(f, 77, 1), -EPERM);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_AUTHORITY, &give), 0);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 1, 1), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	for (i = 1; i < 200; i++) {
		KUNIT_ASSERT_EQ(test, holder_writes(f, 0, 7 * i), 0);
		cyc_run(c, 1 + i % 3);
		KUNIT_ASSERT_EQ(test, units_out(c->b, 0), 7 * i);
		KUNIT_ASSERT_EQ(test, units_out(c->b, 1), i % 3 ? 7 * i : units_out(c->b, 1));
		expect_value(c, 2);
		expect_value(c, 3);
	}
	d.data = (uintptr_t)data;
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_READ, &d), 0);
	KUNIT_EXPECT_EQ(test, data[0], 7 * 199u);
	KUNIT_EXPECT_TRUE(test, d.state & EC_UNIT_HAS_HOLDER);
	d.size = 15;
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_READ, &d), -EINVAL);
	/* the first application, or any tool, takes the authority of the second one */
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 0), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	expect_value(c, 2);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_AUTHORITY, &give), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 7 * 199u);
	KUNIT_EXPECT_EQ(test, ec_ioc(third, EC_IOC_UNIT_AUTHORITY, &take), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_UNIT_AUTHORITY, &give), 0);
	cyc_run(c, 2);
	/* it dies */
	ec_session_leave_units(bus_sessions(c->b), f);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 1), 0u);
	expect_value(c, 3);
	/* the next one begins with zeros; or the first application has the unit again */
	KUNIT_EXPECT_EQ(test, hold(third, 0, "a"), 16);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, ec_ioc(third, EC_IOC_UNIT_AUTHORITY, &give), 0);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 0), 0u);
	KUNIT_EXPECT_EQ(test, hold(third, EC_UNIT_HOLD_END, "b"), -EPERM);
	KUNIT_EXPECT_EQ(test, hold(f, EC_UNIT_HOLD_END, "a"), -EPERM);
	KUNIT_EXPECT_EQ(test, hold(third, EC_UNIT_HOLD_END, "a"), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), 0);
	cyc_run(c, 2);
	expect_value(c, 0);
	KUNIT_EXPECT_EQ(test, hold(f, 0, "a"), -EBUSY);
	cyc_release(c);
	KUNIT_EXPECT_EQ(test, holder_writes(f, 0, 1), -EINVAL);
}

/* What was taken before or during a stop does not return with its end. */
static void unit_stop_gives_nothing(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 6), 3, 2);
	u32 i;

	units_put(c->b, 0, units_new(c->b, "a", EC_UNIT_POLICY_STOP, 0));
	units_put(c->b, 1, units_new(c->b, "b", EC_UNIT_POLICY_ZERO, 0));
	units_put(c->b, 2, units_new(c->b, "c", EC_UNIT_POLICY_ZERO, 0));
	begin(c);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 1, 0), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 2), 0u);
	units_dead(c->b, 0, true);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 4), 0u);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 2, 0), 0);
	/* the slave of another unit does not return with them */
	units_dead(c->b, 3, true);
	units_dead(c->b, 0, false);
	for (i = 0; i < 5000 && units_authority(c->b, 0, 1); i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, i, 5000u);
	cyc_run(c, 2);
	expect_value(c, 0);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 2), 0u);
	KUNIT_EXPECT_EQ(test, units_out(c->b, 4), 0u);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 1, 1), -EINPROGRESS);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 2, 1), 0);
	cyc_run(c, 2);
	expect_value(c, 4);
}

/* A slave that a tool has set to another state is not touched by another unit's policy. */
static void unit_leaves_states_of_others(struct kunit *test)
{
	struct cyc *c = two_units(test, EC_UNIT_POLICY_SAFEOP, EC_UNIT_POLICY_CONTINUE);

	begin(c);
	bus_request(c->b, 4, EC_AL_PREOP);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, al(c->b, 4), EC_AL_PREOP);
	units_dead(c->b, 0, true);
	cyc_run(c, 200);
	KUNIT_EXPECT_EQ(test, al(c->b, 1), EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, al(c->b, 4), EC_AL_PREOP);
}

/* Without a device units fail; what was given just before is void. */
static void unit_outage(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 2), 1, 2);

	units_put(c->b, 0, units_new(c->b, "a", EC_UNIT_POLICY_ZERO, EC_UNIT_FLAG_AUTHORITY));
	begin(c);
	KUNIT_EXPECT_EQ(test, units_authority(c->b, 0, 1), 0);
	ec_sim_link_destroy(c->b->link);
	c->b->link = NULL;
	c->b->sim = NULL;
	KUNIT_EXPECT_EQ(test, ec_ioc_receive(&c->b->app), -ENODEV);
	KUNIT_EXPECT_EQ(test, units_state(c->b, 0) & 0xffff,
			EC_UNIT_RUN_FAILED | EC_UNIT_SENDS_ZERO << 4);
}

static int create(struct bus *b, struct ec_ioc_unit u, const char *name)
{
	strscpy(u.name, name, sizeof(u.name));
	return ec_ioc(&b->app, EC_IOC_UNIT, &u);
}

static void unit_refused(struct kunit *test)
{
	struct cyc *c = units_app(units_bus(test, 2), 2, 1);
	struct ec_ioc_domain_unit d = { .domain = 0, .unit = 7 };
	struct ec_ioc_activate act = { 0 };
	struct ec_ioc_unit u = { .policy = 5 };
	u32 safe;

	KUNIT_EXPECT_EQ(test, create(c->b, u, "a"), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(c->b->app.reason, "policy"));
	u = (struct ec_ioc_unit){ .repeats = 4 };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "a"), -EINVAL);
	u = (struct ec_ioc_unit){ .limit = 1000001 };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "a"), -EINVAL);
	u = (struct ec_ioc_unit){ .flags = 0x80 };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "a"), -EOPNOTSUPP);
	u = (struct ec_ioc_unit){ .reserved2 = 1 };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "a"), -EOPNOTSUPP);
	u = (struct ec_ioc_unit){ };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "7"), -EINVAL);
	memset(u.name, 'a', sizeof(u.name));
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_UNIT, &u), -EINVAL);
	u = (struct ec_ioc_unit){ .lease_cycles = 5 };
	KUNIT_EXPECT_EQ(test, create(c->b, u, "lease"), 0);
	KUNIT_EXPECT_EQ(test, create(c->b, u, "lease"), 0);
	u.lease_cycles = 6;
	KUNIT_EXPECT_EQ(test, create(c->b, u, "lease"), -EEXIST);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_DOMAIN_UNIT, &d), -ENOENT);
	/* a lease without a cycle of the kernel */
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_ACTIVATE, &act), -EOPNOTSUPP);
	KUNIT_EXPECT_NOT_NULL(test, strstr(c->b->app.reason, "ecrt_master_set_cycle"));
	cyc_release(c);
	/* a slave in two units, one of which takes it to SAFEOP */
	c = units_app(c->b, 2, 1);
	safe = units_new(c->b, "safe", EC_UNIT_POLICY_SAFEOP, 0);
	units_put(c->b, 0, safe);
	units_put(c->b, 1, units_new(c->b, "other", EC_UNIT_POLICY_ZERO, 0));
	cyc_map(c, 0, 1, 1);
	if (bus_config(c->b, 0)->n_fmmus == 3)
		KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_ACTIVATE, &act), -EXDEV);
	else
		KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_ACTIVATE, &act), 0);
}

static struct kunit_case unit_cases[] = {
	KUNIT_CASE(unit_zero),
	KUNIT_CASE(unit_hold),
	KUNIT_CASE(unit_limit),
	KUNIT_CASE(unit_safeop),
	KUNIT_CASE(unit_stop),
	KUNIT_CASE(unit_authority),
	KUNIT_CASE(unit_repeats),
	KUNIT_CASE(unit_held),
	KUNIT_CASE(unit_stop_gives_nothing),
	KUNIT_CASE(unit_leaves_states_of_others),
	KUNIT_CASE(unit_outage),
	KUNIT_CASE(unit_refused),
	{ }
};

static struct kunit_suite unit_suite = {
	.name = "bus_units", .exit = bus_exit, .test_cases = unit_cases,
};
kunit_test_suite(unit_suite);
