// SPDX-License-Identifier: GPL-2.0-only
/* Loop control of ports: 0x0100, 0x0101, and what 0x0110, 0x0210 and 0x0310 show of it. */
#include "sim_cable_kunit.h"

#define MS	1000000ull
#define SECOND	1000000000ull

/* slave 0 with slave 3 at its port 3, 1 at port 1, 2 at port 2: the order of processing */
static struct bed *star(struct kunit *test)
{
	static const int port[] = { 0, 1, 2, 3 };
	struct bed *b = bed_new(test, 4, 0);

	for (int i = 0; i < 4; i++) {
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, i ? 0 : EC_SIM_MASTER0, port[i], i, 0,
						  100), 0);
	}
	KUNIT_ASSERT_EQ(test, bed_station(b, 0, 1001), 1);
	KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-1, 1004), 1);
	KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-2, 1002), 1);
	KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-3, 1003), 1);
	return b;
}

static void contact(struct kunit *test, struct bed *b, int port, bool on)
{
	const struct ec_sim_fault f = {
		.type = on ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_CUT, .port = port,
	};

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	ec_sim_advance(b->sim, b->now);
}

/* 0x0101 of slave 0 */
static void loops(struct kunit *test, struct bed *b, u8 v)
{
	KUNIT_EXPECT_EQ(test, bed_put(b, 1001, EC_REG_DL_LOOPS, v, 1), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_DL_LOOPS, 1), v);
}

/* bits 8 and 9 of port 0 in 0x0110, and bit 4, or those of another port */
static u32 view(struct bed *b, int port)
{
	u32 v = dl(b, 0);

	return (v >> (8 + 2 * port) & 3) | (v >> (4 + port) & 1) << 4;
}

#define OPEN_NO_LINK	0x00
#define CLOSED_NO_LINK	0x01
#define OPEN_LINK	0x12
#define CLOSED_LINK	0x13

/* 0: opens and closes with the link */
static void sim_loop_auto_follows_link(struct kunit *test)
{
	struct bed *b = star(test);

	for (int p = 1; p < 4; p++) {
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), 4);
		contact(test, b, p, false);
		KUNIT_EXPECT_EQ(test, view(b, p), CLOSED_NO_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
		contact(test, b, p, true);
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	}
}

/* 1: stays closed when the link is back */
static void sim_loop_auto_close_opens_by_write(struct kunit *test)
{
	struct bed *b = star(test);

	for (int p = 1; p < 4; p++) {
		u8 v = (u8)(EC_LOOP_AUTO_CLOSE << 2 * p);

		loops(test, b, v);
		KUNIT_EXPECT_EQ_MSG(test, view(b, p), OPEN_LINK, "the write closes nothing");
		contact(test, b, p, false);
		KUNIT_EXPECT_EQ(test, view(b, p), CLOSED_NO_LINK);
		loops(test, b, v);		/* too early */
		contact(test, b, p, true);
		b->now += 5 * SECOND;
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
		KUNIT_EXPECT_EQ(test, view(b, p), CLOSED_LINK);
		loops(test, b, v);
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), 4);
		loops(test, b, 0);
	}
}

/* a write acts on each port with this setting, not on the one that it means alone */
static void sim_loop_auto_close_write_opens_all(struct kunit *test)
{
	struct bed *b = star(test);

	loops(test, b, 0x54);
	for (int p = 1; p < 4; p++)
		contact(test, b, p, false);
	contact(test, b, 1, true);
	contact(test, b, 2, true);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	loops(test, b, 0xd4);
	KUNIT_EXPECT_EQ(test, view(b, 1), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 2), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 3), CLOSED_NO_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
}

