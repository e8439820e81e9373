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

static int check(struct ec_file *f, u8 drive, u32 size)
{
	if (drive >= EC_SOE_DRIVES)
		return ec_refuse(f, -EINVAL, "drive number must be 0 to 7, not %u", drive);
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

int ec_ioc_soe_read(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check(f, i->drive, i->size);
	struct ec_slave *s;
	size_t got = 0;
	u16 error = 0;
	u8 *buf;

	s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);
	if (!s)
		return ret;
	buf = kvzalloc(i->size, GFP_KERNEL_ACCOUNT);
	ret = buf ? ec_soe_read(s, i->drive, i->idn, buf, i->size, &got, &error, &limit) : -ENOMEM;
	i->error_code = error;
	ret = failed(f, i, ret);
	if (!ret && copy_to_user(u64_to_user_ptr(i->data), buf, got))
		ret = -EFAULT;
	i->size = got;
	kvfree(buf);
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_soe_write(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check(f, i->drive, i->size);
	struct ec_slave *s;
	u16 error = 0;
	u8 *buf;

	if (ret)
		return ret;
	buf = vmemdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(buf))
		return PTR_ERR(buf);
	s = ec_ioc_get_slave(f, i->position, &ret);
	if (s) {
		ret = ec_soe_write(s, i->drive, i->idn, buf, i->size, &error, &limit);
		i->error_code = error;
		ret = failed(f, i, ret);
		ec_slave_unref(s);
	}
	kvfree(buf);
	return ret;
}

int ec_ioc_sc_idn(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_idn *i = arg;
	int ret = check(f, i->drive, i->size);
	struct ec_config *c;
	u8 *data;

	if (ret)
		return ret;
	if (i->state != EC_AL_PREOP && i->state != EC_AL_SAFEOP)
		return ec_refuse(f, -EINVAL, "IDNs are written in PREOP (2) or SAFEOP (4), not in state %u",
				 i->state);
	data = vmemdup_user(u64_to_user_ptr(i->data), i->size);
	if (IS_ERR(data))
		return PTR_ERR(data);
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (c) {
		ret = ec_config_idn_add(c, i->drive, i->idn, i->state, data, i->size);
		if (ret == -ENOSPC)
			ec_refuse(f, ret, "at most %u startup IDNs for one slave", EC_MAX_SC_IDNS);
		mutex_unlock(&f->master->session_lock);
	}
	kvfree(data);
	return ret;
}
