// SPDX-License-Identifier: GPL-2.0-only
/* The list of the bus changes: a step for each stretch of the ring that the scan has proved. */
#include <linux/slab.h>
#include "../base/once64.h"
#include "../link/links.h"
#include "absent.h"
#include "graph.h"
#include "known.h"
#include "ring_break.h"
#include "ring_ends.h"
#include "ring_place.h"
#include "scan_count.h"
#include "scan_int.h"
#include "scan_lost.h"
#include "scan_publish.h"
#include "scan_station.h"
#include "silent.h"

/**
 * struct list - the list that the bus gets
 * @slaves: by ring position
 * @n: entries in @slaves
 * @at: of each slave of the scan: its position, EC_UAPI_NONE16: it is not taken
 * @lost: those of the list before that are not in @slaves
 * @n_lost: entries in @lost
 */
struct list {
	struct ec_slave **slaves;
	unsigned int n;
	u16 *at;
	struct ec_slave **lost;
	unsigned int n_lost;
};

static void list_free(struct list *l)
{
	kvfree(l->slaves);
	kvfree(l->at);
	kvfree(l->lost);
}

static void list_take(struct list *l, const struct scan *sc, unsigned int i, unsigned int end)
{
	for (; i < end; i++) {
		l->at[i] = l->n;
		l->slaves[l->n++] = sc->slaves[i];
	}
}

/* The slaves in their order, with what the proved stretches have found. */
static void compose(struct list *l, const struct scan *sc)
{
	const struct ec_bus *bus = sc->bus;
	unsigned int i = 0, k, j;

	for (k = 0; k < sc->n_stretches; k++) {
		const struct stretch *t = &sc->stretch[k];

		list_take(l, sc, i, t->new);
		i = t->new + t->n_new;
		if (!t->thrown)
			list_take(l, sc, t->new, i);
		for (j = t->old; t->thrown && j < t->old + t->n_old; j++)
			l->slaves[l->n++] = bus->slaves[j];
	}
	list_take(l, sc, i, sc->n);
}

static int list_make(struct list *l, const struct scan *sc)
{
	unsigned int max = sc->n + sc->bus->n_slaves + 1;

	l->slaves = kvcalloc(max, sizeof(*l->slaves), GFP_KERNEL);
	l->at = kvcalloc(sc->n + 1, sizeof(*l->at), GFP_KERNEL);
	l->lost = kvcalloc(sc->bus->n_slaves + 1, sizeof(*l->lost), GFP_KERNEL);
	if (!l->slaves || !l->at || !l->lost)
		return -ENOMEM;
	memset(l->at, 0xff, (sc->n + 1) * sizeof(*l->at));
	compose(l, sc);
	return 0;
}

/* Known slaves that reply again, or not any more. */
static void note_replies(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];

		if (!ec_scan_is_known(sc, s))
			continue;
		if (sc->regs[i].there)
			sc->changed |= ec_slave_set_replies(s);
		else if (!sc->regs[i].gone)
			sc->changed |= ec_slave_set_silent(s,
				"no reply from the slave, frames pass; waiting for a reply");
	}
}

/* A try that failed again is no change. */
static bool same_failures(const struct scan *sc, const struct stretch *t)
{
	unsigned int i;

	for (i = 0; i < t->n_old && t->n_old == t->n_new; i++)
		if (!ec_scan_unreadable(sc->bus, t->old + i) ||
		    READ_ONCE(sc->slaves[t->new + i]->note.error) != EC_SLAVE_SCAN_FAILED)
			break;
	return i == t->n_old && i == t->n_new;
}

static bool differs(const struct scan *sc)
{
	unsigned int k;

	for (k = 0; k < sc->n_stretches; k++)
		if (!sc->stretch[k].thrown && !same_failures(sc, &sc->stretch[k]))
			return true;
	return sc->changed;
}

/* Slaves that were moved, and those that hung at them, are hung again. */
static void leave_places(const struct scan *sc)
{
	unsigned int k, i;

	for (k = 0; k < sc->n_stretches; k++)
		for (i = 0; !sc->stretch[k].thrown && i < sc->stretch[k].n_new; i++)
			ec_graph_leave(sc->slaves[sc->stretch[k].new + i]);
}

/* Ports of the known slaves, and the new ones. */
static void take_ports(struct scan *sc, const struct list *l)
{
	unsigned int i, p;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];
		const struct regs *r = &sc->regs[i];
		bool known = ec_scan_is_known(sc, s);

		if (l->at[i] == EC_UAPI_NONE16 || (known && (!r->ports || r->partial)))
			continue;
		if (known) {
			sc->changed |= ec_graph_open_ports(s->dl_status) !=
				       ec_graph_open_ports(get_unaligned_le16(r->dl));
			s->dl_status = get_unaligned_le16(r->dl);
			for (p = 0; p < EC_MAX_PORT; p++)
				s->recv[p] = get_unaligned_le32(r->recv + 4 * p);
		}
		ec_graph_note_ports(s);
	}
}

/* A slave that hung where others were found now hangs behind them. */
static void make_room_behind(const struct scan *sc, const struct list *l)
{
	unsigned int k;

	for (k = 0; k < sc->n_stretches; k++) {
		const struct stretch *t = &sc->stretch[k];
		unsigned int end = t->new + t->n_new;

		if (!t->thrown && t->n_new && t->new && end < sc->n &&
		    l->at[t->new - 1] != EC_UAPI_NONE16 && l->at[end] != EC_UAPI_NONE16)
			ec_graph_make_room(sc->slaves[t->new - 1], sc->slaves[end]);
	}
}

