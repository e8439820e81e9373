// SPDX-License-Identifier: GPL-2.0-only
/* SoE: all elements, fragments both ways, procedure commands, messages without a request. */
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"
#include "master/wire/event.h"
#include "master/wire/soe.h"

#define P(n)		(0x8000 | (n))
#define LIST		P(0xa3)	/* up to 2000 bytes */
#define HOMING		148
#define LIMIT_MS	100

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive mbox=64 serial=11 soe=2\nslave b drive mbox=512 serial=12 soe=1\n";

struct soe {
	struct bus *b;
	struct ec_slave *s;
	struct ec_soe_access a;
	struct ec_mbox_limit limit;
	u8 data[2100];
};

static struct soe *soe_up(struct kunit *test, const char *description)
{
	struct soe *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->b = bus_up(test, description, 2);
	x->s = bus_slave(x->b, 0);
	x->limit.timeout_ms = LIMIT_MS;
	bus_idle(x->b);
	return x;
}

static int soe_read(struct soe *x, u8 drive, u16 idn, u8 elements, size_t cap)
{
	x->a = (struct ec_soe_access){
		.drive = drive, .elements = elements, .idn = idn, .data = x->data, .cap = cap,
	};
	memset(x->data, 0, sizeof(x->data));
	return ec_soe_access(&x->s->mbox, &x->a, &x->limit);
}

static int soe_write(struct soe *x, u8 drive, u16 idn, u8 elements, size_t size)
{
	x->a = (struct ec_soe_access){
		.write = true, .drive = drive, .elements = elements, .idn = idn, .data = x->data,
		.size = size,
	};
	return ec_soe_access(&x->s->mbox, &x->a, &x->limit);
}

static void soe_elements_of_idn_are_read(struct kunit *test)
{
	struct soe *x = soe_up(test, text);

	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_NAME, 100), 0);
	KUNIT_EXPECT_EQ(test, x->a.size, (size_t)32);
	KUNIT_EXPECT_MEMEQ(test, x->data, "\x1c\0\x1c\0Bipolar velocity limit value", 32);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_ATTRIBUTE, 100), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), EC_SOE_ATTR_LEN4);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_UNIT, 100), 0);
	KUNIT_EXPECT_MEMEQ(test, x->data, "\3\0\3\0rpm", 7);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_MIN, 100), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 10);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_MAX, 100), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 6000);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_DEFAULT, 100), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 3000);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, HOMING, EC_SOE_STATE, 100), 0);
	KUNIT_EXPECT_EQ(test, x->a.size, (size_t)2);
	/* all at once, in fragments of this small mailbox */
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, 0xfe, 100), 0);
	KUNIT_EXPECT_EQ(test, x->a.size, 32 + 4 + 7 + 4 * 4ul);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data + x->a.size - 4), 3000);
	/* what an IDN has not */
	KUNIT_EXPECT_EQ(test, soe_read(x, 1, 91, EC_SOE_STATE, 100), -EIO);
	KUNIT_EXPECT_EQ(test, x->a.error, EC_SOE_ERR_NO_STATE);
	KUNIT_EXPECT_EQ(test, soe_read(x, 1, 47, EC_SOE_DEFAULT, 100), -EIO);
	KUNIT_EXPECT_EQ(test, x->a.error, EC_SOE_ERR_NO_DEFAULT);
	KUNIT_EXPECT_EQ(test, soe_read(x, 1, 91, 0, 100), -EINVAL);
	KUNIT_EXPECT_EQ(test, soe_read(x, 8, 91, EC_SOE_VALUE, 100), -EINVAL);
}

