/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TRIAL_H
#define EC_TRIAL_H

struct ec_behind;
struct ec_slave;

int ec_trial(struct ec_slave *s, unsigned int port, struct ec_behind *is);

#endif
