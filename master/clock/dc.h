/* SPDX-License-Identifier: GPL-2.0-only */
/* When the clocks are set; their beginning and end. */
#ifndef EC_DC_H
#define EC_DC_H

#include "dc_state.h"

void ec_dc_init(struct ec_dc *dc, struct ec_base *base, struct ec_links *links, struct ec_bus *bus,
		struct workqueue_struct *service);
void ec_dc_exit(struct ec_dc *dc);
int ec_dc_measure(struct ec_dc *dc);
bool ec_dc_is_contradicted(const struct ec_dc *dc);
void ec_dc_begin(struct ec_dc *dc, u16 choice);
void ec_dc_end(struct ec_dc *dc);

#endif
