// SPDX-License-Identifier: GPL-2.0-only
/*
 * What a link does to those who use it: a transmit ring that is full, a cable that is
 * pulled while slaves are read, a reply that claims what cannot be.
 */
#include <linux/kthread.h>
#include "cyc.h"
#include "slow.h"
#include "master/boundary/ioctl.h"
#include "master/bus/known.h"
#include "master/bus/scan_count.h"

#define MANY	100

static const char many[] =
	"segment seed=31 response=100us transition=1ms\n"
	"repeat 100 slave d drive in=8 out=8\n";

/* all have been read, with their PDOs, and none is blamed for anything */
static void all_are_well(struct bus *b, u32 n)
{
	u32 i;

	for (i = 0; i < n; i++) {
		struct ec_slave *s = bus_slave(b, i);

		KUNIT_EXPECT_EQ_MSG(b->test, s->note.error, EC_SLAVE_OK, "slave %u: %s", i,
				    s->note.why);
		KUNIT_EXPECT_FALSE_MSG(b->test, ec_slave_pdos_pending(s), "slave %u: no PDOs", i);
		KUNIT_EXPECT_EQ_MSG(b->test, s->pdos.sm[2].n, 1u, "slave %u", i);
	}
}

/* 25 Mbit/s and 16 buffers: some hundred frames at once wait for room. */
static void link_full_transmit_ring_delays_only(struct kunit *test)
{
	u32 lines = bus_log_lines("EtherCAT 0-");
	struct bus *b = bus_new(test, many);
	struct slow *s = slow_plug(b, 16, 4);
	u64 us = bus_wait(b, MANY, EC_AL_PREOP, 10000);
	unsigned int i;

	KUNIT_ASSERT_NE(test, us, ~0ull);
	bus_idle(b);
	bus_figure("%u slaves at 25 Mbit/s with 16 transmit buffers: PREOP after %llu us, ring full %u times",
		   MANY, us, slow_full(s));
	all_are_well(b, MANY);
	/* nor was anyone meanwhile: a slave that fails is tried again, and well then */
	KUNIT_EXPECT_EQ(test, bus_log_lines("EtherCAT 0-"), lines);
	KUNIT_EXPECT_EQ(test, bus_scans(b), 1u);
	KUNIT_EXPECT_GT(test, slow_full(s), 0u);
	/* not everybody who waits tries for himself */
	KUNIT_EXPECT_LT(test, slow_full(s), 20000u);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_tx_errors(b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_acyclic(b), 0u);
	/* a frame of the monitor may be on its way at this moment, not all the time */
	for (i = 0; i < 100 && bus_acyclic_ns(b); i++)
		usleep_range(100, 110);
	KUNIT_EXPECT_EQ(test, bus_acyclic_ns(b), 0);
}

/* A device that hangs ends the wait of everybody, and goes on when it does. */
static void link_hanging_device_ends_in_error(struct kunit *test)
{
	struct bus *b = bus_new(test, many);
	struct slow *s = slow_plug(b, 16, 4);
	u16 station;
	u64 t0;
	u8 v[4];

	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	station = bus_slave(b, 0)->station;
	slow_stop(s, true);
	/* the ring fills by what the monitor sends */
	msleep(3000);
	KUNIT_EXPECT_GT(test, slow_full(s), 0u);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, bus_fprd(b, station, 0, v, 4), -EBUSY);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 2 * NSEC_PER_SEC);
	KUNIT_EXPECT_GT(test, bus_tx_errors(b), 0ull);
	slow_stop(s, false);
	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_fprd(b, bus_slave(b, 0)->station, 0, v, 4), 0);
}

/* Slaves whose frames found no room in the ring of a device that hung are tried again. */
static void link_hanging_device_is_no_fault_of_slaves(struct kunit *test)
{
	struct bus *b = bus_new(test, many);
	struct slow *s = slow_plug(b, 16, 4);
	u32 i;

	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	for (i = 0; i < MANY; i++)
		bus_request(b, i, EC_AL_INIT);
	bus_idle(b);
	for (i = 0; i < MANY; i++)
		bus_request(b, i, EC_AL_PREOP);
	/* all are on their way */
	usleep_range(5000, 5001);
	slow_stop(s, true);
	msleep(2500);
	slow_stop(s, false);
	msleep(5000);
	for (i = 0; i < MANY; i++)
		KUNIT_EXPECT_EQ_MSG(test, bus_slave(b, i)->al.status, EC_AL_PREOP, "slave %u: %s",
				    i,
				    bus_slave(b, i)->note.why);
}

