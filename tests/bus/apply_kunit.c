// SPDX-License-Identifier: GPL-2.0-only
/* What a slave is configured to, and when: PDOs, SyncManagers, and others' transfers. */
#include <linux/completion.h>
#include <linux/kthread.h>
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/mailbox/coe.h"
#include "master/boundary/ioctl.h"

static const char drive[] =
	"segment seed=17 response=2ms\nslave a drive in=22 out=22 mapping=rewritable\n";

static struct cyc *reserve(struct kunit *test, const char *text, u32 slaves)
{
	struct bus *b = bus_up(test, text, slaves);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	return c;
}

static void write_obj(struct bus *b, u16 index, u8 sub, u32 value, size_t bytes)
{
	u8 v[4];
	u32 abort;

	put_unaligned_le32(value, v);
	KUNIT_ASSERT_EQ(b->test,
			ec_coe_download(bus_mbox(b, 0), index, sub, false, v, bytes,
						 &abort, NULL), 0);
}

/* what an earlier application has left: two bytes of outputs */
static void map_two_bytes(struct bus *b)
{
	write_obj(b, 0x1c12, 0, 0, 1);
	write_obj(b, 0x1600, 0, 0, 1);
	write_obj(b, 0x1600, 1, 0x60400010, 4);
	write_obj(b, 0x1600, 0, 1, 1);
	write_obj(b, 0x1c12, 1, 0x1600, 2);
	write_obj(b, 0x1c12, 0, 1, 1);
}

static u8 sm_active(struct bus *b, u32 slave, u32 sm)
{
	return bus_esc(b, slave)->mem[EC_REG_SM(sm) + EC_SM_OFS_ACTIVATE] & EC_SM_ACT_ENABLE;
}

/* An FMMU without a SyncManager would lead to the registers: address, reset, ports. */
static void apply_unknown_sm(struct kunit *test)
{
	struct cyc *c = reserve(test, "slave a io in=16 out=16\nslave b io in=16 out=16\n", 2);
	struct ec_ioc_sc_sync sm = { .sm = 7, .dir = EC_CFG_DIR_OUTPUT };
	struct bus *b = c->b;
	u32 i;

	sm.config = cyc_config(c, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sm), 0);
	cyc_pdo(c, sm.config, EC_SC_PDO_ASSIGN_ADD, 7, 0x1700, 0);
	for (i = 0; i < 16; i++)
		cyc_pdo(c, sm.config, EC_SC_PDO_MAP_ADD, 7, 0x1700, 0x70000120 + (i << 8));
	cyc_map(c, sm.config, 7, 0);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	memset(cyc_data(c, 0), 0x5a, 64);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(b, 0)->mem + EC_REG_STATION),
			bus_slave(b, 0)->station);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_NOT_NULL_MSG(test,
				  strstr(bus_slave(b, 0)->note.why,
					 "SM7 is not a process data SyncManager"), "%s",
				  bus_slave(b, 0)->note.why);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_OP);
}

/* A SyncManager that its EEPROM wants on in OP only; the slave wants outputs before OP. */
static void apply_op_only(struct kunit *test)
{
	struct cyc *c = reserve(test, "segment seed=17 transition=60ms\n"
				      "slave a io in=8 out=8 cpu=yes\n", 1);
	struct ec_ioc_state safeop = { .state = EC_AL_SAFEOP };
	struct bus *b = c->b;

	bus_slave(b, 0)->sms[0].enable |= EC_SII_SM_OP_ONLY;
	bus_app(b, "a")->model->dev.sms[0].enable |= EC_SII_SM_OP_ONLY;
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	while (bus_slave(b, 0)->al.status != EC_AL_SAFEOP && c->cycles < 2000)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(test, sm_active(b, 0, 0), 0);
	KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, sm_active(b, 0, 0), EC_SM_ACT_ENABLE);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_STATE, &safeop), 0);
	cyc_run(c, 300);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, sm_active(b, 0, 0), 0);
}

