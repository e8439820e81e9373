// SPDX-License-Identifier: GPL-2.0-only
/* A ring that is connected in another way than it should be, or that is not whole at the start. */
#include "ring.h"
#include "devices/ecdev.h"
#include "master/bus/ring_break.h"
#include "master/bus/absent.h"
#include "master/bus/ring_ends.h"
#include "master/bus/scan_count.h"

#define IO_BITS		8
#define ALL		GENMASK(SLAVES - 1, 0)

/* equal slaves */
static const char equal_text[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 8 slave s io in=8 out=8 cable=50\n"
	"wire s8.1 -> master.1 cable=50\n";

/* The outputs that a slave has. */
static u32 outputs(struct bus *b, u32 slave)
{
	char name[16];
	u32 v = 0, i;

	snprintf(name, sizeof(name), "s%u", slave + 1);
	for (i = 0; i < IO_BITS; i++)
		v |= (u32)ec_app_channel(bus_app(b, name), EC_APP_OUT, i) << i;
	return v;
}

/* An application for equal slaves; each has a value of its own. */
struct equal {
	struct cyc *c;
	u32 n;
	u32 wrong;	/* outputs of another slave, so far */
};

/* Slave @i of the closed ring is the one that is connected there, and has no outputs of others. */
static void equal_look(struct cyc *c)
{
	struct equal *e = c->ctx;
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		u32 is = outputs(c->b, i);

		e->wrong += is && is != i + 1;
	}
	for (i = 0; i < e->n; i++)
		*cyc_pd(c, i, 0) = i + 1;
}

/* As a program does that knows its slaves: these may be absent. */
static void equal_config(struct cyc *c, u16 alias, u32 position)
{
	const struct ec_slave *like = bus_slave(c->b, 0);
	struct ec_ioc_slave_config sc = {
		.alias = alias, .position = position, .vendor_id = like->info.vendor,
		.product_code = like->info.product,
	};

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0, "%s",
			    c->b->app.reason);
	ring_map_like(c, sc.index, like);
}

/* Configures @n slaves and is active. */
static struct equal *equal_app(struct bus *b, u16 alias, u32 n)
{
	struct equal *e = kunit_kzalloc(b->test, sizeof(*e), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, e);
	bus_idle(b);
	e->n = n;
	e->c = cyc_new(b, 1000);
	cyc_domain(e->c);
	for (i = 0; i < n; i++)
		equal_config(e->c, alias, i);
	e->c->each = equal_look;
	e->c->ctx = e;
	cyc_activate(e->c);
	return e;
}

/* After 2 s exactly the slaves of the mask @with have their outputs, and none those of another. */
static void equal_run(struct equal *e, u32 with)
{
	u32 got = 0, i;

	cyc_run(e->c, 2000);
	for (i = 0; i < SLAVES; i++)
		got |= outputs(e->c->b, i) == i + 1 ? BIT(i) : 0;
	KUNIT_EXPECT_EQ(e->c->b->test, e->wrong, 0u);
	KUNIT_EXPECT_EQ(e->c->b->test, got, with);
}

static void expect_order(struct bus *b, const u16 *station)
{
	u32 k;

	for (k = 0; k < SLAVES; k++)
		KUNIT_EXPECT_EQ(b->test, bus_slave(b, k)->station, station[k]);
}

static u32 faults_events(struct bus *b, u32 kind)
{
	struct ec_event e;
	u64 from = 0;
	u32 n = 0;

	while (ec_event_ring_get(bus_events(b), &from, &e))
		n += e.kind == kind;
	return n;
}

/* The names are exchanged: the ring works all the same, cut at any place. */
static void ring_names_exchanged(struct kunit *test)
{
	struct bus *b = bus_new_exchanged(test, ring_eight);
	struct ring *r = ring_new(test, b);
	u16 station[SLAVES];
	u32 i;

	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	for (i = 0; i < SLAVES; i++) {
		station[i] = get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION);
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->station, station[i]);
	}
	ring_run(r, SLAVES);
	for (i = 0; i <= SLAVES; i++) {
		ring_cable(b, true, i);
		cyc_run(r->c, 300);
		ring_open(b, i);
		ring_expect(r, "a cut");
		expect_order(b, station);
		ring_cable(b, false, i);
		cyc_run(r->c, 300);
		ring_closed(b, SLAVES);
	}
	ring_expect(r, "all have healed");
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
}

