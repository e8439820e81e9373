/* SPDX-License-Identifier: GPL-2.0-only */
/* An application takes over the detached session of another one. */
#ifndef EC_TAKEOVER_H
#define EC_TAKEOVER_H

#include "session.h"

int ec_session_take_over(struct ec_sessions *ss, char *why, size_t size, bool keep);

#endif
