// SPDX-License-Identifier: GPL-2.0-only
/*
 * Slaves whose mailbox answers random bytes, or right messages with one wrong field: all
 * protocols, many seeds. Each call ends within its limits, and the slave works afterwards.
 */
#include "talk.h"
#include "devices/sim/app.h"
#include "master/mailbox/soe.h"
#include "master/mailbox/voe.h"
#include "master/wire/sdoinfo.h"
#include "master/wire/soe.h"
#include "master/wire/voe.h"

#define LIMIT_MS	20
#define CALL_MS		1000	/* no call takes longer: its messages, each with its limit */
#define SEEDS		40
#define ROUNDS		3

/* how the calls of a run ended, and how long the longest took */
struct hostile {
	struct bus *b;
	struct talk *t;
	u32 calls;
	u32 good;
	u64 longest_ns;
	u64 t0;
};

static void begin(struct hostile *x)
{
	x->t0 = ktime_get_ns();
}

static void ended(struct hostile *x, const char *what, int ret)
{
	u64 took = ktime_get_ns() - x->t0;

	x->calls++;
	x->good += !ret;
	x->longest_ns = max(x->longest_ns, took);
	KUNIT_EXPECT_LE_MSG(x->b->test, took, (u64)CALL_MS * NSEC_PER_MSEC, "%s: %d", what, ret);
	KUNIT_EXPECT_LE_MSG(x->b->test, ret, 0, "%s", what);
	KUNIT_EXPECT_LE_MSG(x->b->test, x->t->got, sizeof(x->t->data), "%s", what);
}

#define DO(x, call)							\
	do {								\
		begin(x);						\
		ended(x, #call, call);					\
	} while (0)

static void coe(struct hostile *x)
{
	static const u8 widths[] = { 0, 1, 1, 2, 4, 8, 1, 2, 4, 8 };	/* of 0x2001:01... */
	struct talk *t = x->t;
	u32 i;

	for (i = 1; i < ARRAY_SIZE(widths); i++) {
		DO(x, talk_upload(t, 0x2001, i, false));
		DO(x, talk_download(t, 0x2001, i, false, widths[i]));
	}
	DO(x, talk_upload(t, 0x1018, 0, true));
	DO(x, talk_upload(t, 0x1008, 0, false));
	DO(x, talk_upload(t, 0x2000, 0, false));
	DO(x, talk_download(t, 0x2000, 0, false, 1000));
	DO(x, talk_upload(t, 0x5555, 0, false));
	DO(x, talk_info(t, EC_SDOINFO_LIST_REQ, 1, 0));
	DO(x, talk_info(t, EC_SDOINFO_LIST_REQ, 0, 0));
	DO(x, talk_info(t, EC_SDOINFO_OBJECT_REQ, 0x1018, 0));
	DO(x, talk_info(t, EC_SDOINFO_ENTRY_REQ, 0x1018, 2));
}

static int soe(struct talk *t, u16 idn, bool write)
{
	u16 error;

	if (write)
		return ec_soe_write(&t->s->mbox, 0, idn, t->data, 4, &error, &t->limit);
	return ec_soe_read(&t->s->mbox, 0, idn, t->data, sizeof(t->data), &t->got, &error,
			   &t->limit);
}

static int voe_write(struct talk *t, size_t size)
{
	struct ec_voe_hdr h = { .vendor = 1, .type = 2 };

	return ec_voe_write(&t->s->mbox, &h, t->data, size, &t->limit);
}

static int voe_read(struct talk *t)
{
	struct ec_voe_hdr h;

	return ec_voe_read(&t->s->mbox, false, &h, t->data, sizeof(t->data), &t->got, &t->limit);
}

static void others(struct hostile *x)
{
	struct talk *t = x->t;

	DO(x, talk_put(t, "data", 1000));
	DO(x, talk_get(t, "data"));
	DO(x, talk_get(t, "none"));
	DO(x, talk_put(t, "data", 0));
	DO(x, soe(t, 47, true));
	DO(x, soe(t, 47, false));
	DO(x, soe(t, 17, false));
	DO(x, soe(t, 30, false));
	DO(x, voe_write(t, 20));
	DO(x, voe_read(t));
}

/* what is left of the fault is thrown away, then everything works */
static void recovers(struct bus *b, struct talk *t)
{
	t->limit.timeout_ms = 100;
	talk_upload(t, 0x1018, 4, false);
	KUNIT_EXPECT_EQ(b->test, talk_upload(t, 0x1018, 4, false), 0);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le32(t->data), 5u);
	KUNIT_EXPECT_EQ(b->test, talk_download(t, 0x2000, 0, false, 1000), 0);
	KUNIT_EXPECT_EQ(b->test, talk_upload(t, 0x2000, 0, false), 0);
	KUNIT_EXPECT_TRUE(b->test, talk_is_filled(t, 1000));
	KUNIT_EXPECT_EQ(b->test, talk_put(t, "data", 1000), 0);
	KUNIT_EXPECT_EQ(b->test, talk_get(t, "data"), 0);
	KUNIT_EXPECT_TRUE(b->test, talk_is_filled(t, 1000));
}

static struct bus *hostile_up(struct kunit *test, u32 seed)
{
	char *text = kunit_kzalloc(test, 256, GFP_KERNEL);
	struct bus *b;

	KUNIT_ASSERT_NOT_NULL(test, text);
	scnprintf(text, 256, "segment seed=%u response=100us transition=200us\n"
		  "slave bad drive serial=5 mbox=128 foe=64 soe=1 voe=7\n"
		  "slave good drive serial=6 mbox=128\n", seed);
	b = bus_up(test, text, 2);
	bus_idle(b);
	return b;
}

static void hostile(struct kunit *test, u32 kind, const char *name)
{
	struct hostile x = { .longest_ns = 0 };
	u32 seed, i;

	for (seed = 1; seed <= SEEDS; seed++) {
		x.b = hostile_up(test, seed);
		x.t = talk_new(x.b, 0, LIMIT_MS);
		bus_fault(x.b, EC_SIM_FAULT_MAILBOX, 0, 0, kind, 0);
		for (i = 0; i < ROUNDS; i++) {
			coe(&x);
			others(&x);
		}
		bus_fault(x.b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
		recovers(x.b, x.t);
		bus_down(x.b);
		test->priv = NULL;
		kunit_kfree(test, x.t);
	}
	bus_figure("%s mailbox: %u calls with %u seeds, %u succeeded, the longest took %llu us",
		   name, x.calls, SEEDS, x.good, div_u64(x.longest_ns, NSEC_PER_USEC));
}

static void hostile_random_messages_end_in_time(struct kunit *test)
{
	hostile(test, EC_SIM_MAILBOX_GARBAGE, "random");
}

static void hostile_almost_right_messages_end_in_time(struct kunit *test)
{
	hostile(test, EC_SIM_MAILBOX_ALMOST, "almost right");
}

/* Configuration of a slave that comes up meanwhile ends as well, and the other slave is there. */
static void hostile_slave_comes_up(struct kunit *test)
{
	struct bus *b = hostile_up(test, 77);
	struct talk *good = talk_new(b, 1, LIMIT_MS);

	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_ALMOST, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 0, 0, 0, 0);
	msleep(500);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 0, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 10000), ~0ull);
	good->s = bus_slave(b, 1);
	KUNIT_EXPECT_EQ(test, talk_upload(good, 0x1018, 4, false), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(good->data), 6u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(hostile_random_messages_end_in_time),
	KUNIT_CASE(hostile_almost_right_messages_end_in_time),
	KUNIT_CASE(hostile_slave_comes_up),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_hostile",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
