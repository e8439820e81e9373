/* SPDX-License-Identifier: GPL-2.0-only */
/* Configurations and the slaves that they mean. */
#ifndef EC_SESSION_ATTACH_H
#define EC_SESSION_ATTACH_H

#include "session.h"

struct ec_group;

struct ec_slave *ec_session_find(struct ec_session *s, const struct ec_ioc_slave_config *i);
void ec_session_settle_places(struct ec_session *s);
void ec_session_begin_active(struct ec_session *s);
void ec_session_attach_all(struct ec_session *s);
void ec_session_attach(struct ec_sessions *ss);
struct ec_config *ec_session_configure(struct ec_session *s, u16 alias, u16 position, u32 vendor,
				       u32 product);
struct ec_config *ec_session_configure_member(struct ec_session *s, struct ec_group *g, u16 member,
					      u32 vendor, u32 product);
void ec_session_again(struct work_struct *work);
void ec_session_try_again(struct ec_sessions *ss);

#endif
