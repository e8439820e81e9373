// SPDX-License-Identifier: GPL-2.0-only
/*
 * A drive with two axes and no CoE, as a TwinCAT configuration of an AX5000 sets it up: startup
 * IDNs choose telegram type, lists of both telegrams, cycle times and mode, before SAFEOP.
 */
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/mailbox/mailbox.h"
#include "master/mailbox/soe.h"

#define AXES		2
#define AXIS_BYTES	6	/* word, then a value */
#define MDT		0x0018	/* PDOs as the drive's description names them */
#define AT		0x0010
#define ON		0xe000
#define RUNS		0xc000
#define FAILED		0x2000

static const char text[] =
	"segment seed=8 response=200us transition=200us\nslave axes sercos serial=7\n"
	"slave io EL2008\n";

/* @axes: one for each axis, else once for the drive */
static const struct idn {
	u16 idn;
	u8 size;
	u8 data[8];
	bool axes;
} startup[] = {
	{ 15, 2, { 7, 0 }, true },
	{ 16, 6, { 2, 0, 2, 0, 51, 0 }, true },
	{ 24, 6, { 2, 0, 2, 0, 36, 0 }, true },
	{ 1, 2, { 0xd0, 7 }, false },
	{ 2, 2, { 0xd0, 7 }, false },
	{ 32, 2, { 2, 0 }, true },
};

static void map(struct cyc *c, u32 config, u8 sm, u16 pdo, u16 word, u16 value)
{
	u32 axis;

	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, sm, 0, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, sm, pdo, 0);
	for (axis = 0; axis < AXES; axis++) {
		cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, sm, pdo, (u32)word << 16 | axis << 8 | 16);
		cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, sm, pdo, (u32)value << 16 | axis << 8 | 32);
	}
	cyc_map(c, config, sm, 0);
}

/* An application with all startup IDNs but @without. */
static struct cyc *sercos(struct kunit *test, u16 without)
{
	struct bus *b = bus_up(test, text, 2);
	struct cyc *c;
	u32 i, axis;

	bus_idle(b);
	c = cyc_new(b, 2000);
	cyc_domain(c);
	cyc_config(c, 0);
	map(c, 0, 2, MDT, 134, 36);
	map(c, 0, 3, AT, 135, 51);
	bus_lock(b);
	for (i = 0; i < ARRAY_SIZE(startup); i++)
		for (axis = 0; axis < (startup[i].axes ? AXES : 1); axis++)
			if (startup[i].idn != without)
				KUNIT_EXPECT_EQ(test,
						ec_config_idn_add(bus_config(b, 0), axis,
								  startup[i].idn, EC_AL_PREOP,
								  startup[i].data, startup[i].size),
						0);
	bus_unlock(b);
	return c;
}

static s32 position(struct cyc *c, u32 axis)
{
	return (s32)get_unaligned_le32(cyc_pd(c, 0, 3) + axis * AXIS_BYTES + 2);
}

static void command(struct cyc *c, u32 axis, u16 control, s32 velocity)
{
	u8 *p = cyc_pd(c, 0, 2) + axis * AXIS_BYTES;

	put_unaligned_le16(control, p);
	put_unaligned_le32((u32)velocity, p + 2);
}

