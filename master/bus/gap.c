// SPDX-License-Identifier: GPL-2.0-only
/*
 * Time between the frames of a trial. A frame goes through other branches of the host before it
 * comes to the port: process data sent before the trial must have left these branches before the
 * port opens, or they leave by it, and so must the work before it closes, or the next slave of the
 * ring does it. Frames that no slave processes lie in between.
 */
#include "../link/links.h"
#include "gap.h"

#define PASS_NS	2500	/* through a slave and 100 m of cable, both ways */
#define FRAMES	8	/* of a trial, without those of gaps */

/**
 * ec_gap_find() - how much time has to be between the frames of a trial
 * @l: links
 * @passed: slaves of the branches that a frame passes before the port
 * @bytes: data of the work
 *
 * In a cycle without so much free wire time the gaps are shorter, the first one before the other:
 * without the second one nothing could be let in.
 *
 * Context: Process.
 * Return: the gaps; 0 without such branches, the first one also without process data.
 */
struct ec_gaps ec_gap_find(const struct ec_links *l, u32 passed, u32 bytes)
{
	u32 wanted_ns = min_t(u32, passed, EC_MAX_SLAVES) * PASS_NS;
	u32 need_ns = FRAMES * ec_frame_wire_ns(EC_ETH_MIN) + 80 * bytes;
	u32 free_ns = ec_access_slack_ns(l);
	struct ec_gaps g = { 0 };

	if (free_ns == ~0u) {
		g.after_ns = wanted_ns;
		return g;
	}
	/* clock frames take some of it now and then */
	free_ns -= free_ns / 8;
	free_ns -= min(free_ns, need_ns);
	g.after_ns = min(free_ns, wanted_ns);
	g.before_ns = min(free_ns - g.after_ns, wanted_ns);
	return g;
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
