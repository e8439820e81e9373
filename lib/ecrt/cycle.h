/* SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later */
/* The cycle as the application has it; once for libethercat and for ec_master.ko. */
#ifndef EC_ECRT_CYCLE_H
#define EC_ECRT_CYCLE_H

#ifdef __KERNEL__
#include "ethercat.h"
#else
#include <stdbool.h>
#include "../../include/uapi/ethercat.h"
#endif

/**
 * struct ec_app_cycle - state of the cycle owner; only it uses the members, except for @started
 * @next: what the next send does; its application time is the last one
 * @started: a request was started or cancelled since the last send, by any thread
 * @received: domains not processed since the last exchange, bit n: domain n
 * @exchange: of a cycle that the kernel runs; NULL: the application runs its cycle
 * @stride: from one buffer of @exchange to the next, bytes
 * @out_back: output buffer that the application holds
 * @out_last: output buffer that it passed last
 * @unseen: domains of a buffer that no cycle has taken
 * @in_front: input buffer that the application holds
 * @in_taken: @in_front has inputs
 * @seen: last cycle that a thread has waited for; several may wait
 */
struct ec_app_cycle {
	struct ec_ioc_send next;
	__u32 started;
	__u64 received;
	struct ec_exchange *exchange;
	unsigned int stride;
	unsigned int out_back;
	unsigned int out_last;
	__u64 unseen;
	unsigned int in_front;
	bool in_taken;
	__aligned_u64 seen;
};

/* inputs of a domain: @count times @size bytes, each @stride behind the one before */
struct ec_input {
	unsigned int offset;
	unsigned int size;
	unsigned int stride;
	unsigned int count;
};

#endif
