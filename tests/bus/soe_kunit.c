// SPDX-License-Identifier: GPL-2.0-only
/* SoE: reading and writing IDNs, at once, at startup and beside the cycle. */
#include <linux/kthread.h>
#include "req.h"
#include "devices/sim/app.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"

#define S(n)	(n)
#define P(n)	(0x8000 | (n))

static const char text[] =
	"segment seed=8 response=500us transition=200us\n"
	"slave a drive mbox=64 serial=11 soe=2\nslave b drive mbox=512 serial=12 soe=1\n"
	"slave c drive\n";

#define WITHOUT	2	/* slave without SoE */

static int get(struct ec_slave *s, u8 drive, u16 idn, u64 *value, u16 *error)
{
	u8 b[8] = { 0 };
	size_t got;
	int ret = ec_soe_read(&s->mbox, drive, idn, b, sizeof(b), &got, error, NULL);

	*value = get_unaligned_le64(b);
	return ret ?: got;
}

static int put(struct ec_slave *s, u8 drive, u16 idn, u64 value, size_t size, u16 *error)
{
	u8 b[8];

	put_unaligned_le64(value, b);
	return ec_soe_write(&s->mbox, drive, idn, b, size, error, NULL);
}

static void soe_values(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	u8 list[54] = { 50 };
	size_t got;
	u16 error;
	u64 v;
	u32 i;

	KUNIT_EXPECT_EQ(test, get(s, 0, S(91), &v, &error), 4);
	KUNIT_EXPECT_EQ(test, v, 3000ull);
	KUNIT_EXPECT_EQ(test, put(s, 1, S(91), 4000, 4, &error), 0);
	KUNIT_EXPECT_EQ(test, get(s, 0, S(91), &v, &error), 4);
	KUNIT_EXPECT_EQ(test, v, 3000ull);
	KUNIT_EXPECT_EQ(test, get(s, 1, S(91), &v, &error), 4);
	KUNIT_EXPECT_EQ(test, v, 4000ull);
	KUNIT_EXPECT_EQ(test, error, 0);
	KUNIT_EXPECT_EQ(test, get(s, 1, P(0xa1), &v, &error), 8);
	KUNIT_EXPECT_EQ(test, v, 0x1122334455667788ull);
	/* a list as large as a message: 64 - 10 bytes */
	for (i = 4; i < sizeof(list); i++)
		list[i] = i;
	KUNIT_EXPECT_EQ(test, ec_soe_write(&s->mbox, 0, P(0xa0), list, sizeof(list), &error, NULL),
			0);
	memset(list, 0, sizeof(list));
	KUNIT_EXPECT_EQ(test,
			ec_soe_read(&s->mbox, 0, P(0xa0), list, sizeof(list), &got, &error, NULL),
			0);
	KUNIT_EXPECT_EQ(test, got, sizeof(list));
	for (i = 4; i < sizeof(list); i++)
		KUNIT_ASSERT_EQ(test, list[i], i);
}

static void soe_errors(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	u8 buf[8];
	size_t got;
	u16 error;
	u64 v;

	KUNIT_EXPECT_EQ(test, get(s, 0, S(92), &v, &error), -EIO);
	KUNIT_EXPECT_EQ(test, error, EC_SOE_ERR_NO_IDN);
	KUNIT_EXPECT_EQ(test, get(s, 2, S(91), &v, &error), -EIO);
	KUNIT_EXPECT_EQ(test, error, EC_SOE_ERR_DRIVE);
	KUNIT_EXPECT_EQ(test, get(s, 8, S(91), &v, &error), -EINVAL);
	KUNIT_EXPECT_EQ(test, error, 0);
	KUNIT_EXPECT_EQ(test, put(s, 0, S(30), 1, 4, &error), -EIO);
	KUNIT_EXPECT_EQ(test, error, EC_SOE_ERR_READ_ONLY);
	KUNIT_EXPECT_EQ(test, put(s, 0, S(91), 9999, 4, &error), -EIO);
	KUNIT_EXPECT_EQ(test, error, EC_SOE_ERR_ABOVE);
	KUNIT_EXPECT_EQ(test, put(s, 0, S(91), 99, 8, &error), -EIO);
	KUNIT_EXPECT_EQ(test, error, EC_SOE_ERR_LONG);
	KUNIT_EXPECT_EQ(test, ec_soe_read(&s->mbox, 0, S(91), buf, 3, &got, &error, NULL),
			-ENOBUFS);
	KUNIT_EXPECT_EQ(test, got, 0ul);
	KUNIT_EXPECT_EQ(test, get(bus_slave(b, WITHOUT), 0, S(91), &v, &error), -EPROTONOSUPPORT);
	/* and the mailbox works on */
	KUNIT_EXPECT_EQ(test, get(s, 0, S(91), &v, &error), 4);
	bus_request(b, 0, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_INIT, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, get(s, 0, S(91), &v, &error), -EAGAIN);
}

