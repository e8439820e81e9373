// SPDX-License-Identifier: GPL-2.0-only
#include "sim_esc_kunit.h"

static struct bed *start(struct kunit *test, u32 n)
{
	return bed_new(test, 8, n);
}

/* ---- addressing and working counters */

static void sim_esc_information_registers_are_as_configured(struct kunit *test)
{
	struct bed *b = start(test, 1);
	u8 v[10];

	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0, v, 10), 1);
	KUNIT_EXPECT_EQ(test, v[0], 0x11);
	KUNIT_EXPECT_EQ(test, v[4], 8);
	KUNIT_EXPECT_EQ(test, v[5], 8);
	KUNIT_EXPECT_EQ(test, v[6], 8);
	KUNIT_EXPECT_EQ(test, v[7], 0xff);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v + 8), 0x018c);
}

static void sim_esc_write_to_read_only_register_counts_only(struct kunit *test)
{
	struct bed *b = start(test, 1);

	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, EC_REG_TYPE, 0x77, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_TYPE, 1), 0x11ull);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, EC_REG_AL_STATUS, 8, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_AL_STATUS, 2), 1ull);
}

static void sim_esc_position_addresses_are_incremented_by_each(struct kunit *test)
{
	struct bed *b = start(test, 3);
	u8 v[2] = {};

	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRD, 0xfffe, 0x10, v, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 1003);
	KUNIT_EXPECT_EQ(test, b->adp, 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRD, 0xfffd, 0x10, v, 2), 0);
	KUNIT_EXPECT_EQ(test, b->adp, 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_NOP, 5, 0x10, v, 2), 0);
	KUNIT_EXPECT_EQ(test, b->adp, 5);
	KUNIT_EXPECT_EQ(test, bed_tx(b, 77, 5, 0x10, v, 2), 0);
}

static void sim_esc_broadcast_read_is_or(struct kunit *test)
{
	struct bed *b = start(test, 3);
	u8 v[2] = { 0x40, 0 };

	ec_esc_set_al_status(ec_sim_slave(b->sim, 1), 0x12, 0x11, b->now);
	ec_esc_set_al_status(ec_sim_slave(b->sim, 2), 0x08, 0, b->now);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 3);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0x40 | 1 | 0x12 | 8);
	KUNIT_EXPECT_EQ(test, b->adp, 3);
}

static void sim_esc_read_write_commands_count_three(struct kunit *test)
{
	struct bed *b = start(test, 3);
	u8 v[2] = { 0x55, 0xaa };

	KUNIT_EXPECT_EQ(test, bed_put(b, 1002, 0xf80, 0x1234, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPRW, 1002, 0xf80, v, 2), 3);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0x1234);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0xf80, 2), 0xaa55ull);
	v[0] = 1;
	v[1] = 0;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRW, 0xffff, 0xf80, v, 2), 3);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0xaa55);
	v[0] = 0x80;
	v[1] = 0;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRW, 0, 0xf80, v, 2), 9);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0x81);
	/* what came in is written, the OR travels on */
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0xf80, 2), 0x80ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0xf80, 2), 0x81ull);
}

static void sim_esc_frmw_reads_one_and_writes_others(struct kunit *test)
{
	struct bed *b = start(test, 3);
	u8 v[2] = { 0x11, 0x11 };

	bed_put(b, 1002, 0xf80, 0x2222, 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, 1002, 0xf80, v, 2), 3);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0x2222);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0xf80, 2), 0x1111ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0xf80, 2), 0x2222ull);
	v[0] = 0;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_ARMW, 0, 0xf80, v, 2), 3);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0xf80, 2), 0x1111ull);
	/* no reader: all write */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, 7, 0xf80, v, 2), 3);
}

