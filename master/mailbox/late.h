/* SPDX-License-Identifier: GPL-2.0-only */
/* Replies after their time limit. */
#ifndef EC_LATE_REPLY_H
#define EC_LATE_REPLY_H

#include "mbox.h"

bool ec_mbox_is_late(struct ec_mbox *mb, const struct ec_mbox_user *u);
void ec_mbox_mark_late(struct ec_mbox *mb, const struct ec_mbox_user *u);
void ec_mbox_forget_late(struct ec_mbox *mb, u16 types);
void ec_mbox_took_late(struct ec_mbox *mb, u8 type);
int ec_mbox_await_late(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b);

#endif
