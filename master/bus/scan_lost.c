// SPDX-License-Identifier: GPL-2.0-only
/* Slaves that were disconnected or connected: one event for each place, for all behind it. */
#include <linux/ktime.h>
#include "../link/links.h"
#include "graph.h"
#include "ports.h"
#include "scan_int.h"
#include "scan_lost.h"

#define LINES	16	/* in the log, per scan */

static u32 position_of(const struct ec_slave *s)
{
	return s ? s->position : EC_EVENT_NONE;
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
	struct ec_slave *u = ec_graph_parent(s);

	lockdep_assert_held_write(&s->bus->topo);
	s->seen_ns = s->bus->complete_ns;
	if (u && u->position < s->position && !u->listing) {
		s->lost_at = u->lost_at;
		strscpy(s->parent, u->parent, sizeof(s->parent));
		if (u->first_lost[0])
			strscpy(s->first_lost, u->first_lost, sizeof(s->first_lost));
		else
			snprintf(s->first_lost, sizeof(s->first_lost), "slave %u (%.24s)",
				 u->position, ec_slave_label(u));
		return;
	}
	if (u)
		ec_ports_note_loss(u, s->parent_port, true);
	s->lost_at = (struct ec_break){
		.station = u ? u->station : 0, .position = position_of(u), .port = s->parent_port,
	};
	if (u)
		snprintf(s->parent, sizeof(s->parent), "port %u of slave %u (%.24s)",
			 s->parent_port, u->position, ec_slave_label(u));
	else
		strscpy(s->parent, "the main device", sizeof(s->parent));
}

/* Lost together? What hangs behind a cable is one range of the ring, and one event. */
static bool same_break(const struct ec_slave *a, const struct ec_slave *b)
{
	return a->lost_at.station == b->lost_at.station && a->lost_at.port == b->lost_at.port;
}

/* No application could use a slave that was not read. */
static bool counts(const struct ec_slave *s)
{
	return READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED;
}

static void log_lost(struct ec_bus *bus, const struct ec_slave *first, const struct ec_slave *last,
		     u64 ms)
{
	char text[128];

	ec_slave_lost_text(first, text, sizeof(text));
	if (first == last)
		ec_warn_each(bus, first->position + 1, "%s, last seen %llu ms ago\n", text, ms);
	else
		ec_warn_each(bus, first->position + 1,
			     "%s, and what is behind it up to slave %u (%s), last seen %llu ms ago\n",
			     text, last->position, ec_slave_label(last), ms);
}

static void report_all(struct ec_bus *bus, unsigned int n)
{
	u64 ms = div_u64(ktime_get_ns() - bus->complete_ns, NSEC_PER_MSEC);

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
	unsigned int i, first, lines = 0;

	if (n && !bus->n_slaves) {
		report_all(bus, n);
		return;
	}
	for (i = 0; i < n; ) {
		const struct ec_slave *s = lost[i];
		u64 ms = div_u64(ktime_get_ns() - s->seen_ns, NSEC_PER_MSEC);

		first = i++;
		if (!counts(s))
			continue;
		while (i < n && counts(lost[i]) && same_break(lost[i], s))
			i++;
		if (lines++ < LINES)
			log_lost(bus, s, lost[i - 1], ms);
		ec_slave_event(s, EC_EVENT_SLAVE_LOST, s->lost_at.position, s->lost_at.port,
			       s->alias, s->info.vendor, s->info.product, ms, i - first);
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
		ec_slave_event(s, EC_EVENT_SLAVE_FOUND, position_of(ec_graph_parent(s)),
			       s->parent_port, s->alias, s->info.vendor, s->info.product,
			       i - first);
	}
}
