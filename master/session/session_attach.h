/* SPDX-License-Identifier: GPL-2.0-only */
/* Configurations and the slaves that they mean. */
#ifndef EC_SESSION_ATTACH_H
#define EC_SESSION_ATTACH_H

#include "session.h"

bool ec_session_owns(const struct ec_config *c);
void ec_session_detach(struct ec_config *c);
struct ec_slave *ec_session_find(struct ec_sessions *ss, u16 alias, u16 position, u32 vendor,
				 u32 product);
bool ec_session_give(struct ec_session *s, struct ec_config *c, struct ec_slave *slave);
void ec_session_begin_active(struct ec_session *s);
void ec_session_attach_one(struct ec_session *s, struct ec_config *c);
void ec_session_attach_all(struct ec_session *s);
void ec_session_attach(struct ec_sessions *ss);
struct ec_config *ec_session_configure(struct ec_session *s, u16 alias, u16 position, u32 vendor,
				       u32 product);
void ec_session_again(struct work_struct *work);
void ec_session_try_again(struct ec_sessions *ss);

#endif
