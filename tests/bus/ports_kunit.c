// SPDX-License-Identifier: GPL-2.0-only
/* While process data run, a slave gets none before it has been looked at. */
#include "cyc.h"
#include "devices/sim/esc_int.h"

static const char text[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"slave a1 drive in=8 out=8\nslave a2 drive in=8 out=8\n"
	"branch hub 2\nslave b1 drive in=8 out=8\nslave b2 drive in=8 out=8\n"
	"branch none\nslave x1 drive in=8 out=8\nslave x2 drive in=8 out=8\n";

enum { HUB, A1, A2, B1, B2, X1, X2 };

#define N	5

static u8 *mem(struct bus *b, u32 index)
{
	return bus_esc(b, index)->mem;
}

static u8 loops(struct bus *b, u32 index)
{
	return mem(b, index)[EC_REG_DL_LOOPS];
}

/**
 * struct watch - process data of the drives at port 1 of the hub
 * @incomplete: cycles in which their domain was not complete
 * @silent: no frame of the last cycle has returned
 * @foreign: cycles in which a slave that does not belong to them took part
 */
struct watch {
	u32 incomplete;
	u32 foreign;
	bool silent;
};

static void look(struct cyc *c)
{
	struct watch *w = c->ctx;
	const struct ec_status_domain *d = cyc_state(c, 0);

	w->incomplete += d->wc_state != 2;
	w->foreign += d->working_counter > 6;
	w->silent = d->age > 1;
}

static struct cyc *in_op_of(struct kunit *test, const char *line, struct watch *w)
{
	struct bus *b = bus_up(test, line, N);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, A1, 2, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	cyc_run(c, 100);
	c->ctx = w;
	c->each = look;
	return c;
}

static struct cyc *in_op(struct kunit *test, struct watch *w)
{
	return in_op_of(test, text, w);
}

/* Ports with link and neighbor close themselves, free ones are closed, and all open at the end. */
static void ports_closed_while_active(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct bus *b = c->b;
	u32 i;

	KUNIT_EXPECT_EQ(test, loops(b, HUB), 0x14);
	KUNIT_EXPECT_EQ(test, loops(b, A1), 0x04);
	KUNIT_EXPECT_EQ(test, loops(b, A2), 0x0c);
	KUNIT_EXPECT_EQ(test, loops(b, B2), 0x0c);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
	c->each = NULL;
	cyc_release(c);
	msleep(100);
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_EQ_MSG(test, loops(b, i), 0, "slave %u", i);
}

/* The same if the master is unloaded as soon as the application has exited. */
static void ports_open_after_unload(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct bus *b = c->b;
	u32 i;

	KUNIT_EXPECT_EQ(test, loops(b, HUB), 0x14);
	c->each = NULL;
	bus_end(b);
	ec_masters_destroy();
	for (i = 0; i < N; i++)
		KUNIT_EXPECT_EQ_MSG(test, loops(b, i), 0, "slave %u", i);
}

/* FMMUs that another master has left, over the outputs and inputs of running drives */
static void old_fmmus(struct bus *b, u32 index, u32 of)
{
	memcpy(mem(b, index) + EC_REG_FMMU(0), mem(b, of) + EC_REG_FMMU(0), 3 * EC_FMMU_PAGE);
	memcpy(mem(b, index) + EC_REG_SM(0), mem(b, of) + EC_REG_SM(0), 4 * EC_SM_PAGE);
	mem(b, index)[EC_REG_AL_STATUS] = EC_AL_OP;
	ec_sim_rehash(bus_esc(b, index));
}

/* New slaves, even with the FMMUs of running ones, are let in, and no cycle is disturbed. */
static void ports_new_slaves(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct bus *b = c->b;
	u32 i;

	bus_command(b, "old x1 station=5 state=OP");
	cyc_run(c, 5);
	old_fmmus(b, X1, A1);
	bus_command(b, "plug a2.1 x1.0");
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ_MSG(test, bus_n_slaves(b), N, "the link is not stable yet");
	for (i = 0; i < 2000 && !(bus_n_slaves(b) == N + 2 &&
				  READ_ONCE(bus_slave(b, 3)->al.status) == EC_AL_PREOP &&
				  READ_ONCE(bus_slave(b, 4)->al.status) == EC_AL_PREOP); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), N + 2u);
	bus_figure("two new slaves in PREOP %u cycles after their link came", i + 50);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 3)->station,
			get_unaligned_le16(mem(b, X1) + EC_REG_STATION));
	KUNIT_EXPECT_EQ(test, bus_slave(b, 4)->station,
			get_unaligned_le16(mem(b, X2) + EC_REG_STATION));
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 2), 1), 3);
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 3), 1), 4);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
	KUNIT_EXPECT_EQ(test, w.foreign, 0u);
	KUNIT_EXPECT_EQ(test, loops(b, A2), 0x04);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, loops(b, X2), 0x0c);
}

