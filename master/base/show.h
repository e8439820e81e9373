/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Read-only commands read the session and the table of slaves without a lock.
 *
 * A reader's section cannot be preempted and is short, so a thread of any priority
 * leaves it at once. A writer announces its change: later readers wait outside, and
 * the writer waits for the few in a section. So a reader delays a change by the time
 * of one section on another CPU, and nothing else.
 */
#ifndef EC_SHOW_H
#define EC_SHOW_H

#include <linux/atomic.h>
#include <linux/lockdep.h>
#include <linux/types.h>
#include <linux/wait.h>

/**
 * struct ec_show - readers and changes of a master
 * @showing: readers in a section
 * @changing: changes in progress: they hold session lock or topo
 * @changes: changes that are over; wraps
 * @over: readers that wait until no change is in progress
 */
struct ec_show {
	atomic_t showing;
	atomic_t changing;
	atomic_t changes;
	wait_queue_head_t over;
};

/* Is a reader in a section? For assertions: it may be another one than the caller. */
static inline bool ec_show_begun(const struct ec_show *show)
{
	return atomic_read(&show->showing) > 0;
}

void ec_show_init(struct ec_show *show);
int ec_show_begin(struct ec_show *show);
void ec_show_end(struct ec_show *show);
int ec_show_pause(struct ec_show *show);

void ec_show_change_announce(struct ec_show *show);
void ec_show_change_begin(struct ec_show *show);
void ec_show_change_end(struct ec_show *show);

#endif
