/* SPDX-License-Identifier: GPL-2.0-only */
/* Repetition of the last message of a slave. */
#ifndef EC_BOX_REPEAT_H
#define EC_BOX_REPEAT_H

#include "box_post.h"

bool ec_box_is_known(struct ec_box *box, u8 counter);
enum ec_box_step ec_box_on_repeat(struct ec_box *box, int ret);

#endif