/* how long until the monitor knows, us; ~0 after a second */
static u64 until_link_is(struct bus *b, struct cyc *c, bool up)
{
	u64 t0 = ktime_get_ns();

	while (bus_link_up(b) != up) {
		if (ktime_get_ns() - t0 > NSEC_PER_SEC)
			return ~0ull;
		if (c)
			cyc_run(c, 1);
		else
			usleep_range(100, 101);
	}
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

static u32 failed(struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < bus_n_slaves(b); i++)
		n += bus_slave_at(b, i)->note.error != EC_SLAVE_OK;
	return n;
}

/* wait for a scan of all slaves that has begun to read EEPROMs */
static void scan_begins(struct bus *b, struct cyc *c)
{
	u32 i;

	for (i = 0; i < 10000; i++) {
		if (bus_scan_busy(b) && bus_table(b)->scan_slaves == MANY)
			break;
		if (c)
			cyc_run(c, 1);
		else
			usleep_range(100, 101);
	}
	KUNIT_ASSERT_TRUE(b->test, bus_scan_busy(b));
	if (c)
		cyc_run(c, 10);
	else
		usleep_range(5000, 5001);
	KUNIT_ASSERT_TRUE(b->test, bus_scan_busy(b));
}

/* The link goes while slaves are scanned: none is blamed, all are found later. */
static void link_loss_ends_scan(struct kunit *test)
{
	struct bus *b = bus_up(test, many, MANY);
	u64 us;

	bus_idle(b);
	bus_rescan(b);
	scan_begins(b, NULL);
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	us = until_link_is(b, NULL, false);
	bus_figure("link lost while %u slaves are scanned: known after %llu us", MANY, us);
	KUNIT_EXPECT_LT(test, us, 100000ull);
	msleep(100);
	KUNIT_EXPECT_FALSE(test, bus_scan_busy(b));
	KUNIT_EXPECT_EQ(test, failed(b), 0u);
	bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	all_are_well(b, MANY);
}

/* The same beside a cycle of 20 ms, where frames wait for their turn. */
static void link_loss_beside_cycle(struct kunit *test)
{
	struct bus *b = bus_up(test, many, MANY);
	struct cyc *c;
	u64 us;

	bus_idle(b);
	c = cyc_new(b, 20000);
	cyc_domain(c);
	cyc_map_all(c, 0, 8, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	/* new ones at the end, so that there is something to read */
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, MANY - 1, 0, 0, 0);
	/* the scan that finds it gone is over then */
	cyc_run(c, 60);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, MANY - 1, 0, 0, 0);
	scan_begins(b, c);
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	us = until_link_is(b, c, false);
	bus_figure("link lost while a slave is scanned beside a cycle of 20 ms: known after %llu us",
		   us);
	KUNIT_EXPECT_LT(test, us, 100000ull);
	/* nobody waits for a frame that cannot leave */
	cyc_run(c, 3);
	KUNIT_EXPECT_EQ(test, bus_acyclic(b), 0u);
}

/* a caller whose frame is on its way, and is sent again if @repeat */
struct waiting {
	struct bus *b;
	u16 station;
	bool repeat;
	int ret;
	u64 end_ns;
	struct completion done;
};

static int wait_for_frame(void *arg)
{
	struct waiting *w = arg;
	u8 v[4];
	struct ec_dg dg = EC_DG(EC_CMD_FPRD, w->station, 0, 4, v);

	dg.repeat = w->repeat;
	w->ret = bus_xfer(w->b, &dg, 1);
	w->end_ns = ktime_get_ns();
	complete(&w->done);
	return 0;
}

/* Callers, and when the last of them knows that the link is down. */
static u64 all_know(struct kunit *test, struct waiting *w, u32 n, u64 cut_ns)
{
	u64 most = 0;
	u32 i;

	for (i = 0; i < n; i++) {
		wait_for_completion(&w[i].done);
		KUNIT_EXPECT_EQ_MSG(test, w[i].ret, -ENETDOWN, "caller %u", i);
		most = max(most, w[i].end_ns - cut_ns);
	}
	return most;
}

static void call_some(struct bus *b, struct waiting *w, u32 n)
{
	u32 i;

	for (i = 0; i < n; i++) {
		w[i] = (struct waiting){
			.b = b, .station = bus_slave(b, 1)->station, .repeat = i & 1,
		};
		init_completion(&w[i].done);
		kthread_run(wait_for_frame, &w[i], "waiting%u", i);
	}
	usleep_range(100, 101);
}

