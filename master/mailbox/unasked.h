/* SPDX-License-Identifier: GPL-2.0-only */
/* Messages that a slave sends without a request: emergencies, VoE. */
#ifndef EC_UNASKED_H
#define EC_UNASKED_H

#include "mbox.h"

void ec_mbox_unasked(struct work_struct *work);
int ec_mbox_error_reply(struct ec_mbox *mb, const u8 *rx, size_t len);
void ec_mbox_keep_voe(struct ec_mbox *mb, bool on);
void ec_mbox_flush_kept(struct ec_mbox *mb);
int ec_mbox_take_kept(struct ec_mbox *mb, u8 *rx);

#endif
