// SPDX-License-Identifier: GPL-2.0-only
/* Random events at ports: what they are said to be, and that the model withstands them. */
#include "sim_cable_kunit.h"
#include "port_events.h"

#define MS	1000000ull
#define SECOND	1000000000ull

#define BUS	"slave r EK1100\nslave a EK1100\nslave b EL2008\nslave c EL2008\n" \
		"branch r 2\nslave d EK1100\nslave e EL2008\n" \
		"branch d 2\nslave f EK1100\nslave g EL2008\n" \
		"branch none\nslave x EK1100\nslave y drive\n"
#define N	8	/* of 10 that are connected */

static struct port_events *begin(struct kunit *test, struct bed *b, u64 seed)
{
	struct port_events *e = kunit_kzalloc(test, sizeof(*e), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, e);
	b->now = SECOND;
	ec_sim_advance(b->sim, b->now);
	port_events_init(e, b->sim, seed, b->now);
	return e;
}

static void run(struct port_events *e, struct bed *b, u64 events)
{
	while (e->events < events) {
		port_events_plan(e, b->now);
		b->now += 4 * MS;
		count(b, 0);
	}
}

/* 200 ms on the average, a tenth of the events in bursts */
static void sim_events_distances(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	struct port_events *e = begin(test, b, 1);
	u64 arrivals, in_bursts;

	run(e, b, 20000);
	in_bursts = 11 * e->bursts;
	arrivals = e->events - in_bursts + e->bursts;
	KUNIT_EXPECT_GT(test, in_bursts * 100, 8 * e->events);
	KUNIT_EXPECT_LT(test, in_bursts * 100, 12 * e->events);
	KUNIT_EXPECT_GT(test, b->now - SECOND, arrivals * 195 * MS);
	KUNIT_EXPECT_LT(test, b->now - SECOND, arrivals * 205 * MS);
	for (u32 i = 0; i < PORT_EVENTS; i++)
		KUNIT_EXPECT_GT_MSG(test, e->kind[i], 1000, "kind %u", i);
}

/* a long and a short distance are as frequent as they shall be */
static void sim_events_exponential(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	struct port_events *e = begin(test, b, 2);
	u32 below[3] = { 0 };

	for (u32 i = 0; i < 100000; i++) {
		u64 t = port_events_exponential(e, 1000000);

		below[0] += t < 100000;
		below[1] += t < 1000000;
		below[2] += t < 3000000;
	}
	/* 1 - exp(-0.1), 1 - exp(-1), 1 - exp(-3) */
	KUNIT_EXPECT_LT(test, below[0] / 100 - 90, 11);
	KUNIT_EXPECT_LT(test, below[1] / 100 - 625, 15);
	KUNIT_EXPECT_LT(test, below[2] / 100 - 945, 11);
}

/* all that tells one run from another */
static u64 fingerprint(struct bed *b, const struct port_events *e)
{
	u64 h = e->events;

	for (u32 i = 0; i < ec_sim_count(b->sim); i++) {
		const struct ec_esc *esc = ec_sim_slave(b->sim, i);

		for (int p = 0; p < EC_MAX_PORT; p++)
			h = ec_sim_hash(h ^ (u64)(u32)esc->port[p].peer << 8 ^
					esc->port[p].linked_ns ^ esc->port[p].open);
		h = ec_sim_hash(h ^ get_unaligned_le32(esc->mem + EC_REG_ERR_LOST(0)));
	}
	return h;
}

static void sim_events_repeat_with_seed(struct kunit *test)
{
	u64 prints[3];

	for (u32 i = 0; i < 3; i++) {
		struct bed *b = app_bed_part(test, BUS, N);
		struct port_events *e = begin(test, b, i < 2 ? 7 : 8);

		run(e, b, 500);
		prints[i] = fingerprint(b, e);
		if (i < 2)
			ec_sim_free(b->sim);
	}
	KUNIT_EXPECT_EQ(test, prints[0], prints[1]);
	KUNIT_EXPECT_NE(test, prints[1], prints[2]);
}

