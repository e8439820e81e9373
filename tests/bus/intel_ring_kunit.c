// SPDX-License-Identifier: GPL-2.0-only
/*
 * The rings of the native Intel device against a card in memory, which does what the data sheets
 * say (82574: 7.1.4, 7.2.10; 82576: 7.1.5, 7.2.2), and what no virtual machine's card does: it
 * keeps frames back, and it writes errors and garbage to descriptors.
 */
#include <kunit/test.h>
#include <linux/etherdevice.h>
#include <linux/prandom.h>
#include <linux/workqueue.h>
#include "devices/intel/health.h"
#include "devices/intel/phy.h"
#include "devices/intel/regs.h"
#include "devices/intel/ring.h"
#include "master/kernel/compat.h"

#define BAR		0x10000
#define DESC		16
#define FRAME_MAX	1514
#define I82574		0x10d3
#define I82580		0x150e
#define I350		0x1521
#define LOG		512	/* frames the card remembers */

/* receive status and errors of both formats */
#define DD		BIT(0)
#define EOP		BIT(1)

struct card {
	struct intel_nic nic;
	struct intel_ring tx, rx;
	u8 *regs;
	u32 rx_head;
	struct {
		u16 len;
		u8 first;
		u8 last;
	} sent[LOG];
	unsigned int n_sent;
	struct delayed_work end_reset;
};

static u32 reg(const struct card *c, u32 offset)
{
	return *(u32 *)(c->regs + offset);
}

static void set_reg(struct card *c, u32 offset, u32 value)
{
	*(u32 *)(c->regs + offset) = value;
}

/* what the card finds with the address that a register holds */
static u8 *base(const struct card *c, u32 queue)
{
	return (u8 *)((u64)reg(c, queue + Q_BAH) << 32 | reg(c, queue + Q_BAL));
}

static void ring_memory(struct kunit *test, struct intel_ring *r, unsigned int n)
{
	r->desc = kunit_kzalloc(test, n * DESC, GFP_KERNEL);
	r->buf = kunit_kzalloc(test, n * INTEL_BUF, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, r->desc);
	KUNIT_ASSERT_NOT_NULL(test, r->buf);
	r->desc_dma = (dma_addr_t)r->desc;
	r->buf_dma = (dma_addr_t)r->buf;
}

static void start(struct kunit *test, struct card *c)
{
	KUNIT_ASSERT_EQ(test, ec_ring_start(&c->nic, &c->tx, &c->rx), 0);
	KUNIT_ASSERT_EQ(test, reg(c, c->nic.class->tx + Q_LEN), INTEL_TX * DESC);
	KUNIT_ASSERT_EQ(test, reg(c, c->nic.class->rx + Q_LEN), INTEL_RX * DESC);
	c->rx_head = 0;
	c->n_sent = 0;
}

/* a card of the class of the parameter, which is a device ID */
static struct card *card(struct kunit *test)
{
	const struct intel_chip *chip = ec_chip_find(*(const u16 *)test->param_value);
	struct card *c = kunit_kzalloc(test, sizeof(*c), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, chip);
	KUNIT_ASSERT_NOT_NULL(test, c);
	c->regs = kunit_kzalloc(test, BAR, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, c->regs);
	c->nic.regs = (void __iomem *)c->regs;
	c->nic.class = chip->class;
	ring_memory(test, &c->tx, INTEL_TX);
	ring_memory(test, &c->rx, INTEL_RX);
	start(test, c);
	return c;
}

/* The card sends up to @n frames that it was given; each ends a descriptor of its own. */
static void card_sends(struct kunit *test, struct card *c, unsigned int n)
{
	u32 q = c->nic.class->tx, head = reg(c, q + Q_HEAD);
	u8 *desc = base(c, q);

	for (; n && head != reg(c, q + Q_TAIL); n--, head = (head + 1) % INTEL_TX) {
		u8 *d = desc + head * DESC, *frame = (u8 *)get_unaligned_le64(d);
		u32 len = get_unaligned_le16(d + 8);

		if (c->nic.class->advanced) {
			/* data descriptor; end of packet, FCS, report status, extension */
			KUNIT_ASSERT_EQ(test, get_unaligned_le32(d + 8) >> 16, 0x2b30u);
			KUNIT_ASSERT_EQ(test, get_unaligned_le32(d + 12), len << 14);
			d[12] = DD;
		} else {
			/* end of packet, FCS, report status */
			KUNIT_ASSERT_EQ(test, d[11], 0x0b);
			KUNIT_ASSERT_EQ(test, d[12] & 0x0f, 0);
			d[12] = DD;
		}
		KUNIT_ASSERT_LT(test, c->n_sent, (unsigned int)LOG);
		c->sent[c->n_sent].len = len;
		c->sent[c->n_sent].first = frame[0];
		c->sent[c->n_sent++].last = frame[len - 1];
	}
	set_reg(c, q + Q_HEAD, head);
}

