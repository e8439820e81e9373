// SPDX-License-Identifier: GPL-2.0-only
/* Hot connect groups: which slaves are used, and that the others are not disturbed. */
#include "cyc.h"
#include "devices/sim/esc_int.h"

/* x1 and y1 are heads of tools with an identification, y1 is slow to PREOP, z1 has none */
static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"branch hub 2\nslave f1 drive in=8 out=8\nslave f2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8 id=6 serial=61\nslave x2 drive in=8 out=8\n"
	"branch none\nslave y1 drive in=8 out=8 id=6 serial=62"
	" transition_preop=40ms\nslave y2 drive in=8 out=8\n"
	"branch none\nslave z1 drive in=8 out=8\nslave z2 EL1859\n"
	"branch none\nslave v EK1100\nslave w EK1100\n"
	"branch v 2\nslave v1 drive in=8 out=8\nbranch w 2\nslave w1 drive in=8 out=8\n";

enum { HUB, F1, F2, X1, X2, Y1, Y2, Z1, Z2, V, W, V1, W1 };

#define N	3	/* connected at first */

/**
 * struct tools - an application with the hub, two fixed drives, and one or more groups
 * @c: its cycle
 * @group: the first group
 * @head: configuration of its head; the other member is the next one
 * @incomplete: cycles in which the domain of the fixed drives was not complete
 * @hub: configuration of the first of the fixed slaves
 * @info: what these are
 */
struct tools {
	struct cyc *c;
	u32 group;
	u32 head;
	u32 incomplete;
	u32 hub;
	struct ec_sii_info info[N];
};

static u32 add_group(struct tools *t, const char *name, u32 by, u16 value, u32 at, u8 port,
		     u32 flags)
{
	struct ec_ioc_group g = {
		.flags = flags, .by = by, .value = value, .at = at, .port = port,
	};

	strscpy(g.name, name, sizeof(g.name));
	KUNIT_ASSERT_EQ_MSG(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_GROUP, &g), 0, "%s",
			    t->c->b->app.reason);
	return g.index;
}

/* A member that is a drive with the usual mapping, in the domain */
static u32 add_drive(struct tools *t, u32 group, u16 member, u32 domain)
{
	const struct ec_sii_info *drive = &t->info[F1];
	struct ec_ioc_group_config m = {
		.group = group, .member = member, .vendor_id = drive->vendor,
		.product_code = drive->product,
	};
	struct ec_ioc_sc_sync sm = { .sm = 2, .dir = EC_CFG_DIR_OUTPUT };

	KUNIT_ASSERT_EQ_MSG(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_GROUP_CONFIG, &m), 0, "%s",
			    t->c->b->app.reason);
	sm.config = m.index;
	KUNIT_ASSERT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_SC_SYNC, &sm), 0);
	sm.sm = 3;
	sm.dir = EC_CFG_DIR_INPUT;
	KUNIT_ASSERT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_SC_SYNC, &sm), 0);
	cyc_remap(t->c, m.index);
	cyc_map(t->c, m.index, 2, domain);
	cyc_map(t->c, m.index, 3, domain);
	return m.index;
}

static void look(struct cyc *c)
{
	struct tools *t = c->ctx;

	t->incomplete += cyc_state(c, 0)->wc_state != EC_STATUS_WC_COMPLETE;
}

static void commands(struct bus *b, const char *list)
{
	char line[128], *rest = line, *one;

	strscpy(line, list, sizeof(line));
	while ((one = strsep(&rest, ";")))
		bus_command(b, one);
}

/* Fixed drives in domain 0; the groups follow */
static struct tools *begin(struct kunit *test, const char *plugged, u32 n)
{
	struct tools *t = kunit_kzalloc(test, sizeof(*t), GFP_KERNEL);
	struct bus *b = bus_up(test, text, N);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, t);
	for (i = 0; i < N; i++)
		t->info[i] = bus_slave(b, i)->info;
	if (plugged) {
		commands(b, plugged);
		for (i = 0; i < 5000 && bus_n_slaves(b) != n; i++)
			msleep(1);
		KUNIT_ASSERT_EQ(test, bus_n_slaves(b), n);
	}
	bus_idle(b);
	t->c = cyc_new(b, 1000);
	cyc_domain(t->c);
	cyc_domain(t->c);
	return t;
}

