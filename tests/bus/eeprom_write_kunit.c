// SPDX-License-Identifier: GPL-2.0-only
/* Writing the EEPROM of a slave: what takes effect, what is refused, and other chips. */
#include "eeprom_writer.h"

/* The alias is written with its checksum, and the master knows it at once. */
static void eeprom_write_alias_takes_effect(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct ec_esc *esc = bus_esc(b, DRIVE);
	u64 device = bus_slave(b, DRIVE)->device;
	struct writer *w = writer_new(b, DRIVE);

	w->alias = 1001;
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, DRIVE, 1001));
	KUNIT_EXPECT_TRUE(test, esc->eep.loaded);
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->alias, 1001);
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->device, device);
	/* this controller sets the register at power-on only */
	KUNIT_EXPECT_EQ(test, w->register_alias, 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 2000), ~0ull);
	/* the EEPROM is the slave's side's again */
	KUNIT_EXPECT_EQ(test, esc->mem[EC_REG_EEP_OWNER], EC_EEP_OWNER_PDI);
}

static void eeprom_write_alias_reloads(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, PLAIN);

	bus_esc(b, PLAIN)->cfg.alias_reload = true;
	w->alias = 7;
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_EQ(test, w->register_alias, 7);
	w->alias = 0;
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_EQ(test, w->register_alias, 0);
	KUNIT_EXPECT_EQ(test, bus_slave(b, PLAIN)->alias, 0);
}

/* Only words that differ are written; the master has the new content afterwards. */
static void eeprom_write_image_differences(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);

	w->image = image_of(b, DRIVE, 0x51, &w->size);
	w->flags = EC_SII_FLAG_DRY_RUN;
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_EQ(test, w->i.written, 0u);
	/* alias, checksum, serial number, the category, the end mark or what was before it */
	KUNIT_EXPECT_GE(test, w->i.differ, EXTRA + 3u);
	KUNIT_EXPECT_LE(test, w->i.differ, EXTRA + 6u);
	KUNIT_EXPECT_FALSE(test, eep_is(b, DRIVE, w->image, w->size));
	w->flags = 0;
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_EQ(test, w->i.written, w->i.differ);
	KUNIT_EXPECT_TRUE(test, w->i.renewed);
	KUNIT_EXPECT_TRUE(test, eep_is(b, DRIVE, w->image, w->size));
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->info.serial, 0x51u);
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->eeprom.bytes, (size_t)w->size);
	KUNIT_ASSERT_EQ(test, write_eeprom(w), 0);
	KUNIT_EXPECT_EQ(test, w->i.differ, 0u);
	KUNIT_EXPECT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 2000), ~0ull);
}

/* Refused, and nothing is written; then with the option that the reason names. */
static void try_image(struct writer *w, const char *words, u32 option)
{
	struct kunit *test = w->b->test;
	u32 other = option == EC_SII_FLAG_FORCE ? EC_SII_FLAG_UNSAFE : EC_SII_FLAG_FORCE;
	u8 *before = kunit_kzalloc(test, w->size, GFP_KERNEL);
	int ret;

	KUNIT_ASSERT_NOT_NULL(test, before);
	memcpy(before, bus_esc(w->b, w->position)->eep.data, w->size);
	w->flags = other;
	ret = write_eeprom(w);
	KUNIT_EXPECT_TRUE_MSG(test, ret == -EBADMSG || ret == -EPERM, "%s: %d", words, ret);
	expect_reason(w->b, &w->file, words);
	KUNIT_EXPECT_TRUE(test, eep_is(w->b, w->position, before, w->size));
	w->flags = option | EC_SII_FLAG_DRY_RUN;
	KUNIT_EXPECT_EQ_MSG(test, write_eeprom(w), 0, "%s: %s", words, w->file.reason);
}

