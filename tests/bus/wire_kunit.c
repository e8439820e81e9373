// SPDX-License-Identifier: GPL-2.0-only
/*
 * Wire time of short cycles: many axes, many digital terminals, and what is
 * left for acyclic frames. Figures of the frames that were sent.
 */
#include <linux/kthread.h>
#include "cyc.h"
#include "master/mailbox/coe.h"
#include "master/boundary/ioctl.h"

#define AXES	100

static void options(struct cyc *c, u32 options)
{
	struct ec_ioc_domain_options o = { .options = options };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_DOMAIN_OPTIONS, &o), 0);
}

static void late_cycles(struct cyc *c, u32 per_s)
{
	struct ec_ioc_late l = { .per_s = per_s };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_LATE, &l), 0);
}

static u64 late(const struct bus *b)
{
	return bus_late(b);
}

/* Slaves as terminals have them: what passes is back within the cycle. */
static struct bus *short_bus(struct kunit *test, const char *text, u32 slaves)
{
	struct bus *b = bus_new(test, text);
	u32 i;

	for (i = 0; i < slaves; i++) {
		bus_esc(b, i)->cfg.process_ns = 60;
		bus_esc(b, i)->cfg.forward_ns = 30;
	}
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, slaves, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	return b;
}

/* A bus in OP, its process data complete and in time for 1000 cycles. */
static void runs(struct cyc *c, u32 domain_bytes)
{
	struct kunit *test = c->b->test;

	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	/* the clocks are set with more datagrams a cycle */
	cyc_run(c, 20000);
	c->incomplete = 0;
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, bus_domain(c->b, 0)->size, domain_bytes);
}

static struct cyc *axes(struct kunit *test, u32 period_us, u32 domain_options)
{
	struct bus *b = short_bus(test, "segment seed=51 response=100us transition=1ms\n"
				  "repeat 100 slave d drive in=8 out=8 cable=0\n", AXES);
	struct cyc *c = cyc_new(b, period_us);

	cyc_domain(c);
	options(c, domain_options);
	cyc_map_all(c, 0, AXES, 0);
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR;
	return c;
}

/* 100 axes of 8 and 8 bytes, with clock datagrams, in a cycle of 100 us */
static void wire_axes(struct kunit *test)
{
	struct cyc *c = axes(test, 100, EC_DOMAIN_OPT_OVERLAP);
	u32 riders = 0;
	u64 before;

	cyc_activate(c);
	runs(c, 1600);
	before = late(c->b);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, late(c->b), before);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->expected, 300u);
	KUNIT_EXPECT_NE(test, bus_cycle(c->b)->clock.time, 0ull);
	/* not one that carries a datagram of the monitor */
	while (bus_riders(c->b)->seq != riders) {
		riders = bus_riders(c->b)->seq;
		cyc_run(c, 1);
	}
	/* 800 bytes and three headers of datagrams, two with clocks */
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->ns,
			(8 + 14 + 2 + 12 + 8 + 12 + 4 + 12 + 800 + 4 + 12) * 80u);
	bus_row(bus_last_wire(c->b)->ns, 100000,
		"ns of wire time: cycle of 100 axes, 8 and 8 bytes, overlapped, with clocks");
	KUNIT_EXPECT_LE(test, bus_last_wire(c->b)->ns, 100000u);
}

/* the same without overlap, for comparison: it needs a longer cycle */
static void wire_axes_apart(struct kunit *test)
{
	struct cyc *c = axes(test, 200, 0);

	cyc_activate(c);
	runs(c, 1600);
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->frames, 3u);
	KUNIT_EXPECT_GT(test, bus_last_wire(c->b)->ns, 100000u);
	bus_figure("wire time of 100 axes, 8 and 8 bytes, inputs and outputs apart, with clocks: %u ns in %u frames",
		   bus_last_wire(c->b)->ns, bus_last_wire(c->b)->frames);
}

static const struct digital {
	const char *name;
	const char *text;
	u32 slaves;
	u32 bytes;
	u32 options;
	u32 wire_bytes;
} digitals[] = {
	{ "8 channels each", "segment seed=52\nslave k EK1100\nrepeat 63 slave i EL1008\n"
	  "repeat 63 slave o EL2008\n", 127, 126, 0, 126 },
	{ "16 channels each", "segment seed=53\nrepeat 32 slave i io in=16 out=0 cable=0\n"
	  "repeat 32 slave o io in=0 out=16 cable=0\n", 64, 128, 0, 128 },
	{ "4 channels each", "segment seed=54\nslave k EK1100\nrepeat 125 slave o EL2004\n"
	  "repeat 125 slave i EL1004\n", 251, 250, 0, 250 },
	{ "4 channels each, overlapped", "segment seed=54\nslave k EK1100\n"
	  "repeat 125 slave o EL2004\nrepeat 125 slave i EL1004\n", 251, 250,
	  EC_DOMAIN_OPT_OVERLAP, 125 },
};

