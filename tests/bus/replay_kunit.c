// SPDX-License-Identifier: GPL-2.0-only
/* What an application has written itself is written again to a slave that returns. */
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"
#include "master/mailbox/coe.h"
#include "replay.h"

#define WORDS	0x0f80	/* registers of the device */

static void put_idn(struct cyc *c, u8 drive, u16 idn, u64 value, u32 size)
{
	struct ec_ioc_soe i = {
		.idn = idn, .drive = drive, .slave.position = DRIVE, .size = size,
		.data = (uintptr_t)&value,
	};

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SOE_WRITE, &i), 0, "%s",
			    c->b->app.reason);
}

static u32 reg(struct bus *b)
{
	return get_unaligned_le32(&bus_esc(b, DRIVE)->mem[WORDS]);
}

/* Active, but a tool keeps the slave in PREOP until cyc_wait_op() after bus_request(). */
static void into_preop(struct cyc *c)
{
	cyc_activate(c);
	bus_request(c->b, DRIVE, EC_AL_PREOP);
	cyc_run(c, 200);
	KUNIT_ASSERT_EQ(c->b->test, bus_slave(c->b, DRIVE)->al.status, EC_AL_PREOP);
	KUNIT_ASSERT_FALSE(c->b->test, bus_config(c->b, 0)->replay.was_op);
}

static void then_op(struct cyc *c)
{
	KUNIT_ASSERT_FALSE(c->b->test, bus_config(c->b, 0)->replay.was_op);
	bus_request(c->b, DRIVE, EC_AL_OP);
	KUNIT_ASSERT_NE(c->b->test, cyc_wait_op(c, 5000), ~0ull);
}

static void returns(struct cyc *c)
{
	replay_power_off(c);
	replay_power_on(c);
	KUNIT_ASSERT_NE(c->b->test, cyc_wait_op(c, 5000), ~0ull);
}

/* The last values, from each way in which they are written; none of those after OP. */
static void replay_returned_slave_gets_values(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	u32 sdo = req_add(c, 0, EC_REQUEST_SDO, 4), soe = req_add(c, 0, EC_REQUEST_SOE, 4);
	u32 word = req_add(c, 0, EC_REQUEST_REG, 4), late = req_add(c, 0, EC_REQUEST_SDO, 4);
	u64 before = replay_value(b, TYPES, 6, 1);
	struct ec_ioc_config_write i;
	char text[EC_UAPI_WARNING];
	u64 v;

	replay_put(c, TYPES, 4, 1, 4);
	replay_put(c, TYPES, 3, 0x1234, 2);
	replay_put(c, TYPES, 4, 2, 4);
	put_idn(c, 1, 91, 4321, 4);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 3u);
	KUNIT_ASSERT_TRUE(test, replay_entry(c, 1, &i, &v));
	KUNIT_EXPECT_EQ(test, i.object, TYPES);
	KUNIT_EXPECT_EQ(test, i.subindex, 4);
	KUNIT_EXPECT_EQ(test, v, 2ull);
	into_preop(c);
	put_unaligned_le32(77, req_data(c, sdo));
	KUNIT_ASSERT_EQ(test, req_do(c, sdo, TYPES, 8, EC_REQUEST_OP_WRITE, 4), 0);
	put_unaligned_le32(5555, req_data(c, soe));
	KUNIT_ASSERT_EQ(test, req_do(c, soe, 91, 0, EC_REQUEST_OP_WRITE, 4), 0);
	put_unaligned_le32(0xabcd, req_data(c, word));
	KUNIT_ASSERT_EQ(test, req_do(c, word, WORDS, 0, EC_REQUEST_OP_WRITE, 4), 0);
	then_op(c);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 6u);
	*req_data(c, late) = 9;
	KUNIT_ASSERT_EQ(test, req_do(c, late, TYPES, 6, EC_REQUEST_OP_WRITE, 1), 0);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 6, 1), 9ull);
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &b->app, TYPES, 4, 3, 4), 0);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 6u);
	replay_power_off(c);
	replay_power_on(c);
	cyc_run(c, 2);
	KUNIT_EXPECT_NE(test, replay_value(b, TYPES, 4, 4), 3ull);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 2ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 3, 2), 0x1234ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 8, 4), 77ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 6, 1), before);
	KUNIT_EXPECT_EQ(test, reg(b), 0xabcdu);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 6u);
	ec_slave_warning(bus_slave(b, DRIVE), text, sizeof(text));
	KUNIT_EXPECT_STREQ(test, text, "");
}

