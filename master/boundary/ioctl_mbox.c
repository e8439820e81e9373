// SPDX-License-Identifier: GPL-2.0-only
/*
 * Commands for values in slaves, SDOs and IDNs of servo drives: at once, and while a
 * slave is configured.
 */
#include "../mailbox/coe.h"
#include "../mailbox/emerg.h"
#include "../config/config.h"
#include "ioctl.h"
#include "../mailbox/mailbox.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../mailbox/soe.h"
#include "../wire/coe.h"
#include "../wire/sdoinfo.h"
#include "../wire/soe.h"

static int check_size(struct ec_call *call, u32 least, u32 most)
{
	if (call->size >= least && call->size <= most)
		return 0;
	return ec_refuse(call, -EINVAL, "size must be %u to %u bytes, not %u", least, most,
			 call->size);
}

/**
 * ec_ioc_mbox_failed() - why a transfer through the mailbox of a slave failed
 * @call: command
 * @ret: result of the transfer
 * @protocol: of the mailbox
 * @what: was transferred
 *
 * Context: Process. May sleep.
 * Return: @ret, with its reason noted unless it is 0.
 */
int ec_ioc_mbox_failed(struct ec_call *call, int ret, const char *protocol, const char *what)
{
	char why[96];

	if (!ret)
		return 0;
	return ec_refuse(call, ret, "%s of slave %u: %s", what, call->slave->position,
			 ec_mbox_fail_text(ret, protocol, why, sizeof(why)));
}

/* SDOs -----------------------------------------------------------------------*/

/* time limit of an SDO message, if the caller sets none */
static u32 sdo_ms(const struct ec_call *call)
{
	return READ_ONCE(call->slave->mbox.reply_ms) ?: EC_SDO_TIMEOUT_MS;
}

static int sdo_failed(struct ec_call *call, const struct ec_ioc_sdo *i, int ret)
{
	char what[24];

	scnprintf(what, sizeof(what), "SDO 0x%04x:%02x", i->index, i->subindex);
	if (ret == -EIO && i->abort_code)
		return ec_refuse(call, ret, "%s aborted with code 0x%08x: %s", what, i->abort_code,
				 ec_coe_abort_text(i->abort_code) ?: "unknown code");
	if (ret == -ENOBUFS)
		return ec_refuse(call, ret, "%s is larger than %u bytes", what, i->size);
	if (ret == -ETIMEDOUT)
		return ec_refuse(call, ret,
				 "%s of slave %u: no reply in time, limit %u ms; if the slave needs longer, allow more: --timeout, ecrt_slave_config_sdo_timeout()",
				 what, call->slave->position, i->timeout_ms ?: sdo_ms(call));
	return ec_ioc_mbox_failed(call, ret, "CoE", what);
}

int ec_ioc_sdo_upload(struct ec_call *call)
{
	struct ec_ioc_sdo *i = call->arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	size_t got = 0;
	int ret;

	i->size = call->size;
	ret = ec_coe_upload(&call->slave->mbox, i->index, i->subindex,
			    i->flags & EC_SDO_FLAG_COMPLETE, call->data, call->size, &got,
			    &i->abort_code, &limit);
	ret = sdo_failed(call, i, ret);
	i->size = got;
	return ret;
}

/* An empty value may be written. */
int ec_ioc_sdo_download(struct ec_call *call)
{
	struct ec_ioc_sdo *i = call->arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	const struct ec_startup what = {
		.type = EC_STARTUP_SDO, .index = i->index, .sub = i->subindex,
		.complete = i->flags & EC_SDO_FLAG_COMPLETE,
	};
	int ret = check_size(call, 0, EC_MAX_SDO_SIZE);

	if (ret)
		return ret;
	ret = ec_coe_download(&call->slave->mbox, i->index, i->subindex, what.complete,
			      call->data, call->size, &i->abort_code, &limit);
	if (!ret)
		ec_ioc_record(call, &what);
	return sdo_failed(call, i, ret);
}

static int info_failed(struct ec_call *call, const struct ec_ioc_sdo_info *i, int ret)
{
	char what[48];

	if (i->what == EC_SDO_INFO_LIST)
		scnprintf(what, sizeof(what), "list %u of objects", i->index);
	else
		scnprintf(what, sizeof(what), "description of 0x%04x:%02x", i->index, i->subindex);
	if (ret == -EIO && i->abort_code)
		return ec_refuse(call, ret, "%s: slave %u: error 0x%08x: %s", what,
				 call->slave->position, i->abort_code,
				 ec_coe_abort_text(i->abort_code) ?: "unknown code");
	if (ret == -ENOBUFS)
		return ec_refuse(call, ret, "%s is larger than %u bytes", what, call->size);
	return ec_ioc_mbox_failed(call, ret, "CoE", what);
}

int ec_ioc_sdo_info(struct ec_call *call)
{
	struct ec_ioc_sdo_info *i = call->arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	struct ec_sdoinfo info;
	int ret;

	if (i->what == EC_SDO_INFO_FORGET) {
		ec_dict_forget(&call->slave->dict);
		i->size = 0;
		return 0;
	}
	if (i->what != EC_SDO_INFO_LIST && i->what != EC_SDO_INFO_OBJECT &&
	    i->what != EC_SDO_INFO_ENTRY)
		return ec_refuse(call, -EINVAL, "unknown kind of SDO information %u", i->what);
	if (i->subindex && i->what != EC_SDO_INFO_ENTRY)
		return ec_refuse(call, -EINVAL, "only entries have a subindex");
	if (i->value_info && i->what != EC_SDO_INFO_ENTRY)
		return ec_refuse(call, -EINVAL, "only entries have value info");
	if (i->value_info & ~EC_SDO_VALUE_ALL)
		return ec_refuse(call, -EINVAL, "unknown bits of value info: 0x%02x, known: 0x%02x",
				 i->value_info, EC_SDO_VALUE_ALL);
	ec_sdoinfo_init(&info, i->what, i->index, i->subindex, call->data, call->size);
	info.info = i->value_info;
	ret = ec_dict_info(call->slave, &info, &limit);
	i->abort_code = info.abort;
	ret = info_failed(call, i, ret);
	i->size = ret ? 0 : info.size;
	return ret;
}

