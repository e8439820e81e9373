// SPDX-License-Identifier: GPL-2.0-only
/* Registers as an earlier master left them. */
#include "esc_int.h"

/**
 * ec_esc_old_write() - write registers, as a master did at some time
 * @esc: slave controller
 * @ado: first register
 * @buf: data
 * @len: bytes
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_old_write(struct ec_esc *esc, u16 ado, const void *buf, size_t len, u64 now)
{
	const struct ec_frame_ctx ctx = { .now = now, .end = now };

	ec_esc_phys_write(esc, ado, buf, len, &ctx);
}

/* what needs no application; a slave without power forgets it */
void ec_esc_old(struct ec_esc *esc, const struct ec_sim_fault *f, u64 now)
{
	u8 v[2];

	put_unaligned_le16((u16)f->value, v);
	if (f->value & EC_SIM_OLD_STATION)
		ec_esc_old_write(esc, EC_REG_STATION, v, 2, now);
	v[0] = (u8)(f->value >> EC_SIM_OLD_LOOPS_SHIFT);
	if (f->value & EC_SIM_OLD_LOOPS)
		ec_esc_old_write(esc, EC_REG_DL_LOOPS, v, 1, now);
	/* not a request of now: the application must not answer it */
	if (f->value & EC_SIM_OLD_STATE)
		put_unaligned_le16((u16)f->arg2, esc->mem + EC_REG_AL_CONTROL);
}
