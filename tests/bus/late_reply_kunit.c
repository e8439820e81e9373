// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that reply to an SDO after its time limit, as drives that store parameters do. */
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/voe.h"
#include "master/wire/voe.h"

#define OBJECT	0x2001
#define SUB	8

static const char text[] =
	"segment seed=8 response=500us transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11 foe=256 voe=0x4321\n";

static struct bus *late_up(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 1);

	bus_idle(b);
	return b;
}

static void reply_after(struct bus *b, u32 ms)
{
	bus_app(b, "a")->response_ns = ms * NSEC_PER_MSEC;
}

static int put_value(struct bus *b, u32 value, const struct ec_mbox_limit *l)
{
	u32 abort;
	u8 v[4];

	put_unaligned_le32(value, v);
	return ec_coe_download(bus_mbox(b, 0), OBJECT, SUB, false, v, 4, &abort, l);
}

static u32 get_value(struct bus *b)
{
	size_t got;
	u32 abort;
	u8 v[4] = { 0 };

	KUNIT_EXPECT_EQ(b->test, ec_coe_upload(bus_mbox(b, 0), OBJECT, SUB, false, v, 4,
					       &got, &abort, NULL), 0);
	return get_unaligned_le32(v);
}

static u64 ms_since(u64 t0)
{
	return div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
}

/* 1 s was the limit; the reply to a configuration or a command comes in time within 5 s. */
static void late_reply_four_seconds_are_in_time(struct kunit *test)
{
	struct bus *b = late_up(test);

	reply_after(b, 4000);
	KUNIT_EXPECT_EQ(test, put_value(b, 0x1234, NULL), 0);
	reply_after(b, 0);
	KUNIT_EXPECT_EQ(test, get_value(b), 0x1234u);
}

/* The limit holds; the next request, with the default limit, begins when the slave has replied. */
static void late_reply_next_request_waits(struct kunit *test)
{
	const struct ec_mbox_limit l = { .timeout_ms = 300 };
	struct bus *b = late_up(test);
	u64 t0 = ktime_get_ns(), failed, next;

	reply_after(b, 3000);
	KUNIT_EXPECT_EQ(test, put_value(b, 0x55, &l), -ETIMEDOUT);
	failed = ms_since(t0);
	KUNIT_EXPECT_GE(test, failed, 300ull);
	KUNIT_EXPECT_LE(test, failed, 310ull);
	reply_after(b, 0);
	KUNIT_EXPECT_EQ(test, put_value(b, 0x66, NULL), 0);
	next = ms_since(t0);
	bus_figure("reply after 3000 ms, limit 300 ms: failed after %llu ms, next request done after %llu ms",
		   failed, next);
	KUNIT_EXPECT_GE(test, next, 3000ull);
	KUNIT_EXPECT_LE(test, next, 3100ull);
	KUNIT_EXPECT_EQ(test, get_value(b), 0x66u);
}

/* VoE beside it; and a request that must begin by a certain time ends then. */
static void late_reply_blocks_no_other_protocol(struct kunit *test)
{
	const struct ec_mbox_limit l = { .timeout_ms = 300 };
	struct bus *b = late_up(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_mbox_limit begin = { .timeout_ms = 300 };
	struct ec_voe_hdr h = { .vendor = 0x4711, .type = 1 };
	u64 t0;

	reply_after(b, 3000);
	KUNIT_EXPECT_EQ(test, put_value(b, 0x55, &l), -ETIMEDOUT);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, ec_voe_write(mb, &h, "hello", 5, NULL), 0);
	KUNIT_EXPECT_LE(test, ms_since(t0), 10ull);
	t0 = ktime_get_ns();
	begin.begin_ns = t0 + 200 * NSEC_PER_MSEC;
	KUNIT_EXPECT_EQ(test, put_value(b, 0x66, &begin), -ETIMEDOUT);
	KUNIT_EXPECT_LE(test, ms_since(t0), 210ull);
	reply_after(b, 0);
	msleep(4000);
	KUNIT_EXPECT_EQ(test, get_value(b), 0x55u);
}

/* No reply comes: a patient request waits 30 s for it, another its own limit, later ones not. */
static void late_reply_that_never_comes_ends_wait(struct kunit *test)
{
	const struct ec_mbox_limit l = { .timeout_ms = 300 }, patient = { .timeout_ms = 40000 };
	struct bus *b = late_up(test);
	u64 t0;

	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_LOST, 0);
	KUNIT_EXPECT_EQ(test, put_value(b, 1, &l), -ETIMEDOUT);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, put_value(b, 2, &l), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ms_since(t0), 600ull);
	KUNIT_EXPECT_LE(test, ms_since(t0), 700ull);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, put_value(b, 2, &patient), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ms_since(t0), 70000ull);
	KUNIT_EXPECT_LE(test, ms_since(t0), 70400ull);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, put_value(b, 3, &l), -ETIMEDOUT);
	KUNIT_EXPECT_LE(test, ms_since(t0), 400ull);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
	KUNIT_EXPECT_EQ(test, put_value(b, 4, &l), 0);
	KUNIT_EXPECT_EQ(test, get_value(b), 4u);
}

/* A startup SDO that the slave has accepted takes effect late; its own limit may be longer. */
static void late_reply_to_startup_sdo_is_taken(struct kunit *test)
{
	struct bus *b = late_up(test);
	struct cyc *c = cyc_new(b, 1000);
	u8 value[4] = { 1, 2, 3, 4 };
	struct ec_ioc_sc_timeout t = { .flags = EC_SC_TIMEOUT_REPLY, .timeout_ms = 1500 };
	struct ec_ioc_sc_sdo sdo = {
		.index = OBJECT, .subindex = SUB, .size = 4, .data = (uintptr_t)value,
	};
	u64 us;

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	t.timeout_ms = 60001;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_TIMEOUT, &t), -EINVAL);
	t.timeout_ms = 500;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_TIMEOUT, &t), 0);
	KUNIT_EXPECT_EQ(test, bus_mbox(b, 0)->reply_ms, 500u);
	reply_after(b, 2000);
	cyc_activate(c);
	us = cyc_wait_op(c, 60000);
	KUNIT_EXPECT_NE_MSG(test, us, ~0ull, "%s", bus_slave(b, 0)->note.why);
	bus_figure("startup SDO answered after 2000 ms, limit 500 ms: OP after %llu ms",
		   div_u64(us, 1000));
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_OK);
	reply_after(b, 0);
	cyc_release(c);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_mbox(b, 0)->reply_ms, 0u);
	KUNIT_EXPECT_EQ(test, get_value(b), 0x04030201u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(late_reply_four_seconds_are_in_time),
	KUNIT_CASE(late_reply_next_request_waits),
	KUNIT_CASE(late_reply_blocks_no_other_protocol),
	KUNIT_CASE(late_reply_that_never_comes_ends_wait),
	KUNIT_CASE(late_reply_to_startup_sdo_is_taken),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_late_reply", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
