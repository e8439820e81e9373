/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * What happens is an event: a record for readers and a line of the kernel log, both by the row of
 * its kind (wire/event.c). ec_event() makes the record alone, where nothing may be printed.
 */
#ifndef EC_REPORT_H
#define EC_REPORT_H

#include "../wire/event.h"

struct ec_base;

void ec_report_put(struct ec_base *b, u32 kind, u16 slave, const struct ec_event_more *more,
		   const u32 *args);
void ec_report_print(struct ec_base *b, const struct ec_event *e,
		     const struct ec_event_more *more);

/* @more_: const struct ec_event_more * or NULL; the arguments of @kind follow. Process context */
#define ec_report_more(base, kind, slave, more_, ...) \
	ec_report_put(base, kind, slave, more_, (const u32 [EC_EVENT_ARGS]) { __VA_ARGS__ })
#define ec_report(base, kind, ...) \
	ec_report_more(base, kind, EC_EVENT_NO_SLAVE, NULL, ##__VA_ARGS__)
/* the line alone, where lines have a limit that records do not have */
#define ec_report_line(base, kind_, ...) \
	ec_report_print(base, &(const struct ec_event){ \
		.kind = kind_, .slave = EC_EVENT_NO_SLAVE, .arg = { __VA_ARGS__ } }, NULL)

#endif
