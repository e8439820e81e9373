// SPDX-License-Identifier: GPL-2.0-only
/* Layout of process data: large and small, bits, rates, and what is too much. */
#include "cyc.h"
#include "master/base/bytes.h"
#include "master/boundary/ioctl.h"

#define CHANNELS	255	/* of 32 bits the model keeps */

/* More than a datagram holds: it is cut between SyncManagers, none of them is. */
static void image_several_datagrams(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=23\nrepeat 3 slave s io in=8000 out=8000\n"
			       "connect s2.200 -> s2.200\n", 3);
	bool split = false;
	char name[8];
	struct cyc *c;
	u32 i, k;

	bus_idle(b);
	c = cyc_new(b, 2000);
	cyc_domain(c);
	cyc_map_all(c, 0, 3, 0);
	cyc_activate(c);
	KUNIT_EXPECT_GE(test, bus_n_dgrams(b), 5u);
	for (i = 0; i < bus_n_dgrams(b); i++)
		split |= bus_dgrams(b)[i].logical % 1000 != 0;
	KUNIT_EXPECT_FALSE(test, split);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	for (i = 0; i < 3; i++)
		for (k = 0; k < 250; k++)
			put_unaligned_le32(i * 31 + k * 0x01000193, cyc_pd(c, i, 0) + 4 * k);
	cyc_run(c, 5);
	c->incomplete = 0;
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	for (i = 0; i < 3; i++) {
		snprintf(name, sizeof(name), "s%u", i + 1);
		for (k = 0; k < 250; k++)
			KUNIT_EXPECT_EQ_MSG(test,
					    (u32)ec_app_channel(bus_app(b, name), EC_APP_OUT, k),
					    i * 31 + k * 0x01000193, "%s channel %u", name, k);
	}
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 1, 1) + 4 * 199),
			31 + 199 * 0x01000193u);
}

/* 16 KiB in one domain, apart and overlapped: the application sees it whole. */
static void image_16k(struct kunit *test, u32 options, u32 frames)
{
	struct bus *b = bus_up(test, "segment seed=25\nrepeat 16 slave s io in=4096 out=4096\n"
			       "connect s1.1 -> s1.1\nconnect s16.128 -> s16.128\n"
			       "connect s8.128 -> s8.128\n", 16);
	struct ec_ioc_domain_options o = { .options = options };
	struct cyc *c;
	char name[8];
	u32 i, k, round;

	bus_idle(b);
	c = cyc_new(b, 4000);
	cyc_domain(c);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OPTIONS, &o), 0);
	cyc_map_all(c, 0, 16, 0);
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, bus_domain(b, 0)->size, 16384u);
	KUNIT_EXPECT_EQ(test, bus_plain_wire(b)->frames, frames);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 8000), ~0ull);
	for (round = 1; round < 4; round++) {
		for (i = 0; i < 16; i++)
			for (k = 0; k < 128; k++)
				put_unaligned_le32(i * 31 + (k + round) * 0x01000193,
						   cyc_pd(c, i, 0) + 4 * k);
		cyc_run(c, 4);
		c->incomplete = 0;
		cyc_run(c, 4);
		KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
		for (i = 0; i < 16; i++) {
			snprintf(name, sizeof(name), "s%u", i + 1);
			for (k = 0; k < 128; k++)
				KUNIT_EXPECT_EQ(test, (u32)ec_app_channel(bus_app(b, name),
									  EC_APP_OUT, k),
						i * 31 + (k + round) * 0x01000193);
		}
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 15, 1) + 4 * 127),
				15 * 31 + (127 + round) * 0x01000193u);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 7, 1) + 4 * 127),
				7 * 31 + (127 + round) * 0x01000193u);
	}
	KUNIT_EXPECT_EQ(test, bus_last_wire(b)->frames, frames);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

static void image_16k_apart(struct kunit *test)
{
	image_16k(test, 0, 16);
}

static void image_16k_overlap(struct kunit *test)
{
	/* two slaves a datagram: 1024 bytes, each way in the same place */
	image_16k(test, EC_DOMAIN_OPT_OVERLAP, 8);
}

/* both outputs of the slave carry the number of the cycle */
static void count_outputs(struct cyc *c)
{
	put_unaligned_le32(c->cycles, cyc_pd(c, 0, 0));
}

/*
 * A SyncManager of several datagrams in several frames: its inputs change only
 * when all parts of one cycle are back.
 */
