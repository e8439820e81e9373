// SPDX-License-Identifier: GPL-2.0-only
#include "out.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>

#include "../lib/tools/text.h"
#include "tool.h"

#define DEPTH 16

static bool json;
static bool lines;
static char closing[DEPTH];	/* of the open containers */
static unsigned int depth;
static bool first;		/* in the innermost container */

void out_start(bool as_json)
{
	json = as_json;
	lines = false;
	depth = 0;
	first = true;
	if (json)
		out_object(NULL);
}

void out_start_lines(bool as_json)
{
	json = as_json;
	lines = true;
	depth = 0;
}

/* close what is open; Return: 0, or -errno when stdout did not take it all */
int out_finish(void)
{
	while (depth)
		out_end();
	if (fflush(stdout) || ferror(stdout))
		return errno ? -errno : -EIO;
	return 0;
}

bool out_is_json(void)
{
	return json;
}

/* SII strings are often Latin-1: bytes that are no UTF-8 are taken as that */
void out_json_string(FILE *f, const char *s)
{
	const unsigned char *p = (const unsigned char *)s;

	fputc('"', f);
	while (*p) {
		int n = utf8_len(p, strnlen((const char *)p, 4));

		if (*p == '"' || *p == '\\')
			fprintf(f, "\\%c", *p);
		else if (n < 2 && (!n || !text_harmless(p, n)))
			fprintf(f, "\\u%04x", *p);
		else if (text_harmless(p, n))
			fwrite(p, 1, (size_t)n, f);
		else if (n == 2)
			fprintf(f, "\\u%04x", (p[0] & 0x1f) << 6 | (p[1] & 0x3f));
		else
			fprintf(f, "\\u%04x", (p[0] & 0xf) << 12 | (p[1] & 0x3f) << 6 |
				(p[2] & 0x3f));
		p += n ? n : 1;
	}
	fputc('"', f);
}

/* comma, line, indent and key of the next value; false: nothing to print */
static bool lead(const char *key)
{
	bool member = depth && closing[depth - 1] == '}';

	if (!json || (member && !key))
		return false;
	if (depth && lines) {
		fputs(first ? "" : ", ", stdout);
	} else if (depth) {
		fputs(first ? "\n" : ",\n", stdout);
		printf("%*s", (int)(2 * depth), "");
	}
	if (member) {
		out_json_string(stdout, key);
		fputs(": ", stdout);
	}
	first = false;
	return true;
}

static void open_container(const char *key, char o, char c)
{
	if (!json || depth == DEPTH || (depth && !lead(key)))
		return;
	putchar(o);
	closing[depth++] = c;
	first = true;
}

void out_object(const char *key)
{
	open_container(key, '{', '}');
}

void out_array(const char *key)
{
	open_container(key, '[', ']');
}

void out_end(void)
{
	if (!json || !depth)
		return;
	depth--;
	if (!first && !lines)
		printf("\n%*s", (int)(2 * depth), "");
	putchar(closing[depth]);
	first = false;
	if (!depth)
		putchar('\n');
}

#define TEXT(fmt)				\
	do {					\
		va_list ap;			\
						\
		if (!json && (fmt)) {		\
			va_start(ap, fmt);	\
			vprintf(fmt, ap);	\
			va_end(ap);		\
		}				\
	} while (0)

void out_text(const char *fmt, ...)
{
	TEXT(fmt);
}

void out_u(const char *key, u64 v, const char *fmt, ...)
{
	TEXT(fmt);
	if (key && lead(key))
		printf("%llu", (unsigned long long)v);
}

void out_i(const char *key, s64 v, const char *fmt, ...)
{
	TEXT(fmt);
	if (key && lead(key))
		printf("%lld", (long long)v);
}

void out_f(const char *key, double v, const char *fmt, ...)
{
	TEXT(fmt);
	if (!key || !lead(key))
		return;
	if (isfinite(v))
		printf("%.17g", v);
	else
		fputs("null", stdout);
}

void out_bool(const char *key, bool v, const char *fmt, ...)
{
	TEXT(fmt);
	if (key && lead(key))
		fputs(v ? "true" : "false", stdout);
}

