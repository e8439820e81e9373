// SPDX-License-Identifier: GPL-2.0-only
/* Writing the EEPROM of a slave is interrupted: by lost frames, a kill, the cable, power. */
#include "eeprom_writer.h"

static void lose_frame(struct bus *b, u32 frame, bool back)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = back ? 0 : -1,
		.arg = frame, .value = back,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/* Each frame of the write of an alias is lost once, on its way out or back: no word is wrong. */
static void eeprom_lost_each_frame_lost(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	u32 frame, back, tries = 0, failed = 0;

	/* the frames of the scan that follows are not meant: 80 are those of the write */
	for (frame = 1; frame <= 80; frame++)
		for (back = 0; back < 2; back++) {
			u16 alias = 2 * frame + back;

			lose_frame(b, frame, back);
			failed += !!set_alias(b, DRIVE, alias, 0);
			KUNIT_ASSERT_TRUE_MSG(test, has_alias(b, DRIVE, alias), "frame %u: %s",
					      frame, b->app.reason);
			tries++;
			KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
			bus_idle(b);
		}
	bus_figure("alias with one frame lost: %u writes, %u failed", tries, failed);
	KUNIT_EXPECT_EQ(test, failed, 0u);
}

/* Contact to the slave is lost when a frame that accesses its EEPROM is on the way. */
static void cut_at(struct bus *b, u32 frame, bool back)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_CUT, .slave = DRIVE, .port = 0,
		.frame = frame, .by_register = true, .reg = EC_REG_EEP_CONTROL,
		.when = back ? EC_SIM_WHEN_BACK : EC_SIM_WHEN_OUT,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

static void eeprom_lost_each_contact_lost(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	u32 frame, back, cut = 0;

	for (frame = 1; frame <= 40; frame++)
		for (back = 0; back < 2; back++) {
			u16 alias = 2 * frame + back;
			int ret;

			cut_at(b, frame, back);
			ret = set_alias(b, DRIVE, alias, 0);
			cut += !!ret;
			KUNIT_EXPECT_TRUE_MSG(test, !ret || ret == -ECANCELED || ret == -ENOLINK,
					      "frame %u: %d %s", frame, ret, b->app.reason);
			msleep(50);
			bus_fault(b, EC_SIM_FAULT_HEAL, DRIVE, 0, 0, 0);
			KUNIT_ASSERT_NE_MSG(test, bus_wait(b, 3, EC_AL_PREOP, 20000), ~0ull,
					    "frame %u", frame);
			bus_idle(b);
			KUNIT_ASSERT_EQ_MSG(test, set_alias(b, DRIVE, alias, 0), 0,
					    "frame %u: %s", frame, b->app.reason);
			KUNIT_ASSERT_TRUE(test, has_alias(b, DRIVE, alias));
			bus_idle(b);
		}
	bus_figure("alias with the contact lost: %u writes, %u ended early, all repeated", 80,
		   cut);
	KUNIT_EXPECT_GT(test, cut, 20u);
}

/* A caller that is killed: the slave's side has its EEPROM again, and the next write continues. */
static void eeprom_lost_killed(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);
	u32 lines = bus_log_lines("EEPROM write ended at word");
	u64 t0;

	w->image = image_of(b, DRIVE, 8, &w->size);
	writer_start(w);
	while (eep_word(b, DRIVE, EC_SII_W_SERIAL) != 8)
		usleep_range(100, 101);
	t0 = ktime_get_ns();
	send_sig(SIGKILL, w->task, 1);
	wait_for_completion(&w->done);
	KUNIT_EXPECT_EQ(test, w->ret, -EINTR);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 50ull * NSEC_PER_MSEC);
	KUNIT_EXPECT_EQ(test, bus_esc(b, DRIVE)->mem[EC_REG_EEP_OWNER], EC_EEP_OWNER_PDI);
	KUNIT_EXPECT_FALSE(test, eep_is(b, DRIVE, w->image, w->size));
	KUNIT_EXPECT_EQ(test, bus_log_lines("EEPROM write ended at word"), lines + 1);
	KUNIT_EXPECT_EQ_MSG(test, write_eeprom(w), 0, "%s", w->file.reason);
	KUNIT_EXPECT_TRUE(test, eep_is(b, DRIVE, w->image, w->size));
}

