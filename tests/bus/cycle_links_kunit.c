// SPDX-License-Identifier: GPL-2.0-only
/* A cycle whose frames leave on two links; a case takes the copies off, and gives them back. */
#include "cyc.h"
#include "master/boundary/ioctl.h"

#define SENDS	(EC_CYC_FRAMES + 2)	/* of a case */
#define BOTH	(BIT(EC_MAIN) | BIT(EC_BACKUP))

struct copy {
	u8 buf[128];
	size_t len;	/* behind the EtherType, 0: not sent */
};

/**
 * struct pair - a cycle on two links
 * @b: bus
 * @c: application, whose slave is in OP
 * @taken: links whose frames of the cycle are taken off: nothing answers them
 * @full: the backup device has no transmit buffer
 * @err: the backup device refuses frames of the cycle with it
 * @n: number of the last send
 * @sent: copies by link and number of the send
 * @base: counters of the links before
 * @real: functions of the main device
 * @ops: those with which frames are taken off
 * @backup: a second device, behind which is no slave, or NULL
 * @tx: its transmit buffer
 */
struct pair {
	struct bus *b;
	struct cyc *c;
	u8 taken;
	bool full;
	int err;
	u32 n;
	struct copy sent[EC_MAX_LINKS][SENDS];
	struct ec_link_stats base[EC_MAX_LINKS];
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	struct ecdev *backup;
	u8 tx[EC_ETH_MAX];
};

static struct pair *pair;

static bool is_cyclic(const u8 *buf)
{
	u8 cmd = buf[EC_ETH_HDR + EC_FRAME_HDR];

	return cmd == EC_CMD_LRD || cmd == EC_CMD_LWR || cmd == EC_CMD_LRW;
}

/* The monitor sends, too. */
static bool take_off(u8 side, const u8 *buf, size_t len)
{
	struct copy *copy = &pair->sent[side][pair->n];

	if (!(pair->taken & BIT(side)) || !is_cyclic(buf))
		return false;
	memcpy(copy->buf, buf, min(len, sizeof(copy->buf)));
	copy->len = EC_FRAME_HDR + (get_unaligned_le16(buf + EC_ETH_HDR) & EC_DGRAM_LEN_MASK);
	return true;
}

static int main_tx_send(void *priv, u8 *buf, size_t len)
{
	return take_off(EC_MAIN, buf, len) ? 0 : pair->real->tx_send(priv, buf, len);
}

static int backup_start(void *priv, struct ecdev *dev)
{
	return 0;
}

static void backup_stop(void *priv)
{
}

static u8 *backup_tx_get(void *priv)
{
	return pair->full ? NULL : pair->tx;
}

/* No slave is reached from this end: the frame comes back as it is. */
static int backup_tx_send(void *priv, u8 *buf, size_t len)
{
	if (pair->err && is_cyclic(buf))
		return pair->err;
	if (!take_off(EC_BACKUP, buf, len))
		ecdev_receive(bus_link(pair->b, EC_BACKUP)->dev, buf + ETH_ALEN,
			      buf + EC_ETH_HDR, len - EC_ETH_HDR);
	return 0;
}

static bool backup_link_up(void *priv)
{
	return true;
}

static const struct ecdev_ops backup_ops = {
	.kind = "test", .atomic = true, .start = backup_start, .stop = backup_stop,
	.tx_get = backup_tx_get, .tx_send = backup_tx_send, .link_up = backup_link_up,
};

static void set_sides(struct bus *b, u8 sides)
{
	bus_links(b)->sides = sides;
	bus_links(b)->only = sides == BOTH ? NULL : bus_link(b, EC_MAIN);
}

static u64 count(struct pair *p, u8 side, size_t counter)
{
	const u8 *now = (u8 *)&bus_link(p->b, side)->stats, *base = (u8 *)&p->base[side];

	return atomic64_read((atomic64_t *)(now + counter)) -
	       atomic64_read((atomic64_t *)(base + counter));
}

#define counted(p, side, what)	count(p, side, offsetof(struct ec_link_stats, what))

static void expect_counts(struct pair *p, u8 side, u64 lost, u64 late)
{
	KUNIT_EXPECT_EQ_MSG(p->b->test, counted(p, side, lost), lost, "link %u", side);
	KUNIT_EXPECT_EQ_MSG(p->b->test, counted(p, side, late), late, "link %u", side);
	KUNIT_EXPECT_EQ_MSG(p->b->test, counted(p, side, unmatched), 0ull, "link %u", side);
}

