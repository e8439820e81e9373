/* SPDX-License-Identifier: GPL-2.0-only */
/* Users of the mailbox queue enter, wait and leave. */
#ifndef EC_DESK_ENTER_H
#define EC_DESK_ENTER_H

#include "mbox.h"

void ec_desk_enter(struct ec_mbox *mb, struct ec_mbox_user *u);
bool ec_desk_again(struct ec_mbox *mb, struct ec_mbox_user *u);
void ec_desk_wait_on(struct ec_mbox *mb, struct ec_mbox_user *u);
void ec_desk_leave(struct ec_mbox *mb, struct ec_mbox_user *u, bool answered);
bool ec_mbox_in_use(const struct ec_mbox *mb);
bool ec_mbox_is_read(const struct ec_mbox *mb);
void ec_mbox_reset(struct ec_mbox *mb);
bool ec_mbox_fetch(struct ec_mbox *mb);

#endif
