// SPDX-License-Identifier: GPL-2.0-only
#include "master/carry/direct.h"
#include "posts.h"

static struct rig *rig;

static u32 number(const struct ec_post *post)
{
	return post - rig->post;
}

static void ended(struct ec_post *post)
{
	u32 i = number(post);

	rig->ends[i]++;
	if (!(rig->again & BIT(i)))
		return;
	rig->again &= ~BIT(i);
	ec_post_send(post, 0);
}

/* Is it one of ours? The monitor sends, too. */
static bool take_off(u8 side, const u8 *buf, size_t len)
{
	const u8 *first = buf + EC_ETH_HDR + EC_FRAME_HDR;
	u16 adp = get_unaligned_le16(first + 2);

	if ((first[0] != EC_CMD_FPRW && first[0] != EC_CMD_BWR) || adp < POSTS_ADP ||
	    adp >= POSTS_ADP + POSTS)
		return false;
	memcpy(rig->frame[side], buf, len);
	rig->len[side] = EC_FRAME_HDR + (get_unaligned_le16(buf + EC_ETH_HDR) & EC_DGRAM_LEN_MASK);
	rig->frames[side]++;
	return true;
}

static int tx_send(void *priv, u8 *buf, size_t len)
{
	return take_off(EC_MAIN, buf, len) ? 0 : rig->real->tx_send(priv, buf, len);
}

/* the second device: nothing is behind it */
static int backup_start(void *priv, struct ecdev *dev)
{
	return 0;
}

static void backup_stop(void *priv)
{
}

static u8 *backup_tx_get(void *priv)
{
	return rig->tx;
}

static int backup_tx_send(void *priv, u8 *buf, size_t len)
{
	if (rig->down)
		return -ENETDOWN;
	take_off(EC_BACKUP, buf, len);
	return 0;
}

static bool backup_link_up(void *priv)
{
	return !rig->down;
}

static const struct ecdev_ops backup_ops = {
	.kind = "test", .atomic = true, .start = backup_start, .stop = backup_stop,
	.tx_get = backup_tx_get, .tx_send = backup_tx_send, .link_up = backup_link_up,
};

/**
 * rig_new() - a bus of one slave whose device hands over the frames of the posts
 * @test: the case
 *
 * Return: the rig.
 */
struct rig *rig_new(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	struct rig *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);
	struct ecdev *dev = bus_dev(b);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	bus_idle(b);
	rig = r;
	r->b = b;
	for (i = 0; i < POSTS; i++) {
		ec_post_init(&r->post[i], bus_links(b), ended);
		r->post[i].dg = r->dg[i];
		r->post[i].n = i == 1 ? 2 : 1;
		r->dg[i][0] = EC_DG(EC_CMD_FPRW, POSTS_ADP + i, 0x1000, 2 + i, r->data[i][0]);
		r->dg[i][1] = EC_DG(EC_CMD_FPRD, POSTS_ADP + i, 0x1100, 5, r->data[i][1]);
		r->dg[i][0].repeat = r->dg[i][1].repeat = false;
	}
	r->real = dev->ops;
	r->ops = *dev->ops;
	r->ops.tx_send = tx_send;
	dev->ops = &r->ops;
	return r;
}

/* Posts go on two links from now on; other frames on the first one. */
void rig_two_links(struct rig *r)
{
	static const u8 mac[ETH_ALEN] = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x77 };
	u32 i;

	for (i = 0; i < EC_SLOTS; i++)
		bus_two_copies(r->b, bus_slot(r->b, i));
	bus_links(r->b)->backup = "bus1";
	r->backup = ecdev_offer("bus1", mac, &backup_ops, NULL);
	KUNIT_ASSERT_FALSE(r->b->test, IS_ERR(r->backup));
	KUNIT_ASSERT_PTR_EQ(r->b->test, bus_link(r->b, EC_BACKUP)->dev, r->backup);
	for (i = 0; i < POSTS; i++)
		r->post[i].sides = BIT(EC_MAIN) | BIT(EC_BACKUP);
}

/* after each case, before bus_exit() */
void rig_exit(struct kunit *test)
{
	struct rig *r = rig;
	u32 i;

	if (r) {
		for (i = 0; i < POSTS; i++)
			ec_post_cancel(&r->post[i]);
		if (bus_dev(r->b))
			bus_dev(r->b)->ops = r->real;
		if (!IS_ERR_OR_NULL(r->backup)) {
			ecdev_withdraw(r->backup);
			bus_links(r->b)->backup = NULL;
			/* the copies are the case's */
			msleep(100);
			for (i = 0; i < EC_SLOTS; i++)
				bus_one_copy(r->b, bus_slot(r->b, i));
		}
	}
	rig = NULL;
	bus_exit(test);
}

/* Send posts so that they leave together: while nobody has the links. */
void rig_send(struct rig *r, u32 mask)
{
	struct ec_links *l = bus_links(r->b);
	u32 i;

	rt_mutex_lock(&l->access.lock);
	for (i = 0; i < POSTS; i++)
		if (mask & BIT(i))
			ec_post_send(&r->post[i], 0);
	rt_mutex_unlock(&l->access.lock);
	ec_direct_push(bus_carry(r->b));
}

/* Each slave writes what it was not sent, and counts; @side is in the bytes. */
void rig_answer(struct rig *r, u8 side)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	u8 k = 0;

	KUNIT_ASSERT_EQ(r->b->test, ec_frame_iter_init(&it, r->frame[side] + EC_ETH_HDR,
						       r->len[side]), 0);
	while (ec_frame_iter_next(&it, &d) == 1) {
		memset(d.data, 0x10 * (side + 1) + k++, d.len);
		ec_dgram_set_wkc(&d, 1);
	}
}

void rig_give(struct rig *r, u8 side, const u8 *data, size_t len)
{
	struct ecdev *dev = side ? r->backup : bus_dev(r->b);

	rcu_read_lock();
	ecdev_receive(dev, r->frame[side] + ETH_ALEN, data, len);
	rcu_read_unlock();
}

/* Posts of @mask have ended so often, all of their datagrams with this result. */
void rig_expect(struct rig *r, u32 mask, u32 ends, int err)
{
	u32 i, k;

	for (i = 0; i < POSTS; i++) {
		if (!(mask & BIT(i)))
			continue;
		KUNIT_EXPECT_EQ_MSG(r->b->test, r->ends[i], ends, "post %u", i);
		for (k = 0; k < r->post[i].n; k++)
			KUNIT_EXPECT_EQ_MSG(r->b->test, r->dg[i][k].err, err, "post %u.%u", i, k);
	}
}
