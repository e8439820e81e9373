/* SPDX-License-Identifier: GPL-2.0-only */
/* Socket at which a running segment takes faults. */
#ifndef EC_SIM_CONTROL_H
#define EC_SIM_CONTROL_H

#include "sim.h"

int control_open(const char *path);
void control_receive(int fd, struct ec_sim *sim);
void control_close(int fd, const char *path);
int control_tell(const char *path, const char *text);

#endif
