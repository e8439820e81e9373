// SPDX-License-Identifier: GPL-2.0-only
/*
 * Device numbers: what a command for a device reaches while others are connected and
 * disconnected, and which devices are the same when they come back.
 */
#include "bus.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/session/reserve.h"

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

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);

	bus_idle(b);
	return b;
}

/* @fault, and what the master makes of it */
static void fault(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u32 slaves)
{
	bus_fault(b, type, slave, port, 0, 0);
	KUNIT_ASSERT_NE_MSG(b->test, bus_wait(b, slaves, EC_AL_PREOP, 10000), ~0ull,
			    "fault %d of slave %d", type, slave);
	bus_idle(b);
}

static struct ec_ioc_address by_number(u64 number)
{
	return (struct ec_ioc_address){ .kind = EC_ADDRESS_DEVICE, .device = number };
}

static int get(struct bus *b, const struct ec_ioc_address *a, struct ec_ioc_slave *s)
{
	*s = (struct ec_ioc_slave){ .slave = *a };
	return ec_ioc(&b->app, EC_IOC_SLAVE, s);
}

/* What an application remembers: the number of the device at a position. */
static u64 number(struct bus *b, u16 position)
{
	const struct ec_ioc_address a = { .position = position };
	struct ec_ioc_slave s;

	KUNIT_ASSERT_EQ(b->test, get(b, &a, &s), 0);
	KUNIT_EXPECT_NE(b->test, s.device, 0ull);
	return s.device;
}

/* Where the device is now; -errno when it is gone. */
static int position(struct bus *b, u64 device)
{
	const struct ec_ioc_address a = by_number(device);
	struct ec_ioc_slave s;
	int ret = get(b, &a, &s);

	return ret ?: s.position;
}

/* Writes @value to an object of the device, as "ethercat download". */
static int download(struct bus *b, const struct ec_ioc_address *a, u32 value)
{
	struct ec_ioc_sdo sdo = {
		.slave = *a, .index = 0x2001, .subindex = 8, .size = 4, .data = (uintptr_t)&value,
	};

	return ec_ioc(&b->app, EC_IOC_SDO_DOWNLOAD, &sdo);
}

static u32 value_at(struct bus *b, u16 position)
{
	u32 value = 0;
	struct ec_ioc_sdo sdo = {
		.slave.position = position, .index = 0x2001, .subindex = 8, .size = 4,
		.data = (uintptr_t)&value,
	};

	KUNIT_EXPECT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_SDO_UPLOAD, &sdo), 0, "%s",
			    b->app.reason);
	return value;
}

/* The four ways to name a slave reach the same one. */
static void number_is_one_of_four_addresses(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_address a[] = {
		{ .position = A },
		{ .kind = EC_ADDRESS_ALIAS, .alias = 7, .position = A },
		{ .kind = EC_ADDRESS_STATION, .station = bus_slave(b, A)->station },
		{ .kind = EC_ADDRESS_DEVICE, .device = number(b, A) },
	};
	struct ec_ioc_slave s;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(a); i++) {
		KUNIT_ASSERT_EQ_MSG(test, get(b, &a[i], &s), 0, "kind %u: %s", i, b->app.reason);
		KUNIT_EXPECT_EQ(test, s.position, A);
		KUNIT_EXPECT_EQ(test, s.serial_number, 11u);
		KUNIT_EXPECT_EQ(test, s.device, a[3].device);
	}
	a[1].position = N;
	KUNIT_EXPECT_EQ(test, get(b, &a[1], &s), -ENOENT);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "no slave 4 after the first one with alias 7; 'ethercat slaves' lists 4");
	a[2].station = 0xfffe;
	KUNIT_EXPECT_EQ(test, get(b, &a[2], &s), -ENOENT);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "no slave has station address 0xfffe; 'ethercat slaves -v' lists them");
	a[3].device += 1000;
	KUNIT_EXPECT_EQ(test, get(b, &a[3], &s), -ENODEV);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "no device has had number"));
}

