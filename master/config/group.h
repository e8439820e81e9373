/* SPDX-License-Identifier: GPL-2.0-only */
/* Hot connect groups: slaves that come and go together, known by their first one. */
#ifndef EC_GROUP_H
#define EC_GROUP_H

#include <linux/types.h>
#include "../include/uapi/ethercat.h"

struct ec_config;
struct ec_slave;
struct ec_wanted;

/**
 * struct ec_group - a hot connect group, under the lock of the session
 * @wanted: owner
 * @index: number there
 * @by: EC_GROUP_BY_*: what its first slave, the head, is known by
 * @value: alias or identification
 * @at: configuration of the slave at whose port the head has to be, NULL: anywhere
 * @port: that port
 * @mandatory: without it the bus is not complete
 * @fast: @port is opened as soon as it has a link
 * @members: their configurations in the order of the ring, the head first
 * @n_members: how many
 * @host: while slaves are marked: the one of @at
 * @left: then: slaves of no group before the place of @at
 * @seen: then: slaves of the group so far, from its last head on
 * @counts: then: @left counts, as the slave with the alias of @at was passed
 * @begun: then: one of its slaves was passed
 * @outer: then: the group in which its first slave was found, NULL: none
 * @head: device number of the head at the last search, 0: there is none that may be used
 * @position: its ring position then, or that of the slave that is in the way
 * @cause: why there is none, EC_CAUSE_*; EC_CAUSE_NONE: the group is on the bus
 * @why: the same in words
 * @logged: @cause that is in the log
 * @name: for messages
 */
struct ec_group {
	struct ec_wanted *wanted;
	u32 index;
	u8 by;
	u16 value;
	struct ec_config *at;
	u8 port;
	bool mandatory;
	bool fast;
	struct ec_config **members;
	unsigned int n_members;
	const struct ec_slave *host;
	u32 left;
	u32 seen;
	bool counts;
	bool begun;
	struct ec_group *outer;
	u64 head;
	u32 position;
	u32 cause;
	char why[EC_UAPI_REASON / 2];
	u32 logged;
	char name[EC_UAPI_STRING];
};

bool ec_group_is_name(const char *name);
struct ec_group *ec_group_create(struct ec_wanted *w, const struct ec_ioc_group *what);
void ec_group_free(struct ec_group *g);
struct ec_config *ec_group_config(struct ec_group *g, u16 member, u32 vendor, u32 product);
void ec_group_drop(struct ec_config *c);
bool ec_group_differs(const struct ec_group *a, const struct ec_group *b);

/* Its slaves may be absent: they are no part of an expected working counter then. */
static inline bool ec_group_is_optional(const struct ec_group *g)
{
	return g && !g->mandatory;
}

/* group_mark.c */
void ec_groups_mark(struct ec_wanted *w);
struct ec_slave *ec_group_neighbor(const struct ec_slave *s, unsigned int port);

/* group_find.c */
bool ec_groups_wait(const struct ec_wanted *w);
u32 ec_groups_place(const struct ec_wanted *w, u16 alias, u16 position, u32 *alias_at);
bool ec_group_find(struct ec_group *g, struct ec_slave **found);

#endif
