// SPDX-License-Identifier: GPL-2.0-only
/* Mailboxes that answer wrongly, endlessly or not at all. */
#include <linux/kthread.h>
#include <linux/sched/signal.h>
#include "cyc.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/session/session_attach.h"

static const char text[] =
	"segment seed=9 response=200us transition=200us\n"
	"slave coupler EK1100\nslave bad drive serial=5\nslave good drive serial=6\n";

#define BAD	1
#define GOOD	2

/* In PREOP, and their PDOs have been read over CoE. */
static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	u32 i;

	for (i = 0; i < 1000 && !bus_settled(b); i++)
		msleep(1);
	KUNIT_ASSERT_TRUE(test, bus_settled(b));
	return b;
}

/* Serial number of a slave; negative: error. Never longer than the default limit. */
static s64 serial(struct bus *b, u32 position)
{
	u64 t0 = ktime_get_ns();
	u8 v[4] = { 0 };
	size_t got;
	u32 abort;
	int ret;

	ret = ec_coe_upload(bus_mbox(b, position), 0x1018, 4, false, v, sizeof(v), &got,
			    &abort,
			    &(struct ec_mbox_limit){ .timeout_ms = 100 });
	KUNIT_EXPECT_LE_MSG(b->test, ktime_get_ns() - t0, 300 * NSEC_PER_MSEC,
			    "slave %u kept its caller", position);
	if (ret)
		return ret;
	KUNIT_EXPECT_EQ(b->test, got, 4ul);
	return get_unaligned_le32(v);
}

static const struct wrong {
	const char *name;
	u32 kind;
	int want;	/* errno; 0: the answer is taken, and right */
} wrongs[] = {
	{ "length", EC_SIM_MAILBOX_LENGTH, -EBADMSG },
	{ "short", EC_SIM_MAILBOX_SHORT, -EBADMSG },
	{ "counter", EC_SIM_MAILBOX_COUNTER, 0 },
	{ "type", EC_SIM_MAILBOX_TYPE, -ETIMEDOUT },
	{ "babble", EC_SIM_MAILBOX_BABBLE, -ETIMEDOUT },
	{ "stale", EC_SIM_MAILBOX_STALE, -ETIMEDOUT },
	{ "fragments", EC_SIM_MAILBOX_FRAGMENTS, 0 },
};

static void wrong_desc(const struct wrong *w, char *desc)
{
	strscpy(desc, w->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* An error within the time limit, no wrong value; the others are not touched. */
static void mbox_wrong(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct bus *b = ready(test);
	u32 i, twice = 0;
	s64 got;

	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, w->kind, 0);
	for (i = 0; i < 3; i++) {
		got = serial(b, BAD);
		/* one answer may look like the last one, sent twice */
		if (w->kind == EC_SIM_MAILBOX_COUNTER && got == -ETIMEDOUT && !twice++)
			continue;
		KUNIT_EXPECT_EQ(test, got, w->want ?: 5);
		KUNIT_EXPECT_EQ(test, serial(b, GOOD), 6);
	}
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_GOOD, 0);
	serial(b, BAD);		/* what still lies there is thrown away */
	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
}

static void mbox_mute(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), -ETIMEDOUT);
	/* now its mailbox is full, too */
	KUNIT_EXPECT_EQ(test, serial(b, BAD), -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, serial(b, GOOD), 6);
	bus_request(b, GOOD, EC_AL_SAFEOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, GOOD, EC_AL_SAFEOP, 500), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 0, 0);
	msleep(50);
	serial(b, BAD);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
}

/* Power fails while a transfer waits. */
static void mbox_gone(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, BAD, 0, 0, 0);
	KUNIT_EXPECT_LT(test, serial(b, BAD), 0);
}

/* somebody who reads an object of the bad slave, until a signal or @cancel */
struct reader {
	struct bus *b;
	u16 index;
	bool cancel;
	struct ec_mbox_limit limit;
	u8 v[1000];
	int ret;
	u64 ended_ns;
	struct completion done;
};

static int read_object(void *arg)
{
	struct reader *r = arg;
	size_t got;
	u32 abort;

	allow_signal(SIGKILL);
	r->ret = ec_coe_upload(bus_mbox(r->b, BAD), r->index, 0, false, r->v,
			       sizeof(r->v), &got, &abort, &r->limit);
	r->ended_ns = ktime_get_ns();
	complete(&r->done);
	return 0;
}

static struct task_struct *begin_read(struct bus *b, struct reader *r, u16 index)
{
	struct task_struct *t;

	*r = (struct reader){
		.b = b, .index = index, .limit = { .timeout_ms = 5000, .cancel = &r->cancel },
	};
	init_completion(&r->done);
	t = kthread_run(read_object, r, "reader");
	KUNIT_ASSERT_FALSE(b->test, IS_ERR(t));
	return t;
}

