// SPDX-License-Identifier: GPL-2.0-only
/* The worker of a slave: configure it and bring it to its requested state. */
#include <linux/delay.h>
#include "config.h"
#include "domain.h"
#include "../mailbox/mailbox.h"
#include "../link/links.h"
#include "../base/once64.h"
#include "../bus/al.h"
#include "../bus/leave_init.h"
#include "../bus/result.h"
#include "../wire/fmmu.h"
#include "../carry/xfer.h"
#include "apply.h"

#define FLAG_MAX_MS	60000	/* upper limit of the flag */
#define ACKS		3	/* of an error, before INIT is requested */
#define HOLD_MS		1000	/* a transfer that takes longer is cut off */

static int write_reg(struct ec_slave *s, u16 ado, const void *data, u16 len)
{
	return ec_xfer_fpwr(s->bus->links, s->station, ado, data, len);
}

/* No failure: the step is obsolete, or waits for a cycle. */
static bool is_aborted(int err)
{
	return err == -ECANCELED || err == -EINTR || err == -EAGAIN;
}

/* Note why @state was not reached. */
static void note_cause(struct ec_slave *s, u8 state, int err)
{
	const struct ec_setup *setup = ec_setup_of(s);
	const char *refusal = setup->pdo_refusal;
	u16 code = READ_ONCE(s->al_code);

	if (err == -EPROTO && state == EC_AL_SAFEOP && refusal[0])
		/* the first cause, not only what follows from it */
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, &setup->pdo_cause,
			      "%.160s; then SAFEOP refused: AL status code 0x%04x (%s)", refusal,
			      code, ec_al_code_text(code));
	else if (state == EC_AL_PREOP && s->sii_flaw[0] && (err == -EPROTO || err == -ETIME))
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(EEPROM, .state = state),
			      "%.170s; then PREOP %s", s->sii_flaw,
			      err == -ETIME ? "not reached in time" : "refused");
	else if (err == -EPROTO)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED,
			      EC_CAUSE(REFUSED, .state = state, .code = code),
			      "%s refused: AL status code 0x%04x (%s)", ec_al_state_name(state),
			      code, ec_al_code_text(code));
	else if (err == -ETIME)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(SLOW, .state = state),
			      "%s not reached in time, AL state %s", ec_al_state_name(state),
			      ec_al_state_name(READ_ONCE(s->al_status) & EC_AL_STATE_MASK));
	else if (err == -ENOMEM)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(MEMORY, .state = state),
			      "no memory before %s, the master tries again; free memory of this computer",
			      ec_al_state_name(state));
	else
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(FRAMES, .state = state),
			      "communication failed before %s (%pe)", ec_al_state_name(state),
			      ERR_PTR(err));
}

/* The result of the way to @state: its failure is reported if that was not done yet. */
static struct ec_result apply_report(struct ec_slave *s, u8 state, struct ec_result r)
{
	const struct ec_setup *setup = ec_setup_of(s);

	if (!r.err || (!r.reported && is_aborted(r.err)))
		return r;
	/* another state is asked for meanwhile: this says nothing of the way there */
	if (!r.reported && setup->heading == ec_slave_wanted(s)) {
		note_cause(s, state, r.err);
		r.reported = true;
	}
	/* ec_slave_request_anew() came in between, and has forgiven too early */
	if (r.reported && setup->heading != ec_slave_wanted(s))
		ec_slave_forgive(s);
	return r;
}

/*
 * Frames were lost, the device hung, memory ran out, or the slave needs more time than usual:
 * worth another try. A refusal is not, unless the slave missed the outputs.
 */
static bool apply_is_transient(const struct ec_slave *s, int err)
{
	u16 code = READ_ONCE(s->al_code);

	if (err == -EPROTO)
		return code == EC_AL_CODE_NO_OUTPUTS || code == EC_AL_CODE_SM_WATCHDOG;
	return err == -EIO || err == -ETIMEDOUT || err == -ETIME || err == -ENETDOWN ||
	       err == -EBUSY || err == -ENOTRECOVERABLE || err == -ENOMEM;
}

