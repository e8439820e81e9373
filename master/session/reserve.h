/* SPDX-License-Identifier: GPL-2.0-only */
/* Which application has the master, and the next one that waits for it. */
#ifndef EC_RESERVE_H
#define EC_RESERVE_H

#include "session.h"

int ec_session_begin(struct ec_sessions *ss, const void *owner, struct ec_waiters *waiters);
void ec_session_end(struct ec_sessions *ss, const void *owner);
int ec_session_end_detached(struct ec_sessions *ss);
int ec_session_stop(struct ec_sessions *ss, const void *owner);
void ec_session_interval(struct ec_sessions *ss, u32 interval_us);
void ec_session_app_time(struct ec_sessions *ss, u64 app_time);

#endif
