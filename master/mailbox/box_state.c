// SPDX-License-Identifier: GPL-2.0-only
/* The states of a mailbox and their changes; the tables are in box_post.h. */
#include "box_state.h"

/**
 * ec_box_set_job() - change what the slave gets
 * @box: mailbox of a slave, its lock held
 * @job: enum ec_box_job
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_set_job(struct ec_box *box, enum ec_box_job job)
{
	/* jobs that may precede */
	static const u8 from[] = {
		[EC_BOX_NO_JOB] = U8_MAX,
		[EC_BOX_EMPTYING] = BIT(EC_BOX_NO_JOB),
		[EC_BOX_DISCARDING] = BIT(EC_BOX_NO_JOB),
		[EC_BOX_WRITING] = BIT(EC_BOX_NO_JOB) | BIT(EC_BOX_EMPTYING) | BIT(EC_BOX_BLOCKED),
		[EC_BOX_BLOCKED] = BIT(EC_BOX_WRITING),
	};

	lockdep_assert_held(&box->lock);
	WARN_ON_ONCE(!(from[job] & BIT(box->job)));
	box->job = job;
}

/**
 * ec_box_set_gap() - change what is known of lost messages of the slave
 * @box: mailbox of a slave, its lock held
 * @gap: enum ec_box_gap
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_set_gap(struct ec_box *box, enum ec_box_gap gap)
{
	/* states that may precede */
	static const u8 from[] = {
		[EC_BOX_WHOLE] = U8_MAX,
		[EC_BOX_UNREAD] = BIT(EC_BOX_WHOLE) | BIT(EC_BOX_UNREAD),
		[EC_BOX_GAP] = BIT(EC_BOX_WHOLE) | BIT(EC_BOX_GAP) | BIT(EC_BOX_GAP_LOOK),
		[EC_BOX_GAP_LOOK] = BIT(EC_BOX_GAP),
	};

	lockdep_assert_held(&box->lock);
	WARN_ON_ONCE(!(from[gap] & BIT(box->gap)));
	box->gap = gap;
}

/**
 * ec_box_end_job() - the job has ended
 * @box: mailbox of a slave, its lock held
 * @err: as for %EC_BOX_ON_JOB
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_end_job(struct ec_box *box, int err)
{
	lockdep_assert_held(&box->lock);
	ec_box_set_job(box, EC_BOX_NO_JOB);
	box->ops->event(box, EC_BOX_ON_JOB, err);
}

/**
 * ec_box_fail() - the slave does not respond, or its mailbox cannot be used
 * @box: mailbox of a slave, its lock held
 * @err: as for %EC_BOX_ON_FAILED
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_fail(struct ec_box *box, int err)
{
	lockdep_assert_held(&box->lock);
	ec_box_set_job(box, EC_BOX_NO_JOB);
	box->ops->event(box, EC_BOX_ON_FAILED, err);
}

/**
 * ec_box_looked() - SM1 was accessed once without a repetition
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_looked(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	if (box->gap == EC_BOX_GAP_LOOK)
		ec_box_set_gap(box, EC_BOX_GAP);
}

/**
 * ec_box_written() - the message of the job is in SM0, or may be and must not be sent again
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_written(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	ec_box_progress(box);
	ec_box_end_job(box, box->doubtful ? -ENOTRECOVERABLE : 0);
}
