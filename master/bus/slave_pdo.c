// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include <linux/sort.h>
#include "../base/grow.h"
#include "../base/limits.h"
#include "../wire/emergency.h"
#include "slave.h"
#include "slave_pdo.h"

#define STATUSWORD	0x6041	/* each drive has it, and maps it */

/* categories of the EEPROM that have PDOs */
static const u16 types[] = { EC_SII_CAT_RXPDO, EC_SII_CAT_TXPDO };

static bool has_object(const struct ec_pdo_list *l, u16 index)
{
	unsigned int i, k;

	for (i = 0; i < l->n; i++)
		for (k = 0; k < l->pdos[i].n_entries; k++)
			if (l->pdos[i].entries[k].index == index)
				return true;
	return false;
}

/**
 * ec_slave_note_profile() - what kind of device a slave is, by its PDOs
 * @slave: slave whose PDOs are known or have changed
 *
 * Object 0x1000 says it as well, but to read it takes a mailbox exchange.
 *
 * Context: Process; PDOs do not change meanwhile.
 */
void ec_slave_note_profile(struct ec_slave *slave)
{
	bool drive = has_object(&slave->pdos.free, STATUSWORD);
	unsigned int sm;

	for (sm = 0; sm < ARRAY_SIZE(slave->pdos.sm); sm++)
		drive |= has_object(&slave->pdos.sm[sm], STATUSWORD);
	WRITE_ONCE(slave->mbox.profile, drive ? EC_PROFILE_DRIVE : 0);
}

/**
 * ec_slave_read_pdos() - take the PDOs of a slave from its EEPROM
 * @slave: slave with EEPROM image
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM, or -ENOSPC beyond 255 entries.
 */
int ec_slave_read_pdos(struct ec_slave *slave)
{
	unsigned int t, i;
	int ret;

	for (t = 0; t < ARRAY_SIZE(types); t++) {
		struct ec_sii_pdo_iter it;
		struct ec_sii_pdo pdo;

		ec_sii_pdo_iter_init(&it, slave->eeprom.data, slave->eeprom.bytes, types[t]);
		while (ec_sii_pdo_iter_next(&it, &pdo) == 1) {
			struct ec_pdo_list *l = pdo.sm < EC_MAX_SM ?
				&slave->pdos.sm[pdo.sm] : &slave->pdos.free;
			struct ec_pdo *p = ec_pdo_add(l, pdo.index, pdo.name);

			if (!p)
				return -ENOMEM;
			for (i = 0; i < pdo.entries; i++) {
				struct ec_pdo_entry entry = { 0 };
				struct ec_sii_pdo_entry e;

				if (ec_sii_pdo_entry(&pdo, i, &e))
					break;
				entry.index = e.index;
				entry.sub = e.sub;
				entry.bits = e.bits;
				entry.name = e.name;
				ret = ec_pdo_add_entry(p, &entry);
				if (ret)
					return ret;
			}
		}
	}
	ec_slave_note_profile(slave);
	return 0;
}

/*
 * An entry of the EEPROM that has a name, as one number: object, subindex, PDO, string. The
 * EEPROM and the object dictionary may have some ten thousand entries each.
 */
#define NAMED(index, sub, pdo, name) \
	((u64)(index) << 32 | (u64)(sub) << 24 | (u64)(pdo) << 8 | (name))

struct named {
	u64 *v;
	unsigned int n;
};

static int slave_pdo_compare(const void *a, const void *b)
{
	u64 x = *(const u64 *)a, y = *(const u64 *)b;

	return x < y ? -1 : x > y;
}

/* The PDOs of the EEPROM: their number, or with @v the named entries of all of them. */
static unsigned int slave_pdo_collect(const struct ec_slave *slave, u64 *v, unsigned int most)
{
	struct ec_sii_pdo_entry e;
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	unsigned int t, i, n = 0;

	for (t = 0; t < ARRAY_SIZE(types); t++) {
		ec_sii_pdo_iter_init(&it, slave->eeprom.data, slave->eeprom.bytes, types[t]);
		while (ec_sii_pdo_iter_next(&it, &pdo) == 1) {
			if (!v)
				n += 1 + pdo.entries;
			if (v && pdo.name && n < most)
				v[n++] = NAMED(0, 0, pdo.index, pdo.name);
			for (i = 0; v && i < pdo.entries && n < most; i++)
				if (!ec_sii_pdo_entry(&pdo, i, &e) && e.name && e.index)
					v[n++] = NAMED(e.index, e.sub, pdo.index, e.name);
			cond_resched();
		}
	}
	return n;
}

/* String index of the first one from @key on, if it is one of @mask's; 0: none. */
static u8 find_name(const struct named *names, u64 key, u64 mask)
{
	unsigned int low = 0, high = names->n;

	while (low < high) {
		unsigned int mid = low + (high - low) / 2;

		if (names->v[mid] < key)
			low = mid + 1;
		else
			high = mid;
	}
	return low < names->n && !((names->v[low] ^ key) & mask) ? names->v[low] & 0xff : 0;
}

static void name_pdo(struct ec_pdo *p, const struct named *names)
{
	u64 same = NAMED(0xffff, 0xff, 0xffff, 0), any = NAMED(0xffff, 0xff, 0, 0);
	unsigned int i;
	u8 name;

	p->name = find_name(names, NAMED(0, 0, p->index, 0), same) ?: p->name;
	for (i = 0; i < p->n_entries; i++) {
		struct ec_pdo_entry *e = &p->entries[i];

		if (!e->index)
			continue;
		/* the same PDO knows best, any other one will do */
		name = find_name(names, NAMED(e->index, e->sub, p->index, 0), same);
		if (!name && !e->name)
			name = find_name(names, NAMED(e->index, e->sub, 0, 0), any);
		e->name = name ?: e->name;
	}
}

/**
 * ec_slave_name_pdos() - names of PDOs and entries, wherever the EEPROM has them
 * @slave: slave with EEPROM image
 * @l: PDOs of the slave
 *
 * An entry may have been mapped to another PDO than the one it is delivered in. Without
 * memory there are no names.
 *
 * Context: Process. May sleep.
 */
void ec_slave_name_pdos(const struct ec_slave *slave, struct ec_pdo_list *l)
{
	unsigned int i, most = slave_pdo_collect(slave, NULL, 0);
	struct named names;

	if (!most)
		return;
	names.v = kvmalloc_array(most, sizeof(*names.v), GFP_KERNEL);
	if (!names.v)
		return;
	names.n = slave_pdo_collect(slave, names.v, most);
	sort(names.v, names.n, sizeof(*names.v), slave_pdo_compare, NULL);
	for (i = 0; i < l->n; i++) {
		name_pdo(&l->pdos[i], &names);
		cond_resched();
	}
	kvfree(names.v);
}

/**
 * ec_slave_find_pdo() - a PDO the slave knows, assigned or not
 * @slave: slave
 * @index: PDO index
 *
 * Context: Process, with a reference to @slave.
 * Return: the PDO or NULL.
 */
const struct ec_pdo *ec_slave_find_pdo(const struct ec_slave *slave, u16 index)
{
	const struct ec_pdo *p;
	unsigned int i;

	ec_bus_assert_stays(slave->bus);
	for (i = 0; i < EC_MAX_SM; i++) {
		p = ec_pdo_find(&slave->pdos.sm[i], index);
		if (p)
			return p;
	}
	return ec_pdo_find(&slave->pdos.free, index);
}
