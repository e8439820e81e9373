// SPDX-License-Identifier: GPL-2.0-only
#include "record_kept.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_ROOM	1024

int record_kept_init(struct record_kept *k, size_t n)
{
	*k = (struct record_kept){
		.n = n, .room = FIRST_ROOM, .rows = calloc(FIRST_ROOM, sizeof(*k->rows)),
		.bits = calloc(FIRST_ROOM * n + 1, sizeof(*k->bits)),
	};
	return !k->rows || !k->bits;
}

void record_kept_free(struct record_kept *k)
{
	free(k->rows);
	free(k->bits);
}

static void forget(struct record_kept *k, s64 from_ns)
{
	while (k->count && k->rows[k->first].time_ns < from_ns) {
		k->first = (k->first + 1) % k->room;
		k->count--;
	}
}

/* Twice as many rows, the oldest one at the begin. */
static int grow(struct record_kept *k)
{
	struct record_row *rows = calloc(2 * k->room, sizeof(*rows));
	u64 *bits = calloc(2 * k->room * k->n + 1, sizeof(*bits));

	if (!rows || !bits) {
		free(rows);
		free(bits);
		return -ENOMEM;
	}
	for (size_t i = 0; i < k->count; i++) {
		size_t from = (k->first + i) % k->room;

		rows[i] = k->rows[from];
		memcpy(bits + i * k->n, k->bits + from * k->n, k->n * sizeof(*bits));
	}
	record_kept_free(k);
	k->rows = rows;
	k->bits = bits;
	k->first = 0;
	k->room *= 2;
	return 0;
}

int record_kept_add(struct record_kept *k, const struct record_row *row, s64 from_ns)
{
	size_t at;

	forget(k, from_ns);
	if (k->count == k->room && grow(k))
		return -ENOMEM;
	at = (k->first + k->count++) % k->room;
	k->rows[at] = *row;
	memcpy(k->bits + at * k->n, row->bits, k->n * sizeof(*k->bits));
	return 0;
}

bool record_kept_take(struct record_kept *k, s64 from_ns, struct record_row *row)
{
	forget(k, from_ns);
	if (!k->count)
		return false;
	*row = k->rows[k->first];
	row->bits = k->bits + k->first * k->n;
	k->first = (k->first + 1) % k->room;
	k->count--;
	return true;
}
