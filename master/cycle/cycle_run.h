/* SPDX-License-Identifier: GPL-2.0-only */
/* A cycle that the kernel runs, as the files that run it see it. */
#ifndef EC_CYCLE_RUN_H
#define EC_CYCLE_RUN_H

#include <linux/completion.h>
#include <linux/hrtimer.h>
#include <linux/notifier.h>
#include <linux/types.h>
#include "../config/domain.h"
#include "cycle.h"
#include "pll.h"

struct task_struct;

/** struct ec_cycle_ops - what the thread reports to higher layers; each may be NULL */
struct ec_cycle_ops {
	/** @cycle: a cycle begins; RT-safe, also in hard interrupt */
	void (*cycle)(struct ec_cycle *c);
};

/* a domain that is not sent in each cycle */
struct ec_cycle_slow {
	u32 domain;
	s32 left;	/* cycles until its turn */
	s32 division;
};

/**
 * struct ec_cycle_thread - @cycle, @outputs and sizes are immutable; what a cycle changes
 * belongs to the thread, or to the interrupt while @timed
 */
struct ec_cycle_thread {
	/** @cycle: active cycle; its session ends the thread before it is freed */
	struct ec_cycle *cycle;
	/** @ops: reports to higher layers */
	const struct ec_cycle_ops *ops;
	/** @task: thread */
	struct task_struct *task;
	/** @outputs: areas that are taken from the application */
	struct ec_domain_area *outputs;
	/** @n_outputs: entries in @outputs */
	unsigned int n_outputs;
	/** @always: domains of each cycle, bit n: domain n */
	u64 always;
	/** @slow: the others */
	struct ec_cycle_slow slow[EC_MAX_DOMAINS];
	/** @n_slow: entries in @slow */
	unsigned int n_slow;
	/** @bytes: of the image of all domains */
	u32 bytes;
	/** @stride: distance of two buffers in the exchange */
	u32 stride;
	/** @next_ns: schedule of the next cycle (ktime) */
	u64 next_ns;
	/** @epoch_ns: initial application time less ktime, ns */
	u64 epoch_ns;
	/** @lock: application time; synchronizes the cycle to the reference clock */
	struct ec_pll lock;
	/** @front: output buffer that the cycle holds */
	u8 front;
	/** @given: @front is from the application, and its outputs are still valid */
	bool given;
	/** @ahead: outputs of @front are not in the image */
	bool ahead;
	/** @steady: cycles in a row whose working counters were complete, up to STEADY */
	u32 steady;
	/** @back: input buffer that the cycle holds */
	u8 back;
	/** @fed: the application has given outputs at least once */
	bool fed;
	/** @kept: the master gives the outputs, when some are set */
	bool kept;
	/** @unfed: cycles without new outputs in a row */
	u32 unfed;
	/** @stalls: rate of the events of output stalls */
	struct ec_event_rate stalls;
	/** @stall_told: the present output stall is an event */
	bool stall_told;
	/**
	 * @adopt: 1: another application is to get the buffers; the cycle takes the request, or
	 * the caller withdraws it, by changing this to 0
	 */
	u32 adopt;
	/** @adopted: it has them: the cycle has taken the request and is done */
	struct completion adopted;
	/** @timer: runs cycles in its interrupt */
	struct hrtimer timer;
	/**
	 * @timed: @timer runs the cycles; until it is false the thread does not touch what they use
	 */
	bool timed;
	/** @polled: the interrupt requests that the thread wakes callers of poll() */
	bool polled;
	/** @ended: the last cycle was run in the interrupt */
	bool ended;
	/** @stopped: by @panic */
	bool stopped;
	/** @end_ns: end of the last cycle (ktime) */
	u64 end_ns;
	/** @tight: cycles in a row that ended in the second half of their period */
	u32 tight;
	/** @in_thread: cycles that have to run in the thread */
	u32 in_thread;
	/** @panic: notifier of a kernel panic, which stops @timer */
	struct notifier_block panic;
};

static inline struct ec_status_cycle *ec_cycle_run_status(const struct ec_cycle_thread *t)
{
	return &t->cycle->shared->status->kernel;
}

static inline struct ec_exchange *ec_cycle_run_exchange(const struct ec_cycle_thread *t)
{
	return t->cycle->shared->exchange;
}

static inline struct ec_exchange_buffer *ec_cycle_run_buffer(const struct ec_cycle_thread *t,
							     unsigned int n)
{
	return t->cycle->shared->exchange + EC_EXCHANGE_FIRST + n * t->stride;
}

/**
 * ec_cycle_thread_task() - the thread that runs the cycle
 * @c: cycle
 *
 * Context: lock of the configuration held.
 * Return: thread; NULL when the application runs the cycle.
 */
static inline struct task_struct *ec_cycle_thread_task(const struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	return c->thread ? c->thread->task : NULL;
}

void ec_cycle_run_give(struct ec_cycle *c, u32 *buffer, const u8 *image);
void ec_cycle_run_deal(struct ec_cycle_thread *t);
bool ec_cycle_run_once(struct ec_cycle_thread *t, bool entered);
void ec_cycle_run_wake(struct ec_cycle *c, bool atomic);
void ec_cycle_run_end(struct ec_cycle *c);

#endif
