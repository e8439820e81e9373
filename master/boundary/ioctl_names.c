// SPDX-License-Identifier: GPL-2.0-only
/* What an application says of its values, for tools. The kernel keeps it and does not read it. */
#include <linux/mm.h>
#include "../session/session.h"
#include "ioctl.h"

int ec_ioc_set_names(struct ec_call *call)
{
	struct ec_session *s = call->session;
	u8 *names = NULL;
	int ret;

	if (call->size && !call->data)
		return ec_refuse(call, -E2BIG, "%u bytes of names, limit %u", call->size,
				 EC_UAPI_NAMES_MAX);
	ret = ec_budget_charge(&s->wanted.budget, call->size);
	if (ret)
		return ec_refuse(call, ret,
				 "no memory for %u bytes of names: limit of the session",
				 call->size);
	if (call->size) {
		names = kvmalloc(call->size, GFP_KERNEL_ACCOUNT);
		if (!names) {
			ec_budget_release(&s->wanted.budget, call->size);
			return -ENOMEM;
		}
		memcpy(names, call->data, call->size);
	}
	ec_budget_release(&s->wanted.budget, s->names_size);
	kvfree(s->names);
	s->names = names;
	s->names_size = call->size;
	return 0;
}

int ec_ioc_names(struct ec_call *call)
{
	struct ec_ioc_names *i = call->arg;
	const struct ec_session *s = call->session;

	i->size = s->names_size;
	return ec_ioc_copy_out(call, s->names, s->names_size);
}
