// SPDX-License-Identifier: GPL-2.0-only
/*
 * A suspend is refused while a master is in use; an idle master is silent until the computer
 * resumes. This kernel has no suspend, so the cases call what the notifier calls.
 */
#include <linux/kthread.h>
#include "kcyc.h"
#include "talk.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"
#include "master/power.h"
#include "master/session/reserve.h"

static const char two[] = "slave a io in=8 out=8\nslave b io in=8 out=8\n";

static struct bus *idle(struct kunit *test)
{
	struct bus *b = bus_up(test, two, 2);

	bus_idle(b);
	return b;
}

/* frames in 500 ms */
static u64 frames(struct bus *b)
{
	u64 n = bus_frames(b);

	msleep(500);
	return bus_frames(b) - n;
}

/* Another slave is at the place of the first one. */
static void exchange_slave(struct bus *b)
{
	put_unaligned_le32(0x4711, bus_esc(b, 0)->eep.data + 2 * EC_SII_W_PRODUCT);
}

static void suspend_idle_silent_then_rescan(struct kunit *test)
{
	struct bus *b = idle(test);
	u32 scans = bus_scans(b);
	struct ec_file other;

	KUNIT_EXPECT_GT(test, frames(b), 10ull);
	KUNIT_ASSERT_EQ(test, ec_power_sleep(), 0);
	KUNIT_EXPECT_EQ(test, frames(b), 0ull);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), -EBUSY);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "sleeps with the computer"), "%s",
				  b->app.reason);
	/* a wish of a tool wakes it neither */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), 0);
	KUNIT_EXPECT_EQ(test, frames(b), 0ull);
	exchange_slave(b);
	ec_power_resume();
	/* it waits for the scan */
	ec_file_init(&other, b->m, true);
	KUNIT_ASSERT_EQ(test, ec_ioc(&other, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_GT(test, bus_scans(b), scans);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 2u);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->info.product, 0x4711u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_RELEASE, NULL), 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
}

/* The card needs seconds for its link: all is scanned then. */
static void suspend_link_returns_late(struct kunit *test)
{
	struct bus *b = idle(test);

	KUNIT_ASSERT_EQ(test, ec_power_sleep(), 0);
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	exchange_slave(b);
	ec_power_resume();
	msleep(2000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 0u);
	bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->info.product, 0x4711u);
}

static void suspend_in_use_refused(struct kunit *test)
{
	u32 used = bus_log_lines("suspend refused: the master is in use by process");
	u32 detached = bus_log_lines("suspend refused: a detached session is active");
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.flags = EC_CYCLE_FLAG_DETACH, .stall_cycles = 10 });
	struct bus *b = a->c->b;
	u64 cycle = kcyc_status(a)->cycle;

	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_EQ(test, bus_log_lines("suspend refused: the master is in use by process"),
			used + 1);
	/* its application has exited */
	bus_end(b);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_EQ(test, bus_log_lines("suspend refused: a detached session is active"),
			detached + 1);
	msleep(200);
	KUNIT_EXPECT_GE(test, kcyc_status(a)->cycle, cycle + 190);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
	KUNIT_ASSERT_EQ(test, ec_session_end_detached(bus_sessions(b)), 0);
	/* reserved, but not active: its list of slaves must stay */
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), 0);
	ec_power_resume();
}

static void suspend_firmware_update_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive serial=5 mbox=128 foe=64 foe_boot=yes\n", 1);

	bus_idle(b);
	bus_request(b, 0, EC_AL_BOOT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_BOOT, 2000), ~0ull);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_GT(test, frames(b), 10ull);
	bus_request(b, 0, EC_AL_PREOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_PREOP, 2000), ~0ull);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), 0);
	ec_power_resume();
}

/* The scan ends first. */
static void suspend_scan_under_way_waits(struct kunit *test)
{
	struct bus *b = bus_new(test, two);

	bus_plug(b);
	usleep_range(2000, 2001);
	KUNIT_ASSERT_EQ(test, ec_power_sleep(), 0);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 2u);
	KUNIT_EXPECT_EQ(test, frames(b), 0ull);
	ec_power_resume();
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
}

/* What was not silent is not changed by a resume, and what is stays so. */
static void suspend_calls_without_pair(struct kunit *test)
{
	struct bus *b = idle(test);
	u32 scans = bus_scans(b);

	ec_power_resume();
	msleep(500);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	KUNIT_ASSERT_EQ(test, ec_power_sleep(), 0);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_EQ(test, frames(b), 0ull);
	ec_power_resume();
	ec_power_resume();
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	msleep(500);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans + 1);
}

/* The last of several masters is in use: the others go on. */
static void suspend_several_masters(struct kunit *test)
{
	char *devices[2] = { "bus0", "none" };
	struct bus *b = kzalloc(sizeof(*b), GFP_KERNEL);
	struct ec_sim_error err = { 0 };
	struct ec_sessions *ss;

	KUNIT_ASSERT_NOT_NULL(test, b);
	b->test = test;
	test->priv = b;
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&b->sim, &ec_sim_kernel_ops, two, strlen(two), NULL,
					      &err), 0);
	KUNIT_ASSERT_EQ(test, ec_masters_create(devices, 2, NULL, 0, 0), 0);
	b->m = ec_cdev_master(0);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	ss = &ec_cdev_master(1)->sessions;
	KUNIT_ASSERT_EQ(test, ec_sessions_pause(ss, "is about to use another device"), 0);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_GT(test, frames(b), 10ull);
	ec_sessions_resume(ss);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), 0);
	KUNIT_EXPECT_EQ(test, frames(b), 0ull);
	/* and rmmod does not wait for the resume */
	bus_exit(test);
}

static int write_file(void *talk)
{
	return talk_put(talk, "file", 10000);
}

static void suspend_file_write_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive serial=5 mbox=128 foe=64 foe_page=2s\n", 1);
	u32 lines = bus_log_lines("suspend refused: a file is written to slave 0");
	struct talk *t = talk_new(b, 0, 1000);
	u64 end = ktime_get_ns() + 10 * NSEC_PER_SEC;
	struct task_struct *thread;

	bus_idle(b);
	thread = kthread_create(write_file, t, "writer");
	KUNIT_ASSERT_FALSE(test, IS_ERR(thread));
	get_task_struct(thread);
	wake_up_process(thread);
	msleep(500);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), -EBUSY);
	KUNIT_EXPECT_EQ(test, bus_log_lines("suspend refused: a file is written to slave 0"),
			lines + 1);
	/* kthread_stop() would end it */
	while (!bus_app(b, "a")->foe.valid && (s64)(end - ktime_get_ns()) > 0)
		msleep(10);
	msleep(10);
	KUNIT_EXPECT_EQ(test, kthread_stop(thread), 0);
	put_task_struct(thread);
	KUNIT_EXPECT_EQ(test, ec_power_sleep(), 0);
	ec_power_resume();
}

static struct kunit_case cases[] = {
	KUNIT_CASE(suspend_idle_silent_then_rescan),
	KUNIT_CASE(suspend_link_returns_late),
	KUNIT_CASE(suspend_in_use_refused),
	KUNIT_CASE(suspend_firmware_update_refused),
	KUNIT_CASE(suspend_file_write_refused),
	KUNIT_CASE(suspend_scan_under_way_waits),
	KUNIT_CASE(suspend_calls_without_pair),
	KUNIT_CASE(suspend_several_masters),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_suspend", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
