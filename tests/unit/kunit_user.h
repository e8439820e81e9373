/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * As much of the kernel's KUnit API (6.1) as unit tests need, for userspace:
 * the same *_kunit.c runs under ASan and UBSan.  Include "ec_kunit.h", not
 * this file; main() is in kunit_user_main.c.
 */
#ifndef KUNIT_USER_H
#define KUNIT_USER_H

#include <errno.h>
#include <limits.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* The few kernel words tests use, the same as in master/wire/env.h. */
typedef uint8_t u8;
typedef uint16_t u16;
typedef uint32_t u32;
typedef uint64_t u64;
typedef int8_t s8;
typedef int16_t s16;
typedef int32_t s32;
typedef int64_t s64;
#ifndef ARRAY_SIZE
#define ARRAY_SIZE(a) (sizeof(a) / sizeof((a)[0]))
#endif
#ifndef GFP_KERNEL
#define GFP_KERNEL 0
#endif
#ifndef MODULE_LICENSE
#define MODULE_LICENSE(x) struct ec_kunit_unused
#define MODULE_DESCRIPTION(x) struct ec_kunit_unused
#define MODULE_AUTHOR(x) struct ec_kunit_unused
#endif
#ifndef IS_ERR_OR_NULL
#define IS_ERR_OR_NULL(p) (!(p) || (uintptr_t)(p) >= (uintptr_t)-4095)
#endif

#define KUNIT_PARAM_DESC_SIZE 128

enum kunit_status { KUNIT_SUCCESS, KUNIT_FAILURE, KUNIT_SKIPPED };
enum kunit_assert_type { KUNIT_ASSERTION, KUNIT_EXPECTATION };

struct kunit {
	void *priv;
	const char *name;
	const void *param_value;
	int param_index;
	enum kunit_status status;
	char status_comment[256];
	jmp_buf out;
	struct kunit_user_mem *mem;
};

struct kunit_case {
	void (*run_case)(struct kunit *test);
	const char *name;
	const void *(*generate_params)(const void *prev, char *desc);
};

struct kunit_suite {
	const char name[256];
	int (*suite_init)(struct kunit_suite *suite);
	void (*suite_exit)(struct kunit_suite *suite);
	int (*init)(struct kunit *test);
	void (*exit)(struct kunit *test);
	struct kunit_case *test_cases;
	struct kunit_suite *next;
};

