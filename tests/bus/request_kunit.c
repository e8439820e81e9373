// SPDX-License-Identifier: GPL-2.0-only
/* Requests beside the cycle: SDOs, registers; emergencies. */
#include "req.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"
#include "master/wire/coe.h"

#define SCRATCH		0x2000	/* 1000 bytes */
#define TYPES		0x2001	/* a record; 8: 4 bytes */

static const char text[] =
	"segment seed=8 response=500us transition=200us\n"
	"slave a drive mbox=64 serial=11\nslave b drive mbox=512 serial=12\n";

static struct ec_emerg_ring *ring(struct cyc *c, u32 config)
{
	return (struct ec_emerg_ring *)((u8 *)req_area(c) + req_area(c)->rings) + config;
}

static int download(struct cyc *c, u32 i, u16 index, u8 sub, const void *value, u32 size)
{
	memcpy(req_data(c, i), value, size);
	req_begin(c, i, index, sub, true, size);
	return req_end(c, i, 5000);
}

static int upload(struct cyc *c, u32 i, u16 index, u8 sub)
{
	req_begin(c, i, index, sub, false, 0);
	return req_end(c, i, 5000);
}

#define ABSENT	2	/* configuration without slave */

/* Configurations 0 and 1 are the slaves, ABSENT is another; not active. */
static struct cyc *prepare(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct ec_ioc_slave_config sc = { .position = 7, .vendor_id = 1, .product_code = 2 };
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_ASSERT_EQ(test, sc.index, ABSENT);
	return c;
}

static bool both_op(struct cyc *c)
{
	return bus_slave(c->b, 0)->al.status == EC_AL_OP &&
	       bus_slave(c->b, 1)->al.status == EC_AL_OP;
}

static void go(struct cyc *c)
{
	u32 i;

	cyc_activate(c);
	for (i = 0; i < 5000 && !both_op(c); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_TRUE(c->b->test, both_op(c));
}

static void req_sdo(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4), b = req_add(c, 1, EC_REQUEST_SDO, 1000), i;
	u8 value[1000];

	go(c);
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 11);
	KUNIT_EXPECT_EQ(test, upload(c, b, 0x1018, 4), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, b)), 12);
	for (i = 0; i < 1000; i++)
		value[i] = i * 7;
	KUNIT_EXPECT_EQ(test, download(c, b, SCRATCH, 0, value, 1000), 0);
	memset(req_data(c, b), 0, 1000);
	KUNIT_EXPECT_EQ(test, upload(c, b, SCRATCH, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, b)->got, 1000);
	KUNIT_EXPECT_MEMEQ(test, req_data(c, b), value, 1000);
	KUNIT_EXPECT_EQ(test, req_rec(c, b)->abort_code, 0);
	/* the cycle did not notice */
	KUNIT_EXPECT_TRUE(test, both_op(c));
	c->incomplete = 0;
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 1), 0);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
}

/* Slaves that wait, however many, hold up no request. */
static void req_beside_many(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4);

	go(c);
	bus_crowd(c->b);
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	bus_crowd_leaves(c->b);
}

/* abort, then restarts from ERROR and from SUCCESS */
static void req_abort_restart(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4), i;

	go(c);
	for (i = 0; i < 3; i++) {
		KUNIT_EXPECT_EQ(test, upload(c, a, 0x3fff, 0), -EIO);
		KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, EC_ABORT_NO_OBJECT);
		KUNIT_EXPECT_EQ(test, download(c, a, 0x1018, 1, "abcd", 4), -EIO);
		KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, EC_ABORT_READ_ONLY);
		KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
		KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, 0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 11);
		KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	}
}

/* One that is started again while BUSY runs once more, after the first. */
static void req_restart_busy(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4);

	go(c);
	req_begin(c, a, 0x1018, 4, false, 0);
	KUNIT_ASSERT_FALSE(test, req_over(c, a));
	req_begin(c, a, 0x1018, 1, false, 0);
	/* the second start may have been seen too early: told again, as with the next one */
	while (!req_over(c, a) && c->cycles < 20000) {
		c->flags = EC_SEND_FLAG_REQUESTS;
		cyc_run(c, 1);
	}
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->done, 2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), bus_slave(c->b, 0)->info.vendor);
}

