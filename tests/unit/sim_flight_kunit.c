// SPDX-License-Identifier: GPL-2.0-only
/* Frames on their way while something happens to ports. */
#include "sim_flight_kunit.h"

static void sim_flight_known_at_once_without_event(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a;

	plan(test, b, b->now + 100 * US, EC_SIM_FAULT_CUT, 2, 1);
	mark(b, &a, b->now, 1);
	KUNIT_EXPECT_TRUE(test, a.fl.done);
	KUNIT_EXPECT_EQ(test, wkc(&a), 7);
	KUNIT_EXPECT_EQ(test, a.fl.due_ns, b->now + (u64)a.fl.res.delay_ns);
	KUNIT_EXPECT_EQ(test, a.fl.res.delay_ns, (s64)(4700 + 40000 + 1200 + 1700 + 100 + WIRE));
	KUNIT_EXPECT_FALSE(test, a.fl.res.induced);
	KUNIT_EXPECT_EQ(test, ec_sim_next_step(b->sim), EC_ESC_NEVER);
	/* the next one may meet the event */
	mark(b, &a, b->now + 60 * US, 2);
	KUNIT_EXPECT_FALSE(test, a.fl.done);
	KUNIT_EXPECT_EQ(test, ec_sim_next_step(b->sim), b->now + 60 * US + 100);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_TRUE(test, a.fl.done);
}

/* a cable breaks when a frame is in front of it, on it, behind it */
static void sim_flight_cut_cable(struct kunit *test)
{
	static const struct {
		u64 at;
		s32 wkc;	/* -1: lost */
		u32 marks;	/* who has executed it */
		const char *where;
	} cuts[] = {
		{ 1200, 4, 0x47, "the port is closed when it gets there" },
		{ 1850, -1, 0x07, "first bit on the cable" },
		{ 2000, -1, 0x0f, "last bit not yet through: slave 3 has begun" },
		{ 1900 + WIRE - 1, -1, 0x0f, "the last bit itself" },
		{ 44000, -1, 0x3f, "in the branch, which is an island then" },
		{ 44650, -1, 0x3f, "on the cable, on its way back" },
		{ 44700 + WIRE - 1, -1, 0x7f, "slave 6 has begun" },
		{ 44700 + WIRE, 7, 0x7f, "through" },
	};
	struct bed *b = line(test, 20000);
	struct air a;

	for (u8 i = 0; i < ARRAY_SIZE(cuts); i++) {
		u64 t = b->now + (u64)(i + 1) * SECOND, before = ec_sim_disturbed(b->sim);

		plan(test, b, t + cuts[i].at, EC_SIM_FAULT_CUT, 2, 1);
		mark(b, &a, t, (u8)(i + 1));
		KUNIT_EXPECT_FALSE(test, a.fl.done);
		ec_sim_advance(b->sim, t + SECOND / 2);
		KUNIT_ASSERT_TRUE(test, a.fl.done);
		KUNIT_EXPECT_EQ_MSG(test, a.fl.res.copies ? wkc(&a) : -1, cuts[i].wkc, "%s",
				    cuts[i].where);
		KUNIT_EXPECT_EQ_MSG(test, a.fl.res.delay_ns < 0, cuts[i].wkc < 0, "%s",
				    cuts[i].where);
		KUNIT_EXPECT_EQ_MSG(test, marked(b, (u8)(i + 1)), cuts[i].marks, "%s",
				    cuts[i].where);
		KUNIT_EXPECT_TRUE(test, a.fl.res.induced);
		KUNIT_EXPECT_EQ(test, ec_sim_disturbed(b->sim), before + 1);
		plan(test, b, 0, EC_SIM_FAULT_HEAL, 2, 1);
		ec_sim_advance(b->sim, t + SECOND / 2);
	}
}

