// SPDX-License-Identifier: GPL-2.0-only
/* Datagrams of the monitor in frames of the cycle. */
#include "kcyc.h"
#include "master/bus/line_errors.h"
#include "master/cycle/cycle.h"

/* three frames a cycle, the last one has room */
static const char text[] =
	"segment seed=77 response=100us transition=1ms\n"
	"repeat 8 slave s io in=1600 out=1600\nconnect s1.1 -> s1.1\n";

/* process data that leave a byte or two of a frame free */
static const char full_text[] =
	"segment seed=78 response=100us transition=1ms\nslave s io in=11872\n";

#define N	8
#define CYCLES	1000

/* what a case counts while the cycle runs */
struct ride {
	u32 carried;	/* frames with a rider */
	u32 waiting;	/* sends that found a rider waiting */
	u32 most_ns;	/* wire time of a send */
	u32 wrong;	/* working counters beyond what is expected */
	bool lose;	/* the next frame with a rider */
	bool lost;
};

static struct ec_riders *riders(struct cyc *c)
{
	return bus_riders(c->b);
}

/* The last frame of the next send is lost: the riders are in it. */
static void lose_last(struct cyc *c)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .arg = 3,
	};

	KUNIT_ASSERT_EQ(c->b->test, ec_sim_add_fault(c->b->sim, &f), 0);
}

static void count(struct cyc *c)
{
	struct ride *r = c->ctx;
	bool waiting = atomic_read(&riders(c)->queued);

	r->waiting += waiting;
	r->most_ns = max(r->most_ns, bus_last_wire(c->b)->ns);
	r->wrong += cyc_state(c, 0)->working_counter > cyc_state(c, 0)->expected;
	r->carried = riders(c)->seq;
	if (r->lose && waiting) {
		r->lose = false;
		r->lost = true;
		lose_last(c);
	}
}

static struct cyc *start(struct kunit *test, const char *segment, u32 n)
{
	struct cyc *c = cyc_in_op(bus_up(test, segment, n), 0, n);

	c->ctx = kunit_kzalloc(test, sizeof(struct ride), GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, c->ctx);
	c->each = count;
	/* what brings slaves to OP is over */
	cyc_run(c, 200);
	memset(c->ctx, 0, sizeof(struct ride));
	c->incomplete = 0;
	return c;
}

static u64 seen_us(const struct cyc *c)
{
	return div_u64(ktime_get_ns() - bus_table(c->b)->complete_ns, NSEC_PER_USEC);
}

/* The monitor needs no frame of its own, and no domain counts its datagram. */
static void rider_beside_process_data_not_counted(struct kunit *test)
{
	struct cyc *c = start(test, text, N);
	struct ride *r = c->ctx;
	u32 rides = riders(c)->seq, sent = bus_n_dgrams(c->b);
	u64 frames = bus_frames(c->b);

	cyc_run(c, CYCLES);
	frames = bus_frames(c->b) - frames;
	rides = riders(c)->seq - rides;
	bus_figure("%llu frames in %u cycles of %u frames, %u riders", frames, CYCLES, sent, rides);
	KUNIT_EXPECT_EQ(test, frames, (u64)CYCLES * sent);
	/* one in 20 ms */
	KUNIT_EXPECT_GE(test, rides, CYCLES / 25);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, r->wrong, 0u);
	KUNIT_EXPECT_LT(test, seen_us(c), 50000ull);
	KUNIT_EXPECT_EQ(test, bus_responding(c->b), N);
	KUNIT_EXPECT_EQ(test, bus_al_states(c->b), EC_AL_OP);
	cyc_release(c);
}

