// SPDX-License-Identifier: GPL-2.0-only
/* SYNC0 and SYNC1 of one slave (ETG.1000.4 clause 6.8.5). */
#include <linux/ktime.h>
#include "../link/links.h"
#include "dc_app.h"
#include "dc_sync.h"
#include "dc_time.h"
#include "../bus/result.h"
#include "../carry/xfer.h"
#include "../wire/dc.h"

#define LEAD_NS		(100 * NSEC_PER_MSEC)	/* until the first SYNC0 */
#define LEAD_CYCLES	4			/* and so many cycles */
#define LEAD_MAX_NS	(16ll * NSEC_PER_SEC)
#define HALF32_NS	(1ll << 31)		/* past and future in 32 bits: up to 2.1 s */
#define STARTS		6			/* attempts, each with a later start */
#define CHECKS		3			/* starts in time without effect */
#define CHECK_NS	(2 * NSEC_PER_MSEC)	/* after the first SYNC signals */
#define WAIT_MS		5000			/* until clocks are near each other */
#define WAIT_SET_MS	60000			/* until they are set */
#define POLL_MS		100

#define RUN		BIT(8)	/* of AssignActivate: cyclic operation */
#define SYNC0		BIT(9)
#define SYNC1		BIT(10)

/* The clocks are set, or cannot be, those of newly connected slaves included; no attempt is due. */
static bool dc_sync_settled(const struct ec_dc *dc)
{
	return !READ_ONCE(dc->changed) && !ec_dc_busy(dc) &&
	       READ_ONCE(dc->state) != EC_DC_RETRY_DUE;
}

/* The step to @state is obsolete. The code that changed the request has queued the worker. */
static bool dc_sync_canceled(const struct ec_slave *s, u8 state)
{
	return READ_ONCE(s->al.requested) < state || ec_stop_worker(&s->stop);
}

/**
 * ec_dc_wait() - wait until the clocks are set
 * @s: slave that wants to use its clock, @lock held
 *
 * Context: Process. May sleep: from the first cycle on at most a minute, and at most
 * 5 s after the clock of @s was set.
 * Return: 0; -ETIME when they were not set in time; -ENXIO when the one of @s
 * could not be set; -ECANCELED.
 */
int ec_dc_wait(struct ec_slave *s)
{
	struct ec_dc *dc = ec_dc_of(s);
	unsigned int ms, set_ms = 0;

	lockdep_assert_held(&s->lock);
	for (ms = 0; ms < WAIT_SET_MS && set_ms < WAIT_MS; ms += POLL_MS) {
		if (READ_ONCE(dc->state) == EC_DC_AWAIT_CYCLE)
			ms = 0;
		if (wait_event_timeout(dc->wq, dc_sync_settled(dc), msecs_to_jiffies(POLL_MS)))
			return READ_ONCE(dc->state) == EC_DC_READY && ec_clock_is_set(s) ?
			       0 : -ENXIO;
		if (dc_sync_canceled(s, EC_AL_SAFEOP))
			return -ECANCELED;
		if (ec_clock_is_set(s) && !READ_ONCE(dc->changed))
			set_ms += POLL_MS;
	}
	return -ETIME;
}

/**
 * ec_dc_sync_stop() - switch SYNC signals off, assign the unit to the master
 * @s: slave with a clock, @lock held
 *
 * Registers 0x0980, 0x0981.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or as ec_xfer_fpwr().
 */
int ec_dc_sync_stop(struct ec_slave *s)
{
	static const u8 off[2];

	lockdep_assert_held(&s->lock);
	WRITE_ONCE(ec_clock_of(s)->sync_unsynchronized, false);
	ec_clock_of(s)->sync_due_ns = 0;
	return ec_xfer_fpwr(s->bus->links, s->station, EC_REG_DC_CUC, off, sizeof(off));
}

/**
 * ec_dc_sync_again() - start SYNC again if it was started before the clock was set
 * @s: slave whose clock was just set
 *
 * Its signals have another phase than those of other slaves, or have ended. In OP they cannot be
 * moved, so the slave is configured again.
 *
 * Context: Process. May sleep.
 */
