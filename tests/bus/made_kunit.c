// SPDX-License-Identifier: GPL-2.0-only
/* Startup SDOs that change the PDOs of a slave: lengths, layout, entries that can be registered. */
#include "cyc.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"

#define DRIVE	"slave d drive in=22 out=22 mapping=rewritable\n"

struct sdo {
	u16 index;
	u8 sub;
	u8 bytes;
	u32 value;
};

/* other PDOs for a drive: 8 bytes of outputs, 2 of inputs */
static const struct sdo remap[] = {
	{ 0x1c12, 0, 1, 0 }, { 0x1600, 0, 1, 0 }, { 0x1600, 1, 4, 0x60400010 },
	{ 0x1600, 2, 4, 0x60ff0020 }, { 0x1600, 3, 4, 0x60710010 }, { 0x1600, 0, 1, 3 },
	{ 0x1c12, 1, 2, 0x1600 }, { 0x1c12, 0, 1, 1 },
	{ 0x1c13, 0, 1, 0 }, { 0x1a00, 0, 1, 0 }, { 0x1a00, 1, 4, 0x60410010 },
	{ 0x1a00, 0, 1, 1 }, { 0x1c13, 1, 2, 0x1a00 }, { 0x1c13, 0, 1, 1 },
};

/* what a slave needs that has no PDOs assigned after power-on */
static const struct sdo assign[] = {
	{ 0x1c12, 0, 1, 0 }, { 0x1c12, 1, 2, 0x1600 }, { 0x1c12, 0, 1, 1 },
	{ 0x1c13, 0, 1, 0 }, { 0x1c13, 1, 2, 0x1a00 }, { 0x1c13, 0, 1, 1 },
};

static void startup(struct cyc *c, u32 config, u16 index, u8 sub, bool complete, const void *data,
		    u32 size)
{
	struct ec_config *sc = bus_config(c->b, config);

	mutex_lock(sc->wanted->lock);
	KUNIT_EXPECT_EQ(c->b->test, ec_config_sdo_add(sc, index, sub, complete, data, size), 0);
	mutex_unlock(sc->wanted->lock);
}

static void startup_all(struct cyc *c, u32 config, const struct sdo *v, u32 n)
{
	u8 b[4];

	for (; n; n--, v++) {
		put_unaligned_le32(v->value, b);
		startup(c, config, v->index, v->sub, false, b, v->bytes);
	}
}

static struct cyc *reserve(struct bus *b, u32 *config)
{
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	*config = cyc_config(c, 0);
	return c;
}

static int reg(struct cyc *c, u32 config, u16 index, u32 *offset)
{
	struct ec_ioc_reg_entry r = { .config = config, .entry_index = index };
	int ret = ec_ioc(&c->b->app, EC_IOC_REG_ENTRY, &r);

	*offset = r.offset;
	return ret;
}

static void expect_op(struct cyc *c, u32 outputs, u32 inputs)
{
	struct bus *b = c->b;

	cyc_activate(c);
	KUNIT_ASSERT_NE_MSG(b->test, cyc_wait_op(c, 5000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(b->test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(bus_esc(b, 0)->mem + EC_REG_SM(2) + 2),
			outputs);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(bus_esc(b, 0)->mem + EC_REG_SM(3) + 2),
			inputs);
	KUNIT_EXPECT_STREQ(b->test, bus_slave(b, 0)->note.warning, "");
}

static void expect_refused(struct cyc *c, const char *text)
{
	struct ec_ioc_config_why w = { .index = 0 };
	struct bus *b = c->b;

	cyc_activate(c);
	cyc_run(c, 2000);
	KUNIT_EXPECT_EQ(b->test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(w.text, text), "%s", w.text);
}

/* The user wants no inputs: the SyncManager is off, and OP is reached. */
static void made_empty_assignment_reaches_op(struct kunit *test)
{
	u32 config, offset;
	struct cyc *c = reserve(bus_up(test, DRIVE, 1), &config);

	startup(c, config, 0x1c13, 0, false, "", 1);
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x6041, &offset), -ENOENT);
	cyc_map(c, config, 2, 0);
	expect_op(c, 22, 0);
}

/* The entries were registered before: the SDO is named. */
static void made_empty_assignment_names_sdo(struct kunit *test)
{
	u32 config;
	struct cyc *c = reserve(bus_up(test, DRIVE, 1), &config);

	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
	startup(c, config, 0x1c13, 0, false, "", 1);
	expect_refused(c, "slave has nothing; startup SDO 0x1c13:00 changes it");
}

