// SPDX-License-Identifier: GPL-2.0-only
/*
 * A scan takes many frames. What it has found in a stretch of the ring is valid only if that was
 * the same all the time: else it may be a list of slaves that never existed, in which one is
 * missing that never left. And ports were read after the addresses: a slave that came in between
 * is in no list, but a port leads to it. So ports away from these stretches are taken only if the
 * whole ring was the same.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "graph.h"
#include "ring_ends.h"
#include "scan_count.h"
#include "scan_int.h"
#include "scan_proof.h"

/* scans in a row that are thrown away because of a slave that contradicts itself, at most */
#define NEW_MAX		5	/* one that is new, or its ports */
#define KNOWN_MAX	20
#define FLAPS_MAX	500	/* while slaves come and go, which no one of them can help */

/* what contradicts the result of the scan */
enum doubt {
	NONE,
	NEW,		/* a slave that was not known, or a port */
	KNOWN,		/* a known slave: it is in another place, or not lost */
	UNREAD,		/* the contact was lost before the slave was read */
};

/* replies to the reads of the proof, by ring position */
struct reply {
	u8 station[2];
	u8 dl[2];
};

struct proof {
	struct scan *sc;
	struct reply *r;
	struct ec_dg *dg;	/* by position, and by station address of the slave found there */
	u8 type[1];		/* the last of @dg counts */
};

static bool answers_as(const struct proof *p, unsigned int i, u16 station)
{
	return p->dg[2 * i].wkc == 1 && get_unaligned_le16(p->r[i].station) == station;
}

/*
 * Where the slaves of a stretch are by now: others may have come or gone before it. The slave
 * before it has kept its address; without one, or when it is silent, nothing has moved.
 */
static int moved_by(const struct proof *p, const struct stretch *t)
{
	const struct scan *sc = p->sc;
	unsigned int i, before = t->new - 1;
	u16 station;

	if (!t->new || !sc->regs[before].there)
		return 0;
	station = sc->slaves[before]->station;
	if (answers_as(p, before, station))
		return 0;
	for (i = 0; i < sc->n; i++)
		if (answers_as(p, i, station))
			return (int)i - (int)before;
	return 0;
}

/* Address and ports of slave @i, now at @at; a known one that fell silent does not reply. */
static enum doubt proof_check(const struct proof *p, unsigned int i, unsigned int at)
{
	const struct scan *sc = p->sc;
	const struct ec_slave *s = sc->slaves[i];
	const struct ec_dg *direct = &p->dg[2 * i + 1];
	bool known = ec_scan_is_known(sc, s);
	u16 changed = get_unaligned_le16(p->r[i].dl) ^ get_unaligned_le16(sc->regs[i].dl);

	if (known && !sc->regs[i].there)
		return direct->wkc ? KNOWN : NONE;
	/* unless it failed because it has lost its address: power was off for a moment */
	if (!known && READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
		return p->dg[2 * at].wkc == 1 && !answers_as(p, at, s->station) ? NEW : NONE;
	if (!answers_as(p, at, s->station) || direct->wkc != 1)
		return known ? KNOWN : NEW;
	return changed & EC_SCAN_PORTS ? NEW : NONE;
}

/* The slaves found in @t, and that the one after them comes next. */
static enum doubt check_found(const struct proof *p, const struct stretch *t)
{
	const struct scan *sc = p->sc;
	int by = moved_by(p, t);
	unsigned int i, end = t->new + t->n_new;
	enum doubt doubt = NONE;

