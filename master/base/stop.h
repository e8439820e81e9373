/* SPDX-License-Identifier: GPL-2.0-only */
/* What ends the waits of callers that work on a slave. */
#ifndef EC_STOP_H
#define EC_STOP_H

#include <linux/compiler.h>
#include <linux/sched.h>
#include <linux/wait.h>
#include "base.h"

/** struct ec_stop - why such a caller leaves */
struct ec_stop {
	/** @base: of the master, whose end ends all */
	const struct ec_base *base;
	/** @gone: the slave is not on the bus any more: all callers leave */
	bool gone;
	/** @interrupt: the slave's worker leaves */
	bool interrupt;
	/** @worker: thread that brings the slave to its state now, NULL: none */
	const struct task_struct *worker;
	/** @wake: callers that wait for what one of these ends early */
	wait_queue_head_t wake;
};

static inline void ec_stop_init(struct ec_stop *s, const struct ec_base *base)
{
	s->base = base;
	init_waitqueue_head(&s->wake);
}

/* The slave is not on the bus any more. */
static inline void ec_stop_gone(struct ec_stop *s)
{
	WRITE_ONCE(s->gone, true);
	wake_up_all(&s->wake);
}

/* Let the slave's worker leave, or let it be. */
static inline void ec_stop_interrupt(struct ec_stop *s, bool on)
{
	WRITE_ONCE(s->interrupt, on);
	if (on)
		wake_up_all(&s->wake);
}

/* Must every caller leave? */
static inline bool ec_stop_all(const struct ec_stop *s)
{
	return READ_ONCE(s->gone) || READ_ONCE(s->base->stopping);
}

/* Must the slave's worker leave? */
static inline bool ec_stop_worker(const struct ec_stop *s)
{
	return READ_ONCE(s->interrupt) || ec_stop_all(s);
}

/* Is this thread the worker, and must it leave? Other callers have nothing to do with that. */
static inline bool ec_stop_interrupted(const struct ec_stop *s)
{
	return READ_ONCE(s->interrupt) && READ_ONCE(s->worker) == current;
}

#endif