static void send(struct pair *p)
{
	struct ec_ioc_send what = { .queued = p->c->queued };

	KUNIT_ASSERT_LT(p->b->test, ++p->n, SENDS);
	KUNIT_ASSERT_EQ(p->b->test, ec_ioc_send(&p->b->app, &what), 0);
}

static void receive(struct pair *p)
{
	KUNIT_ASSERT_EQ(p->b->test, ec_ioc_receive(&p->b->app), 0);
}

/* The copy of a link comes; the slaves have written @value, 0: it has reached none. */
static void give(struct pair *p, u8 side, u32 n, u8 value)
{
	struct copy *copy = &p->sent[side][n];
	struct ec_frame_iter it;
	struct ec_dgram d;

	KUNIT_ASSERT_NE(p->b->test, copy->len, (size_t)0);
	KUNIT_ASSERT_EQ(p->b->test, ec_frame_iter_init(&it, copy->buf + EC_ETH_HDR, copy->len), 0);
	while (value && ec_frame_iter_next(&it, &d) == 1) {
		memset(d.data, value, d.len);
		ec_dgram_set_wkc(&d, bus_cycle(p->b)->domains[0].expected);
	}
	rcu_read_lock();
	ecdev_receive(side ? p->backup : bus_dev(p->b), copy->buf + ETH_ALEN,
		      copy->buf + EC_ETH_HDR, copy->len);
	rcu_read_unlock();
}

/* Data that are complete, or none. */
static void expect_data(struct pair *p, bool complete, u32 age, u8 value)
{
	const struct ec_status_domain *st = cyc_state(p->c, 0);

	KUNIT_EXPECT_EQ(p->b->test, st->working_counter,
			complete ? bus_cycle(p->b)->domains[0].expected : 0);
	KUNIT_EXPECT_EQ(p->b->test, st->wc_state,
			(u32)(complete ? EC_STATUS_WC_COMPLETE : EC_STATUS_WC_ZERO));
	KUNIT_EXPECT_EQ(p->b->test, st->age, age);
	KUNIT_EXPECT_EQ(p->b->test, cyc_pd(p->c, 0, 3)[0], value);
}

/* A slave in OP; the backup device is attached while the cycle runs. */
static struct pair *pair_new(struct kunit *test)
{
	static const u8 mac[ETH_ALEN] = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x78 };
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\n", 1);
	struct pair *p = kunit_kzalloc(test, sizeof(*p), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, p);
	p->b = b;
	p->c = cyc_in_op(b, 0, 1);
	pair = p;
	for (i = 0; i < EC_SLOTS; i++)
		bus_two_copies(b, bus_slot(b, i));
	p->real = bus_dev(b)->ops;
	p->ops = *p->real;
	p->ops.tx_send = main_tx_send;
	bus_dev(b)->ops = &p->ops;
	bus_links(b)->backup = "bus1";
	p->backup = ecdev_offer("bus1", mac, &backup_ops, NULL);
	KUNIT_ASSERT_FALSE(test, IS_ERR(p->backup));
	KUNIT_ASSERT_PTR_EQ(test, bus_link(b, EC_BACKUP)->dev, p->backup);
	set_sides(b, BOTH);
	p->c->next = ktime_get();
	cyc_run(p->c, 50);
	usleep_range(500, 501);
	receive(p);
	KUNIT_ASSERT_EQ(test, bus_n_flight(b), 0u);
	p->c->incomplete = 0;
	for (i = 0; i < EC_MAX_LINKS; i++)
		memcpy(&p->base[i], &bus_link(b, i)->stats, sizeof(p->base[i]));
	return p;
}

/* as pair_new(); the case answers the frames of the cycle, of which the first has 0x11 */
static struct pair *pair_by_hand(struct kunit *test)
{
	struct pair *p = pair_new(test);

	p->taken = BOTH;
	send(p);
	give(p, EC_MAIN, 1, 0x11);
	give(p, EC_BACKUP, 1, 0);
	receive(p);
	expect_data(p, true, 0, 0x11);
	return p;
}

static void pair_exit(struct kunit *test)
{
	struct pair *p = pair;
	u32 i;

	if (p) {
		p->taken = 0;
		p->full = false;
		p->err = 0;
		bus_end(p->b);
		if (!IS_ERR_OR_NULL(p->backup))
			ecdev_withdraw(p->backup);
		set_sides(p->b, BIT(EC_MAIN));
		bus_links(p->b)->backup = NULL;
		/* the copies are the case's */
		msleep(100);
		for (i = 0; i < EC_SLOTS; i++)
			bus_one_copy(p->b, bus_slot(p->b, i));
		bus_dev(p->b)->ops = p->real;
	}
	pair = NULL;
	bus_exit(test);
}