static void replay_idn_is_written_again(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct ec_ioc_soe i = { .idn = 91, .drive = 1, .slave.position = DRIVE };
	u64 v = 0;

	put_idn(c, 1, 91, 4321, 4);
	replay_into_op(c);
	returns(c);
	cyc_release(c);
	i.size = sizeof(v);
	i.data = (uintptr_t)&v;
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SOE_READ, &i), 0);
	KUNIT_EXPECT_EQ(test, v, 4321ull);
}

static void write_words(struct cyc *c, u32 request, u32 v, u32 size)
{
	put_unaligned_le32(v, req_data(c, request));
	KUNIT_ASSERT_EQ(c->b->test,
			req_do(c, request, WORDS, 0, EC_REQUEST_OP_WRITE, size), 0);
}

/* In the order of the first writes it were 0x33332222. */
static void replay_order_is_of_last_writes(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	u32 word = req_add(c, 0, EC_REQUEST_REG, 4);

	into_preop(c);
	write_words(c, word, 0x11111111, 4);
	write_words(c, word, 0x2222, 2);
	write_words(c, word, 0x33333333, 4);
	then_op(c);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 2u);
	returns(c);
	KUNIT_EXPECT_EQ(test, reg(c->b), 0x33333333u);
}

/* Only a slave that was in OP returns: until then the slave keeps what it has. */
static void replay_first_configuration_writes_nothing(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	u8 other[4] = { 6 };
	u32 abort;

	replay_put(c, TYPES, 4, 5, 4);
	KUNIT_ASSERT_EQ(test,
			ec_coe_download(bus_mbox(b, DRIVE), TYPES, 4, false, other, 4, &abort,
					NULL), 0);
	replay_into_op(c);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 6ull);
	returns(c);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 5ull);
}

/* A tool that takes the slave to PREOP and back does not undo what was written in OP. */
static void replay_needs_way_through_init(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;

	replay_put(c, TYPES, 4, 5, 4);
	replay_into_op(c);
	KUNIT_ASSERT_EQ(test, replay_put_of(b, &b->app, TYPES, 4, 6, 4), 0);
	bus_request(b, DRIVE, EC_AL_PREOP);
	cyc_run(c, 200);
	KUNIT_ASSERT_EQ(test, bus_slave(b, DRIVE)->al.status, EC_AL_PREOP);
	bus_request(b, DRIVE, EC_AL_OP);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 6ull);
	bus_request(b, DRIVE, EC_AL_INIT);
	cyc_run(c, 200);
	bus_request(b, DRIVE, EC_AL_OP);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 5ull);
}

static void replay_tool_is_not_recorded(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	struct ec_file tool;

	ec_file_init(&tool, b->m, true);
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &tool, TYPES, 4, 5, 4), 0);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 0u);
	/* nor what a slave refuses */
	KUNIT_EXPECT_EQ(test, replay_put_of(b, &b->app, 0x1018, 1, 5, 4), -EIO);
	KUNIT_EXPECT_EQ(test, replay_entries(c), 0u);
	replay_into_op(c);
	returns(c);
	KUNIT_EXPECT_NE(test, replay_value(b, TYPES, 4, 4), 5ull);
}

