// SPDX-License-Identifier: GPL-2.0-only
/*
 * Station addresses: which of the slaves on the bus are known, and which address the others get.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "known.h"
#include "owed.h"
#include "scan_address.h"
#include "scan_int.h"
#include "scan_station.h"

#define NO_STATION	0xffff	/* the clocks use it for "no slave" */

/**
 * struct rows - where the known slaves are in the ring, seen from both ends
 * @front: from the first position on, slaves with the addresses of the last scan
 * @back: likewise up to the last position
 */
struct rows {
	unsigned int front;
	unsigned int back;
};

/* Addresses of all; a slave that does not answer may be a known one that fell silent. */
static int read_stations(struct scan *sc)
{
	unsigned int i;
	int ret;

	for (i = 0; i < sc->n; i++)
		sc->dg[i] = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_STATION, 4, sc->regs[i].station);
	ret = ec_xfer(sc->bus->links, sc->dg, sc->n);
	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].there = sc->dg[i].wkc == 1;
	return ret;
}

static int index_known(struct scan *sc)
{
	sc->known = kvcalloc(EC_MAX_SLAVES + 1, sizeof(*sc->known), GFP_KERNEL);
	sc->claims = kvzalloc(EC_MAX_SLAVES + 1, GFP_KERNEL);
	sc->aliases = kvcalloc(EC_MAX_SLAVES + 1, sizeof(*sc->aliases), GFP_KERNEL);
	if (!sc->known || !sc->claims || !sc->aliases)
		return -ENOMEM;
	ec_for_each_slave(s, sc->bus)
		sc->known[s->station] = s;
	return 0;
}

/* How many slaves have each address now, up to 2. */
static void count_claims(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		u8 *c = &sc->claims[ec_scan_address(sc, i)];

		if (sc->regs[i].there)
			*c = min(*c + 1, 2);
	}
}

static bool is_at(const struct scan *sc, unsigned int i, const struct ec_slave *s)
{
	return sc->regs[i].there && ec_scan_address(sc, i) == s->station;
}

static struct rows find_rows(const struct scan *sc)
{
	const struct ec_bus *bus = sc->bus;
	unsigned int n = min(sc->n, bus->n_slaves);
	struct rows r = { 0 };

	while (r.front < n && is_at(sc, r.front, bus->slaves[r.front]))
		r.front++;
	while (r.back < n &&
	       is_at(sc, sc->n - 1 - r.back, bus->slaves[bus->n_slaves - 1 - r.back]))
		r.back++;
	return r;
}

/* The known slave that is at @i if only slaves after it were connected or disconnected. */
static struct ec_slave *from_front(const struct scan *sc, unsigned int i)
{
	return i < sc->bus->n_slaves ? sc->bus->slaves[i] : NULL;
}

/* Likewise, slaves before it. */
static struct ec_slave *from_back(const struct scan *sc, unsigned int i)
{
	unsigned int after = sc->n - i;

	return after <= sc->bus->n_slaves ? sc->bus->slaves[sc->bus->n_slaves - after] : NULL;
}

/* Does the slave at @i show the AL state that @s has, as far as the master knows? */
static bool same_state(const struct scan *sc, unsigned int i, const struct ec_slave *s)
{
	u8 al[2];
	struct ec_dg dg = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_AL_STATUS, 2, al);

	return !ec_xfer(sc->bus->links, &dg, 1) && dg.wkc == 1 &&
	       get_unaligned_le16(al) == READ_ONCE(s->al.status);
}

/*
 * Of two slaves with the address of @s one was at another master. It is not the one at @i if that
 * is in the place of @s, seen from one end. Seen from either end another one is in its place when
 * the two are neighbors; then the AL state decides.
 */
static bool owns_station(const struct scan *sc, unsigned int i, const struct ec_slave *s,
			 const struct rows *r)
{
	bool front = i < r->front && from_front(sc, i) == s;
	bool back = sc->n - i <= r->back && from_back(sc, i) == s;
	bool other;

	if (sc->claims[s->station] == 1)
		return true;
	if (!front && !back)
		return false;
	if (front && back)
		return true;
	other = front ? sc->bus->n_slaves - s->position <= r->back : s->position < r->front;
	if (!other)
		return true;
	return same_state(sc, i, s) &&
	       !same_state(sc, front ? sc->n - (sc->bus->n_slaves - s->position) : s->position, s);
}

