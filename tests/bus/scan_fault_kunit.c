// SPDX-License-Identifier: GPL-2.0-only
/* The scan of a bus where something is wrong: it never holds up the others. */
#include "bus.h"
#include "master/boundary/ioctl.h"
#include "master/bus/bus_list.h"

#define N	6

static const char line[] =
	"segment seed=5 response=100us transition=200us\n"
	"slave a EK1100\nslave b EL2008\nslave c EL3062\n"
	"slave d EL4002\nslave e EL1008\nslave f EL2004\n";

/* a segment not plugged in yet, at which something can be prepared */
static struct bus *prepare(struct kunit *test)
{
	struct bus *b = bus_new(test, line);

	KUNIT_ASSERT_EQ(test, ec_sim_count(b->sim), N);
	return b;
}

/* All but @bad (or N) are in PREOP, with the right EEPROM. */
static void are_fine(struct bus *b, u32 bad)
{
	u32 i;

	for (i = 0; i < N; i++) {
		struct ec_slave *s = bus_slave(b, i);

		if (i == bad)
			continue;
		KUNIT_EXPECT_EQ_MSG(b->test, s->al.status, EC_AL_PREOP, "slave %u: %s", i,
				    s->note.why);
		KUNIT_EXPECT_EQ(b->test, s->note.error, EC_SLAVE_OK);
		KUNIT_ASSERT_NOT_NULL(b->test, s->eeprom.data);
		KUNIT_EXPECT_MEMEQ(b->test, s->eeprom.data, bus_esc(b, i)->eep.data,
				   s->eeprom.bytes);
	}
}

/* Plug in, and wait for that for @limit_ms. */
static void others_fine(struct bus *b, u32 bad, u32 limit_ms)
{
	bus_plug_scanned(b, N, limit_ms);
	are_fine(b, bad);
}

static void failed_with(struct bus *b, u32 position, const char *text)
{
	struct ec_slave *s = bus_slave(b, position);

	KUNIT_EXPECT_EQ(b->test, s->note.error, EC_SLAVE_SCAN_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(s->note.why, text), "why: %s", s->note.why);
}

static void scan_mixed_widths(struct kunit *test)
{
	struct bus *b = prepare(test);
	u32 i;

	for (i = 0; i < N; i += 2)
		bus_esc(b, i)->cfg.eeprom_8byte = false;
	others_fine(b, N, 1000);
}

static void scan_pdi_holds_eeprom(struct kunit *test)
{
	struct bus *b = prepare(test);
	u32 i;

	for (i = 0; i < N; i++) {
		bus_esc(b, i)->mem[EC_REG_EEP_OWNER] = EC_EEP_OWNER_PDI;
		bus_esc(b, i)->mem[EC_REG_EEP_PDI] = 1;
	}
	others_fine(b, N, 1000);
}

static void scan_pdi_holds_eeprom_of_deaf(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_esc(b, 2)->mem[EC_REG_EEP_PDI] = 1;
	bus_fault(b, EC_SIM_FAULT_MISS_BROADCAST, 2, 0, 1, 0);
	others_fine(b, N, 1000);
}

/* The PDI of one gets its EEPROM while the others are read: what took it over was lost. */
static void scan_pdi_takes_eeprom(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_esc(b, 3)->cfg.eeprom_busy_ns = 6 * NSEC_PER_MSEC;
	bus_plug(b);
	while (get_unaligned_le32(bus_esc(b, 3)->mem + EC_REG_EEP_ADDRESS) != 4)
		usleep_range(100, 101);
	bus_esc(b, 3)->mem[EC_REG_EEP_OWNER] = EC_EEP_OWNER_PDI;
	bus_wait(b, N, EC_AL_PREOP, 1500);
	bus_idle(b);
	are_fine(b, N);
	/* at once */
	KUNIT_EXPECT_EQ(test, bus_table(b)->lists, 1);
}

