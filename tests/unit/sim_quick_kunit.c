// SPDX-License-Identifier: GPL-2.0-only
/* The short ways of cyclic frames (esc_quick.c) give what the long ways give. */
#include "sim_app_kunit.h"

#define LOGICAL		0x10000u
#define SPAN		64u	/* logical bytes in use */
#define MS		1000000ull
#define SLAVES		11

static const char segment[] =
	"segment seed=7\n"
	"slave o1 io out=8 in=0\n"
	"slave o2 io out=8 in=0\n"
	"slave i1 io out=0 in=8\n"
	"slave i2 io out=0 in=8\n"
	"slave i3 io out=0 in=8 dc=delay\n"
	"slave b io out=16 in=12\n"
	"slave q EL2008\n"
	"slave c io out=8 in=8 cpu=yes\n"
	"slave d1 drive in=8 out=8 drift=20ppm\n"
	"slave d2 drive in=12 out=12 drift=-9ppm dc=32\n"
	"slave o3 io out=8 in=0 dc=none\n"
	"connect o1.1 -> i2.1\n"
	"connect b.3 -> i1.2\n"
	"ramp i3.1 amplitude=2 period=7ms\n";

/* process data of the slaves: bytes, and places of the SyncManagers */
static const struct {
	u8 sm;			/* of the outputs, or the only one */
	u8 out, in;
	u16 out_at, in_at;
} layout[SLAVES] = {
	{ 0, 1, 0, 0x1000, 0 }, { 0, 1, 0, 0x1000, 0 }, { 0, 0, 1, 0, 0x1000 },
	{ 0, 0, 1, 0, 0x1000 }, { 0, 0, 1, 0, 0x1000 }, { 0, 2, 2, 0x1000, 0x1008 },
	{ 0, 1, 0, 0x0F00, 0 }, { 0, 1, 1, 0x1000, 0x1004 },
	{ 2, 8, 8, 0x1200, 0x1218 }, { 2, 12, 12, 0x1200, 0x1224 },
	{ 0, 1, 0, 0x1000, 0 },
};

/**
 * struct twin - two equal segments
 * @test: test
 * @b: the one with short ways
 * @slow: the one without
 * @frame: what @slow gets
 * @f: frame being built, in @b
 * @rng: state of the sequence of random numbers
 */
struct twin {
	struct kunit *test;
	struct bed *b;
	struct ec_sim *slow;
	u8 frame[1600];
	struct ec_frame_buf f;
	u64 rng;
};

static u32 rnd(struct twin *t, u32 n)
{
	t->rng = t->rng * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)(t->rng >> 33) % n;
}

static void begin(struct twin *t)
{
	ec_frame_begin(&t->f, t->b->frame, sizeof(t->b->frame));
}

static u8 *add(struct twin *t, u8 cmd, u16 adp, u16 ado, u16 len)
{
	u8 *p = ec_frame_add(&t->f, cmd, 1, adp, ado, len);

	memset(p, 0, len);
	return p;
}

/* both segments get the same frame and give the same answer */
static void send(struct twin *t)
{
	struct bed *b = t->b;
	size_t n = ec_frame_end(&t->f);
	struct ec_sim_result ra, rb;

	memcpy(t->frame, b->frame, n);
	ec_sim_frame_result(b->sim, 0, b->frame, n, b->now, &ra);
	ec_sim_frame_result(t->slow, 0, t->frame, n, b->now, &rb);
	b->now += b->gap;
	KUNIT_ASSERT_EQ(t->test, ra.delay_ns, rb.delay_ns);
	KUNIT_ASSERT_MEMEQ(t->test, b->frame, t->frame, n);
}

static void put(struct twin *t, u16 station, u16 ado, const void *data, u16 len)
{
	begin(t);
	memcpy(add(t, EC_CMD_FPWR, station, ado, len), data, len);
	send(t);
}

static void al(struct twin *t, u16 station, u8 state)
{
	u8 v[2] = { state, 0 };

	put(t, station, EC_REG_AL_CONTROL, v, 2);
	t->b->now += 2 * MS;
}

static void sm(struct twin *t, int i, int n, u16 start, u16 len, u8 control)
{
	struct ec_sm s = { .start = start, .len = len, .control = control, .activate = 1 };
	u8 page[EC_SM_PAGE];

	ec_sm_encode(&s, page);
	put(t, STATION(i), (u16)EC_REG_SM(n), page, sizeof(page));
}

