// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "env.h"
#include "dc.h"

/* ports in the order in which a frame passes them */
static const u8 order[EC_DC_PORTS] = { 0, 3, 1, 2 };

#define NOISE_NS	50	/* of a way, from that of the receive times */
#define WAY_MAX_NS	1000000	/* some km of fibre, or hundreds of slaves without a clock */

static u32 dc_place(u8 port)
{
	u32 i = 0;

	while (order[i] != port)
		i++;
	return i;
}

/* Open ports of a slave as a frame meets them, the entry first; returns how many. */
static u32 visited(const struct ec_dc_node *a, u8 port[EC_DC_PORTS])
{
	u32 i, start = dc_place(a->entry), n = 0;

	port[n++] = a->entry;
	for (i = 1; i < EC_DC_PORTS; i++) {
		u8 p = order[(start + i) % EC_DC_PORTS];

		if (a->open & BIT(p))
			port[n++] = p;
	}
	return n;
}

/* How long a frame is at and behind the slave, from its arrival to its return. */
static s32 stay(const struct ec_dc_node *a)
{
	u8 port[EC_DC_PORTS];
	u32 n = visited(a, port);

	return a->recv[port[n - 1]] - a->recv[a->entry];
}

/*
 * Hang every slave with a clock behind the port of the nearest slave towards the master
 * that also has one; slaves without a clock count as cable. Returns the first of the
 * clocks that have none towards the master, and the last one in @last.
 */
static s32 link_up(struct ec_dc_node *nodes, u32 n, s32 *last)
{
	s32 top = EC_DC_NONE;
	u32 i, k, p;

	for (i = 0; i < n; i++)
		for (p = 0; p < EC_DC_PORTS; p++)
			nodes[i].first[p] = nodes[i].last[p] = EC_DC_NONE;
	*last = EC_DC_NONE;
	for (i = 0; i < n; i++) {
		struct ec_dc_node *b = &nodes[i];
		s32 a = b->parent;
		u8 port = b->parent_port;

		b->next = EC_DC_NONE;
		b->unreliable = false;
		b->delay = 0;
		b->behind = 0;
		b->to_unit = 0;
		if (!b->dc)
			continue;
		for (k = 0; k < n && a != EC_DC_NONE && !nodes[a].dc; k++) {
			port = nodes[a].parent_port;
			a = nodes[a].parent;
		}
		if (a == EC_DC_NONE) {
			if (*last == EC_DC_NONE)
				top = i;
			else
				nodes[*last].next = i;
			*last = i;
		} else {
			if (nodes[a].last[port] == EC_DC_NONE)
				nodes[a].first[port] = i;
			else
				nodes[nodes[a].last[port]].next = i;
			nodes[a].last[port] = i;
		}
	}
	return top;
}

/* To the nearest, halves to the even one: what is always cut adds up along a line. */
static s64 divide(s64 way, s32 parts)
{
	s64 whole = div_s64(way, parts), rest = 2 * (way - whole * parts);

	if (rest > parts || (rest == parts && whole & 1))
		return whole + 1;
	return rest < -parts || (rest == -parts && whole & 1) ? whole - 1 : whole;
}

/*
 * The slaves of a chain are reached one after the other. What the frame did not stay at them it
 * was on the way, in equal parts: there and back for one. Times that no frame can have count as
 * 0: an error of some us, where they would make seconds of it for all slaves that follow.
 * Returns @round, or 0 when it is one of those.
 */
static s32 place_chain(struct ec_dc_node *nodes, s32 first, u32 start, s32 round, bool unreliable)
{
	s64 way = round;
	bool bad = false;
	s32 parts = 1;
	s32 b;

	for (b = first; b != EC_DC_NONE; b = nodes[b].next) {
		way -= stay(&nodes[b]);
		bad |= stay(&nodes[b]) < -NOISE_NS;
		parts++;
	}
	way = divide(way, max(parts, 2));
	bad |= way < -NOISE_NS || way > WAY_MAX_NS;
	/* noise of the receive times can make a short way negative */
	way = way > 0 && !bad ? way : 0;
	for (b = first; b != EC_DC_NONE; b = nodes[b].next) {
		nodes[b].unreliable = unreliable || bad;
		nodes[b].hop = (u32)way;
		nodes[b].delay = start + (u32)way;
		start = nodes[b].delay + (bad ? 0 : stay(&nodes[b]));
	}
	return bad ? 0 : round;
}

/*
 * Place everything behind the ports of @a, which was placed, and append it to @last. The processing
 * unit is behind port 0, open or not: with another entry the frame has been behind some ports by
 * then.
 */
