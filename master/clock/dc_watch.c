// SPDX-License-Identifier: GPL-2.0-only
/*
 * The sync window of every slave: once a second, while an application's clocks
 * run, each says how far it is from the time it was told (register 0x092C). The log
 * has one line for all that are outside the window. One whose clock could not
 * be set is asked, too: when it answers, setting the clocks is worth another try.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "dc.h"
#include "../base/once64.h"
#include "../bus/slave.h"
#include "../wire/dc.h"
#include "../link/xfer.h"

#define PERIOD_MS	1000
#define GRACE_NS	(10ULL * NSEC_PER_SEC)	/* in which clocks that were set come near */
#define LOG_NS		(10ULL * NSEC_PER_SEC)	/* between two lines */
#define BATCH		60	/* slaves asked at once */
#define AGAIN_MS	2000	/* between tries to set the clocks, then twice that... */
#define AGAIN_MAX_MS	60000
#define VAIN		3	/* tries for one slave that answers only when nothing is at stake */

struct batch {
	unsigned int n;
	struct ec_slave *slaves[BATCH];
	struct ec_dg dg[BATCH];
	u8 value[BATCH][4];
};

/**
 * ec_dc_verdict() - a slave has said how far its clock is off
 * @s: slave
 * @value: register 0x092C
 *
 * Of the reference clock it is the distance to the application's time, which
 * only means something when it follows that.
 *
 * Context: Process, dc.lock held.
 */
void ec_dc_verdict(struct ec_slave *s, u32 value)
{
	struct ec_clock *c = ec_clock_of(s);
	bool ref = s->station == READ_ONCE(ec_dc_of(s)->ref_station);
	s32 diff = ec_dc_diff(value);

	lockdep_assert_held(&ec_dc_of(s)->lock);
	WRITE_ONCE(c->diff, diff);
	/* not back and forth at the limit */
	if (!ref)
		c->outside_window = abs(diff) >
				    (c->outside_window ? EC_DC_LIMIT_NS / 2 : EC_DC_LIMIT_NS);
}

/* One line for all clocks, when the first leaves the window or the last is back in it. */
static void tell_far(struct ec_dc *dc)
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
	if (!far == !dc->far_told || now < dc->far_next_ns ||
	    now < ec_read64(&dc->begun_ns) + GRACE_NS)
		return;
	dc->far_told = far;
	dc->far_next_ns = now + LOG_NS;
	max = DIV_ROUND_CLOSEST(max, 100);
	if (far)
		ec_warn(dc,
			"%u of %u clocks outside the sync window, worst: slave %u by %u.%u us\n",
			far, clocks, worst, max / 10, max % 10);
	else
		ec_info(dc, "all %u clocks inside the sync window\n", clocks);
}

/* The next slaves with a clock that was or shall be set; returns the position to go on from. */
static unsigned int collect(struct ec_dc *dc, struct batch *b, unsigned int from)
{
	b->n = 0;
	down_read(&dc->bus->topo);
	for (; from < dc->bus->n_slaves && b->n < BATCH; from++) {
		struct ec_slave *s = dc->bus->slaves[from];

		if (!(ec_clock_is_set(s) || READ_ONCE(ec_clock_of(s)->excluded)) ||
		    READ_ONCE(s->stop.gone))
			continue;
		b->dg[b->n] = EC_FPRD(s->station, EC_REG_DC_DIFF, 4, b->value[b->n]);
		b->slaves[b->n++] = ec_slave_ref(s);
	}
	up_read(&dc->bus->topo);
	return from;
}

static bool due(const struct ec_dc *dc)
{
	return !READ_ONCE(dc->again) && ktime_get_ns() >= dc->again_ns;
}

/*
 * A slave has answered: is that worth a try, which is due? Each one disturbs the clocks
 * that are set a little, as they are measured again: not for ever because of one slave.
 */
static bool worth_try(struct ec_slave *s)
{
	struct ec_clock *c = ec_clock_of(s);

	if (!READ_ONCE(c->excluded)) {
		c->failed_attempts = 0;
		return false;
	}
	if (c->failed_attempts > VAIN)
		return false;
	if (c->failed_attempts++ < VAIN)
		return true;
	ec_slave_warn(s,
		      "clock not synchronized in %d more attempts although the slave replies; clock excluded until the slave reconnects or the next activation\n",
		      VAIN);
	return false;
}

/* What the slaves of a batch have said; true: one of them is worth a try. */
static bool take(struct ec_dc *dc, struct batch *b, bool try)
{
	bool worth = false;
	unsigned int i;

	mutex_lock(&dc->lock);
	for (i = 0; i < b->n; i++) {
		if (!b->dg[i].err && b->dg[i].wkc == 1) {
			worth |= try && worth_try(b->slaves[i]);
			if (ec_clock_is_set(b->slaves[i]))
				ec_dc_verdict(b->slaves[i], get_unaligned_le32(b->value[i]));
		}
	}
	mutex_unlock(&dc->lock);
	for (i = 0; i < b->n; i++)
		ec_slave_unref(b->slaves[i]);
	return worth;
}

/**
 * ec_dc_watch_begun() - clocks are begun to be set; when is another try due?
 * @dc: clocks of a master, nobody watches them
 *
 * Context: Process.
 */
void ec_dc_watch_begun(struct ec_dc *dc)
{
	dc->again_ms = !dc->again || dc->changed ?
		       AGAIN_MS : min_t(u32, 2 * dc->again_ms, AGAIN_MAX_MS);
	dc->again_ns = ktime_get_ns() + (u64)dc->again_ms * NSEC_PER_MSEC;
	dc->again = false;
	dc->failed = false;
}

static void watch(struct work_struct *work)
{
	struct ec_dc *dc = container_of(to_delayed_work(work), struct ec_dc, watch);
	struct batch *b = kmalloc(sizeof(*b), GFP_KERNEL);
	bool try = due(dc), worth = READ_ONCE(dc->failed);
	unsigned int at = 0;

	/* while clocks are being set they have a verdict of their own */
	if (!b || READ_ONCE(dc->state) == EC_DC_BUSY)
		goto out;
	do {
		at = collect(dc, b, at);
		ec_xfer(dc->links, b->dg, b->n);
		worth |= take(dc, b, try);
	} while (b->n == BATCH && !READ_ONCE(dc->stop));
	if (try && worth)
		WRITE_ONCE(dc->again, true);
	tell_far(dc);
out:
	kfree(b);
	if (!READ_ONCE(dc->stop))
		queue_delayed_work(dc->service, &dc->watch, msecs_to_jiffies(PERIOD_MS));
}

/**
 * ec_dc_watch_init() - prepare
 * @dc: clocks of a master
 *
 * Context: Process.
 */
void ec_dc_watch_init(struct ec_dc *dc)
{
	INIT_DELAYED_WORK(&dc->watch, watch);
}

/**
 * ec_dc_watch_start() - look from now on
 * @dc: clocks
 *
 * Context: Process.
 */
void ec_dc_watch_start(struct ec_dc *dc)
{
	queue_delayed_work(dc->service, &dc->watch, msecs_to_jiffies(PERIOD_MS));
}

/**
 * ec_dc_watch_stop() - and no longer
 * @dc: clocks of a master, @stop set
 *
 * Context: Process. May sleep.
 */
void ec_dc_watch_stop(struct ec_dc *dc)
{
	cancel_delayed_work_sync(&dc->watch);
}
