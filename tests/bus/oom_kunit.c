// SPDX-License-Identifier: GPL-2.0-only
/*
 * One allocation after the other fails while the bus is scanned, an application runs or a mailbox
 * is used: what fails says -ENOMEM or is done again, and afterwards all is as it was.
 */
#include "cyc.h"
#include "oom.h"
#include "talk.h"
#include "master/boundary/ioctl.h"

#define N	3
#define DRIVE	1
#define MOST	2000	/* allocations of an operation */

static const char line[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave small drive mbox=64\nslave large drive mbox=512\nslave digital EL2008\n";

static atomic_t left;
static unsigned long place;

/* Asked before each allocation of the master. */
bool oom_fails(void)
{
	if (atomic_dec_if_positive(&left))
		return false;
	place = _RET_IP_;
	return true;
}

/* The @n-th allocation from now on fails. */
static void fail(u32 n)
{
	place = 0;
	atomic_set(&left, n);
}

/* No one fails any more. Returns whether one has. */
static bool has_failed(void)
{
	atomic_set(&left, 0);
	return place;
}

static void oom_exit(struct kunit *test)
{
	atomic_set(&left, 0);
	bus_exit(test);
}

static bool is_whole(struct bus *b)
{
	u32 i;

	if (b->m->bus.n_slaves != N || !bus_settled(b))
		return false;
	for (i = 0; i < N; i++) {
		const struct ec_slave *s = b->m->bus.slaves[i];

		if (s->al_status != EC_AL_PREOP || s->error || s->pdos_unread ||
		    ec_slave_pdos_pending(s) || s->warning[0])
			return false;
	}
	return true;
}

static bool becomes_whole(struct bus *b)
{
	u32 ms;

	for (ms = 0; ms < 20000 && !is_whole(b); ms++)
		usleep_range(1000, 1001);
	return ms < 20000;
}

static void say(struct kunit *test, const char *what, u32 n)
{
	bus_figure("%s with each of %u allocations failing", what, n - 1);
	KUNIT_EXPECT_GT_MSG(test, n, 5u, "%s allocates more", what);
	KUNIT_EXPECT_LT(test, n, (u32)MOST);
}

static void oom_scan(struct kunit *test)
{
	u32 logged = bus_log_lines("check the slave") + bus_log_lines("content invalid");
	struct bus *b = bus_up(test, line, N);
	bool failed = true;
	u32 n, scans;

	KUNIT_ASSERT_TRUE(test, becomes_whole(b));
	for (n = 1; failed && n < MOST; n++) {
		scans = b->m->bus.scan_count;
		fail(n);
		ec_bus_rescan(&b->m->bus);
		while (b->m->bus.scan_count == scans)
			usleep_range(1000, 1001);
		KUNIT_ASSERT_TRUE_MSG(test, becomes_whole(b), "%u: %pS", n, (void *)place);
		failed = has_failed();
	}
	say(test, "a scan", n);
	KUNIT_EXPECT_EQ_MSG(test, bus_log_lines("check the slave") +
			    bus_log_lines("content invalid"), logged, "no slave is reported as faulty");
}

/* an application, each step of which may fail */
static int configure(struct bus *b, struct cyc *c, bool kernel)
{
	struct ec_ioc_cycle by_kernel = { .period_ns = NSEC_PER_MSEC, .cpu = -1 };
	struct ec_ioc_sc_request request = { .config = DRIVE, .kind = EC_REQUEST_SDO, .size = 100 };
	struct ec_ioc_create_domain d = { 0 };
	struct ec_ioc_activate a = { 0 };
	u32 i, value = 1, sm;
	int ret = ec_ioc(&b->app, EC_IOC_RESERVE, NULL);

	if (!ret)
		ret = ec_ioc(&b->app, EC_IOC_CREATE_DOMAIN, &d);
	c->queued = BIT_ULL(0);
	for (i = 0; i < N && !ret; i++) {
		const struct ec_slave *s = bus_slave(b, i);
		struct ec_ioc_slave_config sc = {
			.position = i, .vendor_id = s->info.vendor,
			.product_code = s->info.product,
		};

		ret = ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc);
		for (sm = 0; sm < s->n_sms && !ret; sm++) {
			struct ec_ioc_reg_entry r = {
				.flags = EC_REG_ENTRY_BY_POS, .config = i, .sm = sm,
			};

			if (ec_pdo_list_bytes(&s->sm_pdos[sm]))
				ret = ec_ioc(&b->app, EC_IOC_REG_ENTRY, &r);
		}
	}
	if (!ret) {
		struct ec_ioc_sc_sdo sdo = {
			.config = DRIVE, .index = 0x2001, .subindex = 8, .size = sizeof(value),
			.data = (uintptr_t)&value,
		};

		ret = ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo);
	}
	if (!ret)
		ret = ec_ioc(&b->app, EC_IOC_SC_REQUEST, &request);
	if (!ret && kernel)
		ret = ec_ioc(&b->app, EC_IOC_CYCLE, &by_kernel);
	return ret ?: ec_ioc(&b->app, EC_IOC_ACTIVATE, &a);
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
	KUNIT_EXPECT_TRUE_MSG(test, cyc_all_op(c), "%u: %pS", n, (void *)place);
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
	struct bus *b = bus_up(test, line, N);
	struct cyc c = { .b = b, .period_ns = NSEC_PER_MSEC };
	long memory;
	u32 n;
	int ret;

	KUNIT_ASSERT_TRUE(test, becomes_whole(b));
	memory = atomic_long_read(&b->m->sessions.memory);
	for (n = 1; failed && n < MOST; n++) {
		fail(n);
		ret = configure(b, &c, kernel);
		if (!ret)
			run(test, &c, kernel, n);
		failed = has_failed();
		if (ret)
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS: %s", n, (void *)place,
					    b->app.reason);
		KUNIT_ASSERT_TRUE(test, !ret || failed);
		ec_session_end(&b->m->sessions, &b->app);
		KUNIT_ASSERT_TRUE_MSG(test, becomes_whole(b), "%u: %pS", n, (void *)place);
		KUNIT_ASSERT_EQ_MSG(test, atomic_long_read(&b->m->sessions.memory), memory,
				    "%u: %pS", n, (void *)place);
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

static const struct service {
	const char *name;
	int (*run)(void);
} services[] = {
	{ "upload", upload }, { "download", download }, { "list", list },
};

static void service_desc(const struct service *s, char *desc)
{
	strscpy(desc, s->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(service, services, service_desc);

static void oom_mailbox(struct kunit *test)
{
	const struct service *s = test->param_value;
	struct bus *b = bus_up(test, line, N);
	bool failed = true;
	u32 n;
	int ret;

	KUNIT_ASSERT_TRUE(test, becomes_whole(b));
	talk = talk_new(b, DRIVE, 1000);
	for (n = 1; failed && n < MOST; n++) {
		fail(n);
		ret = s->run();
		failed = has_failed();
		if (ret)
			KUNIT_ASSERT_EQ_MSG(test, ret, -ENOMEM, "%u: %pS", n, (void *)place);
		KUNIT_ASSERT_TRUE(test, !ret || failed);
		KUNIT_ASSERT_EQ_MSG(test, s->run(), 0, "%u: %pS", n, (void *)place);
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