static void soe_elements_of_idn_are_written(struct kunit *test)
{
	static const struct {
		u8 element;
		u16 error;
	} in[] = {
		{ EC_SOE_NAME, EC_SOE_ERR_NAME_RO }, { EC_SOE_ATTRIBUTE, EC_SOE_ERR_ATTRIBUTE_RO },
		{ EC_SOE_UNIT, EC_SOE_ERR_UNIT_RO }, { EC_SOE_MIN, EC_SOE_ERR_MIN_RO },
		{ EC_SOE_MAX, EC_SOE_ERR_MAX_RO }, { EC_SOE_DEFAULT, EC_SOE_ERR_DEFAULT_RO },
	};
	struct soe *x = soe_up(test, text);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(in); i++) {
		KUNIT_EXPECT_EQ(test, soe_write(x, 0, 91, in[i].element, 4), -EIO);
		KUNIT_EXPECT_EQ(test, x->a.error, in[i].error);
	}
	put_unaligned_le32(77, x->data);
	KUNIT_EXPECT_EQ(test, soe_write(x, 0, 91, EC_SOE_VALUE, 4), 0);
	KUNIT_EXPECT_EQ(test, soe_read(x, 0, 91, EC_SOE_VALUE, 4), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 77);
}

static void fill_list(struct soe *x, u16 bytes)
{
	u16 i;

	put_unaligned_le16(bytes, x->data);
	put_unaligned_le16(bytes, x->data + 2);
	for (i = 0; i < bytes; i++)
		x->data[4 + i] = i * 7 + (i >> 8);
}

static bool is_filled(const struct soe *x, u16 bytes)
{
	u16 i;

	for (i = 0; i < bytes; i++)
		if (x->data[4 + i] != (u8)(i * 7 + (i >> 8)))
			return false;
	return get_unaligned_le16(x->data) == bytes;
}

/* Sizes at the borders of a message, and 38 fragments. */
static void soe_fragments_carry_lists_both_ways(struct kunit *test)
{
	static const u16 sizes[] = { 0, 1, 49, 50, 51, 104, 105, 1999, 2000 };
	struct soe *x = soe_up(test, text);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		fill_list(x, sizes[i]);
		KUNIT_ASSERT_EQ_MSG(test, soe_write(x, 1, LIST, EC_SOE_VALUE, sizes[i] + 4), 0,
				    "%u bytes", sizes[i]);
		KUNIT_ASSERT_EQ_MSG(test, soe_read(x, 1, LIST, EC_SOE_VALUE, 2004), 0, "%u bytes",
				    sizes[i]);
		KUNIT_EXPECT_EQ(test, x->a.size, sizes[i] + 4ul);
		KUNIT_EXPECT_TRUE(test, is_filled(x, sizes[i]));
	}
	/* the other drive has its own */
	KUNIT_ASSERT_EQ(test, soe_read(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
	KUNIT_EXPECT_EQ(test, x->a.size, (size_t)4);
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, LIST, EC_SOE_VALUE, 1000), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, x->a.size, (size_t)0);
	/* and nothing of it is left for the next answer */
	KUNIT_ASSERT_EQ(test, soe_read(x, 1, 91, EC_SOE_VALUE, 4), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 3000);
}

