// SPDX-License-Identifier: GPL-2.0-only
/* A reboot takes the slaves out of OP, whatever bus and application do. */
#include <linux/kthread.h>
#include <linux/notifier.h>
#include <linux/reboot.h>
#include "kcyc.h"
#include "talk.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"
#include "master/link/device.h"
#include "master/power.h"

#define LIMIT_US	(4200 * USEC_PER_MSEC)	/* of the notifier and some scheduling */

/* what the kernel calls on its way down; bus time, us */
static u64 reboot(void)
{
	u64 t0 = ktime_get_ns();

	blocking_notifier_call_chain(&reboot_notifier_list, SYS_RESTART, NULL);
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

static u8 esc_state(struct bus *b, u32 index)
{
	return bus_esc(b, index)->mem[EC_REG_AL_STATUS] & EC_AL_STATE_MASK;
}

/* an application whose cycle the kernel runs, two slaves in OP */
static struct bus *active(struct kunit *test, struct kcyc **a)
{
	*a = kcyc_start(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });
	return (*a)->c->b;
}

/* the same with slaves that take 1 ms for a transition */
static struct bus *drives(struct kunit *test, struct kcyc **a)
{
	struct bus *b = bus_up(test, "segment transition=1ms\nslave a drive in=8 out=8\n"
			       "slave b drive in=8 out=8\n", 2);

	bus_idle(b);
	*a = kcyc_configure(b, (struct ec_ioc_cycle){ .stall_cycles = 0 });
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(*a), 0, "%s", b->app.reason);
	return b;
}

static struct bus *drives_in_op(struct kunit *test)
{
	struct kcyc *a;
	struct bus *b = drives(test, &a);

	kcyc_until_op(a);
	return b;
}

static void expect_states(struct bus *b, u8 first, u8 second)
{
	KUNIT_EXPECT_EQ(b->test, esc_state(b, 0), first);
	KUNIT_EXPECT_EQ(b->test, esc_state(b, 1), second);
}

static void reboot_application_active_slaves_in_preop(struct kunit *test)
{
	u32 lines = bus_log_lines("reboot: 2 slave(s) taken out of SAFEOP and OP"), i;
	struct kcyc *a;
	struct bus *b = active(test, &a);
	u64 us = reboot(), cycle = kcyc_status(a)->cycle;

	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	bus_figure("reboot: two slaves left OP after %llu us", us);
	KUNIT_EXPECT_LT(test, us, 200ull * USEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, bus_log_lines("reboot: 2 slave(s) taken out of SAFEOP and OP"),
			lines + 1);
	/* the cycle goes on, and nothing brings them back */
	for (i = 0; i < 1000; i++) {
		usleep_range(1000, 1001);
		KUNIT_ASSERT_EQ(test, esc_state(b, 0) | esc_state(b, 1), EC_AL_PREOP);
	}
	KUNIT_EXPECT_TRUE(test, bus_wanted(b)->active);
	KUNIT_EXPECT_GE(test, kcyc_status(a)->cycle, cycle + 900);
	KUNIT_EXPECT_EQ_MSG(test, bus_esc(b, 1)->mem[EC_REG_DL_LOOPS], 0, "ports open again");
}

/* The application has stopped: frames get out after the cycle timeout only. */
static void reboot_application_hangs_slaves_in_preop(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a io in=8 out=8\nslave b io in=8 out=8\n", 2);

	cyc_run(cyc_in_op(b, 0, 2), 20);
	KUNIT_EXPECT_LT(test, reboot(), 500ull * USEC_PER_MSEC);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
}

/* No command and no application brings a slave beyond PREOP afterwards. */
static void reboot_states_refused_afterwards(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a io in=8 out=8\nslave b io in=8 out=8\n", 2);
	struct cyc *c;
	u32 i;

	bus_idle(b);
	reboot();
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	cyc_activate(c);
	bus_request(b, 1, EC_AL_OP);
	for (i = 0; i < 500; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_FALSE(test, (esc_state(b, 0) | esc_state(b, 1)) & EC_AL_BEYOND_PREOP);
	}
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	cyc_run(c, 100);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
}

