// SPDX-License-Identifier: GPL-2.0-only
/*
 * Watchdogs. That of the process data runs from the first write to an SM with
 * the watchdog bit, not from the activation of the SM.
 *
 * That of the PDI: the CPU of a slave looks at its controller all the time,
 * so the model lets it run only while the CPU hangs (ec_esc_fault.app_mute);
 * what it still accesses then starts it again.
 */
#include "esc_int.h"

static u64 time_ns(const struct ec_esc *esc, u16 reg)
{
	return (ec_esc_get16(esc, EC_REG_WD_DIVIDER) + 2ull) * 40 *
	       ec_esc_get16(esc, reg);
}

/* time of the process data watchdog, 0: off */
u64 ec_esc_wd_ns(const struct ec_esc *esc)
{
	return time_ns(esc, EC_REG_WD_SM);
}

/* the PDI was accessed, hangs or works again, or the time was written */
void ec_esc_wd_pdi_trigger(struct ec_esc *esc, u64 now)
{
	u64 ns;

	if (!esc->fault.app_mute && !esc->wd_pdi_expired) {
		esc->wd_pdi_due = EC_ESC_NEVER;
		return;
	}
	ns = time_ns(esc, EC_REG_WD_PDI);
	esc->wd_pdi_due = esc->fault.app_mute && ns ? now + ns : EC_ESC_NEVER;
	if (esc->wd_pdi_expired)
		ec_esc_event(esc, EC_ECAT_EVENT_DL, 0);
	esc->wd_pdi_expired = false;
	ec_sim_touch(esc);
}

void ec_esc_wd_pdi_expire(struct ec_esc *esc)
{
	u8 *count = esc->mem + EC_REG_WD_PDI_COUNT;

	esc->wd_pdi_due = EC_ESC_NEVER;
	if (ec_esc_bug(esc, EC_SIM_BUG_WD_PDI))
		return;
	esc->wd_pdi_expired = true;
	if (*count != 0xff)
		++*count;
	ec_esc_event(esc, EC_ECAT_EVENT_DL, 0);
}

bool ec_esc_wd_ok(const struct ec_esc *esc)
{
	return !ec_esc_wd_ns(esc) || esc->wd_due != EC_ESC_NEVER;
}

void ec_esc_wd_trigger(struct ec_esc *esc, u64 now)
{
	ec_esc_wd_start(esc, now, ec_esc_wd_ns(esc));
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
	if (n == esc->cfg.sms || !ec_esc_wd_ns(esc))
		esc->wd_due = EC_ESC_NEVER;
	else if (esc->wd_due > now + ec_esc_wd_ns(esc))
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
