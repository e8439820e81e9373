// SPDX-License-Identifier: GPL-2.0-only
/*
 * Distributed clocks: when they are set, by which reference clock, and again after a failure.
 * dc_delays.c measures, dc_set.c sets and compensates.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include "dc.h"
#include "dc_app.h"
#include "dc_behind.h"
#include "dc_delays.h"
#include "dc_job.h"
#include "dc_set.h"
#include "dc_sync.h"
#include "dc_watch.h"
#include "../base/once64.h"
#include "../base/report.h"

#define EXTRA_DGRAMS	16000	/* of drift compensation by the cycle */
#define LESS_DGRAMS	4400	/* beside clocks in use */
#define APP_WAIT_MS	2000	/* for the first application time of the cycle */
#define APP_CYCLES	20	/* or for so many cycles without one */
#define APP_MEDIAN	5	/* cycles with one: a single cycle may be late */
#define FIRST_CYCLES	8	/* in which the cycle alone compensates clocks in use */
#define FIRST_MS	100	/* or so long */
#define TRIES		20	/* to set the clocks while frames are lost */
#define TRY_MS		50	/* between them */

static void set_ref(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	struct ec_slave *old, *ref = j->ref < j->n ? ec_slave_ref(j->slaves[j->ref]) : NULL;

	down_write(&j->dc->bus->topo);
	ec_show_change_begin(&j->dc->base->show);
	old = dc->ref;
	dc->ref = ref;
	WRITE_ONCE(dc->ref_wide, ref && ec_slave_features(ref) & EC_FEAT_DC64);
	WRITE_ONCE(dc->clocks_upstream, ref && ec_dc_has_upstream(j));
	WRITE_ONCE(dc->ref_station, ref ? ref->station : 0);
	ec_show_change_end(&j->dc->base->show);
	up_write(&j->dc->bus->topo);
	if (old)
		ec_slave_unref(old);
}

