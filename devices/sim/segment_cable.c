// SPDX-License-Identifier: GPL-2.0-only
/*
 * Cables of a segment: laid while it is built, pulled and plugged while it runs.
 */
#include "esc_int.h"

/* a port of a slave, or of the master */
struct end {
	int slave;		/* EC_SIM_MASTER0, EC_SIM_MASTER1 */
	int port;		/* 0 with a master */
};

static struct ec_esc_port *port_of(struct ec_sim *sim, struct end e)
{
	return e.slave < 0 ? &sim->mport[-1 - e.slave] : &sim->esc[e.slave]->port[e.port];
}

/* what is at the other end of the cable in @port, which has one, of a slave or the master */
static struct end far_end(const struct ec_esc_port *port)
{
	return (struct end){
		.slave = port->peer < 0 ? port->peer + 1 : port->peer, .port = port->peer_port,
	};
}

/* what has to be known to lay it again */
struct cable {
	struct end a, b;
	u32 ns;
	bool cut;
};

static bool same_end(struct end a, struct end b)
{
	return a.slave == b.slave && a.port == b.port;
}

/**
 * ec_sim_has_port() - is there a port
 * @sim: segment
 * @slave: slave, EC_SIM_MASTER0 or EC_SIM_MASTER1
 * @port: its port, ignored for a master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether a cable fits there.
 */
bool ec_sim_has_port(const struct ec_sim *sim, int slave, int port)
{
	if (slave < 0)
		return slave >= EC_SIM_MASTER1;
	return slave < (int)sim->count && port >= 0 && port < EC_MAX_PORT &&
	       sim->esc[slave]->cfg.ports[port] > EC_PORT_TYPE_UNCONF;
}

static void attach(struct ec_esc_port *port, struct end far, const struct cable *c)
{
	port->peer = far.slave < 0 ? far.slave - 1 : far.slave;
	port->peer_port = (u8)far.port;
	port->cable_ns = c->ns;
	port->cut = c->cut;
}

static void detach(struct ec_esc_port *port)
{
	port->peer = -1;
	port->cut = false;
}

static void look(struct ec_sim *sim, struct end e, u64 now)
{
	sim->dirty = true;
	if (e.slave >= 0)
		ec_sim_ports(sim->esc[e.slave], now);
}

static void lay(struct ec_sim *sim, const struct cable *c, u64 now)
{
	attach(port_of(sim, c->a), c->b, c);
	attach(port_of(sim, c->b), c->a, c);
	look(sim, c->b, now);
	look(sim, c->a, now);
}

/* false: there is none */
static bool cable_at(struct ec_sim *sim, struct end a, struct cable *c)
{
	const struct ec_esc_port *port = port_of(sim, a);

	if (port->peer == -1 || port->peer == EC_ESC_PEER_HOST)
		return false;
	*c = (struct cable){ a, far_end(port), port->cable_ns, port->cut };
	return true;
}

static void pull(struct ec_sim *sim, struct end a, u64 now)
{
	struct cable c;

	if (port_of(sim, a)->peer == EC_ESC_PEER_HOST) {
		detach(port_of(sim, a));
		look(sim, a, now);
	}
	if (!cable_at(sim, a, &c))
		return;
	detach(port_of(sim, c.a));
	detach(port_of(sim, c.b));
	look(sim, c.a, now);
	look(sim, c.b, now);
}

/**
 * ec_sim_wire() - put a cable between two ports
 * @sim: segment
 * @parent: slave, EC_SIM_MASTER0 or EC_SIM_MASTER1
 * @parent_port: its port, ignored for a master
 * @child: slave
 * @child_port: its port
 * @cable_ns: delay, about 5 ns per metre
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EINVAL for a slave or port that is not there, -EBUSY for one
 * that has a cable.
 */
