// SPDX-License-Identifier: GPL-2.0-only
/* FoE: files read and written, in BOOT, beside other protocols, lost and ended in the middle. */
#include <linux/kthread.h>
#include "bus.h"
#include "devices/sim/app.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/foe.h"
#include "master/mailbox/mailbox.h"
#include "master/wire/regs.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive mbox=128 serial=11 foe=256 foe_busy=2\n"
	"slave b EL7201 serial=12\nslave c drive serial=13\n";

#define WITHOUT	2	/* slave without FoE */
#define MOST	(256 << 10)

/* the master's side of a file */
struct side {
	u8 *data;
	u64 calls;
	u64 fail_at;	/* no copy from there on */
	u64 done;
	bool cancel;
	u64 cancel_at;
};

static u8 content(u64 at)
{
	return (u8)(at * 31 + (at >> 8));
}

static int fill(void *ctx, u64 at, u8 *buf, size_t n)
{
	struct side *x = ctx;

	if (x->fail_at && at + n > x->fail_at)
		return -EFAULT;
	memcpy(buf, x->data + at, n);
	return 0;
}

static int take(void *ctx, u64 at, u8 *buf, size_t n)
{
	struct side *x = ctx;

	memcpy(x->data + at, buf, n);
	return 0;
}

static void progress(void *ctx, u64 done)
{
	struct side *x = ctx;

	x->calls++;
	x->done = done;
	if (x->cancel_at && done >= x->cancel_at)
		WRITE_ONCE(x->cancel, true);
}

static struct side *side_new(struct kunit *test)
{
	struct side *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->data = kunit_kzalloc(test, MOST, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, x->data);
	for (i = 0; i < MOST; i++)
		x->data[i] = content(i);
	return x;
}

static int put(struct ec_slave *s, struct side *x, const char *name, u64 size, struct ec_foe *f)
{
	struct ec_foe_file file = { .size = size, .copy = fill, .progress = progress, .ctx = x };
	struct ec_mbox_limit limit = { .cancel = &x->cancel };

	*f = (struct ec_foe){ .write = true, .name = name, .name_len = strlen(name) };
	return ec_foe_transfer(&s->mbox, f, &file, &limit);
}

static int get(struct ec_slave *s, struct side *x, const char *name, u64 room, struct ec_foe *f)
{
	struct ec_foe_file file = { .size = room, .copy = take, .ctx = x };

	memset(x->data, 0, MOST);
	*f = (struct ec_foe){ .name = name, .name_len = strlen(name), .password = 77 };
	return ec_foe_transfer(&s->mbox, f, &file, NULL);
}

static void expect_content(struct kunit *test, const struct side *x, u64 size)
{
	u64 i;

	for (i = 0; i < size; i++)
		if (x->data[i] != content(i))
			break;
	KUNIT_EXPECT_EQ(test, i, size);
}

/* A mailbox that holds a header and no data: a read would get nothing for ever. */
static void foe_mailbox_without_room_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct side *x = side_new(test);
	const u16 tx_size = s->info.std.tx_size;
	struct ec_foe f;

	KUNIT_ASSERT_EQ(test, put(s, x, "data.bin", 1000, &f), 0);
	s->info.std.tx_size = EC_MBOX_HDR + EC_FOE_HDR;
	KUNIT_EXPECT_EQ(test, get(s, x, "data.bin", MOST, &f), -EMSGSIZE);
	s->info.std.tx_size = tx_size;
	KUNIT_EXPECT_EQ(test, get(s, x, "data.bin", MOST, &f), 0);
}