/* A slave that is on its way to OP does not get there. */
static void reboot_before_op_slaves_in_preop(struct kunit *test)
{
	static const char * const names[] = { "a", "b" };
	struct kcyc *a;
	struct bus *b = drives(test, &a);
	u32 i;

	for (i = 0; i < 2; i++)
		bus_app(b, names[i])->transition_ns = 40 * NSEC_PER_MSEC;
	while (!(esc_state(b, 0) & EC_AL_BEYOND_PREOP))
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_ASSERT_EQ(test, esc_state(b, 0), EC_AL_SAFEOP);
	KUNIT_EXPECT_LT(test, reboot(), 1000ull * USEC_PER_MSEC);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	for (i = 0; i < 500; i++) {
		usleep_range(1000, 1001);
		KUNIT_ASSERT_FALSE(test, (esc_state(b, 0) | esc_state(b, 1)) & EC_AL_BEYOND_PREOP);
	}
}

static void reboot_no_device_returns_at_once(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a io in=8 out=8\n");

	KUNIT_EXPECT_LT(test, reboot(), 50ull * USEC_PER_MSEC);
	/* a device without a slave that replies */
	bus_fault(b, EC_SIM_FAULT_DEAD, 0, 0, 1, 0);
	bus_plug(b);
	msleep(200);
	KUNIT_EXPECT_LT(test, reboot(), 50ull * USEC_PER_MSEC);
}

static void reboot_cable_off_is_logged(struct kunit *test)
{
	u32 lines = bus_log_lines("reboot: no link to 2 slave(s) in SAFEOP or OP");
	struct kcyc *a;
	struct bus *b = active(test, &a);

	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, bus_log_lines("reboot: no link to 2 slave(s) in SAFEOP or OP"),
			lines + 1);
}

/* It is the only one that stays, and the log names it. */
static void reboot_slave_mute_is_named(struct kunit *test)
{
	u32 lines = bus_log_lines("reboot: slave 1 does not reply, 1 slave(s) in all");
	struct kcyc *a;
	struct bus *b = active(test, &a);

	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, esc_state(b, 0), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_log_lines("reboot: slave 1 does not reply, 1 slave(s) in all"),
			lines + 1);
}

static void reboot_slave_slow_is_named(struct kunit *test)
{
	u32 lines = bus_log_lines("reboot: slave 1 stays in OP, 1 slave(s) in all");
	struct bus *b = drives_in_op(test);

	bus_app(b, "b")->transition_ns = 4000 * (u32)NSEC_PER_MSEC;
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, bus_log_lines("reboot: slave 1 stays in OP, 1 slave(s) in all"),
			lines + 1);
}

/* PREOP is refused, INIT is not. */
static void reboot_slave_refuses_preop_gets_init(struct kunit *test)
{
	struct bus *b = drives_in_op(test);

	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, 1, 0, EC_AL_PREOP, 0x0011);
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, esc_state(b, 1), EC_AL_INIT);
	KUNIT_EXPECT_FALSE(test, esc_state(b, 0) & EC_AL_BEYOND_PREOP);
}

static void reboot_scan_under_way_slaves_in_preop(struct kunit *test)
{
	struct kcyc *a;
	struct bus *b = active(test, &a);
	char *device = "bus0";
	unsigned int i;

	bus_rescan(b);
	usleep_range(300, 301);
	KUNIT_EXPECT_LT(test, reboot(), 500ull * USEC_PER_MSEC);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	msleep(500);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	bus_down(b);

	/* an earlier master has left them in OP, and they are not known yet */
	b = active(test, &a);
	ec_masters_destroy();
	KUNIT_ASSERT_EQ(test, esc_state(b, 1), EC_AL_OP);
	KUNIT_ASSERT_EQ(test, ec_masters_create(&device, 1, NULL, 0, 0), 0);
	b->m = ec_cdev_master(0);
	KUNIT_ASSERT_EQ(test, ec_device_use(bus_links(b), EC_MAIN, device), 0);
	for (i = 0; i < 100 && !bus_scan_busy(b); i++)
		usleep_range(500, 501);
	KUNIT_EXPECT_TRUE(test, bus_scan_busy(b));
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 0u);
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_FALSE(test, (esc_state(b, 0) | esc_state(b, 1)) & EC_AL_BEYOND_PREOP);
}

/* The device vanishes while the notifier waits. */
static int pull(void *data)
{
	struct bus *b = data;

	usleep_range(300, 301);
	ec_sim_link_destroy(b->link);
	b->link = NULL;
	b->sim = NULL;
	return 0;
}

