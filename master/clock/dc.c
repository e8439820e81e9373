// SPDX-License-Identifier: GPL-2.0-only
/*
 * Distributed clocks: when they are set, by which reference clock, and again if it
 * has failed. dc_job.c measures, dc_set.c sets and compensates.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include "dc_job.h"
#include "../base/once64.h"

#define BOOST		16000	/* comparisons left to the cycle */
#define APP_WAIT_MS	2000	/* for the first time an application's cycle tells */
#define APP_CYCLES	20	/* or for so many that tell none */
#define APP_MEDIAN	5	/* cycles that tell it: one of them may be late */
#define TRIES		20	/* to set the clocks while frames are lost */
#define TRY_MS		50	/* between them */

static void set_ref(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	struct ec_slave *old, *ref = j->ref < j->n ? ec_slave_ref(j->slaves[j->ref]) : NULL;

	down_write(&j->dc->bus->topo);
	ec_change_begin(&j->dc->base->show);
	old = dc->ref;
	dc->ref = ref;
	WRITE_ONCE(dc->ref_wide, ref && ec_slave_features(ref) & EC_FEAT_DC64);
	WRITE_ONCE(dc->front, ref && ec_dc_has_front(j));
	WRITE_ONCE(dc->ref_station, ref ? ref->station : 0);
	ec_change_end(&j->dc->base->show);
	up_write(&j->dc->bus->topo);
	if (old)
		ec_slave_unref(old);
}

/* Receive times no cables make are worth a line. */
static void tell_odd(const struct ec_dc_job *j)
{
	unsigned int i, n = 0, first = 0;

	for (i = j->n; i-- > 0;)
		if (j->nodes[i].odd) {
			first = i;
			n++;
		}
	if (n)
		ec_slave_warn(j->slaves[first],
			      "receive times of this and %u more slave(s) contradict the topology; delays unreliable: check cables, then rescan\n",
			      n - 1);
}

/**
 * ec_dc_measure() - find the reference clock and the propagation delays
 * @dc: clocks
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ENXIO without clocks; -EAGAIN when the bus has changed; -ENOMEM;
 * or as ec_xfer().
 */
int ec_dc_measure(struct ec_dc *dc)
{
	unsigned int try;
	struct ec_dc_job j;
	int ret = ec_dc_job_init(&j, dc);

	if (ret)
		return ret;
	mutex_lock(&dc->lock);
	for (try = 0; try < j.n; try++)
		ec_job_clock(&j, try)->measured = 0;
	ret = -EAGAIN;
	for (try = 0; j.ref < j.n && ret == -EAGAIN && try <= EC_DC_OUT_TRIES; try++) {
		ret = ec_dc_get_delays(&j);
		if (ret == -EAGAIN)
			ec_dc_leave_out(&j);
	}
	if (j.ref == j.n)
		ret = -ENXIO;
	if (ret)
		j.ref = j.n;
	else
		tell_odd(&j);
	set_ref(&j);
	mutex_unlock(&dc->lock);
	ec_dc_job_free(&j);
	return ret;
}

/*
 * Applications may tell quite another time in their cycle than before activation.
 * Their first cycle is awaited, so that the clocks begin with what they go on with. The
 * cycle wakes no thread of the master, so these waits poll.
 */
static void await_time(struct ec_dc *dc, u64 since)
{
	u32 polls = READ_ONCE(dc->links->access.polls);
	unsigned int i;

	for (i = 0; i < 500; i++) {
		if (!READ_ONCE(dc->has_phase) || READ_ONCE(dc->stop) ||
		    READ_ONCE(dc->wanted) ||
		    (s64)(ec_read64(&dc->app_ktime) - since) >= 0 ||
		    READ_ONCE(dc->links->access.polls) - polls >= 3)
			return;
		usleep_range(900, 1100);
	}
}

static void set_state(struct ec_dc *dc, int state)
{
	WRITE_ONCE(dc->state, state);
	wake_up_all(&dc->wq);
}

/*
 * The time an application tells before its cycle runs may be of another decade
 * than those of the cycle: the clocks shall have the latter.
 */
