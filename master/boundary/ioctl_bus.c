// SPDX-License-Identifier: GPL-2.0-only
/* Commands that cause bus traffic or change the state of slaves. */
#include "../base/report.h"
#include "api.h"
#include "ioctl.h"
#include "master.h"
#include "../session/activate.h"
#include "../session/reserve.h"
#include "../session/session.h"
#include "../session/session_attach.h"
#include "../bus/border.h"
#include "../bus/bus_list.h"
#include "../bus/line_errors.h"
#include "../bus/ports.h"
#include "../wire/port_text.h"
#include "../bus/slave.h"
#include "../carry/xfer.h"

/* An emergency access needs no scan: it goes to a ring position. Others go to a known slave. */
static int reg_address(struct ec_call *call, struct ec_dg *dg, u8 cmd, unsigned int *position)
{
	const struct ec_ioc_reg *i = call->arg;
	int ret;

	*position = i->slave.position;
	if (i->flags & EC_REG_FLAG_EMERGENCY) {
		if (i->slave.kind != EC_ADDRESS_POSITION)
			return ec_refuse(call, -EINVAL,
					 "an emergency access goes to a ring position, not to another kind of address");
		dg->cmd = cmd == EC_CMD_FPWR ? EC_CMD_APWR : EC_CMD_APRD;
		dg->adp = -i->slave.position;
		return 0;
	}
	ret = ec_ioc_get_slave(call, &i->slave);
	if (ret)
		return ret;
	*position = call->slave->position;
	dg->cmd = cmd;
	dg->adp = call->slave->station;
	return 0;
}

static int reg_access(struct ec_call *call, u8 cmd)
{
	struct ec_master *m = call->master;
	const struct ec_ioc_reg *i = call->arg;
	struct ec_dg dg = { .ado = i->address, .len = i->size, .data = call->data };
	u16 expected = cmd == EC_CMD_FPRW ? 3 : 1;
	unsigned int position;
	int ret;

	if (!i->size || i->size > EC_MAX_REG_SIZE || i->address + i->size > 0x10000)
		return ec_refuse(call, -EINVAL,
				 "size must be 1 to %u bytes and end below 0x10000, not %u at 0x%04x",
				 EC_MAX_REG_SIZE, i->size, i->address);
	ret = reg_address(call, &dg, cmd, &position);
	if (ret)
		return ret;
	ret = ec_ioc_may_write(call, &dg) ?: ec_xfer(&m->links, &dg, 1);
	switch (ret) {
	case 0:
		break;
	case -ETIMEDOUT:
		return ec_refuse(call, ret,
				 "no reply to register access 0x%04x at slave %u; check the cables",
				 i->address, position);
	case -EINTR:
	case -EPERM:
		return ret;
	case -ENODEV:
	case -ENETDOWN:
		return ec_refuse(call, ret,
				 "register access 0x%04x at slave %u: the main device is missing or has no link; check the cable",
				 i->address, position);
	default:
		return ec_refuse(call, ret, "register access 0x%04x at slave %u: cannot send (%pe)",
				 i->address, position, ERR_PTR(ret));
	}
	if (dg.wkc != expected)
		return ec_refuse(call, -EIO,
				 "slave %u did not execute access to 0x%04x: working counter %u, expected %u",
				 position, i->address, dg.wkc, expected);
	if (ec_cmd_writes(dg.cmd) && call->slave)
		ec_line_errors_written(call->slave, i->address, i->size);
	return 0;
}

int ec_ioc_reg_read(struct ec_call *call)
{
	return reg_access(call, EC_CMD_FPRD);
}

int ec_ioc_reg_write(struct ec_call *call)
{
	return reg_access(call, EC_CMD_FPWR);
}

/* One datagram reads before it writes: no count of a register that it clears is lost. */
int ec_ioc_reg_rdwr(struct ec_call *call)
{
	return reg_access(call, EC_CMD_FPRW);
}

