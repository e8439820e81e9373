// SPDX-License-Identifier: GPL-2.0-only
/* Commands for IDNs of servo drives: at once, and while a slave is configured. */
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "config.h"
#include "ioctl.h"
#include "mailbox.h"
#include "master.h"
#include "session.h"
#include "slave.h"
#include "soe.h"
#include "wire/soe.h"

static int check_drive(struct ec_file *f, u8 drive)
{
	if (drive >= EC_SOE_DRIVES)
		return ec_refuse(f, -EINVAL, "drive number must be 0 to 7, not %u", drive);
	return 0;
}

static int check_size(struct ec_file *f, u32 size)
{
	if (!size || size > EC_MAX_SOE_SIZE)
		return ec_refuse(f, -EINVAL, "size must be 1 to %u bytes, not %u", EC_MAX_SOE_SIZE,
				 size);
	return 0;
}

static int failed(struct ec_file *f, const struct ec_ioc_soe *i, int ret)
{
	char idn[12];

	ec_soe_idn_text(i->idn, idn);
	switch (ret) {
	case 0:
		return 0;
	case -EIO:
		return ec_refuse(f, ret, "IDN %s of drive %u: error 0x%04x: %s", idn, i->drive,
				 i->error_code, ec_soe_error_text(i->error_code) ?: "???");
	case -EPROTONOSUPPORT:
		return ec_refuse(f, ret, "slave %u has no SoE mailbox", i->position);
	case -EAGAIN:
		return ec_refuse(f, ret, "slave %u is not in PREOP or above, so its mailbox is off; request PREOP first",
				 i->position);
	case -ETIMEDOUT:
		return ec_refuse(f, ret, "slave %u did not answer in time", i->position);
	case -EMSGSIZE:
		return ec_refuse(f, ret, "IDN %s: the value does not fit into one message of the mailbox of slave %u; fragments are not supported",
				 idn, i->position);
	case -ENOBUFS:
		return ec_refuse(f, ret, "IDN %s is larger than %u bytes", idn, i->size);
	default:
		return ec_refuse(f, ret, "IDN %s: transfer with slave %u failed", idn, i->position);
	}
}

/**
 * ec_ioc_read_idn() - read an IDN of a slave
 * @f: open file
 * @i: argument of EC_IOC_SOE_READ; @size is set to what was read
 * @data: result, to be given to kvfree(); NULL on failure
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_read_idn(struct ec_file *f, struct ec_ioc_soe *i, u8 **data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_drive(f, i->drive) ?: check_size(f, i->size);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);
	size_t got = 0;
	u16 error = 0;
	u8 *buf;

	*data = NULL;
	if (!s)
		return ret;
	buf = kvzalloc(i->size, GFP_KERNEL_ACCOUNT);
	ret = buf ? ec_soe_read(s, i->drive, i->idn, buf, i->size, &got, &error, &limit) : -ENOMEM;
	i->error_code = error;
	ret = failed(f, i, ret);
	i->size = got;
	if (ret)
		kvfree(buf);
	else
		*data = buf;
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_soe_read(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;
	u8 *data;
	int ret = ec_ioc_read_idn(f, i, &data);

	if (!ret && copy_to_user(u64_to_user_ptr(i->data), data, i->size))
		ret = -EFAULT;
	kvfree(data);
	return ret;
}

/**
 * ec_ioc_write_idn() - write an IDN of a slave
 * @f: open file
 * @i: argument of EC_IOC_SOE_WRITE
 * @data: value, @i->size bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_write_idn(struct ec_file *f, struct ec_ioc_soe *i, const u8 *data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_drive(f, i->drive) ?: check_size(f, i->size);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);
	u16 error = 0;

	if (!s)
		return ret;
	ret = ec_soe_write(s, i->drive, i->idn, data, i->size, &error, &limit);
	i->error_code = error;
	ret = failed(f, i, ret);
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_soe_write(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;
	int ret = check_drive(f, i->drive) ?: check_size(f, i->size);
	u8 *data;

	if (ret)
		return ret;
	data = vmemdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(data))
		return PTR_ERR(data);
	ret = ec_ioc_write_idn(f, i, data);
	kvfree(data);
	return ret;
}

static int store(struct ec_file *f, struct ec_config *c, const struct ec_ioc_sc_idn *i,
		 const u8 *data)
{
	int ret = check_drive(f, i->drive);

	if (ret)
		return ret;
	if (i->state != EC_AL_PREOP && i->state != EC_AL_SAFEOP)
		return ec_refuse(f, -EINVAL, "IDNs are written in PREOP (2) or SAFEOP (4), not in state %u",
				 i->state);
	ret = ec_config_idn_add(c, i->drive, i->idn, i->state, data, i->size);
	if (ret == -ENOSPC)
		return ec_refuse(f, ret, "a slave configuration has at most %u startup IDNs",
				 EC_MAX_SC_IDNS);
	return ret;
}

/**
 * ec_ioc_store_idn() - one more startup IDN
 * @f: open file
 * @i: argument of EC_IOC_SC_IDN
 * @data: value, @i->size bytes
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_store_idn(struct ec_file *f, const struct ec_ioc_sc_idn *i, const u8 *data)
{
	int ret = check_size(f, i->size);
	struct ec_config *c = ret ? NULL : ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	ret = store(f, c, i, data);
	mutex_unlock(&f->master->session_lock);
	return ret;
}

int ec_ioc_sc_idn(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_idn *i = arg;
	int ret = check_size(f, i->size);
	u8 *data;

	if (ret)
		return ret;
	data = vmemdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(data))
		return PTR_ERR(data);
	ret = ec_ioc_store_idn(f, i, data);
	kvfree(data);
	return ret;
}