void out_str(const char *key, const char *v, const char *fmt, ...)
{
	TEXT(fmt);
	if (key && lead(key))
		out_json_string(stdout, v);
}

void out_null(const char *key, const char *fmt, ...)
{
	TEXT(fmt);
	if (key && lead(key))
		fputs("null", stdout);
}

void out_hex(const char *key, const u8 *data, size_t size, const char *indent)
{
	for (size_t i = 0; !json && i < size; i++)
		printf("%s%02x %s", i % 16 ? "" : indent, data[i],
		       i % 16 == 15 || i + 1 == size ? "\n" : "");
	if (!key || !lead(key))
		return;
	putchar('"');
	for (size_t i = 0; i < size; i++)
		printf("%02x", data[i]);
	putchar('"');
}

/* text inside double quotes, for Graphviz */
void out_quoted(const char *s)
{
	for (; *s; s++)
		out_text(*s == '"' || *s == '\\' ? "\\%c" : "%c", *s);
}

/* may the character at @at go to a terminal? @step: its bytes */
static bool is_shown(const u8 *at, size_t size, size_t *step)
{
	int n = utf8_len(at, size);

	*step = n ? (size_t)n : 1;
	return *at == '\n' || *at == '\t' || text_harmless(at, n);
}

void out_text_bytes(const u8 *data, size_t size)
{
	size_t step;

	if (json)
		return;
	if (!isatty(STDOUT_FILENO)) {
		fwrite(data, 1, size, stdout);
		return;
	}
	for (size_t i = 0; i < size; i += step) {
		if (!is_shown(data + i, size - i, &step))
			fputs(data[i] ? "?" : "", stdout);
		else if (step == 1 && data[i] >= 0x80)	/* Latin-1 */
			printf("%c%c", 0xc0 | data[i] >> 6, 0x80 | (data[i] & 0x3f));
		else
			fwrite(data + i, 1, step, stdout);
	}
}

/* Return: whether a terminal can show the bytes as characters of one line */
bool out_is_line(const u8 *data, size_t size)
{
	for (size_t i = 0; i < size;) {
		int n = utf8_len(data + i, size - i);

		if (!n || !text_harmless(data + i, n))
			return false;
		i += (size_t)n;
	}
	return true;
}

/* little-endian UTF-16 as UTF-8; half of a pair, and what a terminal must not get, as '?' */
void out_utf16(const u8 *data, size_t size)
{
	for (size_t i = 0; i + 1 < size; i += 2) {
		u32 c = data[i] | (u32)data[i + 1] << 8;
		u8 utf8[4];
		size_t n = 0;

		if ((c & 0xfc00) == 0xd800 && i + 3 < size && (data[i + 3] & 0xfc) == 0xdc) {
			i += 2;
			c = 0x10000 + ((c & 0x3ff) << 10 | (data[i + 1] & 3u) << 8 | data[i]);
		}
		if (!c)
			continue;
		if ((c & 0xf800) == 0xd800 && c < 0x10000)
			c = '?';
		if (c >= 0x10000)
			utf8[n++] = (u8)(0xf0 | c >> 18);
		if (c >= 0x800)
			utf8[n++] = (u8)(c < 0x10000 ? 0xe0 | c >> 12 : 0x80 | (c >> 12 & 0x3f));
		if (c >= 0x80)
			utf8[n++] = (u8)(c < 0x800 ? 0xc0 | c >> 6 : 0x80 | (c >> 6 & 0x3f));
		utf8[n++] = (u8)(c < 0x80 ? c : 0x80 | (c & 0x3f));
		out_text_bytes(utf8, n);
	}
}

bool out_to_terminal(void)
{
	return !json && isatty(STDOUT_FILENO);
}

/* Return: 0, or 1 after printing why binary data are not written */
int out_binary_allowed(const char *instead)
{
	if (json || !isatty(STDOUT_FILENO))
		return 0;
	return fail("binary data are not written to a terminal; %s", instead);
}

void out_binary(const char *key, const u8 *data, size_t size)
{
	if (json)
		out_hex(key, data, size, "");
	else
		fwrite(data, 1, size, stdout);
}
