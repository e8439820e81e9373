// SPDX-License-Identifier: GPL-2.0-only
/* Cables that come and go, and what the registers of both ends say. */
#include "sim_cable_kunit.h"

#define LINE	"slave a EK1100\nslave b EL2008\nslave c EL2008\n" \
		"branch none\nslave x EL1008\nslave y EL1008\n"

static void sim_cable_plug_and_unplug(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE, 3);

	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	/* link at its port 1 only, to y */
	KUNIT_EXPECT_EQ(test, dl(b, 3) & 0xfff0, 0x5920);
	KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x5610);
	forget_dl_event(b, 2);
	forget_dl_event(b, 3);
	forget_dl_event(b, 4);

	command(test, b, "plug c.1 x.0 cable=100ns");
	KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x5a30);
	KUNIT_EXPECT_EQ(test, dl(b, 3) & 0xfff0, 0x5a30);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0);
	KUNIT_EXPECT_EQ(test, lost(b, 3), 0);
	KUNIT_EXPECT_TRUE(test, dl_event(b, 2));
	KUNIT_EXPECT_TRUE(test, dl_event(b, 3));
	KUNIT_EXPECT_FALSE_MSG(test, dl_event(b, 4), "nothing happened at its ports");
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);

	forget_dl_event(b, 2);
	command(test, b, "unplug x.0");
	KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x5610);
	KUNIT_EXPECT_EQ(test, dl(b, 3) & 0xfff0, 0x5920);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0x100);
	KUNIT_EXPECT_EQ(test, lost(b, 3), 0x1);
	KUNIT_EXPECT_TRUE(test, dl_event(b, 2));
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	/* there is no cable left that could be healed or pulled */
	command(test, b, "heal c.1");
	command(test, b, "unplug c.1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0x100);
}

/* at another place, and the wrong way round: it keeps what it knows */
static void sim_cable_plug_elsewhere(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE, 3);

	command(test, b, "plug c.1 x.0");
	for (u16 i = 0; i < 5; i++)
		bed_station(b, (u16)-i, (u16)(1001 + i));
	command(test, b, "plug a.2 y.1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1005, EC_REG_STATION, 2), 1005);
	/* y is passed on the way back only: the frame enters at its port 1 */
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x6a70);
	/* a plug fits into one port only: the cables at x.0 and a.2 come out */
	command(test, b, "plug x.0 a.2");
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0x100);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x10000);
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 4), 0x100, "pulled at its port 1");
	KUNIT_EXPECT_EQ(test, lost(b, 3), 0x1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1004, EC_REG_STATION, 2), 1004);
}

/* a port that is closed shows what was plugged in, and lets nothing through */
static void sim_cable_plug_at_closed_port(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE, 3);
	struct ec_esc *c = ec_sim_slave(b->sim, 2);

	bed_station(b, (u16)-2, 1003);
	bed_put(b, 1003, EC_REG_DL_LOOPS, 0x0c, 1);
	bed_put(b, 1003, EC_REG_ECAT_MASK, DL_EVENT, 2);
	forget_dl_event(b, 2);
	command(test, b, "plug c.1 x.0");
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, DL_EVENT, "shown in each datagram");
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, EC_REG_DL_STATUS, 2) & 0xfff0, 0x5e30);
	KUNIT_EXPECT_EQ(test, c->mem[EC_REG_DL_LOOPS], 0x0c);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ_MSG(test, b->irq, 0, "read, so forgotten");
	command(test, b, "unplug c.1");
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, EC_REG_DL_STATUS, 2) & 0xfff0, 0x5610);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0x100);
	command(test, b, "plug c.1 x.0");
	bed_put(b, 1003, EC_REG_DL_LOOPS, 0x04, 1);
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 5, "opened by the write");
	command(test, b, "unplug c.1");
	command(test, b, "plug c.1 x.0");
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 3, "closed itself when the link was lost");
	KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x5e30);
}

static void sim_cable_master_and_ring(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE, 3);

	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 1));
	command(test, b, "plug c.1 master.1");
	KUNIT_EXPECT_TRUE(test, ec_sim_link(b->sim, 1));
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, b->out, 1);
	command(test, b, "unplug master.0");
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, count(b, 1), 3);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x1);
	/* an island is no part of it */
	command(test, b, "plug master.0 y.0");
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, count(b, 1), 3);
}

