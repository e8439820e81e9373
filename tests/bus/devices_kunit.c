// SPDX-License-Identifier: GPL-2.0-only
/*
 * Slaves as devices of Linux: made behind the scan, removed at loss, with the attributes of their
 * slave, and with a limited number of uevents, which a socket counts as udev would.
 */
#include <linux/device.h>
#include <linux/kthread.h>
#include "bus.h"
#include "oom_case.h"
#include "uevents.h"
#include "master/boundary/slave_device.h"
#include "master/kernel/compat.h"

/* in the ring: the hub, what is at its port 1, what is at its port 2 */
static const char text[] =
	"segment seed=12 response=100us transition=1ms\n"
	"slave hub EK1100 alias=7\n"
	"slave n drive in=8 out=8 mbox=128 serial=21\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 mbox=128 serial=11\n"
	"slave c drive in=8 out=8 mbox=128\n";

/* of the segment; in the ring when all are there */
enum { HUB, NEW, A, C, N };

static struct class *class;
static struct device *master;
static struct uevents *u;

static int begin(struct kunit *test)
{
	u = uevents_new(test);
	class = ec_class_create("ec_test");
	KUNIT_ASSERT_FALSE(test, IS_ERR(class));
	master = device_create(class, NULL, 0, NULL, "EtherCAT0");
	KUNIT_ASSERT_FALSE(test, IS_ERR(master));
	/* it has a uevent itself */
	uevents_listen(u);
	u->n = 0;
	return 0;
}

/* Before the devices a master has in the module: here it has none. */
static void publish(struct bus *b)
{
	ec_slave_devices_start(bus_slave_devices(b), bus_table(b), master);
}

static void unpublish(struct bus *b)
{
	ec_slave_devices_stop(bus_slave_devices(b));
}

static void end(struct kunit *test)
{
	if (test->priv)
		unpublish(test->priv);
	bus_exit(test);
	device_unregister(master);
	class_destroy(class);
	uevents_free(u);
}

static int one_more(struct device *dev, void *n)
{
	(*(u32 *)n)++;
	return 0;
}

static u32 n_devices(void)
{
	u32 n = 0;

	/* all that hangs at a master is a slave */
	device_for_each_child(master, &n, one_more);
	return n;
}

static bool has_devices(struct kunit *test, u32 n)
{
	u32 ms;

	for (ms = 0; ms < 10000 && n_devices() != n; ms++)
		uevents_listen_ms(u, 1);
	uevents_listen_ms(u, 50);
	return n_devices() == n;
}

static int is_named(struct device *dev, void *name)
{
	return !strcmp(dev_name(dev), name);
}

/* Device of the slave at a position; a reference less than it seems, its master keeps it. */
static struct device *device_at(struct bus *b, u32 position)
{
	char name[32];
	struct device *dev;

	scnprintf(name, sizeof(name), "EtherCAT0-d%llu", bus_slave(b, position)->device);
	dev = device_find_child(master, name, (void *)is_named);
	KUNIT_ASSERT_NOT_NULL_MSG(b->test, dev, "%s", name);
	put_device(dev);
	return dev;
}

/* Content of an attribute, as a file has it. Return: length, or -errno. */
static ssize_t attribute(struct device *dev, const char *name, char *buf)
{
	struct attribute **a = dev->bus->dev_groups[0]->attrs;

	while (*a && strcmp((*a)->name, name))
		a++;
	return *a ? container_of(*a, struct device_attribute, attr)->show(dev, NULL, buf) : -ENOENT;
}

static void attribute_is(struct bus *b, u32 position, const char *name, const char *want)
{
	char *buf = (char *)get_zeroed_page(GFP_KERNEL);
	ssize_t ret = attribute(device_at(b, position), name, buf);

	KUNIT_EXPECT_GT_MSG(b->test, ret, (ssize_t)0, "%s of slave %u", name, position);
	KUNIT_EXPECT_STREQ_MSG(b->test, buf, want, "%s of slave %u", name, position);
	free_page((unsigned long)buf);
}

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_new(test, text);

	publish(b);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	KUNIT_ASSERT_TRUE(test, has_devices(test, N));
	return b;
}

