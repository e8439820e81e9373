// SPDX-License-Identifier: GPL-2.0-only
/* Frames that nobody sent, that are cut, changed, doubled, late or lost. */
#include <linux/etherdevice.h>
#include <linux/rcupdate.h>
#include "cyc.h"
#include "devices/ecdev.h"
#include "master/link/device.h"
#include "master/link/slots.h"

static const char text[] =
	"segment seed=11 response=100us transition=200us\n"
	"slave a EK1100\nslave b EL2008\nslave c drive serial=9\n";

#define N	3

/* a frame the master waits for, and a good reply to it */
struct expected {
	struct ec_slot *slot;
	u8 src[6];
	u8 reply[EC_FRAME_HDR + EC_FRAME_BODY_MAX];
	size_t len;
};

/*
 * The frame has two datagrams, so that each header has a neighbour. It is built at @frame,
 * NULL: in its slot.
 */
static void expect_at(struct bus *b, struct expected *e, u8 *frame)
{
	struct ec_frame_buf fb;

	e->slot = ec_slot_get(bus_slots(b), true, ktime_get_ns());
	KUNIT_ASSERT_NOT_NULL(b->test, e->slot);
	memset(e->slot->frame, 0xff, sizeof(e->slot->frame));
	frame = frame ?: e->slot->frame;
	ec_frame_begin(&fb, frame + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	memset(ec_frame_add(&fb, EC_CMD_FPRD, e->slot->index, 0x1001, 0x0130, 2), 0, 2);
	memset(ec_frame_add(&fb, EC_CMD_LRW, e->slot->index, 0x0000, 0x0001, 8), 0, 8);
	e->len = ec_frame_end(&fb);
	e->slot->eth_len = EC_ETH_HDR + e->len;
	ec_slot_arm(bus_slots(b), e->slot, frame, BIT(0), ktime_get_ns());
	memcpy(e->src, frame + 6, 6);
	e->src[0] |= 2;
	memcpy(e->reply, frame + EC_ETH_HDR, e->len);
}

static void expect(struct bus *b, struct expected *e)
{
	expect_at(b, e, NULL);
}

static void give(struct bus *b, const u8 *src, const u8 *data, size_t len)
{
	rcu_read_lock();
	ecdev_receive(bus_dev(b), src, data, len);
	rcu_read_unlock();
}

static u64 unmatched(const struct bus *b)
{
	return bus_unmatched(b);
}

static u64 late(const struct bus *b)
{
	return bus_late(b);
}

static int state(const struct expected *e)
{
	return atomic_read(&e->slot->state);
}

/* a buffer of a device, which uses it for other frames */
static u8 buffer[EC_ETH_MAX];

static const struct place {
	const char *name;
	u8 *frame;
} places[] = { { "built_in_slot", NULL }, { "built_in_device", buffer } };

static void place_desc(const struct place *p, char *desc)
{
	strscpy(desc, p->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(place, places, place_desc);

/* Not one changed bit of a header is taken; data and counters may be anything. */
static void frame_changed(struct kunit *test)
{
	const struct place *place = test->param_value;
	struct bus *b = bus_up(test, text, N);
	static struct expected e;
	u64 before = unmatched(b);
	u32 refused = 0;
	size_t i;
	u8 bit;

	expect_at(b, &e, place->frame);
	if (place->frame)
		memset(place->frame, 0x55, EC_ETH_MAX);
	/* EtherCAT header; command, index, address, length of the first datagram */
	for (i = 0; i < EC_FRAME_HDR + 8; i++) {
		for (bit = 0; bit < 8; bit++) {
			/* a slave with a closed port marks what circulates */
			if (i == EC_FRAME_HDR + 7 && bit == 6)
				continue;
			/* bits the header reserves are no reason to refuse */
			if (i == EC_FRAME_HDR + 7 && (bit == 3 || bit == 4 || bit == 5))
				continue;
			if (i == 1 && bit == 3)
				continue;
			e.reply[i] ^= 1 << bit;
			give(b, e.src, e.reply, e.len);
			e.reply[i] ^= 1 << bit;
			refused++;
			KUNIT_ASSERT_EQ_MSG(test, state(&e), EC_SLOT_SENT, "byte %zu bit %u", i,
					    bit);
		}
	}
	KUNIT_EXPECT_GE(test, unmatched(b) + late(b) - before, refused);
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_DONE);
	ec_slot_put(e.slot);
}

/* A device that writes to the frame it is given: lengths from there do not leave the slot. */
static void frame_noted_within_its_length(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slot *slot = ec_slot_get(bus_slots(b), true, ktime_get_ns());
	size_t i, last = EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD + 4;

	KUNIT_ASSERT_NOT_NULL(test, slot);
	memset(slot->frame, 0, sizeof(slot->frame));
	memset(buffer, 0xff, sizeof(buffer));
	/* one datagram of 4 bytes; lengths and "more" of all behind it are the largest */
	put_unaligned_le16(4 | 0x8000, buffer + EC_ETH_HDR + EC_FRAME_HDR + 6);
	slot->eth_len = last + EC_DGRAM_OVERHEAD;
	ec_slot_arm(bus_slots(b), slot, buffer, BIT(0), ktime_get_ns());
	KUNIT_EXPECT_EQ(test, slot->frame[last + EC_DGRAM_HDR - 1], 0xff);
	for (i = last + EC_DGRAM_HDR; i < sizeof(slot->frame); i++)
		KUNIT_ASSERT_EQ(test, slot->frame[i], 0);
	/* the frame itself ends where there is room for no header */
	slot->eth_len = last + EC_DGRAM_OVERHEAD - 1;
	memset(slot->frame, 0, sizeof(slot->frame));
	ec_slot_arm(bus_slots(b), slot, buffer, BIT(0), ktime_get_ns());
	KUNIT_EXPECT_EQ(test, slot->frame[last], 0);
	ec_slot_put(slot);
}

static void frame_truncated(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	static struct expected e;
	u64 before = unmatched(b);
	size_t len;

	expect(b, &e);
	for (len = 0; len < e.len; len++) {
		/* a copy, so that the tool sees a read behind it */
		u8 *cut = kmemdup(e.reply, len, GFP_KERNEL);

		give(b, e.src, cut, len);
		kfree(cut);
		KUNIT_ASSERT_EQ_MSG(test, state(&e), EC_SLOT_SENT, "%zu bytes", len);
	}
	KUNIT_EXPECT_GE(test, unmatched(b) - before, e.len);
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_DONE);
	/* a second copy is not late, also when the slot is free again */
	before = unmatched(b);
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, unmatched(b), before + 1);
	ec_slot_put(e.slot);
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, unmatched(b), before + 2);
	KUNIT_EXPECT_EQ(test, late(b), 0ull);
}

