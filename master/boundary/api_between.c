// SPDX-License-Identifier: GPL-2.0-only
/*
 * Acyclic frames between two cycles of an application in the kernel: with
 * ecrt_master_callbacks() a thread of the master sends and receives between the calls of
 * the application. It calls both hooks only while the session is active, so a module may
 * be removed once it has deactivated the master.
 */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/sched.h>
#include "api.h"

#define LOOK_US	50	/* between two polls for replies */

void ecrt_master_callbacks(ec_master_t *master, void (*send_cb)(void *),
			   void (*receive_cb)(void *), void *cb_data)
{
	if (!master)
		return;
	if (!master->api->reserved || READ_ONCE(master->api->active)) {
		ec_err(master,
		       "kernel API: callbacks are set between ecrt_request_master() and ecrt_master_activate()\n");
		return;
	}
	master->api->send_cb = send_cb;
	master->api->receive_cb = receive_cb;
	master->api->cb_data = cb_data;
}
EXPORT_SYMBOL_GPL(ecrt_master_callbacks);

/* Do posts wait for the cycle? It may be sending them now. */
static bool left(const struct ec_master *m)
{
	return ec_carry_has_left(&m->carry);
}

/* Do posts wait or are they in flight, with cyclic access? Then the hooks have to be called. */
static bool awaited(const struct ec_master *m)
{
	return ec_carry_is_busy(&m->carry) &&
	       READ_ONCE(m->links.access.mode) == EC_ACCESS_CYCLIC;
}

static int between(void *data)
{
	struct ec_master *m = data;
	struct ec_api *api = m->api;

	while (!kthread_should_stop()) {
		wait_event_idle(api->between_wq,
				(left(m) && awaited(m)) || kthread_should_stop());
		while (!kthread_should_stop() && awaited(m)) {
			if (left(m))
				api->send_cb(api->cb_data);
			usleep_range(LOOK_US, LOOK_US + LOOK_US / 5);
			api->receive_cb(api->cb_data);
		}
	}
	return 0;
}

/**
 * ec_api_between_start() - begin to call the hooks of the application
 * @m: master that has just become active; nothing happens without both hooks, or when
 *	the kernel runs the cycle
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_api_between_start(struct ec_master *m)
{
	struct ec_api *api = m->api;
	struct task_struct *t;

	if (!api->send_cb || !api->receive_cb || api->cycle.exchange)
		return 0;
	t = kthread_create(between, m, "EtherCAT%u-btw", m->base->index);
	if (IS_ERR(t))
		return PTR_ERR(t);
	/* before it runs: ec_api_is_between() */
	WRITE_ONCE(api->between, t);
	wake_up_process(t);
	return 0;
}

/**
 * ec_api_between_stop() - call the hooks no more
 * @m: master
 *
 * Context: Process. Waits for a hook that is being called.
 */
void ec_api_between_stop(struct ec_master *m)
{
	struct task_struct *t = m->api->between;

	if (!t)
		return;
	kthread_stop(t);
	WRITE_ONCE(m->api->between, NULL);
}

/**
 * ec_api_is_between() - is this call made by a hook?
 * @api: application
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_api_is_between(const struct ec_api *api)
{
	return READ_ONCE(api->between) == current && in_task();
}

/**
 * ec_api_left() - a post waits for the cycle owner
 * @m: master
 *
 * Context: Process.
 */
void ec_api_left(struct ec_master *m)
{
	if (m->api && READ_ONCE(m->api->between))
		wake_up(&m->api->between_wq);
}