static void scan_slow_eeprom(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_esc(b, 3)->cfg.eeprom_busy_ns = 6 * NSEC_PER_MSEC;
	others_fine(b, N, 1500);
}

static void scan_refused_some(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 1, 0, 3, 0);
	others_fine(b, N, 1000);
}

static void scan_refused_all(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 1, 0, ~0u, 0);
	others_fine(b, 1, 400);
	failed_with(b, 1, "SII read failed at word 0x0000: no acknowledge");
}

/* A requested state neither replaces its error nor keeps it from being read again. */
static void scan_refused_state_request(struct kunit *test)
{
	static const u8 state[] = { EC_AL_PREOP, EC_AL_INIT };
	struct bus *b = prepare(test);
	u32 i;

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 2, 0, ~0u, 0);
	others_fine(b, 2, 400);
	for (i = 0; i < ARRAY_SIZE(state); i++) {
		struct ec_ioc_state st = { .slave.position = 2, .state = state[i] };

		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_STATE, &st), -EIO);
		KUNIT_EXPECT_NOT_NULL_MSG(test,
					  strstr(b->app.reason,
						 "slave 2 could not be read: SII read failed"),
					  "%s", b->app.reason);
		msleep(50);
		failed_with(b, 2, "no acknowledge");
	}
	/* nor does a worker that has begun before */
	ec_slave_request(bus_slave(b, 2), EC_AL_PREOP);
	msleep(50);
	failed_with(b, 2, "no acknowledge");
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 2, 0, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 5000), ~0ull);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 2)->order, "EL3062");
}

/* Reading is ended without a cause in the slaves: none appears that was not read. */
static void scan_not_read_not_published(struct kunit *test)
{
	struct bus *b = prepare(test);
	u32 i, unread = 0;

	bus_plug(b);
	WRITE_ONCE(bus_base(b)->stopping, true);
	for (i = 0; i < 100; i++) {
		msleep(1);
		unread += bus_n_slaves(b) && !bus_slave(b, 0)->eeprom.data;
	}
	WRITE_ONCE(bus_base(b)->stopping, false);
	KUNIT_EXPECT_EQ(test, unread, 0u);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
}

/* One that was not read is no known slave: its object is never filled while others see it. */
static void scan_not_read_gets_new_object(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_slave *old;

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 2, 0, ~0u, 0);
	others_fine(b, 2, 400);
	old = ec_slave_ref(bus_slave(b, 2));
	WRITE_ONCE(old->note.error, EC_SLAVE_OK);
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, 2, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_CUT, 4, 1, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 5, EC_AL_PREOP, 1000), ~0ull);
	KUNIT_EXPECT_PTR_NE(test, bus_slave(b, 2), old);
	KUNIT_EXPECT_NULL(test, old->eeprom.data);
	ec_slave_unref(old);
}

/* a contact that is open for a while, from some time after the stations were read */
static struct bounce {
	struct bus *b;
	int position;
	u64 after_ns;
	u64 ns;
	u32 times;
} bounces;

/* The scan asks right after that read: is the failed slave 0 attached? */
static bool bounce(const struct ec_slave *s)
{
	struct ec_sim_fault dead = {
		.at_ns = ktime_get_ns() + bounces.after_ns, .type = EC_SIM_FAULT_DEAD,
		.slave = bounces.position, .arg = 1,
	};

	if (bounces.times++)
		return true;
	ec_sim_add_fault(bounces.b->sim, &dead);
	dead.at_ns += bounces.ns;
	dead.arg = 0;
	ec_sim_add_fault(bounces.b->sim, &dead);
	return true;
}