/* The frame before, of the same slot, comes while the next is expected. */
static void frame_of_before(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	static struct expected e, next;
	u64 before;

	expect(b, &e);
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(e.slot, ktime_get_ns()));
	msleep(50);
	next = e;
	ec_slot_arm(bus_slots(b), next.slot, next.slot->frame, BIT(0), ktime_get_ns());
	memcpy(next.src, next.slot->frame + 6, 6);
	before = late(b);
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, late(b), before + 1);
	KUNIT_EXPECT_EQ(test, state(&next), EC_SLOT_SENT);
	give(b, next.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&next), EC_SLOT_DONE);
	ec_slot_put(next.slot);
}

/* Sent on two links: done when both copies are back, whichever is the first. */
static void frame_on_two_links_done_with_both_copies(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	static u8 sent[EC_ETH_MAX];
	static struct expected e;
	u64 before = unmatched(b);

	expect(b, &e);
	KUNIT_ASSERT_TRUE(test, ec_slot_cancel(e.slot, ktime_get_ns()));
	bus_two_copies(b, e.slot);
	memcpy(sent, e.reply, e.len);
	ec_slot_arm(bus_slots(b), e.slot, e.slot->frame, BIT(0) | BIT(1), ktime_get_ns());
	memcpy(e.src, e.slot->frame + 6, 6);
	e.src[1] = 1;
	/* processed by a slave each */
	put_unaligned_le16(1, e.reply + e.len - EC_DGRAM_WKC);
	e.reply[EC_FRAME_HDR + EC_DGRAM_HDR] = 0x11;
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_SENT);
	give(b, e.src, e.reply, e.len);
	e.src[1] = 2;
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, unmatched(b), before + 2);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_SENT);
	e.src[1] = 0;
	e.reply[EC_FRAME_HDR + EC_DGRAM_HDR] = 0x22;
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_DONE);
	KUNIT_EXPECT_EQ(test, e.slot->got[1][EC_FRAME_HDR + EC_DGRAM_HDR], 0x11);
	KUNIT_EXPECT_EQ(test, e.slot->got[0][EC_FRAME_HDR + EC_DGRAM_HDR], 0x22);
	/* what was sent is still there */
	KUNIT_EXPECT_EQ(test, memcmp(ec_slot_body(e.slot), sent, e.len), 0);
	ec_slot_put(e.slot);
	bus_one_copy(b, e.slot);
}

