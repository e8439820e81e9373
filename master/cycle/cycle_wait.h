/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers that wait for the cycle that the kernel runs. */
#ifndef EC_CYCLE_WAIT_H
#define EC_CYCLE_WAIT_H

#include <linux/poll.h>
#include <linux/types.h>

struct ec_cycles;
struct ec_waiters;

__poll_t ec_cycle_thread_poll(const struct ec_cycles *cycles, const void *owner);
int ec_cycle_thread_wait(struct ec_cycles *cycles, const void *owner, struct ec_waiters *w,
			 u64 *cycle, u32 timeout_us);

#endif
