/* SPDX-License-Identifier: GPL-2.0-only */
/* A network interface, by packet socket. */
#ifndef EC_SIM_PORT_H
#define EC_SIM_PORT_H

#include <linux/virtio_net.h>
#include <net/if.h>
#include <stdbool.h>
#include <stddef.h>

/**
 * struct port - interface at which a master is
 * @name: of the interface, as given
 * @index: of the interface
 * @fd: packet socket, -1: none
 * @claim: socket whose name says that the interface is taken, -1: none
 * @all: it receives all frames, and those that wait for an offload, see @offload
 * @offload: of the last frame received: what the sender has left to its card
 * @down: the interface is down
 * @gone: the interface does not exist any more
 */
struct port {
	char name[IF_NAMESIZE];
	int index;
	int fd;
	int claim;
	bool all;
	struct virtio_net_hdr offload;
	bool down;
	bool gone;
};

int port_open(struct port *p, const char *name, bool all);
void port_close(struct port *p);
void port_check(struct port *p);
int port_receive(struct port *p, void *buf, size_t cap);
int port_send(struct port *p, const void *buf, size_t len);

#endif
