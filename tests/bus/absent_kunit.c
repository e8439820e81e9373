// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that are absent: one entry, one event and one line for their port, until they return. */
#include "bus.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"

/* in the ring: the hub, what is at its port 1, the line at its port 2 */
static const char text[] =
	"segment seed=12 response=100us transition=1ms\n"
	"slave hub EK1100 alias=7\n"
	"slave n drive in=8 out=8 mbox=128\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 mbox=128\n"
	"slave c drive in=8 out=8 mbox=128\n"
	"slave d drive in=8 out=8 mbox=128\n";

enum { HUB, NEW, A, C, D, N };

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);

	bus_idle(b);
	return b;
}

static void fault(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u32 slaves)
{
	bus_fault(b, type, slave, port, 0, 0);
	KUNIT_ASSERT_NE_MSG(b->test, bus_wait(b, slaves, EC_AL_PREOP, 10000), ~0ull,
			    "fault %d of slave %d", type, slave);
	bus_idle(b);
}

static u64 device(struct bus *b, unsigned int slave)
{
	return bus_slave(b, slave)->device;
}

/* What the command shows at @index. */
static struct ec_ioc_absent shown(struct bus *b, u32 index)
{
	struct ec_ioc_absent a = { .index = index };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_ABSENT, &a), 0);
	return a;
}

static u32 events(struct bus *b, u64 at, u32 kind, u32 slaves)
{
	struct ec_event e = { };
	u32 n = 0;

	while (ec_event_ring_get(bus_events(b), &at, &e))
		n += e.kind == kind && e.arg[0] == HUB && e.arg[1] == 2 &&
		     e.arg[kind == EC_EVENT_SLAVE_LOST ? 6 : 5] == slaves;
	return n;
}

static void absent_branch_is_one_entry_until_it_returns(struct kunit *test)
{
	struct bus *b = ready(test);
	u32 lines = bus_log_lines("behind port");
	u64 at = ec_event_ring_head(bus_events(b));
	struct ec_ioc_absent a;

	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, 0u);
	fault(b, EC_SIM_FAULT_CUT, HUB, 2, A);
	msleep(3000);
	a = shown(b, 0);
	KUNIT_EXPECT_EQ(test, a.slaves, (u32)(N - A));
	KUNIT_EXPECT_EQ(test, a.device, device(b, HUB));
	KUNIT_EXPECT_EQ(test, a.port, 2);
	KUNIT_EXPECT_EQ(test, a.first, A);
	KUNIT_EXPECT_EQ(test, a.last, D);
	KUNIT_EXPECT_STREQ(test, a.name, "drive");
	KUNIT_EXPECT_GE(test, a.since_ns, 3 * NSEC_PER_SEC);
	KUNIT_EXPECT_LE(test, a.since_ns, 4 * NSEC_PER_SEC);
	KUNIT_EXPECT_EQ(test, shown(b, 1).slaves, 0u);
	KUNIT_EXPECT_EQ(test, shown(b, ~0u).slaves, 0u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("behind port") - lines, 1u);
	KUNIT_EXPECT_EQ(test,
			bus_log_lines("behind port 2 of slave 0 (EK1100): 3 slaves disconnected, 2 (drive) to 4 (drive)"),
			1u);
	KUNIT_EXPECT_EQ(test, events(b, at, EC_EVENT_SLAVE_LOST, N - A), 1u);
	fault(b, EC_SIM_FAULT_HEAL, HUB, 2, N);
	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, 0u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("behind port") - lines, 2u);
	KUNIT_EXPECT_EQ(test, events(b, at, EC_EVENT_SLAVE_FOUND, N - A), 1u);
}

/* The cable is repaired, and another one behind it is not. */
static void absent_rest_moves_to_next_port(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_absent a;

	fault(b, EC_SIM_FAULT_CUT, A, 1, C);
	KUNIT_EXPECT_EQ(test, shown(b, 0).device, device(b, A));
	fault(b, EC_SIM_FAULT_CUT, HUB, 2, A);
	a = shown(b, 0);
	KUNIT_EXPECT_EQ_MSG(test, a.device, device(b, HUB), "those lost before as well");
	KUNIT_EXPECT_EQ(test, a.slaves, (u32)(N - A));
	KUNIT_EXPECT_EQ(test, shown(b, 1).slaves, 0u);
	fault(b, EC_SIM_FAULT_HEAL, HUB, 2, C);
	a = shown(b, 0);
	KUNIT_EXPECT_EQ(test, a.device, device(b, A));
	KUNIT_EXPECT_EQ(test, a.port, 1);
	KUNIT_EXPECT_EQ(test, a.slaves, (u32)(N - C));
	fault(b, EC_SIM_FAULT_HEAL, A, 1, N);
	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, 0u);
}

static void absent_two_ports_are_two_entries(struct kunit *test)
{
	struct bus *b = ready(test);

	fault(b, EC_SIM_FAULT_CUT, HUB, 1, N - 1);
	fault(b, EC_SIM_FAULT_CUT, HUB, 2, 1);
	KUNIT_EXPECT_EQ(test, shown(b, 0).port, 1);
	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, 1u);
	KUNIT_EXPECT_EQ(test, shown(b, 1).port, 2);
	KUNIT_EXPECT_EQ(test, shown(b, 1).slaves, (u32)(N - A));
	/* the whole bus: all of them are behind the main device */
	fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0);
	KUNIT_EXPECT_EQ(test, shown(b, 0).device, 0ull);
	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, (u32)N);
	KUNIT_EXPECT_EQ(test, shown(b, 1).slaves, 0u);
	bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	fault(b, EC_SIM_FAULT_HEAL, HUB, 1, 2);
	KUNIT_EXPECT_EQ(test, shown(b, 0).port, 2);
	KUNIT_EXPECT_EQ(test, shown(b, 1).slaves, 0u);
}

static void absent_rescan_of_user_forgets(struct kunit *test)
{
	struct bus *b = ready(test);
	u32 scans, i;

	fault(b, EC_SIM_FAULT_CUT, HUB, 2, A);
	KUNIT_EXPECT_NE(test, shown(b, 0).slaves, 0u);
	scans = bus_scans(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), 0);
	for (i = 0; i < 5000 && bus_scans(b) == scans; i++)
		msleep(1);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, shown(b, 0).slaves, 0u);
	/* a device that returns has its number again, and can be lost again */
	fault(b, EC_SIM_FAULT_HEAL, HUB, 2, N);
	fault(b, EC_SIM_FAULT_CUT, C, 1, D);
	KUNIT_EXPECT_EQ(test, shown(b, 0).device, device(b, C));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(absent_branch_is_one_entry_until_it_returns),
	KUNIT_CASE(absent_rest_moves_to_next_port),
	KUNIT_CASE(absent_two_ports_are_two_entries),
	KUNIT_CASE(absent_rescan_of_user_forgets),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_absent",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