static void fault(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u32 slaves)
{
	bus_fault(b, type, slave, port, 0, 0);
	KUNIT_ASSERT_NE(b->test, bus_wait(b, slaves, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	KUNIT_ASSERT_TRUE(b->test, has_devices(b->test, slaves));
}

static void devices_made_by_scan_have_attributes(struct kunit *test)
{
	struct bus *b = ready(test);
	const struct ec_slave *s;
	char want[40];
	u32 i;

	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'a', false), (u32)N);
	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'c', true), 0u);
	for (i = 0; i < N; i++) {
		s = bus_slave(b, i);
		KUNIT_EXPECT_PTR_EQ(test, device_at(b, i)->parent, master);
		scnprintf(want, sizeof(want), "0x%08x\n", s->info.vendor);
		attribute_is(b, i, "vendor", want);
		scnprintf(want, sizeof(want), "0x%08x\n", s->info.product);
		attribute_is(b, i, "product", want);
		scnprintf(want, sizeof(want), "0x%08x\n", s->info.revision);
		attribute_is(b, i, "revision", want);
		scnprintf(want, sizeof(want), "%u\n", i);
		attribute_is(b, i, "position", want);
		scnprintf(want, sizeof(want), "%llu\n", s->device);
		attribute_is(b, i, "device_number", want);
		scnprintf(want, sizeof(want), "ethercat:v%08Xp%08X", s->info.vendor,
			  s->info.product);
		KUNIT_EXPECT_STREQ(test, u->heard[i].modalias, want);
		KUNIT_EXPECT_STREQ(test, u->heard[i].name, dev_name(device_at(b, i)));
	}
	attribute_is(b, NEW, "serial", "0x00000015\n");
	attribute_is(b, C, "serial", "0x00000000\n");
	attribute_is(b, HUB, "alias", "7\n");
	attribute_is(b, A, "alias", "0\n");
	attribute_is(b, A, "al_state", "PREOP\n");
	bus_request(b, A, EC_AL_SAFEOP);
	bus_wait_al(b, A, EC_AL_SAFEOP, 1000);
	attribute_is(b, A, "al_state", "SAFEOP\n");
	WRITE_ONCE(bus_slave(b, A)->al.status, EC_AL_INIT | EC_AL_ERROR);
	attribute_is(b, A, "al_state", "INIT error\n");
}

/* All is read again, but the devices are the same, and nothing was heard of it. */
static void devices_stay_over_rescan(struct kunit *test)
{
	struct bus *b = ready(test);
	const struct ec_slave *old = ec_slave_ref(bus_slave(b, A));
	struct device *before[N];
	u32 i, ms, n = u->n, lists = bus_table(b)->lists;

	for (i = 0; i < N; i++)
		before[i] = get_device(device_at(b, i));
	ec_bus_rescan(bus_table(b));
	/* the work runs at any moment: it may have a uevent of the master to send */
	for (ms = 0; ms < 3000; ms++) {
		mod_delayed_work(system_unbound_wq, &bus_slave_devices(b)->work, 0);
		uevents_listen_ms(u, 1);
	}
	bus_idle(b);
	KUNIT_ASSERT_TRUE(test, has_devices(test, N));
	/* empty, then the new one */
	KUNIT_EXPECT_EQ(test, bus_table(b)->lists, lists + 2);
	KUNIT_EXPECT_PTR_NE(test, (const struct ec_slave *)bus_slave(b, A), old);
	KUNIT_EXPECT_EQ(test, u->n, n);
	for (i = 0; i < N; i++) {
		KUNIT_EXPECT_PTR_EQ(test, device_at(b, i), before[i]);
		put_device(before[i]);
	}
	attribute_is(b, A, "al_state", "PREOP\n");
	ec_slave_unref((struct ec_slave *)old);
}

static void devices_removed_at_loss_return_with_name(struct kunit *test)
{
	struct bus *b = ready(test);
	struct device *gone = get_device(device_at(b, NEW));
	char name[24], *buf = (char *)get_zeroed_page(GFP_KERNEL);
	u32 n = u->n;

	strscpy(name, dev_name(gone), sizeof(name));
	fault(b, EC_SIM_FAULT_CUT, HUB, 1, N - 1);
	KUNIT_EXPECT_EQ(test, u->n, n + 1);
	KUNIT_EXPECT_EQ(test, u->heard[n].action, 'r');
	KUNIT_EXPECT_STREQ(test, u->heard[n].name, name);
	/* the others have moved up */
	attribute_is(b, A - 1, "serial", "0x0000000b\n");
	attribute_is(b, A - 1, "position", "1\n");
	/* a program that began to read before */
	KUNIT_EXPECT_EQ(test, attribute(gone, "position", buf), (ssize_t)-ENODEV);
	KUNIT_EXPECT_EQ(test, attribute(gone, "serial", buf), 11l);
	put_device(gone);
	fault(b, EC_SIM_FAULT_HEAL, HUB, 1, N);
	KUNIT_EXPECT_EQ(test, u->n, n + 2);
	KUNIT_EXPECT_EQ(test, u->heard[n + 1].action, 'a');
	KUNIT_EXPECT_STREQ(test, u->heard[n + 1].name, name);
	attribute_is(b, NEW, "serial", "0x00000015\n");
	free_page((unsigned long)buf);
}

