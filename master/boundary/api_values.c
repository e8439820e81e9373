// SPDX-License-Identifier: GPL-2.0-only
/* Values of a compiled bus file by their names; for applications in the kernel. */
#include <linux/mm.h>
#include <linux/overflow.h>
#include "../../lib/ecrt/ecrt_int.h"
#include "api_values.h"

/**
 * ec_loaded_new() - memory for the values of a compiled bus file
 * @c: which
 *
 * Context: Process. May sleep.
 * Return: without values, to be freed with kvfree(); NULL: no memory.
 */
struct ec_loaded *ec_loaded_new(const struct ec_compiled *c)
{
	size_t values = sizeof(struct ec_loaded) + array_size(c->n_values,
							      sizeof(struct ec_loaded_value));
	struct ec_loaded *l = kvzalloc(size_add(values, c->texts), GFP_KERNEL);

	if (l)
		l->texts = (char *)l + values;
	return l;
}

/* @texts is as large as all texts of the file */
static const char *keep(struct ec_loaded *l, const char *text)
{
	char *to = l->texts + l->used;

	strcpy(to, text);
	l->used += strlen(text) + 1;
	return to;
}

/**
 * ec_loaded_add() - keep a value
 * @l: of the file that has @r
 * @r: EC_COMPILED_VALUE, behind the one before
 * @v: domain, slave and place of the value; the rest is set
 *
 * Context: Process.
 */
void ec_loaded_add(struct ec_loaded *l, const struct ec_compiled_record *r, ec_value_t *v)
{
	struct ec_loaded_value *to = &l->values[l->n++];

	v->bits = r->bits;
	v->type = r->type;
	v->output = r->output;
	v->object = r->object;
	v->scale_num = r->scale.num;
	v->scale_den = r->scale.den;
	v->offset_num = r->offset.num;
	v->offset_den = r->offset.den;
	v->unit = keep(l, r->unit_text);
	to->v = *v;
	to->name = keep(l, r->name);
}

/**
 * ec_loaded_free() - the handles of a session are not valid any more
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_loaded_free(struct ec_master *m)
{
	kvfree(m->api->loaded);
	m->api->loaded = NULL;
}

int ecrt_master_loaded(const ec_master_t *master, ec_loaded_t *loaded)
{
	if (!master || !loaded)
		return -EINVAL;
	if (!master->api->loaded)
		return -ENOENT;
	*loaded = master->api->loaded->what;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_loaded);

int ecrt_master_value(const ec_master_t *master, const char *name, ec_value_t *value)
{
	const struct ec_loaded *l = master ? master->api->loaded : NULL;
	u32 first = 0, end = l ? l->n : 0;

	if (!master || !name || !value)
		return -EINVAL;
	while (first < end) {
		u32 i = first + (end - first) / 2;
		int differs = strcmp(name, l->values[i].name);

		if (!differs) {
			*value = l->values[i].v;
			return 0;
		}
		if (differs < 0)
			end = i;
		else
			first = i + 1;
	}
	return -ENOENT;
}
EXPORT_SYMBOL_GPL(ecrt_master_value);
