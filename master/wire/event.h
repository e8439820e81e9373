/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Names and texts of events. */
#ifndef EC_WIRE_EVENT_H
#define EC_WIRE_EVENT_H

#include "env.h"
#include "../../include/uapi/ethercat_event.h"

/* kinds of arguments */
enum ec_event_arg {
	EC_ARG_END,
	EC_ARG_U,	/* unsigned */
	EC_ARG_I,	/* signed */
	EC_ARG_SLAVE,	/* ring position or EC_EVENT_NONE */
	EC_ARG_AL,	/* AL state, 0: none */
	EC_ARG_STALL,	/* EC_STALL_* */
	EC_ARG_LOCK,	/* EC_CYCLE_LOCK_*, 0: not synchronized to the reference clock */
};

/**
 * struct ec_event_kind - an event, for programs
 * @kind: EC_EVENT_*
 * @name: one word
 * @arg: its arguments
 * @arg.name: one word with the unit, NULL behind the last
 * @arg.type: what it is
 */
struct ec_event_kind {
	u32 kind;
	const char *name;
	struct {
		const char *name;
		enum ec_event_arg type;
	} arg[EC_EVENT_ARGS];
};

const struct ec_event_kind *ec_event_kind(u32 kind);
int ec_event_text(const struct ec_event *e, char *buf, size_t size);

#endif
