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
 *	belongs to the thread, or to the interrupt while @timed
 * @cycle: active cycle; its session ends the thread before it is freed
 * @ops: reports to higher layers
 * @task: thread
 * @outputs: areas that are taken from the application
 * @n_outputs: entries in @outputs
 * @always: domains of each cycle, bit n: domain n
 * @slow: the others
 * @n_slow: entries in @slow
 * @bytes: of the image of all domains
 * @stride: distance of two buffers in the exchange
 * @next_ns: schedule of the next cycle (ktime)
 * @epoch_ns: initial application time less ktime, ns
 * @lock: application time; synchronizes the cycle to the reference clock
 * @front: output buffer that the cycle holds
 * @given: @front is from the application, and its outputs are still valid
 * @ahead: outputs of @front are not in the image
 * @steady: cycles in a row whose working counters were complete, up to STEADY
 * @back: input buffer that the cycle holds
 * @fed: the application has given outputs at least once
 * @unfed: cycles without new outputs in a row
 * @stalls: rate of the events of output stalls
 * @stall_told: the present output stall is an event
 * @adopt: another application is to get the buffers; cleared when it has them
 * @adopted: completed then
 * @timer: runs cycles in its interrupt
 * @timed: @timer runs the cycles; until it is false the thread does not touch what they use
 * @polled: the interrupt requests that the thread wakes callers of poll()
 * @ended: the last cycle was run in the interrupt
 * @stopped: by @panic
 * @end_ns: end of the last cycle (ktime)
 * @tight: cycles in a row that ended in the second half of their period
 * @in_thread: cycles that have to run in the thread
 * @panic: notifier of a kernel panic, which stops @timer
 */
struct ec_cycle_thread {
	struct ec_cycle *cycle;
	const struct ec_cycle_ops *ops;
	struct task_struct *task;
	struct ec_domain_area *outputs;
	unsigned int n_outputs;
	u64 always;
	struct ec_cycle_slow slow[EC_MAX_DOMAINS];
	unsigned int n_slow;
	u32 bytes;
	u32 stride;
	u64 next_ns;
	u64 epoch_ns;
	struct ec_pll lock;
	u8 front;
	bool given;
	bool ahead;
	u32 steady;
	u8 back;
	bool fed;
	u32 unfed;
	struct ec_event_rate stalls;
	bool stall_told;
	bool adopt;
	struct completion adopted;
	struct hrtimer timer;
	bool timed;
	bool polled;
	bool ended;
	bool stopped;
	u64 end_ns;
	u32 tight;
	u32 in_thread;
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

void ec_cycle_run_deal(struct ec_cycle_thread *t);
bool ec_cycle_run_once(struct ec_cycle_thread *t, bool entered);
void ec_cycle_run_wake(struct ec_cycle *c, bool atomic);
void ec_cycle_run_end(struct ec_cycle *c);

#endif
