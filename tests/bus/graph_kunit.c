// SPDX-License-Identifier: GPL-2.0-only
/* Slaves come, go and move: the list changes where that happens, and nowhere else. */
#include <linux/prandom.h>
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/bus/graph.h"

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"slave a1 drive in=8 out=8\nslave a2 drive in=8 out=8\n"
	"branch hub 2\nslave mid EK1100\n"
	"slave b1 drive in=8 out=8\nslave b2 drive in=8 out=8\nslave b3 drive in=8 out=8\n"
	"branch mid 2\nslave c1 drive in=8 out=8\nslave c2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8\nslave x2 drive in=8 out=8\n";

/* in the segment */
enum { HUB, A1, A2, MID, B1, B2, B3, C1, C2, X1, X2 };

#define N	9	/* connected at first */

static void settle(struct bus *b, u32 ms)
{
	msleep(ms);
	KUNIT_EXPECT_NE(b->test, bus_wait(b, b->sim->route[0].steps, EC_AL_PREOP, 5000), ~0ull);
}

/* steps that leave the number of slaves as it was, or not, without an application */
static const struct step {
	const char *name;
	const char *commands[4];
} steps[] = {
	{ "two slaves added at an end", { "plug a2.1 x1.0" } },
	{ "one added at each of two ends", { "plug b3.1 x1.0", "plug c2.1 x2.0" } },
	{ "one inserted into a line", { "unplug b1.1", "plug b1.1 x2.0", "plug x2.1 b2.0" } },
	{ "one inserted before a branch",
	  { "unplug hub.2", "plug hub.2 x2.0", "plug x2.1 mid.0" } },
	{ "one taken out of a line", { "unplug b2.0", "plug b1.1 b3.0" } },
	{ "a branch moved to another port", { "plug a2.1 c1.0" } },
	{ "a branch moved upstream", { "plug hub.1 c1.0", "plug c2.1 a1.0" } },
	{ "two slaves exchanged", { "swap b1 c1" } },
	{ "one exchanged for another one", { "swap b2 x2" } },
	{ "first and last exchanged", { "swap a1 c2" } },
	{ "the end of a branch turned round", { "plug c1.1 c2.1" } },
	{ "one that comes and one that goes", { "plug c2.1 x2.0", "unplug a2.0" } },
};

static void step_desc(const struct step *s, char *desc)
{
	strscpy(desc, s->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(step, steps, step_desc);

static void graph_follows(struct kunit *test)
{
	const struct step *step = test->param_value;
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *hub = bus_slave(b, 0);
	u32 i;

	bus_idle(b);
	bus_expect_graph(b, "the start");
	for (i = 0; i < ARRAY_SIZE(step->commands) && step->commands[i]; i++)
		bus_command(b, step->commands[i]);
	settle(b, 500);
	bus_expect_graph(b, step->name);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 0), hub);
}

/* A slave that was moved with its power on is the same. */
static void graph_moved_slave_is_not_read_again(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *c1 = bus_slave(b, C1), *c2 = bus_slave(b, C2);
	u64 device = c1->device;

	bus_idle(b);
	bus_command(b, "plug a2.1 c1.0");
	settle(b, 500);
	bus_expect_graph(b, "the move");
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 3), c1);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 4), c2);
	KUNIT_EXPECT_EQ(test, c1->device, device);
	KUNIT_EXPECT_EQ(test, c1->position, 3);
}

/* a1 and b1 hang at free ports alike: their order decides. */
static const char alike[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave top EK1100\nslave e drive in=8 out=8\n"
	"branch top 2\nslave r EK1100\nslave m EK1100\nslave k drive in=8 out=8\n"
	"branch m 2\nslave a1 drive in=8 out=8\n"
	"branch r 2\nslave b1 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8\nslave x2 drive in=8 out=8\n";

#define ALIKE	7	/* connected at first */

/* No list has a port that leads nowhere, until there is a whole one. */
static void expect_consistent(struct bus *b, u32 n, u32 frame)
{
	u32 i, ms, wrong = 0;

	for (ms = 0; ms < 400; ms++) {
		for (i = 0; i < bus_n_slaves(b); i++)
			wrong += bus_slave(b, i)->graph.inconsistent;
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_EQ_MSG(b->test, wrong, 0u, "frame %u", frame);
	settle(b, 100);
	KUNIT_ASSERT_EQ(b->test, bus_n_slaves(b), n);
}

/* While a scan looks at one place, a slave comes to another one: its port may be read open. */
static void graph_port_opens_in_scan(struct kunit *test)
{
	struct bus *b = bus_up(test, alike, ALIKE);
	char words[40];
	u32 frame;

	bus_idle(b);
	for (frame = 1; frame <= 40; frame++) {
		bus_command(b, "plug e.1 x1.0");
		snprintf(words, sizeof(words), "plug k.1 x2.0 frame=%u", frame);
		bus_command(b, words);
		expect_consistent(b, ALIKE + 2, frame);
		snprintf(words, sizeof(words), "frame %u", frame);
		bus_expect_graph(b, words);
		bus_command(b, "unplug x1.0");
		bus_command(b, "unplug x2.0");
		settle(b, 300);
		bus_expect_graph(b, words);
	}
}

/* A foreign device with the address of a slave is exchanged for that slave between two scans. */
static void graph_exchanged_for_its_double(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=7 response=100us transition=1ms\n"
			       "slave hub EK1100\nslave a drive in=8 out=8\n"
			       "branch hub 2\nslave d drive in=8 out=8\n"
			       "slave c drive in=8 out=8 alias=7\n"
			       "branch none\nslave x drive in=4 out=4 alias=9\n", 4);
	const struct ec_esc *c = bus_esc(b, 3);
	const struct ec_slave *s;
	char words[40];

	bus_idle(b);
	snprintf(words, sizeof(words), "old x station=%u", bus_slave(b, 3)->station);
	bus_command(b, "unplug c.0");
	settle(b, 300);
	bus_command(b, words);
	bus_command(b, "plug a.1 x.0");
	settle(b, 300);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->alias, 9);
	bus_command(b, "unplug x.0");
	bus_command(b, "plug d.1 c.0");
	settle(b, 300);
	bus_expect_graph(b, "the exchange");
	s = bus_slave(b, 3);
	KUNIT_EXPECT_EQ(test, s->alias, 7);
	KUNIT_EXPECT_EQ(test, memcmp(s->eeprom.data, c->eep.data, s->eeprom.bytes), 0);
}

