// SPDX-License-Identifier: GPL-2.0-only
/*
 * A long run of a ring with clocks at 1 kHz and random faults: cables are cut and flap, slaves lose
 * power, mailboxes and clocks are wrong, frames are lost, the application restarts. All slaves are
 * alike. No value is wrong, each slave with a path stays in OP, and memory does not grow.
 *
 * ring_soak_kunit.minutes=N on the command line of the kernel says how long (EC_UML_ARGS of
 * tests/uml/run.sh). Each minute is a case; at its end all faults do.
 */
#include <linux/mm.h>
#include <linux/vmstat.h>
#include "random.h"
#include "devices/sim/app_int.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/clock/dc.h"

#define SLAVES		8u
#define CABLES		(SLAVES + 1)	/* the first and the last at the master */
#define FAULTS		2u		/* at a time */
#define ECHO		6		/* byte of the outputs of a drive that comes back */
#define UNTOUCHED	8		/* it, without outputs */
#define MINUTE		60000u		/* cycles */
#define NOTICED		500u		/* cycles: the master has noticed what was before */
#define RESTED		2000u		/* cycles: nothing of it is to be done */
#define RETURN		1500		/* 100 ms: a closed port is tried again after 80 s */
/* bytes: slabs are filled by and by; KASAN keeps freed memory back */
#define GROWTH		((IS_ENABLED(CONFIG_KASAN) ? 2048 : 256) << 10)

static unsigned int minutes = 2;
module_param(minutes, uint, 0444);
MODULE_PARM_DESC(minutes, "Minutes of virtual time, at most 1440");

static unsigned int seed = 37;
module_param(seed, uint, 0444);
MODULE_PARM_DESC(seed, "Seed of the faults");

enum kind {
	CUT, FLAP, POWER, MAILBOX, CLOCK, FRAME, KINDS
};

/**
 * struct fault - one that may be going on
 * @kind: of it
 * @active: it is
 * @at: cable or slave
 * @flaps: changes of the cable to come
 * @until: next change, ns
 */
struct fault {
	enum kind kind;
	bool active;
	u32 at;
	u32 flaps;
	u64 until;
};

/**
 * struct soak - what lives longer than a case
 * @b: bus, NULL: not yet
 * @c: application
 * @r: users of mailboxes, and what they know of slaves
 * @fault: faults
 * @calm: none begins
 * @open: cables
 * @off: slaves without power
 * @in: inputs of a slave
 * @out: its outputs
 * @last: these inputs in the last cycle
 * @sent: outputs that it has had in the last cycle
 * @count: numbers of the last sends, the newest first
 * @well: cycles in OP with a whole path; with RANDOM_SETTLED a slave is entitled to remain so
 * @complete: the last cycle was
 * @begun: faults by kind
 * @restarts: of the application
 * @parted: cycles in which the master had closed a port between two slaves
 * @held: old values, with an incomplete working counter
 * @stuck: times that slaves came back only when a cable was healed
 * @wrong: values
 * @left: slaves that had a path and left OP
 * @memory: after the first minute, bytes
 */
static struct soak {
	struct bus *b;
	struct cyc c;
	struct random_run r;
	struct fault fault[FAULTS];
	bool calm;
	bool open[CABLES];
	bool off[SLAVES];
	u8 *in[SLAVES];
	u8 *out[SLAVES];
	u8 last[SLAVES];
	u8 sent[SLAVES];
	u8 count[RANDOM_HISTORY];
	u32 well[SLAVES];
	bool complete;
	u64 begun[KINDS];
	u64 restarts;
	u64 parted;
	u64 held;
	u64 stuck;
	u64 wrong;
	u64 left;
	long memory;
} soak;

/* what a slave gets with a send: no two slaves get the same */
static u8 code(u8 count, u32 i)
{
	return count * SLAVES + i;
}

/* The mode of operation that a drive was sent; the inputs echo it. */
static u8 outputs(const struct soak *s, u32 i)
{
	const struct ec_app *app = bus_esc(s->b, i)->app;

	return ec_app_od_get(app, ec_app_od_entry(app->model, 0x6060, 0));
}

