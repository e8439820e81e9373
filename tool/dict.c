// SPDX-License-Identifier: GPL-2.0-only
#include "dict.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../master/wire/sii.h"
#include "io.h"
#include "out.h"
#include "progress.h"
#include "text.h"

#define ROOM		(64u << 10)	/* the largest answer the kernel passes on */
#define REFUSED		(-1)

/* reading the dictionary of one slave */
struct dict {
	const struct dict_reader *r;
	struct dev *d;
	const struct slave *s;
	struct progress progress;
	size_t done;	/* objects */
	size_t all;
	u8 *buf;	/* answers, then values */
	u8 *limits;	/* descriptions with limits */
};

/* Does the slave describe its objects, as far as its EEPROM says? */
bool dict_described(const struct slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE &&
	       (!s->coe_details || s->coe_details & EC_SII_COE_SDO_INFO);
}

/* 0, or errno; REFUSED with @quiet: no error is printed */
static int ask(struct dict *x, u8 what, u16 index, u8 sub, size_t *size, bool quiet)
{
	struct ec_ioc_sdo_info i = {
		.slave = x->s->slave, .index = index, .subindex = sub, .what = what,
		.size = ROOM, .data = (uintptr_t)x->buf,
	};
	int err = dev_ioctl(x->d, EC_IOC_SDO_INFO, &i);

	*size = min(i.size, ROOM);
	if (!err)
		return 0;
	if (quiet && i.abort_code)
		return REFUSED;
	if (i.abort_code)
		fail_full(err, NULL, i.abort_code,
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

static void name_of(char to[DICT_NAME], const char *name, size_t len)
{
	snprintf(to, DICT_NAME, "%.*s", (int)min(len, (size_t)DICT_NAME - 1), name);
	string_clean(to, DICT_NAME);
}

/* What the slave does not give is no error; nor is an older module, which knows no limits. */
static void read_limits(struct dict *x, struct dict_entry *e, size_t plain)
{
	struct ec_ioc_sdo_info i = {
		.slave = x->s->slave, .index = e->index, .subindex = e->sub,
		.what = EC_SDO_INFO_ENTRY, .value_info = EC_SDO_VALUE_ALL,
		.size = ROOM, .data = (uintptr_t)x->limits,
	};

	if (dev_ioctl(x->d, EC_IOC_SDO_INFO, &i) ||
	    ec_od_values_decode(x->limits, min(i.size, ROOM), plain, &e->limits))
		e->limits = (struct ec_od_values){ 0 };
}

static void read_value(struct dict *x, struct dict_entry *e)
{
	struct ec_ioc_sdo s = {
		.slave = x->s->slave, .index = e->index, .subindex = e->sub, .size = ROOM,
		.data = (uintptr_t)x->buf,
	};
	int err = dev_ioctl(x->d, EC_IOC_SDO_UPLOAD, &s);

	if (err && s.abort_code)
		e->value.abort = s.abort_code;
	else if (err)
		e->value.err = err;
	else
		e->value = (struct dict_value){ .data = x->buf, .size = min(s.size, ROOM) };
}

static void entry(struct dict *x, const struct ec_od_entry *d, size_t plain)
{
	struct dict_entry e = {
		.index = d->index, .sub = d->sub, .type = d->type, .bits = d->bits,
		.access = d->access,
	};

	/* the buffer takes the value next */
	name_of(e.name, d->name, d->name_len);
	/* optional fields that come without request leave the size of the rest unknown */
	if (x->r->limits && !(d->info & EC_OD_INFO_VALUES))
		read_limits(x, &e, plain);
	/* only what can be read in some state */
	if (x->r->values && e.access & EC_OD_READ)
		read_value(x, &e);
	x->r->entry(x->r, &e);
	progress(x);
}

static int entries(struct dict *x, u16 index, u8 max_sub)
{
	int err = 0;

	for (unsigned int sub = 0; sub <= max_sub && !err; sub++) {
		struct ec_od_entry e;
		size_t size;

		err = ask(x, EC_SDO_INFO_ENTRY, index, (u8)sub, &size, true);
		if (!err && !ec_od_entry_decode(x->buf, size, &e))
			entry(x, &e, size);
		else if (err == REFUSED)
			err = 0;
	}
	return err;
}

static int object(struct dict *x, u16 index)
{
	struct dict_object o = { .index = index };
	struct ec_od_object d;
	size_t size;
	int err = ask(x, EC_SDO_INFO_OBJECT, index, 0, &size, true);

	if (err)
		return err == REFUSED ? 0 : err;
	if (ec_od_object_decode(x->buf, size, &d))
		return 0;
	o.type = d.type;
	o.max_sub = d.max_sub;
	o.code = d.code;
	name_of(o.name, d.name, d.name_len);
	x->r->object(x->r, &o);
	if (x->r->entries)
		err = entries(x, index, o.max_sub);
	if (x->r->object_end)
		x->r->object_end(x->r);
	return err;
}

static int dictionary(struct dict *x)
{
	size_t size;
	int err = ask(x, EC_SDO_INFO_LIST, 1, 0, &size, false);
	u8 *list;

	if (err)
		return 1;
	list = malloc(size + 1);
	if (!list)
		return fail("out of memory");
	memcpy(list, x->buf, size);
	x->all = size / 2;
	while (x->done < x->all && !err) {
		err = object(x, get_unaligned_le16(list + 2 * x->done));
		x->done++;
		progress(x);
	}
	progress_end(&x->progress);
	free(list);
	return err ? 1 : 0;
}

/**
 * dict_read() - read the object dictionary of a slave
 * @t: command line
 * @d: its master, open for writing
 * @s: slave
 * @r: what is done with it
 *
 * Objects and entries that the slave refuses to describe are left out.
 *
 * Return: 0, or 1 after printing why it ended.
 */
int dict_read(const struct tool *t, struct dev *d, const struct slave *s,
	      const struct dict_reader *r)
{
	struct dict x = {
		.r = r, .d = d, .s = s, .buf = malloc(ROOM + 1),
		.limits = malloc(ROOM),
	};
	int ret;

	progress_begin(&x.progress, t);
	if (r->listing && isatty(STDOUT_FILENO))
		x.progress.wanted = false;
	ret = x.buf && x.limits ? dictionary(&x) : fail("out of memory");
	free(x.buf);
	free(x.limits);
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
 * @data: bytes, with room for one behind them
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
