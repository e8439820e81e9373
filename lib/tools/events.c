// SPDX-License-Identifier: LGPL-2.1-or-later
/* What has happened on the bus. */
#include <stdio.h>

#include "../../master/wire/event.h"
#include "internal.h"
#include "sys.h"

#define BATCH	64

int ect_events_begin(struct ect_handle *h, unsigned int flags, uint64_t *first, uint64_t *next)
{
	struct ec_ioc_events arg = {
		.flags = flags & ECT_EVENTS_NEW ? EC_EVENTS_FLAG_NEW : 0,
		.size = sizeof(struct ec_event),
	};
	int ret = ect_command(h, EC_IOC_EVENTS, &arg);

	if (first)
		*first = arg.first;
	if (next)
		*next = arg.next;
	return ret;
}

static void convert_event(struct ect_event *to, const struct ec_event *from)
{
	const struct ec_event_kind *k = ec_event_kind(from->kind);

	to->kind = from->kind;
	to->number = from->number;
	to->time_ns = from->time_ns;
	to->wall_ns = from->wall_ns;
	if (from->kind == EC_EVENT_MISSED)
		to->missed = (u64)from->arg[1] << 32 | from->arg[0];
	memcpy(to->arg, from->arg, sizeof(to->arg));
	to->slave = from->slave == EC_EVENT_NO_SLAVE ? ECT_NONE32 : from->slave;
	snprintf(to->name, sizeof(to->name), "%s", k ? k->name : "unknown");
	ec_event_text(from, to->text, sizeof(to->text));
}

int ect_events_read(struct ect_handle *h, struct ect_list **list)
{
	struct ec_event e[BATCH];
	struct ect_list *l;
	long n;

	do
		n = ect_sys_read(h->fd, e, sizeof(e));
	while (n < 0 && errno == EINTR);
	if (n < 0)
		return ect_failed(h);
	l = ect_list_new(sizeof(struct ect_event));
	for (size_t i = 0; l && i < (size_t)n / sizeof(*e); i++) {
		struct ect_event *to = ect_list_add(l);

		if (!to) {
			ect_list_free(l);
			l = NULL;
			break;
		}
		convert_event(to, &e[i]);
	}
	*list = l;
	return l ? 0 : ect_no_memory(h);
}

const char *ect_event_arg(uint32_t kind, unsigned int i, uint32_t *type)
{
	static const u32 types[] = {
		[EC_ARG_U] = ECT_ARG_UNSIGNED, [EC_ARG_I] = ECT_ARG_SIGNED,
		[EC_ARG_SLAVE] = ECT_ARG_SLAVE, [EC_ARG_AL] = ECT_ARG_AL_STATE,
		[EC_ARG_STALL] = ECT_ARG_STALL, [EC_ARG_LOCK] = ECT_ARG_LOCK,
		[EC_ARG_AL_CODE] = ECT_ARG_UNSIGNED, [EC_ARG_HEX] = ECT_ARG_UNSIGNED,
		[EC_ARG_DEVICE] = ECT_ARG_UNSIGNED,
	};
	const struct ec_event_kind *k = ec_event_kind(kind);

	if (!k || i >= EC_EVENT_ARGS || !k->arg[i].name)
		return NULL;
	if (type)
		*type = types[k->arg[i].type];
	return k->arg[i].name;
}
