/* SPDX-License-Identifier: GPL-2.0-only */
/* How posts end: for the files that send their frames. */
#ifndef EC_POST_INT_H
#define EC_POST_INT_H

#include "carry.h"

#define EC_POST_TRIES	4	/* frames of a repeatable datagram, if each is lost */
void ec_post_due(struct ec_carry *c);
void ec_post_refuse(struct ec_carry *c, struct ec_post *post, int err, struct list_head *posts);
void ec_post_finish(struct ec_carry *c, struct list_head *posts);
void ec_post_lost(struct ec_carry *c, struct list_head *posts, int err);

#endif
