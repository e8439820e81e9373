// SPDX-License-Identifier: GPL-2.0-only
#include "base.h"
#include "report.h"

/* Makes events of one kind different ones for the limit of the kernel log. */
static u32 report_id(const struct ec_event *e)
{
	switch (e->kind) {
	case EC_EVENT_WKC:
	case EC_EVENT_STALE:
	case EC_EVENT_UNIT:
		return 1 + e->arg[0];
	case EC_EVENT_SLAVE_LOST:
	case EC_EVENT_SLAVE_FOUND:
		return 1 + e->slave;
	case EC_EVENT_LINE_ERRORS:
		return 1 + (e->slave << 2 | e->arg[0]);
	case EC_EVENT_CONFIG:
		return 1 + (e->arg[0] << 16 | e->arg[1]);
	default:
		return 0;
	}
}

/**
 * ec_report_print() - the line of an event in the kernel log
 * @b: of the master
 * @e: event
 * @more: what the record does not contain, or NULL
 *
 * Context: Any that may print.
 */
void ec_report_print(struct ec_base *b, const struct ec_event *e,
		     const struct ec_event_more *more)
{
	static const char *const levels[] = {
		[EC_LINE_INFO] = KERN_INFO, [EC_LINE_WARN] = KERN_WARNING,
	};
	static const struct ec_event_more none;
	int slave = ec_event_is_of_slave(e) ? e->slave : EC_LOG_ANY;
	enum ec_event_line level = ec_event_level(e);
	char text[EC_LOG_TEXT];

	if (level == EC_LINE_NONE)
		return;
	ec_event_line(e, more ?: &none, text, sizeof(text));
	ec_log_text(b, slave, report_id(e), levels[level], ec_event_kind(e->kind)->name, text);
}

/**
 * ec_report_put() - record an event, and print its line
 * @b: of the master
 * @kind: EC_EVENT_*
 * @slave: ring position or EC_EVENT_NO_SLAVE
 * @more: what the record does not contain, or NULL
 * @args: EC_EVENT_ARGS arguments
 *
 * Context: Any that may print.
 */
void ec_report_put(struct ec_base *b, u32 kind, u16 slave, const struct ec_event_more *more,
		   const u32 *args)
{
	struct ec_event e = { .kind = kind, .slave = slave };

	memcpy(e.arg, args, sizeof(e.arg));
	ec_events_put(&b->events, kind, slave, args);
	ec_report_print(b, &e, more);
}
