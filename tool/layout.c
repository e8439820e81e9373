// SPDX-License-Identifier: GPL-2.0-only
#include "layout.h"

#include <errno.h>
#include <stdlib.h>


#define CONTROL_WRITE	0x04	/* direction bit of the SM's control byte */

bool layout_is_output(const struct layout_sm *sm)
{
	return sm->sm.control & CONTROL_WRITE;
}

static int read_entries(struct dev *d, const struct ect_slave *s, unsigned int sm, unsigned int pdo,
			struct layout_pdo *p)
{
	p->entries = calloc(p->pdo.entry_count + 1u, sizeof(*p->entries));
	if (!p->entries)
		return -ENOMEM;
	for (unsigned int i = 0; i < p->pdo.entry_count; i++) {
		int err;

		p->entries[i].struct_size = sizeof(*p->entries);
		err = ect_pdo_entry_read(d->h, s->device, sm, pdo, i, &p->entries[i]);
		if (err)
			return err;
	}
	return 0;
}

static int read_pdos(struct dev *d, const struct ect_slave *s, struct layout_sm *sm)
{
	sm->pdos = calloc(sm->sm.pdo_count + 1u, sizeof(*sm->pdos));
	if (!sm->pdos)
		return -ENOMEM;
	for (unsigned int i = 0; i < sm->sm.pdo_count; i++) {
		struct layout_pdo *p = &sm->pdos[i];
		int err;

		p->pdo.struct_size = sizeof(p->pdo);
		err = ect_pdo_read(d->h, s->device, sm->sm.sm, i, &p->pdo);
		err = err ? err : read_entries(d, s, sm->sm.sm, i, p);
		if (err)
			return err;
	}
	return 0;
}

/**
 * layout_read() - read the process data layout of a slave
 * @d: master
 * @s: slave
 * @l: result, to be freed with layout_free()
 *
 * Return: 0, or 1 after printing the error.
 */
int layout_read(struct dev *d, const struct ect_slave *s, struct layout *l)
{
	int err = 0;

	*l = (struct layout){ .sms = calloc(s->sm_count + 1u, sizeof(*l->sms)) };
	if (!l->sms)
		return fail("out of memory");
	for (unsigned int i = 0; i < s->sm_count && !err; i++) {
		struct layout_sm *sm = &l->sms[i];

		sm->sm.struct_size = sizeof(sm->sm);
		err = ect_sm_read(d->h, s->device, i, &sm->sm);
		if (!err) {
			l->n++;
			err = read_pdos(d, s, sm);
		}
	}
	if (!err)
		return 0;
	layout_free(l);
	return dev_fail(d, err, "Master%u slave %u: cannot read the PDOs", d->master, s->position);
}

void layout_free(struct layout *l)
{
	for (unsigned int i = 0; i < l->n; i++) {
		struct layout_sm *sm = &l->sms[i];

		for (unsigned int k = 0; sm->pdos && k < sm->sm.pdo_count; k++)
			free(sm->pdos[k].entries);
		free(sm->pdos);
	}
	free(l->sms);
	*l = (struct layout){ 0 };
}
