// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include "../base/once64.h"
#include "mailboxes.h"
#include "slave.h"
#include "survey.h"

/**
 * ec_survey_is_due() - is the next attempt for a slave that failed due?
 * @s: slave
 * @now: time (ktime), ns
 *
 * Context: Any. RT-safe.
 * Return: whether it is.
 */
bool ec_survey_is_due(const struct ec_slave *s, u64 now)
{
	u64 at;

	if (!READ_ONCE(s->note.error) && !READ_ONCE(s->reply.silent))
		return false;
	at = ec_read64(&s->reply.retry_ns);
	return at && now >= at;
}

/**
 * ec_survey_is_off() - has its worker to act because of its AL status?
 * @s: slave, without a busy worker
 * @status: its AL status
 *
 * What was asked for comes late, or the slave has fallen back by itself. An error of device
 * emulation is an acknowledge that another master has written.
 *
 * Context: Any. RT-safe.
 * Return: whether it has.
 */
bool ec_survey_is_off(const struct ec_slave *s, u16 status)
{
	u8 state = status & (EC_AL_STATE_MASK | (s->emulation ? EC_AL_ERROR : 0));

	return READ_ONCE(s->note.error) ? state == READ_ONCE(s->al.awaited) :
					  state != READ_ONCE(s->al.requested);
}

/**
 * ec_survey_lasts() - is a survey true until @bus->changes counts?
 * @survey: result of ec_survey()
 *
 * Context: The monitor thread.
 * Return: false when time alone may change it, or the end of what is going on now.
 */
bool ec_survey_lasts(const struct ec_survey *survey)
{
	return !survey->chores && !survey->exchange && !survey->failed;
}

/**
 * ec_survey() - sum up the present state of all slaves
 * @bus: bus
 * @survey: result
 *
 * What changes during the pass is seen by the next one.
 *
 * Context: The monitor thread.
 */
void ec_survey(const struct ec_bus *bus, struct ec_survey *survey)
{
	u64 now = ktime_get_ns();

	*survey = (struct ec_survey){ .chores = READ_ONCE(bus->pending) };
	ec_for_each_slave(s, bus) {
		u8 want = READ_ONCE(s->al.requested);

		survey->chores |= ec_slave_busy(s) || ec_survey_is_due(s, now) ||
				  ec_slave_pdos_pending(s);
		survey->exchange |= ec_mbox_in_use(&s->mbox);
		survey->silent |= READ_ONCE(s->reply.silent);
		survey->polled |= ec_mailboxes_polled(s);
		survey->failed |= READ_ONCE(s->note.error) || READ_ONCE(s->reply.silent);
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
			continue;
		survey->state = survey->state ?: want;
		survey->differ |= want != survey->state || READ_ONCE(s->al.status) != want;
		survey->replying++;
	}
}