/* a cable between two free ports: no frame is lost, no slave is passed twice */
static void sim_cable_between_free_ports(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EK1100\nslave c EK1100\n");

	command(test, b, "plug a.2 b.2");
	for (u32 i = 0; i < 3; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	command(test, b, "unplug a.2");
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
}

/* station addresses in ring order, as far as there are any */
static void expect_order(struct kunit *test, struct bed *b, u32 n, const u16 *want)
{
	for (u32 i = 0; i < n; i++) {
		u8 v[2] = { 0 };

		KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_APRD, (u16)-i, EC_REG_STATION, v, 2), 1);
		KUNIT_EXPECT_EQ_MSG(test, get_unaligned_le16(v), want[i], "position %u", i);
	}
	KUNIT_EXPECT_EQ(test, count(b, 0), (int)n);
}

#define TREE	"slave a EK1100\nslave b EL2008\nslave c EL2008\nslave d EL2008\n" \
		"branch a 2\nslave e EK1100\nslave f EL2008\n"

static void sim_cable_swap_slaves(struct kunit *test)
{
	struct bed *b = app_bed(test, TREE);

	expect_order(test, b, 6, (const u16[]){ 1001, 1002, 1003, 1004, 1005, 1006 });
	command(test, b, "swap b d");
	expect_order(test, b, 6, (const u16[]){ 1001, 1004, 1003, 1002, 1005, 1006 });
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x100);
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 2), 0x101, "both neighbours of c");
	KUNIT_EXPECT_EQ(test, lost(b, 1), 0x101);
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 3), 0x1, "its port 1 was free");
	KUNIT_EXPECT_EQ(test, dl(b, 3) & 0xfff0, 0x5a30);
	KUNIT_EXPECT_EQ(test, dl(b, 1) & 0xfff0, 0x5610);
	KUNIT_EXPECT_EQ(test, lost(b, 4), 0);

	command(test, b, "swap c d");		/* neighbours */
	expect_order(test, b, 6, (const u16[]){ 1001, 1003, 1004, 1002, 1005, 1006 });
	/* f has no port 2: the branch of e stays out */
	command(test, b, "swap f a");
	expect_order(test, b, 4, (const u16[]){ 1006, 1003, 1004, 1002 });
	KUNIT_EXPECT_EQ_MSG(test, dl(b, 0) & 0xfff0, 0x5610, "a is at e");
	KUNIT_EXPECT_EQ(test, ec_sim_at(b->sim, 0)->port[0].peer, 4);
}

static void sim_cable_swap_branches(struct kunit *test)
{
	struct bed *b = app_bed(test, TREE);

	command(test, b, "swap a.1 a.2");
	expect_order(test, b, 6, (const u16[]){ 1001, 1005, 1006, 1002, 1003, 1004 });
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x10100);
	KUNIT_EXPECT_EQ(test, lost(b, 1), 0x1);
	KUNIT_EXPECT_EQ(test, lost(b, 4), 0x1);
	KUNIT_EXPECT_EQ(test, lost(b, 5), 0);
	command(test, b, "swap a.1 e.2");	/* free: a branch below itself is cut off */
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	command(test, b, "swap e.2 a.1");
	expect_order(test, b, 6, (const u16[]){ 1001, 1005, 1006, 1002, 1003, 1004 });

	/* both ends of one cable: it comes out and goes in again */
	command(test, b, "swap a.2 b.0");
	KUNIT_EXPECT_EQ(test, lost(b, 1), 0x2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 6);
	command(test, b, "cut d.0");
	command(test, b, "swap c.1 f.1");
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 5, "the cable of d is still broken");
	command(test, b, "heal f.1");
	expect_order(test, b, 6, (const u16[]){ 1001, 1005, 1006, 1004, 1002, 1003 });
}

static void sim_cable_swap_master(struct kunit *test)
{
	struct bed *b = app_bed(test, TREE "wire f.1 -> master.1\n");

	KUNIT_EXPECT_EQ(test, count(b, 0), 6);
	KUNIT_EXPECT_EQ(test, count(b, 1), 0);
	command(test, b, "swap master.0 master.1");
	KUNIT_EXPECT_EQ(test, count(b, 0), 0);
	KUNIT_EXPECT_EQ(test, count(b, 1), 6);
	/* would connect the master with itself: stays out */
	command(test, b, "swap a.0 master.0");
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 1));
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
}

