// SPDX-License-Identifier: GPL-2.0-only
#include "escape.h"

#include <string.h>

#include "../lib/tools/text.h"
#include "../master/wire/env.h"

/* bytes that are no UTF-8 are taken as Latin-1, as in many EEPROMs; controls become '?' */
static void put(FILE *f, const char *s, const char *(*escape)(unsigned char c))
{
	const unsigned char *p = (const unsigned char *)s;

	while (*p) {
		int n = utf8_len(p, strnlen(s, 4));
		const char *instead = escape(*p);

		if (instead)
			fputs(instead, f);
		else if (!text_harmless(p, n))
			fputc('?', f);
		else if (n)
			fwrite(p, 1, (size_t)n, f);
		else
			fprintf(f, "%c%c", 0xc0 | *p >> 6, 0x80 | (*p & 0x3f));
		p += n ? n : 1;
		s = (const char *)p;
	}
}

static const char *html(unsigned char c)
{
	switch (c) {
	case '<':
		return "&lt;";
	case '>':
		return "&gt;";
	case '&':
		return "&amp;";
	case '"':
		return "&quot;";
	case '\'':
		return "&#39;";
	default:
		return NULL;
	}
}

/**
 * escape_html() - write text as content or as a quoted attribute of HTML
 * @f: file
 * @s: text
 */
void escape_html(FILE *f, const char *s)
{
	put(f, s, html);
}

static const char *label(unsigned char c)
{
	switch (c) {
	case '"':
		return "\\\"";
	case '\\':
		return "\\\\";
	case '\n':
		return "\\n";
	default:
		return NULL;
	}
}

/**
 * escape_label() - write text as the value of a label of OpenMetrics
 * @f: file
 * @s: text
 */
void escape_label(FILE *f, const char *s)
{
	put(f, s, label);
}