int ec_sim_wire(struct ec_sim *sim, int parent, int parent_port, int child,
		int child_port, u32 cable_ns)
{
	const struct cable c = {
		{ parent, parent < 0 ? 0 : parent_port }, { child, child_port }, cable_ns, false,
	};

	if (child < 0 || !ec_sim_has_port(sim, parent, parent_port) ||
	    !ec_sim_has_port(sim, child, child_port) || same_end(c.a, c.b))
		return -EINVAL;
	if (port_of(sim, c.a)->peer != -1 || port_of(sim, c.b)->peer != -1)
		return -EBUSY;
	lay(sim, &c, sim->now);
	return 0;
}

/* cut or heal the cable at one of its ends; @slave below 0: master port */
void ec_sim_cut(struct ec_sim *sim, int slave, int port, bool cut, u64 now)
{
	const struct end a = { slave, port };
	struct cable c;

	if (port_of(sim, a)->peer == EC_ESC_PEER_HOST) {
		port_of(sim, a)->cut = cut;
		look(sim, a, now);
	}
	if (!cable_at(sim, a, &c))
		return;
	port_of(sim, c.a)->cut = cut;
	port_of(sim, c.b)->cut = cut;
	look(sim, c.a, now);
	look(sim, c.b, now);
}

/* a plug fits into one port only: a cable that is there comes out first */
void ec_sim_plug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	const struct cable c = {
		{ f->slave, f->port }, { (int)f->arg, (int)f->arg2 }, (u32)f->value, false,
	};

	pull(sim, c.a, now);
	pull(sim, c.b, now);
	lay(sim, &c, now);
}

void ec_sim_unplug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	pull(sim, (struct end){ f->slave, f->port }, now);
}

/* a cable there comes out before */
void ec_sim_plug_host(struct ec_sim *sim, int slave, int port, u64 now)
{
	const struct end a = { slave, port };

	pull(sim, a, now);
	port_of(sim, a)->peer = EC_ESC_PEER_HOST;
	look(sim, a, now);
}

/* the end that takes the place of @e when two slaves, or two of their ports, are exchanged */
static struct end exchanged(const struct ec_sim_fault *f, struct end e)
{
	const struct end a = { f->slave, f->port }, b = { (int)f->arg, (int)f->arg2 };

	if (f->port == EC_SIM_ALL_PORTS) {
		if (e.slave == a.slave || e.slave == b.slave)
			e.slave = e.slave == a.slave ? b.slave : a.slave;
		return e;
	}
	return same_end(e, a) ? b : same_end(e, b) ? a : e;
}

/* take the cables out of @slave; returns how many can be laid again: not that of a host */
static u32 pull_all(struct ec_sim *sim, int slave, int port, struct cable *c, u64 now)
{
	int first = port == EC_SIM_ALL_PORTS ? 0 : port;
	int last = port == EC_SIM_ALL_PORTS ? EC_MAX_PORT - 1 : port;
	u32 n = 0;

	for (int p = first; p <= last; p++) {
		const struct end e = { slave, p };

		n += cable_at(sim, e, &c[n]);
		pull(sim, e, now);
	}
	return n;
}

/* each cable comes out, then goes in again; where there is no port, it stays out */
void ec_sim_swap(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	struct cable c[2 * EC_MAX_PORT];
	u32 n = pull_all(sim, f->slave, f->port, c, now);

	n += pull_all(sim, (int)f->arg, f->port == EC_SIM_ALL_PORTS ? f->port : (int)f->arg2,
		      c + n, now);
	for (u32 i = 0; i < n; i++) {
		c[i].a = exchanged(f, c[i].a);
		c[i].b = exchanged(f, c[i].b);
		if ((c[i].a.slave >= 0 || c[i].b.slave >= 0) &&
		    ec_sim_has_port(sim, c[i].a.slave, c[i].a.port) &&
		    ec_sim_has_port(sim, c[i].b.slave, c[i].b.port))
			lay(sim, &c[i], now);
	}
}