	for (i = t->new; i < end; i++) {
		if (sc->regs[i].gone || (int)i + by < 0 || i + by >= sc->n)
			return UNREAD;
		doubt = max(doubt, proof_check(p, i, i + by));
	}
	if (t->n_new && end < sc->n && sc->regs[end].there &&
	    (end + by >= sc->n || !answers_as(p, end + by, sc->slaves[end]->station)))
		doubt = max(doubt, NEW);
	return doubt;
}

/* The reads have cleared the events of the ports. */
static void note_seen(const struct proof *p)
{
	const struct scan *sc = p->sc;
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (!p->dg[2 * i + 1].err && p->dg[2 * i + 1].wkc == 1)
			sc->slaves[i]->dl_seen = get_unaligned_le16(p->r[i].dl);
}

static int ask_found(struct proof *p)
{
	struct scan *sc = p->sc;
	unsigned int i;
	int ret;

	for (i = 0; i < sc->n; i++) {
		p->dg[2 * i] = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_STATION, 2, p->r[i].station);
		p->dg[2 * i + 1] = EC_FPRD(sc->slaves[i]->station, EC_REG_DL_STATUS, 2, p->r[i].dl);
	}
	p->dg[2 * i] = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, p->type);
	ret = ec_xfer(sc->bus->links, p->dg, 2 * sc->n + 1);
	if (!ret)
		ec_scan_see_ring(sc->bus, &p->dg[2 * i], false);
	note_seen(p);
	return ret;
}

/* Have slaves come or gone, or has the break of the ring moved, since the scan began? */
static bool ring_flaps(const struct proof *p)
{
	const struct scan *sc = p->sc;
	const struct ec_dg *count = &p->dg[2 * sc->n];
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (sc->regs[i].gone)
			return true;
	return count->err || count->back != sc->n || sc->bus->links->ring.front != sc->front;
}

/* Each slave is where it was found, with the same ports open. */
static bool ring_stands(const struct proof *p)
{
	const struct scan *sc = p->sc;
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		const struct ec_slave *s = sc->slaves[i];
		const struct regs *r = &sc->regs[i];

		if (!r->there || READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
			continue;
		if (!answers_as(p, i, s->station) || p->dg[2 * i + 1].wkc != 1 ||
		    ec_graph_open_ports(get_unaligned_le16(p->r[i].dl)) !=
		    ec_graph_open_ports(get_unaligned_le16(r->dl)))
			return false;
	}
	return true;
}

/* Slaves of a stretch, the one before it, the one after it, and at which these hang. */
static void mark_stretch(const struct scan *sc, const struct stretch *t, bool mark)
{
	unsigned int end = t->new + t->n_new, i;
	struct ec_slave *s;

	for (i = t->new; i < end; i++)
		sc->slaves[i]->listing = mark;
	for (s = t->new ? sc->slaves[t->new - 1] : NULL; s; s = ec_graph_parent(s))
		s->listing = mark;
	for (s = end < sc->n ? sc->slaves[end] : NULL; s; s = ec_graph_parent(s))
		s->listing = mark;
}

/* Slaves at which no stretch hangs keep the ports that they have in the list. */
static void leave_ports(struct scan *sc)
{
	unsigned int i, k;

	for (k = 0; k < sc->n_stretches; k++)
		mark_stretch(sc, &sc->stretch[k], true);
	for (i = 0; i < sc->n; i++)
		sc->regs[i].ports &= sc->slaves[i]->listing;
	for (k = 0; k < sc->n_stretches; k++)
		mark_stretch(sc, &sc->stretch[k], false);
}

static bool is_found(const struct scan *sc, const struct ec_slave *s)
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

/* Slaves of the list that this scan has not found in @t: none of them replies. */
static int check_lost(struct scan *sc, const struct stretch *t, enum doubt *doubt)
{
	struct ec_dg *dg;
	unsigned int i, n = 0;
	u8 (*v)[2];
	int ret = 0;

	dg = kvcalloc(t->n_old + 1, sizeof(*dg), GFP_KERNEL);
	v = kvcalloc(t->n_old + 1, sizeof(*v), GFP_KERNEL);
	if (!dg || !v) {
		ret = -ENOMEM;
		goto out;
	}
	for (i = t->old; i < t->old + t->n_old; i++) {
		const struct ec_slave *s = sc->bus->slaves[i];

		/* its address may be that of another one */
		if (sc->claims[s->station] || is_found(sc, s))
			continue;
		dg[n] = EC_FPRD(s->station, EC_REG_STATION, 2, v[n]);
		n++;
	}
	if (n)
		ret = ec_xfer(sc->bus->links, dg, n);
	for (i = 0; i < n && !ret; i++)
		if (dg[i].wkc)
			*doubt = max(*doubt, KNOWN);
out:
	kvfree(dg);
	kvfree(v);
	return ret;
}

