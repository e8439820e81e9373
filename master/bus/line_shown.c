// SPDX-License-Identifier: GPL-2.0-only
/* Error counters as others see them: without traffic, or beside what they read themselves. */
#include <linux/jiffies.h>
#include "line_errors.h"
#include "slave.h"

/**
 * ec_line_errors_show() - let others see what was read
 * @e: error counters of a slave
 *
 * Each count for itself: the sum of what a register has and what the master has cleared of it.
 *
 * Context: The monitor thread.
 */
void ec_line_errors_show(struct ec_line_errors *e)
{
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++) {
		unsigned int rx = EC_LINE_AT(EC_REG_ERR_RX(p));
		unsigned int phy = EC_LINE_AT(EC_REG_ERR_PHY(p));
		unsigned int fwd = EC_LINE_AT(EC_REG_ERR_FWD(p));

		WRITE_ONCE(e->shown[p][0], e->cleared[rx] + e->regs[rx]);
		WRITE_ONCE(e->shown[p][1], e->cleared[phy] + e->regs[phy]);
		WRITE_ONCE(e->shown[p][2], e->cleared[fwd] + e->regs[fwd]);
		WRITE_ONCE(e->shown[p][3], e->regs[EC_LINE_AT(EC_REG_ERR_LOST(p))]);
	}
	WRITE_ONCE(e->shown_at, jiffies);
	/* the counts before their number */
	smp_store_release(&e->shown_n, e->bytes == EC_ERRORS_SIZE ? 4 :
			  e->bytes == EC_LINE_RX_BYTES ? 3 : 2);
}

/**
 * ec_line_errors_seen() - error counters of a port as the master has read them last
 * @s: slave
 * @port: its port
 * @errors: result: invalid frames, errors of the receiver, forwarded errors, lost links; those that
 *	the master has cleared are included
 * @age_ms: result: time since they were read, ms
 *
 * Context: Any.
 * Return: how many of them the slave has, from the first on; 0: none was read since it was found,
 * or since a user has cleared them.
 */
u32 ec_line_errors_seen(const struct ec_slave *s, unsigned int port, u32 errors[4], u32 *age_ms)
{
	/* zeros in it before the pointer */
	const struct ec_line_errors *e = smp_load_acquire(&s->lines);
	u32 n, i;

	memset(errors, 0, 4 * sizeof(*errors));
	*age_ms = 0;
	if (!e || READ_ONCE(e->void_cleared))
		return 0;
	/* the counts after their number */
	n = smp_load_acquire(&e->shown_n);
	for (i = 0; i < n; i++)
		errors[i] = READ_ONCE(e->shown[port][i]);
	if (n)
		*age_ms = jiffies_to_msecs(jiffies - READ_ONCE(e->shown_at));
	return n;
}

/**
 * ec_line_errors_cleared() - errors that the registers of a port do not contain any more
 * @s: slave
 * @port: its port
 * @cleared: result: invalid frames, errors of the receiver, forwarded errors that the master has
 *	cleared since another one did
 *
 * Context: Any.
 */
void ec_line_errors_cleared(const struct ec_slave *s, unsigned int port, u32 cleared[3])
{
	/* zeros in it before the pointer */
	const struct ec_line_errors *e = smp_load_acquire(&s->lines);

	memset(cleared, 0, 3 * sizeof(*cleared));
	/* and in its counts, before the flag is cleared */
	if (!e || smp_load_acquire(&e->void_cleared))
		return;
	cleared[0] = READ_ONCE(e->cleared[EC_LINE_AT(EC_REG_ERR_RX(port))]);
	cleared[1] = READ_ONCE(e->cleared[EC_LINE_AT(EC_REG_ERR_PHY(port))]);
	cleared[2] = READ_ONCE(e->cleared[EC_LINE_AT(EC_REG_ERR_FWD(port))]);
}

/**
 * ec_line_errors_written() - a user has written to registers of a slave
 * @s: slave
 * @reg: first register
 * @n: bytes
 *
 * If they are error counters, those that the master has cleared do not count any more.
 *
 * Context: Any.
 */
void ec_line_errors_written(struct ec_slave *s, u32 reg, u32 n)
{
	/* zeros in it before the pointer */
	struct ec_line_errors *e = smp_load_acquire(&s->lines);

	if (e && reg < EC_REG_ERRORS + EC_LINE_RX_BYTES && reg + n > EC_REG_ERRORS)
		WRITE_ONCE(e->void_cleared, true);
}