static void bounce_at(struct bus *b, int position)
{
	static struct ec_bus_ops ops;

	ops = *bus_table(b)->ops;
	ops.attached = bounce;
	bus_table(b)->ops = &ops;
	bounces.b = b;
	bounces.position = position;
	bounces.times = 0;
	WRITE_ONCE(bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
}

/* A known slave keeps its registers. */
static void scan_bounce_known(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	struct ec_slave *s = bus_slave(b, 2);
	u8 regs[EC_INFO_SIZE];
	u16 dl = s->dl_status;

	bus_idle(b);
	bounces = (struct bounce){ .ns = 20 * NSEC_PER_USEC };
	bounce_at(b, 2);
	memcpy(regs, s->regs, sizeof(regs));
	bus_fault(b, EC_SIM_FAULT_CUT, 4, 1, 0, 0);
	msleep(500);
	/* another scan follows, as the ports of this one were not read */
	KUNIT_EXPECT_EQ(test, bounces.times, 2u);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 5u);
	KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, 2), s);
	KUNIT_EXPECT_MEMEQ(test, s->regs, regs, sizeof(regs));
	KUNIT_EXPECT_EQ(test, s->dl_status, dl);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
}

/* A new one, which has accepted its address, is read again. */
static void scan_bounce_new(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u32 lines = bus_log_lines("EtherCAT 0-5: scan failed: no reply to a register read");
	u8 regs[EC_INFO_SIZE], v[4];
	u64 t0;

	bus_idle(b);
	memcpy(regs, bus_slave(b, 5)->regs, sizeof(regs));
	bus_fault(b, EC_SIM_FAULT_CUT, 4, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 5, EC_AL_PREOP, 1000), ~0ull);
	bus_idle(b);
	t0 = ktime_get_ns();
	bus_fprd(b, bus_slave(b, 0)->station, 0, v, 4);
	t0 = ktime_get_ns() - t0;
	bounces = (struct bounce){ .after_ns = t0 * 3 / 2, .ns = 3 * t0 };
	bounce_at(b, 5);
	bus_fault(b, EC_SIM_FAULT_HEAL, 4, 1, 0, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 2000), ~0ull);
	KUNIT_EXPECT_MEMEQ(test, bus_slave(b, 5)->regs, regs, sizeof(regs));
	KUNIT_EXPECT_EQ(test, bus_log_lines("EtherCAT 0-5: scan failed: no reply to a register read"),
			lines + 1);
}

static void scan_busy_forever(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, 4, 0, 1, 0);
	others_fine(b, 4, 600);
	failed_with(b, 4, "busy too long");
}

/* CPUs that stand in for an EEPROM, one of them slow */
static void scan_emulated_eeprom(struct kunit *test)
{
	struct bus *b = bus_new(test,
		"segment seed=5 response=100us transition=200us\n"
		"slave a EK1100\nslave b EL2008\nslave c EL3062 eeprom=emulated\n"
		"slave d EL4002\nslave e EL7201 eeprom=emulated\nslave f EL2004\n");

	bus_esc(b, 4)->cfg.eeprom_busy_ns = 6 * NSEC_PER_MSEC;
	others_fine(b, N, 2500);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 2)->order, "EL3062");
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 4)->order, "EL7201");
}

/* one whose CPU hangs never answers */
static void scan_emulated_eeprom_mute(struct kunit *test)
{
	struct bus *b = bus_new(test,
		"segment seed=5 response=100us transition=200us\n"
		"slave a EK1100\nslave b EL2008\nslave c EL3062 eeprom=emulated\n"
		"slave d EL4002\nslave e EL7201\nslave f EL2004\n");

	bus_fault(b, EC_SIM_FAULT_MUTE, 2, 0, 1, 0);
	others_fine(b, 2, 600);
	failed_with(b, 2, "busy too long");
}

/* no access begins or ends in unused registers, where some answer nothing */
static void scan_no_unused_registers(struct kunit *test)
{
	struct bus *b = prepare(test);
	u32 i;

	for (i = 0; i < N; i++)
		bus_esc(b, i)->cfg.features |= EC_FEAT_NO_UNUSED;
	others_fine(b, N, 1000);
}

