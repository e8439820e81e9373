/* SPDX-License-Identifier: GPL-2.0-only */
/* Requests of AL states; functions print errors. */
#ifndef EC_TOOL_AL_REQUEST_H
#define EC_TOOL_AL_REQUEST_H

#include "dev.h"

#define AL_WAIT_S	10.0	/* without --wait=SECONDS */

void al_reason(const struct ect_slave *s, char *buf, size_t size);
/* @timeout_ms: of each transition, 0: the usual limits */
int al_request(struct dev *d, const struct ect_slave *s, u8 state, u32 timeout_ms);
/* @before: the slave before the request; @end: see now_s() */
int al_wait(struct dev *d, const struct ect_slave *before, u8 wanted, double end);

#endif
