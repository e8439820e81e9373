/* SPDX-License-Identifier: GPL-2.0-only */
/* A cycle that a thread of the kernel runs. */
#ifndef EC_CYCLE_THREAD_H
#define EC_CYCLE_THREAD_H

#include <linux/poll.h>
#include <linux/types.h>

struct ec_cycles;
struct ec_cycle;
struct ec_waiters;
struct task_struct;

#define EC_CYCLE_PRIORITY	50	/* SCHED_FIFO, when none is configured */

/** struct ec_cycle_ops - what the thread reports to higher layers; each may be NULL */
struct ec_cycle_ops {
	/** @cycle: a cycle begins; RT-safe, also in hard interrupt */
	void (*cycle)(struct ec_cycle *c);
};

int ec_cycle_thread_create(struct ec_cycle *c, u32 image_bytes, const struct ec_cycle_ops *ops);
void ec_cycle_thread_start(struct ec_cycle *c);
struct task_struct *ec_cycle_thread_task(const struct ec_cycle *c);
void ec_cycle_thread_stop(struct ec_cycle *c);
bool ec_cycle_thread_ended(const struct ec_cycle *c);
int ec_cycle_thread_adopt(struct ec_cycle *c);
void ec_cycle_thread_outputs(const struct ec_cycle *c, u8 *image, u32 offset, u32 size);

/* cycle_wait.c */
__poll_t ec_cycle_thread_poll(const struct ec_cycles *cycles, const void *owner);
int ec_cycle_thread_wait(struct ec_cycles *cycles, const void *owner, struct ec_waiters *w,
			 u64 *cycle, u32 timeout_us);

/* cycle_sched.c */
void ec_cycle_sched_set(const struct ec_cycle *c, struct task_struct *task);
void ec_cycle_sched_log(const struct ec_cycle *c);
void ec_cycle_sched_log_place(struct ec_cycle *c);
void ec_cycle_thread_inherit(struct ec_cycle *c, u32 priority, bool may_interrupt);
void ec_cycle_thread_check_cpu(struct ec_cycle *c);

#endif
