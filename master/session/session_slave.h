/* SPDX-License-Identifier: GPL-2.0-only */
/* A configuration and the slave that it has. */
#ifndef EC_SESSION_SLAVE_H
#define EC_SESSION_SLAVE_H

#include "session.h"

bool ec_session_owns(const struct ec_config *c);
void ec_session_detach(struct ec_config *c);
bool ec_session_give(struct ec_session *s, struct ec_config *c, struct ec_slave *slave);
void ec_session_exchange(struct ec_session *s, struct ec_config *c, struct ec_slave *slave);

#endif