static void scan_deaf(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_fault(b, EC_SIM_FAULT_MISS_BROADCAST, 0, 0, 1, 0);
	bus_fault(b, EC_SIM_FAULT_MISS_BROADCAST, 3, 0, 1, 0);
	others_fine(b, N, 1000);
}

static void scan_dead(struct kunit *test)
{
	struct bus *b = prepare(test);

	bus_fault(b, EC_SIM_FAULT_DEAD, 2, 0, 1, 0);
	others_fine(b, 2, 600);
	failed_with(b, 2, "station address not accepted");
}

static void scan_mute(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_slave *s;

	bus_fault(b, EC_SIM_FAULT_MUTE, 2, 0, 1, 0);
	others_fine(b, 2, 600);
	s = bus_slave(b, 2);
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_INIT);
	KUNIT_EXPECT_STREQ(test, s->order, "EL3062");
	/* its own worker gives up after the time of the transition */
	msleep(4000);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(s->note.why, "PREOP not reached in time"), "why: %s",
				  s->note.why);
}

static void scan_bad_checksum(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_cause cause;

	/* found after power-on, so the slave itself goes on */
	bus_esc(b, 5)->eep.data[14] ^= 0x55;
	others_fine(b, N, 1000);
	KUNIT_EXPECT_FALSE(test, bus_slave(b, 5)->info.checksum_ok);
	ec_slave_cause(bus_slave(b, 5), &cause);
	KUNIT_EXPECT_EQ(test, cause.kind, EC_CAUSE_EEPROM);
}

static void scan_blank(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_esc_eeprom *e = &bus_esc(b, 5)->eep;

	memset(e->data, 0xff, e->len);
	others_fine(b, 5, 1000);
	/* nothing in it: no mailbox, no PDO, identity of all ones */
	KUNIT_EXPECT_EQ(test, bus_slave(b, 5)->info.vendor, 0xffffffff);
	KUNIT_EXPECT_LE(test, bus_slave(b, 5)->eeprom.bytes, 1024ul);
	KUNIT_EXPECT_NOT_NULL(test, strstr(bus_slave(b, 5)->note.sii_flaw,
					   "EEPROM is blank (only 0xff)"));
}

static void has_flaw(struct bus *b, u32 position, const char *text)
{
	const char *flaw = bus_slave(b, position)->note.sii_flaw;

	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(flaw, text), "'%s' has no '%s'", flaw, text);
}

/* More than all EEPROMs may have together: this slave is refused, the others are read. */
static void scan_too_much(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_esc_eeprom *e = &bus_esc(b, 5)->eep;
	long most = EC_MAX_SII_TOTAL - N * 2048;

	put_unaligned_le16(0x001f, e->data + 2 * EC_SII_W_SIZE);
	put_unaligned_le16(0x0900, e->data + EC_SII_FIXED_SIZE);
	put_unaligned_le16(3000 / 2, e->data + EC_SII_FIXED_SIZE + 2);
	atomic_long_add(most, &bus_table(b)->sii_bytes);
	others_fine(b, 5, 1000);
	failed_with(b, 5,
		    "the EEPROMs of all slaves exceed 64 MiB; disconnect slaves with large EEPROMs");
	atomic_long_sub(most, &bus_table(b)->sii_bytes);
}

static void scan_blank_zeros(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_esc_eeprom *e = &bus_esc(b, 5)->eep;

	memset(e->data, 0, e->len);
	others_fine(b, 5, 1000);
	has_flaw(b, 5, "EEPROM is blank (only 0x00)");
	KUNIT_EXPECT_LE(test, bus_slave(b, 5)->eeprom.bytes, 1024ul);
}

