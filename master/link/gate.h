/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers that use a link: a limited number of places with a queue, and who watches the link. */
#ifndef EC_GATE_H
#define EC_GATE_H

#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/types.h>

/**
 * struct ec_gate - callers of a link; first come, first served
 * @lock: protects the other fields
 * @limit: places
 * @used: places that are taken
 * @waiting: callers that wait for one, the oldest first
 * @watching: &struct ec_watcher; the first one looks at the link each millisecond
 */
struct ec_gate {
	raw_spinlock_t lock;
	unsigned int limit;
	unsigned int used;
	struct list_head waiting;
	struct list_head watching;
};

void ec_gate_init(struct ec_gate *g, unsigned int limit);
void ec_gate_set_limit(struct ec_gate *g, unsigned int limit);
bool ec_gate_try(struct ec_gate *g);
int ec_gate_enter(struct ec_gate *g, unsigned int timeout_ms);
void ec_gate_leave(struct ec_gate *g);

#endif
