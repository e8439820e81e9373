/* SPDX-License-Identifier: GPL-2.0-only */
/* The state of the bus for an active session, and log messages about its application. */
#ifndef EC_SESSION_STATUS_H
#define EC_SESSION_STATUS_H

#include "session.h"

void ec_session_note_counts(struct ec_session *s, bool first, bool all);
void ec_session_fill_status(struct ec_session *s);
void ec_session_status(struct ec_sessions *ss, bool scanned);

#endif
