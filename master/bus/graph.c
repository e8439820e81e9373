// SPDX-License-Identifier: GPL-2.0-only
/*
 * The bus is a graph: slaves joined at their ports. Ring order and registers say where a new slave
 * hangs; the neighbors of a slave whose place and ports are unchanged stay.
 */
#include "../link/links.h"
#include "graph.h"
#include "slave.h"

/* of receive times; the way through any port and back takes longer */
#define NOISE_NS	40

const u8 ec_graph_order[EC_MAX_PORT] = { 0, 3, 1, 2 };

/**
 * ec_graph_open_ports() - by which ports do frames leave a slave?
 * @dl_status: its DL status (register 0x0110)
 *
 * Context: Any.
 * Return: bit mask of these ports.
 */
u8 ec_graph_open_ports(u16 dl_status)
{
	unsigned int p;
	u8 open = 0;

	for (p = 0; p < EC_MAX_PORT; p++)
		if (dl_status & EC_DLS_COMM(p) && !(dl_status & EC_DLS_LOOP(p)))
			open |= BIT(p);
	return open;
}

/**
 * ec_graph_is_open() - do frames leave a slave by a port?
 * @s: slave
 * @port: port
 *
 * By the DL status read last.
 *
 * Context: Any.
 * Return: whether they do.
 */
bool ec_graph_is_open(const struct ec_slave *s, unsigned int port)
{
	return ec_graph_open_ports(s->dl_status) & BIT(port);
}

/* place of each port in that order */
static const u8 place[EC_MAX_PORT] = { 0, 2, 3, 1 };

static bool has_times(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_DC;
}

static bool in_ring(const struct ec_slave *s)
{
	return !s->bus->links->only;
}

/* Is it the first one behind a break? Seen from the main device it hangs nowhere. */
static bool is_behind_break(const struct ec_slave *s)
{
	return in_ring(s) && s->position && s->position == s->bus->front;
}

/*
 * The port the frame comes in by: the open one that latched first. Without receive
 * times (no DC) it is port 0; with that closed the last one, so that all others come
 * behind the processing unit, as usual. In a ring it is port 0, since a port from which no frame
 * returns has no receive time.
 */
static u8 entry_of(const struct ec_slave *s)
{
	int best = -1;
	unsigned int i;

	if (in_ring(s))
		return 0;
	for (i = 0; i < EC_MAX_PORT; i++) {
		u8 p = ec_graph_order[i];

		if (!ec_graph_is_open(s, p))
			continue;
		if (best < 0 ||
		    (has_times(s) ? (s32)(s->recv[p] - s->recv[best]) < -NOISE_NS :
					     best != 0))
			best = p;
	}
	return max(best, 0);
}

/* the port a frame passes as number @step after its entry */
static u8 port_at(const struct ec_slave *s, unsigned int step)
{
	return ec_graph_order[(place[s->graph.upstream] + step) % EC_MAX_PORT];
}

/* and the number of a port */
static unsigned int step_of(const struct ec_slave *s, unsigned int port)
{
	return (place[port] + EC_MAX_PORT - place[s->graph.upstream]) % EC_MAX_PORT;
}

/* Number of port 0 likewise: behind it is the processing unit; 0: the entry is port 0. */
static unsigned int unit_step(const struct ec_slave *s)
{
	return step_of(s, 0);
}

/* Next open port without a slave behind it, of those behind the processing unit, or -1. */
static int next_port(const struct ec_slave *s)
{
	unsigned int step;

	for (step = unit_step(s) + 1; step < EC_MAX_PORT; step++) {
		u8 p = port_at(s, step);

		if (ec_graph_is_open(s, p) && !s->graph.at[p])
			return p;
	}
	return -1;
}

/* How long the frame was behind the port; with @all: behind all up to it. */
static u32 away(const struct ec_slave *s, unsigned int step, bool all)
{
	u8 from = s->graph.upstream, to = s->graph.upstream;
	unsigned int i;

	for (i = 1; i <= step; i++) {
		u8 p = port_at(s, i);

		if (!ec_graph_is_open(s, p))
			continue;
		from = all ? from : to;
		to = p;
	}
	return s->recv[to] - s->recv[from];
}

/**
 * ec_graph_parent() - the neighbor of a slave towards the main device
 * @s: slave of the list
 *
 * Context: The monitor thread, or as for ec_bus_assert_stays().
 * Return: that slave, or NULL.
 */
struct ec_slave *ec_graph_parent(const struct ec_slave *s)
{
	return s->graph.at[s->graph.upstream];
}

/**
 * ec_graph_is_reversed() - do frames pass a slave in the other direction than in a closed ring?
 * @s: slave of the list
 *
 * Context: Any.
 * Return: whether it is behind the break of a ring.
 */
bool ec_graph_is_reversed(const struct ec_slave *s)
{
	return in_ring(s) && s->position >= READ_ONCE(s->bus->front);
}

/**
 * ec_graph_free_port() - a port by which frames leave a slave although none is known there
 * @s: slave of the list
 *
 * Context: The monitor thread, or as for ec_bus_assert_stays().
 * Return: port, or -1: there is none.
 */
