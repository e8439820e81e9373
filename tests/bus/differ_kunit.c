// SPDX-License-Identifier: GPL-2.0-only
/* Configuration and reality: what the log and reasons say is missing, different or lost. */
#include <linux/kmsg_dump.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"

static const char tree[] =
	"segment seed=10 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave x EL1859 alias=7\nslave ao EL4002\nslave ai EL3062\n"
	"slave last EL1859\n";

#define N	5

static struct kmsg_dump_iter log;

static void log_begin(void)
{
	static char buf[512];
	size_t len;

	kmsg_dump_rewind(&log);
	while (kmsg_dump_get_line(&log, true, buf, sizeof(buf), &len))
		;
}

/* Lines of the kernel log since log_begin() that have @text in them. */
static u32 logged(const char *text)
{
	struct kmsg_dump_iter it = log;
	static char buf[512];
	size_t len;
	u32 n = 0;

	while (kmsg_dump_get_line(&it, true, buf, sizeof(buf) - 1, &len)) {
		buf[len] = 0;
		n += !!strstr(buf, text);
	}
	return n;
}

static const char *why(struct bus *b, u32 config)
{
	static struct ec_ioc_config_why w;

	memset(&w, 0, sizeof(w));
	w.index = config;
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	return w.text;
}

#define EXPECT_WHY(b, config, text) \
	KUNIT_EXPECT_NOT_NULL_MSG((b)->test, strstr(why(b, config), text), "%s", why(b, config))

static u32 expect_slave(struct cyc *c, u16 position, u32 vendor, u32 product)
{
	struct ec_ioc_slave_config sc = {
		.position = position, .vendor_id = vendor, .product_code = product,
	};

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	return sc.index;
}

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = cyc_in_op(bus_up(test, tree, N), 0, N);

	cyc_run(c, 100);
	return c;
}

/* One line per configuration without its slave, at activation; the list marks it. */
static void differ_logged_at_activation(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	struct ec_ioc_slave s = { .slave.position = 2 };
	struct cyc *c;
	u32 other;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	other = expect_slave(c, 2, 2, 0x12345678);
	expect_slave(c, 9, 2, 3);
	log_begin();
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, logged("configuration 0:"), 2u);
	KUNIT_EXPECT_EQ(test,
			logged("configuration 0:2: slave 2 is 0x00000002/0x0fa23052, configured is 0x00000002/0x12345678"), 1u);
	KUNIT_EXPECT_EQ(test,
			logged("configuration 0:9: no slave at ring position 9: 5 slave(s) connected"), 1u);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &s), 0);
	KUNIT_EXPECT_EQ(test, s.config, other + 1);
	KUNIT_EXPECT_EQ(test, s.differs, 1u);
	s.slave.position = 1;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &s), 0);
	KUNIT_EXPECT_EQ(test, s.config, 2u);
	KUNIT_EXPECT_EQ(test, s.differs, 0u);
	s.slave.position = 4;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &s), 0);
	KUNIT_EXPECT_EQ(test, s.config, 0u);
}

/* Very many of them do not fill the log. */
static void differ_log_is_limited(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	for (i = 0; i < 200; i++)
		expect_slave(c, 100 + i, 2, 3);
	log_begin();
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, logged("configuration 0:"), 32u);
	KUNIT_EXPECT_EQ(test, logged("168 more configurations differ"), 1u);
}

/* Another revision than expected is reported and marked, the slave is used. */
static void differ_revision(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	struct ec_ioc_sc_flag f = { .key = EC_FLAG_REVISION, .value = 0x4711 };
	struct ec_ioc_slave s = { .slave.position = 1 };
	struct ec_ioc_slave_why w = { .slave.position = 1 };
	struct cyc *c;
	char want[80];

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	f.config = 1;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &f), 0);
	log_begin();
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, logged("EtherCAT 0-1: revision 0x"), 1u);
	KUNIT_EXPECT_EQ(test, logged(", expected 0x00004711"), 1u);
	KUNIT_EXPECT_EQ(test, logged("configuration 0:"), 0u);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &s), 0);
	KUNIT_EXPECT_EQ(test, s.differs, 1u);
	scnprintf(want, sizeof(want), "slave 1 has revision 0x%08x, expected 0x00004711",
		  bus_slave(b, 1)->info.revision);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &w), 0);
	KUNIT_EXPECT_STREQ(test, w.warning, want);
}

/* A reason says what the slave is waiting for. */
static void differ_wait_has_reason(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	u32 i, outputs = 0, state = 0;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 10000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	for (i = 0; i < 100; i++) {
		cyc_run(c, 1);
		outputs += !!strstr(why(b, 2), "waiting for two cycles of its domains");
		state += !!strstr(why(b, 2), "waiting for the slave to");
	}
	KUNIT_EXPECT_GT(test, outputs, 0u);
	KUNIT_EXPECT_GT(test, state, 0u);
	KUNIT_EXPECT_STREQ(test, why(b, 2), "");
}