/* The card receives; false: the driver has left it no buffer. @flags: status, then errors */
static bool card_receives(struct card *c, u8 byte, u16 len, u16 flags)
{
	u32 q = c->nic.class->rx;
	u8 *d = base(c, q) + c->rx_head * DESC;

	if (c->rx_head == reg(c, q + Q_TAIL))
		return false;
	memset((u8 *)get_unaligned_le64(d), byte, min_t(u16, len, INTEL_BUF));
	if (c->nic.class->advanced) {
		put_unaligned_le32((flags & 0xff) | (u32)(flags >> 8) << 24, d + 8);
		put_unaligned_le32(len, d + 12);
	} else {
		put_unaligned_le16(len, d + 8);
		d[13] = flags >> 8;
		d[12] = flags;
	}
	c->rx_head = (c->rx_head + 1) % INTEL_RX;
	return true;
}

static bool put(struct card *c, u8 byte, u16 len)
{
	u8 *buf = ec_ring_tx_get(&c->nic, &c->tx);

	if (!buf)
		return false;
	memset(buf, byte, len);
	ec_ring_tx_put(&c->nic, &c->tx, len);
	return true;
}

static bool flush(struct card *c)
{
	return ec_ring_tx_flush(&c->nic, &c->tx);
}

static void expect_sent(struct kunit *test, const struct card *c, unsigned int i, u8 byte, u16 len)
{
	KUNIT_ASSERT_LT(test, i, c->n_sent);
	KUNIT_ASSERT_EQ(test, c->sent[i].len, len);
	KUNIT_ASSERT_EQ(test, c->sent[i].first, byte);
	KUNIT_ASSERT_EQ(test, c->sent[i].last, byte);
}

static void frames_leave_with_one_doorbell(struct kunit *test)
{
	struct card *c = card(test);

	KUNIT_EXPECT_TRUE(test, put(c, 1, 60));
	KUNIT_EXPECT_TRUE(test, put(c, 2, FRAME_MAX));
	KUNIT_EXPECT_TRUE(test, put(c, 3, 61));
	card_sends(test, c, LOG);
	KUNIT_EXPECT_EQ(test, c->n_sent, 0u);
	KUNIT_EXPECT_TRUE(test, flush(c));
	card_sends(test, c, LOG);
	KUNIT_ASSERT_EQ(test, c->n_sent, 3u);
	expect_sent(test, c, 0, 1, 60);
	expect_sent(test, c, 1, 2, FRAME_MAX);
	expect_sent(test, c, 2, 3, 61);
	KUNIT_EXPECT_FALSE(test, flush(c));
}

/* The ring takes what a cycle may send beside what waits; then it refuses until one has left. */
static void full_ring_refuses_until_frame_left(struct kunit *test)
{
	struct card *c = card(test);
	unsigned int n, round, i;

	for (round = 0; round < 5; round++) {
		c->n_sent = 0;
		for (n = 0; put(c, n, 60 + n); n++)
			KUNIT_ASSERT_LT(test, n, (unsigned int)INTEL_TX);
		KUNIT_EXPECT_GE(test, n, INTEL_TX - INTEL_TX / 4);
		flush(c);
		KUNIT_EXPECT_NULL(test, ec_ring_tx_get(&c->nic, &c->tx));
		card_sends(test, c, 2);
		KUNIT_EXPECT_NOT_NULL(test, ec_ring_tx_get(&c->nic, &c->tx));
		card_sends(test, c, LOG);
		KUNIT_ASSERT_EQ(test, c->n_sent, n);
		for (i = 0; i < n; i++)
			expect_sent(test, c, i, i, 60 + i);
	}
}

