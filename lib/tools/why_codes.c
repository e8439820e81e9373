// SPDX-License-Identifier: LGPL-2.1-or-later
/* Remedies for the codes of slaves. */
#include "why.h"

/* of AL status codes; others have a general remedy */
static const struct {
	u16 code;
	const char *remedy;
} al_remedies[] = {
	{ 0x0014, "load the firmware of the slave: 'ethercat firmware'" },
	{ 0x0016, "power-cycle the slave; if it stays, compare its mailbox ('ethercat slaves -v') with the manual, ask the manufacturer" },
	{ 0x0019, "let the application send outputs before the slave is in OP" },
	{ 0x001b, "let the application send in each cycle, or lengthen the watchdog: ecrt_slave_config_watchdog()" },
	{ 0x001d, "compare the outputs that are configured with those of the slave: 'ethercat config -v', 'ethercat pdos'" },
	{ 0x001e, "compare the inputs that are configured with those of the slave: 'ethercat config -v', 'ethercat pdos'" },
	{ 0x001f, "correct the watchdog, or leave that of the slave: ecrt_slave_config_watchdog()" },
	{ 0x0024, "map inputs that the slave has: 'ethercat pdos'" },
	{ 0x0025, "map outputs that the slave has: 'ethercat pdos'" },
	{ 0x002c, "check AssignActivate and cycle times against the ESI: ecrt_slave_config_dc()" },
	{ 0x002d, "check AssignActivate against the ESI: ecrt_slave_config_dc()" },
	{ 0x0030, "check AssignActivate against the ESI: ecrt_slave_config_dc()" },
	{ 0x0035, "configure a cycle time that the slave supports: ecrt_slave_config_dc()" },
};

const char *why_al_remedy(u32 code)
{
	for (size_t i = 0; i < ARRAY_SIZE(al_remedies); i++)
		if (al_remedies[i].code == code)
			return al_remedies[i].remedy;
	return "look up the code in the manual of the slave; see also its messages: 'ethercat diag', 'ethercat emergencies'";
}

/* of abort codes that have a more specific remedy than to check the SDO */
static const struct {
	u32 code;
	u32 mask;
	const char *remedy;
} sdo_remedies[] = {
	{ 0x06070010, 0xfffffffc,
	  "give the startup SDO the length that the object has: 'ethercat sdos'" },
	{ 0x06090030, 0xfffffffc,
	  "give the startup SDO a value that the slave takes: limits in 'ethercat sdos -v', or the manual" },
	{ 0x08000020, 0xfffffffe,
	  "release the local control of the slave (panel, other fieldbus), then restart the application" },
	{ 0, 0,
	  "correct or remove the startup SDO in the application: 'ethercat sdos', 'ethercat config -v'" },
};

const char *why_sdo_remedy(u32 code)
{
	size_t i = 0;

	while ((code & sdo_remedies[i].mask) != sdo_remedies[i].code)
		i++;
	return sdo_remedies[i].remedy;
}
