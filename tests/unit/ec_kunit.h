/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * What every *_kunit.c includes: the kernel's KUnit, or in userspace our
 * replacement.  Adds KUNIT_{EXPECT,ASSERT}_MEMEQ, which KUnit has since 6.2.
 */
#ifndef EC_KUNIT_H
#define EC_KUNIT_H

#ifdef __KERNEL__
#include <linux/kernel.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/string.h>
#include <kunit/test.h>
#else
#include "kunit_user.h"
#endif

#ifndef KUNIT_EXPECT_MEMEQ

/* Shows both buffers from the first byte that differs. */
static inline void ec_kunit_show_diff(struct kunit *test, const void *left,
				      const void *right, size_t size)
{
	const unsigned char *l = left, *r = right;
	char a[3 * 16 + 1] = "", b[3 * 16 + 1] = "";
	size_t at, i;

	for (at = 0; at < size && l[at] == r[at]; at++)
		;
	for (i = 0; i < 16 && at + i < size; i++) {
		snprintf(a + 3 * i, 4, " %02x", l[at + i]);
		snprintf(b + 3 * i, 4, " %02x", r[at + i]);
	}
	kunit_err(test, "%zu bytes, from offset %zu: left%s right%s", size, at,
		  a, b);
}

#define EC_KUNIT_MEM(test, type, left, right, size, equal, fmt, ...)	\
	do {								\
		const void *__left = (left), *__right = (right);	\
		size_t __size = (size);					\
									\
		if ((memcmp(__left, __right, __size) == 0) == (equal))\
			break;						\
		ec_kunit_show_diff(test, __left, __right, __size);	\
		KUNIT_FAIL_ASSERTION(test, type,			\
			"Expected " #left " %s " #right fmt,		\
			(equal) ? "==" : "!=", ##__VA_ARGS__);		\
	} while (0)

#define KUNIT_EXPECT_MEMEQ(test, l, r, size) \
	EC_KUNIT_MEM(test, KUNIT_EXPECTATION, l, r, size, true, "")
#define KUNIT_EXPECT_MEMEQ_MSG(test, l, r, size, fmt, ...) \
	EC_KUNIT_MEM(test, KUNIT_EXPECTATION, l, r, size, true, "\n" fmt, \
		     ##__VA_ARGS__)
#define KUNIT_EXPECT_MEMNEQ(test, l, r, size) \
	EC_KUNIT_MEM(test, KUNIT_EXPECTATION, l, r, size, false, "")
#define KUNIT_EXPECT_MEMNEQ_MSG(test, l, r, size, fmt, ...) \
	EC_KUNIT_MEM(test, KUNIT_EXPECTATION, l, r, size, false, "\n" fmt, \
		     ##__VA_ARGS__)
#define KUNIT_ASSERT_MEMEQ(test, l, r, size) \
	EC_KUNIT_MEM(test, KUNIT_ASSERTION, l, r, size, true, "")
#define KUNIT_ASSERT_MEMEQ_MSG(test, l, r, size, fmt, ...) \
	EC_KUNIT_MEM(test, KUNIT_ASSERTION, l, r, size, true, "\n" fmt, \
		     ##__VA_ARGS__)
#define KUNIT_ASSERT_MEMNEQ(test, l, r, size) \
	EC_KUNIT_MEM(test, KUNIT_ASSERTION, l, r, size, false, "")
#define KUNIT_ASSERT_MEMNEQ_MSG(test, l, r, size, fmt, ...) \
	EC_KUNIT_MEM(test, KUNIT_ASSERTION, l, r, size, false, "\n" fmt, \
		     ##__VA_ARGS__)

#endif /* KUNIT_EXPECT_MEMEQ */

#endif /* EC_KUNIT_H */
