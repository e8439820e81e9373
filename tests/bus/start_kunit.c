// SPDX-License-Identifier: GPL-2.0-only
/*
 * How long a few drives take from activation to OP beside a cycle of 1 ms, less what
 * they take themselves: two transitions and the replies to what is written to them. None
 * of them goes through INIT for that.
 */
#include <linux/moduleparam.h>
#include "kapp.h"
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"

#define LIMIT_US	200000
#define DC_LIMIT_US	50000	/* beyond the time until the clocks are set and SYNC0 starts */
#define DC_MAP_US	150000	/* the same when PDOs are written, which takes longer */
#define SYNC_LEAD_US	100000	/* from its programming to the first SYNC0 */
#define TRANSITION_US	1000
#define RESPONSE_US	200

/* start_kunit.debug=1 shows what the master asks for */
static unsigned int debug;
module_param(debug, uint, 0444);

/* what an application gives its drives */
enum mapping { AS_IS, SAME, NEW };

static const char *const mappings[] = { "PDOs as they are", "the same PDOs named",
					"mapping rewritten" };

struct start {
	u32 drives;
	bool dc;
	enum mapping mapping;
};

/* SDO transfers that the drive itself has to reply to */
static u32 transfers(const struct start *p)
{
	static const u32 n[] = { 0, 2 * (2 + 4), 2 * (2 + ARRAY_SIZE(cyc_new_in)) + 2 * 4 };

	return n[p->mapping];
}

static struct bus *drives(struct kunit *test, const struct start *p)
{
	char text[160];
	struct bus *b;

	snprintf(text, sizeof(text), "segment seed=21 response=%uus transition=%uus\n"
		 "repeat %u slave d drive in=22 out=22 drift=30ppm mapping=rewritable\n",
		 RESPONSE_US, TRANSITION_US, p->drives);
	b = bus_up(test, text, p->drives);
	bus_idle(b);
	return b;
}

/* what the drive has already, told once more */
static void name_pdos(struct cyc *c, u32 config)
{
	struct ec_slave *s = bus_slave(c->b, config);
	u32 sm, i, k;

	for (sm = 2; sm < s->n_sms; sm++) {
		const struct ec_pdo_list *l = &s->pdos.sm[sm];

		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, sm, 0, 0);
		for (i = 0; i < l->n; i++) {
			cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, sm, l->pdos[i].index, 0);
			cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, sm, l->pdos[i].index, 0);
			for (k = 0; k < l->pdos[i].n_entries; k++) {
				const struct ec_pdo_entry *e = &l->pdos[i].entries[k];

				cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, sm, l->pdos[i].index,
					(u32)e->index << 16 | e->sub << 8 | e->bits);
			}
		}
	}
}

static void tell_time(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

static struct cyc *configure(struct bus *b, const struct start *p)
{
	struct cyc *c = cyc_new(b, 1000);
	u32 i;

	cyc_domain(c);
	for (i = 0; i < p->drives; i++) {
		u32 config = cyc_config(c, i);
		struct ec_ioc_sc_dc dc = {
			.config = config, .assign_activate = 0x0300, .cycle0 = 1000000,
		};

		if (p->mapping == SAME)
			name_pdos(c, config);
		if (p->mapping == NEW)
			cyc_remap(c, config);
		cyc_map(c, config, 2, 0);
		cyc_map(c, config, 3, 0);
		if (p->dc)
			KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	}
	if (p->dc)
		c->each = tell_time;
	return c;
}

static u32 in_init(struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < bus_n_slaves(b); i++)
		n += (bus_esc(b, i)->mem[EC_REG_AL_STATUS] & EC_AL_STATE_MASK) == EC_AL_INIT;
	return n;
}

static u64 us_since(u64 t0)
{
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

/* Activate; bus time until all are in OP, and until the clocks are set, us. */
static u64 to_op(struct cyc *c, u64 *clocks)
{
	struct bus *b = c->b;
	u64 t0 = ktime_get_ns();
	u32 inits = 0;

	*clocks = 0;
	cyc_activate(c);
	while (!cyc_all_op(c)) {
		KUNIT_ASSERT_LT(b->test, us_since(t0), 5ull * USEC_PER_SEC);
		cyc_run(c, 1);
		inits += in_init(b);
		if (ec_dc_busy(bus_dc(b)))
			*clocks = us_since(t0);
	}
	KUNIT_EXPECT_EQ(b->test, inits, 0u);
	return us_since(t0);
}

static const struct start starts[] = {
	{ 1 }, { 2 }, { 5 },
	{ 1, .mapping = SAME }, { 5, .mapping = SAME },
	{ 1, .mapping = NEW }, { 2, .mapping = NEW }, { 5, .mapping = NEW },
	{ 1, .dc = true }, { 2, .dc = true }, { 5, .dc = true },
	{ 1, .dc = true, .mapping = NEW }, { 5, .dc = true, .mapping = NEW },
};

static void describe(const struct start *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%u drive(s)%s, %s", p->drives,
		 p->dc ? " with DC" : "", mappings[p->mapping]);
}

KUNIT_ARRAY_PARAM(start, starts, describe);

/* Twice: the second application finds the drives as the first one left them. */
static void start_to_op(struct kunit *test)
{
	const struct start *p = test->param_value;
	u64 us, clocks, own = 2 * TRANSITION_US + transfers(p) * RESPONSE_US;
	u64 limit = p->mapping == AS_IS ? DC_LIMIT_US : DC_MAP_US;
	char name[KUNIT_PARAM_DESC_SIZE];
	struct bus *b = drives(test, p);
	struct cyc *c;
	u32 i;

	describe(p, name);
	for (i = 0; i < 2; i++) {
		c = configure(b, p);
		bus_idle(b);
		bus_base(b)->debug = debug;
		us = to_op(c, &clocks);
		bus_base(b)->debug = 0;
		if (p->dc) {
			bus_figure("activation to OP, %s, application %u: %llu us of bus time, of which the clocks take %llu us and SYNC0 begins %u us later",
				   name, i + 1, us, clocks, SYNC_LEAD_US);
			us -= min(us, clocks + SYNC_LEAD_US);
			bus_row(us, limit,
				"us of bus time from activation to OP beyond clocks and SYNC0: %s, application %u",
				name, i + 1);
			KUNIT_EXPECT_LT(test, us, limit);
		} else {
			bus_row(us - own, LIMIT_US,
				"us of bus time from activation to OP without the drives' own: %s, application %u",
				name, i + 1);
			KUNIT_EXPECT_LT(test, us, own + LIMIT_US);
		}
		cyc_release(c);
		bus_idle(b);
	}
}

/* The same through the functions for the kernel. */
static void start_kernel_api(struct kunit *test)
{
	const struct start p = { .drives = 5 };
	struct bus *b = drives(test, &p);
	struct kapp *k = kapp_new(b, 1000);
	u32 i, inits = 0;
	u64 us, t0;

	for (i = 0; i < p.drives; i++)
		kapp_map(k, i);
	t0 = ktime_get_ns();
	kapp_activate(k);
	for (i = 0; i < 5000 && !kapp_all_op(k); i++) {
		kapp_run(k, 1);
		inits += in_init(b);
	}
	us = us_since(t0) - 2 * TRANSITION_US;
	bus_row(us, LIMIT_US,
		"us of bus time from activation to OP without the drives' own: 5 drives, kernel API");
	KUNIT_EXPECT_LT(test, us, (u64)LIMIT_US);
	KUNIT_EXPECT_EQ(test, inits, 0u);
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(start_to_op, start_gen_params),
	KUNIT_CASE(start_kernel_api),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_start", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