/* several frames in one send: each is where it is */
static void sim_flight_burst_meets_cut(struct kunit *test)
{
	struct air *a = kunit_kzalloc(test, 8 * sizeof(*a), GFP_KERNEL);
	struct bed *b = line(test, 20000);
	u64 t = b->now;

	KUNIT_ASSERT_NOT_NULL(test, a);
	plan(test, b, t + 40 * US, EC_SIM_FAULT_CUT, 2, 1);
	for (u8 i = 0; i < 8; i++)
		mark(b, &a[i], t + i * 7 * US, (u8)(i + 1));
	ec_sim_advance(b->sim, t + SECOND);
	for (u8 i = 0; i < 8; i++) {
		KUNIT_EXPECT_TRUE(test, a[i].fl.done);
		KUNIT_EXPECT_EQ_MSG(test, a[i].fl.res.delay_ns < 0, i < 6, "frame %u", i);
	}
	KUNIT_EXPECT_EQ(test, wkc(&a[6]), 4);
	KUNIT_EXPECT_EQ(test, wkc(&a[7]), 4);
	KUNIT_EXPECT_EQ_MSG(test, ec_sim_disturbed(b->sim), 6, "the last two were sent later");
	KUNIT_EXPECT_EQ_MSG(test, marked(b, 5), 0x38,
			    "the sixth did not get through the cable, the others went round");
}

/* a contact breaks and comes back while a frame is behind it: the branch executes it again */
static void sim_flight_island_processes_again(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a;

	plan(test, b, b->now + 20 * US, EC_SIM_FAULT_CUT, 2, 1);
	plan(test, b, b->now + 60 * US, EC_SIM_FAULT_HEAL, 2, 1);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_ASSERT_TRUE(test, a.fl.done);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 1);
	KUNIT_EXPECT_EQ(test, wkc(&a), 7 + 3);
	KUNIT_EXPECT_TRUE_MSG(test, get_unaligned_le16(a.eth + 22) & 0x4000, "circulating");
	/* a second time it is destroyed */
	b->now += 2 * SECOND;
	plan(test, b, b->now + 20 * US, EC_SIM_FAULT_CUT, 2, 1);
	plan(test, b, b->now + 100 * US, EC_SIM_FAULT_HEAL, 2, 1);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
}

/* slave 2 closes its port 1 by the second of three frames, while the first is behind it */
static u32 closed_behind(struct bed *b, struct air *a, u64 t)
{
	u32 back = 0;

	mark(b, &a[0], t, 1);
	send(b, &a[1], t + 7 * US, EC_CMD_FPWR, 1003, EC_REG_DL_LOOPS, EC_LOOP_CLOSED << 2, 1);
	mark(b, &a[2], t + 14 * US, 2);
	ec_sim_advance(b->sim, t + SECOND / 2);
	for (u32 i = 0; i < 3; i++)
		back |= (u32)(a[i].fl.done && a[i].fl.res.copies) << i;
	return back;
}

static void sim_flight_closed_loop_frame_passes(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a[3];

	KUNIT_EXPECT_EQ(test, closed_behind(b, a, b->now), 7);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 7);
	KUNIT_EXPECT_EQ_MSG(test, wkc(&a[1]), 1, "its own reply");
	KUNIT_EXPECT_EQ_MSG(test, wkc(&a[2]), 4, "0, 1, 2, 6");
	KUNIT_EXPECT_EQ(test, ec_sim_disturbed(b->sim), 0);
	/* the same step by step */
	b->now += SECOND;
	bed_put(b, 1003, EC_REG_DL_LOOPS, 0, 1);
	plan(test, b, b->now + 40 * US, EC_SIM_FAULT_HEAL, 2, 1);
	KUNIT_EXPECT_EQ(test, closed_behind(b, a, b->now), 7);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 7);
	KUNIT_EXPECT_EQ(test, wkc(&a[1]), 1);
	KUNIT_EXPECT_EQ(test, wkc(&a[2]), 4);
	KUNIT_EXPECT_EQ_MSG(test, marked(b, 1), 0x78, "it came to slave 6 after the third one");
}

static void sim_flight_closed_loop_frame_lost(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a[3];

	ec_sim_set_under_way(b->sim, EC_SIM_UNDER_WAY_LOST);
	KUNIT_EXPECT_EQ(test, closed_behind(b, a, b->now), 4);
	KUNIT_EXPECT_EQ(test, wkc(&a[2]), 4);
	KUNIT_EXPECT_EQ_MSG(test, marked(b, 1), 0x38, "the first frame never came to slave 6");
	KUNIT_EXPECT_EQ(test, marked(b, 2), 0x47);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 2)->mem[EC_REG_DL_LOOPS], EC_LOOP_CLOSED << 2);
	/* a frame that is back before the loop closes is back */
	ec_sim_free(b->sim);
	b = line(test, 100);
	ec_sim_set_under_way(b->sim, EC_SIM_UNDER_WAY_LOST);
	KUNIT_EXPECT_EQ(test, closed_behind(b, a, b->now), 5);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 7);
}

