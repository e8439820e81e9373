// SPDX-License-Identifier: GPL-2.0-only
/* Commands that write the EEPROM of a slave. */
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "../bus/eeprom_write.h"
#include "../bus/slave.h"
#include "ioctl.h"

static_assert(EC_SII_FLAG_FORCE == EC_EEPROM_FORCE && EC_SII_FLAG_UNSAFE == EC_EEPROM_UNSAFE);
static_assert(EC_SII_FLAG_REPAIR == EC_EEPROM_REPAIR && EC_SII_FLAG_DRY_RUN == EC_EEPROM_DRY_RUN);

/* Report progress to the caller; an invalid pointer does not end the write. */
static void ioctl_eeprom_progress(void *ctx, u32 done, u32 words)
{
	const struct ec_call *call = ctx;
	const struct ec_ioc_sii_write *i = call->arg;
	u64 value = done;

	if (!i->done)
		return;
	if (!call->user)
		WRITE_ONCE(*(u64 *)(uintptr_t)i->done, value);
	else if (copy_to_user(u64_to_user_ptr(i->done), &value, sizeof(value)))
		return;
}

/* -EIO alone copies the argument back: the caller reads there how much was written. */
static int ioctl_eeprom_result(struct ec_call *call, const struct ec_eeprom_job *job)
{
	int ret = job->ret;

	if (!ret || ret == -EINTR || !job->why[0])
		return ret;
	return ec_refuse(call, ret, "EEPROM of slave %u: %s", call->slave->position, job->why);
}

static struct ec_eeprom_job *new_job(struct ec_call *call, u32 flags)
{
	struct ec_eeprom_job *job = kzalloc(sizeof(*job), GFP_KERNEL);

	if (job) {
		job->slave = call->slave;
		job->flags = flags;
	}
	return job;
}

int ec_ioc_sii_write(struct ec_call *call)
{
	struct ec_ioc_sii_write *i = call->arg;
	struct ec_eeprom_job *job;
	int ret;

	if (!call->data)
		return ec_refuse(call, -EINVAL, "an EEPROM image has no %u bytes", i->size);
	job = new_job(call, i->flags);
	if (!job)
		return -ENOMEM;
	job->image = call->data;
	job->bytes = call->size;
	ec_eeprom_write(job, ioctl_eeprom_progress, call);
	i->differ = job->differ;
	i->written = job->written;
	i->register_alias = job->register_alias;
	i->renewed = job->renewed;
	ret = ioctl_eeprom_result(call, job);
	kfree(job);
	return ret;
}

int ec_ioc_alias(struct ec_call *call)
{
	struct ec_ioc_alias *i = call->arg;
	struct ec_eeprom_job *job = new_job(call, i->flags);
	int ret;

	if (!job)
		return -ENOMEM;
	job->alias = i->alias;
	ec_eeprom_write(job, NULL, NULL);
	i->register_alias = job->register_alias;
	i->renewed = job->renewed;
	ret = ioctl_eeprom_result(call, job);
	kfree(job);
	return ret;
}
