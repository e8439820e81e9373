// SPDX-License-Identifier: GPL-2.0-only
/*
 * The list of slaves is held from reservation to activation and from deactivation to the next
 * activation or release: whatever is connected or disconnected meanwhile, a position means the
 * device that it meant before.
 */
#include "kapp.h"
#include "kcyc.h"
#include "devices/sim/esc_int.h"

/* in the ring: the hub, what is at its port 1, what is at its port 2 */
static const char text[] =
	"segment seed=12 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"slave n drive in=8 out=8 mbox=128 serial=21\n"
	"branch hub 2\n"
	"slave a drive in=8 out=8 mbox=128 serial=11\n"
	"slave c drive in=8 out=8 mbox=128 serial=12\n";

/* of the segment */
enum { HUB, NEW, A, C };

#define N	3	/* without the new one */

static void plug(struct bus *b, bool new)
{
	bus_fault(b, new ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_CUT, HUB, 1, 0, 0);
}

/* All but the new slave. */
static struct bus *before(struct kunit *test)
{
	struct bus *b = bus_new(test, text);

	plug(b, false);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	return b;
}

/* 0x1018:04 of the slave at a ring position, which names the device; or -errno. */
static int serial(struct bus *b, u32 position)
{
	u8 data[4];
	struct ec_ioc_sdo sdo = {
		.slave.position = position, .index = 0x1018, .subindex = 4, .size = 4,
		.data = (uintptr_t)data,
	};
	int ret = ec_ioc(&b->app, EC_IOC_SDO_UPLOAD, &sdo);

	return ret ?: (int)get_unaligned_le32(data);
}

/* Valid until the next call: it is too large for the stack. */
static const struct ec_ioc_master *state(struct bus *b)
{
	static struct ec_ioc_master mi;

	memset(&mi, 0, sizeof(mi));
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_MASTER, &mi), 0);
	return &mi;
}

static void wait_responding(struct bus *b, u32 n)
{
	u32 i;

	/* a cycle that has stopped may have to time out first */
	for (i = 0; i < 10000 && bus_responding(b) != n; i++)
		usleep_range(100, 101);
	KUNIT_ASSERT_EQ(b->test, bus_responding(b), n);
}

/* The list is that of before, however many slaves there are by now. */
static void expect_held(struct bus *b, u32 responding)
{
	const struct ec_ioc_master *mi = state(b);

	KUNIT_EXPECT_EQ(b->test, mi->held, 1u);
	KUNIT_EXPECT_NE(b->test, mi->owner[0], 0);
	KUNIT_EXPECT_EQ(b->test, mi->slave_count, (u32)N);
	KUNIT_EXPECT_EQ(b->test, mi->slaves_responding, responding);
	KUNIT_EXPECT_EQ(b->test, mi->scan_busy, 0);
	KUNIT_EXPECT_EQ(b->test, serial(b, 1), 11);
	KUNIT_EXPECT_EQ(b->test, serial(b, 2), 12);
}

static void expect_found(struct bus *b)
{
	KUNIT_EXPECT_EQ(b->test, state(b)->held, 0u);
	bus_idle(b);
	KUNIT_ASSERT_EQ(b->test, state(b)->slave_count, N + 1u);
	KUNIT_EXPECT_EQ(b->test, bus_slave(b, 1)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(b->test, serial(b, 1), 21);
	KUNIT_EXPECT_EQ(b->test, serial(b, 2), 11);
	KUNIT_EXPECT_EQ(b->test, serial(b, 3), 12);
}

static struct cyc *in_op(struct bus *b)
{
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 1, N - 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	return c;
}

static void deactivate(struct bus *b)
{
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
	bus_idle(b);
}

/* A slave is connected upstream: an SDO for a position reaches the same device as before. */
static void held_after_deactivation(struct kunit *test)
{
	struct bus *b = before(test);
	u32 scans;

	in_op(b);
	KUNIT_EXPECT_EQ(test, state(b)->held, 0u);
	deactivate(b);
	expect_held(b, N);
	scans = state(b)->scan_count;
	plug(b, true);
	msleep(3000);
	expect_held(b, N + 1);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), -EBUSY);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "list of slaves is held: process"),
				  "%s", b->app.reason);
	msleep(1000);
	expect_held(b, N + 1);
	KUNIT_EXPECT_EQ(test, state(b)->scan_count, scans);
	bus_end(b);
	expect_found(b);
}