/* a frame that is received at a port: from the other end of a ring */
static void sim_loop_auto_close_opens_by_frame(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 2);

	KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, EC_SIM_MASTER1, 0, 0, 2, 100), 0);
	loops(test, b, EC_LOOP_AUTO_CLOSE << 4);
	contact(test, b, 2, false);
	contact(test, b, 2, true);
	KUNIT_EXPECT_EQ(test, view(b, 2), CLOSED_LINK);
	KUNIT_EXPECT_EQ_MSG(test, count(b, 1), -1, "heard, and destroyed");
	KUNIT_EXPECT_EQ(test, view(b, 2), OPEN_LINK);
	KUNIT_EXPECT_EQ_MSG(test, count(b, 1), 0, "the next one passes on, behind all processing");
	KUNIT_EXPECT_EQ(test, b->out, 0);

	/* closed: no frame opens it, neither now nor with a later setting */
	contact(test, b, 2, false);
	loops(test, b, EC_LOOP_CLOSED << 4);
	contact(test, b, 2, true);
	KUNIT_EXPECT_EQ(test, count(b, 1), -1);
	KUNIT_EXPECT_EQ(test, count(b, 1), -1);
	KUNIT_EXPECT_EQ(test, view(b, 2), CLOSED_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->out, 0);
}

/* 2: open whatever the link is */
static void sim_loop_open_without_link_loses_frames(struct kunit *test)
{
	struct bed *b = star(test);

	for (int p = 1; p < 4; p++) {
		loops(test, b, (u8)(EC_LOOP_OPEN << 2 * p));
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), 4);
		contact(test, b, p, false);
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_NO_LINK);
		KUNIT_EXPECT_EQ(test, count(b, 0), -1);
		contact(test, b, p, true);
		KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
		loops(test, b, 0);
	}
}

/* 3: closed whatever the link is, until another value is written */
static void sim_loop_closed_opens_by_write(struct kunit *test)
{
	struct bed *b = star(test);

	for (int p = 1; p < 4; p++) {
		for (u8 next = EC_LOOP_AUTO; next <= EC_LOOP_OPEN; next++) {
			loops(test, b, (u8)(EC_LOOP_CLOSED << 2 * p));
			KUNIT_EXPECT_EQ(test, view(b, p), CLOSED_LINK);
			KUNIT_EXPECT_EQ(test, count(b, 0), 3);
			contact(test, b, p, false);
			KUNIT_EXPECT_EQ(test, view(b, p), CLOSED_NO_LINK);
			contact(test, b, p, true);
			loops(test, b, (u8)(EC_LOOP_CLOSED << 2 * p));
			KUNIT_EXPECT_EQ_MSG(test, view(b, p), CLOSED_LINK, "again, with the link");
			b->now += 5 * SECOND;
			KUNIT_EXPECT_EQ(test, count(b, 0), 3);
			loops(test, b, (u8)(next << 2 * p));
			KUNIT_EXPECT_EQ(test, view(b, p), OPEN_LINK);
			KUNIT_EXPECT_EQ(test, count(b, 0), 4);
		}
		loops(test, b, 0);
	}
}

/* port 0: no write cuts the slave off, whatever the link does afterwards */
static void sim_loop_port0_stays_reachable(struct kunit *test)
{
	struct bed *b = star(test);

	loops(test, b, EC_LOOP_CLOSED);
	KUNIT_EXPECT_EQ(test, view(b, 0), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	contact(test, b, 0, false);
	KUNIT_EXPECT_EQ(test, view(b, 0), CLOSED_NO_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	contact(test, b, 0, true);
	KUNIT_EXPECT_EQ(test, view(b, 0), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);

	/* auto close: the first frame opens it and is lost */
	loops(test, b, EC_LOOP_AUTO_CLOSE);
	KUNIT_EXPECT_EQ(test, view(b, 0), OPEN_LINK);
	contact(test, b, 0, false);
	contact(test, b, 0, true);
	KUNIT_EXPECT_EQ(test, view(b, 0), CLOSED_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
}

/* a frame that closes a loop goes through it; those after it do not */
static void sim_loop_change_acts_on_next_frame(struct kunit *test)
{
	struct bed *b = star(test);
	u8 v[2] = { 1, EC_LOOP_CLOSED << 2 };

	KUNIT_EXPECT_EQ_MSG(test, bed_tx(b, EC_CMD_BWR, 0, EC_REG_DL_CONTROL, v, 2), 4,
			    "slave 1 behind port 1, too");
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 1)->mem[EC_REG_DL_LOOPS], EC_LOOP_CLOSED << 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	v[1] = 0;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, EC_REG_DL_CONTROL, v, 2), 3);
	KUNIT_EXPECT_EQ_MSG(test, ec_sim_slave(b->sim, 1)->mem[EC_REG_DL_LOOPS],
			    EC_LOOP_CLOSED << 2, "it was not there yet");
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
}

