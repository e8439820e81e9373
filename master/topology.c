// SPDX-License-Identifier: GPL-2.0-only
#include "slave.h"

/* order in which a frame passes the ports of a slave (ETG.1000.4 clause 6.2) */
static const u8 order[EC_MAX_PORT] = { 0, 3, 1, 2 };

static bool port_open(const struct ec_slave *s, unsigned int port)
{
	return s->dl_status & EC_DLS_COMM(port) && !(s->dl_status & EC_DLS_LOOP(port));
}

/* place of @port in the processing order */
static unsigned int place(unsigned int port)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_PORT; i++)
		if (order[i] == port)
			return i;
	return 0;
}

/*
 * The port the frame comes in by: the open one that latched first. Without
 * receive times (no DC) it is port 0.
 */
static u8 upstream(const struct ec_slave *s)
{
	unsigned int p;
	u8 best = 0;

	if (!(ec_slave_features(s) & EC_FEAT_DC) || !port_open(s, 0))
		return 0;
	for (p = 1; p < EC_MAX_PORT; p++)
		if (port_open(s, p) && (s32)(s->recv[p] - s->recv[best]) < 0)
			best = p;
	return best;
}

/* Next open downstream port behind @from in processing order, or -1. */
static int next_port(const struct ec_slave *s, unsigned int from)
{
	unsigned int i, start = place(s->upstream);

	for (i = from; i < EC_MAX_PORT; i++) {
		unsigned int p = order[(start + i) % EC_MAX_PORT];

		if (p != s->upstream && port_open(s, p) && s->next[p] == EC_UAPI_NONE16)
			return p;
	}
	return -1;
}

/**
 * ec_topology_build() - find who hangs at which port
 * @slaves: by ring position, with DL status and receive times
 * @n: entries in @slaves
 *
 * Each slave hangs at the nearest earlier slave that has a free open port.
 *
 * Context: Process.
 */
void ec_topology_build(struct ec_slave **slaves, unsigned int n)
{
	unsigned int i, p;
	int parent;

	for (i = 0; i < n; i++) {
		slaves[i]->upstream = upstream(slaves[i]);
		for (p = 0; p < EC_MAX_PORT; p++)
			slaves[i]->next[p] = EC_UAPI_NONE16;
	}
	for (i = 1; i < n; i++) {
		for (parent = i - 1; parent >= 0;) {
			struct ec_slave *s = slaves[parent];
			int port = next_port(s, 1);

			if (port >= 0) {
				s->next[port] = i;
				slaves[i]->next[slaves[i]->upstream] = parent;
				break;
			}
			/* up: its parent, or when that is unknown the slave before */
			parent = s->next[s->upstream] < parent ?
				 s->next[s->upstream] : parent - 1;
		}
	}
}
