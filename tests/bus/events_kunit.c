// SPDX-License-Identifier: GPL-2.0-only
/* What happens on the bus is in the ring of events, in its order. */
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/wire/event.h"

static const char line[] =
	"segment seed=21 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave x EL1859\nslave drive drive\nslave last EL1859\n";

#define N	4
#define X	1
#define DRIVE	2
#define LAST	3

/* a reader of the ring */
struct log {
	struct kunit *test;
	const struct ec_event_ring *ring;
	u64 at;
	struct ec_event e;
};

static struct log *log_new(struct bus *b)
{
	struct log *l = kunit_kzalloc(b->test, sizeof(*l), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, l);
	l->test = b->test;
	l->ring = bus_events(b);
	l->at = ec_event_ring_head(l->ring);
	return l;
}

/* The next event of this kind; those before it are passed over. */
static bool next(struct log *l, u32 kind)
{
	u64 at = l->at;
	char text[200];

	while (ec_event_ring_get(l->ring, &l->at, &l->e))
		if (l->e.kind == kind)
			return true;
	KUNIT_FAIL(l->test, "no event %s after number %llu", ec_event_kind(kind)->name, at);
	for (l->at = at; ec_event_ring_get(l->ring, &l->at, &l->e);) {
		ec_event_text(&l->e, text, sizeof(text));
		kunit_info(l->test, "%llu: %s", l->e.number, text);
	}
	return false;
}

static void next_of(struct log *l, u32 kind, u16 slave)
{
	if (next(l, kind))
		KUNIT_EXPECT_EQ_MSG(l->test, l->e.slave, slave, "slave of event %s",
				    ec_event_kind(kind)->name);
}

/* How many of this kind came since @at. */
static u32 count(const struct log *l, u64 at, u32 kind)
{
	struct ec_event e = { };
	u32 n = 0;

	while (ec_event_ring_get(l->ring, &at, &e))
		n += e.kind == kind;
	return n;
}

static struct cyc *in_op(struct kunit *test)
{
	struct cyc *c = cyc_two_domains(bus_up(test, line, N), N);

	/* beyond the time in which changes of a working counter are counted together */
	cyc_run(c, 1500);
	return c;
}

/* cycles until @c is in OP and complete */
static void recover(struct cyc *c)
{
	u32 i;

	for (i = 0; i < 5000 && (!cyc_all_op(c) || cyc_state(c, 0)->wc_state != 2 ||
				 cyc_state(c, 1)->wc_state != 2); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_LT(c->b->test, i, 5000u);
	cyc_run(c, 100);
}

static void events_start_has_scan_and_session_in_order(struct kunit *test)
{
	struct bus *b = bus_new(test, line);
	struct log *l = log_new(b);
	struct cyc *c;

	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 50);
	cyc_release(c);
	next(l, EC_EVENT_DEVICE_ON);
	next(l, EC_EVENT_LINK_UP);
	if (next(l, EC_EVENT_SCAN_START))
		KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)N);
	if (next(l, EC_EVENT_SCAN_END))
		KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)N);
	next(l, EC_EVENT_RESERVED);
	if (next(l, EC_EVENT_ACTIVATED))
		KUNIT_EXPECT_EQ(test, l->e.arg[1], 1u);
	/* a slave takes part with its first FMMU */
	if (next(l, EC_EVENT_WKC))
		KUNIT_EXPECT_EQ(test, l->e.arg[2], 0u);
	if (next(l, EC_EVENT_AL_STATE))
		KUNIT_EXPECT_EQ_MSG(test, l->e.arg[2], (u32)N, "slaves");
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[0], (u32)EC_AL_OP, "on its way it was in SAFEOP");
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[1], (u32)EC_AL_PREOP, "before");
	next(l, EC_EVENT_DEACTIVATED);
	next(l, EC_EVENT_RELEASED);
}