/* Bytes by chance, of every length, while the bus works. */
static void frame_foreign(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u64 before = unmatched(b) + late(b);
	u32 rnd = 12345, i, k;
	u8 *buf = kunit_kzalloc(test, 1500, GFP_KERNEL);
	u8 type[2];

	for (i = 0; i < 3000; i++) {
		for (k = 0; k < 1500; k += 3) {
			rnd = rnd * 1664525 + 1013904223;
			buf[k] = rnd >> 24;
		}
		give(b, buf, buf + 6, i % 1494);
		if (i % 100)
			continue;
		KUNIT_ASSERT_EQ(test,
				bus_fprd(b, bus_slave(b, 1)->station, EC_REG_TYPE,
						   type, 2), 0);
		KUNIT_ASSERT_MEMEQ(test, type, bus_slave(b, 1)->regs, 2);
	}
	KUNIT_EXPECT_EQ(test, unmatched(b) + late(b) - before, 3000);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0);
}

/* one read in a thread of its own */
struct reader {
	struct ec_job job;
	struct bus *b;
	u16 station;
	int ret;
	bool done;
};

static void read_type(struct ec_job *job)
{
	struct reader *r = container_of(job, struct reader, job);
	u8 type[2];

	r->ret = bus_fprd(r->b, r->station, EC_REG_TYPE, type, 2);
	WRITE_ONCE(r->done, true);
}

static u32 change_slots(struct bus *b, int from, int to)
{
	u32 i, n = 0;

	for (i = 0; i < EC_SLOTS; i++)
		n += atomic_cmpxchg(&bus_slot(b, i)->state, from, to) == from;
	return n;
}

/*
 * The time limit ends while a frame is compared that then is not the reply: who
 * waits gives up all the same.
 */