static void fmmu(struct twin *t, int i, int n, u32 logical, u16 len, u16 phys, u8 type)
{
	struct ec_fmmu f = {
		.logical = logical, .len = len, .lbit_stop = 7, .phys = phys,
		.type = type, .enable = true,
	};
	u8 page[EC_FMMU_PAGE];

	ec_fmmu_encode(&f, page);
	put(t, STATION(i), (u16)EC_REG_FMMU(n), page, sizeof(page));
}

static void configure(struct twin *t, int i, u32 *logical)
{
	int n = layout[i].sm;

	if (n) {
		sm(t, i, 0, 0x1000, 256, 0x26);
		sm(t, i, 1, 0x1100, 256, 0x22);
	}
	if (layout[i].out) {
		sm(t, i, n, layout[i].out_at, layout[i].out, n ? 0x64 : 0x44);
		fmmu(t, i, 0, *logical, layout[i].out, layout[i].out_at, EC_FMMU_WRITE);
		n++;
	}
	if (layout[i].in) {
		sm(t, i, n, layout[i].in_at, layout[i].in, 0x20);
		/* overlapped in every second slave */
		if (i & 1)
			*logical += layout[i].out;
		fmmu(t, i, 1, *logical, layout[i].in, layout[i].in_at, EC_FMMU_READ);
	}
	*logical += max(layout[i].out, layout[i].in);
}

static u8 *logical(struct twin *t, u8 cmd, u32 at, u16 len)
{
	u8 *p = add(t, cmd, (u16)at, (u16)(at >> 16), len);

	for (u32 i = 0; i < len; i++)
		p[i] = (u8)(rnd(t, 3) ? 0x0F : rnd(t, 256));
	return p;
}

static void operate(struct twin *t, int i)
{
	al(t, STATION(i), EC_AL_PREOP);
	al(t, STATION(i), EC_AL_SAFEOP);
	begin(t);
	logical(t, EC_CMD_LRW, LOGICAL, SPAN);
	send(t);
	al(t, STATION(i), EC_AL_OP);
}

static struct twin *twin_new(struct kunit *test)
{
	struct twin *t = kunit_kzalloc(test, sizeof(*t), GFP_KERNEL);
	struct ec_sim_error err;
	u32 at = LOGICAL;

	KUNIT_ASSERT_NOT_NULL(test, t);
	t->test = test;
	t->rng = 5;
	test->priv = t;
	t->b = kunit_kzalloc(test, sizeof(*t->b), GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, t->b);
	t->b->now = MS;
	t->b->gap = 20000;
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&t->b->sim, &bed_ops, segment,
					      strlen(segment), NULL, &err), 0);
	KUNIT_ASSERT_EQ(test, ec_sim_describe(&t->slow, &bed_ops, segment,
					      strlen(segment), NULL, &err), 0);
	ec_sim_set_slow(t->slow, true);
	for (int i = 0; i < SLAVES; i++) {
		u8 v[2];

		put_unaligned_le16(STATION(i), v);
		begin(t);
		memcpy(add(t, EC_CMD_APWR, (u16)-i, EC_REG_STATION, 2), v, 2);
		send(t);
	}
	for (int i = 0; i < SLAVES; i++)
		configure(t, i, &at);
	KUNIT_ASSERT_LE(test, at, LOGICAL + SPAN);
	for (int i = 0; i < SLAVES; i++)
		operate(t, i);
	for (int i = 0; i < SLAVES; i++)
		KUNIT_ASSERT_EQ(test, ec_app_state(ec_app_of(ec_sim_slave(t->b->sim, (u32)i))),
				EC_AL_OP);
	return t;
}

/* whatever one can see of the two without a frame */
static void compare(struct twin *t)
{
	for (u32 i = 0; i < SLAVES; i++) {
		struct ec_esc *a = ec_sim_slave(t->b->sim, i);
		struct ec_esc *s = ec_sim_slave(t->slow, i);
		struct ec_app *x = ec_app_of(a), *y = ec_app_of(s);

		KUNIT_ASSERT_MEMEQ(t->test, a->mem, s->mem, a->mem_len);
		KUNIT_ASSERT_MEMEQ(t->test, (u8 *)a->sm, (u8 *)s->sm, sizeof(a->sm));
		KUNIT_ASSERT_MEMEQ(t->test, x->data, y->data, x->model->data_len);
		KUNIT_ASSERT_MEMEQ(t->test, (u8 *)&a->dc, (u8 *)&s->dc, sizeof(a->dc));
		KUNIT_ASSERT_EQ(t->test, a->al_event, s->al_event);
		KUNIT_ASSERT_EQ(t->test, a->ecat_event, s->ecat_event);
		KUNIT_ASSERT_EQ(t->test, a->wd_due, s->wd_due);
		KUNIT_ASSERT_EQ(t->test, ec_app_state(x), ec_app_state(y));
	}
}