static void foe_files(struct kunit *test)
{
	static const u32 sizes[] = { 0, 1, 115, 116, 117, 100000, MOST };
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_foe f;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		struct side *x = side_new(test);

		KUNIT_ASSERT_EQ(test, put(s, x, "data.bin", sizes[i], &f), 0);
		KUNIT_EXPECT_EQ(test, x->done, sizes[i]);
		KUNIT_EXPECT_GT(test, x->calls, sizes[i] / 116);
		KUNIT_ASSERT_EQ(test, get(s, x, "data.bin", MOST, &f), 0);
		KUNIT_EXPECT_EQ(test, f.size, sizes[i]);
		expect_content(test, x, sizes[i]);
	}
	KUNIT_EXPECT_EQ(test, bus_app(b, "a")->foe.password, 77u);
}

static void foe_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct side *x = side_new(test);
	struct ec_foe f;

	KUNIT_EXPECT_EQ(test, get(s, x, "none", MOST, &f), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, f.error, (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_STREQ(test, f.text, "file not found");
	KUNIT_EXPECT_EQ(test, put(bus_slave(b, WITHOUT), x, "a", 1, &f), -EPROTONOSUPPORT);
	x = side_new(test);
	KUNIT_ASSERT_EQ(test, put(s, x, "data", 1000, &f), 0);
	KUNIT_EXPECT_EQ(test, get(s, x, "data", 999, &f), -ENOBUFS);
	/* the slave knows that the master has ended it */
	KUNIT_EXPECT_EQ(test, bus_app(b, "a")->foe.opcode, 0);
	KUNIT_EXPECT_EQ(test, get(s, x, "data", 1000, &f), 0);
	expect_content(test, x, 1000);
	bus_request(b, 0, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_INIT, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, get(s, x, "data", 1000, &f), -EAGAIN);
}

/* The bootstrap mailbox of this slave is twice as large as the standard one. */
static void foe_boot(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 1);
	struct side *x = side_new(test);
	struct ec_foe f;
	size_t got;
	u32 abort;
	u8 v[4];

	bus_request(b, 1, EC_AL_BOOT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 1, EC_AL_BOOT, 1000), ~0ull);
	KUNIT_ASSERT_EQ(test, put(s, x, "fw.efw", 50000, &f), 0);
	KUNIT_EXPECT_EQ(test, f.packet, 50000u / 500 + 1);
	KUNIT_ASSERT_EQ(test, get(s, x, "fw.efw", MOST, &f), 0);
	KUNIT_EXPECT_EQ(test, f.size, 50000ull);
	expect_content(test, x, 50000);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x1018, 1, false, v, 4, &got, &abort, NULL),
			-EAGAIN);
	bus_request(b, 1, EC_AL_PREOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 1, EC_AL_PREOP, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, ec_coe_upload(&s->mbox, 0x1018, 1, false, v, 4, &got, &abort, NULL),
			0);
	KUNIT_ASSERT_EQ(test, get(s, x, "fw.efw", MOST, &f), 0);
	KUNIT_EXPECT_EQ(test, f.packet, 50000u / 244 + 1);
	expect_content(test, x, 50000);
}

/* A transfer that ends early leaves no file, and the next one works. */
static void foe_ended(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_app *app = bus_app(b, "a");
	u32 lines = bus_log_lines("0-0: FoE write of 'data' ended early");
	struct side *x = side_new(test);
	struct ec_foe f;

	x->cancel_at = 5000;
	KUNIT_EXPECT_EQ(test, put(s, x, "data", 20000, &f), -ECANCELED);
	/* the log has the slave, its file may be firmware */
	KUNIT_EXPECT_EQ(test, bus_log_lines("0-0: FoE write of 'data' ended early"), lines + 1);
	KUNIT_EXPECT_EQ(test, app->foe.opcode, 0);
	KUNIT_EXPECT_FALSE(test, app->foe.valid);
	/* and no line that a name pretends */
	lines = bus_log_lines("FoE write of 'a\\nEtherCAT 0: b' ended early");
	x->cancel = false;
	KUNIT_EXPECT_EQ(test, put(s, x, "a\nEtherCAT 0: b", 20000, &f), -ECANCELED);
	KUNIT_EXPECT_EQ(test, bus_log_lines("FoE write of 'a\\nEtherCAT 0: b' ended early"),
			lines + 1);
	x->cancel_at = 0;
	x->cancel = false;
	x->fail_at = 7000;
	KUNIT_EXPECT_EQ(test, put(s, x, "data", 20000, &f), -EFAULT);
	KUNIT_EXPECT_EQ(test, app->foe.opcode, 0);
	KUNIT_EXPECT_FALSE(test, app->foe.valid);
	x->fail_at = 0;
	KUNIT_EXPECT_EQ(test, put(s, x, "data", 20000, &f), 0);
	KUNIT_EXPECT_TRUE(test, app->foe.valid);
}

