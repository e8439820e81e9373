/* SPDX-License-Identifier: GPL-2.0-only */
/* The mailbox queue: users get the messages of the slave. */
#ifndef EC_DESK_H
#define EC_DESK_H

#include "mbox.h"

extern const struct ec_box_ops ec_desk_ops;

bool ec_desk_has_reader(struct ec_mbox *mb);
void ec_desk_retry(struct ec_mbox *mb);

#endif
