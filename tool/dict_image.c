// SPDX-License-Identifier: GPL-2.0-only
/*
 * The file of a dictionary is JSON, one entry in a line, so that versions of it can be compared by
 * other programs as well.
 */
#include "dict_image.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/tools/text.h"
#include "io.h"
#include "json.h"
#include "out.h"
#include "save.h"

#define FORMAT		"ethercat sdos"
#define VERSION		1
#define MAX_VALUE	(64u << 10)

void dict_image_free(struct dict_image *i)
{
	for (size_t k = 0; k < i->n; k++)
		free(i->v[k].value.data);
	free(i->v);
	*i = (struct dict_image){ 0 };
}

/* @e with a copy of its value */
static int append(struct dict_image *i, const struct dict_entry *e)
{
	struct dict_entry *more, *to;

	if (!(i->n & (i->n - 1))) {
		more = realloc(i->v, (i->n ? 2 * i->n : 1) * sizeof(*i->v));
		if (!more)
			return -ENOMEM;
		i->v = more;
	}
	to = &i->v[i->n];
	*to = *e;
	if (e->value.data) {
		to->value.data = malloc(e->value.size + 1);
		if (!to->value.data)
			return -ENOMEM;
		memcpy(to->value.data, e->value.data, e->value.size);
	}
	i->n++;
	return 0;
}

static void object(const struct dict_reader *r, const struct ect_object *o)
{
	(void)r, (void)o;
}

static void entry(const struct dict_reader *r, const struct dict_entry *e)
{
	struct dict_image *i = r->ctx;

	i->failures += e->value.err != 0;
	if (append(i, e))
		i->no_memory = true;
}

/**
 * dict_image_read() - read the dictionary of a slave with its values
 * @t: command line
 * @d: its master, open for writing
 * @s: slave
 * @i: result, to be freed with dict_image_free() even after a failure
 *
 * Return: 0, or 1 after printing what failed.
 */
int dict_image_read(const struct tool *t, struct dev *d, const struct ect_slave *s,
		    struct dict_image *i)
{
	const struct dict_reader r = {
		.entries = true, .values = true, .object = object, .entry = entry, .ctx = i,
	};

	*i = (struct dict_image){
		.vendor_id = s->vendor_id, .product_code = s->product_code,
		.revision_number = s->revision_number,
	};
	if (!dict_described(s))
		return fail("Master%u slave %u: no object dictionary that can be read (CoE with SDO information)",
			    d->master, s->position);
	if (dict_read(t, d, s, &r))
		return 1;
	return i->no_memory ? fail("out of memory") : 0;
}

static void save_entry(FILE *f, const struct dict_entry *e)
{
	char access[7], type[32], *text;

	dict_access_text(e->d.access, access);
	dict_type_text(e->d.type, type, sizeof(type));
	fprintf(f, "{\"object\": \"0x%04x:%02x\", \"name\": ", e->d.index, e->d.subindex);
	out_json_string(f, e->d.name);
	fprintf(f, ", \"access\": %u, \"access_text\": \"%s\", \"type_code\": %u, \"type\": \"%s\", \"size_bits\": %u",
		e->d.access, access, e->d.type, type, e->d.bits);
	if (e->value.data) {
		fputs(", \"data_hex\": \"", f);
		for (size_t k = 0; k < e->value.size; k++)
			fprintf(f, "%02x", e->value.data[k]);
		fputs("\", \"value\": ", f);
		text = dict_value_text(e->d.type, e->value.data, e->value.size);
		out_json_string(f, text ? text : "");
		free(text);
	} else if (e->value.abort) {
		fprintf(f, ", \"abort_code\": %u", e->value.abort);
	} else if (e->value.err) {
		fprintf(f, ", \"errno\": %d", e->value.err);
	}
	fputc('}', f);
}

static void write_image(FILE *f, const struct dict_image *i)
{
	fprintf(f, "{\n\"format\": \"" FORMAT "\",\n\"version\": %u,\n", VERSION);
	fprintf(f, "\"vendor_id\": %u,\n\"product_code\": %u,\n\"revision_number\": %u,\n",
		i->vendor_id, i->product_code, i->revision_number);
	fputs("\"entries\": [\n", f);
	for (size_t k = 0; k < i->n; k++) {
		save_entry(f, &i->v[k]);
		fputs(k + 1 < i->n ? ",\n" : "\n", f);
	}
	fputs("]\n}\n", f);
}

