// SPDX-License-Identifier: GPL-2.0-only
/*
 * Runs KUnit suites in userspace.
 *
 *   prog [--list] [GLOB]     GLOB: suite or suite.case, as kunit.filter_glob
 *
 * Prints KTAP.  Exit code 0: all passed, 1: failures, 2: no test ran.
 */
#define _GNU_SOURCE
#include "kunit_user.h"

#include <fnmatch.h>
#include <stdarg.h>

struct kunit_user_mem {
	struct kunit_user_mem *next;
	void *ptr;
};

static struct kunit_suite *first, **last = &first;
static unsigned int passed, failed, skipped;

void kunit_user_register(struct kunit_suite **suites, size_t n)
{
	for (size_t i = 0; i < n; i++) {
		*last = suites[i];
		last = &suites[i]->next;
	}
}

void kunit_user_log(struct kunit *test, const char *fmt, ...)
{
	va_list ap;

	printf("    # %s: ", test->name);
	va_start(ap, fmt);
	vprintf(fmt, ap);
	va_end(ap);
	putchar('\n');
}

void kunit_user_comment(struct kunit *test, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(test->status_comment, sizeof(test->status_comment), fmt, ap);
	va_end(ap);
}

_Noreturn void kunit_user_leave(struct kunit *test)
{
	longjmp(test->out, 1);
}

void kunit_user_failed(struct kunit *test, enum kunit_assert_type type,
		       const char *file, int line, const char *expected)
{
	test->status = KUNIT_FAILURE;
	kunit_user_log(test, "%s FAILED at %s:%d",
		       type == KUNIT_ASSERTION ? "ASSERTION" : "EXPECTATION",
		       file, line);
	if (expected)
		printf("    Expected %s\n", expected);
}

void kunit_user_values(const char *ltext, long long l,
		       const char *rtext, long long r)
{
	printf("        %s == %lld (0x%llx)\n        %s == %lld (0x%llx)\n",
	       ltext, l, (unsigned long long)l,
	       rtext, r, (unsigned long long)r);
}

void kunit_user_finish(struct kunit *test, enum kunit_assert_type type,
		       const char *fmt, ...)
{
	char text[1024];
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(text, sizeof(text), fmt, ap);
	va_end(ap);
	if (text[0])
		printf("    %s\n", text);
	if (type == KUNIT_ASSERTION)
		kunit_user_leave(test);
}

/* One malloc each, so that ASan sees every overrun. */
void *kunit_user_alloc(struct kunit *test, size_t n, size_t size, bool zero)
{
	struct kunit_user_mem *m = malloc(sizeof(*m));
	size_t bytes;

	if (!m || __builtin_mul_overflow(n, size, &bytes)) {
		free(m);
		return NULL;
	}
	m->ptr = malloc(bytes);
	if (!m->ptr) {
		free(m);
		return NULL;
	}
	/* Not zeroed must not look zeroed. */
	memset(m->ptr, zero ? 0 : 0xa5, bytes);
	m->next = test->mem;
	test->mem = m;
	return m->ptr;
}

void kunit_kfree(struct kunit *test, const void *ptr)
{
	for (struct kunit_user_mem **p = &test->mem; *p; p = &(*p)->next) {
		struct kunit_user_mem *m = *p;

		if (m->ptr != ptr)
			continue;
		*p = m->next;
		free(m->ptr);
		free(m);
		return;
	}
}

/* Runs one case with one parameter between init and exit of the suite. */
static void run_one(struct kunit_suite *suite, struct kunit_case *c,
		    struct kunit *test)
{
	int ret;

	test->status = KUNIT_SUCCESS;
	test->status_comment[0] = '\0';
	test->priv = NULL;
	test->name = c->name;
	fflush(stdout);

	if (!setjmp(test->out)) {
		ret = suite->init ? suite->init(test) : 0;
		if (ret) {
			kunit_user_log(test, "failed to initialize: %d", ret);
			test->status = KUNIT_FAILURE;
		} else {
			c->run_case(test);
		}
	}
	/* As the kernel does: exit runs even where init or the case failed. */
	if (suite->exit && !setjmp(test->out))
		suite->exit(test);
	while (test->mem)
		kunit_kfree(test, test->mem->ptr);
}

static const char *ok(enum kunit_status s)
{
	return s == KUNIT_FAILURE ? "not ok" : "ok";
}