/* Outputs of before a loss of the link must not leave when it returns. */
static void start_drops_frames_of_before(struct kunit *test)
{
	struct card *c = card(test);
	unsigned int i;

	for (i = 0; i < 10; i++)
		put(c, 0xee, 60);
	flush(c);
	card_sends(test, c, 3);
	put(c, 0xee, 60);
	start(test, c);
	KUNIT_EXPECT_FALSE(test, flush(c));
	card_sends(test, c, LOG);
	KUNIT_EXPECT_EQ(test, c->n_sent, 0u);
	put(c, 1, 64);
	flush(c);
	card_sends(test, c, LOG);
	KUNIT_ASSERT_EQ(test, c->n_sent, 1u);
	expect_sent(test, c, 0, 1, 64);
}

static void frames_received_in_order(struct kunit *test)
{
	struct card *c = card(test);
	unsigned int sent = 0, got = 0, burst;
	const u8 *frame;
	size_t len;

	KUNIT_EXPECT_NULL(test, ec_ring_rx_get(&c->nic, &c->rx, &len));
	for (burst = 1; sent < 2000; burst = burst % 240 + 7) {
		unsigned int i;

		for (i = 0; i < burst; i++, sent++)
			KUNIT_ASSERT_TRUE(test, card_receives(c, sent, 60 + sent % 1000, DD | EOP));
		for (; (frame = ec_ring_rx_get(&c->nic, &c->rx, &len)); got++) {
			KUNIT_ASSERT_EQ(test, len, 60 + got % 1000);
			KUNIT_ASSERT_EQ(test, frame[0], (u8)got);
			KUNIT_ASSERT_EQ(test, frame[len - 1], (u8)got);
			ec_ring_rx_put(&c->nic, &c->rx);
		}
		KUNIT_ASSERT_EQ(test, got, sent);
	}
}

/* The card gets no buffer twice: it stops, and nothing that was not read is lost. */
static void unread_frames_stop_card(struct kunit *test)
{
	struct card *c = card(test);
	unsigned int n, got;
	const u8 *frame;
	size_t len;

	for (n = 0; card_receives(c, n, 60, DD | EOP); n++)
		KUNIT_ASSERT_LT(test, n, (unsigned int)INTEL_RX);
	KUNIT_EXPECT_EQ(test, n, INTEL_RX - 1u);
	for (got = 0; (frame = ec_ring_rx_get(&c->nic, &c->rx, &len)); got++) {
		KUNIT_ASSERT_EQ(test, frame[0], (u8)got);
		ec_ring_rx_put(&c->nic, &c->rx);
	}
	KUNIT_EXPECT_EQ(test, got, n);
	KUNIT_EXPECT_TRUE(test, card_receives(c, 1, 60, DD | EOP));
}

/* What was taken stays until it is given back, however much comes meanwhile. */
static void taken_frames_stay(struct kunit *test)
{
	struct card *c = card(test);
	const u8 *frame[100];
	unsigned int n, round;
	size_t len;

	for (round = 0; round < 20; round++) {
		for (n = 0; n < ARRAY_SIZE(frame); n++) {
			KUNIT_ASSERT_TRUE(test, card_receives(c, n, 60, DD | EOP));
			frame[n] = ec_ring_rx_get(&c->nic, &c->rx, &len);
			KUNIT_ASSERT_NOT_NULL(test, frame[n]);
		}
		while (card_receives(c, 0xee, 60, DD | EOP))
			;
		for (n = 0; n < ARRAY_SIZE(frame); n++)
			KUNIT_ASSERT_EQ(test, frame[n][0], (u8)n);
		while (ec_ring_rx_get(&c->nic, &c->rx, &len))
			;
		ec_ring_rx_put(&c->nic, &c->rx);
	}
}

/* A poll gives back only at its begin: what came with the one before is still taken. */
static void two_polls_fit(struct kunit *test)
{
	struct card *c = card(test);
	unsigned int n, round;
	size_t len;

	for (round = 0; round < 50; round++) {
		/* 192 acyclic frames and those of a cycle, INTEL_TX at most are sent between */
		for (n = 0; n < 240; n++)
			KUNIT_ASSERT_TRUE(test, card_receives(c, n, 60, DD | EOP));
		ec_ring_rx_put(&c->nic, &c->rx);
		for (n = 0; ec_ring_rx_get(&c->nic, &c->rx, &len); n++)
			;
		KUNIT_ASSERT_EQ(test, n, 240u);
	}
}