/* The same for an application in the kernel, and when the kernel runs its cycle. */
static void kernel_api(struct kunit *test, bool kernel_cycle)
{
	struct bus *b = before(test);
	struct kapp *k = kapp_new(b, 1000);

	if (kernel_cycle)
		kapp_kernel_cycle(k, (ec_cycle_config_t){ .cpu = -1 });
	kapp_map(k, 1);
	kapp_map(k, 2);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	plug(b, true);
	msleep(3000);
	expect_held(b, N + 1);
	KUNIT_EXPECT_STREQ(test, state(b)->owner, "an application in the kernel");
	/* activation lets the scan run; its configurations are those of the held list */
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), 0);
	expect_found(b);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	KUNIT_EXPECT_EQ(test, state(b)->held, 1u);
	ecrt_release_master(k->m);
	KUNIT_EXPECT_EQ(test, state(b)->held, 0u);
}

static void held_by_kernel_application(struct kunit *test)
{
	kernel_api(test, false);
}

static void held_by_kernel_cycle(struct kunit *test)
{
	kernel_api(test, true);
}

static int command(struct bus *b, unsigned int cmd, void *arg)
{
	int ret = ec_ioc(&b->app, cmd, arg);

	if (ret)
		KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, "no reply"), "%s",
					  b->app.reason);
	return ret;
}

/* Every call for a lost slave fails; what is known of it is shown. */
static void expect_lost(struct bus *b, u32 position)
{
	u8 data[4] = { EC_AL_INIT };
	struct ec_ioc_sdo sdo = {
		.slave.position = position, .index = 0x1018, .subindex = 4, .size = 4,
		.data = (uintptr_t)data,
	};
	struct ec_ioc_foe foe = { .slave.position = position, .size = 4, .data = (uintptr_t)data };
	struct ec_ioc_soe soe = { .slave.position = position, .size = 4, .data = (uintptr_t)data };
	struct ec_ioc_state al = { .slave.position = position, .state = EC_AL_INIT };
	struct ec_ioc_reg reg = {
		.slave.position = position, .address = EC_REG_AL_CONTROL, .size = 2,
		.data = (uintptr_t)data,
	};
	struct ec_ioc_slave i = { .slave.position = position };
	struct ec_ioc_slave_why w = { .slave.position = position };

	KUNIT_EXPECT_EQ(b->test, command(b, EC_IOC_SDO_UPLOAD, &sdo), -EIO);
	KUNIT_EXPECT_EQ(b->test, command(b, EC_IOC_SDO_DOWNLOAD, &sdo), -EIO);
	KUNIT_EXPECT_EQ(b->test, command(b, EC_IOC_FOE_READ, &foe), -EIO);
	KUNIT_EXPECT_EQ(b->test, command(b, EC_IOC_SOE_READ, &soe), -EIO);
	KUNIT_EXPECT_EQ(b->test, command(b, EC_IOC_STATE, &al), -EIO);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REG_READ, &reg), -EIO);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REG_WRITE, &reg), -EIO);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SLAVE, &i), 0);
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &w), 0);
	KUNIT_EXPECT_EQ(b->test, w.cause.kind, (u32)EC_CAUSE_SILENT);
	KUNIT_EXPECT_EQ(b->test, i.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_EQ(b->test, i.al_status, 0);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(w.why, "held"), "%s", w.why);
}

/*
 * The slaves of the list are cut off, and another one is at their position: no call for them
 * reaches it. Those that have kept their power reply again.
 */
