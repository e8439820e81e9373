// SPDX-License-Identifier: GPL-2.0-only
/* Cables that damage frames: the right one is named, once, and no other. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/bus/line_errors.h"
#include "master/carry/xfer.h"
#include "master/wire/event_ring.h"

static const char tree[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"slave a1 drive in=8 out=8\nslave a2 drive in=8 out=8\n"
	"branch hub 2\nslave mid EK1100\n"
	"slave b1 drive in=8 out=8\nslave b2 drive in=8 out=8\n"
	"branch mid 2\nslave c1 drive in=8 out=8\nslave c2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8\n";

/* in the segment; in the ring it is the same order */
enum { HUB, A1, A2, MID, B1, B2, C1, C2, X1 };

#define N	8	/* connected at first */
#define CALM_MS	75000	/* until a cable is reported again */

/* a reader of the ring of events; @e is the last report */
struct reports {
	struct bus *b;
	u64 at;
	struct ec_event e;
};

static struct reports watch(struct bus *b)
{
	return (struct reports){ .b = b, .at = ec_event_ring_head(bus_events(b)) };
}

/* The next report of a cable; false: there is none. */
static bool next(struct reports *r)
{
	struct ec_event e = { };

	while (ec_event_ring_get(bus_events(r->b), &r->at, &e))
		if (e.kind == EC_EVENT_LINE_ERRORS) {
			r->e = e;
			return true;
		}
	return false;
}

static void none(struct reports *r, const char *why)
{
	while (next(r))
		KUNIT_FAIL(r->b->test, "%s: %u invalid frames, %u receiver errors, slave %u port %u",
			   why, r->e.arg[1], r->e.arg[2], r->e.slave, r->e.arg[0]);
}

/* One report: @n invalid frames or more at this port, with the other end of its cable. */
static void one(struct reports *r, u32 slave, u32 port, u32 to, u32 n, const char *why)
{
	struct kunit *test = r->b->test;

	KUNIT_ASSERT_TRUE_MSG(test, next(r), "no report, %s", why);
	KUNIT_EXPECT_EQ_MSG(test, r->e.slave, slave, "%s", why);
	KUNIT_EXPECT_EQ_MSG(test, r->e.arg[0], port, "%s", why);
	KUNIT_EXPECT_GE_MSG(test, r->e.arg[1], n, "%s", why);
	KUNIT_EXPECT_EQ_MSG(test, r->e.arg[4], to, "%s", why);
	KUNIT_EXPECT_EQ(test, r->e.arg[6], to == EC_EVENT_NONE);
	none(r, why);
}

static void set_features(struct bus *b, u32 i, u16 set, u16 clear)
{
	struct ec_esc *esc = bus_esc(b, i);

	esc->cfg.features |= set;
	esc->cfg.features &= ~clear;
	put_unaligned_le16(esc->cfg.features, esc->mem + EC_REG_FEATURES);
}

static struct bus *begin(struct kunit *test, u16 set, u16 clear)
{
	struct bus *b = bus_new(test, tree);
	u32 i;

	for (i = 0; i <= X1; i++)
		set_features(b, i, set, clear);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	/* the first read counts for nothing */
	msleep(3000);
	return b;
}

static struct ec_line_errors *counts(struct bus *b, u32 position)
{
	KUNIT_ASSERT_NOT_NULL(b->test, bus_slave(b, position)->lines);
	return bus_slave(b, position)->lines;
}

static u8 *regs(struct bus *b, u32 i)
{
	return bus_esc(b, i)->mem + EC_REG_ERRORS;
}

/* cables: slave and port of both ends, from the main device on; -1: that */
static const struct cable {
	s8 up, up_port;
	u8 down;
} cables[] = {
	{ -1, 0, HUB }, { HUB, 1, A1 }, { A1, 1, A2 }, { HUB, 2, MID }, { MID, 1, B1 },
	{ B1, 1, B2 }, { MID, 2, C1 }, { C1, 1, C2 },
};