static void frame_compared(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	static struct reader r;
	u32 ms, held = 0;

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	r = (struct reader){
		.job.run = read_type, .b = b, .station = bus_slave(b, 1)->station,
	};
	ec_workers_queue(bus_workers(b), &r.job);
	for (ms = 0; ms < 60; ms++) {
		held += change_slots(b, EC_SLOT_SENT, EC_SLOT_FILL);
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_GT(test, held, 0u);
	change_slots(b, EC_SLOT_FILL, EC_SLOT_SENT);
	for (ms = 0; ms < 500 && !READ_ONCE(r.done); ms++)
		usleep_range(1000, 1001);
	KUNIT_EXPECT_TRUE(test, r.done);
	KUNIT_EXPECT_EQ(test, r.ret, -ETIMEDOUT);
}

static const struct trouble {
	const char *name;
	const char *fault;
	bool counted;	/* 300 us are within the time limit of a frame */
} troubles[] = {
	{ "lost", "fault at=1s lose rate=20000ppm\n", true },
	{ "doubled", "fault at=1s duplicate rate=100000ppm copies=3\n", true },
	{ "late", "fault at=1s delay rate=20000ppm by=50ms\n", true },
	{ "late_a_little", "fault at=1s delay rate=100000ppm by=300us\n", false },
};

static void trouble_desc(const struct trouble *t, char *desc)
{
	strscpy(desc, t->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(trouble, troubles, trouble_desc);

/* 2000 reads: each is right or an error, nearly all are right. */
static void frame_trouble(struct kunit *test)
{
	const struct trouble *t = test->param_value;
	char *all = kunit_kzalloc(test, 512, GFP_KERNEL);
	struct bus *b;
	u32 i, errors = 0;
	u8 v[4];
	int ret;

	snprintf(all, 512, "%s%s", text, t->fault);
	b = bus_up(test, all, N);
	msleep(1000);
	for (i = 0; i < 2000; i++) {
		u32 k = i % N;

		memset(v, 0xee, sizeof(v));
		ret = bus_fprd(b, bus_slave(b, k)->station, EC_REG_TYPE, v, 4);
		errors += ret != 0;
		if (!ret)
			KUNIT_ASSERT_MEMEQ(test, v, bus_slave(b, k)->regs, 4);
	}
	KUNIT_EXPECT_LT(test, errors, 3u);
	bus_figure("fault_frame %s lost %llu late %llu unmatched %llu errors %u of 2000", t->name,
		   bus_lost(b), late(b), unmatched(b), errors);
	KUNIT_EXPECT_EQ(test, bus_lost(b) + late(b) + unmatched(b) > 0, t->counted);
	/* a second copy is no late frame */
	if (!strcmp(t->name, "doubled"))
		KUNIT_EXPECT_EQ(test, late(b), 0ull);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), N);
}

/* A device that refuses frames to which another station has sent a good reply already. */
static struct forger {
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	struct ecdev *dev;
	u8 cmd;		/* of the first datagram of these frames */
	u16 wkc;	/* of the reply */
	u32 times;	/* more frames */
	u32 seen;	/* frames of this kind */
} forger;

static int forge(void *priv, u8 *buf, size_t len)
{
	static u8 reply[EC_ETH_MAX];
	struct ec_frame_iter it;
	struct ec_dgram d;

	memcpy(reply, buf, len);
	if (ec_frame_iter_init(&it, reply + EC_ETH_HDR, len - EC_ETH_HDR) ||
	    ec_frame_iter_next(&it, &d) != 1 || d.cmd != forger.cmd)
		return forger.real->tx_send(priv, buf, len);
	forger.seen++;
	if (!forger.times)
		return forger.real->tx_send(priv, buf, len);
	forger.times--;
	reply[6] |= 2;
	memset(d.data, 0x5a, d.len);
	ec_dgram_set_wkc(&d, forger.wkc);
	rcu_read_lock();
	ecdev_receive(forger.dev, reply + 6, reply + EC_ETH_HDR, len - EC_ETH_HDR);
	rcu_read_unlock();
	return -EBUSY;
}

static void begin_forging(struct bus *b, u8 cmd, u16 wkc)
{
	struct ecdev *dev = bus_dev(b);

	forger = (struct forger){
		.real = dev->ops, .ops = *dev->ops, .dev = dev, .cmd = cmd, .wkc = wkc,
	};
	forger.ops.tx_send = forge;
	dev->ops = &forger.ops;
}

/* All slots are free, or in quarantine: none is lost. */
static void end_forging(struct bus *b)
{
	u32 ms, i, used = EC_SLOTS;

	forger.dev->ops = forger.real;
	for (ms = 0; ms < 100 && used; ms++) {
		usleep_range(1000, 1001);
		for (i = 0, used = 0; i < EC_SLOTS; i++) {
			int state = atomic_read(&bus_slot(b, i)->state);

			used += state != EC_SLOT_FREE && state != EC_SLOT_QUARANTINE;
		}
	}
	KUNIT_EXPECT_EQ(b->test, used, 0u);
	KUNIT_EXPECT_EQ(b->test, bus_acyclic(b), 0u);
	KUNIT_EXPECT_EQ(b->test, bus_acyclic_ns(b), 0);
}

/* Refused once, and always: the frame counts as sent. */
static void frame_refused_after_reply_is_not_sent_again(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	u16 station = bus_slave(b, 1)->station;
	u8 v[4], good[4];
	u32 i;

	bus_idle(b);
	memset(good, 0x5a, sizeof(good));
	begin_forging(b, EC_CMD_FPRD, 1);
	for (i = 0; i < 300; i++) {
		forger.times = i % 2 ? U32_MAX : 1;
		forger.seen = 0;
		memset(v, 0, sizeof(v));
		KUNIT_EXPECT_EQ(test, bus_fprd(b, station, 0, v, sizeof(v)), 0);
		KUNIT_EXPECT_MEMEQ(test, v, good, sizeof(v));
		KUNIT_EXPECT_EQ(test, forger.seen, 1u);
		if (forger.seen != 1)
			break;
	}
	end_forging(b);
	KUNIT_EXPECT_EQ(test, bus_fprd(b, station, 0, v, sizeof(v)), 0);
	KUNIT_EXPECT_MEMEQ(test, v, bus_slave(b, 1)->regs, sizeof(v));
}

static void every_second(struct cyc *c)
{
	forger.times = c->cycles % 2;
}

static void frame_refused_after_reply_is_taken_by_cycle(struct kunit *test)
{
	struct cyc *c = cyc_in_op(bus_up(test, text, N), 0, N);
	struct ec_cyc_dgram *d = bus_dgrams(c->b);
	u64 errors = bus_tx_errors(c->b);

	cyc_run(c, 10);
	c->incomplete = 0;
	c->each = every_second;
	begin_forging(c->b, d->cmd, d->expected);
	cyc_run(c, 600);
	KUNIT_EXPECT_EQ(test, forger.seen, 600u);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0u);
	KUNIT_EXPECT_EQ(test, bus_tx_errors(c->b), errors);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	c->each = NULL;
	cyc_release(c);
	end_forging(c->b);
}