static void image_cut(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=26\nslave s io in=32000 out=32000\n"
			       "slave t io in=512 out=512\nconnect s.1 -> s.1\n"
			       "connect t.1 -> t.1\n", 2);
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_LOSE, .slave = -1 };
	struct ec_cycle *cycle;
	struct cyc *c;
	u32 i, v;

	bus_idle(b);
	c = cyc_new(b, 2000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	cyc_activate(c);
	cycle = bus_cycle(b);
	KUNIT_ASSERT_EQ(test, cycle->layout.n_cuts, 1u);
	KUNIT_EXPECT_EQ(test, cycle->layout.cuts[0].parts, 3);
	KUNIT_EXPECT_EQ(test, cycle->layout.cuts[0].len, 4000u);
	KUNIT_EXPECT_EQ(test, bus_plain_wire(b)->frames, 6u);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	c->each = count_outputs;
	cyc_run(c, 10);
	c->incomplete = 0;
	for (i = 0; i < 10; i++) {
		v = get_unaligned_le32(cyc_pd(c, 0, 1));
		cyc_run(c, 1);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 0, 1)), v + 1);
	}
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	v = get_unaligned_le32(cyc_pd(c, 0, 1));
	/* the frame with the last part of the inputs does not come back */
	f.at_ns = ktime_get_ns();
	f.arg = 6;
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 0, 1)), v + 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 1);
	cyc_run(c, 2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(cyc_pd(c, 0, 1)), v + 4);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* Domains with frames of their own are not joined with their neighbours. */
static void image_own_frame(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=27\nrepeat 4 slave s io in=64 out=64\n", 4);
	struct ec_ioc_domain_options o = { .domain = 1, .options = EC_DOMAIN_OPT_OWN_FRAME };
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	for (i = 0; i < 4; i++)
		cyc_map_all(c, i, 1, cyc_domain(c));
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OPTIONS, &o), 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, bus_plain_wire(b)->frames, 3u);
	KUNIT_EXPECT_EQ(test, bus_last_wire(b)->frames, 3u);
	KUNIT_EXPECT_EQ(test, bus_last_wire(b)->ns, (84 + 84 + 96) * 80u);
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_EQ(test, cyc_state(c, i)->wc_state, 2);
}

/* A domain of one SyncManager that fills a datagram to the last byte. */
static void image_full_datagram(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave s io in=0 out=11888\n", 1);
	struct ec_cyc_dgram *d;
	struct cyc *c;
	u32 k;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	d = bus_dgrams(b);
	KUNIT_EXPECT_EQ(test, bus_n_dgrams(b), 1u);
	KUNIT_EXPECT_EQ(test, d->len, EC_DGRAM_DATA_MAX);
	KUNIT_EXPECT_EQ(test, d->cmd, EC_CMD_LWR);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	for (k = 0; k < CHANNELS; k++)
		put_unaligned_le32(k * 0x01000193, cyc_pd(c, 0, 0) + 4 * k);
	cyc_run(c, 5);
	for (k = 0; k < CHANNELS; k++)
		KUNIT_EXPECT_EQ(test, (u32)ec_app_channel(bus_app(b, "s"), EC_APP_OUT, k),
				k * 0x01000193);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* Entries of one bit: each has its place, and nothing beside it moves. */
static void image_bits(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave o EL2008\nslave i EL1008\n"
			       "connect o.6 -> i.3\n", 3);
	u32 cfg[2], offset[2], k, n;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	for (n = 0; n < 2; n++) {
		cfg[n] = cyc_config(c, 1 + n);
		for (k = 0; k < 8; k++) {
			struct ec_ioc_reg_entry r = {
				.config = cfg[n], .entry_index = (n ? 0x6000 : 0x7000) + 0x10 * k,
				.subindex = 1,
			};

			KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &r), 0, "%s",
					    b->app.reason);
			KUNIT_EXPECT_EQ(test, r.bit, k);
			if (k)
				KUNIT_EXPECT_EQ(test, r.offset, offset[n]);
			offset[n] = r.offset;
		}
	}
	KUNIT_EXPECT_EQ(test, offset[1], offset[0] + 1);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	for (k = 0; k < 8; k++) {
		cyc_data(c, 0)[offset[0]] = 1 << k;
		cyc_run(c, 5);
		for (n = 0; n < 8; n++)
			KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "o"), EC_APP_OUT, n),
					(s64)(n == k));
		KUNIT_EXPECT_EQ(test, cyc_data(c, 0)[offset[1]], k == 5 ? 1 << 2 : 0);
	}
}

/* every fourth cycle the second domain, every fifth the third */
static void by_rate(struct cyc *c)
{
	u64 all = BIT_ULL(0);

	if (c->cycles % 4 == 0)
		all |= BIT_ULL(1);
	if (c->cycles % 5 == 0)
		all |= BIT_ULL(2);
	c->queued = all;
	/* in its own cycles a domain's outputs change */
	put_unaligned_le32(c->cycles, cyc_pd(c, 0, 0));
	put_unaligned_le32(c->cycles, cyc_pd(c, 1, 0));
	put_unaligned_le32(c->cycles, cyc_pd(c, 2, 0));
}