/* Between word 4 and word 7 power is lost: the command says what to do. */
static void eeprom_lost_alias_interrupted(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	u8 *data = bus_esc(b, PLAIN)->eep.data;

	put_unaligned_le16(9, data + 2 * EC_SII_W_ALIAS);
	/* the master knows the words before it: it has read them */
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, PLAIN, 9, 0), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, PLAIN, 9));
	/* of what another program has written it knows nothing */
	put_unaligned_le16(77, data + 4);
	bus_rescan(b);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, set_alias(b, PLAIN, 10, 0), -EBADMSG);
	expect_reason(b, &b->app, "--repair-checksum");
	KUNIT_EXPECT_EQ_MSG(test, set_alias(b, PLAIN, 10, EC_SII_FLAG_REPAIR), 0, "%s",
			    b->app.reason);
	KUNIT_EXPECT_TRUE(test, has_alias(b, PLAIN, 10));
}

/* While an EEPROM is written, no user asks for a scan that gives its slave another address. */
static void eeprom_lost_rescan_refused(struct kunit *test)
{
	struct bus *b = eeprom_ready(test);
	struct writer *w = writer_new(b, DRIVE);

	w->image = image_of(b, DRIVE, 8, &w->size);
	writer_start(w);
	while (eep_word(b, DRIVE, EC_SII_W_SERIAL) != 8)
		usleep_range(100, 101);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), -EBUSY);
	wait_for_completion(&w->done);
	KUNIT_EXPECT_EQ(test, w->ret, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), 0);
	bus_idle(b);
}

enum { BY_KILL, BY_CABLE, BY_POWER, BY_PDI, BY_LOSS, N_BY };

static void interrupt(struct bus *b, struct writer *w, u32 by)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1, .arg2 = 1000000,
	};

	switch (by) {
	case BY_KILL:
		if (!completion_done(&w->done))
			send_sig(SIGKILL, w->task, 1);
		break;
	case BY_CABLE:
		bus_fault(b, EC_SIM_FAULT_CUT, DRIVE, 0, 0, 0);
		break;
	case BY_POWER:
		bus_fault(b, EC_SIM_FAULT_POWER_OFF, DRIVE, 0, 0, 0);
		break;
	case BY_PDI:
		bus_esc(b, DRIVE)->mem[EC_REG_EEP_PDI] = 1;
		break;
	case BY_LOSS:
		KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
		break;
	}
}

/* What caused it is over; then each slave loses its power in any case: only the EEPROM remains. */
static void restore(struct bus *b, u32 by)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = EC_SIM_FAULT_LOSE, .port = -1, .arg2 = 0,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
	bus_esc(b, DRIVE)->mem[EC_REG_EEP_PDI] = 0;
	bus_fault(b, EC_SIM_FAULT_HEAL, DRIVE, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, DRIVE, 0, 0, 0);
	msleep(100);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, DRIVE, 0, 0, 0);
}

static bool found_again(struct bus *b)
{
	u32 ms;

	for (ms = 0; ms < 20000; ms += 10) {
		if (bus_n_slaves(b) == 3 && bus_responding(b) == 3 && !bus_scan_busy(b) &&
		    !bus_rescan_due(b) && !READ_ONCE(bus_slave_at(b, DRIVE)->reply.silent))
			return true;
		msleep(10);
	}
	return false;
}

struct outcome {
	u32 finished, untouched, recovered, unreachable;
	u32 broken;	/* wrong checksum in between */
	u32 by[N_BY];
};

