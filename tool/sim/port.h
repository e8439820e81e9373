/* SPDX-License-Identifier: GPL-2.0-only */
/* A network interface, by packet socket. */
#ifndef EC_SIM_PORT_H
#define EC_SIM_PORT_H

#include <net/if.h>
#include <stdbool.h>
#include <stddef.h>

/**
 * struct port - interface at which a master is
 * @name: of the interface, as given
 * @index: of the interface
 * @fd: packet socket, -1: none
 * @claim: socket whose name says that the interface is taken, -1: none
 * @down: the interface is down
 * @gone: the interface does not exist any more
 */
struct port {
	char name[IF_NAMESIZE];
	int index;
	int fd;
	int claim;
	bool down;
	bool gone;
};

int port_open(struct port *p, const char *name, bool all);
void port_close(struct port *p);
void port_check(struct port *p);
int port_receive(struct port *p, void *buf, size_t cap);
int port_send(struct port *p, const void *buf, size_t len);

#endif