/* The application pauses while the slave waits for outputs after that: OP when it goes on. */
static void apply_op_only_pause(struct kunit *test)
{
	struct cyc *c = reserve(test, "segment seed=17\nslave a io in=8 out=8\n", 1);
	struct bus *b = c->b;

	bus_slave(b, 0)->sms[0].enable |= EC_SII_SM_OP_ONLY;
	bus_app(b, "a")->model->dev.sms[0].enable |= EC_SII_SM_OP_ONLY;
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	while (!READ_ONCE(ec_setup_of(bus_slave(b, 0))->op_only) && c->cycles < 2000)
		cyc_run(c, 1);
	KUNIT_ASSERT_LT(test, c->cycles, 2000ull);
	msleep(10000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_SAFEOP);
	c->next = ktime_get();
	KUNIT_EXPECT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	KUNIT_EXPECT_EQ(test, sm_active(b, 0, 0), EC_SM_ACT_ENABLE);
}

/* It comes to OP later than the application allows: its outputs are on then, too. */
static void apply_op_only_late(struct kunit *test)
{
	struct cyc *c = reserve(test, "segment seed=17 transition=60ms\n"
				      "slave a io in=8 out=8\n", 1);
	struct bus *b = c->b;

	bus_slave(b, 0)->sms[0].enable |= EC_SII_SM_OP_ONLY;
	bus_app(b, "a")->model->dev.sms[0].enable |= EC_SII_SM_OP_ONLY;
	cyc_map_all(c, 0, 1, 0);
	bus_config(b, 0)->timeout_ms[EC_AL_SAFEOP][EC_AL_OP] = 20;
	cyc_activate(c);
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS] & EC_AL_STATE_MASK, EC_AL_OP);
	KUNIT_EXPECT_EQ(test, sm_active(b, 0, 0), EC_SM_ACT_ENABLE);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* How often the slave @name, with @ms for each transition, begins one, and where to. */
struct begun {
	struct ec_app *app;
	u32 to[9];
	u64 due;
};

static void note_transition(struct cyc *c)
{
	struct begun *n = c->ctx;

	if (n->app->al_to && n->app->al_due != n->due) {
		n->due = n->app->al_due;
		n->to[n->app->al_to]++;
	}
}

static const struct late {
	u32 ms;		/* a transition takes */
	u32 limit_ms;	/* set by the application, 0: none */
	u32 op_ms;	/* OP is reached by then */
} lates[] = {
	{ 2500, 0, 8000 },	/* within the limits */
	{ 3500, 0, 12000 },	/* over that of PREOP */
	{ 4000, 0, 13500 },
	{ 4200, 0, 14000 },
	{ 300, 200, 1500 },	/* over all of them, up to PREOP and from there */
	{ 300, 40, 4500 },
};

static void late_desc(const struct late *l, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%u ms, limit %u ms", l->ms, l->limit_ms);
}
KUNIT_ARRAY_PARAM(late, lates, late_desc);

/* What comes after its time limit is taken: the slave goes up and never back. */
static void apply_late_states_taken(struct kunit *test)
{
	const struct late *l = test->param_value;
	struct begun begun = { 0 };
	char text[96];
	struct bus *b;
	struct cyc *c;
	u8 from, to;
	u64 us;

	snprintf(text, sizeof(text), "segment seed=17\nslave a io in=8 out=8 cpu=yes transition=%ums\n",
		 l->ms);
	b = bus_new(test, text);
	bus_plug(b);
	while (bus_n_slaves(b) != 1)
		usleep_range(1000, 1001);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	for (from = EC_AL_INIT; from <= EC_AL_OP; from *= 2)
		for (to = EC_AL_INIT; to <= EC_AL_OP; to *= 2)
			bus_config(b, 0)->timeout_ms[from][to] =
				l->limit_ms;
	cyc_activate(c);
	begun.app = bus_app(b, "a");
	c->each = note_transition;
	c->ctx = &begun;
	us = cyc_wait_op(c, 60000);
	bus_figure("transitions of %u ms, limit %u ms: OP after %llu us", l->ms, l->limit_ms, us);
	KUNIT_EXPECT_LE_MSG(test, us, l->op_ms * 1000ull, "%s", bus_slave(b, 0)->note.why);
	KUNIT_EXPECT_LE(test, begun.to[EC_AL_INIT], 0u);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_OK);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* The application ends; a slave takes longer to leave OP than its watchdog. It refuses nothing. */
static void apply_slow_end(struct kunit *test)
{
	struct cyc *c = reserve(test, "segment seed=17 transition=400ms\n"
				      "slave a io in=8 out=8 cpu=yes\n", 1);
	struct bus *b = c->b;
	u32 lines;

	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	cyc_run(c, 500);
	lines = bus_log_lines("refused");
	cyc_release(c);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, 0, EC_AL_PREOP, 10000), ~0ull);
	msleep(1000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_log_lines("refused"), lines);
}

