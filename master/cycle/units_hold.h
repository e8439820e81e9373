/* SPDX-License-Identifier: GPL-2.0-only */
/* A sync unit whose outputs another application gives. */
#ifndef EC_UNITS_HOLD_H
#define EC_UNITS_HOLD_H

#include "unit_state.h"

struct ec_cycle;
struct ec_domain;
struct ec_wanted;

int ec_units_buffers(struct ec_cyc_unit *u, const struct ec_wanted *w);
void ec_units_clear(struct ec_cyc_unit *u);
void ec_units_write(struct ec_cycle *c, u32 unit, const void *data);
void ec_units_take_held(struct ec_cycle *c);
void ec_units_overlay(const struct ec_cycle *c, u8 *image);
void ec_units_show(const struct ec_cycle *c, const struct ec_domain *d, u8 *to, u32 from, u32 size);

#endif