static void frame_with_error_is_skipped(struct kunit *test)
{
	static const struct {
		u16 len, flags;
	} bad[] = {
		{ 60, DD | EOP | 0x80 << 8 },	/* RXE */
		{ 60, DD },			/* continues in the next one */
		{ INTEL_BUF + 1, DD | EOP },
		{ 0xffff, DD | EOP },
		{ 0, DD | EOP },
	};
	struct card *c = card(test);
	unsigned int i;
	size_t len;

	for (i = 0; i < ARRAY_SIZE(bad); i++) {
		KUNIT_ASSERT_TRUE(test, card_receives(c, 0xee, bad[i].len, bad[i].flags));
		KUNIT_EXPECT_NOT_NULL(test, ec_ring_rx_get(&c->nic, &c->rx, &len));
		KUNIT_EXPECT_EQ_MSG(test, len, (size_t)0, "frame %u", i);
		ec_ring_rx_put(&c->nic, &c->rx);
	}
	KUNIT_ASSERT_TRUE(test, card_receives(c, 5, 60, DD | EOP));
	KUNIT_EXPECT_EQ(test, *ec_ring_rx_get(&c->nic, &c->rx, &len), 5);
	KUNIT_EXPECT_EQ(test, len, (size_t)60);
}

/* A broken card writes anything to all descriptors, of both rings, at any time. */
static void garbage_stays_within_buffers(struct kunit *test)
{
	struct rnd_state rnd;
	struct card *c = card(test);
	unsigned int round, i;
	size_t len;

	prandom_seed_state(&rnd, 7);
	for (round = 0; round < 2000; round++) {
		prandom_bytes_state(&rnd, c->rx.desc, INTEL_RX * DESC);
		prandom_bytes_state(&rnd, c->tx.desc, INTEL_TX * DESC);
		for (i = 0; i < 20; i++) {
			const u8 *frame = ec_ring_rx_get(&c->nic, &c->rx, &len);
			const u8 *buf = ec_ring_tx_get(&c->nic, &c->tx);

			if (frame) {
				KUNIT_ASSERT_LE(test, len, (size_t)INTEL_BUF);
				KUNIT_ASSERT_LE(test, (size_t)(frame - c->rx.buf),
						(size_t)(INTEL_RX - 1) * INTEL_BUF);
				ec_ring_rx_put(&c->nic, &c->rx);
			}
			if (buf) {
				KUNIT_ASSERT_LE(test, (size_t)(buf - c->tx.buf),
						(size_t)(INTEL_TX - 1) * INTEL_BUF);
				ec_ring_tx_put(&c->nic, &c->tx, 60);
			}
			flush(c);
		}
		/* all descriptors done: it ends nevertheless */
		memset(c->rx.desc, 0xff, INTEL_RX * DESC);
		for (i = 0; ec_ring_rx_get(&c->nic, &c->rx, &len); i++)
			KUNIT_ASSERT_LT(test, i, (unsigned int)INTEL_RX);
		ec_ring_rx_put(&c->nic, &c->rx);
	}
}

static void end_reset(struct work_struct *work)
{
	struct card *c = container_of(to_delayed_work(work), struct card, end_reset);

	set_reg(c, R_CTRL, reg(c, R_CTRL) & ~CTRL_RST);
}

/* ec_nic_reset() of a card that ends its reset after @ms */
static int reset_that_ends(struct card *c, unsigned int ms)
{
	int ret;

	INIT_DELAYED_WORK(&c->end_reset, end_reset);
	/* the work may be late, never early: it ends what has begun */
	schedule_delayed_work(&c->end_reset, msecs_to_jiffies(ms));
	ret = ec_nic_reset(&c->nic);
	cancel_delayed_work_sync(&c->end_reset);
	return ret;
}