int ec_ioc_state(struct ec_call *call)
{
	struct ec_ioc_state *i = call->arg;
	struct ec_slave *s = call->slave;
	char why[EC_UAPI_REASON];

	if (!ec_al_state_valid(i->state))
		return ec_refuse(call, -EINVAL,
				 "%u is no AL state; use INIT, PREOP, BOOT, SAFEOP or OP",
				 i->state);
	if (i->timeout_ms > EC_MAX_AL_MS)
		return ec_refuse(call, -EINVAL,
				 "a transition may take at most %u ms, not %u", EC_MAX_AL_MS,
				 i->timeout_ms);
	if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
		return ec_refuse(call, -EIO, "slave %u could not be read: %.160s", s->position,
				 ec_slave_why(s, why, sizeof(why)));
	ec_slave_request_anew(s, i->state, i->timeout_ms);
	return 0;
}

int ec_ioc_rescan(struct ec_call *call)
{
	struct ec_master *m = call->master;
	char who[EC_UAPI_STRING];

	if (READ_ONCE(m->bus.held)) {
		if (READ_ONCE(m->api->reserved) ||
		    !ec_session_owner_text(&m->sessions, who, sizeof(who)))
			strscpy(who, "an application", sizeof(who));
		return ec_refuse(call, -EBUSY,
				 "the list of slaves is held: %s has reserved the master and must activate or release it first",
				 who);
	}
	if (ec_bus_scan_awaited(&m->bus))
		return ec_refuse(call, -EBUSY,
				 "another program waits until scans have ended and slaves have settled; try again later");
	/* slaves would get other addresses meanwhile */
	if (atomic_read(&m->bus.writes))
		return ec_refuse(call, -EBUSY,
				 "the EEPROM of a slave is being written; try again later");
	ec_ports_retry(&m->bus);
	ec_bus_rescan(&m->bus);
	return 0;
}

/* Why is no device let in at a port? */
static int no_device(struct ec_call *call, const struct ec_slave *s, u32 port, u32 kept)
{
	if (kept)
		return ec_refuse(call, -ENOENT, "port %u of slave %u: %s; %s", port, s->position,
				 ec_port_text(kept)->reason, ec_port_text(kept)->remedy);
	return ec_refuse(call, -ENOENT,
			 "no device waits behind port %u of slave %u; 'ethercat slaves' lists the closed ports",
			 port, s->position);
}

int ec_ioc_let_in(struct ec_call *call)
{
	const struct ec_ioc_let_in *i = call->arg;
	const struct ec_behind what = {
		.vendor = i->vendor_id, .product = i->product_code,
		.revision = i->revision_number, .serial = i->serial_number,
	};
	struct ec_slave *s = call->slave;
	u32 kept, wait_s;
	int ret;

	if (!i->port || i->port >= EC_UAPI_PORTS)
		return ec_refuse(call, -EINVAL, "devices are let in by the ports 1 to %u, not %u",
				 EC_UAPI_PORTS - 1, i->port);
	down_read(&s->bus->topo);
	kept = ec_ports_kept(s, i->port, &wait_s);
	ret = ec_ports_let_in(s, i->port, &what);
	up_read(&s->bus->topo);
	switch (ret) {
	case -ENOENT:
		return no_device(call, s, i->port, ec_port_text(kept)->device ? 0 : kept);
	case -ESTALE:
		return ec_refuse(call, ret,
				 "another device is behind port %u of slave %u now; see 'ethercat slaves'",
				 i->port, s->position);
	default:
		return ret;
	}
}

int ec_ioc_debug(struct ec_call *call)
{
	struct ec_ioc_debug *i = call->arg;

	if (i->level > 2)
		return ec_refuse(call, -EINVAL, "debug level must be 0, 1 or 2, not %u", i->level);
	if (xchg(&call->master->base->debug, i->level) != i->level)
		ec_report(call->master->base, EC_EVENT_DEBUG, i->level);
	return 0;
}

int ec_ioc_reset(struct ec_call *call)
{
	ec_session_try_again(&call->master->sessions);
	return 0;
}

int ec_ioc_slaves_down(struct ec_call *call)
{
	int ret = ec_session_slaves_down(call->session);

	return ret == -EINVAL ? ec_refuse(call, ret, "the master is not active") : ret;
}

int ec_ioc_end_detached(struct ec_call *call)
{
	switch (ec_session_end_detached(&call->master->sessions)) {
	case 0:
		return 0;
	case -ENOENT:
		return ec_refuse(call, -ENOENT, "master %u has no session",
				 call->master->base->index);
	default:
		return ec_refuse(call, -EBUSY,
				 "session of master %u still has its application; stop it first",
				 call->master->base->index);
	}
}
