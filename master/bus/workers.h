/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Threads that bring slaves to their state. A kernel workqueue would keep all that were ever busy
 * at once for five minutes, each with its stack.
 */
#ifndef EC_WORKERS_H
#define EC_WORKERS_H

#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/workqueue.h>

#define EC_MAX_WORKERS	512

struct ec_base;

/**
 * struct ec_job - what a worker does
 * @run: does it; may sleep
 * @end: after @run, once for each time that ec_workers_queue() has returned true; may free
 *	the job with the last one. NULL: nothing
 * @list: in the queue
 * @queued: to be run, or to be run again
 * @running: a worker runs it
 */
struct ec_job {
	void (*run)(struct ec_job *job);
	void (*end)(struct ec_job *job);
	struct list_head list;
	bool queued;
	bool running;
};

/** struct ec_workers - threads of a master for the jobs of its slaves */
struct ec_workers {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @lock: protects the other members, and those of jobs */
	spinlock_t lock;
	/** @queue: jobs that wait for a worker */
	struct list_head queue;
	/** @queued: jobs in @queue */
	unsigned int queued;
	/** @all: all workers */
	struct list_head all;
	/** @idle: of these the idle ones, the last one that became idle first */
	struct list_head idle;
	/** @n: workers */
	unsigned int n;
	/** @coming: workers that were woken or created, and have yet to check @queue */
	unsigned int coming;
	/** @most: workers at once */
	unsigned int most;
	/** @keep: workers that stay when they are idle */
	unsigned int keep;
	/** @ending: no thread is created any more */
	bool ending;
	/** @manage: creates workers and ends those that have been idle for long */
	struct delayed_work manage;
};

int ec_workers_init(struct ec_workers *ws, struct ec_base *base);
void ec_workers_exit(struct ec_workers *ws);
void ec_workers_need(struct ec_workers *ws, unsigned int most, unsigned int keep);
bool ec_workers_queue(struct ec_workers *ws, struct ec_job *job);

#endif