void ec_dc_sync_again(struct ec_slave *s)
{
	if (!READ_ONCE(ec_clock_of(s)->sync_unsynchronized) ||
	    READ_ONCE(s->al.requested) <= EC_AL_PREOP || READ_ONCE(s->stop.gone))
		return;
	ec_slave_warn(s,
		      "clock synchronized only after SYNC was started; going through INIT to restart SYNC\n");
	WRITE_ONCE(s->work.reconfigure, true);
	ec_slave_kick(s);
}

/*
 * Off first: while SYNC runs a slave ignores a new start time. @now: result, time of the slave
 * at @at_ns.
 */
static int prepare(struct ec_slave *s, const struct ec_dc_sync *c, u64 *now, u64 *at_ns)
{
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;
	u8 off[2] = { 0 }, cycles[8], t[8] = { 0 };
	struct ec_dg dg[] = {
		EC_DG(EC_CMD_FPWR, s->station, EC_REG_DC_CUC, sizeof(off), off),
		EC_DG(EC_CMD_FPWR, s->station, EC_REG_DC_CYCLE0, sizeof(cycles), cycles),
		EC_DG(EC_CMD_FPRD, s->station, EC_REG_DC_SYSTIME, wide ? 8 : 4, t),
	};
	int ret;

	put_unaligned_le32(c->period[0], cycles);
	put_unaligned_le32(c->period[1], cycles + 4);
	ret = ec_xfer_all(s->bus->links, dg, ARRAY_SIZE(dg));
	if (ret)
		return ret;
	*at_ns = dg[2].sent_ns;
	*now = wide ? get_unaligned_le64(t) :
		      ec_dc_extend32(ec_dc_of(s), get_unaligned_le32(t), *at_ns);
	return 0;
}

/* From the first SYNC0 to the first SYNC1, even if SYNC1 is slower. */
static u32 sync1_after(const struct ec_dc_sync *c)
{
	return c->assign & SYNC1 ? c->period[1] : 0;
}

/*
 * Write start time and activation, and read the time of the slave in the same frame. -EAGAIN:
 * the start time had passed, or is too far ahead.
 */
static int dc_sync_activate(struct ec_slave *s, const struct ec_dc_sync *c, u64 first)
{
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;
	u8 start[8], assign[2], t[8] = { 0 };
	struct ec_dg dg[] = {
		EC_DG(EC_CMD_FPWR, s->station, EC_REG_DC_START, wide ? 8 : 4, start),
		EC_DG(EC_CMD_FPWR, s->station, EC_REG_DC_CUC, sizeof(assign), assign),
		EC_DG(EC_CMD_FPRD, s->station, EC_REG_DC_SYSTIME, wide ? 8 : 4, t),
	};
	unsigned int i;
	s64 ahead;
	int ret;

	put_unaligned_le64(first, start);
	put_unaligned_le16(c->assign, assign);
	/* a repeated second half alone would start SYNC at another time */
	for (i = 0; i < ARRAY_SIZE(dg); i++)
		dg[i].repeat = false;
	ret = ec_xfer_all(s->bus->links, dg, ARRAY_SIZE(dg));
	if (ret || !(c->assign & RUN))
		return ret;
	ahead = first - get_unaligned_le64(t);
	if (!wide)
		ahead = (s32)ahead;
	/* further than lead() and a period: the clock was set back meanwhile */
	if (ahead <= 0 || ahead > LEAD_MAX_NS + 2ll * U32_MAX)
		return -EAGAIN;
	ec_clock_of(s)->sync_due_ns = dg[2].sent_ns + ahead + sync1_after(c);
	return 0;
}

/*
 * Minimum time until the start. The start is up to one period later, on the grid; with 32 bits
 * it must still be in the future then, with a margin.
 */