static void await_cycle(struct ec_dc *dc)
{
	u32 polls = READ_ONCE(dc->links->access.polls);
	unsigned int ms;

	WRITE_ONCE(dc->idle, true);
	for (ms = 0; ms < APP_WAIT_MS && !READ_ONCE(dc->told) && !READ_ONCE(dc->stop) &&
	     READ_ONCE(dc->links->access.polls) - polls < APP_CYCLES; ms++)
		usleep_range(1000, 1100);
	polls = READ_ONCE(dc->links->access.polls);
	for (; ms < APP_WAIT_MS && READ_ONCE(dc->told) && !READ_ONCE(dc->stop) &&
	     READ_ONCE(dc->links->access.polls) - polls < APP_MEDIAN - 1; ms++)
		usleep_range(1000, 1100);
	WRITE_ONCE(dc->idle, false);
}

/* Another reference than before, or none, is worth a line. */
static void tell_ref(const struct ec_dc_job *j, bool lost)
{
	struct ec_dc *dc = j->dc;
	u16 choice = READ_ONCE(dc->choice);
	u16 now = READ_ONCE(dc->ref_station), at = now ? j->slaves[j->ref]->position : 0;

	if (!now)
		ec_warn(dc, "reference clock lost: clocks run free\n");
	else if (choice != EC_DC_ANY && choice != now)
		ec_warn(dc, "reference clock lost: slave %u substitutes until it returns\n", at);
	else if (lost)
		ec_warn(dc, "reference clock lost: slave %u is the new reference clock\n", at);
	else
		ec_info(dc, "slave %u is the new reference clock\n", at);
}

static void change_ref(struct ec_dc_job *j, bool found)
{
	struct ec_dc *dc = j->dc;
	u16 before = READ_ONCE(dc->ref_station), now;
	bool lost = before && dc->ref && READ_ONCE(dc->ref->stop.gone);

	if (found)
		set_ref(j);
	else	/* until it is back or the session ends; the bus has not lost it */
		WRITE_ONCE(dc->ref_station, 0);
	now = READ_ONCE(dc->ref_station);
	if (!dc->fresh && before != now)
		tell_ref(j, lost);
}

static bool passes(int ret)
{
	return ret == -EAGAIN || ret == -ETIMEDOUT || ret == -EBUSY;
}

/*
 * Frames may be lost, and slaves may be busy with leaving or coming. Until a new
 * reference clock is set, the cycle goes on with the one before.
 */
static int set(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	unsigned int try;
	int ret = -ENXIO;

	if (j->ref == j->n)
		change_ref(j, false);
	for (try = 0; j->ref < j->n && try < TRIES; try++) {
		ret = ec_dc_get_delays(j) ?: ec_dc_latch(j) ?: ec_dc_write(j);
		if (!ret)
			change_ref(j, true);
		if (!passes(ret) || READ_ONCE(dc->stop))
			break;
		if (ret == -EAGAIN)
			ec_dc_leave_out(j);
		ec_dc_correct_between(j, ~0, TRY_MS);
	}
	if (j->ref < j->n || !try)
		return ret;
	/* the only one there may be does not answer */
	change_ref(j, false);
	return -ENXIO;
}

static void work(struct work_struct *work)
{
	struct ec_dc *dc = container_of(work, struct ec_dc, work);
	unsigned int i;
	struct ec_dc_job j;
	bool was;
	u64 t0;
	int ret;

	if (dc->fresh)
		await_cycle(dc);
	if (READ_ONCE(dc->stop))
		return;
	t0 = ktime_get_ns();
	ret = ec_dc_job_init(&j, dc);
	if (ret) {
		set_state(dc, EC_DC_OFF);
		return;
	}
	if (j.ref < j.n && !ec_clock_is_set(j.slaves[j.ref]))
		await_time(dc, t0);
	if (READ_ONCE(dc->stop)) {
		ec_dc_job_free(&j);
		return;
	}
	mutex_lock(&dc->lock);
	was = READ_ONCE(dc->running);
	j.running = was;
	WRITE_ONCE(dc->running, false);
	ret = set(&j);
	ec_write64(&dc->begun_ns, ktime_get_ns());
	/* those that were set before need the cycle in any case */
	WRITE_ONCE(dc->running, !ret || (was && ret != -ENXIO));
	WRITE_ONCE(dc->boost, ret ? 0 : BOOST);
	ret = ret ?: ec_dc_near(&j) ?: ec_dc_check(&j);
	mutex_unlock(&dc->lock);
	if (!ret)
		ec_info(dc,
			"distributed clocks synchronized in %llu us, reference clock: slave %u\n",
			div_u64(ktime_get_ns() - t0, 1000), j.slaves[j.ref]->position);
	else if (ret != -ENXIO && ret != -ECANCELED)
		ec_warn(dc, "distributed clocks not synchronized (%pe)%s\n", ERR_PTR(ret),
			passes(ret) ? "; retrying" : "");
	if (ret) {
		WRITE_ONCE(dc->boost, 0);
		WRITE_ONCE(dc->framed, false);
	}
	WRITE_ONCE(dc->failed, passes(ret));
	set_state(dc, ret ? EC_DC_OFF : EC_DC_READY);
	/* ec_dc_sync_start() has the other half of this barrier */
	smp_mb();
	for (i = 0; !ret && i < j.n; i++)
		if (ec_clock_is_set(j.slaves[i]))
			ec_dc_sync_again(j.slaves[i]);
	if (!ret)
		ec_dc_settle(&j);
	ec_dc_job_free(&j);
}