/* The registered entry is in its place, but the process data are shorter. */
static void made_other_length_names_sdo(struct kunit *test)
{
	u32 config;
	struct cyc *c = reserve(bus_up(test, DRIVE, 1), &config);

	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
	startup_all(c, config, remap, ARRAY_SIZE(remap));
	expect_refused(c, "SM2 registered with 22 byte(s), slave has 8; startup SDO 0x1c12:00");
}

static void made_entries_are_registered(struct kunit *test)
{
	struct bus *b = bus_up(test, DRIVE, 1);
	u32 config, offset;
	struct cyc *c = reserve(b, &config);

	startup_all(c, config, remap, ARRAY_SIZE(remap));
	KUNIT_EXPECT_EQ_MSG(test, reg(c, config, 0x6071, &offset), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, offset, 6u);
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x6041, &offset), 0);
	KUNIT_EXPECT_EQ(test, offset, 8u);
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x607a, &offset), -ENOENT);
	expect_op(c, 8, 2);
	/* the slave has lost all of it */
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 0, 0, 0, 0);
	cyc_run(c, 500);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 0, 0, 0, 0);
	cyc_run(c, 500);
	KUNIT_EXPECT_NE_MSG(test, cyc_wait_op(c, 10000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
}

/* The same in one SDO per object. */
static void made_by_complete_access(struct kunit *test)
{
	static const u8 none[2] = { 0 }, one[] = { 1, 0, 0x00, 0x1a },
		map[] = { 2, 0, 0x10, 0, 0x41, 0x60, 0x20, 0, 0x64, 0x60 };
	u32 config, offset;
	struct cyc *c = reserve(bus_up(test, DRIVE, 1), &config);

	startup(c, config, 0x1c13, 0, true, none, sizeof(none));
	startup(c, config, 0x1a00, 0, true, map, sizeof(map));
	startup(c, config, 0x1c13, 0, true, one, sizeof(one));
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x6064, &offset), 0);
	KUNIT_EXPECT_EQ(test, offset, 2u);
	cyc_map(c, config, 2, 0);
	expect_op(c, 22, 6);
}

/* A PDO that the application names has the mapping that startup SDOs give it. */
static void made_mapping_of_named_pdo(struct kunit *test)
{
	u32 config, offset;
	struct cyc *c = reserve(bus_up(test, DRIVE, 1), &config);

	startup_all(c, config, remap, 6);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 2, 0, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 2, 0x1600, 0);
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x6071, &offset), 0);
	KUNIT_EXPECT_EQ(test, offset, 6u);
	expect_op(c, 8, 22);
}

/* PDOs in the EEPROM that belong to no SyncManager; 0x1C13 and those from @first are empty. */
static void unassign(struct bus *b, u16 first)
{
	struct ec_esc_eeprom *e = &bus_esc(b, 0)->eep;
	struct ec_app *app = bus_app(b, "d");
	struct ec_sii_cat cat;
	struct ec_sii_iter it;
	u16 index;

	ec_sii_iter_init(&it, e->data, e->len);
	while (ec_sii_iter_next(&it, &cat) == 1)
		if (cat.type == EC_SII_CAT_RXPDO || cat.type == EC_SII_CAT_TXPDO)
			((u8 *)cat.data)[3] = cat.type == EC_SII_CAT_RXPDO && first > 0x1c12 ?
					      2 : 0xff;
	for (index = first; index < 0x1c14; index++)
		ec_app_od_set(app, ec_app_od_entry(app->model, index, 0), 0);
}

static void made_assignment_of_unassigned_slave(struct kunit *test)
{
	struct bus *b = bus_new(test, DRIVE);
	u32 config, offset;
	struct cyc *c;

	unassign(b, 0x1c12);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	c = reserve(b, &config);
	KUNIT_ASSERT_EQ(test, reg(c, config, 0x6041, &offset), -ENOENT);
	startup_all(c, config, assign, ARRAY_SIZE(assign));
	KUNIT_EXPECT_EQ_MSG(test, reg(c, config, 0x6040, &offset), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, reg(c, config, 0x6041, &offset), 0);
	KUNIT_EXPECT_EQ(test, offset, 22u);
	expect_op(c, 22, 22);
}