/* Slaves set the bit that says so; the number distinguishes uses of a slot. */
static void frame_source_locally_administered(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	static struct expected e;

	expect(b, &e);
	KUNIT_EXPECT_EQ(test, e.slot->frame[6], 0x02);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(e.src + 2), e.slot->seq);
	e.src[2]++;
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_SENT);
	e.src[2]--;
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_DONE);
	ec_slot_put(e.slot);
}

/* a device that reads the source addresses of the frames it sends */
static struct {
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	u32 frames, numbered;
} watched;

static int read_source(void *priv, u8 *buf, size_t len)
{
	static const u8 source[] = { 0x02, 0, 0, 0, 0, 0 };

	watched.frames++;
	watched.numbered += !ether_addr_equal(buf + ETH_ALEN, source);
	return watched.real->tx_send(priv, buf, len);
}

/* The source address of every frame is the same then; start and cycle work as before. */
static void frame_without_number_matched_by_index(struct kunit *test)
{
	static const u8 source[] = { 0x02, 0, 0, 0, 0, 0 };
	struct bus *b = bus_up(test, text, N);
	struct ecdev *dev = bus_dev(b);
	struct ec_slots *s = bus_slots(b);
	static struct expected e;
	struct cyc *c;

	s->numbered = false;
	expect(b, &e);
	KUNIT_EXPECT_MEMEQ(test, e.src, source, sizeof(source));
	give(b, e.src, e.reply, e.len);
	KUNIT_EXPECT_EQ(test, state(&e), EC_SLOT_DONE);
	ec_slot_put(e.slot);
	watched.real = dev->ops;
	watched.ops = *dev->ops;
	watched.ops.tx_send = read_source;
	watched.frames = 0;
	watched.numbered = 0;
	dev->ops = &watched.ops;
	c = cyc_in_op(b, 0, N);
	c->incomplete = 0;
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, watched.numbered, 0u);
	KUNIT_EXPECT_GT(test, watched.frames, 500u);
	cyc_release(c);
	dev->ops = watched.real;
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(frame_changed, place_gen_params),
	KUNIT_CASE(frame_noted_within_its_length),
	KUNIT_CASE(frame_truncated),
	KUNIT_CASE(frame_of_before),
	KUNIT_CASE(frame_on_two_links_done_with_both_copies),
	KUNIT_CASE(frame_foreign),
	KUNIT_CASE(frame_compared),
	KUNIT_CASE_PARAM(frame_trouble, trouble_gen_params),
	KUNIT_CASE(frame_refused_after_reply_is_not_sent_again),
	KUNIT_CASE(frame_refused_after_reply_is_taken_by_cycle),
	KUNIT_CASE(frame_source_locally_administered),
	KUNIT_CASE(frame_without_number_matched_by_index),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_fault_frame",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