int ec_ioc_emergencies(struct ec_call *call)
{
	struct ec_ioc_emergencies *i = call->arg;

	struct ec_emergency last[EC_EMERGENCIES];
	unsigned int fit, n = ec_emerg_last(&call->slave->mbox, last, &i->total);

	i->profile = READ_ONCE(call->slave->mbox.profile);
	/* the newest ones that fit */
	fit = min_t(u32, n, call->size / sizeof(last[0]));
	i->size = fit * sizeof(last[0]);
	memcpy(call->data, last + n - fit, i->size);
	return 0;
}

int ec_ioc_sc_sdo(struct ec_call *call)
{
	const struct ec_ioc_sc_sdo *i = call->arg;
	int ret = check_size(call, 1, EC_MAX_SDO_SIZE);

	if (ret)
		return ret;
	ret = ec_config_sdo_add(call->config, i->index, i->subindex,
				i->flags & EC_SDO_FLAG_COMPLETE, call->data, call->size);
	if (ret == -ENOSPC)
		ec_refuse(call, ret, "a slave configuration has at most %u startup SDOs",
			  EC_MAX_SC_SDOS);
	return ec_ioc_limit(call, ret);
}

/* IDNs -----------------------------------------------------------------------*/

static int check_drive(struct ec_call *call, u8 drive)
{
	if (drive >= EC_SOE_DRIVES)
		return ec_refuse(call, -EINVAL, "drive number must be 0 to 7, not %u", drive);
	return 0;
}

static int idn_failed(struct ec_call *call, const struct ec_ioc_soe *i, int ret)
{
	char idn[12], what[20];

	scnprintf(what, sizeof(what), "IDN %s", ec_soe_idn_text(i->idn, idn));
	switch (ret) {
	case -EIO:
		if (!i->error_code)
			return ec_ioc_mbox_failed(call, ret, "SoE", what);
		return ec_refuse(call, ret, "%s of drive %u: error 0x%04x: %s", what, i->drive,
				 i->error_code,
				 ec_soe_error_text(i->error_code) ?: "unknown code");
	case -ENOBUFS:
		return ec_refuse(call, ret, "%s is larger than %u bytes", what, i->size);
	default:
		return ec_ioc_mbox_failed(call, ret, "SoE", what);
	}
}

/* @a: with the direction */
static int idn_access(struct ec_call *call, struct ec_soe_access *a)
{
	struct ec_ioc_soe *i = call->arg;
	struct ec_mbox_limit limit = { .timeout_ms = min(i->timeout_ms, EC_MAX_SDO_MS) };
	int ret;

	a->drive = i->drive;
	a->elements = i->flags ?: EC_SOE_VALUE;
	a->idn = i->idn;
	a->data = call->data;
	ret = ec_soe_access(&call->slave->mbox, a, &limit);
	i->error_code = a->error;
	return idn_failed(call, i, ret);
}

int ec_ioc_soe_read(struct ec_call *call)
{
	struct ec_soe_access a = { .cap = call->size };
	struct ec_ioc_soe *i = call->arg;
	int ret = check_drive(call, i->drive);

	if (ret)
		return ret;
	i->size = call->size;
	ret = idn_access(call, &a);
	i->size = a.size;
	return ret;
}

int ec_ioc_soe_write(struct ec_call *call)
{
	struct ec_soe_access a = { .write = true, .size = call->size };
	struct ec_ioc_soe *i = call->arg;
	const struct ec_startup what = {
		.type = EC_STARTUP_IDN, .index = i->idn, .sub = i->drive,
	};
	int ret = check_drive(call, i->drive) ?: check_size(call, 1, EC_MAX_SOE_SIZE);

	if (ret)
		return ret;
	if (hweight8(i->flags) > 1)
		return ec_refuse(call, -EINVAL, "elements 0x%02x: one is written at a time",
				 i->flags);
	ret = idn_access(call, &a);
	if (!ret && a.elements == EC_SOE_VALUE)
		ec_ioc_record(call, &what);
	return ret;
}

int ec_ioc_sc_idn(struct ec_call *call)
{
	const struct ec_ioc_sc_idn *i = call->arg;
	int ret = check_drive(call, i->drive) ?: check_size(call, 1, EC_MAX_SOE_SIZE);

	if (ret)
		return ret;
	if (i->state != EC_AL_PREOP && i->state != EC_AL_SAFEOP)
		return ec_refuse(call, -EINVAL,
				 "IDNs are written in PREOP (2) or SAFEOP (4), not in state %u",
				 i->state);
	ret = ec_config_idn_add(call->config, i->drive, i->idn, i->state, call->data, call->size);
	if (ret == -ENOSPC)
		ec_refuse(call, ret, "a slave configuration has at most %u startup IDNs",
			  EC_MAX_SC_IDNS);
	return ec_ioc_limit(call, ret);
}
