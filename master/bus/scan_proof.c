// SPDX-License-Identifier: GPL-2.0-only
/*
 * A scan takes many frames. Its result is valid only if the bus was the same all the time: else
 * it may be a list of slaves that never existed, in which one is missing that never left.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "scan_int.h"

/* link, loop and communication of all ports */
#define PORTS	0xfff0

/* scans in a row that are thrown away because of a slave that contradicts itself, at most */
#define NEW_MAX		5	/* one that is new, or its ports */
#define KNOWN_MAX	20

/* what contradicts the result of the scan */
enum doubt {
	NONE,
	NEW,		/* a slave that was not known, or a port */
	KNOWN,		/* a known slave: it is in another place, or not lost */
};

/* replies to the reads of the proof */
struct reply {
	u8 station[2];
	u8 dl[2];
};

/**
 * ec_scan_same_count() - is the number of slaves still the same?
 * @bus: bus
 * @n: slaves the scan began with
 *
 * Context: Process. Waits for bus traffic.
 * Return: whether it is.
 */
bool ec_scan_same_count(struct ec_bus *bus, unsigned int n)
{
	u8 type[1] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, type);

	return !ec_xfer(bus->links, &dg, 1) && dg.back == (u16)n;
}

static bool is_listed(const struct scan *sc, const struct ec_slave *s)
{
	unsigned int i;

	/* almost always it is where it was, or not far from there */
	if (s->position < sc->n && sc->slaves[s->position] == s)
		return true;
	for (i = 0; i < sc->n; i++)
		if (sc->slaves[i] == s)
			return true;
	return false;
}

/* Address and ports of the slave at @i; a known one that fell silent does not reply. */
static enum doubt scan_proof_check(const struct scan *sc, unsigned int i, const struct ec_dg *dg,
				   const struct reply *r)
{
	const struct ec_slave *s = sc->slaves[i];
	bool known = ec_scan_is_known(sc, s);
	u16 changed = get_unaligned_le16(r->dl) ^ get_unaligned_le16(sc->regs[i].dl);

	if (known && !sc->regs[i].there)
		return dg[1].wkc ? KNOWN : NONE;
	/* unless it failed because it has lost its address: power was off for a moment */
	if (!known && READ_ONCE(s->error) == EC_SLAVE_SCAN_FAILED)
		return dg[0].wkc == 1 && get_unaligned_le16(r->station) != s->station ? NEW : NONE;
	if (dg[0].wkc != 1 || get_unaligned_le16(r->station) != s->station || dg[1].wkc != 1)
		return known ? KNOWN : NEW;
	return changed & PORTS ? NEW : NONE;
}

/* Slaves that this scan has not found: none of them replies. */
static int check_lost(struct scan *sc, enum doubt *doubt)
{
	struct ec_bus *bus = sc->bus;
	struct ec_dg *dg;
	unsigned int i, n = 0;
	u8 (*v)[2];
	int ret = 0;

	dg = kvcalloc(bus->n_slaves + 1, sizeof(*dg), GFP_KERNEL);
	v = kvcalloc(bus->n_slaves + 1, sizeof(*v), GFP_KERNEL);
	if (!dg || !v) {
		ret = -ENOMEM;
		goto out;
	}
	ec_for_each_slave(s, bus) {
		/* its address may be that of another one */
		if (sc->claims[s->station] || is_listed(sc, s))
			continue;
		dg[n] = EC_FPRD(s->station, EC_REG_STATION, 2, v[n]);
		n++;
	}
	if (n)
		ret = ec_xfer(bus->links, dg, n);
	for (i = 0; i < n && !ret; i++)
		if (dg[i].wkc)
			*doubt = KNOWN;
out:
	kvfree(dg);
	kvfree(v);
	return ret;
}

static int check_found(struct scan *sc, enum doubt *doubt)
{
	struct reply *r = kvcalloc(sc->n, sizeof(*r), GFP_KERNEL);
	unsigned int i;
	int ret;

	if (!r)
		return -ENOMEM;
	for (i = 0; i < sc->n; i++) {
		sc->dg[2 * i] = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_STATION, 2, r[i].station);
		sc->dg[2 * i + 1] = EC_FPRD(sc->slaves[i]->station, EC_REG_DL_STATUS, 2, r[i].dl);
	}
	ret = ec_xfer(sc->bus->links, sc->dg, 2 * sc->n);
	for (i = 0; i < sc->n && !ret; i++)
		*doubt = max(*doubt, scan_proof_check(sc, i, &sc->dg[2 * i], &r[i]));
	kvfree(r);
	return ret;
}

/**
 * ec_scan_proof() - is the bus what the scan has found?
 * @sc: scan that has read everything
 *
 * A slave that contradicts itself all the time must not keep the others from being used.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN when the result has to be thrown away; -ENOMEM; or as ec_xfer().
 */
int ec_scan_proof(struct scan *sc)
{
	struct ec_bus *bus = sc->bus;
	enum doubt doubt = NONE;
	int ret;

	/* an empty list needs no check of the bus */
	if (!sc->n)
		return 0;
	ret = check_found(sc, &doubt) ?: check_lost(sc, &doubt);
	if (ret)
		return ret;
	if (!ec_scan_same_count(bus, sc->n))
		return -EAGAIN;
	if (!doubt || bus->thrown_away >= (doubt == NEW ? NEW_MAX : KNOWN_MAX)) {
		bus->thrown_away = 0;
		return 0;
	}
	bus->thrown_away++;
	return -EAGAIN;
}