static void sim_esc_alias_answers_when_enabled(struct kunit *test)
{
	struct bed *b = start(test, 2);
	u8 v[2];

	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_ALIAS, 2), 0x1234ull);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 0x1234, 0x10, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1002, EC_REG_DL_ALIAS, 1, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 0x1234, 0x10, v, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 1002);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, 0x10, v, 2), 1);
	/* master may not change it */
	KUNIT_EXPECT_EQ(test, bed_put(b, 1002, EC_REG_ALIAS, 5, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, EC_REG_ALIAS, 2), 0x1234ull);
}

static void sim_esc_missing_registers_do_not_count(struct kunit *test)
{
	struct bed *b = start(test, 1);
	u8 v[16] = {};

	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x2ff0, v, 16), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x2ff1, v, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0xfff9, v, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x0ff8, v, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1009, 0, v, 16), 0);
}

/* ---- SyncManagers */

static void sim_esc_mailbox_is_full_or_empty(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[16] = "0123456789abcde", w[16];

	KUNIT_EXPECT_EQ(test, bed_sm(b, 1001, 0, 0x1000, 16, 0x26), 1);
	KUNIT_EXPECT_EQ(test, bed_sm(b, 1001, 1, 0x1080, 16, 0x22), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1080, w, 16), 0);
	KUNIT_EXPECT_FALSE(test, ec_esc_sm_readable(esc, 0));
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1000, w, 16, b->now),
			-EACCES);

	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, v, 16), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x805, 1), 0x09ull);
	w[0] = 'X';
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, w, 16), 0);
	KUNIT_EXPECT_TRUE(test, ec_esc_sm_readable(esc, 0));
	KUNIT_EXPECT_TRUE(test, esc->al_event & EC_AL_EVENT_SM(0));
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1000, w, 16, b->now), 0);
	KUNIT_EXPECT_MEMEQ(test, v, w, 16);
	KUNIT_EXPECT_FALSE(test, esc->al_event & EC_AL_EVENT_SM(0));
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x805, 1), 0x02ull);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, v, 16), 1);

	KUNIT_EXPECT_EQ(test, ec_esc_pdi_write(esc, 0x1080, v, 16, b->now), 0);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_write(esc, 0x1080, v, 16, b->now),
			-EACCES);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x80d, 1), 0x09ull);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1080, w, 16), 1);
	KUNIT_EXPECT_MEMEQ(test, v, w, 16);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1080, w, 16), 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x80d, 1), 0x02ull);
}

static void sim_esc_mailbox_needs_first_and_last_byte(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[32] = {};

	bed_sm(b, 1001, 0, 0x1000, 16, 0x26);
	/* begins in the middle, sticks out, wrong direction */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1001, v, 15), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, v, 17), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1000, v, 16), 0);
	/* in pieces */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, v, 4), 1);
	KUNIT_EXPECT_FALSE(test, ec_esc_sm_readable(esc, 0));
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x100f, v, 1), 1);
	KUNIT_EXPECT_TRUE(test, ec_esc_sm_readable(esc, 0));
	/* next to the window RAM is free for all */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1010, v, 4), 1);
}

/* a page with a window but not activated guards nothing */
static void sim_esc_disabled_sm_guards_nothing(struct kunit *test)
{
	struct bed *b = start(test, 1);
	u8 v[4] = { 1, 2, 3, 4 }, page[EC_SM_PAGE];
	struct ec_sm off = { .start = 0x1000, .len = 16, .control = 0x22 };

	ec_sm_encode(&off, page);
	bed_tx(b, EC_CMD_FPWR, 1001, EC_REG_SM(0), page, sizeof(page));
	bed_sm(b, 1001, 1, 0x1100, 16, 0x22);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1004, v, 4), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1104, v, 4), 0);
}

