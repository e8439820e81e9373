/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The mailbox transport of a slave. It does not know the users that wait: it asks and reports by
 * the calls in struct ec_box_ops. States and structure are in box_post.h.
 */
#ifndef EC_BOX_H
#define EC_BOX_H

#include "box_post.h"

void ec_box_init(struct ec_box *box, const struct ec_box_ops *ops);

/* with the lock held; ec_box_go() not in a call of struct ec_box_ops: it is called after that */
void ec_box_go(struct ec_box *box);
void ec_box_hurry(struct ec_box *box);
void ec_box_give(struct ec_box *box, u8 type, const u8 *data, u16 len, bool emptying);
void ec_box_discard(struct ec_box *box);
bool ec_box_take_back(struct ec_box *box);
void ec_box_arrived(struct ec_box *box);
int ec_box_message(const struct ec_box *box, struct ec_mbox_hdr *h);
void ec_box_drop(struct ec_box *box);

#endif