/* A branch that was away comes back: it has kept its addresses, and its drives return to OP. */
static void ports_branch_returns(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct bus *b = c->b;
	u16 station[2] = { bus_slave(b, 3)->station, bus_slave(b, 4)->station };
	u32 i;

	bus_command(b, "unplug hub.2");
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 3u);
	KUNIT_EXPECT_EQ(test, loops(b, HUB), 0x34);
	bus_command(b, "plug hub.2 b1.0");
	for (i = 0; i < 2000 && bus_n_slaves(b) < N; i++)
		cyc_run(c, 1);
	bus_figure("a branch of two back in the list %u cycles after its link came", i);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)N);
	cyc_run(c, 200);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, 3 + i)->station, station[i]);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
}

/* The same at the drives of the application: back in OP. */
static void ports_drives_return(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct bus *b = c->b;
	u64 t0;

	bus_command(b, "unplug hub.1");
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 3u);
	bus_command(b, "plug hub.1 a1.0");
	t0 = ktime_get_ns();
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_figure("two drives back in OP %llu ms after their link came",
		   div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2u);
}

/* registers of a slave that has nothing to do with what is plugged in */
struct healthy {
	u8 station[2];
	u8 loops;
	u8 al[2];
	u8 fmmu[4 * EC_FMMU_PAGE];
	u8 sm[4 * EC_SM_PAGE];
	u8 dc;
};

static void take(struct bus *b, u32 index, struct healthy *h)
{
	const u8 *m = mem(b, index);
	u32 sm;

	memset(h, 0, sizeof(*h));
	memcpy(h->station, m + EC_REG_STATION, sizeof(h->station));
	h->loops = m[EC_REG_DL_LOOPS];
	memcpy(h->al, m + EC_REG_AL_STATUS, sizeof(h->al));
	memcpy(h->fmmu, m + EC_REG_FMMU(0), sizeof(h->fmmu));
	memcpy(h->sm, m + EC_REG_SM(0), sizeof(h->sm));
	/* the status of a buffer changes all the time */
	for (sm = 0; sm < 4; sm++)
		h->sm[sm * EC_SM_PAGE + EC_SM_OFS_STATUS] = 0;
	h->dc = m[EC_REG_DC_ACTIVATION];
}

#define HEALTHY	5	/* all that are connected at first */
#define FRAMES	60	/* of a trial and of the cycle meanwhile */

/* Frame @n from shortly before the trial on meets @what. Returns cycles of a wrong address. */
static u32 try_at(struct cyc *c, const struct healthy *h, const char *what, u32 n, u32 *odd)
{
	struct bus *b = c->b;
	struct healthy is;
	char text[64];
	u32 i, k, wrong = 0;

	/* as after a rest: losses of the try before do not count */
	memset(bus_slave(b, A2)->ports.loss, 0, sizeof(bus_slave(b, A2)->ports.loss));
	bus_command(b, "plug a2.1 x1.0");
	cyc_run(c, 95);
	snprintf(text, sizeof(text), what, n);
	bus_command(b, text);
	for (k = 0; k < 1500; k++) {
		bool all = true;

		cyc_run(c, 1);
		if (k == 2 * FRAMES)
			bus_command(b, "heal a2.1");
		for (i = 0; i < HEALTHY; i++) {
			take(b, i, &is);
			all &= !memcmp(is.station, h[i].station, 2);
			/* its own port opens for the new ones */
			is.loops = i == A2 ? h[i].loops : is.loops;
			*odd += memcmp(&is.loops, &h[i].loops,
				       sizeof(is) - offsetof(struct healthy, loops)) != 0;
		}
		wrong += !all;
		if (bus_n_slaves(b) == N + 2 && k > 2 * FRAMES + 10)
			break;
	}
	KUNIT_EXPECT_EQ_MSG(b->test, bus_n_slaves(b), N + 2u, "%s", text);
	bus_command(b, "unplug a2.1");
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ_MSG(b->test, bus_n_slaves(b), (u32)N, "%s", text);
	return wrong;
}

