// SPDX-License-Identifier: GPL-2.0-only
/* The worker of a slave: configure it and bring it to its requested state. */
#include "config.h"
#include "../mailbox/mailbox.h"
#include "../bus/identify.h"
#include "../bus/leave_init.h"
#include "../bus/pdo_coe.h"
#include "../bus/result.h"
#include "../carry/xfer.h"
#include "apply.h"
#include "apply_regs.h"
#include "apply_state.h"
#include "apply_up.h"
#include "replay_run.h"
#include "../clock/dc_sync.h"

#define ACKS		3	/* of an error, before INIT is requested */
#define HOLD_MS		1000	/* a transfer that takes longer is cut off */

/*
 * The way through INIT must not abort a transfer of another thread: the worker waits for it,
 * for a limited time, and holds the mailbox until PREOP.
 */
static void hold_mailbox(struct ec_slave *s)
{
	if (ec_setup_of(s)->mailbox.state == EC_CLAIM_HELD ||
	    READ_ONCE(s->al.requested) < EC_AL_PREOP)
		return;
	ec_mbox_claim(&s->mbox, &ec_setup_of(s)->mailbox, EC_MBOX_ALL, HOLD_MS);
}

static void release_mailbox(struct ec_slave *s)
{
	if (ec_setup_of(s)->mailbox.state == EC_CLAIM_HELD)
		ec_mbox_unclaim(&s->mbox, &ec_setup_of(s)->mailbox);
}

/* It has reached INIT: nothing of a configuration is left. */
static void in_init(struct ec_slave *s)
{
	static const u8 force[1] = { EC_EEP_OWNER_FORCE }, zero[1];
	int ret = ec_apply_clear(s);

	ec_xfer_fpwr(s->bus->links, s->station, EC_REG_EEP_OWNER, force, 1);
	ec_xfer_fpwr(s->bus->links, s->station, EC_REG_EEP_OWNER, zero, 1);
	if (ec_slave_has_clock(s))
		ret = ec_dc_sync_stop(s) ?: ret;
	ec_mbox_reset(&s->mbox);
	ec_setup_of(s)->op_only = 0;
	WRITE_ONCE(s->work.reconfigure, false);
	s->work.ours = false;
	s->work.clean = !ret;
}

/*
 * Commands of the application for a step down. Their failure is reported; the slave goes down
 * nevertheless. Only of a slave that the master has brought to its state.
 */
static void run_down(struct ec_slave *s, u8 to)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	u8 from = READ_ONCE(s->al.status) & EC_AL_STATE_MASK;

	if (c && s->work.ours)
		ec_startup_run(s, c, EC_TRANSITION(from, to));
}

/* Any state to INIT (ETG.1000.6 clause 6.4.1). */
static struct ec_result to_init(struct ec_slave *s)
{
	int ret;

	run_down(s, EC_AL_INIT);
	hold_mailbox(s);
	ec_apply_op_only_off(s);
	ret = ec_apply_set(s, EC_AL_INIT);
	if (!ret)
		in_init(s);
	return ec_apply_report(s, EC_AL_INIT, EC_RESULT(ret));
}

/* An error that stays in spite of acknowledges: INIT ends it, as a slave obeys that always. */
static struct ec_result acknowledge(struct ec_slave *s)
{
	u8 state = READ_ONCE(s->al.status) & EC_AL_STATE_MASK;
	u16 code = READ_ONCE(s->al.code);
	unsigned int i;
	int ret;

	for (i = 0; i < ACKS; i++) {
		ec_apply_waits_for(s, "the slave to take the acknowledge of its error");
		ret = ec_al_ack(s);
		ec_apply_waits_for(s, NULL);
		if (ret != -ETIME)
			return ec_apply_report(s, state, EC_RESULT(ret));
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
	s->work.ours = true;
	if (state == EC_AL_PREOP)
		release_mailbox(s);
}

/* From INIT to PREOP or BOOT with the mailbox of that state. */
static struct ec_result leave_init(struct ec_slave *s, u8 state)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	bool boot = state == EC_AL_BOOT;
	struct ec_result r = { 0 };
	int ret;

	if (boot && !(s->info.boot.rx_size && s->info.boot.tx_size))
		return ec_result_fail(s, -EOPNOTSUPP, EC_CAUSE(REFUSED, .state = EC_AL_BOOT),
				      "BOOT not possible: no bootstrap mailbox in the SII");
	s->work.ours = false;
	ec_replay_forget(s);
	if (c)
		r = ec_startup_run(s, c, EC_TRANSITION(EC_AL_INIT, state));
	if (r.err)
		return ec_apply_report(s, state, r);
	ret = ec_apply_set_by(s, state, ec_leave_init);
	/* any AL status code may be due to the event of SM1: try again without */
	if (ret == -EPROTO && !s->mbox.strict && ec_mbox_present(&s->mbox)) {
		s->mbox.strict = true;
		ret = ec_apply_set(s, EC_AL_INIT) ?: ec_apply_set_by(s, state, ec_leave_init);
	}
	if (!ret)
		has_left_init(s, state);
	else if (!boot)
		release_mailbox(s);
	return ec_apply_report(s, state, EC_RESULT(ret));
}

/*
 * In PREOP a slave has no use for SYNC signals and process data. Without them the next
 * application need not take it through INIT.
 */
static void back_in_preop(struct ec_slave *s)
{
	int ret = ec_slave_has_clock(s) ? ec_dc_sync_stop(s) : 0;

	s->work.clean = !ec_apply_clear_pdos(s) && !ret;
}

static struct ec_result step_down(struct ec_slave *s, u8 want)
{
	int ret;