/* Likewise, never seen closed, and with one end only. */
static void ring_names_exchanged_open(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value, i;
	struct bus *b = bus_new_exchanged(test, ring_eight);
	struct ring *r = ring_new(test, b);

	ring_cable(b, true, at);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_open(b, at);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->exchanged);
	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->station,
				get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION));
	ring_run(r, SLAVES);
	ring_cable(b, false, at);
	cyc_run(r->c, 300);
	ring_closed(b, SLAVES);
	ring_expect(r, "it has healed");
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_EXCHANGED), 1u);
}

static const u32 places[] = { 0, 1, 4, 7, 8 };

static void place_desc(const u32 *at, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "before slave %u", *at);
}

KUNIT_ARRAY_PARAM(place, places, place_desc);

/* A slave that is the wrong way round, where @at is its number. */
static void ring_slave_turned(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value % SLAVES, cut;
	struct ec_ioc_activate a = { 0 };
	struct bus *b = bus_new(test, equal_text);
	char text[48];
	struct cyc *c;

	snprintf(text, sizeof(text), "swap s%u.0 s%u.1", at + 1, at + 1);
	bus_command(b, text);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_CLOSED);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	/* the same at each place where the ring may be open */
	for (cut = 0; cut <= SLAVES; cut++) {
		if (cut && cut < SLAVES)
			continue;
		bus_fault(b, EC_SIM_FAULT_CUT, min_t(u32, cut, SLAVES - 1),
			  (cut == SLAVES) ^ (at == min_t(u32, cut, SLAVES - 1)), 0, 0);
		bus_idle(b);
		KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_OPEN);
		c = cyc_new(b, 1000);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
		cyc_release(c);
		bus_fault(b, EC_SIM_FAULT_HEAL, min_t(u32, cut, SLAVES - 1),
			  (cut == SLAVES) ^ (at == min_t(u32, cut, SLAVES - 1)), 0, 0);
		bus_idle(b);
	}
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	bus_command(b, text);
	bus_idle(b);
	ring_closed(b, SLAVES);
	equal_run(equal_app(b, 0, SLAVES), ALL);
}

/* Likewise, in a ring that was never seen closed. */
static void ring_slave_turned_open(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value, cut;
	struct ec_ioc_activate a = { 0 };
	struct bus *b = bus_new(test, equal_text);
	char text[48];

	at = min_t(u32, at, SLAVES - 1);
	cut = at < 4 ? 5 : 3;
	snprintf(text, sizeof(text), "swap s%u.0 s%u.1", at + 1, at + 1);
	bus_command(b, text);
	ring_cable(b, true, cut);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_links(b)->ring.state, EC_RING_OPEN);
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 1u);
	KUNIT_EXPECT_FALSE(test, bus_links(b)->exchanged);
	cyc_new(b, 1000);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
}

/* One without power, and the application is started: others do not get its outputs. */
static void ring_start_without(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value % SLAVES;
	struct bus *b = bus_up(test, equal_text, SLAVES);
	struct equal *e = equal_app(b, 0, SLAVES);
	char text[16];

	equal_run(e, ALL);
	snprintf(text, sizeof(text), "off s%u", at + 1);
	bus_command(b, text);
	equal_run(e, ALL & ~BIT(at));
	cyc_release(e->c);
	e = equal_app(b, 0, SLAVES);
	equal_run(e, ALL & ~BIT(at));
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), SLAVES - 1);
	snprintf(text, sizeof(text), "on s%u", at + 1);
	bus_command(b, text);
	equal_run(e, ALL);
	ring_closed(b, SLAVES);
}

/* Likewise after the start of the computer. */
static void ring_first_start_without(struct kunit *test)
{
	u32 at = *(const u32 *)test->param_value % SLAVES;
	struct bus *b = bus_new(test, equal_text);
	struct equal *e;
	char text[16];

	snprintf(text, sizeof(text), "off s%u", at + 1);
	bus_command(b, text);
	bus_plug_scanned(b, SLAVES - 1, 5000);
	e = equal_app(b, 0, SLAVES);
	equal_run(e, ALL & ~BIT(at));
	snprintf(text, sizeof(text), "on s%u", at + 1);
	bus_command(b, text);
	equal_run(e, ALL);
	ring_closed(b, SLAVES);
}

