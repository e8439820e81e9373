// SPDX-License-Identifier: GPL-2.0-only
/* Configuration to OP and process data. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

#define BENCH	22	/* slaves of the built-in bench */

/* the whole bench in OP, everything in one domain */
static struct cyc *bench_op(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", BENCH);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, BENCH, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 10);
	c->incomplete = 0;
	return c;
}

static void op_bench(struct kunit *test)
{
	struct cyc *c = bench_op(test);
	struct bus *b = c->b;

	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, cyc_state(c, 0)->expected);
	/* outputs 1 and 2 of the EL1859 are wired to its inputs 5 and 2 */
	*cyc_pd(c, 1, 0) = 0x01;
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, 1, 1) & 0x12, 0x10);
	*cyc_pd(c, 1, 0) = 0x02;
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, 1, 1) & 0x12, 0x02);
	/* an analog output far away, over the tree */
	put_unaligned_le16(12345, cyc_pd(c, 14, 2));
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "ao2"), EC_APP_OUT, 0), 12345ll);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

static void op_mapping_rewritten(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave d drive in=22 out=22 mapping=rewritable\n", 1);
	struct ec_app *app = bus_app(b, "d");
	const struct ec_app_entry *e;
	u32 out, in, config, i;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	config = cyc_config(c, 0);
	cyc_remap(c, config);
	out = cyc_map(c, config, 2, 0);
	in = cyc_map(c, config, 3, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 2000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	KUNIT_EXPECT_EQ(test, app->bytes[EC_APP_OUT], 8);
	KUNIT_EXPECT_EQ(test, app->bytes[EC_APP_IN], 12);
	for (i = 0; i < ARRAY_SIZE(cyc_new_in); i++)
		KUNIT_EXPECT_EQ(test,
				ec_app_od_get(app, ec_app_od_entry(app->model, 0x1a00, i + 1)),
				(u64)cyc_new_in[i]);
	/* a torque arrives where the mapping says */
	put_unaligned_le16(77, cyc_data(c, 0) + out + 6);
	cyc_run(c, 5);
	e = ec_app_od_entry(app->model, 0x6071, 0);
	KUNIT_EXPECT_EQ(test, ec_app_od_get(app, e), 77ull);
	e = ec_app_od_entry(app->model, 0x6041, 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_data(c, 0) + in), (u16)ec_app_od_get(app, e));
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

static void op_several_domains(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave o EL2008\nslave i EL1008\n"
			       "slave x EL1859\nconnect o.1 -> i.1\n", 4);
	u32 cfg[3], out, in;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_domain(c);
	cyc_domain(c);
	cfg[0] = cyc_config(c, 1);
	cfg[1] = cyc_config(c, 2);
	cfg[2] = cyc_config(c, 3);
	out = cyc_map(c, cfg[0], 0, 0);
	in = cyc_map(c, cfg[1], 0, 1);
	cyc_map(c, cfg[2], 0, 2);
	cyc_map(c, cfg[2], 1, 2);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 2000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 1)->working_counter, 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 2)->working_counter, 3);
	cyc_data(c, 0)[out] = 1;
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_data(c, 1)[in] & 1, 1);

	/* a domain that is not queued stands still, the others go on */
	c->queued = BIT_ULL(0) | BIT_ULL(2);
	cyc_data(c, 0)[out] = 0;
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_data(c, 1)[in] & 1, 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 2)->wc_state, 2);
	c->queued |= BIT_ULL(1);
	cyc_run(c, 3);
	KUNIT_EXPECT_EQ(test, cyc_data(c, 1)[in] & 1, 0);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* A slave without LRW gets LRD and LWR, and its data are right. */
static void op_without_lrw(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\nslave x EL1859\nconnect x.1 -> x.1\n");
	struct ec_esc *esc = bus_esc(b, 1);
	struct cyc *c;
	u32 i;

	esc->cfg.features |= EC_FEAT_NO_LRW;
	put_unaligned_le16(esc->cfg.features, esc->mem + EC_REG_FEATURES);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 1000), ~0ull);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	KUNIT_EXPECT_GE(test, bus_n_dgrams(b), 2u);
	for (i = 0; i < bus_n_dgrams(b); i++)
		KUNIT_EXPECT_NE(test, bus_dgrams(b)[i].cmd, EC_CMD_LRW);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 2000), ~0ull);
	*cyc_pd(c, 1, 0) = 1;
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, *cyc_pd(c, 1, 1) & 1, 1);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, 2);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* 24 slaves of 200 bytes each way: several datagrams, several frames. */
static void op_many_frames(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=9\nrepeat 24 slave s io in=1600 out=1600\n", 24);
	struct cyc *c;
	char name[16];
	u64 frames;
	u32 i, k;

	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 24, 0);
	cyc_activate(c);
	KUNIT_EXPECT_GT(test, bus_n_dgrams(b), 6u);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	for (i = 0; i < 24; i++)
		for (k = 0; k < 50; k++)
			put_unaligned_le32(i * 31 + k * 0x01000193, cyc_pd(c, i, 0) + 4 * k);
	cyc_run(c, 5);
	for (i = 0; i < 24; i++) {
		snprintf(name, sizeof(name), "s%u", i + 1);
		for (k = 0; k < 50; k++)
			KUNIT_EXPECT_EQ_MSG(test,
					    (u32)ec_app_channel(bus_app(b, name), EC_APP_OUT, k),
					    i * 31 + k * 0x01000193, "%s channel %u", name, k);
	}
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	frames = bus_frames(b);
	c->incomplete = 0;
	cyc_run(c, 100);
	KUNIT_EXPECT_GE(test, bus_frames(b) - frames, 400ull);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* An entry that is not mapped is refused with a reason. */
