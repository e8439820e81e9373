/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers that wait for frames of a link see soon that it is down. */
#ifndef EC_WATCH_H
#define EC_WATCH_H

#include <linux/completion.h>
#include <linux/list.h>
#include <linux/sched.h>
#include <linux/spinlock.h>

/**
 * struct ec_watch - callers that wait for frames of a link
 * @lock: protects @waiting
 * @waiting: &struct ec_watcher; the first one looks at the link each millisecond
 */
struct ec_watch {
	raw_spinlock_t lock;
	struct list_head waiting;
};

/**
 * struct ec_watcher - one of them
 * @list: its place
 * @task: to wake when it becomes the first one
 */
struct ec_watcher {
	struct list_head list;
	struct task_struct *task;
};

void ec_watch_init(struct ec_watch *w);
void ec_watch_begin(struct ec_watch *w, struct ec_watcher *me);
void ec_watch_end(struct ec_watch *w, struct ec_watcher *me);
bool ec_watch_wait(struct ec_watch *w, const struct ec_watcher *me, struct completion *done,
		   unsigned int us);

#endif
