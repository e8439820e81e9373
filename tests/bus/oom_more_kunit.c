// SPDX-License-Identifier: GPL-2.0-only
/*
 * More than one allocation fails: two of them by chance, or all from one on until memory is there
 * again. One fails while a master is created, an application in the kernel runs, a session is
 * taken over, or a reader of events begins.
 */
#include <linux/moduleparam.h>
#include <linux/prandom.h>
#include "kcyc.h"
#include "oom_case.h"
#include "include/ecrt.h"

#define MOST	2000	/* allocations of an operation */
#define SPAN	100	/* a cycle has some 100 */

static unsigned int pairs = 500;
module_param(pairs, uint, 0);
static unsigned long seed = 1;
module_param(seed, ulong, 0);

/* Cycles of @c until all slaves are in OP, or for @ms. */
static bool runs(struct cyc *c, bool kernel, u32 ms)
{
	c->next = ktime_get();
	for (; ms && !cyc_all_op(c); ms--)
		if (kernel)
			usleep_range(1000, 1001);
		else
			cyc_run(c, 1);
	return ms;
}

/* The session ends; the bus, and what is counted, is as before. */
static void ends(struct bus *b, long memory, u32 n, u32 m)
{
	bus_end(b);
	KUNIT_ASSERT_TRUE_MSG(b->test, oom_becomes_whole(b), "%u, %u: %pS", n, m,
			      (void *)oom_place);
	KUNIT_ASSERT_EQ_MSG(b->test, bus_memory(b), memory, "%u, %u: %pS", n, m, (void *)oom_place);
}

static void oom_two_allocations_fail(struct kunit *test)
{
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	struct cyc c = { .b = b, .period_ns = NSEC_PER_MSEC };
	u32 i, refused = 0, both = 0;
	struct rnd_state random;
	long memory;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	memory = bus_memory(b);
	prandom_seed_state(&random, seed);
	for (i = 0; i < pairs; i++) {
		u32 n = 1 + prandom_u32_state(&random) % SPAN;
		u32 m = 1 + prandom_u32_state(&random) % SPAN;
		bool kernel = prandom_u32_state(&random) & 1;
		unsigned long first;
		int ret;

		oom_fail_two(n, m);
		ret = oom_configure(b, &c, kernel);
		first = oom_place;
		if (!ret)
			KUNIT_ASSERT_TRUE_MSG(test, runs(&c, kernel, 20000), "%u, %u: %pS", n, m,
					      (void *)oom_place);
		else
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u, %u: %pS: %s", n, m,
					    (void *)oom_place, b->app.reason);
		KUNIT_ASSERT_TRUE(test, oom_has_failed() || !ret);
		refused += ret != 0;
		both += oom_place != first;
		ends(b, memory, n, m);
	}
	bus_figure("%u pairs of failing allocations, seed %lu: %u refused, %u failed later again",
		   pairs, seed, refused, both);
	KUNIT_EXPECT_GT(test, refused, 0u);
	KUNIT_EXPECT_GT(test, both, 0u);
}

static const bool by_kernel[] = { false, true };

static void by_desc(const bool *kernel, char *desc)
{
	strscpy(desc, *kernel ? "of_the_kernel" : "of_an_application", KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(by, by_kernel, by_desc);

/* From each allocation of a cycle on there is no memory for a second. */
static void oom_shortage_ends(struct kunit *test)
{
	bool kernel = *(const bool *)test->param_value, failed = true;
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	struct cyc c = { .b = b, .period_ns = NSEC_PER_MSEC };
	long memory;
	u32 n;
	int ret;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	memory = bus_memory(b);
	for (n = 1; failed && n < MOST; n++) {
		oom_fail_from(n);
		ret = oom_configure(b, &c, kernel);
		if (!ret)
			runs(&c, kernel, 1000);
		failed = oom_has_failed();
		if (ret)
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS: %s", n,
					    (void *)oom_place, b->app.reason);
		else
			KUNIT_ASSERT_TRUE_MSG(test, runs(&c, kernel, 20000), "%u: %pS", n,
					      (void *)oom_place);
		ends(b, memory, n, 0);
	}
	bus_figure("a cycle %s with a shortage from each of %u allocations on",
		   kernel ? "of the kernel" : "of an application", n - 1);
	KUNIT_EXPECT_GT(test, n, 20u);
}

static void oom_shortage_during_scan_ends(struct kunit *test)
{
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	u32 n, blamed = bus_log_lines("check the slave");
	bool failed = true;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	for (n = 1; failed && n < MOST; n++) {
		oom_fail_from(n);
		bus_rescan(b);
		msleep(200);
		failed = oom_has_failed();
		KUNIT_ASSERT_TRUE_MSG(test, oom_becomes_whole(b), "%u: %pS", n, (void *)oom_place);
	}
	bus_figure("a scan with a shortage from each of %u allocations on", n - 1);
	KUNIT_EXPECT_GT(test, n, 20u);
	KUNIT_EXPECT_EQ_MSG(test, bus_log_lines("check the slave"), blamed,
			    "no slave is reported as faulty");
}

/* A master is created or not, never half of one, and its end needs no memory. */
static void oom_load_is_whole_or_refused(struct kunit *test)
{
	char *device = "bus0";
	bool failed = true;
	u32 n;
	int ret;

	for (n = 1; failed && n < MOST; n++) {
		oom_fail(n);
		ret = ec_masters_create(&device, 1, NULL, 0, 0);
		failed = oom_has_failed();
		if (ret) {
			KUNIT_EXPECT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS", n, (void *)oom_place);
			KUNIT_ASSERT_TRUE(test, failed);
			KUNIT_ASSERT_EQ(test, ec_cdev_count(), 0u);
		} else {
			oom_fail_from(1);
			ec_masters_destroy();
			oom_has_failed();
		}
	}
	bus_figure("a master created with each of %u allocations failing", n - 1);
	KUNIT_EXPECT_GT(test, n, 5u);
	KUNIT_EXPECT_TRUE(test, oom_becomes_whole(bus_up(test, oom_line, OOM_SLAVES)));
}

/* Returns whether the application got as far as OP. */
static bool lives(struct bus *b)
{
	ec_master_t *m = ecrt_request_master(0);
	bool ok = false;
	ec_slave_info_t info;
	ec_slave_config_t *sc;
	ec_domain_t *d;

	if (IS_ERR_OR_NULL(m))
		return false;
	d = ecrt_master_create_domain(m);
	if (!d || ecrt_master_get_slave(m, OOM_DRIVE, &info))
		goto out;
	sc = ecrt_master_slave_config(m, 0, OOM_DRIVE, info.vendor_id, info.product_code);
	if (!sc || ecrt_slave_config_sdo32(sc, 0x2001, 8, 1) ||
	    !ecrt_slave_config_create_sdo_request(sc, 0x2000, 0, 100) ||
	    !ecrt_slave_config_create_voe_handler(sc, 64) ||
	    ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 0, d, NULL) < 0)
		goto out;
	ok = !ecrt_master_activate(m);
out:
	ecrt_release_master(m);
	return ok;
}

