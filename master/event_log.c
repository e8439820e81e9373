// SPDX-License-Identifier: GPL-2.0-only
/*
 * Lines of the kernel log for events that have none where they are found: the cycle and its
 * counters must not print, so the monitor does.
 */
#include <linux/sched.h>
#include "base/base.h"
#include "event_log.h"
#include "wire/event.h"

/*
 * Of a working counter: complete, or no longer. That it changes while slaves come, or are taken to
 * PREOP by their application, is expected.
 */
static const char *wkc_level(const u32 *a)
{
	bool now = !a[6], before = !a[7];

	if (before == now)
		return NULL;
	return now ? KERN_INFO : a[5] ? NULL : KERN_WARNING;
}

/* NULL: the event has a line already, or the line about its result is enough. */
static const char *level(const struct ec_event *e)
{
	switch (e->kind) {
	case EC_EVENT_SLAVE_FOUND:
	case EC_EVENT_OUTPUTS:
	case EC_EVENT_DEBUG:
		return KERN_INFO;
	case EC_EVENT_STALL:
	case EC_EVENT_OVERRUN:
	case EC_EVENT_FRAMES_LOST:
	case EC_EVENT_FRAMES_LATE:
	case EC_EVENT_MISSED:
		return KERN_WARNING;
	case EC_EVENT_WKC:
		return wkc_level(e->arg);
	default:
		return NULL;
	}
}

/* What repeats for itself: a kind, each domain of it. */
static u32 subject(const struct ec_event *e)
{
	return (e->kind + 1) << 8 | (e->kind == EC_EVENT_WKC ? e->arg[0] & 0xff : 0);
}

/**
 * ec_event_log() - log new events that have no line of their own
 * @base: of a master
 * @at: number of the first new event, then of the next one
 *
 * Context: The monitor.
 */
void ec_event_log(struct ec_base *base, u64 *at)
{
	struct ec_event e = { };
	const char *lvl;
	char text[200];

	while (ec_event_ring_get(&base->events.ring, at, &e)) {
		cond_resched();
		lvl = level(&e);
		if (!lvl)
			continue;
		ec_event_text(&e, text, sizeof(text));
		ec_log_event(base, EC_LOG_ANY, subject(&e), lvl, "%s\n", text);
	}
}
