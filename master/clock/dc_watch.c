// SPDX-License-Identifier: GPL-2.0-only
/*
 * The sync window: once a second, while a session uses the clocks, the watch reads the difference
 * of each to the reference clock (register 0x092C). The log has one line for all clocks outside
 * the window. The watch polls excluded clocks as well: when one replies, it is worth another
 * attempt to set the clocks.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "dc_watch.h"
#include "../base/once64.h"
#include "../base/report.h"
#include "../bus/slave.h"
#include "../carry/xfer.h"
#include "../wire/dc.h"

#define PERIOD_MS	1000
#define GRACE_NS	(10ULL * NSEC_PER_SEC)	/* for clocks that were set to settle */
#define LOG_NS		(10ULL * NSEC_PER_SEC)	/* between two lines */
#define BATCH		60	/* slaves polled at once */
#define RETRY_MS	2000	/* between attempts to set the clocks, doubled each time */
#define RETRY_MAX_MS	60000
#define ATTEMPTS	3	/* for a slave that replies while its clock cannot be set */

struct batch {
	unsigned int n;
	struct ec_slave *slaves[BATCH];
	struct ec_dg dg[BATCH];
	u8 value[BATCH][4];
};

/**
 * ec_dc_update_diff() - take the difference of a clock that was read
 * @s: slave
 * @value: register 0x092C
 *
 * The reference clock shows its difference to the application time, which has a meaning only
 * if the application is the time reference.
 *
 * Context: Process, dc.lock held.
 */
void ec_dc_update_diff(struct ec_slave *s, u32 value)
{
	struct ec_clock *c = ec_clock_of(s);
	bool ref = s->station == READ_ONCE(ec_dc_of(s)->ref_station);
	s32 diff = ec_dc_diff(value);

	lockdep_assert_held(&ec_dc_of(s)->lock);
	WRITE_ONCE(c->diff, diff);
	/* with hysteresis */
	if (!ref)
		c->outside_window = abs(diff) >
				    (c->outside_window ? EC_DC_LIMIT_NS / 2 : EC_DC_LIMIT_NS);
}

/* One line for all clocks, when the first leaves the window or the last returns into it. */
static void log_window(struct ec_dc *dc)
{
	unsigned int clocks = 0, far = 0, worst = 0, i;
	u64 now = ktime_get_ns();
	u32 max = 0;

	down_read(&dc->bus->topo);
	for (i = 0; i < dc->bus->n_slaves; i++) {
		const struct ec_slave *s = dc->bus->slaves[i];
		const struct ec_clock *c = ec_clock_of(s);
		u32 diff = abs(READ_ONCE(c->diff));

		if (!ec_clock_is_set(s) || READ_ONCE(s->stop.gone) ||
		    s->station == dc->ref_station)
			continue;
		clocks++;
		far += c->outside_window;
		if (c->outside_window && diff > max) {
			max = diff;
			worst = i;
		}
	}
	up_read(&dc->bus->topo);
	if (!far == !dc->window_logged || now < dc->window_log_ns ||
	    now < ec_read64(&dc->since_ns) + GRACE_NS)
		return;
	dc->window_logged = far;
	dc->window_log_ns = now + LOG_NS;
	ec_report(dc->base, EC_EVENT_DC_WINDOW, far, clocks, far ? worst : EC_EVENT_NONE, max);
}

/* The next slaves whose clock is set or excluded; returns the position to continue from. */
static unsigned int dc_watch_collect(struct ec_dc *dc, struct batch *b, unsigned int from)
{
	b->n = 0;
	down_read(&dc->bus->topo);
	for (; from < dc->bus->n_slaves && b->n < BATCH; from++) {
		struct ec_slave *s = dc->bus->slaves[from];

		if (READ_ONCE(ec_clock_of(s)->state) == EC_CLOCK_UNSET || READ_ONCE(s->stop.gone))
			continue;
		b->dg[b->n] = EC_FPRD(s->station, EC_REG_DC_DIFF, 4, b->value[b->n]);
		b->slaves[b->n++] = ec_slave_ref(s);
	}
	up_read(&dc->bus->topo);
	return from;
}

