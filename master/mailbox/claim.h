/* SPDX-License-Identifier: GPL-2.0-only */
/* Who may use a protocol of a slave's mailbox. */
#ifndef EC_CLAIM_H
#define EC_CLAIM_H

#include "mbox.h"

int ec_mbox_claim(struct ec_mbox *mb, u16 types, u32 ms);
int ec_mbox_claim_for(struct ec_mbox *mb, u8 type, const struct ec_mbox_limit *limit);
void ec_mbox_unclaim(struct ec_mbox *mb, u16 types);
bool ec_mbox_is_claimed(struct ec_mbox *mb, u16 types);

#endif
