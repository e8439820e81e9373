/* SPDX-License-Identifier: GPL-2.0-only */
/* Posts whose frames a case takes off the wire, and answers as it likes. */
#ifndef EC_BUS_POSTS_H
#define EC_BUS_POSTS_H

#include "bus.h"

#define POSTS		4
#define POSTS_ADP	0x7001	/* station of the first one, which no slave has */

/**
 * struct rig - posts on a bus
 * @b: bus
 * @post: the posts
 * @dg: their datagrams: one, two, one and one
 * @data: of these
 * @ends: how often each has ended
 * @frames: frames taken off the wire, of each link
 * @frame: the last one of each link
 * @len: bytes of it behind the EtherType
 * @again: posts that are sent again when they have ended
 * @real: functions of the device
 * @ops: those with which frames are taken off
 * @backup: a second device, or NULL
 * @refuses: result of its sends
 */
struct rig {
	struct bus *b;
	struct ec_post post[POSTS];
	struct ec_dg dg[POSTS][2];
	u8 data[POSTS][2][8];
	u32 ends[POSTS];
	u32 frames[EC_MAX_LINKS];
	u8 frame[EC_MAX_LINKS][EC_ETH_MAX];
	size_t len[EC_MAX_LINKS];
	u32 again;
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	struct ecdev *backup;
	bool down;
	u8 tx[EC_ETH_MAX];
};

struct rig *rig_new(struct kunit *test);
void rig_two_links(struct rig *r);
void rig_exit(struct kunit *test);
void rig_send(struct rig *r, u32 mask);
void rig_answer(struct rig *r, u8 side);
void rig_give(struct rig *r, u8 side, const u8 *data, size_t len);
void rig_expect(struct rig *r, u32 mask, u32 ends, int err);

#endif
