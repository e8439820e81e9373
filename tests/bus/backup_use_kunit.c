// SPDX-License-Identifier: GPL-2.0-only
/* A master gets a backup device, another one, or none, while it is there. */
#include "ring.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/link/device.h"

#define CUT	3	/* slaves before the break */

static int use(struct bus *b, bool backup, const char *name)
{
	struct ec_ioc_device_use i = { .flags = backup ? EC_DEVICE_FLAG_BACKUP : 0 };

	strscpy(i.name, name, sizeof(i.name));
	return ec_ioc(&b->app, EC_IOC_DEVICE_USE, &i);
}

static void use_backup(struct bus *b, const char *name)
{
	KUNIT_ASSERT_EQ_MSG(b->test, use(b, true, name), 0, "%s", b->app.reason);
}

static void refused(struct bus *b, bool backup, const char *name, int err, const char *why)
{
	KUNIT_EXPECT_EQ_MSG(b->test, use(b, backup, name), err, "%s", name);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, why), "%s", b->app.reason);
}

/* A bus with one end, as if there had never been another one. */
static void expect_line(struct bus *b, u32 n)
{
	const struct ec_links *l = bus_links(b);

	KUNIT_ASSERT_NE(b->test, bus_wait(b, n, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_EXPECT_PTR_EQ(b->test, l->only, &bus_links(b)->link[EC_MAIN]);
	KUNIT_EXPECT_EQ(b->test, l->sides, BIT(EC_MAIN));
	KUNIT_EXPECT_EQ(b->test, ec_links_n(l), 1u);
	KUNIT_EXPECT_EQ(b->test, l->ring.state, EC_RING_NONE);
	KUNIT_EXPECT_FALSE(b->test, l->ring.news);
	KUNIT_EXPECT_NULL(b->test, l->slots.copies);
	KUNIT_EXPECT_NULL(b->test, l->link[EC_BACKUP].dev);
	KUNIT_EXPECT_FALSE(b->test, bus_table(b)->places.open);
}

static void expect_ring(struct bus *b)
{
	KUNIT_ASSERT_NE(b->test, bus_wait(b, SLAVES, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_NULL(b->test, bus_links(b)->only);
	KUNIT_EXPECT_EQ(b->test, ec_links_n(bus_links(b)), 2u);
}

/* An application runs with each form, and in the ring also beside a break. */
static void backup_use_line_becomes_ring(struct kunit *test)
{
	struct bus *b = bus_new_line(test, ring_eight);
	struct ring *r;
	u32 i;

	bus_plug_scanned(b, SLAVES, 5000);
	for (i = 0; i < 2; i++) {
		expect_line(b, SLAVES);
		r = ring_new(test, b);
		ring_run(r, SLAVES);
		bus_end(b);

		use_backup(b, "bus0b");
		/* it has waited for the scan */
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)SLAVES);
		expect_ring(b);
		r = ring_new(test, b);
		ring_run(r, SLAVES);
		ring_cable(b, true, CUT);
		cyc_run(r->c, 300);
		ring_open(b, CUT);
		ring_expect(r, "a cut of the new ring");
		ring_cable(b, false, CUT);
		cyc_run(r->c, 300);
		ring_closed(b, SLAVES);
		ring_expect(r, "the repair of the new ring");
		bus_end(b);
		use_backup(b, "");
	}
	expect_line(b, SLAVES);
	KUNIT_EXPECT_EQ(test, bus_log_lines("backup device bus0b instead of none"), 2u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("backup device none instead of bus0b"), 2u);
	/* the reply of a frame that the ring has sent is not awaited */
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* Loop control of the last slave, as it is there. */
static u8 loops_of_last(struct bus *b)
{
	return bus_esc(b, SLAVES - 1)->mem[EC_REG_DL_LOOPS];
}

/* The slaves behind the break are not reached any more, until it heals. */
static void backup_use_none_in_open_ring(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);

	bus_idle(b);
	ring_cable(b, true, CUT);
	msleep(500);
	bus_idle(b);
	ring_open(b, CUT);
	use_backup(b, "");
	expect_line(b, CUT);
	ring_cable(b, false, CUT);
	expect_line(b, SLAVES);
	use_backup(b, "bus0b");
	expect_ring(b);
}

static void backup_use_same(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	char name[32];
	u32 scans;

	bus_idle(b);
	scans = bus_scans(b);
	snprintf(name, sizeof(name), "%pM", bus_link(b, EC_BACKUP)->dev->mac);
	use_backup(b, "bus0b");
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	use_backup(b, "");
	expect_line(b, SLAVES);
	scans = bus_scans(b);
	use_backup(b, "");
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	/* by its address */
	use_backup(b, name);
	expect_ring(b);
	KUNIT_EXPECT_STREQ(test, bus_links(b)->backup, name);
}

/* The device at port 0 of the first slave is the main one, with either name. */
static void backup_use_exchanged_ends(struct kunit *test)
{
	struct bus *b = bus_new_exchanged(test, ring_eight);

	bus_plug_scanned(b, SLAVES, 5000);
	expect_ring(b);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	refused(b, true, "bus0b", -EBUSY, "bus0b is the device of master 0");
	use_backup(b, "");
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, "bus0b");
	KUNIT_EXPECT_FALSE(test, bus_links(b)->exchanged);
	/* no slave is found: frames leave by port 0 of the first one, whose card has a link */
	KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_NONE);
	use_backup(b, "bus0");
	expect_ring(b);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, "bus0");
}