static void sercos_axes_move_after_startup_idns(struct kunit *test)
{
	struct cyc *c = sercos(test, 0);
	struct ec_slave *s = bus_slave(c->b, 0);
	u16 error;
	size_t got;
	u8 v[4];
	s32 from;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_app(c->b, "axes")->soe.writes, 10u);
	KUNIT_EXPECT_EQ(test, bus_esc(c->b, 0)->sm[2].page.len, AXES * AXIS_BYTES);
	KUNIT_EXPECT_EQ(test, bus_esc(c->b, 0)->sm[3].page.len, AXES * AXIS_BYTES);
	command(c, 0, ON, 10000);
	command(c, 1, ON, -250000);
	cyc_run(c, 5);
	from = position(c, 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_pd(c, 0, 3)), RUNS);
	c->incomplete = 0;
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	/* a second: 10000 inc/s */
	KUNIT_EXPECT_GE(test, position(c, 0) - from, 9900);
	KUNIT_EXPECT_LE(test, position(c, 0) - from, 10100);
	KUNIT_EXPECT_LE(test, position(c, 1), -247500);
	/* what SoE reads is the same value */
	KUNIT_EXPECT_EQ(test, ec_soe_read(&s->mbox, 1, 36, v, 4, &got, &error, NULL), 0);
	KUNIT_EXPECT_EQ(test, (s32)get_unaligned_le32(v), -250000);
	/* one axis stops */
	command(c, 0, 0, 10000);
	/* the cycles that were due during the transfer have no time for a reply */
	cyc_run(c, 20);
	from = position(c, 0);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, position(c, 0), from);
	KUNIT_EXPECT_NE(test, get_unaligned_le16(cyc_pd(c, 0, 3)), RUNS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_pd(c, 0, 3) + AXIS_BYTES), RUNS);
}

static u32 read_idn(struct cyc *c, u32 axis, u16 idn, u8 *v, size_t cap)
{
	size_t got = 0;
	u16 error;

	KUNIT_EXPECT_EQ(c->b->test, ec_soe_read(&bus_slave(c->b, 0)->mbox, axis, idn, v, cap, &got,
						&error, NULL), 0);
	return got;
}

/* An axis in error stands and says what it has, in its status word and by IDNs, until its reset. */
static void sercos_axis_in_error_stops_until_reset(struct kunit *test)
{
	struct cyc *c = sercos(test, 0);
	u8 v[40] = { 0 };
	u16 error;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	command(c, 0, ON, 10000);
	command(c, 1, ON, 10000);
	bus_command(c->b, "fault drive axes drive=1 error=0x80");
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_pd(c, 0, 3)), RUNS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_pd(c, 0, 3) + AXIS_BYTES), FAILED);
	KUNIT_EXPECT_EQ(test, read_idn(c, 0, EC_SOE_IDN_ERROR, v, 2), 2u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0);
	KUNIT_EXPECT_EQ(test, read_idn(c, 1, EC_SOE_IDN_ERROR, v, 2), 2u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0x80);
	KUNIT_EXPECT_EQ(test, read_idn(c, 1, EC_SOE_IDN_ERROR_NUMBER, v, 4), 4u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v), 0xf0000080);
	KUNIT_EXPECT_EQ(test, read_idn(c, 1, EC_SOE_IDN_ERROR_TEXT, v, sizeof(v)), 19u);
	KUNIT_EXPECT_EQ(test, memcmp(v + EC_SOE_LIST_HDR, "simulated error", 15), 0);
	put_unaligned_le16(EC_SOE_COMMAND_SET | EC_SOE_COMMAND_ENABLE, v);
	KUNIT_EXPECT_EQ(test, ec_soe_write(&bus_slave(c->b, 0)->mbox, 1, 99, v, 2, &error, NULL),
			0);
	cyc_run(c, 20);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(cyc_pd(c, 0, 3) + AXIS_BYTES), RUNS);
	KUNIT_EXPECT_EQ(test, read_idn(c, 1, EC_SOE_IDN_ERROR_TEXT, v, sizeof(v)), 12u);
}

/* Without a list the drive expects less process data, and the reason is an AL status code. */
static void sercos_missing_list_keeps_drive_in_preop(struct kunit *test)
{
	struct cyc *c = sercos(test, 24);

	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_slave(c->b, 0)->al.status & EC_AL_STATE_MASK, EC_AL_PREOP);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(bus_slave(c->b, 0)->note.why, "0x001d"), "%s",
				  bus_slave(c->b, 0)->note.why);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sercos_axes_move_after_startup_idns),
	KUNIT_CASE(sercos_axis_in_error_stops_until_reset),
	KUNIT_CASE(sercos_missing_list_keeps_drive_in_preop),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_sercos",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
