// SPDX-License-Identifier: GPL-2.0-only
/* Ethernet behind EoE: option of a slave, and its faults. */
#include "describe_int.h"

/**
 * ec_desc_eoe() - eoe= of a slave statement
 * @d: description
 * @p: result
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_eoe(struct ec_desc *d, struct ec_app_params *p)
{
	struct ec_desc_word w = ec_desc_value(d, "eoe");

	p->eoe = ec_desc_is(&w, "host") ? EC_APP_EOE_HOST :
		 ec_desc_is(&w, "switch") ? EC_APP_EOE_SWITCH : EC_APP_EOE_NONE;
	if (w.s && !p->eoe)
		return ec_desc_fail(d, "invalid eoe '", &w, "': expected host or switch");
	return 0;
}

/**
 * ec_desc_eoe_fault() - kind of a fault of the Ethernet
 * @d: description
 * @f: result, its slave is known
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_eoe_fault(struct ec_desc *d, struct ec_sim_fault *f)
{
	static const char * const kinds[EC_SIM_EOE_FAULTS] = {
		"good", "interleave", "stamp", "short", "lost", "offset", "number", "endless",
		"size", "flood", "spoof", "ethercat", "udp", "refuse",
	};
	struct ec_desc_word *w = ec_desc_next(d);
	s64 every = 1;

	if (!ec_app_of(ec_sim_at(d->sim, (u32)f->slave))->eoe)
		return ec_desc_fail(d, "the slave has no Ethernet; add eoe=host or eoe=switch to it", NULL, "");
	for (u32 i = 0; i < ARRAY_SIZE(kinds); i++) {
		if (!ec_desc_is(w, kinds[i]))
			continue;
		if (ec_desc_number(d, "every", 1, 0xFFFFFFFF, &every))
			return -EINVAL;
		f->arg = i;
		f->arg2 = (u32)every;
		return 0;
	}
	return ec_desc_fail(d, "invalid eoe fault: expected good, interleave, stamp, short, lost, offset, number, endless, size, flood, spoof, ethercat, udp or refuse",
			    NULL, "");
}
