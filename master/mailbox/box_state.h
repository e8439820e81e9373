/* SPDX-License-Identifier: GPL-2.0-only */
/* The states of a mailbox and their changes. */
#ifndef EC_BOX_STATE_H
#define EC_BOX_STATE_H

#include "box_post.h"

/* May the message of the job have arrived, although the job continues? */
static inline bool ec_box_is_doubtful(const struct ec_box *box)
{
	return box->job != EC_BOX_NO_JOB && box->doubtful;
}

void ec_box_set_job(struct ec_box *box, enum ec_box_job job);
void ec_box_set_gap(struct ec_box *box, enum ec_box_gap gap);
void ec_box_end_job(struct ec_box *box, int err);
void ec_box_fail(struct ec_box *box, int err);
void ec_box_looked(struct ec_box *box);
void ec_box_written(struct ec_box *box);

#endif
