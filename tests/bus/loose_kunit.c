// SPDX-License-Identifier: GPL-2.0-only
/* A loose contact behind a port: what is not behind it must not notice. */
#include <linux/prandom.h>
#include "cyc.h"
#include "devices/sim/esc_int.h"

/* the branch with the loose contact precedes the drives in the ring */
static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\nrepeat 4 slave l drive in=8 out=8\n"
	"branch hub 2\nrepeat 3 slave d drive in=8 out=8\n";

#define N_LOOSE	4
#define N_SAFE	3
#define N	(1 + N_LOOSE + N_SAFE)
#define CUT_MS	300

/**
 * struct watch - what happens to the drives that are not behind the contact
 * @slave: their objects
 * @offline: cycles in which one was reported as absent, or not in OP
 * @incomplete: cycles in which their domain was not complete
 */
struct watch {
	struct ec_slave *slave[N_SAFE];
	u32 offline;
	u32 incomplete;
};

/* without the session lock, which a cycle must not wait for */
static void look(struct cyc *c)
{
	struct watch *w = c->ctx;
	u32 i;

	for (i = 0; i < N_SAFE; i++) {
		const struct ec_slave *s = w->slave[i];

		w->offline += READ_ONCE(s->stop.gone) || READ_ONCE(s->reply.silent) ||
			      READ_ONCE(s->work.reconfigure) || READ_ONCE(s->al.status) != EC_AL_OP;
	}
	w->incomplete += cyc_state(c, 0)->wc_state != 2;
}

static struct cyc *in_op(struct kunit *test, struct watch *w, u32 period_us)
{
	struct bus *b = bus_up(test, text, N);
	struct cyc *c;
	u32 d, i;

	bus_idle(b);
	c = cyc_new(b, period_us);
	cyc_domain(c);
	d = cyc_domain(c);
	cyc_map_all(c, 1 + N_LOOSE, N_SAFE, 0);
	cyc_map_all(c, 1, N_LOOSE, d);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 20);
	for (i = 0; i < N_SAFE; i++)
		w->slave[i] = ec_slave_ref(bus_slave(b, 1 + N_LOOSE + i));
	c->ctx = w;
	c->each = look;
	return c;
}

static void untouched(struct cyc *c, struct watch *w)
{
	struct bus *b = c->b;
	u32 i;

	for (i = 0; i < N_SAFE; i++) {
		KUNIT_EXPECT_FALSE_MSG(b->test, w->slave[i]->stop.gone, "drive %u", i);
		ec_slave_unref(w->slave[i]);
	}
	KUNIT_EXPECT_EQ(b->test, w->offline, 0u);
	KUNIT_EXPECT_LE_MSG(b->test, (u64)w->incomplete, ec_sim_disturbed(b->sim),
			    "frames in flight when the contact changed");
	c->each = NULL;
}

static void at(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u64 ns)
{
	struct ec_sim_fault f = { .at_ns = ns, .type = type, .slave = slave, .port = port };

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/* The slaves behind the contact, whose port opens at @t for @ns; @cold: they lose their power. */
static void open_contact(struct bus *b, u64 t, u64 ns, bool cold)
{
	u32 i;

	at(b, EC_SIM_FAULT_CUT, 0, 1, t);
	at(b, EC_SIM_FAULT_HEAL, 0, 1, t + ns);
	for (i = 1; cold && i <= N_LOOSE; i++) {
		at(b, EC_SIM_FAULT_POWER_OFF, i, 0, t);
		at(b, EC_SIM_FAULT_POWER_ON, i, 0, t + ns);
	}
}

static const struct contact {
	const char *name;
	u32 period_us;
	u32 open_ms;	/* at least */
	u32 spread_ms;	/* more by chance, open and closed */
	u32 breaks;	/* between two times of rest */
	bool cold;
} contacts[] = {
	{ "five breaks of 0.3 s, cycle 10 ms", 10000, 300, 0, 5, false },
	{ "short breaks, cycle 1 ms", 1000, 3, 100, 20, false },
	{ "short breaks with loss of power, cycle 1 ms", 1000, 3, 100, 20, true },
	{ "short breaks with loss of power, cycle 4 ms", 4000, 20, 200, 10, true },
};

static void contact_desc(const struct contact *c, char *desc)
{
	strscpy(desc, c->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(contact, contacts, contact_desc);

/* Where the breaks begin within a scan differs. */
static void loose_other_branch_stays_in_op(struct kunit *test)
{
	const struct contact *k = test->param_value;
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w, k->period_us);
	u32 lines = bus_log_lines("SII read failed"), round, i;
	struct rnd_state r;
	u64 t;

	prandom_seed_state(&r, 7);
	for (round = 0; round < 8; round++) {
		t = ktime_get_ns() + prandom_u32_state(&r) % 20000000;
		for (i = 0; i < k->breaks; i++) {
			u64 us = k->open_ms * 1000ull +
				 k->spread_ms * (prandom_u32_state(&r) % 1000), ns = us * 1000;

			open_contact(c->b, t, ns, k->cold);
			t += ns + 20 * NSEC_PER_MSEC +
			     prandom_u32_state(&r) % (400 * NSEC_PER_MSEC);
		}
		while (ktime_get_ns() < t)
			cyc_run(c, 1);
		/* after so many losses a port is opened after a minute of link */
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 90000), ~0ull);
	}
	untouched(c, &w);
	KUNIT_EXPECT_EQ(test, bus_log_lines("SII read failed"), lines);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 1)->wc_state, 2u);
	bus_figure("%s, %u times: drives beside them offline in %u, incomplete in %u of %llu cycles",
		   k->name, 8 * k->breaks, w.offline, w.incomplete, c->cycles);
}

