// SPDX-License-Identifier: GPL-2.0-only
/* Logical addresses: apart, shared in each way; one image, whatever the wire has. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

/* bytes each way; channels are bytes */
static const struct slave {
	u32 out;
	u32 in;
} slaves[] = {
	{ 64, 64 }, { 64, 128 }, { 128, 64 }, { 0, 64 }, { 128, 0 }, { 64, 128 },
};

#define N	ARRAY_SIZE(slaves)

/* what an output is wired to; slaves by position, channels from 1 */
static const struct wire {
	u32 from;
	u32 out;
	u32 to;
	u32 in;
} wires[] = {
	{ 0, 1, 0, 1 }, { 0, 64, 0, 64 }, { 1, 1, 1, 128 }, { 1, 64, 1, 64 },
	{ 2, 1, 2, 1 }, { 2, 128, 2, 64 }, { 4, 1, 3, 1 }, { 4, 128, 3, 64 },
	{ 5, 1, 5, 1 }, { 5, 64, 5, 128 }, { 2, 65, 1, 1 }, { 2, 2, 5, 64 },
};

static void options(struct cyc *c, u32 domain, u32 options)
{
	struct ec_ioc_domain_options o = { .domain = domain, .options = options };

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_DOMAIN_OPTIONS, &o), 0, "%s",
			    c->b->app.reason);
}

static void overlap(struct cyc *c, u32 config)
{
	struct ec_ioc_sc_overlap o = { .config = config, .overlap = 1 };

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_OVERLAP, &o), 0, "%s",
			    c->b->app.reason);
}

static const struct layout {
	const char *name;
	u32 options;
	u32 own;	/* configurations that overlap by themselves, bit n */
	u32 no_lrw;	/* slaves that lack LRW, bit n */
	u32 dgrams;
	u32 bytes;	/* of data in them */
	u32 expected;
} layouts[] = {
	{ "apart", 0, 0, 0, 1, 896, 15 },
	{ "own", 0, 0x3f, 0, 1, 640, 15 },
	{ "one_of_them", 0, 0x01, 0, 1, 832, 15 },
	{ "domain", EC_DOMAIN_OPT_OVERLAP, 0, 0, 1, 512, 15 },
	{ "separate", EC_DOMAIN_OPT_SEPARATE, 0, 0, 2, 896, 10 },
	{ "domain_without_lrw", EC_DOMAIN_OPT_OVERLAP, 0, 0x02, 2, 896, 10 },
	{ "own_without_lrw", 0, 0x3f, 0x20, 2, 896, 10 },
	{ "own_frame", EC_DOMAIN_OPT_OWN_FRAME, 0, 0, 1, 896, 15 },
};

