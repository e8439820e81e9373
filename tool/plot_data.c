// SPDX-License-Identifier: GPL-2.0-only
#define _GNU_SOURCE	/* memmem() */
#include "plot_data.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/tools/text.h"
#include "tool.h"

#define SINCE	"time 0 is "

void plot_free(struct plot_data *p)
{
	for (size_t i = 0; i < p->n; i++)
		free(p->columns[i].v);
	free(p->columns);
	*p = (struct plot_data){ 0 };
}

const struct plot_column *plot_find(const struct plot_data *p, const char *name)
{
	for (size_t i = 0; i < p->n; i++)
		if (!strcmp(p->columns[i].name, name))
			return &p->columns[i];
	return NULL;
}

void plot_copy_text(char *to, const char *from, size_t len)
{
	size_t n = strnlen(from, min_t(size_t, len, PLOT_TEXT - 1));

	memcpy(to, from, n);
	to[n] = 0;
	text_clean(to, n);
}

int plot_add_column(const char *name, struct plot_data *p, const char *text, size_t len)
{
	struct plot_column *c;
	size_t end = len;

	if (p->n == PLOT_COLUMNS)
		return fail("%s has more than %u columns", name, PLOT_COLUMNS);
	c = realloc(p->columns, (p->n + 1) * sizeof(*c));
	if (!c)
		return fail("out of memory");
	p->columns = c;
	c = &p->columns[p->n++];
	*c = (struct plot_column){ 0 };
	if (len && text[len - 1] == ']') {
		while (end && text[end - 1] != '[')
			end--;
		if (end > 1 && text[end - 2] == ' ') {
			plot_copy_text(c->unit, text + end, len - end - 1);
			len = end - 2;
		}
	}
	plot_copy_text(c->name, text, len);
	return 0;
}

int plot_add_row(struct plot_data *p)
{
	size_t room = p->room ? 2 * p->room : 1024;

	if (p->rows < p->room) {
		p->rows++;
		return 0;
	}
	for (size_t i = 0; i < p->n; i++) {
		double *v = realloc(p->columns[i].v, room * sizeof(*v));

		if (!v)
			return fail("out of memory");
		p->columns[i].v = v;
	}
	p->room = room;
	p->rows++;
	return 0;
}

/* A line of CSV while it is taken apart */
struct csv {
	const char *name;
	size_t line;
	const char *at;
	const char *end;	/* of the line */
};

/* The next field without its quotes, in @to; false: the line has ended. */
static bool next_field(struct csv *c, bool first, char *to, size_t size)
{
	bool quoted;
	size_t n = 0;

	if (c->at == c->end || (!first && *c->at != ','))
		return false;
	c->at += !first;
	quoted = c->at < c->end && *c->at == '"';
	c->at += quoted;
	while (c->at < c->end && (quoted || *c->at != ',')) {
		if (quoted && *c->at == '"' && (c->at + 1 == c->end || c->at[1] != '"')) {
			c->at++;
			break;
		}
		c->at += quoted && *c->at == '"';
		if (n + 1 < size)
			to[n++] = *c->at;
		c->at++;
	}
	to[n] = 0;
	return true;
}

static int csv_header(struct csv *c, struct plot_data *p)
{
	char field[PLOT_TEXT];

	while (next_field(c, !p->n, field, sizeof(field)))
		if (plot_add_column(c->name, p, field, strlen(field)))
			return 1;
	return p->n ? 0 : fail("%s: line %zu has no names of columns", c->name, c->line);
}

static int csv_row(struct csv *c, struct plot_data *p)
{
	char field[PLOT_TEXT], *end;
	size_t i = 0;

	if (plot_add_row(p))
		return 1;
	while (next_field(c, !i, field, sizeof(field))) {
		if (i == p->n)
			return fail("%s: line %zu has more columns than its header, %zu", c->name,
				    c->line, p->n);
		p->columns[i].v[p->rows - 1] = strtod(field, &end);
		if (end == field || *end) {
			text_clean(field, strlen(field));
			return fail("%s: line %zu, column %zu: '%.40s' is no number", c->name,
				    c->line, i + 1, field);
		}
		i++;
	}
	if (i != p->n)
		return fail("%s: line %zu has %zu column(s), its header %zu", c->name, c->line, i,
			    p->n);
	return 0;
}

static void csv_comment(const struct csv *c, struct plot_data *p)
{
	const char *at = memmem(c->at, (size_t)(c->end - c->at), SINCE, strlen(SINCE));
	const char *end;

	if (!at || p->since[0])
		return;
	at += strlen(SINCE);
	end = memchr(at, ',', (size_t)(c->end - at));
	plot_copy_text(p->since, at, (size_t)((end ? end : c->end) - at));
}

static int read_csv(const char *name, const char *data, size_t size, struct plot_data *p)
{
	struct csv c = { .name = name };
	const char *end = data + size;
	int ret = 0;

	/* UTF-8 of other programs may begin with a byte order mark */
	if (size >= 3 && !memcmp(data, "\xef\xbb\xbf", 3))
		data += 3;
	for (const char *at = data, *next; at < end && !ret; at = next) {
		const char *stop = memchr(at, '\n', (size_t)(end - at));

		next = stop ? stop + 1 : end;
		c.line++;
		c.at = at;
		c.end = stop ? stop : end;
		if (c.end > at && c.end[-1] == '\r')
			c.end--;
		if (c.end == at)
			continue;
		if (*at == '#')
			csv_comment(&c, p);
		else
			ret = p->n ? csv_row(&c, p) : csv_header(&c, p);
	}
	if (!ret && !p->n)
		return fail("%s is empty", name);
	return ret;
}

static void find_flags(struct plot_data *p)
{
	for (size_t i = 0; i < p->n; i++) {
		struct plot_column *c = &p->columns[i];

		c->flag = true;
		for (size_t k = 0; k < p->rows && c->flag; k++)
			c->flag = c->v[k] == 0 || c->v[k] == 1;
	}
}

int plot_read_memory(const char *name, const char *data, size_t size, struct plot_data *p)
{
	bool npy = size >= 6 && !memcmp(data, "\x93NUMPY", 6);
	int ret;

	*p = (struct plot_data){ 0 };
	ret = npy ? plot_npy(name, data, size, p) : read_csv(name, data, size, p);
	if (!ret)
		find_flags(p);
	return ret;
}

static char *whole_file(FILE *f, size_t *size, int *err)
{
	size_t room = 1 << 16, n;
	char *data = malloc(room), *more;

	*size = 0;
	*err = 0;
	while (data && (n = fread(data + *size, 1, room - *size, f)) > 0) {
		*size += n;
		if (*size < room)
			continue;
		*err = room >= PLOT_FILE_MAX ? EFBIG : 0;
		more = *err ? NULL : realloc(data, room * 2);
		room *= 2;
		if (!more) {
			free(data);
			return NULL;
		}
		data = more;
	}
	if (data && ferror(f)) {
		*err = errno;
		free(data);
		return NULL;
	}
	return data;
}

int plot_read(const char *path, struct plot_data *p)
{
	FILE *f = strcmp(path, "-") ? fopen(path, "rb") : stdin;
	char *data = NULL;
	int ret, err;
	size_t size;

	*p = (struct plot_data){ 0 };
	if (!f)
		return fail("cannot read '%s': %s", path, strerror(errno));
	data = whole_file(f, &size, &err);
	if (f != stdin)
		fclose(f);
	if (!data)
		return fail("cannot read '%s': %s", path, strerror(err ? err : ENOMEM));
	ret = plot_read_memory(path, data, size, p);
	free(data);
	return ret;
}