/*
 * A slave that failed in a scan is read again, an attached one that refused a state is not. One
 * whose EEPROM was written is, but not while it runs.
 */
static bool is_usable(const struct ec_slave *s)
{
	u8 error = READ_ONCE(s->note.error);

	if (READ_ONCE(s->work.renew) && !(READ_ONCE(s->al.status) & EC_AL_BEYOND_PREOP))
		return false;
	return s->eeprom.data && (!error || READ_ONCE(s->reply.silent) ||
				  (error == EC_SLAVE_CONFIG_FAILED && s->bus->ops &&
				   s->bus->ops->attached && s->bus->ops->attached(s)));
}

/*
 * The known slave at @i that does not reply: the slaves before it are the same as in the
 * list, and no slave has its address.
 */
static struct ec_slave *fell_silent(const struct scan *sc, unsigned int i, bool same_before)
{
	struct ec_slave *s = from_front(sc, i);

	if (!s || sc->regs[i].there || !same_before || sc->claims[s->station])
		return NULL;
	return READ_ONCE(s->reply.silent) ||
	       (s->eeprom.data && READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED) ? s : NULL;
}

/**
 * ec_scan_unreadable() - find the slave that could not be read where it was
 * @bus: bus
 * @i: ring position
 *
 * Context: The monitor thread.
 * Return: that slave, or NULL.
 */
const struct ec_slave *ec_scan_unreadable(const struct ec_bus *bus, unsigned int i)
{
	const struct ec_slave *s = i < bus->n_slaves ? bus->slaves[i] : NULL;

	return s && READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED &&
	       !READ_ONCE(s->reply.silent) ? s : NULL;
}

/* What was read of the EEPROM by the scan before. */
static void scan_station_take_part(struct ec_slave *s, struct ec_slave *old)
{
	swap(s->eeprom.part, old->eeprom.part);
	swap(s->eeprom.part_bytes, old->eeprom.part_bytes);
	if (s->eeprom.part)
		swap(s->eeprom.counted, old->eeprom.counted);
}

/*
 * The slave at @i, if it is one that could not be read before: by its address. By its place only if
 * no slave of the list has that, and the one of that place replies nowhere else.
 */
static const struct ec_slave *unread_before(const struct scan *sc, unsigned int i)
{
	const struct ec_slave *s = sc->known[ec_scan_address(sc, i)];

	if (!s || !is_at(sc, i, s)) {
		const struct ec_slave *there = ec_scan_unreadable(sc->bus, i);

		return there && !sc->claims[there->station] ? there : NULL;
	}
	return sc->claims[s->station] == 1 ? ec_scan_unreadable(sc->bus, s->position) : NULL;
}

/* If a slave could not be read before, keep its cause, which is logged once, and its tries. */
static void take_failure(struct ec_slave *s, const struct ec_slave *old)
{
	if (!old)
		return;
	strscpy(s->note.why, old->note.why, sizeof(s->note.why));
	s->note.cause = old->note.cause;
	s->device = old->device;
	s->reply.retry_ms = old->reply.retry_ms;
}

/* Given by a scan that was thrown away. */
static bool was_tried(const struct ec_bus *bus, u16 station)
{
	return (u16)(station - bus->listed_station - 1) <
	       (u16)(bus->next_station - bus->listed_station);
}

/* It may have been passed over when addresses were read. */
static bool replies_itself(const struct scan *sc, const struct ec_slave *s)
{
	u8 station[2];
	struct ec_dg dg = EC_FPRD(s->station, EC_REG_STATION, 2, station);

	return ec_xfer(sc->bus->links, &dg, 1) || dg.wkc;
}

/* May the slave at @i, with an address that was meant for another one, be @s as that ran? */
static bool may_be(const struct scan *sc, unsigned int i, const struct ec_slave *s)
{
	return s && !sc->claims[s->station] && is_usable(s) &&
	       ec_owed_runs_as(sc->bus, ec_scan_address(sc, i), s) && !replies_itself(sc, s);
}