/* Two branches that hang at each other's port contradict the ring order alone. */
static void graph_crossed_branches(struct kunit *test)
{
	enum { R = 2, M, A = 5, B };
	struct bus *b = bus_up(test, alike, ALIKE);
	struct ec_slave **s = bus_table(b)->slaves;

	bus_idle(b);
	down_write(&bus_table(b)->topo);
	ec_show_change_begin(&bus_table(b)->base->show);
	KUNIT_EXPECT_EQ(test, ec_graph_misfit(s, ALIKE), (unsigned int)ALIKE);
	swap(s[R]->graph.at[2], s[M]->graph.at[2]);
	swap(s[A]->graph.at[0], s[B]->graph.at[0]);
	KUNIT_EXPECT_EQ(test, ec_graph_misfit(s, ALIKE), (unsigned int)A);
	ec_show_change_end(&bus_table(b)->base->show);
	up_write(&bus_table(b)->topo);
	bus_command(b, "plug e.1 x1.0");
	settle(b, 500);
	bus_expect_graph(b, "crossed branches");
}

/* Receive times that were read wrong are read again. */
static void graph_wrong_receive_times(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *mid = bus_slave(b, MID);

	bus_idle(b);
	down_write(&bus_table(b)->topo);
	ec_show_change_begin(&bus_table(b)->base->show);
	mid->recv[1] = mid->recv[0] - 1000;
	ec_graph_note_ports(mid);
	ec_show_change_end(&bus_table(b)->base->show);
	up_write(&bus_table(b)->topo);
	bus_command(b, "plug a2.1 x1.0");
	settle(b, 500);
	KUNIT_EXPECT_EQ(test, mid->graph.upstream, 1);
	settle(b, 1500);
	bus_expect_graph(b, "wrong receive times");
}

/* What is known of a device that comes back is not read again, unless its EEPROM is another one. */
static void graph_eeprom_of_known_device(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	size_t bytes = bus_slave(b, N - 1)->eeprom.bytes;
	u32 i;

	bus_idle(b);
	for (i = 0; i < 3; i++) {
		u64 frames;

		bus_command(b, "off c2");
		msleep(200);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N - 1u);
		if (i == 1)
			bus_esc(b, C2)->eep.data[bytes - 3] ^= 1;
		bus_command(b, "on c2");
		settle(b, 300);
		KUNIT_EXPECT_EQ(test, bus_slave(b, N - 1)->eeprom.bytes, bytes);
		KUNIT_EXPECT_EQ(test, memcmp(bus_slave(b, N - 1)->eeprom.data,
					     bus_esc(b, C2)->eep.data, bytes), 0);
		frames = bus_table(b)->scan_frames;
		bus_figure("device back, EEPROM %s: %llu frames",
			   i == 1 ? "changed" : "as before", frames);
		if (i == 1)
			KUNIT_EXPECT_GT(test, frames, bytes / 8);
		else
			KUNIT_EXPECT_LT(test, frames, 50ull);
	}
}

/* A device that comes back leaves nothing behind. */
static void graph_devices_return_often(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u32 i;

	bus_idle(b);
	for (i = 0; i < 20; i++) {
		bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
		msleep(300);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 0u);
		KUNIT_EXPECT_EQ(test, bus_table(b)->known.n_lost, (u32)N);
		bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
		KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
		KUNIT_EXPECT_EQ(test, bus_table(b)->known.n_lost, 0u);
	}
}

