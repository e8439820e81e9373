// SPDX-License-Identifier: GPL-2.0-only
/* VoE: messages sent, answered and sent unasked; beside the cycle, and beside CoE. */
#include "req.h"
#include "devices/sim/app.h"
#include "master/mailbox/coe.h"
#include "master/boundary/ioctl.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/voe.h"
#include "master/wire/voe.h"

#define TYPE	0x4321	/* of the answers of slave 0 */
#define VENDOR	0xec51

static const char text[] =
	"segment seed=8 response=500us transition=200us\n"
	"slave a drive mbox=64 serial=11 voe=0x4321\nslave b drive serial=12\n";

#define WITHOUT	1	/* slave without VoE */
#define ABSENT	2	/* configuration without slave */

static int put(struct ec_slave *s, const char *data, u32 size)
{
	struct ec_voe_hdr h = { .vendor = VENDOR, .type = 7 };

	return ec_voe_write(&s->mbox, &h, data, size, NULL);
}

static int get(struct ec_slave *s, struct ec_voe_hdr *h, u8 *data, u32 cap, u32 ms)
{
	struct ec_mbox_limit limit = { .timeout_ms = ms };
	size_t got;
	int ret = ec_voe_read(&s->mbox, false, h, data, cap, &got, &limit);

	return ret ?: got;
}

static void unasked(struct bus *b, u16 type, u16 size)
{
	struct ec_app_voe v = { .hdr = { .vendor = 5, .type = type }, .size = size };

	ec_app_voe_send(bus_app(b, "a"), &v, ktime_get_ns());
}

static struct bus *bus_idle_up(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);

	bus_idle(b);
	return b;
}

static void voe_echo(struct kunit *test)
{
	struct bus *b = bus_idle_up(test);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_voe_hdr h;
	u8 data[64], out[52];
	u32 i;

	KUNIT_EXPECT_EQ(test, put(s, "hello", 5), 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), 5);
	KUNIT_EXPECT_MEMEQ(test, data, "hello", 5);
	KUNIT_EXPECT_EQ(test, h.vendor, VENDOR);
	KUNIT_EXPECT_EQ(test, h.type, TYPE);
	/* nothing but the header, and as much as there is room for: 64 - 6 - 6 */
	KUNIT_EXPECT_EQ(test, put(s, NULL, 0), 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), 0);
	for (i = 0; i < sizeof(out); i++)
		out[i] = i * 3;
	KUNIT_EXPECT_EQ(test, put(s, out, sizeof(out)), 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), (int)sizeof(out));
	KUNIT_EXPECT_MEMEQ(test, data, out, sizeof(out));
	KUNIT_EXPECT_EQ(test, put(s, out, sizeof(out) + 1), -EMSGSIZE);
	/* larger than the room for it: gone */
	KUNIT_EXPECT_EQ(test, put(s, "hello", 5), 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, 4, 0), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), -ETIMEDOUT);
}

static void voe_errors(struct kunit *test)
{
	struct bus *b = bus_idle_up(test);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_voe_hdr h;
	u8 data[64];
	u64 t0;

	KUNIT_EXPECT_EQ(test, put(bus_slave(b, WITHOUT), "x", 1), -EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, get(bus_slave(b, WITHOUT), &h, data, 64, 0), -EPROTONOSUPPORT);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 500 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 505 * NSEC_PER_MSEC);
	/* its application hangs: the first message fits in, the second does not */
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, put(s, "a", 1), 0);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, put(s, "b", 1), -ETIMEDOUT);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 505 * NSEC_PER_MSEC);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), 1);
	KUNIT_EXPECT_EQ(test, data[0], 'a');
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_SHORT, 0);
	KUNIT_EXPECT_EQ(test, put(s, "a", 1), 0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), -EBADMSG);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
	bus_request(b, 0, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_INIT, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, put(s, "a", 1), -EAGAIN);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 0), -EAGAIN);
}

/* Each frame of a message and its answer is lost in turn: whole or nothing, never twice. */
static void voe_lost_frames(struct kunit *test)
{
	struct bus *b = bus_idle_up(test);
	struct ec_slave *s = bus_slave(b, 0);
	u32 n, back, lost = 0;
	struct ec_voe_hdr h;
	u8 data[64];
	int ret;

	for (n = 1; n <= 4; n++) {
		for (back = 0; back < 2; back++) {
			struct ec_sim_fault f = {
				.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1,
				.arg = n, .value = back,
			};

			KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
			KUNIT_EXPECT_EQ(test, put(s, "hello", 5), 0);
			ret = get(s, &h, data, sizeof(data), 200);
			if (ret == 5)
				KUNIT_EXPECT_MEMEQ(test, data, "hello", 5);
			else
				KUNIT_EXPECT_EQ(test, ret, -ETIMEDOUT);
			lost += ret != 5;
			KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), -ETIMEDOUT);
			ec_sim_clear_faults(b->sim);
		}
	}
	/* only a message that never arrived has no answer */
	KUNIT_EXPECT_LE(test, lost, 1u);
	KUNIT_EXPECT_GE(test, bus_lost(b), 6ull);
}

