/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Mailbox messages that only a slave sends without a request of theirs: errors, emergencies. */
#ifndef EC_SIM_MBOX_ENCODE_H
#define EC_SIM_MBOX_ENCODE_H

#include "../../master/wire/coe.h"

void ec_mbox_error_encode(struct ec_wbuf *w, u16 detail);
int ec_coe_emergency_encode(u8 *tx, size_t cap, const struct ec_coe_emergency *e);

#endif
