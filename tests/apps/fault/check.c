// SPDX-License-Identifier: GPL-2.0-only
/*
 * ioctl_check GROUP: asks the character device for what it must refuse. Prints
 * each answer that is not the expected one; the exit status says whether there
 * was any. The segment "three" is expected on the bus.
 */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "fault.h"

static unsigned int asked, wrong;

static void complain(const char *fmt, va_list ap, const char *tail)
{
	wrong++;
	vprintf(fmt, ap);
	printf("%s\n", tail);
}

void expect(bool good, const char *fmt, ...)
{
	va_list ap;

	asked++;
	if (good)
		return;
	va_start(ap, fmt);
	complain(fmt, ap, "");
	va_end(ap);
}

void expect_errno(int got, int want, const char *fmt, ...)
{
	char tail[128];
	va_list ap;

	asked++;
	if (got == want)
		return;
	snprintf(tail, sizeof(tail), ": %s, expected %s", got ? strerrorname_np(got) : "success",
		 want ? strerrorname_np(want) : "success");
	va_start(ap, fmt);
	complain(fmt, ap, tail);
	va_end(ap);
}

static const struct {
	const char *name;
	void (*run)(void);
} groups[] = {
	{ "numbers", check_numbers },
	{ "sizes", check_sizes },
	{ "pointers", check_pointers },
	{ "unknown", check_unknown },
	{ "readonly", check_readonly },
	{ "version", check_version },
	{ "positions", check_positions },
	{ "addresses", check_addresses },
	{ "values", check_values },
	{ "states", check_states },
	{ "policy", check_policy },
	{ "ioctl_only", check_ioctl_only },
	{ "limits", check_limits },
	{ "mmap", check_mmap },
	{ "pages", check_pages },
	{ "flood", check_flood },
};

int main(int argc, char **argv)
{
	for (unsigned int i = 0; i < sizeof(groups) / sizeof(groups[0]); i++) {
		if (argc != 2 || strcmp(argv[1], groups[i].name))
			continue;
		groups[i].run();
		printf("%u asked, %u wrong\n", asked, wrong);
		return wrong || !asked;
	}
	fprintf(stderr, "usage: ioctl_check GROUP, one of:");
	for (unsigned int i = 0; i < sizeof(groups) / sizeof(groups[0]); i++)
		fprintf(stderr, " %s", groups[i].name);
	fprintf(stderr, "\n");
	return 2;
}