static void sim_cable_old_registers_are_live(struct kunit *test)
{
	struct bed *b = app_bed_part(test, "slave a EK1100\nslave o EL2008\nbranch none\n"
				     "slave x EL2008\nslave m io in=32 out=32 cpu=yes\n"
				     "fault old x station=1002 state=OP logical=0x10000\n"
				     "fault old m station=7 loops=0x0c state=OP logical=0x10001\n",
				     2);
	struct ec_app *m = ec_sim_find(b->sim, "m"), *x = ec_sim_find(b->sim, "x");
	static const u8 outputs[] = { 0xA5, 1, 2, 3, 4 };
	u8 v[9] = { 0 };

	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, EC_REG_AL_STATUS, 2), EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, logical(b, EC_CMD_LRW, 0x10000, v, 9), 0);
	command(test, b, "plug o.1 x.0");
	/* two slaves answer, the first with its state, the second with an old one */
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, EC_REG_AL_STATUS, v, 2), 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 7, EC_REG_AL_STATUS, 2), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bed_get(b, 7, EC_REG_AL_CONTROL, 2), EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bed_get(b, 7, EC_REG_DL_LOOPS, 1), 0x0c);
	KUNIT_EXPECT_EQ(test, bed_get(b, 7, EC_REG_DL_STATUS, 2) & 0xfff0, 0x5610);
	/* and they take part in the process data at once */
	memcpy(v, outputs, sizeof(outputs));
	KUNIT_EXPECT_EQ(test, logical(b, EC_CMD_LRW, 0x10000, v, 9), 2 + 3);
	KUNIT_EXPECT_EQ(test, ec_app_channel(x, EC_APP_OUT, 0), 1);
	KUNIT_EXPECT_EQ(test, ec_app_channel(x, EC_APP_OUT, 1), 0);
	KUNIT_EXPECT_EQ(test, ec_app_channel(x, EC_APP_OUT, 7), 1);
	for (u16 i = 0; i < 32; i++)
		KUNIT_EXPECT_EQ_MSG(test, ec_app_channel(m, EC_APP_OUT, i), 0x04030201 >> i & 1,
				    "output %u", i);
	b->now += 2000000000;
	KUNIT_EXPECT_EQ_MSG(test, bed_get(b, 7, EC_REG_AL_STATUS, 2), EC_AL_OP, "no watchdog");
	/* INIT through its own master ends it */
	bed_put(b, 7, EC_REG_AL_CONTROL, EC_AL_INIT, 2);
	b->now += 100000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 7, EC_REG_AL_STATUS, 2), EC_AL_INIT);
	command(test, b, "off m");
	command(test, b, "old m station=9");
	command(test, b, "on m");
	KUNIT_EXPECT_EQ(test, bed_get(b, 9, EC_REG_STATION, 2), ~0ull);
}

static void sim_cable_old_states(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave m drive\nslave o EL2008\n");
	static const struct {
		const char *command;
		u16 state;
	} steps[] = {
		{ "old m state=PREOP", EC_AL_PREOP }, { "old m state=OP", EC_AL_OP },
		{ "old m state=SAFEOP", EC_AL_SAFEOP }, { "old m state=BOOT", EC_AL_BOOT },
		{ "old m state=INIT", EC_AL_INIT },
	};

	for (u32 i = 0; i < ARRAY_SIZE(steps); i++) {
		command(test, b, steps[i].command);
		KUNIT_EXPECT_EQ_MSG(test, bed_get(b, STATION(0), EC_REG_AL_STATUS, 2),
				    steps[i].state, "%s", steps[i].command);
		KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_STATION, 2), STATION(0));
	}
	/* it goes on from there as any slave */
	command(test, b, "old m state=SAFEOP");
	bed_put(b, STATION(0), EC_REG_AL_CONTROL, EC_AL_PREOP, 2);
	b->now += 100000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_AL_STATUS, 2), EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), EC_REG_AL_STATUS, 2), EC_AL_INIT);
}