/* The application of the slave says nothing: an error, the other slave goes on. */
static void req_mute(struct kunit *test)
{
	struct ec_ioc_sc_timeout reply = { .flags = EC_SC_TIMEOUT_REPLY, .timeout_ms = 1000 };
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4), a2 = req_add(c, 0, EC_REQUEST_SDO, 4);
	u32 b = req_add(c, 1, EC_REQUEST_SDO, 4);
	u64 t0;

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_TIMEOUT, &reply), 0);
	go(c);
	bus_fault(c->b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	t0 = ktime_get_ns();
	req_begin(c, a, 0x1018, 4, false, 0);
	req_rec(c, a2)->timeout_ms = 100;
	req_begin(c, a2, 0x1018, 4, false, 0);
	KUNIT_EXPECT_EQ(test, upload(c, b, 0x1018, 4), 0);
	KUNIT_EXPECT_FALSE(test, req_over(c, a));
	/* the second waits behind the first, but not longer than it may */
	KUNIT_EXPECT_EQ(test, req_end(c, a2, 500), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 100 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 150 * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, req_end(c, a, 3000), -ETIMEDOUT);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 1100 * NSEC_PER_MSEC);
	bus_fault(c->b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
}

static void req_absent(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 timed = req_add(c, ABSENT, EC_REQUEST_SDO, 4);
	u32 ever = req_add(c, ABSENT, EC_REQUEST_SDO, 4);
	u64 t0, ms;

	go(c);
	req_begin(c, ever, 0x1018, 4, false, 0);
	req_rec(c, timed)->timeout_ms = 300;
	t0 = ktime_get_ns();
	req_begin(c, timed, 0x1018, 4, false, 0);
	KUNIT_EXPECT_EQ(test, req_end(c, timed, 2000), -ETIMEDOUT);
	ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	KUNIT_EXPECT_GE(test, ms, 300ull);
	KUNIT_EXPECT_LE(test, ms, 330ull);
	KUNIT_EXPECT_EQ(test, req_end(c, ever, 3000), 1);
}

/* A request waits for a slave that is away; when it is back it is done. */
static void req_comes_back(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 b = req_add(c, 1, EC_REQUEST_SDO, 4), i;

	go(c);
	bus_fault(c->b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	for (i = 0; i < 2000 && bus_config(c->b, 1)->slave; i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_NULL(test, bus_config(c->b, 1)->slave);
	req_begin(c, b, 0x1018, 4, false, 0);
	KUNIT_EXPECT_EQ(test, req_end(c, b, 500), 1);
	bus_fault(c->b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, req_end(c, b, 5000), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, b)), 12);
}

/* Numbers in the record that cannot be. */
static void req_bounds(struct kunit *test)
{
	static const u32 sizes[] = { 0, 5, 4096, 0x7fffffff, ~0u };
	struct ec_ioc_sc_request big = { .kind = EC_REQUEST_SDO, .size = EC_MAX_SDO_SIZE + 1 };
	struct ec_ioc_sc_request kind = { .kind = 99 }, none = { .config = 3 };
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4), r = req_add(c, 0, EC_REQUEST_REG, 4), i;
	u32 guard = req_add(c, 1, EC_REQUEST_SDO, 8);

	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &big), -EINVAL);
	big.kind = EC_REQUEST_REG;
	big.size = EC_MAX_REG_SIZE + 1;
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &big), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &kind), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &none), -ENOENT);
	go(c);
	memset(req_data(c, guard), 0x55, 8);
	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		req_begin(c, a, TYPES, 8, true, sizes[i]);
		KUNIT_EXPECT_EQ(test, req_end(c, a, 1000), -EINVAL);
		req_begin(c, r, 0x1000, 0, true, sizes[i]);
		KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), -EINVAL);
		req_begin(c, r, 0, 0, false, sizes[i]);
		KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), -EINVAL);
	}
	/* an object larger than the room */
	KUNIT_EXPECT_EQ(test, upload(c, a, SCRATCH, 0), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 0);
	/* what the kernel has laid out is not read back */
	req_rec(c, a)->data = 0xfffffff0;
	req_begin(c, a, 0x1018, 4, false, 0);
	KUNIT_EXPECT_EQ(test, req_end(c, a, 1000), 0);
	for (i = 0; i < 8; i++)
		KUNIT_EXPECT_EQ(test, req_data(c, guard)[i], 0x55);
	KUNIT_EXPECT_EQ(test, upload(c, guard, 0x1018, 4), 0);
}