static void cyclic(struct twin *t)
{
	static const u8 cmds[] = { EC_CMD_LRW, EC_CMD_LRW, EC_CMD_LRD, EC_CMD_LWR };
	u32 at = rnd(t, 6) ? 0 : rnd(t, SPAN);

	logical(t, cmds[rnd(t, ARRAY_SIZE(cmds))], LOGICAL + at,
		(u16)(at ? 1 + rnd(t, SPAN - at) : SPAN));
}

static void registers(struct twin *t)
{
	static const u16 ados[] = {
		0x000, 0x110, 0x130, 0x134, 0x210, 0x220, 0x300, 0x440, 0x800,
		0x810, 0x910, 0x92c, 0x981, 0xf00, 0x1000, 0x1200, 0x1218,
	};
	u16 ado = ados[rnd(t, ARRAY_SIZE(ados))], len = (u16)(1 + rnd(t, 16));
	u8 *p;

	switch (rnd(t, 4)) {
	case 0:
		add(t, EC_CMD_BRD, (u16)rnd(t, 3), ado, len);
		break;
	case 1:
		p = add(t, EC_CMD_FRMW, STATION(rnd(t, 3) ? 8 : 0), EC_REG_DC_SYSTIME,
			rnd(t, 2) ? 8 : 4);
		p[0] = (u8)rnd(t, 256);
		break;
	case 2:
		add(t, EC_CMD_APRD, (u16)-rnd(t, SLAVES), ado, len);
		break;
	default:
		add(t, EC_CMD_FPRD, STATION(rnd(t, SLAVES)), ado, len);
	}
}

static void both_fault(struct twin *t, enum ec_sim_fault_type type, int slave, u32 arg)
{
	struct ec_sim_fault f = {
		.at_ns = t->b->now + 20000, .type = type, .slave = slave, .port = 1, .arg = arg,
	};

	t->b->now += 40000;	/* no frame is on its way */

	KUNIT_ASSERT_EQ(t->test, ec_sim_add_fault(t->b->sim, &f), 0);
	KUNIT_ASSERT_EQ(t->test, ec_sim_add_fault(t->slow, &f), 0);
}

/* something that does not happen in every cycle */
static void event(struct twin *t)
{
	static const enum ec_sim_fault_type types[] = {
		EC_SIM_FAULT_DEAD, EC_SIM_FAULT_MISS_BROADCAST, EC_SIM_FAULT_MUTE,
		EC_SIM_FAULT_WKC, EC_SIM_FAULT_REFUSE_AL,
	};
	static const u8 states[] = { EC_AL_INIT, EC_AL_PREOP, EC_AL_SAFEOP, EC_AL_OP };
	int i = (int)rnd(t, SLAVES);
	u8 v[2] = { 0 };

	switch (rnd(t, 8)) {
	case 0:
	case 1:
		both_fault(t, types[rnd(t, ARRAY_SIZE(types))], i, rnd(t, 2));
		break;
	case 2:
		t->b->now += rnd(t, 300) * MS;
		break;
	case 3:
		v[0] = states[rnd(t, 4)] | (rnd(t, 2) ? 0x10 : 0);
		put(t, STATION(i), EC_REG_AL_CONTROL, v, 2);
		break;
	case 4:
		v[0] = (u8)rnd(t, 2);
		put(t, STATION(i), EC_REG_SM(layout[i].sm) + EC_SM_OFS_ACTIVATE, v, 1);
		break;
	case 5:
		v[0] = (u8)rnd(t, 2);
		put(t, STATION(i), rnd(t, 2) ? EC_REG_ESC_WRITE_PROTECT : EC_REG_WD_SM, v, 1);
		break;
	case 6:
		both_fault(t, EC_SIM_FAULT_POWER_OFF, i, 0);
		begin(t);
		cyclic(t);
		send(t);
		both_fault(t, EC_SIM_FAULT_POWER_ON, i, 0);
		break;
	default:
		both_fault(t, rnd(t, 2) ? EC_SIM_FAULT_CUT : EC_SIM_FAULT_HEAL, i, 0);
	}
}