/* One write that is interrupted after @us, and the next one */
static void once(struct bus *b, struct outcome *o, u32 number, u32 by, u32 us)
{
	struct writer w = { .b = b, .position = DRIVE };
	size_t used = bus_esc(b, DRIVE)->eep.len;
	u8 *image, *before = kmemdup(bus_esc(b, DRIVE)->eep.data, used, GFP_KERNEL);
	const u8 *data = bus_esc(b, DRIVE)->eep.data;
	size_t at = ec_sii_used(data, used) - 2;
	u32 k;

	KUNIT_ASSERT_NOT_NULL(b->test, before);
	image = kmemdup(before, used, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(b->test, image);
	ec_file_init(&w.file, b->m, true);
	put_unaligned_le16(number, image + 2 * EC_SII_W_ALIAS);
	put_unaligned_le16(number, image + 4);
	put_unaligned_le32(number, image + 2 * EC_SII_W_SERIAL);
	for (k = 0; k < 8; k++)
		put_unaligned_le16(number + k, image + at - 16 + 2 * k);
	fix_checksum(image);
	w.image = image;
	w.size = at + 2;
	writer_start(&w);
	usleep_range(us, us + 1);
	interrupt(b, &w, by);
	wait_for_completion(&w.done);
	o->by[by]++;
	if (!w.ret && eep_is(b, DRIVE, image, w.size))
		o->finished++;
	else if (!memcmp(data, before, used))
		o->untouched++;
	else
		o->recovered++;
	o->broken += data[14] != ec_sii_crc(data);
	restore(b, by);
	if (!found_again(b) || write_eeprom(&w) || !eep_is(b, DRIVE, image, w.size) ||
	    bus_wait(b, 3, EC_AL_PREOP, 30000) == ~0ull) {
		o->unreachable++;
		kunit_err(b->test, "write %u by %u after %u us: %d %s", number, by, us, w.ret,
			  w.file.reason);
	}
	kfree(image);
	kfree(before);
}

/* A case has a time limit, so the 1,000 are many cases; the last one prints the sum. */
#define PARTS	40
#define OF_PART	25

static const u32 parts[PARTS] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18,
	19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40 };

static void part_desc(const u32 *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "part %u", *p);
}

KUNIT_ARRAY_PARAM(part, parts, part_desc);

/* 1,000 writes are interrupted at random places: no slave is unreachable. */
static void eeprom_lost_1000_interruptions(struct kunit *test)
{
	static struct outcome o;
	static u32 n;
	struct bus *b = bus_new(test, SEGMENT);
	u32 i, part = *(const u32 *)test->param_value;
	struct rnd_state rnd;

	/* its last category is the vendor's: the words that change there */
	bus_fill_eeprom(b, DRIVE, 1024);
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	prandom_seed_state(&rnd, 34 + part);
	for (i = 0; i < OF_PART; i++, n++) {
		/* a write takes some 300 ms, 170 of them until the first word is written */
		u32 us = prandom_u32_state(&rnd) % 330000;

		once(b, &o, n + 1, prandom_u32_state(&rnd) % N_BY, us);
	}
	KUNIT_EXPECT_EQ(test, o.unreachable, 0u);
	if (part != PARTS)
		return;
	bus_figure("%u interruptions of a write (kill %u, cable %u, power %u, PDI %u, loss %u): %u finished, %u untouched, %u recovered (%u had a wrong checksum), %u unreachable",
		   n, o.by[BY_KILL], o.by[BY_CABLE], o.by[BY_POWER], o.by[BY_PDI], o.by[BY_LOSS],
		   o.finished, o.untouched, o.recovered, o.broken, o.unreachable);
	KUNIT_EXPECT_EQ(test, n, PARTS * OF_PART);
	KUNIT_EXPECT_GT(test, o.recovered, 200u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eeprom_lost_each_frame_lost),
	KUNIT_CASE(eeprom_lost_each_contact_lost),
	KUNIT_CASE(eeprom_lost_killed),
	KUNIT_CASE(eeprom_lost_alias_interrupted),
	KUNIT_CASE(eeprom_lost_rescan_refused),
	KUNIT_CASE_PARAM(eeprom_lost_1000_interruptions, part_gen_params),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_eeprom_lost",
	.exit = bus_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);

MODULE_LICENSE("GPL");