/* The cause is the EEPROM, not that PREOP was not reached in time. */
static void scan_blank_mute(struct kunit *test)
{
	struct bus *b = prepare(test);
	struct ec_esc_eeprom *e = &bus_esc(b, 2)->eep;

	memset(e->data, 0xff, e->len);
	bus_fault(b, EC_SIM_FAULT_MUTE, 2, 0, 1, 0);
	others_fine(b, 2, 1000);
	msleep(4000);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 2)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 2)->note.why,
			   "EEPROM is blank (only 0xff): no identity, no mailbox; write an image; then PREOP not reached in time");
}

/* The first category of @type; test ends without one. */
static u8 *category(struct bus *b, u32 index, u16 type)
{
	struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	ec_sii_iter_init(&it, e->data, e->len);
	while (ec_sii_iter_next(&it, &cat) == 1)
		if (cat.type == type)
			return e->data + cat.offset;
	KUNIT_ASSERT_TRUE(b->test, false);
	return NULL;
}

static void scan_damaged(struct kunit *test)
{
	struct bus *b = prepare(test);
	u8 *strings = category(b, 1, EC_SII_CAT_STRINGS);
	u8 *pdo = category(b, 2, EC_SII_CAT_TXPDO);
	struct ec_esc_eeprom *e = &bus_esc(b, 4)->eep;

	/* a string, then a PDO, longer than its category; a category larger than the EEPROM */
	strings[5] = 0xff;
	pdo[6] = 0xff;
	put_unaligned_le16(0xc000, category(b, 3, EC_SII_CAT_RXPDO) + 2);
	/* categories beyond the declared size: 128 bytes */
	put_unaligned_le16(0, e->data + 2 * EC_SII_W_SIZE);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 3000), ~0ull);
	has_flaw(b, 1, "an entry of category 0x000a at word 0x0040 is longer than the category");
	has_flaw(b, 2, "an entry of category 0x0032 at word ");
	has_flaw(b, 3, "category 0x0033 at word ");
	has_flaw(b, 3, "has 98304 bytes, the EEPROM has 2048");
	has_flaw(b, 4, "beyond the declared size of 128 (word 0x003e); all are used");
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 0)->note.sii_flaw, "");
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 4)->order, "EL1008");
}

/* Who stays is not read again. */
static void scan_reads_new_slaves_only(struct kunit *test)
{
	struct ec_slave *old[4];
	struct bus *b = prepare(test);
	u64 all;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_CUT, 3, 1, 0, 0);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 4, EC_AL_PREOP, 1000), ~0ull);
	all = bus_scan_frames(b);
	for (i = 0; i < 4; i++)
		old[i] = bus_slave(b, i);

	bus_fault(b, EC_SIM_FAULT_HEAL, 3, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, i), old[i]);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, 5)->order, "EL2004");
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 3), 1), 4);

	/* nobody is new now: no EEPROM is read */
	bus_fault(b, EC_SIM_FAULT_CUT, 4, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 5, EC_AL_PREOP, 1000), ~0ull);
	KUNIT_EXPECT_LT(test, bus_scan_frames(b), 12ull);
	KUNIT_EXPECT_LT(test, 8 * bus_scan_frames(b), all);
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 4), 1), EC_UAPI_NONE16);
}

/* The request of a user reads everything anew. */
static void scan_on_request(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u64 frames = bus_frames(b);
	struct ec_esc_eeprom *e = &bus_esc(b, 1)->eep;

	/* the serial number changes */
	put_unaligned_le32(4711, e->data + 2 * EC_SII_W_SERIAL);
	bus_rescan(b);
	KUNIT_ASSERT_EQ(test, ec_bus_wait_scan(bus_table(b)), 0);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->info.serial, 4711);
	KUNIT_EXPECT_GT(test, bus_frames(b) - frames, 50ull);
	KUNIT_EXPECT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
}

