/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Which slave of one bus is which of another one. */
#ifndef ECB_MATCH_H
#define ECB_MATCH_H

#include "internal.h"

#define NO_SLAVE	SIZE_MAX

/* a side: slaves in the order of the bus */
struct side {
	struct ecb_slave *const *slaves;
	size_t count;
	size_t *peer;		/* index on the other side, or NO_SLAVE */
	size_t *parent;		/* index on this side, or NO_SLAVE */
	size_t *up;		/* of match_parent() */
	unsigned int *up_port;
	size_t *path;
	bool placed;		/* parents are known */
};

struct match {
	struct side a;		/* expected */
	struct side b;		/* found */
};

/* 0 or -ENOMEM; match_free() in any case */
int match_slaves(struct match *m, const struct ecb_master *a, const struct ecb_master *b,
		 bool by_name);
void match_free(struct match *m);
/* of match_slaves(): the nearest slave upstream that has a peer, and the port there */
size_t match_parent(const struct side *s, size_t i, unsigned int *port);

static inline bool same_identity(const struct ecb_slave *a, const struct ecb_slave *b)
{
	return a->vendor == b->vendor && a->product == b->product;
}

#endif
