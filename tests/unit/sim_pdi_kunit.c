// SPDX-License-Identifier: GPL-2.0-only
/*
 * What the master sees of the slave's CPU: that it hangs, that it stands in
 * for an EEPROM, when it changed buffers; and what the CPU acknowledges.
 */
#include "sim_esc_kunit.h"

#define MS	1000000ull

static void mute(struct kunit *test, struct bed *b, u32 on)
{
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_MUTE, .arg = on,
				  .at_ns = b->now };

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	ec_sim_advance(b->sim, b->now);
}

static void sim_pdi_hanging_cpu_lets_its_watchdog_expire(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u64 hung;
	u8 v;

	bed_put(b, 1001, 0x200, EC_ECAT_EVENT_DL, 2);
	bed_get(b, 1001, 0x110, 2);
	bed_put(b, 1001, 0x410, 50, 2);		/* 5 ms */
	ec_sim_advance(b->sim, b->now += 1000 * MS);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x442, 2), 0ull);
	mute(test, b, 1);
	hung = b->now;
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), hung + 5 * MS);
	b->now = hung + 4 * MS;			/* it does something yet */
	ec_esc_pdi_read(esc, 0x120, &v, 1, b->now);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), hung + 9 * MS);
	b->now = hung + 9 * MS - 50000;
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x110, 2) & EC_DLS_PDI_WD_OK);
	b->now = hung + 9 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x442, 2), 0x0100ull);
	KUNIT_EXPECT_EQ(test, b->irq, EC_ECAT_EVENT_DL);
	KUNIT_EXPECT_FALSE(test, bed_get(b, 1001, 0x110, 2) & EC_DLS_PDI_WD_OK);
	/* that of the process data has nothing to do with it */
	KUNIT_EXPECT_FALSE(test, esc->al_event & EC_AL_EVENT_WD);
	bed_get(b, 1001, 0x110, 2);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
	/* once only, until it is started again */
	b->now += 1000 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x443, 1), 1ull);
	mute(test, b, 0);
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x110, 2) & EC_DLS_PDI_WD_OK);
	mute(test, b, 1);
	b->now += 6 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x443, 1), 2ull);
	/* either counter clears both */
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x442, 0, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x443, 1), 0ull);
}

static void sim_pdi_watchdog_time_of_zero_is_off(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);

	bed_put(b, 1001, 0x410, 0, 2);
	bed_put(b, 1001, 0x420, 0, 2);
	mute(test, b, 1);
	ec_sim_advance(b->sim, b->now += 1000 * MS);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 4), 1ull);
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x110, 2) & EC_DLS_PDI_WD_OK);
	/* switched on while it hangs */
	bed_put(b, 1001, 0x410, 10, 2);
	b->now += 2 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 4), 0x01000001ull);
}

static void sim_pdi_watchdog_counters_stop_at_end(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2] = {};
	int i;

	bed_put(b, 1001, 0x410, 1, 2);
	bed_put(b, 1001, 0x420, 1, 2);
	bed_sm(b, 1001, 2, 0x1100, 2, 0x64);
	mute(test, b, 1);
	for (i = 0; i < 300; i++) {
		bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2);
		ec_esc_pdi_read(esc, 0x120, v, 1, b->now);
		ec_sim_advance(b->sim, b->now += MS);
	}
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 4), 0xffff0000ull);
}

/* ---- EEPROM emulated by the PDI */

static int asked;

static void on_eeprom(struct ec_esc *esc, u64 now)
{
	(void)esc;
	(void)now;
	asked++;
}

static const struct ec_esc_app_ops eeprom_ops = { .eeprom = on_eeprom };

static struct bed *emulated(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);

	b->cfg.eeprom_emulated = true;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	ec_sim_slave(b->sim, 0)->app_ops = &eeprom_ops;
	asked = 0;
	return b;
}

