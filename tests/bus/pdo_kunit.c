// SPDX-License-Identifier: GPL-2.0-only
/* The PDOs a slave uses now, not those it was delivered with. */
#include "bus.h"
#include "master/mailbox/coe.h"
#include "master/boundary/ioctl.h"
#include "cyc.h"
#include "master/bus/slave_pdo.h"

static int put(struct ec_slave *s, u16 index, u8 sub, u32 value, size_t bytes)
{
	u8 b[4];
	u32 abort;

	put_unaligned_le32(value, b);
	return ec_coe_download(&s->mbox, index, sub, false, b, bytes, &abort, NULL);
}

static bool known(struct bus *b)
{
	u32 i;

	for (i = 0; i < bus_n_slaves(b); i++)
		if (ec_slave_pdos_pending(bus_slave_at(b, i)))
			return false;
	return bus_settled(b);
}

static void wait_known(struct bus *b)
{
	unsigned int i;

	for (i = 0; i < 5000 && !known(b); i++)
		usleep_range(1000, 1001);
	KUNIT_ASSERT_TRUE(b->test, known(b));
}

/* reading over CoE must agree with the EEPROM of a slave nobody changed */
static void pdo_same_as_eeprom(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave d drive in=22 out=22 mapping=rewritable\n", 1);
	struct ec_slave *s = bus_slave(b, 0);
	u32 bytes[4], entries[4];
	unsigned int sm;

	for (sm = 2; sm < 4; sm++) {
		bytes[sm] = ec_pdo_list_bytes(&s->pdos.sm[sm]);
		entries[sm] = s->pdos.sm[sm].pdos[0].n_entries;
		KUNIT_EXPECT_EQ(test, bytes[sm], 22u);
	}
	KUNIT_EXPECT_FALSE(test, s->pdos.known);
	wait_known(b);
	KUNIT_EXPECT_TRUE(test, s->pdos.known);
	for (sm = 2; sm < 4; sm++) {
		KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&s->pdos.sm[sm]), bytes[sm]);
		KUNIT_EXPECT_EQ(test, s->pdos.sm[sm].pdos[0].n_entries, entries[sm]);
		/* names come from the EEPROM still */
		KUNIT_EXPECT_NE(test, s->pdos.sm[sm].pdos[0].name, 0);
	}
}

/* Its mailbox fails just when they are read: what is said of it ends with that. */
static void pdo_mailbox_failed_read_later(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave d drive in=22 out=22 mapping=rewritable\n", 1);
	struct ec_slave *s = bus_slave(b, 0);
	unsigned int i, busy = 0;
	char warning[160];

	KUNIT_ASSERT_FALSE(test, s->pdos.known);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	for (i = 0; i < 60 && !READ_ONCE(s->pdos.known); i++)
		msleep(500);
	KUNIT_EXPECT_TRUE(test, s->pdos.unread);
	ec_slave_warning(s, warning, sizeof(warning));
	KUNIT_EXPECT_TRUE(test, strstarts(warning, "PDOs could not be read over CoE"));
	/* nobody who waits for the bus waits for that */
	KUNIT_EXPECT_TRUE(test, bus_settled(b));
	/* its worker is not always at that */
	for (i = 0; i < 400; i++) {
		msleep(500);
		busy += ec_slave_busy(s);
	}
	bus_figure("PDOs that cannot be read: worker busy in %u of 400 looks", busy);
	KUNIT_EXPECT_LE(test, busy, 80u);
	KUNIT_EXPECT_TRUE(test, s->pdos.unread);

	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	for (i = 0; i < 400 && READ_ONCE(s->pdos.unread); i++)
		msleep(500);
	KUNIT_EXPECT_FALSE(test, s->pdos.unread);
	ec_slave_warning(s, warning, sizeof(warning));
	KUNIT_EXPECT_STREQ(test, warning, "");
	KUNIT_EXPECT_FALSE(test, ec_slave_pdos_pending(s));
}