/* The same when the kernel runs the cycle. */
static void rider_in_kernel_cycle_not_counted(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;
	u64 frames, sends;
	u32 rides;

	msleep(200);
	kcyc_wait_cycles(a, 1);
	frames = bus_frames(b);
	sends = bus_sends(b);
	rides = bus_riders(b)->seq;
	kcyc_wait_cycles(a, CYCLES);
	sends = bus_sends(b) - sends;
	KUNIT_EXPECT_EQ(test, bus_frames(b) - frames, sends * bus_last_wire(b)->frames);
	KUNIT_EXPECT_GE(test, bus_riders(b)->seq - rides, CYCLES / 25);
	KUNIT_EXPECT_EQ(test, cyc_state(a->c, 0)->working_counter, cyc_state(a->c, 0)->expected);
	KUNIT_EXPECT_LT(test, seen_us(a->c), 50000ull);
}

/* Without the frame only this round is lost: the monitor asks again, and finds all slaves. */
static void rider_in_lost_frame_loses_one_round(struct kunit *test)
{
	struct cyc *c = start(test, text, N);
	struct ride *r = c->ctx;
	u32 lines = bus_log_lines("slaves responding"), scans = bus_scans(c->b), rides;

	r->lose = true;
	cyc_run(c, 100);
	KUNIT_ASSERT_TRUE(test, r->lost);
	KUNIT_EXPECT_EQ(test, c->incomplete, 1ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 1ull);
	rides = riders(c)->seq;
	cyc_run(c, 200);
	KUNIT_EXPECT_GE(test, riders(c)->seq - rides, 8u);
	KUNIT_EXPECT_EQ(test, c->incomplete, 1ull);
	KUNIT_EXPECT_EQ(test, bus_log_lines("slaves responding"), lines);
	KUNIT_EXPECT_EQ(test, bus_scans(c->b), scans);
	KUNIT_EXPECT_EQ(test, bus_responding(c->b), N);
	KUNIT_EXPECT_LT(test, seen_us(c), 50000ull);
	cyc_release(c);
}

/* Frames of its own, when the application stops, and when it sends no process data. */
static void rider_without_cycle_monitor_continues(struct kunit *test)
{
	struct cyc *c = start(test, text, N);
	u64 queued = c->queued, frames;
	u32 i, rides = riders(c)->seq;

	/* a frame that was queued or sent at the last moment: until the cycle timeout is noticed */
	msleep(200);
	for (i = 0; i < 10; i++) {
		msleep(100);
		KUNIT_EXPECT_LT_MSG(test, seen_us(c), 60000ull, "after %u ms", 200 + 100 * i);
	}
	KUNIT_EXPECT_LE(test, riders(c)->seq - rides, 1u);
	c->next = ktime_get();
	c->queued = 0;
	cyc_run(c, 10);
	rides = riders(c)->seq;
	for (i = 0; i < 10; i++) {
		frames = bus_frames(c->b);
		cyc_run(c, 100);
		KUNIT_EXPECT_LT(test, seen_us(c), 60000ull);
		KUNIT_EXPECT_GE(test, bus_frames(c->b) - frames, 2ull);
	}
	KUNIT_EXPECT_EQ(test, riders(c)->seq, rides);
	/* a second later at most they ride again */
	c->queued = queued;
	cyc_run(c, 1100);
	rides = riders(c)->seq;
	cyc_run(c, 100);
	KUNIT_EXPECT_GE(test, riders(c)->seq - rides, 4u);
	KUNIT_EXPECT_EQ(test, bus_responding(c->b), N);
	cyc_release(c);
}

/* Where the wire has no time for it, the cycle gets no longer: the monitor's frames wait. */
static void rider_without_wire_time_waits(struct kunit *test)
{
	struct cyc *c = start(test, text, N);
	struct ride *r = c->ctx;

	cyc_run(c, 100);
	KUNIT_EXPECT_GT(test, r->most_ns, bus_plain_wire(c->b)->ns);
	/* a rider of two bytes needs 1120 ns: less is free */
	c->period_ns = DIV_ROUND_UP(bus_plain_wire(c->b)->ns, 900) * NSEC_PER_USEC;
	bus_set_interval(c->b, c->period_ns / NSEC_PER_USEC);
	c->next = ktime_get();
	cyc_run(c, 5);
	memset(r, 0, sizeof(*r));
	cyc_run(c, 3 * CYCLES);
	KUNIT_EXPECT_GT(test, r->waiting, 0u);
	KUNIT_EXPECT_LE(test, r->most_ns, bus_plain_wire(c->b)->ns);
	KUNIT_EXPECT_EQ(test, r->wrong, 0u);
	KUNIT_EXPECT_LT(test, seen_us(c), 100000ull);
	cyc_release(c);
}

