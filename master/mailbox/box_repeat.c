// SPDX-License-Identifier: GPL-2.0-only
/*
 * Repetition. A slave with the repeat mechanism (EEPROM, general category) puts its last message
 * into SM1 again when it is asked to: ETG.1000.4 clause 6.7.3, registers 0x080E, 0x080F. The
 * counter of a message shows whether the master has it already.
 */
#include <linux/ktime.h>
#include "../wire/regs.h"
#include "box_repeat.h"
#include "box_state.h"

#define ACK_FAILS	3	/* repeat requests without acknowledgement */
#define ACK_POLLS	50	/* of a repeat request */
#define ACK_NS		(300 * NSEC_PER_USEC)	/* between them */
#define UNSEEN_NS	(5 * NSEC_PER_MSEC)	/* for one that the slave cannot acknowledge */
#define ORDERED		3	/* messages with the next counter in a row */

/* Is the message in @rx the last one again, from a slave with correct counters so far? */
static bool is_twice(struct ec_box *box, u8 counter)
{
	bool same = !memcmp(box->begin, box->rx, sizeof(box->begin));

	lockdep_assert_held(&box->lock);
	memcpy(box->begin, box->rx, sizeof(box->begin));
	if (counter == box->seen) {
		same &= box->in_order >= ORDERED;
		/* of a slave that stops counting one message is discarded, not more */
		box->in_order -= same;
		return same;
	}
	box->in_order = counter == ec_mbox_next_counter(box->seen) ?
		       min(box->in_order + 1, ORDERED) : 0;
	return false;
}

/**
 * ec_box_is_known() - is the message in @rx one that the master has already?
 * @box: mailbox of a slave, its lock held
 * @counter: of that message
 *
 * When a slave has repeated its last message although nothing was lost, the counter shows
 * that the message is not a new one; also when a slave sends a message twice.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_box_is_known(struct ec_box *box, u8 counter)
{
	bool twice = is_twice(box, counter);
	bool again = counter && counter == box->seen && (box->repeats || twice);

	lockdep_assert_held(&box->lock);
	box->repeats = false;
	if (again)
		return true;
	box->counts = counter && box->seen && counter != box->seen;
	box->seen = counter;
	return false;
}

/*
 * Let the slave put its last message into SM1 again (ETG.1000.4 clause 6.7.3, registers
 * 0x080E, 0x080F). A request that is written again after a lost frame has the same value, so the
 * slave does not repeat twice.
 */
static enum ec_box_step on_repeat_get(struct ec_box *box)
{
	u8 *b = box->status;

	if (!box->asked) {
		box->asked = true;
		box->asked_bit = !(b[0] & EC_SM_ACT_REPEAT);
		/* left from before INIT: the slave cannot show that it has repeated */
		box->unseen = !!(b[1] & EC_SM_PDI_REPEAT_ACK) == box->asked_bit;
	}
	b[0] &= ~EC_SM_ACT_REPEAT;
	if (box->asked_bit)
		b[0] |= EC_SM_ACT_REPEAT;
	box->acks = 0;
	return EC_BOX_REPEAT_SET;
}

static enum ec_box_step no_repetition(struct ec_box *box, bool silent)
{
	box->due_ns = 0;
	if (!silent || ++box->ack_fails < ACK_FAILS) {
		ec_box_set_gap(box, EC_BOX_GAP_LOOK);
		return EC_BOX_REST;
	}
	box->can_repeat = false;
	ec_box_set_gap(box, EC_BOX_WHOLE);
	if (ec_box_is_doubtful(box))
		ec_box_written(box);
	box->ops->event(box, EC_BOX_ON_UNABLE, 0);
	return EC_BOX_REST;
}

static enum ec_box_step on_ack(struct ec_box *box)
{
	if (!!(box->status[1] & EC_SM_PDI_REPEAT_ACK) == box->asked_bit) {
		ec_box_set_gap(box, EC_BOX_WHOLE);
		box->asked = false;
		box->repeats = true;
		box->ack_fails = 0;
		box->due_ns = 0;
		return EC_BOX_REST;
	}
	if (++box->acks >= ACK_POLLS)
		return no_repetition(box, true);
	box->due_ns = ktime_get_ns() + ACK_NS;
	return EC_BOX_REPEAT_ACK;
}

/**
 * ec_box_on_repeat() - result of a step of a repetition
 * @box: mailbox of a slave, its lock held
 * @ret: 0 or -errno
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the next step; %EC_BOX_REST: what there is to do.
 */
enum ec_box_step ec_box_on_repeat(struct ec_box *box, int ret)
{
	lockdep_assert_held(&box->lock);
	if (ret)
		return no_repetition(box, false);
	if (box->step == EC_BOX_REPEAT_GET)
		return on_repeat_get(box);
	if (box->step == EC_BOX_REPEAT_ACK)
		return on_ack(box);
	box->due_ns = box->unseen ? ktime_get_ns() + UNSEEN_NS : 0;
	return EC_BOX_REPEAT_ACK;
}
