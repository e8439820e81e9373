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
	/* the gap before the name is filled: there is no gateway and no DNS server */
	KUNIT_EXPECT_EQ(test, sw->ip.now.which, EC_IP_ALL);
	KUNIT_EXPECT_EQ(test, sw->ip.now.gateway[0] | sw->ip.now.dns[0], 0);
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
	struct ec_ip_params has = net;

	has.which = EC_IP_ALL;	/* the gateway and the DNS server 0.0.0.0 among them */
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_SET, &i), 0, "%s", b->app.reason);
	memset(&i, 0, sizeof(i));
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_GET, &i), 0, "%s", b->app.reason);
	KUNIT_EXPECT_MEMEQ(test, &i.params, &has, sizeof(has));
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

static const struct ec_ip_params address = {
	.which = EC_IP_ADDRESS | EC_IP_MASK | EC_IP_GATEWAY,
	.ip = { 10, 1, 2, 3 }, .mask = { 255, 0, 0, 0 }, .gateway = { 10, 0, 0, 1 },
};

static void expect_address(struct kunit *test, const struct ec_app *app)
{
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.ip, address.ip, 4);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.mask, address.mask, 4);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.gateway, address.gateway, 4);
}

/*
 * By the tool: an address without MAC address reaches a slave that reads fixed places, one that
 * reads the fields packed, and one that does not report what it has. They get a MAC address each.
 */
static void eoe_address_reaches_slaves_of_both_readings(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave f EL6614\nslave p EL6614 ip=packed\n"
				     "slave w EL6614 ip=write\n", 3);
	struct ec_eoe_ip now[3];
	unsigned int i;
	u64 begin;

	for (i = 0; i < 3; i++) {
		struct ec_app *app = bus_app(b, (const char *[]){ "f", "p", "w" }[i]);
		struct ec_ioc_ip c = { .slave.position = i, .params = address };

		begin = ktime_get_ns();
		KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0, "%s",
				    b->app.reason);
		KUNIT_EXPECT_LT(test, ktime_get_ns() - begin, 1000ull * NSEC_PER_MSEC);
		expect_address(test, app);
		now[i] = app->ip.now;
		KUNIT_EXPECT_EQ(test, now[i].which, address.which | EC_IP_MAC);
		KUNIT_EXPECT_EQ(test, now[i].mac[0] & 3, 2);
	}
	KUNIT_EXPECT_NE(test, memcmp(now[0].mac, now[1].mac, 6), 0);
	KUNIT_EXPECT_NE(test, memcmp(now[1].mac, now[2].mac, 6), 0);
}

/* What the slave has, the MAC address of the user among it, stays. */
static void eoe_packed_slave_keeps_other_parameters(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave p EL6614 ip=packed\n", 1);
	struct ec_ip_params more = { .which = EC_IP_ADDRESS | EC_IP_HOSTNAME, .ip = { 10, 9, 9, 9 },
				     .name = "gate" };
	struct ec_app *app = bus_app(b, "p");
	struct ec_ioc_ip c = { .params = net };

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0);
	c.params = address;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0);
	expect_address(test, app);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.mac, net.mac, 6);
	c.params = more;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.ip, more.ip, 4);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.mask, address.mask, 4);
	KUNIT_EXPECT_MEMEQ(test, app->ip.now.gateway, address.gateway, 4);
	KUNIT_EXPECT_STREQ(test, (char *)app->ip.now.name, "gate");
	memset(&c, 0, sizeof(c));
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_GET, &c), 0, "%s", b->app.reason);
	KUNIT_EXPECT_MEMEQ(test, c.params.ip, more.ip, 4);
}

/* Its address may be from DHCP, so that a name alone has a gap. Slaves of both readings get it. */
static void eoe_name_alone_is_packed_for_packed_slave(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave f EL6614\nslave p EL6614 ip=packed\n"
				     "slave w EL6614 ip=write\n", 3);
	struct ec_ip_params name = { .which = EC_IP_HOSTNAME | EC_IP_GATEWAY, .name = "gate",
				     .gateway = { 10, 2, 2, 2 } };
	struct ec_ioc_ip c;
	unsigned int i;

	for (i = 0; i < 3; i++) {
		struct ec_app *app = bus_app(b, (const char *[]){ "f", "p", "w" }[i]);

		c = (struct ec_ioc_ip){ .slave.position = i, .params = address };
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0);
		c.params = name;
		KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_IP_SET, &c), 0, "%s",
				    b->app.reason);
		KUNIT_EXPECT_STREQ(test, (char *)app->ip.now.name, "gate");
		KUNIT_EXPECT_MEMEQ(test, app->ip.now.gateway, name.gateway, 4);
		KUNIT_EXPECT_MEMEQ(test, app->ip.now.ip, address.ip, 4);
		KUNIT_EXPECT_EQ(test, app->ip.sets, i == 1 ? 3u : 2u);
	}
}

/* By an application: at the start, and again after a power loss. */
static void eoe_configured_packed(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave sw EL6614 ip=packed\n", 2);
	struct ec_app *sw = bus_app(b, "sw");
	struct cyc *c = cyc_new(b, 1000);
	u8 mac[6];
	u32 i;

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	config_ip(c, cyc_config(c, 1), &address);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	expect_address(test, sw);
	memcpy(mac, sw->ip.now.mac, 6);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	cyc_run(c, 200);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	for (i = 0; i < 50 && sw->ip.sets < 2; i++)
		cyc_run(c, 100);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, sw->ip.sets, 2u);
	expect_address(test, sw);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.mac, mac, 6);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eoe_configured),
	KUNIT_CASE(eoe_again_after_power_loss),
	KUNIT_CASE(eoe_refused),
	KUNIT_CASE(eoe_without_eoe),
	KUNIT_CASE(eoe_parameters_set_by_tool),
	KUNIT_CASE(eoe_address_reaches_slaves_of_both_readings),
	KUNIT_CASE(eoe_packed_slave_keeps_other_parameters),
	KUNIT_CASE(eoe_name_alone_is_packed_for_packed_slave),
	KUNIT_CASE(eoe_configured_packed),
	{ }
};

static struct kunit_suite suite = { .name = "bus_eoe", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