static void set_station(struct bus *b, u32 index, u16 station)
{
	put_unaligned_le16(station, bus_esc(b, index)->mem + EC_REG_STATION);
	ec_sim_rehash(bus_esc(b, index));
}

/* A slave comes back with the address of a drive that never left: next to it, or not. */
static void loose_address_of_another(struct kunit *test)
{
	static const u32 from[] = { 1, 4, 4 }, to[] = { 6, 5, 6 };
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w, 1000);
	struct bus *b = c->b;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(from); i++) {
		open_contact(b, ktime_get_ns(), 100 * NSEC_PER_MSEC, false);
		cyc_run(c, 50);
		set_station(b, from[i], w.slave[to[i] - N_LOOSE - 1]->station);
		bus_esc(b, from[i])->mem[EC_REG_AL_STATUS] = EC_AL_PREOP;
		cyc_run(c, 500);
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	}
	untouched(c, &w);
}

/*
 * Drives have got the addresses that a scan which was thrown away meant for other slaves: seen from
 * the front of the ring each is in its place, then only from its end.
 */
static void loose_addresses_overwritten(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w, 1000);
	struct bus *b = c->b;
	u32 end, i;

	for (end = 0; end < 2; end++) {
		bus_fault(b, EC_SIM_FAULT_CUT, 0, 1, 0, 0);
		cyc_run(c, 100);
		KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 1u + N_SAFE);
		for (i = 0; i < N_SAFE; i++)
			set_station(b, 1 + N_LOOSE + i, ++bus_table(b)->next_station);
		if (end)
			bus_fault(b, EC_SIM_FAULT_HEAL, 0, 1, 0, 0);
		else
			bus_rescan(b);
		cyc_run(c, 100);
		for (i = 0; i < N_SAFE; i++)
			KUNIT_EXPECT_EQ(test, w.slave[i]->station,
					get_unaligned_le16(bus_esc(b, 1 + N_LOOSE + i)->mem +
							   EC_REG_STATION));
		bus_fault(b, EC_SIM_FAULT_HEAL, 0, 1, 0, 0);
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
		cyc_run(c, 1000);
	}
	untouched(c, &w);
}

/* All slaves are away while EEPROMs are read: none of these is at fault. */
static void loose_bus_empty_during_scan(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w, 1000);
	u32 lines = bus_log_lines("SII read failed"), i;
	struct bus *b = c->b;

	c->each = NULL;
	for (i = 0; i < 10; i++) {
		u64 t = ktime_get_ns();

		open_contact(b, t, 200 * NSEC_PER_MSEC, true);
		t += (230 + 9 * i) * NSEC_PER_MSEC;
		at(b, EC_SIM_FAULT_CUT, -1, 0, t);
		at(b, EC_SIM_FAULT_HEAL, -1, 0, t + 300 * NSEC_PER_MSEC);
		cyc_run(c, 700);
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
	}
	for (i = 0; i < N_SAFE; i++)
		ec_slave_unref(w.slave[i]);
	KUNIT_EXPECT_EQ(test, bus_log_lines("SII read failed"), lines);
}

/* One that cannot be read when it is back keeps its address, and is the same when it can. */
static void loose_unread_stays_itself(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w, 1000);
	struct bus *b = c->b;
	u16 station = bus_slave(b, 2)->station;
	u64 device = bus_slave(b, 2)->device;

	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, 2, 0, 1, 0);
	open_contact(b, ktime_get_ns(), 50 * NSEC_PER_MSEC, false);
	cyc_run(c, 5000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->station, station);
	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, 2, 0, 0, 0);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 60000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->station, station);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->device, device);
	untouched(c, &w);
}

/* New slaves come before one that could not be read: they do not get its number. */
static void loose_unread_keeps_its_number(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u64 device = bus_slave(b, 1 + N_LOOSE)->device;
	u32 i, k;

	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, 1 + N_LOOSE, 0, 1, 0);
	bus_fault(b, EC_SIM_FAULT_CUT, 0, 2, 0, 0);
	msleep(300);
	bus_fault(b, EC_SIM_FAULT_HEAL, 0, 2, 0, 0);
	msleep(1000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_ASSERT_EQ(test, bus_slave(b, 1 + N_LOOSE)->note.error, EC_SLAVE_SCAN_FAILED);
	open_contact(b, ktime_get_ns(), 400 * NSEC_PER_MSEC, true);
	msleep(300);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 1u + N_SAFE);
	msleep(2000);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1 + N_LOOSE)->device, device);
	for (i = 0; i < N; i++)
		for (k = 0; k < i; k++)
			KUNIT_EXPECT_NE(test, bus_slave(b, i)->device, bus_slave(b, k)->device);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(loose_other_branch_stays_in_op, contact_gen_params),
	KUNIT_CASE(loose_address_of_another),
	KUNIT_CASE(loose_addresses_overwritten),
	KUNIT_CASE(loose_bus_empty_during_scan),
	KUNIT_CASE(loose_unread_stays_itself),
	KUNIT_CASE(loose_unread_keeps_its_number),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_loose", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