/* The application dies with a request BUSY; nobody waits, the next one works. */
static void req_killed(struct kunit *test)
{
	struct cyc *c = prepare(test);
	struct bus *b = c->b;
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4), n = req_add(c, ABSENT, EC_REQUEST_SDO, 4);
	u64 t0;

	go(c);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	req_begin(c, n, 0x1018, 4, false, 0);
	req_begin(c, a, 0x1018, 4, false, 0);
	cyc_run(c, 10);
	KUNIT_ASSERT_FALSE(test, req_over(c, a));
	t0 = ktime_get_ns();
	bus_end(b);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 100 * NSEC_PER_MSEC);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	a = req_add(c, 0, EC_REQUEST_SDO, 4);
	go(c);
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 11);
	/* and the master goes away with one BUSY */
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	req_begin(c, a, 0x1018, 4, false, 0);
}

/* How long until the mailbox of slave 0 is free, ms; at most 5000. */
static u64 until_free(struct bus *b)
{
	u64 t0 = ktime_get_ns();
	u32 i;

	for (i = 0; i < 50000 && ec_mbox_is_claimed(bus_mbox(b, 0), EC_MBOX_ALL); i++)
		usleep_range(100, 101);
	return div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
}

/* A transfer ends with its session: one nobody answers, and one that would take long. */
static void req_cancelled(struct kunit *test)
{
	struct cyc *c = prepare(test);
	struct bus *b = c->b;
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 1000);
	u8 value[1000] = { 0 };

	go(c);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	req_begin(c, a, 0x1018, 4, false, 0);
	cyc_run(c, 10);
	KUNIT_ASSERT_TRUE(test, ec_mbox_in_use(bus_mbox(b, 0)));
	bus_end(b);
	KUNIT_EXPECT_LE(test, until_free(b), 3ull);

	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	a = req_add(c, 0, EC_REQUEST_SDO, 1000);
	go(c);
	bus_app(b, "a")->response_ns = 100 * NSEC_PER_MSEC;	/* 18 segments */
	memcpy(req_data(c, a), value, 1000);
	req_begin(c, a, SCRATCH, 0, true, 1000);
	cyc_run(c, 250);
	KUNIT_ASSERT_TRUE(test, ec_mbox_is_claimed(bus_mbox(b, 0), BIT(EC_MBOX_COE)));
	bus_end(b);
	KUNIT_EXPECT_LE(test, until_free(b), 3ull);
}

static void req_complete_access(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 64);

	go(c);
	req_rec(c, a)->flags = EC_SDO_FLAG_COMPLETE;
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 18);
	KUNIT_EXPECT_EQ(test, req_data(c, a)[0], 4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a) + 14), 11);
	req_rec(c, a)->flags = 2;
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 0), -EOPNOTSUPP);
	req_rec(c, a)->flags = 0;
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 1);
}

static void req_registers(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 r = req_add(c, 1, EC_REQUEST_REG, 8), n = req_add(c, ABSENT, EC_REQUEST_REG, 8);

	go(c);
	req_begin(c, r, 0x0010, 0, false, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(req_data(c, r)), bus_slave(c->b, 1)->station);
	KUNIT_EXPECT_EQ(test, req_rec(c, r)->got, 2);
	put_unaligned_le16(0x1234, req_data(c, r));
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, true, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), 0);
	memset(req_data(c, r), 0, 8);
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, false, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, r)->got, 2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(req_data(c, r)), 0x1234);
	req_begin(c, n, EC_REG_WD_DIVIDER, 0, false, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, n, 1000), 1);
	/* what was there comes back, what was sent is there */
	put_unaligned_le16(0x5678, req_data(c, r));
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, EC_REQUEST_OP_READWRITE, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(req_data(c, r)), 0x1234);
	KUNIT_EXPECT_EQ(test, req_rec(c, r)->got, 2);
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, false, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(req_data(c, r)), 0x5678);
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, EC_REQUEST_OP_READ_NOW, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), -EINVAL);
	req_begin(c, r, EC_REG_WD_DIVIDER, 0, 200, 2);
	KUNIT_EXPECT_EQ(test, req_end(c, r, 1000), -EINVAL);
}

