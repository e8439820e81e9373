/* SPDX-License-Identifier: GPL-2.0-only */
/* What the slave answers to the request of a list of objects. */
#ifndef OD_LIST_H
#define OD_LIST_H

#include "../../master/wire/sdoinfo.h"

static inline size_t od_list_count(const struct ec_sdoinfo *s)
{
	return s->size / 2;
}

/* 0 when @i is too large */
static inline u16 od_list_get(const struct ec_sdoinfo *s, size_t i)
{
	return i < s->size / 2 ? get_unaligned_le16(s->data + 2 * i) : 0;
}

#endif