/* The contact breaks at each frame of a trial, and each of its frames is lost. */
static void ports_fault_at_each_frame(struct kunit *test)
{
	static const char * const faults[] = {
		"cut a2.1 frame=%u when=out", "cut a2.1 frame=%u when=back",
		"lose frame=%u", "lose frame=%u when=out",
	};
	struct healthy h[HEALTHY];
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 i, n, most = 0, odd = 0, lost;

	for (i = 0; i < HEALTHY; i++)
		take(c->b, i, &h[i]);
	for (i = 0; i < ARRAY_SIZE(faults); i++)
		for (n = 1; n <= FRAMES; n++)
			most = max(most, try_at(c, h, faults[i], n, &odd));
	lost = w.incomplete;
	bus_figure("faults at each of %u frames from before a trial on: an address wrong for at most %u cycles, %u of %llu cycles incomplete",
		   FRAMES * (u32)ARRAY_SIZE(faults), most, lost, c->cycles);
	KUNIT_EXPECT_LE(test, most, 2u);
	KUNIT_EXPECT_EQ(test, odd, 0u);
	KUNIT_EXPECT_EQ(test, w.foreign, 0u);
	/* each fault takes one frame, which may be that of the cycle */
	KUNIT_EXPECT_LE(test, lost, FRAMES * (u32)ARRAY_SIZE(faults));
}

/* What the command shows of port 1. */
static struct ec_ioc_port kept(struct bus *b, u16 slave)
{
	struct ec_ioc_port p = { .port = 1, .slave = { .position = slave } };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_PORT, &p), 0);
	return p;
}

/* A PC or a cable between two free ports: said once, and no frame of the cycle is lost. */
static void ports_no_reply(struct kunit *test)
{
	static const char * const commands[] = {
		"host b2.1 every=1ms", "plug a2.1 b2.1",
	};
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(commands); i++) {
		u32 lines = bus_log_lines("no slave replies behind it");

		bus_command(c->b, commands[i]);
		cyc_run(c, 12000);
		KUNIT_EXPECT_EQ_MSG(test, bus_log_lines("no slave replies behind it") - lines,
				    i ? 2u : 1u, "%s", commands[i]);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
		KUNIT_EXPECT_EQ(test, loops(c->b, B2), 0x0c);
		KUNIT_EXPECT_EQ(test, kept(c->b, B2).kept, (u32)EC_PORT_NO_REPLY);
		bus_command(c->b, "unplug b2.1");
		cyc_run(c, 100);
	}
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
}

/* A device behind a new slave swallows all frames: the slave gets in, the device no frames. */
static void ports_slave_with_host_behind(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 i;

	bus_command(c->b, "unplug x1.1");
	bus_command(c->b, "host x1.1 every=1ms");
	bus_command(c->b, "plug a2.1 x1.0");
	for (i = 0; i < 3000 && bus_n_slaves(c->b) == N; i++)
		cyc_run(c, 1);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), N + 1u);
	KUNIT_EXPECT_EQ(test, loops(c->b, X1), 0x0c);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
}

/* One whose loops are fixed is let in alone; with others behind it the port stays closed. */
static void ports_slave_with_fixed_loops(struct kunit *test)
{
	u32 lines = bus_log_lines("does not keep register 0x0101");
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 i;

	bus_esc(c->b, X1)->cfg.loops_fixed = true;
	old_fmmus(c->b, X2, A1);
	bus_command(c->b, "plug a2.1 x1.0");
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_log_lines("does not keep register 0x0101") - lines, 1u);
	bus_command(c->b, "unplug x1.1");
	for (i = 0; i < 20000 && bus_n_slaves(c->b) == N; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), N + 1u);
	KUNIT_EXPECT_EQ(test, w.foreign, 0u);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
}

/* One that is connected the wrong way round is let in alone, as port 0 cannot be closed. */
static void ports_reversed_branch(struct kunit *test)
{
	static const char line[] = "is connected the wrong way round";
	u32 lines = bus_log_lines(line);
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	struct ec_ioc_let_in let = { .port = 1, .slave = { .position = A2 } };
	u32 i;

	old_fmmus(c->b, X1, A1);
	old_fmmus(c->b, X2, A1);
	bus_command(c->b, "plug a2.1 x2.1");
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
	KUNIT_EXPECT_EQ(test, bus_log_lines(line) - lines, 1u);
	KUNIT_EXPECT_EQ(test, kept(c->b, A2).kept, (u32)EC_PORT_WRONG_WAY);
	/* no device that a user could let in */
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_LET_IN, &let), -ENOENT);
	bus_command(c->b, "unplug x2.0");
	for (i = 0; i < 20000 && bus_n_slaves(c->b) == N; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), N + 1u);
	bus_command(c->b, "unplug x2.1");
	cyc_run(c, 200);
	/* behind one that has its right way round */
	bus_command(c->b, "plug a2.1 x2.0");
	bus_command(c->b, "plug x2.1 x1.1");
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), N + 2u);
	KUNIT_EXPECT_EQ(test, w.foreign, 0u);
	KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
}

