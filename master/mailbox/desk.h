/* SPDX-License-Identifier: GPL-2.0-only */
/* The mailbox queue: users enter, wait and leave, and get the messages of the slave. */
#ifndef EC_DESK_H
#define EC_DESK_H

#include "mbox.h"

extern const struct ec_box_ops ec_desk_ops;

void ec_desk_enter(struct ec_mbox *mb, struct ec_mbox_user *u);
bool ec_desk_again(struct ec_mbox *mb, struct ec_mbox_user *u);
void ec_desk_wait_on(struct ec_mbox *mb, struct ec_mbox_user *u);
void ec_desk_leave(struct ec_mbox *mb, struct ec_mbox_user *u, bool answered);
bool ec_desk_has_reader(struct ec_mbox *mb);
bool ec_mbox_in_use(const struct ec_mbox *mb);
bool ec_mbox_is_read(const struct ec_mbox *mb);
void ec_mbox_reset(struct ec_mbox *mb);
bool ec_mbox_fetch(struct ec_mbox *mb);

#endif
