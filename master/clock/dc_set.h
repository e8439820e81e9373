/* SPDX-License-Identifier: GPL-2.0-only */
/* Offsets and delays are set, the drift is compensated. */
#ifndef EC_DC_SET_H
#define EC_DC_SET_H

struct ec_dc_job;

int ec_dc_write(struct ec_dc_job *j);
int ec_dc_near(struct ec_dc_job *j);
void ec_dc_settle(struct ec_dc_job *j);
int ec_dc_check(struct ec_dc_job *j);

#endif