/* 0x0100 bit 1: one second after the write all is as before */
static void sim_loop_temporary_setting_ends(struct kunit *test)
{
	struct bed *b = star(test);
	u64 end;

	loops(test, b, EC_LOOP_CLOSED << 2);
	end = b->now + SECOND;
	bed_put(b, 1001, EC_REG_DL_CONTROL, 3 | EC_LOOP_CLOSED << 14, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_DL_CONTROL, 4),
			0x70003u | EC_LOOP_CLOSED << 14);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, view(b, 1), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 3), CLOSED_LINK);
	ec_sim_advance(b->sim, end - 1);
	KUNIT_EXPECT_EQ(test, view(b, 3), CLOSED_LINK);
	b->now = end + MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_DL_CONTROL, 4),
			0x70001u | EC_LOOP_CLOSED << 10);
	KUNIT_EXPECT_EQ(test, view(b, 1), CLOSED_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 3), OPEN_LINK);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
}

/* a second one lengthens the first; one without bit 1 stays */
static void sim_loop_temporary_setting_repeated(struct kunit *test)
{
	struct bed *b = star(test);

	for (u32 i = 0; i < 4; i++) {
		bed_put(b, 1001, EC_REG_DL_CONTROL, 3 | EC_LOOP_CLOSED << (10 + 2 * (i & 1)), 2);
		b->now += 900 * MS;
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	}
	b->now += 200 * MS;
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_DL_LOOPS, 1), 0);

	bed_put(b, 1001, EC_REG_DL_CONTROL, 3 | EC_LOOP_CLOSED << 10, 2);
	bed_put(b, 1001, EC_REG_DL_CONTROL, 1 | EC_LOOP_CLOSED << 12, 2);
	b->now += 5 * SECOND;
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, view(b, 2), CLOSED_LINK);
}

/* its end is no write: a port with auto close that has lost its link stays closed */
static void sim_loop_temporary_end_opens_nothing(struct kunit *test)
{
	struct bed *b = star(test);

	loops(test, b, 0x54);
	contact(test, b, 1, false);
	bed_put(b, 1001, EC_REG_DL_CONTROL, 0xfc03, 2);		/* all closed */
	contact(test, b, 1, true);
	contact(test, b, 2, false);
	contact(test, b, 2, true);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	b->now += 2 * SECOND;
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 2, "the one at port 3");
	KUNIT_EXPECT_EQ(test, view(b, 1), CLOSED_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 2), CLOSED_LINK);
	KUNIT_EXPECT_EQ(test, view(b, 3), OPEN_LINK);
	/* a port opened for a second is closed again, its branch whole or not */
	loops(test, b, 0xfc);
	bed_put(b, 1001, EC_REG_DL_CONTROL, 3 | 0xf400, 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	b->now += 2 * SECOND;
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, view(b, 1), CLOSED_LINK);
}

/* power resets 0x0101 and what was temporary */
static void sim_loop_power_resets_settings(struct kunit *test)
{
	struct bed *b = star(test);
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_POWER_OFF };

	bed_put(b, 1001, EC_REG_DL_CONTROL, 0xfc03, 2);
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	f.type = EC_SIM_FAULT_POWER_ON;
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 0)->mem[EC_REG_DL_CONTROL], 0x01);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

/* each change of a link or a loop, shown in datagrams while the mask lets it through */
static void sim_loop_change_sets_dl_event(struct kunit *test)
{
	struct bed *b = star(test);

	forget_dl_event(b, 0);
	contact(test, b, 1, false);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, 0, "mask 0");
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_ECAT_EVENT, 2), DL_EVENT);
	bed_put(b, 1001, EC_REG_ECAT_MASK, DL_EVENT, 2);
	for (u32 i = 0; i < 3; i++) {
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
		KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "kept, whoever the datagram is for");
	}
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_DL_STATUS, 2) & 0xfff0, 0xa6d0u);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, 0, "cleared by reading 0x0110");

	loops(test, b, EC_LOOP_CLOSED << 4);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "a loop closed by a write");
	bed_get(b, 1001, EC_REG_DL_STATUS + 1, 1);
	loops(test, b, EC_LOOP_CLOSED << 4);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, 0, "nothing changed");
	loops(test, b, (EC_LOOP_CLOSED << 4) | (EC_LOOP_CLOSED << 2));
	KUNIT_EXPECT_EQ_MSG(test, b->irq, 0, "closed already for want of a link");
	contact(test, b, 1, true);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "a link at a closed port");
	bed_get(b, 1001, EC_REG_DL_STATUS, 2);
	contact(test, b, 1, false);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "and its loss");
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, EC_REG_DL_STATUS, 2), ~0ull);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "that was no slave");
}