static void replay_filter_has_reasons(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct ec_ioc_sc_replay r = { .flags = EC_SC_REPLAY_SDO, .object = 0x607a };
	char text[EC_UAPI_WARNING];
	u8 startup[4] = { 42 };
	struct ec_ioc_sc_sdo sdo = {
		.index = TYPES, .subindex = 8, .size = 4, .data = (uintptr_t)startup,
	};

	replay_put(c, 0x6040, 0, 6, 2);
	replay_put(c, 0x607a, 0, 1000, 4);
	replay_put(c, 0x6060, 0, 8, 1);
	replay_put(c, TYPES, 8, 41, 4);
	replay_put(c, TYPES, 4, 5, 4);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_SDO, &sdo), 0);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x6040, 0), (u32)EC_REPLAY_WHY_CONTROL);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x607a, 0), (u32)EC_REPLAY_WHY_TARGET);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x6060, 0), (u32)EC_REPLAY_WHY_OUTPUT);
	KUNIT_EXPECT_EQ(test, replay_not(c, TYPES, 8), (u32)EC_REPLAY_WHY_STARTUP);
	KUNIT_EXPECT_EQ(test, replay_not(c, TYPES, 4), (u32)EC_REPLAY_WHY_NONE);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &r), 0);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x607a, 0), (u32)EC_REPLAY_WHY_NONE);
	replay_into_op(c);
	returns(c);
	KUNIT_EXPECT_EQ(test, replay_value(c->b, TYPES, 8, 4), 42ull);
	ec_slave_warning(bus_slave(c->b, DRIVE), text, sizeof(text));
	HAS(test, text, "returned, 2 write(s) of the application not replayed: ");
	HAS(test, text, ": 0x6040:00 (control word), 0x6060:00 (mapped to outputs)");
	KUNIT_EXPECT_NULL(test, strstr(text, "config -v"));
}

static void replay_modes(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct ec_ioc_sc_replay none = { .mode = EC_REPLAY_MODE_NONE };
	struct ec_ioc_sc_replay all = { .mode = EC_REPLAY_MODE_ALL };
	struct ec_ioc_sc_replay bad = { .mode = EC_REPLAY_MODES };
	struct ec_ioc_sc_replay name = {
		.flags = EC_SC_REPLAY_SDO, .object = TYPES, .subindex = 3,
	};
	struct ec_ioc_sc_replay idn = { .flags = EC_SC_REPLAY_IDN, .subindex = 8 };
	char text[EC_UAPI_WARNING];
	u32 i;

	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &bad), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &idn), -EINVAL);
	replay_put(c, 0x6040, 0, 6, 2);
	replay_put(c, TYPES, 3, 7, 2);
	replay_put(c, TYPES, 4, 5, 4);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &all), 0);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x6040, 0), (u32)EC_REPLAY_WHY_NONE);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &none), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &name), 0);
	KUNIT_EXPECT_EQ(test, replay_not(c, TYPES, 4), (u32)EC_REPLAY_WHY_OFF);
	for (i = 0; i < EC_MAX_SC_REPLAYS - 1; i++) {
		name.object = i;
		KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &name), 0);
	}
	/* one that is named already */
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &name), 0);
	name.object = i;
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &name), -ENOSPC);
	replay_into_op(c);
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REPLAY, &all), -EBUSY);
	returns(c);
	KUNIT_EXPECT_EQ(test, replay_value(c->b, TYPES, 3, 2), 7ull);
	KUNIT_EXPECT_NE(test, replay_value(c->b, TYPES, 4, 4), 5ull);
	ec_slave_warning(bus_slave(c->b, DRIVE), text, sizeof(text));
	KUNIT_EXPECT_STREQ(test, text, "");
}