static void soe_silence(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_mbox_limit limit = { .timeout_ms = 200 };
	size_t got;
	u16 error;
	u8 buf[8];
	u64 t0, v;

	bus_idle(b);
	t0 = ktime_get_ns();
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ec_soe_read(&s->mbox, 0, S(91), buf, 8, &got, &error, &limit),
			-ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 200 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 210 * NSEC_PER_MSEC);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, get(s, 0, S(47), &v, &error), -ETIMEDOUT);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 5010 * NSEC_PER_MSEC);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	usleep_range(10000, 10001);
	/* the late answer to S-0-0091 is none to S-0-0015 */
	KUNIT_EXPECT_EQ(test, get(s, 0, S(15), &v, &error), 2);
	KUNIT_EXPECT_EQ(test, v, 7ull);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_TYPE, 0);
	KUNIT_EXPECT_EQ(test, ec_soe_read(&s->mbox, 0, S(91), buf, 8, &got, &error, &limit),
			-ETIMEDOUT);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_SHORT, 0);
	KUNIT_EXPECT_EQ(test, ec_soe_read(&s->mbox, 0, S(91), buf, 8, &got, &error, &limit),
			-EBADMSG);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
	KUNIT_EXPECT_EQ(test, get(s, 0, S(91), &v, &error), 4);
}

/* Each frame of an exchange is lost in turn: the value, or a clean end, and then the value. */
static void soe_lost_frames(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	u32 n, back, failed = 0;
	u16 error;
	u64 v;
	int ret;

	bus_idle(b);
	for (n = 1; n <= 6; n++) {
		for (back = 0; back < 2; back++) {
			struct ec_sim_fault f = {
				.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1,
				.arg = n, .value = back,
			};

			KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
			ret = put(s, 0, S(47), n, 4, &error);
			if (ret != -ETIMEDOUT)
				KUNIT_EXPECT_EQ_MSG(test, ret, 0, "frame %u, back %u", n, back);
			failed += !!ret;
			ret = get(s, 0, S(47), &v, &error);
			if (ret == -ETIMEDOUT)
				ret = get(s, 0, S(47), &v, &error);
			KUNIT_EXPECT_EQ(test, ret, 4);
			ec_sim_clear_faults(b->sim);
			usleep_range(50000, 50001);
		}
	}
	/* only a request that never arrived has no answer */
	KUNIT_EXPECT_LE(test, failed, 2u);
	KUNIT_EXPECT_GE(test, bus_lost(b), 8ull);
}

/* tools that use the same mailbox at the same time */
struct other {
	struct ec_slave *s;
	bool soe;
	u32 id;
	u32 done;
	u32 wrong;
	struct completion end;
};

static int use(void *arg)
{
	struct other *o = arg;
	u32 i, abort, v = 0;
	u16 error;
	size_t got;
	u64 value;

	for (i = 0; i < 50; i++) {
		if (o->soe)
			o->wrong += get(o->s, 0, S(91), &value, &error) != 4 || value != 3000;
		else
			o->wrong += ec_coe_upload(&o->s->mbox, 0x1018, 4, false, (u8 *)&v, 4, &got,
						  &abort, NULL) || v != 11;
		o->done++;
	}
	complete(&o->end);
	return 0;
}

