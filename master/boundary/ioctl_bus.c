// SPDX-License-Identifier: GPL-2.0-only
/* Commands that cause bus traffic or change the state of slaves. */
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "ioctl.h"
#include "../master.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../link/xfer.h"

static int reg_check(struct ec_file *f, const struct ec_ioc_reg *i)
{
	if (!i->size || i->size > EC_MAX_REG_SIZE || i->address + i->size > 0x10000)
		return ec_refuse(f, -EINVAL,
				 "size must be 1 to %u bytes and end below 0x10000, not %u at 0x%04x",
				 EC_MAX_REG_SIZE, i->size, i->address);
	return 0;
}

static int reg_access(struct ec_file *f, const struct ec_ioc_reg *i, u8 cmd, u8 *buf)
{
	struct ec_master *m = f->master;
	struct ec_dg dg = { .ado = i->address, .len = i->size, .data = buf };
	bool write = cmd == EC_CMD_FPWR;
	struct ec_slave *s;
	int ret = 0;

	if (i->flags & EC_REG_FLAG_EMERGENCY) {
		dg.cmd = write ? EC_CMD_APWR : EC_CMD_APRD;
		dg.adp = -i->position;
	} else {
		s = ec_ioc_get_slave(f, i->position, &ret);
		if (!s)
			return ret;
		dg.cmd = cmd;
		dg.adp = s->station;
		ec_slave_unref(s);
	}
	ret = ec_xfer(&m->links, &dg, 1);
	switch (ret) {
	case 0:
		break;
	case -ETIMEDOUT:
		return ec_refuse(f, ret, "no reply to register access 0x%04x at slave %u; check the cables",
				 i->address, i->position);
	case -EINTR:
		return ret;
	case -ENODEV:
	case -ENETDOWN:
		return ec_refuse(f, ret, "register access 0x%04x at slave %u: the main device is missing or has no link; check the cable",
				 i->address, i->position);
	default:
		return ec_refuse(f, ret, "register access 0x%04x at slave %u: cannot send (%pe)",
				 i->address, i->position, ERR_PTR(ret));
	}
	if (dg.wkc != 1)
		return ec_refuse(f, -EIO, "slave %u did not execute access to 0x%04x: working counter %u, expected 1",
				 i->position, i->address, dg.wkc);
	return 0;
}

int ec_ioc_reg_read(struct ec_file *f, void *arg)
{
	struct ec_ioc_reg *i = arg;
	int ret = reg_check(f, i);
	u8 *buf;

	if (ret)
		return ret;
	buf = kzalloc(i->size, GFP_KERNEL_ACCOUNT);
	if (!buf)
		return -ENOMEM;
	ret = reg_access(f, i, EC_CMD_FPRD, buf);
	return ec_ioc_hand_over(i->data, buf, i->size, ret);
}

int ec_ioc_reg_write(struct ec_file *f, void *arg)
{
	struct ec_ioc_reg *i = arg;
	int ret = reg_check(f, i);
	u8 *buf;

	if (ret)
		return ret;
	ret = ec_ioc_fetch(i->data, i->size, &buf);
	if (ret)
		return ret;
	ret = reg_access(f, i, EC_CMD_FPWR, buf);
	kvfree(buf);
	return ret;
}

int ec_ioc_state(struct ec_file *f, void *arg)
{
	struct ec_ioc_state *i = arg;
	struct ec_slave *s;
	int ret = 0;

	if (!ec_al_state_valid(i->state))
		return ec_refuse(f, -EINVAL, "%u is no AL state; use INIT, PREOP, BOOT, SAFEOP or OP",
				 i->state);
	s = ec_ioc_get_slave(f, i->position, &ret);
	if (!s)
		return ret;
	s->error = s->error == EC_SLAVE_CONFIG_FAILED ? EC_SLAVE_OK : s->error;
	ec_slave_request(s, i->state);
	ec_slave_unref(s);
	return 0;
}

int ec_ioc_rescan(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;

	if (READ_ONCE(m->freeze))
		return ec_refuse(f, -EBUSY, "an application has reserved the master; it must activate or release it first");
	ec_master_rescan(m);
	return 0;
}

int ec_ioc_debug(struct ec_file *f, void *arg)
{
	struct ec_ioc_debug *i = arg;

	if (i->level > 2)
		return ec_refuse(f, -EINVAL, "debug level must be 0, 1 or 2, not %u", i->level);
	WRITE_ONCE(f->master->base->debug, i->level);
	return 0;
}

/* What an active session wants from a slave is OP, whatever a tool has requested since. */
static bool wanted_in_op(const struct ec_session *session, const struct ec_slave *s)
{
	return session && session->active && !session->ending &&
	       (s->config || s == session->raised);
}

static void try_again(const struct ec_session *session, struct ec_slave *s)
{
	bool op = wanted_in_op(session, s) && s->error != EC_SLAVE_SCAN_FAILED;

	if (s->error == EC_SLAVE_CONFIG_FAILED) {
		s->error = EC_SLAVE_OK;
		s->reconfigure = true;
	} else if (!op || s->requested == EC_AL_OP) {
		return;
	}
	if (op)
		ec_slave_request(s, EC_AL_OP);
	else
		ec_slave_kick(s);
}

int ec_ioc_reset(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	unsigned int k;

	mutex_lock(&m->session_lock);
	down_read(&m->topo);
	for (k = 0; k < m->n_slaves; k++)
		try_again(m->session, m->slaves[k]);
	up_read(&m->topo);
	mutex_unlock(&m->session_lock);
	return 0;
}

int ec_ioc_end_detached(struct ec_file *f, void *arg)
{
	switch (ec_session_end_detached(f->master)) {
	case 0:
		return 0;
	case -ENOENT:
		return ec_refuse(f, -ENOENT, "master %u has no session", f->master->base->index);
	default:
		return ec_refuse(f, -EBUSY, "session of master %u still has its application; stop it first",
				 f->master->base->index);
	}
}