static void reset_refuses_card_that_does_not_work(struct kunit *test)
{
	static const u8 mac[] = { 0x52, 0x54, 0x00, 0x01, 0x02, 0x03 };
	const u16 *id = test->param_value;
	struct card *c = card(test);

	/* it is absent */
	memset(c->regs, 0xff, BAR);
	KUNIT_EXPECT_EQ(test, ec_nic_reset(&c->nic), -ENODEV);
	/* its reset never ends */
	memset(c->regs, 0, BAR);
	KUNIT_EXPECT_EQ(test, ec_nic_reset(&c->nic), -EIO);
	/* it has no address */
	memset(c->regs, 0, BAR);
	memset(c->nic.mac, 0, sizeof(c->nic.mac));
	KUNIT_EXPECT_EQ(test, reset_that_ends(c, 25), -EADDRNOTAVAIL);
	/* a good one: no interrupt, its address is valid, all is off */
	memset(c->regs, 0, BAR);
	memset(c->nic.mac, 0, sizeof(c->nic.mac));
	set_reg(c, R_RAL0, get_unaligned_le32(mac));
	set_reg(c, R_RAH0, get_unaligned_le16(mac + 4));
	set_reg(c, R_RCTL, ~0u);
	set_reg(c, R_TCTL, ~0u);
	set_reg(c, R_CTRL, BIT(29));
	set_reg(c, 0x3840, BIT(30));
	if (!c->nic.class->advanced)
		set_reg(c, 0x0018, BIT(23));
	/* the link stays off until a driver comes, and falls asleep */
	set_reg(c, 0x0e14, ~0u);
	set_reg(c, 0x0e30, ~0u);
	set_reg(c, 0x0e38, ~0u);
	KUNIT_EXPECT_EQ(test, reset_that_ends(c, 25), 0);
	KUNIT_EXPECT_TRUE(test, ether_addr_equal(c->nic.mac, mac));
	KUNIT_EXPECT_EQ(test, reg(c, R_IMC), ~0u);
	KUNIT_EXPECT_EQ(test, reg(c, R_RAH0), get_unaligned_le16(mac + 4) | BIT(31));
	KUNIT_EXPECT_EQ(test, reg(c, R_RCTL), 0u);
	KUNIT_EXPECT_EQ(test, reg(c, R_TCTL) & TCTL_EN, 0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0e14), *id == I350 || *id == I82580 ? ~(1u << 5) : ~0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0e30), *id == I350 ? ~(7u << 16) : ~0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0e38), *id == I350 ? ~(3u << 2) : ~0u);
	if (c->nic.class->advanced) {
		/* SGMII */
		set_reg(c, 0x0018, 2 << 22);
		KUNIT_EXPECT_EQ(test, reset_that_ends(c, 25), -EMEDIUMTYPE);
	}
	if (*id != I82574)
		return;
	/* errata of the 82574, and reserved bits that have to be 1 */
	KUNIT_EXPECT_EQ(test, reg(c, R_CTRL) & BIT(29), 0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x5b64), 1u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x5b00), 0x08400000u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0018), 0x00400000u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x3828), 0x00400000u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x3840), 0x04000000u);
}

static void put_frames(struct kunit *test, struct card *c, unsigned int n)
{
	while (n--)
		KUNIT_ASSERT_TRUE(test, put(c, 1, 60));
	KUNIT_ASSERT_TRUE(test, flush(c));
}

/* A frame that does not leave while there is a link: the controller hangs. */
static void hang_of_card_is_noticed(struct kunit *test)
{
	struct card *c = card(test);
	struct intel_health h = { };
	unsigned int i;
	u64 now = 0;

	c->nic.up = true;
	/* it has nothing to send, and then it sends */
	for (i = 0; i < 100; i++, now += 20 * NSEC_PER_MSEC) {
		KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
		if (i >= 50) {
			put_frames(test, c, 3);
			KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
			card_sends(test, c, 3);
		}
	}
	/* not without a link */
	put_frames(test, c, 3);
	c->nic.up = false;
	for (i = 0; i < 100; i++, now += 20 * NSEC_PER_MSEC)
		KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
	/* it sends two of three: the last one is what counts */
	c->nic.up = true;
	card_sends(test, c, 2);
	for (i = 0; i < 25; i++, now += 20 * NSEC_PER_MSEC)
		KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
	KUNIT_EXPECT_TRUE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
	KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
	/* few looks in a long time say nothing */
	h.looks = 0;
	KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now));
	KUNIT_EXPECT_FALSE(test, ec_health_stuck(&h, &c->nic, &c->tx, now + NSEC_PER_SEC));
}

static void faults_of_frames_are_counted(struct kunit *test)
{
	struct card *c = card(test);
	struct intel_health h = { };

	KUNIT_EXPECT_FALSE(test, ec_health_count(&h, &c->nic));
	set_reg(c, 0x4000, 2);
	set_reg(c, 0x400c, 3);
	set_reg(c, 0x4010, 4);
	KUNIT_EXPECT_TRUE(test, ec_health_count(&h, &c->nic));
	KUNIT_EXPECT_EQ(test, h.damaged, 5u);
	KUNIT_EXPECT_EQ(test, h.missed, 4u);
	set_reg(c, 0x4010, ~0u);
	KUNIT_EXPECT_TRUE(test, ec_health_count(&h, &c->nic));
	ec_health_clear(&h, &c->nic);
	KUNIT_EXPECT_EQ(test, h.damaged + h.missed, 0u);
	KUNIT_EXPECT_FALSE(test, ec_health_second(&h, NSEC_PER_SEC - 1));
	KUNIT_EXPECT_TRUE(test, ec_health_second(&h, NSEC_PER_SEC));
	KUNIT_EXPECT_FALSE(test, ec_health_second(&h, NSEC_PER_SEC + 1));
}

