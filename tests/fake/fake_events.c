// SPDX-License-Identifier: GPL-2.0-only
/*
 * Events of the fake master. FAKE_EVENTS=gap: some are lost while they are read, =unknown: one is
 * of a newer module, =none: nothing has happened, =quiet: none comes later, =old: the module
 * has no events. The end of those that come later is the end of the file.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "../../lib/tools/sys.h"
#include "../../tool/sys.h"
#include "fake.h"

#define WALL	1764000000000000000ULL
#define EVENT(ms, k, s, ...) { \
	.time_ns = 5000000000ULL + (ms) * 1000000ULL, .wall_ns = WALL + (ms) * 1000000ULL, \
	.kind = EC_EVENT_##k, .slave = (s), .arg = { __VA_ARGS__ } }
#define NO_SLAVE	EC_EVENT_NO_SLAVE
#define KEPT	9	/* the others come later */

static const struct ec_event all[] = {
	EVENT(0, LINK_UP, NO_SLAVE, 0),
	EVENT(3, SCAN_END, NO_SLAVE, 3, 4100, 120),
	EVENT(100, RESERVED, NO_SLAVE, 4711),
	EVENT(120, ACTIVATED, NO_SLAVE, 4711, 1, 24, 2),
	EVENT(150, AL_STATE, 2, 8, 4, 1),
	EVENT(151, WKC, NO_SLAVE, 0, 3, 1, 3),
	EVENT(1000, WKC, NO_SLAVE, 0, 1, 3, 3, 2),
	EVENT(1020, SLAVE_LOST, 2, 1, 1, 0, 2, 0x1c213052, 25, 92),
	EVENT(1021, LOCK, NO_SLAVE, 3, (__u32)-12, (__u32)-8700),
	EVENT(2000, SLAVE_FOUND, 2, EC_EVENT_NONE, 0, 1001, 2, 0x1c213052, 1),
	EVENT(2100, AL_ERROR, 2, 4, 0x1b),
};

static unsigned int at;

static bool is(const char *what)
{
	const char *v = getenv("FAKE_EVENTS");

	return v && !strcmp(v, what);
}

int fake_events(unsigned long request, void *arg)
{
	struct ec_ioc_events *i = arg;

	if (request != EC_IOC_EVENTS)
		return FAKE_OTHER;
	if (is("old")) {
		errno = ENOTTY;
		return -1;
	}
	if (i->size != sizeof(struct ec_event) || i->flags)
		return fake_fail(EINVAL, "another size");
	at = 0;
	i->first = 7;
	i->next = is("none") ? 7 : 7 + KEPT;
	return 0;
}

int sys_poll(struct pollfd *p, unsigned int n)
{
	p->revents = 0;
	if (is("quiet") && at >= KEPT)
		return poll(p + 1, n - 1, -1);
	p->revents = POLLIN;
	return 1 + poll(p + 1, n - 1, 0);
}

/* three at a time */
long ect_sys_read(int fd, void *buf, unsigned long size)
{
	struct ec_event *e = buf;
	unsigned int n;
	long bytes;

	(void)fd;
	if (fake_mail_read(buf, size, &bytes) || fake_recorder_read(buf, size, &bytes))
		return bytes;
	for (n = 0; n < 3 && at < LEN(all) && size >= sizeof(*e); n++, e++, at++) {
		*e = all[at];
		e->number = 7 + at;
		if (is("unknown") && at == 4)
			e->kind = 0xabc;
		if (is("gap") && at == 3) {
			*e = (struct ec_event)EVENT(120, MISSED, NO_SLAVE, 4);
			e->number = 7 + at;
			at += 3;
		}
		size -= sizeof(*e);
	}
	return (long)(n * sizeof(*e));
}
