/* SPDX-License-Identifier: GPL-2.0-only */
/* How the slaves are connected, and the way of a frame through them. */
#ifndef EC_TOOL_TOPOLOGY_H
#define EC_TOOL_TOPOLOGY_H

#include "dev.h"

#define TOPO_MASTER	0xffffffffU

/**
 * struct topo_node - a slave
 * @parent: slave upstream, TOPO_MASTER: none
 * @parent_port: its port
 * @port: own port towards @parent or the master
 * @depth: branches that it is away from the first line
 * @last: no slave follows in its line
 * @device: of a slave at the master: 0 main, 1 backup
 */
struct topo_node {
	u32 parent;
	u8 parent_port;
	u8 port;
	u32 depth;
	bool last;
	u8 device;
};

/* a port at which a frame arrives */
struct topo_rx {
	u32 slave;
	u32 port;
};

/**
 * struct topo - the tree of a master
 * @n: slaves
 * @node: by ring position
 * @order: ring positions, upstream first
 * @rx_n: number of @rx
 * @rx: in the order in which a frame arrives
 */
struct topo {
	size_t n;
	struct topo_node *node;
	u32 *order;
	size_t rx_n;
	struct topo_rx *rx;
};

int topo_build(struct topo *t, const struct slaves *all);
void topo_free(struct topo *t);
bool topo_peer(const struct slaves *all, unsigned int slave, unsigned int port, u32 *peer,
	       unsigned int *peer_port);

#endif
