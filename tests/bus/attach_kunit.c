// SPDX-License-Identifier: GPL-2.0-only
/* Which slave a configuration belongs to when positions in the ring change. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

/* a slave on a branch stands before three of the same kind */
static const char tree[] =
	"segment seed=41 response=100us transition=1ms\n"
	"slave hub EK1100\nslave leaf io in=512 out=512\n"
	"branch hub 2\nrepeat 3 slave s io in=512 out=512 cpu=yes\n"
	"connect leaf.1 -> leaf.1\nconnect s1.1 -> s1.1\nconnect s2.1 -> s2.1\n"
	"connect s3.1 -> s3.1\n";

#define N	5
#define LEAF	1

static s64 output(struct cyc *c, const char *name)
{
	return ec_app_channel(bus_app(c->b, name), EC_APP_OUT, 0);
}

static struct cyc *configure(struct kunit *test)
{
	struct bus *b = bus_up(test, tree, N);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, N - 1, 0);
	return c;
}

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = configure(test);
	u32 i;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	for (i = 1; i < N; i++)
		*cyc_pd(c, i, 0) = 10 * i;
	cyc_run(c, 20);
	KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_ASSERT_EQ(test, output(c, "leaf"), 10ll);
	KUNIT_ASSERT_EQ(test, output(c, "s1"), 20ll);
	return c;
}

static void why(struct cyc *c, u32 config, char *text)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_CONFIG_WHY, &w), 0);
	strscpy(text, w.text, sizeof(w.text));
}

/* The others keep their outputs although each stands where another did. */
static void attach_one_pulled(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	struct ec_slave *s1 = bus_slave(b, 2);
	char text[EC_UAPI_REASON];
	u32 i, not_op = 0;

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, LEAF, 0, 0, 0);
	for (i = 0; i < 1000; i++) {
		cyc_run(c, 1);
		not_op += (READ_ONCE(s1->al.status) & 0xf) != EC_AL_OP;
	}
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N - 1);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 1), s1);
	KUNIT_EXPECT_EQ(test, not_op, 0u);
	for (i = 1; i < N - 1; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->al.status, EC_AL_OP);
	KUNIT_EXPECT_EQ(test, output(c, "s1"), 20ll);
	KUNIT_EXPECT_EQ(test, output(c, "s2"), 30ll);
	KUNIT_EXPECT_EQ(test, output(c, "s3"), 40ll);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, 4, 1), 40);
	why(c, 0, text);
	KUNIT_EXPECT_NOT_NULL_MSG(test,
				  strstr(text,
					 "slave 1 (io) disconnected from port 1 of slave 0"), "%s", text);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, LEAF, 0, 0, 0);
	cyc_run(c, 2000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, output(c, "leaf"), 10ll);
	KUNIT_EXPECT_EQ(test, output(c, "s1"), 20ll);
}

/* So does one that has refused a state before: it is the same. */
static void attach_failed_one(struct kunit *test)
{
	struct cyc *c = configure(test);
	struct bus *b = c->b;
	struct ec_slave *s1 = bus_slave(b, 2);

	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, 2, 0, EC_AL_OP, 0x001e);
	cyc_activate(c);
	*cyc_pd(c, LEAF, 0) = 10;
	cyc_run(c, 2000);
	KUNIT_ASSERT_EQ(test, (u32) s1->note.error, (u32)EC_SLAVE_CONFIG_FAILED);
	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, 2, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, LEAF, 0, 0, 0);
	cyc_run(c, 1000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N - 1);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 1), s1);
	KUNIT_ASSERT_NOT_NULL(test, ec_setup_of(s1)->config);
	KUNIT_EXPECT_EQ(test, ec_setup_of(s1)->config->position, 2u);
	KUNIT_EXPECT_NE(test, output(c, "s1"), 10ll);
}

/* The next application finds slaves by the positions of now. */
static void attach_next_application(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, LEAF, 0, 0, 0);
	cyc_run(c, 500);
	cyc_release(c);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, N - 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	for (i = 1; i < N - 1; i++)
		*cyc_pd(c, i, 0) = 50 + i;
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, output(c, "s1"), 51ll);
	KUNIT_EXPECT_EQ(test, output(c, "s3"), 53ll);
}