/* Without a cycle: who waits for a frame knows at once that it will not come. */
static void link_loss_ends_waiting(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=33\nslave a EK1100\nslave x EL1859\n", 2);
	static struct waiting w[10];
	u64 cut_ns, most;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	call_some(b, w, ARRAY_SIZE(w));
	usleep_range(2000, 2001);
	cut_ns = ktime_get_ns();
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	most = all_know(test, w, ARRAY_SIZE(w), cut_ns);
	bus_figure("link lost while frames are on their way, no cycle: callers know after %llu us",
		   div_u64(most, NSEC_PER_USEC));
	KUNIT_EXPECT_LT(test, most, 2 * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, bus_acyclic(b), 0u);
}

/* Beside a cycle: frames that were sent are waited for as long as those in the queue. */
static void loss_ends_waiting_beside(struct kunit *test, u32 period_us)
{
	struct bus *b = bus_up(test, "segment seed=34\nslave a EK1100\nslave x EL1859\n", 2);
	static struct waiting w[20];
	u64 cut_ns, most;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, period_us);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	call_some(b, w, 10);
	/* the first ones leave in two sends, and do not come back */
	cyc_run(c, 2);
	call_some(b, w + 10, 10);
	cut_ns = ktime_get_ns();
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	most = all_know(test, w, 20, cut_ns);
	bus_figure("link lost while frames are on their way, cycle of %u us: callers know after %llu us",
		   period_us, div_u64(most, NSEC_PER_USEC));
	KUNIT_EXPECT_LT(test, most, 2 * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, bus_acyclic(b), 0u);
}

static void link_loss_ends_waiting_beside_cycle(struct kunit *test)
{
	loss_ends_waiting_beside(test, 1000);
}

static void link_loss_ends_waiting_beside_slow_cycle(struct kunit *test)
{
	loss_ends_waiting_beside(test, 20000);
}

/* A reply that claims 65,535 slaves: nothing is allocated for them, and the others stay. */
static void link_claims_beyond_memory_refused(struct kunit *test)
{
	struct bus *b = bus_new(test, many);
	struct slow *s = slow_plug(b, 16, 1);
	u64 frames;

	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	KUNIT_EXPECT_GE(test, ec_scan_limit(), 1000u);
	KUNIT_ASSERT_LT(test, ec_scan_limit(), 65535u);
	slow_claim(s, 65535);
	msleep(500);
	frames = bus_frames(b);
	msleep(1000);
	/* the monitor's looks only, and the claim is no number of slaves */
	KUNIT_EXPECT_LT(test, bus_frames(b) - frames, 300ull);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), MANY);
	KUNIT_EXPECT_EQ(test, bus_responding(b), MANY);
	slow_claim(s, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, MANY, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	all_are_well(b, MANY);
}

static u16 fresh(struct kunit *test, struct ec_bus *bus, u16 last, struct ec_slave **known,
		 const u8 *claims)
{
	u16 station;

	bus->next_station = last;
	station = ec_known_fresh_station(bus, known, claims);
	KUNIT_EXPECT_EQ(test, bus->next_station, station ?: last);
	return station;
}

/* All addresses in use: the search ends. */
static void link_station_search_ends(struct kunit *test)
{
	struct ec_slave **known = kvcalloc(EC_MAX_SLAVES + 1, sizeof(*known), GFP_KERNEL);
	struct ec_bus *bus = kunit_kzalloc(test, sizeof(*bus), GFP_KERNEL);
	u8 *claims = kvzalloc(EC_MAX_SLAVES + 1, GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, bus);
	KUNIT_ASSERT_NOT_NULL(test, known);
	KUNIT_ASSERT_NOT_NULL(test, claims);
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 0, known, claims), 1);
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 65535, known, claims), 1);
	/* 65535 is no slave's: the clocks use it for "none" */
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 65534, known, claims), 1);
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 65534, NULL, NULL), 1);
	memset(claims, 1, EC_MAX_SLAVES + 1);
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 7, known, claims), 0);
	claims[7] = 0;
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 7, known, claims), 7);
	KUNIT_EXPECT_EQ(test, fresh(test, bus, 8, known, claims), 7);
	kvfree(known);
	kvfree(claims);
}

