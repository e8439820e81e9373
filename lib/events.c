// SPDX-License-Identifier: LGPL-2.1-or-later
/* Events of a master: a file to read them from, and what they say. */

#include <fcntl.h>
#include <unistd.h>

#include "ecrt/ecrt_int.h"
#include "../master/wire/event.h"

_Static_assert(sizeof(ec_event_t) == sizeof(struct ec_event), "both are one record");
_Static_assert(offsetof(ec_event_t, arg) == offsetof(struct ec_event, arg), "likewise");

int ecrt_open_events(unsigned int master_index, int only_new)
{
	struct ec_ioc_events arg = {
		.flags = only_new ? EC_EVENTS_FLAG_NEW : 0, .size = sizeof(struct ec_event),
	};
	struct ec_master m = { .index = master_index };
	char path[40];
	int ret;

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", master_index);
	m.fd = open(path, O_RDONLY | O_CLOEXEC);
	if (m.fd < 0)
		return ec_cannot_open(path);
	ret = ec_do(&m, EC_IOC_EVENTS, &arg, "read events of master %u", master_index);
	if (!ret)
		return m.fd;
	close(m.fd);
	errno = -ret;
	return ret;
}

const char *ecrt_event_name(uint32_t kind)
{
	const struct ec_event_kind *k = ec_event_kind(kind);

	return k ? k->name : "unknown";
}

int ecrt_event_text(const ec_event_t *event, char *buf, size_t size)
{
	struct ec_event e;

	if (!event || !buf || !size)
		return -EINVAL;
	memcpy(&e, event, sizeof(e));
	return ec_event_text(&e, buf, size);
}