/* The slave at @i is @s; returns whether it has accepted its address. */
static bool restore_station(struct scan *sc, unsigned int i, const struct ec_slave *s)
{
	u16 station = ec_scan_address(sc, i);

	put_unaligned_le16(s->station, sc->regs[i].station);
	sc->claims[s->station] = 1;
	return !ec_xfer_fpwr(sc->bus->links, station, EC_REG_STATION, sc->regs[i].station, 2);
}

/* The slave at @i has an address that was meant for another one, and is in no list. */
static bool has_tried(const struct scan *sc, unsigned int i)
{
	u16 station = ec_scan_address(sc, i);

	return sc->regs[i].there && sc->claims[station] == 1 && !sc->known[station] &&
	       was_tried(sc->bus, station);
}

/* Does a slave with process data not reply at its address? */
static bool misses_mapped(const struct scan *sc)
{
	ec_for_each_slave(s, sc->bus)
		if (READ_ONCE(s->work.mapped) && !sc->claims[s->station])
			return true;
	return false;
}

/* Known slaves with such addresses get their own back, wherever they are: by their FMMUs. */
static void restore_mapped(struct scan *sc)
{
	const struct ec_slave **owner = kvcalloc(sc->n, sizeof(*owner), GFP_KERNEL);
	u16 *used = kvcalloc(sc->n, sizeof(*used), GFP_KERNEL);
	unsigned int i, k = 0;

	if (!owner || !used || !misses_mapped(sc))
		goto out;
	for (i = 0; i < sc->n; i++) {
		if (!has_tried(sc, i))
			continue;
		sc->who[k] = i;
		used[k++] = ec_scan_address(sc, i);
	}
	if (k)
		ec_owed_by_fmmu(sc->bus, used, k, owner);
	for (i = 0; i < k; i++)
		if (owner[i] && !sc->claims[owner[i]->station])
			restore_station(sc, sc->who[i], owner[i]);
out:
	kvfree(owner);
	kvfree(used);
}

/* The known slave that follows in the list on the one at @i - 1, if that is certain. */
static struct ec_slave *next_of_before(const struct scan *sc, unsigned int i)
{
	const struct ec_slave *s = i ? sc->known[ec_scan_address(sc, i - 1)] : NULL;

	if (i && (!s || !is_at(sc, i - 1, s) || sc->claims[s->station] != 1))
		return NULL;
	return from_front(sc, s ? s->position + 1 : 0);
}

/* Likewise the one before that at @i + 1. */
static struct ec_slave *last_before_next(const struct scan *sc, unsigned int i)
{
	const struct ec_slave *s;

	if (i + 1 == sc->n)
		return from_back(sc, i);
	s = sc->known[ec_scan_address(sc, i + 1)];
	if (!s || !is_at(sc, i + 1, s) || sc->claims[s->station] != 1 || !s->position)
		return NULL;
	return from_front(sc, s->position - 1);
}

/*
 * A known slave has got the address of another one in a scan that was thrown away. It gets its own
 * back if it is beside a slave that was its neighbor in the ring, and in a state that no new slave
 * has. Returns whether it has it.
 */
static bool restore(struct scan *sc, unsigned int i)
{
	struct ec_slave *a, *b;

	if (!has_tried(sc, i))
		return false;
	a = next_of_before(sc, i);
	b = last_before_next(sc, i);
	a = may_be(sc, i, a) ? a : NULL;
	b = b != a && may_be(sc, i, b) ? b : NULL;
	/* one of two */
	if (a && b)
		return false;
	return (a || b) && restore_station(sc, i, a ?: b);
}

/* One that has its own back says what is beside it. */
static void restore_neighbors(struct scan *sc)
{
	bool more = true;
	unsigned int i;

	while (more)
		for (more = false, i = 0; i < sc->n; i++)
			more |= restore(sc, i);
}

/*
 * The slave at @i has an address of its own, at which it has replied up to now: also if its EEPROM
 * could not be read. With another address it would be another device.
 */