/*
 * An attempt after a failure that was aborted, or found no cycle, has no result. The monitor
 * has removed the slave from its plan, so the worker must plan the next attempt.
 */
static bool is_undecided(const struct ec_slave *s, int err)
{
	return s->retry_ms && (!err || is_aborted(err));
}

/* What the application allows for a transition, ms; 0: the default. */
static u32 apply_limit(const struct ec_slave *s, u8 from, u8 to)
{
	const struct ec_config *c = ec_config_of(s);

	return c && ec_al_state_valid(from) ? c->timeout_ms[from][to] : 0;
}

/* What a reason shows while the worker waits; NULL ends it. */
static void apply_waits_for(struct ec_slave *s, const char *what)
{
	WRITE_ONCE(ec_setup_of(s)->waits_for, what);
}

/* Bring it to @state by ec_al_set() or ec_leave_init(). */
static int set_state_by(struct ec_slave *s, u8 state,
			int (*set)(struct ec_slave *s, u8 state, u32 timeout_ms))
{
	int ret;

	/* the computer reboots since the worker has begun this way */
	if (state & EC_AL_BEYOND_PREOP && READ_ONCE(s->bus->down))
		return -ECANCELED;
	apply_waits_for(s, state == EC_AL_OP ? "the slave to reach OP" :
			   state == EC_AL_SAFEOP ? "the slave to reach SAFEOP" :
						   "the slave to change its state");
	ret = set(s, state, apply_limit(s, READ_ONCE(s->al_status) & EC_AL_STATE_MASK, state));
	apply_waits_for(s, NULL);
	return ret;
}

static int set_state(struct ec_slave *s, u8 state)
{
	return set_state_by(s, state, ec_al_set);
}

/*
 * The way through INIT must not abort a transfer of another thread: the worker waits for it,
 * for a limited time, and holds the mailbox until PREOP.
 */
static void hold_mailbox(struct ec_slave *s)
{
	if (ec_setup_of(s)->mailbox.state == EC_CLAIM_HELD || READ_ONCE(s->requested) < EC_AL_PREOP)
		return;
	ec_mbox_claim(&s->mbox, &ec_setup_of(s)->mailbox, EC_MBOX_ALL, HOLD_MS);
}

static void release_mailbox(struct ec_slave *s)
{
	if (ec_setup_of(s)->mailbox.state == EC_CLAIM_HELD)
		ec_mbox_unclaim(&s->mbox, &ec_setup_of(s)->mailbox);
}

static int activate_sm(struct ec_slave *s, unsigned int sm, u8 active)
{
	return write_reg(s, EC_REG_SM(sm) + EC_SM_OFS_ACTIVATE, &active, 1);
}

/*
 * SyncManagers that the SII enables in OP only: enabled before OP is requested, as some slaves
 * need outputs first. Return: how many were off, or -errno.
 */
static int op_only_on(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	unsigned int sm, n = 0;
	int ret;

	for (sm = 0; sm < s->n_sms; sm++) {
		if (!(s->sms[sm].enable & EC_SII_SM_OP_ONLY) || setup->op_only & BIT(sm) ||
		    !ec_pdo_list_bytes(ec_apply_pdos_of(s, setup->active_config, sm)))
			continue;
		ret = activate_sm(s, sm, EC_SM_ACT_ENABLE);
		if (ret)
			return ret;
		setup->op_only |= BIT(sm);
		n++;
	}
	return n;
}

static int op_only_off(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	unsigned int sm;
	int ret;

	for (sm = 0; setup->op_only; sm++) {
		ret = setup->op_only & BIT(sm) ? activate_sm(s, sm, 0) : 0;
		if (ret)
			return ret;
		setup->op_only &= ~BIT(sm);
	}
	return 0;
}

