// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Commands for the steps of a slave from one AL state to another. */
#include "ecrt_int.h"

#define VALUE_MAX	0x10000

/* The values of @c behind one another: to write, expected, mask. Return: bytes. */
static size_t gather(const ec_command_t *c, __u8 *to)
{
	size_t at = 0;

	if (c->data) {
		memcpy(to, c->data, c->size);
		at = c->size;
	}
	if (!c->expect)
		return at;
	memcpy(to + at, c->expect, c->size);
	at += c->size;
	if (c->mask)
		memcpy(to + at, c->mask, c->size);
	else
		memset(to + at, 0xff, c->size);
	return at + c->size;
}

int ecrt_slave_config_command(ec_slave_config_t *sc, ec_step_t step, const ec_command_t *command)
{
	static const __u8 kinds[] = {
		[EC_COMMAND_SDO] = EC_REQUEST_SDO, [EC_COMMAND_REG] = EC_REQUEST_REG,
		[EC_COMMAND_IDN] = EC_REQUEST_SOE,
	};
	struct ec_ioc_sc_command arg = {
		.config = ec_sc_index(sc), .from = (step >> 4) & 0xf, .to = step & 0xf,
	};
	__u8 *values;
	int ret;

	if (!sc || !command || !command->size || command->size > VALUE_MAX ||
	    (!command->data && !command->expect) || (unsigned int)step > 0xff ||
	    (unsigned int)command->kind > EC_COMMAND_IDN)
		return sc ? ec_fail_sc(sc, -EINVAL, "store an invalid command for step 0x%02x",
				       (unsigned int)step) : -EINVAL;
	values = ec_zalloc(3 * command->size);
	if (!values)
		return ec_fail_sc(sc, -ENOMEM, "store a command for step 0x%02x",
				  (unsigned int)step);
	arg.flags = (command->data ? EC_COMMAND_FLAG_WRITE : 0) |
		    (command->expect ? EC_COMMAND_FLAG_CHECK : 0) |
		    (command->complete ? EC_COMMAND_FLAG_COMPLETE : 0);
	arg.kind = kinds[command->kind];
	arg.index = command->index;
	arg.subindex = command->subindex;
	arg.timeout_ms = command->timeout_ms;
	arg.size = (__u32)gather(command, values);
	arg.data = (uintptr_t)values;
	ret = ec_do_sc(sc, EC_IOC_SC_COMMAND, &arg, "store command 0x%04x for step 0x%02x",
		       command->index, (unsigned int)step);
	ec_free(values);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_command);
