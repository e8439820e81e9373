/* SPDX-License-Identifier: GPL-2.0-only */
/* The kernel log of events that the cycle notices. */
#ifndef EC_EVENT_LOG_H
#define EC_EVENT_LOG_H

#include <linux/types.h>

struct ec_base;

void ec_event_log(struct ec_base *base, u64 *at);

#endif