static void events_unplugged_slave_is_lost_and_found(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);
	u64 begin = l->at, begin_again;

	bus_fault(c->b, EC_SIM_FAULT_CUT, DRIVE, 1, 0, 0);
	cyc_run(c, 300);
	if (next(l, EC_EVENT_WKC)) {
		KUNIT_EXPECT_EQ(test, l->e.arg[0], 1u);
		KUNIT_EXPECT_EQ_MSG(test, l->e.arg[1], 0u, "working counter");
		KUNIT_EXPECT_EQ_MSG(test, l->e.arg[2], l->e.arg[3], "it was complete");
	}
	if (next(l, EC_EVENT_RESPONDING)) {
		KUNIT_EXPECT_EQ(test, l->e.arg[0], N - 1u);
		KUNIT_EXPECT_EQ(test, l->e.arg[1], (u32)N);
	}
	next_of(l, EC_EVENT_SLAVE_LOST, LAST);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[0], (u32)DRIVE, "slave upstream");
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[1], 1u, "its port");
	KUNIT_EXPECT_LE_MSG(test, l->e.arg[5], 100u, "ms");
	KUNIT_EXPECT_EQ(test, count(l, begin, EC_EVENT_SLAVE_LOST), 1u);

	bus_fault(c->b, EC_SIM_FAULT_HEAL, DRIVE, 1, 0, 0);
	recover(c);
	next_of(l, EC_EVENT_SLAVE_FOUND, LAST);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)DRIVE);
	begin_again = l->at;
	next_of(l, EC_EVENT_AL_STATE, LAST);
	next_of(l, EC_EVENT_SLAVE_BACK, LAST);
	for (l->at = begin_again; count(l, l->at, EC_EVENT_WKC); next(l, EC_EVENT_WKC))
		;
	KUNIT_EXPECT_EQ_MSG(test, l->e.kind, (u32)EC_EVENT_WKC, "the last of them");
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[1], l->e.arg[3], "complete again");
	KUNIT_EXPECT_EQ(test, count(l, begin, EC_EVENT_SLAVE_FOUND), 1u);
}

#define MANY	100	/* drives */
#define AT	8	/* the first one that is cut off */

/* A cable with most of the bus behind it: lost, found and in OP again are one fact each. */
static void events_cut_of_many_slaves_has_few_records(struct kunit *test)
{
	char *text = kunit_kzalloc(test, 80 + MANY * 24, GFP_KERNEL);
	struct log *l;
	struct cyc *c;
	u64 begin, cut;
	u32 i, at;

	KUNIT_ASSERT_NOT_NULL(test, text);
	at = sprintf(text, "segment seed=21 response=100us transition=1ms\n");
	for (i = 0; i < MANY; i++)
		at += sprintf(text + at, "slave d%u drive\n", i);
	c = cyc_two_domains(bus_up(test, text, MANY), MANY);
	cyc_run(c, 1500);
	l = log_new(c->b);
	cut = l->at;

	bus_fault(c->b, EC_SIM_FAULT_CUT, AT, 0, 0, 0);
	cyc_run(c, 1000);
	next_of(l, EC_EVENT_SLAVE_LOST, AT);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[0], AT - 1u, "slave upstream");
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[6], MANY - (u32)AT, "slaves");
	bus_figure("cut of %u slaves: %llu events", MANY - AT,
		   ec_event_ring_head(l->ring) - cut);
	begin = ec_event_ring_head(l->ring);
	bus_fault(c->b, EC_SIM_FAULT_HEAL, AT, 0, 0, 0);
	recover(c);
	cyc_run(c, 1000);
	next_of(l, EC_EVENT_SLAVE_FOUND, AT);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[5], MANY - (u32)AT, "slaves");
	next_of(l, EC_EVENT_AL_STATE, AT);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[3], (u32)EC_AL_INIT, "lowest");
	next_of(l, EC_EVENT_SLAVE_BACK, AT);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[1], MANY - (u32)AT, "slaves");
	bus_figure("until they are in OP again: %llu events", ec_event_ring_head(l->ring) - begin);
	/* 100 such faults are in the ring */
	KUNIT_EXPECT_LE(test, 100 * (ec_event_ring_head(l->ring) - cut), EC_EVENTS_KEPT + 0ull);
}

static void events_power_loss_of_slave_is_noticed_twice(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);

	bus_fault(c->b, EC_SIM_FAULT_POWER_OFF, LAST, 0, 0, 0);
	cyc_run(c, 300);
	next_of(l, EC_EVENT_SLAVE_LOST, LAST);
	bus_fault(c->b, EC_SIM_FAULT_POWER_ON, LAST, 0, 0, 0);
	recover(c);
	next_of(l, EC_EVENT_SLAVE_FOUND, LAST);
}

