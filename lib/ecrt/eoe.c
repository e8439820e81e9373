// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Network devices of slaves with EoE. */
#include "ecrt_int.h"

static int wish(ec_master_t *master, uint16_t alias, uint16_t posn, __u32 what)
{
	struct ec_ioc_eoe_wish arg = {
		.wish = what,
		.slave = {
			.kind = alias ? EC_ADDRESS_ALIAS : EC_ADDRESS_POSITION,
			.alias = alias, .position = posn,
		},
	};

	if (!master)
		return -EINVAL;
	return ec_do(master, EC_IOC_EOE_WISH, &arg, "%s the network device of slave %u:%u",
		     what == EC_EOE_WISH_ON ? "make" : "remove", alias, posn);
}

int ecrt_master_eoe_addif(ec_master_t *master, uint16_t alias, uint16_t posn)
{
	return wish(master, alias, posn, EC_EOE_WISH_ON);
}
EXPORT_SYMBOL_GPL(ecrt_master_eoe_addif);

int ecrt_master_eoe_delif(ec_master_t *master, uint16_t alias, uint16_t posn)
{
	return wish(master, alias, posn, EC_EOE_WISH_OFF);
}
EXPORT_SYMBOL_GPL(ecrt_master_eoe_delif);

int ecrt_master_eoe_is_open(ec_master_t *master)
{
	struct ec_ioc_eoe arg = { 0 };
	__u32 i;

	if (!master)
		return -EINVAL;
	for (i = 0; ; i++) {
		arg = (struct ec_ioc_eoe){ .index = i };
		/* there is no more */
		if (ec_command(master, EC_IOC_EOE, &arg))
			return 0;
		if (arg.state & EC_EOE_UP)
			return 1;
	}
}
EXPORT_SYMBOL_GPL(ecrt_master_eoe_is_open);

/* The mailboxes carry the frames without calls of the application. */
int ecrt_master_eoe_process(ec_master_t *master)
{
	return master ? 0 : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_master_eoe_process);
