// SPDX-License-Identifier: GPL-2.0-only
/* Ports at which a hot connect group is expected stay closed if another device is behind them. */
#include "cyc.h"
#include "devices/sim/esc_int.h"

/* x is the head of the tool, y has its identification, z is a drive without one */
static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"branch hub 2\nslave f1 drive in=8 out=8\nslave f2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8 id=6 serial=61\nslave x2 drive in=8 out=8\n"
	"branch none\nslave y1 drive in=8 out=8 id=6 serial=62\n"
	"branch none\nslave z1 drive in=8 out=8 serial=63\nslave z2 EL1859\n"
	"branch none\nslave v EK1100\nbranch none\nslave w drive in=8 out=8 id=7\n";

enum { HUB, F1, F2, X1, X2, Y1, Z1, Z2, V, W };

#define N	3	/* connected at first */
#define PORT	1	/* of the hub, at which the tool is expected */

/**
 * struct border - an application with two fixed drives and a tool at a port of the hub
 * @c: its cycle
 * @head: configuration of the head of the tool
 * @info: the fixed slaves
 * @incomplete: cycles in which the domain of the fixed drives was not complete
 */
struct border {
	struct cyc *c;
	u32 head;
	struct ec_sii_info info[N];
	u32 incomplete;
};

static void look(struct cyc *c)
{
	struct border *t = c->ctx;

	t->incomplete += cyc_state(c, 0)->wc_state != EC_STATUS_WC_COMPLETE;
}

/* @plugged: connected as well, as slave N; or NULL */
static struct border *begin(struct kunit *test, enum ec_border_mode mode, const char *plugged)
{
	struct border *t = kunit_kzalloc(test, sizeof(*t), GFP_KERNEL);
	struct bus *b = bus_up(test, text, N);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, t);
	bus_table(b)->border.mode = mode;
	for (i = 0; i < N; i++)
		t->info[i] = bus_slave(b, i)->info;
	if (plugged)
		bus_command(b, plugged);
	for (i = 0; i < 5000 && plugged && bus_n_slaves(b) != N + 1; i++)
		msleep(1);
	bus_idle(b);
	t->c = cyc_new(b, 1000);
	cyc_domain(t->c);
	cyc_domain(t->c);
	return t;
}

static u32 add_fixed(struct border *t)
{
	u32 i, hub = 0;

	for (i = 0; i < N; i++) {
		struct ec_ioc_slave_config sc = {
			.position = i, .vendor_id = t->info[i].vendor,
			.product_code = t->info[i].product,
		};

		KUNIT_ASSERT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
		hub = i ? hub : sc.index;
		if (!i)
			continue;
		cyc_map(t->c, sc.index, 2, 0);
		cyc_map(t->c, sc.index, 3, 0);
	}
	return hub;
}

/* A drive as head, in the second domain */
static void add_head(struct border *t, u32 by, u16 value, u32 at)
{
	struct ec_ioc_group g = { .name = "tool", .by = by, .value = value, .at = at };
	struct ec_ioc_group_config m = {
		.vendor_id = t->info[F1].vendor, .product_code = t->info[F1].product,
	};
	struct bus *b = t->c->b;
	u32 sm;

	g.port = at == EC_UAPI_NONE32 ? 0 : PORT;
	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_GROUP, &g), 0, "%s", b->app.reason);
	m.group = g.index;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), 0);
	t->head = m.index;
	for (sm = 2; sm < 4; sm++) {
		struct ec_ioc_sc_sync sync = {
			.config = m.index, .sm = sm,
			.dir = sm == 2 ? EC_CFG_DIR_OUTPUT : EC_CFG_DIR_INPUT,
		};

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sync), 0);
	}
	cyc_remap(t->c, m.index);
	cyc_map(t->c, m.index, 2, 1);
	cyc_map(t->c, m.index, 3, 1);
}