/* From list to download the ring changes: the value reaches the device, and no other one. */
static void number_stays_with_device(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_address a = by_number(number(b, A));
	const struct ec_ioc_address at = { .position = A };

	fault(b, EC_SIM_FAULT_CUT, HUB, 1, N - 1);
	KUNIT_EXPECT_EQ(test, position(b, a.device), A - 1);
	KUNIT_ASSERT_EQ_MSG(test, download(b, &a, 4711), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, value_at(b, A - 1), 4711u);
	KUNIT_EXPECT_NE(test, value_at(b, A), 4711u);
	/* by position, as a user types it, it is another slave now */
	KUNIT_ASSERT_EQ(test, download(b, &at, 4712), 0);
	KUNIT_EXPECT_EQ(test, value_at(b, A), 4712u);
	KUNIT_EXPECT_EQ(test, value_at(b, A - 1), 4711u);
}

/* A device that is gone gets nothing, nor does the slave that has its position by now. */
static void number_of_lost_device_is_refused(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_address a = by_number(number(b, NEW));
	char want[48];

	fault(b, EC_SIM_FAULT_CUT, HUB, 1, N - 1);
	KUNIT_EXPECT_EQ(test, download(b, &a, 4711), -ENODEV);
	scnprintf(want, sizeof(want), "device %llu, which was slave 1 (", a.device);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, want), "%s", b->app.reason);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "disconnected 0 s ago"), "%s",
				  b->app.reason);
	KUNIT_EXPECT_NE(test, value_at(b, 1), 4711u);
	KUNIT_EXPECT_NE(test, value_at(b, 2), 4711u);
	/* it had power all the time */
	fault(b, EC_SIM_FAULT_HEAL, HUB, 1, N);
	KUNIT_EXPECT_EQ(test, position(b, a.device), NEW);
	KUNIT_EXPECT_EQ(test, download(b, &a, 4711), 0);
	KUNIT_EXPECT_EQ(test, value_at(b, NEW), 4711u);
}

/* By its serial number a device is the same after its power was off; without one it is new. */
static void number_after_power_loss(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 a = number(b, A), c = number(b, C), again;

	fault(b, EC_SIM_FAULT_POWER_OFF, A, 0, A);
	KUNIT_EXPECT_EQ(test, position(b, a), -ENODEV);
	/* it has kept its power behind the other */
	fault(b, EC_SIM_FAULT_POWER_ON, A, 0, N);
	KUNIT_EXPECT_EQ(test, position(b, a), A);
	KUNIT_EXPECT_EQ(test, position(b, c), C);

	fault(b, EC_SIM_FAULT_POWER_OFF, C, 0, C);
	fault(b, EC_SIM_FAULT_POWER_ON, C, 0, N);
	again = number(b, C);
	KUNIT_EXPECT_GT(test, again, c);
	KUNIT_EXPECT_EQ(test, position(b, c), -ENODEV);
	KUNIT_EXPECT_EQ(test, position(b, again), C);
}

/* The whole bus is disconnected, and comes back. */
static void number_after_loss_of_all(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 before[N];
	u32 i;

	for (i = 0; i < N; i++)
		before[i] = number(b, i);
	fault(b, EC_SIM_FAULT_CUT, HUB, 0, 0);
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_EQ(test, position(b, before[i]), -ENODEV);
	fault(b, EC_SIM_FAULT_HEAL, HUB, 0, N);
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_EQ_MSG(test, position(b, before[i]), (int)i, "device %llu",
				    before[i]);
	KUNIT_EXPECT_EQ(test, bus_table(b)->known.n_lost, 0u);
}

/* Two devices with one serial number are told apart by their station addresses alone. */
static void number_with_serial_number_twice(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 serial=5\n"
			       "slave b drive in=8 out=8 serial=5\n", 2);
	u64 a, c;

	bus_idle(b);
	a = number(b, 0);
	c = number(b, 1);
	KUNIT_EXPECT_NE(test, a, c);
	fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 1);
	fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 2);
	KUNIT_EXPECT_EQ(test, position(b, a), 0);
	KUNIT_EXPECT_EQ(test, position(b, c), -ENODEV);
	KUNIT_EXPECT_GT(test, number(b, 1), c);
}

