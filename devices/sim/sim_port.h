/* SPDX-License-Identifier: GPL-2.0-only */
/* Ethernet ports of simulated switches (eoe=switch) as network devices. */
#ifndef EC_SIM_PORT_H
#define EC_SIM_PORT_H

#include "sim_wire.h"

int ec_sim_port_add(const char *name, struct ec_sim_wire *w, u32 index);
void ec_sim_port_exit(void);

#endif