static u8 loop_of(const struct soak *s, u32 i, u32 port)
{
	return bus_esc(s->b, i)->mem[EC_REG_DL_LOOPS] >> 2 * port & 3;
}

/* a port that leads away from the main device, closed by the master */
static bool is_closed(const struct soak *s, u32 i)
{
	return loop_of(s, i, 1) == EC_LOOP_CLOSED;
}

/* the end of a break whose cable is whole again, which the master has not opened yet */
static bool is_end(const struct soak *s, u32 i, u32 port)
{
	return loop_of(s, i, port) == EC_LOOP_AUTO_CLOSE && !bus_esc(s->b, i)->port[port].open;
}

/* from the main device to the next slave, and back */
static bool is_way(const struct soak *s, u32 cable)
{
	if (cable && (is_closed(s, cable - 1) || is_end(s, cable - 1, 1)))
		return false;
	return !s->open[cable] && (cable == SLAVES || !is_end(s, cable, 0));
}

/*
 * The last port is closed while the master measures delays: then a break parts slaves. So it does
 * before the ends of another one, which has healed, are open.
 */
static bool has_path(const struct soak *s, u32 i)
{
	bool front = true, back = true;
	u32 k;

	for (k = 0; k <= i; k++)
		front &= is_way(s, k) && !s->off[k];
	for (k = i; k < SLAVES; k++)
		back &= !s->off[k] && is_way(s, k + 1);
	return front || back;
}

/*
 * A cut counts before frames set out that may meet it. It comes before a repair that is requested
 * in the same cycle.
 */
static void cable(struct soak *s, u32 at, bool open)
{
	u32 half = NSEC_PER_MSEC / 2;

	s->open[at] = open;
	bus_fault_later(s->b, open ? EC_SIM_FAULT_CUT : EC_SIM_FAULT_HEAL, min(at, SLAVES - 1),
			at == SLAVES, (open ? 2 : 3) * half + random_below(&s->r, half));
}

static void command(struct soak *s, const char *what, u32 at, const char *how)
{
	char text[64];

	snprintf(text, sizeof(text), "%s d%u%s", what, at + 1, how);
	bus_command(s->b, text);
}

static void begin(struct soak *s, struct fault *f, u64 now)
{
	static const char * const mail[] = {
		" lost", " garbage", " almost", " duplicate", " busy", " counter", " stale",
		" delay by=20ms",
	};
	static const char * const frame[] = {
		"lose frame=1", "duplicate frame=1", "delay frame=1 by=2ms",
	};
	struct random_run *r = &s->r;
	u32 k;

	f->kind = random_below(r, KINDS);
	f->at = random_below(r, f->kind == CUT || f->kind == FLAP ? CABLES : SLAVES);
	for (k = 0; k < FAULTS; k++)
		if (s->fault[k].active && s->fault[k].at == f->at)
			return;
	f->active = true;
	f->until = now + (50 + random_below(r, 1500)) * NSEC_PER_MSEC;
	s->begun[f->kind]++;
	switch (f->kind) {
	case FLAP:
		f->flaps = 2 * (1 + random_below(r, 10));
		f->until = now;
		break;
	case POWER:
		s->off[f->at] = true;
		/* it may end before the next look */
		s->well[f->at] = 0;
		command(s, "off", f->at, "");
		break;
	case MAILBOX:
		r->s[f->at].mailbox = false;
		s->well[f->at] = 0;
		command(s, "mailbox", f->at, mail[random_below(r, ARRAY_SIZE(mail))]);
		break;
	case CLOCK:
		command(s, "jump", f->at, " by=1ms");
		break;
	case FRAME:
		bus_command(s->b, frame[random_below(r, ARRAY_SIZE(frame))]);
		break;
	default:
		cable(s, f->at, true);
	}
}