static void held_lost_slaves(struct kunit *test)
{
	struct bus *b = before(test);
	u8 al;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	plug(b, true);
	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 2, 0, 0);
	msleep(300);
	al = bus_esc(b, NEW)->mem[EC_REG_AL_STATUS];
	KUNIT_EXPECT_EQ(test, state(b)->slaves_responding, 2u);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, (u32)N);
	expect_lost(b, 1);
	expect_lost(b, 2);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	/* for longer than a retry by position takes */
	msleep(3000);
	expect_lost(b, 1);
	KUNIT_EXPECT_EQ(test, bus_esc(b, NEW)->mem[EC_REG_AL_STATUS], al);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(b, NEW)->mem + EC_REG_STATION), 0);

	bus_fault(b, EC_SIM_FAULT_HEAL, HUB, 2, 0, 0);
	msleep(300);
	expect_held(b, N + 1);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_PREOP);
	bus_end(b);
	expect_found(b);
}

/* One that was switched off has no station address: it stays lost until the list is released. */
static void held_power_cycled_slave(struct kunit *test)
{
	struct bus *b = before(test);
	struct ec_slave *s = bus_slave(b, 2);
	u64 t0;

	in_op(b);
	deactivate(b);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, C, 0, 0, 0);
	msleep(500);
	expect_lost(b, 2);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, C, 0, 0, 0);
	msleep(3000);
	KUNIT_EXPECT_EQ(test, state(b)->slaves_responding, (u32)N);
	expect_lost(b, 2);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 2), s);
	KUNIT_EXPECT_EQ(test, serial(b, 1), 11);
	KUNIT_EXPECT_EQ(test, bus_esc(b, C)->mem[EC_REG_AL_STATUS], EC_AL_INIT);
	/* at release its scan is due, although the number of slaves is right */
	t0 = ktime_get_ns();
	bus_end(b);
	KUNIT_EXPECT_TRUE(test, state(b)->scan_busy);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 2 * NSEC_PER_SEC);
	KUNIT_EXPECT_PTR_NE(test, bus_slave(b, 2), s);
	expect_held(b, N);
}

/*
 * A slave of another master that has the station address of a slave in the list: no call reaches
 * the two.
 */
static void held_station_address_twice(struct kunit *test)
{
	struct bus *b = before(test);
	struct ec_esc *esc = bus_esc(b, NEW);

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	put_unaligned_le16(bus_slave(b, 1)->station, esc->mem + EC_REG_STATION);
	ec_sim_rehash(esc);
	plug(b, true);
	msleep(300);
	KUNIT_EXPECT_EQ(test, state(b)->slaves_responding, N + 1u);
	KUNIT_EXPECT_EQ(test, serial(b, 1), -EIO);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "same station address"), "%s",
				  b->app.reason);
	KUNIT_EXPECT_EQ(test, serial(b, 2), 12);
	plug(b, false);
	msleep(300);
	expect_held(b, N);
	plug(b, true);
	msleep(300);
	bus_end(b);
	expect_found(b);
}

/* A slave that was slow on its way to a state is brought there, also while the list is held. */
static void held_slave_is_tried_again(struct kunit *test)
{
	struct bus *b = before(test);
	u32 i;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	bus_fault(b, EC_SIM_FAULT_MUTE, A, 0, 1, 0);
	bus_request(b, 1, EC_AL_INIT);
	for (i = 0; i < 20000 && !READ_ONCE(bus_slave(b, 1)->note.error); i++)
		usleep_range(1000, 1001);
	KUNIT_ASSERT_EQ(test, bus_slave(b, 1)->note.error, EC_SLAVE_CONFIG_FAILED);
	bus_fault(b, EC_SIM_FAULT_MUTE, A, 0, 0, 0);
	/* the request has got lost: the state does not come late */
	bus_esc(b, A)->mem[EC_REG_AL_CONTROL] = EC_AL_PREOP;
	msleep(20000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_INIT);
}

/* No reply at all, as the cable of the master is cut: all are lost, and all return. */
static void held_without_link(struct kunit *test)
{
	struct bus *b = before(test);

	in_op(b);
	deactivate(b);
	bus_fault(b, EC_SIM_FAULT_CUT, HUB, 0, 0, 0);
	msleep(500);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, (u32)N);
	KUNIT_EXPECT_EQ(test, state(b)->slaves_responding, 0u);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 0)->reply.silent);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 1)->reply.silent);
	bus_fault(b, EC_SIM_FAULT_HEAL, HUB, 0, 0, 0);
	msleep(500);
	expect_held(b, N);
}