static void layout_desc(const struct layout *l, char *desc)
{
	strscpy(desc, l->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(layout, layouts, layout_desc);

static struct bus *segment(struct kunit *test, u32 no_lrw)
{
	char text[1024];
	struct bus *b;
	u32 i, n = scnprintf(text, sizeof(text), "segment seed=41 transition=1ms\n");

	for (i = 0; i < N; i++)
		n += scnprintf(text + n, sizeof(text) - n, "slave s%u io in=%u out=%u\n", i + 1,
			       8 * slaves[i].in, 8 * slaves[i].out);
	for (i = 0; i < ARRAY_SIZE(wires); i++)
		n += scnprintf(text + n, sizeof(text) - n, "connect s%u.%u -> s%u.%u\n",
			       wires[i].from + 1, wires[i].out, wires[i].to + 1, wires[i].in);
	b = bus_new(test, text);
	for (i = 0; i < N; i++)
		if (no_lrw & BIT(i)) {
			struct ec_esc *esc = bus_esc(b, i);

			esc->cfg.features |= EC_FEAT_NO_LRW;
			put_unaligned_le16(esc->cfg.features, esc->mem + EC_REG_FEATURES);
		}
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	return b;
}

/* All slaves in one domain of these options. */
static struct cyc *configured(struct kunit *test, const struct layout *l)
{
	struct cyc *c = cyc_new(segment(test, l->no_lrw), 1000);
	u32 i;

	cyc_domain(c);
	options(c, 0, l->options);
	cyc_map_all(c, 0, N, 0);
	for (i = 0; i < N; i++)
		if (l->own & BIT(i))
			overlap(c, cyc_config(c, i));
	return c;
}

static struct cyc *in_op(struct kunit *test, const struct layout *l)
{
	struct cyc *c = configured(test, l);

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	cyc_run(c, 5);
	c->incomplete = 0;
	return c;
}

static u8 *output(struct cyc *c, u32 slave, u32 channel)
{
	return cyc_pd(c, slave, 0) + channel - 1;
}

static u8 *input(struct cyc *c, u32 slave, u32 channel)
{
	return cyc_pd(c, slave, 1) + channel - 1;
}

static u8 pattern(u32 round, u32 slave, u32 channel)
{
	return 1 + (round * 37 + slave * 101 + channel * 7) % 255;
}

static void write_outputs(struct cyc *c, u32 round)
{
	u32 i, k;

	for (i = 0; i < N; i++)
		for (k = 1; k <= slaves[i].out; k++)
			*output(c, i, k) = pattern(round, i, k);
}

/* Each slave has got every byte of its outputs. */
static void check_outputs(struct cyc *c, u32 round, u32 missing)
{
	char name[8];
	u32 i, k, wrong = 0;

	for (i = 0; i < N; i++) {
		if (missing & BIT(i))
			continue;
		snprintf(name, sizeof(name), "s%u", i + 1);
		for (k = 1; k <= slaves[i].out; k++)
			wrong += (u8)ec_app_channel(bus_app(c->b, name), EC_APP_OUT, k - 1) !=
				 pattern(round, i, k);
	}
	KUNIT_EXPECT_EQ_MSG(c->b->test, wrong, 0u, "round %u", round);
}

/* What is wired shows what was sent, all other inputs are zero. */
static void check_inputs(struct cyc *c, u32 round)
{
	u32 i, k, w, wrong = 0;

	for (i = 0; i < N; i++)
		for (k = 1; k <= slaves[i].in; k++) {
			u8 want = 0;

			for (w = 0; w < ARRAY_SIZE(wires); w++)
				if (wires[w].to == i && wires[w].in == k)
					want = pattern(round, wires[w].from, wires[w].out);
			wrong += *input(c, i, k) != want;
		}
	KUNIT_EXPECT_EQ_MSG(c->b->test, wrong, 0u, "round %u", round);
}

static u32 data_bytes(const struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < bus_n_dgrams(b); i++)
		n += bus_dgrams(b)[i].len;
	return n;
}

/* Every byte arrives, each way, and the application's image is always the same. */
static void layout_echo(struct kunit *test)
{
	const struct layout *l = test->param_value;
	struct cyc *c = in_op(test, l);
	u32 i, round, offset = 0;

	KUNIT_EXPECT_EQ(test, bus_n_dgrams(c->b), l->dgrams);
	KUNIT_EXPECT_EQ(test, data_bytes(c->b), l->bytes);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->expected, l->expected);
	KUNIT_EXPECT_EQ(test, bus_domain(c->b, 0)->size, 896u);
	for (i = 0; i < N; i++) {
		if (slaves[i].out)
			KUNIT_EXPECT_PTR_EQ(test, output(c, i, 1), cyc_data(c, 0) + offset);
		offset += slaves[i].out;
		if (slaves[i].in)
			KUNIT_EXPECT_PTR_EQ(test, input(c, i, 1), cyc_data(c, 0) + offset);
		offset += slaves[i].in;
	}
	for (round = 0; round < 5; round++) {
		write_outputs(c, round);
		cyc_run(c, 4);
		check_outputs(c, round, 0);
		check_inputs(c, round);
	}
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->working_counter, l->expected);
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->frames, bus_plain_wire(c->b)->frames);
	KUNIT_EXPECT_EQ(test, bus_last_wire(c->b)->ns, bus_plain_wire(c->b)->ns);
}

/*
 * One slave takes no part for a while: its own inputs hold, the others' hold,
 * too, where outputs were sent in their place, and nothing ever shows those.
 */