/* Cut in the middle: each lost slave is named, where it was, and when it is back. */
static void lost_slaves_are_named(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u32 i;

	log_begin();
	bus_fault(b, EC_SIM_FAULT_CUT, 2, 1, 0, 0);
	cyc_run(c, 2500);
	KUNIT_EXPECT_EQ(test, logged("disconnected"), 1u);
	KUNIT_EXPECT_EQ(test,
			logged("behind port 1 of slave 2 (EL4002): 2 slaves disconnected, 3 (EL3062) to 4 (EL1859), last seen "), 1u);
	EXPECT_WHY(b, 3,
		   "slave 3 (EL3062) disconnected from port 1 of slave 2 (EL4002), last seen 2 s ago");
	EXPECT_WHY(b, 4,
		   "slave 4 (EL1859) disconnected with slave 3 (EL3062) from port 1 of slave 2 (EL4002), last seen 2 s ago");
	bus_fault(b, EC_SIM_FAULT_HEAL, 2, 1, 0, 0);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	/* neighbours are told together, a second later at most */
	for (i = 0; i < 1100 && !logged("back in OP"); i++)
		cyc_run(c, 1);
	/* 2500 ms, the time of a stable link, and the way to OP */
	KUNIT_EXPECT_EQ(test, logged("slaves 3 to 4: back in OP, 28") +
			      logged("slaves 3 to 4: back in OP, 29"), 1u);
	KUNIT_EXPECT_EQ(test, logged("back in OP"), 1u);
	KUNIT_EXPECT_STREQ(test, why(b, 3), "");
}

/* One in the middle goes: the reason names it, not the neighbour that moved up. */
static void lost_slave_keeps_its_name(struct kunit *test)
{
	struct bus *b = bus_up(test,
		"segment seed=41 response=100us transition=1ms\n"
		"slave hub EK1100\nslave leaf io in=8 out=8 alias=9\n"
		"branch hub 2\nslave s1 io in=8 out=8\nslave s2 io in=8 out=8\n", 4);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 3, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	cyc_run(c, 1000);
	EXPECT_WHY(b, 0, "slave 1 (alias 9, io) disconnected from port 1 of slave 0 (EK1100)");
	KUNIT_EXPECT_STREQ(test, why(b, 1), "");
}

/* No link, no device: that is the reason. */
static void lost_link_is_said(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;

	log_begin();
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, logged("disconnected"), 1u);
	KUNIT_EXPECT_EQ(test, logged("all 5 slave(s) disconnected, last seen "), 1u);
	EXPECT_WHY(b, 3, "link down: check the cable");
}

static void lost_device_is_said(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;

	ec_sim_link_destroy(b->link);
	b->link = NULL;
	b->sim = NULL;
	msleep(300);
	EXPECT_WHY(b, 3, "no network device: master 0 waits for bus0");
}

/* Who shows a configuration does not walk all slaves for its alias: it is known. */
static void differ_alias_is_found_by_scan(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	struct ec_ioc_slave_config sc = { .alias = 7, .position = 9, .vendor_id = 1 };
	struct ec_config *c;
	u32 none;

	bus_idle(b);
	cyc_new(b, 1000);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	c = bus_config(b, sc.index);
	KUNIT_EXPECT_EQ(test, c->alias_at, 1u);
	EXPECT_WHY(b, sc.index, "no slave at ring position 10");
	sc.alias = 8;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	none = sc.index;
	EXPECT_WHY(b, none, "has alias 8");
	/* what was found before the slaves changed is not taken for it */
	bus_config(b, none)->alias_at = 1;
	EXPECT_WHY(b, none, "has alias 8");
}

static struct kunit_case differ_cases[] = {
	KUNIT_CASE(differ_alias_is_found_by_scan),
	KUNIT_CASE(differ_logged_at_activation),
	KUNIT_CASE(differ_log_is_limited),
	KUNIT_CASE(differ_revision),
	KUNIT_CASE(differ_wait_has_reason),
	KUNIT_CASE(lost_slaves_are_named),
	KUNIT_CASE(lost_slave_keeps_its_name),
	KUNIT_CASE(lost_link_is_said),
	KUNIT_CASE(lost_device_is_said),
	{}
};

static struct kunit_suite differ_suite = {
	.name = "bus_differ",
	.exit = bus_exit,
	.test_cases = differ_cases,
};

kunit_test_suite(differ_suite);

MODULE_LICENSE("GPL");