/* a broadcast reads 0x0110 of all: the event of each is cleared */
static void sim_loop_dl_event_cleared_by_broadcast(struct kunit *test)
{
	struct bed *b = star(test);
	u8 v[2] = { DL_EVENT };

	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, EC_REG_ECAT_MASK, v, 2), 4);
	for (u32 i = 0; i < 4; i++)
		KUNIT_EXPECT_TRUE(test, dl_event(b, i));
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, EC_REG_DL_STATUS, v, 2), 4);
	KUNIT_EXPECT_EQ(test, b->irq, DL_EVENT);
	for (u32 i = 0; i < 4; i++)
		KUNIT_EXPECT_FALSE(test, dl_event(b, i));
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
}

/* one more at each end for each loss, whatever the loop is */
static void sim_loop_lost_links_counted(struct kunit *test)
{
	struct bed *b = star(test);

	for (u32 mode = 0; mode < 4; mode++) {
		loops(test, b, (u8)(mode << 4));
		contact(test, b, 2, false);
		contact(test, b, 2, true);
		KUNIT_EXPECT_EQ(test, lost(b, 0), (mode + 1) << 16);
		KUNIT_EXPECT_EQ(test, lost(b, 2), mode + 1);
	}
	contact(test, b, 3, false);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x1040000);
	/* a write to any of the four clears all of them, and only them */
	ec_sim_slave(b->sim, 0)->mem[EC_REG_ERR_RX(2)] = 5;
	bed_put(b, 1001, EC_REG_ERR_LOST(1), 7, 1);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 0)->mem[EC_REG_ERR_RX(2)], 5);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 4);
}

/* a controller without the register */
static void sim_loop_fixed_stays_auto(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100 loops=fixed\nslave c EL2008\n");

	bed_put(b, STATION(0), EC_REG_DL_LOOPS, 0x0c, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_DL_LOOPS, 1), 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	bed_put(b, STATION(0), EC_REG_DL_CONTROL, 0x0c03, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_DL_CONTROL, 2), 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	b->now += 2 * SECOND;
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_DL_CONTROL, 2), 1);
	command(test, b, "old a loops=4");
	command(test, b, "cut a.1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	command(test, b, "heal a.1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	/* its neighbor has it */
	bed_put(b, STATION(1), EC_REG_DL_LOOPS, 0x0c, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), EC_REG_DL_LOOPS, 1), 0x0c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_loop_auto_follows_link),
	KUNIT_CASE(sim_loop_auto_close_opens_by_write),
	KUNIT_CASE(sim_loop_auto_close_write_opens_all),
	KUNIT_CASE(sim_loop_auto_close_opens_by_frame),
	KUNIT_CASE(sim_loop_open_without_link_loses_frames),
	KUNIT_CASE(sim_loop_closed_opens_by_write),
	KUNIT_CASE(sim_loop_port0_stays_reachable),
	KUNIT_CASE(sim_loop_change_acts_on_next_frame),
	KUNIT_CASE(sim_loop_temporary_setting_ends),
	KUNIT_CASE(sim_loop_temporary_setting_repeated),
	KUNIT_CASE(sim_loop_temporary_end_opens_nothing),
	KUNIT_CASE(sim_loop_power_resets_settings),
	KUNIT_CASE(sim_loop_change_sets_dl_event),
	KUNIT_CASE(sim_loop_dl_event_cleared_by_broadcast),
	KUNIT_CASE(sim_loop_lost_links_counted),
	KUNIT_CASE(sim_loop_fixed_stays_auto),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_loop",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
