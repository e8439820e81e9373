// SPDX-License-Identifier: GPL-2.0-only
/* The list of return codes that applications in the kernel share with userspace. */
#include "kapp.h"

static struct kunit *test;

#define CODE(have, want) KUNIT_EXPECT_EQ(test, (s64)(have), (s64)(want))
#define MISSING(pointer) KUNIT_EXPECT_NULL(test, pointer)
#define CODES_NO_SLAVE (-ENOENT)
#include "codes.h"

static void kapi_codes_equal_userspace(struct kunit *t)
{
	struct bus *b = bus_up(t, "slave a drive in=8 out=8 mbox=128 soe=2\n"
			       "slave b io in=16 out=16\n", 2);
	ec_master_t *m;

	test = t;
	bus_idle(b);
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	codes_all(m, 0, 1);
	ecrt_release_master(m);
}

static void kapi_codes_kernel_cycle(struct kunit *t)
{
	struct bus *b = bus_up(t, "slave a io in=16 out=16\n", 1);
	struct kapp *k;

	test = t;
	bus_idle(b);
	k = kapp_new(b, 1000000);
	kapp_kernel_cycle(k, (ec_cycle_config_t){ });
	kapp_map(k, 0);
	kapp_activate(k);
	codes_cycle_runs(k->m, k->d);
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_codes_equal_userspace),
	KUNIT_CASE(kapi_codes_kernel_cycle),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_codes", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