static void op_entry_not_there(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=9\nrepeat 3 slave s io in=64 out=64\n", 3);
	struct ec_ioc_reg_entry r = {
		.flags = EC_REG_ENTRY_BY_POS, .sm = 0, .pdo_pos = 9,
	};
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_config(c, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &r), -ENOENT);
	KUNIT_EXPECT_NE(test, b->app.reason[0], '\0');
}

/* Process data that were changed after they were registered are refused, with what is wrong. */
static void op_map_first(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave s io in=64 out=64\n", 1);
	struct ec_ioc_activate act = { 0 };
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_config(c, 0);
	cyc_map(c, 0, 0, 0);
	cyc_pdo(c, 0, EC_SC_PDO_ASSIGN_CLEAR, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &act), -EBUSY);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(b->app.reason,
		"slave 0:0: SM0 was registered in domain 0 with 8 bytes of outputs; now it has 0 of outputs"),
				  "%s", b->app.reason);
}

/* What one application has mapped does not answer in place of the next one's. */
static void op_next_application(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EL1008\nslave b EL1008\nconst a.1 value=1\n"
			       "const b.2 value=1\n", 2);
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 2000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_data(c, 0)[0], 1);
	cyc_release(c);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 1000), ~0ull);
	bus_idle(b);

	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 2000), ~0ull);
	cyc_run(c, 5);
	KUNIT_EXPECT_EQ(test, cyc_data(c, 0)[0], 2);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, 1);
}

/* AL state of the first slave, which nobody has configured, beside one in OP */
static u8 beside(struct kunit *test, const char *text)
{
	struct bus *b = bus_up(test, text, 2);
	struct cyc *c;
	u8 state;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 2000), ~0ull);
	cyc_run(c, 500);
	state = bus_slave(b, 0)->al.status;
	KUNIT_EXPECT_EQ(test, bus_al_states(b), EC_AL_OP | state);
	cyc_release(c);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 1000), ~0ull);
	return state;
}

/* The reference clock goes to OP with the others, unless it has outputs. */
static void op_reference(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, beside(test, "slave a EK1100\nslave b EL2008\n"), EC_AL_OP);
}

static void op_reference_outputs(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, beside(test, "slave a EL2008\nslave b EL2008\n"), EC_AL_PREOP);
}

/* AL states of the bus are those of now, at whatever moment of a poll the last slave comes to OP. */
static void op_al_states(struct kunit *test)
{
	static const char *text = "slave a EK1100\nslave b EL2008\nslave c EL1008 transition=7ms\n";
	struct bus *b = bus_up(test, text, 3);
	u32 i;

	bus_idle(b);
	for (i = 0; i < 40; i++) {
		struct cyc *c = cyc_new(b, 1000);

		cyc_domain(c);
		cyc_map_all(c, 0, 3, 0);
		cyc_activate(c);
		KUNIT_EXPECT_NE(test, cyc_wait_op(c, 2000), ~0ull);
		cyc_run(c, 300);
		KUNIT_EXPECT_EQ_MSG(test, bus_al_states(b), (u32)EC_AL_OP, "attempt %u", i);
		cyc_release(c);
		KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 1000), ~0ull);
		usleep_range(500 * i, 500 * i + 1);
	}
}

static struct kunit_case op_cases[] = {
	KUNIT_CASE(op_bench),
	KUNIT_CASE(op_mapping_rewritten),
	KUNIT_CASE(op_several_domains),
	KUNIT_CASE(op_without_lrw),
	KUNIT_CASE(op_many_frames),
	KUNIT_CASE(op_entry_not_there),
	KUNIT_CASE(op_map_first),
	KUNIT_CASE(op_next_application),
	KUNIT_CASE(op_reference),
	KUNIT_CASE(op_reference_outputs),
	KUNIT_CASE(op_al_states),
	{}
};

static struct kunit_suite op_suite = {
	.name = "bus_op",
	.exit = bus_exit,
	.test_cases = op_cases,
};

kunit_test_suite(op_suite);

MODULE_LICENSE("GPL");
