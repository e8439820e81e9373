// SPDX-License-Identifier: GPL-2.0-only
/* Slaves whose CoE and FoE servers go wrong: a clear error in time, and the next transfer works. */
#include "talk.h"
#include "devices/sim/app.h"
#include "master/wire/foe.h"
#include "master/wire/sdoinfo.h"

static const char text[] =
	"segment seed=9 response=200us transition=200us\n"
	"slave bad drive serial=5 mbox=128 foe=64\nslave good drive serial=6 mbox=128 foe=64\n";

#define LIMIT_MS	100
#define SIZE		1000	/* of object and file: some 9 messages of 128 bytes */
#define OBJECT		0x2000
#define DENIED		0x06010000

/*
 * What a fault makes of transfers that it concerns from message @after on. The transport discards
 * a message that comes twice.
 */
static const struct wrong {
	const char *name;
	u32 kind;
	u32 arg;
	u32 after;
	int coe_read;
	int coe_write;
	int foe_read;
	int foe_write;
} wrongs[] = {
	{ "delay", EC_SIM_MAILBOX_DELAY, 20000000, 0, 0, 0, 0, 0 },
	{ "delay_beyond_limit", EC_SIM_MAILBOX_DELAY, 300000000, 0,
	  -ETIMEDOUT, -ETIMEDOUT, -ETIMEDOUT, -ETIMEDOUT },
	{ "busy", EC_SIM_MAILBOX_BUSY, 0, 0, -EALREADY, -EALREADY, -ETIMEDOUT, -ETIMEDOUT },
	{ "busy_later", EC_SIM_MAILBOX_BUSY, 0, 4, -EALREADY, -EALREADY, -ETIMEDOUT, -ETIMEDOUT },
	{ "deny", EC_SIM_MAILBOX_DENY, DENIED, 0, -EIO, -EIO, -EREMOTEIO, -EREMOTEIO },
	{ "deny_later", EC_SIM_MAILBOX_DENY, DENIED, 4, -EIO, -EIO, -EREMOTEIO, -EREMOTEIO },
	{ "counter", EC_SIM_MAILBOX_COUNTER, 0, 0, 0, 0, 0, 0 },
	{ "length_later", EC_SIM_MAILBOX_LENGTH, 0, 4, -EBADMSG, -EBADMSG, -EBADMSG, -EBADMSG },
	{ "short_later", EC_SIM_MAILBOX_SHORT, 0, 4, -EBADMSG, -EBADMSG, -EBADMSG, -EBADMSG },
	{ "duplicate", EC_SIM_MAILBOX_DUPLICATE, 0, 0, 0, 0, 0, 0 },
	{ "lost", EC_SIM_MAILBOX_LOST, 0, 0, -ETIMEDOUT, -ETIMEDOUT, -ETIMEDOUT, -ETIMEDOUT },
	{ "lost_later", EC_SIM_MAILBOX_LOST, 0, 4, -ETIMEDOUT, -ETIMEDOUT, -ETIMEDOUT,
	  -ETIMEDOUT },
};

static void wrong_desc(const struct wrong *w, char *desc)
{
	strscpy(desc, w->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* the fault for the messages of the slave from now on */
static void mailbox_fault(struct bus *b, u32 kind, u32 arg, u32 after)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_MAILBOX, .arg = kind, .arg2 = arg,
		.value = after,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

static struct bus *proto_up(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);

	bus_idle(b);
	return b;
}

enum what { COE_READ, COE_WRITE, FOE_READ, FOE_WRITE };

static int transfer(struct talk *t, enum what what)
{
	switch (what) {
	case COE_READ:
		return talk_upload(t, OBJECT, 0, false);
	case COE_WRITE:
		return talk_download(t, OBJECT, 0, false, SIZE);
	case FOE_READ:
		return talk_get(t, "data");
	default:
		return talk_put(t, "data", SIZE);
	}
}

static void fault_case(struct bus *b, struct talk *t, enum what what, int want)
{
	const struct wrong *w = b->test->param_value;
	struct talk *good = talk_new(b, 1, LIMIT_MS);
	u64 t0;
	int ret;

	KUNIT_ASSERT_EQ(b->test, transfer(t, COE_WRITE), 0);
	KUNIT_ASSERT_EQ(b->test, transfer(t, FOE_WRITE), 0);
	mailbox_fault(b, w->kind, w->arg, w->after);
	t0 = ktime_get_ns();
	ret = transfer(t, what);
	KUNIT_EXPECT_EQ_MSG(b->test, ret, want, "transfer %u", what);
	bus_figure("%s, transfer %u: %llu ms", w->name, what,
		   div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	if (want == -EIO)
		KUNIT_EXPECT_EQ(b->test, t->abort, DENIED);
	if (want == -EREMOTEIO)
		KUNIT_EXPECT_EQ(b->test, t->foe.error, DENIED);
	if (!ret && what != COE_WRITE && what != FOE_WRITE)
		KUNIT_EXPECT_TRUE(b->test, talk_is_filled(t, SIZE));
	KUNIT_EXPECT_EQ(b->test, talk_upload(good, 0x1018, 4, false), 0);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le32(good->data), 6u);
	mailbox_fault(b, EC_SIM_MAILBOX_GOOD, 0, 0);
	msleep(w->kind == EC_SIM_MAILBOX_DELAY ? 400 : 1);	/* late replies have come by then */
	KUNIT_EXPECT_EQ_MSG(b->test, transfer(t, what), 0, "next transfer %u", what);
}

static void fault_proto_clear_error_and_next_works(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct bus *b = proto_up(test);
	struct talk *t = talk_new(b, 0, LIMIT_MS);

	fault_case(b, t, COE_READ, w->coe_read);
	fault_case(b, t, COE_WRITE, w->coe_write);
	fault_case(b, t, FOE_READ, w->foe_read);
	fault_case(b, t, FOE_WRITE, w->foe_write);
}

/* A file with another header is refused at its first data, and a right one is taken, in BOOT. */
static void fault_proto_wrong_firmware_is_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive serial=5 mbox=128 foe=64 foe_page=50ms foe_boot=yes\n",
			       1);
	struct talk *t = talk_new(b, 0, LIMIT_MS);
	struct ec_app_foe *foe = &bus_app(b, "a")->foe;
	u64 t0;

	bus_idle(b);
	KUNIT_EXPECT_EQ(test, talk_put(t, "fw", 10000), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, t->foe.error, (u32)EC_FOE_ERR_BOOT_ONLY);
	foe->boot = false;
	memcpy(foe->header, "EC", 2);
	foe->header_len = 2;
	KUNIT_EXPECT_EQ(test, talk_put(t, "fw", 10000), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, t->foe.error, (u32)EC_FOE_ERR_PROGRAM);
	KUNIT_EXPECT_STREQ(test, t->foe.text, "not firmware of this device");
	KUNIT_EXPECT_EQ(test, talk_get(t, "fw"), -EREMOTEIO);
	talk_fill(t, 10000);
	memcpy(foe->header, t->data, 2);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, talk_put(t, "fw", 10000), 0);
	/* two pages of flash */
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 100 * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, talk_get(t, "fw"), 0);
	KUNIT_EXPECT_TRUE(test, talk_is_filled(t, 10000));
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(fault_proto_clear_error_and_next_works, wrong_gen_params),
	KUNIT_CASE(fault_proto_wrong_firmware_is_refused),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_fault_proto",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
