/* SPDX-License-Identifier: GPL-2.0-only */
/* The parts of 'ethercat report': a page of HTML without scripts, and nothing outside of it. */
#ifndef EC_TOOL_REPORT_H
#define EC_TOOL_REPORT_H

#include <stdio.h>

#include "facts.h"

/**
 * struct report - what a part shows, and where
 * @f: page
 * @d: open file of the master
 * @facts: of this master
 * @why: result of ect_why()
 */
struct report {
	FILE *f;
	struct dev *d;
	struct facts facts;
	struct ect_why *why;
};

/* html.c: tags are literals, all that comes from elsewhere is escaped */
void html_begin(FILE *f);
void html_end(FILE *f);
void html_heading(FILE *f, const char *text);
void html_text(FILE *f, const char *tag, const char *class, const char *fmt, ...)
	__attribute__((format(printf, 4, 5)));
/* a table with these columns, apart by '|'; then rows of cells */
void html_table(FILE *f, const char *columns);
void html_row(FILE *f);
void html_cell(FILE *f, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
void html_table_end(FILE *f);
#define HTML_TIME	40
/* ns since 1970 as UTC; returns @buf of HTML_TIME bytes */
const char *html_time(u64 ns, char *buf);

/* each returns 0, or 1 after printing an error */
int report_bus(const struct report *r);
int report_state(const struct report *r);
int report_slaves(const struct report *r);
int report_cycle(const struct report *r);
int report_log(const struct report *r);

#endif