static void run(struct border *t)
{
	cyc_activate(t->c);
	cyc_run(t->c, 1000);
	t->c->ctx = t;
	t->c->each = look;
}

static struct border *with_tool(struct kunit *test, enum ec_border_mode mode, u32 by, u16 value)
{
	struct border *t = begin(test, mode, NULL);

	add_head(t, by, value, add_fixed(t));
	run(t);
	return t;
}

static bool in_op(struct border *t)
{
	return cyc_config_status(t->c->b, t->head) & EC_STATUS_SC_OP;
}

static void wait_op(struct border *t, const char *when)
{
	u32 i;

	for (i = 0; i < 5000 && !in_op(t); i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_LT_MSG(t->c->b->test, i, 5000u, "%s", when);
}

static struct ec_ioc_port port(struct border *t)
{
	struct ec_ioc_port p = { .port = PORT };

	KUNIT_EXPECT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_PORT, &p), 0);
	return p;
}

static int let_in(struct border *t, const struct ec_ioc_port *p)
{
	struct ec_ioc_let_in l = {
		.port = p->port, .slave = p->slave, .vendor_id = p->vendor_id,
		.product_code = p->product_code, .revision_number = p->revision_number,
		.serial_number = p->serial_number,
	};

	return ec_ioc(&t->c->b->app, EC_IOC_LET_IN, &l);
}

