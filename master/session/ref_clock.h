/* SPDX-License-Identifier: GPL-2.0-only */
/* The reference clock of a session goes to OP with its slaves. */
#ifndef EC_REF_CLOCK_H
#define EC_REF_CLOCK_H

struct ec_session;

void ec_ref_clock_raise(struct ec_session *s);
void ec_ref_clock_lower(struct ec_session *s);

#endif