static void sim_pdi_answers_for_eeprom(struct kunit *test)
{
	struct bed *b = emulated(test);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[8], data[8] = { 1, 2, 3, 4, 5, 6, 7, 8 };

	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x60ull);
	bed_put(b, 1001, 0x502, EC_EEP_CMD_READ | 8 << 16, 6);
	KUNIT_EXPECT_EQ(test, asked, 1);
	KUNIT_EXPECT_TRUE(test, esc->al_event & EC_AL_EVENT_EEPROM);
	/* as long as it takes; nothing else is taken meanwhile */
	b->now += 1000 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x8160ull);
	bed_put(b, 1001, 0x502, EC_EEP_CMD_READ | 9 << 16, 6);
	KUNIT_EXPECT_EQ(test, asked, 1);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x502, v, 6, b->now), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v) & EC_EEP_CMD_MASK,
			EC_EEP_CMD_READ);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v + 2), 8u);
	ec_esc_pdi_write(esc, 0x508, data, 8, b->now);
	put_unaligned_le16(EC_EEP_CMD_WRITE, v);	/* not what was asked */
	ec_esc_pdi_write(esc, 0x502, v, 2, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x8160ull);
	put_unaligned_le16(EC_EEP_CMD_READ, v);
	ec_esc_pdi_write(esc, 0x502, v, 2, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x60ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x508, 8), 0x0807060504030201ull);
	KUNIT_EXPECT_FALSE(test, esc->al_event & EC_AL_EVENT_EEPROM);
	/* without a command the data are not the PDI's */
	memset(data, 0, sizeof(data));
	ec_esc_pdi_write(esc, 0x508, data, 8, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x508, 8), 0x0807060504030201ull);
}

static void sim_pdi_may_fail_as_eeprom(struct kunit *test)
{
	struct bed *b = emulated(test);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2];

	bed_put(b, 1001, 0x508, 0xbeef, 2);
	bed_put(b, 1001, 0x502, EC_EEP_CMD_WRITE | 20 << 16, 6);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x4060ull);
	KUNIT_EXPECT_EQ(test, asked, 0);
	bed_put(b, 1001, 0x502, EC_EEP_CMD_WRITE | 1 | 20 << 16, 6);
	KUNIT_EXPECT_EQ(test, asked, 1);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x508, v, 2, b->now), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0xbeef);
	put_unaligned_le16(EC_EEP_CMD_WRITE | EC_EEP_ERR_ACK, v);
	ec_esc_pdi_write(esc, 0x502, v, 2, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x2060ull);
	bed_put(b, 1001, 0x502, 0, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x60ull);
}

/* ---- SYNC signals held, buffer times */

static int syncs[2];

static void on_sync(struct ec_esc *esc, int which, u64 now)
{
	(void)esc;
	(void)now;
	syncs[which]++;
}

static const struct ec_esc_app_ops sync_ops = { .sync = on_sync };

/* 1 ms, the first in 1 ms, SYNC1 with every second one */
static u64 start_sync(struct bed *b)
{
	u64 t = b->now + MS + 10000;

	syncs[0] = syncs[1] = 0;
	ec_sim_slave(b->sim, 0)->app_ops = &sync_ops;
	bed_put(b, 1001, 0x9a0, MS | MS << 32, 8);
	t = ec_esc_system_time(ec_sim_slave(b->sim, 0), t);
	bed_put(b, 1001, 0x990, t, 8);
	bed_put(b, 1001, 0x980, 0x0700, 2);
	return t;
}