/* Slaves between two cuts come in later. */
static void ring_start_between_cuts(struct kunit *test)
{
	struct bus *b = bus_new(test, equal_text);
	struct equal *e;

	ring_cable(b, true, 2);
	ring_cable(b, true, 5);
	bus_plug_scanned(b, SLAVES - 3, 5000);
	e = equal_app(b, 0, SLAVES);
	equal_run(e, ALL & ~GENMASK(4, 2));
	ring_cable(b, false, 5);
	equal_run(e, ALL);
	ring_open(b, 2);
	ring_cable(b, false, 2);
	equal_run(e, ALL);
	ring_closed(b, SLAVES);
}

static u32 cause_of(struct bus *b, u32 config)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	return w.cause.kind;
}

/*
 * An application that does not use the last slaves: the master cannot know whether one is missing.
 * In front of the break all is certain, behind it all is once the ring has been closed.
 */
static void ring_start_not_certain(struct kunit *test)
{
	struct bus *b = bus_new(test, equal_text);
	struct equal *e;

	bus_command(b, "off s4");
	bus_plug_scanned(b, SLAVES - 1, 5000);
	e = equal_app(b, 0, 6);
	equal_run(e, BIT(0) | BIT(1) | BIT(2));
	KUNIT_EXPECT_EQ(test, cause_of(b, 2), EC_CAUSE_NONE);
	KUNIT_EXPECT_EQ(test, cause_of(b, 3), EC_CAUSE_RING);
	KUNIT_EXPECT_EQ(test, cause_of(b, 5), EC_CAUSE_RING);
	bus_command(b, "on s4");
	equal_run(e, GENMASK(5, 0));
	cyc_release(e->c);
	bus_command(b, "off s4");
	e = equal_app(b, 0, 6);
	equal_run(e, GENMASK(5, 0) & ~BIT(3));
	KUNIT_EXPECT_EQ(test, cause_of(b, 3), EC_CAUSE_NO_SLAVE);
}

/* An offset from an alias counts slaves of the closed ring as well. */
static void ring_start_alias(struct kunit *test)
{
	struct bus *b = bus_new(test, "segment seed=8 response=100us transition=1ms\n"
				"slave s1 io in=8 out=8 alias=7 cable=50\n"
				"slave s2 io in=8 out=8 cable=50\n"
				"slave s3 io in=8 out=8 cable=50\n"
				"slave s4 io in=8 out=8 cable=50\n"
				"slave s5 io in=8 out=8 cable=50\n"
				"slave s6 io in=8 out=8 cable=50\n"
				"slave s7 io in=8 out=8 cable=50\n"
				"slave s8 io in=8 out=8 cable=50\n"
				"wire s8.1 -> master.1 cable=50\n");
	struct equal *e;

	bus_command(b, "off s4");
	bus_plug_scanned(b, SLAVES - 1, 5000);
	e = equal_app(b, 7, SLAVES);
	equal_run(e, ALL & ~BIT(3));
	bus_command(b, "on s4");
	equal_run(e, ALL);
	ring_closed(b, SLAVES);
}

/* A device that sends and receives nothing although it has a link. */
static int mute_start(void *priv, struct ecdev *dev)
{
	return 0;
}

static void mute_stop(void *priv)
{
}

static u8 *mute_get(void *priv)
{
	return priv;
}

static int mute_send(void *priv, u8 *buf, size_t len)
{
	return 0;
}

static bool mute_up(void *priv)
{
	return true;
}

static const struct ecdev_ops mute_ops = {
	.kind = "mute", .atomic = true, .start = mute_start, .stop = mute_stop, .tx_get = mute_get,
	.tx_send = mute_send, .link_up = mute_up,
};