static void sim_flight_closed_loop_either(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	u32 seen = 0, all = 0;
	struct air a[3];

	ec_sim_set_under_way(b->sim, EC_SIM_UNDER_WAY_RANDOM);
	for (u32 i = 0; i < 40; i++) {
		b->now += SECOND;
		bed_put(b, 1003, EC_REG_DL_LOOPS, 0, 1);
		seen = closed_behind(b, a, b->now);
		KUNIT_EXPECT_TRUE(test, seen & 4);
		all |= 1u << seen;
	}
	KUNIT_EXPECT_EQ_MSG(test, all, 0xf0, "each of both, independently");
}

/* open, work, close in one send, and the port is closed before and after it */
static void sim_flight_open_work_close(struct kunit *test)
{
	for (u32 lose = 0; lose < 2; lose++) {
		struct bed *b = line(test, 100);
		struct air a[4];
		u64 t;

		bed_put(b, 1003, EC_REG_DL_LOOPS, EC_LOOP_CLOSED << 2, 1);
		ec_sim_set_under_way(b->sim, lose ? EC_SIM_UNDER_WAY_LOST :
						    EC_SIM_UNDER_WAY_BACK);
		b->now += SECOND;
		t = b->now;
		send(b, &a[0], t, EC_CMD_FPWR, 1003, EC_REG_DL_LOOPS, EC_LOOP_AUTO_CLOSE << 2, 1);
		mark(b, &a[1], t + 7 * US, 7);
		send(b, &a[2], t + 14 * US, EC_CMD_FPWR, 1003, EC_REG_DL_LOOPS,
		     EC_LOOP_CLOSED << 2, 1);
		mark(b, &a[3], t + 21 * US, 8);
		ec_sim_advance(b->sim, t + SECOND);
		KUNIT_EXPECT_EQ(test, wkc(&a[0]), 1);
		KUNIT_EXPECT_EQ_MSG(test, a[0].fl.res.delay_ns, a[3].fl.res.delay_ns,
				    "opened for the next frame");
		KUNIT_EXPECT_EQ(test, wkc(&a[1]), 7);
		KUNIT_EXPECT_EQ_MSG(test, a[2].fl.res.copies, !lose, "comes back to a closed port");
		KUNIT_EXPECT_EQ(test, wkc(&a[3]), 4);
		KUNIT_EXPECT_EQ(test, marked(b, 7), 0x38);
		KUNIT_EXPECT_EQ(test, marked(b, 8), 0x47);
		ec_sim_free(lose ? NULL : b->sim);
	}
}

/* a temporary setting ends while a frame is behind the port */
static void sim_flight_temporary_setting_ends(struct kunit *test)
{
	for (u32 lose = 0; lose < 2; lose++) {
		struct bed *b = line(test, 20000);
		struct air a;
		u64 end;

		bed_put(b, 1003, EC_REG_DL_LOOPS, EC_LOOP_CLOSED << 2, 1);
		ec_sim_set_under_way(b->sim, lose ? EC_SIM_UNDER_WAY_LOST :
						    EC_SIM_UNDER_WAY_BACK);
		end = b->now + 1300 + SECOND;
		bed_put(b, 1003, EC_REG_DL_CONTROL, 3, 2);
		mark(b, &a, end - 10 * US, 1);
		KUNIT_EXPECT_FALSE(test, a.fl.done);
		ec_sim_advance(b->sim, end + SECOND);
		KUNIT_EXPECT_TRUE(test, a.fl.done);
		KUNIT_EXPECT_EQ(test, a.fl.res.copies, !lose);
		KUNIT_EXPECT_EQ(test, marked(b, 1), lose ? 0x3fu : 0x7fu);
		ec_sim_free(lose ? NULL : b->sim);
	}
}

