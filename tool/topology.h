/* SPDX-License-Identifier: GPL-2.0-only */
/* How the slaves are connected, and the way of a frame through them. */
#ifndef EC_TOOL_TOPOLOGY_H
#define EC_TOOL_TOPOLOGY_H

#include "dev.h"

/**
 * struct topo - the tree of a master
 * @n: slaves
 * @node: by ring position
 * @order: struct ect_node, upstream first
 * @way: struct ect_arrival, in the order in which a frame arrives
 */
struct topo {
	size_t n;
	const struct ect_node **node;
	struct ect_list *order;
	struct ect_list *way;
};

int topo_build(struct topo *t, const struct slaves *all);
void topo_free(struct topo *t);

#endif