static void sim_pdi_sync_waits_for_its_acknowledge(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);
	struct ec_esc *esc;
	u64 t0;
	u8 v[2];

	b->eeprom[4] = 0;
	bed_checksum(b);
	esc = ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	t0 = b->now;
	start_sync(b);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x98e, 2), 0ull);
	ec_sim_advance(b->sim, b->now = t0 + 1500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 1);
	KUNIT_EXPECT_EQ(test, syncs[1], 0);
	ec_sim_advance(b->sim, b->now = t0 + 2500000);
	KUNIT_EXPECT_EQ(test, syncs[1], 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x98e, 2), 0x0101ull);
	/* the master's read acknowledges nothing: no further edge */
	ec_sim_advance(b->sim, b->now = t0 + 4500000);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x98e, 2), 0x0101ull);
	KUNIT_EXPECT_EQ(test, syncs[0], 1);
	KUNIT_EXPECT_EQ(test, syncs[1], 1);
	ec_esc_pdi_read(esc, 0x98e, v, 1, b->now);
	KUNIT_EXPECT_EQ(test, v[0], 1);
	KUNIT_EXPECT_FALSE(test, esc->al_event & EC_AL_EVENT_SYNC0);
	KUNIT_EXPECT_TRUE(test, esc->al_event & EC_AL_EVENT_SYNC1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x98e, 2), 0x0100ull);
	ec_sim_advance(b->sim, b->now = t0 + 5500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 2);
	KUNIT_EXPECT_EQ(test, syncs[1], 1);
	ec_esc_pdi_read(esc, 0x98f, v, 1, b->now);
	ec_sim_advance(b->sim, b->now = t0 + 8500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 2);
	KUNIT_EXPECT_EQ(test, syncs[1], 2);
}

static void sim_pdi_sync_pulses_need_no_acknowledge(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	u64 t0 = b->now;

	start_sync(b);
	ec_sim_advance(b->sim, b->now = t0 + 4500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 4);
	KUNIT_EXPECT_EQ(test, syncs[1], 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x98e, 2), 0ull);
}

static void sim_pdi_sync_unit_may_belong_to_pdi(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[8] = { 3 };

	ec_esc_pdi_write(esc, 0x981, v, 1, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x981, 1), 0ull);
	bed_put(b, 1001, 0x980, 0x0711, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x980, 2), 0x0011ull);
	bed_put(b, 1001, 0x9a0, 1000, 4);
	bed_put(b, 1001, 0x9a8, 0x0303, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9a0, 4), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9a8, 2), 0x0300ull);
	put_unaligned_le64(ec_esc_system_time(esc, b->now) + MS, v);
	ec_esc_pdi_write(esc, 0x990, v, 8, b->now);
	v[0] = 3;
	ec_esc_pdi_write(esc, 0x981, v, 1, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 1ull);
	b->now += 2 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 0ull);
}

static void sim_pdi_buffer_changes_leave_their_time(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2] = {};
	u64 at;

	bed_sm(b, 1001, 2, 0x1100, 2, 0x24);
	bed_sm(b, 1001, 3, 0x1180, 2, 0x20);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2);
	ec_esc_pdi_write(esc, 0x1180, v, 2, b->now);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9f0, 4), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9f8, 8), 0ull);
	bed_put(b, 1001, 0x816, 0x41, 1);
	bed_put(b, 1001, 0x81e, 0x81, 1);
	at = b->now + 100;			/* the cable */
	bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9f0, 4),
			(u64)(u32)ec_esc_local_time(esc, at));
	ec_esc_pdi_write(esc, 0x1180, v, 1, b->now);
	ec_esc_pdi_write(esc, 0x1181, v, 1, b->now + 300);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9f8, 4),
			(u64)(u32)ec_esc_local_time(esc, b->now - b->gap));
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9fc, 4),
			(u64)(u32)ec_esc_local_time(esc, b->now - 2 * b->gap + 300));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_pdi_hanging_cpu_lets_its_watchdog_expire),
	KUNIT_CASE(sim_pdi_watchdog_time_of_zero_is_off),
	KUNIT_CASE(sim_pdi_watchdog_counters_stop_at_end),
	KUNIT_CASE(sim_pdi_answers_for_eeprom),
	KUNIT_CASE(sim_pdi_may_fail_as_eeprom),
	KUNIT_CASE(sim_pdi_sync_waits_for_its_acknowledge),
	KUNIT_CASE(sim_pdi_sync_pulses_need_no_acknowledge),
	KUNIT_CASE(sim_pdi_sync_unit_may_belong_to_pdi),
	KUNIT_CASE(sim_pdi_buffer_changes_leave_their_time),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_pdi",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