/* The backup device is at a switch or at a PC: the bus is as without it. */
static void ring_end_mute(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u8 *buf = kunit_kzalloc(test, EC_ETH_MAX, GFP_KERNEL), mac[6] = { 2, 3 };
	struct ring *r = ring_new(test, b);
	struct ecdev *dev;
	u64 lost;

	KUNIT_ASSERT_NOT_NULL(test, buf);
	ring_cable(b, true, SLAVES);
	ec_sim_link_second_withdraw(b->link);
	dev = ecdev_offer("bus0b", mac, &mute_ops, buf);
	KUNIT_ASSERT_FALSE(test, IS_ERR(dev));
	msleep(3000);
	bus_idle(b);
	ring_open(b, SLAVES);
	KUNIT_EXPECT_TRUE(test, bus_links(b)->link[EC_BACKUP].mute);
	/* one that loses its power is noticed, and one that is new is found */
	bus_command(b, "off d8");
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), SLAVES - 1);
	bus_command(b, "on d8");
	KUNIT_EXPECT_NE(test, bus_wait(b, SLAVES, EC_AL_PREOP, 5000), ~0ull);
	ring_run(r, SLAVES);
	cyc_run(r->c, 200);
	lost = atomic64_read(&bus_links(b)->link[EC_BACKUP].stats.lost);
	cyc_run(r->c, 1000);
	KUNIT_EXPECT_LE(test, atomic64_read(&bus_links(b)->link[EC_BACKUP].stats.lost), lost + 3);
	ring_expect(r, "a mute end");
	ecdev_withdraw(dev);
	bus_plug_second(b);
	ring_cable(b, false, SLAVES);
	cyc_run(r->c, 300);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_FALSE(test, bus_links(b)->link[EC_BACKUP].mute);
	ring_expect(r, "it has a slave again");
}

/* The card of the backup device keeps its link although the device is absent. */
static void end_without_device(struct bus *b)
{
	ec_sim_link_second_withdraw(b->link);
	ec_sim_wire_card(ec_sim_link_wire(b->link), 1, true);
}

static void ring_end_without_device(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ring *r = ring_new(test, b);
	u32 cycles = 0;

	bus_idle(b);
	end_without_device(b);
	msleep(500);
	bus_idle(b);
	ring_open(b, SLAVES);
	bus_plug_second(b);
	msleep(500);
	bus_idle(b);
	ring_closed(b, SLAVES);
	ring_run(r, SLAVES);
	r->absent = ~0ull;
	end_without_device(b);
	do {
		cyc_run(r->c, 1);
		cycles++;
	} while (cycles < 5 || (cycles < 1000 &&
				cyc_state(r->c, 0)->wc_state != EC_STATUS_WC_COMPLETE));
	bus_figure("ring whose backup device leaves, with a link that stays: %u cycles without data",
		   cycles);
	KUNIT_EXPECT_LE(test, cycles, 200u);
	KUNIT_EXPECT_NE(test, cyc_wait_op(r->c, 2000), ~0ull);
	cyc_run(r->c, 100);
	ring_open(b, SLAVES);
	bus_plug_second(b);
	cyc_run(r->c, 1000);
	ring_closed(b, SLAVES);
	r->absent = 0;
	cyc_run(r->c, 10);
	r->lost = r->left = r->wrong = 0;
	cyc_run(r->c, 100);
	ring_expect(r, "the device is back");
}

/* The place of a break beside a slave that is lost is the port at which that hung. */
static void ring_place_of_loss(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u32 at[4], i;
	char text[16];

	for (i = 1; i < SLAVES; i++) {
		snprintf(text, sizeof(text), "off d%u", i + 1);
		bus_command(b, text);
		bus_idle(b);
		ec_ring_break_show(bus_table(b), &at[0], &at[1], &at[2], &at[3]);
		KUNIT_EXPECT_EQ(test, at[0], (u32)EC_RING_OPEN);
		KUNIT_EXPECT_EQ(test, at[1], i - 1);
		KUNIT_EXPECT_EQ(test, at[2], 1u);
		KUNIT_EXPECT_EQ(test, at[3], i + 1 < SLAVES ? i : EC_EVENT_NONE);
		snprintf(text, sizeof(text), "on d%u", i + 1);
		bus_command(b, text);
		KUNIT_ASSERT_NE(test, bus_wait(b, SLAVES, EC_AL_PREOP, 5000), ~0ull);
		bus_idle(b);
	}
}

/* What is lost between two cuts hung at the first of them. */
static void ring_loss_between_cuts(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	struct ec_event e, lost = { 0 };
	struct ec_absent a;
	u64 from = 0;

	bus_idle(b);
	ring_cable(b, true, 2);
	bus_idle(b);
	ring_cable(b, true, 5);
	bus_idle(b);
	while (ec_event_ring_get(bus_events(b), &from, &e))
		if (e.kind == EC_EVENT_SLAVE_LOST)
			lost = e;
	KUNIT_EXPECT_EQ(test, lost.slave, 2u);
	KUNIT_EXPECT_EQ(test, lost.arg[0], 1u);
	KUNIT_EXPECT_EQ(test, lost.arg[1], 1u);
	KUNIT_EXPECT_EQ(test, lost.arg[6], 3u);
	down_read(&bus_table(b)->topo);
	ec_absent_get(bus_table(b), 0, &a);
	KUNIT_EXPECT_EQ(test, a.n, 3u);
	KUNIT_EXPECT_EQ(test, a.up, bus_slave(b, 1)->device);
	KUNIT_EXPECT_EQ(test, a.port, 1);
	up_read(&bus_table(b)->topo);
}

