/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_DETACHED_H
#define EC_DETACHED_H

#include "session.h"

int ec_detached_begin(struct ec_session *s);
int ec_detached_set(struct ec_session *s, const struct ec_ioc_output *o);
void ec_detached_device(struct ec_session *s, struct ec_config *c);
void ec_detached_end(struct ec_session *s);
bool ec_detached_runs(struct ec_sessions *ss);

#endif
