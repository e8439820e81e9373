// SPDX-License-Identifier: GPL-2.0-only
#include "current.h"

#include <errno.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/tools/text.h"
#include "bus_machine.h"
#include "value.h"

static int read_values(struct dev *d, struct current *l)
{
	int err = ect_values_read(d->h, &l->list);
	const struct ect_value *v;

	if (err)
		return dev_fail(d, err, "Master%u: cannot read the process data", d->master);
	l->n = ect_list_count(l->list);
	for (size_t i = 0; (v = current_at(l, i)); i++)
		l->domains = max(l->domains, v->domain + 1);
	l->images = calloc(l->domains + 1u, sizeof(*l->images));
	l->sizes = calloc(l->domains + 1u, sizeof(*l->sizes));
	if (!l->images || !l->sizes)
		return fail("out of memory");
	for (size_t i = 0; (v = current_at(l, i)); i++)
		l->sizes[v->domain] = max(l->sizes[v->domain], (v->bit + v->bits + 7u) / 8u);
	for (unsigned int i = 0; i < l->domains; i++) {
		l->images[i] = calloc(1, l->sizes[i] + 8);
		if (!l->images[i])
			return fail("out of memory");
	}
	return 0;
}

/**
 * current_read() - read the values of the running session
 * @d: master
 * @l: result, to be freed with current_free() in any case
 *
 * Return: 0, or 1 after printing the error.
 */
int current_read(struct dev *d, struct current *l)
{
	*l = (struct current){ 0 };
	return read_values(d, l) || current_rename(d, l) || current_distinct(l) ||
		current_refresh(d, l);
}

int current_read_as(const struct tool *t, struct dev *d, const char *file, struct current *l)
{
	int ret = current_read(d, l);

	if (ret || !file)
		return ret;
#ifdef EC_TOOL_NO_BUS
	(void)t;
	return fail("--file: this 'ethercat' was built without libyaml");
#else
	return bus_values(t, d, file, l) || current_distinct(l);
#endif
}

static bool same_place(const struct ect_value *a, const struct ect_value *b)
{
	return a->config == b->config && a->domain == b->domain && a->bit == b->bit &&
		a->bits == b->bits && a->index == b->index && a->subindex == b->subindex &&
		a->dir == b->dir;
}

static bool same_name(const struct current *l, size_t i, const struct ect_value *v)
{
	return !strcmp(v->name, l->before ? l->before[i] : current_at(l, i)->name);
}

/* Another session may have the same places, and mean something else by them. */
static int check_text(struct dev *d, const struct current *l)
{
	char *text;
	size_t size;
	int err = current_text(d, &text, &size);

	if (!err && (size != l->text_size || (text && memcmp(text, l->text, size))))
		err = -ESTALE;
	free(text);
	return err;
}

/* A session of the same size has begun since the last poll if the sends count from 0 again. */
static int check_session(struct dev *d, struct current *l)
{
	struct ect_cycle c = { .struct_size = sizeof(c) };
	struct ect_list *now;
	const struct ect_value *v;
	int err = ect_cycle_read(d->h, &c);
	bool fewer = !err && c.late_count < l->sends;

	if (!err)
		l->sends = c.late_count;
	if (!fewer)
		return 0;
	/* the statistics may have been cleared as well */
	err = ect_values_read(d->h, &now);
	if (err)
		return err;
	if (ect_list_count(now) != l->n)
		err = -ESTALE;
	for (size_t i = 0; !err && (v = ect_list_get(now, i)); i++)
		if (!same_place(v, current_at(l, i)) || !same_name(l, i, v))
			err = -ESTALE;
	ect_list_free(now);
	return err ? err : check_text(d, l);
}

int current_poll(struct dev *d, struct current *l)
{
	for (unsigned int i = 0; i < l->domains; i++) {
		long n = ect_domain_data(d->h, i, l->images[i], l->sizes[i]);

		if (n < 0)
			return (int)n;
		if ((size_t)n < l->sizes[i])
			return -ESTALE;	/* another session */
	}
	return check_session(d, l);
}

int current_refresh(struct dev *d, struct current *l)
{
	int err = current_poll(d, l);

	return err ? dev_fail(d, err, "Master%u: cannot read the process data", d->master) : 0;
}

void current_free(struct current *l)
{
	for (unsigned int i = 0; i < l->domains && l->images; i++)
		free(l->images[i]);
	free(l->images);
	free(l->sizes);
	for (size_t i = 0; i < l->n && l->units; i++)
		free(l->units[i].text);
	free(l->units);
	free(l->before);
	free(l->text);
	ect_list_free(l->list);
	*l = (struct current){ 0 };
}

bool current_matches(const struct ect_value *v, const char *pattern)
{
	return !fnmatch(pattern, v->name, 0);
}

const struct ect_value *current_find(const struct dev *d, const struct current *l, const char *name)
{
	const struct ect_value *v, *nearest = NULL;
	size_t least = strlen(name) / 3 + 1;

	for (size_t i = 0; (v = current_at(l, i)); i++) {
		size_t n;

		if (!strcmp(v->name, name))
			return v;
		n = text_typos(name, v->name);
		if (n < least) {
			least = n;
			nearest = v;
		}
	}
	if (nearest)
		fail("Master%u has no value %s; did you mean %s?", d->master, name, nearest->name);
	else
		fail("Master%u has no value %s; 'ethercat data --names' shows them", d->master,
		     name);
	return NULL;
}

