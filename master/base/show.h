/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Read-only commands look at the session and the table of slaves without a lock.
 *
 * A reader's section cannot be preempted and is short, so a thread of any priority
 * leaves it at once. Who changes what readers look at announces that: readers that
 * come later wait outside, and the few in a section are waited for. So a reader
 * delays a change by the time of one section on another CPU, and nothing else.
 */
#ifndef EC_SHOW_H
#define EC_SHOW_H

#include <linux/atomic.h>
#include <linux/lockdep.h>
#include <linux/types.h>

/**
 * struct ec_show - readers and changes of a master
 * @showing: readers in a section
 * @changing: changes in progress: they hold session_lock or topo
 * @changes: changes that are over; wraps
 */
struct ec_show {
	atomic_t showing;
	atomic_t changing;
	atomic_t changes;
};

int ec_show_begin(struct ec_show *show);
void ec_show_end(struct ec_show *show);
int ec_show_pause(struct ec_show *show);

void ec_change_announce(struct ec_show *show);
void ec_change_begin(struct ec_show *show);
void ec_change_end(struct ec_show *show);

#endif
