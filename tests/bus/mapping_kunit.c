// SPDX-License-Identifier: GPL-2.0-only
/* A slave that refuses its PDO mapping: what it has instead decides. */
#include <linux/kmsg_dump.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"

#define FIXED	"slave d drive in=8 out=8 mapping=fixed\nslave e EL1859\n"

/* Lines of the kernel log since @it was last read that have @text in them. */
static u32 logged(struct kmsg_dump_iter *it, const char *text)
{
	static char buf[512];
	size_t len;
	u32 n = 0;

	while (kmsg_dump_get_line(it, true, buf, sizeof(buf) - 1, &len)) {
		buf[len] = 0;
		n += !!strstr(buf, text);
	}
	return n;
}

static void expect_why(struct bus *b, u32 config, const char *text)
{
	struct ec_ioc_config_why w = { .index = config };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(w.text, text), "%s", w.text);
}

static u32 entry_of(const struct ec_pdo_entry *e, u32 i, u32 wrong)
{
	return (e->index << 16 | e->sub << 8 | e->bits) + (i == wrong ? 0x71 << 8 : 0);
}

/*
 * The drive gets the mapping it has, but for the entry at @wrong, whose subindex is
 * another; entry @used is registered.
 */
static struct cyc *configure(struct kunit *test, const char *text, u32 wrong, u32 used)
{
	struct bus *b = bus_up(test, text, 2);
	struct ec_ioc_reg_entry r = {
		.flags = EC_REG_ENTRY_BY_POS, .sm = 2, .entry_pos = used,
	};
	const struct ec_pdo_list *l;
	struct cyc *c;
	u32 i, n, entries[16];
	u16 pdo;

	bus_idle(b);
	c = cyc_new(b, 1000);
	r.domain = cyc_domain(c);
	r.config = cyc_config(c, 0);
	l = &bus_slave(b, 0)->pdos.sm[2];
	KUNIT_ASSERT_EQ(test, l->n, 1u);
	pdo = l->pdos[0].index;
	n = min_t(u32, l->pdos[0].n_entries, ARRAY_SIZE(entries));
	KUNIT_ASSERT_GE(test, n, 2u);
	for (i = 0; i < n; i++)
		entries[i] = entry_of(&l->pdos[0].entries[i], i, wrong);
	cyc_pdo(c, r.config, EC_SC_PDO_ASSIGN_CLEAR, 2, 0, 0);
	cyc_pdo(c, r.config, EC_SC_PDO_ASSIGN_ADD, 2, pdo, 0);
	cyc_pdo(c, r.config, EC_SC_PDO_MAP_CLEAR, 2, pdo, 0);
	for (i = 0; i < n; i++)
		cyc_pdo(c, r.config, EC_SC_PDO_MAP_ADD, 2, pdo, entries[i]);
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &r), 0, "%s", b->app.reason);
	cyc_map_all(c, 1, 1, r.domain);
	return c;
}

static void mapping_other_entry_does_not_reach_op(struct kunit *test)
{
	struct cyc *c = configure(test, FIXED, 0, 0);
	struct bus *b = c->b;
	struct kmsg_dump_iter it, first;

	kmsg_dump_rewind(&it);
	logged(&it, "");
	cyc_activate(c);
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_OP);
	expect_why(b, 0, "registered 0x6040:71, 16 bit; slave has 0x6040:00, 16 bit");
	expect_why(b, 0, "refused: abort 0x06");
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "SM2 configured: 0x1600: 6040:71/16"), 1u);
	first = it;
	KUNIT_EXPECT_EQ(test, logged(&first, "SM2 in the slave: 0x1600: 6040:00/16"), 1u);
}

static void mapping_flag_accepts_other_entry(struct kunit *test)
{
	struct cyc *c = configure(test, FIXED, 0, 0);
	struct ec_ioc_sc_flag f = { .config = 0, .value = 1, .key = EC_FLAG_ANY_PDOS };
	struct bus *b = c->b;
	struct ec_ioc_slave_why i = { 0 };

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &f), 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	/* what was accepted stays visible */
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(i.warning, "registered 0x6040:71"), "%s", i.warning);
}

