// SPDX-License-Identifier: GPL-2.0-only
/*
 * How many cycles a slave needs after its port was opened: a known one to OP, a new one to PREOP.
 * What it takes for itself is printed apart, and added to the limit of a known one: accesses to its
 * EEPROM, changes of state, mailbox replies. A port is open for the first time in a trial.
 */
#include "cyc.h"
#include "slow.h"
#include "devices/sim/esc_int.h"

#define BACK		200	/* cycles to OP */
#define BACK_SYNC	400	/* with SYNC0 */
#define NEW		60	/* cycles to PREOP, and one for each access to the EEPROM */
#define READS		10	/* accesses to the EEPROM of a known slave */
#define SPREAD		3	/* cycles by which figures of other cycle times differ */

/* x is behind port 1 of a, y has not been there */
static const char few[] =
	"segment seed=7 response=100us transition=1ms\n"
	"slave hub EK1100\nslave a drive in=8 out=8\nslave x drive in=8 out=8 serial=61\n"
	"branch none\nslave y drive in=8 out=8 serial=62\n";

static const char many[] =
	"segment seed=7 response=100us transition=1ms\n"
	"repeat 997 slave d EL1859 delay=500ns cable=0\n"
	"slave hub EK1100\nslave a drive in=8 out=8\nslave x drive in=8 out=8 serial=61\n"
	"branch none\nslave y drive in=8 out=8 serial=62\n";

/**
 * struct place - where the drives are
 * @text: segment
 * @n: slaves connected
 * @a: number of the drive before the port, in the segment and in the ring; x and y follow it
 */
struct place {
	const char *text;
	u32 n;
	u32 a;
};

static const struct place short_bus = { few, 3, 1 }, long_bus = { many, 1000, 998 };

static const u32 periods_us[] = { 1000, 4000, 10000 };

/**
 * struct way - of a slave
 * @p: place
 * @period_us: of the cycle
 * @bytes: of its EEPROM
 * @large: likewise, of y
 * @four: its controller reads 4 bytes in an access, else 8
 * @off: it has lost its power meanwhile
 * @sync: it has SYNC0
 * @remap: its mapping is written
 * @ring: the device has rings of descriptors, as a native one, and is polled by the cycle
 * @cycle_bytes: result: of the frame of the cycle, on the wire
 * @wire_ns: result: wire time of the frames beside the cycle
 * @own_ns: result: its own time
 */
struct way {
	const struct place *p;
	u32 period_us;
	u32 bytes;
	u32 large;
	bool four;
	bool off;
	bool sync;
	bool remap;
	bool ring;
	u64 cycle_bytes;
	u64 wire_ns;
	u64 own_ns;
};

static void configure(struct cyc *c, const struct way *w, u32 position)
{
	u32 config = cyc_config(c, position);

	if (w->remap)
		cyc_remap(c, config);
	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
}

/* Bytes of all frames on the wire, with preamble, FCS and gap */
static u64 on_wire(struct bus *b)
{
	return atomic64_read(&bus_link(b, 0)->stats.tx_bytes) + 24 * bus_frames(b);
}

static void enlarge(struct bus *b, u32 index, size_t len)
{
	struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	u8 *data = ec_sim_alloc(b->sim, len + 1);

	KUNIT_ASSERT_NOT_NULL(b->test, data);
	memset(data, 0xff, len);
	memcpy(data, e->data, e->len);
	ec_sim_release(b->sim, e->data);
	e->data = data;
	e->len = len;
	put_unaligned_le16(len / 128 - 1, data + 2 * EC_SII_W_SIZE);
	bus_fill_eeprom(b, index, len);
}

/* a and x in OP, then x is disconnected */
static struct cyc *without_x(struct kunit *test, struct way *w)
{
	struct bus *b = bus_new(test, w->p->text);
	struct cyc *c;
	u32 i;

