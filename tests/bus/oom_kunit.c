// SPDX-License-Identifier: GPL-2.0-only
/*
 * One allocation after the other fails while the bus is scanned, an application runs or a mailbox
 * is used: what fails says -ENOMEM or is done again, and afterwards all is as it was.
 */
#include "cyc.h"
#include "oom_case.h"
#include "talk.h"
#include "master/mailbox/eoe.h"
#include "master/mailbox/soe.h"
#include "master/mailbox/voe.h"
#include "master/wire/voe.h"

#define MOST	2000	/* allocations of an operation */

static void say(struct kunit *test, const char *what, u32 n)
{
	bus_figure("%s with each of %u allocations failing", what, n - 1);
	KUNIT_EXPECT_GT_MSG(test, n, 5u, "%s allocates more", what);
	KUNIT_EXPECT_LT(test, n, (u32)MOST);
}

static void oom_scan(struct kunit *test)
{
	u32 logged = bus_log_lines("check the slave") + bus_log_lines("content invalid");
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	bool failed = true;
	u32 n, scans;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	for (n = 1; failed && n < MOST; n++) {
		scans = bus_scans(b);
		oom_fail(n);
		bus_rescan(b);
		while (bus_scans(b) == scans)
			usleep_range(1000, 1001);
		KUNIT_ASSERT_TRUE_MSG(test, oom_becomes_whole(b), "%u: %pS", n, (void *)oom_place);
		failed = oom_has_failed();
	}
	say(test, "a scan", n);
	KUNIT_EXPECT_EQ_MSG(test, bus_log_lines("check the slave") +
			    bus_log_lines("content invalid"), logged, "no slave is reported as faulty");
}

/* Cycles until all are in OP, and the end. */
static void run(struct kunit *test, struct cyc *c, bool kernel, u32 n)
{
	u32 ms;

	c->next = ktime_get();
	for (ms = 0; ms < 20000 && !cyc_all_op(c); ms++)
		if (kernel)
			usleep_range(1000, 1001);
		else
			cyc_run(c, 1);
	KUNIT_EXPECT_TRUE_MSG(test, cyc_all_op(c), "%u: %pS", n, (void *)oom_place);
}

static const bool by_kernel[] = { false, true };

static void by_desc(const bool *kernel, char *desc)
{
	strscpy(desc, *kernel ? "of_the_kernel" : "of_an_application", KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(by, by_kernel, by_desc);

static void oom_cycle(struct kunit *test)
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
		oom_fail(n);
		ret = oom_configure(b, &c, kernel);
		if (!ret)
			run(test, &c, kernel, n);
		failed = oom_has_failed();
		if (ret)
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS: %s", n, (void *)oom_place,
					    b->app.reason);
		KUNIT_ASSERT_TRUE(test, !ret || failed);
		bus_end(b);
		KUNIT_ASSERT_TRUE_MSG(test, oom_becomes_whole(b), "%u: %pS", n, (void *)oom_place);
		KUNIT_ASSERT_EQ_MSG(test, bus_memory(b), memory, "%u: %pS", n, (void *)oom_place);
	}
	say(test, kernel ? "a cycle of the kernel" : "a cycle", n);
}

static struct talk *talk;

static int upload(void)
{
	return talk_upload(talk, 0x2000, 0, false);
}

static int download(void)
{
	return talk_download(talk, 0x2000, 0, false, 1000);
}

static int list(void)
{
	return talk_info(talk, 1, 1, 0);
}

static int foe(void)
{
	return talk_put(talk, "file", 3000) ?: talk_get(talk, "file");
}

static int soe_read(void)
{
	u8 value[8];
	u16 error;

	return ec_soe_read(&talk->s->mbox, 0, 91, value, sizeof(value), &talk->got, &error, NULL);
}

static int soe_write(void)
{
	static const u8 value[4] = { 4000 & 0xff, 4000 >> 8 };
	u16 error;

	return ec_soe_write(&talk->s->mbox, 0, 91, value, sizeof(value), &error, NULL);
}

static int voe(void)
{
	struct ec_voe_hdr h = { .vendor = 0xec51, .type = 7 };
	struct ec_mbox_limit limit = { .timeout_ms = 100 };
	u8 data[64];

	return ec_voe_write(&talk->s->mbox, &h, "hello", 5, NULL) ?:
	       ec_voe_read(&talk->s->mbox, false, &h, data, sizeof(data), &talk->got, &limit);
}

static int eoe(void)
{
	struct ec_eoe_ip p = { .which = EC_EOE_IP, .ip = { 10, 0, 0, 1 } };
	u16 result;

	return ec_eoe_set_ip(&talk->s->mbox, &p, &result) ?:
	       ec_eoe_get_ip(&talk->s->mbox, &p, &result);
}

static const struct service {
	const char *name;
	int (*run)(void);
} services[] = {
	{ "upload", upload }, { "download", download }, { "list", list },
	{ "foe", foe }, { "soe_read", soe_read }, { "soe_write", soe_write }, { "voe", voe },
	{ "eoe", eoe },
};

static void service_desc(const struct service *s, char *desc)
{
	strscpy(desc, s->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(service, services, service_desc);

static void oom_mailbox(struct kunit *test)
{
	const struct service *s = test->param_value;
	struct bus *b = bus_up(test, oom_line, OOM_SLAVES);
	bool failed = true;
	u32 n;
	int ret;

	KUNIT_ASSERT_TRUE(test, oom_becomes_whole(b));
	talk = talk_new(b, s->run == eoe ? OOM_SWITCH : OOM_DRIVE, 1000);
	for (n = 1; failed && n < MOST; n++) {
		oom_fail(n);
		ret = s->run();
		failed = oom_has_failed();
		if (ret)
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS", n, (void *)oom_place);
		KUNIT_ASSERT_TRUE(test, !ret || failed);
		KUNIT_ASSERT_EQ_MSG(test, s->run(), 0, "%u: %pS", n, (void *)oom_place);
	}
	bus_figure("%s with each of %u allocations failing", s->name, n - 1);
	KUNIT_EXPECT_LT(test, n, (u32)MOST);
}

static struct kunit_case oom_cases[] = {
	KUNIT_CASE(oom_scan),
	KUNIT_CASE_PARAM(oom_cycle, by_gen_params),
	KUNIT_CASE_PARAM(oom_mailbox, service_gen_params),
	{}
};

static struct kunit_suite oom_suite = {
	.name = "bus_oom",
	.test_cases = oom_cases,
	.exit = oom_exit,
};

kunit_test_suite(oom_suite);
