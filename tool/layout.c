// SPDX-License-Identifier: GPL-2.0-only
#include "layout.h"

#include <errno.h>
#include <stdlib.h>

#include "text.h"

#define CONTROL_WRITE	0x04	/* direction bit of the SM's control byte */

bool layout_is_output(const struct layout_sm *sm)
{
	return sm->sm.control & CONTROL_WRITE;
}

static int read_entries(struct dev *d, struct layout_pdo *p)
{
	p->entries = calloc(p->pdo.entry_count + 1u, sizeof(*p->entries));
	if (!p->entries)
		return ENOMEM;
	for (unsigned int i = 0; i < p->pdo.entry_count; i++) {
		struct ec_ioc_pdo_entry *e = &p->entries[i];
		int err;

		e->slave = p->pdo.slave;
		e->sm = p->pdo.sm;
		e->pdo_pos = p->pdo.pdo_pos;
		e->entry_pos = (__u16)i;
		err = dev_ioctl(d, EC_IOC_PDO_ENTRY, e);
		if (err)
			return err;
		string_clean(e->name, sizeof(e->name));
	}
	return 0;
}

static int read_pdos(struct dev *d, struct layout_sm *sm)
{
	sm->pdos = calloc(sm->sm.pdo_count + 1u, sizeof(*sm->pdos));
	if (!sm->pdos)
		return ENOMEM;
	for (unsigned int i = 0; i < sm->sm.pdo_count; i++) {
		struct layout_pdo *p = &sm->pdos[i];
		int err;

		p->pdo.slave = sm->sm.slave;
		p->pdo.sm = sm->sm.sm;
		p->pdo.pdo_pos = (__u16)i;
		err = dev_ioctl(d, EC_IOC_PDO, &p->pdo);
		if (err)
			return err;
		string_clean(p->pdo.name, sizeof(p->pdo.name));
		err = read_entries(d, p);
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
int layout_read(struct dev *d, const struct slave *s, struct layout *l)
{
	int err = 0;

	*l = (struct layout){ .sms = calloc(s->sm_count + 1u, sizeof(*l->sms)) };
	if (!l->sms)
		return fail("out of memory");
	for (unsigned int i = 0; i < s->sm_count && !err; i++) {
		struct layout_sm *sm = &l->sms[i];

		sm->sm.slave = s->slave;
		sm->sm.sm = (__u8)i;
		err = dev_ioctl(d, EC_IOC_SM, &sm->sm);
		if (!err) {
			l->n++;
			err = read_pdos(d, sm);
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