static const struct damage {
	const char *name;
	u16 clear;	/* features */
	bool back;	/* frames on their way to the main device */
	u32 first;	/* of four cables */
} damages[] = {
	{ "out, in one branch", 0, false, 0 },
	{ "out, in the other one", 0, false, 4 },
	{ "back, in one branch", 0, true, 0 },
	{ "back, in the other one", 0, true, 4 },
	{ "out, in one branch, one counter", EC_FEAT_FCS_SEPARATE, false, 0 },
	{ "out, in the other one, one counter", EC_FEAT_FCS_SEPARATE, false, 4 },
	{ "back, in one branch, one counter", EC_FEAT_FCS_SEPARATE, true, 0 },
	{ "back, in the other one, one counter", EC_FEAT_FCS_SEPARATE, true, 4 },
};

static void damage_desc(const struct damage *d, char *desc)
{
	strscpy(desc, d->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(damage, damages, damage_desc);

/* One cable after the other damages a tenth of the frames in one direction. */
static void line_errors_name_each_cable_of_tree(struct kunit *test)
{
	const struct damage *d = test->param_value;
	struct bus *b = begin(test, 0, d->clear);
	struct reports r = watch(b);
	u32 i;

	for (i = d->first; i < d->first + 4; i++) {
		const struct cable *k = &cables[i];
		int slave = d->back ? k->up : k->down, port = d->back ? k->up_port : 0;
		u32 to = d->back ? k->down : k->up;
		char why[40];

		/* no counter is behind the last cable on the way back */
		if (slave < 0)
			continue;
		snprintf(why, sizeof(why), "cable %u %s", i, d->back ? "back" : "out");
		bus_fault(b, EC_SIM_FAULT_DAMAGE, slave, port, 100000, 0);
		msleep(40000);
		one(&r, slave, port, to, 10, why);
		bus_fault(b, EC_SIM_FAULT_DAMAGE, slave, port, 0, 0);
		msleep(30000);
		none(&r, why);
	}
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
}

static void line_errors_report_cable_once_until_it_was_calm(struct kunit *test)
{
	struct bus *b = begin(test, 0, 0);
	struct reports r = watch(b);

	bus_fault(b, EC_SIM_FAULT_DAMAGE, B2, 0, 50000, 0);
	msleep(100000);
	one(&r, B2, 0, B1, 10, "at first");
	/* also when the other end of the same cable begins */
	bus_fault(b, EC_SIM_FAULT_DAMAGE, B1, 1, 50000, 0);
	msleep(40000);
	none(&r, "the other end");
	bus_fault(b, EC_SIM_FAULT_DAMAGE, B1, 1, 0, 0);
	bus_fault(b, EC_SIM_FAULT_DAMAGE, B2, 0, 0, 0);
	msleep(CALM_MS);
	none(&r, "calm");
	bus_command(b, "errors b2.0 add=12");
	msleep(30000);
	one(&r, B2, 0, B1, 12, "again");
	KUNIT_EXPECT_EQ(test, bus_log_lines("12 CRC errors in "), 1u);
}

/* the same errors with a change of the link and without */
static const struct loss {
	const char *name;
	const char *commands[3];	/* after another, with 30 ms between */
	u32 wait_ms;	/* before the second one */
	u32 reports;
} losses[] = {
	{ "errors alone", { "errors a2.0 add=200" }, 0, 1 },
	{ "errors with a lost link", { "errors a2.0 add=200", "cut a2.0", "heal a2.0" }, 0, 0 },
	{ "errors read before the link is lost",
	  { "errors a2.0 add=200", "cut a2.0", "heal a2.0" }, 3000, 0 },
	{ "errors after a lost link", { "cut a2.0", "heal a2.0", "errors a2.0 add=200" }, 30, 0 },
	{ "errors at the other end", { "errors a1.1 add=200", "cut a2.0", "heal a2.0" }, 0, 0 },
	{ "errors while power is off", { "errors a1.1 add=200", "off a2", "on a2" }, 0, 0 },
};

static void loss_desc(const struct loss *l, char *desc)
{
	strscpy(desc, l->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(loss, losses, loss_desc);

static void line_errors_of_lost_link_are_not_those_of_cable(struct kunit *test)
{
	const struct loss *l = test->param_value;
	struct bus *b = begin(test, 0, 0);
	struct reports r = watch(b);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(l->commands) && l->commands[i]; i++) {
		msleep(i == 1 ? max(l->wait_ms, 1u) : 30);
		bus_command(b, l->commands[i]);
	}
	msleep(60000);
	if (l->reports)
		one(&r, A2, 0, A1, 200, l->name);
	else
		none(&r, l->name);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
}

/* as 'ethercat crc reset', another master or the PDI clear them */
static void clear(struct bus *b, u32 position)
{
	static const u8 zero[EC_ERRORS_SIZE];

	KUNIT_ASSERT_EQ(b->test, ec_xfer_fpwr(bus_links(b), bus_slave(b, position)->station,
					      EC_REG_ERRORS, zero, sizeof(zero)), 0);
}

static void line_errors_count_from_zero_when_others_clear(struct kunit *test)
{
	struct bus *b = begin(test, 0, 0);
	struct reports r = watch(b);
	u32 i;

	bus_command(b, "errors a2.0 add=200");
	msleep(25000);
	one(&r, A2, 0, A1, 200, "at first");
	msleep(CALM_MS);
	clear(b, A2);
	bus_command(b, "errors a2.0 add=11");
	msleep(25000);
	one(&r, A2, 0, A1, 11, "eleven");
	KUNIT_EXPECT_EQ(test, r.e.arg[1], 11u);
	/* fewer than the limit, cleared before they are read: neither 200 nor less than none */
	msleep(CALM_MS);
	for (i = 9; i > 7; i--) {
		clear(b, A2);
		bus_fault(b, EC_SIM_FAULT_ERRORS, A2, 0, i, 0);
		msleep(30000);
	}
	none(&r, "nine, then eight");
	KUNIT_EXPECT_EQ_MSG(test, regs(b, A2)[0], 8, "the master does not clear it");
}

/* What is shown of invalid frames at a port beside the registers. */
static u32 cleared(struct bus *b, u16 position, u32 port)
{
	struct ec_ioc_port p = { .slave = { .position = position }, .port = port };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_PORT, &p), 0);
	return p.cleared[0];
}

/* What is shown without traffic: @errors of a port; returns how many are known. */
static u32 seen(struct bus *b, u16 position, u32 port, u32 errors[4])
{
	struct ec_ioc_port p = { .slave = { .position = position }, .port = port };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_PORT, &p), 0);
	KUNIT_EXPECT_LT(b->test, p.errors_age_ms, 20000u);
	memcpy(errors, p.errors, sizeof(p.errors));
	return p.errors_known;
}