static void wait_kept(struct border *t, u32 kept)
{
	u32 i;

	for (i = 0; i < 5000 && port(t).kept != kept; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_EQ(t->c->b->test, port(t).kept, kept);
}

/* Until the port has the reason, which is logged once, although there are trials again and again */
static void expect_kept(struct border *t, u32 kept)
{
	struct kunit *test = t->c->b->test;
	u32 lines = bus_log_lines("stays closed despite its link: "), trials;

	wait_kept(t, kept);
	trials = bus_table(t->c->b)->trials;
	cyc_run(t->c, 4000);
	KUNIT_EXPECT_GT(test, bus_table(t->c->b)->trials, trials);
	KUNIT_EXPECT_EQ(test, bus_log_lines("stays closed despite its link: ") - lines, 1u);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(t->c->b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_esc(t->c->b, HUB)->mem[EC_REG_DL_LOOPS] >> 2 & 3,
			EC_LOOP_CLOSED);
	KUNIT_EXPECT_FALSE(test, in_op(t));
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
}

/**
 * struct wrong - a device that is not the tool
 * @command: connects it
 * @by: EC_GROUP_BY_*
 * @value: of the group
 * @kept: EC_PORT_*
 * @slaves: with those behind it
 * @device: index of the device, whose identity is shown
 */
struct wrong {
	const char *command;
	u32 by;
	u16 value;
	u32 kept;
	u32 slaves;
	u32 device;
};

static const struct wrong wrongs[] = {
	{ "plug hub.1 v.0", EC_GROUP_BY_PORT, 0, EC_PORT_OTHER, 1, V },
	{ "plug hub.1 v.0", EC_GROUP_BY_ID, 6, EC_PORT_OTHER, 1, V },
	{ "plug hub.1 z1.0", EC_GROUP_BY_ID, 6, EC_PORT_SIGN, 2, Z1 },
	{ "plug hub.1 w.0", EC_GROUP_BY_ID, 6, EC_PORT_SIGN, 1, W },
	{ "plug hub.1 x1.0", EC_GROUP_BY_ALIAS, 99, EC_PORT_SIGN, 2, X1 },
	{ "unplug x1.1;plug hub.1 x1.1", EC_GROUP_BY_ID, 6, EC_PORT_REVERSED, 1, X1 },
};

static void commands(struct bus *b, const char *list)
{
	char line[128], *rest = line, *one;

	strscpy(line, list, sizeof(line));
	while ((one = strsep(&rest, ";")))
		bus_command(b, one);
}

static void wrong_desc(const struct wrong *w, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%s, group by %u", w->command, w->by);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* It stays outside, is listed with its identity, and gets in by command. */
static void border_keeps_wrong_device(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct border *t = with_tool(test, EC_BORDER_AUTO, w->by, w->value);
	const u8 *sii = bus_esc(t->c->b, w->device)->eep.data;
	struct ec_ioc_port p;
	u32 i;

	commands(t->c->b, w->command);
	expect_kept(t, w->kept);
	p = port(t);
	KUNIT_EXPECT_EQ(test, p.vendor_id, get_unaligned_le32(sii + 2 * EC_SII_W_VENDOR));
	KUNIT_EXPECT_EQ(test, p.product_code, get_unaligned_le32(sii + 2 * EC_SII_W_PRODUCT));
	KUNIT_EXPECT_EQ(test, p.serial_number, get_unaligned_le32(sii + 2 * EC_SII_W_SERIAL));
	KUNIT_EXPECT_EQ(test, p.slaves, w->slaves);
	KUNIT_EXPECT_NE(test, p.name[0], '\0');
	KUNIT_EXPECT_EQ(test, let_in(t, &p), 0);
	for (i = 0; i < 2000 && bus_n_slaves(t->c->b) == N; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_GT(test, bus_n_slaves(t->c->b), (u32)N);
	KUNIT_EXPECT_EQ(test, port(t).kept, (u32)EC_PORT_NOT_KEPT);
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
}

/* The right one needs no command, also in exchange for another one. */
static void border_lets_group_in(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);

	bus_command(t->c->b, "plug hub.1 x1.0");
	wait_op(t, "the group");
	bus_command(t->c->b, "unplug hub.1");
	cyc_run(t->c, 300);
	bus_command(t->c->b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_SIGN);
	bus_command(t->c->b, "unplug hub.1");
	cyc_run(t->c, 50);
	bus_command(t->c->b, "plug hub.1 y1.0");
	wait_op(t, "exchanged");
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
}

/* One with the identification of a slave of the bus */
static void border_keeps_second(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	u32 i;

	bus_command(t->c->b, "plug f2.1 y1.0");
	for (i = 0; i < 3000 && bus_n_slaves(t->c->b) == N; i++)
		cyc_run(t->c, 1);
	cyc_run(t->c, 300);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(t->c->b), N + 1u);
	bus_command(t->c->b, "plug hub.1 x1.0");
	wait_kept(t, EC_PORT_SECOND);
	/* once the other one is gone */
	bus_command(t->c->b, "unplug f2.1");
	wait_op(t, "alone");
}

/* One in BOOT is left there; one whose EEPROM does not answer is unknown. */
static void border_keeps_unreadable(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	struct bus *b = t->c->b;
	struct ec_ioc_port p;
	u32 i;

	bus_command(b, "old x1 station=5 state=BOOT");
	bus_command(b, "plug hub.1 x1.0");
	expect_kept(t, EC_PORT_BOOT);
	KUNIT_EXPECT_EQ(test, bus_esc(b, X1)->mem[EC_REG_AL_STATUS], EC_AL_BOOT);
	p = port(t);
	KUNIT_EXPECT_EQ(test, let_in(t, &p), 0);
	for (i = 0; i < 2000 && bus_n_slaves(b) == N; i++)
		cyc_run(t->c, 1);
	wait_op(t, "from BOOT");
	bus_command(b, "unplug hub.1");
	cyc_run(t->c, 300);
	bus_command(b, "noack y1 count=1000000");
	bus_command(b, "plug hub.1 y1.0");
	expect_kept(t, EC_PORT_UNREADABLE);
	p = port(t);
	KUNIT_EXPECT_EQ(test, p.vendor_id, 0u);
}

/* The command is for the device that was seen, and for no other port. */
static void border_let_in_refuses(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	struct bus *b = t->c->b;
	struct ec_ioc_port p = port(t), q;

	KUNIT_EXPECT_EQ(test, let_in(t, &p), -ENOENT);
	bus_command(b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_SIGN);
	p = port(t);
	q = p;
	q.serial_number++;
	KUNIT_EXPECT_EQ(test, let_in(t, &q), -ESTALE);
	q = p;
	q.port = 2;
	KUNIT_EXPECT_EQ(test, let_in(t, &q), -ENOENT);
	q.port = 0;
	KUNIT_EXPECT_EQ(test, let_in(t, &q), -EINVAL);
	q.port = 1 << 31;
	KUNIT_EXPECT_EQ(test, let_in(t, &q), -EINVAL);
	cyc_run(t->c, 3000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
	/* it is another one by the time that it is let in */
	bus_esc(b, Z1)->eep.data[2 * EC_SII_W_SERIAL] ^= 0xff;
	KUNIT_EXPECT_EQ(test, let_in(t, &p), 0);
	cyc_run(t->c, 3000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
	q = port(t);
	KUNIT_EXPECT_EQ(test, q.kept, (u32)EC_PORT_SIGN);
	KUNIT_EXPECT_NE(test, q.serial_number, p.serial_number);
}

/* A device that was let in needs no second command after its contact was lost. */
static void border_flapping_after_let_in(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	struct bus *b = t->c->b;
	struct ec_ioc_port p;
	u32 i;

	bus_command(b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_SIGN);
	/* a new contact: looked at again */
	bus_command(b, "cut hub.1");
	cyc_run(t->c, 40);
	KUNIT_EXPECT_EQ(test, port(t).kept, (u32)EC_PORT_NOT_KEPT);
	bus_command(b, "heal hub.1");
	wait_kept(t, EC_PORT_SIGN);
	p = port(t);
	KUNIT_EXPECT_EQ(test, let_in(t, &p), 0);
	cyc_run(t->c, 500);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 2u);
	bus_command(b, "cut hub.1");
	cyc_run(t->c, 300);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
	bus_command(b, "heal hub.1");
	for (i = 0; i < 3000 && bus_n_slaves(b) == N; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 2u);
	/* for another one it does not hold */
	bus_command(b, "unplug hub.1");
	cyc_run(t->c, 300);
	bus_command(b, "plug hub.1 w.0");
	wait_kept(t, EC_PORT_SIGN);
}

/* After the session its port opens, and the normal scan finds the device. */
static void border_ends_with_session(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	struct bus *b = t->c->b;
	u32 i;

	bus_command(b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_SIGN);
	t->c->each = NULL;
	cyc_release(t->c);
	for (i = 0; i < 5000 && bus_n_slaves(b) == N; i++)
		msleep(1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 2u);
	KUNIT_EXPECT_TRUE(test, list_empty(&bus_table(b)->border.found));
	KUNIT_EXPECT_EQ(test, bus_table(b)->border.n_signs, 0u);
}

/* The module is unloaded while a device is kept: nothing is left closed. */
static void border_ends_with_module(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_AUTO, EC_GROUP_BY_ID, 6);
	struct bus *b = t->c->b;

	bus_command(b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_SIGN);
	t->c->each = NULL;
	bus_end(b);
	ec_masters_destroy();
	KUNIT_EXPECT_EQ(test, bus_esc(b, HUB)->mem[EC_REG_DL_LOOPS], 0);
	KUNIT_EXPECT_EQ(test, bus_esc(b, Z1)->mem[EC_REG_DL_LOOPS], 0);
}

/* A drive that the application expects behind the coupler v, which is the last of the ring */
static struct border *with_host(struct kunit *test)
{
	struct border *t = begin(test, EC_BORDER_AUTO, "plug f2.1 v.0");
	struct bus *b = t->c->b;
	struct ec_ioc_slave_config host = { .position = N };

	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), N + 1u);
	host.vendor_id = bus_slave(b, N)->info.vendor;
	host.product_code = bus_slave(b, N)->info.product;
	add_fixed(t);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &host), 0);
	add_head(t, EC_GROUP_BY_ID, 6, host.index);
	run(t);
	return t;
}

