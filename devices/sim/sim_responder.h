/* SPDX-License-Identifier: GPL-2.0-only */
/* A segment that answers at network devices. */
#ifndef EC_SIM_RESPONDER_H
#define EC_SIM_RESPONDER_H

#include "sim.h"

struct ec_sim_responder;
struct ec_sim_wire;

struct ec_sim_responder *ec_sim_responder_create(char *const *names, unsigned int n,
						 struct ec_sim *sim);
struct ec_sim_wire *ec_sim_responder_wire(struct ec_sim_responder *r);
void ec_sim_responder_destroy(struct ec_sim_responder *r);

#endif