static bool is_addressed(const struct scan *sc, unsigned int i, const struct ec_slave *unread)
{
	u16 station = ec_scan_address(sc, i);

	return !sc->fresh && sc->regs[i].there && station && station != NO_STATION &&
	       sc->claims[station] == 1 &&
	       (!unread || (unread->station == station &&
			    unread->note.cause.kind != EC_CAUSE_REGISTERS));
}

static bool has_alias_of(const struct scan *sc, unsigned int i, const struct ec_slave *s)
{
	return get_unaligned_le16(sc->regs[i].station + 2) == READ_ONCE(s->register_alias);
}

/* An unknown slave: it keeps its address if no slave has had that. */
static int scan_station_add(struct scan *sc, unsigned int i, bool *write)
{
	u16 station = ec_scan_address(sc, i), old = station;
	const struct ec_slave *unread = unread_before(sc, i);
	struct ec_slave *known = sc->known[old], *s;
	bool addressed = is_addressed(sc, i, unread);

	*write = !addressed || (known && known != unread);
	sc->regs[i].own = addressed ? old : 0;
	if (*write) {
		station = ec_known_fresh_station(sc->bus, sc->known, sc->claims);
		if (!station)
			return -ENOSPC;
		/* not for another one as well */
		sc->claims[station] = 1;
	}
	s = ec_slave_alloc(sc->bus, station);
	if (!s)
		return -ENOMEM;
	sc->slaves[i] = s;
	s->position = i;
	take_failure(s, unread);
	s->kept_station = sc->regs[i].there && old != NO_STATION && sc->claims[old] == 1 ? old : 0;
	/* by its address it is the same */
	if (known && sc->regs[i].there && sc->claims[old] == 1 && has_alias_of(sc, i, known)) {
		scan_station_take_part(s, known);
		s->found = known->eeprom.data ? known->found : 0;
		s->work.renew = READ_ONCE(known->work.renew);
		if (s->work.renew)
			s->device = known->device;
	}
	WRITE_ONCE(s->register_alias, get_unaligned_le16(sc->regs[i].station + 2));
	sc->regs[i].was = sc->regs[i].there ? old : 0;
	put_unaligned_le16(station, sc->regs[i].station);
	return 0;
}

/*
 * A slave that was connected to another master may have any address, also that of a slave which
 * was disconnected. When the two were exchanged since the last scan, the place is another one.
 */
static bool is_same(const struct scan *sc, unsigned int i, const struct ec_slave *s,
		    const struct rows *r)
{
	return i < r->front || sc->n - i <= r->back || has_alias_of(sc, i, s);
}

/* Which slave of the scan is which known one; returns how many need an address, @at, or -errno. */
static int assign(struct scan *sc, u16 *at)
{
	struct rows r;
	bool same_before = true, write;
	unsigned int i, n = 0;
	int ret;

	restore_neighbors(sc);
	r = find_rows(sc);
	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = fell_silent(sc, i, same_before);

		if (s) {
			sc->slaves[i] = ec_slave_ref(s);
			continue;
		}
		s = sc->known[ec_scan_address(sc, i)];
		if (s && is_usable(s) && sc->regs[i].there && owns_station(sc, i, s, &r) &&
		    is_same(sc, i, s, &r)) {
			sc->slaves[i] = ec_slave_ref(s);
			same_before &= from_front(sc, i) == s;
			continue;
		}
		same_before &= ec_scan_unreadable(sc->bus, i) != NULL;
		ret = scan_station_add(sc, i, &write);
		if (ret)
			return ret;
		at[n] = i;
		n += write;
	}
	return n;
}

/**
 * ec_scan_stations() - find the known slaves, give addresses to the others
 * @sc: scan; @slaves, @known and @claims are set
 *
 * A slave that has kept the address of this master is a known one.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -ENOSPC without a free address; -ENOMEM; or as ec_xfer().
 */
int ec_scan_stations(struct scan *sc)
{
	u16 *at = kvcalloc(sc->n, sizeof(*at), GFP_KERNEL);
	int ret = at ? index_known(sc) : -ENOMEM;

	ret = ret ?: read_stations(sc);
	if (!ret) {
		count_claims(sc);
		restore_mapped(sc);
		ret = assign(sc, at);
	}
	if (ret > 0)
		ret = ec_scan_address_all(sc, at, ret);
	kvfree(at);
	return ret;
}