/* What comes while CoE uses the mailbox is kept, in order; the oldest go first. */
static void voe_unasked(struct kunit *test)
{
	struct bus *b = bus_idle_up(test);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_voe_hdr h;
	u8 data[64], v[4];
	u32 abort, i;
	size_t got;

	/* nobody wants them */
	unasked(b, 1, 3);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x1018, 4, false, v, 4, &got, &abort, NULL),
			0);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), -ETIMEDOUT);
	ec_mbox_keep_voe(&s->mbox, true);
	for (i = 0; i < EC_MBOX_KEPT + 2; i++) {
		unasked(b, i, i);
		KUNIT_EXPECT_EQ(test,
				ec_coe_upload(&s->mbox, 0x1018, 4, false, v, 4, &got, &abort, NULL),
				0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(v), 11);
	}
	for (i = 2; i < EC_MBOX_KEPT + 2; i++) {
		KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), i);
		KUNIT_EXPECT_EQ(test, h.type, i);
		KUNIT_EXPECT_EQ(test, h.vendor, 5);
		KUNIT_EXPECT_EQ(test, data[i - 1], i - 1);
	}
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), -ETIMEDOUT);
	unasked(b, 1, 3);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x1018, 4, false, v, 4, &got, &abort, NULL),
			0);
	ec_mbox_keep_voe(&s->mbox, false);
	KUNIT_EXPECT_EQ(test, get(s, &h, data, sizeof(data), 20), -ETIMEDOUT);
}

static struct cyc *prepare(struct kunit *test)
{
	struct ec_ioc_slave_config sc = { .position = 7, .vendor_id = 1, .product_code = 2 };
	struct bus *b = bus_idle_up(test);
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_ASSERT_EQ(test, sc.index, ABSENT);
	return c;
}

static void go(struct cyc *c)
{
	u32 i;

	cyc_activate(c);
	for (i = 0; i < 5000 && (bus_slave(c->b, 0)->al.status != EC_AL_OP ||
				 bus_slave(c->b, 1)->al.status != EC_AL_OP); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_EQ(c->b->test, bus_slave(c->b, 0)->al.status, EC_AL_OP);
}

static void write_begin(struct cyc *c, u32 i, const char *data, u32 size)
{
	memcpy(req_data(c, i), data, size);
	req_rec(c, i)->vendor_id = VENDOR;
	req_begin(c, i, 7, 0, EC_REQUEST_OP_WRITE, size);
}

#define begin_read(c, i)	req_begin(c, i, 0, 0, EC_REQUEST_OP_READ, 0)
#define begin_read_now(c, i)	req_begin(c, i, 0, 0, EC_REQUEST_OP_READ_NOW, 0)

static void voe_handlers(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 in = req_add(c, 0, EC_REQUEST_VOE, 58), out = req_add(c, 0, EC_REQUEST_VOE, 58);
	u32 sdo = req_add(c, 0, EC_REQUEST_SDO, 4);
	u64 t0;

	go(c);
	c->incomplete = 0;
	/* one waits, another writes, an SDO comes in between: none holds up the others */
	begin_read(c, in);
	cyc_run(c, 20);
	KUNIT_EXPECT_FALSE(test, req_over(c, in));
	KUNIT_EXPECT_EQ(test, req_do(c, sdo, 0x1018, 4, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, sdo)), 11);
	KUNIT_EXPECT_FALSE(test, req_over(c, in));
	write_begin(c, out, "hello", 5);
	KUNIT_EXPECT_EQ(test, req_end(c, out, 100), 0);
	KUNIT_EXPECT_EQ(test, req_end(c, in, 100), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, in)->got, 5);
	KUNIT_EXPECT_MEMEQ(test, req_data(c, in), "hello", 5);
	KUNIT_EXPECT_EQ(test, req_rec(c, in)->got_vendor_id, VENDOR);
	KUNIT_EXPECT_EQ(test, req_rec(c, in)->got_type, TYPE);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	/* nothing comes: 500 ms */
	t0 = ktime_get_ns();
	begin_read(c, in);
	KUNIT_EXPECT_EQ(test, req_end(c, in, 2000), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 500 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 510 * NSEC_PER_MSEC);
	/* one that came while nobody read */
	unasked(c->b, 9, 4);
	KUNIT_EXPECT_EQ(test, req_do(c, sdo, 0x1018, 4, EC_REQUEST_OP_READ, 0), 0);
	begin_read(c, in);
	KUNIT_EXPECT_EQ(test, req_end(c, in, 100), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, in)->got_type, 9);
	KUNIT_EXPECT_EQ(test, req_rec(c, in)->got, 4);
}