/* A frame that is full takes none; no frame is longer than Ethernet has it. */
static void rider_full_frame_carries_none(struct kunit *test)
{
	struct cyc *c = start(test, full_text, 1);
	const struct ec_link_stats *st = bus_stats(c->b);
	u64 frames = bus_frames(c->b), bytes = atomic64_read(&st->tx_bytes), more;
	u32 len = EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD + bus_dgrams(c->b)[0].len;

	KUNIT_ASSERT_EQ(test, bus_n_dgrams(c->b), 1u);
	KUNIT_ASSERT_GT(test, len + EC_DGRAM_OVERHEAD + 2, (u32)EC_ETH_MAX);
	cyc_run(c, CYCLES);
	more = bus_frames(c->b) - frames - CYCLES;
	bytes = atomic64_read(&st->tx_bytes) - bytes;
	/* the others have the minimum */
	KUNIT_EXPECT_EQ(test, bytes, (u64)CYCLES * len + more * EC_ETH_MIN);
	KUNIT_EXPECT_GE(test, more, CYCLES / 40);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_LT(test, seen_us(c), 60000ull);
	cyc_release(c);
}

/*
 * While all is well the interrupt of a timer looks at the rider, and the monitor at each tenth;
 * what changes wakes it as soon as it would look.
 */
static void rider_monitor_sleeps_while_all_is_well(struct kunit *test)
{
	struct cyc *c = start(test, text, N);
	unsigned long looks;
	u32 rides;
	u64 t;

	/* now it is in step */
	cyc_run(c, 200);
	looks = bus_monitor_slept(c->b);
	rides = riders(c)->seq;
	t = ktime_get_ns();
	while (ktime_get_ns() - t < 2 * NSEC_PER_SEC) {
		cyc_run(c, 1);
		KUNIT_EXPECT_LE(test, seen_us(c), 50000ull);
	}
	looks = bus_monitor_slept(c->b) - looks;
	rides = riders(c)->seq - rides;
	bus_figure("2 s in OP: %u riders, the monitor has slept %lu times", rides, looks);
	KUNIT_EXPECT_GE(test, rides, 80u);
	KUNIT_EXPECT_LE(test, looks, 8ul);
	/* it still looks by itself, once a second */
	KUNIT_EXPECT_GE(test, looks, 2ul);
	bus_fault(c->b, EC_SIM_FAULT_CUT, N - 2, 1, 0, 0);
	t = ktime_get_ns();
	while (bus_responding(c->b) == N && ktime_get_ns() - t < NSEC_PER_SEC)
		cyc_run(c, 1);
	t = ktime_get_ns() - t;
	bus_figure("a slave is cut off: known after %llu us", div_u64(t, NSEC_PER_USEC));
	KUNIT_EXPECT_LE(test, t, 50 * NSEC_PER_MSEC);
	cyc_release(c);
}

/* the frame a second of the look at error counters is not the monitor's that is counted here */
static int rider_init(struct kunit *test)
{
	WRITE_ONCE(ec_line_errors_limit, 0);
	return 0;
}

static void rider_exit(struct kunit *test)
{
	WRITE_ONCE(ec_line_errors_limit, 10);
	bus_exit(test);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(rider_beside_process_data_not_counted),
	KUNIT_CASE(rider_in_kernel_cycle_not_counted),
	KUNIT_CASE(rider_in_lost_frame_loses_one_round),
	KUNIT_CASE(rider_without_cycle_monitor_continues),
	KUNIT_CASE(rider_without_wire_time_waits),
	KUNIT_CASE(rider_full_frame_carries_none),
	KUNIT_CASE(rider_monitor_sleeps_while_all_is_well),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_rider",
	.init = rider_init, .exit = rider_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
