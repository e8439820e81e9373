// SPDX-License-Identifier: GPL-2.0-only
/* Faults that wait for a frame, in descriptions. */
#include "describe_int.h"

/**
 * ec_desc_when() - where a frame is when something happens to it
 * @d: description, a fault statement
 * @when: result; stays as it is without the word
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_when(struct ec_desc *d, enum ec_sim_when *when)
{
	struct ec_desc_word w = ec_desc_value(d, "when");

	if (!w.s)
		return 0;
	*when = ec_desc_is(&w, "out") ? EC_SIM_WHEN_OUT : EC_SIM_WHEN_BACK;
	return ec_desc_is(&w, "out") || ec_desc_is(&w, "back") ? 0 :
		ec_desc_fail(d, "invalid when '", &w, "': expected out or back");
}

/**
 * ec_desc_register() - which frames count
 * @d: description, a fault statement
 * @f: the fault
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_register(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 reg = -1;

	if (ec_desc_number(d, "register", 0, 0xFFFF, &reg))
		return -EINVAL;
	f->by_register = reg >= 0;
	f->reg = (u16)max_t(s64, reg, 0);
	return 0;
}

/**
 * ec_desc_wait() - the frame that a fault waits for
 * @d: description, a fault statement
 * @f: the fault
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_wait(struct ec_desc *d, struct ec_sim_fault *f)
{
	s64 n = 0;

	if (ec_desc_number(d, "frame", 1, 0x7FFFFFFF, &n))
		return -EINVAL;
	f->frame = (u32)n;
	if (!n)
		return 0;
	if (ec_desc_register(d, f) || ec_desc_when(d, &f->when))
		return -EINVAL;
	return ec_desc_time(d, "after", EC_DESC_TIME_MAX, &f->after_ns);
}