static void image_rates(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=24\nrepeat 3 slave s io in=512 out=512\n"
			       "connect s1.1 -> s1.1\nconnect s2.1 -> s2.1\n"
			       "connect s3.1 -> s3.1\n", 3);
	static const u32 rate[3] = { 1, 4, 5 };
	struct cyc *c;
	u32 i, v;

	bus_idle(b);
	c = cyc_new(b, 1000);
	for (i = 0; i < 3; i++)
		cyc_map_all(c, i, 1, cyc_domain(c));
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	c->each = by_rate;
	cyc_run(c, 100);
	c->incomplete = 0;
	cyc_run(c, 1000);
	/* a domain that is not sent keeps its last verdict */
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	for (i = 0; i < 3; i++) {
		v = ec_app_channel(bus_app(b, i ? i == 1 ? "s2" : "s3" : "s1"), EC_APP_OUT, 0) &
		    0xff;
		/* channels of 8 bits; the slave has what its last cycle sent */
		KUNIT_EXPECT_EQ(test, v, (u8)((c->cycles - 1) / rate[i] * rate[i]));
		KUNIT_EXPECT_LE(test, (u8)(c->cycles - *cyc_pd(c, i, 1)), 3 * rate[i]);
		KUNIT_EXPECT_EQ(test, cyc_state(c, i)->wc_state, 2);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* Sixty-four domains are all the queue mask has bits for. */
static void image_too_many_domains(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave x EL1859\n", 2);
	struct ec_ioc_create_domain d = { 0 };
	struct cyc *c = cyc_new(b, 1000);
	u32 i;

	for (i = 0; i < EC_MAX_DOMAINS; i++)
		cyc_domain(c);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CREATE_DOMAIN, &d), -ENOSPC);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, "64"), "%s", b->app.reason);
	/* what is there works, the last one too */
	cyc_map_all(c, 1, 1, EC_MAX_DOMAINS - 1);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_state(c, EC_MAX_DOMAINS - 1)->wc_state, 2);
}

/* a bus whose process data are too many in one way or the other */
static struct cyc *too_much(struct kunit *test, u32 slaves, u32 bits, bool lrw, u32 domains)
{
	char text[80];
	struct bus *b;
	struct cyc *c;
	u32 i;

	snprintf(text, sizeof(text), "repeat %u slave s io in=%u out=%u\n", slaves, bits, bits);
	b = bus_new(test, text);
	for (i = 0; i < slaves && !lrw; i++) {
		struct ec_esc *esc = bus_esc(b, i);

		esc->cfg.features |= EC_FEAT_NO_LRW;
		put_unaligned_le16(esc->cfg.features, esc->mem + EC_REG_FEATURES);
	}
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, slaves, EC_AL_PREOP, 5000), ~0ull);
	c = cyc_new(b, 1000);
	for (i = 0; i < domains; i++)
		cyc_domain(c);
	for (i = 0; i < slaves; i++)
		cyc_map_all(c, i, 1, i % domains);
	return c;
}

/* Refused with the reason; the bus is as before and the next one may try. */
static void refused(struct kunit *test, struct cyc *c, const char *why)
{
	struct bus *b = c->b;
	struct ec_ioc_activate a = { 0 };

	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EOVERFLOW);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason, why), "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), EC_ACCESS_DIRECT);
	KUNIT_EXPECT_EQ(test, ec_ioc_receive(&b->app), -EPERM);
	cyc_release(c);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
}

/* 65 frames of one SyncManager each; 64 are possible */
static void image_too_many_frames(struct kunit *test)
{
	refused(test, too_much(test, 33, 8000, true, 1), "64 frames");
}

static void image_many_frames(struct kunit *test)
{
	struct cyc *c = too_much(test, 32, 8000, true, 1);

	c->period_ns = 10 * NSEC_PER_MSEC;
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, bus_plain_wire(c->b)->frames, (u32)EC_MAX_CYCLE_FRAMES);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 60000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

static void image_too_many_bytes(struct kunit *test)
{
	refused(test, too_much(test, 150, 8000, true, 2), "262144 bytes");
}

/* Every length and place: all of it, and nothing beside it. */
static void image_copy(struct kunit *test)
{
	u8 from[96], to[96];
	u32 i, len, at;

	for (i = 0; i < sizeof(from); i++)
		from[i] = i + 1;
	for (len = 0; len <= 70; len++)
		for (at = 0; at < 8; at++) {
			u32 wrong = 0;

			memset(to, 0, sizeof(to));
			ec_bytes_copy(to + 8 + at, from + at, len);
			for (i = 0; i < sizeof(to); i++)
				wrong += to[i] != (i >= 8 + at && i < 8 + at + len ? i - 7 : 0);
			KUNIT_EXPECT_EQ_MSG(test, wrong, 0u, "%u bytes at %u", len, at);
		}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(image_copy),
	KUNIT_CASE(image_several_datagrams),
	KUNIT_CASE(image_16k_apart),
	KUNIT_CASE(image_16k_overlap),
	KUNIT_CASE(image_cut),
	KUNIT_CASE(image_own_frame),
	KUNIT_CASE(image_full_datagram),
	KUNIT_CASE(image_bits),
	KUNIT_CASE(image_rates),
	KUNIT_CASE(image_too_many_domains),
	KUNIT_CASE(image_too_many_frames),
	KUNIT_CASE(image_many_frames),
	KUNIT_CASE(image_too_many_bytes),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_image",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