static void cycle_links_both_copies_come(struct kunit *test)
{
	struct pair *p = pair_new(test);
	u8 side, first;

	cyc_run(p->c, 20);
	KUNIT_EXPECT_EQ(test, p->c->incomplete, 0ull);
	usleep_range(500, 501);
	receive(p);
	p->taken = BOTH;
	for (first = 0; first < EC_MAX_LINKS; first++) {
		send(p);
		give(p, first, p->n, first ? 0 : 0x21);
		give(p, !first, p->n, first ? 0x22 : 0);
		receive(p);
		expect_data(p, true, 0, first ? 0x22 : 0x21);
	}
	KUNIT_EXPECT_EQ(test, bus_n_flight(p->b), 0u);
	for (side = 0; side < EC_MAX_LINKS; side++)
		expect_counts(p, side, 0, 0);
}

/* The copy that came is taken at the next receive, the other one is late when it comes. */
static void one_copy(struct kunit *test, u8 came)
{
	struct pair *p = pair_by_hand(test);

	send(p);
	give(p, came, 2, 0x22);
	receive(p);
	expect_data(p, false, 1, 0x11);
	expect_counts(p, !came, 0, 0);
	send(p);
	receive(p);
	expect_data(p, true, 1, 0x22);
	expect_counts(p, came, 0, 0);
	expect_counts(p, !came, 1, 0);
	KUNIT_EXPECT_EQ(test, bus_n_flight(p->b), 1u);
	give(p, !came, 2, 0x33);
	receive(p);
	KUNIT_EXPECT_EQ(test, cyc_pd(p->c, 0, 3)[0], 0x22);
	expect_counts(p, came, 0, 0);
	expect_counts(p, !came, 1, 1);
}

static void cycle_links_no_copy_of_backup(struct kunit *test)
{
	one_copy(test, EC_MAIN);
}

static void cycle_links_no_copy_of_main(struct kunit *test)
{
	one_copy(test, EC_BACKUP);
}

/* The application polls: the copy that no slave has processed is first. */
static void cycle_links_copy_between_receives(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);

	send(p);
	receive(p);
	give(p, EC_BACKUP, 2, 0);
	receive(p);
	expect_data(p, false, 1, 0x11);
	give(p, EC_MAIN, 2, 0x22);
	receive(p);
	expect_data(p, true, 0, 0x22);
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 0, 0);
}

/* A link whose copies come after each receive was mute once: they are awaited again. */
static void cycle_links_late_link_is_heard_again(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);
	u32 i, complete = 0;

	for (i = 2; i < 10; i++) {
		send(p);
		give(p, EC_BACKUP, i, 0);
		receive(p);
		complete += cyc_state(p->c, 0)->wc_state == EC_STATUS_WC_COMPLETE;
		/* one is lost */
		if (i != 3)
			give(p, EC_MAIN, i, 0x20 + i);
	}
	/* the one before, and not the one that is lost */
	KUNIT_EXPECT_EQ(test, complete, 6u);
	KUNIT_EXPECT_EQ(test, cyc_pd(p->c, 0, 3)[0], 0x28);
}

/* Without a send it is given up after the time limit, and the other one is taken. */
static void cycle_links_one_copy_without_send(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);

	send(p);
	give(p, EC_MAIN, 2, 0x22);
	receive(p);
	expect_data(p, false, 1, 0x11);
	usleep_range(21000, 21001);
	receive(p);
	expect_data(p, true, 0, 0x22);
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 1, 0);
}

/*
 * As a cable heals: the copy of the backup link has turned at the break, that of the main link has
 * passed all slaves. A value is that of the latter, as is the working counter.
 */
static void cycle_links_crossed_copy_is_whole(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);
	struct copy *copy;

	send(p);
	give(p, EC_BACKUP, 2, 0x81);
	copy = &p->sent[EC_MAIN][2];
	swap(p->sent[EC_BACKUP][2], *copy);
	/* sent by the main link, received by the other one */
	p->sent[EC_BACKUP][2].buf[7] = 0;
	give(p, EC_BACKUP, 2, 0x42);
	receive(p);
	expect_data(p, true, 0, 0x42);
	KUNIT_EXPECT_EQ(test, cyc_state(p->c, 0)->redundancy_active, 0u);
}

