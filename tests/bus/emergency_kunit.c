// SPDX-License-Identifier: GPL-2.0-only
/* Messages without a request are fetched soon, in every state, without an application. */
#include "cyc.h"
#include "master/mailbox/emerg.h"

#define DRIVE	1
#define SOON_MS	100
#define MANY	20

static const char text[] =
	"segment seed=31 response=200us transition=200us\n"
	"slave coupler EK1100\nslave drive drive\nslave other drive\n";

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);

	bus_idle(b);
	return b;
}

/* Send an emergency; how long it is in the slave, ms. */
static u32 send(struct bus *b)
{
	static const u8 data[5] = { 1, 2, 3, 4, 5 };
	struct ec_app *app = bus_app(b, "drive");
	u32 ms;

	KUNIT_ASSERT_FALSE(b->test, app->mbox.out_len);
	ec_app_emergency(app, 0x3210, 0x04, data, ktime_get_ns());
	KUNIT_ASSERT_TRUE(b->test, app->mbox.out_len);
	for (ms = 0; app->mbox.out_len && ms < 5000; ms++)
		usleep_range(1000, 1001);
	return ms;
}

/* The longest of some, at any phase of the monitor. */
static u32 longest(struct bus *b, u32 n)
{
	u32 i, ms = 0;

	for (i = 0; i < n; i++) {
		usleep_range(30000 + i * 1300, 30001 + i * 1300);
		ms = max(ms, send(b));
	}
	return ms;
}

static void emergency_in_each_state(struct kunit *test)
{
	static const u8 states[] = { EC_AL_PREOP, EC_AL_SAFEOP, EC_AL_PREOP };
	struct bus *b = ready(test);
	u32 i, ms;

	for (i = 0; i < ARRAY_SIZE(states); i++) {
		bus_request(b, DRIVE, states[i]);
		KUNIT_ASSERT_NE(test, bus_wait_al(b, DRIVE, states[i], 500), ~0ull);
		bus_idle(b);
		ms = longest(b, 20);
		bus_figure("emergency in AL state %u: fetched after at most %u ms", states[i], ms);
		KUNIT_EXPECT_LE(test, ms, (u32)SOON_MS);
	}
}

/* A drive is known by its PDOs: then the codes of CiA 402 hold. */
static void emergency_of_drive(struct kunit *test)
{
	struct bus *b = ready(test);

	KUNIT_EXPECT_EQ(test, bus_mbox(b, DRIVE)->profile, 402u);
	KUNIT_EXPECT_EQ(test, bus_mbox(b, 0)->profile, 0u);
	ec_app_emergency(bus_app(b, "drive"), 0x7305, 0x21, (u8[5]){ 0 }, ktime_get_ns());
	msleep(2 * SOON_MS);
	KUNIT_EXPECT_EQ(test, bus_log_lines("code 0x7305 (fault of encoder 1), error"), 1u);
}

/* The last ones stay, the oldest first. */
static void emergency_list(struct kunit *test)
{
	struct ec_emergency e[EC_EMERGENCIES];
	struct bus *b = ready(test);
	u64 before = ktime_get_real_ns();
	u32 i, total;

	KUNIT_EXPECT_EQ(test, ec_emerg_last(bus_mbox(b, DRIVE), e, &total), 0u);
	for (i = 0; i < EC_EMERGENCIES + 2; i++) {
		ec_app_emergency(bus_app(b, "drive"), 0x3200 + i, 0x04, (u8[5]){ i, 2, 3, 4, 5 },
				 ktime_get_ns());
		msleep(50);
	}
	KUNIT_ASSERT_EQ(test, ec_emerg_last(bus_mbox(b, DRIVE), e, &total),
			(u32)EC_EMERGENCIES);
	KUNIT_EXPECT_EQ(test, total, EC_EMERGENCIES + 2u);
	for (i = 0; i < EC_EMERGENCIES; i++) {
		KUNIT_EXPECT_EQ(test, e[i].code, 0x3202 + i);
		KUNIT_EXPECT_EQ(test, e[i].error_register, 0x04);
		KUNIT_EXPECT_EQ(test, e[i].data[0], i + 2);
		KUNIT_EXPECT_EQ(test, e[i].data[4], 5);
		KUNIT_EXPECT_GE(test, e[i].time_ns, before + i * 50 * NSEC_PER_MSEC);
	}
}

/*
 * Readers of the list take no lock that the mailbox holds for longer than a copy: with lockdep
 * (run.sh --debug) a lock taken twice is a failure.
 */
static void emergency_list_read_without_lock_of_mailbox(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, DRIVE);
	struct ec_emergency e[EC_EMERGENCIES];
	u32 total;

	spin_lock(&mb->desk.unasked_lock);
	KUNIT_EXPECT_EQ(test, ec_emerg_last(mb, e, &total), 0u);
	spin_unlock(&mb->desk.unasked_lock);
}

