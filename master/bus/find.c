// SPDX-License-Identifier: GPL-2.0-only
#include "find.h"
#include "known.h"
#include "ring_place.h"
#include "slave.h"

#define WALK	64	/* slaves to check without a pause */

/* Does @a have a value in a field that its kind does not use? */
static bool has_more(const struct ec_ioc_address *a)
{
	struct ec_ioc_address rest = *a;

	rest.kind = 0;
	switch (a->kind) {
	case EC_ADDRESS_ALIAS:
		rest.alias = 0;
		fallthrough;
	case EC_ADDRESS_POSITION:
		rest.position = 0;
		break;
	case EC_ADDRESS_STATION:
		rest.station = 0;
		break;
	case EC_ADDRESS_DEVICE:
		rest.device = 0;
		break;
	}
	return memchr_inv(&rest, 0, sizeof(rest));
}

/**
 * ec_find_check() - is an address one that this module knows?
 * @a: address
 * @why: result: why not
 *
 * Context: Any.
 * Return: 0; -EOPNOTSUPP an unknown kind, or fields that a later version may know; -EINVAL.
 */
int ec_find_check(const struct ec_ioc_address *a, const char **why)
{
	*why = "unknown kind of address; this module knows ring position, alias and offset, station address and device number";
	if (a->kind > EC_ADDRESS_DEVICE)
		return -EOPNOTSUPP;
	*why = "the address has an identification, port or reserved bytes, which this module does not know";
	if (a->identification || a->port || memchr_inv(a->reserved, 0, sizeof(a->reserved)))
		return -EOPNOTSUPP;
	*why = "the address has a value in a field that its kind does not use; set these fields to 0";
	if (has_more(a))
		return -EINVAL;
	*why = "alias 0 is no alias; use the ring position";
	return a->kind == EC_ADDRESS_ALIAS && !a->alias ? -EINVAL : 0;
}

static struct ec_slave *at(const struct ec_bus *bus, u32 position)
{
	return position < bus->n_slaves ? bus->slaves[position] : NULL;
}

static bool matches(const struct ec_slave *s, const struct ec_ioc_address *a)
{
	return a->kind == EC_ADDRESS_ALIAS ? s->alias == a->alias : s->station == a->station;
}

/**
 * ec_find_slave() - look for the slave that an address names
 * @bus: bus
 * @a: address, checked by ec_find_check()
 * @from: ring position to continue from, initially 0; 0 again when the list has changed
 * @slave: result: NULL there is none
 *
 * Checks some slaves only, as a section of a reader is short.
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: 0; -EAGAIN: call again.
 */
int ec_find_slave(const struct ec_bus *bus, const struct ec_ioc_address *a, unsigned int *from,
		  struct ec_slave **slave)
{
	unsigned int end = min(bus->n_slaves, *from + WALK);

	ec_bus_assert_stays(bus);
	*slave = NULL;
	if (a->kind == EC_ADDRESS_POSITION)
		*slave = at(bus, a->position);
	else if (a->kind == EC_ADDRESS_DEVICE)
		*slave = ec_known_slave(bus, a->device);
	if (a->kind == EC_ADDRESS_POSITION || a->kind == EC_ADDRESS_DEVICE)
		return 0;
	for (; *from < end; ++*from) {
		if (!matches(bus->slaves[*from], a))
			continue;
		*slave = at(bus, *from + (a->kind == EC_ADDRESS_ALIAS ? a->position : 0));
		return 0;
	}
	return end < bus->n_slaves ? -EAGAIN : 0;
}

/**
 * ec_find_alias() - look for the first slave with an alias
 * @bus: bus
 * @alias: alias, not 0
 *
 * Checks all slaves: not for a section of a reader.
 *
 * Context: Process, topo held.
 * Return: its ring position; the number of slaves: there is none.
 */
unsigned int ec_find_alias(const struct ec_bus *bus, u16 alias)
{
	unsigned int i = 0;

	lockdep_assert_held(&bus->topo);
	while (i < bus->n_slaves && bus->slaves[i]->alias != alias)
		i++;
	return i;
}

/**
 * ec_find_place() - the ring position that alias and offset mean
 * @bus: bus
 * @alias: alias, 0: @position is that in the ring
 * @alias_at: what ec_find_alias() has found for it; the list may have changed since
 * @position: slaves after the one with the alias
 * @place: result, also when the ring ends before it
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: false: no slave with the alias is at @alias_at.
 */