static void events_al_error_has_code_and_return_to_op(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);

	ec_app_al_fail(bus_app(c->b, "drive"), EC_AL_SAFEOP, 0x001b, ktime_get_ns());
	cyc_run(c, 50);
	recover(c);
	next_of(l, EC_EVENT_AL_LEFT, DRIVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, l->e.arg[1], (u32)EC_AL_OP);
	next_of(l, EC_EVENT_AL_ERROR, DRIVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, l->e.arg[1], 0x1bu);
	do
		next_of(l, EC_EVENT_AL_STATE, DRIVE);
	while (l->e.kind == EC_EVENT_AL_STATE && l->e.arg[0] != EC_AL_OP);
}

/* What a slave had reached, and has left again before the monitor told of it. */
static void events_al_state_before_error_has_record(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct ec_slave *s = bus_slave(c->b, DRIVE);
	struct log *l = log_new(c->b);
	u64 begin = l->at;

	ec_slave_set_al(s, EC_AL_PREOP, 0, EC_AL_BY_WORKER);
	ec_slave_set_al(s, EC_AL_SAFEOP, 0, EC_AL_BY_WORKER);
	ec_slave_set_al(s, EC_AL_OP, 0, EC_AL_BY_WORKER);
	ec_slave_set_al(s, EC_AL_SAFEOP | EC_AL_ERROR, 0x1b, EC_AL_BY_ITSELF);
	next_of(l, EC_EVENT_AL_STATE, DRIVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)EC_AL_OP);
	KUNIT_EXPECT_EQ_MSG(test, l->e.arg[3], (u32)EC_AL_PREOP, "lowest");
	next_of(l, EC_EVENT_AL_LEFT, DRIVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, l->e.arg[1], (u32)EC_AL_OP);
	next_of(l, EC_EVENT_AL_ERROR, DRIVE);
	KUNIT_EXPECT_EQ(test, ec_event_ring_head(l->ring) - begin, 3ull);
}

static void events_link_down_ends_all_slaves(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);

	bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	cyc_run(c, 400);
	if (next(l, EC_EVENT_LINK_DOWN))
		KUNIT_EXPECT_EQ(test, l->e.arg[0], 0u);
	if (next(l, EC_EVENT_ALL_LOST))
		KUNIT_EXPECT_EQ(test, l->e.arg[0], (u32)N);
	bus_fault(c->b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	recover(c);
	next(l, EC_EVENT_LINK_UP);
	next(l, EC_EVENT_SCAN_END);
	next(l, EC_EVENT_WKC);
}

/* A slave that takes part in every second frame only: few records, and the last one is right. */
static void events_flapping_working_counter_has_few_records(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);
	u32 *wkc = &cyc_state(c, 1)->working_counter, before = *wkc, full = *wkc;
	u32 i, more = 0, changes = 0, last = 0, n = 0;

	for (i = 0; i < 4500; i++) {
		if (i < 3000)
			bus_fault(c->b, EC_SIM_FAULT_WKC, LAST, 0, ~i & 1, 0);
		cyc_run(c, 1);
		changes += *wkc != before;
		before = *wkc;
	}
	while (count(l, l->at, EC_EVENT_WKC) && next(l, EC_EVENT_WKC)) {
		if (l->e.arg[0] != 1)
			continue;
		n++;
		more += l->e.arg[4];
		last = l->e.arg[1];
	}
	bus_figure("%u changes of a working counter in 3 s: %u records", changes, n);
	KUNIT_EXPECT_GT(test, changes, 2000u);
	KUNIT_EXPECT_LE(test, n, 4u * EC_EVENT_RATE);
	KUNIT_EXPECT_EQ_MSG(test, n + more, changes, "each change is counted");
	KUNIT_EXPECT_EQ(test, last, full);
}

