// SPDX-License-Identifier: GPL-2.0-only
/* What slaves are asked for, and what they say besides their PDOs. */
#include <stdlib.h>

#include "bus_int.h"

static int no_memory(void)
{
	return fail("out of memory");
}

static int wish_values(const struct ecb_slave *file, struct present *l)
{
	for (size_t i = 0; i < file->startup_count; i++) {
		const struct ecb_command *c = file->startup[i];
		struct present_value *grown;
		size_t k = 0;

		if (c->sdo == ECB_NONE32)
			continue;
		while (k < l->value_count && (l->values[k].object != c->sdo ||
					      l->values[k].complete != c->complete))
			k++;
		if (k < l->value_count)
			continue;
		grown = realloc(l->values, (k + 1) * sizeof(*grown));
		if (!grown)
			return no_memory();
		l->values = grown;
		grown[k] = (struct present_value){ .object = c->sdo, .complete = c->complete };
		l->value_count++;
		l->wish |= PRESENT_VALUES;
	}
	return 0;
}

/* of slaves of its kind, since ecb_compare() finds out which one it is */
static int wish_of_file(const struct ecb_master *m, const struct ect_slave *s, bool pdos,
			struct present *l)
{
	for (size_t i = 0; i < m->slave_count; i++) {
		const struct ecb_slave *file = m->slaves[i];

		if (file->vendor != s->vendor_id || file->product != s->product_code)
			continue;
		l->wish |= (pdos || file->pdo_count ? PRESENT_PDOS : 0) |
			(file->module_count ? PRESENT_MODULES : 0) |
			(file->clock ? PRESENT_CLOCK : 0);
		if (wish_values(file, l))
			return 1;
	}
	return 0;
}

int bus_present_wish(const struct bus_wish *wish, unsigned int master, const struct ect_slave *s,
		  struct present *l)
{
	*l = (struct present){ .s = s };
	if (wish->whole)
		l->wish = PRESENT_PDOS | PRESENT_NAMES | PRESENT_MODULES | PRESENT_CLOCK;
	for (size_t i = 0; wish->file && i < wish->file->master_count; i++)
		if (wish->file->masters[i]->index == master)
			return wish_of_file(wish->file->masters[i], s, wish->pdos, l);
	return 0;
}

static int take_values(struct ecb_bus *bus, const struct present *l, struct ecb_slave *to)
{
	for (size_t i = 0; i < l->value_count; i++) {
		const struct present_value *v = &l->values[i];
		struct ecb_command *c;

		if (!v->data || !v->size)
			continue;
		c = ecb_startup_add(bus, to, v->data, v->size);
		if (!c)
			return no_memory();
		c->sdo = v->object;
		c->complete = v->complete && 1;
	}
	return 0;
}

int bus_present_take(struct ecb_bus *bus, const struct present *l, struct ecb_slave *to)
{
	for (unsigned int slot = 1; l->known & PRESENT_MODULES && slot <= l->slots;
	     slot++) {
		struct ecb_module *m = l->idents[slot] ? ecb_module_add(bus, to) : NULL;

		if (!l->idents[slot])
			continue;
		if (!m)
			return no_memory();
		m->slot = (uint8_t)slot;
		m->ident = l->idents[slot];
	}
	if (l->assign_activate) {
		struct ecb_clock *c = ecb_clock_add(bus, to);

		if (!c)
			return no_memory();
		c->assign_activate = l->assign_activate;
		c->sync0 = l->sync[0];
		c->sync1 = l->sync[1];
		to->known |= ECB_KNOWN_CLOCK;
	}
	if (l->known & PRESENT_MODULES)
		to->known |= ECB_KNOWN_MODULES;
	to->known |= ECB_KNOWN_STARTUP;
	return take_values(bus, l, to);
}