/* It always has a message ready, and none is the reply: a caller that is killed leaves. */
static void mbox_stale_messages_leave_fatal_signal(struct kunit *test)
{
	static struct reader r;
	struct bus *b = ready(test);
	struct task_struct *t;
	u64 t0;

	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_STALE, 0);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), -ETIMEDOUT);
	t = begin_read(b, &r, 0x1000);
	msleep(100);
	KUNIT_ASSERT_FALSE(test, completion_done(&r.done));
	t0 = ktime_get_ns();
	send_sig(SIGKILL, t, 1);
	wait_for_completion(&r.done);
	bus_figure("SDO upload beside endless stale messages: ends %llu us after SIGKILL",
		   div_u64(r.ended_ns - t0, NSEC_PER_USEC));
	KUNIT_EXPECT_EQ(test, r.ret, -EINTR);
	KUNIT_EXPECT_LT(test, r.ended_ns - t0, 50ull * NSEC_PER_MSEC);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_GOOD, 0);
	serial(b, BAD);
	KUNIT_EXPECT_EQ(test, serial(b, BAD), 5);
}

/* Each segment is there at once: the transfer ends when its caller does not want it any more. */
static void mbox_segments_at_once_leave_cancel(struct kunit *test)
{
	static struct reader r;
	struct bus *b = bus_up(test, "segment seed=9\nslave coupler EK1100\n"
			       "slave bad drive mbox=32 response=0us\n", 2);
	u64 t0;

	bus_idle(b);
	begin_read(b, &r, 0x2000);
	usleep_range(500, 501);
	KUNIT_ASSERT_FALSE(test, completion_done(&r.done));
	t0 = ktime_get_ns();
	WRITE_ONCE(r.cancel, true);
	wait_for_completion(&r.done);
	bus_figure("SDO upload in 44 segments that are ready at once: ends %llu us after cancel",
		   div_u64(r.ended_ns - t0, NSEC_PER_USEC));
	KUNIT_EXPECT_EQ(test, r.ret, -ECANCELED);
	KUNIT_EXPECT_LT(test, r.ended_ns - t0, 1ull * NSEC_PER_MSEC);
	/* and the slave does not wait for the others */
	usleep_range(500, 501);
	KUNIT_EXPECT_EQ(test, bus_app(b, "bad")->mbox.srv.state, EC_SDO_SRV_IDLE);
}

/* The EEPROM of the bad slave has no names. */
static struct bus *nameless(struct kunit *test)
{
	struct bus *b = bus_new(test, text);

	bus_strip_names(b, BAD);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	KUNIT_ASSERT_GT(test, bus_slave(b, BAD)->pdos.names.n, 0u);
	return b;
}

/* Its worker asks for them, and the messages of its mailbox are wrong. */
static void read_names(struct bus *b, u32 kind)
{
	struct ec_slave *s = bus_slave(b, BAD);

	ec_names_free(s);
	s->pdos.names_done = false;
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, kind, 0);
	ec_slave_kick(s);
	msleep(5);
	KUNIT_ASSERT_TRUE(b->test, ec_mbox_is_claimed(&s->mbox, BIT(EC_MBOX_COE)));
}

/* As the monitor attaches it, which waits for nothing: not for names that never come either. */
static void mbox_stale_messages_leave_session(struct kunit *test)
{
	struct bus *b = nameless(test);
	struct ec_slave *s = bus_slave(b, BAD);
	struct ec_config *c;
	u64 t0;

	cyc_new(b, 1000);
	read_names(b, EC_SIM_MAILBOX_STALE);
	t0 = ktime_get_ns();
	bus_lock(b);
	c = ec_session_configure(bus_session(b), 0, BAD, s->info.vendor,
				 s->info.product);
	bus_unlock(b);
	t0 = ktime_get_ns() - t0;
	KUNIT_EXPECT_FALSE(test, IS_ERR(c));
	bus_figure("configuration of a slave whose worker reads stale messages: %llu us",
		   div_u64(t0, NSEC_PER_USEC));
	KUNIT_EXPECT_LT(test, t0, 50ull * NSEC_PER_MSEC);
}

/* A name whose fragments never end: the limit of all names ends it. */
static void mbox_endless_fragments(struct kunit *test)
{
	struct bus *b = nameless(test);
	u32 ms;

	read_names(b, EC_SIM_MAILBOX_FRAGMENTS);
	for (ms = 0; ms < 5000 && !bus_settled(b); ms++)
		usleep_range(1000, 1001);
	bus_figure("slave with names in endless fragments: settled after %u ms", ms);
	KUNIT_EXPECT_LT(test, ms, 1000u);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, BAD)->pdos.names_done);
	KUNIT_EXPECT_EQ(test, serial(b, GOOD), 6);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(mbox_wrong, wrong_gen_params),
	KUNIT_CASE(mbox_mute),
	KUNIT_CASE(mbox_gone),
	KUNIT_CASE(mbox_stale_messages_leave_fatal_signal),
	KUNIT_CASE(mbox_stale_messages_leave_session),
	KUNIT_CASE(mbox_segments_at_once_leave_cancel),
	KUNIT_CASE(mbox_endless_fragments),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_fault_mbox",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