/* one behind port 1 of the hub precedes its twins behind port 2; none has a serial number */
static const char twins[] =
	"segment seed=41 response=100us transition=1ms\n"
	"slave hub EK1100\nslave a io in=512 out=512 cpu=yes alias=5\n"
	"branch hub 2\nslave b io in=512 out=512 cpu=yes alias=5\n"
	"slave x io in=512 out=512 cpu=yes\n"
	"connect a.1 -> a.1\nconnect b.1 -> b.1\nconnect x.1 -> x.1\n";

enum { HUB, A, B, X };

/* Configurations of the slave with the alias and, with @both, of the one at position 2. */
static struct cyc *twins_in_op(struct kunit *test, bool both)
{
	struct bus *b = bus_up(test, twins, 4);
	struct ec_slave *s = bus_slave(b, A);
	struct ec_ioc_slave_config sc = {
		.alias = 5, .vendor_id = s->info.vendor, .product_code = s->info.product,
	};
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	cyc_map(c, sc.index, 0, 0);
	if (both)
		cyc_map(c, cyc_config(c, B), 0, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_data(c, 0)[0] = 10;
	if (both)
		*cyc_pd(c, B, 0) = 20;
	cyc_run(c, 20);
	KUNIT_ASSERT_EQ(test, output(c, "a"), 10ll);
	KUNIT_ASSERT_EQ(test, output(c, "b"), both ? 20ll : 0ll);
	return c;
}

/* The twin, which was there all the time, takes over neither by its alias nor by its position. */
static void attach_twin_keeps_off(struct kunit *test)
{
	u32 lines = bus_log_lines("configuration 5:0: alias 5 is not unique");
	struct cyc *c = twins_in_op(test, false);
	struct bus *b = c->b;
	char text[EC_UAPI_WARNING];

	KUNIT_EXPECT_EQ(test, bus_log_lines("configuration 5:0: alias 5 is not unique"), lines + 1);
	ec_slave_warning(bus_slave(b, B), text, sizeof(text));
	KUNIT_EXPECT_STREQ(test, text,
			   "alias 5 is not unique; configurations use slave 1, the first one");
	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 1, 0, 0);
	cyc_run(c, 1000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 3u);
	KUNIT_EXPECT_NULL(test, ec_setup_of(bus_slave(b, 1))->config);
	KUNIT_EXPECT_EQ(test, output(c, "b"), 0ll);
	bus_fault(b, EC_SIM_FAULT_HEAL, HUB, 1, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, output(c, "a"), 10ll);
	KUNIT_EXPECT_EQ(test, output(c, "b"), 0ll);
}

/* Both are cut off, the second one comes back first: by its station address it is itself. */
static void attach_same_device_elsewhere(struct kunit *test)
{
	struct cyc *c = twins_in_op(test, true);
	struct bus *b = c->b;

	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 1, 0, 0);
	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 2, 0, 0);
	cyc_run(c, 500);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 1u);
	bus_fault(b, EC_SIM_FAULT_HEAL, HUB, 2, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, output(c, "b"), 20ll);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_OP);
	bus_fault(b, EC_SIM_FAULT_HEAL, HUB, 1, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, output(c, "a"), 10ll);
	KUNIT_EXPECT_EQ(test, output(c, "b"), 20ll);
}

/* All were without power at once: position and alias decide, with one line in the log. */
static void attach_alike_by_place(struct kunit *test)
{
	u32 lines = bus_log_lines("of identical slaves that were disconnected"), i;
	struct cyc *c = twins_in_op(test, true);
	struct bus *b = c->b;

	for (i = A; i <= X; i++)
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, i, 0, 0, 0);
	cyc_run(c, 500);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 1u);
	for (i = A; i <= X; i++)
		bus_fault(b, EC_SIM_FAULT_POWER_ON, i, 0, 0, 0);
	cyc_run(c, 2000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, output(c, "a"), 10ll);
	KUNIT_EXPECT_EQ(test, output(c, "b"), 20ll);
	KUNIT_EXPECT_EQ(test, bus_log_lines("of identical slaves that were disconnected"),
			lines + 1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(attach_twin_keeps_off),
	KUNIT_CASE(attach_same_device_elsewhere),
	KUNIT_CASE(attach_alike_by_place),
	KUNIT_CASE(attach_one_pulled),
	KUNIT_CASE(attach_failed_one),
	KUNIT_CASE(attach_next_application),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_attach", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