/* what the registers and the frames say of each digit of a pattern */
static void sim_cable_bounce_follows_pattern(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\nslave c EL2008\n");
	static const char pattern[] = "0100110";

	b->gap = 0;
	b->now = 2000000000;
	command(test, b, "bounce a.1 pattern=0100110 step=1ms times=2");
	for (u32 i = 0; i < 14; i++) {
		bool on = pattern[i % 7] == '1';

		b->now = 2000000000 + i * 1000000 + 900000;
		KUNIT_EXPECT_EQ_MSG(test, count(b, 0), on ? 3 : 1, "digit %u", i);
		KUNIT_EXPECT_EQ_MSG(test, bed_get(b, STATION(0), EC_REG_DL_STATUS, 2) & 0xfff0,
				    on ? 0x5a30ull : 0x5610ull, "digit %u", i);
	}
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 0), 0x500, "0 after 1, five times");
	KUNIT_EXPECT_EQ(test, lost(b, 1), 0x5);
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0);
	b->now += 1000000000;
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 1, "as the last digit");
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

/* a port that closes itself loses the first frame only, however often the contact comes */
static void sim_cable_bounce_at_auto_closed_port(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n");

	b->now = 2000000000;
	bed_put(b, STATION(0), EC_REG_DL_LOOPS, EC_LOOP_AUTO_CLOSE << 2, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	command(test, b, "bounce a.1 pattern=01 step=7us times=400");
	for (u32 i = 0; i < 300; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 0), 0xff00, "counts up to 255");
	KUNIT_EXPECT_EQ(test, lost(b, 1), 0xff);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_DL_STATUS, 2) & 0xfff0, 0x5e30);
}

/* many events in one microsecond: each is counted, the last one stays */
static void sim_cable_bursts_within_microsecond(struct kunit *test)
{
	struct bed *b = app_bed(test, TREE
		"fault at=2000000000ns bounce a.1 pattern=01 step=100ns times=5\n"
		"fault at=2000000050ns bounce a.2 pattern=0 step=100ns\n"
		"fault at=2000000250ns off c\n"
		"fault at=2000000250ns on c\n"
		"fault at=2000000250ns swap b d\n"
		"fault at=2000000300ns unplug e.1\n"
		"fault at=2000000300ns plug b.1 f.0\n"
		"fault at=2000000900ns heal e.0\n");

	b->now = 1999900000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 6);
	b->now = 2000001000;
	/* a, d, c, b, f, e; c has lost its address, no other slave has */
	expect_order(test, b, 6, (const u16[]){ 1001, 1004, 0, 1002, 1006, 1005 });
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 0), 0x10500, "five times; the swap without contact");
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 2), 0x101, "after its power came: the swap");
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 3), 0x5, "c off, the swap, then three times at a.1");
	KUNIT_EXPECT_EQ(test, lost(b, 4), 0x101);
	KUNIT_EXPECT_EQ(test, lost(b, 5), 0x1);
	for (u32 i = 0; i < 6; i++)
		KUNIT_EXPECT_TRUE_MSG(test, dl_event(b, i), "slave %u", i);
}

/* what a PC or a switch does depends on the loop of its port */
static void sim_cable_host_and_loops(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n");
	char line[100];

	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	command(test, b, "host a.2");
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), -1, "auto: open at once, and frames do not return");
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x6a70);
	ec_sim_show(b->sim, 0, line, sizeof(line));
	KUNIT_EXPECT_STREQ(test, line, "0 a EK1100 at master.0: host .2");
	command(test, b, "unplug a.2");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x10000);

	bed_put(b, STATION(0), EC_REG_DL_LOOPS, EC_LOOP_CLOSED << 4, 1);
	forget_dl_event(b, 0);
	command(test, b, "host a.2 every=30us");
	for (u32 i = 0; i < 20; i++)
		KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 2, "closed: whatever is sent there");
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x7a70);
	KUNIT_EXPECT_TRUE(test, dl_event(b, 0));
	command(test, b, "cut a.2");
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x5a30);
	command(test, b, "heal a.2");
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x7a70);
	command(test, b, "unplug a.2");

	/* closes itself: a silent one does nothing, one with traffic opens the port */
	bed_put(b, STATION(0), EC_REG_DL_LOOPS, EC_LOOP_AUTO_CLOSE << 4, 1);
	command(test, b, "host a.2");
	for (u32 i = 0; i < 20; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x7a70);
	command(test, b, "host a.2 every=1ms");
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x6a70);
	command(test, b, "swap a.1 a.2");
	KUNIT_EXPECT_EQ_MSG(test, dl(b, 0) & 0xfff0, 0x7650, "b is behind a closed port, no host");
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 0), 0x50100, "a cut, four hosts that went");
	command(test, b, "swap a.1 a.2");
	command(test, b, "host a.2 every=1ms");
	command(test, b, "plug a.2 master.1");
	b->now += 10000000;
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 2, "it is gone, and its frames with it");
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