/* While a slave takes its time to refuse a state, another one is requested: that has not failed. */
static void apply_other_request_meanwhile(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=17 transition=300ms\n"
				     "slave a io in=8 out=8 cpu=yes\n"
				     "fault refuse a SAFEOP code=0x1d\n", 1);
	u32 ms;

	bus_idle(b);
	bus_request(b, 0, EC_AL_OP);
	msleep(100);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	bus_request(b, 0, EC_AL_INIT);
	for (ms = 0; ms < 3000; ms++) {
		KUNIT_ASSERT_EQ(test, READ_ONCE(bus_slave(b, 0)->note.error), EC_SLAVE_OK);
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_INIT);
}

/* The mapping that was found is not the slave's any more after its power was off. */
static void apply_found_pdos(struct kunit *test)
{
	struct cyc *c = reserve(test, drive, 1);
	struct bus *b = c->b;

	map_two_bytes(b);
	WRITE_ONCE(bus_slave(b, 0)->pdos.known, false);
	bus_request(b, 0, EC_AL_PREOP);
	cyc_map_all(c, 0, 1, 0);
	KUNIT_ASSERT_EQ(test, bus_config(b, 0)->fmmus[0].size, 2u);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 0, 0, 0, 0);
	cyc_run(c, 500);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 0, 0, 0, 0);
	cyc_run(c, 500);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 10000), ~0ull);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* The slave is on its way back, and its PDOs are read, when it is configured again. */
static void apply_second_round(struct kunit *test)
{
	struct cyc *c = reserve(test, drive, 1);
	struct bus *b = c->b;
	u32 i;

	for (i = 0; i < 3; i++) {
		u32 config = cyc_config(c, 0);

		if (i % 2) {
			cyc_map(c, config, 2, 0);
			cyc_map(c, config, 3, 0);
		} else {
			cyc_remap(c, config);
			cyc_map(c, config, 2, 0);
			cyc_map(c, config, 3, 0);
		}
		cyc_activate(c);
		KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 5000), ~0ull, "round %u: %s", i,
				    bus_slave(b, 0)->note.why);
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
		cyc_domain(c);
	}
}

/* A tool takes the slave up while the application still says what it wants. */
static void apply_changes_meanwhile(struct kunit *test)
{
	struct cyc *c = reserve(test, drive, 1);
	struct bus *b = c->b;
	u32 config = cyc_config(c, 0), i, k, ups = 0;
	void *other[16];

	for (i = 0; i < 300; i++) {
		if (i % 30 == 10) {
			WRITE_ONCE(bus_slave(b, 0)->work.reconfigure, i % 60 == 10);
			bus_request(b, 0, i % 60 == 10 ? EC_AL_SAFEOP : EC_AL_PREOP);
		}
		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 2, 0, 0);
		for (k = 0; k < ARRAY_SIZE(other); k++) {	/* whose memory it is now */
			other[k] = kmalloc(sizeof(struct ec_pdo), GFP_KERNEL);
			memset(other[k], 0xee, sizeof(struct ec_pdo));
		}
		usleep_range(2300, 2310);
		for (k = 0; k < ARRAY_SIZE(other); k++)
			kfree(other[k]);
		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 2, 0x1600, 0);
		usleep_range(2300, 2310);
		ups += bus_slave(b, 0)->al.status == EC_AL_SAFEOP;
	}
	KUNIT_EXPECT_GT(test, ups, 0u);
	/* nothing of that has reached the slave */
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&bus_slave(b, 0)->pdos.sm[2]), 22u);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_OK);
}

struct reader {
	struct bus *b;
	struct completion done;
	bool stop;
	u32 good;
	u32 bad;
	int err;
};

static int read_on(void *arg)
{
	struct reader *r = arg;
	struct ec_slave *s = ec_slave_ref(bus_slave(r->b, 0));

	while (!READ_ONCE(r->stop)) {
		size_t got;
		u32 abort;
		u8 v[4];
		int ret = ec_coe_upload(&s->mbox, 0x1018, 1, false, v, sizeof(v), &got, &abort,
					NULL);

		if (ret)
			r->err = ret;
		ret ? r->bad++ : r->good++;
		usleep_range(100, 110);
	}
	ec_slave_unref(s);
	complete(&r->done);
	return 0;
}

