// SPDX-License-Identifier: LGPL-2.1-or-later
/* Process data of a slave, asked of the slave. */
#include "demo.h"

static int read_pdo(ec_master_t *m, struct layout *l, const ec_sync_info_t *sync,
		    uint16_t pdo_pos)
{
	ec_pdo_info_t pdo;
	struct entry *e;
	uint16_t i;

	if (ecrt_master_get_pdo(m, l->position, sync->index, pdo_pos, &pdo))
		return -1;
	for (i = 0; i < pdo.n_entries && l->count < ENTRIES_MAX; i++) {
		e = &l->entries[l->count];
		e->sm = sync->index;
		e->pdo_pos = pdo_pos;
		e->entry_pos = i;
		e->dir = sync->dir;
		if (ecrt_master_get_pdo_entry(m, l->position, sync->index,
					      pdo_pos, i, &e->info))
			return -1;
		if (e->info.index)	/* else a gap */
			l->count++;
	}
	return 0;
}

int layout_read(ec_master_t *master, const ec_slave_info_t *slave,
		struct layout *l)
{
	ec_sync_info_t sync;
	uint8_t sm;
	uint16_t i;

	l->position = slave->position;
	l->count = 0;
	for (sm = 0; sm < slave->sync_count; sm++) {
		if (ecrt_master_get_sync_manager(master, l->position, sm, &sync))
			return -1;
		for (i = 0; i < sync.n_pdos; i++)
			if (read_pdo(master, l, &sync, i))
				return -1;
	}
	return 0;
}

const struct entry *layout_find(const struct layout *l, ec_direction_t dir,
				uint16_t index, uint8_t subindex)
{
	const struct entry *e;

	for (e = l->entries; e < l->entries + l->count; e++)
		if (e->dir == dir && e->info.index == index &&
		    e->info.subindex == subindex)
			return e;
	return NULL;
}

/* the @n-th entry, from 0, of that direction and size */
const struct entry *layout_nth(const struct layout *l, ec_direction_t dir,
			       unsigned int bits, unsigned int n)
{
	const struct entry *e;

	for (e = l->entries; e < l->entries + l->count; e++)
		if (e->dir == dir && e->info.bit_length == bits && !n--)
			return e;
	return NULL;
}

/* By position, since a mapping may hold an object more than once. */
int point_register(struct point *p, ec_slave_config_t *sc, ec_domain_t *domain,
		   const struct entry *e)
{
	int offset = ecrt_slave_config_reg_pdo_entry_pos(sc, e->sm, e->pdo_pos,
							 e->entry_pos, domain,
							 &p->bit);

	if (offset < 0)
		return offset;
	p->byte = (unsigned int)offset;
	p->bits = e->info.bit_length;
	p->index = e->info.index;
	p->subindex = e->info.subindex;
	return 0;
}
