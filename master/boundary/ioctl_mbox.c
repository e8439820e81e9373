// SPDX-License-Identifier: GPL-2.0-only
/*
 * Commands for values in slaves, SDOs and IDNs of servo drives: at once, and while a
 * slave is configured.
 */
#include <linux/slab.h>
#include <linux/string.h>
#include <linux/uaccess.h>
#include "../mailbox/coe.h"
#include "../config/config.h"
#include "ioctl.h"
#include "../mailbox/mailbox.h"
#include "../master.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../mailbox/soe.h"
#include "../wire/coe.h"
#include "../wire/soe.h"

/* what both have in common ---------------------------------------------------*/

static int check_size(struct ec_file *f, u32 size, u32 most)
{
	if (!size || size > most)
		return ec_refuse(f, -EINVAL, "size must be 1 to %u bytes, not %u", most, size);
	return 0;
}

/* Room of any size is welcome; it may have none, for what is empty or to see it refused. */
static u32 room(u32 size, u32 most)
{
	return min(size, most);
}

/* Runs a command with the value a process has at @from; the size is checked already. */
static int with_value(struct ec_file *f, void *arg, u64 from, u32 size,
		      int (*command)(struct ec_file *f, void *arg, const u8 *data))
{
	u8 *data;
	int ret = ec_ioc_fetch(from, size, &data);

	if (ret)
		return ret;
	ret = command(f, arg, data);
	kvfree(data);
	return ret;
}

/**
 * ec_ioc_mbox_failed() - why a transfer through the mailbox of a slave failed
 * @f: open file
 * @ret: result of the transfer
 * @position: of the slave
 * @protocol: of the mailbox
 * @what: was transferred
 *
 * Context: Process. May sleep.
 * Return: @ret, with its reason in @f unless it is 0.
 */
int ec_ioc_mbox_failed(struct ec_file *f, int ret, u16 position, const char *protocol,
		       const char *what)
{
	char why[96];

	if (!ret)
		return 0;
	return ec_refuse(f, ret, "%s of slave %u: %s", what, position,
			 ec_mbox_fail_text(ret, protocol, why, sizeof(why)));
}

/* SDOs -----------------------------------------------------------------------*/

static int sdo_failed(struct ec_file *f, const struct ec_ioc_sdo *i, int ret)
{
	char what[24];

	scnprintf(what, sizeof(what), "SDO 0x%04x:%02x", i->index, i->subindex);
	if (ret == -EIO && i->abort_code)
		return ec_refuse(f, ret, "%s aborted with code 0x%08x: %s", what, i->abort_code,
				 ec_coe_abort_text(i->abort_code) ?: "unknown code");
	if (ret == -ENOBUFS)
		return ec_refuse(f, ret, "%s is larger than %u bytes", what, i->size);
	return ec_ioc_mbox_failed(f, ret, i->position, "CoE", what);
}

/**
 * ec_ioc_upload() - read an object of a slave
 * @f: open file
 * @i: what to read; its @data is not used. Out: bytes read and abort code
 * @data: out: the value; to be given to kvfree(), after a failure as well
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with the reason noted.
 */
