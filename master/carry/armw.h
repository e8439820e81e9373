/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * By which command the time of the reference clock goes to the other clocks: FRMW, which addresses
 * that clock by its station address, or ARMW for slaves that ignore FRMW. ARMW addresses a ring
 * position: the time of another slave at that position would go to all others. So it is only sent
 * while the position is certain; else the time is only read.
 */
#ifndef EC_ARMW_H
#define EC_ARMW_H

#include "../base/once64.h"
#include "../wire/frame.h"

/** struct ec_armw - ring position of the reference clock */
struct ec_armw {
	/** @wanted: a slave of the session ignores FRMW */
	bool wanted;
	/**
	 * @at: ec_armw_at(): station address and ring position of that clock, and the changes of
	 * ports after which it has that position; 0: unknown. Written by the monitor
	 */
	aligned_u64 at;
	/** @changes: numbers whose sum counts the changes of ports; immutable */
	const u32 *changes[2];
};

static inline u64 ec_armw_at(u16 station, u16 position, u32 changes)
{
	return (u64)station << 48 | (u64)position << 32 | changes;
}

/**
 * ec_armw_command() - the command of a drift compensation datagram
 * @a: position of the reference clock
 * @adp: station address of that clock; result: low half of the address of the datagram
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: EC_CMD_FRMW; EC_CMD_ARMW; EC_CMD_FPRD: the position is not certain.
 */
static inline u8 ec_armw_command(const struct ec_armw *a, u16 *adp)
{
	u64 at;

	if (!READ_ONCE(a->wanted))
		return EC_CMD_FRMW;
	at = ec_read64(&a->at);
	if (!*adp || (u16)(at >> 48) != *adp ||
	    (u32)at != READ_ONCE(*a->changes[0]) + READ_ONCE(*a->changes[1]))
		return EC_CMD_FPRD;
	*adp = -(u16)(at >> 32);
	return EC_CMD_ARMW;
}

#endif
