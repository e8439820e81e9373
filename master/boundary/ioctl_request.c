// SPDX-License-Identifier: GPL-2.0-only
/* Commands that prepare requests and emergencies; their use needs none. */
#include <linux/nospec.h>
#include "../config/config.h"
#include "ioctl.h"
#include "../session/request.h"
#include "../session/request_layout.h"
#include "../session/session.h"

static const u32 limits[] = {
	[EC_REQUEST_SDO] = EC_MAX_SDO_SIZE,
	[EC_REQUEST_REG] = EC_MAX_REG_SIZE,
	[EC_REQUEST_SOE] = EC_MAX_SOE_SIZE,
	[EC_REQUEST_VOE] = EC_MAX_VOE_SIZE,
	[EC_REQUEST_FOE] = EC_MAX_FOE_SIZE,
	[EC_REQUEST_SDO_INFO] = EC_MAX_SDO_SIZE,
};

static int request_add(struct ec_call *call, u32 config, u32 kind, u32 size, u32 *index)
{
	int ret = ec_requests_add(call->session, config, kind, size, index);

	if (ret == -ENOSPC)
		ec_refuse(call, ret, "at most %u requests with %u bytes together", EC_MAX_REQUESTS,
			  EC_MAX_REQUEST_BYTES);
	return ret;
}

int ec_ioc_sc_request(struct ec_call *call)
{
	struct ec_ioc_sc_request *i = call->arg;
	u32 limit;

	if (i->kind >= ARRAY_SIZE(limits))
		return ec_refuse(call, -EINVAL, "%u is no kind of request", i->kind);
	limit = limits[array_index_nospec(i->kind, ARRAY_SIZE(limits))];
	if (i->size > limit)
		return ec_refuse(call, -EINVAL, "size must be at most %u bytes, not %u", limit,
				 i->size);
	return request_add(call, i->config, i->kind, i->size, &i->index);
}

int ec_ioc_datagram_request(struct ec_call *call)
{
	struct ec_ioc_datagram_request *i = call->arg;

	if (!i->size || i->size > EC_MAX_DATAGRAM_SIZE)
		return ec_refuse(call, -EINVAL, "a datagram has 1 to %u bytes, not %u",
				 EC_MAX_DATAGRAM_SIZE, i->size);
	return request_add(call, EC_UAPI_NONE32, EC_REQUEST_DATAGRAM, i->size, &i->index);
}

int ec_ioc_sc_emerg(struct ec_call *call)
{
	struct ec_ioc_sc_emerg *i = call->arg;
	struct ec_session *s = call->session;
	size_t bytes;

	if (i->count > EC_MAX_EMERG)
		return ec_refuse(call, -ENOMEM, "at most %u emergencies are kept, not %u",
				 EC_MAX_EMERG, i->count);
	bytes = s->request_bytes - call->config->emergencies * EC_EMERG_BYTES +
		i->count * EC_EMERG_BYTES;
	if (bytes > EC_MAX_REQUEST_BYTES)
		return ec_refuse(call, -ENOMEM, "requests and emergencies have %u bytes together",
				 EC_MAX_REQUEST_BYTES);
	s->request_bytes = bytes;
	call->config->emergencies = i->count;
	return 0;
}