static void reboot_device_vanishes_returns(struct kunit *test)
{
	struct kcyc *a;
	struct bus *b = active(test, &a);
	struct task_struct *t;

	bus_fault(b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	t = kthread_create(pull, b, "pull");
	KUNIT_ASSERT_FALSE(test, IS_ERR(t));
	get_task_struct(t);
	wake_up_process(t);
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	kthread_stop(t);
	put_task_struct(t);
	KUNIT_EXPECT_FALSE(test, ec_links_attached(bus_links(b)));
}

static int reboots(void *data)
{
	*(u64 *)data = reboot();
	return 0;
}

/* A second caller beside the first one, and rmmod beside both. */
static void reboot_twice_and_unload_beside(struct kunit *test)
{
	struct kcyc *a;
	struct bus *b = active(test, &a);
	struct task_struct *t[2];
	u64 us[2] = { 0, 0 };
	u32 i;

	for (i = 0; i < 2; i++) {
		t[i] = kthread_create(reboots, &us[i], "reboot%u", i);
		KUNIT_ASSERT_FALSE(test, IS_ERR(t[i]));
		get_task_struct(t[i]);
		wake_up_process(t[i]);
	}
	usleep_range(100, 101);
	/* what rmmod does; it waits for the notifiers */
	ec_power_exit();
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	bus_exit(test);
	for (i = 0; i < 2; i++) {
		kthread_stop(t[i]);
		put_task_struct(t[i]);
		KUNIT_EXPECT_GT(test, us[i], 0ull);
		KUNIT_EXPECT_LT(test, us[i], (u64)LIMIT_US);
	}
	KUNIT_EXPECT_EQ(test, ec_power_init(), 0);
}

/* One master has no device, the other one slaves in SAFEOP: one waits for no other. */
static void reboot_several_masters(struct kunit *test)
{
	static const char text[] = "slave a io in=8 out=8\nslave b io in=8 out=8\n";
	char *devices[2] = { "none", "bus0" };
	struct bus *b = kzalloc(sizeof(*b), GFP_KERNEL);
	struct ec_sim_error err = { 0 };

	KUNIT_ASSERT_NOT_NULL(test, b);
	b->test = test;
	test->priv = b;
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&b->sim, &ec_sim_kernel_ops, text, strlen(text),
					      NULL, &err), 0);
	KUNIT_ASSERT_EQ(test, ec_masters_create(devices, 2, NULL, 0, 0), 0);
	b->m = ec_cdev_master(1);
	ec_file_init(&b->app, b->m, true);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_request(b, 0, EC_AL_SAFEOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_SAFEOP, 1000), ~0ull);
	KUNIT_EXPECT_LT(test, reboot(), 100ull * USEC_PER_MSEC);
	expect_states(b, EC_AL_PREOP, EC_AL_PREOP);
	KUNIT_EXPECT_TRUE(test, ec_cdev_master(0)->bus.down);
}

/* a file on its way to the first slave, which has a page of 4 KiB */
struct writing {
	struct bus *b;
	struct talk *talk;
	struct task_struct *thread;
	bool cancel;
	u8 other;	/* state of the second slave, when it has ended */
};

static int write_file(void *data)
{
	struct writing *w = data;
	int ret = talk_put(w->talk, "firmware", TALK_MAX);

	w->other = esc_state(w->b, 1);
	return ret;
}

/* The first slave of @text gets a file in its @state, the second one is in SAFEOP. */
static struct writing *writing_begin(struct kunit *test, const char *text, u8 state)
{
	struct writing *w = kunit_kzalloc(test, sizeof(*w), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, w);
	w->b = bus_up(test, text, 2);
	bus_idle(w->b);
	w->talk = talk_new(w->b, 0, 1000);
	w->talk->limit.cancel = &w->cancel;
	talk_fill(w->talk, TALK_MAX);
	bus_request(w->b, 0, state);
	bus_request(w->b, 1, EC_AL_SAFEOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(w->b, 0, state, 2000), ~0ull);
	KUNIT_ASSERT_NE(test, bus_wait_al(w->b, 1, EC_AL_SAFEOP, 2000), ~0ull);
	w->thread = kthread_create(write_file, w, "writer");
	KUNIT_ASSERT_FALSE(test, IS_ERR(w->thread));
	get_task_struct(w->thread);
	wake_up_process(w->thread);
	msleep(500);
	return w;
}

static int writing_end(struct writing *w)
{
	int ret = kthread_stop(w->thread);

	put_task_struct(w->thread);
	return ret;
}

#define WAITS "reboot: waiting up to 30 s for the file that is written to slave 0, 1 slave(s) in all"