/*
 * A slave has replied: is another attempt worth it? Each attempt measures all clocks again and
 * slightly disturbs those that are set, so the attempts for one slave are limited.
 */
static bool worth_attempt(struct ec_slave *s)
{
	struct ec_clock *c = ec_clock_of(s);

	if (!ec_clock_is_excluded(s) || c->failed_attempts > ATTEMPTS)
		return false;
	if (c->failed_attempts++ < ATTEMPTS)
		return true;
	ec_slave_warn(s,
		      "clock not synchronized in %d more attempts although the slave replies; clock excluded until the slave reconnects or the next activation\n",
		      ATTEMPTS);
	return false;
}

/* Take the replies of a batch; true: one of the slaves is worth another attempt, if @due. */
static bool dc_watch_take(struct ec_dc *dc, struct batch *b, bool due)
{
	bool worth = false;
	unsigned int i;

	mutex_lock(&dc->lock);
	for (i = 0; i < b->n; i++) {
		if (!b->dg[i].err && b->dg[i].wkc == 1) {
			worth |= due && worth_attempt(b->slaves[i]);
			if (ec_clock_is_set(b->slaves[i]))
				ec_dc_update_diff(b->slaves[i], get_unaligned_le32(b->value[i]));
		}
	}
	mutex_unlock(&dc->lock);
	for (i = 0; i < b->n; i++)
		ec_slave_unref(b->slaves[i]);
	return worth;
}

/**
 * ec_dc_watch_begun() - plan the next attempt when one begins
 * @dc: clocks of a master, the watch is stopped
 *
 * Context: Process.
 */
void ec_dc_watch_begun(struct ec_dc *dc)
{
	dc->retry_ms = dc->state != EC_DC_RETRY_DUE || dc->changed ?
		       RETRY_MS : min_t(u32, 2 * dc->retry_ms, RETRY_MAX_MS);
	dc->retry_ns = ktime_get_ns() + (u64)dc->retry_ms * NSEC_PER_MSEC;
}

static void watch(struct work_struct *work)
{
	struct ec_dc *dc = container_of(to_delayed_work(work), struct ec_dc, watch);
	struct batch *b = kmalloc(sizeof(*b), GFP_KERNEL);
	int state = READ_ONCE(dc->state);
	bool due = state != EC_DC_RETRY_DUE && ktime_get_ns() >= dc->retry_ns;
	bool worth = state == EC_DC_RETRY_WAIT;
	unsigned int at = 0;

	/* the worker checks the clocks itself */
	if (!b || ec_dc_busy(dc))
		goto out;
	do {
		at = dc_watch_collect(dc, b, at);
		ec_xfer(dc->links, b->dg, b->n);
		worth |= dc_watch_take(dc, b, due);
	} while (b->n == BATCH && !READ_ONCE(dc->stop));
	if (due && worth)
		ec_dc_set_state(dc, EC_DC_RETRY_DUE);
	log_window(dc);
	if (dc->again && !(due && worth))
		dc->again(dc);
out:
	kfree(b);
	if (!READ_ONCE(dc->stop))
		queue_delayed_work(dc->service, &dc->watch, msecs_to_jiffies(PERIOD_MS));
}

/**
 * ec_dc_watch_init() - prepare the watch
 * @dc: clocks of a master
 *
 * Context: Process.
 */
void ec_dc_watch_init(struct ec_dc *dc)
{
	INIT_DELAYED_WORK(&dc->watch, watch);
}

/**
 * ec_dc_watch_start() - poll once a second from now on
 * @dc: clocks
 *
 * Context: Process.
 */
void ec_dc_watch_start(struct ec_dc *dc)
{
	queue_delayed_work(dc->service, &dc->watch, msecs_to_jiffies(PERIOD_MS));
}

/**
 * ec_dc_watch_stop() - wait for the watch to end
 * @dc: clocks of a master, @stop set
 *
 * Context: Process. May sleep.
 */
void ec_dc_watch_stop(struct ec_dc *dc)
{
	cancel_delayed_work_sync(&dc->watch);
}
