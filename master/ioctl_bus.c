// SPDX-License-Identifier: GPL-2.0-only
/* Commands that cause bus traffic or change the state of slaves. */
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "coe.h"
#include "ioctl.h"
#include "mailbox.h"
#include "master.h"
#include "session.h"
#include "slave.h"
#include "wire/coe.h"
#include "xfer.h"

static int sdo_failed(struct ec_file *f, const struct ec_ioc_sdo *i, int ret)
{
	const char *text;

	switch (ret) {
	case 0:
		return 0;
	case -EIO:
		text = ec_coe_abort_text(i->abort_code) ?: "???";
		return ec_refuse(f, ret, "SDO 0x%04x:%02x aborted with code 0x%08x: %s", i->index,
				 i->subindex, i->abort_code, text);
	case -EPROTONOSUPPORT:
		return ec_refuse(f, ret, "slave %u has no CoE mailbox", i->position);
	case -EAGAIN:
		return ec_refuse(f, ret, "slave %u is not in PREOP or above, so its mailbox is off; request PREOP first",
				 i->position);
	case -ETIMEDOUT:
		return ec_refuse(f, ret, "slave %u did not answer in time", i->position);
	case -EBADMSG:
	case -EMSGSIZE:
	case -EPROTO:
		return ec_refuse(f, ret, "SDO 0x%04x:%02x: slave %u sent a mailbox message that cannot be (length or content)",
				 i->index, i->subindex, i->position);
	case -ENOBUFS:
		return ec_refuse(f, ret, "SDO 0x%04x:%02x is larger than %u bytes", i->index,
				 i->subindex, i->size);
	default:
		return ec_refuse(f, ret, "SDO 0x%04x:%02x: transfer with slave %u failed", i->index,
				 i->subindex, i->position);
	}
}

/**
 * ec_ioc_upload() - read an object of a slave
 * @f: open file
 * @i: what to read; its @data is not used. Out: bytes read and abort code
 * @data: out: the value, to be freed by kvfree(); NULL on failure
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with the reason noted.
 */
int ec_ioc_upload(struct ec_file *f, struct ec_ioc_sdo *i, u8 **data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	struct ec_slave *s;
	size_t got = 0;
	int ret = 0;
	u8 *buf;

	*data = NULL;
	if (!i->size || i->size > EC_MAX_SDO_SIZE)
		return ec_refuse(f, -EINVAL, "size must be 1 to %u bytes, not %u", EC_MAX_SDO_SIZE,
				 i->size);
	s = ec_ioc_get_slave(f, i->position, &ret);
	if (!s)
		return ret;
	buf = kvzalloc(i->size, GFP_KERNEL_ACCOUNT);
	if (buf)
		ret = ec_coe_upload(s, i->index, i->subindex, i->flags & EC_SDO_FLAG_COMPLETE,
				    buf, i->size, &got, &i->abort_code, &limit);
	else
		ret = -ENOMEM;
	ret = sdo_failed(f, i, ret);
	i->size = got;
	if (ret)
		kvfree(buf);
	else
		*data = buf;
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_sdo_upload(struct ec_file *f, void *arg)
{
	struct ec_ioc_sdo *i = arg;
	u8 *data;
	int ret = ec_ioc_upload(f, i, &data);

	if (!ret && copy_to_user(u64_to_user_ptr(i->data), data, i->size))
		ret = -EFAULT;
	kvfree(data);
	return ret;
}

static int check_download(struct ec_file *f, const struct ec_ioc_sdo *i)
{
	if (i->size > EC_MAX_SDO_SIZE)
		return ec_refuse(f, -EINVAL, "size must be at most %u bytes, not %u",
				 EC_MAX_SDO_SIZE, i->size);
	return 0;
}

/**
 * ec_ioc_download() - write an object of a slave
 * @f: open file
 * @i: what to write; its @data is not used. Out: abort code
 * @data: the value, @i->size bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with the reason noted.
 */
int ec_ioc_download(struct ec_file *f, struct ec_ioc_sdo *i, const u8 *data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_download(f, i);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);

	if (!s)
		return ret;
	ret = sdo_failed(f, i, ec_coe_download(s, i->index, i->subindex,
					       i->flags & EC_SDO_FLAG_COMPLETE, data, i->size,
					       &i->abort_code, &limit));
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_sdo_download(struct ec_file *f, void *arg)
{
	struct ec_ioc_sdo *i = arg;
	int ret = check_download(f, i);
	u8 *data;

	if (ret)
		return ret;
	data = vmemdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(data))
		return PTR_ERR(data);
	ret = ec_ioc_download(f, i, data);
	kvfree(data);
	return ret;
}

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
	ret = ec_xfer(m, &dg, 1);
	if (ret)
		return ec_refuse(f, ret, "the frame did not come back; check the cable to slave %u",
				 i->position);
	if (dg.wkc != 1)
		return ec_refuse(f, -EIO, "slave %u refused access to 0x%04x (working counter %u)",
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
	buf = kzalloc(i->size, GFP_KERNEL);
	if (!buf)
		return -ENOMEM;
	ret = reg_access(f, i, EC_CMD_FPRD, buf);
	if (!ret && copy_to_user(u64_to_user_ptr(i->data), buf, i->size))
		ret = -EFAULT;
	kfree(buf);
	return ret;
}

int ec_ioc_reg_write(struct ec_file *f, void *arg)
{
	struct ec_ioc_reg *i = arg;
	int ret = reg_check(f, i);
	u8 *buf;

	if (ret)
		return ret;
	buf = memdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(buf))
		return PTR_ERR(buf);
	ret = reg_access(f, i, EC_CMD_FPWR, buf);
	kfree(buf);
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
	WRITE_ONCE(f->master->debug, i->level);
	return 0;
}

/* Try again to bring every slave to its state. */
int ec_ioc_reset(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	unsigned int k;

	down_read(&m->topo);
	for (k = 0; k < m->n_slaves; k++) {
		struct ec_slave *s = m->slaves[k];

		if (s->error != EC_SLAVE_CONFIG_FAILED)
			continue;
		s->error = EC_SLAVE_OK;
		s->reconfigure = true;
		ec_slave_request(s, s->requested);
	}
	up_read(&m->topo);
	return 0;
}

int ec_ioc_end_detached(struct ec_file *f, void *arg)
{
	switch (ec_session_end_detached(f->master)) {
	case 0:
		return 0;
	case -ENOENT:
		return ec_refuse(f, -ENOENT, "master %u runs no session", f->master->index);
	default:
		return ec_refuse(f, -EBUSY, "the application of master %u is there; stop that",
				 f->master->index);
	}
}