static void end(struct soak *s, struct fault *f, u64 now)
{
	f->active = false;
	f->until = now + random_below(&s->r, 1000) * NSEC_PER_MSEC;
	switch (f->kind) {
	case POWER:
		s->off[f->at] = false;
		command(s, "on", f->at, "");
		break;
	case MAILBOX:
		s->r.s[f->at].mailbox = true;
		command(s, "mailbox", f->at, " good");
		break;
	case CLOCK:
		command(s, "jump", f->at, " by=-1ms");
		break;
	case FRAME:
		break;
	default:
		if (s->open[f->at])
			cable(s, f->at, false);
	}
}

static void turn(struct soak *s, struct fault *f, u64 now)
{
	if (now < f->until)
		return;
	if (f->active && f->kind == FLAP && f->flaps--) {
		cable(s, f->at, !s->open[f->at]);
		f->until = now + (2 + random_below(&s->r, 60)) * NSEC_PER_MSEC;
	} else if (f->active) {
		end(s, f, now);
	} else if (!s->calm) {
		begin(s, f, now);
	}
}

/* One that has returned in OP, or whose SYNC began before its clock was set, starts again. */
static bool is_known(struct ec_slave *s)
{
	return !READ_ONCE(s->stop.gone) && !READ_ONCE(s->reply.silent) &&
		!READ_ONCE(s->work.reconfigure) && READ_ONCE(s->al.status) == EC_AL_OP &&
		!READ_ONCE(ec_clock_of(s)->sync_unsynchronized) && !ec_slave_busy(s);
}

static void become(struct soak *s, u32 i)
{
	u16 station = get_unaligned_le16(bus_esc(s->b, i)->mem + EC_REG_STATION);
	struct random_slave *x = &s->r.s[i];
	u32 k;

	for (k = 0; k < bus_n_slaves(s->b); k++)
		if (bus_slave(s->b, k)->station == station)
			break;
	if (k == bus_n_slaves(s->b) || !is_known(bus_slave(s->b, k)))
		return;
	if (x->slave)
		ec_slave_unref(x->slave);
	x->slave = ec_slave_ref(bus_slave(s->b, k));
	s->well[i] = 1;
}

static void report(struct soak *s, u32 i, const char *what, u8 is)
{
	if (s->wrong + s->left <= 10)
		pr_info("# %s: slave %u, 0x%02x, expected 0x%02x, AL 0x%02x, ring %u front %u, well for %u cycles, faults %u %u%s, %u %u%s, %llu ns\n",
			what, i, is, code(s->count[1], i),
			bus_esc(s->b, i)->mem[EC_REG_AL_STATUS], bus_links(s->b)->ring.state,
			bus_links(s->b)->ring.front, s->well[i], s->fault[0].kind,
			s->fault[0].at, s->fault[0].active ? "!" : "", s->fault[1].kind,
			s->fault[1].at, s->fault[1].active ? "!" : "", ktime_get_ns());
}

static void wrong(struct soak *s, u32 i, const char *what, u8 is)
{
	s->wrong++;
	report(s, i, what, is);
	s->well[i] = 0;
}

/* Its inputs hold, and the working counter is incomplete. */
static void hold(struct soak *s, u32 i)
{
	s->held++;
	s->well[i] = 0;
}

/* An LRW reads before it writes: a value is that of the send before the last. */
static void judge(struct soak *s, u32 i, bool steady)
{
	bool op = bus_esc(s->b, i)->mem[EC_REG_AL_STATUS] == EC_AL_OP;
	u8 is = *s->in[i];
	u32 k;

	if (is != s->last[i] && is && is != UNTOUCHED && is % SLAVES != i)
		wrong(s, i, "value of another slave", is);
	s->last[i] = is;
	is = outputs(s, i);
	if (is != s->sent[i] && is && is != UNTOUCHED && is % SLAVES != i)
		wrong(s, i, "outputs of another slave", is);
	s->sent[i] = is;
	is = *s->in[i];
	if (!has_path(s, i)) {
		s->well[i] = 0;
		return;
	}
	if (s->well[i] <= RANDOM_SETTLED) {
		if (!op || is != code(s->count[1], i))
			s->well[i] = 0;
		else if (s->well[i])
			s->well[i]++;
		else
			become(s, i);
		return;
	}
	s->well[i]++;
	for (k = 0; k < RANDOM_HISTORY && is != code(s->count[k], i); k++)
		;
	/* the working counter says so */
	if (k == RANDOM_HISTORY && !steady)
		hold(s, i);
	else if (k == RANDOM_HISTORY)
		wrong(s, i, "old value of a complete cycle", is);
	else if (steady && k > 1)	/* newer: at an event both copies may pass it */
		wrong(s, i, "value of a complete cycle", is);
	if (op)
		return;
	if (s->well[i] > NOTICED) {
		s->left++;
		report(s, i, "left OP", is);
	}
	s->well[i] = 0;
}

