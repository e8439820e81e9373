// SPDX-License-Identifier: GPL-2.0-only
/*
 * What slaves with EoE are called: read from the list of slaves, and found again. There may be
 * thousands, so they are sorted.
 */
#include <linux/bsearch.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include <linux/sort.h>
#include "../bus/slave.h"
#include "ids.h"

#define STEP		64	/* slaves in a section of a reader */

static bool has_eoe(const struct ec_slave *s)
{
	return ec_mbox_present(&s->mbox) && s->info.protocols & EC_SII_PROTO_EOE;
}

static void identify(const struct ec_slave *s, struct ec_eoe_id *id)
{
	*id = (struct ec_eoe_id){
		.device = s->device, .alias = s->alias, .serial = s->info.serial,
		.position = s->position, .vendor = s->info.vendor, .product = s->info.product,
	};
}

static struct ec_eoe_id *ids_read_list(struct ec_bus *bus, u32 lists, unsigned int *n)
{
	unsigned int i = 0, size = READ_ONCE(bus->n_slaves);
	struct ec_eoe_id *ids = kvcalloc(size + 1, sizeof(*ids), GFP_KERNEL);
	bool more = ids;

	*n = 0;
	while (more) {
		unsigned int end = i + STEP;

		cond_resched();
		if (ec_show_begin(&bus->base->show))
			break;
		if (READ_ONCE(bus->lists) != lists || ec_bus_scan_busy(bus) ||
		    bus->n_slaves > size) {
			ec_show_end(&bus->base->show);
			break;
		}
		for (; i < min(end, bus->n_slaves); i++)
			if (has_eoe(bus->slaves[i]))
				identify(bus->slaves[i], &ids[(*n)++]);
		more = i < bus->n_slaves;
		ec_show_end(&bus->base->show);
		if (!more)
			return ids;
	}
	kvfree(ids);
	return NULL;
}

/* orders of slaves ----------------------------------------------------------*/

static int order(u64 a, u64 b)
{
	return a < b ? -1 : a > b;
}

static int by_alias(const void *a, const void *b)
{
	return order(((const struct ec_eoe_id *)a)->alias, ((const struct ec_eoe_id *)b)->alias);
}

static int ids_by_serial(const void *a, const void *b)
{
	return order(((const struct ec_eoe_id *)a)->serial, ((const struct ec_eoe_id *)b)->serial);
}

static int by_device(const void *a, const void *b)
{
	return order(((const struct ec_eoe_id *)a)->device, ((const struct ec_eoe_id *)b)->device);
}

static u64 type_of(const struct ec_eoe_id *id)
{
	return (u64)id->vendor << 32 | id->product;
}

/* One without alias and serial number is known by its place alone. */
static u64 ids_unit_of(const struct ec_eoe_id *id)
{
	return (u64)id->alias << 48 | (u64)id->serial << 16 |
	       (id->alias || id->serial ? 0 : id->position);
}

static int by_unit(const void *a, const void *b)
{
	return order(type_of(a), type_of(b)) ?: order(ids_unit_of(a), ids_unit_of(b));
}

/* Heapsort: bounded for whatever slaves say. */
static void sort_ids(struct ec_eoe_id *ids, unsigned int n,
		     int (*by)(const void *a, const void *b))
{
	sort(ids, n, sizeof(*ids), by, NULL);
	cond_resched();
}

/* A name that two slaves would have is none. */
static void mark_shared(struct ec_eoe_id *ids, unsigned int n)
{
	unsigned int i;

	sort_ids(ids, n, by_alias);
	for (i = 1; i < n; i++)
		if (ids[i].alias && ids[i].alias == ids[i - 1].alias)
			ids[i].alias_shared = ids[i - 1].alias_shared = true;
	sort_ids(ids, n, ids_by_serial);
	for (i = 1; i < n; i++)
		if (ids[i].serial && ids[i].serial == ids[i - 1].serial)
			ids[i].serial_shared = ids[i - 1].serial_shared = true;
}

/**
 * ec_eoe_ids_by_device() - sort slaves by their device numbers
 * @ids: slaves
 * @n: how many
 *
 * Context: Process. May sleep.
 */
void ec_eoe_ids_by_device(struct ec_eoe_id *ids, unsigned int n)
{
	sort_ids(ids, n, by_device);
}

/**
 * ec_eoe_ids_by_unit() - sort slaves so that those that may be the same stand together
 * @ids: slaves
 * @n: how many
 *
 * Context: Process. May sleep.
 */
void ec_eoe_ids_by_unit(struct ec_eoe_id *ids, unsigned int n)
{
	sort_ids(ids, n, by_unit);
}

/**
 * ec_eoe_ids_read() - slaves with EoE, in the order of device numbers
 * @bus: slaves
 * @lists: the list that is meant, as counted by @bus->lists
 * @n: result: how many
 *
 * Context: Process. May sleep.
 * Return: slaves, to be freed by kvfree(); NULL: there is no memory, or the list changes at
 * present.
 */
struct ec_eoe_id *ec_eoe_ids_read(struct ec_bus *bus, u32 lists, unsigned int *n)
{
	struct ec_eoe_id *ids = ids_read_list(bus, lists, n);

	if (ids) {
		mark_shared(ids, *n);
		ec_eoe_ids_by_device(ids, *n);
	}
	return ids;
}

/**
 * ec_eoe_ids_find() - a slave by its device number
 * @ids: slaves in the order of device numbers
 * @n: how many
 * @device: device number
 *
 * Context: Any.
 * Return: slave; NULL: it is not among them.
 */
const struct ec_eoe_id *ec_eoe_ids_find(const struct ec_eoe_id *ids, unsigned int n, u64 device)
{
	const struct ec_eoe_id key = { .device = device };

	return bsearch(&key, ids, n, sizeof(*ids), by_device);
}

/**
 * ec_eoe_ids_first() - where slaves that may be the same begin
 * @ids: slaves after ec_eoe_ids_by_unit()
 * @n: how many
 * @id: slave that is sought
 *
 * Context: Any.
 * Return: index of the first one, or of the next other one; @n: there is none behind.
 */
unsigned int ec_eoe_ids_first(const struct ec_eoe_id *ids, unsigned int n,
			      const struct ec_eoe_id *id)
{
	unsigned int low = 0, high = n, mid;

	while (low < high) {
		mid = low + (high - low) / 2;
		if (by_unit(&ids[mid], id) < 0)
			low = mid + 1;
		else
			high = mid;
	}
	return low;
}

/**
 * ec_eoe_ids_same() - may two be the same slave?
 * @a: slave
 * @b: slave, read at another time
 *
 * One that was without power may come with a new device number, but has its alias or serial
 * number; one without both is known by its place alone.
 *
 * Context: Any.
 * Return: whether they may.
 */
bool ec_eoe_ids_same(const struct ec_eoe_id *a, const struct ec_eoe_id *b)
{
	return !by_unit(a, b);
}
