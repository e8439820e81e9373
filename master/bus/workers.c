// SPDX-License-Identifier: GPL-2.0-only
#include <linux/kthread.h>
#include <linux/jiffies.h>
#include <linux/slab.h>
#include "../base/base.h"
#include "workers.h"

#define IDLE_S		50	/* after that an idle worker ends; a timer is up to 1/8 late */
#define AGAIN_MS	100	/* after a thread could not be created */

/**
 * struct worker - one thread
 * @ws: of all workers
 * @task: the thread
 * @all: in @ws->all
 * @idle: in @ws->idle, empty: not there
 * @since: when it became idle (jiffies)
 * @ends: it takes no job any more
 */
struct worker {
	struct ec_workers *ws;
	struct task_struct *task;
	struct list_head all;
	struct list_head idle;
	unsigned long since;
	bool ends;
};

static void append(struct ec_workers *ws, struct ec_job *job)
{
	lockdep_assert_held(&ws->lock);
	list_add_tail(&job->list, &ws->queue);
	ws->queued++;
}

/* Jobs wait, and not so many workers are about to look. */
static bool need_more(const struct ec_workers *ws)
{
	lockdep_assert_held(&ws->lock);
	return ws->queued > ws->coming;
}

/* Wake a worker for what was appended, or let one be created. */
static void call_worker(struct ec_workers *ws)
{
	struct worker *w = list_first_entry_or_null(&ws->idle, struct worker, idle);

	lockdep_assert_held(&ws->lock);
	if (!need_more(ws))
		return;
	if (w) {
		list_del_init(&w->idle);
		ws->coming++;
		wake_up_process(w->task);
	} else if (ws->n < ws->most && !ws->ending) {
		mod_delayed_work(system_unbound_wq, &ws->manage, 0);
	}
}

static void run_first(struct ec_workers *ws)
{
	struct ec_job *job = list_first_entry(&ws->queue, struct ec_job, list);

	lockdep_assert_held(&ws->lock);
	list_del(&job->list);
	ws->queued--;
	job->queued = false;
	job->running = true;
	spin_unlock(&ws->lock);
	job->run(job);
	spin_lock(&ws->lock);
	job->running = false;
	/* this worker is the next one to look */
	if (job->queued)
		append(ws, job);
	spin_unlock(&ws->lock);
	if (job->end)
		job->end(job);
	spin_lock(&ws->lock);
}

/* Sleep until a job waits. Return: false: the worker ends without another job. */
static bool be_idle(struct ec_workers *ws, struct worker *w)
{
	lockdep_assert_held(&ws->lock);
	w->since = jiffies;
	/* the last one is the first to be woken, so that those not needed stay idle */
	list_add(&w->idle, &ws->idle);
	if (ws->n > ws->keep && !ws->ending)
		queue_delayed_work(system_unbound_wq, &ws->manage, IDLE_S * HZ);
	for (;;) {
		set_current_state(TASK_IDLE);
		/* one that ends waits for kthread_stop(), which must find it */
		if (kthread_should_stop() || (list_empty(&w->idle) && !w->ends))
			break;
		spin_unlock(&ws->lock);
		schedule();
		spin_lock(&ws->lock);
	}
	__set_current_state(TASK_RUNNING);
	if (!list_empty(&w->idle)) {
		list_del_init(&w->idle);
		ws->coming++;
	}
	return !w->ends;
}

static int worker_main(void *arg)
{
	struct worker *w = arg;
	struct ec_workers *ws = w->ws;

	spin_lock(&ws->lock);
	do {
		ws->coming--;
		while (ws->queued)
			run_first(ws);
	} while (!kthread_should_stop() && be_idle(ws, w));
	spin_unlock(&ws->lock);
	return 0;
}

/* One more, which @coming and @n count already. */
static int create_worker(struct ec_workers *ws)
{
	struct worker *w = kzalloc(sizeof(*w), GFP_KERNEL);

	if (!w)
		return -ENOMEM;
	w->ws = ws;
	INIT_LIST_HEAD(&w->idle);
	w->task = kthread_create(worker_main, w, "EtherCAT%u-slv", ws->base->index);
	if (IS_ERR(w->task)) {
		kfree(w);
		return -ENOMEM;
	}
	spin_lock(&ws->lock);
	list_add(&w->all, &ws->all);
	spin_unlock(&ws->lock);
	wake_up_process(w->task);
	return 0;
}

