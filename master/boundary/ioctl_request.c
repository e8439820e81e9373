// SPDX-License-Identifier: GPL-2.0-only
/* Commands that prepare requests and emergencies; their use needs none. */
#include <linux/nospec.h>
#include "../config/config.h"
#include "ioctl.h"
#include "../master.h"
#include "../session/request.h"
#include "../session/session.h"

static const u32 limits[] = {
	[EC_REQUEST_SDO] = EC_MAX_SDO_SIZE,
	[EC_REQUEST_REG] = EC_MAX_REG_SIZE,
	[EC_REQUEST_SOE] = EC_MAX_SOE_SIZE,
	[EC_REQUEST_VOE] = EC_MAX_VOE_SIZE,
};

int ec_ioc_sc_request(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_request *i = arg;
	struct ec_config *c;
	u32 limit;
	int ret = 0;

	if (i->kind >= ARRAY_SIZE(limits))
		return ec_refuse(f, -EINVAL, "%u is no kind of request", i->kind);
	limit = limits[array_index_nospec(i->kind, ARRAY_SIZE(limits))];
	if (i->size > limit)
		return ec_refuse(f, -EINVAL, "size must be at most %u bytes, not %u", limit,
				 i->size);
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (!c)
		return ret;
	ret = ec_requests_add(c->session, i->config, i->kind, i->size, &i->index);
	if (ret == -ENOSPC)
		ec_refuse(f, ret, "at most %u requests with %u bytes together", EC_MAX_REQUESTS,
			  EC_MAX_REQUEST_BYTES);
	ec_session_unlock(f->master);
	return ret;
}

int ec_ioc_sc_emerg(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_emerg *i = arg;
	struct ec_config *c;
	size_t bytes;
	int ret = 0;

	if (i->count > EC_MAX_EMERG)
		return ec_refuse(f, -ENOMEM, "at most %u emergencies are kept, not %u",
				 EC_MAX_EMERG, i->count);
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (!c)
		return ret;
	bytes = c->session->request_bytes - c->emergencies * EC_EMERG_BYTES +
		i->count * EC_EMERG_BYTES;
	if (bytes > EC_MAX_REQUEST_BYTES) {
		ret = ec_refuse(f, -ENOMEM, "requests and emergencies have %u bytes together",
				EC_MAX_REQUEST_BYTES);
	} else {
		c->session->request_bytes = bytes;
		c->emergencies = i->count;
	}
	ec_session_unlock(f->master);
	return ret;
}