/* It has reached INIT: nothing of a configuration is left. */
static void in_init(struct ec_slave *s)
{
	static const u8 force[1] = { EC_EEP_OWNER_FORCE }, zero[1];
	int ret = ec_apply_clear(s);

	write_reg(s, EC_REG_EEP_OWNER, force, 1);
	write_reg(s, EC_REG_EEP_OWNER, zero, 1);
	if (ec_slave_has_clock(s))
		ret = ec_dc_sync_stop(s) ?: ret;
	ec_mbox_reset(&s->mbox);
	ec_setup_of(s)->op_only = 0;
	WRITE_ONCE(s->reconfigure, false);
	s->ours = false;
	s->clean = !ret;
}

/* Any state to INIT (ETG.1000.6 clause 6.4.1). */
static struct ec_result to_init(struct ec_slave *s)
{
	int ret;

	hold_mailbox(s);
	op_only_off(s);
	ret = set_state(s, EC_AL_INIT);
	if (!ret)
		in_init(s);
	return apply_report(s, EC_AL_INIT, EC_RESULT(ret));
}

/* An error that stays in spite of acknowledges: INIT ends it, as a slave obeys that always. */
static struct ec_result acknowledge(struct ec_slave *s)
{
	u8 state = READ_ONCE(s->al_status) & EC_AL_STATE_MASK;
	u16 code = READ_ONCE(s->al_code);
	unsigned int i;
	int ret;

	for (i = 0; i < ACKS; i++) {
		apply_waits_for(s, "the slave to take the acknowledge of its error");
		ret = ec_al_ack(s);
		apply_waits_for(s, NULL);
		if (ret != -ETIME)
			return apply_report(s, state, EC_RESULT(ret));
	}
	ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED,
		      EC_CAUSE(AL_ERROR, .state = state, .code = code),
		      "AL state %s with error, AL status code 0x%04x (%s): %u acknowledges without effect; INIT follows",
		      ec_al_state_name(state), code, ec_al_code_text(code), ACKS);
	return to_init(s);
}

/* The master has brought it from INIT to @state. */
static void has_left_init(struct ec_slave *s, u8 state)
{
	s->ours = true;
	if (state == EC_AL_PREOP)
		release_mailbox(s);
}

/* From INIT to PREOP or BOOT with the mailbox of that state. */
static struct ec_result leave_init(struct ec_slave *s, u8 state)
{
	bool boot = state == EC_AL_BOOT;
	int ret;

	if (boot && !(s->info.boot.rx_size && s->info.boot.tx_size))
		return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(REFUSED, .state = EC_AL_BOOT),
				      "BOOT not possible: no bootstrap mailbox in the SII");
	s->ours = false;
	ret = set_state_by(s, state, ec_leave_init);
	/* any AL status code may be due to the event of SM1: try again without */
	if (ret == -EPROTO && !s->mbox.strict && ec_mbox_present(&s->mbox)) {
		s->mbox.strict = true;
		ret = set_state(s, EC_AL_INIT) ?: set_state_by(s, state, ec_leave_init);
	}
	if (!ret)
		has_left_init(s, state);
	else if (!boot)
		release_mailbox(s);
	return apply_report(s, state, EC_RESULT(ret));
}

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
		ec_slave_warn(s, "no distributed clock; DC settings ignored\n");
		ec_slave_event(s, EC_EVENT_NO_CLOCK);
		return EC_RESULT(0);
	}
	ec_dc_sync_compare(s, &c->sync);
	apply_waits_for(s, "the clocks of the segment to be synchronized");
	ret = ec_dc_wait(s);
	apply_waits_for(s, NULL);
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

/* PREOP to SAFEOP: startup commands, PDOs, registers, SYNC signals, then the request. */
static struct ec_result to_safeop(struct ec_slave *s, const struct ec_config *c)
{
	struct ec_result r = { 0 };

