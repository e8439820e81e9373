// SPDX-License-Identifier: GPL-2.0-only
#include "../link/links.h"
#include "slave.h"
#include "scan.h"

/* of receive times; the way through any port and back takes longer */
#define NOISE_NS	40

/* order in which a frame passes the ports of a slave (ETG.1000.4 clause 6.2) */
static const u8 order[EC_MAX_PORT] = { 0, 3, 1, 2 };

static bool port_open(const struct ec_slave *s, unsigned int port)
{
	return s->dl_status & EC_DLS_COMM(port) && !(s->dl_status & EC_DLS_LOOP(port));
}

/* place of each port in that order */
static const u8 place[EC_MAX_PORT] = { 0, 2, 3, 1 };

static bool topology_has_times(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_DC;
}

/*
 * The port the frame comes in by: the open one that latched first. Without receive
 * times (no DC) it is port 0; with that closed the last one, so that all others come
 * behind the processing unit, as usual.
 */
static u8 upstream(const struct ec_slave *s)
{
	int best = -1;
	unsigned int i;

	for (i = 0; i < EC_MAX_PORT; i++) {
		u8 p = order[i];

		if (!port_open(s, p))
			continue;
		if (best < 0 ||
		    (topology_has_times(s) ? (s32)(s->recv[p] - s->recv[best]) < -NOISE_NS :
					     best != 0))
			best = p;
	}
	return max(best, 0);
}

/* the port a frame passes as number @step after its entry */
static u8 port_at(const struct ec_slave *s, unsigned int step)
{
	return order[(place[s->upstream] + step) % EC_MAX_PORT];
}

/* Number of port 0 likewise: behind it is the processing unit; 0: the entry is port 0. */
static unsigned int unit_step(const struct ec_slave *s)
{
	return (EC_MAX_PORT - place[s->upstream]) % EC_MAX_PORT;
}

/* Next open port without a slave behind it, of those behind the processing unit, or -1. */
static int next_port(const struct ec_slave *s)
{
	unsigned int step;

	for (step = unit_step(s) + 1; step < EC_MAX_PORT; step++) {
		u8 p = port_at(s, step);

		if (port_open(s, p) && s->next[p] == EC_UAPI_NONE16)
			return p;
	}
	return -1;
}

/* How long the frame was behind the port; with @all: behind all up to it. */
static u32 away(const struct ec_slave *s, unsigned int step, bool all)
{
	u8 from = s->upstream, to = s->upstream;
	unsigned int i;

	for (i = 1; i <= step; i++) {
		u8 p = port_at(s, i);

		if (!port_open(s, p))
			continue;
		from = all ? from : to;
		to = p;
	}
	return s->recv[to] - s->recv[from];
}

static int parent_of(const struct ec_slave *s)
{
	return s->next[s->upstream] == EC_UAPI_NONE16 ? -1 : s->next[s->upstream];
}

/*
 * The branch behind a port that the frame passes before the processing unit: it ends
 * with slave @last, and is the largest one that fits in the time the frame was away.
 */
static int branch_before(struct ec_slave **slaves, int last, const struct ec_slave *s,
			 unsigned int step)
{
	u32 time = away(s, step, false);
	int x = last, up = last;

	if (last < 0 || next_port(slaves[last]) >= 0)
		return -1;
	while ((up = parent_of(slaves[up])) >= 0 && next_port(slaves[up]) < 0) {
		if (!topology_has_times(slaves[up]))
			continue;
		if (away(slaves[up], EC_MAX_PORT - 1, true) >= time)
			break;
		x = up;
	}
	return x;
}

/* the one of a branch that comes first in the ring */
static int first_of(struct ec_slave **slaves, int x)
{
	unsigned int step = 1;

	while (step <= unit_step(slaves[x])) {
		u16 next = slaves[x]->next[port_at(slaves[x], step)];

		step++;
		if (next != EC_UAPI_NONE16) {
			x = next;
			step = 1;
		}
	}
	return x;
}