static void log_unreliable(const struct ec_dc_job *j)
{
	unsigned int i, n = 0, first = 0;

	for (i = j->n; i-- > 0;)
		if (j->nodes[i].unreliable) {
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
	int ret = ec_dc_job_init(&j, dc, true);

	if (ret)
		return ret;
	mutex_lock(&dc->lock);
	for (try = 0; try < j.n; try++)
		/* those of the closed ring stay where no reference clock is on the way */
		if (j.ref == j.n || (!j.nodes[try].other && !j.nodes[j.ref].other))
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
		log_unreliable(&j);
	set_ref(&j);
	mutex_unlock(&dc->lock);
	ec_dc_job_free(&j);
	return ret;
}

/**
 * ec_dc_is_contradicted() - do receive times contradict the topology?
 * @dc: clocks
 *
 * Context: The monitor thread.
 * Return: whether they do, as measured last.
 */
bool ec_dc_is_contradicted(const struct ec_dc *dc)
{
	ec_for_each_slave(s, dc->bus)
		if (READ_ONCE(ec_clock_of(s)->delay_unreliable))
			return true;
	return false;
}

/*
 * The application time of the cycle may differ a lot from the time before activation. Wait for
 * its first cycle, so that the clocks begin with the time they continue with. The cycle wakes
 * no thread of the master, so these waits poll.
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

/* Poll until the application time has come or not (@seen), for @cycles at most. */
static void await_cycles(struct ec_dc *dc, bool seen, u32 cycles, unsigned int *ms)
{
	u32 polls = READ_ONCE(dc->links->access.polls);

	for (; *ms < APP_WAIT_MS && READ_ONCE(dc->app_time_seen) == seen && !READ_ONCE(dc->stop) &&
	     READ_ONCE(dc->links->access.polls) - polls < cycles; ++*ms)
		usleep_range(1000, 1100);
}

/*
 * The application time before its cycle runs may be decades away from the time in the cycle,
 * which the clocks are set to.
 */
static void await_cycle(struct ec_dc *dc)
{
	unsigned int ms = 0;

	ec_dc_set_state(dc, EC_DC_AWAIT_CYCLE);
	await_cycles(dc, false, APP_CYCLES, &ms);
	await_cycles(dc, true, APP_MEDIAN - 1, &ms);
	ec_dc_set_state(dc, EC_DC_BUSY);
}

static void log_ref(const struct ec_dc_job *j, bool lost)
{
	struct ec_dc *dc = j->dc;
	u16 choice = READ_ONCE(dc->choice);
	u16 now = READ_ONCE(dc->ref_station), at = now ? j->slaves[j->ref]->position : 0;
	bool substitute = now && choice != EC_DC_ANY && choice != now;

	ec_report(dc->base, EC_EVENT_REF_CLOCK, now ? at : EC_EVENT_NONE,
		  lost || !now || substitute, substitute);
}

static void change_ref(struct ec_dc_job *j, bool found)
{
	struct ec_dc *dc = j->dc;
	u16 before = READ_ONCE(dc->ref_station), now;
	bool lost = before && dc->ref && READ_ONCE(dc->ref->stop.gone);
	bool substitute = found && READ_ONCE(dc->choice) == EC_DC_NOBODY;

	if (found)
		set_ref(j);
	else	/* until it replies or the session ends; it is still on the bus */
		WRITE_ONCE(dc->ref_station, 0);
	ec_dc_look_behind(dc, found && j->given ? &j->shift_behind : NULL);
	now = READ_ONCE(dc->ref_station);
	if ((!j->first || substitute) && before != now)
		log_ref(j, lost);
}

static bool dc_is_transient(int ret)
{
	return ret == -EAGAIN || ret == -ETIMEDOUT || ret == -EBUSY || ret == -ENETDOWN ||
	       ret == -ENODEV || ret == -ENOMEM;
}

/*
 * Frames may be lost, and slaves may connect or disconnect. Until a new reference clock is set,
 * the cycle continues with the one before.
 */
static int set_clocks(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	unsigned int try;
	int ret = -ENXIO;

	if (j->ref == j->n)
		change_ref(j, false);
	for (try = 0; j->ref < j->n && try < TRIES; try++) {
		ret = ec_dc_get_delays(j) ?: ec_dc_latch(j) ?: ec_dc_write(j);
		if (!ret) {
			ec_dc_path_is_known(dc, j->path);
			change_ref(j, true);
			/* what has changed since, as by the measurement, is for the monitor */
			WRITE_ONCE(dc->delays_written, true);
		}
		if (!dc_is_transient(ret) || READ_ONCE(dc->stop))
			break;
		if (ret == -EAGAIN)
			ec_dc_leave_out(j);
		ec_dc_correct_between(j, ~0, TRY_MS);
	}
	if (j->ref < j->n || !try)
		return ret;
	/* the only possible one does not reply */
	change_ref(j, false);
	return -ENXIO;
}

/* Have clocks in use the reference clock that they had before? */
static bool same_ref(const struct ec_dc_job *j)
{
	return j->compensated && j->ref < j->n && j->slaves[j->ref]->station == j->followed;
}

static bool all_set(const struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS) &&
		    READ_ONCE(ec_job_clock(j, i)->state) != EC_CLOCK_SET)
			return false;
	return true;
}

/*
 * Set and compensate all clocks of the job; the cycle uses them meanwhile as far as it can. Where
 * no clock is new, it continues: each datagram more would disturb the rates of those in use.
 */
static int synchronize(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	bool quiet;
	int ret;

	mutex_lock(&dc->lock);
	j->compensated = READ_ONCE(dc->mode) == EC_DC_COMPENSATE;
	WRITE_ONCE(dc->mode, EC_DC_IDLE);
	WRITE_ONCE(dc->extra_dgrams, 0);
	quiet = same_ref(j) && all_set(j);
	ret = set_clocks(j);
	ec_write64(&dc->since_ns, ktime_get_ns());
	/* a clock measures its rate again by few datagrams before it gets many */
	if (!ret && j->compensated)
		ec_dc_correct_between(j, FIRST_CYCLES, FIRST_MS);
	/* clocks that were set before need the cycle in any case */
	if (!ret || (j->compensated && ret != -ENXIO))
		WRITE_ONCE(dc->mode, EC_DC_COMPENSATE);
	if (!ret && !quiet)
		WRITE_ONCE(dc->extra_dgrams, same_ref(j) ? LESS_DGRAMS : EXTRA_DGRAMS);
	ret = ret ?: quiet ? 0 : ec_dc_near(j);
	ret = ret ?: ec_dc_check(j);
	mutex_unlock(&dc->lock);
	if (ret) {
		WRITE_ONCE(dc->extra_dgrams, 0);
		if (READ_ONCE(dc->mode) == EC_DC_READ)
			WRITE_ONCE(dc->mode, EC_DC_COMPENSATE);
	}
	return ret;
}