/*
 * A slave that contradicts itself all the time must not keep the others from being used. Returns
 * whether that counts: a contact that is lost does not.
 */
static bool note_doubt(struct scan *sc, struct stretch *t, enum doubt doubt, bool flaps)
{
	static const unsigned int max[] = { 0, NEW_MAX, KNOWN_MAX, UINT_MAX };

	t->thrown = doubt && (flaps || sc->bus->thrown_away < max[doubt]);
	sc->n_thrown += t->thrown;
	return t->thrown && doubt != UNREAD;
}

static int prove(struct proof *p)
{
	struct scan *sc = p->sc;
	unsigned int k;
	int ret = ask_found(p);
	bool counts, flaps = !ret && ring_flaps(p);

	sc->calm = !ret && !flaps;
	/* a flapping ring is not believed because it contradicts so often */
	sc->bus->flaps = flaps ? sc->bus->flaps + 1 : 0;
	flaps &= sc->bus->flaps <= FLAPS_MAX;
	sc->moving = flaps || (!ret && sc->bus->thrown_away < NEW_MAX && !ring_stands(p));
	if (sc->moving)
		leave_ports(sc);
	counts = sc->moving;

	for (k = 0; k < sc->n_stretches && !ret; k++) {
		enum doubt doubt = check_found(p, &sc->stretch[k]);

		ret = check_lost(sc, &sc->stretch[k], &doubt);
		counts |= note_doubt(sc, &sc->stretch[k], doubt, flaps);
	}
	counts &= !flaps;
	if (counts || !ec_scan_is_partial(sc))
		sc->bus->thrown_away = counts ? sc->bus->thrown_away + 1 : 0;
	return ret;
}

/* One that fell silent is still counted, and does not reply at its address either. */
static int prove_silence(struct scan *sc)
{
	unsigned int i, k, n = 0;
	int ret, same;

	for (i = 0; i < sc->n; i++) {
		if (sc->regs[i].there || !ec_scan_is_known(sc, sc->slaves[i]))
			continue;
		sc->who[n] = i;
		sc->dg[n++] = EC_FPRD(sc->slaves[i]->station, EC_REG_STATION, 2,
				      sc->regs[i].station);
	}
	if (!n)
		return 0;
	ret = ec_xfer(sc->bus->links, sc->dg, n);
	same = ec_scan_count_again(sc);
	for (k = 0; k < n; k++) {
		struct regs *r = &sc->regs[sc->who[k]];

		r->there = !sc->dg[k].err && sc->dg[k].wkc == 1;
		r->gone |= !r->there && same != 1;
	}
	return ret ?: min(same, 0);
}

/* Known slaves with other ports; their neighbors may be the same. */
static bool has_ports(const struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (sc->regs[i].ports)
			return true;
	return false;
}

/**
 * ec_scan_proof() - is the bus what the scan has found?
 * @sc: scan that has read everything, with its stretches; @thrown is set in those where it is not
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN when nothing of the result remains; -ENOMEM; or as ec_xfer().
 */
int ec_scan_proof(struct scan *sc)
{
	struct proof p = { .sc = sc };
	int ret = prove_silence(sc);
	bool change = sc->n_stretches || has_ports(sc);

	if (!ret && !change) {
		sc->bus->thrown_away = 0;
		sc->calm = READ_ONCE(sc->bus->links->ring.front) == sc->front;
	}
	/* an empty list needs no check of the bus */
	if (ret || !sc->n || !change)
		return ret;
	ret = -ENOMEM;
	p.r = kvcalloc(sc->n, sizeof(*p.r), GFP_KERNEL);
	p.dg = kvcalloc(2 * sc->n + 1, sizeof(*p.dg), GFP_KERNEL);
	if (p.r && p.dg)
		ret = prove(&p);
	kvfree(p.r);
	kvfree(p.dg);
	if (!ret && sc->n_thrown && sc->n_thrown == sc->n_stretches)
		ret = -EAGAIN;
	return ret ?: ec_ring_ends_judge(sc);
}
