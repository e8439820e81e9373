/* SPDX-License-Identifier: GPL-2.0-only */
/* Begin and end of the cyclic exchange of a session. */
#ifndef EC_ACTIVATE_H
#define EC_ACTIVATE_H

#include "session.h"

int ec_session_activate(struct ec_session *s);
int ec_session_slaves_down(struct ec_session *s);
int ec_session_deactivate(struct ec_session *s);

#endif
