// SPDX-License-Identifier: GPL-2.0-only
/*
 * Commands for files of slaves. A file may be large, so it is not copied as a whole: each packet
 * goes between the memory of the caller and the mailbox.
 */
#include <linux/uaccess.h>
#include "../base/limits.h"
#include "../bus/slave.h"
#include "../mailbox/foe.h"
#include "../mailbox/mailbox.h"
#include "ioctl.h"

static int copy(void *ctx, u64 at, u8 *buf, size_t n, bool to_slave)
{
	const struct ec_call *call = ctx;
	const struct ec_ioc_foe *i = call->arg;
	u64 address = i->data + at;
	bool bad = false;

	if (!call->user && to_slave)
		memcpy(buf, (void *)(uintptr_t)address, n);
	else if (!call->user)
		memcpy((void *)(uintptr_t)address, buf, n);
	else if (to_slave)
		bad = copy_from_user(buf, u64_to_user_ptr(address), n);
	else
		bad = copy_to_user(u64_to_user_ptr(address), buf, n);
	return bad ? -EFAULT : 0;
}

static int to_slave(void *ctx, u64 at, u8 *buf, size_t n)
{
	return copy(ctx, at, buf, n, true);
}

static int from_slave(void *ctx, u64 at, u8 *buf, size_t n)
{
	return copy(ctx, at, buf, n, false);
}

/* Report progress to the caller; an invalid pointer does not end the transfer. */
static void progress(void *ctx, u64 done)
{
	const struct ec_call *call = ctx;
	const struct ec_ioc_foe *i = call->arg;

	if (!i->done)
		return;
	if (!call->user)
		WRITE_ONCE(*(u64 *)(uintptr_t)i->done, done);
	else if (copy_to_user(u64_to_user_ptr(i->done), &done, sizeof(done)))
		return;
}

static int ioctl_foe_refused(struct ec_call *call, const struct ec_foe *f)
{
	const char *meaning = ec_foe_error_text(f->error) ?: "unknown code";

	return ec_refuse(call, -EIO, "file '%*pE' of slave %u: error 0x%08x: %s%s%s",
			 (int)f->name_len, f->name, call->slave->position, f->error, meaning,
			 f->text[0] ? "; text of the slave: " : "", f->text);
}

static int ioctl_foe_failed(struct ec_call *call, const struct ec_foe *f, int ret)
{
	const struct ec_ioc_foe *i = call->arg;
	char what[EC_FOE_NAME + 10];

	scnprintf(what, sizeof(what), "file '%*pE'", (int)f->name_len, f->name);
	switch (ret) {
	case -EREMOTEIO:
		return ioctl_foe_refused(call, f);
	case -EINPROGRESS:
		return ec_refuse(call, -EBUSY,
				 "another file of slave %u is transferred just now; try again later",
				 call->slave->position);
	case -ENOBUFS:
		return ec_refuse(call, ret, "%s of slave %u is larger than %u bytes", what,
				 call->slave->position, i->size);
	case -EFAULT:
		return ret;
	default:
		return ec_ioc_mbox_failed(call, ret, "FoE", what);
	}
}

static int ioctl_foe_transfer(struct ec_call *call, bool write)
{
	struct ec_ioc_foe *i = call->arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	struct ec_foe f = {
		.write = write, .password = i->password, .name = i->name,
		.name_len = ec_foe_name_len(i->name, sizeof(i->name)),
	};
	struct ec_foe_file file = {
		.size = i->size, .copy = write ? to_slave : from_slave, .progress = progress,
		.ctx = call,
	};
	int ret;

	if (!f.name_len)
		return ec_refuse(call, -EINVAL,
				 "the name of the file on the slave must be 1 to %u printable characters",
				 EC_FOE_NAME);
	ret = ioctl_foe_failed(call, &f, ec_foe_transfer(&call->slave->mbox, &f, &file, &limit));
	i->error_code = f.error;
	if (!write)
		i->size = ret ? 0 : f.size;
	return ret;
}

int ec_ioc_foe_read(struct ec_call *call)
{
	return ioctl_foe_transfer(call, false);
}

int ec_ioc_foe_write(struct ec_call *call)
{
	return ioctl_foe_transfer(call, true);
}