static void layout_missing(struct kunit *test)
{
	const struct layout *l = test->param_value;
	bool hold = l->dgrams == 1 && l->bytes < 896;
	struct cyc *c = in_op(test, l);
	u8 before;

	write_outputs(c, 1);
	cyc_run(c, 4);
	check_inputs(c, 1);
	before = *input(c, 1, 128);
	bus_fault(c->b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0);
	write_outputs(c, 2);
	/* before the monitor has noticed and after that */
	cyc_run(c, 4);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 1);
	KUNIT_EXPECT_LT(test, cyc_state(c, 0)->working_counter, l->expected);
	check_outputs(c, 2, BIT(1));
	KUNIT_EXPECT_EQ(test, *input(c, 1, 128), before);
	/* shared with itself only: apart from slave 0 in "one_of_them" all go on */
	KUNIT_EXPECT_EQ(test, *input(c, 0, 1), pattern(hold ? 1 : 2, 0, 1));
	KUNIT_EXPECT_EQ(test, *input(c, 3, 64),
			pattern(l->options & EC_DOMAIN_OPT_OVERLAP && hold ? 1 : 2, 4, 128));
	cyc_run(c, 200);
	KUNIT_EXPECT_EQ(test, *input(c, 1, 128), before);
	bus_fault(c->b, EC_SIM_FAULT_DEAD, 1, 0, 0, 0);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	check_outputs(c, 2, 0);
	check_inputs(c, 2);
}

/* A slave that is taken out of the exchange: the same, until it runs again. */
static void layout_not_running(struct kunit *test)
{
	static const struct layout l = { .options = EC_DOMAIN_OPT_OVERLAP };
	struct cyc *c = in_op(test, &l);
	u32 i;

	write_outputs(c, 1);
	cyc_run(c, 4);
	bus_request(c->b, 2, EC_AL_INIT);
	for (i = 0; i < 100 && bus_slave(c->b, 2)->al.status != EC_AL_INIT; i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_EQ(test, bus_slave(c->b, 2)->al.status, EC_AL_INIT);
	cyc_run(c, 4);
	write_outputs(c, 2);
	cyc_run(c, 4);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 1);
	check_outputs(c, 2, BIT(2));
	KUNIT_EXPECT_EQ(test, *input(c, 0, 1), pattern(1, 0, 1));
	bus_request(c->b, 2, EC_AL_OP);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	check_inputs(c, 2);
}

/* Inputs never lie where a slave behind has its outputs, however they are registered. */
static void layout_inputs_first(struct kunit *test)
{
	struct cyc *c = cyc_new(segment(test, 0), 1000);
	u32 i, j, k, config[N];

	cyc_domain(c);
	options(c, 0, EC_DOMAIN_OPT_OVERLAP);
	for (i = N; i-- > 0;)
		config[i] = cyc_config(c, i);
	for (i = N; i-- > 0;)
		if (slaves[i].in)
			cyc_map(c, config[i], 1, 0);
	for (i = 0; i < N; i++)
		if (slaves[i].out)
			cyc_map(c, config[i], 0, 0);
	cyc_activate(c);
	for (i = 0; i < bus_wanted(c->b)->n_configs; i++)
		for (j = 0; j < bus_wanted(c->b)->n_configs; j++)
			for (k = 0; k < 4; k++) {
				const struct ec_config *a = bus_config(c->b, i);
				const struct ec_config *b = bus_config(c->b, j);
				const struct ec_config_fmmu *in = &a->fmmus[k & 1];
				const struct ec_config_fmmu *out = &b->fmmus[k >> 1];

				if ((k & 1) >= a->n_fmmus || (k >> 1) >= b->n_fmmus ||
				    in->dir != EC_CFG_DIR_INPUT || out->dir != EC_CFG_DIR_OUTPUT ||
				    a->position >= b->position)
					continue;
				KUNIT_EXPECT_TRUE(test, in->logical + in->size <= out->logical ||
						  out->logical + out->size <= in->logical);
			}
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	write_outputs(c, 3);
	cyc_run(c, 5);
	check_outputs(c, 3, 0);
	check_inputs(c, 3);
	KUNIT_EXPECT_EQ(test, data_bytes(c->b), 512u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(layout_echo, layout_gen_params),
	KUNIT_CASE_PARAM(layout_missing, layout_gen_params),
	KUNIT_CASE(layout_not_running),
	KUNIT_CASE(layout_inputs_first),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_layout",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