static void eeprom_write_image_refused(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);
	u8 *image = image_of(b, DRIVE, 3, &w->size), keep[16];

	w->image = image;
	image[2 * EC_SII_W_CHECKSUM] ^= 1;
	try_image(w, "--repair-checksum", EC_SII_FLAG_UNSAFE);
	image[2 * EC_SII_W_CHECKSUM] ^= 1;
	put_unaligned_le16(1, image + w->size - 2);
	try_image(w, "no end marker", EC_SII_FLAG_UNSAFE);
	put_unaligned_le16(0xffff, image + w->size - 2);
	image[2 * EC_SII_W_VENDOR] ^= 4;
	try_image(w, "--force", EC_SII_FLAG_FORCE);
	image[2 * EC_SII_W_VENDOR] ^= 4;
	memcpy(keep, image + 2 * EC_SII_W_STD_MBOX, 8);
	put_unaligned_le16(0x1400, image + 2 * EC_SII_W_STD_MBOX);
	try_image(w, "moves the mailboxes", EC_SII_FLAG_UNSAFE);
	put_unaligned_le16(0x0800, image + 2 * EC_SII_W_STD_MBOX);
	try_image(w, "are not between", EC_SII_FLAG_UNSAFE);
	memcpy(image + 2 * EC_SII_W_STD_MBOX, keep, 8);
	put_unaligned_le16(0, image + 2 * EC_SII_W_SIZE);
	try_image(w, "beyond its declared size of 128", EC_SII_FLAG_UNSAFE);
	w->flags = EC_SII_FLAG_FORCE | EC_SII_FLAG_UNSAFE;
	w->size = 0x81;
	KUNIT_EXPECT_EQ(test, write_eeprom(w), -EINVAL);
	w->size = 0x80;
	KUNIT_EXPECT_EQ(test, write_eeprom(w), -EINVAL);
	w->size = 0;
	KUNIT_EXPECT_EQ(test, write_eeprom(w), -EINVAL);
}

/* What a chip does not have is neither read nor written: its first words would be. */
static void eeprom_write_beyond_chip_refused(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);
	u8 *image = kunit_kzalloc(test, 4096, GFP_KERNEL);
	u32 n;
	const u8 *from = image_of(b, DRIVE, 4, &n);

	KUNIT_ASSERT_NOT_NULL(test, image);
	KUNIT_ASSERT_EQ(test, bus_esc(b, DRIVE)->eep.len, 2048ul);
	memcpy(image, from, n);
	w->image = image;
	w->size = 2050;
	w->flags = EC_SII_FLAG_FORCE | EC_SII_FLAG_UNSAFE;
	KUNIT_EXPECT_EQ(test, write_eeprom(w), -EFBIG);
	expect_reason(b, &w->file, "the image has 2050 bytes, the EEPROM at most 2048");
	KUNIT_EXPECT_EQ(test, eep_word(b, DRIVE, EC_SII_W_ALIAS), 0);
}

static void eeprom_write_blank_recovered(struct kunit *test)
{
	struct bus *b = bus_new(test, SEGMENT);
	struct writer *w = writer_new(b, DRIVE);

	w->image = image_of(b, DRIVE, 9, &w->size);
	memset(bus_esc(b, DRIVE)->eep.data, 0xff, 2048);
	bus_plug_scanned(b, 3, 3000);
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 5, EC_SII_FLAG_FORCE), -EBADMSG);
	KUNIT_ASSERT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_TRUE(test, eep_is(b, DRIVE, w->image, w->size));
	bus_command(b, "off b");
	msleep(200);
	bus_command(b, "on b");
	KUNIT_EXPECT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
}

/* A slave in OP keeps its EEPROM, unless that is forced; then it takes effect later. */
static void eeprom_write_running_refused(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);

	bus_request(b, 0, EC_AL_OP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_OP, 2000), ~0ull);
	KUNIT_EXPECT_EQ(test, set_alias(b, 0, 3, 0), -EBUSY);
	expect_reason(b, &b->app, "the slave is in OP; request PREOP first, or --force");
	KUNIT_EXPECT_EQ(test, eep_word(b, 0, EC_SII_W_ALIAS), 0);
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, 0, 3, EC_SII_FLAG_FORCE), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, 0, 3));
	KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->alias, 0);
	bus_request(b, 0, EC_AL_PREOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_PREOP, 2000), ~0ull);
	bus_rescan(b);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->alias, 3);
}

static void run_beside(struct cyc *c, struct writer *w)
{
	writer_start(w);
	while (!completion_done(&w->done))
		cyc_run(c, 1);
}

/* Beside a cycle: a slave that it does not use is written, another one is not. */
static void eeprom_write_beside_cycle(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct cyc *c = cyc_in_op(b, PLAIN, 1);
	struct writer *w = writer_new(b, DRIVE), *used = writer_new(b, PLAIN);

	c->incomplete = 0;
	run_beside(c, used);
	KUNIT_EXPECT_EQ(test, used->ret, -EBUSY);
	w->alias = 5;
	run_beside(c, w);
	KUNIT_EXPECT_EQ_MSG(test, w->ret, 0, "%s", w->file.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, DRIVE, 5));
	KUNIT_EXPECT_EQ(test, c->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_esc(b, PLAIN)->mem[EC_REG_AL_STATUS], EC_AL_OP);
}

