/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Why a port is closed although it has a link, for the kernel log and for tools. */
#ifndef EC_WIRE_PORT_TEXT_H
#define EC_WIRE_PORT_TEXT_H

#include "env.h"

/**
 * struct ec_port_text - a reason, in words
 * @reason: behind "port 2 stays closed: "
 * @remedy: what to do
 * @device: a device is kept behind it, which a user can let in
 */
struct ec_port_text {
	const char *reason;
	const char *remedy;
	bool device;
};

const struct ec_port_text *ec_port_text(u32 kept);

#endif
