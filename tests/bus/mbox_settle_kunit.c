// SPDX-License-Identifier: GPL-2.0-only
/* Slaves whose EEPROM contradicts itself about the mailbox. */
#include "cyc.h"
#include "master/mailbox/coe.h"

static const struct unlike {
	const char *name;
	const char *option;
	const char *text;
	int sdo;	/* result of an upload */
} unlikes[] = {
	{ "all three agree", "", "", 0 },
	{ "no words", "mbox_words=no",
	  "mailbox of 0 and 0 bytes in SII words 0x18 to 0x1b, of 256 and 256 bytes in category 41; this one is used",
	  0 },
	{ "no protocol", "mbox_protocols=no",
	  "mailbox of 256 and 256 bytes, but protocols 0x0000 (SII word 0x1c); set up, and not used",
	  -EPROTONOSUPPORT },
};

static void unlike_desc(const struct unlike *u, char *desc)
{
	strscpy(desc, u->name, KUNIT_PARAM_DESC_SIZE);
}
KUNIT_ARRAY_PARAM(unlike, unlikes, unlike_desc);

static int upload(struct bus *b)
{
	size_t size;
	u32 abort;
	u8 v[4];

	return ec_coe_upload(bus_mbox(b, 0), 0x1018, 1, false, v, sizeof(v), &size, &abort,
			     NULL);
}

/* The scan, the way to PREOP and the one to SAFEOP have the same answer. */
static void mbox_contradicting_eeprom_reaches_op(struct kunit *test)
{
	const struct unlike *u = test->param_value;
	char text[128], warning[EC_UAPI_WARNING];
	u32 lines = u->text[0] ? bus_log_lines(u->text) : 0;
	struct ec_cause cause;
	struct bus *b;
	struct cyc *c;

	snprintf(text, sizeof(text), "segment seed=17\nslave a drive in=8 out=8 %s\n", u->option);
	b = bus_up(test, text, 1);
	bus_idle(b);
	ec_slave_warning(bus_slave(b, 0), warning, sizeof(warning));
	KUNIT_EXPECT_STREQ(test, warning, u->text);
	ec_slave_cause(bus_slave(b, 0), &cause);
	KUNIT_EXPECT_EQ(test, cause.kind, u->text[0] ? EC_CAUSE_MAILBOX : EC_CAUSE_NONE);
	KUNIT_EXPECT_EQ(test, upload(b), u->sdo);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_SM(0) + EC_SM_OFS_ACTIVATE],
			EC_SM_ACT_ENABLE);
	KUNIT_EXPECT_EQ(test, upload(b), u->sdo);
	if (u->text[0])
		KUNIT_EXPECT_EQ(test, bus_log_lines(u->text), lines + 1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(mbox_contradicting_eeprom_reaches_op, unlike_gen_params),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_mbox_settle", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
