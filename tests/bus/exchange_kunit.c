// SPDX-License-Identifier: GPL-2.0-only
/* Frames of the cycle that are late, lost, doubled or nobody's; odd callers. */
#include "cyc.h"
#include "devices/ecdev.h"
#include "master/link/device.h"
#include "master/boundary/ioctl.h"

/* three frames a cycle; what s1 is told it shows */
static const char three_frames[] =
	"segment seed=21 response=100us transition=1ms\n"
	"repeat 8 slave s io in=1600 out=1600\nconnect s1.1 -> s1.1\n";

#define N	8

/* Every cycle sends a number; what comes back never goes back. */
static void count_up(struct cyc *c)
{
	u32 seen = get_unaligned_le32(cyc_pd(c, 0, 1)), *last = c->ctx;

	KUNIT_ASSERT_GE(c->b->test, seen, *last);
	KUNIT_ASSERT_LE(c->b->test, cyc_state(c, 0)->working_counter, cyc_state(c, 0)->expected);
	*last = seen;
	put_unaligned_le32(c->cycles + 1, cyc_pd(c, 0, 0));
}

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = cyc_in_op(bus_up(test, three_frames, N), 0, N);

	KUNIT_ASSERT_GE(test, bus_n_dgrams(c->b), 3u);
	c->ctx = kunit_kzalloc(test, sizeof(u32), GFP_KERNEL);
	c->each = count_up;
	cyc_run(c, 20);
	KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_ASSERT_GT(test, *(u32 *)c->ctx, 0u);
	c->incomplete = 0;
	return c;
}

static u64 late(const struct bus *b)
{
	return bus_late(b);
}

/* the @n-th frame from now on, or with 0 all of them */
static void frame_fault(struct bus *b, enum ec_sim_fault_type type, u32 n, u64 value)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = type, .arg = n, .arg2 = n ? 0 : 1000000,
		.value = value,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/* Does nobody hold a slot, except the monitor for a moment? */
static bool slots_free(struct bus *b)
{
	u32 i, tries, busy;

	for (tries = 0; tries < 100; tries++) {
		busy = bus_acyclic(b);
		for (i = 0; i < EC_SLOTS; i++) {
			int state = atomic_read(&bus_slot(b, i)->state);

			busy += state != EC_SLOT_FREE && state != EC_SLOT_QUARANTINE;
		}
		if (!busy)
			return true;
		usleep_range(1000, 1001);
	}
	return false;
}

static const struct delay {
	const char *name;
	u32 frame;	/* of the cycle */
	u32 us;
	u32 incomplete;	/* cycles */
	u32 late;
} delays[] = {
	{ "within_the_cycle", 1, 500, 0, 0 },
	{ "with_the_next", 1, 1200, 1, 1 },
	{ "with_the_next_part", 2, 1200, 1, 1 },
	{ "behind_the_next", 1, 2500, 1, 1 },
	{ "behind_the_next_part", 3, 2500, 1, 1 },
};

static void delay_desc(const struct delay *d, char *desc)
{
	strscpy(desc, d->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(delay, delays, delay_desc);

/* Not counted twice, not over what is newer, and never without a word. */
static void exchange_late(struct kunit *test)
{
	const struct delay *d = test->param_value;
	struct cyc *c = in_op(test);
	u64 before = late(c->b);

	frame_fault(c->b, EC_SIM_FAULT_DELAY, d->frame, (u64)d->us * NSEC_PER_USEC);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, c->incomplete, (u64)d->incomplete);
	KUNIT_EXPECT_EQ(test, late(c->b) - before, (u64)d->late);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_GE(test, *(u32 *)c->ctx + 2, (u32)c->cycles);
}

/* All frames come a cycle late: data arrive, and the counter tells it. */
static void exchange_always_late(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u64 before = late(c->b);

	frame_fault(c->b, EC_SIM_FAULT_DELAY, 0, 1200 * NSEC_PER_USEC);
	cyc_run(c, 100);
	KUNIT_EXPECT_GE(test, late(c->b) - before, 98ull * bus_n_dgrams(c->b));
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_GE(test, *(u32 *)c->ctx + 4, (u32)c->cycles);
}

/* Domain 1 is sent in every fourth cycle. */
static void each_fourth(struct cyc *c)
{
	c->queued = c->cycles % 4 ? BIT_ULL(0) : BIT_ULL(0) | BIT_ULL(1);
}

static void max_age(struct cyc *c, u32 domain, u32 sends)
{
	struct ec_ioc_domain_age age = { .domain = domain, .max_age = sends };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_DOMAIN_AGE, &age), 0);
}

