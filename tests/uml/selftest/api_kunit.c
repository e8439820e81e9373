// SPDX-License-Identifier: GPL-2.0-only
/*
 * Every KUnit word our tests may use, so that the kernel's KUnit and the
 * userspace replacement can be seen to agree.  Also built in userspace.
 */
#include "ec_kunit.h"

static int inits, exits;

static void api_compare(struct kunit *test)
{
	static const char text[] = "abc";
	unsigned char a[20] = { 1, 2, 3 }, b[20] = { 1, 2, 3 };
	int x = 3, y = 4;
	u64 big = ~0ULL;
	void *p = &x;

	KUNIT_SUCCEED(test);
	KUNIT_EXPECT_EQ(test, x, 3);
	KUNIT_EXPECT_EQ(test, big, ~0ULL);
	KUNIT_EXPECT_EQ_MSG(test, x, 3, "x is %d", x);
	KUNIT_EXPECT_NE(test, x, y);
	KUNIT_EXPECT_LT(test, x, y);
	KUNIT_EXPECT_LE(test, x, 3);
	KUNIT_EXPECT_GT(test, y, x);
	KUNIT_EXPECT_GE(test, y, 4);
	KUNIT_EXPECT_TRUE(test, x == 3);
	KUNIT_EXPECT_FALSE(test, x == y);
	KUNIT_EXPECT_TRUE_MSG(test, x == 3, "x is %d", x);
	KUNIT_EXPECT_NULL(test, NULL);
	KUNIT_EXPECT_NOT_NULL(test, p);
	KUNIT_EXPECT_PTR_EQ(test, p, (void *)&x);
	KUNIT_EXPECT_PTR_NE(test, p, (void *)&y);
	KUNIT_EXPECT_STREQ(test, text, "abc");
	KUNIT_EXPECT_STRNEQ(test, text, "abd");
	KUNIT_EXPECT_MEMEQ(test, a, b, sizeof(a));
	KUNIT_EXPECT_MEMEQ_MSG(test, a, b, sizeof(a), "x is %d", x);
	b[19] = 1;
	KUNIT_EXPECT_MEMNEQ(test, a, b, sizeof(a));
	KUNIT_EXPECT_NOT_ERR_OR_NULL(test, p);
	KUNIT_ASSERT_EQ(test, x, 3);
	KUNIT_ASSERT_EQ_MSG(test, x, 3, "x is %d", x);
	KUNIT_ASSERT_NE(test, x, y);
	KUNIT_ASSERT_TRUE(test, x == 3);
	KUNIT_ASSERT_NOT_NULL(test, p);
	KUNIT_ASSERT_STREQ(test, text, "abc");
	KUNIT_ASSERT_MEMEQ(test, a, a, sizeof(a));
}

static void api_memory(struct kunit *test)
{
	unsigned char *p = kunit_kzalloc(test, 100, GFP_KERNEL);
	unsigned char *q = kunit_kmalloc(test, 100, GFP_KERNEL);
	u32 *r = kunit_kcalloc(test, 10, sizeof(*r), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, p);
	KUNIT_ASSERT_NOT_NULL(test, q);
	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, p[99], 0);
	KUNIT_EXPECT_EQ(test, r[9], 0u);
	q[99] = 1;
	kunit_kfree(test, q);
}

static void api_skip(struct kunit *test)
{
	kunit_info(test, "a skipped case is no failure, %d", 1);
	kunit_skip(test, "on purpose (%s)", "selftest");
	KUNIT_FAIL(test, "ran on after kunit_skip");
}

static const struct api_param {
	int in, out;
} api_params[] = { { 1, 2 }, { 2, 4 }, { 3, 6 } };

static void api_param_desc(const struct api_param *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "twice %d", p->in);
}
KUNIT_ARRAY_PARAM(api, api_params, api_param_desc);

static void api_param(struct kunit *test)
{
	const struct api_param *p = test->param_value;

	KUNIT_EXPECT_EQ(test, 2 * p->in, p->out);
}

static int api_init(struct kunit *test)
{
	inits++;
	test->priv = &inits;
	return 0;
}

static void api_exit(struct kunit *test)
{
	exits++;
}

/* Six runs are over (three of them parameters of one case), this one is not. */
static void api_init_exit(struct kunit *test)
{
	KUNIT_EXPECT_PTR_EQ(test, test->priv, (void *)&inits);
	KUNIT_EXPECT_EQ(test, inits, 7);
	KUNIT_EXPECT_EQ(test, exits, 6);
}

static struct kunit_case api_cases[] = {
	KUNIT_CASE(api_compare),
	KUNIT_CASE(api_memory),
	KUNIT_CASE(api_skip),
	KUNIT_CASE_PARAM(api_param, api_gen_params),
	KUNIT_CASE(api_init_exit),
	{}
};

static struct kunit_suite api_suite = {
	.name = "ec_kunit_api",
	.init = api_init,
	.exit = api_exit,
	.test_cases = api_cases,
};

kunit_test_suite(api_suite);

MODULE_LICENSE("GPL");