static void run(struct tools *t)
{
	cyc_activate(t->c);
	cyc_run(t->c, 1000);
	t->c->ctx = t;
	t->c->each = look;
}

/* The hub and the fixed drives, by ring position */
static void add_fixed(struct tools *t)
{
	u32 i, sm;

	for (i = 0; i < N; i++) {
		struct ec_ioc_slave_config sc = {
			.position = i, .vendor_id = t->info[i].vendor,
			.product_code = t->info[i].product,
		};

		KUNIT_ASSERT_EQ_MSG(t->c->b->test,
				    ec_ioc(&t->c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0, "%s",
				    t->c->b->app.reason);
		if (!i)
			t->hub = sc.index;
		for (sm = 2; i && sm < 4; sm++)
			cyc_map(t->c, sc.index, sm, 0);
	}
}

/* Two members by identification 6, in the domain of the fixed drives */
static struct tools *with_tool(struct kunit *test, const char *plugged, u32 n, u32 flags)
{
	struct tools *t = begin(test, plugged, n);

	t->group = add_group(t, "tool", EC_GROUP_BY_ID, 6, EC_UAPI_NONE32, 0, flags);
	t->head = add_drive(t, t->group, 0, 0);
	add_drive(t, t->group, 1, 0);
	add_fixed(t);
	run(t);
	return t;
}

static bool in_op(struct tools *t, u32 config)
{
	return cyc_config_status(t->c->b, config) & EC_STATUS_SC_OP;
}

/* Wait until both members are in OP, or until there are @n slaves otherwise. */
static u32 wait_op(struct tools *t)
{
	u32 i;

	for (i = 0; i < 5000 && !(in_op(t, t->head) && in_op(t, t->head + 1)); i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_LT(t->c->b->test, i, 5000u);
	return i;
}

static void wait_slaves(struct tools *t, u32 n)
{
	u32 i;

	for (i = 0; i < 5000 && bus_n_slaves(t->c->b) != n; i++)
		cyc_run(t->c, 1);
	KUNIT_EXPECT_EQ(t->c->b->test, bus_n_slaves(t->c->b), n);
	cyc_run(t->c, 500);
}

static void expect_why(struct tools *t, u32 config, u32 kind, const char *words)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_EXPECT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_CONFIG_WHY, &w), 0);
	KUNIT_EXPECT_EQ_MSG(t->c->b->test, w.cause.kind, kind, "%s", w.text);
	KUNIT_EXPECT_TRUE_MSG(t->c->b->test, strstr(w.text, words), "'%s' in '%s'", words, w.text);
}

/* Neither the absence, nor the arrival, nor the way to OP of a group disturbs the others. */
static void groups_optional_comes_and_goes(struct kunit *test)
{
	struct tools *t = with_tool(test, NULL, 0, 0);
	struct bus *b = t->c->b;
	u32 i;

	KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->expected, 6u);
	expect_why(t, t->head, EC_CAUSE_NO_GROUP, "optional group tool: no slave has identification 6");
	for (i = 0; i < 3; i++) {
		bus_command(b, "plug hub.1 x1.0");
		bus_figure("a group of two in OP %u cycles after its link came", wait_op(t));
		cyc_run(t->c, 100);
		KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->identification, 6);
		KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->expected, 12u);
		KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->working_counter, 12u);
		KUNIT_EXPECT_EQ_MSG(test, t->incomplete, 0u, "on the way to OP");
		bus_command(b, "unplug hub.1");
		wait_slaves(t, N);
		KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->expected, 6u);
		KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
		KUNIT_EXPECT_FALSE(test, in_op(t, t->head));
		bus_figure("%u cycles incomplete until the loss of the group was seen",
			   t->incomplete);
		KUNIT_EXPECT_LE(test, t->incomplete, 50u);
		t->incomplete = 0;
	}
}