/* A slave that refused OP or a startup SDO can still be asked why. */
static void req_registers_of_failed_slave(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave c drive in=8 out=8\n"
			       "fault refuse a OP code=0x0027\n", 2);
	u8 value = 0;
	struct ec_ioc_sc_sdo sdo = {
		.config = 1, .index = 0x5FFF, .subindex = 1, .size = 1, .data = (uintptr_t)&value,
	};
	struct cyc *c;
	u32 r[2], i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	for (i = 0; i < 2; i++)
		r[i] = req_add(c, i, EC_REQUEST_REG, 8);
	cyc_activate(c);
	cyc_run(c, 2000);
	for (i = 0; i < 2; i++) {
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->note.error, EC_SLAVE_CONFIG_FAILED);
		req_begin(c, r[i], EC_REG_STATION, 0, false, 2);
		KUNIT_EXPECT_EQ(test, req_end(c, r[i], 1000), 0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(req_data(c, r[i])),
				bus_slave(b, i)->station);
		put_unaligned_le16(0x1234, req_data(c, r[i]));
		req_begin(c, r[i], EC_REG_WD_DIVIDER, 0, EC_REQUEST_OP_READWRITE, 2);
		KUNIT_EXPECT_EQ(test, req_end(c, r[i], 1000), 0);
	}
}

static void req_emergencies(struct kunit *test)
{
	static const u8 five[5] = { 1, 2, 3, 4, 5 };
	struct ec_ioc_sc_emerg e = { .config = 0, .count = 4 };
	struct ec_ioc_sc_emerg many = { .config = 0, .count = EC_MAX_EMERG + 1 };
	struct cyc *c = prepare(test);
	const u8 *first;
	u32 i;

	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_EMERG, &many), -ENOMEM);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_EMERG, &e), 0);
	go(c);
	/* nobody asks for anything, and still it comes, soon */
	ec_app_emergency(bus_app(c->b, "a"), 0x8110, 0x11, five, ktime_get_ns());
	cyc_run(c, 40);
	KUNIT_ASSERT_EQ(test, ring(c, 0)->head, 1);
	first = (u8 *)req_area(c) + ring(c, 0)->data;
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(first), 0x8110);
	KUNIT_EXPECT_EQ(test, first[2], 0x11);
	KUNIT_EXPECT_MEMEQ(test, first + 3, five, 5);
	for (i = 0; i < 5; i++) {
		ec_app_emergency(bus_app(c->b, "a"), 0x1000 + i, 0, five, ktime_get_ns());
		cyc_run(c, 40);
	}
	KUNIT_EXPECT_EQ(test, ring(c, 0)->head, 4);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->overruns, 2);
	ring(c, 0)->tail = 1;
	ec_app_emergency(bus_app(c->b, "a"), 0x2000, 0, five, ktime_get_ns());
	cyc_run(c, 40);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->head, 5);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(first), 0x2000);
	/* a wild tail costs the application its messages, nobody else anything */
	ring(c, 0)->tail = 0x80000000;
	ec_app_emergency(bus_app(c->b, "a"), 0x2000, 0, five, ktime_get_ns());
	cyc_run(c, 40);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->head, 5);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->overruns, 3);
	KUNIT_EXPECT_EQ(test, ring(c, 1)->head, 0);
}

/* One that another thread starts beside a send may miss the flag of that send. */
static void req_without_flag(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4);
	struct ec_request_record *r;
	u32 n;

	go(c);
	for (n = 1; n < 4; n++) {
		r = req_rec(c, a);
		r->index = 0x1018;
		r->subindex = 4;
		smp_store_release(&r->start, r->start + 1);
		atomic_inc((atomic_t *)&req_area(c)->starts);
		KUNIT_EXPECT_EQ(test, req_end(c, a, 200), 0);
		/* the usual way beside it: looked for once only */
		KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	}
}

/* Without room all are lost, but counted: those an SDO transfer meets. */
static void req_emergency_without_room(struct kunit *test)
{
	static const u8 five[5] = { 0 };
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SDO, 4);

	go(c);
	ec_app_emergency(bus_app(c->b, "a"), 0x8110, 0x11, five, ktime_get_ns());
	cyc_run(c, 40);
	KUNIT_EXPECT_EQ(test, upload(c, a, 0x1018, 4), 0);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->head, 0);
	KUNIT_EXPECT_EQ(test, ring(c, 0)->overruns, 1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(req_sdo),
	KUNIT_CASE(req_beside_many),
	KUNIT_CASE(req_abort_restart),
	KUNIT_CASE(req_restart_busy),
	KUNIT_CASE(req_mute),
	KUNIT_CASE(req_absent),
	KUNIT_CASE(req_comes_back),
	KUNIT_CASE(req_bounds),
	KUNIT_CASE(req_killed),
	KUNIT_CASE(req_cancelled),
	KUNIT_CASE(req_complete_access),
	KUNIT_CASE(req_registers),
	KUNIT_CASE(req_registers_of_failed_slave),
	KUNIT_CASE(req_emergencies),
	KUNIT_CASE(req_emergency_without_room),
	KUNIT_CASE(req_without_flag),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_request",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
