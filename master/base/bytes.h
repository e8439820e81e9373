/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies of process values: many of them, most shorter than a call of memcpy(). */
#ifndef EC_BYTES_H
#define EC_BYTES_H

#include <linux/string.h>
#include <linux/types.h>
#include "../kernel/compat.h"

/**
 * ec_bytes_copy() - copy some bytes
 * @to: destination, apart from @from
 * @from: source
 * @len: bytes, best 1 to 32
 *
 * The first and the last part of a value may overlap, so that a few moves do
 * for any length.
 *
 * Context: Any. RT-safe.
 */
static __always_inline void ec_bytes_copy(u8 *to, const u8 *from, unsigned int len)
{
	if (len > 32) {
		memcpy(to, from, len);
	} else if (len >= 8) {
		u64 first = get_unaligned((const u64 *)from);
		u64 last = get_unaligned((const u64 *)(from + len - 8));

		if (len > 16) {
			put_unaligned(get_unaligned((const u64 *)(from + 8)), (u64 *)(to + 8));
			put_unaligned(get_unaligned((const u64 *)(from + len - 16)),
				      (u64 *)(to + len - 16));
		}
		put_unaligned(first, (u64 *)to);
		put_unaligned(last, (u64 *)(to + len - 8));
	} else if (len >= 4) {
		u32 first = get_unaligned((const u32 *)from);
		u32 last = get_unaligned((const u32 *)(from + len - 4));

		put_unaligned(first, (u32 *)to);
		put_unaligned(last, (u32 *)(to + len - 4));
	} else {
		while (len--)
			to[len] = from[len];
	}
}

/* One word; a whole one, as the compiler keeps parts of a local array in memory. */
static __always_inline void ec_bytes_word(u8 *to, const u8 *from, unsigned int at)
{
	put_unaligned(get_unaligned((const u64 *)(from + at)), (u64 *)(to + at));
}

/* 2 to 4 words, the last one at @at_last */
static __always_inline void ec_bytes_value(u8 *to, const u8 *from, unsigned int at_last,
					   unsigned int words)
{
	ec_bytes_word(to, from, 0);
	if (words > 2)
		ec_bytes_word(to, from, 8);
	if (words > 3)
		ec_bytes_word(to, from, 16);
	ec_bytes_word(to, from, at_last);
}

/* @count values of 2 to 4 @words; the last word of each may overlap those before. */
static __always_inline void ec_bytes_words(u8 *to, unsigned int to_stride, const u8 *from,
					   unsigned int from_stride, unsigned int len,
					   unsigned int count, unsigned int words)
{
	const unsigned int at_last = len - 8;
	unsigned long at = 0, end = (unsigned long)count * to_stride;

	/*
	 * an image that is as its datagrams: one distance to add, two values a turn. A single value
	 * may have none
	 */
	if (to_stride == from_stride) {
		if (count & 1) {
			ec_bytes_value(to, from, at_last, words);
			at = to_stride;
		}
		while (at != end) {
			ec_bytes_value(to + at, from + at, at_last, words);
			at += to_stride;
			ec_bytes_value(to + at, from + at, at_last, words);
			at += to_stride;
		}
		return;
	}
	for (; count; count--, to += to_stride, from += from_stride)
		ec_bytes_value(to, from, at_last, words);
}

/**
 * ec_bytes_run() - copy values of one size that stand at equal distances
 * @to: first destination
 * @to_stride: from one to the next, bytes
 * @from: first source, apart from all destinations
 * @from_stride: from one to the next, bytes
 * @len: of each value, bytes
 * @count: values
 *
 * Context: Any. RT-safe.
 */
static __always_inline void ec_bytes_run(u8 *to, unsigned int to_stride, const u8 *from,
					 unsigned int from_stride, unsigned int len,
					 unsigned int count)
{
	if (len > 16 && len <= 24)
		ec_bytes_words(to, to_stride, from, from_stride, len, count, 3);
	else if (len >= 8 && len <= 16)
		ec_bytes_words(to, to_stride, from, from_stride, len, count, 2);
	else if (len > 24 && len <= 32)
		ec_bytes_words(to, to_stride, from, from_stride, len, count, 4);
	else
		for (; count; count--, to += to_stride, from += from_stride)
			ec_bytes_copy(to, from, len);
}

#endif