static void soe_and_coe(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	static struct other others[4];
	u32 i;

	for (i = 0; i < 4; i++) {
		others[i] = (struct other){ .s = bus_slave(b, 0), .soe = i & 1 };
		init_completion(&others[i].end);
		KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(use, &others[i], "other%u", i)));
	}
	for (i = 0; i < 4; i++) {
		wait_for_completion(&others[i].end);
		KUNIT_EXPECT_EQ(test, others[i].done, 50u);
		KUNIT_EXPECT_EQ(test, others[i].wrong, 0u);
	}
}

static struct ec_config *config(struct cyc *c, u32 i)
{
	return bus_config(c->b, i);
}

static struct cyc *prepare(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 3, 0);
	return c;
}

static int startup(struct cyc *c, u16 idn, u8 state, u16 value)
{
	u8 v[2];
	int ret;

	put_unaligned_le16(value, v);
	bus_lock(c->b);
	ret = ec_config_idn_add(config(c, 0), 0, idn, state, v, 2);
	bus_unlock(c->b);
	return ret;
}

/* P-0-0170 cannot be written in PREOP, S-0-0015 only there. */
static void soe_startup(struct kunit *test)
{
	struct cyc *c = prepare(test);
	struct ec_slave *s = bus_slave(c->b, 0);
	u8 list[200];
	u16 error;
	u64 v;

	KUNIT_ASSERT_EQ(test, startup(c, P(0x96), EC_AL_PREOP, 1), 0);
	KUNIT_ASSERT_EQ(test, startup(c, S(15), EC_AL_PREOP, 4), 0);
	KUNIT_ASSERT_EQ(test, startup(c, P(0xaa), EC_AL_SAFEOP, 9), 0);
	KUNIT_ASSERT_EQ(test, startup(c, P(0x96), EC_AL_PREOP, 2), 0);
	/* a list in four fragments */
	memset(list, 5, sizeof(list));
	put_unaligned_le16(sizeof(list) - 4, list);
	bus_lock(c->b);
	KUNIT_EXPECT_EQ(test, ec_config_idn_add(config(c, 0), 1, P(0xa0), EC_AL_PREOP, list,
						sizeof(list)), 0);
	bus_unlock(c->b);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_app(c->b, "a")->soe.writes, 5u);
	cyc_release(c);
	KUNIT_EXPECT_EQ(test, get(s, 0, S(15), &v, &error), 2);
	KUNIT_EXPECT_EQ(test, v, 4ull);
	KUNIT_EXPECT_EQ(test, get(s, 0, P(0xaa), &v, &error), 2);
	KUNIT_EXPECT_EQ(test, v, 9ull);
	/* in the order of the calls */
	KUNIT_EXPECT_EQ(test, get(s, 0, P(0x96), &v, &error), 2);
	KUNIT_EXPECT_EQ(test, v, 2ull);
}

