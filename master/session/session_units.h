/* SPDX-License-Identifier: GPL-2.0-only */
/* Slaves that the policy of a sync unit takes out of OP. */
#ifndef EC_SESSION_UNITS_H
#define EC_SESSION_UNITS_H

#include "session.h"

u8 ec_session_goal(const struct ec_session *s, const struct ec_config *c);
void ec_session_units(struct work_struct *work);
int ec_session_find_unit(const struct ec_session *s, const char *name);
void ec_session_leave_units(struct ec_sessions *ss, const void *holder);

#endif