	for (i = w->p->a; i < w->p->a + 3; i++) {
		bus_esc(b, i)->cfg.eeprom_8byte = !w->four;
		if (!w->large || i < w->p->a + 2)
			bus_fill_eeprom(b, i, w->bytes);
	}
	if (w->large)
		enlarge(b, w->p->a + 2, w->large);
	if (w->ring)
		slow_plug(b, 64, 1);
	else
		bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, w->p->n, EC_AL_PREOP, 20000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, w->period_us);
	cyc_domain(c);
	configure(c, w, w->p->a);
	configure(c, w, w->p->a + 1);
	if (w->sync)
		cyc_sync0(c, 2);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 60000), ~0ull);
	cyc_run(c, 1000);
	w->cycle_bytes = ~0ull;
	for (i = 0; i < 100; i++) {
		u64 before = on_wire(b);

		cyc_run(c, 1);
		w->cycle_bytes = min(w->cycle_bytes, on_wire(b) - before);
	}
	bus_command(b, "unplug a.1");
	cyc_run(c, 400);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), w->p->n - 1);
	return c;
}

static u64 us(u64 ns)
{
	return div_u64(ns, NSEC_PER_USEC);
}

/* In the list, in @state, and the application would be told so */
static bool arrived(struct bus *b, const struct way *w, u8 state)
{
	return bus_n_slaves(b) == w->p->n && !bus_scan_busy(b) &&
	       READ_ONCE(bus_slave(b, w->p->n - 1)->al.status) == state;
}

/* A cycle; of frames beside the cycle @wire_ns gets their length, and once the way of a frame. */
static void run_counted(struct cyc *c, struct way *w)
{
	struct bus *b = c->b;
	u64 before = on_wire(b), frames = bus_frames(b);

	cyc_run(c, 1);
	/* the cycle has one */
	if (bus_frames(b) - frames > 1)
		w->wire_ns += 80 * (on_wire(b) - before - w->cycle_bytes) +
			      b->sim->route[0].delay_ns;
}

/* Cycles from the first opening of the port until slave @index of the segment is in @state. */
static u32 cycles_to(struct cyc *c, struct way *w, u32 index, u8 state)
{
	struct bus *b = c->b;
	const struct ec_esc_own *own = &bus_esc(b, index)->own, before = *own;
	u32 i, trials = READ_ONCE(bus_table(b)->trials);
	u64 frames, began;

	for (i = 0; i < 2000 && READ_ONCE(bus_table(b)->trials) == trials; i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_LT(b->test, i, 2000u);
	began = c->cycles - 1;
	frames = bus_frames(b);
	w->wire_ns = 0;
	for (i = 0; i < 20000 && !arrived(b, w, state); i++)
		run_counted(c, w);
	KUNIT_ASSERT_LT(b->test, i, 20000u);
	w->own_ns = own->eeprom_ns - before.eeprom_ns + own->al_ns - before.al_ns +
		    own->mbox_ns - before.mbox_ns;
	bus_figure("cycle of %u us, bus of %u%s: %s %s%s%s%s in %s %llu cycles after its port was opened; %llu frames, on the wire %llu us; its own time: %u accesses to %u bytes of EEPROM %llu us, changes of state %llu us, mailbox replies %llu us",
		   w->period_us, w->p->n, w->ring ? " at a device with rings" : "",
		   state == EC_AL_OP ? "known" : "new",
		   w->four ? "4-byte slave" : "slave", w->off ? ", power off" : "",
		   w->sync ? ", SYNC0" : "", w->remap ? ", mapping written" : "",
		   state == EC_AL_OP ? "OP" : "PREOP", c->cycles - began, bus_frames(b) - frames,
		   us(w->wire_ns), own->reads - before.reads,
		   state == EC_AL_OP || !w->large ? w->bytes : w->large,
		   us(own->eeprom_ns - before.eeprom_ns), us(own->al_ns - before.al_ns),
		   us(own->mbox_ns - before.mbox_ns));
	if (state == EC_AL_OP)
		KUNIT_EXPECT_LE(b->test, own->reads - before.reads, READS);
	return c->cycles - began;
}

/* x comes back */
static u32 back(struct kunit *test, struct way *w)
{
	struct cyc *c = without_x(test, w);
	u32 cycles, limit = w->sync ? BACK_SYNC : BACK;

	if (w->off) {
		bus_command(c->b, "off x");
		cyc_run(c, 5);
		bus_command(c->b, "on x");
	}
	bus_command(c->b, "plug a.1 x.0");
	cycles = cycles_to(c, w, w->p->a + 1, EC_AL_OP);
	KUNIT_EXPECT_LE(test, cycles, limit + (u32)div_u64(w->own_ns + w->wire_ns, c->period_ns));
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2u);
	bus_exit(test);
	return cycles;
}