static u64 lead(struct ec_slave *s, u32 period, u64 took)
{
	u32 interval_us = ec_access_interval_us(&s->bus->links->access);
	u64 cycles = (u64)LEAD_CYCLES * interval_us * NSEC_PER_USEC;
	s64 most = HALF32_NS - period - LEAD_NS;

	if (ec_slave_features(s) & EC_FEAT_DC64)
		most = LEAD_MAX_NS;
	return min_t(u64, LEAD_NS + cycles + took, max_t(s64, most, LEAD_NS));
}

/* One attempt; the longer transfers to the slave take, the later is the start time. */
static int dc_sync_start(struct ec_slave *s, const struct ec_dc_sync *c, unsigned int try)
{
	u32 period = c->period[0] + c->period[1];
	u64 now, at_ns, t0 = ktime_get_ns(), took;
	int ret = prepare(s, c, &now, &at_ns);

	if (ret)
		return ret;
	took = ktime_get_ns() - t0;
	now += ktime_get_ns() - at_ns + lead(s, period, took << (try + 1));
	return dc_sync_activate(s, c,
				ec_dc_start(now, ec_dc_phase(ec_dc_of(s)), period, c->shift[0]));
}

#define MODES	8	/* of the SII that are compared and logged */

/**
 * ec_dc_sync_compare() - warn about an implausible AssignActivate value
 * @s: slave with a clock, @lock held
 * @c: its configuration with @dc_assign
 *
 * Either it enables no SYNC signal, or the SII has operation modes and none with
 * this value. The master uses it nevertheless: an EEPROM may be older than its slave.
 *
 * Context: Process. May sleep.
 */
void ec_dc_sync_compare(struct ec_slave *s, const struct ec_dc_sync *c)
{
	struct ec_sii_dc dc[MODES];
	char list[8 * MODES] = "";
	int i, n, len = 0;

	lockdep_assert_held(&s->lock);
	if (!(c->assign & RUN) || !(c->assign & (SYNC0 | SYNC1))) {
		ec_slave_warn(s,
			      "AssignActivate 0x%04x enables no SYNC signal: bit 8 and bit 9 or 10 must be set, as in 0x0300\n",
			      c->assign);
		return;
	}
	n = s->eeprom.data ? ec_sii_decode_dcs(s->eeprom.data, s->eeprom.bytes, dc, MODES) : 0;
	for (i = 0; i < min(n, MODES); i++) {
		if (dc[i].assign == c->assign)
			return;
		len += scnprintf(list + len, sizeof(list) - len, " 0x%04x", dc[i].assign);
	}
	/* else it may be a mode that was not decoded */
	if (n > 0 && n < MODES)
		ec_slave_warn(s,
			      "AssignActivate 0x%04x is no operation mode of the SII, which has%s; check it against the ESI\n",
			      c->assign, list);
}

/**
 * ec_dc_sync_compare_cycle() - warn about SYNC0 signals at ever other places of the cycle
 * @s: slave with a clock, @lock held
 * @c: its configuration with @dc_assign
 *
 * Context: Process. May sleep.
 */
void ec_dc_sync_compare_cycle(struct ec_slave *s, const struct ec_dc_sync *c)
{
	u32 cycle_us = ec_access_interval_us(&s->bus->links->access);

	lockdep_assert_held(&s->lock);
	if (c->assign & SYNC0 && !ec_dc_sync_fits(c->period[0], cycle_us * NSEC_PER_USEC))
		ec_slave_warn(s,
			      "SYNC0 time %u ns does not divide the cycle of %u us; set it to the cycle time or a whole part of it: ecrt_slave_config_dc()\n",
			      c->period[0], cycle_us);
}

/**
 * ec_dc_sync_start() - program and start SYNC0 and SYNC1
 * @s: slave whose clock is set, @lock held
 * @c: its configuration with @dc_assign
 *
 * Registers 0x0980 off, 0x09A0, 0x0990, then 0x0980. Repeats a start whose time had passed.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ERANGE when the cycle times are 0 or too long, -EOPNOTSUPP when the
 * start time had always passed (both reported); -ECANCELED; or as ec_xfer_all().
 */
