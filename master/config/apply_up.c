// SPDX-License-Identifier: GPL-2.0-only
/* PREOP to SAFEOP with the configuration, SAFEOP to OP with outputs. */
#include <linux/delay.h>
#include "config.h"
#include "domain.h"
#include "../link/links.h"
#include "../base/once64.h"
#include "../bus/pdo_coe.h"
#include "../bus/result.h"
#include "apply_pdo.h"
#include "apply_regs.h"
#include "apply_state.h"
#include "apply_up.h"
#include "replay_run.h"
#include "../clock/dc_sync.h"

#define FLAG_MAX_MS	60000	/* upper limit of the flag */

/* Does it have a SyncManager whose PDOs the application has not configured? */
static bool uses_found_pdos(const struct ec_slave *s, const struct ec_config *c)
{
	unsigned int sm;

	for (sm = 2; sm < s->n_sms; sm++)
		if (!c || !c->sm[sm].explicit)
			return true;
	return false;
}

/* SYNC signals, as soon as the clocks of the whole segment are set */
static struct ec_result start_sync(struct ec_slave *s, const struct ec_config *c)
{
	int ret;

	if (!c || !c->sync.assign)
		return EC_RESULT(0);
	if (!ec_slave_has_clock(s)) {
		ec_slave_report(s, EC_EVENT_NO_CLOCK);
		return EC_RESULT(0);
	}
	ec_dc_sync_compare(s, &c->sync);
	ec_apply_waits_for(s, "the clocks of the segment to be synchronized");
	ret = ec_dc_wait(s);
	ec_apply_waits_for(s, NULL);
	if (ret == -ECANCELED)
		return EC_RESULT(ret);
	if (ret)
		ec_slave_warn(s, "SYNC signals started, but the clock is not %s (%pe)\n",
			      ec_clock_is_set(s) ? "inside the sync window yet" :
						     "synchronized", ERR_PTR(ret));
	/* a cycle that is measured is known by now */
	ec_dc_sync_compare_cycle(s, &c->sync);
	return ec_dc_sync_start(s, &c->sync);
}

/* Some slaves need time between their configuration and SAFEOP. */
static int wait_flag(struct ec_slave *s, s32 ms)
{
	unsigned long left = msecs_to_jiffies(clamp(ms, 0, FLAG_MAX_MS));

	/* a tick may begin late */
	if (ms > 0 && wait_event_idle_timeout(s->stop.wake, ec_stop_worker(&s->stop), left + 1))
		return -ECANCELED;
	return 0;
}

/**
 * ec_apply_to_safeop() - configure a slave and bring it to SAFEOP
 * @s: slave in PREOP
 * @c: its configuration, or NULL
 *
 * Startup commands, what the application has written if the slave has returned, PDOs, registers,
 * SYNC signals, then the request.
 *
 * Context: The slave's worker. Waits for bus traffic, until the time limits.
 * Return: result; a failure is reported, unless SAFEOP is not requested any more; -EAGAIN when
 * the application holds the slave in PREOP.
 */
struct ec_result ec_apply_to_safeop(struct ec_slave *s, const struct ec_config *c)
{
	struct ec_result r = EC_RESULT(ec_replay_hold(s));

	if (r.err)
		return r;
	s->work.clean = false;
	ec_setup_of(s)->pdo_refusal[0] = '\0';
	ec_slave_clear_warning(s);
	if (uses_found_pdos(s, c) && ec_slave_pdos_pending(s))
		ec_slave_read_coe_pdos(s);
	if (c) {
		ec_apply_waits_for(s, "mailbox replies to its configuration");
		r = ec_startup_run(s, c, EC_TRANSITION_PS);
		if (!r.err)
			r = ec_replay_run(s, c);
		if (!r.err && uses_found_pdos(s, c) && ec_slave_pdos_pending(s))
			ec_slave_read_coe_pdos(s);
		if (!r.err)
			r = ec_apply_pdos(s, c);
		ec_apply_waits_for(s, NULL);
	}
	if (!r.err)
		r = ec_apply_regs(s, c);
	if (!r.err && c) {
		ec_apply_waits_for(s, "the time in flag " EC_FLAG_WAIT_SAFEOP);
		r.err = wait_flag(s, ec_config_flag(c, EC_FLAG_WAIT_SAFEOP));
		ec_apply_waits_for(s, NULL);
	}
	if (!r.err)
		r = start_sync(s, c);
	if (!r.err)
		r.err = ec_apply_set(s, EC_AL_SAFEOP);
	return ec_apply_report(s, EC_AL_SAFEOP, r);
}

/* Cycles after which all domains of a slave have been sent twice. */
static u32 cycles_twice(const struct ec_config *c)
{
	u32 division = 1;
	unsigned int i;

	for (i = 0; i < c->n_fmmus; i++)
		division = max(division, c->fmmus[i].domain->division);
	return 2 * division;
}

/*
 * Outputs must have arrived before OP is requested (0x0019 else). Two sends:
 * the first may have left before the FMMUs were written.
 */
static int wait_outputs(struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	u32 cycles, limit;
	unsigned int i;
	u64 from;

	lockdep_assert_held(&s->lock);
	if (!c)
		return 0;
	cycles = cycles_twice(c);
	limit = 5000 + div_u64((u64)cycles * ec_access_interval_us(&s->bus->links->access), 500);
	from = ec_read64(c->wanted->sends);
	/* a poll: the cycle wakes no thread of the master */
	for (i = 0; i < limit; i++) {
		if (ec_read64(c->wanted->sends) - from >= cycles)
			return 0;
		if (ec_stop_worker(&s->stop))
			return -ECANCELED;
		usleep_range(500, 1000);
	}
	/* no cycle runs: the monitor starts the worker again later */
	return -EAGAIN;
}

/**
 * ec_apply_to_op() - bring a slave to OP
 * @s: slave in SAFEOP
 *
 * Outputs, startup commands, clocks, SyncManagers of OP, then the request.
 *
 * Context: The slave's worker. Waits for bus traffic, until the time limits.
 * Return: result; -EAGAIN when no cycle runs; another failure is reported, unless OP is not
 * requested any more.
 */
struct ec_result ec_apply_to_op(struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	struct ec_result r;
	int ret;

	ec_apply_waits_for(s, "two cycles of its domains");
	r = EC_RESULT(wait_outputs(s));
	ec_apply_waits_for(s, NULL);
	if (!r.err && c)
		r = ec_startup_run(s, c, EC_TRANSITION_SO);
	if (!r.err && c)
		r = ec_dc_sync_check(s, &c->sync);
	if (r.err)
		return ec_apply_report(s, EC_AL_OP, r);
	ret = ec_apply_op_only_on(s);
	if (ret > 0)
		ret = wait_outputs(s);
	ret = ret ?: ec_apply_set(s, EC_AL_OP);
	if (ret == -EPROTO)
		ec_apply_op_only_off(s);
	return ec_apply_report(s, EC_AL_OP, EC_RESULT(ret));
}