static void sim_events_only_chosen_kinds(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	struct port_events *e = begin(test, b, 3);

	e->kinds = BIT(PORT_EVENT_OPEN) | BIT(PORT_EVENT_CLOSE);
	run(e, b, 300);
	KUNIT_EXPECT_EQ(test, e->kind[PORT_EVENT_OPEN] + e->kind[PORT_EVENT_CLOSE], (u32)e->events);
	KUNIT_EXPECT_TRUE_MSG(test, ec_sim_link(b->sim, 0), "never at the master's port");
	for (int i = 0; i < 10; i++)
		for (int p = 0; p < EC_MAX_PORT; p++)
			KUNIT_EXPECT_EQ(test, port_events_cable(b->sim, i, p).slave,
					e->first[i][p].slave);
}

/* ---- what the model says */

static void sim_events_reached_by_links(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS "wire g.1 -> master.1\n", N);
	u8 m[10];

	b->now = SECOND;
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, b->now, -1, m), N);
	KUNIT_EXPECT_EQ_MSG(test, port_events_reached(b->sim, b->now, 0, m), 4, "from the other end");
	KUNIT_EXPECT_EQ(test, m[4] + m[5] + m[6] + m[7], 4);
	command(test, b, "cut g.0");
	KUNIT_EXPECT_EQ_MSG(test, port_events_reached(b->sim, b->now, -1, m), N, "a ring needs one");
	command(test, b, "cut a.0");
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, b->now, -1, m), 5);
	KUNIT_EXPECT_EQ(test, m[1] + m[2] + m[3], 0);
	command(test, b, "off d");
	KUNIT_EXPECT_EQ_MSG(test, port_events_reached(b->sim, b->now, -1, m), 2, "r and g");
	KUNIT_EXPECT_EQ(test, m[0] + m[7], 2);
	/* a closed loop is no cut */
	command(test, b, "on d");
	ec_sim_slave(b->sim, 4)->mem[EC_REG_DL_LOOPS] = EC_LOOP_CLOSED << 2;
	ec_sim_loops(ec_sim_slave(b->sim, 4), true, b->now);
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, b->now, -1, m), 5);
	command(test, b, "host a.2");
	KUNIT_EXPECT_EQ_MSG(test, port_events_reached(b->sim, b->now, -1, m), 5, "no master");
}

/* a path that was there all the time is one whose links have not changed */
static void sim_events_reached_since(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	u8 m[10];

	b->now = SECOND;
	command(test, b, "cut a.0");
	command(test, b, "heal a.0");
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, b->now, -1, m), N);
	KUNIT_EXPECT_EQ_MSG(test, port_events_reached(b->sim, b->now - 1, -1, m), N - 3, "a, b, c");
	KUNIT_EXPECT_EQ(test, m[1] + m[2] + m[3], 0);
	b->now += SECOND;
	command(test, b, "off f");
	command(test, b, "on f");
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, SECOND, -1, m), N - 2);
	KUNIT_EXPECT_EQ(test, m[6] + m[7], 0);
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, SECOND - 1, -1, m), N - 5);
	command(test, b, "swap b e");
	KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, SECOND, -1, m), N - 2 - 3);
}

static void expect_peer(struct kunit *test, struct bed *b, int slave, int port, int peer,
			int peer_port)
{
	struct port_end e = port_events_peer(b->sim, slave, port);

	KUNIT_EXPECT_EQ_MSG(test, e.slave, peer, "port %d of slave %d", port, slave);
	KUNIT_EXPECT_EQ_MSG(test, e.port, peer_port, "port %d of slave %d", port, slave);
}

static void sim_events_peers(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS "wire g.1 -> master.1\n", N);

	expect_peer(test, b, 0, 0, EC_SIM_MASTER0, 0);
	expect_peer(test, b, 0, 1, 1, 0);
	expect_peer(test, b, 0, 2, 4, 0);
	expect_peer(test, b, 0, 3, PORT_END_NONE, 0);
	expect_peer(test, b, 2, 0, 1, 1);
	expect_peer(test, b, 7, 1, EC_SIM_MASTER1, 0);
	command(test, b, "host a.2");
	expect_peer(test, b, 1, 2, PORT_END_HOST, 0);
	command(test, b, "cut b.0");
	expect_peer(test, b, 1, 1, PORT_END_NONE, 0);
	expect_peer(test, b, 2, 0, PORT_END_NONE, 0);
	KUNIT_EXPECT_EQ_MSG(test, port_events_cable(b->sim, 1, 1).slave, 2, "broken, but there");
}