static void link_is_read(struct kunit *test)
{
	static const struct {
		u32 status;
		u16 speed;
		bool up, gone, slow;
	} v[] = {
		{ 0, 10, false, false, true }, { 0x43, 100, true, false, false },
		{ 0x83, 1000, true, false, false }, { 0x42, 100, true, false, true },
		{ 0x03, 10, true, false, true }, { ~0u, 1000, false, true, false },
		{ 0x43, 100, true, false, false },
	};
	struct card *c = card(test);
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(v); i++) {
		set_reg(c, 0x0008, v[i].status);
		ec_nic_look(&c->nic);
		KUNIT_EXPECT_EQ(test, c->nic.up, v[i].up);
		KUNIT_EXPECT_EQ(test, c->nic.gone, v[i].gone);
		KUNIT_EXPECT_EQ(test, c->nic.slow, v[i].slow);
		KUNIT_EXPECT_EQ(test, c->nic.speed, v[i].speed);
	}
}

/* The firmware has the PHY, then it is free; it does not answer here. No pause frames. */
static void phy_is_shared_with_firmware(struct kunit *test)
{
	struct card *c = card(test);
	const struct intel_class *class = c->nic.class;

	set_reg(c, 0x0000, 3 << 27);
	set_reg(c, 0x0008, 1 << 2);	/* the second function */
	set_reg(c, 0x5b5c, BIT(2) << 16);
	KUNIT_EXPECT_EQ(test, ec_nic_connect(&c->nic), class->phy_sync ? -EBUSY : -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, reg(c, 0x5b5c), BIT(2) << 16);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0000) & 3 << 27, 0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0018) & BIT(28), class->pcie ? BIT(28) : 0u);
	/* that of the first function is another one; software has left its semaphore behind */
	set_reg(c, 0x5b5c, BIT(1) << 16);
	set_reg(c, 0x5b50, BIT(0));
	KUNIT_EXPECT_EQ(test, ec_phy_wake(&c->nic, true), -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, reg(c, 0x5b5c), BIT(1) << 16);
	KUNIT_EXPECT_EQ(test, reg(c, 0x5b50) & 3, class->phy_sync ? 0u : 1u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0f00) & BIT(5), 0u);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0020) & 0xffe00000, BIT(21) | BIT(27));
	ec_nic_quiet(&c->nic);
	KUNIT_EXPECT_EQ(test, reg(c, 0x0018) & BIT(28), 0u);
}

/* one chip of each class */
static const u16 chips[] = { 0x100e, I82574, 0x10c9, I82580, I350 };

static void chip_desc(const u16 *id, char *desc)
{
	strscpy(desc, ec_chip_find(*id)->class->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(chip, chips, chip_desc);

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(frames_leave_with_one_doorbell, chip_gen_params),
	KUNIT_CASE_PARAM(full_ring_refuses_until_frame_left, chip_gen_params),
	KUNIT_CASE_PARAM(start_drops_frames_of_before, chip_gen_params),
	KUNIT_CASE_PARAM(frames_received_in_order, chip_gen_params),
	KUNIT_CASE_PARAM(unread_frames_stop_card, chip_gen_params),
	KUNIT_CASE_PARAM(taken_frames_stay, chip_gen_params),
	KUNIT_CASE_PARAM(two_polls_fit, chip_gen_params),
	KUNIT_CASE_PARAM(frame_with_error_is_skipped, chip_gen_params),
	KUNIT_CASE_PARAM(garbage_stays_within_buffers, chip_gen_params),
	KUNIT_CASE_PARAM(hang_of_card_is_noticed, chip_gen_params),
	KUNIT_CASE_PARAM(faults_of_frames_are_counted, chip_gen_params),
	KUNIT_CASE_PARAM(link_is_read, chip_gen_params),
	KUNIT_CASE_PARAM(phy_is_shared_with_firmware, chip_gen_params),
	KUNIT_CASE_PARAM(reset_refuses_card_that_does_not_work, chip_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_intel",
	.test_cases = cases,
};
kunit_test_suite(suite);