/* A scan that is due runs first, for deactivation as for reservation. */
static void held_after_due_scan(struct kunit *test)
{
	struct bus *b = before(test);
	u64 t0;

	in_op(b);
	plug(b, true);
	wait_responding(b, N + 1);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	t0 = ktime_get_ns();
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
	bus_figure("deactivation while a scan is due: %llu ms",
		   div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	KUNIT_EXPECT_EQ(test, state(b)->held, 1u);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, N + 1u);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 3 * NSEC_PER_SEC);
	bus_end(b);
	expect_found(b);
	plug(b, false);
	wait_responding(b, N);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	expect_held(b, N);
}

/* Scans that never end, as beside a loose contact, do not block the call. */
static void held_although_scans_do_not_end(struct kunit *test)
{
	struct bus *b = before(test);
	u64 t0, ms;

	in_op(b);
	WRITE_ONCE(bus_table(b)->scan_busy, true);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
	ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	KUNIT_EXPECT_GE(test, ms, (u64)EC_SCAN_WAIT_MS);
	KUNIT_EXPECT_LE(test, ms, EC_SCAN_WAIT_MS + 1000ull);
	WRITE_ONCE(bus_table(b)->scan_busy, false);
	expect_held(b, N);
}

/* What the scan has found when the list is held is thrown away; it is found again afterwards. */
static void held_during_scan(struct kunit *test)
{
	struct bus *b = before(test);
	u32 i;

	plug(b, true);
	for (i = 0; i < 1000 && !bus_scan_busy(b); i++)
		usleep_range(100, 101);
	KUNIT_ASSERT_TRUE(test, bus_scan_busy(b));
	KUNIT_EXPECT_FALSE(test, ec_bus_hold(bus_table(b), false));
	KUNIT_EXPECT_TRUE(test, ec_bus_hold(bus_table(b), true));
	msleep(3000);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, (u32)N);
	KUNIT_EXPECT_EQ(test, serial(b, 1), 11);
	KUNIT_EXPECT_EQ(test, state(b)->scan_busy, 0);
	ec_bus_unhold(bus_table(b));
	expect_found(b);
}

/*
 * While a detached session runs, the list changes. When it is ended, a scan that is due runs, then
 * the list is held for the candidate.
 */
static void held_for_candidate(struct kunit *test)
{
	struct bus *b = before(test);
	struct kcyc *a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });

	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	bus_end(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, state(b)->held, 0u);
	plug(b, true);
	wait_responding(b, N + 1);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_EQ(test, state(b)->held, 1u);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, N + 1u);
	plug(b, false);
	msleep(1000);
	KUNIT_EXPECT_EQ(test, state(b)->slave_count, N + 1u);
	expect_lost(b, 1);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, serial(b, 2), 11);
	bus_end(b);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
}

/* The one that takes the detached session over holds the list from its deactivation on. */
static void held_after_takeover(struct kunit *test)
{
	struct bus *b = before(test);
	struct kcyc *a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });

	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	bus_end(b);
	a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	KUNIT_ASSERT_TRUE(test, a->taken_over);
	KUNIT_EXPECT_EQ(test, state(b)->held, 0u);
	deactivate(b);
	plug(b, true);
	msleep(1000);
	expect_held(b, N + 1);
	bus_end(b);
	expect_found(b);
}

static struct kunit_case held_cases[] = {
	KUNIT_CASE(held_after_deactivation),
	KUNIT_CASE(held_by_kernel_application),
	KUNIT_CASE(held_by_kernel_cycle),
	KUNIT_CASE(held_lost_slaves),
	KUNIT_CASE(held_power_cycled_slave),
	KUNIT_CASE(held_station_address_twice),
	KUNIT_CASE(held_slave_is_tried_again),
	KUNIT_CASE(held_without_link),
	KUNIT_CASE(held_after_due_scan),
	KUNIT_CASE(held_although_scans_do_not_end),
	KUNIT_CASE(held_during_scan),
	KUNIT_CASE(held_for_candidate),
	KUNIT_CASE(held_after_takeover),
	{}
};

static struct kunit_suite held_suite = {
	.name = "bus_held",
	.exit = bus_exit,
	.test_cases = held_cases,
};

kunit_test_suite(held_suite);