static void join(struct ec_slave **slaves, int parent, u8 port, int child)
{
	slaves[parent]->next[port] = child;
	slaves[child]->next[slaves[child]->upstream] = parent;
}

static void topology_leave(struct ec_slave **slaves, int child)
{
	int parent = parent_of(slaves[child]);
	unsigned int p;

	for (p = 0; parent >= 0 && p < EC_MAX_PORT; p++)
		if (slaves[parent]->next[p] == child)
			slaves[parent]->next[p] = EC_UAPI_NONE16;
	slaves[child]->next[slaves[child]->upstream] = EC_UAPI_NONE16;
}

/* Slaves that precede @i because they are behind its port 0; returns the last one before. */
static int join_before(struct ec_slave **slaves, int i)
{
	struct ec_slave *s = slaves[i];
	unsigned int step;
	int last = i - 1;

	for (step = unit_step(s); step; step--) {
		u8 p = port_at(s, step);
		int x = port_open(s, p) ? branch_before(slaves, last, s, step) : -1;

		if (x < 0)
			continue;
		topology_leave(slaves, x);
		join(slaves, i, p, x);
		last = first_of(slaves, x) - 1;
	}
	return last;
}

/* Hang @i at the nearest slave up to @parent that has a free port. */
static void hang(struct ec_slave **slaves, int i, int parent)
{
	while (parent >= 0) {
		struct ec_slave *s = slaves[parent];
		int port = next_port(s), up = parent_of(s);

		if (port >= 0) {
			join(slaves, parent, port, i);
			return;
		}
		/* up: its parent, or when that is unknown the slave before */
		parent = up >= 0 && up < parent ? up : parent - 1;
	}
}

/* The first slave with an open port that leads nowhere, or without a slave upstream; or @n. */
static unsigned int misfit(struct ec_slave **slaves, unsigned int n)
{
	unsigned int i, p, first = n, roots = 0, free = 0;

	for (i = 0; i < n; i++) {
		struct ec_slave *s = slaves[i];
		bool bad = parent_of(s) < 0 && roots++;

		/* what it says of its ports was guessed */
		if (READ_ONCE(s->silent) || !s->regs[EC_REG_TYPE])
			return n;
		for (p = 0; p < EC_MAX_PORT; p++)
			if (p != s->upstream && port_open(s, p) && s->next[p] == EC_UAPI_NONE16) {
				free++;
				bad = true;
			}
		first = bad ? min(first, i) : first;
	}
	/* the one that leads to the other device of a ring */
	if (n && free == 1 && roots == 1 && ec_links_ring_end_up(slaves[0]->bus->links))
		return n;
	return first;
}

/**
 * ec_topology_build() - find the slave at each port
 * @slaves: by ring position, with DL status and receive times
 * @n: entries in @slaves
 *
 * Each slave hangs at the nearest earlier slave that has a free open port. A frame
 * goes through the processing unit when it comes from port 0: what hangs there at a
 * slave that is connected by another port precedes it in the ring.
 *
 * Context: Process.
 */
void ec_topology_build(struct ec_slave **slaves, unsigned int n)
{
	unsigned int i, p, first;

	for (i = 0; i < n; i++) {
		slaves[i]->upstream = upstream(slaves[i]);
		for (p = 0; p < EC_MAX_PORT; p++)
			slaves[i]->next[p] = EC_UAPI_NONE16;
	}
	for (i = 0; i < n; i++)
		hang(slaves, i, join_before(slaves, i));
	for (i = 0; i < n; i++)
		for (p = 0; p < EC_MAX_PORT; p++)
			if (p != slaves[i]->upstream && slaves[i]->next[p] < n)
				slaves[slaves[i]->next[p]]->parent_port = p;
	first = misfit(slaves, n);
	for (i = 0; i < n; i++)
		WRITE_ONCE(slaves[i]->topology_inconsistent, i >= first);
	if (first < n)
		ec_slave_warn(slaves[first],
			      "open ports inconsistent with ring order from this slave on; delays unreliable: check cables, then rescan\n");
}