	run_down(s, want);
	ret = ec_apply_op_only_off(s) ?: ec_apply_set(s, want);
	/* process data have ended before a slow slave was down: it did not refuse anything */
	if (ret == -EPROTO && READ_ONCE(s->al.code) == EC_AL_CODE_SM_WATCHDOG)
		ret = ec_apply_set(s, want);
	if (ret == -EPROTO) {
		/* the stronger step; the way up from there leads to @want */
		ec_slave_warn(s, "%s refused: AL status code 0x%04x (%s); INIT follows\n",
			      ec_al_state_name(want), READ_ONCE(s->al.code),
			      ec_al_code_text(READ_ONCE(s->al.code)));
		return to_init(s);
	}
	if (!ret && want == EC_AL_PREOP)
		back_in_preop(s);
	return ec_apply_report(s, want, EC_RESULT(ret));
}

/* What was asked for has come after its time limit: the rest of that step. */
static void arrived(struct ec_slave *s, u8 state)
{
	WRITE_ONCE(s->al.awaited, 0);
	if (state == EC_AL_INIT)
		in_init(s);
	else if (!s->work.ours)
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
	WRITE_ONCE(s->work.reconfigure, true);
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
		s->work.clean = false;
	else
		WRITE_ONCE(s->work.reconfigure, false);
	return 0;
}

/* The configuration has commands from INIT on. */
static bool needs_init(const struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;

	return c && ec_startup_has(s, c, EC_TRANSITION_IP);
}

/*
 * The next state on the way down to @to: the application may have commands for steps between
 * neighbors, and none for the step over several states.
 */
static u8 next_down(const struct ec_slave *s, u8 cur, u8 to)
{
	static const u8 between[] = { EC_AL_SAFEOP, EC_AL_PREOP };
	const struct ec_config *c = ec_setup_of(s)->active_config;
	unsigned int i;

	if (!c || !s->work.ours || ec_startup_has(s, c, EC_TRANSITION(cur, to)))
		return to;
	for (i = 0; i < ARRAY_SIZE(between); i++)
		if (cur > between[i] && between[i] > to &&
		    (ec_startup_has(s, c, EC_TRANSITION(cur, between[i])) ||
		     ec_startup_leaves(s, c, between[i], to)))
			return between[i];
	return to;
}

/* One or more steps down, and the way to and from BOOT, which leads through INIT. */
static struct ec_result go_down(struct ec_slave *s, u8 cur, u8 want)
{
	u8 to = want == EC_AL_BOOT ? EC_AL_INIT : want;

	if (cur == EC_AL_BOOT)
		return to_init(s);
	to = next_down(s, cur, to);
	return to == EC_AL_INIT ? to_init(s) : step_down(s, to);
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
	if (!r.err && READ_ONCE(s->al.status) & EC_AL_ERROR)
		r = acknowledge(s);
	if (r.err)
		return r;
	cur = READ_ONCE(s->al.status) & EC_AL_STATE_MASK;
	if (cur == READ_ONCE(s->al.awaited)) {
		arrived(s, cur);
		return r;
	}
	anew = READ_ONCE(s->work.reconfigure) && want > EC_AL_PREOP;
	if (cur == EC_AL_PREOP && s->work.clean && s->work.ours && anew && !needs_init(s))
		return EC_RESULT(start_clean(s));
	if (cur != EC_AL_INIT && (!s->work.ours || anew))
		return to_init(s);
	if (setup->mapped && cur <= EC_AL_PREOP && want <= EC_AL_PREOP)
		return EC_RESULT(ec_apply_clear_fmmus(s));
	if (setup->op_only && cur != EC_AL_OP)
		return EC_RESULT(ec_apply_op_only_off(s));
	if (cur == want) {
		*there = want != EC_AL_OP || ec_apply_op_only_on(s) >= 0;
		return EC_RESULT(*there ? 0 : -EIO);
	}
	if (cur != EC_AL_INIT && (cur > want || cur == EC_AL_BOOT || want == EC_AL_BOOT))
		return go_down(s, cur, want);
	switch (cur) {
	case EC_AL_INIT:
		return leave_init(s, want == EC_AL_BOOT ? EC_AL_BOOT : EC_AL_PREOP);
	case EC_AL_PREOP:
		return ec_apply_to_safeop(s, setup->active_config);
	case EC_AL_SAFEOP:
		return ec_apply_to_op(s);
	default:
		return to_init(s);
	}
}

/* One that was lost or silent is where it was wanted. */
static void log_return(struct ec_slave *s)
{
	const struct ec_config *c = ec_setup_of(s)->active_config;
	u64 ms = div_u64(ktime_get_ns() - s->lost.seen_ns, NSEC_PER_MSEC);

	if (s->lost.seen_ns && c && READ_ONCE(s->al.status) == EC_AL_OP)
		ec_pending_back(s, ms);
	if (!c || READ_ONCE(s->al.status) == EC_AL_OP)
		s->lost.seen_ns = 0;
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
	if (there && ec_setup_of(s)->active_config && READ_ONCE(s->al.status) == EC_AL_OP)
		ec_replay_reached_op(s);
	if (there && ec_slave_set_ok(s, false)) {
		s->reply.retry_ms = 0;
		log_return(s);
	}
	if (!there)
		ec_apply_plan(s, r.err);
	if (there && ec_identify_is_due(s))
		ec_identify(s);
	if (there && READ_ONCE(s->pdos.wanted) && ec_slave_pdos_pending(s))
		ec_slave_read_coe_pdos(s);
	if (there && READ_ONCE(s->pdos.wanted) && ec_names_pending(s))
		ec_names_read(s);
	WRITE_ONCE(s->stop.worker, NULL);
	mutex_unlock(&s->lock);
}