static void sim_esc_buffered_sm_has_three_buffers(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2] = { 1, 1 }, w[2];

	bed_sm(b, 1001, 2, 0x1100, 2, 0x24);
	bed_sm(b, 1001, 3, 0x1180, 2, 0x20);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x815, 1), 0x30ull);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1100, w, 2, 0), -EACCES);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2), 1);
	v[0] = 2;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2), 1);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1100, w, 1, 0), 0);
	KUNIT_EXPECT_EQ(test, w[0], 2);
	/* a write in between does not tear the read in pieces */
	v[0] = v[1] = 3;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2), 1);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1101, w, 1, 0), 0);
	KUNIT_EXPECT_EQ(test, w[0], 1);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1100, w, 2, 0), 0);
	KUNIT_EXPECT_EQ(test, w[0], 3);
	/* second and third buffer are out of reach */
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1102, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FPWR, 1001, 0x1106, v, 2), 1);

	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1180, w, 2), 1);
	v[0] = v[1] = 9;
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_write(esc, 0x1180, v, 2, 0), 0);
	v[0] = v[1] = 10;
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_write(esc, 0x1180, v, 1, 0), 0);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1180, w, 2), 1);
	KUNIT_EXPECT_EQ(test, w[0], 9);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x1180, w, 2), 1);
	KUNIT_EXPECT_EQ(test, w[0], 9);
}

static void sim_esc_active_sm_keeps_its_page(struct kunit *test)
{
	struct bed *b = start(test, 1);

	bed_sm(b, 1001, 0, 0x1000, 16, 0x26);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x800, 0x1234, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x800, 2), 0x1000ull);
	bed_put(b, 1001, 0x806, 0, 1);
	bed_put(b, 1001, 0x800, 0x1234, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x800, 2), 0x1234ull);
}

/* ---- FMMUs */

static void sim_esc_logical_commands_count_per_slave_and_direction(struct kunit *test)
{
	struct bed *b = start(test, 2);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[16] = { 1, 2, 3, 4 }, w[4] = { 0xa1, 0xa2, 0xa3, 0xa4 };

	bed_sm(b, 1001, 2, 0x1100, 4, 0x24);
	bed_sm(b, 1001, 3, 0x1180, 4, 0x20);
	bed_fmmu(b, 1001, 0, (struct ec_fmmu){ 0x10000, 2, 0, 7, 0x1100, 0, 2, 1 });
	bed_fmmu(b, 1001, 1, (struct ec_fmmu){ 0x10002, 2, 0, 7, 0x1102, 0, 2, 1 });
	bed_fmmu(b, 1001, 2, (struct ec_fmmu){ 0x10004, 4, 0, 7, 0x1180, 0, 1, 1 });
	bed_fmmu(b, 1002, 0, (struct ec_fmmu){ 0x10008, 4, 0, 7, 0x1200, 0, 2, 1 });
	ec_esc_pdi_write(esc, 0x1180, w, 4, 0);

	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 0, 1, v, 12), 2 + 1 + 2);
	KUNIT_EXPECT_MEMEQ(test, v + 4, w, 4);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1100, w, 4, 0), 0);
	KUNIT_EXPECT_MEMEQ(test, v, w, 4);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRD, 0, 1, v, 12), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 0, 1, v, 12), 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 12, 1, v, 4), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 11, 1, v, 4), 2);
	/* a part of the window without its first byte is refused */
	bed_put(b, 1001, EC_REG_FMMU(0) + 12, 0, 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 2, 1, v, 2), 0);
}

static void sim_esc_logical_write_leaves_inputs_alone(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2] = { 0x11, 0x22 };

	bed_fmmu(b, 1001, 0, (struct ec_fmmu){ 0, 2, 0, 7, 0x1100, 0, 1, 1 });
	esc->mem[0x1100] = 0x33;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 0, 0, v, 2), 0);
	KUNIT_EXPECT_EQ(test, esc->mem[0x1100], 0x33);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 0, 0, v, 2), 1);
	KUNIT_EXPECT_EQ(test, v[0], 0x33);
	KUNIT_EXPECT_EQ(test, esc->mem[0x1100], 0x33);
}