static void bounce(struct bus *b, int slave, int port, u64 t, u64 end, struct rnd_state *r)
{
	while (t < end) {
		struct ec_sim_fault f = {
			.at_ns = t, .type = EC_SIM_FAULT_CUT, .slave = slave, .port = port,
		};

		KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
		f.type = EC_SIM_FAULT_HEAL;
		f.at_ns += 500000 + prandom_u32_state(r) % 6000000;
		KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
		t = f.at_ns + 500000 + prandom_u32_state(r) % 6000000;
	}
}

/* A contact that never comes to rest does not keep slaves from being found elsewhere. */
static void graph_found_beside_bouncing_contact(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct rnd_state r;
	u64 t0;
	u32 i;

	bus_idle(b);
	prandom_seed_state(&r, 33);
	t0 = ktime_get_ns();
	bounce(b, MID, 2, t0, t0 + NSEC_PER_SEC, &r);
	msleep(50);
	bus_command(b, "plug a2.1 x1.0");
	t0 = ktime_get_ns();
	for (i = 0; i < 900; i++) {
		if (bus_n_slaves(b) > 4 && bus_slave(b, 3)->eeprom.data &&
		    bus_slave(b, 3)->station ==
		    get_unaligned_le16(bus_esc(b, X1)->mem + EC_REG_STATION) &&
		    READ_ONCE(bus_slave(b, 3)->al.status) == EC_AL_PREOP)
			break;
		msleep(1);
	}
	KUNIT_EXPECT_LT(test, i, 600u);
	bus_figure("a slave found beside a bouncing contact after %llu ms",
		   div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	settle(b, 2000);
	bus_expect_graph(b, "the bounces");
}

/* random events of all kinds at the branch "mid", while drives beside it are in OP */
static const char * const events[] = {
	"cut mid.1", "heal mid.1", "cut b1.1", "heal b1.1", "cut b2.1", "heal b2.1",
	"cut mid.2", "heal mid.2", "cut c1.1", "heal c1.1", "cut mid.0", "heal mid.0",
	"off b1", "on b1", "off b2", "on b2", "off c1", "on c1", "off mid", "on mid",
	"plug b3.1 x1.0", "unplug x1.0", "plug c2.1 x1.0", "plug mid.2 x1.0", "plug x2.1 c1.0",
	"swap b1 c2", "swap b2 b3", "swap x2 b1", "unplug c2.0", "plug c1.1 c2.0",
};

static const char * const all_on[] = {
	"on mid", "on b1", "on b2", "on c1", "heal mid.0", "heal mid.1", "heal mid.2", "heal b1.1",
	"heal b2.1", "heal c1.1",
};

struct watch {
	struct ec_slave *slave[2];
	u32 offline;
	u32 incomplete;
};

static void look(struct cyc *c)
{
	struct watch *w = c->ctx;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(w->slave); i++)
		w->offline += READ_ONCE(w->slave[i]->stop.gone) ||
			      READ_ONCE(w->slave[i]->reply.silent) ||
			      READ_ONCE(w->slave[i]->work.reconfigure) ||
			      READ_ONCE(w->slave[i]->al.status) != EC_AL_OP;
	w->incomplete += cyc_state(c, 0)->wc_state != 2;
}

static void graph_random_events(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct cyc *c;
	struct watch w = { 0 };
	struct rnd_state r;
	u32 i, k, n = 400;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, A1, 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 20);
	for (i = 0; i < ARRAY_SIZE(w.slave); i++)
		w.slave[i] = ec_slave_ref(bus_slave(b, A1 + i));
	c->ctx = &w;
	c->each = look;
	prandom_seed_state(&r, 33);
	for (i = 0; i < n; i++) {
		bus_command(b, events[prandom_u32_state(&r) % ARRAY_SIZE(events)]);
		cyc_run(c, prandom_u32_state(&r) % (i % 10 ? 400 : 3));
		if (i % 20 != 19)
			continue;
		for (k = 0; k < ARRAY_SIZE(all_on); k++)
			bus_command(b, all_on[k]);
		cyc_run(c, 4000);
		bus_expect_graph(b, "random events");
	}
	c->each = NULL;
	KUNIT_EXPECT_EQ(test, w.offline, 0u);
	bus_figure("%u random events: drives beside them offline in %u, incomplete in %u of %llu cycles",
		   n, w.offline, w.incomplete, c->cycles);
	for (i = 0; i < ARRAY_SIZE(w.slave); i++) {
		KUNIT_EXPECT_FALSE(test, w.slave[i]->stop.gone);
		ec_slave_unref(w.slave[i]);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(graph_follows, step_gen_params),
	KUNIT_CASE(graph_moved_slave_is_not_read_again),
	KUNIT_CASE(graph_port_opens_in_scan),
	KUNIT_CASE(graph_exchanged_for_its_double),
	KUNIT_CASE(graph_crossed_branches),
	KUNIT_CASE(graph_wrong_receive_times),
	KUNIT_CASE(graph_eeprom_of_known_device),
	KUNIT_CASE(graph_devices_return_often),
	KUNIT_CASE(graph_found_beside_bouncing_contact),
	KUNIT_CASE(graph_random_events),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_graph", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