/* An entry nobody registered may be another one. */
static void mapping_unregistered_entry_does_not_matter(struct kunit *test)
{
	struct cyc *c = configure(test, FIXED, 0, 1);

	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	KUNIT_EXPECT_STREQ(test, bus_slave(c->b, 0)->note.warning, "");
}

/* It refuses, or does not reply, and cannot be read either. */
static void mapping_unreadable_stays_visible(struct kunit *test)
{
	struct cyc *c = configure(test, FIXED, 99, 0);
	struct bus *b = c->b;
	struct ec_ioc_slave_why i = { 0 };

	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_TYPE, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 60000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
	cyc_run(c, 3000);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(i.warning, "cannot be read"), "%s", i.warning);
	/* the next configuration begins without it */
	cyc_release(c);
	bus_idle(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_STREQ(test, i.warning, "");
}

/* Terminals without mailbox: the entry is @entry at @wrong; 99: at none. */
static struct cyc *terminal(struct kunit *test, struct bus *b, u32 wrong, u32 entry)
{
	u32 i, config, sm = 0;
	struct ec_slave *s;
	struct cyc *c;

	bus_idle(b);
	s = bus_slave(b, 0);
	KUNIT_ASSERT_FALSE(test, ec_mbox_present(&s->mbox));
	c = cyc_new(b, 1000);
	cyc_domain(c);
	config = cyc_config(c, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, sm, 0, 0);
	for (i = 0; i < 8; i++) {
		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, sm, 0x1600 + i, 0);
		cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, sm, 0x1600 + i, 0);
		cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, sm, 0x1600 + i,
			i == wrong ? entry : (0x7000 + 0x10 * i) << 16 | 1 << 8 | 1);
	}
	cyc_map(c, config, sm, 0);
	return c;
}

static void mapping_without_mailbox_is_compared(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave o EL2008\n", 1);
	struct ec_ioc_sc_flag f = { .config = 0, .value = 1, .key = EC_FLAG_ANY_PDOS };
	struct ec_ioc_slave_why i = { 0 };
	struct cyc *c = terminal(test, b, 0, 0x70100101);	/* that of another place */

	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	expect_why(b, 0, "registered 0x7010:01, 1 bit; slave has 0x7000:01, 1 bit");
	cyc_release(c);
	c = terminal(test, b, 0, 0x30010102);	/* another length */
	cyc_activate(c);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->al.status, EC_AL_PREOP);
	expect_why(b, 0, "registered 0x3001:01, 2 bit; slave has 0x7000:01, 1 bit");
	cyc_release(c);
	/* an entry that is not registered, as cyc_map() takes the first one */
	c = terminal(test, b, 3, 0x70000201);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 0)->note.warning, "");
	cyc_release(c);
	c = terminal(test, b, 0, 0x70100101);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &f), 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(i.warning, "registered 0x7010:01"), "%s", i.warning);
}

/* What no service can reach may have any name, as in the examples of other masters. */
static void mapping_without_mailbox_names_are_labels(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave o EL2008\n", 1);
	struct cyc *c = terminal(test, b, 0, 0x30010101);
	struct ec_ioc_slave_why i = { 0 };
	struct kmsg_dump_iter it;

	kmsg_dump_rewind(&it);
	logged(&it, "");
	cyc_activate(c);
	KUNIT_ASSERT_NE_MSG(test, cyc_wait_op(c, 3000), ~0ull, "%s", bus_slave(b, 0)->note.why);
	cyc_run(c, 10);
	KUNIT_EXPECT_EQ(test, cyc_state(c, 0)->wc_state, 2);
	KUNIT_EXPECT_EQ(test, logged(&it, "EtherCAT 0-0: "), 1u);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test,
				  strstr(i.warning, "registered as 0x3001:01, named 0x7000:01"),
				  "%s", i.warning);
	/* a direction is no name */
	cyc_release(c);
	c = terminal(test, b, 0, 0x30010101);
	bus_config(b, 0)->sm[0].dir = EC_CFG_DIR_INPUT;
	bus_config(b, 0)->fmmus[0].dir = EC_CFG_DIR_INPUT;
	cyc_activate(c);
	cyc_run(c, 1000);
	expect_why(b, 0, "registered 0x3001:01, 1 bit; slave has 0x7000:01, 1 bit");
}

