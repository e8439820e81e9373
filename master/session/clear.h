/* SPDX-License-Identifier: GPL-2.0-only */
/* The end of what an application has configured. */
#ifndef EC_CLEAR_H
#define EC_CLEAR_H

#include "session.h"

void ec_session_clear(struct ec_session *s);
void ec_session_free(struct ec_session *s);

#endif