/* Frames 17.5 ms late have full working counters and old inputs: their age tells. */
static void exchange_old_data(struct kunit *test)
{
	struct bus *b = bus_up(test, three_frames, N);
	u32 told = bus_log_lines("domain 0 receives stale process data"), i, min = ~0u, max = 0;
	u32 others = bus_log_lines("domain 1 receives stale process data");
	struct ec_ioc_domain_age none = { .domain = 2 };
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_domain(c);
	cyc_map_all(c, 0, N / 2, 0);
	cyc_map_all(c, N / 2, N / 2, 1);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_AGE, &none), -ENOENT);
	max_age(c, 1, 5);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	c->each = each_fourth;
	for (i = 0; i < 1000; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->age, 0);
		KUNIT_ASSERT_EQ(test, cyc_state(c, 1)->age, 0);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("receives stale process data"), told + others);

	frame_fault(b, EC_SIM_FAULT_DELAY, 0, 17500 * NSEC_PER_USEC);
	cyc_run(c, 100);
	for (i = 0; i < 2000; i++) {
		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->wc_state, 2);
		KUNIT_ASSERT_EQ(test, cyc_state(c, 0)->working_counter,
				cyc_state(c, 0)->expected);
		min = min(min, (u32)cyc_state(c, 0)->age);
		max = max(max, (u32)cyc_state(c, 0)->age);
		KUNIT_ASSERT_GE(test, cyc_state(c, 1)->age, 4);
		KUNIT_ASSERT_LE(test, cyc_state(c, 1)->age, 5);
	}
	bus_figure("frames 17.5 ms late in a 1 ms cycle: data are %u to %u sends old", min, max);
	KUNIT_EXPECT_EQ(test, min, 17u);
	KUNIT_EXPECT_EQ(test, max, 17u);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	/* once, and only where the limit is below the age */
	KUNIT_EXPECT_EQ(test, bus_log_lines("domain 0 receives stale process data"), told + 1);
	KUNIT_EXPECT_EQ(test, bus_log_lines("domain 1 receives stale process data"), others);
}

/* Without any frame back data grow old as well, but no frame has brought them. */
static void exchange_age_of_lost(struct kunit *test)
{
	u32 told = bus_log_lines("receives stale process data");
	struct cyc *c = in_op(test);

	frame_fault(c->b, EC_SIM_FAULT_LOSE, 0, 0);
	cyc_run(c, 11);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 0);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->age, 10);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->age, EC_CYC_SENDS);
	KUNIT_EXPECT_EQ(test, bus_log_lines("receives stale process data"), told);
}

/* One working counter is too low, another too high by as much: their sum hides it. */
static void exchange_sum_hides_no_wrong_counter(struct kunit *test)
{
	u32 logged = bus_log_lines("in sum, not of each datagram");
	struct ec_ioc_domain d = { };
	struct cyc *c = in_op(test);

	bus_fault(c->b, EC_SIM_FAULT_WKC, 0, 0, (u32)-1, 0);
	bus_fault(c->b, EC_SIM_FAULT_WKC, N - 1, 0, 1, 0);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, cyc_state(c, 0)->expected);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, EC_STATUS_WC_INCOMPLETE);
	KUNIT_EXPECT_GE(test, c->incomplete, 99ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_DOMAIN, &d), 0);
	KUNIT_EXPECT_EQ(test, d.working_counter, d.expected);
	KUNIT_EXPECT_EQ(test, d.wc_state, EC_STATUS_WC_INCOMPLETE);
	KUNIT_EXPECT_EQ(test, bus_log_lines("in sum, not of each datagram"), logged + 1);
	bus_fault(c->b, EC_SIM_FAULT_WKC, 0, 0, 0, 0);
	bus_fault(c->b, EC_SIM_FAULT_WKC, N - 1, 0, 0, 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
}

static const u32 pauses[] = { 0x7fffff00, 0x80000010, 0xfffffff0 };

static void pause_desc(const u32 *sends, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%#x", *sends);
}

KUNIT_ARRAY_PARAM(pause, pauses, pause_desc);

/* Many sends without a reply to the domain, as over days: the next reply counts. */
static void exchange_reply_after_pause_is_taken(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ec_cycle *cycle = bus_cycle(c->b);
	u32 i, seen;

	c->each = NULL;
	c->queued = 0;
	cyc_run(c, 3);
	KUNIT_ASSERT_EQ(test, bus_n_flight(c->b), 0u);
	cycle->send += *(const u32 *)test->param_value;
	cycle->judged = cycle->send;
	c->queued = BIT_ULL(0);
	seen = get_unaligned_le32(cyc_pd(c, 0, 1));
	for (i = 0; i < 10; i++) {
		put_unaligned_le32(seen + 1, cyc_pd(c, 0, 0));
		cyc_run(c, 1);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->age, 0);
	}
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 0, 1)), seen + 1);
}

static int send(struct cyc *c)
{
	struct ec_ioc_send s = { .queued = c->queued };

	return ec_ioc_send(&c->b->app, &s);
}

/* more sends than receives: the second one between two cycles */
static void send_more(struct cyc *c)
{
	count_up(c);
	KUNIT_ASSERT_EQ(c->b->test, send(c), 0);
}

