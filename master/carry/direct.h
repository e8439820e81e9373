/* SPDX-License-Identifier: GPL-2.0-only */
/* Sending with direct access. */
#ifndef EC_DIRECT_H
#define EC_DIRECT_H

#include "carry.h"

void ec_direct_push(struct ec_carry *c);
bool ec_direct_push_on(struct ec_carry *c);

#endif
