/* SPDX-License-Identifier: GPL-2.0-only */
/* How posts end: for the files that send their frames. */
#ifndef EC_POST_INT_H
#define EC_POST_INT_H

#include "carry.h"

/* Are posts of this class sent in frames of their own? */
static inline bool ec_post_alone(enum ec_post_class class)
{
	return class == EC_POST_CLOCK || class == EC_POST_TRAIN;
}

/* Are they sent although other callers have used up the frames that may be in flight? */
static inline bool ec_post_first(enum ec_post_class class)
{
	return class == EC_POST_URGENT || class == EC_POST_TRAIN;
}

#define EC_POST_TRIES	4	/* frames of a repeatable datagram, if each is lost */
void ec_post_due(struct ec_carry *c);
void ec_post_refuse(struct ec_carry *c, struct ec_post *post, int err, struct list_head *posts);
void ec_post_finish(struct ec_carry *c, struct list_head *posts);
void ec_post_lost(struct ec_carry *c, struct list_head *posts, int err);

#endif