/* As many as jobs wait. Return: false: a thread could not be created. */
static bool create_all(struct ec_workers *ws)
{
	bool ok = true;

	lockdep_assert_held(&ws->lock);
	while (ok && need_more(ws) && ws->n < ws->most) {
		ws->n++;
		ws->coming++;
		spin_unlock(&ws->lock);
		ok = !create_worker(ws);
		spin_lock(&ws->lock);
		if (!ok) {
			ws->n--;
			ws->coming--;
		}
	}
	return ok;
}

/* Those that have been idle for long. Return: when to look again, jiffies from now; 0: never. */
static unsigned long end_idle(struct ec_workers *ws)
{
	lockdep_assert_held(&ws->lock);
	while (ws->n > ws->keep && !list_empty(&ws->idle)) {
		struct worker *w = list_last_entry(&ws->idle, struct worker, idle);
		unsigned long due = w->since + IDLE_S * HZ;

		if (time_before(jiffies, due))
			return due - jiffies;
		list_del_init(&w->idle);
		list_del(&w->all);
		ws->n--;
		w->ends = true;
		spin_unlock(&ws->lock);
		kthread_stop(w->task);
		kfree(w);
		spin_lock(&ws->lock);
	}
	return 0;
}

static void manage(struct work_struct *work)
{
	struct ec_workers *ws = container_of(to_delayed_work(work), struct ec_workers, manage);
	unsigned long again;

	spin_lock(&ws->lock);
	again = end_idle(ws);
	if (!create_all(ws))
		again = msecs_to_jiffies(AGAIN_MS);
	if (again && !ws->ending)
		mod_delayed_work(system_unbound_wq, &ws->manage, again);
	spin_unlock(&ws->lock);
}

/**
 * ec_workers_init() - the first worker
 * @ws: zeroed structure
 * @base: of the master
 *
 * It stays, so that jobs are done even when no other one can be created.
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM; ec_workers_exit() must follow both.
 */
int ec_workers_init(struct ec_workers *ws, struct ec_base *base)
{
	ws->base = base;
	spin_lock_init(&ws->lock);
	INIT_LIST_HEAD(&ws->queue);
	INIT_LIST_HEAD(&ws->all);
	INIT_LIST_HEAD(&ws->idle);
	INIT_DELAYED_WORK(&ws->manage, manage);
	ws->most = 1;
	ws->keep = 1;
	ws->n = 1;
	ws->coming = 1;
	return create_worker(ws);
}

/**
 * ec_workers_exit() - do all jobs, then end the workers
 * @ws: workers; no other thread queues jobs any more
 *
 * Context: Process. May sleep.
 */
void ec_workers_exit(struct ec_workers *ws)
{
	struct worker *w, *next;

	if (!ws->base)
		return;
	spin_lock(&ws->lock);
	ws->ending = true;
	spin_unlock(&ws->lock);
	cancel_delayed_work_sync(&ws->manage);
	/* alone with @all now */
	list_for_each_entry_safe(w, next, &ws->all, all) {
		kthread_stop(w->task);
		kfree(w);
	}
	INIT_LIST_HEAD(&ws->all);
	/* a thread that is ended before it has run once does nothing */
	spin_lock(&ws->lock);
	while (ws->queued)
		run_first(ws);
	spin_unlock(&ws->lock);
}

/**
 * ec_workers_need() - how many workers there may be and how many stay
 * @ws: workers
 * @most: as many at once from now on, if they were less; EC_MAX_WORKERS at most
 * @keep: as many stay when they are idle, 1 at least
 *
 * Context: Process.
 */
void ec_workers_need(struct ec_workers *ws, unsigned int most, unsigned int keep)
{
	spin_lock(&ws->lock);
	ws->most = max(ws->most, min(most, EC_MAX_WORKERS + 0u));
	ws->keep = max(keep, 1u);
	if (!ws->ending)
		mod_delayed_work(system_unbound_wq, &ws->manage, 0);
	spin_unlock(&ws->lock);
}

/**
 * ec_workers_queue() - let a worker run a job
 * @ws: workers
 * @job: job with @run and @end, zeroed otherwise
 *
 * A job that runs is run once more afterwards, never by two workers at once.
 *
 * Context: Process.
 * Return: false: it waits in the queue already, and its run sees what the caller has written.
 */
bool ec_workers_queue(struct ec_workers *ws, struct ec_job *job)
{
	bool added;

	spin_lock(&ws->lock);
	added = !job->queued;
	job->queued = true;
	if (added && !job->running) {
		append(ws, job);
		call_worker(ws);
	}
	spin_unlock(&ws->lock);
	return added;
}