static void log_result(const struct ec_dc_job *j, int ret, u64 t0)
{
	struct ec_dc *dc = j->dc;
	u64 us = div_u64(ktime_get_ns() - t0, 1000);

	if (!ret)
		ec_report(dc->base, EC_EVENT_DC_SET, us, j->slaves[j->ref]->position);
	else if (ret != -ENXIO && ret != -ECANCELED)
		ec_report(dc->base, EC_EVENT_DC_FAILED, -ret, dc_is_transient(ret));
}

static void dc_work(struct work_struct *work)
{
	struct ec_dc *dc = container_of(work, struct ec_dc, work);
	bool first = !READ_ONCE(dc->app.set);
	struct ec_dc_job j;
	unsigned int i;
	u64 t0;
	int ret;

	if (first)
		await_cycle(dc);
	if (READ_ONCE(dc->stop))
		return;
	t0 = ktime_get_ns();
	ret = ec_dc_job_init(&j, dc, true);
	if (ret) {
		ec_dc_set_state(dc, EC_DC_RETRY_WAIT);
		return;
	}
	j.worker = true;
	j.first = first;
	if (j.ref < j.n && !ec_clock_is_set(j.slaves[j.ref]))
		await_time(dc, t0);
	if (READ_ONCE(dc->stop)) {
		ec_dc_job_free(&j);
		return;
	}
	ret = synchronize(&j);
	log_result(&j, ret, t0);
	ec_dc_set_state(dc, !ret ? EC_DC_READY : dc_is_transient(ret) ? EC_DC_RETRY_WAIT :
						 EC_DC_FAILED);
	/* pairs with the barrier in ec_dc_sync_start() */
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
 * ec_dc_begin() - set the clocks of a session, or of slaves that have connected since
 * @dc: clocks
 * @choice: station address of the reference clock, or EC_DC_ANY...
 *
 * The first time in a session all clocks get the application time; later ones get the time of
 * the reference clock.
 *
 * Context: Process. May sleep.
 */
void ec_dc_begin(struct ec_dc *dc, u16 choice)
{
	bool all = !ec_dc_begun(dc);
	unsigned int i;

	stop(dc);
	down_read(&dc->bus->topo);
	for (i = 0; all && i < dc->bus->n_slaves; i++)
		ec_clock_event(ec_clock_of(dc->bus->slaves[i]), EC_CLOCK_ON_ACTIVATION);
	up_read(&dc->bus->topo);
	WRITE_ONCE(dc->stop, false);
	WRITE_ONCE(dc->delays_written, false);
	if (all) {
		ec_dc_app_set(dc, 0, false);
		dc->window_logged = false;
		dc->guessed = false;
		/* the reference clock of the session before has no meaning in this one */
		if (!ec_dc_can_be(dc, choice))
			WRITE_ONCE(dc->ref_station, 0);
	}
	ec_dc_watch_begun(dc);
	WRITE_ONCE(dc->app_time_seen, false);
	WRITE_ONCE(dc->choice, choice);
	ec_dc_set_state(dc, EC_DC_BUSY);
	queue_work(dc->service, &dc->work);
	ec_dc_watch_start(dc);
}

/**
 * ec_dc_end() - end the clocks of a session
 * @dc: clocks
 *
 * Context: Process. May sleep.
 */
void ec_dc_end(struct ec_dc *dc)
{
	stop(dc);
	WRITE_ONCE(dc->mode, EC_DC_IDLE);
	/* the cycle has ended, maybe while it held the clocks */
	WRITE_ONCE(dc->links->carry->clocks_held, false);
	WRITE_ONCE(dc->armw.wanted, false);
	ec_dc_app_forget(dc);
	WRITE_ONCE(dc->choice, EC_DC_ANY);
	WRITE_ONCE(dc->wanted, false);
	ec_dc_app_set(dc, 0, false);
	down_read(&dc->bus->topo);
	WRITE_ONCE(dc->ref_station, dc->ref ? dc->ref->station : 0);
	up_read(&dc->bus->topo);
	ec_dc_set_state(dc, EC_DC_OFF);
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
	links->carry->ref_minus_ktime = &dc->ref_minus_ktime;
	dc->armw.changes[0] = &dc->path_events;
	dc->armw.changes[1] = &bus->trials;
	links->carry->armw = &dc->armw;
	dc->bus = bus;
	dc->service = service;
	bus->ext[EC_EXT_CLOCK] = dc;
	bus->slave_bytes[EC_EXT_CLOCK] = sizeof(struct ec_clock);
	mutex_init(&dc->lock);
	INIT_WORK(&dc->work, dc_work);
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
