// SPDX-License-Identifier: LGPL-2.1-or-later
/* Events: how the file is opened, and what records say. */
#include "session.h"

#include <errno.h>
#include <string.h>

static void opens(void)
{
	const struct ec_ioc_events *arg = (void *)fake.arg;
	unsigned int closes = fake.closes;

	CHECK(ecrt_open_events(0, 0) == FAKE_FD && !fake.writable);
	CHECK(fake.last == EC_IOC_EVENTS && !arg->flags && arg->size == sizeof(ec_event_t));
	CHECK(ecrt_open_events(0, 1) == FAKE_FD && arg->flags == EC_EVENTS_FLAG_NEW);
	CHECK(fake.closes == closes);
	CHECK(ecrt_open_events(7, 0) == -ENOENT && errno == ENOENT);
	/* an older module: nothing is left open */
	fake.refuse = EC_IOC_EVENTS;
	fake.err = ENOTTY;
	CHECK(ecrt_open_events(0, 0) == -ENOTTY && errno == ENOTTY);
	CHECK(fake.closes == closes + 1);
	fake.refuse = 0;
}

static void says(void)
{
	ec_event_t e = { .kind = EC_EVENT_LINK_DOWN, .slave = EC_EVENT_NO_SLAVE };
	char text[200];

	CHECK(!strcmp(ecrt_event_name(EC_EVENT_LINK_DOWN), "link_down"));
	CHECK(!strcmp(ecrt_event_name(0xabcd), "unknown"));
	CHECK(ecrt_event_text(&e, text, sizeof(text)) == 14 && !strcmp(text, "main link down"));
	CHECK(ecrt_event_text(&e, text, 5) == 4 && !strcmp(text, "main"));
	CHECK(ecrt_event_text(NULL, text, sizeof(text)) == -EINVAL);
	CHECK(ecrt_event_text(&e, NULL, 5) == -EINVAL);
	CHECK(ecrt_event_text(&e, text, 0) == -EINVAL);
	e.kind = EC_EVENT_MISSED;
	e.arg[0] = 12;
	ecrt_event_text(&e, text, sizeof(text));
	CHECK(!strcmp(text, "12 event(s) missed: the reader was too slow"));
}

void events(void)
{
	memset(&fake, 0, sizeof(fake));
	opens();
	says();
	memset(&fake, 0, sizeof(fake));
}
