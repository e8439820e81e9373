// SPDX-License-Identifier: LGPL-2.1-or-later
/* Causes beyond AL states: clocks, error counters of the ports. */
#include <stdio.h>
#include <stdlib.h>

#include "../../master/wire/dc.h"
#include "why.h"

static void numbers(struct ect_finding *f, s64 first, s64 second)
{
	f->evidence_count = 2;
	f->evidence[0] = first;
	f->evidence[1] = second;
}

static void clock_of(struct why *w, size_t i, const struct ect_slave *s)
{
	const struct ect_explained *c = why_config(w, i);
	struct ect_finding *f;

	if (!s->dc_supported || s->dc_delay_only) {
		f = why_add(w, NO_CLOCK);
	} else if (!s->dc_set && why_in_op(c)) {
		f = why_add(w, CLOCK_NOT_SET);
	} else if (s->dc_set && (s->dc_diff > ECT_DC_WINDOW || s->dc_diff < -ECT_DC_WINDOW)) {
		f = why_add(w, CLOCK_OFF, s->dc_diff, ECT_DC_WINDOW);
		numbers(f, s->dc_diff, ECT_DC_WINDOW);
	} else if (c->config.dc_cycle[0] &&
		   !ec_dc_sync_fits(c->config.dc_cycle[0], w->m.cycle_interval_us * 1000)) {
		f = why_add(w, SYNC_CYCLE, c->config.dc_cycle[0], w->m.cycle_interval_us);
		numbers(f, c->config.dc_cycle[0], w->m.cycle_interval_us);
	} else {
		return;
	}
	f->slave = s->position;
	f->config = (int)i;
}

/**
 * why_clocks() - clocks that SYNC signals need
 * @w: what is known
 */
void why_clocks(struct why *w)
{
	if (!w->m.active)
		return;
	for (size_t i = 0; i < w->configs->n; i++) {
		const struct ect_explained *c = why_config(w, i);
		int position = c->config.slave_position;

		if (c->config.dc_assign_activate && position >= 0 && (size_t)position < w->bus->n)
			clock_of(w, i, why_slave(w, (size_t)position));
	}
	if (w->m.cycle_lock == ECT_LOCK_HOLD)
		why_add(w, CYCLE_LOCK);
}

/* the port where a cable was cut, or a slave lost, has its own finding */
static bool is_cable(const struct why *w, unsigned int position, unsigned int port)
{
	for (size_t i = 0; i < w->findings->n; i++) {
		const struct ect_finding *f = why_finding(w, i);

		if (f->slave == (int)position && f->port == (int)port)
			return true;
	}
	return false;
}

struct errors {
	unsigned int rx, phy, lost;
};

static struct errors errors_at(const struct ect_errors *all, unsigned int port)
{
	const struct ect_port_errors *e = &all->ports[port];

	return (struct errors){ e->invalid, e->receiver, e->lost_link };
}

static bool any(const struct errors *e)
{
	return e->rx || e->phy || e->lost;
}

/* Both ends of a cable may count its errors: it is reported once, at the upstream end. */
static void port_errors(struct why *w, const struct ect_errors *all, unsigned int at,
			unsigned int port)
{
	struct errors e = errors_at(&all[at], port), far = { 0 };
	char name[96], other[96] = "the main device";
	struct ect_finding *f;
	u32 peer, peer_port;
	bool connected;

	if (is_cable(w, at, port) || !any(&e))
		return;
	/* without a slave behind it, it leads to the main device */
	connected = why_slave(w, at)->ports[port].link_up;
	if (ect_peer(w->bus, at, port, &peer, &peer_port)) {
		connected = true;
		why_slave_name(w, peer, other, sizeof(other));
		if (peer_port < ECT_PORTS)
			far = errors_at(&all[peer], peer_port);
		if (peer < at && any(&far))
			return;
	}
	why_slave_name(w, at, name, sizeof(name));
	if (connected) {
		e = (struct errors){ e.rx + far.rx, e.phy + far.phy, e.lost + far.lost };
		f = why_add(w, LINK_ERRORS, port, name, other, e.rx, e.phy, e.lost);
	} else {
		f = why_add(w, OPEN_ERRORS, port, name, e.rx, e.phy, e.lost);
	}
	numbers(f, e.rx, e.phy);
	f->evidence[f->evidence_count++] = e.lost;
	f->slave = (int)at;
	f->port = (int)port;
}

/* as the master has read them last, up to 255 as from the registers */
static void known_counters(struct why *w, struct ect_errors *all)
{
	for (size_t i = 0; i < w->bus->n; i++) {
		bool known = false;

		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			const struct ect_port *from = &why_slave(w, i)->ports[p];

			known |= from->errors_known;
			/* there is no such port */
			if (from->type < 2)
				continue;
			all[i].ports[p] = (struct ect_port_errors){
				.invalid = (u8)min(from->invalid, 255U),
				.receiver = (u8)min(from->receiver, 255U),
				.forwarded = (u8)min(from->forwarded, 255U),
				.lost_link = (u8)min(from->lost_link, 255U),
			};
		}
		w->silent += !known;
	}
}

static void read_counters(struct why *w, struct ect_errors *all)
{
	struct ect_handle *h = why_open(w);

	w->counters = h;
	/* one that does not reply for long has its own finding */
	for (size_t i = 0; w->counters && i < w->bus->n; i++)
		w->silent += !!ect_get_errors(h, why_slave(w, i)->device, &all[i]);
	ect_free(h);
}

/**
 * why_counters() - error counters of the ports
 * @w: what is known; @counters and @silent say what was read
 */
void why_counters(struct why *w)
{
	struct ect_errors *all = calloc(w->bus->n + 1, sizeof(*all));

	w->failed |= !all;
	if (all && w->quiet) {
		w->counters = true;
		known_counters(w, all);
	} else if (all) {
		read_counters(w, all);
	}
	for (unsigned int i = 0; all && i < w->bus->n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++)
			port_errors(w, all, i, p);
	free(all);
}
