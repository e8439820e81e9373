/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Texts of events that are more than a row of the table. */
#ifndef EC_WIRE_EVENT_TEXT_H
#define EC_WIRE_EVENT_TEXT_H

#include "event.h"

#ifndef __KERNEL__
#include <stdio.h>
#endif

/**
 * struct ec_event_buf - a text, as far as there is room
 * @at: text
 * @size: bytes of it, 1 at least
 * @len: length so far
 */
struct ec_event_buf {
	char *at;
	size_t size;
	size_t len;
};

/* @t: struct ec_event_buf */
#ifdef __KERNEL__
#define ec_event_add(t, ...) \
	((t)->len += (size_t)scnprintf((t)->at + (t)->len, (t)->size - (t)->len, __VA_ARGS__))
#else
static inline size_t ec_event_stored(int n, size_t size)
{
	return n < 0 ? 0 : min((size_t)n, size - 1);
}

#define ec_event_add(t, ...) \
	((t)->len += ec_event_stored(snprintf((t)->at + (t)->len, (t)->size - (t)->len, \
					      __VA_ARGS__), (t)->size - (t)->len))
#endif

void ec_event_text_add(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more);

#endif
