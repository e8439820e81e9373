// SPDX-License-Identifier: GPL-2.0-only
/* Ends of cables in descriptions, and what happens to cables while a segment runs. */
#include "describe_int.h"

#define BOUNCE_STEP_MAX	4000000000u	/* ns */
#define CABLE_MAX	1000000	/* ns */

/**
 * ec_desc_end_of_wire() - read one end of a cable
 * @d: description
 * @w: NAME.PORT, "master" or "master.PORT"; NULL: missing
 * @slave: result, EC_SIM_MASTER0 or EC_SIM_MASTER1 for a master
 * @port: its port, 0 for a master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_end_of_wire(struct ec_desc *d, const struct ec_desc_word *w, int *slave, int *port)
{
	struct ec_desc_word name;
	s64 n;
	int ret;

	if (ec_desc_is(w, "master")) {
		*slave = EC_SIM_MASTER0;
		*port = 0;
		return 0;
	}
	ret = ec_desc_place(d, w, &name, &n);
	if (ret)
		return ret;
	if (ec_desc_is(&name, "master")) {
		if (n >= EC_SIM_PORTS)
			return ec_desc_fail(d, "'", w, "': the master has ports 0 and 1");
		*slave = n ? EC_SIM_MASTER1 : EC_SIM_MASTER0;
		*port = 0;
		return 0;
	}
	if (n >= EC_MAX_PORT)
		return ec_desc_fail(d, "'", w, "': ports are 0 to 3");
	*slave = ec_desc_slave(d, &name);
	*port = (int)n;
	return *slave < 0 ? *slave : 0;
}

/* an end of a cable at a port that the slave has */
static int real_end(struct ec_desc *d, const struct ec_desc_word *w, int *slave, int *port)
{
	int ret = ec_desc_end_of_wire(d, w, slave, port);

	if (ret)
		return ret;
	return ec_sim_has_port(d->sim, *slave, *port) ? 0 :
		ec_desc_fail(d, "'", w, "': the slave does not have this port");
}

static bool has_dot(const struct ec_desc_word *w)
{
	for (size_t i = 0; w && i < w->n; i++)
		if (w->s[i] == '.')
			return true;
	return false;
}

/* the two ends of plug and swap */
static int two_ends(struct ec_desc *d, struct ec_sim_fault *f, struct ec_desc_word *a,
		    struct ec_desc_word *b)
{
	int slave = -1, port = 0, ret;

	ret = real_end(d, a, &f->slave, &f->port);
	if (!ret)
		ret = real_end(d, b, &slave, &port);
	if (ret)
		return ret;
	f->arg = (u32)slave;
	f->arg2 = (u32)port;
	return f->slave != slave || f->port != port ? 0 :
		ec_desc_fail(d, "'", b, "' is named twice; name two different ports");
}

static int plug(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word *a = ec_desc_next(d), *b = ec_desc_next(d);
	int ret = two_ends(d, f, a, b);

	if (!ret)
		ret = ec_desc_time(d, "cable", CABLE_MAX, &f->value);
	if (!ret && f->slave < 0 && (int)f->arg < 0)
		return ec_desc_fail(d, "the ports of the master cannot be connected to each other",
				    NULL, "");
	return ret;
}

static int exchange(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word *a = ec_desc_next(d), *b = ec_desc_next(d);
	int slave;

	if (has_dot(a) || has_dot(b))
		return two_ends(d, f, a, b);
	f->port = EC_SIM_ALL_PORTS;
	f->slave = ec_desc_slave(d, a);
	if (f->slave < 0)
		return f->slave;
	slave = ec_desc_slave(d, b);
	if (slave < 0)
		return slave;
	f->arg = (u32)slave;
	return f->slave != slave ? 0 :
		ec_desc_fail(d, "'", b, "' is named twice; name two different slaves");
}

/* "0110": no contact, contact twice, none */
static int bounce(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word w = ec_desc_value(d, "pattern");
	u64 step = 1000;
	s64 times = 1;
	u32 n;

	for (n = 0; n < w.n && n < EC_SIM_BOUNCE_BITS; n++) {
		if (w.s[n] != '0' && w.s[n] != '1')
			break;
		f->value |= (u64)(w.s[n] == '1') << n;
	}
	if (!n || n < w.n || n == EC_SIM_BOUNCE_BITS)
		return ec_desc_fail(d, "invalid pattern '", &w,
				    "': expected 1 to 63 digits 0 (no contact) and 1, as pattern=01001");
	if (ec_desc_time(d, "step", BOUNCE_STEP_MAX, &step) ||
	    ec_desc_number(d, "times", 1, EC_SIM_BOUNCE_MAX / n, &times))
		return -EINVAL;
	if (!step)
		return ec_desc_fail(d, "the contact needs time: expected step=1us", NULL, "");
	f->arg = (u32)step;
	f->arg2 = (u32)times * n * EC_SIM_BOUNCE_BITS + n;
	return 0;
}

