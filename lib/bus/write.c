// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fields.h"
#include "internal.h"

/* words that YAML takes for something else */
static bool is_plain(const char *s)
{
	static const char *const others[] = {
		"true", "false", "null", "yes", "no", "on", "off", "y", "n",
	};

	for (size_t i = 0; i < sizeof(others) / sizeof(others[0]); i++)
		if (!strcasecmp(s, others[i]))
			return false;
	return (*s | 32) >= 'a' && (*s | 32) <= 'z';
}

static void quoted(FILE *to, const char *s)
{
	putc('"', to);
	for (; *s; s++) {
		if (*s == '"' || *s == '\\')
			putc('\\', to);
		putc(*s, to);
	}
	putc('"', to);
}

static void scalar(FILE *to, const struct field *f, const void *from)
{
	bool large = f->kind == K_BYTES;
	char small[ECB_VALUE], *buf = large ? malloc(3 * BYTES_MAX + 1) : small;

	if (!buf)
		return;
	scalar_print(f, from, buf, large ? 3 * BYTES_MAX + 1 : sizeof(small));
	if (f->kind == K_TEXT || f->kind == K_BYTES || f->kind == K_OBJECT ||
	    ((f->kind == K_NAME || f->kind == K_VALUE || f->kind == K_WORD) && !is_plain(buf)))
		quoted(to, buf);
	else
		fputs(buf, to);
	if (large)
		free(buf);
}

/* without lists and items in it, and not long: on one line */
static bool is_flow(const struct type *type)
{
	for (size_t i = 0; i < type->count; i++)
		if (type->fields[i].kind == K_LIST || type->fields[i].kind == K_ITEM)
			return false;
	return true;
}

static void flow(FILE *to, const struct type *type, const void *item)
{
	const char *sep = "{";

	for (size_t i = 0; i < type->count; i++) {
		const struct field *f = &type->fields[i];
		const void *from = (const char *)item + f->at;

		if (!scalar_given(f, from))
			continue;
		fprintf(to, "%s%s: ", sep, f->key);
		scalar(to, f, from);
		sep = ", ";
	}
	fputs(*sep == '{' ? "{}\n" : "}\n", to);
}

static void item(FILE *to, const struct type *type, const void *from, unsigned int depth,
		 bool dash);

static void list(FILE *to, const struct field *f, const void *from, unsigned int depth)
{
	void *const *items = *(void *const *const *)from;
	size_t n = *(const size_t *)((const char *)from + sizeof(void *));

	putc('\n', to);
	for (size_t i = 0; i < n; i++)
		if (is_flow(f->type)) {
			fprintf(to, "%*s- ", depth, "");
			flow(to, f->type, items[i]);
		} else {
			item(to, f->type, items[i], depth, true);
		}
}

static void item(FILE *to, const struct type *type, const void *from, unsigned int depth,
		 bool dash)
{
	unsigned int in = dash ? depth + 2 : depth;

	for (size_t i = 0; i < type->count; i++) {
		const struct field *f = &type->fields[i];
		const char *at = (const char *)from + f->at;

		if (!scalar_given(f, at) && !(f->flags & F_REQUIRED))
			continue;
		if (dash)
			fprintf(to, "%*s- %s:", depth, "", f->key);
		else
			fprintf(to, "%*s%s:", in, "", f->key);
		dash = false;
		if (f->kind == K_LIST && !scalar_given(f, at)) {
			fputs(" []\n", to);
		} else if (f->kind == K_LIST) {
			list(to, f, at, in + 2);
		} else if (f->kind == K_ITEM) {
			putc(' ', to);
			flow(to, f->type, *(void *const *)at);
		} else {
			putc(' ', to);
			scalar(to, f, at);
			putc('\n', to);
		}
	}
	if (dash)
		fprintf(to, "%*s- {}\n", depth, "");
}

ECB_API int ecb_file_write(const struct ecb_bus *bus, FILE *to)
{
	item(to, &type_bus, bus, 0, false);
	return fflush(to) || ferror(to) ? -EIO : 0;
}