/* Without power it loses its station address; its serial number names it. */
static void devices_keep_name_without_power(struct kunit *test)
{
	struct bus *b = ready(test);
	u16 station = bus_slave(b, NEW)->station;
	u32 n = u->n;

	fault(b, EC_SIM_FAULT_POWER_OFF, NEW, 0, N - 1);
	fault(b, EC_SIM_FAULT_POWER_ON, NEW, 0, N);
	KUNIT_ASSERT_EQ(test, u->n, n + 2);
	KUNIT_EXPECT_STREQ(test, u->heard[n].name, u->heard[n + 1].name);
	KUNIT_EXPECT_NE(test, bus_slave(b, NEW)->station, station);
	device_at(b, NEW);
}

/* Its EEPROM is read at last: programs see another device of the same name. */
static void devices_made_again_with_identity(struct kunit *test)
{
	struct bus *b = bus_new(test, text);
	u32 n;

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, C, 0, ~0u, 0);
	publish(b);
	bus_plug(b);
	KUNIT_ASSERT_TRUE(test, has_devices(test, N));
	attribute_is(b, C, "vendor", "0x00000000\n");
	uevents_listen_ms(u, 5000);
	n = u->n;
	KUNIT_EXPECT_EQ(test, n, (u32)N);
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, C, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 120000), ~0ull);
	uevents_listen_ms(u, 1000);
	KUNIT_ASSERT_EQ(test, u->n, n + 2);
	KUNIT_EXPECT_EQ(test, u->heard[n].action, 'r');
	KUNIT_EXPECT_EQ(test, u->heard[n + 1].action, 'a');
	KUNIT_EXPECT_STREQ(test, u->heard[n].name, u->heard[n + 1].name);
	KUNIT_EXPECT_STRNEQ(test, u->heard[n].modalias, u->heard[n + 1].modalias);
}

static void devices_of_thousand_slaves(struct kunit *test)
{
	struct bus *b = bus_new(test, "line1000");
	u32 i;

	publish(b);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1000, EC_AL_PREOP, 60000), ~0ull);
	KUNIT_ASSERT_TRUE(test, has_devices(test, 1000));
	/* all of them came at the main device: the master has one for the others */
	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'a', false), (u32)EC_UEVENT_RATE);
	KUNIT_ASSERT_EQ(test, uevents_count(u, 0, 'c', true), 1u);
	KUNIT_EXPECT_TRUE(test, u->heard[EC_UEVENT_RATE].master);
	KUNIT_EXPECT_EQ(test, u->heard[EC_UEVENT_RATE].changes, 1000u - EC_UEVENT_RATE);
	for (i = 0; i < 1000; i += 111)
		device_at(b, i);
	bus_fault(b, EC_SIM_FAULT_CUT, 9, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 10, EC_AL_PREOP, 60000), ~0ull);
	KUNIT_ASSERT_TRUE(test, has_devices(test, 10));
	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'r', false), (u32)EC_UEVENT_RATE);
	uevents_listen_ms(u, 2000);
	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'c', true), 2u);
	KUNIT_EXPECT_EQ(test, u->heard[u->n - 1].changes, 990u - EC_UEVENT_RATE);
	bus_figure("a slave's device: %zu bytes, and those of its files",
		   sizeof(struct ec_slave_device));
}

/* Does @i belong to the storm? The other port has one slave. */
static bool is_of_storm(u32 i, const char *other)
{
	return !u->heard[i].master && strcmp(u->heard[i].name, other);
}

/*
 * A branch comes and goes: no second has more than the limit, and the last change is told. What
 * happens at another port has its own uevents meanwhile.
 */
