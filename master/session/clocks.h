/* SPDX-License-Identifier: GPL-2.0-only */
/* When the clocks of a session are set, and by which reference clock. */
#ifndef EC_SESSION_CLOCKS_H
#define EC_SESSION_CLOCKS_H

#include "session.h"

u16 ec_clocks_choice(const struct ec_session *s);
bool ec_clocks_need_armw(const struct ec_session *s);
bool ec_clocks_used(const struct ec_session *s);
bool ec_clocks_begin_now(const struct ec_session *s);
void ec_session_clocks(struct ec_sessions *ss);

#endif
