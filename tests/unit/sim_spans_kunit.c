// SPDX-License-Identifier: GPL-2.0-only
/*
 * Logical datagrams find the slaves they concern in a sorted table (segment_spans.c): order
 * and working counters are those of a ring in which each slave looks at each datagram.
 */
#include "sim_esc_kunit.h"
#include "../../devices/sim/esc_int.h"

#define SLAVES	70u
#define SPAN	256u	/* logical bytes in use, at either end of the addresses */

/**
 * struct pair - two equal segments
 * @test: test
 * @a: uses the table
 * @b: every slave looks at every datagram
 * @rng: state of the sequence of random numbers
 */
struct pair {
	struct kunit *test;
	struct bed *a;
	struct bed *b;
	u64 rng;
};

static u32 rnd(struct pair *p, u32 n)
{
	p->rng = p->rng * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)(p->rng >> 33) % n;
}

/* one datagram through both; returns the working counter */
static int both(struct pair *p, u8 cmd, u32 at, void *data, u16 len)
{
	u8 *copy = p->b->frame + 1024;
	int wkc, slow;

	memcpy(copy, data, len);
	wkc = bed_tx(p->a, cmd, (u16)at, (u16)(at >> 16), data, len);
	slow = bed_tx(p->b, cmd, (u16)at, (u16)(at >> 16), copy, len);
	KUNIT_ASSERT_EQ_MSG(p->test, wkc, slow, "command %u at %#x, %u bytes", cmd, at, len);
	KUNIT_ASSERT_MEMEQ(p->test, data, copy, len);
	return wkc;
}

static u32 place(struct pair *p)
{
	return rnd(p, 4) ? rnd(p, SPAN) : ~0u - rnd(p, SPAN);
}

static void random_fmmu(struct pair *p)
{
	struct ec_fmmu f = {
		.logical = place(p), .len = (u16)rnd(p, rnd(p, 20) ? 4 : SPAN),
		.lbit_start = (u8)(rnd(p, 3) ? 0 : rnd(p, 8)),
		.lbit_stop = (u8)(rnd(p, 3) ? 7 : rnd(p, 8)),
		.phys = (u16)(0x1000 + rnd(p, 64)), .pbit = (u8)(rnd(p, 3) ? 0 : rnd(p, 8)),
		.type = (u8)rnd(p, 4), .enable = rnd(p, 5),
	};
	u8 page[EC_FMMU_PAGE];

	ec_fmmu_encode(&f, page);
	both(p, EC_CMD_FPWR, (1001 + rnd(p, SLAVES)) | (u32)EC_REG_FMMU(rnd(p, 8)) << 16, page,
	     sizeof(page));
}

static void random_fault(struct pair *p)
{
	struct ec_sim_fault f = {
		.slave = (int)rnd(p, SLAVES), .port = (int)rnd(p, 2),
		.type = rnd(p, 2) ? EC_SIM_FAULT_CUT : EC_SIM_FAULT_POWER_OFF,
	};

	KUNIT_ASSERT_EQ(p->test, ec_sim_add_fault(p->a->sim, &f), 0);
	KUNIT_ASSERT_EQ(p->test, ec_sim_add_fault(p->b->sim, &f), 0);
	if (rnd(p, 3))
		return;
	for (f.slave = 0; f.slave < (int)SLAVES; f.slave++)
		for (u32 i = 0; i < 3; i++) {
			f.type = i == 2 ? EC_SIM_FAULT_POWER_ON : EC_SIM_FAULT_HEAL;
			f.port = i & 1;
			ec_sim_add_fault(p->a->sim, &f);
			ec_sim_add_fault(p->b->sim, &f);
		}
	for (u16 i = 0; i < SLAVES; i++) {
		u8 v[2];

		put_unaligned_le16(1001 + i, v);
		both(p, EC_CMD_APWR, (u16)-i | (u32)EC_REG_STATION << 16, v, 2);
	}
}

