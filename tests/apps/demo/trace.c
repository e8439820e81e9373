// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * What was written to an output against what an input, wired to it, showed.
 * The input is some cycles behind; how many is found out.
 */
#include "demo.h"

#include <stdlib.h>

#define LAG_MAX		16	/* cycles */
#define JITTER		2	/* cycles the lag may differ when a cycle was late */
#define TOLERANCE	50	/* part of the span: 2 % */
/*
 * One value of so many may be off: on a busy machine a cycle is late by more than JITTER, and its
 * value is older than the others.
 */
#define RARE		1000

int trace_alloc(struct trace *t, unsigned int cycles)
{
	t->sent = calloc(cycles, sizeof(*t->sent));
	t->seen = calloc(cycles, sizeof(*t->seen));
	t->still = calloc(cycles, sizeof(*t->still));
	t->min = INT16_MAX;
	t->max = INT16_MIN;
	return t->sent && t->seen && t->still ? 0 : -1;
}

/* RT-safe; at most as often as trace_alloc() was told */
void trace_add(struct trace *t, int16_t sent, int16_t seen, bool still)
{
	t->still[t->count] = still;
	t->sent[t->count] = sent;
	t->seen[t->count++] = seen;
	t->min = sent < t->min ? sent : t->min;
	t->max = sent > t->max ? sent : t->max;
}

/* Sum of the differences, the input taken as @lag cycles behind. */
static unsigned long long distance(const struct trace *t, unsigned int lag)
{
	unsigned long long sum = 0;
	unsigned int i;

	for (i = LAG_MAX; i < t->count; i++)
		sum += (unsigned int)abs(t->seen[i] - t->sent[i - lag]);
	return sum;
}

/*
 * How far value @i of the input is from what was written @lag cycles before.
 * A frame of a late cycle is answered after the next one has begun.
 */
static unsigned int difference(const struct trace *t, unsigned int i)
{
	int diff, low = INT16_MAX, high = INT16_MIN;
	unsigned int lag;

	lag = t->lag > JITTER ? t->lag - JITTER : 0;
	for (; lag <= t->lag + JITTER; lag++) {
		low = t->sent[i - lag] < low ? t->sent[i - lag] : low;
		high = t->sent[i - lag] > high ? t->sent[i - lag] : high;
	}
	diff = t->seen[i] < low ? low - t->seen[i] : t->seen[i] - high;
	return diff > 0 ? (unsigned int)diff : 0;
}

/*
 * @lag: cycles the input is behind; @off: values that differ by more than 2 %
 * of the span, taking that into account; @off_still: of these, those soon after a standstill of
 * the machine; @worst: largest difference
 */
void trace_judge(struct trace *t)
{
	unsigned long long best = ~0ULL, now;
	unsigned int i, diff;
	bool off;

	for (i = 0; i + JITTER <= LAG_MAX; i++) {
		now = distance(t, i);
		if (now < best) {
			best = now;
			t->lag = i;
		}
	}
	for (i = LAG_MAX; i < t->count; i++) {
		diff = difference(t, i);
		t->worst = diff > t->worst ? diff : t->worst;
		off = diff * TOLERANCE > (unsigned int)(t->max - t->min);
		t->off += off;
		t->off_still += off && t->still[i];
	}
}

/* A value that never changes proves nothing. @excuse: without those soon after a standstill. */
bool trace_followed(const struct trace *t, bool excuse)
{
	unsigned int off = excuse ? t->off - t->off_still : t->off;

	return t->count > LAG_MAX && t->max > t->min && off <= t->count / RARE;
}
