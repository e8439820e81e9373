// SPDX-License-Identifier: GPL-2.0-only
/* One line on stderr, or one JSON object; nothing else ends up there as an error. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "../master/wire/coe.h"
#include "out.h"
#include "tool.h"

static const char *command = "";
static bool as_json;

/* what the following messages belong to */
void error_context(const char *cmd, bool json)
{
	command = cmd;
	as_json = json;
}

static const char *abort_text(u32 code)
{
	const char *text = ec_coe_abort_text(code);

	return text ? text : "unknown code";
}

static void print(const char *kind, int err, const char *reason, u32 abort, const char *fmt,
		  va_list ap)
{
	char text[1024];

	vsnprintf(text, sizeof(text), fmt, ap);
	fflush(stdout);
	if (as_json) {
		fputs("{\"error\": {\"command\": ", stderr);
		out_json_string(stderr, command);
		fprintf(stderr, ", \"kind\": \"%s\", \"message\": ", kind);
		out_json_string(stderr, text);
		if (err) {
			fprintf(stderr, ", \"errno\": %d, \"errno_text\": ", err);
			out_json_string(stderr, strerror(err));
		}
		if (reason && *reason) {
			fputs(", \"reason\": ", stderr);
			out_json_string(stderr, reason);
		}
		if (abort) {
			fprintf(stderr, ", \"abort_code\": %u, \"abort_text\": ", abort);
			out_json_string(stderr, abort_text(abort));
		}
		fputs("}}\n", stderr);
		return;
	}
	fprintf(stderr, "ethercat%s%s: %s", *command ? " " : "", command, text);
	if (abort)
		fprintf(stderr, " aborted with code 0x%08x: %s", abort, abort_text(abort));
	else if (err)
		fprintf(stderr, ": %s", strerror(err));
	if (reason && *reason)
		fprintf(stderr, ": %s", reason);
	fputc('\n', stderr);
	if (!strcmp(kind, "usage"))
		fprintf(stderr, "Try 'ethercat %s%s--help'.\n", command, *command ? " " : "");
}

/* wrong use; Return: the exit code */
int usage_error(const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	print("usage", 0, NULL, 0, fmt, ap);
	va_end(ap);
	return 1;
}

/* anything else; Return: the exit code */
int fail(const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	print("runtime", 0, NULL, 0, fmt, ap);
	va_end(ap);
	return 1;
}

int fail_full(int err, const char *reason, u32 abort, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	print("runtime", err, reason, abort, fmt, ap);
	va_end(ap);
	return 1;
}

/*
 * @cause replaces the text of @err; "": there is none, NULL: @fmt has it all. JSON has @err, and
 * @reason of the kernel.
 */
int fail_cause(int err, const char *reason, const char *cause, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	if (as_json)
		print("runtime", err, reason, 0, fmt, ap);
	else
		print("runtime", cause && !*cause ? err : 0, cause, 0, fmt, ap);
	va_end(ap);
	return 1;
}

/* a remark on stderr that is no error */
void note(const char *fmt, ...)
{
	va_list ap;
	char text[1024];

	va_start(ap, fmt);
	vsnprintf(text, sizeof(text), fmt, ap);
	va_end(ap);
	fflush(stdout);
	if (as_json) {
		fputs("{\"note\": ", stderr);
		out_json_string(stderr, text);
		fputs("}\n", stderr);
	} else {
		fprintf(stderr, "%s\n", text);
	}
}