int ec_graph_free_port(const struct ec_slave *s)
{
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++)
		if (p != s->graph.upstream && ec_graph_is_open(s, p) && !s->graph.at[p])
			return p;
	return -1;
}

/**
 * ec_graph_next_arrival() - where does a frame arrive next?
 * @slave: slave of the list at which it arrives; the next one
 * @port: by this port; the next one
 *
 * Context: As ec_graph_parent().
 * Return: false: at the main device.
 */
bool ec_graph_next_arrival(struct ec_slave **slave, unsigned int *port)
{
	struct ec_slave *s = *slave, *next;
	unsigned int step = step_of(s, *port);

	while (++step < EC_MAX_PORT) {
		next = s->graph.at[port_at(s, step)];
		if (!next)
			continue;
		*slave = next;
		*port = next->graph.upstream;
		return true;
	}
	*port = s->graph.parent_port;
	*slave = ec_graph_parent(s);
	return *slave;
}

/*
 * The branch behind a port that the frame passes before the processing unit: it ends
 * with slave @last, and is the largest one that fits in the time the frame was away.
 */
static struct ec_slave *branch_before(struct ec_slave *last, const struct ec_slave *s,
				      unsigned int step)
{
	u32 time = away(s, step, false);
	struct ec_slave *x = last, *up = last;

	if (!last || next_port(last) >= 0)
		return NULL;
	while ((up = ec_graph_parent(up)) && next_port(up) < 0) {
		if (!has_times(up))
			continue;
		if (away(up, EC_MAX_PORT - 1, true) >= time)
			break;
		x = up;
	}
	return x;
}

/* the one of a branch that comes first in the ring */
static struct ec_slave *first_of(struct ec_slave *x)
{
	unsigned int step = 1;

	while (step <= unit_step(x)) {
		struct ec_slave *next = x->graph.at[port_at(x, step)];

		step++;
		if (next) {
			x = next;
			step = 1;
		}
	}
	return x;
}

/* the one of a branch that comes last in the ring */
static const struct ec_slave *last_of(const struct ec_slave *x)
{
	unsigned int step = EC_MAX_PORT;

	while (--step > unit_step(x)) {
		const struct ec_slave *next = x->graph.at[port_at(x, step)];

		if (next) {
			x = next;
			step = EC_MAX_PORT;
		}
	}
	return x;
}

/**
 * ec_graph_place() - the ring position of the first slave that would be behind a port
 * @s: slave of the list
 * @port: its port, without a neighbor
 *
 * Context: The monitor thread, or as for ec_bus_assert_stays().
 * Return: ring position.
 */
unsigned int ec_graph_place(const struct ec_slave *s, unsigned int port)
{
	unsigned int unit = unit_step(s), step = 1, k;

	while (port_at(s, step) != port)
		step++;
	if (step > unit) {
		/* behind the slave, and what hangs at the ports in between */
		while (--step > unit)
			if (s->graph.at[port_at(s, step)])
				return last_of(s->graph.at[port_at(s, step)])->position + 1;
		return s->position + 1;
	}
	for (k = step + 1; k <= unit; k++)
		if (s->graph.at[port_at(s, k)])
			return first_of(s->graph.at[port_at(s, k)])->position;
	return s->position;
}

static struct ec_slave *before(struct ec_slave **slaves, const struct ec_slave *s)
{
	return s->position ? slaves[s->position - 1] : NULL;
}

static void join(struct ec_slave *parent, u8 port, struct ec_slave *child)
{
	parent->graph.at[port] = child;
	child->graph.at[child->graph.upstream] = parent;
	child->graph.parent_port = port;
	child->graph.hung = true;
}

/* The neighbor at @port is none any more; what hung at @s is to be hung again. */
static void part(struct ec_slave *s, unsigned int port)
{
	struct ec_slave *next = s->graph.at[port];
	unsigned int p;

	if (!next)
		return;
	s->graph.at[port] = NULL;
	if (port == s->graph.upstream)
		s->graph.hung = false;
	for (p = 0; p < EC_MAX_PORT; p++) {
		if (next->graph.at[p] != s)
			continue;
		next->graph.at[p] = NULL;
		if (p == next->graph.upstream)
			next->graph.hung = false;
	}
}

/**
 * ec_graph_leave() - a slave has no neighbors any more
 * @s: slave
 *
 * Those that hung at it are hung again by ec_graph_fit().
 *
 * Context: The monitor thread, while no reader uses the list, or for a slave in no list.
 */
void ec_graph_leave(struct ec_slave *s)
{
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++)
		part(s, p);
	s->graph.hung = false;
}

/**
 * ec_graph_note_ports() - take over DL status and receive times of a slave
 * @s: slave, with both as read
 *
 * A neighbor behind a port that is closed now is none any more; with another entry none is.
 *
 * Context: As ec_graph_leave().
 */
