// SPDX-License-Identifier: GPL-2.0-only
#include "ring_clocks.h"

#define TEXT	4096

u64 clock_of(const struct clocks *k, u32 i, u64 now)
{
	return ec_esc_system_time(bus_esc(k->b, i), now);
}

/* The time that the reference clock has, or would have. */
static u64 line(const struct clocks *k, u64 now)
{
	u64 since = now - k->then_ns;

	if (!k->lost)
		return clock_of(k, k->ref, now);
	return k->then + since + div_s64((s64)since * k->ppb, NSEC_PER_SEC);
}

/* How far the running clocks are from that line, the worst of them, ns. */
static s64 apart(struct clocks *k)
{
	u64 now = ktime_get_ns(), is;
	s64 most = 0, off;
	u32 i;

	ec_sim_advance(k->b->sim, now);
	is = line(k, now);
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

static void clocks_look(struct cyc *c)
{
	struct clocks *k = c->ctx;
	bool open = bus_links(k->b)->ring.state == EC_RING_OPEN;

	k->most = max(k->most, apart(k));
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
	if (!k->kernel)
		cyc_run(k->c, cycles);
	else
		while (cycles--) {
			usleep_range(1000, 1001);
			clocks_look(k->c);
		}
	return k->most;
}

/* @back_ns: cable to the backup device; that of the main device has 50 m */
struct bus *clocks_bus_of(struct kunit *test, u32 back_ns, struct kinds kinds)
{
	char *text = kunit_kzalloc(test, TEXT, GFP_KERNEL);
	struct rnd_state rnd;
	int len, i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	prandom_seed_state(&rnd, 5);
	len = scnprintf(text, TEXT, "segment seed=8 response=100us transition=1ms\n");
	for (i = 1; i <= SLAVES; i++)
		len += scnprintf(text + len, TEXT - len,
				 "slave d%u drive in=8 out=8 cable=50 drift=%dppb clock=%ums%s\n",
				 i, (int)(prandom_u32_state(&rnd) % 200001) - 100000 - 50000,
				 prandom_u32_state(&rnd),
				 kinds.none & BIT(i - 1) ? " dc=none" :
				 kinds.narrow & BIT(i - 1) ? " dc=32" : "");
	scnprintf(text + len, TEXT - len, "wire d8.1 -> master.1 cable=%uns\n", back_ns);
	return bus_new(test, text);
}

struct bus *clocks_bus(struct kunit *test)
{
	return clocks_bus_of(test, 250, (struct kinds){ 0 });
}

static void clocks_sync0(struct clocks *k)
{
	u32 i;

	for (i = 0; i < SLAVES; i++) {
		struct ec_ioc_sc_dc dc = {
			.config = i, .assign_activate = 0x0300, .cycle0 = NSEC_PER_MSEC,
		};

		if (!(k->none & BIT(i)))
			KUNIT_ASSERT_EQ(k->b->test, ec_ioc(&k->b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

/* An application at the ring; @ref is the reference clock. All slaves are in OP then. */
void clocks_activate(struct clocks *k, u32 ref)
{
	struct ec_ioc_cycle cycle = {
		.period_ns = NSEC_PER_MSEC, .phase_ns = 300000, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_CYCLE_DC_FOLLOW,
	};
	struct bus *b = k->b;
	u32 ms;

	k->ref = ref;
	bus_idle(b);
	k->c = cyc_new(b, 1000);
	cyc_domain(k->c);
	cyc_map_all(k->c, 0, SLAVES, 0);
	clocks_sync0(k);
	if (ref) {
		struct ec_ioc_ref_clock r = { .config = ref };

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &r), 0);
	}
	k->c->ctx = k;
	k->c->each = clocks_look;
	if (k->kernel)
		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cycle), 0);
	cyc_activate(k->c);
	for (ms = 0; ms < 20000 && !cyc_all_op(k->c); ms++)
		clocks_run(k, 1);
	KUNIT_ASSERT_TRUE(b->test, cyc_all_op(k->c));
	cyc_shake(k->c, LATE_NS, 1000);
	clocks_run(k, 5000);
}

struct clocks *clocks_new(struct bus *b)
{
	struct clocks *k = kunit_kzalloc(b->test, sizeof(*k), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, k);
	k->b = b;
	return k;
}

struct clocks *clocks_start(struct bus *b, u32 ref)
{
	struct clocks *k = clocks_new(b);

	bus_plug_scanned(b, SLAVES, 5000);
	clocks_activate(k, ref);
	return k;
}

void clocks_power(struct clocks *k, u32 i, bool on)
{
	char text[16];

	snprintf(text, sizeof(text), "%s d%u", on ? "on" : "off", i + 1);
	bus_command(k->b, text);
}
