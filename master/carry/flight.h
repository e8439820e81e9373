/* SPDX-License-Identifier: GPL-2.0-only */
/* Posts in one frame: sent together, with a reply or lost together. */
#ifndef EC_FLIGHT_H
#define EC_FLIGHT_H

#include "carry.h"

/** struct ec_flight_room - limits of a frame with several posts */
struct ec_flight_room {
	/** @len: bytes behind the EtherType */
	unsigned int len;
	/** @dgrams: datagrams; 0: the first post is sent alone */
	unsigned int dgrams;
};

/* the next post of a class, NULL: none; with the lock of the posts held */
static inline struct ec_post *ec_flight_first(struct ec_carry *c, enum ec_post_class class)
{
	lockdep_assert_held(&c->lock);
	return list_first_entry_or_null(&c->ready[class], struct ec_post, list);
}

int ec_flight_send(struct ec_carry *c, enum ec_post_class class,
		   const struct ec_flight_room *room, u64 sent_ns);
void ec_flight_end(struct ec_carry *c, const struct ec_slot *slot, struct list_head *posts);
void ec_flight_landed(struct ec_slot *slot);
void ec_flight_land(struct ec_carry *c);

#endif