void ec_graph_note_ports(struct ec_slave *s)
{
	u8 entry = entry_of(s);
	unsigned int p;

	if (entry != s->graph.upstream)
		ec_graph_leave(s);
	s->graph.upstream = entry;
	for (p = 0; p < EC_MAX_PORT; p++)
		if (!ec_graph_is_open(s, p))
			part(s, p);
	/* a break that has healed */
	if (in_ring(s) && !s->graph.at[entry])
		s->graph.hung = false;
}

/* Slaves that precede @s because they are behind its port 0; returns the last one before. */
static struct ec_slave *join_before(struct ec_slave **slaves, struct ec_slave *s)
{
	struct ec_slave *last = before(slaves, s);
	unsigned int step;

	for (step = unit_step(s); step; step--) {
		u8 p = port_at(s, step);
		struct ec_slave *x = s->graph.at[p];

		if (!x && ec_graph_is_open(s, p))
			x = branch_before(last, s, step);
		if (!x)
			continue;
		if (x != s->graph.at[p]) {
			part(x, x->graph.upstream);
			join(s, p, x);
		}
		last = before(slaves, first_of(x));
	}
	return last;
}

/* Hang @s at the nearest slave up to @parent that has a free port, or at the main device. */
static void hang(struct ec_slave **slaves, struct ec_slave *s, struct ec_slave *parent)
{
	s->graph.hung = true;
	if (is_behind_break(s))
		return;
	while (parent) {
		struct ec_slave *up = ec_graph_parent(parent);
		int port = next_port(parent);

		if (port >= 0) {
			join(parent, port, s);
			return;
		}
		/* up: its parent, or when that is unknown the slave before */
		parent = up && up->position < parent->position ? up : before(slaves, parent);
	}
}

/**
 * ec_graph_make_room() - a slave that hangs where others were found before it hangs behind these
 * @last: slave before those in the ring, NULL: there is none
 * @next: slave after them
 *
 * Context: As ec_graph_leave().
 */
void ec_graph_make_room(struct ec_slave *last, struct ec_slave *next)
{
	const struct ec_slave *top = ec_graph_parent(next);

	for (; last; last = ec_graph_parent(last)) {
		if (next_port(last) >= 0)
			return;
		if (last == top)
			break;
	}
	part(next, next->graph.upstream);
	next->graph.hung = false;
}

/**
 * ec_graph_fit() - find the place of those slaves that hang nowhere
 * @slaves: by ring position, @position set, after ec_graph_note_ports()
 * @n: entries in @slaves
 *
 * Each hangs at the nearest earlier slave that has a free open port. A frame goes through the
 * processing unit when it comes from port 0: what hangs there at a slave that is connected by
 * another port precedes it in the ring.
 *
 * Context: As ec_graph_leave().
 */
void ec_graph_fit(struct ec_slave **slaves, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		if (!slaves[i]->graph.hung)
			hang(slaves, slaves[i], join_before(slaves, slaves[i]));
}

/* The first slave that a frame along the graph from @root on does not pass in its turn. */
static unsigned int out_of_turn(struct ec_slave *root, unsigned int turn, unsigned int n)
{
	unsigned int port = root->graph.upstream, arrivals, from, to;
	struct ec_slave *s = root, *at = root;

	for (arrivals = 0; s && arrivals < 2 * n; arrivals++) {
		from = step_of(s, port);
		to = EC_MAX_PORT;
		if (ec_graph_next_arrival(&at, &port) && ec_graph_parent(at) == s)
			to = step_of(s, at->graph.parent_port);
		/* behind port 0 is the processing unit */
		if (unit_step(s) >= from && unit_step(s) < to && s->position != turn++)
			return min(turn, s->position + 1) - 1;
		s = at;
	}
	return n;
}

/**
 * ec_graph_misfit() - look for a contradiction between ring order and ports
 * @slaves: as for ec_graph_fit(), after it
 * @n: entries in @slaves
 *
 * Context: As ec_graph_leave().
 * Return: position of the first slave with an open port that leads nowhere, or without one
 * upstream, or that a frame does not pass in its turn; @n: there is none, or what a slave says of
 * its ports was guessed.
 */
unsigned int ec_graph_misfit(struct ec_slave **slaves, unsigned int n)
{
	unsigned int i, p, first = n, roots = 0, free = 0;
	struct ec_slave *root = NULL, *second = NULL;

	for (i = 0; i < n; i++) {
		struct ec_slave *s = slaves[i];
		bool behind = is_behind_break(s), bad = !ec_graph_parent(s) && !behind && roots++;

		if (behind)
			second = s;
		else
			root = ec_graph_parent(s) ? root : s;
		if (READ_ONCE(s->reply.silent) || !s->regs[EC_REG_TYPE])
			return n;
		for (p = 0; p < EC_MAX_PORT; p++)
			if (p != s->graph.upstream && ec_graph_is_open(s, p) && !s->graph.at[p]) {
				free++;
				bad = true;
			}
		first = bad ? min(first, i) : first;
	}
	/* the one that leads to the other device of a ring */
	if (n && free == 1 && roots == 1 && ec_links_ring_end_up(slaves[0]->bus->links))
		first = n;
	if (first == n && root)
		first = out_of_turn(root, 0, n);
	return first == n && second ? out_of_turn(second, second->position, n) : first;
}