int ec_ioc_upload(struct ec_file *f, struct ec_ioc_sdo *i, u8 **data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = 0;
	struct ec_slave *s = ec_ioc_get_slave(f, i->position, &ret);
	size_t got = 0;

	*data = NULL;
	if (!s)
		return ret;
	i->size = room(i->size, EC_MAX_SDO_SIZE);
	*data = kvzalloc(i->size, GFP_KERNEL_ACCOUNT);
	if (*data)
		ret = ec_coe_upload(&s->mbox, i->index, i->subindex, i->flags & EC_SDO_FLAG_COMPLETE,
				    *data, i->size, &got, &i->abort_code, &limit);
	else
		ret = -ENOMEM;
	ret = sdo_failed(f, i, ret);
	i->size = got;
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_sdo_upload(struct ec_file *f, void *arg)
{
	struct ec_ioc_sdo *i = arg;
	u8 *data;
	int ret = ec_ioc_upload(f, i, &data);

	return ec_ioc_hand_over(i->data, data, i->size, ret);
}

/* An empty value may be written. */
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
 * @arg: struct ec_ioc_sdo, what to write; its @data is not used. Out: abort code
 * @data: the value, @size bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with the reason noted.
 */
int ec_ioc_download(struct ec_file *f, void *arg, const u8 *data)
{
	struct ec_ioc_sdo *i = arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_download(f, i);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);

	if (!s)
		return ret;
	ret = sdo_failed(f, i, ec_coe_download(&s->mbox, i->index, i->subindex,
					       i->flags & EC_SDO_FLAG_COMPLETE, data, i->size,
					       &i->abort_code, &limit));
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_sdo_download(struct ec_file *f, void *arg)
{
	struct ec_ioc_sdo *i = arg;

	return check_download(f, i) ?: with_value(f, i, i->data, i->size, ec_ioc_download);
}

/**
 * ec_ioc_store_sdo() - one more startup SDO
 * @f: open file
 * @arg: struct ec_ioc_sc_sdo, which; its @data is not used
 * @data: the value, @size bytes; copied
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno, with the reason noted.
 */
int ec_ioc_store_sdo(struct ec_file *f, void *arg, const u8 *data)
{
	const struct ec_ioc_sc_sdo *i = arg;
	int ret = check_size(f, i->size, EC_MAX_SDO_SIZE);
	struct ec_config *c = ret ? NULL : ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	ret = ec_config_sdo_add(c, i->index, i->subindex, i->flags & EC_SDO_FLAG_COMPLETE, data,
				i->size);
	if (ret == -ENOSPC)
		ec_refuse(f, ret, "a slave configuration has at most %u startup SDOs",
			  EC_MAX_SC_SDOS);
	ret = ec_ioc_limit(f, ret);
	ec_session_unlock(f->master);
	return ret;
}

int ec_ioc_sc_sdo(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_sdo *i = arg;

	return check_size(f, i->size, EC_MAX_SDO_SIZE) ?:
	       with_value(f, i, i->data, i->size, ec_ioc_store_sdo);
}

/* IDNs -----------------------------------------------------------------------*/

static int check_drive(struct ec_file *f, u8 drive)
{
	if (drive >= EC_SOE_DRIVES)
		return ec_refuse(f, -EINVAL, "drive number must be 0 to 7, not %u", drive);
	return 0;
}

static int check_idn(struct ec_file *f, const struct ec_ioc_soe *i)
{
	return check_drive(f, i->drive) ?: check_size(f, i->size, EC_MAX_SOE_SIZE);
}

static int idn_failed(struct ec_file *f, const struct ec_ioc_soe *i, int ret)
{
	char idn[12], what[20];

	scnprintf(what, sizeof(what), "IDN %s", ec_soe_idn_text(i->idn, idn));
	switch (ret) {
	case -EIO:
		if (!i->error_code)
			return ec_ioc_mbox_failed(f, ret, i->position, "SoE", what);
		return ec_refuse(f, ret, "%s of drive %u: error 0x%04x: %s", what, i->drive,
				 i->error_code,
				 ec_soe_error_text(i->error_code) ?: "unknown code");
	case -EMSGSIZE:
		return ec_refuse(f, ret, "%s: the value does not fit into one message of the mailbox of slave %u; fragments are not supported",
				 what, i->position);
	case -ENOBUFS:
		return ec_refuse(f, ret, "%s is larger than %u bytes", what, i->size);
	default:
		return ec_ioc_mbox_failed(f, ret, i->position, "SoE", what);
	}
}

/**
 * ec_ioc_read_idn() - read an IDN of a slave
 * @f: open file
 * @i: argument of EC_IOC_SOE_READ; @size is set to what was read
 * @data: out: the value; to be given to kvfree(), after a failure as well
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_read_idn(struct ec_file *f, struct ec_ioc_soe *i, u8 **data)
{
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_drive(f, i->drive);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);
	size_t got = 0;
	u16 error = 0;

	*data = NULL;
	if (!s)
		return ret;
	i->size = room(i->size, EC_MAX_SOE_SIZE);
	*data = kvzalloc(i->size, GFP_KERNEL_ACCOUNT);
	if (*data)
		ret = ec_soe_read(&s->mbox, i->drive, i->idn, *data, i->size, &got, &error, &limit);
	else
		ret = -ENOMEM;
	i->error_code = error;
	ret = idn_failed(f, i, ret);
	i->size = got;
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_soe_read(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;
	u8 *data;
	int ret = ec_ioc_read_idn(f, i, &data);

	return ec_ioc_hand_over(i->data, data, i->size, ret);
}

/**
 * ec_ioc_write_idn() - write an IDN of a slave
 * @f: open file
 * @arg: struct ec_ioc_soe, argument of EC_IOC_SOE_WRITE
 * @data: value, @size bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_write_idn(struct ec_file *f, void *arg, const u8 *data)
{
	struct ec_ioc_soe *i = arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret = check_idn(f, i);
	struct ec_slave *s = ret ? NULL : ec_ioc_get_slave(f, i->position, &ret);
	u16 error = 0;

	if (!s)
		return ret;
	ret = ec_soe_write(&s->mbox, i->drive, i->idn, data, i->size, &error, &limit);
	i->error_code = error;
	ret = idn_failed(f, i, ret);
	ec_slave_unref(s);
	return ret;
}

int ec_ioc_soe_write(struct ec_file *f, void *arg)
{
	struct ec_ioc_soe *i = arg;

	return check_idn(f, i) ?: with_value(f, i, i->data, i->size, ec_ioc_write_idn);
}

static int store_idn(struct ec_file *f, struct ec_config *c, const struct ec_ioc_sc_idn *i,
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
 * @arg: struct ec_ioc_sc_idn, argument of EC_IOC_SC_IDN
 * @data: value, @size bytes; copied
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno, with its reason in @f.
 */
int ec_ioc_store_idn(struct ec_file *f, void *arg, const u8 *data)
{
	const struct ec_ioc_sc_idn *i = arg;
	int ret = check_size(f, i->size, EC_MAX_SOE_SIZE);
	struct ec_config *c = ret ? NULL : ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	ret = ec_ioc_limit(f, store_idn(f, c, i, data));
	ec_session_unlock(f->master);
	return ret;
}

int ec_ioc_sc_idn(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_idn *i = arg;

	return check_size(f, i->size, EC_MAX_SOE_SIZE) ?:
	       with_value(f, i, i->data, i->size, ec_ioc_store_idn);
}
