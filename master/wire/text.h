/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Sorted tables from code to text. */
#ifndef EC_WIRE_TEXT_H
#define EC_WIRE_TEXT_H

#include "env.h"

/**
 * struct ec_text - one line of a table
 * @code: key, ascending through the table
 * @text: meaning
 */
struct ec_text {
	u32 code;
	const char *text;
};

/* NULL when @code is not in the table */
static inline const char *ec_text_find(const struct ec_text *table, size_t n, u32 code)
{
	size_t lo = 0, hi = n;

	while (lo < hi) {
		size_t mid = lo + (hi - lo) / 2;

		if (table[mid].code == code)
			return table[mid].text;
		if (table[mid].code < code)
			lo = mid + 1;
		else
			hi = mid;
	}
	return NULL;
}

#endif