bool current_bits(const struct current *l, const struct ect_value *v, u64 *bits)
{
	const u8 *from = l->images[v->domain] + v->bit / 8;
	unsigned int shift = v->bit % 8, n = min(v->bits, (u8)64);

	*bits = value_unsigned(from, (shift + n + 7) / 8 > 8 ? 8 : (shift + n + 7) / 8) >> shift;
	if (shift + n > 64)
		*bits |= (u64)from[8] << (64 - shift);
	if (n < 64)
		*bits &= (1ULL << n) - 1;
	return v->bits <= 64;
}

/* The type that the EEPROM names, if it has as many bits; otherwise a number without sign. */
struct ec_type current_type(const struct ect_value *v)
{
	static const char *const names[] = { "bool", "uint8", "uint16", "uint32", "uint64" };
	const struct ec_type *t = v->type ? ec_type_by_code(v->type) : NULL;
	const char *name = "bits";

	if (t && t->bits == v->bits && t->kind != EC_KIND_RAW && t->kind != EC_KIND_SM)
		return *t;
	if (v->bits == 1)
		name = names[0];
	for (unsigned int i = 1; i < ARRAY_SIZE(names); i++)
		if (v->bits == 4u << i)
			name = names[i];
	return (struct ec_type){ .bits = v->bits, .kind = EC_KIND_UINT, .name = name };
}

static double number_of(const struct ec_type *t, const u8 *data, u64 bits)
{
	if (t->kind == EC_KIND_FLOAT)
		return value_real(data, t->bits / 8u);
	return t->kind == EC_KIND_INT ? (double)value_signed(t, data, t->bits / 8u) : (double)bits;
}

static void to_wire(u64 bits, u8 *data)
{
	for (unsigned int i = 0; i < 8; i++)
		data[i] = (u8)(bits >> 8 * i);
}

double current_number(const struct current *l, const struct ect_value *v, u64 bits)
{
	struct ec_type t = current_type(v);
	u8 data[8];

	to_wire(bits, data);
	return current_scaled(l, v, number_of(&t, data, bits));
}

void current_format(const struct current *l, const struct ect_value *v, char *buf, size_t size)
{
	struct ec_type t = current_type(v);
	u8 data[8];
	u64 bits;

	if (!current_bits(l, v, &bits)) {
		snprintf(buf, size, "(%u bits)", v->bits);
		return;
	}
	to_wire(bits, data);
	if (current_is_scaled(l, v))
		snprintf(buf, size, "%.9g", current_number(l, v, bits));
	else if (t.kind == EC_KIND_FLOAT)
		snprintf(buf, size, "%.7g", value_real(data, t.bits / 8u));
	else if (t.kind == EC_KIND_INT)
		snprintf(buf, size, "%lld", (long long)value_signed(&t, data, t.bits / 8u));
	else if (t.kind == EC_KIND_BITS)
		snprintf(buf, size, "0x%0*llx", (t.bits + 3) / 4, (unsigned long long)bits);
	else
		snprintf(buf, size, "%llu", (unsigned long long)bits);
}

static int does_not_fit(const struct ect_value *v, const char *text, const char *why)
{
	return fail("%s has the type %s, %u bit(s), which '%s' does not fit%s%s", v->name,
		    current_type(v).name, v->bits, text, *why ? ": " : "", why);
}

/* A number of bits that no type has: without sign, or negative if it fits so. */
static int parse_bits(const struct ect_value *v, const char *text, u64 *bits)
{
	bool negative = *text == '-';
	const char *why = "";
	u64 most = v->bits < 64 ? (1ULL << v->bits) - 1 : ~0ULL, value;

	if (!strcmp(text, "true") || !strcmp(text, "on"))
		text = "1";
	if (!strcmp(text, "false") || !strcmp(text, "off"))
		text = "0";
	if (negative)
		most = most / 2 + 1;
	if (number_parse(text + negative, most, &value, &why))
		return does_not_fit(v, text, why);
	*bits = negative ? 0 - value : value;
	if (v->bits < 64)
		*bits &= (1ULL << v->bits) - 1;
	return 0;
}

int current_parse(const struct current *l, const struct ect_value *v, const char *text, u64 *bits)
{
	struct ec_type t = current_type(v);
	char raw[400];	/* of the largest double */
	const char *why = "";
	u8 data[8] = { 0 };
	size_t size;

	if (v->bits > 64)
		return fail("%s has %u bits, at most 64 can be set", v->name, v->bits);
	if (current_is_scaled(l, v)) {
		if (!current_unscaled(l, v, text, raw, sizeof(raw)))
			return fail("%s is scaled: '%s' is no number", v->name, text);
		text = strcmp(raw, "-0") ? raw : "0";
		if (*text == '-' && t.kind != EC_KIND_INT && t.kind != EC_KIND_FLOAT)
			return does_not_fit(v, text, "it has no sign");
	}
	if (t.kind != EC_KIND_FLOAT && t.kind != EC_KIND_INT)
		return parse_bits(v, text, bits);
	if (value_parse(&t, text, strlen(text), data, sizeof(data), &size, &why))
		return does_not_fit(v, text, why);
	*bits = value_unsigned(data, size);
	return 0;
}