static void sim_spans_table_changes_no_result(struct kunit *test)
{
	struct pair p = { .test = test, .a = bed_new(test, SLAVES, SLAVES), .rng = 3 };
	u8 data[SPAN];
	u32 i, k, at[20], answered = 0;
	u16 len[20];

	p.b = bed_new(test, SLAVES, SLAVES);
	ec_sim_set_slow(p.b->sim, true);
	for (i = 0; i < 20000; i++) {
		u32 d = rnd(&p, ARRAY_SIZE(at));

		if (!rnd(&p, 200))
			random_fault(&p);
		if (!rnd(&p, 4))
			random_fmmu(&p);
		/* most datagrams come again */
		if (i < ARRAY_SIZE(at) || !rnd(&p, 5)) {
			d = i < ARRAY_SIZE(at) ? i : d;
			at[d] = place(&p);
			len[d] = (u16)(1 + rnd(&p, rnd(&p, 4) ? 8 : SPAN));
		}
		for (k = 0; k < len[d]; k++)
			data[k] = (u8)rnd(&p, 256);
		answered += both(&p, (u8)(EC_CMD_LRD + rnd(&p, 3)), at[d], data, len[d]) > 0;
	}
	KUNIT_EXPECT_GT(test, answered, 10000u);
	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_MEMEQ(test, ec_sim_slave(p.a->sim, i)->mem,
				   ec_sim_slave(p.b->sim, i)->mem, ec_sim_slave(p.a->sim, i)->mem_len);
	ec_sim_free(p.a->sim);
}

/* it holds what is switched on, and nothing after the slaves had no power */
static void sim_spans_table_follows_registers(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);
	struct ec_fmmu f = {
		.logical = 0x1000, .len = 4, .lbit_stop = 7, .phys = 0x1000,
		.type = EC_FMMU_READ, .enable = true,
	};
	struct ec_sim_fault off = { .type = EC_SIM_FAULT_POWER_OFF, .port = 0 }, on = off;

	on.type = EC_SIM_FAULT_POWER_ON;
	for (u16 i = 0; i < 3; i++)
		for (int n = 0; n < 8; n++)
			bed_fmmu(b, (u16)(1001 + i), n, f);
	KUNIT_EXPECT_EQ(test, b->sim->spans, 24u);
	bed_fmmu(b, 1002, 3, f);
	KUNIT_EXPECT_EQ(test, b->sim->spans, 24u);
	f.logical = 0x2000;
	bed_fmmu(b, 1002, 3, f);
	KUNIT_EXPECT_EQ(test, b->sim->spans, 24u);
	KUNIT_EXPECT_EQ(test, b->sim->span[23].key, 0x200000000001ull);
	f.enable = false;
	bed_fmmu(b, 1002, 3, f);
	KUNIT_EXPECT_EQ(test, b->sim->spans, 23u);
	for (off.slave = 0; off.slave < 3; off.slave++) {
		on.slave = off.slave;
		ec_sim_add_fault(b->sim, &off);
		ec_sim_add_fault(b->sim, &on);
	}
	ec_sim_advance(b->sim, b->now);
	KUNIT_EXPECT_EQ(test, b->sim->spans, 0u);
}

/* the same datagram, the same number of slaves, but others */
static void sim_spans_table_follows_wiring(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 0);
	struct ec_fmmu f = {
		.logical = 0x1000, .len = 1, .lbit_stop = 7, .phys = 0x1000,
		.type = EC_FMMU_READ, .enable = true,
	};
	struct ec_sim_fault fault = { .slave = 0 };

	for (int i = 0; i < 3; i++) {
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, i ? 0 : -1, i, i, 0, 100), 0);
	}
	for (u16 i = 0; i < 3; i++)
		bed_station(b, (u16)-i, (u16)(1001 + i));
	bed_fmmu(b, 1003, 0, f);
	for (int i = 2; i > 0; i--) {
		u8 v = 0;

		/* behind port 2 is the one that maps, behind port 1 one that does not */
		fault.port = i;
		fault.type = EC_SIM_FAULT_CUT;
		ec_sim_add_fault(b->sim, &fault);
		KUNIT_EXPECT_EQ_MSG(test, bed_tx(b, EC_CMD_LRD, 0x1000, 0, &v, 1), i == 1,
				    "without port %d", i);
		fault.type = EC_SIM_FAULT_HEAL;
		ec_sim_add_fault(b->sim, &fault);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_spans_table_changes_no_result),
	KUNIT_CASE(sim_spans_table_follows_registers),
	KUNIT_CASE(sim_spans_table_follows_wiring),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_spans",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