	s->clean = false;
	ec_setup_of(s)->pdo_refusal[0] = '\0';
	ec_slave_clear_warning(s);
	if (uses_found_pdos(s, c) && ec_slave_pdos_pending(s))
		ec_slave_read_coe_pdos(s);
	if (c) {
		apply_waits_for(s, "mailbox replies to its configuration");
		r = ec_startup_run(s, c, EC_TRANSITION_PS);
		if (!r.err)
			r = ec_apply_pdos(s, c);
		apply_waits_for(s, NULL);
	}
	if (!r.err)
		r = ec_apply_regs(s, c);
	if (!r.err && c) {
		apply_waits_for(s, "the time in flag " EC_FLAG_WAIT_SAFEOP);
		r.err = wait_flag(s, ec_config_flag(c, EC_FLAG_WAIT_SAFEOP));
		apply_waits_for(s, NULL);
	}
	if (!r.err)
		r = start_sync(s, c);
	if (!r.err)
		r.err = set_state(s, EC_AL_SAFEOP);
	return apply_report(s, EC_AL_SAFEOP, r);
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

/* SAFEOP to OP: outputs, startup commands, clocks, SyncManagers of OP, then the request. */
static struct ec_result to_op(struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	struct ec_result r;
	int ret;

	apply_waits_for(s, "two cycles of its domains");
	r = EC_RESULT(wait_outputs(s));
	apply_waits_for(s, NULL);
	if (!r.err && c)
		r = ec_startup_run(s, c, EC_TRANSITION_SO);
	if (!r.err && c)
		r = ec_dc_sync_check(s, &c->sync);
	if (r.err)
		return apply_report(s, EC_AL_OP, r);
	ret = op_only_on(s);
	if (ret > 0)
		ret = wait_outputs(s);
	ret = ret ?: set_state(s, EC_AL_OP);
	if (ret == -EPROTO)
		op_only_off(s);
	return apply_report(s, EC_AL_OP, EC_RESULT(ret));
}

/*
 * In PREOP a slave has no use for SYNC signals and process data. Without them the next
 * application need not take it through INIT.
 */
static void back_in_preop(struct ec_slave *s)
{
	int ret = ec_slave_has_clock(s) ? ec_dc_sync_stop(s) : 0;

	s->clean = !ec_apply_clear_pdos(s) && !ret;
}

static struct ec_result step_down(struct ec_slave *s, u8 want)
{
	int ret = op_only_off(s) ?: set_state(s, want);

	/* process data have ended before a slow slave was down: it did not refuse anything */
	if (ret == -EPROTO && READ_ONCE(s->al_code) == EC_AL_CODE_SM_WATCHDOG)
		ret = set_state(s, want);
	if (ret == -EPROTO) {
		/* the stronger step; the way up from there leads to @want */
		ec_slave_warn(s, "%s refused: AL status code 0x%04x (%s); INIT follows\n",
			      ec_al_state_name(want), READ_ONCE(s->al_code),
			      ec_al_code_text(READ_ONCE(s->al_code)));
		return to_init(s);
	}
	if (!ret && want == EC_AL_PREOP)
		back_in_preop(s);
	return apply_report(s, want, EC_RESULT(ret));
}

/* What was asked for has come after its time limit: the rest of that step. */
static void arrived(struct ec_slave *s, u8 state)
{
	WRITE_ONCE(s->awaited, 0);
	if (state == EC_AL_INIT)
		in_init(s);
	else if (!s->ours)
		has_left_init(s, state);
	else if (state == EC_AL_PREOP)
		back_in_preop(s);
}

/* Before activation the application may change its configuration at any time. */
static void take_plan(struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	const struct ec_config *c = setup->config;

	lockdep_assert_held(&s->lock);
	/* from activation on the configuration does not change */
	if (!c || !smp_load_acquire(&c->wanted->active) || setup->active_config == c)
		return;
	setup->active_config = c;
	WRITE_ONCE(s->reconfigure, true);
}

/*
 * Nothing of a configuration is left in the slave, so that it need not go through INIT. INIT
 * would also have emptied its mailbox: a slave whose mailbox cannot be emptied goes there.
 */
static int start_clean(struct ec_slave *s)
{
	int ret = ec_mbox_present(&s->mbox) ? ec_mbox_forget(&s->mbox) : 0;

	if (ret == -ECANCELED)
		return ret;
	if (ret)
		s->clean = false;
	else
		WRITE_ONCE(s->reconfigure, false);
	return 0;
}

/* One step towards the requested state. @there: result: it is in that state. */
static struct ec_result apply_step(struct ec_slave *s, bool *there)
{
	struct ec_setup *setup = ec_setup_of(s);
	u8 want = ec_slave_wanted(s), cur;
	struct ec_result r = EC_RESULT(ec_al_read(s));
	bool anew;