/* A mandatory one counts, and is named. */
static void groups_mandatory_is_missed(struct kunit *test)
{
	u32 lines = bus_log_lines("mandatory group tool: not connected");
	struct tools *t = with_tool(test, NULL, 0, EC_GROUP_FLAG_MANDATORY);

	KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->expected, 12u);
	KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->wc_state, EC_STATUS_WC_INCOMPLETE);
	expect_why(t, t->head + 1, EC_CAUSE_NO_GROUP, "group tool: no slave has identification 6");
	KUNIT_EXPECT_EQ(test, bus_log_lines("mandatory group tool: not connected") - lines, 1u);
	bus_command(t->c->b, "plug f2.1 x1.0");
	wait_op(t);
	cyc_run(t->c, 20);
	KUNIT_EXPECT_EQ(test, cyc_state(t->c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
}

/* Slaves of groups do not count for ring positions, whether they are there or not. */
static void groups_do_not_count_for_positions(struct kunit *test)
{
	struct tools *t = with_tool(test, "plug hub.1 x1.0", N + 2, 0);
	struct bus *b = t->c->b;
	u32 i;

	wait_op(t);
	for (i = 0; i < N; i++) {
		const struct ec_slave *s = bus_config(b, t->hub + i)->slave;

		KUNIT_ASSERT_NOT_NULL(test, s);
		KUNIT_EXPECT_EQ(test, s->position, i ? i + 2 : 0);
	}
	KUNIT_EXPECT_EQ(test, bus_config(b, t->head)->slave->position, 1);
}

#define WRONG_TWO	"unplug x2.0;plug x1.1 z2.0;plug hub.1 x1.0"

/**
 * struct wrong - a group that must not be started
 * @command: what is connected
 * @n: slaves then
 * @words: of the reason
 * @remedy: makes it the right one
 */
struct wrong {
	const char *command;
	u32 n;
	const char *words;
	const char *remedy;
};

static const struct wrong wrongs[] = {
	{ "plug f2.1 z1.0", 5, "no slave has identification 6", "plug hub.1 x1.0" },
	{ "unplug x2.0;plug hub.1 x1.0", 4, "member 1 (", "plug x1.1 x2.0" },
	{ WRONG_TWO, 5, "slave 2 is 0x", "unplug x1.1;plug x1.1 x2.0" },
	{ "unplug x1.1;plug hub.1 x1.1", 4, "connected by its port 1",
	  "unplug hub.1;plug x1.1 x2.0;plug hub.1 x1.0" },
};

static void wrong_desc(const struct wrong *w, char *desc)
{
	strscpy(desc, w->command, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* What is not the group is not started, with a reason; the group is once it is right. */
static void groups_wrong_ones(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct tools *t = with_tool(test, NULL, 0, 0);

	commands(t->c->b, w->command);
	wait_slaves(t, w->n);
	KUNIT_EXPECT_FALSE(test, in_op(t, t->head));
	expect_why(t, t->head, w == wrongs ? EC_CAUSE_NO_GROUP : EC_CAUSE_GROUP, w->words);
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
	commands(t->c->b, w->remedy);
	wait_op(t);
}

/* A second one with the same identification does not disturb the one that is in use. */
static void groups_twin_of_running(struct kunit *test)
{
	struct tools *t = with_tool(test, NULL, 0, 0);
	struct bus *b = t->c->b;
	u64 device;

	bus_command(b, "plug hub.1 x1.0");
	wait_op(t);
	device = bus_slave(b, 1)->device;
	bus_command(b, "plug f2.1 y1.0");
	wait_slaves(t, N + 4);
	KUNIT_EXPECT_TRUE(test, in_op(t, t->head));
	KUNIT_EXPECT_EQ(test, bus_config(b, t->head)->slave->device, device);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave(b, 5)->al.status), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
	/* the other one is used once it is the only one */
	bus_command(b, "unplug hub.1");
	cyc_run(t->c, 200);
	wait_op(t);
	KUNIT_EXPECT_NE(test, bus_config(b, t->head)->slave->device, device);
}

/* Of two that are alike none is started. */
static void groups_twins(struct kunit *test)
{
	struct tools *t = with_tool(test, "plug hub.1 x1.0;plug f2.1 y1.0", N + 4, 0);

	KUNIT_EXPECT_FALSE(test, in_op(t, t->head));
	expect_why(t, t->head, EC_CAUSE_GROUP, "slaves 1 and 5 have the same identification 6");
	KUNIT_EXPECT_EQ(test, t->incomplete, 0u);
	bus_command(t->c->b, "unplug f2.1");
	wait_op(t);
}

/* Groups of one kind, known by the port where they are */
static void groups_by_port(struct kunit *test)
{
	struct tools *t = begin(test, NULL, 0);
	struct bus *b = t->c->b;
	u32 second;

	add_fixed(t);
	t->head = add_drive(t, add_group(t, "left", EC_GROUP_BY_PORT, 0, t->hub, 1, 0), 0, 0);
	second = add_drive(t, add_group(t, "end", EC_GROUP_BY_PORT, 0, t->hub + F2, 1, 0), 0, 0);
	run(t);
	expect_why(t, second, EC_CAUSE_NO_GROUP, "no slave at port 1 of slave 2");
	bus_command(b, "plug f2.1 z1.0");
	wait_slaves(t, N + 2);
	cyc_run(t->c, 500);
	KUNIT_EXPECT_TRUE(test, in_op(t, second));
	KUNIT_EXPECT_FALSE(test, in_op(t, t->head));
	bus_command(b, "unplug f2.1");
	wait_slaves(t, N);
	bus_command(b, "plug hub.1 z1.0");
	wait_slaves(t, N + 2);
	cyc_run(t->c, 500);
	KUNIT_EXPECT_TRUE(test, in_op(t, t->head));
	KUNIT_EXPECT_FALSE(test, in_op(t, second));
}

/* An optional slave that stays below OP does not hide the loss of another one. */
static void groups_stuck_member_hides_nothing(struct kunit *test)
{
	struct tools *t = with_tool(test, NULL, 0, 0);
	struct bus *b = t->c->b;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_REFUSE_AL, X1, 0, EC_AL_OP, 0x0017);
	bus_command(b, "plug hub.1 x1.0");
	wait_slaves(t, N + 2);
	cyc_run(t->c, 3000);
	KUNIT_EXPECT_FALSE(test, in_op(t, t->head));
	KUNIT_EXPECT_TRUE(test, in_op(t, t->head + 1));
	/* it failed: the domain may be complete or not, but not without the other one */
	i = t->incomplete;
	bus_command(b, "unplug f1.1");
	cyc_run(t->c, 500);
	KUNIT_EXPECT_NE(test, cyc_state(t->c, 0)->wc_state, EC_STATUS_WC_COMPLETE);
	KUNIT_EXPECT_GT(test, t->incomplete, i + 400u);
}

/* The EEPROM of a slave says that its identification is a word of its memory. */
static void name_word(struct bus *b, u32 index, u16 address, u16 identification)
{
	struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	ec_sii_iter_init(&it, e->data, e->len);
	while (ec_sii_iter_next(&it, &cat) == 1) {
		if (cat.type != EC_SII_CAT_GENERAL)
			continue;
		((u8 *)cat.data)[0x0b] |= EC_SII_FLAG_ID_MEM;
		put_unaligned_le16(address, (u8 *)cat.data + 0x12);
	}
	put_unaligned_le16(identification, bus_esc(b, index)->mem + address);
}

/* A word of memory identifies; an EEPROM that names a register, whose read may change it, not. */
static void groups_by_word_of_memory(struct kunit *test)
{
	struct tools *t = begin(test, NULL, 0);
	struct bus *b = t->c->b;

	name_word(b, X2, EC_REG_DL_STATUS, 0x1234);
	name_word(b, Z1, 0x0f18, 9);
	t->head = add_drive(t, add_group(t, "word", EC_GROUP_BY_ID, 9, EC_UAPI_NONE32, 0, 0), 0, 0);
	add_fixed(t);
	run(t);
	bus_command(b, "plug hub.1 z1.0");
	wait_slaves(t, N + 2);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->identification, 9);
	KUNIT_EXPECT_TRUE(test, in_op(t, t->head));
	bus_command(b, "plug f2.1 x1.0");
	wait_slaves(t, N + 4);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 5)->identification, 6);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 6)->identification, 0);
}