/* ---- the model withstands them */

/* with loops that open by themselves a frame passes whom the links reach, each once */
static void sim_events_frames_pass_reached(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	struct port_events *e = begin(test, b, 4);
	u32 settled = 0, lost = 0;
	u8 m[PORT_EVENTS_SLAVES];

	e->kinds &= ~BIT(PORT_EVENT_FOREIGN);
	e->in_frame_percent = 0;
	b->gap = 0;
	while (e->events < 3000) {
		u64 before = ec_sim_disturbed(b->sim);
		int n;

		port_events_plan(e, b->now);
		b->now += MS;
		n = count(b, 0);
		lost += n < 0;
		if (ec_sim_disturbed(b->sim) != before)
			continue;
		settled++;
		KUNIT_ASSERT_EQ_MSG(test, n, (int)port_events_reached(b->sim, ~0ull, -1, m),
				    "after %u events", (u32)e->events);
	}
	KUNIT_EXPECT_GT(test, settled, 100000);
	KUNIT_EXPECT_GT_MSG(test, ec_sim_disturbed(b->sim), 10, "frames met events");
	KUNIT_EXPECT_LE(test, (u64)lost, ec_sim_disturbed(b->sim));
}

/* events that wait for frames meet some of them; a frame that meets none returns */
static void sim_events_meet_frames(struct kunit *test)
{
	struct bed *b = app_bed_part(test, BUS, N);
	struct port_events *e = begin(test, b, 5);
	u32 frames = 0, lost = 0;
	u64 met;

	e->kinds &= ~BIT(PORT_EVENT_FOREIGN);
	e->in_frame_percent = 100;
	while (e->events < 2000) {
		port_events_plan(e, b->now);
		b->now += MS;
		lost += count(b, 0) < 0;
		frames++;
	}
	met = ec_sim_disturbed(b->sim);
	KUNIT_EXPECT_GT(test, met, 500);
	KUNIT_EXPECT_LT_MSG(test, met, 2000, "of %u frames", frames);
	KUNIT_EXPECT_GT(test, lost, 200);
	KUNIT_EXPECT_LE(test, (u64)lost, met);
}

/* all kinds, all fates, then all is as it was */
static void sim_events_restored(struct kunit *test)
{
	for (u64 seed = 1; seed <= 20; seed++) {
		struct bed *b = app_bed_part(test, BUS "wire g.1 -> master.1\n", N);
		struct port_events *e = begin(test, b, seed);
		u8 m[PORT_EVENTS_SLAVES];

		ec_sim_set_under_way(b->sim, (enum ec_sim_under_way)(seed % 3));
		e->root = seed & 1;
		e->wrong_way = seed & 2;
		while (e->events < 200) {
			port_events_plan(e, b->now);
			b->now += MS;
			count(b, (int)(b->now / MS & 1));
		}
		port_events_stop(e);
		for (u64 t = 0; t <= PORT_EVENTS_REST_NS + e->ahead_ns; t += MS) {
			b->now += MS;
			count(b, 0);
		}
		port_events_restore(e, b->now);
		ec_sim_advance(b->sim, b->now);
		for (int i = 0; i < e->slaves; i++)
			for (int p = 0; p < EC_MAX_PORT; p++)
				expect_peer(test, b, i, p, e->first[i][p].slave,
					    e->first[i][p].port);
		KUNIT_EXPECT_EQ(test, port_events_reached(b->sim, b->now, -1, m), N);
		KUNIT_EXPECT_EQ(test, count(b, 0), N);
		if (seed < 20)
			ec_sim_free(b->sim);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_events_distances),
	KUNIT_CASE(sim_events_exponential),
	KUNIT_CASE(sim_events_repeat_with_seed),
	KUNIT_CASE(sim_events_only_chosen_kinds),
	KUNIT_CASE(sim_events_reached_by_links),
	KUNIT_CASE(sim_events_reached_since),
	KUNIT_CASE(sim_events_peers),
	KUNIT_CASE(sim_events_frames_pass_reached),
	KUNIT_CASE(sim_events_meet_frames),
	KUNIT_CASE(sim_events_restored),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_events",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
