/* SPDX-License-Identifier: GPL-2.0-only */
/* Ethernet ports of simulated switches that end in interfaces of this computer. */
#ifndef EC_SIM_UPLINK_H
#define EC_SIM_UPLINK_H

#include "../../devices/sim/app.h"
#include "offload.h"
#include "port.h"

#define UPLINKS	8

/**
 * struct uplink - an Ethernet port of a slave
 * @app: the slave
 * @port: interface; of a tap only its descriptor
 * @offload: frame from an interface, of which segments may wait; NULL: a tap of this program
 * @dropped: frames too long, or not sent
 */
struct uplink {
	struct ec_app *app;
	struct port port;
	struct offload *offload;
	u64 dropped;
};

int uplink_open(struct uplink *u, struct ec_sim *sim, const char *text);
void uplink_close(struct uplink *u);
void uplink_out(struct uplink *u);
bool uplink_waits(const struct uplink *u);
void uplink_in(struct uplink *u, u64 now);

#endif
