// SPDX-License-Identifier: GPL-2.0-only
#include "ring_clocks.h"

#define TEXT	4096
#define STEP_NS	(100 * NSEC_PER_MSEC)	/* between changes of the rate of the host's clock */
#define STEP_PPB	50	/* each of them, at most */

static unsigned int seed = 5;
module_param(seed, uint, 0444);
MODULE_PARM_DESC(seed, "Seed of the clocks, and of what changes them");

u64 clock_of(const struct clocks *k, u32 i, u64 now)
{
	return ec_esc_system_time(bus_esc(k->b, i), now);
}

/* How far the clock of the computer is ahead of what it was at first, 1e-9 ns. */
static s64 ahead(const struct clocks *k, u64 now)
{
	return k->wandered + (s64)(now - k->wander_ns) * k->wander_ppb;
}

/* The clock of a slave gets another rate, from now on. */
static void change_rate(struct ec_esc *esc, s32 ppb, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	s64 part = dc->base_frac - (s64)(now - dc->base_ns) * ppb;

	esc->cfg.drift_ppb += ppb;
	dc->base_local += div_s64(part, NSEC_PER_SEC);
	dc->base_frac = part - div_s64(part, NSEC_PER_SEC) * NSEC_PER_SEC;
}

/* The computer's clock changes its rate: to it, all others do. */
static void wander(struct clocks *k, u64 now)
{
	s32 was = k->wander_ppb, step;
	u32 i;

	if (k->still || now - k->wander_ns < STEP_NS)
		return;
	k->wandered = ahead(k, now);
	k->wander_ns = now;
	step = (s32)(prandom_u32_state(&k->random) % (2 * STEP_PPB + 1)) - STEP_PPB;
	k->wander_ppb = clamp(was + step, -WANDER_PPB, WANDER_PPB);
	for (i = 0; i < SLAVES; i++)
		change_rate(bus_esc(k->b, i), was - k->wander_ppb, now);
}

/* The time that the reference clock has, or would have. */
u64 clocks_line(const struct clocks *k, u64 now)
{
	s64 since = now - k->then_ns;

	if (!k->lost)
		return clock_of(k, k->ref, now);
	return k->then + since +
	       div_s64(since * k->ppb - (ahead(k, now) - k->then_ahead), NSEC_PER_SEC);
}

/* How far the running clocks are from that line, the worst of them, ns. */
static s64 apart(struct clocks *k)
{
	u64 now = ktime_get_ns(), is;
	s64 most = 0, off;
	u32 i;

	ec_sim_advance(k->b->sim, now);
	wander(k, now);
	is = clocks_line(k, now);
	for (i = 0; i < SLAVES; i++) {
		if ((k->absent | k->none) & BIT(i))
			continue;
		/* some have 32 bits */
		off = (s32)((u32)clock_of(k, i, now) - (u32)is);
		most = max_t(s64, most, abs(off));
		k->jump = max_t(s64, k->jump, abs(off - k->was[i]));
		k->was[i] = off;
	}
	return most;
}

/* Those in OP, and how often one left it that has a path. */
static void look_at_states(struct clocks *k)
{
	u32 i, op = 0;

	for (i = 0; i < SLAVES; i++)
		if (bus_esc(k->b, i)->mem[EC_REG_AL_STATUS] == EC_AL_OP)
			op |= BIT(i);
	k->left += hweight32(k->op & ~op & ~k->absent);
	k->op = op;
}

static void clocks_look(struct cyc *c)
{
	struct clocks *k = c->ctx;
	bool open = bus_links(k->b)->ring.state == EC_RING_OPEN;

	k->most = max(k->most, apart(k));
	k->unlocked += k->kernel && bus_status(k->b)->kernel.lock != EC_CYCLE_LOCK_LOCKED;
	look_at_states(k);
	k->opened += open && !k->open;
	k->open = open;
	k->empty += !k->kernel && !cyc_state(c, 0)->working_counter;
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR;
	if (!k->leads)
		return;
	c->flags |= EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_REF_TIME;
	c->app_time = ktime_to_ns(c->next);
	c->sync_time = c->app_time;
}

/* Cycles; the largest difference in them, ns. */
s64 clocks_run(struct clocks *k, u32 cycles)
{
	k->most = 0;
	k->jump = 0;
	k->unlocked = 0;
	if (!k->kernel)
		cyc_run(k->c, cycles);
	else
		while (cycles--) {
			usleep_range(1000, 1001);
			clocks_look(k->c);
		}
	return k->most;
}

/* @back_ns: cable to the backup device, 0: a line; that of the main device has 50 m */
struct bus *clocks_bus_of(struct kunit *test, u32 back_ns, struct kinds kinds)
{
	char *text = kunit_kzalloc(test, TEXT, GFP_KERNEL);
	struct rnd_state rnd;
	int len, i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	prandom_seed_state(&rnd, seed);
	len = scnprintf(text, TEXT, "segment seed=8 response=100us transition=1ms\n");
	for (i = 1; i <= SLAVES; i++)
		len += scnprintf(text + len, TEXT - len,
				 "slave d%u drive in=8 out=8 cable=50 drift=%dppb clock=%ums%s%s\n",
				 i, (int)(prandom_u32_state(&rnd) % 200001) - 100000 - HOST_PPB,
				 prandom_u32_state(&rnd),
				 kinds.none & BIT(i - 1) ? " dc=none" :
				 kinds.narrow & BIT(i - 1) ? " dc=32" : "",
				 kinds.deaf & BIT(i - 1) ? " frmw=no" : "");
	if (back_ns)
		scnprintf(text + len, TEXT - len, "wire d8.1 -> master.1 cable=%uns\n", back_ns);
	return bus_new(test, text);
}