static void devices_in_storm_have_few_uevents(struct kunit *test)
{
	struct bus *b = bus_new(test, "segment seed=1 response=10us transition=100us\n"
				"slave hub EK1100\nslave single EL1004\nbranch hub 2\n"
				"repeat 40 slave i EL1004\n");
	u64 ring[EC_UEVENT_RATE] = { 0 }, last = 0, now, pause;
	u32 i, n, round, storm = 0, changes = 0;
	char other[24];

	publish(b);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 42, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_ASSERT_TRUE(test, has_devices(test, 42));
	uevents_listen_ms(u, 3000);
	strscpy(other, dev_name(device_at(b, 1)), sizeof(other));
	n = u->n;
	for (round = 0; round < 40; round++) {
		bus_fault(b, round % 2 ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_CUT, 0, 2, 0, 0);
		if (round == 11)
			bus_fault(b, EC_SIM_FAULT_CUT, 0, 1, 0, 0);
		if (round == 13)
			bus_fault(b, EC_SIM_FAULT_HEAL, 0, 1, 0, 0);
		/* some are shorter than a scan */
		pause = 20 + round % 5 * 100;
		uevents_listen_ms(u, pause);
	}
	KUNIT_ASSERT_NE(test, bus_wait(b, 42, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_ASSERT_TRUE(test, has_devices(test, 42));
	uevents_listen_ms(u, 2000);
	for (i = n; i < u->n; i++) {
		now = u->heard[i].at;
		if (u->heard[i].master) {
			KUNIT_EXPECT_GE(test, now - last, NSEC_PER_SEC - 2 * NSEC_PER_MSEC);
			last = now;
			changes += u->heard[i].changes;
		} else if (is_of_storm(i, other)) {
			KUNIT_EXPECT_GT(test, now - ring[storm % EC_UEVENT_RATE],
					(u64)NSEC_PER_SEC - 2 * NSEC_PER_MSEC);
			ring[storm++ % EC_UEVENT_RATE] = now;
		}
	}
	bus_figure("storm at a port: %u uevents of slaves, %u of the master for %u changes", storm,
		   uevents_count(u, n, 'c', true), changes);
	KUNIT_EXPECT_GE(test, storm, 2 * EC_UEVENT_RATE);
	KUNIT_EXPECT_GE(test, changes, 200u);
	KUNIT_EXPECT_EQ(test, (storm + changes) % 40, 0u);
	/* the last word, when changes without their own had come after it */
	KUNIT_EXPECT_EQ(test, bus_slave_devices(b)->more, 0u);
	for (i = n, now = 0; i < u->n; i++)
		now += !u->heard[i].master && !is_of_storm(i, other);
	KUNIT_EXPECT_EQ(test, now, 2ull);
}

/* Whatever allocation fails, all slaves are devices soon. */
static void devices_without_memory_follow_later(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u32 n;

	bus_idle(b);
	for (n = 1; n <= N + 1; n++) {
		oom_fail(n);
		publish(b);
		uevents_listen_ms(u, 500);
		KUNIT_EXPECT_TRUE_MSG(test, oom_has_failed(), "%u", n);
		/* the first one is the copy of the list, at the next poll there is memory for it */
		KUNIT_EXPECT_EQ_MSG(test, n_devices(), n == 1 ? N : N - 1u, "%u", n);
		KUNIT_ASSERT_TRUE_MSG(test, has_devices(test, N), "%u", n);
		unpublish(b);
		KUNIT_EXPECT_EQ(test, n_devices(), 0u);
		uevents_listen_ms(u, 2000);
		bus_slave_devices(b)->synced = 0;
	}
	KUNIT_EXPECT_GT(test, bus_log_lines("no device in sysfs (-ENOMEM); retrying"), 0u);
}

static int unregisters(void *done)
{
	ec_slave_device_unregister();
	complete(done);
	return 0;
}

/* The memory of the module stays until the last user of a device lets it go. */
static void devices_outlast_module_by_no_user(struct kunit *test)
{
	struct bus *b = ready(test);
	struct device *used = get_device(device_at(b, A));
	DECLARE_COMPLETION_ONSTACK(done);
	struct task_struct *t;

	unpublish(b);
	KUNIT_EXPECT_EQ(test, n_devices(), 0u);
	uevents_listen(u);
	KUNIT_EXPECT_EQ(test, uevents_count(u, 0, 'r', false), (u32)N);
	t = kthread_run(unregisters, &done, "ec_test");
	KUNIT_ASSERT_FALSE(test, IS_ERR(t));
	msleep(200);
	KUNIT_EXPECT_FALSE(test, completion_done(&done));
	put_device(used);
	KUNIT_EXPECT_NE(test, wait_for_completion_timeout(&done, HZ), 0ul);
	KUNIT_ASSERT_EQ(test, ec_slave_device_register(), 0);
	/* the monitor does not make them again */
	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N - 1, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, n_devices(), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(devices_made_by_scan_have_attributes),
	KUNIT_CASE(devices_stay_over_rescan),
	KUNIT_CASE(devices_removed_at_loss_return_with_name),
	KUNIT_CASE(devices_keep_name_without_power),
	KUNIT_CASE(devices_made_again_with_identity),
	KUNIT_CASE(devices_of_thousand_slaves),
	KUNIT_CASE(devices_in_storm_have_few_uevents),
	KUNIT_CASE(devices_without_memory_follow_later),
	KUNIT_CASE(devices_outlast_module_by_no_user),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_devices", .init = begin, .exit = end, .test_cases = cases,
};
kunit_test_suite(suite);
