/* SPDX-License-Identifier: GPL-2.0-only */
/* Error counters of a slave's ports, registers 0x0300 to 0x0313. */
#ifndef EC_TOOL_ERRORS_H
#define EC_TOOL_ERRORS_H

#include "../master/wire/regs.h"
#include "reg.h"

int errors_try(struct dev *d, const struct slave *s, u8 *regs);
int errors_read(struct dev *d, const struct slave *s, u8 *regs);

static inline u8 err_rx(const u8 *regs, unsigned int port)
{
	return regs[EC_REG_ERR_RX(port) - EC_REG_ERRORS];
}

static inline u8 err_phy(const u8 *regs, unsigned int port)
{
	return regs[EC_REG_ERR_PHY(port) - EC_REG_ERRORS];
}

static inline u8 err_fwd(const u8 *regs, unsigned int port)
{
	return regs[EC_REG_ERR_FWD(port) - EC_REG_ERRORS];
}

static inline u8 err_lost(const u8 *regs, unsigned int port)
{
	return regs[EC_REG_ERR_LOST(port) - EC_REG_ERRORS];
}

#endif