/* A slave from another master's bus has an address one of ours has. */
static void scan_foreign_address(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);
	u32 i, k;

	bus_fault(b, EC_SIM_FAULT_CUT, 3, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, 4, EC_AL_PREOP, 1000), ~0ull);
	/* the address of the slave in front of the cut */
	memcpy(bus_esc(b, 4)->mem + EC_REG_STATION, bus_esc(b, 1)->mem + EC_REG_STATION, 2);
	bus_fault(b, EC_SIM_FAULT_HEAL, 3, 1, 0, 0);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
	for (i = 0; i < N; i++) {
		struct ec_slave *s = bus_slave(b, i);

		KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
		KUNIT_EXPECT_EQ(test, s->station,
				get_unaligned_le16(bus_esc(b, i)->mem + EC_REG_STATION));
		KUNIT_EXPECT_EQ(test, s->info.product,
				get_unaligned_le32(bus_esc(b, i)->eep.data + 2 * EC_SII_W_PRODUCT));
		for (k = 0; k < i; k++)
			KUNIT_EXPECT_NE(test, s->station, bus_slave(b, k)->station);
	}
}

/* Power off and on between two looks: the number of slaves never changes. */
static void scan_power_blip(struct kunit *test)
{
	struct bus *b = bus_up(test, line, N);

	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, N - 1, 0, 0, 0);
	usleep_range(1000, 1001);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, N - 1, 0, 0, 0);
	ec_sim_advance(b->sim, ktime_get_ns());
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(b, N - 1)->mem + EC_REG_STATION), 0);
	usleep_range(100000, 100001);
	KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, bus_slave(b, N - 1)->station,
			get_unaligned_le16(bus_esc(b, N - 1)->mem + EC_REG_STATION));
	KUNIT_EXPECT_EQ(test, bus_esc(b, N - 1)->mem[EC_REG_AL_STATUS], EC_AL_PREOP);
}

/* Who asks for the master right after its device came waits for the scan. */
static void scan_comes_before_reserve(struct kunit *test)
{
	struct bus *b = bus_new(test, line);

	bus_plug(b);
	KUNIT_ASSERT_EQ(test, ec_bus_wait_scan(bus_table(b)), 0);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), (u32)N);
}

static struct kunit_case scan_fault_cases[] = {
	KUNIT_CASE(scan_mixed_widths),
	KUNIT_CASE(scan_pdi_holds_eeprom),
	KUNIT_CASE(scan_pdi_holds_eeprom_of_deaf),
	KUNIT_CASE(scan_pdi_takes_eeprom),
	KUNIT_CASE(scan_slow_eeprom),
	KUNIT_CASE(scan_refused_some),
	KUNIT_CASE(scan_refused_all),
	KUNIT_CASE(scan_refused_state_request),
	KUNIT_CASE(scan_not_read_not_published),
	KUNIT_CASE(scan_not_read_gets_new_object),
	KUNIT_CASE(scan_bounce_known),
	KUNIT_CASE(scan_bounce_new),
	KUNIT_CASE(scan_busy_forever),
	KUNIT_CASE(scan_emulated_eeprom),
	KUNIT_CASE(scan_emulated_eeprom_mute),
	KUNIT_CASE(scan_no_unused_registers),
	KUNIT_CASE(scan_deaf),
	KUNIT_CASE(scan_dead),
	KUNIT_CASE(scan_mute),
	KUNIT_CASE(scan_bad_checksum),
	KUNIT_CASE(scan_blank),
	KUNIT_CASE(scan_blank_zeros),
	KUNIT_CASE(scan_blank_mute),
	KUNIT_CASE(scan_too_much),
	KUNIT_CASE(scan_damaged),
	KUNIT_CASE(scan_reads_new_slaves_only),
	KUNIT_CASE(scan_on_request),
	KUNIT_CASE(scan_foreign_address),
	KUNIT_CASE(scan_power_blip),
	KUNIT_CASE(scan_comes_before_reserve),
	{}
};

static struct kunit_suite scan_fault_suite = {
	.name = "bus_scan_fault",
	.exit = bus_exit,
	.test_cases = scan_fault_cases,
};

kunit_test_suite(scan_fault_suite);

MODULE_LICENSE("GPL");
