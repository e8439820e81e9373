/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * On which side of the break of a ring the data of a datagram are. What is known of it is one
 * number: its low 16 bits are where those behind the break begin, the others what has to be so.
 */
#ifndef EC_RING_SIDES_H
#define EC_RING_SIDES_H

#include <linux/types.h>

struct ec_cycle;

/**
 * ec_ring_sides_proof() - what proves that the sides of a datagram are those that are known
 * @moves: struct ec_cycle.moves
 * @wa: working counter of the copy of the main link
 * @wb: that of the backup link
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the upper 48 bits of struct ec_cyc_dgram.sides, if they are.
 */
static inline u64 ec_ring_sides_proof(u16 moves, u16 wa, u16 wb)
{
	return (u64)moves << 32 | (u32)wa << 16 | wb;
}

void ec_ring_sides_look(struct ec_cycle *c, bool scanned);

#endif
