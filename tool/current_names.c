// SPDX-License-Identifier: GPL-2.0-only
/*
 * Values are called as the application of the session calls them, with its types, units and
 * scaling: those of the bus file that it was made of.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "current.h"

double current_scaled(const struct current *l, const struct ect_value *v, double raw)
{
	const struct current_unit *u = current_unit(l, v);

	return u ? raw * u->scale + u->offset : raw;
}

bool current_is_scaled(const struct current *l, const struct ect_value *v)
{
	const struct current_unit *u = current_unit(l, v);

	return u && (u->scale != 1 || u->offset != 0);
}

/* The raw number as text, in the range of a double; its type decides what fits. */
bool current_unscaled(const struct current *l, const struct ect_value *v, const char *text,
		      char *buf, size_t size)
{
	const struct current_unit *u = current_unit(l, v);
	char *end;
	double number = strtod(text, &end);

	if (end == text || *end || !isfinite(number))
		return false;
	number = (number - u->offset) / u->scale;
	if (!isfinite(number))
		return false;
	if (current_type(v).kind == EC_KIND_FLOAT)
		snprintf(buf, size, "%.17g", number);
	else
		snprintf(buf, size, "%.0f", number);
	return true;
}

static int by_name(const void *a, const void *b)
{
	return strcmp((*(struct ect_value *const *)a)->name, (*(struct ect_value *const *)b)->name);
}

static bool take_back(const struct current *l, struct ect_value *v)
{
	const char *name = l->before[v - current_at(l, 0)];

	if (!strcmp(v->name, name))
		return false;
	snprintf(v->name, sizeof(v->name), "%s", name);
	return true;
}

/* All values lose a name that several have. */
static bool take_back_once(const struct current *l, struct ect_value **all)
{
	bool any = false;
	size_t end;

	qsort(all, l->n, sizeof(*all), by_name);
	for (size_t i = 0; i < l->n; i = end) {
		for (end = i + 1; end < l->n && !by_name(&all[i], &all[end]);)
			end++;
		for (size_t k = i; k < end && end > i + 1; k++)
			any |= take_back(l, all[k]);
	}
	return any;
}

/* A name that is taken back may be one that another value has got. */
int current_distinct(struct current *l)
{
	struct ect_value **all;

	if (!l->before)
		return 0;
	all = calloc(l->n + 1, sizeof(struct ect_value *));
	if (!all)
		return fail("out of memory");
	for (size_t i = 0; i < l->n; i++)
		all[i] = (struct ect_value *)current_at(l, i);
	while (take_back_once(l, all))
		;
	free(all);
	return 0;
}

int current_text(struct dev *d, char **text, size_t *size)
{
	int err = ect_session_names(d->h, text, size);

	/* an older module has none */
	return err == -ENOTTY || err == -ENOENT ? 0 : err;
}

#ifdef EC_TOOL_NO_BUS
int current_rename(struct dev *d, struct current *l)
{
	(void)d;
	(void)l;
	return 0;
}
#else
#include "../include/ethercat-bus.h"

/* CoE data types of enum ecb_type */
static const u16 codes[] = {
	[ECB_TYPE_BOOL] = 0x0001, [ECB_TYPE_INT8] = 0x0002, [ECB_TYPE_INT16] = 0x0003,
	[ECB_TYPE_INT32] = 0x0004, [ECB_TYPE_INT64] = 0x0015, [ECB_TYPE_UINT8] = 0x0005,
	[ECB_TYPE_UINT16] = 0x0006, [ECB_TYPE_UINT32] = 0x0007, [ECB_TYPE_UINT64] = 0x001b,
	[ECB_TYPE_REAL32] = 0x0008, [ECB_TYPE_REAL64] = 0x0011,
};

/* An entry that is found is used up: an object may be mapped twice. */
static struct ecb_entry *take_entry(const struct ecb_slave *s, const struct ect_value *v)
{
	u32 object = (u32)v->index << 8 | v->subindex;

	for (size_t p = 0; p < s->pdo_count; p++)
		for (size_t i = 0; i < s->pdos[p]->entry_count; i++) {
			struct ecb_entry *e = s->pdos[p]->entries[i];

			if (e->object != object || e->bits != v->bits)
				continue;
			e->object = 0;
			return e;
		}
	return NULL;
}

/* the slave that the text has for a configuration, or NULL */
static const struct ecb_slave *slave_of(struct dev *d, const struct ecb_master *m, u32 config)
{
	struct ect_config c = { .struct_size = sizeof(c) };
	const struct ecb_slave *s;

	if (config >= m->slave_count || ect_config_read(d->h, config, &c))
		return NULL;
	s = m->slaves[config];
	return s->vendor == c.vendor_id && s->product == c.product_code ? s : NULL;
}

static int begin_units(struct current *l)
{
	if (l->units)
		return 0;
	l->units = calloc(l->n + 1, sizeof(*l->units));
	l->before = calloc(l->n + 1, sizeof(*l->before));
	if (!l->units || !l->before)
		return fail("out of memory");
	for (size_t i = 0; i < l->n; i++) {
		l->units[i].scale = 1;
		memcpy(l->before[i], current_at(l, i)->name, sizeof(*l->before));
	}
	return 0;
}

int current_rename_value(struct current *l, size_t i, const struct ecb_slave *s)
{
	struct ect_value *v = (struct ect_value *)current_at(l, i);
	struct ecb_entry *e = take_entry(s, v);
	char name[ECB_VALUE];

	if (!e || !e->name || !ecb_name_value(name, s->name, e->name))
		return 0;
	if (begin_units(l))
		return 1;
	snprintf(v->name, sizeof(v->name), "%s", name);
	/* else the one that the EEPROM has */
	if (e->type)
		v->type = codes[e->type];
	l->units[i].scale = e->scale;
	l->units[i].offset = e->offset;
	free(l->units[i].text);
	l->units[i].text = e->unit ? strdup(e->unit) : NULL;
	return e->unit && !l->units[i].text ? fail("out of memory") : 0;
}

static int rename_all(struct dev *d, struct current *l, const struct ecb_master *m)
{
	const struct ecb_slave *s = NULL;
	const struct ect_value *v;
	u32 config = ECT_NONE32;
	int ret = 0;

	if (begin_units(l))
		return 1;
	for (size_t i = 0; (v = current_at(l, i)) && !ret; i++) {
		if (v->config != config)
			s = slave_of(d, m, v->config);
		config = v->config;
		if (s)
			ret = current_rename_value(l, i, s);
	}
	return ret;
}

/**
 * current_rename() - take the names of the application
 * @d: master
 * @l: values with the names that their slaves give
 *
 * The text is that of another user. One that is not valid changes nothing.
 *
 * Return: 0, or 1 after printing the error.
 */
int current_rename(struct dev *d, struct current *l)
{
	struct ecb_bus *bus = NULL;
	struct ecb_error e;
	int err = current_text(d, &l->text, &l->text_size), ret = 0;

	if (err)
		return dev_fail(d, err, "Master%u: cannot read the names of its application",
				d->master);
	if (l->text && !ecb_file_parse(&bus, "names of the application", l->text, l->text_size,
				       &e) &&
	    bus->master_count == 1)
		ret = rename_all(d, l, bus->masters[0]);
	ecb_bus_free(bus);
	return ret;
}
#endif