static int host(struct ec_desc *d, const struct ec_desc_word *w, struct ec_sim_fault *f)
{
	struct ec_desc_word frames;

	if (real_end(d, w, &f->slave, &f->port))
		return -EINVAL;
	if (f->slave < 0)
		return ec_desc_fail(d, "a PC or a switch is plugged in at a slave only", NULL, "");
	if (ec_desc_time(d, "every", EC_DESC_TIME_MAX, &f->value))
		return -EINVAL;
	frames = ec_desc_value(d, "frames");
	f->arg = ec_desc_is(&frames, "ethercat") ? EC_SIM_HOST_ETHERCAT : EC_SIM_HOST_BROADCAST;
	if (frames.s && !f->arg && !ec_desc_is(&frames, "broadcast"))
		return ec_desc_fail(d, "invalid frames '", &frames,
				    "': expected broadcast or ethercat");
	if (f->arg && f->value && f->value < EC_SIM_HOST_ETHERCAT_NS)
		return ec_desc_fail(d, "EtherCAT frames of a host come at most every 100 us",
				    NULL, "");
	return !f->value || f->value >= EC_SIM_HOST_MIN_NS ? 0 :
		ec_desc_fail(d, "the frames of a host do not follow each other so fast: expected every=7us or more",
			     NULL, "");
}

/**
 * ec_desc_port() - the ports that a fault statement names
 * @d: description, the verb is used
 * @f: the fault, its type is known
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, or -EINVAL.
 */
int ec_desc_port(struct ec_desc *d, struct ec_sim_fault *f)
{
	struct ec_desc_word *w;

	if (f->type == EC_SIM_FAULT_PLUG)
		return plug(d, f);
	if (f->type == EC_SIM_FAULT_SWAP)
		return exchange(d, f);
	w = ec_desc_next(d);
	if (f->type == EC_SIM_FAULT_HOST)
		return host(d, w, f);
	if (f->type == EC_SIM_FAULT_UNPLUG)
		return real_end(d, w, &f->slave, &f->port);
	if (ec_desc_end_of_wire(d, w, &f->slave, &f->port))
		return -EINVAL;
	return f->type == EC_SIM_FAULT_BOUNCE ? bounce(d, f) : 0;
}

/**
 * ec_desc_own_ports() - how the ports of a slave behave
 * @d: description, a slave statement
 * @c: result
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_own_ports(struct ec_desc *d, struct ec_app_config *c)
{
	struct ec_desc_word w = ec_desc_value(d, "loops");
	u64 link = d->link_ns;

	if (ec_desc_time(d, "link", EC_DESC_LINK_MAX, &link))
		return -EINVAL;
	c->link_ns = (u32)link;
	c->loops_fixed = ec_desc_is(&w, "fixed");
	return !w.s || c->loops_fixed ? 0 :
		ec_desc_fail(d, "invalid loops '", &w, "': expected fixed");
}

/**
 * ec_desc_under_way() - fate of frames that come back to a closed loop
 * @d: description, a segment statement
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_under_way(struct ec_desc *d)
{
	static const char * const fates[] = {
		[EC_SIM_UNDER_WAY_BACK] = "back", [EC_SIM_UNDER_WAY_LOST] = "lost",
		[EC_SIM_UNDER_WAY_RANDOM] = "random",
	};
	struct ec_desc_word w = ec_desc_value(d, "under_way");

	for (u32 i = 0; w.s && i < ARRAY_SIZE(fates); i++) {
		if (!ec_desc_is(&w, fates[i]))
			continue;
		ec_sim_set_under_way(d->sim, i);
		return 0;
	}
	return !w.s ? 0 : ec_desc_fail(d, "invalid under_way '", &w,
				       "': expected back, lost or random");
}

/* the slave hangs where it would without its wire statement, which becomes one more cable */
static void add_cable(struct ec_desc *d, int slave)
{
	struct ec_desc_node *n = &d->node[slave];

	d->wire[d->n_wires++] = (struct ec_desc_wire){
		n->place.line, n->parent, n->parent_port, slave, n->child_port, n->cable_ns,
	};
	n->wired = false;
	n->parent = n->place.a;
	n->parent_port = n->place.a_port;
	n->child_port = n->place.b_port;
	n->cable_ns = n->place.cable_ns;
}

/* @first hangs behind itself: the last wire to a port that had no cable opens that */
static int open_loop(struct ec_desc *d, int first)
{
	int at = first, found = -1;

	do {
		const struct ec_desc_node *n = &d->node[at];

		if (n->wired && n->child_port != n->place.b_port &&
		    (found < 0 || n->place.line > d->node[found].place.line))
			found = at;
		at = n->parent;
	} while (at != first);
	if (found < 0)
		return -1;
	add_cable(d, found);
	return d->node[found].parent;
}

/**
 * ec_desc_add_loops() - wires that begin behind the slave at which they end
 * @d: description, all statements were read
 *
 * Such a wire replaces no cable, as the slave would be connected with itself only.
 *
 * Context: Process. May sleep.
 */
void ec_desc_add_loops(struct ec_desc *d)
{
	for (u32 i = 0; i < d->n_nodes; i++) {
		int at = (int)i;

		while (at >= 0 && (!d->node[at].walk || d->node[at].walk == i + 1)) {
			if (d->node[at].walk) {
				at = open_loop(d, at);
				continue;
			}
			d->node[at].walk = i + 1;
			at = d->node[at].parent;
		}
	}
}
