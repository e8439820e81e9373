// SPDX-License-Identifier: GPL-2.0-only
/* A PC or a switch at a port of a slave, and its frames in the bus. */
#include "sim_flight_kunit.h"

#define MS	1000000ull

/*
 * Slave 0 with slave 1 at port 3, slave 2 at port 1, and slave 4 at port 2 of slave 3, which is
 * between it and the master. The host is at port 3 of slave 4, or of another.
 */
static struct bed *tree(struct kunit *test)
{
	static const int w[][3] = {
		{ 3, 1, 0 }, { 0, 3, 1 }, { 0, 1, 2 }, { -1, 0, 3 }, { 3, 2, 4 },
	};
	struct bed *b = bed_new(test, 5, 0);

	for (u32 i = 0; i < 5; i++)
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
	for (u32 i = 0; i < 5; i++)
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, w[i][0], w[i][1], w[i][2], 0, 100), 0);
	b->now = SECOND;
	return b;
}

static void host(struct kunit *test, struct bed *b, int slave, int port, u32 frames, u64 every)
{
	const struct ec_sim_fault f = {
		.type = EC_SIM_FAULT_HOST, .slave = slave, .port = port, .arg = frames,
		.value = every,
	};

	ec_sim_advance(b->sim, b->now);
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	ec_sim_advance(b->sim, b->now);
}

/* bit 0 of 0x0100 in all slaves, reached or not */
static void forward(struct bed *b, bool on)
{
	for (u32 i = 0; i < ec_sim_count(b->sim); i++)
		ec_sim_slave(b->sim, i)->mem[EC_REG_DL_CONTROL] = !on;
}

/* frames that came to a master within @ns */
static u32 arrived(struct bed *b, u64 ns, struct ec_sim_foreign *last)
{
	u32 n = 0;

	b->now += ns;
	ec_sim_advance(b->sim, b->now);
	while (ec_sim_foreign(b->sim, last))
		n++;
	return n;
}

static void sim_host_broadcast_destroyed_by_first_slave(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;

	host(test, b, 2, 2, EC_SIM_HOST_BROADCAST, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, 10 * MS, &f), 0);
	/* one that forwards is not enough */
	ec_sim_slave(b->sim, 2)->mem[EC_REG_DL_CONTROL] = 0;
	KUNIT_EXPECT_EQ(test, arrived(b, 10 * MS, &f), 0);
	forward(b, true);
	KUNIT_EXPECT_EQ(test, arrived(b, 10 * MS, &f), 10);
	/* nor are all but one on the way */
	ec_sim_slave(b->sim, 4)->mem[EC_REG_DL_CONTROL] = 1;
	KUNIT_EXPECT_EQ_MSG(test, arrived(b, 10 * MS, &f), 0, "through port 2 of slave 3");
}

static void sim_host_broadcast_forwarded_unchanged(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;
	u8 mark[14] = {
		0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02, 0x0c, 0, 0, 2, 2, 0x08, 0x06,
	};

	forward(b, true);
	host(test, b, 2, 2, EC_SIM_HOST_BROADCAST, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, MS + 30 * US, &f), 1);
	KUNIT_EXPECT_EQ(test, f.port, 0);
	KUNIT_EXPECT_MEMEQ(test, f.eth, mark, sizeof(mark));
	/* slaves 2, 0, 3, 4, 3: five times 500 ns; five cables */
	KUNIT_EXPECT_EQ(test, f.due_ns, SECOND + MS + 5 * 500 + 5 * 100 + WIRE);
	for (u32 i = 0; i < 5; i++)
		KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, i)->mem[EC_REG_ERR_PU], 0);
}

/* it is processed by the slaves that it enters at port 0, whatever bit 0 is */
static void sim_host_ethercat_processed_on_its_way(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;

	host(test, b, 1, 2, EC_SIM_HOST_ETHERCAT, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, MS + 30 * US, &f), 1);
	KUNIT_EXPECT_EQ(test, f.eth[12] << 8 | f.eth[13], EC_ETHERTYPE);
	KUNIT_EXPECT_EQ(test, f.eth[16], EC_CMD_BRD);
	KUNIT_EXPECT_EQ_MSG(test, get_unaligned_le16(f.eth + 16 + 2), 2, "slaves 2 and 4");
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(f.eth + 16 + 4), EC_REG_AL_STATUS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(f.eth + 16 + 10), EC_AL_INIT);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(f.eth + 16 + 12), 2);
	KUNIT_EXPECT_EQ(test, f.eth[6], 0x02);
	/* frames of the master that go there are lost, those of the host come */
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_EQ(test, arrived(b, 3 * MS, &f), 3);
}

/* what it reads is acknowledged, as by any other master */
static void sim_host_ethercat_clears_events(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;

	for (u32 i = 0; i < 5; i++)
		ec_esc_event(ec_sim_slave(b->sim, i), EC_ECAT_EVENT_AL, 0);
	host(test, b, 0, 2, EC_SIM_HOST_ETHERCAT, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, MS + 30 * US, &f), 1);
	for (u32 i = 0; i < 5; i++)
		KUNIT_EXPECT_EQ_MSG(test, ec_sim_slave(b->sim, i)->ecat_event & EC_ECAT_EVENT_AL,
				    i == 4 ? 0 : EC_ECAT_EVENT_AL, "slave %u", i);
}