/* That of a disconnected slave is given only if there is no other one: it may return with it. */
static void link_station_of_disconnected_kept(struct kunit *test)
{
	static const char text[] =
		"segment seed=3 response=100us transition=1ms\n"
		"slave hub EK1100\nslave a drive in=8 out=8\n"
		"branch hub 2\nslave c drive in=8 out=8\nbranch none\nslave x drive in=8 out=8\n";
	struct bus *b = bus_up(test, text, 3);
	u16 station = bus_slave(b, 2)->station;
	u64 device = bus_slave(b, 2)->device;
	u8 *claims = kvmalloc(EC_MAX_SLAVES + 1, GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, claims);
	bus_idle(b);
	bus_command(b, "unplug hub.2");
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 20000), ~0ull);
	bus_idle(b);
	bus_table(b)->next_station = station - 1;
	bus_command(b, "plug a.1 x.0");
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 20000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->station, station + 1);
	bus_command(b, "plug hub.2 c.0");
	KUNIT_ASSERT_NE(test, bus_wait(b, 4, EC_AL_PREOP, 20000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 3)->station, station);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 3)->device, device);
	bus_command(b, "unplug hub.2");
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 20000), ~0ull);
	bus_idle(b);
	memset(claims, 1, EC_MAX_SLAVES + 1);
	claims[station] = 0;
	bus_table(b)->next_station = 7;
	KUNIT_EXPECT_EQ(test, ec_known_fresh_station(bus_table(b), NULL, claims), station);
	kvfree(claims);
}

/* offers a device in a thread of its own */
struct offer {
	struct ec_sim *sim;
	struct ec_sim_link *link;
	struct completion done;
};

static int offer(void *arg)
{
	static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, 0x78 };
	struct offer *o = arg;

	o->link = ec_sim_link_create("bus1", mac, o->sim, 0);
	complete(&o->done);
	return 0;
}

/* Neither the device nor its counters change under a call of the cycle. */
static void link_device_beside_cycle_waits_for_its_call(struct kunit *test)
{
	static const char one[] = "slave a EK1100\n";
	struct bus *b = bus_up(test, one, 1);
	struct ec_links *l = bus_links(b);
	struct ec_link *link = bus_link(b, 1);
	struct ec_sim_error err = { 0 };
	struct offer o = {};

	KUNIT_ASSERT_EQ(test, ec_sim_describe(&o.sim, &ec_sim_kernel_ops, one, strlen(one), NULL,
					      &err), 0);
	init_completion(&o.done);
	l->backup = "bus1";
	atomic64_set(&link->stats.rx_frames, 7);
	ec_access_change(l, EC_ACCESS_CYCLIC);
	KUNIT_ASSERT_TRUE(test, ec_access_enters(&l->access));
	KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(offer, &o, "offer")));
	/* not the two ticks that msleep() may take: the cycle times out then */
	usleep_range(10000, 10001);
	KUNIT_EXPECT_FALSE(test, completion_done(&o.done));
	KUNIT_EXPECT_NULL(test, link->dev);
	KUNIT_EXPECT_EQ(test, (u64)atomic64_read(&link->stats.rx_frames), 7ull);
	ec_access_leave(&l->access);
	wait_for_completion(&o.done);
	KUNIT_ASSERT_FALSE(test, IS_ERR(o.link));
	KUNIT_EXPECT_NOT_NULL(test, link->dev);
	KUNIT_EXPECT_EQ(test, (u64)atomic64_read(&link->stats.rx_frames), 0ull);
	/* the cycle goes on */
	KUNIT_EXPECT_EQ(test, ec_access_try_enter(l), 0);
	ec_access_leave(&l->access);
	KUNIT_EXPECT_EQ(test, bus_timeouts(b), 0u);
	ec_access_change(l, EC_ACCESS_DIRECT);
	ec_sim_link_destroy(o.link);
	l->backup = NULL;
}

static struct kunit_case cases[] = {
	KUNIT_CASE(link_full_transmit_ring_delays_only),
	KUNIT_CASE(link_hanging_device_ends_in_error),
	KUNIT_CASE(link_hanging_device_is_no_fault_of_slaves),
	KUNIT_CASE(link_loss_ends_scan),
	KUNIT_CASE(link_loss_beside_cycle),
	KUNIT_CASE(link_loss_ends_waiting),
	KUNIT_CASE(link_loss_ends_waiting_beside_cycle),
	KUNIT_CASE(link_loss_ends_waiting_beside_slow_cycle),
	KUNIT_CASE(link_claims_beyond_memory_refused),
	KUNIT_CASE(link_station_search_ends),
	KUNIT_CASE(link_station_of_disconnected_kept),
	KUNIT_CASE(link_device_beside_cycle_waits_for_its_call),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_link",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
