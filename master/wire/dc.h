/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Arithmetic of distributed clocks (ETG.1000.4 clause 6.8); times in ns. */
#ifndef EC_WIRE_DC_H
#define EC_WIRE_DC_H

#include "regs.h"

#define EC_DC_PORTS	4
#define EC_DC_NONE	(-1)

/**
 * struct ec_dc_node - one slave of the segment, in ring order
 * @parent: index of the slave it hangs at, EC_DC_NONE: the first one; a later one when
 *	that is entered by another port than 0
 * @parent_port: port there
 * @entry: its own port towards the master
 * @open: bit per open port, @entry included
 * @dc: has receive times
 * @other: behind the break of a ring: reached by frames of the other end; all of them after
 *	those that are not
 * @recv: receive times at the ports, registers 0x0900-0x090F, all latched by
 *	the same frame
 * @delay: result: when a frame reaches its processing unit, counted from the reference clock,
 *	for register 0x0928; modulo 2^32, so that slaves upstream of the
 *	reference clock have a negative one
 * @hop: result: way from the clock before it, ns
 * @unreliable: result: the receive times of the slave, or of one before it, contradict the
 *	topology; ways that no frame can have taken are missing in @delay and @hop
 * @behind: for ec_dc_delays(): how long a frame is behind the ports placed so far
 * @to_unit: for ec_dc_delays(): how long it takes from the entry to the processing unit
 * @first: for ec_dc_delays(): first slave with a clock behind each port
 * @last: the last one
 * @next: the next behind the same port
 */
struct ec_dc_node {
	s32 parent;
	u8 parent_port;
	u8 entry;
	u8 open;
	bool dc;
	bool other;
	u32 recv[EC_DC_PORTS];
	u32 delay;
	u32 hop;
	bool unreliable;
	u32 behind;
	u32 to_unit;
	s32 first[EC_DC_PORTS];
	s32 last[EC_DC_PORTS];
	s32 next;
};

void ec_dc_delays(struct ec_dc_node *nodes, u32 n, u32 ref);
u64 ec_dc_offset(u64 ref_time, u32 delay, u64 local);
s32 ec_dc_diff(u32 value);
bool ec_dc_sync_fits(u32 sync0, u32 cycle);
u64 ec_dc_start(u64 earliest, u64 phase, u32 period, s32 shift);

#endif
