// SPDX-License-Identifier: GPL-2.0-only
/*
 * Links and loops of a segment, and the way a frame takes.
 *
 * The way depends on the topology only, so it is computed once per change: a
 * list of processing units with the time since the master sent the first bit.
 */
#include "esc_int.h"

/**
 * ec_sim_link() - what the PHY of the master says
 * @sim: segment
 * @port: master port, 0 or 1
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: link is up.
 */
bool ec_sim_link(const struct ec_sim *sim, int port)
{
	const struct ec_esc_port *m = &sim->mport[port];

	return m->peer >= 0 && sim->esc[m->peer]->port[m->peer_port].link;
}

/**
 * ec_sim_card() - the network card at a master port is switched on or off
 * @sim: segment
 * @port: master port, 0 or 1
 * @on: it is on: there is a link if a slave is connected; that is so initially
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_card(struct ec_sim *sim, int port, bool on, u64 now)
{
	sim->mport_off[port] = !on;
	if (sim->mport[port].peer >= 0)
		ec_sim_ports(sim->esc[sim->mport[port].peer], now);
}

/**
 * ec_sim_is_ring() - has a segment a cable at its second master port?
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it has, perhaps one that is cut.
 */
bool ec_sim_is_ring(const struct ec_sim *sim)
{
	return sim->mport[1].peer >= 0;
}

static void dl_event(struct ec_esc *esc)
{
	if (!ec_esc_bug(esc, EC_SIM_BUG_DL_SILENT))
		ec_esc_event(esc, EC_ECAT_EVENT_DL, 0);
}

/* loop settings or links changed; @written: by a write to 0x0101 */
void ec_sim_loops(struct ec_esc *esc, bool written, u64 now)
{
	u8 before = ec_esc_open_ports(esc);
	int p;

	for (p = 0; p < EC_MAX_PORT; p++) {
		struct ec_esc_port *port = &esc->port[p];
		u32 mode = ec_esc_loop_mode(esc, p);
		bool open = port->link;

		if (!port->link)
			port->auto_closed = true;
		else if (written || mode == EC_LOOP_AUTO ||
			 ec_esc_bug(esc, EC_SIM_BUG_AUTO_CLOSE))
			port->auto_closed = false;
		switch (mode) {
		case EC_LOOP_AUTO:
			open |= port->open && ec_esc_bug(esc, EC_SIM_BUG_CUT_OPEN);
			break;
		case EC_LOOP_AUTO_CLOSE:
			open = !port->auto_closed;
			break;
		case EC_LOOP_OPEN:
			open = true;
			break;
		case EC_LOOP_CLOSED:	/* port 0 must stay reachable */
			open = !p && port->link;
			break;
		}
		if (open == port->open)
			continue;
		port->open = open;
		if (!open)
			port->closed_at = ++esc->sim->port_events;
		esc->sim->dirty = true;
		if (esc->powered)
			dl_event(esc);
	}
	if (esc->sim->passing && esc->loop_frame != esc->sim->frame) {
		esc->loop_frame = esc->sim->frame;
		esc->loop_before = before;
	}
}

static void set_link(struct ec_esc *esc, int p, bool link, u64 now)
{
	struct ec_esc_port *port = &esc->port[p];
	u8 *lost = esc->mem + EC_REG_ERR_LOST(p);

	if (link == port->link)
		return;
	port->link = link;
	if (link)
		port->linked_ns = now;
	ec_sim_link_changed(esc, p, now);
	if (!esc->powered)
		return;
	if (!link && *lost != 0xff && !ec_esc_bug(esc, EC_SIM_BUG_LOST_UNCOUNTED))
		++*lost;
	dl_event(esc);
}

/* there is all that a link needs but time */
static bool has_partner(const struct ec_esc *esc, const struct ec_esc_port *port)
{
	if (!esc->powered || port->peer == -1 || port->cut)
		return false;
	if (port->peer >= 0)
		return esc->sim->esc[port->peer]->powered;
	return port->peer == EC_ESC_PEER_HOST || !esc->sim->mport_off[-2 - port->peer];
}

static u32 link_delay(const struct ec_esc *esc, const struct ec_esc_port *port)
{
	u32 other = port->peer < 0 ? 0 : esc->sim->esc[port->peer]->cfg.link_ns;

	return max(esc->cfg.link_ns, other);
}

static void wake_for_links(struct ec_esc *esc)
{
	esc->link_wake = EC_ESC_NEVER;
	for (int p = 0; p < EC_MAX_PORT; p++)
		esc->link_wake = min(esc->link_wake, esc->port[p].link_at);
	ec_sim_port_due(esc->sim, esc->link_wake);
	ec_sim_touch(esc);
}

/* power or cables around @esc changed, or it is time for a link */
void ec_sim_ports(struct ec_esc *esc, u64 now)
{
	int p;

	esc->sim->dirty = true;
	for (p = 0; p < EC_MAX_PORT; p++) {
		struct ec_esc_port *port = &esc->port[p];
		bool could = has_partner(esc, port);

		if (!could)
			port->link_at = EC_ESC_NEVER;
		else if (!port->link && port->link_at == EC_ESC_NEVER)
			port->link_at = now + link_delay(esc, port);
		if (port->link_at <= now)
			port->link_at = EC_ESC_NEVER;
		set_link(esc, p, could && port->link_at == EC_ESC_NEVER, now);
	}
	ec_sim_loops(esc, false, now);
	wake_for_links(esc);
}