static void sim_cable_without_power(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE "fault off x\n", 3);

	command(test, b, "plug c.1 x.0");
	KUNIT_EXPECT_EQ_MSG(test, dl(b, 2) & 0xfff0, 0x5610, "no link without power");
	KUNIT_EXPECT_EQ(test, lost(b, 2), 0);
	command(test, b, "on x");
	KUNIT_EXPECT_EQ(test, dl(b, 2) & 0xfff0, 0x5a30);
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
}

/* a PHY needs time for a link; of two the slower one */
static void sim_cable_link_takes_time(struct kunit *test)
{
	struct bed *b = app_bed_part(test, "segment link=10ms\nslave a EK1100 link=0\n"
				     "slave b EL2008 link=5ms\nslave c EL2008\n", 0);

	b->gap = 0;
	b->now = 100;
	KUNIT_EXPECT_TRUE(test, ec_sim_link(b->sim, 0));
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	b->now = 5000000 - 20000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x5610);
	b->now = 5000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x5a30);
	b->now = 10000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	forget_dl_event(b, 1);
	forget_dl_event(b, 2);

	command(test, b, "cut c.0");
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 2, "down at once");
	forget_dl_event(b, 1);
	command(test, b, "heal c.0");
	KUNIT_EXPECT_FALSE_MSG(test, dl_event(b, 1), "not yet");
	b->now += 9000000;
	command(test, b, "cut c.0");
	KUNIT_EXPECT_EQ_MSG(test, lost(b, 1), 0x100, "there was none to lose");
	command(test, b, "heal c.0");
	b->now += 9000000;
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), 2, "from the beginning");
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_TRUE(test, dl_event(b, 1));
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

/* power, a host and the master's port */
static void sim_cable_link_takes_time_elsewhere(struct kunit *test)
{
	struct bed *b = app_bed_part(test, "segment link=10ms\nslave a EK1100\nslave b EL2008\n",
				     0);

	b->gap = 0;
	b->now = 100;
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
	b->now = 10000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	command(test, b, "off b");
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	command(test, b, "on b");
	command(test, b, "host a.2");
	b->now += 9000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	command(test, b, "unplug a.2");
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x100);
	command(test, b, "host a.2");
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	b->now += 9000000;
	KUNIT_EXPECT_EQ_MSG(test, count(b, 0), -1, "the host has a link now");
	KUNIT_EXPECT_EQ(test, dl(b, 0) & 0xfff0, 0x6a70);
	command(test, b, "unplug master.0");
	command(test, b, "plug master.0 a.0");
	b->now += 9999999;
	ec_sim_advance(b->sim, b->now);
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
	ec_sim_advance(b->sim, b->now + 1);
	KUNIT_EXPECT_TRUE(test, ec_sim_link(b->sim, 0));
}

/* a bounce shorter than a link needs: no link until the contact stays */
static void sim_cable_link_outlasts_bounce(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008 link=1ms\n");

	b->now = 1000000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	command(test, b, "bounce a.1 pattern=01 step=100us times=50");
	for (u32 i = 0; i < 500; i++)
		KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, lost(b, 0), 0x100);
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
}

