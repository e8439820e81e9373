/* SPDX-License-Identifier: GPL-2.0-only */
/* Propagation delays of all slaves. */
#ifndef EC_DC_DELAYS_H
#define EC_DC_DELAYS_H

struct ec_dc_job;

int ec_dc_get_delays(struct ec_dc_job *j);

#endif