/* A member in BOOT keeps the group from use until it has left BOOT. */
static void groups_member_in_boot(struct kunit *test)
{
	struct tools *t = with_tool(test, "plug hub.1 x1.0", N + 2, 0);
	struct bus *b = t->c->b;

	wait_op(t);
	bus_command(b, "unplug hub.1");
	wait_slaves(t, N);
	bus_command(b, "unplug x1.1");
	bus_command(b, "plug hub.1 x1.0");
	wait_slaves(t, N + 1);
	expect_why(t, t->head, EC_CAUSE_GROUP, "member 1 (");
	bus_request(b, 1, EC_AL_BOOT);
	cyc_run(t->c, 100);
	KUNIT_EXPECT_EQ(test, READ_ONCE(bus_slave(b, 1)->al.status), EC_AL_BOOT);
	bus_command(b, "plug x1.1 x2.0");
	wait_slaves(t, N + 2);
	expect_why(t, t->head, EC_CAUSE_GROUP, "slave 1 is in BOOT");
	KUNIT_EXPECT_FALSE(test, in_op(t, t->head + 1));
	bus_request(b, 1, EC_AL_PREOP);
	wait_op(t);
}

/* Its port is opened at once, and again and again after losses. */
static void groups_fast(struct kunit *test)
{
	u32 lines = bus_log_lines("has lost its link 3 times"), i, cycles;
	struct tools *t = begin(test, NULL, 0);
	struct bus *b = t->c->b;

	add_fixed(t);
	t->group = add_group(t, "tool", EC_GROUP_BY_ID, 6, t->hub, 1, EC_GROUP_FLAG_FAST);
	t->head = add_drive(t, t->group, 0, 0);
	add_drive(t, t->group, 1, 0);
	run(t);
	for (i = 0; i < 6; i++) {
		bus_command(b, "plug hub.1 x1.0");
		cycles = wait_op(t);
		bus_figure("a fast group of two in OP %u cycles after its link came", cycles);
		/* the first time with its EEPROM */
		KUNIT_EXPECT_LE(test, cycles, i ? 250u : 600u);
		bus_command(b, "unplug hub.1");
		wait_slaves(t, N);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("has lost its link 3 times") - lines, 0u);
}

