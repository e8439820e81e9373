// SPDX-License-Identifier: GPL-2.0-only
/*
 * The cycle of an application in the kernel. It may run where nothing may sleep,
 * so it does not take the mutex of a process' cycle: it enters the links, or the call
 * fails. Deactivation waits for a caller that has entered them.
 */
#include <linux/sched.h>
#include "../../lib/ecrt/ecrt_int.h"
#include "../cycle/receive.h"
#include "../cycle/send.h"
#include "../link/device.h"
#include "../session/reserve.h"

/* May the devices be used in the present context? */
static bool place_is_right(const struct ec_links *l)
{
	if (!ec_links_need_thread(l))
		return true;
	if (IS_ENABLED(CONFIG_PREEMPT_RT))
		return preemptible();
	return !in_hardirq() && !irqs_disabled();
}

static void leave_to_work(struct ec_master *m)
{
	queue_work(m->sessions.service, &m->api->work);
}

/*
 * Enter the links of an active session. On failure nothing is entered: -EINVAL not
 * active, -ENODEV, -EWOULDBLOCK the device needs a thread, -EBUSY, -EAGAIN.
 */
static int api_cycle_enter(struct ec_master *m, struct ec_session **s)
{
	struct ec_api *api;
	int ret;

	if (!m)
		return -EINVAL;
	api = m->api;
	*s = ec_api_session(api);
	if (!*s)
		return -EINVAL;
	/* the thread of the kernel cycle uses the links */
	if (api->cycle.exchange)
		return -EBUSY;
	/* no reason to make the access cyclic again */
	if (!ec_links_attached(&m->links))
		return -ENODEV;
	ret = ec_access_try_enter(&m->links);
	if (ret) {
		if (ret == -EAGAIN)
			leave_to_work(m);
		return ret;
	}
	if (!ec_links_attached(&m->links))
		ret = -ENODEV;
	else if (READ_ONCE(m->cycles.active) != &(*s)->cycle)
		ret = -EINVAL;
	else if (!place_is_right(&m->links))
		ret = -EWOULDBLOCK;
	if (!ret)
		return 0;
	ec_links_leave(&m->links);
	if (ret == -EWOULDBLOCK && !READ_ONCE(api->atomic)) {
		WRITE_ONCE(api->atomic, true);
		leave_to_work(m);
	}
	return ret;
}

/* Receive or send when the kernel runs the cycle. */
static int api_cycle_exchange(struct ec_master *m,
			      int (*fn)(struct ec_master *m, const struct ec_status *st))
{
	const struct ec_status *st;
	int ret;

	if (atomic_cmpxchg(&m->api->busy, 0, 1))
		return -EBUSY;
	/* read again with @busy set: deactivation waits for that call */
	st = ec_active_status(m);
	ret = st ? fn(m, st) : -EINVAL;
	atomic_set_release(&m->api->busy, 0);
	return ret;
}

int ecrt_master_receive(ec_master_t *master)
{
	struct ec_session *s;
	int ret;

	if (ec_run_by_kernel(master))
		return api_cycle_exchange(master, ec_exchange_receive);
	ret = api_cycle_enter(master, &s);
	if (ret)
		return ret;
	if (ec_api_is_between(master->api)) {
		/* for callers that wait; process data belong to the cycle */
		ec_links_poll(&master->links);
	} else {
		ret = ec_cycle_do_receive(&s->cycle);
	}
	ec_links_leave(&master->links);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_receive);

int ecrt_master_send(ec_master_t *master)
{
	struct ec_ioc_send *next;
	struct ec_session *s;
	int ret;

	if (ec_run_by_kernel(master))
		return api_cycle_exchange(master, ec_exchange_send);
	ret = api_cycle_enter(master, &s);
	if (ret)
		return ret;
	next = &master->api->cycle.next;
	if (READ_ONCE(master->api->cycle.started) && xchg(&master->api->cycle.started, 0))
		ec_requests_kick(s);
	ret = ec_cycle_take_request(&s->cycle, next) ?: ec_cycle_do_send(&s->cycle, next);
	next->queued = 0;
	next->flags = 0;
	ec_links_leave(&master->links);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_send);

int ecrt_master_send_ext(ec_master_t *master)
{
	struct ec_session *s;
	int ret = api_cycle_enter(master, &s);

	if (ret)
		return ret == -EBUSY ? -EAGAIN : ret;
	ec_share_send_between(&master->carry);
	ec_links_leave(&master->links);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_send_ext);

int ecrt_master_application_time(ec_master_t *master, uint64_t app_time)
{
	struct ec_api *api;

	if (!master)
		return -EINVAL;
	api = master->api;
	if (!READ_ONCE(api->reserved))
		return -EPERM;
	api->cycle.next.app_time = app_time;
	if (READ_ONCE(api->active))
		api->cycle.next.flags |= EC_SEND_FLAG_APP_TIME;
	else
		/* without a cycle no send carries it */
		ec_session_app_time(&master->sessions, app_time);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_application_time);
