// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application for transitions of a slave. */
#include <linux/err.h>
#include "../base/limits.h"
#include "../bus/pdo.h"
#include "../config/config.h"
#include "../wire/soe.h"
#include "ioctl.h"

/* steps between neighboring AL states, and down over several */
static const u8 steps[] = {
	EC_TRANSITION(EC_AL_INIT, EC_AL_PREOP), EC_TRANSITION(EC_AL_PREOP, EC_AL_SAFEOP),
	EC_TRANSITION(EC_AL_SAFEOP, EC_AL_OP), EC_TRANSITION(EC_AL_OP, EC_AL_SAFEOP),
	EC_TRANSITION(EC_AL_OP, EC_AL_PREOP), EC_TRANSITION(EC_AL_OP, EC_AL_INIT),
	EC_TRANSITION(EC_AL_SAFEOP, EC_AL_PREOP), EC_TRANSITION(EC_AL_SAFEOP, EC_AL_INIT),
	EC_TRANSITION(EC_AL_PREOP, EC_AL_INIT), EC_TRANSITION(EC_AL_INIT, EC_AL_BOOT),
	EC_TRANSITION(EC_AL_BOOT, EC_AL_INIT),
};

static int check_step(struct ec_call *call, const struct ec_ioc_sc_command *i)
{
	bool mailbox = i->from != EC_AL_INIT && i->from != EC_AL_BOOT;
	unsigned int k;

	for (k = 0; k < ARRAY_SIZE(steps); k++)
		if (i->from < 0x10 && i->to < 0x10 && steps[k] == EC_TRANSITION(i->from, i->to))
			break;
	if (k == ARRAY_SIZE(steps))
		return ec_refuse(call, -EINVAL, "the master makes no step from AL state %u to %u",
				 i->from, i->to);
	if (i->kind != EC_REQUEST_REG && !mailbox)
		return ec_refuse(call, -EINVAL,
				 "a slave has no mailbox for this command in %s; only registers are possible there",
				 ec_al_state_name(i->from));
	return 0;
}

static int check_register(struct ec_call *call, const struct ec_ioc_sc_command *i, u32 bytes)
{
	const char *what = ec_ioc_runs_bus(i->index, bytes);

	if (bytes > EC_MAX_REG_SIZE || i->index + bytes > 0x10000)
		return ec_refuse(call, -EINVAL,
				 "size must be 1 to %u bytes and end below 0x10000, not %u at 0x%04x",
				 EC_MAX_REG_SIZE, bytes, i->index);
	if (what && i->flags & EC_COMMAND_FLAG_WRITE)
		return ec_refuse(call, -EINVAL, "the master itself writes register 0x%04x (%s)",
				 i->index, what);
	return 0;
}

static int check_sdo(struct ec_call *call, const struct ec_ioc_sc_command *i)
{
	bool pdos = ec_pdo_is_mapping(i->index) || ec_pdo_is_assign(i->index) ||
		    i->index == EC_PDO_MODULES;

	if (pdos && i->flags & EC_COMMAND_FLAG_WRITE)
		return ec_refuse(call, -EINVAL,
				 "SDO 0x%04x changes PDOs; use ecrt_slave_config_sdo(), which the master follows",
				 i->index);
	return 0;
}

/* Its protocol, and what that allows. */
static int check_kind(struct ec_call *call, const struct ec_ioc_sc_command *i, u32 bytes, u8 *type)
{
	if (i->flags & EC_COMMAND_FLAG_COMPLETE && i->kind != EC_REQUEST_SDO)
		return ec_refuse(call, -EINVAL, "only an SDO accesses a whole object");
	switch (i->kind) {
	case EC_REQUEST_SDO:
		*type = EC_STARTUP_SDO;
		return check_sdo(call, i);
	case EC_REQUEST_SOE:
		*type = EC_STARTUP_IDN;
		if (i->subindex >= EC_SOE_DRIVES)
			return ec_refuse(call, -EINVAL, "drive number must be 0 to 7, not %u",
					 i->subindex);
		return 0;
	case EC_REQUEST_REG:
		*type = EC_STARTUP_REG;
		return check_register(call, i, bytes);
	default:
		return ec_refuse(call, -EINVAL, "%u is no kind of command", i->kind);
	}
}

/* Bytes of the value, 0: the size is invalid. */
static u32 value_bytes(const struct ec_ioc_sc_command *i)
{
	u32 parts = (i->flags & EC_COMMAND_FLAG_WRITE ? 1 : 0) +
		    (i->flags & EC_COMMAND_FLAG_CHECK ? 2 : 0);

	if (!parts || i->size % parts || i->size / parts > EC_MAX_SDO_SIZE)
		return 0;
	return i->size / parts;
}

int ec_ioc_sc_command(struct ec_call *call)
{
	const struct ec_ioc_sc_command *i = call->arg;
	u32 bytes = value_bytes(i);
	struct ec_startup what = {
		.type = EC_STARTUP_COMMAND, .transition = EC_TRANSITION(i->from, i->to),
		.index = i->index, .sub = i->subindex, .timeout_ms = i->timeout_ms,
		.complete = i->flags & EC_COMMAND_FLAG_COMPLETE, .size = i->size,
		.how = (i->flags & EC_COMMAND_FLAG_WRITE ? EC_STARTUP_WRITES : 0) |
		       (i->flags & EC_COMMAND_FLAG_CHECK ? EC_STARTUP_CHECKS : 0),
	};
	int ret;

	if (!bytes)
		return ec_refuse(call, -EINVAL,
				 "a command writes or checks 1 to %u bytes; %u bytes of data are invalid",
				 EC_MAX_SDO_SIZE, i->size);
	if (i->timeout_ms > EC_MAX_SDO_MS)
		return ec_refuse(call, -EINVAL, "the time limit is at most %u ms, not %u",
				 EC_MAX_SDO_MS, i->timeout_ms);
	ret = check_step(call, i) ?: check_kind(call, i, bytes, &what.kind);
	if (ret)
		return ret;
	ret = PTR_ERR_OR_ZERO(ec_startup_add(call->config, &what, call->data));
	if (ret == -ENOSPC)
		ec_refuse(call, ret, "a slave configuration has at most %u commands",
			  EC_MAX_SC_COMMANDS);
	return ec_ioc_limit(call, ret);
}