struct bus *clocks_bus(struct kunit *test)
{
	return clocks_bus_of(test, 250, (struct kinds){ 0 });
}

/* Without a backup device. */
struct bus *clocks_bus_line(struct kunit *test)
{
	return clocks_bus_of(test, 0, (struct kinds){ 0 });
}

static void clocks_sync0(struct clocks *k, u32 n)
{
	u32 i;

	for (i = 0; i < n; i++) {
		struct ec_ioc_sc_dc dc = {
			.config = i, .assign_activate = 0x0300, .cycle0 = NSEC_PER_MSEC,
		};

		if (!(k->none & BIT(i)))
			KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

/* Slaves that ignore FRMW are marked. */
static void clocks_flag(struct clocks *k)
{
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		struct ec_ioc_sc_flag f = { .config = i, .key = EC_FLAG_NO_FRMW, .value = 1 };

		if (k->deaf & BIT(i))
			KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_SC_FLAG, &f), 0);
	}
}

/* An application at the first @n slaves of the ring; @ref is the reference clock. */
void clocks_configure(struct clocks *k, u32 ref, u32 n)
{
	struct ec_ioc_cycle cycle = {
		.period_ns = NSEC_PER_MSEC, .phase_ns = 300000, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_CYCLE_DC_FOLLOW,
	};
	struct bus *b = k->b;

	k->ref = ref;
	bus_idle(b);
	k->c = cyc_new(b, 1000);
	cyc_domain(k->c);
	if (k->map)
		k->map(k);
	else
		cyc_map_all(k->c, 0, n, 0);
	clocks_sync0(k, n);
	clocks_flag(k);
	if (ref) {
		struct ec_ioc_ref_clock r = { .config = ref };

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &r), 0);
	}
	k->c->ctx = k;
	k->c->each = clocks_look;
	if (k->kernel)
		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cycle), 0);
	k->configured = n;
}

/* All slaves that are there and configured in OP? */
static bool in_op(const struct clocks *k)
{
	u32 wanted = (BIT(k->configured) - 1) & ~k->absent;

	return (k->op & wanted) == wanted && (k->absent || cyc_all_op(k->c));
}

/* All slaves that are there are in OP then. */
void clocks_begin(struct clocks *k)
{
	u32 ms;

	cyc_activate(k->c);
	for (ms = 0; ms < 20000 && !in_op(k); ms++)
		clocks_run(k, 1);
	KUNIT_ASSERT_TRUE(k->b->test, in_op(k));
	cyc_shake(k->c, LATE_NS, 1000);
	k->c->jitter.late_ns = LATE_NS + VERY_LATE_NS;
	k->left = 0;
	clocks_run(k, 5000);
}

/* An application at the ring; @ref is the reference clock. All slaves are in OP then. */
void clocks_activate(struct clocks *k, u32 ref)
{
	clocks_configure(k, ref, SLAVES);
	clocks_begin(k);
}

struct clocks *clocks_new(struct bus *b)
{
	struct clocks *k = kunit_kzalloc(b->test, sizeof(*k), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, k);
	k->b = b;
	k->wander_ns = ktime_get_ns();
	prandom_seed_state(&k->random, seed);
	return k;
}

struct clocks *clocks_start(struct bus *b, u32 ref)
{
	struct clocks *k = clocks_new(b);

	bus_plug_scanned(b, SLAVES, 5000);
	clocks_activate(k, ref);
	return k;
}

/* The line of the reference clock from now on, which nothing compares. */
void clocks_note_line(struct clocks *k)
{
	const struct ec_esc *esc = bus_esc(k->b, k->ref);

	clocks_run(k, 1);
	k->then_ns = ktime_get_ns();
	ec_sim_advance(k->b->sim, k->then_ns);
	k->then = clock_of(k, k->ref, k->then_ns);
	k->then_ahead = ahead(k, k->then_ns);
	k->ppb = esc->cfg.drift_ppb + (esc->dc.adj_ppb16 >> 16) + k->wander_ppb;
	k->lost = true;
	clocks_run(k, 500);
	KUNIT_EXPECT_LE(k->b->test, abs(k->was[k->ref]), 2);
}

/* Which slave is the reference clock. */
u32 clocks_ref(struct clocks *k)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		if (!(k->absent & BIT(i)) &&
		    get_unaligned_le16(bus_esc(k->b, i)->mem + EC_REG_STATION) ==
		    bus_dc_ref_station(k->b))
			return i;
	KUNIT_FAIL(k->b->test, "no reference clock");
	return 0;
}

/* Each clock that runs has SYNC0, and at the same times of it. */
void clocks_on_grid(struct clocks *k)
{
	const struct ec_esc *ref = bus_esc(k->b, k->ref);
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		const struct ec_esc *esc = bus_esc(k->b, i);
		u64 off;

		if ((k->absent | k->none) & BIT(i))
			continue;
		KUNIT_EXPECT_TRUE_MSG(k->b->test, esc->dc.running, "slave %u", i);
		off = esc->dc.start - ref->dc.start;
		/* those of 32 bits count from another time */
		if (esc->cfg.features & ref->cfg.features & EC_FEAT_DC64)
			KUNIT_EXPECT_EQ_MSG(k->b->test, (u32)((s64)off % (s64)NSEC_PER_MSEC), 0u,
					    "slave %u", i);
	}
}

void clocks_power(struct clocks *k, u32 i, bool on)
{
	char text[16];

	snprintf(text, sizeof(text), "%s d%u", on ? "on" : "off", i + 1);
	bus_command(k->b, text);
}