/* y comes instead */
static u32 arrives(struct kunit *test, struct way *w)
{
	struct cyc *c = without_x(test, w);
	u32 cycles;

	bus_command(c->b, "plug a.1 y.0");
	cycles = cycles_to(c, w, w->p->a + 2, EC_AL_PREOP);
	KUNIT_EXPECT_LE(test, cycles, (w->large ?: w->bytes) / (w->four ? 4 : 8) + NEW +
				      (u32)div_u64(w->wire_ns, c->period_ns));
	bus_exit(test);
	return cycles;
}

/* The same with each cycle time. */
static void at_each(struct kunit *test, struct way w, u32 (*figure)(struct kunit *, struct way *))
{
	u32 i, cycles, first = 0;

	for (i = 0; i < ARRAY_SIZE(periods_us); i++) {
		w.period_us = periods_us[i];
		cycles = figure(test, &w);
		first = first ?: cycles;
		/* what is a time, as that until the first SYNC0, is less cycles */
		KUNIT_EXPECT_LE(test, cycles, first + SPREAD);
		if (!w.sync)
			KUNIT_EXPECT_GE(test, cycles + SPREAD, first);
	}
}

static void return_known(struct kunit *test)
{
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024 }, back);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .off = true }, back);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 2048, .off = true, .four = true,
				    .remap = true }, back);
}

static void return_known_sync(struct kunit *test)
{
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .sync = true }, back);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .sync = true, .off = true,
				    .remap = true }, back);
}

static void return_new(struct kunit *test)
{
	struct way large = {
		.p = &short_bus, .bytes = 1024, .large = 16384, .period_us = 1000,
	};

	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024 }, arrives);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 2048 }, arrives);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .four = true }, arrives);
	/* what takes more than 2 s and 16 KiB, or 10 s, is read by several scans */
	arrives(test, &large);
}

/* The same at a device with rings of descriptors */
static void return_at_rings(struct kunit *test)
{
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .ring = true }, back);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .ring = true, .sync = true },
		back);
	at_each(test, (struct way){ .p = &short_bus, .bytes = 1024, .ring = true }, arrives);
}

/* In a bus of 1,000 slaves the same, and the wire time */
static void return_of_1000(struct kunit *test)
{
	struct way w = { .p = &long_bus, .bytes = 1024 };
	u32 i;

	for (i = 0; i < 2; i++) {
		w.period_us = periods_us[i];
		back(test, &w);
		arrives(test, &w);
	}
	w.period_us = periods_us[0];
	w.sync = true;
	back(test, &w);
}

