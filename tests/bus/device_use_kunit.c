// SPDX-License-Identifier: GPL-2.0-only
/* A master gets another device while it is there. */
#include "bus.h"
#include "master/boundary/ioctl.h"
#include "master/link/device.h"

static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, 0x77 };

/* a second device, with as many slaves at the same addresses */
static struct ec_sim_link *other;

/* the master leaves the devices first */
static void two_exit(struct kunit *test)
{
	bus_exit(test);
	if (other)
		ec_sim_link_destroy(other);
	other = NULL;
}

static struct bus *two_up(struct kunit *test)
{
	static const char *text = "slave a EK1100\nslave b EL2008\nslave c EL2008\n";
	struct ec_sim_error err = { 0 };
	struct ec_sim *sim;
	struct bus *b;

	b = bus_up(test, "slave a EK1100\nslave b EL1008\nslave c EL1008\n", 3);
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&sim, &ec_sim_kernel_ops, text, strlen(text), NULL,
					      &err), 0);
	other = ec_sim_link_create("bus1", mac, sim, 0);
	KUNIT_ASSERT_FALSE(test, IS_ERR(other));
	return b;
}

static int use(struct bus *b, const char *name)
{
	struct ec_ioc_device_use i = { 0 };

	strscpy(i.name, name, sizeof(i.name));
	return ec_ioc(&b->app, EC_IOC_DEVICE_USE, &i);
}

static const char *reason(struct bus *b)
{
	return b->app.reason;
}

/* the same number of slaves at the same addresses, and none of the old ones */
static void device_use_other(struct kunit *test)
{
	struct bus *b = two_up(test);
	u32 product = bus_slave(b, 1)->info.product, i;

	bus_request(b, 1, EC_AL_SAFEOP);
	bus_wait_al(b, 1, EC_AL_SAFEOP, 1000);
	for (i = 0; i < 3; i++) {
		KUNIT_ASSERT_EQ_MSG(test, use(b, i & 1 ? "bus0" : "bus1"), 0, "%s", reason(b));
		/* it has waited for the scan */
		KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 3u);
		KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->info.product == product, (bool)(i & 1));
		KUNIT_EXPECT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
	}
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, "bus1");
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_GE(test, bus_log_lines("main device bus1 instead of bus0"), 1u);
}

static void device_use_same(struct kunit *test)
{
	struct bus *b = two_up(test);
	u32 scans = bus_scans(b);
	char name[32];

	snprintf(name, sizeof(name), "%pM", bus_dev(b)->mac);
	KUNIT_EXPECT_EQ(test, use(b, "bus0"), 0);
	KUNIT_EXPECT_EQ(test, use(b, name), 0);
	KUNIT_EXPECT_EQ(test, use(b, "ff:ff:ff:ff:ff:ff"), 0);
	KUNIT_EXPECT_STREQ(test, bus_links(b)->main, "ff:ff:ff:ff:ff:ff");
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 3u);
}

/* what cannot be used changes nothing */
static void device_use_absent(struct kunit *test)
{
	struct bus *b = two_up(test);
	u32 product = bus_slave(b, 1)->info.product;

	KUNIT_EXPECT_EQ(test, use(b, "eth7"), -ENODEV);
	KUNIT_EXPECT_NOT_NULL(test, strstr(reason(b), "master 0 keeps bus0"));
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, "bus0");
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->info.product, product);
}

static void device_use_bad_name(struct kunit *test)
{
	static const char * const bad[] = {
		"", ".", "..", "a/b", "a b", "01:00.0", "00:11:22:33:44", "01:00:00:00:00:00",
		"\033[2J\007:", "name_that_is_too_long", "0000:01:00.0x",
	};
	struct bus *b = two_up(test);
	struct ec_ioc_device_use i;
	u32 scans = bus_scans(b), k;

	for (k = 0; k < ARRAY_SIZE(bad); k++)
		KUNIT_EXPECT_EQ_MSG(test, use(b, bad[k]), -EINVAL, "%s", bad[k]);
	KUNIT_EXPECT_EQ(test, use(b, "\033[2J:"), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(reason(b), "\"\\e[2J:\" is neither"));
	/* no end */
	memset(&i, 'a', sizeof(i));
	i.flags = 0;
	i.reserved = 0;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEVICE_USE, &i), -EINVAL);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	KUNIT_EXPECT_STREQ(test, bus_links(b)->main, "bus0");
}

/* no application loses its slaves, and none reserves the master meanwhile */
static void device_use_reserved(struct kunit *test)
{
	struct bus *b = two_up(test);
	struct ec_sessions *ss = bus_sessions(b);
	struct ec_file second;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, use(b, "bus1"), -EBUSY);
	KUNIT_EXPECT_NOT_NULL(test, strstr(reason(b), "stop that application first"));
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, "bus0");
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);

	ec_file_init(&second, b->m, true);
	KUNIT_ASSERT_EQ(test, ec_sessions_pause(ss, "is about to use another device"), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&second, EC_IOC_RESERVE, NULL), -EBUSY);
	KUNIT_EXPECT_NOT_NULL(test, strstr(second.reason, "about to use another device"));
	KUNIT_EXPECT_EQ(test, use(b, "bus1"), -EBUSY);
	ec_sessions_resume(ss);
	KUNIT_EXPECT_EQ(test, ec_ioc(&second, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&second, EC_IOC_RELEASE, NULL), 0);
	KUNIT_EXPECT_EQ(test, use(b, "bus1"), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(device_use_other),
	KUNIT_CASE(device_use_same),
	KUNIT_CASE(device_use_absent),
	KUNIT_CASE(device_use_bad_name),
	KUNIT_CASE(device_use_reserved),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_device_use",
	.test_cases = cases,
	.exit = two_exit,
};
kunit_test_suite(suite);