/* auto close: the frame that comes back over a contact that was broken opens the port */
static void sim_flight_returning_frame_opens_port(struct kunit *test)
{
	for (u32 lose = 0; lose < 2; lose++) {
		struct bed *b = line(test, 20000);
		struct air a;

		bed_put(b, 1003, EC_REG_DL_LOOPS, EC_LOOP_AUTO_CLOSE << 2, 1);
		ec_sim_set_under_way(b->sim, lose ? EC_SIM_UNDER_WAY_LOST :
						    EC_SIM_UNDER_WAY_BACK);
		b->now += SECOND;
		plan(test, b, b->now + 20 * US, EC_SIM_FAULT_CUT, 2, 1);
		plan(test, b, b->now + 30 * US, EC_SIM_FAULT_HEAL, 2, 1);
		mark(b, &a, b->now, 1);
		ec_sim_advance(b->sim, b->now + 40 * US);
		KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x6e70);
		ec_sim_advance(b->sim, b->now + SECOND);
		KUNIT_EXPECT_EQ(test, a.fl.res.copies, !lose);
		KUNIT_EXPECT_EQ_MSG(test, dl(b, 2) & 0xfff0, 0x6a70, "open again");
		ec_sim_free(lose ? NULL : b->sim);
	}
}

/* a slave loses its power with the frame in it, and with the frame behind it */
static void sim_flight_power_off(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a;

	plan(test, b, b->now + 2000, EC_SIM_FAULT_POWER_OFF, 3, 0);
	mark(b, &a, b->now, 1);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	b->now += 2 * SECOND;
	plan(test, b, 0, EC_SIM_FAULT_POWER_ON, 3, 0);
	plan(test, b, b->now + 30000, EC_SIM_FAULT_POWER_OFF, 3, 0);
	plan(test, b, b->now + 31000, EC_SIM_FAULT_POWER_ON, 3, 0);
	mark(b, &a, b->now, 2);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ_MSG(test, a.fl.res.copies, 0, "on the long cable");
	KUNIT_EXPECT_EQ(test, marked(b, 2), 0x37);
}

/* a branch that comes while a frame is on its way to it, or has passed its place */
static void sim_flight_branch_comes(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a[2];

	plan(test, b, 0, EC_SIM_FAULT_CUT, 2, 2);
	plan(test, b, b->now + 48 * US, EC_SIM_FAULT_HEAL, 2, 2);
	mark(b, &a[0], b->now, 1);
	mark(b, &a[1], b->now + 7 * US, 2);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 6);
	KUNIT_EXPECT_EQ(test, wkc(&a[1]), 7);
}

/* a link that comes by itself while the frame is on a long cable */
static void sim_flight_link_comes(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);
	struct air a[2];

	for (int i = 0; i < 2; i++) {
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, i - 1, 1, i, 0, i ? 100 : 20000), 0);
		b->cfg.link_ns = 1000000;
	}
	mark(b, &a[0], 1000000 - 30 * US, 1);
	mark(b, &a[1], 1000000 - 20 * US, 2);
	ec_sim_advance(b->sim, SECOND);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 1);
	KUNIT_EXPECT_EQ(test, wkc(&a[1]), 2);
	KUNIT_EXPECT_EQ(test, ec_sim_disturbed(b->sim), 2);
}

static void sim_flight_recalled_frame_is_lost(struct kunit *test)
{
	struct bed *b = line(test, 20000);
	struct air a[3];

	plan(test, b, b->now + 40 * US, EC_SIM_FAULT_CUT, 2, 2);
	for (u8 i = 0; i < 3; i++)
		mark(b, &a[i], b->now + i * 7 * US, (u8)(i + 1));
	ec_sim_recall(b->sim, &a[1].fl);
	ec_sim_recall(b->sim, &a[1].fl);
	KUNIT_EXPECT_TRUE(test, a[1].fl.done);
	KUNIT_EXPECT_EQ(test, a[1].fl.res.delay_ns, (s64)-ENOLINK);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, marked(b, 2), 0);
	KUNIT_EXPECT_EQ(test, wkc(&a[0]), 6);
	KUNIT_EXPECT_EQ(test, wkc(&a[2]), 6);
}

