/* SPDX-License-Identifier: GPL-2.0-only */
/* Files in debugfs at which running segments take faults. */
#ifndef EC_SIM_CONTROL_H
#define EC_SIM_CONTROL_H

#include "sim_wire.h"

void ec_sim_control_init(void);
void ec_sim_control_exit(void);
void ec_sim_control_add(const char *name, struct ec_sim_wire *w);

#endif