static void sim_esc_overlapped_lrw_exchanges_in_place(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 v[2] = { 0x11, 0x22 }, w[2] = { 0x33, 0x44 };

	bed_sm(b, 1001, 2, 0x1100, 2, 0x24);
	bed_sm(b, 1001, 3, 0x1180, 2, 0x20);
	bed_fmmu(b, 1001, 0, (struct ec_fmmu){ 0, 2, 0, 7, 0x1100, 0, 2, 1 });
	bed_fmmu(b, 1001, 1, (struct ec_fmmu){ 0, 2, 0, 7, 0x1180, 0, 1, 1 });
	ec_esc_pdi_write(esc, 0x1180, w, 2, 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRW, 0, 0, v, 2), 3);
	KUNIT_EXPECT_MEMEQ(test, v, w, 2);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x1100, w, 2, 0), 0);
	KUNIT_EXPECT_EQ(test, w[0], 0x11);
	KUNIT_EXPECT_EQ(test, w[1], 0x22);
}

static void sim_esc_bits_are_mapped_one_by_one(struct kunit *test)
{
	struct bed *b = start(test, 2);
	struct ec_esc *esc = ec_sim_slave(b->sim, 1);
	u8 v[2] = { 0xff, 0x00 };

	/* 4 bits from bit 6 of the first byte, physical from bit 2 */
	bed_fmmu(b, 1002, 0, (struct ec_fmmu){ 8, 2, 6, 1, 0x1000, 2, 2, 1 });
	esc->mem[0x1000] = 0xff;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LWR, 8, 0, v, 2), 1);
	KUNIT_EXPECT_EQ(test, esc->mem[0x1000], 0xff & ~0x30);
	bed_fmmu(b, 1002, 1, (struct ec_fmmu){ 16, 2, 6, 1, 0x1000, 2, 1, 1 });
	v[0] = 0x3f;
	v[1] = 0xff;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRD, 16, 0, v, 2), 1);
	KUNIT_EXPECT_EQ(test, v[0], 0xff);
	KUNIT_EXPECT_EQ(test, v[1], 0xfc);
	/* mailbox state bit */
	bed_sm(b, 1002, 1, 0x1080, 16, 0x22);
	bed_fmmu(b, 1002, 2, (struct ec_fmmu){ 32, 1, 5, 5, 0x080d, 3, 1, 1 });
	v[0] = 0;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRD, 32, 0, v, 1), 1);
	KUNIT_EXPECT_EQ(test, v[0], 0);
	ec_esc_pdi_write(esc, 0x1080, b->frame, 16, 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_LRD, 32, 0, v, 1), 1);
	KUNIT_EXPECT_EQ(test, v[0], 0x20);
}

/* ---- EEPROM */

static void eep_command(struct bed *b, u16 cmd, u32 addr)
{
	bed_put(b, 1001, EC_REG_EEP_CONTROL, cmd | (u64)addr << 16, 6);
}

static void sim_esc_eeprom_reads_take_their_time(struct kunit *test)
{
	struct bed *b = start(test, 1);
	u8 v[10];

	eep_command(b, EC_EEP_CMD_READ, 8);
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x502, 2) & EC_EEP_BUSY);
	b->now += 640000;
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x502, 2) & EC_EEP_BUSY);
	b->now += 100000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x502, v, 10), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(v + 2), 8u);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x508, 8),
			0x1716151413121110ull);
	/* behind the end */
	eep_command(b, EC_EEP_CMD_READ, 63);
	b->now += 800000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x508, 8),
			0xffffffffffff7f7eull);
}

static void sim_esc_eeprom_writes_need_their_enable(struct kunit *test)
{
	struct bed *b = start(test, 1);

	bed_put(b, 1001, 0x508, 0xbeef, 2);
	eep_command(b, EC_EEP_CMD_WRITE, 20);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2),
			0x40ull | EC_EEP_ERR_WRITE_EN);
	eep_command(b, EC_EEP_CMD_WRITE | EC_EEP_WRITE_ENABLE, 20);
	b->now += 4900000;
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x502, 2) & EC_EEP_BUSY);
	b->now += 100000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 0)->eep.data[40], 0xef);
	eep_command(b, EC_EEP_CMD_READ | EC_EEP_CMD_WRITE, 20);
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x502, 2) & EC_EEP_ERR_ACK);
	eep_command(b, 0, 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
}