/* Reading an object of the slave all the time, as a tool does, while applications come and go. */
static void apply_sdo_beside(struct kunit *test)
{
	struct cyc *c = reserve(test, drive, 1);
	struct reader r = { .b = c->b };
	u32 i;

	init_completion(&r.done);
	KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(read_on, &r, "reader")));
	for (i = 0; i < 8; i++) {
		cyc_map_all(c, 0, 1, 0);
		cyc_activate(c);
		if (cyc_wait_op(c, 5000) == ~0ull)
			break;
		cyc_run(c, 20);
		ec_ioc(&c->b->app, EC_IOC_DEACTIVATE, NULL);
		cyc_domain(c);
	}
	WRITE_ONCE(r.stop, true);
	wait_for_completion(&r.done);
	KUNIT_EXPECT_EQ(test, i, 8u);
	KUNIT_EXPECT_GT(test, r.good, 20u);
	KUNIT_EXPECT_EQ_MSG(test, r.bad, 0u, "%d", r.err);
}

/* So many that there is always one waiting: the slave's worker has its turn. */
static void apply_sdo_crowd(struct kunit *test)
{
	struct cyc *c = reserve(test, drive, 1);
	struct reader r[4] = { 0 };
	u32 config = cyc_config(c, 0), i;

	cyc_remap(c, config);
	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
	bus_app(c->b, "a")->response_ns = 15 * NSEC_PER_MSEC;
	for (i = 0; i < ARRAY_SIZE(r); i++) {
		r[i].b = c->b;
		init_completion(&r[i].done);
		KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(read_on, &r[i], "reader%u", i)));
	}
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	for (i = 0; i < ARRAY_SIZE(r); i++) {
		WRITE_ONCE(r[i].stop, true);
		while (!try_wait_for_completion(&r[i].done))
			cyc_run(c, 1);
		KUNIT_EXPECT_GT(test, r[i].good, 5u);
		KUNIT_EXPECT_EQ_MSG(test, r[i].bad, 0u, "%d", r[i].err);
	}
}

/* messages that never end, from a slave that nothing is left in */
static const struct endless {
	const char *name;
	u32 kind;	/* of the first message, which is repeated then */
} endless[] = {
	{ "bad length", EC_SIM_MAILBOX_LENGTH },
	{ "unknown protocol", EC_SIM_MAILBOX_TYPE },
};

static void endless_desc(const struct endless *e, char *desc)
{
	strscpy(desc, e->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(endless, endless, endless_desc);

/* A mailbox that cannot be emptied is emptied by the way through INIT. */
static void apply_endless_mailbox(struct kunit *test)
{
	const struct endless *e = test->param_value;
	struct cyc *c = reserve(test, drive, 1);
	struct ec_app *app = bus_app(c->b, "a");

	KUNIT_ASSERT_TRUE(test, bus_slave(c->b, 0)->work.clean);
	bus_fault(c->b, EC_SIM_FAULT_MAILBOX, 0, 0, e->kind, 0);
	msleep(30);
	ec_app_emergency(app, 0x1000, 0, (u8[5]){ 0 }, ktime_get_ns());
	KUNIT_ASSERT_TRUE(test, app->mbox.out_in_sm);
	bus_fault(c->b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_BABBLE, 0);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(c->b, 0)->note.why);
	KUNIT_EXPECT_EQ(test, app->mbox.out_len, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(apply_unknown_sm),
	KUNIT_CASE(apply_op_only),
	KUNIT_CASE(apply_op_only_pause),
	KUNIT_CASE(apply_op_only_late),
	KUNIT_CASE_PARAM(apply_late_states_taken, late_gen_params),
	KUNIT_CASE(apply_slow_end),
	KUNIT_CASE(apply_other_request_meanwhile),
	KUNIT_CASE(apply_found_pdos),
	KUNIT_CASE(apply_second_round),
	KUNIT_CASE(apply_changes_meanwhile),
	KUNIT_CASE(apply_sdo_beside),
	KUNIT_CASE(apply_sdo_crowd),
	KUNIT_CASE_PARAM(apply_endless_mailbox, endless_gen_params),
	{ }
};

static struct kunit_suite suite = { .name = "bus_apply", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