/* An application may write before it makes the configuration. */
static void replay_write_before_configuration(struct kunit *test)
{
	struct cyc *c = replay_reserve(test);
	struct bus *b = c->b;

	replay_put(c, TYPES, 4, 4, 4);
	replay_put(c, TYPES, 4, 5, 4);
	KUNIT_EXPECT_EQ(test, bus_wanted(b)->strays.n, 1u);
	cyc_config(c, 0);
	KUNIT_EXPECT_EQ(test, bus_config(b, 0)->replay.n, 0u);
	cyc_config(c, DRIVE);
	KUNIT_EXPECT_EQ(test, bus_wanted(b)->strays.n, 0u);
	KUNIT_EXPECT_EQ(test, bus_config(b, 1)->replay.n, 1u);
	replay_put(c, TYPES, 4, 6, 4);
	KUNIT_EXPECT_EQ(test, bus_config(b, 1)->replay.n, 1u);
	KUNIT_EXPECT_EQ(test, bus_config(b, 1)->replay.bytes, 4u);
}

static void replay_is_freed_with_session(struct kunit *test)
{
	struct cyc *c = replay_reserve(test);
	struct bus *b = c->b;
	long before;

	replay_put(c, TYPES, 3, 4, 2);
	cyc_config(c, 0);
	bus_end(b);
	KUNIT_EXPECT_EQ(test, bus_memory(b), 0l);
	c = cyc_new(b, 1000);
	KUNIT_EXPECT_EQ(test, bus_wanted(b)->strays.n, 0u);
	cyc_config(c, DRIVE);
	before = bus_memory(b);
	replay_put(c, TYPES, 3, 4, 2);
	KUNIT_EXPECT_GT(test, bus_memory(b), before);
	bus_end(b);
	KUNIT_EXPECT_EQ(test, bus_memory(b), 0l);
}

static void record(struct cyc *c, u8 type, u16 index, u32 size)
{
	static u8 data[1000];
	struct ec_startup what = { .type = type, .index = index, .size = size };

	bus_lock(c->b);
	ec_replay_record(bus_wanted(c->b), bus_slave(c->b, DRIVE), &what, data);
	bus_unlock(c->b);
}

/* The oldest lose their value, then their place in the list. */
static void replay_record_is_limited(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct ec_replay *r = &bus_config(c->b, 0)->replay;
	long empty = bus_memory(c->b);
	struct ec_ioc_config_write i;
	u64 v;
	u32 n;

	for (n = 0; n < 70; n++)
		record(c, EC_STARTUP_SDO, 0x2000 + n, 1000);
	KUNIT_EXPECT_EQ(test, r->n, 70u);
	KUNIT_EXPECT_EQ(test, r->n_values, 65u);
	KUNIT_EXPECT_EQ(test, r->bytes, 65000u);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x2004, 0), (u32)EC_REPLAY_WHY_LIMIT);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x2005, 0), (u32)EC_REPLAY_WHY_NONE);
	/* written again it is the newest */
	record(c, EC_STARTUP_SDO, 0x2004, 1000);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x2004, 0), (u32)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, replay_not(c, 0x2005, 0), (u32)EC_REPLAY_WHY_LIMIT);
	KUNIT_EXPECT_EQ(test, r->n, 70u);
	for (n = 0; n < 1100; n++)
		record(c, EC_STARTUP_SDO, 0x3000 + n, 4);
	KUNIT_EXPECT_EQ(test, r->n, (u32)EC_MAX_SC_LISTED);
	KUNIT_EXPECT_EQ(test, r->n_values, (u32)EC_MAX_SC_WRITES);
	KUNIT_EXPECT_EQ(test, r->bytes, 4u * EC_MAX_SC_WRITES);
	KUNIT_ASSERT_TRUE(test, replay_entry(c, 0, &i, &v));
	KUNIT_EXPECT_EQ(test, i.total, (u32)EC_MAX_SC_LISTED);
	KUNIT_EXPECT_EQ(test, i.forgotten, 70u + 1100u - EC_MAX_SC_LISTED);
	KUNIT_EXPECT_EQ(test, i.size, 0u);
	KUNIT_EXPECT_EQ(test, (u32)i.object, 0x3000u + 1100 - EC_MAX_SC_LISTED);
	KUNIT_EXPECT_EQ(test, bus_memory(c->b) - empty,
			(long)(EC_MAX_SC_LISTED * sizeof(struct ec_startup) + r->bytes));
}

