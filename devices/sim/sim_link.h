/* SPDX-License-Identifier: GPL-2.0-only */
/* A segment as a virtual device. */
#ifndef EC_SIM_LINK_H
#define EC_SIM_LINK_H

#include "sim.h"

struct ec_sim_link;
struct ec_sim_wire;

struct ec_sim_link *ec_sim_link_create(const char *name, const u8 *mac, struct ec_sim *sim,
				       u64 start_ns);
struct ec_sim_wire *ec_sim_link_wire(struct ec_sim_link *l);
void ec_sim_link_destroy(struct ec_sim_link *l);

#endif