static void sim_esc_pdi_may_own_eeprom(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u8 one = 1;

	bed_put(b, 1001, 0x500, 1, 1);
	ec_esc_pdi_write(esc, 0x501, &one, 1, b->now);
	eep_command(b, EC_EEP_CMD_READ, 8);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
	bed_put(b, 1001, 0x500, 0, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x501, 1), 1ull);
	bed_put(b, 1001, 0x500, 2, 1);
	bed_put(b, 1001, 0x500, 0, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x501, 1), 0ull);
	eep_command(b, EC_EEP_CMD_READ, 8);
	KUNIT_EXPECT_TRUE(test, bed_get(b, 1001, 0x502, 2) & EC_EEP_BUSY);
}

static void sim_esc_bad_checksum_stops_pdi(struct kunit *test)
{
	struct bed *b = bed_new(test, 4, 0);
	struct ec_esc *esc;

	b->eeprom[14] ^= 1;
	b->cfg.eeprom_8byte = false;
	esc = ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2),
			0ull | EC_EEP_ERR_CHECKSUM);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_ALIAS, 2), 0ull);
	KUNIT_EXPECT_FALSE(test, bed_get(b, 1001, 0x110, 2) & EC_DLS_PDI_OK);
	esc->eep.data[14] ^= 1;
	eep_command(b, EC_EEP_CMD_RELOAD, 0);
	b->now += 2000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_ALIAS, 2), 0x1234ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_PDI_CONTROL, 1), 5ull);
	/* 4 bytes an access, in half the time */
	eep_command(b, EC_EEP_CMD_READ, 8);
	b->now += 360000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x508, 4), 0x13121110ull);
}

static void sim_esc_checksums_match_published_ones(struct kunit *test)
{
	static const struct {
		u8 data[14];
		u8 crc;
	} v[] = {
		{ {}, 0x30 },
		{ { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13 }, 0xe0 },
		{ { 0, 0x0d }, 0x46 },
		{ { 4, 1, 0, 0, 0, 0, 0x0f }, 0xd8 },
		{ { 5, 0x0e, 3, 6, 0x10, 0x27 }, 0xd7 },
		{ { 0x80, 6, 0, 0x44, 0x64 }, 0xf3 },
		{ { 0x80, 2, 0, 0x6e, 0xff, 0, 0xff }, 0xb6 },
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(v); i++)
		KUNIT_EXPECT_EQ(test, ec_esc_eeprom_crc(v[i].data), v[i].crc);
}

/* ---- AL, events, watchdog */

static int al_calls, sm_calls, wd_calls, poll_calls;
static u64 last_call;

static void on_al(struct ec_esc *esc, u64 now)
{
	(void)esc;
	al_calls++;
	last_call = now;
}

static void on_sm(struct ec_esc *esc, int sm, u64 now)
{
	(void)esc;
	(void)now;
	sm_calls += 1 << 4 * sm;
}

static void on_wd(struct ec_esc *esc, u64 now)
{
	(void)esc;
	wd_calls++;
	last_call = now;
}

static void on_poll(struct ec_esc *esc, u64 now)
{
	poll_calls++;
	last_call = now;
	if (poll_calls < 3)
		ec_esc_wake_at(esc, now + 1000);
}

static const struct ec_esc_app_ops app_ops = {
	.al_control = on_al,
	.sm_written = on_sm,
	.sm_read = on_sm,
	.watchdog = on_wd,
	.poll = on_poll,
};

static struct bed *with_app(struct kunit *test)
{
	struct bed *b = start(test, 1);

	al_calls = sm_calls = wd_calls = poll_calls = 0;
	ec_sim_slave(b->sim, 0)->app_ops = &app_ops;
	return b;
}

