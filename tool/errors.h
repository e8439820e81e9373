/* SPDX-License-Identifier: GPL-2.0-only */
/* Error counters of a slave's ports. */
#ifndef EC_TOOL_ERRORS_H
#define EC_TOOL_ERRORS_H

#include "../master/wire/regs.h"
#include "reg.h"

int errors_read(struct dev *d, const struct ect_slave *s, struct ect_errors *e);

static inline u8 err_rx(const struct ect_errors *e, unsigned int port)
{
	return e->ports[port].invalid;
}

static inline u8 err_phy(const struct ect_errors *e, unsigned int port)
{
	return e->ports[port].receiver;
}

static inline u8 err_fwd(const struct ect_errors *e, unsigned int port)
{
	return e->ports[port].forwarded;
}

static inline u8 err_lost(const struct ect_errors *e, unsigned int port)
{
	return e->ports[port].lost_link;
}

#endif
