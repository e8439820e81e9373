// SPDX-License-Identifier: GPL-2.0-only
/*
 * A slave that got an address meant for another one gets its own back, even if it is cut off before
 * it can: until it has accepted that, another slave replies there, or some seconds have passed.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "graph.h"
#include "known.h"
#include "owed.h"
#include "slave.h"

#define TRIES		3
#define LATEST_NS	(10ULL * NSEC_PER_SEC)

/**
 * ec_owed_note() - a slave has to get its station address back
 * @bus: bus
 * @has: address that it has
 * @own: its own
 *
 * Without memory it is found as a new slave.
 *
 * Context: The monitor thread. May sleep.
 */
void ec_owed_note(struct ec_bus *bus, u16 has, u16 own)
{
	struct ec_owed owed = { .since_ns = ktime_get_ns(), .has = has, .own = own }, *more;
	unsigned int i;

	for (i = 0; i < bus->n_owed && bus->owed[i].own != own; i++)
		;
	if (i == bus->n_owed) {
		more = krealloc_array(bus->owed, i + 1, sizeof(*more), GFP_KERNEL | __GFP_NOWARN);
		if (!more)
			return;
		bus->owed = more;
		bus->n_owed++;
	}
	bus->owed[i] = owed;
}

/**
 * ec_owed_has_lost() - has a slave of the list lost its station address?
 * @s: slave
 * @own: read of a register at its address
 * @up: read of the DL status of the slave at which it hangs; that without one: any
 * @dl: result of @up
 *
 * Context: The monitor thread.
 * Return: whether it does not reply, although the port at which it hangs is open.
 */
bool ec_owed_has_lost(const struct ec_slave *s, const struct ec_dg *own, const struct ec_dg *up,
		      const u8 *dl)
{
	if (own->err || own->wkc)
		return false;
	return !ec_graph_parent(s) ||
	       (!up->err && up->wkc == 1 &&
		ec_graph_open_ports(get_unaligned_le16(dl)) & BIT(s->graph.parent_port));
}

/**
 * ec_owed_find() - slaves of the list that have lost their station addresses
 * @bus: bus
 * @found: result, in ring order
 * @max: entries in @found
 *
 * They do not reply there, although the port at which they hang is open.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: how many there are.
 */
unsigned int ec_owed_find(struct ec_bus *bus, const struct ec_slave **found, unsigned int max)
{
	struct ec_dg *dg = kvcalloc(bus->n_slaves, sizeof(*dg), GFP_KERNEL);
	u8 (*dl)[2] = kvcalloc(bus->n_slaves, sizeof(*dl), GFP_KERNEL);
	bool *lost = kvcalloc(bus->n_slaves, sizeof(*lost), GFP_KERNEL);
	unsigned int n = 0;

	if (!dg || !dl || !lost)
		goto out;
	ec_for_each_slave(s, bus)
		dg[s->position] = EC_FPRD(s->station, EC_REG_DL_STATUS, 2, dl[s->position]);
	ec_xfer(bus->links, dg, bus->n_slaves);
	ec_for_each_slave(s, bus) {
		const struct ec_slave *u = ec_graph_parent(s);
		const struct ec_dg *d = &dg[s->position];

		if (!d->err && d->wkc == 1)
			s->dl_seen = get_unaligned_le16(dl[s->position]);
		if (READ_ONCE(s->reply.silent))
			continue;
		/* nothing says whether the port of one that has lost its own is open */
		if (u && lost[u->position] ? d->err || d->wkc :
		    !ec_owed_has_lost(s, d, u ? &dg[u->position] : NULL,
				      u ? dl[u->position] : NULL))
			continue;
		lost[s->position] = true;
		if (n < max)
			found[n] = s;
		n++;
	}
out:
	kvfree(dg);
	kvfree(dl);
	kvfree(lost);
	return n;
}

/* The only slave of the list with that address of its first FMMU, or NULL */
static const struct ec_slave *mapped_at(struct ec_bus *bus, u32 logical)
{
	const struct ec_slave *found = NULL;

	ec_for_each_slave(s, bus) {
		if (READ_ONCE(s->work.mapped) != logical + 1)
			continue;
		if (found)
			return NULL;
		found = s;
	}
	return found;
}

/* read from a slave, and whether one replies at the address that it may have lost */
struct owed_look {
	u8 fmmu[EC_FMMU_PAGE];
	u8 al[2];
	u8 own[2];
};

/*
 * Does a slave run as @s did, with the same process data? No device that was let in nowhere does,
 * nor does another slave with process data, also if it is identical.
 */
static bool runs_as(const struct ec_slave *s, const struct owed_look *k)
{
	u32 mapped = k->fmmu[EC_FMMU_OFS_ENABLE] & 1 ? get_unaligned_le32(k->fmmu) + 1 : 0;
	u16 is = READ_ONCE(s->al.status);

	return is & EC_AL_BEYOND_PREOP && get_unaligned_le16(k->al) == is &&
	       mapped == READ_ONCE(s->work.mapped);
}

static void look_add(struct ec_dg *dg, struct owed_look *k, u16 station)
{
	dg[0] = EC_FPRD(station, EC_REG_FMMU(0), EC_FMMU_PAGE, k->fmmu);
	dg[1] = EC_FPRD(station, EC_REG_AL_STATUS, 2, k->al);
}

static bool has_looked(const struct ec_dg *dg)
{
	return !dg[0].err && dg[0].wkc == 1 && !dg[1].err && dg[1].wkc == 1;
}