static void oom_application_in_kernel_is_refused_or_runs(struct kunit *test)
{
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	bool failed = true, ok;
	long memory;
	u32 n;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	memory = bus_memory(b);
	for (n = 1; failed && n < MOST; n++) {
		oom_fail(n);
		ok = lives(b);
		failed = oom_has_failed();
		KUNIT_ASSERT_TRUE_MSG(test, ok || failed, "%u", n);
		KUNIT_ASSERT_TRUE_MSG(test, oom_becomes_whole(b), "%u: %pS", n, (void *)oom_place);
		KUNIT_ASSERT_EQ(test, bus_memory(b), memory);
	}
	bus_figure("an application in the kernel with each of %u allocations failing", n - 1);
	KUNIT_EXPECT_GT(test, n, 10u);
}

static void oom_reader_of_events_is_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	struct ec_ioc_events arg = { .size = sizeof(struct ec_event) };
	struct ec_file f = { 0 };

	ec_file_init(&f, b->m, false);
	oom_fail(1);
	KUNIT_EXPECT_EQ(test, ec_ioc(&f, EC_IOC_EVENTS, &arg), -ENOMEM);
	KUNIT_EXPECT_TRUE(test, oom_has_failed());
	KUNIT_EXPECT_EQ(test, ec_ioc(&f, EC_IOC_EVENTS, &arg), 0);
	ec_reader_end(&f);
}

/* No memory to take over: the cycle that runs goes on, and the next one takes it over. */
static void oom_takeover_is_refused_or_done(struct kunit *test)
{
	static const struct ec_ioc_cycle hold = { .flags = EC_CYCLE_FLAG_DETACH };
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	bool failed = true;
	u64 cycle;
	u32 n;
	int ret;

	for (n = 1; failed && n < MOST; n++) {
		bus_end(b);
		cycle = kcyc_status(a)->cycle;
		a = kcyc_configure(b, hold);
		oom_fail(n);
		ret = kcyc_activate(a);
		failed = oom_has_failed();
		KUNIT_ASSERT_TRUE_MSG(test, !ret || (ret == -ENOMEM && failed), "%u: %d: %s", n,
				      ret, b->app.reason);
		if (ret) {
			bus_end(b);
			a = kcyc_configure(b, hold);
			KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
		}
		KUNIT_ASSERT_TRUE(test, a->taken_over);
		msleep(10);
		KUNIT_ASSERT_GE(test, kcyc_status(a)->cycle, cycle + 10);
		KUNIT_ASSERT_TRUE(test, cyc_all_op(a->c));
	}
	bus_figure("a takeover with each of %u allocations failing", n - 1);
}

static struct kunit_case oom_more_cases[] = {
	KUNIT_CASE(oom_two_allocations_fail),
	KUNIT_CASE_PARAM(oom_shortage_ends, by_gen_params),
	KUNIT_CASE(oom_shortage_during_scan_ends),
	KUNIT_CASE(oom_load_is_whole_or_refused),
	KUNIT_CASE(oom_application_in_kernel_is_refused_or_runs),
	KUNIT_CASE(oom_reader_of_events_is_refused),
	KUNIT_CASE(oom_takeover_is_refused_or_done),
	{}
};

static struct kunit_suite oom_more_suite = {
	.name = "bus_oom_more",
	.test_cases = oom_more_cases,
	.exit = oom_exit,
};

kunit_test_suite(oom_more_suite);