/* what cannot be used changes nothing */
static void backup_use_refused(struct kunit *test)
{
	static const char any[] = "ff:ff:ff:ff:ff:ff";
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ec_ioc_device_use i = { .flags = 2 };
	u32 scans;

	bus_idle(b);
	scans = bus_scans(b);
	refused(b, true, "bus0", -EBUSY, "bus0 is the device of master 0");
	refused(b, false, "bus0b", -EBUSY, "bus0b is the device of master 0");
	refused(b, true, any, -EINVAL, "need the name of their device");
	refused(b, false, any, -EINVAL, "need the name of their device");
	refused(b, true, "a/b", -EINVAL, "neither a MAC address");
	refused(b, false, "", -EINVAL, "neither a MAC address");
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEVICE_USE, &i), -EOPNOTSUPP);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	refused(b, true, "", -EBUSY, "stop that application first");
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	refused(b, true, "eth7", -ENODEV, "master 0 keeps bus0b");
	expect_ring(b);

	use_backup(b, "");
	refused(b, true, "eth7", -ENODEV, "master 0 keeps no backup device");
	expect_line(b, SLAVES);
	KUNIT_EXPECT_EQ(test, use(b, false, any), 0);
	refused(b, true, "bus0b", -EINVAL, "need the name of their device");
	expect_line(b, SLAVES);
}

