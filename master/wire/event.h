/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Names and texts of events. */
#ifndef EC_WIRE_EVENT_H
#define EC_WIRE_EVENT_H

#include "env.h"
#include "../../include/uapi/ethercat_event.h"
#include "../../include/uapi/ethercat_unit.h"

/* kinds of arguments */
enum ec_event_arg {
	EC_ARG_END,
	EC_ARG_U,	/* unsigned */
	EC_ARG_I,	/* signed */
	EC_ARG_SLAVE,	/* ring position or EC_EVENT_NONE */
	EC_ARG_AL,	/* AL state, 0: none */
	EC_ARG_STALL,	/* EC_STALL_* */
	EC_ARG_LOCK,	/* EC_CYCLE_LOCK_*, 0: not synchronized to the reference clock */
	EC_ARG_AL_CODE,	/* AL status code */
	EC_ARG_HEX,	/* number of 32 bits, in hexadecimal */
	EC_ARG_DEVICE,	/* 0 main, 1 backup */
};

/* what the kernel log has of an event */
enum ec_event_line {
	EC_LINE_NONE,
	EC_LINE_INFO,
	EC_LINE_WARN,
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

/**
 * struct ec_event_more - what the kernel knows of an event, and its record does not contain
 * @detail: text behind that of the record, or a better one than its last part; NULL: none
 * @place: port of a slave with its name, or the main device
 * @name: of the slave, the first one of several
 * @last: name of the last slave of several
 */
struct ec_event_more {
	const char *detail;
	const char *place;
	const char *name;
	const char *last;
};

const struct ec_event_kind *ec_event_kind(u32 kind);
enum ec_event_line ec_event_level(const struct ec_event *e);
bool ec_event_is_later(u32 kind);
bool ec_event_is_of_slave(const struct ec_event *e);
void ec_event_line(const struct ec_event *e, const struct ec_event_more *more, char *buf,
		   size_t size);
int ec_event_text(const struct ec_event *e, char *buf, size_t size);

#endif
