/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: what has happened on the bus. */
#ifndef ETHERCAT_TOOLS_EVENTS_H
#define ETHERCAT_TOOLS_EVENTS_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_EVENT_ARGS		8
#define ECT_EVENT_MISSED	0x00	/* kind: this reader has missed @missed events */

/* types of arguments */
#define ECT_ARG_UNSIGNED	1
#define ECT_ARG_SIGNED		2
#define ECT_ARG_SLAVE		3	/* ring position, ECT_NONE32: none */
#define ECT_ARG_AL_STATE	4	/* 0: none */
#define ECT_ARG_STALL		5	/* ECT_STALL_* */
#define ECT_ARG_LOCK		6	/* ECT_LOCK_* */

struct ect_event {
	uint32_t struct_size;
	uint32_t kind;		/* never changes its meaning; @name is its name */
	uint64_t number;	/* since the module was loaded; of the first one that is missed */
	uint64_t time_ns;	/* since the start of the computer, CLOCK_MONOTONIC */
	uint64_t wall_ns;	/* since 1970 */
	uint64_t missed;	/* of %ECT_EVENT_MISSED: how many */
	uint32_t arg[ECT_EVENT_ARGS];	/* see ect_event_arg() */
	uint32_t slave;		/* ring position, ECT_NONE32: not of one slave */
	uint32_t reserved;
	char name[32];		/* one word */
	char text[ECT_TEXT];	/* a sentence */
};

/* flags of ect_events_begin() */
#define ECT_EVENTS_NEW	1U	/* begin with the next event, not with the oldest kept */

/**
 * ect_events_begin() - begin to read events
 * @h: master; each open handle is a reader of its own, and each reader gets all events
 * @flags: ECT_EVENTS_*
 * @first: NULL, or set to the number of the first event that ect_events_read() gets
 * @next: NULL, or set to the number of the event that comes next
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_events_begin(struct ect_handle *h, unsigned int flags, uint64_t *first, uint64_t *next);

/**
 * ect_events_read() - the next events
 * @h: master, after ect_events_begin()
 * @list: result, elements are struct ect_event; an empty list: there will be none, as the module
 *	is being removed
 *
 * Waits for an event if there is none; poll() on ect_fd() says when there is one.
 *
 * Context: The thread of the handle; a signal does not end the wait.
 * Return: 0 or a negative errno.
 */
int ect_events_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_event_arg() - what an argument of an event is
 * @kind: of the event
 * @i: index of the argument, from 0
 * @type: NULL, or set to ECT_ARG_*
 *
 * Context: Any.
 * Return: one word with the unit; NULL behind the last one, or for an unknown kind.
 */
const char *ect_event_arg(uint32_t kind, unsigned int i, uint32_t *type);

#ifdef __cplusplus
}
#endif

#endif