static void print_result(const char *indent, struct kunit *test,
			 unsigned int n, const char *name)
{
	bool skip = test->status == KUNIT_SKIPPED;

	printf("%s%s %u %s%s%s\n", indent, ok(test->status), n, name,
	       skip ? " # SKIP " : "", skip ? test->status_comment : "");
}

static enum kunit_status run_case(struct kunit_suite *suite,
				  struct kunit_case *c, unsigned int n)
{
	struct kunit test = { .name = c->name };
	enum kunit_status all = KUNIT_SKIPPED;
	char desc[KUNIT_PARAM_DESC_SIZE] = "";

	if (!c->generate_params) {
		run_one(suite, c, &test);
		all = test.status;
	} else {
		printf("        # Subtest: %s\n", c->name);
		while ((test.param_value =
			c->generate_params(test.param_value, desc))) {
			if (!desc[0])
				snprintf(desc, sizeof(desc), "param-%d",
					 test.param_index);
			run_one(suite, c, &test);
			test.param_index++;
			print_result("        ", &test, test.param_index, desc);
			if (test.status == KUNIT_FAILURE)
				all = KUNIT_FAILURE;
			else if (all == KUNIT_SKIPPED)
				all = test.status;
			desc[0] = '\0';
		}
	}

	test.status = all;
	print_result("    ", &test, n, c->name);
	if (all == KUNIT_FAILURE)
		failed++;
	else if (all == KUNIT_SKIPPED)
		skipped++;
	else
		passed++;
	return all;
}

static bool wanted(const char *glob, struct kunit_suite *suite,
		   struct kunit_case *c)
{
	const char *dot = glob ? strchr(glob, '.') : NULL;
	char *part;
	bool match;

	if (!glob)
		return true;
	part = strndup(glob, dot ? (size_t)(dot - glob) : strlen(glob));
	match = part && !fnmatch(part, suite->name, 0);
	free(part);
	return match && (!dot || !fnmatch(dot + 1, c->name, 0));
}

static unsigned int count(const char *glob, struct kunit_suite *suite)
{
	unsigned int n = 0;

	for (struct kunit_case *c = suite->test_cases; c->run_case; c++)
		n += wanted(glob, suite, c);
	return n;
}

static void run_suite(struct kunit_suite *suite, const char *glob,
		      unsigned int index)
{
	enum kunit_status all = KUNIT_SUCCESS;
	unsigned int n = 0;
	int ret;

	printf("    # Subtest: %s\n    1..%u\n", suite->name,
	       count(glob, suite));
	ret = suite->suite_init ? suite->suite_init(suite) : 0;
	if (ret) {
		printf("    # %s: suite_init failed: %d\n", suite->name, ret);
		all = KUNIT_FAILURE;
		failed++;
	}
	for (struct kunit_case *c = suite->test_cases; !ret && c->run_case; c++)
		if (wanted(glob, suite, c) &&
		    run_case(suite, c, ++n) == KUNIT_FAILURE)
			all = KUNIT_FAILURE;
	if (suite->suite_exit)
		suite->suite_exit(suite);
	printf("%s %u %s\n", ok(all), index, suite->name);
}

int main(int argc, char **argv)
{
	bool list = argc > 1 && !strcmp(argv[1], "--list");
	const char *glob = argc > 1 + list ? argv[1 + list] : NULL;
	unsigned int n = 0;

	if (argc > 2 + list || (glob && glob[0] == '-')) {
		fprintf(stderr, "usage: %s [--list] [SUITE_GLOB[.CASE_GLOB]]\n",
			argv[0]);
		return 2;
	}
	for (struct kunit_suite *s = first; s; s = s->next)
		n += count(glob, s) != 0;
	printf("KTAP version 1\n");
	if (!list)
		printf("1..%u\n", n);
	n = 0;
	for (struct kunit_suite *s = first; s; s = s->next) {
		if (!count(glob, s))
			continue;
		if (!list)
			run_suite(s, glob, ++n);
		for (struct kunit_case *c = s->test_cases;
		     list && c->run_case; c++)
			if (wanted(glob, s, c))
				printf("%s.%s\n", s->name, c->name);
	}
	if (list)
		return 0;
	printf("# Totals: pass:%u fail:%u skip:%u total:%u\n",
	       passed, failed, skipped, passed + failed + skipped);
	if (!(passed + failed + skipped)) {
		fprintf(stderr, "no test ran\n");
		return 2;
	}
	return failed ? 1 : 0;
}
