/* SPDX-License-Identifier: GPL-2.0-only */
/* Which slave hangs at which port of which one. */
#ifndef EC_GRAPH_H
#define EC_GRAPH_H

#include <linux/types.h>
#include "../wire/regs.h"

struct ec_slave;

/* order in which a frame passes the ports of a slave (ETG.1000.4 clause 6.2) */
extern const u8 ec_graph_order[EC_MAX_PORT];

u8 ec_graph_open_ports(u16 dl_status);
bool ec_graph_is_open(const struct ec_slave *s, unsigned int port);
struct ec_slave *ec_graph_parent(const struct ec_slave *s);
bool ec_graph_is_reversed(const struct ec_slave *s);
int ec_graph_free_port(const struct ec_slave *s);
bool ec_graph_next_arrival(struct ec_slave **slave, unsigned int *port);
void ec_graph_leave(struct ec_slave *s);
void ec_graph_note_ports(struct ec_slave *s);
void ec_graph_make_room(struct ec_slave *last, struct ec_slave *next);
unsigned int ec_graph_place(const struct ec_slave *s, unsigned int port);
void ec_graph_fit(struct ec_slave **slaves, unsigned int n);
unsigned int ec_graph_misfit(struct ec_slave **slaves, unsigned int n);

#endif