/* A slave whose EEPROM cannot be read has a number, the same after each attempt. */
static void number_of_unreadable_slave(struct kunit *test)
{
	struct bus *b = bus_new(test, text);
	u64 n;

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, C, 0, ~0u, 0);
	bus_plug(b);
	msleep(1000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	n = number(b, C);
	msleep(5000);
	KUNIT_ASSERT_EQ(test, bus_slave(b, C)->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_EQ(test, number(b, C), n);
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, C, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 120000), ~0ull);
	KUNIT_EXPECT_EQ(test, number(b, C), n);
}

/* Numbers of many devices: found at once, and what was lost is kept within its limit. */
static void number_of_many_devices(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave hub EK1100\nrepeat 300 slave i EL1004\n", 301);
	u64 last;
	u32 i;

	bus_idle(b);
	for (i = 0; i < 301; i++)
		KUNIT_ASSERT_EQ(test, position(b, number(b, i)), (int)i);
	last = number(b, 300);
	for (i = 0; i < 3; i++) {
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 20000), ~0ull);
		bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, 301, EC_AL_PREOP, 20000), ~0ull);
		bus_idle(b);
	}
	/* the first one lost its power, those behind it did not */
	KUNIT_EXPECT_EQ(test, position(b, last), 300);
	KUNIT_EXPECT_EQ(test, bus_table(b)->known.n_lost, 3u);
}

/*
 * A device without serial number that loses its power is another one each time. What is kept of it
 * is limited, and they share their image.
 */
static void number_lost_are_limited(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave d drive\n", 2);
	const struct ec_known *k = &bus_table(b)->known;
	const struct ec_image *image = NULL;
	struct ec_lost *l;
	u32 i;

	bus_idle(b);
	for (i = 0; i < 270; i++) {
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 20000), ~0ull);
		bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 20000), ~0ull);
	}
	KUNIT_EXPECT_EQ(test, k->n_lost, 2u + 256u);
	list_for_each_entry(l, &k->oldest, age) {
		image = image ?: l->image;
		KUNIT_EXPECT_TRUE(test, !l->image || l->image == image);
	}
	KUNIT_EXPECT_NOT_NULL(test, image);
}

/* Alias and offset mean the same slave in a configuration as in a command. */
static void number_of_config_by_alias_further_upstream(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 alias=7\n"
			       "slave b drive in=8 out=8 alias=9\nslave c drive in=8 out=8\n", 3);
	struct ec_ioc_slave_config sc = { .alias = 7, .position = 2, .vendor_id = 1 };
	const struct ec_ioc_address a = {
		.kind = EC_ADDRESS_ALIAS, .alias = 7, .position = 2,
	};
	struct ec_ioc_slave s;

	bus_idle(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_ASSERT_EQ(test, get(b, &a, &s), 0);
	KUNIT_EXPECT_EQ(test, s.position, 2);
	KUNIT_EXPECT_EQ(test, s.alias_group, 9);
	KUNIT_EXPECT_EQ(test, s.alias_pos, 1);
	KUNIT_EXPECT_EQ(test, s.config, sc.index + 1);
	KUNIT_EXPECT_EQ(test, s.differs, 1u);
	ec_session_end(bus_sessions(b), &b->app);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(number_lost_are_limited),
	KUNIT_CASE(number_is_one_of_four_addresses),
	KUNIT_CASE(number_stays_with_device),
	KUNIT_CASE(number_of_lost_device_is_refused),
	KUNIT_CASE(number_after_power_loss),
	KUNIT_CASE(number_after_loss_of_all),
	KUNIT_CASE(number_with_serial_number_twice),
	KUNIT_CASE(number_of_unreadable_slave),
	KUNIT_CASE(number_of_many_devices),
	KUNIT_CASE(number_of_config_by_alias_further_upstream),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_number", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