	lockdep_assert_held(&s->lock);
	setup->heading = want;
	if (!r.err && READ_ONCE(s->al_status) & EC_AL_ERROR && !s->emulation)
		r = acknowledge(s);
	if (r.err)
		return r;
	cur = READ_ONCE(s->al_status) & EC_AL_STATE_MASK;
	if (cur == READ_ONCE(s->awaited)) {
		arrived(s, cur);
		return r;
	}
	anew = READ_ONCE(s->reconfigure) && want > EC_AL_PREOP;
	if (cur == EC_AL_PREOP && s->clean && s->ours && anew)
		return EC_RESULT(start_clean(s));
	if (cur != EC_AL_INIT && (!s->ours || anew))
		return to_init(s);
	if (setup->mapped && cur <= EC_AL_PREOP && want <= EC_AL_PREOP)
		return EC_RESULT(ec_apply_clear_fmmus(s));
	if (setup->op_only && cur != EC_AL_OP)
		return EC_RESULT(op_only_off(s));
	if (cur == want) {
		*there = want != EC_AL_OP || op_only_on(s) >= 0;
		return EC_RESULT(*there ? 0 : -EIO);
	}
	if (want == EC_AL_BOOT)
		return cur == EC_AL_INIT ? leave_init(s, EC_AL_BOOT) : to_init(s);
	if (cur > want || cur == EC_AL_BOOT) {
		if (want == EC_AL_INIT || cur == EC_AL_BOOT)
			return to_init(s);
		return step_down(s, want);
	}
	switch (cur) {
	case EC_AL_INIT:
		return leave_init(s, EC_AL_PREOP);
	case EC_AL_PREOP:
		return to_safeop(s, setup->active_config);
	case EC_AL_SAFEOP:
		return to_op(s);
	default:
		return to_init(s);
	}
}

/* One that was lost or silent is where it was wanted. */
static void log_return(struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	u64 ms = div_u64(ktime_get_ns() - s->seen_ns, NSEC_PER_MSEC);

	if (s->seen_ns && c && READ_ONCE(s->al_status) == EC_AL_OP)
		ec_pending_back(s, ms);
	if (!c || READ_ONCE(s->al_status) == EC_AL_OP)
		s->seen_ns = 0;
}

/**
 * ec_apply() - bring a slave to its requested state
 * @s: slave
 *
 * Context: The slave's worker. Waits for bus traffic.
 */
void ec_apply(struct ec_slave *s)
{
	struct ec_result r = { 0 };
	bool there = false;
	unsigned int i;

	mutex_lock(&s->lock);
	WRITE_ONCE(s->stop.worker, current);
	for (i = 0; i < 16 && !there && !r.err && !ec_stop_worker(&s->stop); i++) {
		take_plan(s);
		r = apply_step(s, &there);
	}
	release_mailbox(s);
	if (there && ec_slave_set_ok(s, false)) {
		s->retry_ms = 0;
		log_return(s);
	}
	if (!there && READ_ONCE(s->error) == EC_SLAVE_CONFIG_FAILED &&
	    (apply_is_transient(s, r.err) || is_undecided(s, r.err))) {
		/* wait that limit once more: another request may restart the transition */
		if (r.err == -ETIME && READ_ONCE(s->awaited))
			s->retry_ms = max(s->retry_ms, s->awaited_ms / 2);
		ec_slave_retry(s, EC_RETRY_MAX_MS);
	}
	if (there && READ_ONCE(s->read_pdos) && ec_slave_pdos_pending(s))
		ec_slave_read_coe_pdos(s);
	if (there && READ_ONCE(s->read_pdos) && ec_names_pending(s))
		ec_names_read(s);
	WRITE_ONCE(s->stop.worker, NULL);
	mutex_unlock(&s->lock);
}