static void sim_esc_al_control_waits_for_pdi(struct kunit *test)
{
	struct bed *b = with_app(test);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);
	u64 sent = b->now;
	u8 v[2];

	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x120, 2, 2), 1);
	KUNIT_EXPECT_EQ(test, al_calls, 1);
	/* the application hears of it when the frame has passed */
	KUNIT_EXPECT_EQ(test, last_call, sent + 100 + 72 * 80);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x120, 1, 2), 0);
	KUNIT_EXPECT_EQ(test, ec_esc_pdi_read(esc, 0x120, v, 2, b->now), 0);
	KUNIT_EXPECT_EQ(test, v[0], 2);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x120, 1, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x130, 2), 1ull);
}

static void sim_esc_emulation_copies_al_state(struct kunit *test)
{
	struct bed *b = bed_new(test, 4, 0);

	b->eeprom[1] = 1;
	bed_checksum(b);
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	bed_station(b, 0, 1001);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, 0x120, 0x12, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x130, 2), 0x12ull);
}

static void sim_esc_events_show_in_every_datagram(struct kunit *test)
{
	struct bed *b = start(test, 2);
	u8 v[2] = {};

	bed_get(b, 1001, 0x110, 2);
	bed_get(b, 1002, 0x110, 2);
	bed_put(b, 1002, 0x200, 0x000c, 2);
	bed_tx(b, EC_CMD_NOP, 0, 0, v, 2);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
	ec_esc_set_al_status(ec_sim_slave(b->sim, 0), 1, 0, b->now);
	bed_tx(b, EC_CMD_NOP, 0, 0, v, 2);
	KUNIT_EXPECT_EQ(test, b->irq, 0);	/* 1001 masks it */
	bed_rd(b, 1001, 0x130, v, 2);
	ec_esc_set_al_status(ec_sim_slave(b->sim, 1), 2, 0, b->now);
	ec_esc_set_al_status(ec_sim_slave(b->sim, 0), 2, 0, b->now);
	bed_tx(b, EC_CMD_NOP, 0, 0, v, 2);
	KUNIT_EXPECT_EQ(test, b->irq, EC_ECAT_EVENT_AL);
	bed_rd(b, 1001, 0x130, v, 2);
	KUNIT_EXPECT_EQ(test, b->irq, EC_ECAT_EVENT_AL);
	bed_rd(b, 1002, 0x130, v, 2);
	bed_tx(b, EC_CMD_NOP, 0, 0, v, 2);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
}

static void sim_esc_buffers_set_al_events(struct kunit *test)
{
	struct bed *b = with_app(test);
	u8 v[16] = {};

	bed_sm(b, 1001, 0, 0x1000, 16, 0x26);
	bed_sm(b, 1001, 3, 0x1180, 2, 0x20);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x1000, v, 15);
	KUNIT_EXPECT_EQ(test, sm_calls, 0);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x100f, v, 1);
	KUNIT_EXPECT_EQ(test, sm_calls, 1);
	bed_rd(b, 1001, 0x1180, v, 2);
	KUNIT_EXPECT_EQ(test, sm_calls, 0x1001);
}

static void sim_esc_watchdog_watches_from_first_write(struct kunit *test)
{
	struct bed *b = with_app(test);
	u64 first;
	u8 v[2] = {};

	bed_sm(b, 1001, 2, 0x1100, 2, 0x64);
	bed_put(b, 1001, 0x420, 100, 2);	/* 10 ms */
	ec_sim_advance(b->sim, b->now += 50000000);
	KUNIT_EXPECT_EQ(test, wd_calls, 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 2), 0ull);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 2), 1ull);
	b->now += 9000000;
	first = b->now;
	bed_tx(b, EC_CMD_FPWR, 1001, 0x1100, v, 2);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), first + 100 + 10000000);
	ec_sim_advance(b->sim, b->now += 9900000);
	KUNIT_EXPECT_EQ(test, wd_calls, 0);
	ec_sim_advance(b->sim, b->now += 100000);
	KUNIT_EXPECT_EQ(test, wd_calls, 1);
	KUNIT_EXPECT_EQ(test, last_call, first + 100 + 10000000);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x440, 4), 0x10000ull);
	bed_put(b, 1001, 0x442, 0, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x442, 1), 0ull);
}