void kunit_user_register(struct kunit_suite **suites, size_t n);
void kunit_user_log(struct kunit *test, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
void kunit_user_comment(struct kunit *test, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
_Noreturn void kunit_user_leave(struct kunit *test);
void kunit_user_failed(struct kunit *test, enum kunit_assert_type type,
		       const char *file, int line, const char *expected);
/* Prints the optional message, then leaves the case if it was an ASSERT. */
void kunit_user_finish(struct kunit *test, enum kunit_assert_type type,
		       const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));
void kunit_user_values(const char *ltext, long long l,
		       const char *rtext, long long r);

void *kunit_user_alloc(struct kunit *test, size_t n, size_t size, bool zero);
void kunit_kfree(struct kunit *test, const void *ptr);
#define kunit_kmalloc_array(test, n, size, gfp) \
	((void)(gfp), kunit_user_alloc(test, n, size, false))
#define kunit_kcalloc(test, n, size, gfp) \
	((void)(gfp), kunit_user_alloc(test, n, size, true))
#define kunit_kmalloc(test, size, gfp) kunit_kmalloc_array(test, 1, size, gfp)
#define kunit_kzalloc(test, size, gfp) kunit_kcalloc(test, 1, size, gfp)

#define KUNIT_CASE(fn) { .run_case = fn, .name = #fn }
#define KUNIT_CASE_PARAM(fn, gen) \
	{ .run_case = fn, .name = #fn, .generate_params = gen }
#define KUNIT_ARRAY_PARAM(name, array, get_desc)			\
	static const void *name##_gen_params(const void *prev, char *desc) \
	{								\
		typeof((array)[0]) *__next = prev ?			\
			((typeof(__next))prev) + 1 : (array);		\
		if ((size_t)(__next - (array)) < ARRAY_SIZE(array)) {	\
			void (*__get)(typeof(__next), char *) = get_desc; \
			if (__get)					\
				__get(__next, desc);			\
			return __next;					\
		}							\
		return NULL;						\
	}

#define KUNIT_USER_CAT2(a, b) a##b
#define KUNIT_USER_CAT(a, b) KUNIT_USER_CAT2(a, b)
#define kunit_test_suites(...)						\
	__attribute__((constructor)) static void			\
	KUNIT_USER_CAT(kunit_user_init_, __LINE__)(void)		\
	{								\
		static struct kunit_suite *__suites[] = { __VA_ARGS__ };\
		kunit_user_register(__suites, ARRAY_SIZE(__suites));\
	}								\
	struct ec_kunit_unused
#define kunit_test_suite(suite) kunit_test_suites(&suite)

#define kunit_info kunit_user_log
#define kunit_warn kunit_user_log
#define kunit_err kunit_user_log
#define kunit_mark_skipped(test, fmt, ...)				\
	do {								\
		(test)->status = KUNIT_SKIPPED;				\
		kunit_user_comment(test, fmt, ##__VA_ARGS__);		\
	} while (0)
#define kunit_skip(test, fmt, ...)					\
	do {								\
		kunit_mark_skipped(test, fmt, ##__VA_ARGS__);		\
		kunit_user_leave(test);					\
	} while (0)

#define KUNIT_SUCCEED(test) do { } while (0)
#define KUNIT_FAIL_ASSERTION(test, type, fmt, ...)			\
	do {								\
		kunit_user_failed(test, type, __FILE__, __LINE__, NULL); \
		kunit_user_finish(test, type, fmt, ##__VA_ARGS__);	\
	} while (0)
#define KUNIT_FAIL(test, fmt, ...) \
	KUNIT_FAIL_ASSERTION(test, KUNIT_EXPECTATION, fmt, ##__VA_ARGS__)

#define KUNIT_USER_COND(test, type, cond, text, fmt, ...)		\
	do {								\
		if (cond)						\
			break;						\
		kunit_user_failed(test, type, __FILE__, __LINE__, text); \
		kunit_user_finish(test, type, fmt, ##__VA_ARGS__);	\
	} while (0)

/* Compares in the types of the two sides, as KUnit does. */
#define KUNIT_USER_BIN(test, type, left, op, right, fmt, ...)		\
	do {								\
		const typeof(left) __left = (left);			\
		const typeof(right) __right = (right);			\
		if (__left op __right)					\
			break;						\
		kunit_user_failed(test, type, __FILE__, __LINE__,	\
				  #left " " #op " " #right);		\
		kunit_user_values(#left, (long long)__left,		\
				  #right, (long long)__right);		\
		kunit_user_finish(test, type, fmt, ##__VA_ARGS__);	\
	} while (0)
#define KUNIT_USER_PTR(test, type, left, op, right, fmt, ...)		\
	do {								\
		const void *__lp = (left), *__rp = (right);		\
		if (__lp op __rp)					\
			break;						\
		kunit_user_failed(test, type, __FILE__, __LINE__,	\
				  #left " " #op " " #right);		\
		kunit_user_values(#left, (long long)(intptr_t)__lp,	\
				  #right, (long long)(intptr_t)__rp);	\
		kunit_user_finish(test, type, fmt, ##__VA_ARGS__);	\
	} while (0)
#define KUNIT_USER_STR(test, type, left, op, right, fmt, ...)		\
	do {								\
		const char *__ls = (left), *__rs = (right);		\
		if (strcmp(__ls, __rs) op 0)				\
			break;						\
		kunit_user_failed(test, type, __FILE__, __LINE__,	\
				  #left " " #op " " #right);		\
		printf("    %s == \"%s\"\n    %s == \"%s\"\n",		\
		       #left, __ls, #right, __rs);			\
		kunit_user_finish(test, type, fmt, ##__VA_ARGS__);	\
	} while (0)

#define KUNIT_EXPECT_EQ(test, l, r) KUNIT_EXPECT_EQ_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_EQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_NE(test, l, r) KUNIT_EXPECT_NE_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_NE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_LT(test, l, r) KUNIT_EXPECT_LT_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_LT_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, <, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_LE(test, l, r) KUNIT_EXPECT_LE_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_LE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, <=, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_GT(test, l, r) KUNIT_EXPECT_GT_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_GT_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, >, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_GE(test, l, r) KUNIT_EXPECT_GE_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_GE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_EXPECTATION, l, >=, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_PTR_EQ(test, l, r) \
	KUNIT_EXPECT_PTR_EQ_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_PTR_EQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_EXPECTATION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_PTR_NE(test, l, r) \
	KUNIT_EXPECT_PTR_NE_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_PTR_NE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_EXPECTATION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_STREQ(test, l, r) \
	KUNIT_EXPECT_STREQ_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_STREQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_STR(test, KUNIT_EXPECTATION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_STRNEQ(test, l, r) \
	KUNIT_EXPECT_STRNEQ_MSG(test, l, r, "%s", "")
#define KUNIT_EXPECT_STRNEQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_STR(test, KUNIT_EXPECTATION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_TRUE(test, c) KUNIT_EXPECT_TRUE_MSG(test, c, "%s", "")
#define KUNIT_EXPECT_TRUE_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_EXPECTATION, c, #c, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_FALSE(test, c) KUNIT_EXPECT_FALSE_MSG(test, c, "%s", "")
#define KUNIT_EXPECT_FALSE_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_EXPECTATION, !(c), "!(" #c ")", fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_NULL(test, c) KUNIT_EXPECT_NULL_MSG(test, c, "%s", "")
#define KUNIT_EXPECT_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_EXPECTATION, c, ==, NULL, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_NOT_NULL(test, c) \
	KUNIT_EXPECT_NOT_NULL_MSG(test, c, "%s", "")
#define KUNIT_EXPECT_NOT_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_EXPECTATION, c, !=, NULL, fmt, ##__VA_ARGS__)
#define KUNIT_EXPECT_NOT_ERR_OR_NULL(test, c) \
	KUNIT_EXPECT_NOT_ERR_OR_NULL_MSG(test, c, "%s", "")
#define KUNIT_EXPECT_NOT_ERR_OR_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_EXPECTATION, !IS_ERR_OR_NULL(c), "valid pointer: " #c, fmt, ##__VA_ARGS__)

#define KUNIT_ASSERT_EQ(test, l, r) KUNIT_ASSERT_EQ_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_EQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_NE(test, l, r) KUNIT_ASSERT_NE_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_NE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_LT(test, l, r) KUNIT_ASSERT_LT_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_LT_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, <, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_LE(test, l, r) KUNIT_ASSERT_LE_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_LE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, <=, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_GT(test, l, r) KUNIT_ASSERT_GT_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_GT_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, >, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_GE(test, l, r) KUNIT_ASSERT_GE_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_GE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_BIN(test, KUNIT_ASSERTION, l, >=, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_PTR_EQ(test, l, r) \
	KUNIT_ASSERT_PTR_EQ_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_PTR_EQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_ASSERTION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_PTR_NE(test, l, r) \
	KUNIT_ASSERT_PTR_NE_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_PTR_NE_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_ASSERTION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_STREQ(test, l, r) \
	KUNIT_ASSERT_STREQ_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_STREQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_STR(test, KUNIT_ASSERTION, l, ==, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_STRNEQ(test, l, r) \
	KUNIT_ASSERT_STRNEQ_MSG(test, l, r, "%s", "")
#define KUNIT_ASSERT_STRNEQ_MSG(test, l, r, fmt, ...) \
	KUNIT_USER_STR(test, KUNIT_ASSERTION, l, !=, r, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_TRUE(test, c) KUNIT_ASSERT_TRUE_MSG(test, c, "%s", "")
#define KUNIT_ASSERT_TRUE_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_ASSERTION, c, #c, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_FALSE(test, c) KUNIT_ASSERT_FALSE_MSG(test, c, "%s", "")
#define KUNIT_ASSERT_FALSE_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_ASSERTION, !(c), "!(" #c ")", fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_NULL(test, c) KUNIT_ASSERT_NULL_MSG(test, c, "%s", "")
#define KUNIT_ASSERT_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_ASSERTION, c, ==, NULL, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_NOT_NULL(test, c) \
	KUNIT_ASSERT_NOT_NULL_MSG(test, c, "%s", "")
#define KUNIT_ASSERT_NOT_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_PTR(test, KUNIT_ASSERTION, c, !=, NULL, fmt, ##__VA_ARGS__)
#define KUNIT_ASSERT_NOT_ERR_OR_NULL(test, c) \
	KUNIT_ASSERT_NOT_ERR_OR_NULL_MSG(test, c, "%s", "")
#define KUNIT_ASSERT_NOT_ERR_OR_NULL_MSG(test, c, fmt, ...) \
	KUNIT_USER_COND(test, KUNIT_ASSERTION, !IS_ERR_OR_NULL(c), "valid pointer: " #c, fmt, ##__VA_ARGS__)
#endif /* KUNIT_USER_H */
