// SPDX-License-Identifier: GPL-2.0-only
/* IP parameters of slaves with EoE: by the application, by the tool. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

static const struct ec_ip_params net = {
	.which = EC_IP_MAC | EC_IP_ADDRESS | EC_IP_MASK | EC_IP_HOSTNAME,
	.mac = { 2, 0, 0, 0xec, 1, 7 },
	.ip = { 192, 168, 0, 17 },
	.mask = { 255, 255, 255, 0 },
	.name = "switch",
};

static void config_ip(struct cyc *c, u32 config, const struct ec_ip_params *p)
{
	struct ec_ioc_sc_ip i = { .config = config, .params = *p };

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_IP, &i), 0, "%s",
			    c->b->app.reason);
}

static void eoe_configured(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave sw EL6614\n", 2);
	struct ec_app *sw = bus_app(b, "sw");
	struct ec_ip_params more = { .which = EC_IP_ADDRESS, .ip = { 10, 0, 0, 1 } };
	struct ec_ioc_sc_ip shown = { 0 };
	struct cyc *c = cyc_new(b, 1000);
	u32 sc;

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	sc = cyc_config(c, 1);
	config_ip(c, sc, &net);
	config_ip(c, sc, &more);	/* they add up, the last one counts */
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, sw->ip.sets, 1u);
	KUNIT_EXPECT_EQ(test, sw->ip.now.which, net.which);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.mac, net.mac, 6);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.ip, more.ip, 4);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.mask, net.mask, 4);
	KUNIT_EXPECT_STREQ(test, (char *)sw->ip.now.name, "switch");
	shown.config = sc;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_IP, &shown), 0);
	KUNIT_EXPECT_EQ(test, shown.params.which, net.which);
	KUNIT_EXPECT_MEMEQ(test, shown.params.ip, more.ip, 4);
	shown.config = 9;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_IP, &shown), -ENOENT);
}

/* After a power loss it gets them again. */
static void eoe_again_after_power_loss(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave sw EL6614\n", 2);
	struct ec_app *sw = bus_app(b, "sw");
	struct cyc *c = cyc_new(b, 1000);
	u32 i;

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	config_ip(c, cyc_config(c, 1), &net);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	cyc_run(c, 200);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	for (i = 0; i < 50 && sw->ip.sets < 2; i++)
		cyc_run(c, 100);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, sw->ip.sets, 2u);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.ip, net.ip, 4);
}

static void refused(struct kunit *test, const char *text, const char *why)
{
	struct bus *b = bus_up(test, text, 2);
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	config_ip(c, cyc_config(c, 1), &net);
	cyc_activate(c);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 1)->note.why, why);
}

static void eoe_refused(struct kunit *test)
{
	refused(test, "slave a drive in=8 out=8\nslave sw EL6614 ip=no\n",
		"IP parameters refused: EoE result 0x0201 (the slave does not support IP)");
}

static void eoe_without_eoe(struct kunit *test)
{
	refused(test, "slave a drive in=8 out=8\nslave b drive\n",
		"IP parameters configured, but the slave has no EoE; remove ecrt_slave_config_eoe_*()");
}

/* What "ethercat ip" does. */
static void eoe_parameters_set_by_tool(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave sw EL6614\nslave no EL6614 ip=no\nslave d drive\n", 3);
	struct ec_ioc_ip i = { .params = net };

	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_SET, &i), 0, "%s", b->app.reason);
	memset(&i, 0, sizeof(i));
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_GET, &i), 0, "%s", b->app.reason);
	KUNIT_EXPECT_MEMEQ(test, &i.params, &net, sizeof(net));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &(struct ec_ioc_ip){ 0 }), -EINVAL);
	i.slave.position = 1;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &i), -EIO);
	KUNIT_EXPECT_EQ(test, i.result, 0x0201);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "slave 1: IP parameters refused: EoE result 0x0201 (the slave does not support IP)");
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_GET, &i), -EIO);
	i.slave.position = 2;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &i), -EPROTONOSUPPORT);
	KUNIT_EXPECT_STREQ(test, b->app.reason, "IP parameters of slave 2: no EoE mailbox");
	i.slave.position = 3;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_GET, &i), -ENOENT);
	bus_request(b, 0, EC_AL_INIT);
	bus_idle(b);
	i.slave.position = 0;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_GET, &i), -EAGAIN);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eoe_configured),
	KUNIT_CASE(eoe_again_after_power_loss),
	KUNIT_CASE(eoe_refused),
	KUNIT_CASE(eoe_without_eoe),
	KUNIT_CASE(eoe_parameters_set_by_tool),
	{ }
};

static struct kunit_suite suite = { .name = "bus_eoe", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