/* all as in the beginning */
static void repair(struct twin *t)
{
	u32 at = LOGICAL;
	u8 v[2] = { 0 };

	for (int i = 0; i < SLAVES - 1; i++)
		both_fault(t, EC_SIM_FAULT_HEAL, i, 0);
	ec_sim_advance(t->b->sim, t->b->now);
	ec_sim_advance(t->slow, t->b->now);
	ec_sim_clear_faults(t->b->sim);
	ec_sim_clear_faults(t->slow);
	for (int i = 0; i < SLAVES; i++) {
		put_unaligned_le16(STATION(i), v);
		begin(t);
		add(t, EC_CMD_APWR, (u16)-i, EC_REG_ESC_WRITE_ENABLE, 1);
		add(t, EC_CMD_APWR, (u16)-i, EC_REG_ESC_WRITE_PROTECT, 1);
		memcpy(add(t, EC_CMD_APWR, (u16)-i, EC_REG_STATION, 2), v, 2);
		send(t);
		put_unaligned_le16(1000, v);
		put(t, STATION(i), EC_REG_WD_SM, v, 2);
		al(t, STATION(i), EC_AL_INIT | EC_AL_ERROR);
		for (int n = 0; n < 4; n++) {
			v[0] = 0;
			put(t, STATION(i), (u16)(EC_REG_SM(n) + EC_SM_OFS_ACTIVATE), v, 1);
		}
		configure(t, i, &at);
	}
	for (int i = 0; i < SLAVES; i++)
		operate(t, i);
}

static void sim_quick_quiet_cycles(struct kunit *test)
{
	struct twin *t = twin_new(test);

	for (u32 i = 0; i < 300; i++) {
		begin(t);
		logical(t, EC_CMD_LRW, LOGICAL, SPAN);
		send(t);
		t->b->now += MS;
		if (i % 16 == 15)
			compare(t);
	}
}

/* what is seen at the terminals between the cycles */
static void sim_quick_channels(struct kunit *test)
{
	struct twin *t = twin_new(test);

	for (u32 i = 0; i < 200; i++) {
		u32 s = rnd(t, SLAVES);

		begin(t);
		logical(t, EC_CMD_LRW, LOGICAL, SPAN);
		send(t);
		t->b->now += MS;
		for (u16 c = 0; c < 8; c++)
			KUNIT_ASSERT_EQ(test,
				ec_app_channel(ec_app_of(ec_sim_slave(t->b->sim, s)), EC_APP_OUT, c),
				ec_app_channel(ec_app_of(ec_sim_slave(t->slow, s)), EC_APP_OUT, c));
	}
}

static void cycles_with_events(struct twin *t)
{
	for (u32 i = 0; i < 12000; i++) {
		begin(t);
		cyclic(t);
		if (!rnd(t, 4))
			registers(t);
		if (!rnd(t, 4))
			cyclic(t);
		if (!rnd(t, 8))
			registers(t);
		send(t);
		if (!rnd(t, 3))
			t->b->now += rnd(t, 3000000);
		if (!rnd(t, 40))
			event(t);
		if (i % 400 == 399)
			repair(t);
		if (i % 50 == 49)
			compare(t);
	}
	compare(t);
}

static void sim_quick_cycles_with_events(struct kunit *test)
{
	cycles_with_events(twin_new(test));
}

/* the other segment moves its frames from slave to slave */
static void sim_quick_cycles_step_by_step(struct kunit *test)
{
	struct twin *t = twin_new(test);

	ec_sim_set_under_way(t->slow, EC_SIM_UNDER_WAY_LOST);
	cycles_with_events(t);
}

static void twin_exit(struct kunit *test)
{
	struct twin *t = test->priv;

	if (!t || !t->b)
		return;
	ec_sim_free(t->b->sim);
	ec_sim_free(t->slow);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_quick_quiet_cycles),
	KUNIT_CASE(sim_quick_channels),
	KUNIT_CASE(sim_quick_cycles_with_events),
	KUNIT_CASE(sim_quick_cycles_step_by_step),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_quick",
	.exit = twin_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