static void pdo_changed_mapping_is_seen(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave d drive in=22 out=22 mapping=rewritable\n", 1);
	struct ec_slave *s = bus_slave(b, 0);
	const struct ec_pdo *p;
	u16 pdo, unassigned;

	wait_known(b);
	pdo = s->pdos.sm[2].pdos[0].index;
	unassigned = s->pdos.sm[3].pdos[0].index;
	KUNIT_ASSERT_EQ(test, put(s, 0x1c12, 0, 0, 1), 0);
	KUNIT_ASSERT_EQ(test, put(s, pdo, 0, 0, 1), 0);
	KUNIT_ASSERT_EQ(test, put(s, pdo, 1, 0x60400010, 4), 0);
	KUNIT_ASSERT_EQ(test, put(s, pdo, 0, 1, 1), 0);
	KUNIT_ASSERT_EQ(test, put(s, 0x1c12, 1, pdo, 2), 0);
	KUNIT_ASSERT_EQ(test, put(s, 0x1c12, 0, 1, 1), 0);
	KUNIT_ASSERT_EQ(test, put(s, 0x1c13, 0, 0, 1), 0);

	bus_rescan(b);
	usleep_range(50000, 50001);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	wait_known(b);
	s = bus_slave(b, 0);
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&s->pdos.sm[2]), 2u);
	KUNIT_ASSERT_EQ(test, s->pdos.sm[2].n, 1u);
	KUNIT_ASSERT_EQ(test, s->pdos.sm[2].pdos[0].n_entries, 1u);
	KUNIT_EXPECT_EQ(test, s->pdos.sm[2].pdos[0].entries[0].index, 0x6040);
	KUNIT_EXPECT_EQ(test, s->pdos.sm[3].n, 0u);
	/* it can be assigned again with the mapping of the EEPROM */
	down_read(&bus_table(b)->topo);
	p = ec_slave_find_pdo(s, unassigned);
	KUNIT_EXPECT_NOT_NULL(test, p);
	if (p)
		KUNIT_EXPECT_EQ(test, ec_pdo_bits(p), 22u * 8);
	up_read(&bus_table(b)->topo);
}

/* a slave that does not answer keeps the PDOs of its EEPROM, and is said to */
static void pdo_mute_slave(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave d drive in=22 out=22\nslave e drive in=8 out=8\n");

	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 10000), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	wait_known(b);
	KUNIT_EXPECT_TRUE(test, bus_slave(b, 0)->pdos.known);
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&bus_slave(b, 0)->pdos.sm[2]), 22u);
	KUNIT_EXPECT_EQ(test, ec_pdo_list_bytes(&bus_slave(b, 1)->pdos.sm[2]), 8u);
}

/* Name of PDO 0 of SM2, or of its entry @entry. */
static const char *shown(struct bus *b, int entry)
{
	static struct ec_ioc_pdo_entry e;
	static struct ec_ioc_pdo p;

	p = (struct ec_ioc_pdo){ .sm = 2, .name = "?" };
	e = (struct ec_ioc_pdo_entry){ .sm = 2, .entry_pos = entry, .name = "?" };
	if (entry < 0) {
		KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_PDO, &p), 0);
		return p.name;
	}
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_PDO_ENTRY, &e), 0);
	return e.name;
}

static struct bus *nameless(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave d drive in=22 out=22 mapping=rewritable\n");

	bus_strip_names(b, 0);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 10000), ~0ull);
	return b;
}

/* What the EEPROM has no name for is called as in the object dictionary. */
static void pdo_names_of_dictionary(struct kunit *test)
{
	struct bus *b = nameless(test);
	u32 i, n;

	KUNIT_EXPECT_STREQ(test, shown(b, 0), "");
	bus_idle(b);
	n = bus_slave(b, 0)->pdos.sm[2].pdos[0].n_entries;
	KUNIT_EXPECT_GT(test, n, 1u);
	for (i = 0; i < n; i++)
		if (bus_slave(b, 0)->pdos.sm[2].pdos[0].entries[i].index)
			KUNIT_EXPECT_STRNEQ_MSG(test, shown(b, i), "", "entry %u", i);
	KUNIT_EXPECT_STREQ(test, shown(b, 0), "Controlword");
	KUNIT_EXPECT_STRNEQ(test, shown(b, -1), "");
}

/* Beside a cycle nothing is asked for; what is known already is shown. */
static void pdo_names_beside_cycle(struct kunit *test)
{
	struct bus *b = nameless(test);
	struct ec_slave *s;
	struct cyc *c;
	u32 n, config;

	bus_idle(b);
	s = bus_slave(b, 0);
	n = s->pdos.names.n;
	KUNIT_ASSERT_GT(test, n, 0u);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	config = cyc_config(c, 0);
	cyc_remap(c, config);
	cyc_map(c, config, 2, 0);
	cyc_map(c, config, 3, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 500);
	KUNIT_EXPECT_EQ(test, s->pdos.names.n, n);
	KUNIT_EXPECT_STREQ(test, shown(b, 0), "Controlword");
	cyc_release(c);
	bus_idle(b);
	KUNIT_EXPECT_GE(test, s->pdos.names.n, n);
	KUNIT_EXPECT_STRNEQ(test, shown(b, 2), "");
}