/* Where the bus is still changing, ports may contradict what is known. */
static void fit(const struct scan *sc, const struct list *l)
{
	unsigned int i, first;

	make_room_behind(sc, l);
	ec_graph_fit(l->slaves, l->n);
	first = ec_graph_misfit(l->slaves, l->n);
	if (ec_scan_is_partial(sc))
		return;
	if (first < l->n || sc->bus->doubt.look) {
		for (i = 0; i < l->n; i++)
			ec_graph_leave(l->slaves[i]);
		ec_graph_fit(l->slaves, l->n);
		first = ec_graph_misfit(l->slaves, l->n);
	}
	for (i = 0; i < l->n; i++)
		WRITE_ONCE(l->slaves[i]->graph.inconsistent, i >= first);
	if (first < l->n)
		ec_slave_warn(l->slaves[first],
			      "open ports inconsistent with ring order from this slave on; delays unreliable: check cables, then rescan\n");
}

/* Aliases that more than one slave has. */
static void note_aliases(struct scan *sc, const struct list *l)
{
	unsigned int i;

	for (i = 0; i < l->n; i++) {
		struct ec_slave *s = l->slaves[i];
		u16 *first = &sc->aliases[s->alias];

		WRITE_ONCE(s->alias_first, 0);
		if (s->alias && *first) {
			WRITE_ONCE(s->alias_first, *first);
			WRITE_ONCE(l->slaves[*first - 1]->alias_first, *first);
		} else {
			*first = i + 1;
		}
	}
}

/* Those that are lost leave the graph; of each it is noted where it hung. */
static void leave_list(const struct scan *sc, struct list *l)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i;

	for (i = 0; i < l->n; i++)
		l->slaves[i]->listing = true;
	ec_for_each_slave(s, bus) {
		if (s->listing)
			continue;
		ec_lost_note_place(s);
		l->lost[l->n_lost++] = s;
	}
	for (i = 0; i < l->n_lost; i++)
		ec_graph_leave(l->lost[i]);
	for (i = 0; i < l->n; i++)
		l->slaves[i]->listing = false;
}

static void set_list(struct scan *sc, struct list *l)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i;

	lockdep_assert_held_write(&bus->topo);
	WRITE_ONCE(bus->front, sc->front);
	ec_ring_break_note(bus, l->slaves, l->n);
	leave_list(sc, l);
	for (i = 0; i < l->n; i++)
		l->slaves[i]->position = i;
	leave_places(sc);
	take_ports(sc, l);
	ec_known_update(bus, l->slaves, l->n, ec_scan_limit());
	ec_ring_ends_note(sc, l->slaves, l->n);
	ec_ring_places_note(bus, l->slaves, l->n, sc->calm && !ec_scan_is_partial(sc));
	note_aliases(sc, l);
	WRITE_ONCE(bus->lists, bus->lists + 1);
	for (i = 0; i < l->n; i++)
		l->slaves[i]->found = l->slaves[i]->found ?: bus->lists;
	fit(sc, l);
	ec_absent_update(bus, l->n);
}

/* The list has its references, and the scan keeps those of what it does not take. */
static struct ec_slave **swap_list(struct scan *sc, struct list *l)
{
	struct ec_bus *bus = sc->bus;
	struct ec_slave **old = bus->slaves;
	unsigned int i;

	for (i = 0; i < l->n; i++)
		ec_slave_ref(l->slaves[i]);
	bus->slaves = l->slaves;
	WRITE_ONCE(bus->n_slaves, l->n);
	l->slaves = NULL;
	return old;
}

/**
 * ec_scan_publish() - change the list of the bus, unless an application keeps it by now
 * @sc: scan that was proved
 *
 * Slaves missing in the new list are disconnected.
 *
 * Context: The monitor thread. May sleep.
 * Return: 0, -EAGAIN: an application keeps the list, or -ENOMEM.
 */
int ec_scan_publish(struct scan *sc)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i, n_old = bus->n_slaves;
	struct ec_slave **old;
	struct list l = { 0 };
	int ret = list_make(&l, sc);

	if (ret)
		goto out;
	ec_pending_flush(bus, true);
	down_write(&bus->topo);
	if (bus->held) {
		up_write(&bus->topo);
		ret = -EAGAIN;
		goto out;
	}
	note_replies(sc);
	sc->changed = differs(sc);
	ec_show_change_begin(&bus->base->show);
	set_list(sc, &l);
	old = swap_list(sc, &l);
	ec_show_change_end(&bus->base->show);
	up_write(&bus->topo);
	ec_bus_need_workers(bus, l.n / 2);
	ec_for_each_slave(s, bus)
		if (!s->note.listed)
			ec_slave_list(s);
	for (i = 0; i < l.n_lost; i++)
		ec_stop_gone(&l.lost[i]->stop);
	ec_lost_report(bus, l.lost, l.n_lost);
	ec_lost_report_found(sc, n_old);
	ec_ring_break_report(bus);
	ec_ring_ends_report(bus);
	for (i = 0; i < n_old; i++)
		ec_slave_unref(old[i]);
	kvfree(old);
out:
	list_free(&l);
	return ret;
}