static void digital_desc(const struct digital *d, char *desc)
{
	strscpy(desc, d->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(digital, digitals, digital_desc);

/* Of a cycle with its own datagrams only: a look of the monitor rides with one of ten. */
static u32 own_ns(struct cyc *c)
{
	u32 ns = U32_MAX, i;

	for (i = 0; i < 3; i++) {
		cyc_run(c, 1);
		ns = min(ns, bus_last_wire(c->b)->ns);
	}
	return ns;
}

/* 1000 digital inputs and outputs, half of each */
static void wire_digital(struct kunit *test)
{
	const struct digital *d = test->param_value;
	struct bus *b = short_bus(test, d->text, d->slaves);
	struct cyc *c = cyc_new(b, 100);
	u32 ns;

	cyc_domain(c);
	options(c, d->options);
	cyc_map_all(c, 0, d->slaves, 0);
	cyc_activate(c);
	runs(c, d->bytes);
	ns = own_ns(c);
	KUNIT_EXPECT_EQ(test, ns, (8 + 14 + 2 + 12 + d->wire_bytes + 4 + 12) * 80);
	bus_row(ns, 30000, "ns of wire time: 1000 digital I/O, %s", d->name);
	KUNIT_EXPECT_LE(test, ns, 30000u);
}

/* a tool that reads one object after the other */
struct reader {
	struct cyc *c;
	u32 done;
	u32 failed;
	bool stop;
	struct completion end;
};

static int read_objects(void *arg)
{
	struct reader *r = arg;
	u32 abort, n;

	for (n = 0; !READ_ONCE(r->stop); n++) {
		char text[64] = { 0 };
		size_t got;
		int ret = ec_coe_upload(&bus_slave(r->c->b, n % AXES)->mbox, 0x1008, 0, false, text,
					sizeof(text), &got, &abort, 0);

		if (ret || !got || text[0] < ' ')
			r->failed++;
		else
			r->done++;
	}
	complete(&r->end);
	return 0;
}

static struct reader *uploads(struct cyc *c, u32 cycles)
{
	struct kunit *test = c->b->test;
	struct reader *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->c = c;
	init_completion(&r->end);
	KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(read_objects, r, "reader")));
	cyc_run(c, cycles);
	WRITE_ONCE(r->stop, true);
	while (!try_wait_for_completion(&r->end))
		cyc_run(c, 1);
	return r;
}

/* SDOs beside 100 axes in 100 us: mailboxes of 256 bytes go in pieces, nothing is late. */
static void wire_sdo_beside_axes(struct kunit *test)
{
	struct cyc *c = axes(test, 100, EC_DOMAIN_OPT_OVERLAP);
	struct reader *r;
	u64 before;

	late_cycles(c, 0);
	cyc_activate(c);
	runs(c, 1600);
	KUNIT_EXPECT_FALSE(test, bus_room_logged(c->b));
	KUNIT_EXPECT_EQ(test, bus_slack_ns(c->b), 90000 - bus_clocked_wire(c->b)->ns);
	KUNIT_EXPECT_LT(test, bus_room(c->b), 256);
	before = late(c->b);
	r = uploads(c, 10000);
	bus_figure("SDO uploads beside 100 axes in a cycle of 100 us, %u ns left: %u in 1 s, %u failed",
		   bus_slack_ns(c->b), r->done, r->failed);
	KUNIT_EXPECT_GE(test, r->done, 800u);
	KUNIT_EXPECT_EQ(test, r->failed, 0u);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, late(c->b), before);
	KUNIT_EXPECT_EQ(test, bus_late_cycles(c->b), 0u);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* Not even the shortest frame fits: so many late cycles a second, and they are counted. */
static void wire_full(struct kunit *test)
{
	struct cyc *c = axes(test, 100, EC_DOMAIN_OPT_OVERLAP);
	struct reader *r;
	u64 cycles;
	u32 before;

	late_cycles(c, 400);
	cyc_activate(c);
	runs(c, 1600);
	KUNIT_EXPECT_EQ(test, bus_late_cycles(c->b), 0u);
	/* the application goes faster */
	bus_set_interval(c->b, 75);
	c->period_ns = 75000;
	cyc_run(c, 10);
	KUNIT_EXPECT_LT(test, bus_slack_ns(c->b), ec_layout_need_ns());
	before = bus_late_cycles(c->b);
	cycles = c->cycles;
	/* a second, and until the last one is done */
	r = uploads(c, 13333);
	bus_figure("SDO uploads beside 100 axes in a cycle of 75 us, 400 late cycles a second allowed: %u in 1 s, %u failed, %u late",
		   r->done, r->failed, bus_late_cycles(c->b) - before);
	KUNIT_EXPECT_GE(test, r->done, 12u);
	KUNIT_EXPECT_EQ(test, r->failed, 0u);
	KUNIT_EXPECT_GE(test, bus_late_cycles(c->b) - before, 100u);
	KUNIT_EXPECT_LE(test, bus_late_cycles(c->b) - before,
			div_u64((c->cycles - cycles) * 75 * 400, USEC_PER_SEC) + 20);
}

/* The same at activation: with late cycles allowed it is told. */
static void wire_overload_logged_at_activation(struct kunit *test)
{
	struct cyc *c = axes(test, 75, EC_DOMAIN_OPT_OVERLAP);

	cyc_activate(c);
	KUNIT_EXPECT_TRUE(test, bus_room_logged(c->b));
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 0);
}

/* With no late cycle allowed that is refused; the bus stays as it was. */
static void wire_refused(struct kunit *test)
{
	struct cyc *c = axes(test, 75, EC_DOMAIN_OPT_OVERLAP);
	struct bus *b = c->b;
	struct ec_ioc_activate a = { 0 };

	late_cycles(c, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -ENOSPC);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "6720 ns"), "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), EC_ACCESS_DIRECT);
	/* in a longer cycle the same session works */
	c->period_ns = 200000;
	bus_set_interval(b, 200);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	KUNIT_EXPECT_FALSE(test, bus_room_logged(b));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(wire_axes),
	KUNIT_CASE(wire_axes_apart),
	KUNIT_CASE_PARAM(wire_digital, digital_gen_params),
	KUNIT_CASE(wire_sdo_beside_axes),
	KUNIT_CASE(wire_full),
	KUNIT_CASE(wire_overload_logged_at_activation),
	KUNIT_CASE(wire_refused),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_wire",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
