/* SPDX-License-Identifier: GPL-2.0-only */
/* The thread that finds lost frames. */
#ifndef EC_LOSS_H
#define EC_LOSS_H

#include "carry.h"

int ec_loss_start(struct ec_carry *c);
void ec_loss_stop(struct ec_carry *c);
void ec_loss_end_all(struct ec_carry *c);
void ec_loss_watch(struct ec_carry *c);

#endif
