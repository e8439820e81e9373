/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Included first in each file of modules built for a kernel with KCSAN: gcc 12 instruments
 * no call of memcpy() and its like, so that a race in one would not be seen.
 */
#ifndef EC_KCSAN_MEM_H
#define EC_KCSAN_MEM_H

#include <linux/kcsan-checks.h>
#include <linux/string.h>

static __always_inline void *ec_kcsan_memcpy(void *to, const void *from, size_t n)
{
	kcsan_check_read(from, n);
	kcsan_check_write(to, n);
	return __builtin_memcpy(to, from, n);
}

static __always_inline void *ec_kcsan_memmove(void *to, const void *from, size_t n)
{
	kcsan_check_read(from, n);
	kcsan_check_write(to, n);
	return __builtin_memmove(to, from, n);
}

static __always_inline void *ec_kcsan_memset(void *to, int c, size_t n)
{
	kcsan_check_write(to, n);
	return __builtin_memset(to, c, n);
}

static __always_inline int ec_kcsan_memcmp(const void *a, const void *b, size_t n)
{
	kcsan_check_read(a, n);
	kcsan_check_read(b, n);
	return __builtin_memcmp(a, b, n);
}

#undef memcpy
#undef memmove
#undef memset
#undef memcmp
#define memcpy(to, from, n)	ec_kcsan_memcpy(to, from, n)
#define memmove(to, from, n)	ec_kcsan_memmove(to, from, n)
#define memset(to, c, n)	ec_kcsan_memset(to, c, n)
#define memcmp(a, b, n)		ec_kcsan_memcmp(a, b, n)

#endif