/* faults of frames, and Ethernet frames, as with frames that go at once */
static void sim_flight_fates(struct kunit *test)
{
	struct bed *b = line(test, 100);
	struct ec_sim_fault f = {
		.type = EC_SIM_FAULT_DELAY, .port = -1, .arg = 1, .value = 5000,
	};
	struct air a;
	s64 delay;

	mark(b, &a, b->now, 1);
	delay = a.fl.res.delay_ns;
	b->now += SECOND;
	ec_sim_set_under_way(b->sim, EC_SIM_UNDER_WAY_LOST);
	ec_sim_add_fault(b->sim, &f);
	f.type = EC_SIM_FAULT_DUPLICATE;
	f.value = 2;
	ec_sim_add_fault(b->sim, &f);
	f.type = EC_SIM_FAULT_LOSE;
	f.value = 1;
	f.arg = 2;
	ec_sim_add_fault(b->sim, &f);
	f.arg = 3;
	f.value = 0;
	ec_sim_add_fault(b->sim, &f);
	mark(b, &a, b->now, 2);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 3);
	KUNIT_EXPECT_EQ(test, a.fl.res.delay_ns, delay + 5000);
	KUNIT_EXPECT_EQ(test, a.fl.due_ns, b->now + (u64)delay + 5000);
	KUNIT_EXPECT_TRUE(test, a.fl.res.processed);
	KUNIT_EXPECT_EQ_MSG(test, a.eth[6], 0xff, "marked, and it was already");
	b->now += SECOND;
	mark(b, &a, b->now, 3);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	KUNIT_EXPECT_EQ_MSG(test, marked(b, 3), 0x7f, "lost on the way back");
	b->now += SECOND;
	mark(b, &a, b->now, 4);
	ec_sim_advance(b->sim, b->now + SECOND);
	KUNIT_EXPECT_EQ(test, a.fl.res.copies, 0);
	KUNIT_EXPECT_EQ_MSG(test, marked(b, 4), 0, "lost on the way out");
}

/* ---- step by step and at once give the same */

struct rnd {
	u64 state;
};

static u32 rnd(struct rnd *r, u32 n)
{
	r->state = r->state * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)(r->state >> 33) % n;
}

static size_t random_frame(struct rnd *r, u8 *buf, size_t cap)
{
	static const u16 ados[] = {
		0x000, 0x010, 0x100, 0x101, 0x110, 0x130, 0x200, 0x210, 0x300, 0x310, 0x502,
		0x600, 0x800, 0x900, 0x910, 0x92c, 0xf80, 0x1000,
	};
	u32 n = 1 + rnd(r, 5);
	struct ec_frame_buf f;

	ec_frame_begin(&f, buf, cap);
	while (n--) {
		u8 cmd = (u8)rnd(r, 16);
		u16 len = (u16)(1 + rnd(r, 12)), ado = ados[rnd(r, ARRAY_SIZE(ados))];
		u16 adp = (u16)(rnd(r, 2) ? 1000 + rnd(r, 9) : rnd(r, 4) ? -rnd(r, 8) : rnd(r, 3));
		u8 *p;

		if (cmd >= EC_CMD_LRD && cmd <= EC_CMD_LRW) {
			adp = (u16)rnd(r, 64);
			ado = 0;
		}
		p = ec_frame_add(&f, cmd, 3, adp, ado, len);
		for (u32 i = 0; i < len; i++)
			p[i] = (u8)(rnd(r, 3) ? 0 : rnd(r, 256));
		/* mostly reachable, with its address; ports 1 and 2 are closed now and then */
		if (ado == 0x100 && len > 1)
			p[1] &= rnd(r, 3) ? 0 : 0x3c;
		if (ado == 0x101)
			p[0] &= rnd(r, 3) ? 0 : 0x3c;
		if (ado == 0x010 && len > 1)
			put_unaligned_le16((u16)(1000 + rnd(r, 9)), p);
		if (ado == 0x600 && len > 11)
			put_unaligned_le32(rnd(r, 64), p);
	}
	return ec_frame_end(&f);
}

static void both(struct bed *a, struct bed *b, struct ec_sim_fault *f)
{
	f->at_ns = a->now + 25000;	/* no frame is on its way then */
	ec_sim_add_fault(a->sim, f);
	ec_sim_add_fault(b->sim, f);
}