/* Without a look: what is there, or an error at once. */
static void voe_read_now(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 v = req_add(c, 0, EC_REQUEST_VOE, 58);
	u64 t0;

	go(c);
	t0 = ktime_get_ns();
	begin_read_now(c, v);
	KUNIT_EXPECT_EQ(test, req_end(c, v, 1000), -ENOMSG);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 10 * NSEC_PER_MSEC);
	write_begin(c, v, "abc", 3);
	KUNIT_EXPECT_EQ(test, req_end(c, v, 100), 0);
	cyc_run(c, 5);
	begin_read_now(c, v);
	KUNIT_EXPECT_EQ(test, req_end(c, v, 100), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, v)->got, 3);
	KUNIT_EXPECT_MEMEQ(test, req_data(c, v), "abc", 3);
	KUNIT_EXPECT_EQ(test, req_rec(c, v)->got_type, TYPE);
}

/* Errors at once where there is nobody to talk to; unknown operations. */
static void voe_message_without_handler(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 v = req_add(c, 0, EC_REQUEST_VOE, 4), n = req_add(c, WITHOUT, EC_REQUEST_VOE, 4);
	u32 a = req_add(c, ABSENT, EC_REQUEST_VOE, 4);

	go(c);
	begin_read(c, a);
	KUNIT_EXPECT_EQ(test, req_end(c, a, 20), -ENOTCONN);
	write_begin(c, a, "abc", 3);
	KUNIT_EXPECT_EQ(test, req_end(c, a, 20), -ENOTCONN);
	begin_read(c, n);
	KUNIT_EXPECT_EQ(test, req_end(c, n, 20), -EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_READWRITE, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_WRITE, 5), -EINVAL);
	req_rec(c, v)->flags = EC_SDO_FLAG_COMPLETE;
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_WRITE, 0), -EOPNOTSUPP);
	req_rec(c, v)->flags = 0;
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_WRITE, 0), 0);
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, v)->got, 0);
	unasked(c->b, 9, 5);
	KUNIT_EXPECT_EQ(test, req_do(c, v, 0, 0, EC_REQUEST_OP_READ, 0), -ENOBUFS);
	/* a slave on its way through INIT is waited for, not for long */
	bus_fault(c->b, EC_SIM_FAULT_REFUSE_AL, 0, 0, EC_AL_PREOP, 0x1d);
	bus_request(c->b, 0, EC_AL_INIT);
	cyc_run(c, 200);
	begin_read(c, v);
	KUNIT_EXPECT_NE(test, req_end(c, v, 600), 1);
	KUNIT_EXPECT_LT(test, req_rec(c, v)->result, 0);
}

/* A read that waits ends with its session; what was kept is gone. */
static void voe_ended(struct kunit *test)
{
	struct cyc *c = prepare(test);
	struct bus *b = c->b;
	u32 v = req_add(c, 0, EC_REQUEST_VOE, 58), i;
	u64 t0;

	go(c);
	begin_read(c, v);
	cyc_run(c, 20);
	KUNIT_EXPECT_FALSE(test, req_over(c, v));
	t0 = ktime_get_ns();
	bus_end(b);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 50 * NSEC_PER_MSEC);
	KUNIT_EXPECT_FALSE(test, bus_mbox(b, 0)->desk.keep_voe);
	for (i = 0; i < 100; i++)
		usleep_range(100, 101);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	unasked(b, 9, 4);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	v = req_add(c, 0, EC_REQUEST_VOE, 58);
	go(c);
	write_begin(c, v, "abc", 3);
	KUNIT_EXPECT_EQ(test, req_end(c, v, 100), 0);
	begin_read(c, v);
	KUNIT_EXPECT_EQ(test, req_end(c, v, 100), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, v)->got_type, TYPE);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(voe_echo),
	KUNIT_CASE(voe_errors),
	KUNIT_CASE(voe_lost_frames),
	KUNIT_CASE(voe_unasked),
	KUNIT_CASE(voe_handlers),
	KUNIT_CASE(voe_read_now),
	KUNIT_CASE(voe_message_without_handler),
	KUNIT_CASE(voe_ended),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_voe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
