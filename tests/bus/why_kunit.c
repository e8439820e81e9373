// SPDX-License-Identifier: GPL-2.0-only
/* Causes for programs: kind, place and code of why a slave is not in OP. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

static const char line[] =
	"segment seed=10 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave x EL1859 alias=7\nslave ao EL4002\nslave ai EL3062\n"
	"slave d drive in=8 out=8 mapping=fixed\n";

#define N	5
#define AI	3
#define D	4

static struct ec_cause why(struct bus *b, u32 config)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	return w.cause;
}

static struct ec_cause of_slave(struct bus *b, u16 position)
{
	struct ec_ioc_slave_why s = { .slave.position = position };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &s), 0);
	return s.cause;
}

static struct cyc *reserved(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	return c;
}

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = cyc_in_op(bus_up(test, line, N), 0, N);

	cyc_run(c, 100);
	return c;
}

static u32 expect(struct cyc *c, u16 alias, u16 position, u32 product)
{
	struct ec_ioc_slave_config sc = {
		.alias = alias, .position = position, .vendor_id = 2, .product_code = product,
	};

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	return sc.index;
}

static void why_op_has_no_cause(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u32 i;

	for (i = 0; i < N; i++) {
		KUNIT_EXPECT_EQ(test, why(c->b, i).kind, EC_CAUSE_NONE);
		KUNIT_EXPECT_EQ(test, of_slave(c->b, i).kind, EC_CAUSE_NONE);
	}
}

/* All slaves behind a break have its place; when that is lost as well, they have none. */
static void why_lost_has_place_of_break(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_CUT, 2, 1, 0, 0);
	cyc_run(c, 1000);
	for (i = AI; i < N; i++) {
		KUNIT_EXPECT_EQ(test, why(b, i).kind, EC_CAUSE_LOST);
		KUNIT_EXPECT_EQ(test, why(b, i).position, 2);
		KUNIT_EXPECT_EQ(test, why(b, i).port, 1);
	}
	KUNIT_EXPECT_EQ(test, why(b, 2).kind, EC_CAUSE_NONE);
	bus_fault(b, EC_SIM_FAULT_CUT, 0, 1, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, why(b, 1).position, 0);
	KUNIT_EXPECT_EQ(test, why(b, 2).position, 0);
	KUNIT_EXPECT_EQ(test, why(b, AI).kind, EC_CAUSE_LOST);
	KUNIT_EXPECT_EQ(test, why(b, AI).position, EC_UAPI_NONE16);
	bus_fault(b, EC_SIM_FAULT_HEAL, 0, 1, 0, 0);
	bus_fault(b, EC_SIM_FAULT_HEAL, 2, 1, 0, 0);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	KUNIT_EXPECT_EQ(test, why(b, AI).kind, EC_CAUSE_NONE);
}

static void why_link_down_at_main_device(struct kunit *test)
{
	struct cyc *c = in_op(test);

	bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, why(c->b, 2).kind, EC_CAUSE_LINK_DOWN);
	bus_fault(c->b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 10000), ~0ull);
}

static void why_silent_slave(struct kunit *test)
{
	struct cyc *c = in_op(test);

	bus_fault(c->b, EC_SIM_FAULT_DEAD, AI, 0, 1, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, why(c->b, AI).kind, EC_CAUSE_SILENT);
	KUNIT_EXPECT_EQ(test, of_slave(c->b, AI).kind, EC_CAUSE_SILENT);
	KUNIT_EXPECT_EQ(test, why(c->b, D).kind, EC_CAUSE_NONE);
}

static void why_absent_slaves(struct kunit *test)
{
	struct cyc *c = reserved(test);
	u32 other = expect(c, 0, 2, 0x12345678), end = expect(c, 0, 9, 3);
	u32 alias = expect(c, 77, 0, 3);

	cyc_map_all(c, 0, 2, 0);
	KUNIT_EXPECT_EQ(test, why(c->b, alias + 1).kind, EC_CAUSE_INACTIVE);
	cyc_activate(c);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, why(c->b, other).kind, EC_CAUSE_DIFFERENT);
	KUNIT_EXPECT_EQ(test, why(c->b, other).position, 2);
	KUNIT_EXPECT_EQ(test, why(c->b, end).kind, EC_CAUSE_NO_SLAVE);
	KUNIT_EXPECT_EQ(test, why(c->b, end).position, 9);
	KUNIT_EXPECT_EQ(test, why(c->b, alias).kind, EC_CAUSE_NO_ALIAS);
}

static void why_refused_state_has_code(struct kunit *test)
{
	struct cyc *c = reserved(test);
	struct ec_cause cause;

	cyc_map_all(c, 0, N, 0);
	bus_fault(c->b, EC_SIM_FAULT_REFUSE_AL, AI, 0, EC_AL_SAFEOP, 0x001e);
	cyc_activate(c);
	cyc_run(c, 500);
	cause = why(c->b, AI);
	KUNIT_EXPECT_EQ(test, cause.kind, EC_CAUSE_REFUSED);
	KUNIT_EXPECT_EQ(test, cause.state, EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, cause.code, 0x001e);
}