/* Its name stays, as that of a device that is absent at the start. */
static void backup_use_main_absent(struct kunit *test)
{
	struct bus *b = bus_new_line(test, ring_eight);

	bus_plug(b);
	KUNIT_ASSERT_EQ(test, ec_device_release(bus_links(b), EC_MAIN, "bus9", NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_device_use(bus_links(b), EC_MAIN, "bus9"), -ENODEV);
	use_backup(b, "bus0b");
	KUNIT_EXPECT_STREQ(test, bus_link(b, EC_BACKUP)->dev->name, "bus0b");
	KUNIT_EXPECT_NULL(test, bus_link(b, EC_MAIN)->dev);
	KUNIT_ASSERT_EQ(test, use(b, false, "bus0"), 0);
	expect_ring(b);
}

/* The link of its card stays: the port there is closed, and opened when the cable is out. */
static void backup_use_none_keeps_link(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u32 i;

	ec_sim_link_keep(b->link);
	bus_idle(b);
	for (i = 0; i < 2; i++) {
		ring_closed(b, SLAVES);
		use_backup(b, "");
		expect_line(b, SLAVES);
		KUNIT_EXPECT_EQ(test, loops_of_last(b), EC_LOOP_CLOSED << 2);
		/* the next scans know it as well */
		bus_rescan(b);
		expect_line(b, SLAVES);
		if (i) {
			ring_cable(b, true, SLAVES);
			msleep(1000);
			bus_idle(b);
			KUNIT_EXPECT_EQ(test, loops_of_last(b), 0);
			expect_line(b, SLAVES);
			ring_cable(b, false, SLAVES);
		}
		use_backup(b, "bus0b");
		expect_ring(b);
		KUNIT_EXPECT_EQ(test, loops_of_last(b), 0);
	}
	KUNIT_EXPECT_GE(test, bus_log_lines("keeps the link without the master"), 1u);
	/* closed before, as the device was absent */
	ec_sim_link_second_withdraw(b->link);
	ec_sim_wire_card(ec_sim_link_wire(b->link), 1, true);
	msleep(500);
	bus_idle(b);
	ring_open(b, SLAVES);
	use_backup(b, "");
	expect_line(b, SLAVES);
	ring_run(ring_new(test, b), SLAVES);
}

/* The master waits for another main device. */
static struct bus *main_is_absent(struct kunit *test)
{
	struct bus *b = bus_new(test, ring_eight);

	KUNIT_ASSERT_EQ(test, ec_device_release(bus_links(b), EC_MAIN, "bus9", NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_device_use(bus_links(b), EC_MAIN, "bus9"), -ENODEV);
	return b;
}

/* The device itself, as if it had been wanted all the time. */
static void main_comes(struct bus *b)
{
	struct ec_links *l = bus_links(b);

	KUNIT_ASSERT_EQ(b->test, ec_device_release(l, EC_MAIN, "bus0", NULL), 0);
	KUNIT_ASSERT_EQ(b->test, ec_device_use(l, EC_MAIN, "bus0"), 0);
}

/* Its card has no link: all slaves are at the backup device, and run on when it comes. */
static void backup_use_main_later(struct kunit *test)
{
	struct bus *b = main_is_absent(test);
	struct ring *r;

	bus_plug(b);
	ec_sim_wire_card(ec_sim_link_wire(b->link), 0, false);
	KUNIT_ASSERT_NE(test, bus_wait(b, SLAVES, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	ring_open(b, 0);
	KUNIT_EXPECT_NULL(test, bus_link(b, EC_MAIN)->dev);
	r = ring_new(test, b);
	ring_run(r, SLAVES);
	cyc_run(r->c, 200);
	ring_expect(r, "without the main device");
	ec_sim_wire_card(ec_sim_link_wire(b->link), 0, true);
	main_comes(b);
	cyc_run(r->c, 2000);
	ring_is_whole(r, "the main device has come");
}

/* Its card has a link: no frame of the backup device is processed, or returns, until it comes. */
static void backup_use_main_keeps_link(struct kunit *test)
{
	struct bus *b = main_is_absent(test);
	struct ring *r;

	bus_plug(b);
	msleep(5000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 0u);
	main_comes(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, SLAVES, EC_AL_PREOP, 10000), ~0ull);
	expect_ring(b);
	r = ring_new(test, b);
	ring_run(r, SLAVES);
	cyc_run(r->c, 200);
	ring_expect(r, "a ring whose main device came late");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(backup_use_line_becomes_ring),
	KUNIT_CASE(backup_use_none_in_open_ring),
	KUNIT_CASE(backup_use_same),
	KUNIT_CASE(backup_use_exchanged_ends),
	KUNIT_CASE(backup_use_refused),
	KUNIT_CASE(backup_use_main_absent),
	KUNIT_CASE(backup_use_none_keeps_link),
	KUNIT_CASE(backup_use_main_later),
	KUNIT_CASE(backup_use_main_keeps_link),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_backup_use",
	.test_cases = cases,
	.exit = bus_exit,
};
kunit_test_suite(suite);