/*
 * A port in use closes itself without link, and opens by a frame from outside: a PC that is
 * connected there at once takes all frames.
 */
static void ports_host_instead_of_branch(struct kunit *test)
{
	static const char line[] = "no frame returned while it was open";
	static const struct {
		const char *unplug, *host, *back;
		u32 left;
	} at[] = {
		{ "unplug hub.2", "host hub.2 every=1ms", "plug hub.2 b1.0", 3 },
		{ "unplug b1.1", "host b1.1 every=1ms", "plug b1.1 b2.0", 4 },
		{ "unplug a1.1", "host a1.1 every=1ms", "plug a1.1 a2.0", 4 },
		{ "unplug hub.1", "host hub.1 every=1ms", "plug hub.1 a1.0", 3 },
	};
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 k, i, none, first = 0;

	for (k = 0; k < ARRAY_SIZE(at); k++) {
		u32 lines = bus_log_lines(line);

		bus_command(c->b, at[k].unplug);
		bus_command(c->b, at[k].host);
		cyc_run(c, 5);
		KUNIT_EXPECT_TRUE(test, w.silent);
		none = bus_log_lines("no slave replies behind it");
		for (i = 0; i < 3000 && bus_n_slaves(c->b) != at[k].left; i++) {
			cyc_run(c, 1);
			if (w.silent)
				first = i;
		}
		bus_figure("%s: frames again after %u cycles, list without those behind it after %u",
			   at[k].host, first, i);
		/* 150 to 204 in 32 of 40 moments, up to 386 in the others */
		KUNIT_EXPECT_LE(test, first, 400u);
		KUNIT_EXPECT_LE(test, i, 500u);
		KUNIT_EXPECT_EQ(test, bus_log_lines(line) - lines, 1u);
		w.incomplete = 0;
		cyc_run(c, 1000);
		KUNIT_EXPECT_EQ(test, bus_log_lines("no slave replies behind it"), none);
		if (k < 2)
			KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
		bus_command(c->b, at[k].unplug);
		bus_command(c->b, at[k].back);
		cyc_run(c, 12000);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
		KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2u);
	}
}

static const char beside_trial[] = "segment seed=7 response=100us transition=1ms link=200ms\n"
	"slave hub EK1100\n"
	"slave a1 drive in=8 out=8\nslave a2 drive in=8 out=8\n"
	"branch hub 2\nslave b1 drive in=8 out=8\nslave b2 drive in=8 out=8\n"
	"branch none\nrepeat 120 slave x drive in=8 out=8\n";

/*
 * While the master looks behind another port, which takes a second if many slaves are there, a port
 * that has lost its link is closed before a PC that is connected there has a link.
 */
static void ports_host_beside_trial(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op_of(test, beside_trial, &w);
	u32 ms;

	for (ms = 320; ms < 1600; ms += 300) {
		bus_command(c->b, "plug a2.1 x1.0");
		cyc_run(c, ms);
		bus_command(c->b, "unplug b1.1");
		bus_command(c->b, "host b1.1 every=1ms");
		w.incomplete = 0;
		cyc_run(c, 3000);
		/* of those before the place */
		KUNIT_EXPECT_EQ_MSG(test, w.incomplete, 0u, "after %u ms", ms);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), N - 1u + 120);
		bus_command(c->b, "unplug a2.1");
		bus_command(c->b, "unplug b1.1");
		bus_command(c->b, "plug b1.1 b2.0");
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_RESCAN, NULL), 0);
		cyc_run(c, 2000);
	}
}

/*
 * Slaves that a trial has let in are read before the master lists them, which takes long if one has
 * a slow EEPROM; process data reach them already. A port that one of them loses meanwhile is closed
 * before a PC that is connected there has a link.
 */
