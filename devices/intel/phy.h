/* SPDX-License-Identifier: GPL-2.0-only */
/* PHY of an Intel network controller, which firmware may use as well. */
#ifndef EC_INTEL_PHY_H
#define EC_INTEL_PHY_H

#include "nic.h"

int ec_phy_wake(const struct intel_nic *nic, bool anew);

#endif
