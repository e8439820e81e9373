// SPDX-License-Identifier: GPL-2.0-only
#include "record_npy.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "value.h"

#define MAGIC	"\x93NUMPY"
#define PREFIX	12	/* magic, version, bytes of the text */
#define ALIGN	64	/* where the rows begin */

static const struct {
	const char *name;
	const char *type;
} fixed[RECORD_FIXED] = {
	{ "time_s", "<f8" }, { "app_time_ns", "<u8" }, { "cycle", "<u8" }, { "lost", "<u8" },
	{ "wc", "|u1" },
};

/* bytes of a value in the array: those of a type that has its bits */
static unsigned int width(const struct record_column *c)
{
	unsigned int bytes = 1;

	while (8 * bytes < c->bits)
		bytes *= 2;
	return bytes;
}

size_t record_npy_row(const struct record_file *f)
{
	size_t size = 8 * 4 + 1;

	for (size_t i = 0; i < f->n; i++)
		size += width(&f->columns[i]);
	return size;
}

/* The unit is a text of the user; plot_npy.c and old readers know no escapes. */
static void print_text(FILE *to, const char *s)
{
	for (; *s; s++)
		fputc(strchr("'\\", *s) ? '?' : *s, to);
}

static void print_column(FILE *to, const struct record_column *c)
{
	char letter = c->kind == EC_KIND_FLOAT ? 'f' : c->kind == EC_KIND_INT ? 'i' : 'u';

	if (c->kind == EC_KIND_BOOL || c->bits == 1)
		letter = 'b';
	fputs(*c->unit ? "(('" : "('", to);
	/* names have letters, digits, '_' and '.' */
	if (*c->unit) {
		fprintf(to, "%s [", c->name);
		print_text(to, c->unit);
		fputs("]', '", to);
	}
	fprintf(to, "%s%s, '%c%c%u'), ", c->name, *c->unit ? "')" : "'",
		width(c) == 1 ? '|' : '<', letter, width(c));
}

/* The title of the first column says when time is 0. NULL: out of memory. */
static char *header_text(const struct record_file *f, u64 rows, size_t *size)
{
	char wall[48], *text = NULL;
	FILE *to = open_memstream(&text, size);

	if (!to)
		return NULL;
	record_wall_text(f->wall_ns, wall, sizeof(wall));
	fputs("{'descr': [", to);
	for (unsigned int i = 0; i < RECORD_FIXED; i++) {
		if (!i)
			fprintf(to, "(('seconds since %s', '%s'), '%s'), ", wall, fixed[i].name,
				fixed[i].type);
		else
			fprintf(to, "('%s', '%s'), ", fixed[i].name, fixed[i].type);
	}
	for (size_t i = 0; i < f->n; i++)
		print_column(to, &f->columns[i]);
	fprintf(to, "], 'fortran_order': False, 'shape': (%llu,), }", (unsigned long long)rows);
	if (fclose(to)) {
		free(text);
		return NULL;
	}
	return text;
}

/* Version 3.0 has UTF-8; older readers know 2.0. */
static char version(const struct record_file *f)
{
	for (size_t i = 0; i < f->n; i++)
		for (const char *s = f->columns[i].unit; *s; s++)
			if ((unsigned char)*s >= 0x80)
				return 3;
	return 2;
}

/* The header, padded for any number of rows; the first one decides how long it is. */
static char *header(struct record_file *f, u64 rows)
{
	size_t size, longest;
	char *text = header_text(f, ~0ULL, &longest), *all;

	free(text);
	text = text ? header_text(f, rows, &size) : NULL;
	longest = (PREFIX + longest + 1 + ALIGN - 1) / ALIGN * ALIGN;
	all = text ? malloc(longest) : NULL;
	if (!all) {
		f->err = ENOMEM;
		free(text);
		return NULL;
	}
	memset(all, ' ', longest);
	memcpy(all, MAGIC "\2\0", 8);
	all[6] = version(f);
	for (unsigned int i = 0; i < 4; i++)
		all[8 + i] = (char)((longest - PREFIX) >> 8 * i);
	memcpy(all + PREFIX, text, size);
	all[longest - 1] = '\n';
	free(text);
	f->head = longest;
	return all;
}

static void put_header(struct record_file *f, u64 rows)
{
	char *text = header(f, rows);
	ssize_t n = text ? pwrite(f->fd, text, f->head, 0) : 0;

	if (text && n != (ssize_t)f->head && !f->err)
		f->err = n < 0 ? errno : ENOSPC;
	free(text);
}

void record_npy_begin(struct record_file *f)
{
	put_header(f, 0);
	if (!f->err && lseek(f->fd, (off_t)f->head, SEEK_SET) < 0)
		f->err = errno;
}

void record_npy_count(struct record_file *f)
{
	put_header(f, f->written / record_npy_row(f));
}

static void put(struct record_file *f, u64 v, unsigned int bytes)
{
	for (unsigned int i = 0; i < bytes; i++)
		f->buf[f->used++] = (char)(v >> 8 * i);
}

void record_npy_add(struct record_file *f, const struct record_row *row)
{
	double t = (double)(row->time_ns - f->zero_ns) / 1e9;
	u64 bits;

	memcpy(&bits, &t, sizeof(bits));
	put(f, bits, 8);
	put(f, row->app_time_ns, 8);
	put(f, row->cycle, 8);
	put(f, row->lost, 8);
	put(f, row->wc_state, 1);
	for (size_t i = 0; i < f->n; i++) {
		const struct record_column *c = &f->columns[i];

		bits = row->bits[i];
		/* a number with a sign fills the bytes of its type */
		if (c->kind == EC_KIND_INT && c->bits < 64 && bits >> (c->bits - 1) & 1)
			bits |= ~0ULL << c->bits;
		put(f, bits, width(c));
	}
}
