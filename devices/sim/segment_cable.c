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

/* what is at the other end of the cable in @port, which has one */
static struct end far_end(const struct ec_esc_port *port)
{
	return (struct end){
		.slave = port->peer < 0 ? port->peer + 1 : port->peer, .port = port->peer_port,
	};
}

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

static void attach(struct ec_esc_port *port, struct end far, u32 cable_ns)
{
	port->peer = far.slave < 0 ? far.slave - 1 : far.slave;
	port->peer_port = (u8)far.port;
	port->cable_ns = cable_ns;
	port->cut = false;
}

static void look(struct ec_sim *sim, struct end e, u64 now)
{
	sim->dirty = true;
	if (e.slave >= 0)
		ec_sim_ports(sim->esc[e.slave], now);
}

static void lay(struct ec_sim *sim, struct end a, struct end b, u32 cable_ns, u64 now)
{
	attach(port_of(sim, a), b, cable_ns);
	attach(port_of(sim, b), a, cable_ns);
	look(sim, b, now);
	look(sim, a, now);
}

static void pull(struct ec_sim *sim, struct end a, u64 now)
{
	struct ec_esc_port *port = port_of(sim, a);
	struct end b;

	if (port->peer == -1)
		return;
	b = far_end(port);
	port->peer = -1;
	port->cut = false;
	port = port_of(sim, b);
	port->peer = -1;
	port->cut = false;
	look(sim, a, now);
	look(sim, b, now);
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
	struct end a = { parent, parent < 0 ? 0 : parent_port }, b = { child, child_port };

	if (child < 0 || !ec_sim_has_port(sim, parent, parent_port) ||
	    !ec_sim_has_port(sim, child, child_port) || same_end(a, b))
		return -EINVAL;
	if (port_of(sim, a)->peer != -1 || port_of(sim, b)->peer != -1)
		return -EBUSY;
	lay(sim, a, b, cable_ns, sim->now);
	return 0;
}

/* cut or heal the cable at one of its ends; @slave below 0: master port */
void ec_sim_cut(struct ec_sim *sim, int slave, int port, bool cut, u64 now)
{
	struct end a = { slave, port }, b;

	if (port_of(sim, a)->peer == -1)
		return;
	b = far_end(port_of(sim, a));
	port_of(sim, a)->cut = cut;
	port_of(sim, b)->cut = cut;
	look(sim, a, now);
	look(sim, b, now);
}

/* a plug fits into one port only: a cable that is there comes out first */
void ec_sim_plug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	struct end a = { f->slave, f->port }, b = { (int)f->arg, (int)f->arg2 };

	pull(sim, a, now);
	pull(sim, b, now);
	lay(sim, a, b, (u32)f->value, now);
}

void ec_sim_unplug(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	pull(sim, (struct end){ f->slave, f->port }, now);
}
