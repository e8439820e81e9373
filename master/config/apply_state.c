// SPDX-License-Identifier: GPL-2.0-only
/* The request of an AL state, why that failed, and when the next attempt is. */
#include "config.h"
#include "../bus/result.h"
#include "apply_state.h"

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
	u16 code = READ_ONCE(s->al.code);

	if (err == -EPROTO && state == EC_AL_SAFEOP && refusal[0])
		/* the first cause, not only what follows from it */
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, &setup->pdo_cause,
			      "%.160s; then SAFEOP refused: AL status code 0x%04x (%s)", refusal,
			      code, ec_al_code_text(code));
	else if (state == EC_AL_PREOP && s->note.sii_flaw[0] && (err == -EPROTO || err == -ETIME))
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(EEPROM, .state = state),
			      "%.170s; then PREOP %s", s->note.sii_flaw,
			      err == -ETIME ? "not reached in time" : "refused");
	else if (err == -EPROTO)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED,
			      EC_CAUSE(REFUSED, .state = state, .code = code),
			      "%s refused: AL status code 0x%04x (%s)", ec_al_state_name(state),
			      code, ec_al_code_text(code));
	else if (err == -ETIME)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(SLOW, .state = state),
			      "%s not reached in time, AL state %s", ec_al_state_name(state),
			      ec_al_state_name(READ_ONCE(s->al.status) & EC_AL_STATE_MASK));
	else if (err == -ENOMEM)
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(MEMORY, .state = state),
			      "no memory before %s, the master tries again; free memory of this computer",
			      ec_al_state_name(state));
	else
		ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, EC_CAUSE(FRAMES, .state = state),
			      "communication failed before %s (%pe)", ec_al_state_name(state),
			      ERR_PTR(err));
}

/**
 * ec_apply_report() - report why a slave was not brought to a state
 * @s: slave
 * @state: AL state
 * @r: result of the way there; a failure that is reported already is not reported again
 *
 * Nothing is reported of a way that was aborted, of a slave that is not in the list any more, or
 * to a state that is not requested any more.
 *
 * Context: The slave's worker.
 * Return: @r, with a failure marked as reported if it is.
 */
struct ec_result ec_apply_report(struct ec_slave *s, u8 state, struct ec_result r)
{
	const struct ec_setup *setup = ec_setup_of(s);

	if (!r.err || (!r.reported && (is_aborted(r.err) || READ_ONCE(s->stop.gone))))
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
static bool is_transient(const struct ec_slave *s, int err)
{
	u16 code = READ_ONCE(s->al.code);

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
	return s->reply.retry_ms && (!err || is_aborted(err));
}

/**
 * ec_apply_plan() - plan another attempt if the last one has failed and the next one may not
 * @s: slave that is not in its requested state
 * @err: errno of the last attempt, 0: it has no result
 *
 * Context: The slave's worker.
 */
void ec_apply_plan(struct ec_slave *s, int err)
{
	lockdep_assert_held(&s->lock);
	if (READ_ONCE(s->note.error) != EC_SLAVE_CONFIG_FAILED ||
	    !(is_transient(s, err) || is_undecided(s, err)))
		return;
	/* wait that limit once more: another request may restart the transition */
	if (err == -ETIME && READ_ONCE(s->al.awaited))
		s->reply.retry_ms = max(s->reply.retry_ms, s->al.awaited_ms / 2);
	ec_slave_retry(s, EC_RETRY_MAX_MS);
}

/* What the application allows for a transition, ms; 0: the default. */
static u32 apply_limit(const struct ec_slave *s, u8 from, u8 to)
{
	const struct ec_config *c = ec_config_of(s);

	return c && ec_al_state_valid(from) ? c->timeout_ms[from][to] : 0;
}

/**
 * ec_apply_waits_for() - what a reason shows while the worker waits
 * @s: slave
 * @what: constant text; NULL: it does not wait any more
 *
 * Context: The slave's worker.
 */
void ec_apply_waits_for(struct ec_slave *s, const char *what)
{
	WRITE_ONCE(ec_setup_of(s)->waits_for, what);
}

/**
 * ec_apply_set_by() - bring a slave to a neighbouring AL state
 * @s: slave
 * @state: AL state
 * @set: ec_al_set() or ec_leave_init()
 *
 * Context: The slave's worker. Waits for bus traffic, until the time limit.
 * Return: as @set; -ECANCELED for a state beyond PREOP while the computer reboots.
 */
int ec_apply_set_by(struct ec_slave *s, u8 state,
		    int (*set)(struct ec_slave *s, u8 state, u32 timeout_ms))
{
	int ret;

	/* the computer reboots since the worker has begun this way */
	if (state & EC_AL_BEYOND_PREOP && READ_ONCE(s->bus->down))
		return -ECANCELED;
	ec_apply_waits_for(s, state == EC_AL_OP ? "the slave to reach OP" :
			      state == EC_AL_SAFEOP ? "the slave to reach SAFEOP" :
						      "the slave to change its state");
	ret = set(s, state, apply_limit(s, READ_ONCE(s->al.status) & EC_AL_STATE_MASK, state));
	ec_apply_waits_for(s, NULL);
	return ret;
}