static void ports_host_behind_found(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op_of(test, beside_trial, &w);
	u32 ms;

	for (ms = 920; ms <= 1580; ms += 220) {
		bus_command(c->b, "plug a2.1 x1.0");
		cyc_run(c, ms);
		bus_command(c->b, "busy x5");
		cyc_run(c, 60);
		bus_command(c->b, "unplug x60.1");
		bus_command(c->b, "host x60.1 every=1ms");
		w.incomplete = 0;
		cyc_run(c, 1000);
		bus_command(c->b, "idle x5");
		cyc_run(c, 4000);
		KUNIT_EXPECT_EQ_MSG(test, w.incomplete, 0u, "after %u ms", ms);
		KUNIT_EXPECT_EQ_MSG(test, bus_n_slaves(c->b), N + 60u, "after %u ms", ms);
		bus_command(c->b, "unplug a2.1");
		bus_command(c->b, "unplug x60.1");
		bus_command(c->b, "plug x60.1 x61.0");
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_RESCAN, NULL), 0);
		cyc_run(c, 2000);
	}
}

/*
 * No frame returns for another reason: no port stays closed for that, whether slaves have executed
 * the frames or not.
 */
static void ports_all_frames_lost(struct kunit *test)
{
	static const char * const faults[] = { "lose rate=1000000ppm", "lose rate=1000000ppm when=out" };
	u32 i, k, lines = bus_log_lines("no frame returned while it was open");
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);

	for (i = 0; i < ARRAY_SIZE(faults); i++) {
		bus_command(c->b, faults[i]);
		cyc_run(c, 600);
		KUNIT_EXPECT_TRUE(test, w.silent);
		bus_command(c->b, i ? "lose rate=0ppm when=out" : "lose rate=0ppm");
		for (k = 0; k < 3000 && cyc_state(c, 0)->wc_state != 2; k++)
			cyc_run(c, 1);
		w.incomplete = 0;
		cyc_run(c, 1000);
		KUNIT_EXPECT_EQ(test, w.incomplete, 0u);
		KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
		KUNIT_EXPECT_EQ(test, loops(c->b, HUB), 0x14);
		KUNIT_EXPECT_EQ(test, loops(c->b, A1), 0x04);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("no frame returned while it was open"), lines);
}

/* A contact that bounces costs the frames of the first bounce, and is left alone then. */
static void ports_flapping(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	static const char line[] = "it has lost its link again and again (3 times in 10 s";
	u32 i, lines = bus_log_lines(line);

	for (i = 0; i < 8; i++) {
		bus_command(c->b, "cut hub.2");
		cyc_run(c, 40);
		bus_command(c->b, "heal hub.2");
		cyc_run(c, 400);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines(line) - lines, 1u);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), 3u);
	cyc_run(c, 5000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), (u32)N);
	KUNIT_EXPECT_LE(test, w.incomplete, 3u);
}

/* A port that waits is opened at once when a user asks for a scan. */
static void ports_retry(struct kunit *test)
{
	struct watch w = { 0 };
	struct cyc *c = in_op(test, &w);
	u32 i;

	for (i = 0; i < 8; i++) {
		bus_command(c->b, "cut hub.2");
		cyc_run(c, 40);
		bus_command(c->b, "heal hub.2");
		cyc_run(c, 40);
	}
	cyc_run(c, 400);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(c->b), 3u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_RESCAN, NULL), 0);
	for (i = 0; i < 3000 && bus_n_slaves(c->b) < N; i++)
		cyc_run(c, 1);
	bus_figure("a port that waits after losses opened, and two slaves read, %u cycles after the request", i);
	KUNIT_EXPECT_LE(test, i, 500u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ports_closed_while_active),
	KUNIT_CASE(ports_open_after_unload),
	KUNIT_CASE(ports_new_slaves),
	KUNIT_CASE(ports_branch_returns),
	KUNIT_CASE(ports_drives_return),
	KUNIT_CASE(ports_fault_at_each_frame),
	KUNIT_CASE(ports_no_reply),
	KUNIT_CASE(ports_slave_with_host_behind),
	KUNIT_CASE(ports_slave_with_fixed_loops),
	KUNIT_CASE(ports_reversed_branch),
	KUNIT_CASE(ports_host_instead_of_branch),
	KUNIT_CASE(ports_host_beside_trial),
	KUNIT_CASE(ports_host_behind_found),
	KUNIT_CASE(ports_all_frames_lost),
	KUNIT_CASE(ports_flapping),
	KUNIT_CASE(ports_retry),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ports", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