void ec_sim_power(struct ec_esc *esc, bool on, u64 now)
{
	struct ec_sim *sim = esc->sim;
	int p;

	if (on == esc->powered)
		return;
	ec_esc_settle(esc);
	esc->powered = on;
	if (on) {
		ec_esc_power_on(esc, now);
	} else {
		ec_esc_eeprom_power_off(esc, now);
		esc->ecat_event = 0;
		ec_esc_event(esc, 0, 0);
		esc->wd_due = EC_ESC_NEVER;
		esc->loop_restore = EC_ESC_NEVER;
		esc->app_wake_ns = EC_ESC_NEVER;
		esc->dc.sync_wake = EC_ESC_NEVER;
		memset(&esc->pend, 0, sizeof(esc->pend));
	}
	ec_sim_ports(esc, now);
	for (p = 0; p < EC_MAX_PORT; p++)
		if (esc->port[p].peer >= 0)
			ec_sim_ports(sim->esc[esc->port[p].peer], now);
	if (on && esc->app_ops && esc->app_ops->power_on)
		esc->app_ops->power_on(esc, now);
}

/* false: the frame ends here */
static bool add_step(struct ec_sim *sim, struct ec_sim_route *r, int mport,
		     struct ec_esc *esc, u32 t)
{
	struct ec_sim_step *st;
	bool circ = !esc->port[0].open;

	/* it carries the circulating bit by now: destroyed */
	if (circ && r->circ >= 0)
		return false;
	if (esc->route_pos[mport] >= 0)
		r->repeats = true;
	if (r->steps == sim->max)
		return false;
	st = &r->step[r->steps];
	st->esc = esc;
	st->pu_ns = t;
	esc->route_pos[mport] = (s32)r->steps;
	if (circ)
		r->circ = (int)r->steps;
	r->steps++;
	return true;
}

/* in which order frames leave */
int ec_sim_next_port(const struct ec_sim *sim, int port)
{
	static const u8 right[EC_MAX_PORT] = { 3, 2, 0, 1 };
	static const u8 wrong[EC_MAX_PORT] = { 1, 2, 3, 0 };

	return sim->bug == EC_SIM_BUG_PORT_ORDER ? wrong[port] : right[port];
}

static void walk(struct ec_sim *sim, int mport)
{
	struct ec_sim_route *r = &sim->route[mport];
	const struct ec_esc_port *cable = &sim->mport[mport];
	u32 guard = 8 * sim->count + 16;
	u64 t = 0;

	if (!ec_sim_link(sim, mport))
		return;
	while (guard--) {
		struct ec_esc *esc = sim->esc[cable->peer];
		u8 p = cable->peer_port;
		bool processed = false;

		t += cable->cable_ns;
		r->span_ns = t;
		if (!esc->port[p].open) {	/* no slave listens */
			if (ec_esc_port_waits(esc, p)) {
				r->opens = esc->index;
				r->opens_port = p;
			}
			return;
		}
		if (!(esc->route_mask & BIT(p))) {
			esc->route_mask |= (u8)BIT(p);
			esc->route_recv_ns[p] = (u32)t;
		}
		do {
			if (!p) {
				if (!add_step(sim, r, mport, esc, (u32)t))
					return;
				processed = true;
			}
			p = (u8)ec_sim_next_port(sim, p);
		} while (!esc->port[p].open);
		if (sim->bug != EC_SIM_BUG_NO_DELAY)
			t += processed ? esc->cfg.process_ns : esc->cfg.forward_ns;

		cable = &esc->port[p];
		if (!cable->link)		/* loop held open: lost */
			return;
		if (cable->peer == EC_ESC_PEER_HOST)	/* does not send it back */
			return;
		if (cable->peer < 0) {
			r->out_port = -2 - cable->peer;
			r->delay_ns = t + cable->cable_ns;
			r->span_ns = r->delay_ns;
			return;
		}
	}
}

/* compute the ways from both master ports */
void ec_sim_routes(struct ec_sim *sim)
{
	u32 i, k;

	for (i = 0; i < EC_SIM_PORTS; i++) {
		struct ec_sim_route *r = &sim->route[i];

		r->steps = 0;
		r->delay_ns = 0;
		r->span_ns = 0;
		r->out_port = -1;
		r->circ = -1;
		r->repeats = false;
		r->opens = -1;
		for (k = 0; k < sim->count; k++) {
			sim->esc[k]->route_pos[i] = -1;
			sim->esc[k]->route_mask = 0;
		}
		walk(sim, (int)i);
		for (k = 0; k < r->steps; k++) {
			struct ec_sim_step *st = &r->step[k];

			st->recv_mask = st->esc->route_mask;
			memcpy(st->recv_ns, st->esc->route_recv_ns,
			       sizeof(st->recv_ns));
		}
	}
	sim->dirty = false;
	sim->change++;
}
