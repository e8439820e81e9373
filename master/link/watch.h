/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers that wait for frames of a link see soon that it is down. */
#ifndef EC_WATCH_H
#define EC_WATCH_H

#include <linux/completion.h>
#include <linux/list.h>
#include <linux/sched.h>
#include "gate.h"

/**
 * struct ec_watcher - a caller that waits for its frames
 * @list: its place
 * @task: to wake when it becomes the first one
 */
struct ec_watcher {
	struct list_head list;
	struct task_struct *task;
};

void ec_watch_begin(struct ec_gate *g, struct ec_watcher *me);
void ec_watch_end(struct ec_gate *g, struct ec_watcher *me);
bool ec_watch_wait(struct ec_gate *g, const struct ec_watcher *me, struct completion *done,
		   unsigned int us);

#endif
