/* SPDX-License-Identifier: GPL-2.0-only */
/* A segment as a virtual device, a ring as two. */
#ifndef EC_SIM_LINK_H
#define EC_SIM_LINK_H

#include "sim.h"

struct ec_sim_link;
struct ec_sim_wire;

struct ec_sim_link *ec_sim_link_create(const char *name, const u8 *mac, struct ec_sim *sim,
				       u64 start_ns);
int ec_sim_link_second(struct ec_sim_link *l, const char *name, const u8 *mac);
void ec_sim_link_keep(struct ec_sim_link *l);
void ec_sim_link_second_withdraw(struct ec_sim_link *l);
struct ec_sim_wire *ec_sim_link_wire(struct ec_sim_link *l);
void ec_sim_link_destroy(struct ec_sim_link *l);

#endif