bool ec_find_place(const struct ec_bus *bus, u16 alias, unsigned int alias_at, u16 position,
		   unsigned int *place)
{
	ec_bus_assert_stays(bus);
	*place = position;
	if (!alias)
		return true;
	*place += ec_ring_places_of(bus, alias_at);
	return alias_at < bus->n_slaves && bus->slaves[alias_at]->alias == alias;
}

/**
 * ec_find_index() - the place in the list that alias and offset mean
 * @bus: bus
 * @alias: as for ec_find_place()
 * @alias_at: likewise
 * @position: likewise
 * @total: slaves of a closed ring, by its configurations
 *
 * An offset counts slaves of the closed ring as well, so it matters whether the ring is open
 * between the two.
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: index, also behind the end of the list; -ENOENT or -EAGAIN as ec_ring_places_find().
 */
int ec_find_index(const struct ec_bus *bus, u16 alias, unsigned int alias_at, u16 position,
		  unsigned int total)
{
	unsigned int place;

	ec_bus_assert_stays(bus);
	if (!ec_find_place(bus, alias, alias_at, position, &place))
		return -ENOENT;
	if (alias && !ec_ring_places_open_between(bus, alias_at, alias_at + position))
		return alias_at + position;
	return ec_ring_places_find(bus, place, total);
}

/**
 * ec_find_slave_at() - the slave that alias and offset mean
 * @bus: bus
 * @alias: alias, 0: @position is that in the ring
 * @position: slaves after the one with the alias
 * @total: as for ec_find_index()
 *
 * Context: Process, topo held.
 * Return: the slave, in a ring the one of that place of the list if that is not certain; or NULL.
 */
struct ec_slave *ec_find_slave_at(const struct ec_bus *bus, u16 alias, u16 position,
				  unsigned int total)
{
	unsigned int alias_at = alias ? ec_find_alias(bus, alias) : 0;
	int i = ec_find_index(bus, alias, alias_at, position, total);

	lockdep_assert_held(&bus->topo);
	if (i == -EAGAIN)
		i = alias_at + position;
	return i < 0 ? NULL : at(bus, i);
}

/**
 * ec_find_group() - alias and offset by which a slave is known: of the nearest slave upstream
 * @slave: slave of the list
 * @steps: positions that were checked, initially 0
 * @alias: result: alias of the slave or of the nearest one before it that has one, 0: none has
 * @distance: result: slaves from that one on; without alias the ring position
 *
 * Checks some slaves only, as a section of a reader is short.
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: 0; -EAGAIN: call again.
 */
int ec_find_group(const struct ec_slave *slave, u32 *steps, u16 *alias, u16 *distance)
{
	const struct ec_bus *bus = slave->bus;
	u32 end = min_t(u32, *steps + WALK, slave->position + 1);

	ec_bus_assert_stays(bus);
	*alias = 0;
	*distance = slave->position;
	for (; *steps < end; ++*steps) {
		const struct ec_slave *s = at(bus, slave->position - *steps);

		/* it may have been disconnected since, behind the end of the list */
		if (!s || !s->alias)
			continue;
		*alias = s->alias;
		*distance = *steps;
		return 0;
	}
	return end <= slave->position ? -EAGAIN : 0;
}

/**
 * ec_find_text() - why an address names no slave
 * @bus: bus
 * @a: address for which ec_find_slave() has found none
 * @buf: result
 * @size: of @buf
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: length of the text.
 */
size_t ec_find_text(const struct ec_bus *bus, const struct ec_ioc_address *a, char *buf,
		    size_t size)
{
	ec_bus_assert_stays(bus);
	switch (a->kind) {
	case EC_ADDRESS_ALIAS:
		return scnprintf(buf, size,
				 "no slave %u after the first one with alias %u; 'ethercat slaves' lists %u",
				 a->position, a->alias, bus->n_slaves);
	case EC_ADDRESS_STATION:
		return scnprintf(buf, size,
				 "no slave has station address 0x%04x; 'ethercat slaves -v' lists them",
				 a->station);
	case EC_ADDRESS_DEVICE:
		return ec_known_text(bus, a->device, buf, size);
	default:
		return scnprintf(buf, size, "no slave at position %u; 'ethercat slaves' lists %u",
				 a->position, bus->n_slaves);
	}
}