/* The slave has the value, only the record does not; an old value must not be replayed. */
static void replay_without_memory_drops_value(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct ec_replay *r = &bus_config(c->b, 0)->replay;

	replay_put(c, TYPES, 4, 5, 4);
	bus_add_memory(c->b, EC_MAX_SESSION_BYTES);
	replay_put(c, TYPES, 3, 6, 2);
	replay_put(c, TYPES, 4, 6, 4);
	bus_add_memory(c->b, -(long)EC_MAX_SESSION_BYTES);
	KUNIT_EXPECT_EQ(test, r->n, 0u);
	KUNIT_EXPECT_EQ(test, r->n_values, 0u);
	KUNIT_EXPECT_EQ(test, r->forgotten, 2u);
	replay_into_op(c);
	returns(c);
	KUNIT_EXPECT_NE(test, replay_value(c->b, TYPES, 4, 4), 5ull);
}

/* It is lost again while the values are written, each time a little later. */
static void replay_interrupted_begins_again(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	u32 i, n, cut = 0;

	for (i = 2; i <= 9; i++)
		replay_put(c, TYPES, i, i, 1 << ((i - 2) % 4));
	replay_into_op(c);
	replay_power_off(c);
	for (n = 0; n < 8; n++) {
		/* a port with three losses in 10 s opens later */
		cyc_run(c, 6000);
		replay_power_on(c);
		for (i = 0; i < 3000 && replay_value(b, TYPES, 2, 1) != 2; i++)
			cyc_run(c, 1);
		cyc_run(c, 2 * n);
		cut += replay_value(b, TYPES, 2, 1) == 2 && replay_value(b, TYPES, 9, 8) != 9;
		replay_power_off(c);
	}
	KUNIT_EXPECT_GT(test, cut, 3u);
	cyc_run(c, 10000);
	replay_power_on(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	for (i = 2; i <= 9; i++)
		KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, i, 1 << ((i - 2) % 4)), (u64)i);
}

static void replay_refusal_has_reason(struct kunit *test)
{
	struct cyc *c = replay_configure(test);
	struct bus *b = c->b;
	struct ec_app_entry *e =
		(struct ec_app_entry *)ec_app_od_entry(bus_app(b, "a")->model, TYPES, 4);
	u16 access = e->access;
	char text[EC_UAPI_REASON];

	replay_put(c, TYPES, 3, 7, 2);
	replay_put(c, TYPES, 4, 5, 4);
	replay_into_op(c);
	replay_power_off(c);
	e->access &= ~(EC_OD_WRITE_PREOP | EC_OD_WRITE_SAFEOP | EC_OD_WRITE_OP);
	replay_power_on(c);
	cyc_run(c, 3000);
	KUNIT_EXPECT_FALSE(test, cyc_all_op(c));
	replay_why_text(c, text);
	HAS(test, text, "replayed SDO 0x2001:04 (4 byte(s)) failed: abort 0x06010002");
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->al.status, EC_AL_PREOP);
	e->access = access;
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESET, NULL), 0);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, replay_value(b, TYPES, 4, 4), 5ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(replay_returned_slave_gets_values),
	KUNIT_CASE(replay_idn_is_written_again),
	KUNIT_CASE(replay_order_is_of_last_writes),
	KUNIT_CASE(replay_first_configuration_writes_nothing),
	KUNIT_CASE(replay_needs_way_through_init),
	KUNIT_CASE(replay_tool_is_not_recorded),
	KUNIT_CASE(replay_filter_has_reasons),
	KUNIT_CASE(replay_modes),
	KUNIT_CASE(replay_write_before_configuration),
	KUNIT_CASE(replay_is_freed_with_session),
	KUNIT_CASE(replay_record_is_limited),
	KUNIT_CASE(replay_without_memory_drops_value),
	KUNIT_CASE(replay_interrupted_begins_again),
	KUNIT_CASE(replay_refusal_has_reason),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_replay", .test_cases = cases, .exit = bus_exit,
};
kunit_test_suite(suite);