/* Another caller used the mailbox longer than the master waits for names: it asks again later. */
static void pdo_names_after_long_transfer(struct kunit *test)
{
	struct bus *b = nameless(test);
	struct ec_claim claim = { 0 };
	struct ec_slave *s;

	bus_idle(b);
	s = bus_slave(b, 0);
	KUNIT_ASSERT_GT(test, s->pdos.names.n, 0u);
	ec_names_free(s);
	s->pdos.names_done = false;
	KUNIT_ASSERT_EQ(test, ec_mbox_claim(&s->mbox, &claim, BIT(EC_MBOX_COE), 0), 0);
	ec_slave_kick(s);
	msleep(2000);
	ec_mbox_unclaim(&s->mbox, &claim);
	KUNIT_ASSERT_EQ(test, s->pdos.names.n, 0u);
	ec_slave_kick(s);
	bus_idle(b);
	KUNIT_EXPECT_GT(test, s->pdos.names.n, 0u);
}

#define HOSTILE_PDOS	252	/* of 255 entries each, in categories of 63: 504 KiB */

/* A PDO of the EEPROM with 255 entries, 0x7000 + @number and 0x2000 upwards. */
static void hostile_pdo(u8 *p, u32 number, u8 name)
{
	u32 i;

	put_unaligned_le16(0x1600 + number, p);
	p[2] = 255;
	p[5] = name;
	for (i = 0; i < 255; i++) {
		put_unaligned_le16(i ? 0x2000 + i : 0x7000, p + 8 + 8 * i);
		p[8 + 8 * i + 2] = number;
		p[8 + 8 * i + 3] = i ? 0 : number + 1;	/* string */
		p[8 + 8 * i + 5] = 8;
	}
}

static u8 *hostile_eeprom(struct kunit *test)
{
	u8 *img = kvzalloc(EC_MAX_SII_BYTES, GFP_KERNEL), *p = img + EC_SII_FIXED_SIZE;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, img);
	for (i = 0; i < HOSTILE_PDOS; i++, p += 8 + 255 * 8) {
		if (i % 63 == 0) {
			put_unaligned_le16(EC_SII_CAT_RXPDO, p);
			put_unaligned_le16(63 * (8 + 255 * 8) / 2, p + 2);
			p += 4;
		}
		hostile_pdo(p, i, i + 1);
	}
	put_unaligned_le16(EC_SII_CAT_END, p);
	return img;
}

/* Names cost no product of what EEPROM and object dictionary have. */
static void pdo_names_of_hostile_slave(struct kunit *test)
{
	struct ec_slave *s = kunit_kzalloc(test, sizeof(*s), GFP_KERNEL);
	struct ec_pdo_list l = { 0 };
	u64 ticks;
	u32 i, k;

	KUNIT_ASSERT_NOT_NULL(test, s);
	s->eeprom.data = hostile_eeprom(test);
	s->eeprom.bytes = EC_MAX_SII_BYTES;
	for (i = 0; i < 255; i++) {
		struct ec_pdo *p = ec_pdo_add(&l, 0x1600 + i, 0);

		KUNIT_ASSERT_NOT_NULL(test, p);
		for (k = 0; k < 255; k++) {
			struct ec_pdo_entry e = {
				.index = k < 2 ? 0x7000 : 0x3000 + k, .bits = 8,
				.sub = k ? HOSTILE_PDOS - 1 - i : i,
			};

			KUNIT_ASSERT_EQ(test, ec_pdo_add_entry(p, &e), 0);
		}
	}
	ticks = __builtin_ia32_rdtsc();
	ec_slave_name_pdos(s, &l);
	ticks = __builtin_ia32_rdtsc() - ticks;
	bus_figure("names for 255 PDOs of 255 entries from an EEPROM with as many: %llu ticks of the CPU",
		   ticks);
	KUNIT_EXPECT_LT(test, ticks, 2000000000ull);
	/* of the PDO itself, and of another one */
	for (i = 0; i < HOSTILE_PDOS; i++) {
		KUNIT_EXPECT_EQ(test, l.pdos[i].name, i + 1);
		KUNIT_EXPECT_EQ(test, l.pdos[i].entries[0].name, i + 1);
		KUNIT_EXPECT_EQ(test, l.pdos[i].entries[1].name, HOSTILE_PDOS - i);
		KUNIT_EXPECT_EQ(test, l.pdos[i].entries[2].name, 0);
	}
	KUNIT_EXPECT_EQ(test, l.pdos[254].name, 0);
	ec_pdo_list_clear(&l);
	kvfree(s->eeprom.data);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(pdo_same_as_eeprom),
	KUNIT_CASE(pdo_mailbox_failed_read_later),
	KUNIT_CASE(pdo_changed_mapping_is_seen),
	KUNIT_CASE(pdo_mute_slave),
	KUNIT_CASE(pdo_names_of_dictionary),
	KUNIT_CASE(pdo_names_beside_cycle),
	KUNIT_CASE(pdo_names_after_long_transfer),
	KUNIT_CASE(pdo_names_of_hostile_slave),
	{ }
};

static struct kunit_suite suite = { .name = "bus_pdo", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
