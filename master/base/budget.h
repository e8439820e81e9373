/* SPDX-License-Identifier: GPL-2.0-only */
/* Memory that an application causes: all of a master's have one limit. */
#ifndef EC_BUDGET_H
#define EC_BUDGET_H

#include <linux/atomic.h>
#include <linux/errno.h>
#include <linux/lockdep.h>
#include <linux/mutex.h>
#include "limits.h"

/** struct ec_budget - memory of one session */
struct ec_budget {
	/** @lock: of the session, immutable; protects @bytes */
	const struct mutex *lock;
	/** @total: bytes of all sessions of the master, and what they have mapped */
	atomic_long_t *total;
	/** @bytes: of this one, without what is mapped */
	size_t bytes;
};

/* Count memory that is allocated already. */
static inline void ec_budget_add(struct ec_budget *b, size_t bytes)
{
	lockdep_assert_held(b->lock);
	atomic_long_add(bytes, b->total);
	b->bytes += bytes;
}

/* That memory is free again. */
static inline void ec_budget_release(struct ec_budget *b, size_t bytes)
{
	lockdep_assert_held(b->lock);
	atomic_long_sub(bytes, b->total);
	b->bytes -= bytes;
}

/**
 * ec_budget_charge() - more memory is about to be allocated
 * @b: budget
 * @bytes: how much
 *
 * Context: Process, with the lock of the session held.
 * Return: 0, or -EDQUOT beyond EC_MAX_SESSION_BYTES; then nothing is counted.
 */
static inline int ec_budget_charge(struct ec_budget *b, size_t bytes)
{
	lockdep_assert_held(b->lock);
	ec_budget_add(b, bytes);
	if (atomic_long_read(b->total) <= EC_MAX_SESSION_BYTES)
		return 0;
	ec_budget_release(b, bytes);
	return -EDQUOT;
}

#endif
