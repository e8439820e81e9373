// SPDX-License-Identifier: GPL-2.0-only
/*
 * Time between the frames of a trial. A frame goes through other branches of the host before it
 * comes to the port: process data sent before the trial must have left these branches before the
 * port opens, or they leave by it, and so must the work before it closes, or the next slave of the
 * ring does it. Frames that no slave processes lie in between.
 */
#include "../link/links.h"
#include "gap.h"

#define FRAMES	8	/* of a trial, without those of gaps */

/**
 * ec_gap_fits() - has a cycle enough free wire time for a trial?
 * @l: links
 * @branch_ns: a frame is in the branches before the port for so long
 * @bytes: data of the work
 *
 * Context: Process.
 * Return: whether it is so; without a cycle it is, for branches up to 475 us.
 */
bool ec_gap_fits(const struct ec_links *l, u32 branch_ns, u32 bytes)
{
	u32 free_ns = ec_access_slack_ns(l);

	if (branch_ns / 80 > EC_GAP_FRAMES * EC_DGRAM_DATA_MAX)
		return false;
	/* clock frames take some of it now and then */
	return free_ns == ~0u ||
	       free_ns - free_ns / 8 >
	       2 * branch_ns + FRAMES * ec_frame_wire_ns(EC_ETH_MIN) + 80 * bytes;
}

/**
 * ec_gap_add() - add frames that take some time on the wire
 * @dg: %EC_GAP_FRAMES datagrams
 * @ns: time, 0: none
 *
 * Context: Process.
 * Return: how many, each in a frame of its own.
 */
unsigned int ec_gap_add(struct ec_dg *dg, u32 ns)
{
	static u8 nothing[EC_DGRAM_DATA_MAX];
	u32 bytes = ns / 80, n;

	for (n = 0; bytes && n < EC_GAP_FRAMES; n++) {
		u32 len = min_t(u32, bytes, EC_DGRAM_DATA_MAX);

		dg[n] = EC_DG(EC_CMD_NOP, 0, 0, len, nothing);
		dg[n].keep = true;
		dg[n].last = true;
		bytes -= len;
	}
	return n;
}
