// SPDX-License-Identifier: GPL-2.0-only
/* SYNC0 and SYNC1 of one slave (ETG.1000.4 clause 6.8.5). */
#include "config.h"
#include "dc.h"
#include "master.h"
#include "slave.h"
#include "wire/dc.h"
#include "xfer.h"

#define LEAD_NS	(100 * NSEC_PER_MSEC)	/* first SYNC0 is in the future */

/**
 * ec_dc_sync_stop() - no SYNC signals, the unit belongs to the master
 * @s: slave with a clock, @lock held
 *
 * Registers 0x0980, 0x0981.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or as ec_xfer_fpwr().
 */
int ec_dc_sync_stop(struct ec_slave *s)
{
	static const u8 off[2];

	return ec_xfer_fpwr(s->master, s->station, EC_REG_DC_CUC, off, sizeof(off));
}

/* Start time on the grid of the application's phase, from the slave's own clock. */
static int start_time(struct ec_slave *s, const struct ec_config *c, u8 *b)
{
	struct ec_dc *dc = &s->master->dc;
	u32 period = c->dc_cycle[0] + c->dc_cycle[1];
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;
	u64 now, phase = dc->has_phase ? dc->phase : 0;
	u8 t[8] = { 0 };
	int ret;

	if (period < c->dc_cycle[0] || !period)
		return -ERANGE;
	ret = ec_xfer_fprd(s->master, s->station, EC_REG_DC_SYSTIME, t, wide ? 8 : 4);
	if (ret)
		return ret;
	now = get_unaligned_le64(t);
	if (!wide) {
		/* the upper half comes from the application's time */
		u64 app = ec_dc_now(s->master);

		now = app + (s32)((u32)now - (u32)app);
	}
	put_unaligned_le64(ec_dc_start(now + LEAD_NS, phase, period, c->dc_shift[0]), b);
	return 0;
}

/**
 * ec_dc_sync_start() - program and start SYNC0 and SYNC1
 * @s: slave whose clock is set, @lock held
 * @c: its configuration with @dc_assign
 *
 * Registers 0x09A0, 0x09A4, 0x0990, then 0x0980.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ERANGE when the cycle times are 0 or too long; or as
 * ec_xfer_fpwr().
 */
int ec_dc_sync_start(struct ec_slave *s, const struct ec_config *c)
{
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;
	u8 cycles[8], start[8], assign[2];

	put_unaligned_le32(c->dc_cycle[0], cycles);
	put_unaligned_le32(c->dc_cycle[1], cycles + 4);
	put_unaligned_le16(c->dc_assign, assign);
	return ec_xfer_fpwr(s->master, s->station, EC_REG_DC_CYCLE0, cycles, sizeof(cycles)) ?:
	       start_time(s, c, start) ?:
	       ec_xfer_fpwr(s->master, s->station, EC_REG_DC_START, start, wide ? 8 : 4) ?:
	       ec_xfer_fpwr(s->master, s->station, EC_REG_DC_CUC, assign, sizeof(assign));
}
