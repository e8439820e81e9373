// SPDX-License-Identifier: GPL-2.0-only
/* The identification by AL control of a slave that is slow to reply, or never does. */
#include "cyc.h"
#include "devices/sim/esc_int.h"

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\nslave f drive in=8 out=8\n"
	"slave x drive in=8 out=8 id=6 id_delay=300ms\n";

enum { X = 2, N };

static u16 al_control(struct bus *b)
{
	return get_unaligned_le16(bus_esc(b, X)->mem + EC_REG_AL_CONTROL);
}

/* The reply is seen without a scan, and the request ended. It does not show in the AL status. */
static void identify_late_reply_taken(struct kunit *test)
{
	u64 begin = ktime_get_ns(), ms;
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s = bus_slave(b, X);
	u32 scans = bus_table(b)->scan_count, other = 0;

	bus_idle(b);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - begin, 250 * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, s->identification, 0);
	KUNIT_EXPECT_EQ(test, al_control(b), EC_AL_PREOP | EC_AL_ID);
	for (ms = 0; ms < 400; ms++) {
		msleep(1);
		other += READ_ONCE(s->al.status) != EC_AL_PREOP || READ_ONCE(s->al.code) ||
			 READ_ONCE(s->note.error);
	}
	KUNIT_EXPECT_EQ(test, s->identification, 6);
	KUNIT_EXPECT_EQ(test, al_control(b), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(b, X)->mem + EC_REG_AL_STATUS),
			EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, other, 0u);
	KUNIT_EXPECT_EQ(test, bus_table(b)->scan_count, scans);
}

/* A request that stands costs no frames. */
static void identify_without_reply_costs_nothing(struct kunit *test)
{
	static const char never[] =
		"segment seed=7 response=100us transition=1ms\n"
		"slave hub EK1100\nslave f drive in=8 out=8\n"
		"slave x drive in=8 out=8 id=6 id_delay=%s\n";
	u64 frames[2];
	char line[256];
	u32 i;

	for (i = 0; i < 2; i++) {
		struct bus *b;

		snprintf(line, sizeof(line), never, i ? "100s" : "1ms");
		b = bus_up(test, line, N);
		bus_idle(b);
		msleep(2000);
		frames[i] = bus_frames(b);
		msleep(2000);
		frames[i] = bus_frames(b) - frames[i];
		KUNIT_EXPECT_EQ(test, bus_slave(b, X)->identification, i ? 0 : 6);
		bus_exit(test);
	}
	KUNIT_EXPECT_LE(test, frames[1], frames[0] + 2);
}

/* It goes to OP before it has replied: that ends the request, and there is another one after it. */
static void identify_cut_by_session_asked_again(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s = bus_slave(b, X);
	struct cyc *c;
	u32 ms;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	KUNIT_EXPECT_EQ(test, al_control(b), EC_AL_OP);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, READ_ONCE(s->al.status), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, s->identification, 0);
	cyc_release(c);
	for (ms = 0; ms < 1000 && !READ_ONCE(s->identification); ms++)
		msleep(1);
	KUNIT_EXPECT_EQ(test, s->identification, 6);
	msleep(100);
	KUNIT_EXPECT_EQ(test, al_control(b), EC_AL_PREOP);
}

/* A group that is known by it is found then. */
static void identify_late_reply_starts_group(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_ioc_group g = { .name = "tool", .by = EC_GROUP_BY_ID, .value = 6 };
	struct ec_ioc_group_config m = {
		.vendor_id = bus_slave(b, X)->info.vendor,
		.product_code = bus_slave(b, X)->info.product,
	};
	struct cyc *c;
	u32 ms;

	g.at = EC_UAPI_NONE32;
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_GROUP, &g), 0, "%s", b->app.reason);
	m.group = g.index;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), 0);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	cyc_run(c, 50);
	KUNIT_EXPECT_FALSE(test, cyc_config_status(b, m.index) & EC_STATUS_SC_ONLINE);
	for (ms = 0; ms < 2000 && !(cyc_config_status(b, m.index) & EC_STATUS_SC_ONLINE);
	     ms++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, ms, 600u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(identify_late_reply_taken),
	KUNIT_CASE(identify_without_reply_costs_nothing),
	KUNIT_CASE(identify_cut_by_session_asked_again),
	KUNIT_CASE(identify_late_reply_starts_group),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_identify", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