static void exchange_send_twice(struct kunit *test)
{
	struct cyc *c = in_op(test);

	c->each = send_more;
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	msleep(1);
	KUNIT_EXPECT_EQ(test, ec_ioc_receive(&c->b->app), 0);
	KUNIT_EXPECT_EQ(test, bus_n_flight(c->b), 0u);
	KUNIT_EXPECT_EQ(test, late(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* A slave is missing, and two replies come with one receive: the inputs are of the newer one. */
static void exchange_newest_incomplete_reply_is_taken(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u32 i, k;

	c->each = NULL;
	bus_fault(c->b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	cyc_run(c, 5);
	for (i = 1000000; i < 1000020; i += 2) {
		for (k = 0; k < 2; k++) {
			put_unaligned_le32(i + k, cyc_pd(c, 0, 0));
			KUNIT_ASSERT_EQ(test, send(c), 0);
		}
		msleep(1);
		KUNIT_ASSERT_EQ(test, ec_ioc_receive(&c->b->app), 0);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 1);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->age, 0);
		/* the second send brings what the first one has written */
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 0, 1)), i);
	}
}

static void receive_more(struct cyc *c)
{
	u32 wkc = cyc_state(c, 0)->working_counter;

	count_up(c);
	KUNIT_ASSERT_EQ(c->b->test, ec_ioc_receive(&c->b->app), 0);
	KUNIT_ASSERT_EQ(c->b->test, cyc_state(c, 0)->working_counter, wkc);
	KUNIT_ASSERT_EQ(c->b->test, cyc_state(c, 0)->wc_state, 2);
}

static void exchange_receive_twice(struct kunit *test)
{
	struct cyc *c = in_op(test);

	c->each = receive_more;
	cyc_run(c, 100);
	/* and before anything can be back: that is no lateness */
	c->each = NULL;
	KUNIT_EXPECT_EQ(test, ec_ioc_receive(&c->b->app), 0);
	cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, late(c->b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* Nothing comes back for two seconds: the cycle goes on, everything returns. */
static void exchange_all_lost(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u64 before;

	frame_fault(b, EC_SIM_FAULT_LOSE, 0, 1);
	before = bus_frames(b);
	cyc_run(c, 2000);
	/* every send found a slot */
	KUNIT_EXPECT_GE(test, bus_frames(b) - before, 6000ull);
	KUNIT_EXPECT_EQ(test, bus_tx_errors(b), 0ll);
	KUNIT_EXPECT_GE(test, bus_lost(b), 5800ull);
	KUNIT_EXPECT_GE(test, c->incomplete, 1998ull);
	/* the slaves forget their inputs on the way back to OP */
	c->each = NULL;
	ec_sim_clear_faults(b->sim);
	cyc_run(c, 50);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	*(u32 *)c->ctx = 0;
	c->each = count_up;
	cyc_run(c, 5);
	before = bus_lost(b);
	c->incomplete = 0;
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(b), before);
	KUNIT_EXPECT_GE(test, *(u32 *)c->ctx + 2, (u32)c->cycles);
	cyc_release(c);
	bus_idle(b);
	KUNIT_EXPECT_TRUE(test, slots_free(b));
}

/* The session ends while frames are on their way; they come back to nobody. */
static void exchange_end_in_flight(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct bus *b = c->b;
	u32 i;

	frame_fault(b, EC_SIM_FAULT_DELAY, 0, 5 * NSEC_PER_MSEC);
	cyc_run(c, 10);
	KUNIT_EXPECT_GE(test, bus_n_flight(b), 12u);
	cyc_release(c);
	KUNIT_EXPECT_PTR_EQ(test, bus_session(b), NULL);
	msleep(20);
	ec_sim_clear_faults(b->sim);
	/* each of them was late for the master, none was taken */
	KUNIT_EXPECT_GE(test, late(b), 12ull);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	KUNIT_EXPECT_TRUE(test, slots_free(b));
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->note.error, EC_SLAVE_OK);
}

/* Who looks at working counters only sees that the device is gone. */
static void exchange_device_gone(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ec_file *app = &c->b->app;

	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	bus_no_device(c->b);
	KUNIT_EXPECT_EQ(test, ec_ioc_receive(app), -ENODEV);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, 0u);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 0);
	KUNIT_EXPECT_EQ(test, send(c), -ENODEV);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(exchange_late, delay_gen_params),
	KUNIT_CASE(exchange_always_late),
	KUNIT_CASE(exchange_old_data),
	KUNIT_CASE(exchange_age_of_lost),
	KUNIT_CASE(exchange_sum_hides_no_wrong_counter),
	KUNIT_CASE_PARAM(exchange_reply_after_pause_is_taken, pause_gen_params),
	KUNIT_CASE(exchange_send_twice),
	KUNIT_CASE(exchange_newest_incomplete_reply_is_taken),
	KUNIT_CASE(exchange_receive_twice),
	KUNIT_CASE(exchange_all_lost),
	KUNIT_CASE(exchange_end_in_flight),
	KUNIT_CASE(exchange_device_gone),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_exchange",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
