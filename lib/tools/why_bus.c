// SPDX-License-Identifier: LGPL-2.1-or-later
/* Causes that concern the whole bus: device, link, scan, cycle. */
#include <stdio.h>
#include <string.h>

#include "why.h"

#define OVERRUN_SHARE	100	/* skipped cycles: one in so many is worth a warning */

static void explain_all(struct why *w)
{
	for (size_t i = 0; i < w->configs->n; i++)
		if (!why_in_op(why_config(w, i)))
			why_explain(w, why_config(w, i));
}

static bool link_up(const struct why *w)
{
	for (size_t i = 0; i < w->devices->n; i++)
		if (why_device(w, i)->link_up)
			return true;
	return false;
}

/**
 * why_scan() - a bus scan is due or in progress
 * @w: what is known
 *
 * Return: its only finding, a warning.
 */
struct ect_finding *why_scan(struct why *w)
{
	const struct ect_master *m = &w->m;
	struct ect_finding *f;

	for (size_t i = 0; i < w->findings->n; i++)
		if (!strcmp(why_finding(w, i)->cause, "scan"))
			return why_finding(w, i);
	f = why_add(w, SCAN, m->scan_index, m->scan_slaves);
	f->evidence_count = 2;
	f->evidence[0] = m->scan_index;
	f->evidence[1] = m->scan_slaves;
	return f;
}

/* Do scans only repeat an attempt to read a slave? It has a finding of its own. */
static bool tries_again(const struct why *w)
{
	for (size_t i = 0; i < w->bus->n; i++)
		if (why_slave(w, i)->error == ECT_SLAVE_SCAN_FAILED)
			return w->m.slaves_responding == w->bus->n;
	return false;
}

/**
 * why_bus() - no device, no link, no slaves
 * @w: what is known
 *
 * Return: true: nothing else can be known of the bus.
 */
bool why_bus(struct why *w)
{
	const char *name = w->devices->n ? why_device(w, 0)->name : "";
	const struct ect_master *m = &w->m;

	if (m->phase == ECT_PHASE_WAITING && !strncmp(name, "sim", 3))
		why_add(w, NO_SIM, m->index, name);
	else if (m->phase == ECT_PHASE_WAITING)
		why_add(w, NO_DEVICE, m->index, name);
	else if (!link_up(w))
		why_add(w, LINK_DOWN, name);
	else if (!m->slaves_responding && !m->slave_count && !m->scan_busy)
		why_add(w, NO_SLAVES, name);
	else if (m->scan_busy && !tries_again(w))
		return why_scan(w), false;
	else
		return false;
	explain_all(w);
	return true;
}

/* A ring that is open works as well as before, until it breaks again. */
void why_ring(struct why *w)
{
	const struct ect_master *m = &w->m;
	bool inside = m->ring_slave != ECT_NONE32 && m->ring_next != ECT_NONE32;
	char before[2 * ECT_STRING] = "the main device", behind[2 * ECT_STRING] = "the backup device";
	char name[ECT_STRING];

	if (m->ring_turned && w->bus->n) {
		why_slave_name(w, m->ring_turned - 1, name, sizeof(name));
		why_add(w, RING_TURNED, name);
	}
	if (m->ring_exchanged)
		why_add(w, RING_EXCHANGED, w->devices->n ? why_device(w, 0)->name : "");
	if (m->ring != ECT_RING_OPEN || !w->bus->n)
		return;
	if (m->ring_slave != ECT_NONE32) {
		why_slave_name(w, m->ring_slave, name, sizeof(name));
		if (m->ring_port != ECT_NONE32)
			snprintf(before, sizeof(before), "port %u of %s", m->ring_port, name);
		else
			snprintf(before, sizeof(before), "%s", name);
	}
	if (m->ring_next != ECT_NONE32)
		why_slave_name(w, m->ring_next, behind, sizeof(behind));
	if (inside)
		why_add(w, RING_OPEN, before, behind);
	else
		why_add(w, RING_END, before, behind);
}

/* the newest finding explains slaves that need a cycle to be in OP */
static void explain_cycle(struct why *w)
{
	for (size_t i = 0; i < w->configs->n; i++) {
		const struct ect_explained *c = why_config(w, i);

		if (c->cause.kind == ECT_CAUSE_NO_CYCLE || c->cause.kind == ECT_CAUSE_UNDER_WAY ||
		    (c->cause.kind == ECT_CAUSE_REFUSED && c->cause.state == 8))
			why_explain(w, why_config(w, i));
	}
}

static void no_cycle(struct why *w)
{
	why_add(w, NO_CYCLE);
	explain_cycle(w);
}

/* Is the wire time longer than the cycle? Then cycles are skipped in any case. */
static bool too_short(struct why *w)
{
	const struct ect_master *m = &w->m;
	struct ect_finding *f;

	if (!m->cycle_interval_us || m->cycle_wire_ns <= m->cycle_interval_us * 1000ull)
		return false;
	f = why_add(w, CYCLE_TOO_SHORT, m->cycle_wire_ns / 1000 + 1, m->cycle_interval_us);
	f->evidence_count = 2;
	f->evidence[0] = m->cycle_wire_ns / 1000 + 1;
	f->evidence[1] = m->cycle_interval_us;
	return true;
}

/* Output stall: the kernel runs the cycle, and has applied the configured policy to the outputs. */
static void stalled(struct why *w, u32 stall, u32 state)
{
	if (state == ECT_CYCLE_STOPPED) {
		why_add(w, OUTPUT_STOP);
		explain_cycle(w);
	} else if (state == ECT_CYCLE_STALLED && stall == ECT_STALL_ZERO) {
		why_add(w, OUTPUT_ZERO);
	} else if (state == ECT_CYCLE_STALLED) {
		why_add(w, OUTPUT_HOLD);
	}
}

static void thread(struct why *w, const struct ect_cycle *c, bool short_cycle)
{
	u64 cycles = c->late_count + c->overruns;
	struct ect_finding *f;

	if (c->kind == ECT_CYCLE_BY_KERNEL && w->m.session != ECT_SESSION_DETACHED)
		stalled(w, c->stall, c->state);
	if (short_cycle || c->overruns * OVERRUN_SHARE <= cycles)
		return;
	f = why_add(w, OVERRUNS, (unsigned long long)c->overruns, (unsigned long long)cycles);
	f->evidence_count = 2;
	f->evidence[0] = (s64)c->overruns;
	f->evidence[1] = (s64)cycles;
}

/**
 * why_cycle() - what is wrong with the cycle of an active application
 * @w: what is known
 */
void why_cycle(struct why *w)
{
	struct ect_cycle c;
	bool short_cycle;

	if (!w->m.active)
		return;
	short_cycle = too_short(w);
	if (!ect_get_cycle(w->h, &c))
		thread(w, &c, short_cycle);
	if (w->m.no_cycle && !(c.kind == ECT_CYCLE_BY_KERNEL && c.state == ECT_CYCLE_STOPPED))
		no_cycle(w);
	/* a kernel cycle sends a domain by its division */
	if (c.kind == ECT_CYCLE_BY_APP)
		why_unsent(w);
}