/**
 * dict_image_save() - write a file
 * @path: name
 * @i: content
 *
 * Return: 0, or 1 after printing what failed.
 */
int dict_image_save(const char *path, const struct dict_image *i)
{
	struct save s;

	if (save_begin(&s, path))
		return 1;
	write_image(s.f, i);
	return save_end(&s);
}

/* Hex digits to bytes; false: there is something else. */
static bool load_data(const char *hex, struct dict_value *v)
{
	size_t n = strlen(hex);

	if (n % 2 || n / 2 > MAX_VALUE || strspn(hex, "0123456789abcdefABCDEF") != n)
		return false;
	v->data = malloc(n / 2 + 1);
	if (!v->data)
		return false;
	v->size = n / 2;
	for (size_t k = 0; k < v->size; k++) {
		const char two[3] = { hex[2 * k], hex[2 * k + 1] };

		v->data[k] = (u8)strtoul(two, NULL, 16);
	}
	return true;
}

static bool load_entry(const struct json *j, struct dict_image *i)
{
	const char *where = json_str(j, "object"), *name = json_str(j, "name");
	const char *hex = json_str(j, "data_hex");
	struct dict_entry e = { 0 };
	unsigned int index, sub;
	u64 access, type, bits, number;
	int used = 0;
	bool ok;

	if (!where || !name || sscanf(where, "0x%4x:%2x%n", &index, &sub, &used) != 2 ||
	    where[used] || !json_u(j, "access", 0xffff, &access) ||
	    !json_u(j, "type_code", 0xffff, &type) || !json_u(j, "size_bits", 0xffff, &bits))
		return false;
	e.d.index = (u16)index;
	e.d.subindex = (u8)sub;
	e.d.access = (u16)access;
	e.d.type = (u16)type;
	e.d.bits = (u16)bits;
	snprintf(e.d.name, sizeof(e.d.name), "%s", name);
	string_clean(e.d.name, sizeof(e.d.name));
	if (json_u(j, "abort_code", 0xffffffff, &number))
		e.value.abort = (u32)number;
	else if (json_u(j, "errno", 0xffff, &number))
		e.value.err = (int)number;
	else if (hex && !load_data(hex, &e.value))
		return false;
	ok = !append(i, &e);
	free(e.value.data);
	return ok;
}

static int load(const char *path, const struct json *j, struct dict_image *i)
{
	const struct json *list = json_get(j, "entries");
	const char *format = json_str(j, "format");
	u64 vendor, product, revision, version;
	size_t n = 0;

	if (!format || strcmp(format, FORMAT) || !list || list->kind != JSON_ARRAY)
		return fail("'%s' is no dictionary: expected a file of 'ethercat sdos --save'",
			    path);
	if (!json_u(j, "version", ~0ull, &version) || version != VERSION)
		return fail("'%s' has an unknown version: expected %u; use a newer ethercat command",
			    path, VERSION);
	if (!json_u(j, "vendor_id", 0xffffffff, &vendor) ||
	    !json_u(j, "product_code", 0xffffffff, &product) ||
	    !json_u(j, "revision_number", 0xffffffff, &revision))
		return fail("'%s': vendor_id, product_code or revision_number is missing", path);
	i->vendor_id = (u32)vendor;
	i->product_code = (u32)product;
	i->revision_number = (u32)revision;
	for (const struct json *e = list->child; e; e = e->next) {
		n++;
		if (!load_entry(e, i))
			return fail("'%s': entry %zu of the list is invalid", path, n);
	}
	return 0;
}

/**
 * dict_image_load() - read a file of dict_image_save()
 * @path: name, "-" for stdin
 * @i: result, to be freed with dict_image_free() even after a failure
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int dict_image_load(const char *path, struct dict_image *i)
{
	const char *why;
	struct json *j;
	size_t size, line;
	u8 *text;
	int ret;

	*i = (struct dict_image){ 0 };
	if (io_read(path, &text, &size))
		return 1;
	if (memchr(text, 0, size)) {
		free(text);
		return fail("'%s' is no dictionary: it is a binary file", path);
	}
	j = json_parse((char *)text, &line, &why);
	ret = j ? load(path, j, i) : fail("'%s' is no dictionary: line %zu: %s", path, line, why);
	json_free(j);
	free(text);
	return ret;
}
