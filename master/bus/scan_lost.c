// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that were disconnected or connected: one event for each place, for all behind it. */
#include <linux/ktime.h>
#include "../base/report.h"
#include "../link/links.h"
#include "graph.h"
#include "ports.h"
#include "ring_break.h"
#include "scan_int.h"
#include "scan_lost.h"

#define LINES	16	/* in the log, per scan */

static u32 position_of(const struct ec_slave *s)
{
	return s ? s->position : EC_EVENT_NONE;
}

/* Behind which port slave @s hangs. */
static void place_text(const struct ec_slave *s, const struct ec_slave *u, u8 port, char *buf,
		       size_t size)
{
	if (u)
		snprintf(buf, size, "port %u of slave %u (%.24s)", port, u->position,
			 ec_slave_label(u));
	else if (s->position && !s->bus->links->only)
		strscpy(buf, "the break of the ring", size);
	else
		strscpy(buf, "the main device", size);
}

/**
 * ec_lost_note_place() - the place that a slave has which is disconnected
 * @s: slave, still in the graph
 *
 * Slaves that are lost together have the place where the first of them hung.
 *
 * Context: The monitor thread, topo held for writing, for each such slave in ring order.
 */
void ec_lost_note_place(struct ec_slave *s)
{
	struct ec_slave *up = ec_graph_parent(s), *u;
	u8 port = s->graph.parent_port;

	lockdep_assert_held_write(&s->bus->topo);
	u = up ?: ec_ring_break_neighbor(s, &port);
	s->lost.seen_ns = s->bus->complete_ns ?: ktime_get_ns();
	if (u && u->position < s->position && !u->listing) {
		s->lost.at = u->lost.at;
		s->lost.at.up = u->position;
		s->lost.at.up_port = port;
		strscpy(s->lost.parent, u->lost.parent, sizeof(s->lost.parent));
		if (u->lost.first[0])
			strscpy(s->lost.first, u->lost.first, sizeof(s->lost.first));
		else
			snprintf(s->lost.first, sizeof(s->lost.first), "slave %u (%.24s)",
				 u->position, ec_slave_label(u));
		return;
	}
	if (up)
		ec_ports_note_loss(up, port, true);
	s->lost.at = (struct ec_break){
		.station = u ? u->station : 0, .position = position_of(u),
		.port = port,
		.up = u ? u->position : EC_UAPI_NONE16, .up_port = port,
	};
	place_text(s, u, port, s->lost.parent, sizeof(s->lost.parent));
}

/* Lost together? What hangs behind a cable is one range of the ring, and one event. */
static bool same_break(const struct ec_slave *a, const struct ec_slave *b)
{
	return a->lost.at.station == b->lost.at.station && a->lost.at.port == b->lost.at.port;
}

/* No application could use a slave that was not read. */
static bool counts(const struct ec_slave *s)
{
	return READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;
}

/* What was lost behind one port: @first and those after it up to @last. */
static void report_port(const struct ec_slave *first, const struct ec_slave *last, bool line)
{
	struct ec_base *base = first->bus->base;
	const struct ec_event_more more = {
		.place = first->lost.parent, .name = ec_slave_label(first),
		.last = ec_slave_label(last),
	};
	const struct ec_event e = {
		.kind = EC_EVENT_SLAVE_LOST, .slave = first->position,
		.arg = {
			first->lost.at.position, first->lost.at.port, first->alias,
			first->info.vendor, first->info.product,
			div_u64(ktime_get_ns() - first->lost.seen_ns, NSEC_PER_MSEC),
			last->position - first->position + 1,
		},
	};

	ec_events_put(&base->events, e.kind, e.slave, e.arg);
	if (line)
		ec_report_print(base, &e, &more);
}

static void report_all(struct ec_bus *bus, unsigned int n)
{
	u64 ms = div_u64(ktime_get_ns() - (bus->complete_ns ?: ktime_get_ns()), NSEC_PER_MSEC);

	if (READ_ONCE(bus->links->access.mode) == EC_ACCESS_DIRECT)
		return;
	ec_warn(bus, "all %u slave(s) disconnected, last seen %llu ms ago\n", n, ms);
	ec_event(bus->base, EC_EVENT_ALL_LOST, n, ms);
}

/**
 * ec_lost_report() - one event and one line for each place where slaves were lost
 * @bus: bus, with the list without them
 * @lost: these slaves, in ring order, after ec_lost_note_place()
 * @n: entries in @lost
 *
 * Without any slave on the bus, one for all.
 *
 * Context: The monitor thread.
 */
void ec_lost_report(struct ec_bus *bus, struct ec_slave **lost, unsigned int n)
{
	unsigned int i, lines = 0;

	if (n && !bus->n_slaves) {
		report_all(bus, n);
		return;
	}
	for (i = 0; i < n; ) {
		const struct ec_slave *s = lost[i++], *last = s;

		if (!counts(s))
			continue;
		for (; i < n && same_break(lost[i], s); i++)
			last = counts(lost[i]) ? lost[i] : last;
		report_port(s, last, lines++ < LINES);
	}
	if (lines > LINES)
		ec_warn(bus, "slaves disconnected from %u more place(s)\n", lines - LINES);
}

static bool is_new(const struct scan *sc, const struct ec_slave *s)
{
	return !ec_scan_is_known(sc, s) && counts(s);
}

/**
 * ec_lost_report_found() - one event for each place where slaves were found beside known ones
 * @sc: scan, its result is the list of the bus
 * @n_old: slaves in the list before; without any the end of the scan says enough
 *
 * Context: The monitor thread.
 */
void ec_lost_report_found(struct scan *sc, unsigned int n_old)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i, first;
	struct ec_event_more more;
	char place[EC_UAPI_STRING];

	for (i = 0; n_old && i < bus->n_slaves; ) {
		const struct ec_slave *s = bus->slaves[i];

		first = i++;
		if (!is_new(sc, s))
			continue;
		/* and those that hang at one of these */
		for (; i < bus->n_slaves && is_new(sc, bus->slaves[i]); i++) {
			u32 up = position_of(ec_graph_parent(bus->slaves[i]));

			if (up < first || up == EC_EVENT_NONE)
				break;
		}
		place_text(s, ec_graph_parent(s), s->graph.parent_port, place, sizeof(place));
		more = (struct ec_event_more){
			.place = place, .name = ec_slave_label(s),
			.last = ec_slave_label(bus->slaves[i - 1]),
		};
		ec_report_more(bus->base, EC_EVENT_SLAVE_FOUND, s->position, &more,
			       position_of(ec_graph_parent(s)), s->graph.parent_port, s->alias,
			       s->info.vendor, s->info.product, i - first);
	}
}