/* Nothing comes back for a while: one record a second, with all frames. */
static void events_lost_frames_are_counted_in_few_records(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);
	u64 lost = bus_lost(c->b);
	u32 n = 0, sum = 0;

	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	cyc_run(c, 2500);
	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	cyc_run(c, 1500);
	while (count(l, l->at, EC_EVENT_FRAMES_LOST) && next(l, EC_EVENT_FRAMES_LOST)) {
		n++;
		sum += l->e.arg[0];
	}
	KUNIT_EXPECT_GE(test, n, 2u);
	KUNIT_EXPECT_LE(test, n, 5u);
	KUNIT_EXPECT_GT(test, sum, 1000u);
	KUNIT_EXPECT_EQ(test, sum, (u32)(bus_lost(c->b) - lost));
}

/* One line of the kernel log for each loss of process data and its end; a stop is none. */
static void events_working_counter_and_lost_frames_are_logged(struct kunit *test)
{
	struct cyc *c = in_op(test);
	u32 down = bus_log_lines("domain 1: working counter 0 of"), up, lost;
	u32 others = bus_log_lines("domain 0: working counter");

	bus_fault(c->b, EC_SIM_FAULT_CUT, DRIVE, 1, 0, 0);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_log_lines("domain 1: working counter 0 of"), down + 1);
	up = bus_log_lines("domain 1: working counter");
	bus_fault(c->b, EC_SIM_FAULT_HEAL, DRIVE, 1, 0, 0);
	recover(c);
	cyc_run(c, 1000);
	/* once more while it is configured */
	KUNIT_EXPECT_GE(test, bus_log_lines("domain 1: working counter"), up + 1);
	KUNIT_EXPECT_LE(test, bus_log_lines("domain 1: working counter"), up + 4);
	KUNIT_EXPECT_EQ(test, bus_log_lines("domain 0: working counter"), others);

	lost = bus_log_lines("frame(s) lost");
	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	cyc_run(c, 30);
	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	recover(c);
	cyc_run(c, 12000);
	KUNIT_EXPECT_GE(test, bus_log_lines("frame(s) lost"), lost + 1);
	KUNIT_EXPECT_LE(test, bus_log_lines("frame(s) lost"), lost + 3);
	up = bus_log_lines("working counter");
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SLAVES_DOWN, NULL), 0);
	cyc_run(c, 200);
	cyc_release(c);
	msleep(100);
	KUNIT_EXPECT_EQ_MSG(test, bus_log_lines("working counter"), up, "the slaves are stopped");
	KUNIT_EXPECT_GE(test, bus_log_lines("released the master, process"), 1u);
}

/* Each loss is in the ring, the kernel log has few lines of them. */
static void events_flapping_working_counter_has_few_log_lines(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);
	u32 lines, i;

	cyc_run(c, 12000);
	lines = bus_log_lines("domain 1: working counter");
	for (i = 0; i < 9000; i++) {
		bus_fault(c->b, EC_SIM_FAULT_WKC, LAST, 0, ~(i / 300) & 1, 0);
		cyc_run(c, 1);
	}
	KUNIT_EXPECT_GE(test, count(l, l->at, EC_EVENT_WKC), 29u);
	KUNIT_EXPECT_GE(test, bus_log_lines("domain 1: working counter"), lines + 2);
	KUNIT_EXPECT_LE(test, bus_log_lines("domain 1: working counter"), lines + 6);
}

/* However many there are, they leave most of the ring to others. */
static void events_absent_slaves_have_limited_records(struct kunit *test)
{
	struct ec_ioc_slave_config sc = { .vendor_id = 1, .product_code = 2 };
	struct bus *b = bus_up(test, line, N);
	struct cyc *c = cyc_new(b, 1000);
	struct log *l = log_new(b);
	u32 i;

	cyc_domain(c);
	cyc_map_all(c, 0, N, 0);
	for (i = 0; i < 300; i++) {
		sc.position = 1000 + i;
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	}
	cyc_activate(c);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, count(l, l->at, EC_EVENT_CONFIG), 256u);
	next_of(l, EC_EVENT_CONFIG, EC_EVENT_NO_SLAVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[1], 1000u);
	KUNIT_EXPECT_EQ(test, l->e.arg[2], (u32)EC_CAUSE_NO_SLAVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[4], 2u);
	if (next(l, EC_EVENT_CONFIGS))
		KUNIT_EXPECT_EQ(test, l->e.arg[0], 44u);
	cyc_release(c);
}