static void look(struct cyc *c)
{
	struct soak *s = c->ctx;
	u64 now = ktime_get_ns();
	bool complete, closed = false;
	u32 i;

	ec_sim_advance(s->b->sim, now);
	complete = cyc_state(c, 0)->wc_state == EC_STATUS_WC_COMPLETE;
	for (i = 0; i < SLAVES; i++) {
		judge(s, i, complete && s->complete);
		s->r.s[i].well = max(s->well[i], RESTED) - RESTED;
	}
	s->complete = complete;
	for (i = 0; i < SLAVES - 1; i++)
		closed |= is_closed(s, i);
	s->parted += closed;
	for (i = 0; i < FAULTS; i++)
		turn(s, &s->fault[i], now);
	memmove(s->count + 1, s->count, RANDOM_HISTORY - 1);
	s->count[0] = s->count[0] % (U8_MAX / SLAVES) + 1;
	for (i = 0; i < SLAVES; i++)
		*s->out[i] = code(s->count[0], i);
	random_users_turn(&s->r, now);
}

static void configure(struct soak *s)
{
	struct cyc *c = cyc_new(s->b, 1000);
	u32 i;

	cyc_domain(c);
	cyc_map_all(c, 0, SLAVES, 0);
	cyc_sync0(c, SLAVES);
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR;
	cyc_activate(c);
	s->c = *c;
	for (i = 0; i < SLAVES; i++) {
		s->in[i] = cyc_pd(c, i, 3) + ECHO;
		s->out[i] = cyc_pd(c, i, 2) + ECHO;
		s->well[i] = 0;
		s->last[i] = 0;
	}
	s->complete = false;
	s->c.ctx = s;
	s->c.each = look;
	KUNIT_ASSERT_NE(s->b->test, cyc_wait_op(&s->c, 30000), ~0ull);
}

static bool all_return(struct soak *s, bool all)
{
	u32 i;

	s->calm = true;
	for (i = 0; i < FAULTS; i++)
		if (s->fault[i].active && (all || s->fault[i].kind != CUT))
			end(s, &s->fault[i], ktime_get_ns());
	for (i = 0; i < RETURN && (i < 5 || bus_n_slaves(s->b) < SLAVES || !cyc_all_op(&s->c)); i++)
		cyc_run(&s->c, 100);
	return bus_n_slaves(s->b) == SLAVES;
}

/*
 * Faults but cuts end, with @all these too, and none begins. What is behind a port that the master
 * has closed before a cut is reached again when the cable is whole.
 */
static void calm(struct soak *s, bool all)
{
	if (all_return(s, all))
		return;
	s->stuck++;
	KUNIT_ASSERT_TRUE(s->b->test, all_return(s, true));
}

/* A ring that seems to have a slave the wrong way round has to close before an activation. */
static void restart(struct soak *s)
{
	calm(s, bus_ring_turned(s->b));
	cyc_release(&s->c);
	configure(s);
	s->restarts++;
	s->calm = false;
}

static void prepare(struct kunit *test)
{
	char *text = kunit_kzalloc(test, 4096, GFP_KERNEL);
	struct random_run *r = &soak.r;
	size_t len;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	r->rng = seed;
	r->n = SLAVES;
	len = scnprintf(text, 4096, "segment seed=8 response=100us transition=1ms\n");
	for (i = 1; i <= SLAVES; i++) {
		r->s[i - 1].mailbox = true;
		len += scnprintf(text + len, 4096 - len,
				 "slave d%u drive in=8 out=8 mbox=128 foe=16 cable=50 drift=%dppb clock=%ums\n",
				 i, (int)random_below(r, 200000) - 100000,
				 random_below(r, 1000000));
	}
	scnprintf(text + len, 4096 - len, "wire d%u.1 -> master.1 cable=50\n", SLAVES);
	soak.b = bus_up(test, text, SLAVES);
	test->priv = NULL;	/* it lives longer than this case */
	r->b = soak.b;
	r->c = &soak.c;
	bus_idle(soak.b);
	configure(&soak);
}