struct ec_result ec_dc_sync_start(struct ec_slave *s, const struct ec_dc_sync *c)
{
	struct ec_clock *clock = ec_clock_of(s);
	u32 period = c->period[0] + c->period[1];
	unsigned int try;
	int ret = -EAGAIN;

	lockdep_assert_held(&s->lock);
	if (period < c->period[0] || !period)
		return ec_result_fail(s, -ERANGE, EC_CAUSE(SYNC),
				      "SYNC0 %u ns + SYNC1 %u ns with AssignActivate 0x%04x: the sum must be 1 to 4294967295 ns",
				      c->period[0], c->period[1], c->assign);
	for (try = 0; try < STARTS && (ret == -EAGAIN || ret == -ETIMEDOUT); try++) {
		bool set = ec_clock_is_set(s);

		if (dc_sync_canceled(s, EC_AL_SAFEOP))
			return EC_RESULT(-ECANCELED);
		clock->sync_due_ns = 0;
		WRITE_ONCE(clock->sync_unsynchronized, !set);
		/* the clock worker sees that, or it is seen below that the clock is set */
		smp_mb();
		ret = dc_sync_start(s, c, try);
		if (!ret && !set && ec_clock_is_set(s))
			ret = -EAGAIN;
	}
	if (ret == -EAGAIN)
		return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(SYNC),
				      "SYNC0 start time had passed on arrival, %d attempts; configure fewer slaves at once or allow more delayed cycles",
				      STARTS);
	return EC_RESULT(ret);
}

static int dc_sync_wait_until(struct ec_slave *s, u64 ns)
{
	u64 now = ktime_get_ns();

	if (now >= ns)
		return 0;
	return wait_event_hrtimeout(s->stop.wake, dc_sync_canceled(s, EC_AL_OP),
				    ns_to_ktime(ns - now)) ? 0 : -ECANCELED;
}

/* SYNC signals in use that are pending by register 0x0984, or an implausible start. */
static u8 missing(const struct ec_dc_sync *c, u8 status)
{
	return status & (4 | (c->assign & SYNC0 ? 1 : 0) | (c->assign & SYNC1 ? 2 : 0));
}

/**
 * ec_dc_sync_check() - check that the started SYNC signals run
 * @s: slave in SAFEOP, @lock held
 * @c: its configuration
 *
 * Waits for the first signals and reads register 0x0984; starts them again when they are
 * missing. A controller without that register may return any value: only a warning.
 *
 * Context: Process. Waits for bus traffic, and for the start time.
 * Return: 0; -EOPNOTSUPP when they do not run (reported); -ECANCELED; or as ec_dc_sync_start().
 */
struct ec_result ec_dc_sync_check(struct ec_slave *s, const struct ec_dc_sync *c)
{
	struct ec_clock *clock = ec_clock_of(s);
	bool known = ec_slave_features(s) & EC_FEAT_DC_ENHANCED;
	u8 status[1] = { 0 };
	struct ec_result r;
	unsigned int try;
	int ret;

	lockdep_assert_held(&s->lock);
	for (try = 0; clock->sync_due_ns; try++) {
		ret = dc_sync_wait_until(s, clock->sync_due_ns + CHECK_NS);
		ret = ret ?: ec_xfer_fprd(s->bus->links, s->station, EC_REG_DC_ACT_STATUS, status,
					  1);
		if (ret && (ret != -EIO || known))
			return EC_RESULT(ret);
		if (!missing(c, status[0]))
			break;
		if (!known) {
			ec_slave_warn(s,
				      "SYNC signals may not run (0x0984 = 0x%02x), or the slave lacks this register; continuing to OP\n",
				      status[0]);
			break;
		}
		if (try == CHECKS)
			return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(SYNC),
					      "SYNC signals started but not running (0x0984 = 0x%02x); check AssignActivate 0x%04x against the ESI",
					      status[0], c->assign);
		r = ec_dc_sync_start(s, c);
		if (r.err) {
			/* SYNC may be off now; the configuration starts it again */
			WRITE_ONCE(s->work.reconfigure, true);
			return r;
		}
	}
	clock->sync_due_ns = 0;
	return EC_RESULT(0);
}