/* A slave refuses before it has all fragments: the rest is not sent. */
static void soe_fragments_end_when_slave_refuses_early(struct kunit *test)
{
	struct soe *x = soe_up(test, text);
	u64 t0 = ktime_get_ns();

	fill_list(x, 2000);
	KUNIT_EXPECT_EQ(test, soe_write(x, 5, LIST, EC_SOE_VALUE, 2004), -EIO);
	KUNIT_EXPECT_EQ(test, x->a.error, EC_SOE_ERR_DRIVE);
	KUNIT_EXPECT_GT(test, x->a.left, 20);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 20 * NSEC_PER_MSEC);
	fill_list(x, 2000);
	KUNIT_EXPECT_EQ(test, soe_write(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
	/* refused at the end */
	fill_list(x, 150);
	KUNIT_EXPECT_EQ(test, soe_write(x, 0, 95, EC_SOE_VALUE, 154), -EIO);
	KUNIT_EXPECT_EQ(test, x->a.error, EC_SOE_ERR_READ_ONLY);
}

/* Each frame of a transfer in fragments is lost in turn. */
static void soe_fragments_survive_lost_frames(struct kunit *test)
{
	struct soe *x = soe_up(test, text);
	u32 n, back, wrong = 0;

	for (n = 1; n <= 24; n++) {
		for (back = 0; back < 2; back++) {
			struct ec_sim_fault f = {
				.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1,
				.arg = n, .value = back,
			};
			int ret;

			fill_list(x, 200 + n);
			KUNIT_ASSERT_EQ(test, ec_sim_add_fault(x->b->sim, &f), 0);
			ret = soe_write(x, 0, LIST, EC_SOE_VALUE, 204 + n);
			if (!ret)
				ret = soe_read(x, 0, LIST, EC_SOE_VALUE, 2004);
			wrong += ret || !is_filled(x, 200 + n);
			ec_sim_clear_faults(x->b->sim);
			usleep_range(50000, 50001);
		}
	}
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_GE(test, bus_lost(x->b), 24ull);
}

/* A caller ends in the middle of a list; the next one gets its own answer. */
static void soe_fragments_of_cancelled_read_disturb_no_other(struct kunit *test)
{
	struct soe *x = soe_up(test, text);
	bool cancel = true;
	u32 i;

	fill_list(x, 2000);
	KUNIT_ASSERT_EQ(test, soe_write(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
	for (i = 0; i < 20; i++) {
		/* the time limit ends it somewhere, as each fragment restarts only that of one */
		x->limit = (struct ec_mbox_limit){
			.timeout_ms = LIMIT_MS, .end_ns = ktime_get_ns() + 1000000 + i * 200000,
		};
		soe_read(x, 0, LIST, EC_SOE_VALUE, 2004);
		x->limit = (struct ec_mbox_limit){ .timeout_ms = LIMIT_MS };
		KUNIT_ASSERT_EQ(test, soe_read(x, 0, 91, EC_SOE_VALUE, 4), 0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 3000);
	}
	x->limit.cancel = &cancel;
	KUNIT_EXPECT_EQ(test, soe_read(x, 0, 91, EC_SOE_VALUE, 4), -ECANCELED);
}

static const struct wrong {
	const char *name;
	u32 fault;
	u32 after;
	int list;	/* result of reading a list of 38 fragments */
	int number;	/* of reading a number */
} wrongs[] = {
	{ "endless", EC_SIM_SOE_ENDLESS, 0, -EBADMSG, -EBADMSG },
	{ "endless_later", EC_SIM_SOE_ENDLESS, 4, -EBADMSG, 0 },
	{ "countdown", EC_SIM_SOE_COUNTDOWN, 0, -EBADMSG, -ENOBUFS },
	{ "skip", EC_SIM_SOE_SKIP, 0, -EBADMSG, 0 },
	{ "drive", EC_SIM_SOE_DRIVE, 0, -ETIMEDOUT, -ETIMEDOUT },
	{ "drive_later", EC_SIM_SOE_DRIVE, 4, -ETIMEDOUT, 0 },
	{ "idn", EC_SIM_SOE_IDN, 0, -ETIMEDOUT, -ETIMEDOUT },
	{ "elements", EC_SIM_SOE_ELEMENTS, 0, -ETIMEDOUT, -ETIMEDOUT },
	{ "elements_later", EC_SIM_SOE_ELEMENTS, 4, -ETIMEDOUT, 0 },
	{ "error", EC_SIM_SOE_ERROR, 0, -EIO, -EIO },
	{ "error_later", EC_SIM_SOE_ERROR, 4, -EIO, 0 },
	{ "list", EC_SIM_SOE_LIST, 0, 0, 0 },
	{ "empty", EC_SIM_SOE_EMPTY, 0, -EBADMSG, 0 },
};

static void wrong_desc(const struct wrong *w, char *desc)
{
	strscpy(desc, w->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(wrong, wrongs, wrong_desc);

/* A slave that goes wrong: a clear error in time, and the next access works. */
static void soe_hostile_answers_end_in_time(struct kunit *test)
{
	const struct wrong *w = test->param_value;
	struct soe *x = soe_up(test, text);
	struct ec_sim_fault f = {
		.type = EC_SIM_FAULT_MAILBOX, .arg = EC_SIM_MAILBOX_SOE, .arg2 = w->fault,
		.value = w->after,
	};
	u32 i;

	for (i = 0; i < 2; i++) {
		u64 t0;
		int ret;

		fill_list(x, 2000);
		KUNIT_ASSERT_EQ(test, soe_write(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
		f.at_ns = ktime_get_ns();
		KUNIT_ASSERT_EQ(test, ec_sim_add_fault(x->b->sim, &f), 0);
		usleep_range(1000, 1001);
		t0 = ktime_get_ns();
		ret = soe_read(x, 0, i ? 91 : LIST, EC_SOE_VALUE, 2004);
		KUNIT_EXPECT_EQ(test, ret, i ? w->number : w->list);
		KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 5 * LIMIT_MS * NSEC_PER_MSEC);
		KUNIT_EXPECT_LE(test, x->a.size, ret ? 0ul : 2004ul);
		if (ret == -EIO)
			KUNIT_EXPECT_EQ(test, x->a.error, 0x700b);
		bus_fault(x->b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
		usleep_range(50000, 50001);
		KUNIT_EXPECT_EQ(test, soe_read(x, 0, 91, EC_SOE_VALUE, 4), 0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(x->data), 3000);
	}
}

static int command(struct soe *x, u16 idn, u16 value)
{
	put_unaligned_le16(value, x->data);
	return soe_write(x, 0, idn, EC_SOE_VALUE, 2);
}

static int command_state(struct soe *x, u16 idn)
{
	int ret = soe_read(x, 0, idn, EC_SOE_STATE, 2);

	return ret ?: get_unaligned_le16(x->data);
}

static void soe_command_runs_ends_and_is_cancelled(struct kunit *test)
{
	struct soe *x = soe_up(test, text);

	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 0);
	KUNIT_ASSERT_EQ(test, command(x, HOMING, 3), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 7);
	msleep(60);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 3);
	KUNIT_ASSERT_EQ(test, command(x, HOMING, 0), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 0);
	/* interrupted, then cancelled while it runs */
	KUNIT_ASSERT_EQ(test, command(x, HOMING, 1), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 5);
	KUNIT_ASSERT_EQ(test, command(x, HOMING, 3), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 7);
	KUNIT_ASSERT_EQ(test, command(x, HOMING, 0), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, HOMING), 0);
	KUNIT_ASSERT_EQ(test, command(x, P(0xab), 3), 0);
	KUNIT_EXPECT_EQ(test, command_state(x, P(0xab)), 0xf);
}

/* The next event of @kind from @at on; false: there is none. */
static bool next_event(struct soe *x, u64 *at, u32 kind, struct ec_event *e)
{
	while (ec_event_ring_get(bus_events(x->b), at, e))
		if (e->kind == kind)
			return true;
	return false;
}

/* A slave that sends by itself, for some time. */
struct chatter {
	struct delayed_work work;
	struct ec_app *app;
	u32 sent;
};

#define CHATTER		40

static void chat(struct work_struct *work)
{
	struct chatter *c = container_of(to_delayed_work(work), struct chatter, work);
	struct ec_app_soe_message m = {
		.hdr = { .opcode = EC_SOE_NOTIFICATION, .drive = 1, .elements = EC_SOE_STATE,
			 .idn = HOMING },
		.size = 2, .data = { 1, 2 },
	};

	m.data[0] = c->sent++;
	ec_app_soe_send(c->app, &m, ktime_get_ns());
	if (c->sent < CHATTER)
		schedule_delayed_work(&c->work, 1);
}

/* They come at any time, also amid fragments, and are no answers; none is lost. */
static void soe_notifications_amid_fragments_are_events(struct kunit *test)
{
	struct soe *x = soe_up(test, text);
	u64 at = ec_event_ring_head(bus_events(x->b));
	struct chatter c = { .app = bus_app(x->b, "a") };
	struct ec_event e;
	char line[256];
	u32 i, reads = 0;

	fill_list(x, 2000);
	KUNIT_ASSERT_EQ(test, soe_write(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
	INIT_DELAYED_WORK_ONSTACK(&c.work, chat);
	schedule_delayed_work(&c.work, 0);
	while (READ_ONCE(c.sent) < CHATTER) {
		KUNIT_EXPECT_EQ(test, soe_read(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
		KUNIT_EXPECT_TRUE(test, is_filled(x, 2000));
		KUNIT_EXPECT_EQ(test, soe_write(x, 0, LIST, EC_SOE_VALUE, 2004), 0);
		reads++;
	}
	cancel_delayed_work_sync(&c.work);
	destroy_delayed_work_on_stack(&c.work);
	bus_figure("notifications beside SoE in fragments: %u, %u reads and writes", c.sent, reads);
	KUNIT_EXPECT_GE(test, reads, 5u);
	msleep(1500);
	for (i = 0; i < CHATTER; i++) {
		KUNIT_ASSERT_TRUE(test, next_event(x, &at, EC_EVENT_SOE_NOTIFICATION, &e));
		KUNIT_EXPECT_EQ(test, e.arg[4], i | 2 << 8);
	}
	ec_event_text(&e, line, sizeof(line));
	KUNIT_EXPECT_STREQ(test, line,
			   "slave 0: SoE notification of drive 1: IDN S-0-0148, elements 0x01, 2 byte(s): 27 02");
}

static void soe_emergencies_are_events(struct kunit *test)
{
	static const struct ec_app_soe_message in[] = {
		{ { .opcode = EC_SOE_EMERGENCY, .drive = 1, .idn = P(0x96) }, 5, { 1, 2, 3, 4, 5 } },
		{ { .opcode = EC_SOE_EMERGENCY }, 20, { 1, 2, 3, 4, 5, 6, 7, 8, 9 } },
		{ { .opcode = EC_SOE_EMERGENCY, .elements = 0x40, .idn = 95 }, 0, { 0 } },
	};
	static const char * const lines[] = {
		"slave 0: SoE emergency of drive 1: IDN P-0-0150, elements 0x00, 5 byte(s): 01 02 03 04 05",
		"slave 0: SoE emergency of drive 0: IDN S-0-0000, elements 0x00, 20 byte(s): 01 02 03 04 05 06 07 08...",
		"slave 0: SoE emergency of drive 0: IDN S-0-0095, elements 0x40, 0 byte(s)",
	};
	struct soe *x = soe_up(test, text);
	u64 at = ec_event_ring_head(bus_events(x->b));
	u32 before = bus_log_lines("SoE emergency");	/* of other cases */
	struct ec_event e;
	char line[256];
	u32 i;

	for (i = 0; i < ARRAY_SIZE(in); i++)
		ec_app_soe_send(bus_app(x->b, "a"), &in[i], ktime_get_ns());
	/* no access waits: the event of the mailbox fetches them */
	msleep(1500);
	for (i = 0; i < ARRAY_SIZE(in); i++) {
		KUNIT_ASSERT_TRUE(test, next_event(x, &at, EC_EVENT_SOE_EMERGENCY, &e));
		ec_event_text(&e, line, sizeof(line));
		KUNIT_EXPECT_STREQ(test, line, lines[i]);
	}
	KUNIT_EXPECT_EQ(test, bus_log_lines("SoE emergency"), before + 3);
}

static void soe_command_end_is_notified(struct kunit *test)
{
	struct soe *x = soe_up(test, text);
	u64 at = ec_event_ring_head(bus_events(x->b));
	struct ec_event e;

	KUNIT_ASSERT_EQ(test, command(x, HOMING, 3), 0);
	msleep(1200);
	KUNIT_ASSERT_TRUE(test, next_event(x, &at, EC_EVENT_SOE_NOTIFICATION, &e));
	KUNIT_EXPECT_EQ(test, e.arg[1], (u32)HOMING);
	KUNIT_EXPECT_EQ(test, e.arg[4], 3u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(soe_elements_of_idn_are_read),
	KUNIT_CASE(soe_elements_of_idn_are_written),
	KUNIT_CASE(soe_fragments_carry_lists_both_ways),
	KUNIT_CASE(soe_fragments_end_when_slave_refuses_early),
	KUNIT_CASE(soe_fragments_survive_lost_frames),
	KUNIT_CASE(soe_fragments_of_cancelled_read_disturb_no_other),
	KUNIT_CASE_PARAM(soe_hostile_answers_end_in_time, wrong_gen_params),
	KUNIT_CASE(soe_command_runs_ends_and_is_cancelled),
	KUNIT_CASE(soe_notifications_amid_fragments_are_events),
	KUNIT_CASE(soe_emergencies_are_events),
	KUNIT_CASE(soe_command_end_is_notified),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_soe_whole",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