/* emergencies of many slaves beside a cycle */
struct storm {
	struct ec_app *app[MANY];
	u64 since;	/* cycle in which they were sent */
	u64 most;	/* cycles until all of them were fetched */
	u32 fetched;
};

static void storm(struct cyc *c)
{
	static const u8 data[5];
	struct storm *x = c->ctx;
	bool waiting = false;
	u32 i;

	for (i = 0; i < MANY; i++)
		waiting |= x->app[i]->mbox.out_len;
	if (!waiting && x->since) {
		x->most = max(x->most, c->cycles - x->since);
		x->fetched += MANY;
		x->since = 0;
	}
	/* 307: at any phase of the monitor */
	if (c->cycles % 307 || x->since)
		return;
	for (i = 0; i < MANY; i++)
		ec_app_emergency(x->app[i], 0x3210, 0x04, data, ktime_get_ns());
	x->since = c->cycles;
}

static void emergency_in_op(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=33 response=200us transition=200us\n"
			       "repeat 20 slave d drive\n", MANY);
	struct cyc *c = cyc_in_op(b, 0, MANY);
	struct storm x = { .since = 0 };
	char name[8];
	u32 i;

	for (i = 0; i < MANY; i++) {
		scnprintf(name, sizeof(name), "d%u", i + 1);
		x.app[i] = bus_app(b, name);
	}
	c->ctx = &x;
	c->each = storm;
	c->incomplete = 0;
	cyc_run(c, 5000);
	bus_figure("emergencies of %u slaves at once in OP at 1 kHz: %u, all fetched after at most %llu ms",
		   MANY, x.fetched, x.most);
	KUNIT_EXPECT_GE(test, x.fetched, 10u * MANY);
	KUNIT_EXPECT_LE(test, x.most, (u64)SOON_MS);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
}

/* A slave that takes only the usual control byte: it comes to PREOP, and is polled. */
static void emergency_strict(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=32 response=200us transition=200us\n"
			       "slave coupler EK1100\nslave drive drive strict=yes\n", 2);
	u32 ms;

	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_esc(b, DRIVE)->sm[1].page.control, 0x22);
	ms = longest(b, 20);
	bus_figure("emergency of a polled slave: fetched after at most %u ms", ms);
	KUNIT_EXPECT_LE(test, ms, (u32)SOON_MS);
	/* and again from INIT */
	bus_request(b, DRIVE, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, DRIVE, EC_AL_INIT, 500), ~0ull);
	bus_request(b, DRIVE, EC_AL_PREOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, DRIVE, EC_AL_PREOP, 500), ~0ull);
}

/* One that shows no event, although it takes the setting: that is found out. */
static void emergency_unshown(struct kunit *test)
{
	static const u8 none[2];
	struct bus *b = ready(test);
	u32 i;

	KUNIT_ASSERT_EQ(test, bus_fpwr(b, bus_slave(b, DRIVE)->station,
				       EC_REG_ECAT_MASK, none, 2), 0);
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_LE(test, longest(b, 1), 1000u + SOON_MS);
	KUNIT_EXPECT_LE(test, longest(b, 20), (u32)SOON_MS);
}

/* While there is no message nothing is asked for, but once a second. */
static void emergency_costs_nothing(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 frames;

	msleep(200);
	frames = bus_frames(b);
	msleep(10000);
	frames = bus_frames(b) - frames;
	bus_figure("frames of an idle bus in 10 s: %llu", frames);
	/* the monitor's broadcasts, every 20 ms, and some a second */
	KUNIT_EXPECT_LE(test, frames, 600ull);
}

/* A slave that sends without end gets a part of the bus only. */
static void emergency_flood(struct kunit *test)
{
	struct bus *b = ready(test);
	u64 frames;

	send(b);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, DRIVE, 0, EC_SIM_MAILBOX_BABBLE, 0);
	ec_app_emergency(bus_app(b, "drive"), 0x3210, 0x04, (u8[5]){ 0 }, ktime_get_ns());
	msleep(200);
	frames = bus_frames(b);
	msleep(10000);
	frames = bus_frames(b) - frames;
	bus_figure("frames beside a slave that sends without end, in 10 s: %llu", frames);
	KUNIT_EXPECT_GT(test, frames, 1000ull);
	KUNIT_EXPECT_LE(test, frames, 2500ull);
}

static struct kunit_case emergency_cases[] = {
	KUNIT_CASE(emergency_in_each_state),
	KUNIT_CASE(emergency_of_drive),
	KUNIT_CASE(emergency_list),
	KUNIT_CASE(emergency_list_read_without_lock_of_mailbox),
	KUNIT_CASE(emergency_in_op),
	KUNIT_CASE(emergency_strict),
	KUNIT_CASE(emergency_unshown),
	KUNIT_CASE(emergency_costs_nothing),
	KUNIT_CASE(emergency_flood),
	{}
};

static struct kunit_suite emergency_suite = {
	.name = "bus_emergency",
	.exit = bus_exit,
	.test_cases = emergency_cases,
};

kunit_test_suites(&emergency_suite);
