/* SPDX-License-Identifier: GPL-2.0-only */
/* Hot connect groups and their slaves. */
#ifndef EC_SESSION_GROUPS_H
#define EC_SESSION_GROUPS_H

#include "session.h"

struct ec_group;

void ec_session_mark(struct ec_session *s);
void ec_session_report_groups(struct ec_session *s);
int ec_session_set_borders(struct ec_session *s);
void ec_session_attach_groups(struct ec_session *s);
void ec_session_drop_groups(struct ec_session *s);
struct ec_slave *ec_session_find_member(struct ec_session *s, const struct ec_group *g,
					unsigned int member);

#endif
