/* SPDX-License-Identifier: GPL-2.0-only */
/* The segment in real time. */
#ifndef EC_SIM_RUN_H
#define EC_SIM_RUN_H

#include "port.h"
#include "sim.h"
#include "uplink.h"

int run_segment(struct ec_sim *sim, struct port *ports, int n_ports, struct uplink *uplinks,
		int n_uplinks, int control, bool verbose);

#endif