/* The slave's side is using the EEPROM. */
static void eeprom_write_pdi_keeps_it(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);

	bus_esc(b, DRIVE)->mem[EC_REG_EEP_PDI] = 1;
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 5, 0), -EBUSY);
	expect_reason(b, &b->app, "slave's side keeps the EEPROM");
	KUNIT_EXPECT_TRUE(test, has_alias(b, DRIVE, 0));
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 5, EC_SII_FLAG_FORCE), 0);
	KUNIT_EXPECT_TRUE(test, has_alias(b, DRIVE, 5));
}

/* Another master gives it to the slave's side meanwhile; or the slave's side takes it for good. */
static void eeprom_write_taken_away(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);
	struct ec_esc *esc = bus_esc(b, DRIVE);

	w->image = image_of(b, DRIVE, 8, &w->size);
	writer_start(w);
	while (eep_word(b, DRIVE, EC_SII_W_SERIAL) != 8)
		usleep_range(100, 101);
	esc->mem[EC_REG_EEP_OWNER] = EC_EEP_OWNER_PDI;
	wait_for_completion(&w->done);
	KUNIT_EXPECT_EQ_MSG(test, w->ret, 0, "%s", w->file.reason);
	w->image = image_of(b, DRIVE, 11, &w->size);
	writer_start(w);
	while (eep_word(b, DRIVE, EC_SII_W_SERIAL) != 11)
		usleep_range(100, 101);
	esc->mem[EC_REG_EEP_PDI] = 1;
	wait_for_completion(&w->done);
	KUNIT_EXPECT_EQ(test, w->ret, -EBUSY);
	expect_reason(b, &w->file, "words written, write it again");
	KUNIT_EXPECT_NOT_NULL(test, strstr(bus_slave(b, DRIVE)->note.sii_flaw, "write it again"));
	esc->mem[EC_REG_EEP_PDI] = 0;
	KUNIT_EXPECT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_TRUE(test, eep_is(b, DRIVE, w->image, w->size));
	KUNIT_EXPECT_EQ(test, bus_slave(b, DRIVE)->note.sii_flaw[0], '\0');
}

static void eeprom_write_not_acknowledged(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);

	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, DRIVE, 0, 3, 0);
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, DRIVE, 5, 0), 0, "%s", b->app.reason);
	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, DRIVE, 0, ~0u, 0);
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 6, 0), -EIO);
	bus_fault(b, EC_SIM_FAULT_EEPROM_NOACK, DRIVE, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, DRIVE, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 6, 0), -ETIME);
	expect_reason(b, &b->app, "the EEPROM stays busy");
	bus_fault(b, EC_SIM_FAULT_EEPROM_BUSY, DRIVE, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, set_alias(b, DRIVE, 6, 0), 0);
	KUNIT_EXPECT_TRUE(test, has_alias(b, DRIVE, 6));
}

/* A chip that is slow, and a CPU in the place of a chip */
static void eeprom_write_slow_and_emulated_chips(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave b EL7201 eeprom=emulated\n"
			       "slave c EL2008\n", 3);

	bus_idle(b);
	bus_esc(b, PLAIN)->cfg.eeprom_write_ns = 60 * NSEC_PER_MSEC;
	bus_esc(b, PLAIN)->cfg.eeprom_8byte = false;
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, DRIVE, 5, 0), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, eep_word(b, DRIVE, EC_SII_W_ALIAS), 5);
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, PLAIN, 6, 0), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, PLAIN, 6));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eeprom_write_alias_takes_effect),
	KUNIT_CASE(eeprom_write_alias_reloads),
	KUNIT_CASE(eeprom_write_image_differences),
	KUNIT_CASE(eeprom_write_image_refused),
	KUNIT_CASE(eeprom_write_beyond_chip_refused),
	KUNIT_CASE(eeprom_write_blank_recovered),
	KUNIT_CASE(eeprom_write_running_refused),
	KUNIT_CASE(eeprom_write_beside_cycle),
	KUNIT_CASE(eeprom_write_pdi_keeps_it),
	KUNIT_CASE(eeprom_write_taken_away),
	KUNIT_CASE(eeprom_write_not_acknowledged),
	KUNIT_CASE(eeprom_write_slow_and_emulated_chips),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_eeprom_write",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