static void sim_esc_applications_are_woken_on_time(struct kunit *test)
{
	struct bed *b = with_app(test);

	ec_esc_wake_at(ec_sim_slave(b->sim, 0), 5000000);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), 5000000ull);
	ec_sim_advance(b->sim, 4999999);
	KUNIT_EXPECT_EQ(test, poll_calls, 0);
	ec_sim_advance(b->sim, 6000000);
	KUNIT_EXPECT_EQ(test, poll_calls, 3);
	KUNIT_EXPECT_EQ(test, last_call, 5002000ull);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

static void sim_esc_error_counters_are_cleared_by_write(struct kunit *test)
{
	struct bed *b = start(test, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);

	memset(esc->mem + 0x300, 7, 20);
	bed_put(b, 1001, 0x302, 0, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x300, 8), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x30c, 2), 0x0707ull);
	bed_put(b, 1001, 0x30c, 0, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x30c, 2), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x310, 4), 0x07070707ull);
	bed_put(b, 1001, 0x310, 0, 4);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x310, 4), 0ull);
}

static void sim_esc_res_resets_slave(struct kunit *test)
{
	struct bed *b = start(test, 2);
	u8 v[2] = {};

	bed_put(b, 1002, 0x40, 'R', 1);
	bed_put(b, 1002, 0x40, 'E', 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x10, 2), 1002ull);
	bed_put(b, 1002, 0x40, 'S', 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, 0x10, v, 2), 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRD, 0xffff, 0x10, v, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_esc_information_registers_are_as_configured),
	KUNIT_CASE(sim_esc_write_to_read_only_register_counts_only),
	KUNIT_CASE(sim_esc_position_addresses_are_incremented_by_each),
	KUNIT_CASE(sim_esc_broadcast_read_is_or),
	KUNIT_CASE(sim_esc_read_write_commands_count_three),
	KUNIT_CASE(sim_esc_frmw_reads_one_and_writes_others),
	KUNIT_CASE(sim_esc_alias_answers_when_enabled),
	KUNIT_CASE(sim_esc_missing_registers_do_not_count),
	KUNIT_CASE(sim_esc_mailbox_is_full_or_empty),
	KUNIT_CASE(sim_esc_mailbox_needs_first_and_last_byte),
	KUNIT_CASE(sim_esc_disabled_sm_guards_nothing),
	KUNIT_CASE(sim_esc_buffered_sm_has_three_buffers),
	KUNIT_CASE(sim_esc_active_sm_keeps_its_page),
	KUNIT_CASE(sim_esc_logical_commands_count_per_slave_and_direction),
	KUNIT_CASE(sim_esc_logical_write_leaves_inputs_alone),
	KUNIT_CASE(sim_esc_overlapped_lrw_exchanges_in_place),
	KUNIT_CASE(sim_esc_bits_are_mapped_one_by_one),
	KUNIT_CASE(sim_esc_eeprom_reads_take_their_time),
	KUNIT_CASE(sim_esc_eeprom_writes_need_their_enable),
	KUNIT_CASE(sim_esc_pdi_may_own_eeprom),
	KUNIT_CASE(sim_esc_bad_checksum_stops_pdi),
	KUNIT_CASE(sim_esc_checksums_match_published_ones),
	KUNIT_CASE(sim_esc_al_control_waits_for_pdi),
	KUNIT_CASE(sim_esc_emulation_copies_al_state),
	KUNIT_CASE(sim_esc_events_show_in_every_datagram),
	KUNIT_CASE(sim_esc_buffers_set_al_events),
	KUNIT_CASE(sim_esc_watchdog_watches_from_first_write),
	KUNIT_CASE(sim_esc_applications_are_woken_on_time),
	KUNIT_CASE(sim_esc_error_counters_are_cleared_by_write),
	KUNIT_CASE(sim_esc_res_resets_slave),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_esc",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