static s32 place_behind(struct ec_dc_node *nodes, struct ec_dc_node *a, s32 last)
{
	u8 port[EC_DC_PORTS];
	u32 k, ports = visited(a, port);
	bool before_unit = a->entry;

	for (k = 1; k < ports; k++) {
		s32 first = a->first[port[k]];

		if (port[k] && dc_place(port[k]) < dc_place(a->entry))
			before_unit = false;
		a->behind += place_chain(nodes, first, a->delay + a->behind,
					 a->recv[port[k]] - a->recv[port[k - 1]], a->unreliable);
		if (before_unit)
			a->to_unit = a->behind;
		if (first == EC_DC_NONE)
			continue;
		nodes[last].next = first;
		last = a->last[port[k]];
	}
	return last;
}

/**
 * ec_dc_delays() - propagation delays from receive times
 * @nodes: the slaves of a segment in ring order; results are in them
 * @n: how many
 * @ref: index of the reference clock
 *
 * Register 0x0928 of a slave is compared with a datagram that has been through
 * all branches before it, so their round trips count as well. Cables are taken as
 * symmetric; frames of both ends of an open ring reach their first slave at the same time.
 *
 * Context: Any. RT-safe: O(@n), no sleep, no allocation.
 */
void ec_dc_delays(struct ec_dc_node *nodes, u32 n, u32 ref)
{
	u32 i, zero, at = 0;
	s32 last, b, top = link_up(nodes, n, &last), top_end = last;
	bool at_top = true, other = false;

	/* so far when a frame comes in; the list grows on the way */
	for (b = top; b != EC_DC_NONE; b = nodes[b].next) {
		if (at_top && nodes[b].other && !other) {
			other = true;
			at = 0;
		}
		if (at_top) {
			nodes[b].hop = 0;
			nodes[b].delay = at;
		}
		last = place_behind(nodes, &nodes[b], last);
		at += nodes[b].behind;
		at_top = at_top && b != top_end;
	}
	for (i = 0; i < n; i++)
		nodes[i].delay += nodes[i].to_unit;
	zero = ref < n ? nodes[ref].delay : 0;
	for (i = 0; i < n; i++)
		nodes[i].delay = nodes[i].dc ? nodes[i].delay - zero : 0;
}

/**
 * ec_dc_offset() - system time offset of a slave, register 0x0920
 * @ref_time: system time at the reference clock when the frame latched
 * @delay: of the slave
 * @local: its local time of the same latch, register 0x0918
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: offset modulo 2^64; 32-bit slaves take its low half.
 */
u64 ec_dc_offset(u64 ref_time, u32 delay, u64 local)
{
	return ref_time + (s64)(s32)delay - local;
}

/**
 * ec_dc_diff() - system time difference from register 0x092C
 * @value: sign and magnitude
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns, positive: the slave is ahead of the reference.
 */
s32 ec_dc_diff(u32 value)
{
	s32 magnitude = value & ~(u32)EC_DC_DIFF_AHEAD;

	return value & EC_DC_DIFF_AHEAD ? magnitude : -magnitude;
}

/* what is left of a time, which may be negative, by whole periods */
static u32 modulo(s64 t, u32 period)
{
	u64 magnitude = t < 0 ? 0 - (u64)t : (u64)t;
	u32 rest = (u32)(magnitude - div_u64(magnitude, period) * period);

	return t < 0 && rest ? period - rest : rest;
}

/**
 * ec_dc_start() - start time of the SYNC signals, register 0x0990
 * @earliest: system time before which it must not be
 * @phase: any point of the grid all slaves share; may be decades away
 * @period: of the grid, not 0
 * @shift: of this slave against the grid
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the first time on the shifted grid that is not before @earliest.
 */
u64 ec_dc_start(u64 earliest, u64 phase, u32 period, s32 shift)
{
	u32 now = modulo((s64)(earliest - phase), period), want = modulo(shift, period);

	return earliest + (want >= now ? want - now : want + period - now);
}

/**
 * ec_dc_sync_fits() - is one of two times a multiple of the other
 * @sync0: time of SYNC0, ns
 * @cycle: cycle time, ns; if it was measured it differs a little from what it should be
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is, within 2 % of the shorter or 1 % of the longer one; true for a time of 0.
 */
bool ec_dc_sync_fits(u32 sync0, u32 cycle)
{
	u32 longer = max(sync0, cycle), shorter = min(sync0, cycle), rest;

	if (!shorter)
		return true;
	rest = longer % shorter;
	return min(rest, shorter - rest) <= max(shorter / 50, longer / 100);
}