/* x returns, and has the image that its EEPROM has now. Returns accesses to it. */
static u32 reread(struct cyc *c, const struct way *w, const char *fault, u32 noack)
{
	const struct ec_esc *x = bus_esc(c->b, w->p->a + 1), *a = bus_esc(c->b, w->p->a);
	u32 i, reads = x->own.reads;
	struct ec_slave *s;

	bus_command(c->b, "plug a.1 x.0");
	for (i = 0; i < 1000 && (a->mem[EC_REG_DL_LOOPS] >> 2 & 3) != EC_LOOP_AUTO_CLOSE; i++)
		cyc_run(c, 1);
	if (fault)
		bus_command(c->b, fault);
	bus_esc(c->b, x->index)->fault.eeprom_noack = noack;
	for (i = 0; i < 10000 && !arrived(c->b, w, EC_AL_OP); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_LT_MSG(c->b->test, i, 10000u, "%s", fault);
	s = bus_slave(c->b, w->p->n - 1);
	KUNIT_EXPECT_EQ_MSG(c->b->test, s->eeprom.bytes, w->bytes, "%s", fault);
	KUNIT_EXPECT_EQ_MSG(c->b->test, memcmp(s->eeprom.data, x->eep.data, w->bytes), 0, "%s",
			    fault);
	bus_command(c->b, "unplug a.1");
	cyc_run(c, 400);
	KUNIT_ASSERT_EQ(c->b->test, bus_n_slaves(c->b), w->p->n - 1);
	/* as after a rest: losses of the try before do not count */
	memset(bus_slave(c->b, w->p->a)->ports.loss, 0, sizeof(s->ports.loss));
	return x->own.reads - reads;
}

/* The image that is kept is taken only if the size, and the last access, are the same. */
static void return_compares(struct kunit *test)
{
	static const struct {
		u16 word;
		bool head;
	} changes[] = { { 0x3e }, { 1024 / 2 - 3 }, { 4, true }, { 0x0e, true } };
	u32 i, four;

	for (four = 0; four < 2; four++) {
		struct way w = {
			.p = &short_bus, .period_us = 1000, .bytes = 1024, .four = four,
		};
		struct cyc *c = without_x(test, &w);
		u8 *data = bus_esc(c->b, w.p->a + 1)->eep.data;

		for (i = 0; i < ARRAY_SIZE(changes); i++) {
			u8 *p = data + 2 * changes[i].word;

			KUNIT_EXPECT_LE(test, reread(c, &w, NULL, 0), (u32)READS);
			*p += 0x10;
			if (changes[i].head)
				data[14] = ec_esc_eeprom_crc(data);
			KUNIT_EXPECT_GE_MSG(test, reread(c, &w, NULL, 0), w.bytes / (four ? 4 : 8),
					    "word 0x%04x", changes[i].word);
		}
		bus_exit(test);
	}
}

/* Frames are lost, or the EEPROM is slow or refuses, while it is read beside the cycle. */
static void return_eeprom_faults(struct kunit *test)
{
	static const char * const faults[] = { "lose frame=%u", "lose frame=%u when=out" };
	static const u32 busy_us[] = { 900, 2500, 15000 };
	struct way w = { .p = &short_bus, .period_us = 1000, .bytes = 1024 };
	struct cyc *c = without_x(test, &w);
	struct ec_esc *x = bus_esc(c->b, w.p->a + 1);
	u8 *last = x->eep.data + w.bytes - 6;
	u32 i, n;
	char text[32];

	for (i = 0; i < ARRAY_SIZE(faults); i++)
		for (n = 40; n < 340; n += 7) {
			*last += 1;
			snprintf(text, sizeof(text), faults[i], n);
			reread(c, &w, text, 0);
		}
	for (i = 0; i < ARRAY_SIZE(busy_us); i++) {
		*last += 1;
		x->cfg.eeprom_busy_ns = busy_us[i] * NSEC_PER_USEC;
		reread(c, &w, NULL, 0);
	}
	*last += 1;
	reread(c, &w, NULL, 2);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(return_known),
	KUNIT_CASE(return_known_sync),
	KUNIT_CASE(return_new),
	KUNIT_CASE(return_at_rings),
	KUNIT_CASE(return_of_1000),
	KUNIT_CASE(return_compares),
	KUNIT_CASE(return_eeprom_faults),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_return", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