/* Its firmware is complete, and the other slave has not waited for that. */
static void expect_written(struct kunit *test, struct writing *w, u32 waits, u8 other)
{
	u64 us = reboot();

	bus_figure("reboot: firmware of four pages of 3 s awaited for %llu ms",
		   div_u64(us, USEC_PER_MSEC));
	KUNIT_EXPECT_GT(test, us, 8ull * USEC_PER_SEC);
	KUNIT_EXPECT_EQ(test, writing_end(w), 0);
	KUNIT_EXPECT_TRUE(test, bus_app(w->b, "a")->foe.valid);
	KUNIT_EXPECT_EQ(test, w->other, other);
	KUNIT_EXPECT_EQ(test, bus_log_lines(WAITS), waits + 1);
	/* nothing more to wait for */
	KUNIT_EXPECT_LT(test, reboot(), (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, bus_log_lines(WAITS), waits + 1);
}

#define FIRMWARE "slave a drive serial=5 mbox=128 foe=64 foe_page=3s foe_boot=yes\nslave b drive\n"

static void reboot_firmware_is_awaited(struct kunit *test)
{
	u32 waits = bus_log_lines(WAITS);
	struct writing *w = writing_begin(test, FIRMWARE, EC_AL_BOOT);

	expect_written(test, w, waits, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, esc_state(w->b, 0), EC_AL_BOOT);
}

/* A slave that needs INIT does not take it to the one with the file. */
static void reboot_firmware_beside_init_is_awaited(struct kunit *test)
{
	u32 waits = bus_log_lines(WAITS);
	struct writing *w = writing_begin(test, FIRMWARE, EC_AL_BOOT);

	bus_fault(w->b, EC_SIM_FAULT_REFUSE_AL, 1, 0, EC_AL_PREOP, 0x0011);
	expect_written(test, w, waits, EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, esc_state(w->b, 0), EC_AL_BOOT);
}

/* Its mailbox works in PREOP as well. */
static void reboot_file_in_safeop_is_awaited(struct kunit *test)
{
	u32 waits = bus_log_lines(WAITS);
	struct writing *w = writing_begin(test, "slave a drive serial=5 mbox=128 foe=64 foe_page=3s\n"
					  "slave b drive\n", EC_AL_SAFEOP);

	expect_written(test, w, waits, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, esc_state(w->b, 0), EC_AL_PREOP);
}

static void reboot_firmware_without_end_is_named(struct kunit *test)
{
	static const char named[] = "reboot: file of slave 0 not complete after 30 s, 1 slave(s) in all";
	u32 lines = bus_log_lines(named), early = bus_log_lines("FoE write of 'firmware' ended early");
	struct writing *w = writing_begin(test, "slave a drive serial=5 mbox=128 foe=64 foe_page=20s "
					  "foe_boot=yes\nslave b drive\n", EC_AL_BOOT);
	u64 us = reboot();

	KUNIT_EXPECT_GE(test, us, 30ull * USEC_PER_SEC);
	KUNIT_EXPECT_LT(test, us, 30ull * USEC_PER_SEC + LIMIT_US);
	KUNIT_EXPECT_EQ(test, bus_log_lines(named), lines + 1);
	expect_states(w->b, EC_AL_BOOT, EC_AL_PREOP);
	/* what ends the programs ends it before */
	WRITE_ONCE(w->cancel, true);
	KUNIT_EXPECT_EQ(test, writing_end(w), -ECANCELED);
	KUNIT_EXPECT_EQ(test, bus_log_lines("FoE write of 'firmware' ended early"), early + 1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(reboot_application_active_slaves_in_preop),
	KUNIT_CASE(reboot_application_hangs_slaves_in_preop),
	KUNIT_CASE(reboot_states_refused_afterwards),
	KUNIT_CASE(reboot_before_op_slaves_in_preop),
	KUNIT_CASE(reboot_no_device_returns_at_once),
	KUNIT_CASE(reboot_cable_off_is_logged),
	KUNIT_CASE(reboot_slave_mute_is_named),
	KUNIT_CASE(reboot_slave_slow_is_named),
	KUNIT_CASE(reboot_slave_refuses_preop_gets_init),
	KUNIT_CASE(reboot_scan_under_way_slaves_in_preop),
	KUNIT_CASE(reboot_device_vanishes_returns),
	KUNIT_CASE(reboot_twice_and_unload_beside),
	KUNIT_CASE(reboot_several_masters),
	KUNIT_CASE(reboot_firmware_is_awaited),
	KUNIT_CASE(reboot_firmware_beside_init_is_awaited),
	KUNIT_CASE(reboot_file_in_safeop_is_awaited),
	KUNIT_CASE(reboot_firmware_without_end_is_named),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_reboot", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
