// SPDX-License-Identifier: GPL-2.0-only
/* Structured arrays of NumPy: what 'ethercat record' writes, and others with numbers only. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plot_data.h"
#include "tool.h"
#include "value.h"

#define SINCE	"seconds since "

/* how a column is in a row */
struct field {
	char kind;		/* b, u, i, f */
	unsigned int bytes;
	size_t at;
};

/**
 * struct npy - a file while it is read
 * @name: in messages
 * @at: in the text of the header
 * @end: of the text
 * @fields: of the columns
 * @row: bytes of a row
 */
struct npy {
	const char *name;
	const char *at;
	const char *end;
	struct field *fields;
	size_t row;
};

static int malformed(const struct npy *x)
{
	return fail("%s is no array that 'ethercat plot' reads: structures of numbers in one dimension",
		    x->name);
}

static void skip(struct npy *x)
{
	while (x->at < x->end && (*x->at == ' ' || *x->at == '\n'))
		x->at++;
}

static bool take(struct npy *x, char c)
{
	skip(x);
	if (x->at == x->end || *x->at != c)
		return false;
	x->at++;
	return true;
}

/* A string, of which escapes stay unchanged; false: there is none. */
static bool string(struct npy *x, const char **from, size_t *len)
{
	const char *stop;

	if (!take(x, '\''))
		return false;
	stop = memchr(x->at, '\'', (size_t)(x->end - x->at));
	if (!stop)
		return false;
	*from = x->at;
	*len = (size_t)(stop - x->at);
	x->at = stop + 1;
	return true;
}

static bool format(struct npy *x, struct field *f)
{
	const char *s;
	size_t len;

	if (!string(x, &s, &len) || len != 3 || !strchr("<|", s[0]) || !strchr("buif", s[1]))
		return false;
	f->kind = s[1];
	f->bytes = (unsigned int)(s[2] - '0');
	f->at = x->row;
	if (f->bytes != 1 && f->bytes != 2 && f->bytes != 4 && f->bytes != 8)
		return false;
	return f->kind == 'f' ? f->bytes >= 4 : f->kind != 'b' || f->bytes == 1;
}

/* ('name', '<u4') or (('title', 'name'), '<u4') */
static int column(struct npy *x, struct plot_data *p)
{
	const char *name, *title = NULL;
	size_t len, title_len = 0;
	struct field f, *all;
	bool pair;

	pair = take(x, '(');
	if (pair && (!string(x, &title, &title_len) || !take(x, ',')))
		return malformed(x);
	if (!string(x, &name, &len) || (pair && !take(x, ')')) || !take(x, ',') ||
	    !format(x, &f) || !take(x, ')'))
		return malformed(x);
	if (title && title_len > strlen(SINCE) && !memcmp(title, SINCE, strlen(SINCE)))
		plot_copy_text(p->since, title + strlen(SINCE), title_len - strlen(SINCE));
	else if (title)
		name = title, len = title_len;
	if (plot_add_column(x->name, p, name, len))
		return 1;
	all = realloc(x->fields, p->n * sizeof(*all));
	if (!all)
		return fail("out of memory");
	x->fields = all;
	all[p->n - 1] = f;
	x->row += f.bytes;
	return 0;
}

static bool key(struct npy *x, const char *name)
{
	const char *s;
	size_t len;

	return string(x, &s, &len) && len == strlen(name) && !memcmp(s, name, len) &&
	       take(x, ':');
}

/* The text as NumPy writes it: keys in this order. */
static int header(struct npy *x, struct plot_data *p, u64 *rows)
{
	if (!take(x, '{') || !key(x, "descr") || !take(x, '['))
		return malformed(x);
	while (take(x, '(')) {
		if (column(x, p))
			return 1;
		take(x, ',');
	}
	if (!p->n || !take(x, ']') || !take(x, ',') || !key(x, "fortran_order"))
		return malformed(x);
	skip(x);
	if (x->end - x->at < 5 || memcmp(x->at, "False", 5))
		return malformed(x);
	x->at += 5;
	if (!take(x, ',') || !key(x, "shape") || !take(x, '('))
		return malformed(x);
	skip(x);
	for (*rows = 0; x->at < x->end && *x->at >= '0' && *x->at <= '9'; x->at++) {
		if (*rows > PLOT_FILE_MAX)
			return malformed(x);
		*rows = 10 * *rows + (u64)(*x->at - '0');
	}
	return take(x, ',') && take(x, ')') ? 0 : malformed(x);
}

static double value(const struct field *f, const char *row)
{
	const u8 *data = (const u8 *)row + f->at;
	const struct ec_type t = { .bits = (u16)(8 * f->bytes), .kind = EC_KIND_INT };

	if (f->kind == 'f')
		return value_real(data, f->bytes);
	if (f->kind == 'i')
		return (double)value_signed(&t, data, f->bytes);
	return (double)value_unsigned(data, f->bytes);
}

static int read_rows(struct npy *x, struct plot_data *p, const char *data, size_t size, u64 n)
{
	if (size / x->row < n)
		return fail("%s ends after %zu of %llu rows", x->name, size / x->row,
			    (unsigned long long)n);
	for (u64 i = 0; i < n; i++) {
		if (plot_add_row(p))
			return 1;
		for (size_t k = 0; k < p->n; k++)
			p->columns[k].v[i] = value(&x->fields[k], data + i * x->row);
	}
	return 0;
}

int plot_npy(const char *name, const char *data, size_t size, struct plot_data *p)
{
	struct npy x = { .name = name };
	size_t prefix, len;
	u64 n = 0;
	int ret;

	if (size < 12)
		return malformed(&x);
	prefix = data[6] == 1 ? 10 : 12;
	len = (size_t)value_unsigned((const u8 *)data + 8, prefix - 8);
	if (len > size - prefix)
		return malformed(&x);
	x.at = data + prefix;
	x.end = x.at + len;
	ret = header(&x, p, &n);
	if (!ret)
		ret = read_rows(&x, p, data + prefix + len, size - prefix - len, n);
	free(x.fields);
	return ret;
}