/* The slave with the port returns, with or without power meanwhile, and another device behind it. */
static void border_host_returns(struct kunit *test)
{
	struct border *t = with_host(test);
	struct bus *b = t->c->b;
	u32 i, k;

	for (k = 0; k < 2; k++) {
		struct ec_ioc_port p = { .port = PORT, .slave = { .position = N } };

		bus_command(b, "unplug f2.1");
		cyc_run(t->c, 300);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
		if (k) {
			bus_command(b, "off v");
			bus_command(b, "on v");
		} else {
			bus_command(b, "plug v.1 z1.0");
		}
		bus_command(b, "plug f2.1 v.0");
		for (i = 0; i < 6000 && p.kept != EC_PORT_SIGN; i++) {
			cyc_run(t->c, 1);
			if (bus_n_slaves(b) == N + 1)
				ec_ioc(&b->app, EC_IOC_PORT, &p);
			KUNIT_EXPECT_LE(test, bus_n_slaves(b), N + 1u);
		}
		KUNIT_EXPECT_EQ_MSG(test, p.kept, (u32)EC_PORT_SIGN, "%u", k);
	}
	bus_command(b, "unplug v.1");
	cyc_run(t->c, 100);
	bus_command(b, "plug v.1 x1.0");
	wait_op(t, "the right one");
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
}