/* Not given up yet, but after the next send: late on its link, not on the other. */
static void cycle_links_copy_after_next_send(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);

	send(p);
	give(p, EC_MAIN, 2, 0x22);
	receive(p);
	send(p);
	give(p, EC_BACKUP, 2, 0);
	receive(p);
	expect_data(p, true, 1, 0x22);
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 0, 1);
}

/* So many sends without a receive that the oldest frame is given up: main had its copy. */
static void cycle_links_oldest_given_up(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);
	u32 i;

	send(p);
	give(p, EC_MAIN, 2, 0x22);
	for (i = 0; i < EC_CYC_FRAMES - 1; i++)
		send(p);
	expect_counts(p, EC_BACKUP, 0, 0);
	/* one more, which is not kept */
	p->n--;
	send(p);
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 1, 0);
}

/* With a frame in flight whose copy it will not deliver. */
static void cycle_links_backup_withdrawn(struct kunit *test)
{
	struct pair *p = pair_new(test);

	p->c->next = ktime_get();
	p->taken = BIT(EC_BACKUP);
	cyc_run(p->c, 1);
	p->taken = 0;
	ecdev_withdraw(p->backup);
	p->backup = NULL;
	KUNIT_EXPECT_EQ(test, bus_access_mode(p->b), EC_ACCESS_CYCLIC);
	cyc_run(p->c, 100);
	KUNIT_EXPECT_EQ(test, bus_access_mode(p->b), EC_ACCESS_CYCLIC);
	KUNIT_EXPECT_EQ(test, bus_timeouts(p->b), 0u);
	/* only that frame */
	KUNIT_EXPECT_EQ(test, p->c->incomplete, 1ull);
	KUNIT_EXPECT_EQ(test, cyc_state(p->c, 0)->age, 0u);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(p->c));
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 1, 0);
}

/* The frames of the main go on, and each counts as an error of the backup. */
static void backup_refuses(struct kunit *test, bool full, int err)
{
	struct pair *p = pair_new(test);

	p->full = full;
	p->err = err;
	p->c->next = ktime_get();
	cyc_run(p->c, 10);
	usleep_range(500, 501);
	receive(p);
	KUNIT_EXPECT_EQ(test, p->c->incomplete, 0ull);
	expect_data(p, true, 0, cyc_pd(p->c, 0, 3)[0]);
	KUNIT_EXPECT_EQ(test, counted(p, EC_MAIN, tx_errors), 0ull);
	KUNIT_EXPECT_GE(test, counted(p, EC_BACKUP, tx_errors), 10ull);
	KUNIT_EXPECT_EQ(test, counted(p, EC_BACKUP, tx_errors) + counted(p, EC_BACKUP, tx_frames),
			counted(p, EC_MAIN, tx_frames));
	expect_counts(p, EC_MAIN, 0, 0);
	expect_counts(p, EC_BACKUP, 0, 0);
}

static void cycle_links_backup_full(struct kunit *test)
{
	backup_refuses(test, true, 0);
}

static void cycle_links_backup_busy(struct kunit *test)
{
	backup_refuses(test, false, -EBUSY);
}

static void cycle_links_backup_fails(struct kunit *test)
{
	backup_refuses(test, false, -EIO);
}

static void cycle_links_no_copy(struct kunit *test)
{
	struct pair *p = pair_by_hand(test);
	u32 i;

	for (i = 1; i <= 8; i++) {
		send(p);
		usleep_range(6000, 6001);
		receive(p);
		expect_data(p, false, i, 0x11);
	}
	/* older than 20 ms: the sends 2 to 6 */
	KUNIT_EXPECT_EQ(test, bus_n_flight(p->b), 3u);
	expect_counts(p, EC_MAIN, 5, 0);
	expect_counts(p, EC_BACKUP, 5, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(cycle_links_both_copies_come),
	KUNIT_CASE(cycle_links_no_copy_of_backup),
	KUNIT_CASE(cycle_links_no_copy_of_main),
	KUNIT_CASE(cycle_links_copy_between_receives),
	KUNIT_CASE(cycle_links_late_link_is_heard_again),
	KUNIT_CASE(cycle_links_one_copy_without_send),
	KUNIT_CASE(cycle_links_crossed_copy_is_whole),
	KUNIT_CASE(cycle_links_copy_after_next_send),
	KUNIT_CASE(cycle_links_oldest_given_up),
	KUNIT_CASE(cycle_links_backup_withdrawn),
	KUNIT_CASE(cycle_links_backup_full),
	KUNIT_CASE(cycle_links_backup_busy),
	KUNIT_CASE(cycle_links_backup_fails),
	KUNIT_CASE(cycle_links_no_copy),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_cycle_links", .exit = pair_exit, .test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
