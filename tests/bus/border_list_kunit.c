// SPDX-License-Identifier: GPL-2.0-only
/* The list of devices that are kept behind closed ports, and the parameter for that. */
#include <linux/moduleparam.h>
#include "bus.h"
#include "master/bus/border.h"

/* The list is full: the entries of slaves that are not connected are given up, the oldest first. */
static void border_list_full_drops_absent(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=7\nslave hub EK1100\n"
			       "slave f drive in=8 out=8\n", 2);
	struct ec_bus *bus = bus_table(b);
	u64 hub = bus_slave(b, 0)->device;
	const struct ec_behind is = { .kept = EC_PORT_OTHER, .vendor = 1, .slaves = 1 };
	struct ec_behind got;
	u32 i;

	bus_idle(b);
	for (i = 0; i < 64; i++)
		KUNIT_EXPECT_TRUE(test, ec_border_note(bus, 1000 + i, 1, &is));
	KUNIT_EXPECT_EQ(test, ec_border_let_in(bus, 1001, 1, &is), 0);
	for (i = 0; i < 2; i++) {
		KUNIT_EXPECT_TRUE(test, ec_border_note(bus, hub, i, &is));
		KUNIT_EXPECT_TRUE(test, ec_border_get(bus, hub, i, &got));
	}
	KUNIT_EXPECT_FALSE(test, ec_border_get(bus, 1000, 1, &got));
	KUNIT_EXPECT_TRUE_MSG(test, ec_border_get(bus, 1001, 1, &got), "let in by a user");
	KUNIT_EXPECT_FALSE(test, ec_border_get(bus, 1002, 1, &got));
	KUNIT_EXPECT_TRUE(test, ec_border_get(bus, 1003, 1, &got));
	for (; i < 64; i++)
		KUNIT_EXPECT_TRUE(test, ec_border_note(bus, hub, i, &is));
	KUNIT_EXPECT_FALSE(test, ec_border_get(bus, 1001, 1, &got));
	/* all slaves are connected: what is listed stays */
	KUNIT_EXPECT_FALSE(test, ec_border_note(bus, hub, i, &is));
	KUNIT_EXPECT_FALSE(test, ec_border_get(bus, hub, i, &got));
	for (i = 0; i < 64; i++)
		KUNIT_EXPECT_TRUE(test, ec_border_get(bus, hub, i, &got));
	KUNIT_EXPECT_EQ(test, bus->border.n_found, 64u);
	ec_border_clear(&bus->border);
}

extern const struct kernel_param __start___param[], __stop___param[];

static const struct kernel_param *parameter(const char *name)
{
	const struct kernel_param *p;

	for (p = __start___param; p < __stop___param; p++)
		if (strlen(p->name) >= strlen(name) &&
		    !strcmp(p->name + strlen(p->name) - strlen(name), name))
			return p;
	return NULL;
}

/* The module parameter: words as documented, nothing else. */
static void border_parameter_parsed(struct kunit *test)
{
	static const struct {
		const char *value, *shown;
		enum ec_border_mode mode;
	} valid[] = {
		{ "closed", "closed\n", EC_BORDER_CLOSED },
		{ "open\n", "open\n", EC_BORDER_OPEN },
		{ "auto", "auto\n", EC_BORDER_AUTO },
	};
	static const char * const invalid[] = {
		"", "\n", "Closed", "close", "closed ", " closed", "closed,open", "open\n\n", "0", "1",
		"-1", "y",
	};
	const struct kernel_param *p = parameter(".border");
	char *shown = kunit_kzalloc(test, PAGE_SIZE, GFP_KERNEL);
	struct ec_border b = { 0 };
	u32 i, k;

	KUNIT_ASSERT_NOT_NULL(test, p);
	KUNIT_ASSERT_NOT_NULL(test, shown);
	for (i = 0; i < ARRAY_SIZE(valid); i++) {
		KUNIT_EXPECT_EQ(test, p->ops->set(valid[i].value, p), 0);
		for (k = 0; k < ARRAY_SIZE(invalid); k++)
			KUNIT_EXPECT_EQ_MSG(test, p->ops->set(invalid[k], p), -EINVAL, "'%s'",
					    invalid[k]);
		KUNIT_EXPECT_EQ(test, p->ops->get(shown, p), (int)strlen(valid[i].shown));
		KUNIT_EXPECT_STREQ(test, shown, valid[i].shown);
		ec_border_init(&b);
		KUNIT_EXPECT_EQ(test, b.mode, valid[i].mode);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(border_list_full_drops_absent),
	KUNIT_CASE(border_parameter_parsed),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_border_list", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