static void stop(struct ec_dc *dc)
{
	WRITE_ONCE(dc->stop, true);
	cancel_work_sync(&dc->work);
	ec_dc_watch_stop(dc);
}

/**
 * ec_dc_begin() - set the clocks of a session, or of slaves that join it
 * @dc: clocks
 * @all: all of them, from the application's time; else only new ones, from the
 *	reference clock
 * @choice: station address of the reference clock, or EC_DC_ANY...
 *
 * Context: Process. May sleep.
 */
void ec_dc_begin(struct ec_dc *dc, bool all, u16 choice)
{
	unsigned int i;

	stop(dc);
	down_read(&dc->bus->topo);
	for (i = 0; all && i < dc->bus->n_slaves; i++) {
		struct ec_clock *c = ec_clock_of(dc->bus->slaves[i]);

		WRITE_ONCE(c->set, false);
		c->failed_attempts = 0;
	}
	up_read(&dc->bus->topo);
	WRITE_ONCE(dc->stop, false);
	if (all)
		ec_dc_app_set(dc, 0, false);
	/* that of the application before is none of this one */
	if (all && !ec_dc_can_be(dc, choice))
		WRITE_ONCE(dc->ref_station, 0);
	/* who joins before the application has told its time does not set another one */
	dc->fresh = all || (dc->fresh && !dc->app.set);
	ec_dc_watch_begun(dc);
	WRITE_ONCE(dc->told, false);
	WRITE_ONCE(dc->choice, choice);
	dc->begun = true;
	if (all)
		dc->far_told = false;
	set_state(dc, EC_DC_BUSY);
	queue_work(dc->service, &dc->work);
	ec_dc_watch_start(dc);
}

/**
 * ec_dc_end() - the session ends: its phase means nothing any more
 * @dc: clocks
 *
 * Context: Process. May sleep.
 */
void ec_dc_end(struct ec_dc *dc)
{
	unsigned long flags;

	stop(dc);
	WRITE_ONCE(dc->running, false);
	raw_spin_lock_irqsave(&dc->time_lock, flags);
	dc->has_phase = false;
	ec_write64(&dc->app_time, 0);
	dc->choice = EC_DC_ANY;
	dc->begun = false;
	dc->wanted = false;
	dc->again = false;
	dc->failed = false;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	ec_dc_app_set(dc, 0, false);
	down_read(&dc->bus->topo);
	WRITE_ONCE(dc->ref_station, dc->ref ? dc->ref->station : 0);
	up_read(&dc->bus->topo);
	set_state(dc, EC_DC_OFF);
}

/**
 * ec_dc_init() - prepare the clocks of a master
 * @dc: zeroed structure
 * @base: of the master
 * @links: way to the slaves
 * @bus: slaves
 * @service: queue for short work
 *
 * Context: Process.
 */
void ec_dc_init(struct ec_dc *dc, struct ec_base *base, struct ec_links *links, struct ec_bus *bus,
		struct workqueue_struct *service)
{
	dc->base = base;
	dc->links = links;
	dc->bus = bus;
	dc->service = service;
	bus->ext[EC_EXT_CLOCK] = dc;
	mutex_init(&dc->lock);
	INIT_WORK(&dc->work, work);
	ec_dc_watch_init(dc);
	init_waitqueue_head(&dc->wq);
	raw_spin_lock_init(&dc->time_lock);
}

/**
 * ec_dc_exit() - end all work on the clocks
 * @dc: clocks; no session uses them
 *
 * Context: Process. May sleep.
 */
void ec_dc_exit(struct ec_dc *dc)
{
	stop(dc);
	if (dc->ref)
		ec_slave_unref(dc->ref);
	dc->ref = NULL;
}
