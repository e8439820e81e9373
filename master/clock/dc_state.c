// SPDX-License-Identifier: GPL-2.0-only
/* States of the clocks of a master, and of that of a slave: all changes are in two tables. */
#include "dc_state.h"

/**
 * ec_clock_event() - change the state of a clock
 * @c: clock of a slave
 * @event: what happens to it
 *
 * Context: Process. The worker, the monitor, or an activation.
 * Return: its state before.
 */
enum ec_clock_state ec_clock_event(struct ec_clock *c, enum ec_clock_event event)
{
	static const u8 next[][3] = {
		[EC_CLOCK_UNSET] = { EC_CLOCK_SET, EC_CLOCK_EXCLUDED, EC_CLOCK_UNSET },
		[EC_CLOCK_SET] = { EC_CLOCK_SET, EC_CLOCK_LOST, EC_CLOCK_UNSET },
		[EC_CLOCK_EXCLUDED] = { EC_CLOCK_SET, EC_CLOCK_EXCLUDED, EC_CLOCK_EXCLUDED },
		[EC_CLOCK_LOST] = { EC_CLOCK_SET, EC_CLOCK_LOST, EC_CLOCK_EXCLUDED },
	};
	u32 old = READ_ONCE(c->state);

	/* the monitor may measure during an activation */
	while (!try_cmpxchg(&c->state, &old, next[old][event]))
		;
	if (event != EC_CLOCK_ON_SILENT)
		c->failed_attempts = 0;
	return old;
}

/**
 * ec_dc_set_state() - change the state of the clocks
 * @dc: clocks
 * @state: as the table at enum ec_dc_state allows
 *
 * Context: Process. The worker, the watch, or while neither of them runs.
 */
void ec_dc_set_state(struct ec_dc *dc, enum ec_dc_state state)
{
	/* the states before */
	static const u8 from[] = {
		[EC_DC_OFF] = U8_MAX,
		[EC_DC_BUSY] = U8_MAX,
		[EC_DC_AWAIT_CYCLE] = BIT(EC_DC_BUSY),
		[EC_DC_READY] = BIT(EC_DC_BUSY),
		[EC_DC_FAILED] = BIT(EC_DC_BUSY),
		[EC_DC_RETRY_WAIT] = BIT(EC_DC_BUSY),
		[EC_DC_RETRY_DUE] = BIT(EC_DC_READY) | BIT(EC_DC_FAILED) | BIT(EC_DC_RETRY_WAIT),
	};

	WARN_ON_ONCE(!(from[state] & BIT(dc->state)));
	WRITE_ONCE(dc->state, state);
	wake_up_all(&dc->wq);
}
