// SPDX-License-Identifier: GPL-2.0-only
#include <stdarg.h>
#include <string.h>
#include <time.h>

#include "escape.h"
#include "report.h"

#define TEXT_MAX	4096

/* The policy lets a browser load nothing, should a mistake put a tag into the page. */
static const char head[] =
	"<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
	"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
	"<meta name=\"viewport\" content=\"width=device-width\">\n"
	"<title>EtherCAT report</title>\n<style>\n"
	"body { font: 14px/1.4 sans-serif; margin: 1em auto; max-width: 70em; padding: 0 1em; color: #222; background: #fff; }\n"
	"h2 { border-bottom: 1px solid #aaa; margin-top: 1.5em; }\n"
	"table { border-collapse: collapse; }\n"
	"th, td { border: 1px solid #ccc; padding: 2px 6px; text-align: left; vertical-align: top; overflow-wrap: anywhere; }\n"
	"th { background: #eee; }\n"
	".fault { color: #a00; } .warning { color: #850; } .note { color: #666; }\n"
	"svg { max-width: 100%; height: auto; } svg text { font: 13px sans-serif; fill: #222; }\n"
	"svg .box { stroke: #555; fill: #ddd; } svg .op { fill: #bfe5bf; } svg .safeop { fill: #f3e3a0; }\n"
	"svg .preop { fill: #c4d8f2; } svg .error { fill: #f2b8b8; } svg .line { stroke: #555; fill: none; }\n"
	"svg .bad { fill: #a00; } svg .bar { fill: #5b84b1; }\n"
	"</style>\n</head>\n<body>\n";

const char *html_time(u64 ns, char *buf)
{
	const time_t s = (time_t)(ns / 1000000000);
	struct tm tm;
	size_t n = 0;

	if (gmtime_r(&s, &tm))
		n = strftime(buf, HTML_TIME, "%Y-%m-%d %H:%M:%S", &tm);
	snprintf(buf + n, HTML_TIME - n, n ? ".%06u" : "?", (unsigned int)(ns / 1000 % 1000000));
	return buf;
}

void html_begin(FILE *f)
{
	fputs(head, f);
}

void html_end(FILE *f)
{
	fputs("</body>\n</html>\n", f);
}

static void put_text(FILE *f, const char *fmt, va_list ap)
{
	char text[TEXT_MAX];

	vsnprintf(text, sizeof(text), fmt, ap);
	escape_html(f, text);
}

void html_heading(FILE *f, const char *text)
{
	html_text(f, "h2", NULL, "%s", text);
}

void html_text(FILE *f, const char *tag, const char *class, const char *fmt, ...)
{
	va_list ap;

	if (class)
		fprintf(f, "<%s class=\"%s\">", tag, class);
	else
		fprintf(f, "<%s>", tag);
	va_start(ap, fmt);
	put_text(f, fmt, ap);
	va_end(ap);
	fprintf(f, "</%s>\n", tag);
}

void html_table(FILE *f, const char *columns)
{
	fputs("<table>\n<tr>", f);
	while (*columns) {
		size_t n = strcspn(columns, "|");

		fprintf(f, "<th>%.*s</th>", (int)n, columns);
		columns += n + (columns[n] == '|');
	}
}

void html_row(FILE *f)
{
	fputs("</tr>\n<tr>", f);
}

void html_cell(FILE *f, const char *fmt, ...)
{
	va_list ap;

	fputs("<td>", f);
	va_start(ap, fmt);
	put_text(f, fmt, ap);
	va_end(ap);
	fputs("</td>", f);
}

void html_table_end(FILE *f)
{
	fputs("</tr>\n</table>\n", f);
}