static void shown(struct bus *b, u32 state, u32 events, u32 kind)
{
	u32 at[4];

	bus_idle(b);
	ec_ring_break_show(bus_table(b), &at[0], &at[1], &at[2], &at[3]);
	KUNIT_EXPECT_EQ(b->test, at[0], state);
	KUNIT_EXPECT_EQ(b->test, faults_events(b, kind), events);
}

/* The end at the computer: no slave shows an event, and as many are before the break. */
static void ring_device_has_event(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);

	shown(b, EC_RING_CLOSED, 1, EC_EVENT_RING_CLOSED);
	bus_fault(b, EC_SIM_FAULT_MISS_BROADCAST, 0, -1, 0, 0);
	ec_sim_link_second_withdraw(b->link);
	shown(b, EC_RING_OPEN, 1, EC_EVENT_RING_OPEN);
	bus_plug_second(b);
	shown(b, EC_RING_CLOSED, 2, EC_EVENT_RING_CLOSED);
	ring_cable(b, true, 0);
	ring_cable(b, true, SLAVES);
	msleep(500);
	shown(b, EC_RING_UNKNOWN, 2, EC_EVENT_RING_CLOSED);
	ring_cable(b, false, 0);
	ring_cable(b, false, SLAVES);
	msleep(500);
	shown(b, EC_RING_CLOSED, 2, EC_EVENT_RING_CLOSED);
}

/* A copy that is lost once leaves the positions as they are. */
static void ring_copy_is_lost(struct kunit *test)
{
	struct bus *b = bus_up(test, ring_eight, SLAVES);
	u32 i;

	ring_cable(b, true, 5);
	bus_idle(b);
	for (i = 0; i < 50; i++) {
		bus_fault(b, EC_SIM_FAULT_LOSE, -1, -1, 1, 0);
		ec_scan_count(bus_table(b));
		KUNIT_EXPECT_EQ(test, bus_links(b)->ring.front, 5u);
		bus_fault(b, EC_SIM_FAULT_LOSE, -1, -1, 0, 0);
	}
}

/*
 * The first slave has no power, and a contact flaps further on: no slave has outputs of another
 * one, and none seems to be the wrong way round, however often scans contradict the ring.
 */
static void ring_flaps_without_first(struct kunit *test)
{
	struct bus *b = bus_up(test, equal_text, SLAVES);
	struct equal *e = equal_app(b, 0, SLAVES);
	u32 i, k;

	equal_run(e, ALL);
	for (k = 0; k < 20; k++) {
		bus_command(b, "off s1");
		for (i = 0; i < 60; i++) {
			ring_cable(b, !(i & 1), 4);
			cyc_run(e->c, 1 + (7 * i + 13 * k) % 19);
		}
		bus_command(b, "on s1");
		cyc_run(e->c, 2000);
	}
	KUNIT_EXPECT_EQ(test, faults_events(b, EC_EVENT_RING_TURNED), 0u);
	equal_run(e, ALL);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ring_names_exchanged),
	KUNIT_CASE_PARAM(ring_names_exchanged_open, place_gen_params),
	KUNIT_CASE(ring_flaps_without_first),
	KUNIT_CASE_PARAM(ring_slave_turned, place_gen_params),
	KUNIT_CASE_PARAM(ring_slave_turned_open, place_gen_params),
	KUNIT_CASE_PARAM(ring_start_without, place_gen_params),
	KUNIT_CASE_PARAM(ring_first_start_without, place_gen_params),
	KUNIT_CASE(ring_start_between_cuts),
	KUNIT_CASE(ring_start_not_certain),
	KUNIT_CASE(ring_start_alias),
	KUNIT_CASE(ring_end_mute),
	KUNIT_CASE(ring_end_without_device),
	KUNIT_CASE(ring_place_of_loss),
	KUNIT_CASE(ring_loss_between_cuts),
	KUNIT_CASE(ring_device_has_event),
	KUNIT_CASE(ring_copy_is_lost),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_faults", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