/* another thread, which reads objects meanwhile */
static int reader(void *arg)
{
	struct ec_slave *s = arg;
	int good = 0;
	size_t got;
	u32 abort;
	u8 v[4];

	while (!kthread_should_stop()) {
		if (!ec_coe_upload(&s->mbox, 0x1018, 1, false, v, 4, &got, &abort, NULL))
			good++;
		usleep_range(500, 600);
	}
	return good;
}

static void foe_beside_others(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct side *x = side_new(test);
	struct task_struct *t = kthread_run(reader, s, "foe_reader");
	struct ec_foe f;

	KUNIT_ASSERT_FALSE(test, IS_ERR(t));
	KUNIT_EXPECT_EQ(test, put(s, x, "data", 30000, &f), 0);
	KUNIT_EXPECT_EQ(test, get(s, x, "data", MOST, &f), 0);
	KUNIT_EXPECT_GT(test, kthread_stop(t), 50);
	expect_content(test, x, 30000);
}

struct writer {
	struct ec_slave *s;
	struct side *x;
	int ret;
	struct completion done;
};

static int write_one(void *arg)
{
	struct writer *w = arg;
	struct ec_foe f;

	w->ret = put(w->s, w->x, "other", 50000, &f);
	complete(&w->done);
	return 0;
}

static void foe_second_writer(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct writer w = { .s = bus_slave(b, 0), .x = side_new(test) };
	struct side *x = side_new(test);
	struct task_struct *t;
	struct ec_foe f;

	init_completion(&w.done);
	t = kthread_run(write_one, &w, "foe_writer");
	KUNIT_ASSERT_FALSE(test, IS_ERR(t));
	usleep_range(20000, 20001);
	KUNIT_EXPECT_EQ(test, put(w.s, x, "data", 10, &f), -EINPROGRESS);
	/* another slave has a file of its own */
	KUNIT_EXPECT_EQ(test, put(bus_slave(b, 1), x, "data", 10, &f), 0);
	wait_for_completion(&w.done);
	KUNIT_EXPECT_EQ(test, w.ret, 0);
	KUNIT_EXPECT_EQ(test, put(w.s, x, "data", 10, &f), 0);
}

static void foe_silence(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct ec_slave *s = bus_slave(b, 0);
	struct ec_foe_file file = { .size = 100, .copy = fill, .ctx = side_new(test) };
	struct ec_foe f = { .write = true, .name = "x", .name_len = 1 };
	struct ec_mbox_limit limit = { .timeout_ms = 200 };
	u64 t0;

	bus_idle(b);
	t0 = ktime_get_ns();
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ec_foe_transfer(&s->mbox, &f, &file, &limit), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - t0, 200 * NSEC_PER_MSEC);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 400 * NSEC_PER_MSEC);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	usleep_range(10000, 10001);
	KUNIT_EXPECT_EQ(test, put(s, file.ctx, "x", 100, &f), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(foe_mailbox_without_room_refused),
	KUNIT_CASE(foe_files),
	KUNIT_CASE(foe_refused),
	KUNIT_CASE(foe_boot),
	KUNIT_CASE(foe_ended),
	KUNIT_CASE(foe_beside_others),
	KUNIT_CASE(foe_second_writer),
	KUNIT_CASE(foe_silence),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_foe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