/* What the kernel, and sessions, have taken. */
static long memory_now(struct soak *s)
{
	return (long)global_node_page_state_pages(NR_SLAB_UNRECLAIMABLE_B) * PAGE_SIZE +
		bus_memory(s->b);
}

/* A scan, and a job of the clocks, take 512 KiB as long as they run. */
static long memory_at_rest(struct soak *s)
{
	long least = memory_now(s);
	u32 i;

	for (i = 0; i < 10 && (!s->memory || least > s->memory + GROWTH); i++) {
		cyc_run(&s->c, 1000);
		least = min(least, memory_now(s));
	}
	return least;
}

static void expect_all_well(struct soak *s, u32 minute)
{
	struct kunit *test = s->b->test;
	struct random_user *u = s->r.user;
	long memory = memory_at_rest(s);

	KUNIT_EXPECT_EQ(test, s->wrong, 0ull);
	KUNIT_EXPECT_EQ(test, s->left, 0ull);
	/* printed; one that meets a port that the master has closed may fail */
	KUNIT_EXPECT_LE(test, u[0].bad + u[1].bad, 1 + minutes / 240);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(&s->c));
	KUNIT_EXPECT_EQ(test, bus_links(s->b)->ring.state, EC_RING_CLOSED);
	s->memory = s->memory ?: memory;
	KUNIT_EXPECT_LE(test, memory, s->memory + GROWTH);
	if (minute < minutes)
		return;
	bus_figure("ring of %u slaves, %u minutes at 1 kHz, seed %u: %llu cuts, %llu flapping cables, %llu times no power, %llu wrong mailboxes, %llu wrong clocks, %llu frames, %llu restarts; %llu wrong values, %llu held, %llu slaves with a path left OP, a port in the ring closed for %llu ms, %llu times slaves parted by it until a cable was healed; objects %u good, %u cut off, %u failed, files %u, %u, %u; memory %ld KiB, %ld after the first minute",
		   SLAVES, minutes, seed, s->begun[CUT], s->begun[FLAP], s->begun[POWER],
		   s->begun[MAILBOX], s->begun[CLOCK], s->begun[FRAME], s->restarts, s->wrong,
		   s->held, s->left, s->parted, s->stuck, u[0].good, u[0].cut, u[0].bad, u[1].good,
		   u[1].cut, u[1].bad,
		   memory >> 10, s->memory >> 10);
}

static const char numbers[1440];	/* their addresses count */

static const void *next_minute(const void *prev, char *desc)
{
	const char *next = prev ? (const char *)prev + 1 : numbers;

	if (next >= numbers + min_t(u32, minutes, ARRAY_SIZE(numbers)))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "minute %u", (u32)(next - numbers) + 1);
	return next;
}

static void ring_soak(struct kunit *test)
{
	u32 minute = (const char *)test->param_value - numbers + 1, i;
	struct soak *s = &soak;

	if (!s->b)
		prepare(test);
	s->b->test = test;
	random_users_begin(&s->r);
	s->calm = false;
	for (i = 0; i < MINUTE / 100; i++) {
		cyc_run(&s->c, 100);
		if (!random_below(&s->r, 200))
			restart(s);
	}
	calm(s, true);
	random_users_end(&s->r);
	cyc_run(&s->c, 3000);
	expect_all_well(s, minute);
}

static void soak_exit(struct kunit_suite *suite)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		if (soak.r.s[i].slave)
			ec_slave_unref(soak.r.s[i].slave);
	bus_down(soak.b);
	memset(&soak, 0, sizeof(soak));
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(ring_soak, next_minute),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_soak", .exit = bus_exit, .suite_exit = soak_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