/* Nobody can tell what the slave has. */
static void mapping_without_knowledge_stays_visible(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave o EL2008\n");
	struct ec_esc_eeprom *e = &bus_esc(b, 0)->eep;
	struct ec_ioc_slave_why i = { 0 };
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	struct cyc *c;

	ec_sii_iter_init(&it, e->data, e->len);
	while (ec_sii_iter_next(&it, &cat) == 1)
		if (cat.type == EC_SII_CAT_RXPDO)	/* of the vendor from now on */
			put_unaligned_le16(0x0900, (u8 *)cat.data - 4);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	c = terminal(test, b, 99, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(i.warning, "EEPROM lists no PDOs"), "%s", i.warning);
}

/* The PDOs as they are, but they could not be read. */
static void mapping_found_unreadable_stays_visible(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave d drive in=8 out=8\n");
	struct ec_ioc_slave_why i = { 0 };
	struct cyc *c;

	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_TYPE, 0);
	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_GOOD, 0);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_WHY, &i), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(i.warning, "PDOs could not be read"), "%s",
				  i.warning);
}

/* The first cause is kept, not the AL status code that follows from it. */
static void mapping_first_cause_is_kept(struct kunit *test)
{
	struct bus *b = bus_up(test, FIXED, 2);
	struct cyc *c;
	u32 config;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	config = cyc_config(c, 0);
	/* a PDO that does not exist, with an entry nobody registers */
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 2, 0x1615, 0);
	cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, 2, 0x1615, 0x7FF00120);
	cyc_map(c, config, 2, 0);
	cyc_map_all(c, 1, 1, 0);
	cyc_activate(c);
	cyc_run(c, 3000);
	expect_why(b, config, "PDO mapping 0x1615 refused: abort 0x06020000");
	expect_why(b, config, "then SAFEOP refused: AL status code 0x001d");
}

/* What is shown while an application runs is what it wrote, with names. */
static void mapping_written_is_shown(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave d drive in=22 out=22 mapping=rewritable\n", 1);
	struct ec_ioc_pdo p = { .sm = 2 };
	struct ec_ioc_pdo_entry e = { .sm = 2 };
	u32 config, i;
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	config = cyc_config(c, 0);
	cyc_remap(c, config);
	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_PDO, &p), 0);
	KUNIT_EXPECT_EQ(test, p.index, 0x1600);
	KUNIT_EXPECT_STRNEQ(test, p.name, "");
	KUNIT_ASSERT_EQ(test, p.entry_count, ARRAY_SIZE(cyc_new_out));
	for (i = 0; i < p.entry_count; i++) {
		e.entry_pos = i;
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_PDO_ENTRY, &e), 0);
		KUNIT_EXPECT_EQ(test, (u32)e.index << 16 | e.subindex << 8 | e.bits,
				cyc_new_out[i]);
		KUNIT_EXPECT_STRNEQ(test, e.name, "");
	}
	/* the slave has them, but it is the configuration that has registered some */
	for (i = 0; i < p.entry_count; i++)
		KUNIT_EXPECT_FALSE(test,
				   bus_slave(b, 0)->pdos.sm[2].pdos[0].entries[i].registered);
	/* the next application finds them, too, although the EEPROM has others */
	cyc_release(c);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&bus_slave(b, 0)->pdos.sm[2]), 8u);
}

static struct kunit_case mapping_cases[] = {
	KUNIT_CASE(mapping_other_entry_does_not_reach_op),
	KUNIT_CASE(mapping_flag_accepts_other_entry),
	KUNIT_CASE(mapping_unregistered_entry_does_not_matter),
	KUNIT_CASE(mapping_unreadable_stays_visible),
	KUNIT_CASE(mapping_without_mailbox_is_compared),
	KUNIT_CASE(mapping_without_mailbox_names_are_labels),
	KUNIT_CASE(mapping_without_knowledge_stays_visible),
	KUNIT_CASE(mapping_found_unreadable_stays_visible),
	KUNIT_CASE(mapping_first_cause_is_kept),
	KUNIT_CASE(mapping_written_is_shown),
	{}
};

static struct kunit_suite mapping_suite = {
	.name = "bus_mapping",
	.exit = bus_exit,
	.test_cases = mapping_cases,
};

kunit_test_suite(mapping_suite);

MODULE_LICENSE("GPL");