static void repair(struct bed *a, struct bed *b)
{
	for (int i = 0; i < 28; i++) {
		struct ec_sim_fault f = {
			.type = i & 3 ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_POWER_ON,
			.slave = i / 4, .port = i % 4,
		};

		both(a, b, &f);
	}
	a->now += 30000;
	b->now = a->now;
	for (u32 i = 0; i < 7; i++) {
		bed_put(a, (u16)(1001 + i), EC_REG_DL_CONTROL, 1, 2);
		bed_put(b, (u16)(1001 + i), EC_REG_DL_CONTROL, 1, 2);
	}
}

static void sim_flight_same_as_at_once(struct kunit *test)
{
	struct bed *a = line(test, 300), *b = line(test, 300);
	struct rnd r = { 3 };
	u32 lost = 0;

	KUNIT_ASSERT_EQ(test, ec_sim_wire(a->sim, EC_SIM_MASTER1, 0, 5, 1, 100), 0);
	KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, EC_SIM_MASTER1, 0, 5, 1, 100), 0);
	for (u32 i = 0; i < 20000; i++) {
		struct ec_sim_fault f = {
			.type = (enum ec_sim_fault_type)rnd(&r, 4), .slave = (int)rnd(&r, 7),
			.port = (int)rnd(&r, 3),
		};
		int port = !rnd(&r, 4);
		struct ec_sim_result ra, rb;
		size_t len;
		u64 now;

		if (!rnd(&r, 60))
			both(a, b, &f);
		if (i % 100 == 99)
			repair(a, b);
		now = a->now + 30000;
		ec_sim_advance(a->sim, now);
		ec_sim_advance(b->sim, now);
		len = random_frame(&r, a->frame, sizeof(a->frame));
		memcpy(b->frame, a->frame, len);
		plan(test, b, now + 1, EC_SIM_FAULT_HEAL, 6, 1);	/* there is no cable */
		KUNIT_ASSERT_TRUE(test, ec_sim_must_fly(b->sim, now + 2));
		ec_sim_frame_result(a->sim, port, a->frame, len, now, &ra);
		ec_sim_frame_result(b->sim, port, b->frame, len, now, &rb);
		a->now = now;
		b->now = now;
		KUNIT_ASSERT_EQ_MSG(test, ra.delay_ns, rb.delay_ns, "frame %u", i);
		KUNIT_ASSERT_EQ(test, ra.out_port, rb.out_port);
		lost += ra.delay_ns < 0;
		if (ra.delay_ns >= 0)
			KUNIT_ASSERT_MEMEQ(test, a->frame, b->frame, len);
	}
	KUNIT_EXPECT_LT_MSG(test, lost, 10000, "the test is worth its name");
	for (u32 s = 0; s < 7; s++)
		KUNIT_EXPECT_MEMEQ(test, ec_sim_slave(a->sim, s)->mem,
				   ec_sim_slave(b->sim, s)->mem,
				   ec_sim_slave(a->sim, s)->mem_len);
	ec_sim_free(a->sim);
}

static void sim_flight_described(struct kunit *test)
{
	struct bed *b = app_bed(test, "segment under_way=lost\nslave a EK1100\n");

	KUNIT_EXPECT_EQ(test, b->sim->under_way, EC_SIM_UNDER_WAY_LOST);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_flight_known_at_once_without_event),
	KUNIT_CASE(sim_flight_cut_cable),
	KUNIT_CASE(sim_flight_burst_meets_cut),
	KUNIT_CASE(sim_flight_island_processes_again),
	KUNIT_CASE(sim_flight_closed_loop_frame_passes),
	KUNIT_CASE(sim_flight_closed_loop_frame_lost),
	KUNIT_CASE(sim_flight_closed_loop_either),
	KUNIT_CASE(sim_flight_open_work_close),
	KUNIT_CASE(sim_flight_temporary_setting_ends),
	KUNIT_CASE(sim_flight_returning_frame_opens_port),
	KUNIT_CASE(sim_flight_power_off),
	KUNIT_CASE(sim_flight_branch_comes),
	KUNIT_CASE(sim_flight_link_comes),
	KUNIT_CASE(sim_flight_recalled_frame_is_lost),
	KUNIT_CASE(sim_flight_fates),
	KUNIT_CASE(sim_flight_same_as_at_once),
	KUNIT_CASE(sim_flight_described),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_flight",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