/* A refused one keeps the slave where it is, and says why; the others go on. */
static void soe_startup_refused(struct kunit *test)
{
	static const struct {
		u16 idn;
		u8 state;
		u8 stays;
		const char *why;
	} in[] = {
		{ S(30), EC_AL_PREOP, EC_AL_PREOP,
		  "startup IDN S-0-0030 of drive 0 (2 byte(s)) failed: SoE error 0x7004: the value can only be read" },
		{ P(0x96) + 0x1001, EC_AL_SAFEOP, EC_AL_SAFEOP,
		  "startup IDN P-1-0151 of drive 0 (2 byte(s)) failed: SoE error 0x1001: there is no such IDN" },
	};
	struct cyc *c = prepare(test);
	u32 i, k;

	for (i = 0; i < ARRAY_SIZE(in); i++) {
		if (i) {
			bus_idle(c->b);
			c = cyc_new(c->b, 1000);
			cyc_domain(c);
			cyc_map_all(c, 0, 3, 0);
		}
		KUNIT_ASSERT_EQ(test, startup(c, in[i].idn, in[i].state, 1), 0);
		cyc_activate(c);
		for (k = 0; k < 3000 && bus_slave(c->b, 1)->al.status != EC_AL_OP; k++)
			cyc_run(c, 1);
		cyc_run(c, 500);
		KUNIT_EXPECT_EQ(test, bus_slave(c->b, 1)->al.status, EC_AL_OP);
		KUNIT_EXPECT_EQ(test, bus_slave(c->b, 0)->al.status, in[i].stays);
		KUNIT_EXPECT_EQ(test, bus_slave(c->b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
		KUNIT_EXPECT_STREQ(test, bus_slave(c->b, 0)->note.why, in[i].why);
		cyc_release(c);
	}
}

static void soe_requests(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_SOE, 8), b = req_add(c, 1, EC_REQUEST_SOE, 4);
	u32 n = req_add(c, WITHOUT, EC_REQUEST_SOE, 4), sdo = req_add(c, 0, EC_REQUEST_SDO, 4);
	u32 list = req_add(c, 0, EC_REQUEST_SOE, 2004);
	u64 t0;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	c->incomplete = 0;
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 1, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 3000);
	put_unaligned_le32(555, req_data(c, a));
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 1, EC_REQUEST_OP_WRITE, 4), 0);
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 1, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 555);
	/* two slaves, and an SDO of one of them, at once */
	req_begin(c, a, S(91), 0, EC_REQUEST_OP_READ, 0);
	req_begin(c, sdo, 0x1018, 4, EC_REQUEST_OP_READ, 0);
	KUNIT_EXPECT_EQ(test, req_do(c, b, S(91), 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_end(c, a, 100), 0);
	KUNIT_EXPECT_EQ(test, req_end(c, sdo, 100), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, a)), 3000);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, sdo)), 11);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	/* a list in fragments, beside the cycle */
	put_unaligned_le32(1996, req_data(c, list));
	memset(req_data(c, list) + 4, 7, 1996);
	KUNIT_EXPECT_EQ(test, req_do(c, list, P(0xa3), 0, EC_REQUEST_OP_WRITE, 2000), 0);
	memset(req_data(c, list), 0, 2000);
	KUNIT_EXPECT_EQ(test, req_do(c, list, P(0xa3), 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, list)->got, 2000);
	KUNIT_EXPECT_EQ(test, req_data(c, list)[1999], 7);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	/* errors, and what the slave says of them */
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(92), 0, EC_REQUEST_OP_READ, 0), -EIO);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, EC_SOE_ERR_NO_IDN);
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(15), 0, EC_REQUEST_OP_WRITE, 2), -EIO);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, EC_SOE_ERR_PROTECTED);
	KUNIT_EXPECT_EQ(test, req_do(c, b, P(0xa1), 0, EC_REQUEST_OP_READ, 0), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 8, EC_REQUEST_OP_READ, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 0, EC_REQUEST_OP_READWRITE, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, n, S(91), 0, EC_REQUEST_OP_READ, 0), -EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, req_do(c, a, S(91), 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->abort_code, 0);
	/* a mute slave holds up the end of the session no more than the others */
	bus_fault(c->b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	req_begin(c, a, S(91), 0, EC_REQUEST_OP_READ, 0);
	cyc_run(c, 5);
	t0 = ktime_get_ns();
	cyc_release(c);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 50 * NSEC_PER_MSEC);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(soe_values),
	KUNIT_CASE(soe_errors),
	KUNIT_CASE(soe_silence),
	KUNIT_CASE(soe_lost_frames),
	KUNIT_CASE(soe_and_coe),
	KUNIT_CASE(soe_startup),
	KUNIT_CASE(soe_startup_refused),
	KUNIT_CASE(soe_requests),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_soe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