static void sim_host_loop_of_its_port(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_esc *esc = ec_sim_slave(b->sim, 2);
	struct ec_sim_foreign f;
	u8 v = EC_LOOP_CLOSED << 4;

	KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-3, 1002), 1);
	KUNIT_ASSERT_EQ(test, get_unaligned_le16(esc->mem + EC_REG_STATION), 1002);
	KUNIT_EXPECT_EQ(test, bed_put(b, 1002, EC_REG_DL_LOOPS, v, 1), 1);
	host(test, b, 2, 2, EC_SIM_HOST_ETHERCAT, MS);
	KUNIT_EXPECT_EQ_MSG(test, arrived(b, 5 * MS + 500 * US, &f), 0, "closed");
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
	/* auto close: the first frame opens the port and is destroyed */
	v = EC_LOOP_AUTO_CLOSE << 4;
	KUNIT_EXPECT_EQ(test, bed_put(b, 1002, EC_REG_DL_LOOPS, v, 1), 1);
	KUNIT_EXPECT_EQ_MSG(test, dl(b, 2) >> 12 & 3, 2, "open by the write");
	ec_sim_cut(b->sim, 2, 2, true, b->now);
	ec_sim_cut(b->sim, 2, 2, false, b->now);
	KUNIT_EXPECT_EQ(test, dl(b, 2) >> 12 & 3, 3);
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
	KUNIT_EXPECT_EQ(test, arrived(b, MS, &f), 0);
	KUNIT_EXPECT_EQ(test, dl(b, 2) >> 12 & 3, 2);
	KUNIT_EXPECT_EQ(test, arrived(b, MS, &f), 1);
	/* without a link it sends nothing */
	ec_sim_cut(b->sim, 2, 2, true, b->now);
	KUNIT_EXPECT_EQ(test, arrived(b, 5 * MS, &f), 0);
}

/* no master: from one host to the other; and to the second master port of a ring */
static void sim_host_other_ends(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;

	forward(b, true);
	host(test, b, 1, 1, EC_SIM_HOST_BROADCAST, 0);
	host(test, b, 2, 1, EC_SIM_HOST_BROADCAST, MS);
	KUNIT_EXPECT_EQ_MSG(test, arrived(b, 5 * MS + 500 * US, &f), 5, "behind port 1");
	host(test, b, 1, 2, EC_SIM_HOST_BROADCAST, MS);
	KUNIT_EXPECT_EQ_MSG(test, arrived(b, 500 * US, &f), 0, "to slave 2's host");
	ec_sim_free(b->sim);
	b = bed_new(test, 2, 2);
	b->now = SECOND;
	KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, EC_SIM_MASTER1, 0, 1, 1, 100), 0);
	host(test, b, 0, 3, EC_SIM_HOST_ETHERCAT, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, MS + 30 * US, &f), 1);
	KUNIT_EXPECT_EQ(test, f.port, 1);
	KUNIT_EXPECT_EQ_MSG(test, get_unaligned_le16(f.eth + 16 + 12), 1, "slave 1");
}

/* frames of the host and of the master pass each other */
static void sim_host_beside_master(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;
	struct air a;
	u32 n = 0;

	bed_station(b, (u16)-3, 1002);
	host(test, b, 2, 2, EC_SIM_HOST_ETHERCAT, 100 * US);
	bed_put(b, 1002, EC_REG_DL_LOOPS, EC_LOOP_CLOSED << 4, 1);
	host(test, b, 1, 2, EC_SIM_HOST_ETHERCAT, 100 * US);
	ec_sim_slave(b->sim, 1)->mem[EC_REG_DL_LOOPS] = 0;
	for (u32 i = 0; i < 100; i++) {
		b->now += 97 * US;
		mark(b, &a, b->now, 1);
		ec_sim_advance(b->sim, b->now + 30 * US);
		KUNIT_EXPECT_EQ_MSG(test, a.fl.res.copies, 0, "open: the host keeps it");
		n += arrived(b, 0, &f);
	}
	KUNIT_EXPECT_GT(test, n, 90);
}

/* a caller that never fetches them has the newest */
static void sim_host_not_fetched(struct kunit *test)
{
	struct bed *b = tree(test);
	struct ec_sim_foreign f;

	host(test, b, 2, 2, EC_SIM_HOST_ETHERCAT, MS);
	KUNIT_EXPECT_EQ(test, arrived(b, 100 * MS + 500 * US, &f), EC_SIM_HOST_FRAMES);
	KUNIT_EXPECT_GT(test, f.due_ns, SECOND + 100 * MS);
	KUNIT_EXPECT_FALSE(test, ec_sim_foreign(b->sim, &f));
	/* unplugged while one is on its way: it is lost */
	b->now += 500 * US;
	plan(test, b, b->now + 1 * US, EC_SIM_FAULT_UNPLUG, 2, 2);
	KUNIT_EXPECT_EQ(test, arrived(b, 10 * MS, &f), 0);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
}

static void sim_host_described(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave b EL2008\n"
				"fault at=1s host a.2 every=1ms frames=ethercat\n");
	struct ec_sim_foreign f;

	b->now = SECOND;
	KUNIT_EXPECT_EQ(test, arrived(b, 3 * MS + 500 * US, &f), 3);
	command(test, b, "host a.2 every=1ms frames=broadcast");
	KUNIT_EXPECT_EQ(test, arrived(b, 3 * MS, &f), 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_host_broadcast_destroyed_by_first_slave),
	KUNIT_CASE(sim_host_broadcast_forwarded_unchanged),
	KUNIT_CASE(sim_host_ethercat_processed_on_its_way),
	KUNIT_CASE(sim_host_ethercat_clears_events),
	KUNIT_CASE(sim_host_loop_of_its_port),
	KUNIT_CASE(sim_host_other_ends),
	KUNIT_CASE(sim_host_beside_master),
	KUNIT_CASE(sim_host_not_fetched),
	KUNIT_CASE(sim_host_described),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_host",
	.exit = bed_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