/* The coupler at a position, with a group of one drive at its port 2 */
static u32 add_host(struct tools *t, u16 position, const char *group)
{
	struct ec_ioc_slave_config host = {
		.position = position, .vendor_id = t->info[HUB].vendor,
		.product_code = t->info[HUB].product,
	};

	KUNIT_ASSERT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_SLAVE_CONFIG, &host), 0);
	return add_drive(t, add_group(t, group, EC_GROUP_BY_PORT, 0, host.index, 2, 0), 0, 1);
}

static u32 add_drive_at(struct tools *t, u16 position)
{
	struct ec_ioc_slave_config drive = {
		.position = position, .vendor_id = t->info[F1].vendor,
		.product_code = t->info[F1].product,
	};

	KUNIT_ASSERT_EQ(t->c->b->test, ec_ioc(&t->c->b->app, EC_IOC_SLAVE_CONFIG, &drive), 0);
	cyc_map(t->c, drive.index, 2, 0);
	cyc_map(t->c, drive.index, 3, 0);
	return drive.index;
}

/*
 * Two couplers, each with a group at its port, and behind them in the ring drives like those of the
 * groups: all lose their power, and with it their addresses. Each gets its own back.
 */
static void groups_by_port_without_power(struct kunit *test)
{
	static const char * const off[] = { "off v", "off w", "off v1", "off w1", "off f1", "off f2" };
	static const char * const on[] = { "on f2", "on f1", "on v1", "on w1", "on w", "on v" };
	struct tools *t = begin(test, "plug hub.1 v.0", N + 4);
	struct bus *b = t->c->b;
	u32 i, k, config[4];

	/* the ring is hub, v, w, w1, v1, f1, f2 */
	config[1] = add_host(t, 1, "left");
	config[0] = add_host(t, 2, "right");
	config[2] = add_drive_at(t, 3);
	config[3] = add_drive_at(t, 4);
	run(t);
	for (k = 0; k < 3; k++) {
		for (i = 0; i < 5000 && !(in_op(t, config[0]) && in_op(t, config[1]) &&
					  in_op(t, config[2]) && in_op(t, config[3])); i++)
			cyc_run(t->c, 1);
		KUNIT_ASSERT_LT(test, i, 5000u);
		for (i = 0; i < 4; i++)
			KUNIT_EXPECT_EQ(test, bus_config(b, config[i])->slave->position, 3 + i);
		for (i = 0; i < ARRAY_SIZE(off); i++)
			bus_command(b, off[i]);
		cyc_run(t->c, 1000);
		for (i = 0; i < ARRAY_SIZE(on); i++)
			bus_command(b, on[i]);
	}
}