static void why_startup_sdo_has_object_and_abort(struct kunit *test)
{
	static const u8 value[4];
	struct cyc *c = reserved(test);
	struct ec_ioc_sc_sdo sdo = {
		.index = 0x5fff, .subindex = 3, .size = 4, .data = (uintptr_t)value,
	};
	struct ec_cause cause;

	cyc_map_all(c, 0, N, 0);
	sdo.config = D;
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_SDO, &sdo), 0);
	cyc_activate(c);
	cyc_run(c, 500);
	cause = why(c->b, D);
	KUNIT_EXPECT_EQ(test, cause.kind, EC_CAUSE_SDO);
	KUNIT_EXPECT_EQ(test, cause.object, 0x5fff);
	KUNIT_EXPECT_EQ(test, cause.subindex, 3);
	KUNIT_EXPECT_EQ(test, cause.code, 0x06020000u);
	KUNIT_EXPECT_EQ(test, of_slave(c->b, D).kind, EC_CAUSE_SDO);
	ec_ioc(&c->b->app, EC_IOC_DEACTIVATE, NULL);
	msleep(500);
	KUNIT_EXPECT_EQ(test, of_slave(c->b, D).kind, EC_CAUSE_NONE);
}

static void why_refused_pdos_have_sync_manager(struct kunit *test)
{
	struct cyc *c = reserved(test);
	struct ec_cause cause;
	u32 config;

	cyc_map_all(c, 0, D, 0);
	config = cyc_config(c, D);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 2, 0, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 2, 0x1600, 0);
	cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, 2, 0x1600, 0);
	cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, 2, 0x1600, 0x60ff0020);
	cyc_map(c, config, 2, 0);
	cyc_activate(c);
	cyc_run(c, 1000);
	cause = why(c->b, config);
	KUNIT_EXPECT_EQ(test, cause.kind, EC_CAUSE_PDO);
	KUNIT_EXPECT_EQ(test, cause.sm, 2);
	KUNIT_EXPECT_EQ(test, cause.object, 0x1600);
	KUNIT_EXPECT_EQ(test, cause.code >> 24, 6);
}

static void why_without_cycle(struct kunit *test)
{
	static struct ec_ioc_master m;
	struct cyc *c = in_op(test);

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_MASTER, &m), 0);
	KUNIT_EXPECT_EQ(test, m.no_cycle, 0u);
	msleep(500);
	KUNIT_EXPECT_EQ(test, why(c->b, D).kind, EC_CAUSE_NO_CYCLE);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_MASTER, &m), 0);
	KUNIT_EXPECT_EQ(test, m.no_cycle, 1u);
	cyc_run(c, 1);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
}

/* An application that has forgotten ecrt_master_send(): it takes the links again and again. */
static void why_receive_without_send(struct kunit *test)
{
	static struct ec_ioc_master m;
	struct cyc *c = in_op(test);
	u32 i, before = bus_timeouts(c->b);

	for (i = 0; i < 400; i++) {
		KUNIT_ASSERT_EQ(test, ec_ioc_receive(&c->b->app), 0);
		msleep(5);
		if (i < 40)
			continue;
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_MASTER, &m), 0);
		KUNIT_ASSERT_EQ_MSG(test, m.no_cycle, 1u, "receive %u", i);
	}
	KUNIT_EXPECT_EQ(test, bus_timeouts(c->b), before + 1);
	c->next = ktime_get();
	cyc_run(c, 1);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_MASTER, &m), 0);
	KUNIT_EXPECT_EQ(test, m.no_cycle, 0u);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
}

static u32 unsent(struct cyc *c, u32 domain)
{
	struct ec_ioc_domain d = { .index = domain };

	KUNIT_EXPECT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_DOMAIN, &d), 0);
	return d.unsent;
}

static void why_domain_never_sent(struct kunit *test)
{
	struct cyc *c = reserved(test);

	cyc_map(c, cyc_config(c, AI), 3, 0);
	cyc_map(c, cyc_config(c, D), 3, cyc_domain(c));
	cyc_activate(c);
	c->queued = BIT(0);
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, unsent(c, 0), 0u);
	KUNIT_EXPECT_EQ(test, unsent(c, 1), 300u);
	c->queued = BIT(1);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, unsent(c, 1), 0u);
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, unsent(c, 0), 0u);
}

static struct kunit_case why_cases[] = {
	KUNIT_CASE(why_op_has_no_cause),
	KUNIT_CASE(why_lost_has_place_of_break),
	KUNIT_CASE(why_link_down_at_main_device),
	KUNIT_CASE(why_silent_slave),
	KUNIT_CASE(why_absent_slaves),
	KUNIT_CASE(why_refused_state_has_code),
	KUNIT_CASE(why_startup_sdo_has_object_and_abort),
	KUNIT_CASE(why_refused_pdos_have_sync_manager),
	KUNIT_CASE(why_without_cycle),
	KUNIT_CASE(why_receive_without_send),
	KUNIT_CASE(why_domain_never_sent),
	{}
};

static struct kunit_suite why_suite = {
	.name = "bus_why",
	.exit = bus_exit,
	.test_cases = why_cases,
};

kunit_test_suite(why_suite);

MODULE_LICENSE("GPL");