/* 'ethercat crc reset' */
static void clear_by_user(struct bus *b, u16 position)
{
	u8 zero[EC_ERRORS_SIZE] = { 0 };
	struct ec_ioc_reg r = {
		.slave = { .position = position }, .address = EC_REG_ERRORS, .size = sizeof(zero),
		.data = (uintptr_t)zero,
	};

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REG_WRITE, &r), 0);
}

static const struct full {
	const char *name;
	u16 set;
	enum ec_sim_bug bug;
	bool kept;
} fulls[] = {
	{ "read and write at once", 0, EC_SIM_BUG_NONE, false },
	{ "no such access", EC_FEAT_NO_RW, EC_SIM_BUG_NONE, false },
	{ "counters that stay", 0, EC_SIM_BUG_ERRORS_KEPT, true },
};

static void full_desc(const struct full *f, char *desc)
{
	strscpy(desc, f->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(full, fulls, full_desc);

static void line_errors_full_counter_is_cleared(struct kunit *test)
{
	const struct full *f = test->param_value;
	struct bus *b = begin(test, f->set, 0);
	struct reports r = watch(b);
	u32 n[4];

	ec_sim_set_bug(b->sim, f->bug);
	bus_command(b, "errors a2.1 add=7");
	bus_command(b, "errors a2.0 add=255");
	msleep(25000);
	one(&r, A2, 0, A1, 255, "full");
	KUNIT_EXPECT_EQ(test, regs(b, A2)[0], f->kept ? 255 : 0);
	KUNIT_EXPECT_EQ(test, regs(b, A2)[2], f->kept ? 7 : 0);
	/* what the registers have lost is kept here */
	KUNIT_EXPECT_EQ(test, cleared(b, A2, 0), f->kept ? 0u : 255u);
	KUNIT_EXPECT_EQ(test, cleared(b, A2, 1), f->kept ? 0u : 7u);
	/* it is in what is shown without traffic */
	KUNIT_EXPECT_EQ(test, seen(b, A2, 0, n), 4u);
	KUNIT_EXPECT_EQ(test, n[0], 255u);
	KUNIT_EXPECT_EQ(test, seen(b, A2, 1, n), 4u);
	KUNIT_EXPECT_EQ(test, n[0], 7u);
	msleep(CALM_MS);
	none(&r, "full");
	bus_command(b, "errors a2.0 add=30");
	msleep(30000);
	if (f->kept)
		none(&r, "it cannot be seen");
	else
		one(&r, A2, 0, A1, 30, "more");
	seen(b, A2, 0, n);
	KUNIT_EXPECT_EQ_MSG(test, n[0], f->kept ? 255u : 285u, "beyond a register");
	if (!f->kept) {
		clear_by_user(b, A2);
		KUNIT_EXPECT_EQ_MSG(test, cleared(b, A2, 0), 0u, "the user counts anew, at once");
		KUNIT_EXPECT_EQ_MSG(test, seen(b, A2, 0, n), 0u, "not known before the next read");
		msleep(10000);
		KUNIT_EXPECT_EQ(test, seen(b, A2, 0, n), 4u);
		KUNIT_EXPECT_EQ(test, n[0], 0u);
		KUNIT_EXPECT_EQ(test, cleared(b, A2, 0), 0u);
		/* and if it is another program, when the master notices it */
		bus_command(b, "errors a2.0 add=255");
		msleep(10000);
		KUNIT_EXPECT_EQ(test, cleared(b, A2, 0), 255u);
		bus_command(b, "errors a2.0 add=2");
		msleep(10000);
		clear(b, A2);
		msleep(10000);
		KUNIT_EXPECT_EQ(test, cleared(b, A2, 0), 0u);
	}
	ec_sim_set_bug(b->sim, EC_SIM_BUG_NONE);
}

static void line_errors_of_other_device_are_not_counted(struct kunit *test)
{
	struct bus *b = begin(test, 0, 0);
	struct reports r = watch(b);

	bus_command(b, "errors x1.0 add=200");
	bus_command(b, "errors x1.1 add=200");
	bus_command(b, "swap b2 x1");
	msleep(60000);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	KUNIT_EXPECT_EQ_MSG(test, counts(b, B2)->regs[0], 200, "of the new one");
	none(&r, "new slave");
	/* also where the same one is at another place */
	bus_command(b, "errors c2.0 add=100");
	bus_command(b, "plug a2.1 c2.0");
	msleep(60000);
	none(&r, "moved");
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
}

/* A slave that does not answer there is asked for fewer of them, then for all again. */
static void line_errors_absent_registers_disturb_nothing(struct kunit *test)
{
	struct bus *b = begin(test, 0, 0);
	struct reports r = watch(b);
	u32 i, n[4];

	for (i = 0; i < N; i++)
		memset(regs(b, i), 0, EC_ERRORS_SIZE);
	bus_fault(b, EC_SIM_FAULT_DAMAGE, C2, 0, 100000, 0);
	counts(b, C2)->bytes = EC_REG_ERR_FWD(0) - EC_REG_ERRORS;
	counts(b, C2)->known = false;
	msleep(40000);
	one(&r, C2, 0, C1, 10, "8 bytes");
	KUNIT_EXPECT_EQ(test, counts(b, C2)->bytes, EC_REG_ERR_FWD(0) - EC_REG_ERRORS);
	KUNIT_EXPECT_EQ(test, seen(b, C2, 0, n), 2u);
	bus_fault(b, EC_SIM_FAULT_DAMAGE, C2, 0, 0, 0);
}

/* Frames that read the error counters from now on; returns the fault that counts them. */
static u32 count_frames(struct bus *b)
{
	const struct ec_sim_fault f = {
		.type = EC_SIM_FAULT_LOSE, .port = -1, .arg = 0x7fffffff, .by_register = true,
		.reg = EC_REG_ERRORS,
	};
	int i = b->sim->fault_free;

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
	return i;
}

static void figures(struct kunit *test, u32 n)
{
	char text[100];
	struct bus *b;
	u32 f, i;

	snprintf(text, sizeof(text), "segment seed=7\nrepeat %u slave d drive in=8 out=8\n", n);
	b = bus_up(test, text, n);
	bus_idle(b);
	f = count_frames(b);
	msleep(100000);
	/* once a second, and as the frame is not full it is one */
	bus_row(b->sim->fault[f].seen, 120,
		"frames in 100 s: error counters of %u slaves", n);
	KUNIT_EXPECT_GE(test, b->sim->fault[f].seen, 90u);
	KUNIT_EXPECT_LE(test, b->sim->fault[f].seen, 120u);
	for (i = 0; i < n; i++) {
		KUNIT_ASSERT_TRUE_MSG(test, counts(b, i)->known, "slave %u of %u", i, n);
		KUNIT_EXPECT_LT_MSG(test, ktime_get_ns() - counts(b, i)->read_ns,
				    61 * NSEC_PER_SEC, "slave %u of %u", i, n);
	}
	bus_exit(test);
}

static void line_errors_cost_one_frame_each_second(struct kunit *test)
{
	figures(test, 3);
	figures(test, 100);
}

static void line_errors_of_600_slaves_take_one_minute(struct kunit *test)
{
	figures(test, 600);
}

static void line_errors_without_limit_are_not_read(struct kunit *test)
{
	u32 was = ec_line_errors_limit, f;
	struct bus *b;

	WRITE_ONCE(ec_line_errors_limit, 0);
	b = begin(test, 0, 0);
	f = count_frames(b);
	msleep(10000);
	WRITE_ONCE(ec_line_errors_limit, was);
	KUNIT_EXPECT_EQ_MSG(test, b->sim->fault[f].seen, 0u, "line_errors=0");
}

static void line_errors_beside_cycle_cost_no_frame_of_it(struct kunit *test)
{
	struct cyc *c = cyc_drives(test, 100, 1000);
	struct bus *b = c->b;
	struct reports r = watch(b);
	u64 lost, late;
	u32 i, f;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 5000);
	lost = bus_lost(b);
	late = bus_late(b);
	c->incomplete = 0;
	f = count_frames(b);
	cyc_run(c, 20000);
	bus_row(b->sim->fault[f].seen, 22,
		"frames in 20 s beside a cycle of 1 ms: error counters of 100 slaves");
	KUNIT_EXPECT_GE(test, b->sim->fault[f].seen, 18u);
	KUNIT_EXPECT_LE(test, b->sim->fault[f].seen, 22u);
	KUNIT_EXPECT_EQ(test, bus_lost(b), lost);
	KUNIT_EXPECT_EQ(test, bus_late(b), late);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	for (i = 0; i < 100; i++)
		KUNIT_EXPECT_TRUE(test, counts(b, i)->known);
	none(&r, "no errors");
	/* two of a thousand frames */
	bus_fault(b, EC_SIM_FAULT_DAMAGE, 20, 1, 2000, 0);
	cyc_run(c, 40000);
	one(&r, 20, 1, 21, 10, "in the cycle");
	bus_fault(b, EC_SIM_FAULT_DAMAGE, 20, 1, 0, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(line_errors_name_each_cable_of_tree, damage_gen_params),
	KUNIT_CASE(line_errors_report_cable_once_until_it_was_calm),
	KUNIT_CASE_PARAM(line_errors_of_lost_link_are_not_those_of_cable, loss_gen_params),
	KUNIT_CASE(line_errors_count_from_zero_when_others_clear),
	KUNIT_CASE_PARAM(line_errors_full_counter_is_cleared, full_gen_params),
	KUNIT_CASE(line_errors_of_other_device_are_not_counted),
	KUNIT_CASE(line_errors_absent_registers_disturb_nothing),
	KUNIT_CASE(line_errors_cost_one_frame_each_second),
	KUNIT_CASE(line_errors_of_600_slaves_take_one_minute),
	KUNIT_CASE(line_errors_without_limit_are_not_read),
	KUNIT_CASE(line_errors_beside_cycle_cost_no_frame_of_it),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_line_errors",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
