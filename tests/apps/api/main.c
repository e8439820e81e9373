// SPDX-License-Identifier: GPL-2.0-only
/*
 * api GROUP...: runs groups of cases, one line each, TAP. With API_CALLED=FILE
 * the names of the functions that were called are added to that file.
 */
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "api.h"

static const struct api_group groups[] = {
	{ "open", open_cases }, { "info", info_cases }, { "config", config_cases },
	{ "pdo", pdo_cases }, { "cycle", cycle_cases }, { "after", after_cases },
	{ "dc", dc_cases }, { "request", request_cases }, { "kcycle", kcycle_cases },
	{ "null", null_cases }, { "access", access_cases },
	{ "layout", layout_cases },
	{ "extension", extension_cases },
	{ "foe", foe_cases },
	{ "dict", dict_cases },
	{ "lcec", lcec_cases }, { "ros2", ros2_cases }, { "beside", beside_cases },
	{ "soe", soe_cases },
	{ "syscalls", syscall_cases },
};

static FILE *called;
static unsigned int failures;	/* of the case that runs */
static int err_fd = -1;		/* stderr goes here */
static off_t err_seen;

struct api_counts api_counts(void)
{
	return (struct api_counts){ .failures = failures };
}

void api_called(const char *name)
{
	if (called)
		fprintf(called, "%s\n", name);
}

bool api_yes(bool ok, const char *file, int line, const char *what)
{
	if (!ok) {
		printf("# %s:%d: not so: %s\n", file, line, what);
		failures++;
	}
	return ok;
}

bool api_is(long long have, long long want, const char *file, int line, const char *a,
	    const char *b)
{
	if (have != want) {
		printf("# %s:%d: %s is %lld (0x%llx), not %s (%lld)\n", file, line, a, have,
		       (unsigned long long)have, b, want);
		failures++;
	}
	return have == want;
}

/* Lines on stderr since the last call. */
unsigned int api_lines(void)
{
	unsigned int lines = 0;
	char buf[512];
	ssize_t n;

	while ((n = pread(err_fd, buf, sizeof(buf), err_seen)) > 0) {
		err_seen += n;
		for (ssize_t i = 0; i < n; i++)
			lines += buf[i] == '\n';
	}
	return lines;
}

void api_printed(unsigned int want, const char *file, int line, const char *what)
{
	unsigned int lines = api_lines();

	if (lines == want)
		return;
	printf("# %s:%d: %s prints %u line(s), not %u\n", file, line, what, lines, want);
	failures++;
}

static unsigned int run_group(const struct api_group *g)
{
	unsigned int failed = 0;

	for (const struct api_case *c = g->cases; c->name; c++) {
		failures = 0;
		c->run();
		printf("%s - %s: %s\n", failures ? "not ok" : "ok", g->name, c->name);
		fflush(stdout);
		failed += failures != 0;
	}
	return failed;
}

int main(int argc, char **argv)
{
	const char *file = getenv("API_CALLED");
	unsigned int failed = 0, n = 0;

	called = file ? fopen(file, "a") : NULL;
	if (called)	/* whole lines, also of a process that is killed */
		setvbuf(called, NULL, _IOLBF, 0);
	err_fd = memfd_create("stderr", 0);
	if (err_fd < 0 || dup2(err_fd, STDERR_FILENO) < 0) {
		perror("stderr to a file");
		return 2;
	}
	for (int i = 1; i < argc; i++)
		for (size_t k = 0; k < sizeof(groups) / sizeof(groups[0]); k++)
			if (!strcmp(argv[i], groups[k].name)) {
				failed += run_group(&groups[k]);
				n++;
			}
	if (called)
		fclose(called);
	if (!n || n != (unsigned int)argc - 1) {
		printf("no such group\n");
		return 2;
	}
	return failed ? 1 : 0;
}