static void events_emergency_has_code_and_data(struct kunit *test)
{
	static const u8 data[5] = { 1, 2, 3, 4, 5 };
	struct bus *b = bus_up(test, line, N);
	struct log *l;

	bus_idle(b);
	l = log_new(b);
	ec_app_emergency(bus_app(b, "drive"), 0x3210, 0x04, data, ktime_get_ns());
	msleep(300);
	next_of(l, EC_EVENT_EMERGENCY, DRIVE);
	KUNIT_EXPECT_EQ(test, l->e.arg[0], 0x3210u);
	KUNIT_EXPECT_EQ(test, l->e.arg[1], 4u);
	KUNIT_EXPECT_EQ(test, l->e.arg[2], 0x04030201u);
	KUNIT_EXPECT_EQ(test, l->e.arg[3], 5u);
}

static void events_application_without_sends_times_out_and_resumes(struct kunit *test)
{
	struct cyc *c = in_op(test);
	struct log *l = log_new(c->b);

	msleep(300);
	c->next = ktime_get();
	cyc_run(c, 100);
	if (next(l, EC_EVENT_TIMEOUT)) {
		KUNIT_EXPECT_GE(test, l->e.arg[0], 20u);
		KUNIT_EXPECT_EQ(test, l->e.arg[1], 1u);
	}
	if (next(l, EC_EVENT_RESUMED))
		KUNIT_EXPECT_GE(test, l->e.arg[0], 250u);
}

/* The file begins where its command says; the number of the next event is the same for all. */
static void events_reader_begins_at_oldest_or_newest(struct kunit *test)
{
	struct ec_ioc_events arg = { .size = sizeof(struct ec_event) }, bad = { .size = 60 };
	struct bus *b = bus_up(test, line, N);
	struct ec_file *f = kunit_kzalloc(test, sizeof(*f), GFP_KERNEL);
	u64 head = ec_event_ring_head(bus_events(b));

	KUNIT_ASSERT_NOT_NULL(test, f);
	ec_file_init(f, b->m, false);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &bad), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(f->reason, "64 bytes, not 60"));
	KUNIT_EXPECT_NULL_MSG(test, f->reader, "a refused file reads no events");
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &arg), 0);
	KUNIT_EXPECT_EQ(test, arg.first, 0ull);
	KUNIT_EXPECT_EQ(test, arg.next, head);
	KUNIT_EXPECT_TRUE(test, ec_file_poll(f, NULL, NULL) & EPOLLIN);
	arg.flags = EC_EVENTS_FLAG_NEW;
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &arg), 0);
	KUNIT_EXPECT_EQ(test, arg.first, head);
	KUNIT_EXPECT_FALSE(test, ec_file_poll(f, NULL, NULL) & EPOLLIN);
	ec_event(bus_base(b), EC_EVENT_DEBUG, 1);
	KUNIT_EXPECT_TRUE(test, ec_file_poll(f, NULL, NULL) & EPOLLIN);
	KUNIT_EXPECT_EQ(test, bus_readers(b), 1u);
	ec_reader_end(f);
	KUNIT_EXPECT_EQ(test, bus_readers(b), 0u);
	arg.flags = 2;
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &arg), -EOPNOTSUPP);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(events_start_has_scan_and_session_in_order),
	KUNIT_CASE(events_unplugged_slave_is_lost_and_found),
	KUNIT_CASE(events_cut_of_many_slaves_has_few_records),
	KUNIT_CASE(events_power_loss_of_slave_is_noticed_twice),
	KUNIT_CASE(events_al_error_has_code_and_return_to_op),
	KUNIT_CASE(events_al_state_before_error_has_record),
	KUNIT_CASE(events_link_down_ends_all_slaves),
	KUNIT_CASE(events_flapping_working_counter_has_few_records),
	KUNIT_CASE(events_lost_frames_are_counted_in_few_records),
	KUNIT_CASE(events_working_counter_and_lost_frames_are_logged),
	KUNIT_CASE(events_flapping_working_counter_has_few_log_lines),
	KUNIT_CASE(events_absent_slaves_have_limited_records),
	KUNIT_CASE(events_emergency_has_code_and_data),
	KUNIT_CASE(events_application_without_sends_times_out_and_resumes),
	KUNIT_CASE(events_reader_begins_at_oldest_or_newest),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_events",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
