// SPDX-License-Identifier: GPL-2.0-only
/* Datagrams of any command, and which of them may change how the bus runs. */
#include <linux/capability.h>
#include "../base/limits.h"
#include "../carry/xfer.h"
#include "../session/session.h"
#include "../wire/regs.h"
#include "ioctl.h"
#include "master.h"

static_assert(EC_MAX_DATAGRAM_SIZE == EC_DGRAM_DATA_MAX);

/* registers that run the bus; a latch input (0x09a8) or the EEPROM interface (0x0500) does not */
static const struct {
	u16 first;
	u16 last;
	const char *name;
} runs_bus[] = {
	{ EC_REG_STATION, EC_REG_STATION + 1, "station address" },
	{ EC_REG_DL_CONTROL, EC_REG_DL_CONTROL + 3, "DL control" },
	{ EC_REG_AL_CONTROL, EC_REG_AL_CONTROL + 1, "AL control" },
	{ EC_REG_ECAT_MASK, EC_REG_ECAT_MASK + 1, "event mask" },
	{ EC_REG_FMMU(0), EC_REG_FMMU(16) - 1, "FMMU" },
	{ EC_REG_SM(0), EC_REG_SM(16) - 1, "SyncManager" },
	{ EC_REG_DC_RECV(0), EC_REG_DC_LATCH0_CTRL - 1, "distributed clock" },
};

/**
 * ec_ioc_runs_bus() - find registers that run the bus
 * @address: first register
 * @bytes: how many
 *
 * Context: Any.
 * Return: what they are, or NULL: none of them does.
 */
const char *ec_ioc_runs_bus(u16 address, u32 bytes)
{
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(runs_bus); i++)
		if (address <= runs_bus[i].last && address + bytes > runs_bus[i].first)
			return runs_bus[i].name;
	return NULL;
}

/* Why a datagram may change how the bus runs; NULL: it does not. */
static const char *write_risk(const struct ec_dg *dg)
{
	if (!ec_cmd_writes(dg->cmd))
		return NULL;
	switch (dg->cmd) {
	case EC_CMD_BWR:
	case EC_CMD_BRW:
	case EC_CMD_ARMW:
	case EC_CMD_FRMW:
		return "all slaves";
	case EC_CMD_LWR:
	case EC_CMD_LRW:
		return "a logical address";
	}
	return ec_ioc_runs_bus(dg->ado, dg->len);
}

/**
 * ec_ioc_may_write() - check that the caller may send a datagram
 * @call: command
 * @dg: its datagram
 *
 * While a session is active, only its application, or a process with CAP_SYS_ADMIN, may write to
 * all slaves, to a logical address, or to registers that run the bus.
 *
 * Context: Process, without a lock. May sleep.
 * Return: 0 or -EPERM with the reason noted.
 */
int ec_ioc_may_write(struct ec_call *call, const struct ec_dg *dg)
{
	struct ec_sessions *ss = &call->master->sessions;
	const char *what = write_risk(dg);
	char who[EC_UAPI_STRING];
	bool refused;

	if (!what)
		return 0;
	ec_sessions_lock(ss);
	refused = ss->session && READ_ONCE(ss->session->wanted.active) &&
		  ss->session->cycle.owner != call->file;
	if (refused && !ec_session_process(ss->session, who, sizeof(who)))
		strscpy(who, "an application", sizeof(who));
	ec_sessions_unlock(ss);
	if (!refused || capable(CAP_SYS_ADMIN))
		return 0;
	return ec_refuse(call, -EPERM,
			 "%s runs the bus: a write to %s needs CAP_SYS_ADMIN (root), or stop the application first",
			 who, what);
}

static int datagram_failed(struct ec_call *call, const struct ec_ioc_datagram *i, int ret)
{
	switch (ret) {
	case 0:
	case -EINTR:
		return ret;
	case -ETIMEDOUT:
		return ec_refuse(call, ret,
				 "datagram of command %u to 0x%08x: no reply; check the cables",
				 i->command, i->address);
	case -ENODEV:
	case -ENETDOWN:
		return ec_refuse(call, ret,
				 "datagram of command %u to 0x%08x: the main device is missing or has no link; check the cable",
				 i->command, i->address);
	default:
		return ec_refuse(call, ret, "datagram of command %u to 0x%08x: cannot send (%pe)",
				 i->command, i->address, ERR_PTR(ret));
	}
}

/* Sent once: the master does not know whether a slave may execute the command twice. */
int ec_ioc_datagram(struct ec_call *call)
{
	struct ec_ioc_datagram *i = call->arg;
	struct ec_dg dg = {
		.cmd = i->command, .adp = i->address & 0xffff, .ado = i->address >> 16,
		.len = i->size, .data = call->data,
	};
	int ret;

	if (i->command > EC_CMD_FRMW)
		return ec_refuse(call, -EINVAL, "%u is no EtherCAT command; use 0 (NOP) to %u (FRMW)",
				 i->command, EC_CMD_FRMW);
	if (!i->size || i->size > EC_MAX_DATAGRAM_SIZE)
		return ec_refuse(call, -EINVAL, "a datagram has 1 to %u bytes, not %u",
				 EC_MAX_DATAGRAM_SIZE, i->size);
	ret = ec_ioc_may_write(call, &dg);
	if (ret)
		return ret;
	ret = ec_xfer(&call->master->links, &dg, 1);
	i->working_counter = dg.wkc;
	return datagram_failed(call, i, ret);
}
