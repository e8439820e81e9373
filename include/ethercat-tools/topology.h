/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: how the slaves are connected, and the way of a frame through them. */
#ifndef ETHERCAT_TOOLS_TOPOLOGY_H
#define ETHERCAT_TOOLS_TOPOLOGY_H

#include "slave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* a slave in the tree */
struct ect_node {
	uint32_t struct_size;
	uint32_t slave;		/* ring position */
	uint32_t parent;	/* ring position of the slave upstream, ECT_NONE32: the master */
	uint32_t parent_port;
	uint32_t port;		/* own port, towards @parent or the master */
	uint32_t depth;		/* branches between it and the first line */
	uint32_t last;		/* no slave follows in its line */
	uint32_t device;	/* of a slave at the master: 0 main, 1 backup */
};

/* a port at which a frame arrives */
struct ect_arrival {
	uint32_t struct_size;
	uint32_t slave;		/* ring position */
	uint32_t port;
	uint32_t reserved;
};

/**
 * ect_topology() - the tree of the slaves
 * @slaves: list of ect_slaves_read()
 * @nodes: result, elements are struct ect_node, a slave before those downstream of it
 * @way: NULL, or result, elements are struct ect_arrival in the order in which a frame arrives
 *
 * Slaves without connection to the first one are further trees at the master: those at its backup
 * device, for example.
 *
 * Context: Any thread, while no other one frees the list.
 * Return: 0 or -ENOMEM.
 */
int ect_topology(const struct ect_list *slaves, struct ect_list **nodes, struct ect_list **way);

/**
 * ect_peer() - the other end of a cable
 * @slaves: list of ect_slaves_read()
 * @slave: ring position
 * @port: of this slave
 * @peer: set to the ring position of the slave at the other end
 * @peer_port: set to its port, %ECT_PORTS: not known
 *
 * Context: Any thread, while no other one frees the list.
 * Return: 1, or 0: no slave is connected.
 */
int ect_peer(const struct ect_list *slaves, unsigned int slave, unsigned int port, uint32_t *peer,
	     uint32_t *peer_port);

#ifdef __cplusplus
}
#endif

#endif
