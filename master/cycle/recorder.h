/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies of the process data of each cycle for those that record them. */
#ifndef EC_RECORDER_H
#define EC_RECORDER_H

#include <linux/atomic.h>
#include <linux/rcupdate.h>
#include "cycle.h"

/** struct ec_recorder_place - one cycle: this, the states of the domains, one or two images */
struct ec_recorder_place {
	/** @time_ns: of the send, CLOCK_MONOTONIC */
	u64 time_ns;
	/** @app_time_ns: application time */
	u64 app_time_ns;
	/** @cycle: sends since activation */
	u64 cycle;
	/** @sent: domains sent in this cycle, bit n: domain n */
	u64 sent;
	/** @apart: the outputs are in the second image */
	u64 apart;
};

/** struct ec_recorder_part - domains whose images are in one piece */
struct ec_recorder_part {
	/** @domain: the first of them */
	u32 domain;
	/** @offset: where in the image they begin, bytes */
	u32 offset;
	/** @len: bytes, without those behind the last domain */
	u32 len;
};

/** struct ec_recorder_form - what a place of the ring contains */
struct ec_recorder_form {
	/** @image: bytes of all domains, a multiple of 8 */
	u32 image;
	/** @domains: how many */
	u32 domains;
	/** @outputs_at: where in the second image outputs begin, bytes */
	u32 outputs_at;
	/** @outputs: bytes from there to the end of the last output; 0: there is one image only */
	u32 outputs;
	/** @parts: pieces of the image */
	u32 parts;
	/** @part: these */
	struct ec_recorder_part part[EC_MAX_DOMAINS];
};

/** struct ec_recorder - ring of a session; there is one while it has a reader */
struct ec_recorder {
	/** @head: number of the next cycle; written by the cycle owner */
	atomic64_t head;
	/** @first: number of the first one */
	u64 first;
	/** @at: its place; of the cycle owner */
	u8 *at;
	/** @form: of a place; immutable, as are the next three */
	struct ec_recorder_form form;
	/** @stride: bytes of a place */
	u32 stride;
	/** @places: how many there are */
	u32 places;
	/** @end: behind the last place */
	u8 *end;
	/** @ended: the session has ended */
	bool ended;
	/** @users: readers; under the lock of their list */
	u32 users;
	/** @rcu: frees it after the cycle owner */
	struct rcu_head rcu;
	/** @ring: places */
	u8 ring[] __aligned(8);
};

/** struct ec_recorder_run - bytes that a reader wants */
struct ec_recorder_run {
	/** @offset: in the image */
	u32 offset;
	/** @len: how many */
	u32 len:31;
	/** @output: as sent, else as received */
	u32 output:1;
};

/* A pointer and no static key: a reader that begins interrupts no CPU, on which a cycle may run. */
static __always_inline bool ec_recorder_wanted(const struct ec_cycle *c)
{
	return unlikely(rcu_access_pointer(c->cycles->recorder));
}

static inline u64 ec_recorder_head(const struct ec_recorder *r)
{
	return atomic64_read(&r->head);
}

/* One place is that which is being written. */
static inline u32 ec_recorder_kept(const struct ec_recorder *r)
{
	return r->places - 1;
}

void ec_recorder_form(const struct ec_cycle *c, struct ec_recorder_form *f);
struct ec_recorder *ec_recorder_new(const struct ec_recorder_form *f, u64 next);
bool ec_recorder_begin(struct ec_cycle *c, struct ec_recorder *r);
void ec_recorder_leave(struct ec_cycles *cycles, struct ec_recorder *r);
void ec_recorder_end(struct ec_cycle *c);
void ec_recorder_put(const struct ec_cycle *c, u64 sent, u64 now);
bool ec_recorder_get(const struct ec_recorder *r, u64 *at, const struct ec_recorder_run *runs,
		     u32 n, struct ec_record *to);

#endif