static void sim_cable_errors_are_reported(struct kunit *test)
{
	struct bed *b = app_bed_part(test, LINE, 3);
	static const struct {
		const char *text, *want;
	} bad[] = {
		{ "plug c.1", "missing channel or port" },
		{ "plug c.1 c.1", "is named twice; name two different ports" },
		{ "plug c.1 x.3", "does not have this port" },
		{ "plug c.4 x.0", "ports are 0 to 3" },
		{ "plug c.1 z.0", "unknown slave 'z'" },
		{ "plug master.0 master.1", "cannot be connected to each other" },
		{ "plug c.1 x.0 cable=2ms", "too long here" },
		{ "unplug c", "has no number" },
		{ "bounce c.0", "invalid pattern ''" },
		{ "bounce c.0 pattern=012", "invalid pattern '012'" },
		{ "bounce c.0 pattern=01 step=0", "needs time" },
		{ "bounce c.0 pattern=01 step=5s", "too long here" },
		{ "bounce c.0 pattern=01 times=0", "out of range" },
		{ "bounce c.0 pattern=01 times=50001", "out of range" },
		{ "host c.0 every=1us", "expected every=7us or more" },
		{ "host c.2", "does not have this port" },
		{ "host c.0 frames=ip", "invalid frames 'ip': expected broadcast or ethercat" },
		{ "host c.0 frames=ethercat every=99us", "at most every 100 us" },
		{ "host master.0", "at a slave only" },
		{ "old c", "nothing is old" },
		{ "old c state=ON", "invalid state 'ON'" },
		{ "old c loops=256", "out of range" },
		{ "swap c", "missing name of a slave" },
		{ "swap c c", "is named twice; name two different slaves" },
		{ "swap c x.0", "has no number" },
		{ "swap c.1 x.2", "does not have this port" },
		{ "unplug c.2", "does not have this port" },
	};
	struct ec_sim_error err;
	struct ec_sim_fault f;
	char line[100];

	for (u32 i = 0; i < ARRAY_SIZE(bad); i++) {
		KUNIT_EXPECT_EQ_MSG(test, ec_sim_command(b->sim, &bed_ops, bad[i].text,
							 strlen(bad[i].text), &f, &err),
				    -EINVAL, "%s", bad[i].text);
		KUNIT_EXPECT_TRUE_MSG(test, strstr(err.text, bad[i].want), "\"%s\" says \"%s\"",
				      bad[i].text, err.text);
	}
	f = (struct ec_sim_fault){ .type = EC_SIM_FAULT_PLUG, .slave = 2, .port = 1,
				   .arg = 3, .arg2 = 3 };
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	f.type = EC_SIM_FAULT_SWAP;
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	f.port = EC_SIM_ALL_PORTS;
	f.arg = 5;
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	f = (struct ec_sim_fault){ .type = EC_SIM_FAULT_UNPLUG, .slave = -3 };
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	ec_sim_show(b->sim, 3, line, sizeof(line));
	KUNIT_EXPECT_STREQ(test, line, "3 x EL1008 at y.0");
	command(test, b, "unplug x.1");
	ec_sim_show(b->sim, 3, line, sizeof(line));
	KUNIT_EXPECT_STREQ(test, line, "3 x EL1008 unplugged");
	command(test, b, "plug c.1 y.1");
	ec_sim_show(b->sim, 4, line, sizeof(line));
	KUNIT_EXPECT_STREQ(test, line, "4 y EL1008 at c.1");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_cable_plug_and_unplug),
	KUNIT_CASE(sim_cable_plug_elsewhere),
	KUNIT_CASE(sim_cable_plug_at_closed_port),
	KUNIT_CASE(sim_cable_master_and_ring),
	KUNIT_CASE(sim_cable_between_free_ports),
	KUNIT_CASE(sim_cable_swap_slaves),
	KUNIT_CASE(sim_cable_swap_branches),
	KUNIT_CASE(sim_cable_swap_master),
	KUNIT_CASE(sim_cable_old_registers_are_live),
	KUNIT_CASE(sim_cable_old_states),
	KUNIT_CASE(sim_cable_bounce_follows_pattern),
	KUNIT_CASE(sim_cable_bounce_at_auto_closed_port),
	KUNIT_CASE(sim_cable_bursts_within_microsecond),
	KUNIT_CASE(sim_cable_host_and_loops),
	KUNIT_CASE(sim_cable_without_power),
	KUNIT_CASE(sim_cable_link_takes_time),
	KUNIT_CASE(sim_cable_link_takes_time_elsewhere),
	KUNIT_CASE(sim_cable_link_outlasts_bounce),
	KUNIT_CASE(sim_cable_errors_are_reported),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_cable",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