static const struct ec_slave *mapped_as(struct ec_bus *bus, const struct ec_dg *dg,
					const struct owed_look *k)
{
	const struct ec_slave *s;

	if (!has_looked(dg) || !(k->fmmu[EC_FMMU_OFS_ENABLE] & 1))
		return NULL;
	s = mapped_at(bus, get_unaligned_le32(k->fmmu));
	return s && runs_as(s, k) ? s : NULL;
}

/**
 * ec_owed_by_fmmu() - find slaves that have lost their addresses by their first FMMUs
 * @bus: bus
 * @station: station addresses that slaves have by now
 * @n: how many
 * @owner: result for each: the slave of the list which that is, and which does not reply at its own
 * address; NULL: there is none
 *
 * No two slaves of a session have the same logical address there. The slave was made harmless when
 * it came, so it has no FMMU of another master. All are asked at a time, as each of them is missing
 * from the process of the application.
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_owed_by_fmmu(struct ec_bus *bus, const u16 *station, unsigned int n,
		     const struct ec_slave **owner)
{
	struct ec_dg *dg = kvcalloc(n, 2 * sizeof(*dg), GFP_KERNEL);
	struct owed_look *look = kvcalloc(n, sizeof(*look), GFP_KERNEL);
	unsigned int i, m = 0;

	memset(owner, 0, n * sizeof(*owner));
	if (!dg || !look)
		goto out;
	for (i = 0; i < n; i++)
		look_add(&dg[2 * i], &look[i], station[i]);
	ec_xfer(bus->links, dg, 2 * n);
	for (i = 0; i < n; i++)
		owner[i] = mapped_as(bus, &dg[2 * i], &look[i]);
	for (i = 0; i < n; i++)
		if (owner[i])
			dg[m++] = EC_FPRD(owner[i]->station, EC_REG_STATION, 2, look[i].own);
	if (m)
		ec_xfer(bus->links, dg, m);
	while (n--)
		if (owner[n] && dg[--m].wkc)
			owner[n] = NULL;
out:
	kvfree(dg);
	kvfree(look);
}

/**
 * ec_owed_runs_as() - may a slave be another one by its state, above PREOP, and its process data?
 * @bus: bus
 * @station: station address of the slave
 * @s: the other one
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether it may; false: also when nothing can be read.
 */
bool ec_owed_runs_as(struct ec_bus *bus, u16 station, const struct ec_slave *s)
{
	struct owed_look look;
	struct ec_dg dg[2];

	look_add(dg, &look, station);
	return !ec_xfer(bus->links, dg, 2) && has_looked(dg) && runs_as(s, &look);
}

/* Of those that were tried before, the ones at whose own address no slave replies by now. */
static void owed_sift(struct ec_bus *bus, struct ec_dg *dg, u8 (*station)[2])
{
	unsigned int i, n = bus->n_owed;
	u64 now = ktime_get_ns();

	for (i = 0; i < n; i++)
		dg[i] = EC_FPRD(bus->owed[i].own, EC_REG_STATION, 2, station[i]);
	ec_xfer(bus->links, dg, n);
	bus->n_owed = 0;
	for (i = 0; i < n; i++)
		if (!bus->owed[i].tried ||
		    ((dg[i].err || !dg[i].wkc) && now - bus->owed[i].since_ns < LATEST_NS &&
		     ec_known_is_present(bus, bus->owed[i].own)))
			bus->owed[bus->n_owed++] = bus->owed[i];
}

static void owed_write(struct ec_bus *bus, struct ec_dg *dg, u8 (*station)[2])
{
	unsigned int i, n = bus->n_owed;

	for (i = 0; i < n; i++) {
		put_unaligned_le16(bus->owed[i].own, station[i]);
		dg[i] = EC_FPWR(bus->owed[i].has, EC_REG_STATION, 2, station[i]);
	}
	ec_xfer(bus->links, dg, n);
	bus->n_owed = 0;
	for (i = 0; i < n; i++)
		if (dg[i].err || !dg[i].wkc) {
			bus->owed[i].tried = true;
			bus->owed[bus->n_owed++] = bus->owed[i];
		}
}

/**
 * ec_owed_pay() - give slaves their station addresses back
 * @bus: bus
 *
 * Context: The monitor thread. May sleep; waits for bus traffic if there are such slaves.
 * Return: whether all of them have it now.
 */
bool ec_owed_pay(struct ec_bus *bus)
{
	u8 (*station)[2];
	struct ec_dg *dg;
	unsigned int i;

	if (!bus->n_owed)
		return true;
	dg = kvcalloc(bus->n_owed, sizeof(*dg), GFP_KERNEL);
	station = kvcalloc(bus->n_owed, sizeof(*station), GFP_KERNEL);
	if (dg && station) {
		for (i = 0; i < bus->n_owed && !bus->owed[i].tried; i++)
			;
		if (i < bus->n_owed)
			owed_sift(bus, dg, station);
		for (i = 0; i < TRIES && bus->n_owed; i++)
			owed_write(bus, dg, station);
	}
	kvfree(dg);
	kvfree(station);
	return !bus->n_owed;
}

/**
 * ec_owed_exit() - forget such slaves
 * @bus: bus without a monitor
 *
 * Context: Any.
 */
void ec_owed_exit(struct ec_bus *bus)
{
	kfree(bus->owed);
	bus->owed = NULL;
	bus->n_owed = 0;
}
