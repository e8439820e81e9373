// SPDX-License-Identifier: GPL-2.0-only
#include "dict.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../lib/tools/text.h"
#include "../master/wire/sii.h"
#include "io.h"
#include "out.h"
#include "progress.h"

/* reading the dictionary of one slave */
struct dict {
	const struct dict_reader *r;
	struct dev *d;
	const struct ect_slave *s;
	struct progress progress;
	size_t done;	/* objects */
	size_t all;
	u8 *buf;	/* values */
};

/* Does the slave describe its objects, as far as its EEPROM says? */
bool dict_described(const struct ect_slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE &&
	       (!s->coe_details || s->coe_details & EC_SII_COE_SDO_INFO);
}

/* entries that the slave does not describe are skipped: 0; any other failure is reported */
static int failed(struct dict *x, int err, bool quiet)
{
	u32 abort = ect_error_code(x->d->h);

	if (quiet && (abort || err == -EBADMSG))
		return 0;
	if (abort)
		fail_full(-err, NULL, abort,
			  "Master%u slave %u: cannot read the object dictionary", x->d->master,
			  x->s->position);
	else
		dev_fail(x->d, err, "Master%u slave %u: cannot read the object dictionary",
			 x->d->master, x->s->position);
	return err;
}

static void progress(struct dict *x)
{
	char what[32];

	snprintf(what, sizeof(what), "slave %u", x->s->position);
	progress_step(&x->progress, what, x->done, x->all, "objects");
}

static void read_value(struct dict *x, struct dict_entry *e)
{
	long n = ect_sdo_upload(x->d->h, x->s->device, e->d.index, e->d.subindex, 0, 0, x->buf,
				ECT_SDO_MAX);

	if (n < 0 && ect_error_code(x->d->h))
		e->value.abort = ect_error_code(x->d->h);
	else if (n < 0)
		e->value.err = -(int)n;
	else
		e->value = (struct dict_value){ .data = x->buf, .size = (size_t)n };
}

static int entry(struct dict *x, u16 index, u8 sub)
{
	struct dict_entry e = { .d.struct_size = sizeof(e.d) };
	int err = ect_entry_read(x->d->h, x->s->device, index, sub,
				 x->r->limits ? ECT_VALUE_ALL : 0, 0, &e.d);

	if (err)
		return failed(x, err, true);
	/* only what can be read in some state */
	if (x->r->values && e.d.access & EC_OD_READ)
		read_value(x, &e);
	x->r->entry(x->r, &e);
	progress(x);
	return 0;
}

static int object(struct dict *x, u16 index)
{
	struct ect_object o = { .struct_size = sizeof(o) };
	int err = ect_object_read(x->d->h, x->s->device, index, 0, &o);

	if (err)
		return failed(x, err, true);
	x->r->object(x->r, &o);
	for (unsigned int sub = 0; x->r->entries && sub <= o.max_subindex && !err; sub++)
		err = entry(x, index, (u8)sub);
	if (x->r->object_end)
		x->r->object_end(x->r);
	return err;
}

static int dictionary(struct dict *x)
{
	struct ect_list *list;
	int err = ect_objects_read(x->d->h, x->s->device, 0, &list);

	if (err) {
		failed(x, err, false);
		return 1;
	}
	x->all = ect_list_count(list);
	while (x->done < x->all && !err) {
		const struct ect_object *o = ect_list_get(list, x->done);

		err = object(x, o->index);
		x->done++;
		progress(x);
	}
	progress_end(&x->progress);
	ect_list_free(list);
	return err ? 1 : 0;
}

/**
 * dict_read() - read the object dictionary of a slave
 * @t: command line
 * @d: its master, open for writing
 * @s: slave
 * @r: what is done with it
 *
 * Objects and entries that the slave refuses to describe are skipped.
 *
 * Return: 0, or 1 after printing why it ended.
 */
int dict_read(const struct tool *t, struct dev *d, const struct ect_slave *s,
	      const struct dict_reader *r)
{
	struct dict x = {
		.r = r, .d = d, .s = s, .buf = malloc(ECT_SDO_MAX + 1),
	};
	int ret;

	progress_begin(&x.progress, t);
	if (r->listing && isatty(STDOUT_FILENO))
		x.progress.wanted = false;
	ret = x.buf ? dictionary(&x) : fail("out of memory");
	free(x.buf);
	return ret;
}

void dict_access_text(u16 access, char to[7])
{
	for (unsigned int i = 0; i < 3; i++) {
		to[2 * i] = access & EC_OD_READ_PREOP << i ? 'r' : '-';
		to[2 * i + 1] = access & EC_OD_WRITE_PREOP << i ? 'w' : '-';
	}
	to[6] = 0;
}

void dict_type_text(u16 type, char *to, size_t size)
{
	const struct ec_type *t = ec_type_by_code(type);

	if (t)
		snprintf(to, size, "%s", t->name);
	else
		snprintf(to, size, "type %04x", type);
}

static const struct ec_type *type_for(u16 code, size_t size)
{
	const struct ec_type *t = ec_type_by_code(code);

	return t && (!value_bytes(t) || value_bytes(t) == size) ? t :
	       ec_type_by_code(EC_TYPE_RAW);
}

/**
 * dict_value_text() - a value as text for one line, harmless to a terminal
 * @type: data type
 * @data: bytes, in a buffer with one byte more
 * @size: how many
 *
 * Return: text, to be freed; NULL without memory.
 */
char *dict_value_text(u16 type, u8 *data, size_t size)
{
	const struct ec_type *t = type_for(type, size);
	size_t cap = max((size_t)VALUE_TEXT, 5 * size + 1);
	char *text = malloc(cap);

	if (!text)
		return NULL;
	if (t->kind == EC_KIND_STRING) {
		data[size] = 0;
		snprintf(text, cap, "\"%s\"", (char *)data);
		string_clean(text, cap);
	} else {
		if (value_is_text(t))
			t = ec_type_by_code(EC_TYPE_RAW);
		value_format(t, data, size, text, cap);
	}
	return text;
}

/* in JSON the members of an object, in text no end of line */
void dict_value_out(u16 type, u8 *data, size_t size)
{
	char *text;

	if (out_is_json()) {
		io_print(type_for(type, size), data, size);
		return;
	}
	text = dict_value_text(type, data, size);
	out_text("%s", text ? text : "?");
	free(text);
}
