// SPDX-License-Identifier: GPL-2.0-only
/*
 * Process data watchdog. It runs from the first write to an SM with the
 * watchdog bit, not from the activation of the SM. The PDI watchdog never
 * expires: the model's applications never hang in that way.
 */
#include "esc_int.h"

static u64 period_ns(const struct ec_esc *esc)
{
	return (ec_esc_get16(esc, EC_REG_WD_DIVIDER) + 2ull) * 40 *
	       ec_esc_get16(esc, EC_REG_WD_SM);
}

bool ec_esc_wd_ok(const struct ec_esc *esc)
{
	return !period_ns(esc) || esc->wd_due != EC_ESC_NEVER;
}

void ec_esc_wd_trigger(struct ec_esc *esc, u64 now)
{
	u64 ns = period_ns(esc);

	esc->wd_due = ns ? now + ns : EC_ESC_NEVER;
	ec_sim_touch(esc);
}

/* SM pages or watchdog times were written */
void ec_esc_wd_config(struct ec_esc *esc, u64 now)
{
	int n;

	if (esc->wd_due == EC_ESC_NEVER)
		return;
	for (n = 0; n < esc->cfg.sms; n++)
		if (esc->sm[n].active &&
		    esc->sm[n].page.control & EC_SM_WATCHDOG)
			break;
	if (n == esc->cfg.sms || !period_ns(esc))
		esc->wd_due = EC_ESC_NEVER;
	else if (esc->wd_due > now + period_ns(esc))
		ec_esc_wd_trigger(esc, now);
}

void ec_esc_wd_expire(struct ec_esc *esc, u64 now)
{
	u8 *count = esc->mem + EC_REG_WD_SM_COUNT;

	if (ec_esc_bug(esc, EC_SIM_BUG_WD_DEAF)) {
		ec_esc_wd_trigger(esc, now);
		return;
	}
	esc->wd_due = EC_ESC_NEVER;
	if (*count != 0xff)
		++*count;
	esc->al_event |= EC_AL_EVENT_WD;
	if (esc->app_ops && esc->app_ops->watchdog && esc->eep.loaded)
		esc->app_ops->watchdog(esc, now);
}