/* The one entry of 0x1C13 is @pdo: 0, or a PDO that does not exist. The slave changes no list. */
static struct cyc *output_terminal(struct kunit *test, u16 pdo)
{
	struct bus *b = bus_new(test, "slave d drive in=22 out=22 mapping=fixed\n");
	struct ec_app *app = bus_app(b, "d");
	u32 config;
	struct cyc *c;

	unassign(b, 0x1c13);
	ec_app_od_set(app, ec_app_od_entry(app->model, 0x1c13, 1), pdo);
	ec_app_od_set(app, ec_app_od_entry(app->model, 0x1c13, 0), 1);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	c = reserve(b, &config);
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&bus_slave(b, 0)->pdos.sm[3]), 0u);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->pdos.sm[3].n, pdo ? 1u : 0u);
	cyc_map(c, config, 2, 0);
	/* as 'ethercat cstruct' writes it */
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 3, 0, 0);
	if (pdo)
		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 3, pdo, 0);
	return c;
}

static void made_unused_entry_is_no_pdo(struct kunit *test)
{
	u32 lines = bus_log_lines("EtherCAT 0-0: ");
	struct cyc *c = output_terminal(test, 0);

	expect_op(c, 22, 0);
	KUNIT_EXPECT_EQ(test, bus_log_lines("EtherCAT 0-0: "), lines);
}

static void made_absent_pdo_has_no_data(struct kunit *test)
{
	u32 lines = bus_log_lines("EtherCAT 0-0: ");
	struct cyc *c = output_terminal(test, 0x1a77);

	expect_op(c, 22, 0);
	KUNIT_EXPECT_EQ(test, bus_log_lines("EtherCAT 0-0: "), lines);
}

/* Without a slave the SDOs alone say what there will be. */
static void made_entries_of_absent_slave(struct kunit *test)
{
	struct bus *b = bus_up(test, DRIVE, 1);
	struct ec_ioc_slave_config sc = { .position = 5, .vendor_id = 1, .product_code = 2 };
	u32 config, offset;
	struct cyc *c = reserve(b, &config);

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	startup_all(c, sc.index, remap, ARRAY_SIZE(remap));
	KUNIT_EXPECT_EQ_MSG(test, reg(c, sc.index, 0x60ff, &offset), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, offset, 2u);
	KUNIT_EXPECT_EQ(test, reg(c, sc.index, 0x6041, &offset), 0);
}

/* Which objects count, for which SyncManager. */
static void made_by_which_objects(struct kunit *test)
{
	static const struct {
		u16 index;
		u8 sms;
	} v[] = {
		{ 0x1c12, BIT(2) }, { 0x1c13, BIT(3) }, { 0x1c1f, 0 }, { 0x1600, BIT(2) },
		{ 0x1a00, BIT(3) }, { 0x1601, 0 }, { 0xf030, BIT(2) | BIT(3) }, { 0x6065, 0 },
	};
	struct bus *b = bus_up(test, DRIVE, 1);
	struct ec_slave *s = bus_slave(b, 0);
	const struct ec_startup *u;
	struct ec_config *sc;
	u32 config, i, sm;
	struct cyc *c = reserve(b, &config);

	sc = bus_config(b, config);
	for (i = 0; i < ARRAY_SIZE(v); i++) {
		startup(c, config, v[i].index, 1, false, "\0\0\0", 4);
		mutex_lock(&s->lock);
		for (sm = 2; sm < 4; sm++) {
			u = ec_startup_changes(sc, s, sm);
			KUNIT_EXPECT_EQ_MSG(test, u && u->index == v[i].index,
					    !!(v[i].sms & BIT(sm)), "0x%04x SM%u", v[i].index, sm);
		}
		mutex_unlock(&s->lock);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(made_empty_assignment_reaches_op),
	KUNIT_CASE(made_empty_assignment_names_sdo),
	KUNIT_CASE(made_other_length_names_sdo),
	KUNIT_CASE(made_entries_are_registered),
	KUNIT_CASE(made_by_complete_access),
	KUNIT_CASE(made_mapping_of_named_pdo),
	KUNIT_CASE(made_assignment_of_unassigned_slave),
	KUNIT_CASE(made_unused_entry_is_no_pdo),
	KUNIT_CASE(made_absent_pdo_has_no_data),
	KUNIT_CASE(made_entries_of_absent_slave),
	KUNIT_CASE(made_by_which_objects),
	{ }
};

static struct kunit_suite suite = { .name = "bus_made", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