/* "open": as without groups. "closed": also at a port that no group names. */
static void border_open(struct kunit *test)
{
	struct border *t = with_tool(test, EC_BORDER_OPEN, EC_GROUP_BY_ID, 6);
	u32 i;

	bus_command(t->c->b, "plug hub.1 z1.0");
	for (i = 0; i < 3000 && bus_n_slaves(t->c->b) == N; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(t->c->b), N + 2u);
}

static void border_closed(struct kunit *test)
{
	struct border *t = begin(test, EC_BORDER_CLOSED, NULL);
	struct bus *b = t->c->b;
	struct ec_ioc_port p;
	u32 i;

	add_head(t, EC_GROUP_BY_ID, 6, EC_UAPI_NONE32);
	add_fixed(t);
	run(t);
	bus_command(b, "plug hub.1 z1.0");
	expect_kept(t, EC_PORT_UNKNOWN);
	p = port(t);
	KUNIT_EXPECT_EQ(test, let_in(t, &p), 0);
	cyc_run(t->c, 1000);
	/* the one behind it is not known either */
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 1u);
	bus_command(b, "unplug hub.1");
	cyc_run(t->c, 300);
	/* a group that may be anywhere, and a device of this bus */
	bus_command(b, "unplug x1.1");
	bus_command(b, "plug hub.1 x1.0");
	wait_op(t, "a group anywhere");
	bus_command(b, "cut hub.1");
	cyc_run(t->c, 300);
	bus_command(b, "heal hub.1");
	wait_op(t, "a group that returns");
	bus_command(b, "cut hub.2");
	cyc_run(t->c, 300);
	KUNIT_EXPECT_LT(test, bus_n_slaves(b), N + 1u);
	bus_command(b, "heal hub.2");
	for (i = 0; i < 3000 && bus_n_slaves(b) < N + 1; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N + 1u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(border_keeps_wrong_device, wrong_gen_params),
	KUNIT_CASE(border_lets_group_in),
	KUNIT_CASE(border_keeps_second),
	KUNIT_CASE(border_keeps_unreadable),
	KUNIT_CASE(border_let_in_refuses),
	KUNIT_CASE(border_flapping_after_let_in),
	KUNIT_CASE(border_ends_with_session),
	KUNIT_CASE(border_ends_with_module),
	KUNIT_CASE(border_host_returns),
	KUNIT_CASE(border_open),
	KUNIT_CASE(border_closed),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_border", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
