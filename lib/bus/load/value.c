// SPDX-License-Identifier: LGPL-2.1-or-later
/* Values by name, and their numbers in process data. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "load.h"

struct loaded *loaded_new(void)
{
	struct loaded *to = calloc(1, sizeof(*to));

	if (to)
		to->what.struct_size = sizeof(to->what);
	return to;
}

void loaded_free(void *loaded)
{
	struct loaded *x = loaded;

	for (size_t i = 0; x && i < x->n; i++) {
		free(x->values[i].name);
		free(x->values[i].unit);
	}
	if (x)
		free(x->values);
	free(x);
}

void loaded_describe(struct loaded *to, uint32_t slaves, uint32_t clocks, int64_t cycle)
{
	to->what.slaves = slaves;
	to->what.clocks = clocks;
	to->what.cycle = cycle;
}

int loaded_add(struct loaded *to, const char *slave, const struct ecb_entry *e,
	       const struct ecb_value *v)
{
	char name[ECB_VALUE];
	struct named *n;

	if (!ecb_name_value(name, slave, e->name ? e->name : ""))
		return 0;
	if (to->n == to->room) {
		size_t room = to->room ? 2 * to->room : 64;

		n = realloc(to->values, room * sizeof(*n));
		if (!n)
			return -ENOMEM;
		to->values = n;
		to->room = room;
	}
	n = &to->values[to->n];
	n->v = *v;
	n->reg = to->regs - 1;
	n->name = strdup(name);
	n->unit = strdup(e->unit ? e->unit : "");
	to->n++;	/* loaded_free() frees what is here */
	if (!n->name || !n->unit)
		return -ENOMEM;
	n->v.unit = n->unit;
	return 0;
}

static int by_name(const void *a, const void *b)
{
	return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

/* Return: 0, or -EEXIST: two have the same name */
int loaded_sort(struct loaded *to)
{
	if (to->n)
		qsort(to->values, to->n, sizeof(*to->values), by_name);
	to->what.values = (uint32_t)to->n;
	for (size_t i = 1; i < to->n; i++)
		if (!strcmp(to->values[i - 1].name, to->values[i].name))
			return -EEXIST;
	return 0;
}

/* @from begins with struct_size as well; that of the caller stays */
static int give(void *to, const void *from, size_t size)
{
	uint32_t room;

	if (!to)
		return -EINVAL;
	memcpy(&room, to, sizeof(room));
	if (room <= sizeof(room))
		return -EINVAL;
	memset((char *)to + sizeof(room), 0, room - sizeof(room));
	if (size > room)
		size = room;
	memcpy((char *)to + sizeof(room), (const char *)from + sizeof(room), size - sizeof(room));
	return 0;
}

ECB_API int ecrt_master_loaded(const ec_master_t *master, struct ecb_loaded *loaded)
{
	const struct loaded *x = ecrt_master_data(master, loaded_free);

	return x ? give(loaded, &x->what, sizeof(x->what)) : -ENOENT;
}

ECB_API int ecrt_master_value(const ec_master_t *master, const char *name,
			      struct ecb_value *value)
{
	const struct loaded *x = ecrt_master_data(master, loaded_free);
	const struct named key = { .name = (char *)name };
	const struct named *n;

	if (!name || !value)
		return -EINVAL;
	n = x && x->n ? bsearch(&key, x->values, x->n, sizeof(*n), by_name) : NULL;
	return n ? give(value, &n->v, sizeof(n->v)) : -ENOENT;
}

static uint64_t get_bits(const struct ecb_value *v, const uint8_t *data)
{
	uint64_t raw = 0;

	for (unsigned int i = 0, at = v->bit; i < v->bits; i++, at++)
		raw |= (uint64_t)(data[v->byte + at / 8] >> at % 8 & 1) << i;
	return raw;
}

static void put_bits(const struct ecb_value *v, uint8_t *data, uint64_t raw)
{
	for (unsigned int i = 0, at = v->bit; i < v->bits; i++, at++) {
		uint8_t *b = &data[v->byte + at / 8], mask = (uint8_t)(1 << at % 8);

		*b = (uint8_t)(raw >> i & 1 ? *b | mask : *b & ~mask);
	}
}

static bool is_signed(unsigned int type)
{
	return type >= ECB_TYPE_INT8 && type <= ECB_TYPE_INT64;
}

ECB_API double ecb_value_read(const struct ecb_value *value, const uint8_t *data)
{
	uint8_t copy[8];
	uint64_t raw;
	double number;

	if (!value->bits || value->bits > 64)
		return NAN;
	raw = get_bits(value, data);
	EC_WRITE_U64(copy, raw);
	if (value->type == ECB_TYPE_REAL32) {
		number = (double)ecrt_read_real(copy);
	} else if (value->type == ECB_TYPE_REAL64) {
		number = ecrt_read_lreal(copy);
	} else if (is_signed(value->type)) {
		unsigned int gap = 64U - value->bits;

		number = (double)((int64_t)(raw << gap) >> gap);
	} else {
		number = (double)raw;
	}
	return number * value->scale + value->offset;
}

/* 2^@n */
static double power(unsigned int n)
{
	return ldexp(1, (int)n);
}

ECB_API int ecb_value_write(const struct ecb_value *value, uint8_t *data, double number)
{
	double raw = (number - value->offset) / value->scale, lowest = 0, limit;
	uint8_t copy[8] = { 0 };

	if (!value->output || !value->bits || value->bits > 64 || isnan(raw))
		return -EINVAL;
	if (value->type == ECB_TYPE_REAL32 || value->type == ECB_TYPE_REAL64) {
		bool single = value->type == ECB_TYPE_REAL32;

		if (isinf(raw) || (single && fabs(raw) > 3.4028234663852886e38))
			return -ERANGE;
		if (single)
			ecrt_write_real(copy, (float)raw);
		else
			ecrt_write_lreal(copy, raw);
		put_bits(value, data, EC_READ_U64(copy));
		return 0;
	}
	raw = nearbyint(raw);
	limit = power(value->bits);
	if (is_signed(value->type)) {
		limit /= 2;
		lowest = -limit;
	}
	if (raw < lowest || raw >= limit)
		return -ERANGE;
	put_bits(value, data, raw < 0 ? (uint64_t)(int64_t)raw : (uint64_t)raw);
	return 0;
}