/* One with an identification that has to be at a port, and one with a serial number */
static void groups_pinned_and_serial(struct kunit *test)
{
	struct tools *t = begin(test, NULL, 0);
	struct ec_ioc_sc_flag flag = { .value = 62, .key = "ExpectedSerial" };
	struct bus *b = t->c->b;

	/* else the one with another serial number stays outside, see border_kunit.c */
	bus_table(b)->border.mode = EC_BORDER_OPEN;
	add_fixed(t);
	t->group = add_group(t, "tool", EC_GROUP_BY_ID, 6, t->hub, 1, 0);
	t->head = add_drive(t, t->group, 0, 0);
	add_drive(t, t->group, 1, 0);
	flag.config = t->head;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &flag), 0);
	run(t);
	bus_command(b, "plug f2.1 y1.0");
	wait_slaves(t, N + 2);
	expect_why(t, t->head, EC_CAUSE_GROUP, "slave 3 is not at port 1 of slave 0");
	bus_command(b, "unplug f2.1");
	wait_slaves(t, N);
	bus_command(b, "plug hub.1 x1.0");
	wait_slaves(t, N + 2);
	expect_why(t, t->head, EC_CAUSE_GROUP, "has serial number 0x0000003d");
	bus_command(b, "unplug hub.1");
	wait_slaves(t, N);
	bus_command(b, "plug hub.1 y1.0");
	wait_op(t);
}

/* A description that is the same as another one, or not valid, is refused. */
static void groups_refused(struct kunit *test)
{
	static const struct {
		struct ec_ioc_group g;
		int ret;
	} bad[] = {
		{ { .by = 1, .value = 5, .at = EC_UAPI_NONE32, .name = "" }, -EINVAL },
		{ { .by = 1, .value = 5, .at = EC_UAPI_NONE32, .name = "5" }, -EINVAL },
		{ { .by = 1, .value = 5, .at = EC_UAPI_NONE32, .name = "a b" }, -EINVAL },
		{ { .by = 0, .value = 5, .at = EC_UAPI_NONE32, .name = "a" }, -EINVAL },
		{ { .by = 4, .value = 5, .at = EC_UAPI_NONE32, .name = "a" }, -EINVAL },
		{ { .by = 2, .value = 0, .at = EC_UAPI_NONE32, .name = "a" }, -EINVAL },
		{ { .by = 3, .value = 0, .at = EC_UAPI_NONE32, .name = "a" }, -EINVAL },
		{ { .by = 3, .value = 0, .at = 0, .port = 0, .name = "a" }, -EINVAL },
		{ { .by = 3, .value = 0, .at = 0, .port = 4, .name = "a" }, -EINVAL },
		{ { .by = 3, .value = 0, .at = 99, .port = 1, .name = "a" }, -EINVAL },
		{ { .by = 2, .value = 9, .at = EC_UAPI_NONE32, .port = 1, .name = "a" }, -EINVAL },
		{ { .by = 2, .value = 9, .at = EC_UAPI_NONE32, .name = "tool" }, -EEXIST },
		{ { .by = 2, .value = 6, .at = EC_UAPI_NONE32, .name = "a" }, -EEXIST },
		{ { .by = 2, .value = 6, .at = EC_UAPI_NONE32, .name = "tool" }, 0 },
	};
	struct tools *t = begin(test, NULL, 0);
	struct ec_ioc_group_config m = { .member = 1 };
	struct bus *b = t->c->b;
	struct ec_ioc_group g;
	u32 i;

	add_fixed(t);
	t->group = add_group(t, "tool", EC_GROUP_BY_ID, 6, EC_UAPI_NONE32, 0, 0);
	for (i = 0; i < ARRAY_SIZE(bad); i++) {
		g = bad[i].g;
		KUNIT_EXPECT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_GROUP, &g), bad[i].ret, "%u", i);
	}
	memset(g.name, 'a', sizeof(g.name));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_GROUP, &g), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), -EINVAL);
	m.group = 1;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), -ENOENT);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(groups_optional_comes_and_goes),
	KUNIT_CASE(groups_mandatory_is_missed),
	KUNIT_CASE(groups_do_not_count_for_positions),
	KUNIT_CASE_PARAM(groups_wrong_ones, wrong_gen_params),
	KUNIT_CASE(groups_twin_of_running),
	KUNIT_CASE(groups_twins),
	KUNIT_CASE(groups_by_port),
	KUNIT_CASE(groups_by_port_without_power),
	KUNIT_CASE(groups_stuck_member_hides_nothing),
	KUNIT_CASE(groups_by_word_of_memory),
	KUNIT_CASE(groups_member_in_boot),
	KUNIT_CASE(groups_fast),
	KUNIT_CASE(groups_pinned_and_serial),
	KUNIT_CASE(groups_refused),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_groups", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
